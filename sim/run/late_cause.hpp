#pragma once
// Why ticks of a stream are late: what the time from one frame to the next went into, beside what it goes into where frames are on time.
#include <array>
#include <cstdint>
#include <map>
#include <string>

namespace pitviper {

/// In the order in which they are asked for.
enum class LateCause {
  Sinks,      ///< frames were handed over meanwhile
  Planner,    ///< plans, tables and programs were made beside
  Compiler,   ///< programs were made
  PageFaults,
  Processor,  ///< others had it: other processes, or other threads of this one
  Before,     ///< it could only be begun when the tick before was drawn
  Picture     ///< drawing it took longer
};
constexpr std::size_t kLateCauses = 7;
std::string nameOf(LateCause cause);

/// What this process has used so far.
struct ProcessUse {
  std::int64_t waited_ns = 0;  ///< of the thread that waited most for a processor, but for those that give way
  std::uint64_t majorFaults = 0, minorFaults = 0;
  std::uint64_t programs = 0;  ///< made
};

class LateCauses {
 public:
  /// A frame and what was before it, monotonic [ns]: from the frame before on, or since it was begun.
  struct Tick {
    std::int64_t begins_ns = 0, begun_ns = 0, due_ns = 0, made_ns = 0;
    std::int64_t handing_ns = 0;  ///< spent with sinks since the last frame
    bool plansBeside = false;
    ProcessUse use;  ///< as it is now
  };
  /// What made it late: the first cause that has taken half of what it is late by, beyond what it takes where ticks are on time. Counts it. Of one that is on
  /// time nothing, but that is what others are held against.
  const LateCause* look(const Tick& tick);
  const std::array<std::uint64_t, kLateCauses>& counts() const { return counts_; }

 private:
  std::array<std::uint64_t, kLateCauses> counts_{};
  ProcessUse last_;
  bool hasLast_ = false;
  double usualWait_ns_ = 0.0, usualFaults_ = 0.0;  ///< of ticks on time
  LateCause found_ = LateCause::Picture;
};

/// Reads what this process has used. Threads that begin later are looked for now and then.
class ProcessWatch {
 public:
  ProcessWatch() = default;
  ~ProcessWatch();
  ProcessWatch(const ProcessWatch&) = delete;
  ProcessWatch& operator=(const ProcessWatch&) = delete;
  ProcessUse read();

 private:
  struct Thread {
    int file = -1;               ///< its schedstat
    std::int64_t waited_ns = -1;  ///< -1: not read yet
  };
  std::map<int, Thread> threads_;
  std::uint64_t reads_ = 0;
  std::int64_t waited_ns_ = 0;
};

}  // namespace pitviper
