#pragma once
// Scenes for tests, written as scenarios are, and rendered through the whole pipeline.
#include <string>

#include "sim/frame/make_frame.hpp"
#include "sim/camera/camera_renderer.hpp"

namespace pitviper::test {

/// A simulation from YAML text (libraries of the source tree). Cameras whose text says nothing of samples look at pixels' middles alone: most tests hold
/// radiance along lines of sight against each other.
Simulation scene(const std::string& yaml);

/// One GL context for the whole test program.
void needContext();
/// True where the driver draws on the CPU.
bool onSoftware();

/// Frame 0 (or another) of camera 0 as integrals, and as a calibrated frame.
CameraImage renderImage(const Simulation& simulation, int frame = 0);
Frame renderFrame(const Simulation& simulation, int frame = 0);
const FrameLayer& layer(const Frame& frame, const std::string& name);
double at(const FrameLayer& layer, const Frame& frame, int column, int row);
double sum(const FrameLayer& layer);
std::vector<double> probeReading(const Simulation& simulation);

/// Band radiance of a black body [W/(m2 sr)] by the classical series, independent of the code under test:
///   integral_0^lambda B = (2 k^4 T^4 / (h^3 c^2)) sum_n e^(-n x) (x^3/n + 3 x^2/n^2 + 6 x/n^3 + 6/n^4), x = c2 / (lambda T).
double blackBodyBand(double low_um, double high_um, double temperature_K);

}  // namespace pitviper::test
