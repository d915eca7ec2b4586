#pragma once
// Which of several accuracies a stream draws to, so that it holds its rate.
#include <cstdint>
#include <vector>

namespace pitviper {

class AccuracyDial {
 public:
  /// `work_ns`: what a tick takes of each rung, measured before the first; the first rung is the finest. Begins with the finest that is expected to hold.
  AccuracyDial(std::vector<double> work_ns, std::int64_t period_ns);
  /// What a tick took that was drawn to a rung, not counting waiting; whether it was late.
  void look(std::size_t drawn, std::int64_t work_ns, bool isLate, std::int64_t now_ns);
  std::size_t rung() const { return rung_; }
  const std::vector<std::uint64_t>& frames() const { return frames_; }
  std::uint64_t turns() const { return turns_; }

 private:
  void turn(std::size_t rung, std::int64_t now_ns);
  std::vector<double> work_ns_;  ///< running means
  std::vector<std::uint64_t> frames_;
  double period_ns_;
  std::size_t rung_ = 0;
  int over_ = 0;  ///< ticks on end, nearly, that took too long
  std::int64_t turned_ns_ = 0, wait_ns_;
  std::uint64_t turns_ = 0;
};

}  // namespace pitviper
