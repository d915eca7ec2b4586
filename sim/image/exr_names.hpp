#pragma once
// What the EXR writer and reader must agree on.
#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

namespace pitviper::exr {

constexpr int maxSide = 32768;
constexpr int maxChannels = 1024;
constexpr std::size_t maxNameBytes = 255;  // the long-names flag of the file format

/// Attributes with a meaning of their own in EXR (OpenEXR file layout, "Predefined attributes"): not for metadata.
inline bool isReserved(std::string_view name) {
  constexpr std::array<std::string_view, 16> names = {"channels",
                                                      "chunkCount",
                                                      "compression",
                                                      "dataWindow",
                                                      "displayWindow",
                                                      "dwaCompressionLevel",
                                                      "lineOrder",
                                                      "name",
                                                      "maxSamplesPerPixel",
                                                      "pixelAspectRatio",
                                                      "screenWindowCenter",
                                                      "screenWindowWidth",
                                                      "tiles",
                                                      "type",
                                                      "version",
                                                      "view"};
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace pitviper::exr
