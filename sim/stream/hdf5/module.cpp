// The module's border: one C function, no exceptions out.
#include <exception>

#include "sim/stream/hdf5/frames_file.hpp"
#include "sim/stream/hdf5/hdf5_module.hpp"

extern "C" __attribute__((visibility("default"))) void pitviperOpenHdf5Frames(const pitviper::Hdf5Request* request, pitviper::Hdf5Reply* reply) {
  try {
    reply->frames = pitviper::makeFramesFile(*request);
  } catch (const std::exception& problem) {
    reply->failure = problem.what();
  }
}
