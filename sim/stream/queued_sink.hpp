#pragma once
// A sink that may wait, behind a queue that does not.
#include <condition_variable>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "sim/frame/frame.hpp"
#include "sim/model/sink.hpp"

namespace pitviper {

class QueuedSink final : public Sink {
 public:
  /// `name`: of what is behind it, for counts. `skips`: a frame that finds the queue full is left out and counted; else take() waits for room: nothing is lost
  /// in lockstep.
  QueuedSink(std::unique_ptr<Sink> sink, std::string name, bool skips, std::size_t length = 16);
  ~QueuedSink() override;
  void start() override { sink_->start(); }
  void take(const std::shared_ptr<const Frame>& frame) override;
  void finish(const std::function<void(double share)>& progress) override;
  bool neverWaits() const override { return skips_; }
  std::vector<SinkCounts> counts() const override;
  std::vector<std::filesystem::path> filesOf(const std::string& camera, int number, const std::string& kind) const override {
    return sink_->filesOf(camera, number, kind);
  }

 private:
  void serve();
  std::unique_ptr<Sink> sink_;
  std::string name_;
  bool skips_;
  std::size_t length_;
  mutable std::mutex mutex_;
  std::condition_variable wake_, room_;
  std::deque<std::shared_ptr<const Frame>> queue_;
  std::uint64_t taken_ = 0, passed_ = 0, skipped_ = 0;
  bool ends_ = false, busy_ = false;
  std::exception_ptr failure_;  ///< of the sink: thrown at the next call
  std::thread thread_;
};

}  // namespace pitviper
