#pragma once
// A frame's metadata as JSON.
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper {

/// How a layer lies in a file: value = low + step x code, where it is in codes; otherwise as it is.
struct LayerCode {
  std::string layer;
  std::string file;  ///< its name, where it has one of its own
  std::string type;  ///< "uint16", "float32"
  double low = 0.0, step = 1.0;
  bool zeroIsNone = false;  ///< code 0 stands for no number
};

/// {"pitviper.scenario": ..., "pitviper.scenario_sha256": ..., "width", "height", "layers": [{"name", "unit", "type", "file", "low", "step", ...}],
/// "attributes":
/// {...}}. What is not finite is null.
std::string frameJson(const Frame& frame, const std::vector<LayerCode>& codes);

}  // namespace pitviper
