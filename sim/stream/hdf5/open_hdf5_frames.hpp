#pragma once
// HDF5 for those who are not linked with it.
#include "sim/parameters/error.hpp"
#include "sim/stream/hdf5/hdf5_module.hpp"

namespace pitviper {

/// The module's function. Errors: UserError where HDF5 or the module is not installed.
Hdf5Function loadHdf5(const Location& askedAt);

}  // namespace pitviper
