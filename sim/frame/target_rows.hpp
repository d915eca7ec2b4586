#pragma once
// Rows of targets (TargetRow) in a frame's header and as tables.
#include "sim/frame/frame.hpp"
#include "sim/model/count_marks.hpp"

namespace pitviper {

/// What a frame's pixels say of its targets (those that are full), and their rows as attributes `target.<name>.`: `kind`, `place` [column, row, left, top,
/// right, bottom], `sight` [range, its rate, turning to the right and up, share that is visible], and of each channel `<channel>` [own, total, contrast,
/// signal to noise, full pixels]; `target_unit.<channel>` is the unit of the first three. `marks`: of the frame's pixels.
void finishTargets(Frame& frame, const CountMarks& marks);

/// Rows as such attributes tell them. Attributes that are none of them are passed over.
void restoreTargets(Frame& frame);

/// Rows as a table: a line of names and units, and for each row a line.
std::string targetTableHead(const std::vector<TargetRow>& rows);
std::string targetTable(const Frame& frame);

}  // namespace pitviper
