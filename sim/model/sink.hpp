#pragma once
// The contract of what takes frames: files, previews, streams. A sink sees frames and nothing of how they were drawn.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

struct Frame;
struct Simulation;

/// What became of the frames that a sink was given.
struct SinkCounts {
  std::string sink;  ///< where they go: "shared memory /pitviper.tracker"
  std::uint64_t taken = 0, passedOn = 0, skipped = 0;  ///< given = passed on + skipped, because whoever reads them was slow or not there
  std::vector<std::pair<std::string, std::uint64_t>> others;  ///< what else there is to count, in words
};

/// Where frames go; one at a time, in order: a camera's frame, its spectral image if it has one, camera by camera, then tick by tick. The calls come
/// from a thread that is not the one that draws. An exception ends the run.
class Sink {
 public:
  virtual ~Sink() = default;
  /// Before the first frame: what must be there is made. Called on the thread that draws.
  virtual void start() {}
  virtual void take(const std::shared_ptr<const Frame>& frame) = 0;
  /// After the last frame. `progress`: called where it takes long, with the share that is done; or empty.
  virtual void finish(const std::function<void(double share)>&) {}
  /// take() never waits for anybody: a stream calls it as a frame is due. The frames of others wait in a queue.
  virtual bool neverWaits() const { return false; }
  /// So far; may be called from any thread.
  virtual std::vector<SinkCounts> counts() const { return {}; }
  /// The files that it would write for a frame of this camera, number and kind (as of Frame): those that say whose they are. One may be of many frames.
  virtual std::vector<std::filesystem::path> filesOf(const std::string&, int, const std::string&) const { return {}; }
};

/// Where a run puts what it writes.
struct SinkPlace {
  std::filesystem::path folder;
  MayReplace mayReplace;
  SinkPlace below(const std::filesystem::path& part) const { return {(folder / part).lexically_normal(), mayReplace}; }
};

/// A sink that a scenario asks for. It is made anew where a run starts over.
struct SinkChoice {
  Location where;
  std::function<std::unique_ptr<Sink>(const Simulation& simulation, const SinkPlace& place)> make;
};

}  // namespace pitviper
