#pragma once
// A picture that VTK draws off screen.
#include <functional>

#include "sim/image/picture.hpp"

class vtkRenderer;

namespace pitviper {

/// Drawn chart_style::kOversampling times larger, on white, and averaged. `fill` puts in what is to be seen; the renderer's window has its size by then. Makes
/// a GlContext of its own, current on this thread until it returns. Errors: std::exception where it fails, with what VTK says.
Rgb8Image drawnOffScreen(int width, int height, const std::function<void(vtkRenderer&)>& fill);

}  // namespace pitviper
