#pragma once
// Sinks that stand for a device: who reads it sets it, and triggers it.
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace pitviper {

class ControllableSink {
 public:
  /// `command`: gets the keys and values of a command as a scenario writes it; `trigger`: a pulse that came by the device's own way. From whatever thread.
  struct Controls {
    std::function<void(const std::vector<std::pair<std::string, std::string>>& words)> command;
    std::function<void()> trigger;
  };
  virtual ~ControllableSink() = default;
  /// Before start().
  virtual void control(const Controls& controls) = 0;
  /// A pulse on the line that triggers it.
  virtual void pulse() = 0;
};

}  // namespace pitviper
