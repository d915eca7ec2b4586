#pragma once
// Frames that wait for the end of their run: their layers in a file without a name, the rest in memory.
#include <filesystem>
#include <functional>
#include <vector>

#include "sim/frame/frame.hpp"

namespace pitviper {

class FrameSpool {
 public:
  /// The file lies in this folder, which must exist.
  explicit FrameSpool(std::filesystem::path folder) : folder_(std::move(folder)) {}
  FrameSpool(const FrameSpool&) = delete;
  FrameSpool& operator=(const FrameSpool&) = delete;
  ~FrameSpool();
  /// Errors: OutputError.
  void add(Frame frame);
  /// One after another. Errors: OutputError.
  void each(const std::function<void(const Frame& frame, double share)>& visit) const;
  bool isEmpty() const { return frames_.empty(); }

 private:
  std::filesystem::path folder_;
  int file_ = -1;
  std::vector<Frame> frames_;  ///< without pixels
};

}  // namespace pitviper
