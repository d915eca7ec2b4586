#pragma once
// A frame's metadata read from JSON (frame_json.hpp).
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/frame/frame_json.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

struct FrameNotes {
  Frame frame;                   ///< layers without pixels
  std::vector<LayerCode> codes;  ///< of each layer
};

/// Errors: UserError at `where` if it is not what frameJson() writes.
FrameNotes frameNotes(const std::string& json, const Location& where);

}  // namespace pitviper
