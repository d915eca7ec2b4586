#include "sim/stream/hdf5/open_hdf5_frames.hpp"

#include "sim/parameters/module_on_demand.hpp"

namespace pitviper {

Hdf5Function loadHdf5(const Location& askedAt) {
  return reinterpret_cast<Hdf5Function>(loadOnDemand(
      {kHdf5Module, kHdf5Function, "the module", "HDF5 1.10 or later", "install the package libhdf5-dev and build again", "install the package libhdf5-103-1"},
      askedAt));
}

}  // namespace pitviper
