#pragma once
// The border between the program and the HDF5 module: one C function. Both sides come from one build, so that C++ types may cross it.
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace pitviper {

/// Numbers of targets: frames x targets, NaN where there is none.
struct Hdf5Table {
  std::string name, unit;
  std::vector<double> values;
};

/// What is known when all frames are there.
struct Hdf5Ends {
  std::vector<std::pair<std::string, std::string>> attributes;  ///< of the file
  std::vector<int> numbers;                                     ///< of the frames
  std::vector<double> times_s;
  std::vector<std::string> targets, kinds;  ///< none: no tables
  std::vector<Hdf5Table> tables;
};

/// Frames of one camera on their way into a file. Errors of all: std::runtime_error with what HDF5 says; the file is then of no use.
class Hdf5Frames {
 public:
  virtual ~Hdf5Frames() = default;
  /// A frame's layers in the order of the request's, each width x height.
  virtual void add(const std::vector<std::span<const float>>& layers) = 0;
  /// Writes the rest, and closes the file.
  virtual void finish(const Hdf5Ends& ends) = 0;
};

struct Hdf5Request {
  std::string file;  ///< which is made; one of this name is replaced
  int width = 0, height = 0;
  int compression = 0;                                      ///< of deflate, 1 to 9; 0: none
  std::vector<std::pair<std::string, std::string>> layers;  ///< names and units
};

struct Hdf5Reply {
  std::unique_ptr<Hdf5Frames> frames;
  std::string failure;  ///< why there are none, in one line
};

inline constexpr const char* kHdf5Module = "libpitviper_hdf5.so";
inline constexpr const char* kHdf5Function = "pitviperOpenHdf5Frames";
using Hdf5Function = void (*)(const Hdf5Request* request, Hdf5Reply* reply);

}  // namespace pitviper
