#pragma once
// The border between the program and the projector module: one C function. Both sides come from one build, so that C++ types may cross it.
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace pitviper {

struct ProjectorOptions {
  int width = 0, height = 0;         ///< of a frame, pixels
  int monitor = -1;                  ///< the one to fill, from 0; -1: a window of the frames' size
  int scale = 1;                     ///< a frame's pixel is a square of this many of the display's
  std::vector<std::uint8_t> levels;  ///< grey level of each code; codes beyond have the last. None: a code's high byte is red, its low byte green, blue is 0
};

/// The display's clock.
struct ProjectorSwap {
  std::uint64_t number = 0;    ///< from 1; a gap: swaps that were not waited for
  std::int64_t time_ns = 0;    ///< monotonic clock (std::chrono::steady_clock) when the swap was done
  std::uint64_t sequence = 0;  ///< of the frame shown since then
  bool hasFrame = false;       ///< else the display is still black
};

struct ProjectorCounts {
  std::uint64_t swaps = 0;
  std::uint64_t shown = 0;     ///< frames
  std::uint64_t replaced = 0;  ///< frames that a newer one took the place of before a swap
};

/// Frames on a display, by a thread of its own: the newest at each vertical blanking, unscaled or in whole squares, centred, black around. Escape or closing
/// the window ends it.
class Projector {
 public:
  /// Waits at most two seconds; a display that hangs longer is left behind.
  virtual ~Projector() = default;

  /// `codes`: width x height, row by row from the top; `sequence` comes back with its swap. Never waits. Nothing where it is closed. A frame that is here by
  /// half of a period after a swap is shown by the next. Errors: std::invalid_argument for another number of codes.
  virtual void show(std::span<const std::uint16_t> codes, std::uint64_t sequence) = 0;
  /// Waits for a swap later than `swap`, and puts the newest there. False after `timeout_ns`, or where it is closed. Any number of threads.
  virtual bool waitSwap(ProjectorSwap& swap, std::int64_t timeout_ns) = 0;
  virtual bool closed() const = 0;
  /// What went wrong while it ran, in one line; empty: nothing.
  virtual std::string error() const = 0;
  virtual ProjectorCounts counts() const = 0;
  /// Swaps a second: as measured at the beginning, or as paced.
  virtual double rate_hz() const = 0;
  /// No display holds the swaps (measured at the beginning: far faster than any monitor's refresh): a timer does, at the fastest monitor's nominal rate.
  virtual bool isPaced() const = 0;
};

struct ProjectorReply {
  std::unique_ptr<Projector> projector;
  std::string failure;  ///< why there is none, in one line
  std::string expected, fix;
};

inline constexpr const char* kProjectorModule = "libpitviper_projector.so";
inline constexpr const char* kProjectorFunction = "pitviperOpenProjector";
using ProjectorFunction = void (*)(const ProjectorOptions* options, ProjectorReply* reply);

}  // namespace pitviper
