#pragma once
// The stream channel (GVSP): a thread that takes pictures out of a small mailbox and sends them as packets, some of them twice.
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "sim/stream/gige/gige_control.hpp"
#include "sim/stream/gige/gvsp_block.hpp"

namespace pitviper {

/// All functions may be called from any thread and return at once.
class GigeStream {
 public:
  /// `socket` is a UDP socket that does not block and outlives this. `acquisition` is told what starts and ends, by whoever makes it so.
  GigeStream(int socket, const GigeSettings& settings, GigeTally& tally, std::function<void(bool)> acquisition);
  GigeStream(const GigeStream&) = delete;
  GigeStream& operator=(const GigeStream&) = delete;
  ~GigeStream();

  void configure(const GigePlan& plan);
  void reopen();
  void acquire(bool isOn);
  bool isAcquiring() const { return isAcquiring_; }
  bool isStreaming() const { return isAcquiring_ && hasDestination_; }
  /// Whether it is one that is waited for.
  bool trigger(GigeTrigger source);
  void publish(std::shared_ptr<const GigePicture> picture);
  void resend(const GigeResend& request);
  void sendTestPacket(const GigePlan& plan);

 private:
  using Clock = std::chrono::steady_clock;
  class Batch;
  void giveUpWaiting();
  void run();
  void send(const GigePicture& picture, const GigePlan& plan, std::uint64_t generation);
  void serveResends();
  void serve(const GigeResend& request);
  /// Waits until the socket takes more, or it is time to give up.
  bool waitForSocket(Clock::time_point until) const;
  std::uint64_t nextId(bool hasWideIds);
  GvspBlock& freshBlock();

  const int socket_;
  const int bits_;
  const double byte_ns_;  ///< time of a byte on the line
  GigeTally& tally_;
  const std::function<void(bool)> acquisition_;

  std::mutex mutex_;
  std::condition_variable wake_;
  // Guarded by mutex_.
  GigePlan plan_;
  std::deque<std::shared_ptr<const GigePicture>> mailbox_;
  std::deque<GigeResend> resends_;
  bool hasTrigger_ = false;
  std::uint32_t picturesLeft_ = 0;

  // Written under mutex_, read anywhere.
  std::atomic<bool> isAcquiring_{false};
  std::atomic<bool> hasDestination_{false};
  std::atomic<bool> hasResends_{false};
  std::atomic<bool> isEnding_{false};
  std::atomic<std::uint64_t> generation_{0};  ///< goes up when a picture in flight is no longer wanted
  std::atomic<std::uint64_t> openings_{0};    ///< goes up when what was sent is to be forgotten

  // Of the thread alone.
  std::deque<std::unique_ptr<GvspBlock>> sent_;  ///< the newest last
  std::uint64_t openingsSeen_ = 0;
  std::uint64_t id_ = 0;
  std::thread thread_;  ///< the last member: all others are there before it starts
};

}  // namespace pitviper
