#pragma once
// What a pixel of a frame is made of, worked out by the reference.
#include <string>

#include "scenarios/commands/scenario_wish.hpp"
#include "sim/image/exr.hpp"

namespace pitviper {

/// Prints a row for each part of a pixel (emission, each light's reflection, the dome's, the air's emission, scattered sunlight, media, lamps in view; by the
/// body that sends it) and a column for each channel, in double precision at every wavelength, and their sum beside the frame's own value.
/// Throws UserError where the frame is not of this scenario as it is now (text, tables, meshes), or names a camera that it does not have.
void printPixelTerms(const ExrImage& frame, const std::string& file, int column, int row, const ScenarioWish& scenario);

}  // namespace pitviper
