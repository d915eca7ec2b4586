#pragma once
// What a frame's header says of pixels whose counts say nothing.
#include "sim/frame/frame.hpp"
#include "sim/model/count_marks.hpp"

namespace pitviper {

/// So many of a channel's pixels are full, at the converter's lowest code, bad.
struct MarkTally {
  int full = 0, lowest = 0, bad = 0;
};

/// `pitviper.saturated.<channel>.full`, `.lowest`, `.bad`: numbers of pixels, of each channel that a detector counts.
void addMarks(Frame& frame, const CountMarks& marks);
/// As a frame's header has them, by channel.
std::map<std::string, MarkTally> markTallies(const Frame& frame);

}  // namespace pitviper
