#pragma once
// Colours for values: equal steps of the value look like equal steps.
#include <string>
#include <string_view>
#include <vector>

#include "sim/image/picture.hpp"

namespace pitviper {

class ColourMap {
 public:
  /// Colours at equal steps from 0 to 1; at least two.
  explicit ColourMap(std::vector<Rgb8> anchors) : anchors_(std::move(anchors)) {}

  /// `value` in 0..1; outside is clamped, NaN gives the colour of 0.
  Rgb8 operator()(float value) const;

 private:
  std::vector<Rgb8> anchors_;
};

/// "thermal" (black, violet, red, orange, pale yellow), "white_hot" (grey), "black_hot" or "blue_yellow" (also for people who do not tell red from green).
/// Errors: std::invalid_argument for another name.
const ColourMap& colourMap(std::string_view name);

/// The names that colourMap knows.
std::vector<std::string> colourMapNames();

}  // namespace pitviper
