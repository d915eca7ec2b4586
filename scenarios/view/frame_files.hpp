#pragma once
// Frames from files in a window, one after another, and what one has more than another.
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/view/picture_maker.hpp"

namespace pitviper {

/// Whether a word names frames and not a scenario: a folder, or a file that is no YAML.
bool namesFrames(const std::filesystem::path& word);

struct FrameFileWish {
  std::filesystem::path file, beside;  ///< the second: empty, none
  std::uint64_t number = 0;            ///< that the picture gets
};

/// A frame as it was written. With one beside it, of each layer that both have one more, "less FILE.layer": what the frame has more than that. Errors:
/// UserError.
ShownPicturePointer readShownFrame(const FrameFileWish& wish);

/// Name of a body by its number in a frame's entity layer, where the frame says it; else empty.
std::string bodyNamed(const Frame& frame, int entity);

/// What the frame says of itself, a line each: "name  value".
std::vector<std::pair<std::string, std::string>> wordsOf(const Frame& frame);

}  // namespace pitviper
