#pragma once
// Frames as datasets of an HDF5 file. The only place that knows the library.
#include <memory>

#include "sim/stream/hdf5/hdf5_module.hpp"

namespace pitviper {

/// Each layer is a dataset [frames, height, width] of single precision, a chunk a frame, with its `unit`; beside them `number` and `time_s` [frames], and in
/// the group `targets` `names`, `kinds` and tables [frames, targets]. The same frames give the same bytes. Errors: std::runtime_error.
std::unique_ptr<Hdf5Frames> makeFramesFile(const Hdf5Request& request);

}  // namespace pitviper
