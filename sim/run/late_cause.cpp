#include "sim/run/late_cause.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "sim/gl/objects.hpp"

namespace pitviper {
namespace {

/// A page that was not there takes about so long: it is cleared [ns]. One that comes from a disk.
constexpr double kMinorFault_ns = 1000.0, kMajorFault_ns = 1.0e6;
/// After so many reads threads are looked for again.
constexpr std::uint64_t kLookAgain = 64;
/// The newest tick's part in what is usual.
constexpr double kNewest = 0.1;

double faultsOf(const ProcessUse& now, const ProcessUse& before) {
  return kMinorFault_ns * static_cast<double>(now.minorFaults - before.minorFaults) +
         kMajorFault_ns * static_cast<double>(now.majorFaults - before.majorFaults);
}

}  // namespace

std::string nameOf(LateCause cause) {
  static const char* const kNames[kLateCauses] = {"sinks", "plans made beside", "the compiler", "page faults", "others had the processor", "the tick before",
                                                  "the picture itself"};
  return kNames[static_cast<std::size_t>(cause)];
}

const LateCause* LateCauses::look(const Tick& tick) {
  const ProcessUse before = hasLast_ ? last_ : tick.use;
  last_ = tick.use;
  hasLast_ = true;
  const double waited = static_cast<double>(tick.use.waited_ns - before.waited_ns), faults = faultsOf(tick.use, before);
  const auto late_ns = static_cast<double>(tick.made_ns - tick.due_ns);
  if (late_ns <= 0.0) {
    usualWait_ns_ += kNewest * (waited - usualWait_ns_), usualFaults_ += kNewest * (faults - usualFaults_);
    return nullptr;
  }
  const double much = 0.5 * late_ns;
  found_ = static_cast<double>(tick.handing_ns) >= much                       ? LateCause::Sinks
           : tick.plansBeside                                                 ? LateCause::Planner
           : tick.use.programs > before.programs                              ? LateCause::Compiler
           : faults - usualFaults_ >= much                                    ? LateCause::PageFaults
           : waited - usualWait_ns_ >= much                                   ? LateCause::Processor
           : static_cast<double>(tick.begun_ns - tick.begins_ns) >= much      ? LateCause::Before
                                                                              : LateCause::Picture;
  ++counts_[static_cast<std::size_t>(found_)];
  return &found_;
}

ProcessWatch::~ProcessWatch() {
  for (const auto& [number, thread] : threads_) close(thread.file);
}

ProcessUse ProcessWatch::read() {
  if (reads_++ % kLookAgain == 0) {
    std::error_code none;
    for (const auto& t : std::filesystem::directory_iterator("/proc/self/task", none)) {
      const int number = std::atoi(t.path().filename().c_str());
      if (threads_.count(number) > 0) continue;
      if (const int file = open((t.path() / "schedstat").c_str(), O_RDONLY | O_CLOEXEC); file >= 0) threads_[number] = {file, -1};
    }
  }
  std::int64_t most = 0;
  for (auto t = threads_.begin(); t != threads_.end();) {
    Thread& thread = t->second;
    char text[96] = "";
    long long ran = 0, waited = 0;
    if (pread(thread.file, text, sizeof text - 1, 0) <= 0 || std::sscanf(text, "%lld %lld", &ran, &waited) != 2) {  // it has ended
      close(thread.file);
      t = threads_.erase(t);
      continue;
    }
    // What gives way to drawing waits, and makes nothing late by that.
    const bool givesWay = getpriority(PRIO_PROCESS, static_cast<id_t>(t->first)) > 0;
    if (thread.waited_ns >= 0 && !givesWay) most = std::max<std::int64_t>(most, waited - thread.waited_ns);
    thread.waited_ns = waited;
    ++t;
  }
  waited_ns_ += most;
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  return {waited_ns_, static_cast<std::uint64_t>(used.ru_majflt), static_cast<std::uint64_t>(used.ru_minflt),
          static_cast<std::uint64_t>(programsSoFar().programs)};
}

}  // namespace pitviper
