#include <arpa/inet.h>
#include <sys/eventfd.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <thread>

#include "sim/stream/cigi/cigi_start_of_frame.hpp"
#include "sim/stream/cigi_world.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_port.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kLargestDatagram = 65536;
/// A host frame number that falls behind by less is an old datagram; by more, a host that was started again.
constexpr std::int32_t kOldest = 1000;

class CigiPort final : public CommandPort {
 public:
  CigiPort(const std::string& address, bool steps, const Simulation& simulation, CommandInbox& inbox)
      : address_(address), steps_(steps), world_(simulation), inbox_(inbox) {
    const SocketPlace place = readSocketPlace(address, "--cigi");
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_port = htons(static_cast<std::uint16_t>(place.port));
    inet_pton(AF_INET, place.host.c_str(), &at.sin_addr);
    socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (bind(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) {
      const int reason = errno;
      close(socket_);
      throw UserError({"--cigi " + address, 0, 0, -1}, std::string("it cannot be listened at (") + std::strerror(reason) + ")", "a free port of this machine",
                      "choose another, or end what has it");
    }
    wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    began_ns_ = monotonic_ns();
    thread_ = std::thread([this] { serve(); });
  }
  ~CigiPort() override {
    ends_ = true;
    eventfd_write(wake_, 1);
    thread_.join();
    close(socket_);
    close(wake_);
  }
  std::string place() const override { return "CIGI 3.3 at UDP " + address_; }

  void tickDone(const TickDone& tick) override {
    const std::lock_guard lock(mutex_);
    frame_.igFrame = static_cast<std::uint32_t>(tick.sequence);
    frame_.hostFrame = steps_ ? static_cast<std::uint32_t>(tick.hostFrame) : newest_;
    sendFrame();
  }

 private:
  void serve() {
    std::vector<std::byte> buffer(kLargestDatagram);
    pollfd fds[2] = {{wake_, POLLIN, 0}, {socket_, POLLIN, 0}};
    while (!ends_) {
      if (poll(fds, 2, -1) < 0) continue;
      for (;;) {
        sockaddr_in from{};
        socklen_t size = sizeof from;
        const ssize_t count = recvfrom(socket_, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
        if (count < 0) break;
        receive(std::span(buffer).first(static_cast<std::size_t>(count)), from);
      }
    }
  }

  void receive(std::span<const std::byte> bytes, const sockaddr_in& from) {
    const std::int64_t received = monotonic_ns();
    const CigiMessage message = readCigi(bytes);
    if (message.fault != CigiFault::None) return inbox_.refuse("malformed CIGI", message.words);
    const CigiIgControl& control = *message.control;
    {
      const std::lock_guard lock(mutex_);
      const bool sameHost = hasHost_ && from.sin_addr.s_addr == host_.sin_addr.s_addr && from.sin_port == host_.sin_port;
      const auto ahead = static_cast<std::int32_t>(control.hostFrame - newest_);
      if (sameHost && ahead <= 0 && ahead > -kOldest) {
        inbox_.refuse("stale CIGI", "host frame " + std::to_string(control.hostFrame) + " after " + std::to_string(newest_));
        if (ahead == 0 && frame_.hostFrame == newest_) sendFrame();  // it may not have had the answer; where that is yet to come it will
        return;
      }
      host_ = from;
      hasHost_ = true;
      newest_ = control.hostFrame;
      frame_.mode = control.mode;
    }
    if (message.notServed > 0) inbox_.refuse("CIGI packets not served", std::to_string(message.notServed) + " in a message");
    std::vector<Command> commands;
    world_.translate(cigiChanges(message), commands, [this](const std::string& says) { inbox_.refuse("CIGI not possible", says); });
    for (Command& c : commands) inbox_.put({std::move(c), received, control.hostFrame});
    const bool operates = control.mode == CigiMode::Operate;
    if (!steps_) return inbox_.setRunning(operates);
    if (operates) {
      inbox_.step({1, control.hostFrame, 0});
      return;
    }
    const std::lock_guard lock(mutex_);
    frame_.hostFrame = newest_;
    sendFrame();
  }

  /// Under the lock.
  void sendFrame() {
    if (!hasHost_) return;
    frame_.timestampValid = true;
    frame_.timestamp_10us = static_cast<std::uint32_t>((monotonic_ns() - began_ns_) / 10000);
    const auto bytes = cigiStartOfFrame(frame_);
    sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&host_), sizeof host_);
  }

  std::string address_;
  bool steps_;
  CigiWorld world_;
  CommandInbox& inbox_;
  int socket_ = -1, wake_ = -1;
  std::mutex mutex_;  ///< host_, frame_
  sockaddr_in host_{};
  bool hasHost_ = false;
  CigiStartOfFrame frame_;
  std::uint32_t newest_ = 0;  ///< host frame
  std::int64_t began_ns_ = 0;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace

std::unique_ptr<CommandPort> openCigiPort(const std::string& address, bool steps, const Simulation& simulation, CommandInbox& inbox) {
  return std::make_unique<CigiPort>(address, steps, simulation, inbox);
}

}  // namespace pitviper
