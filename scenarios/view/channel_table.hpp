#pragma once
// Tables of several channels' values over one angle or two, read linearly; over one, filled only where they bend.
#include <array>
#include <functional>
#include <vector>

#include "sim/model/component.hpp"

namespace pitviper {

struct ChannelTable {
  std::array<AngleAxis, 2> axes;
  std::vector<std::vector<float>> values;  ///< [channel][entry 2 x count 1 + entry 1]
};

/// Puts values[channel] of an angle on each axis.
using ValuesAtAngles = std::function<void(const std::array<double, 2>& angles_rad, double* values)>;

/// Asks for all entries, on several threads at once.
ChannelTable filledTable(const std::array<AngleAxis, 2>& axes, std::size_t channels, const ValuesAtAngles& at);

/// Over one axis: entries between those asked for are linear where that is off by less than `accuracy` of the value, or of a thousandth of the largest.
ChannelTable bisectedTable(const AngleAxis& axis, std::size_t channels, double accuracy, const ValuesAtAngles& at);

}  // namespace pitviper
