#include "sim/stream/gige/gige_device.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>

#include "sim/stream/gige/genicam_xml.hpp"
#include "sim/stream/gige/gige_control.hpp"
#include "sim/stream/gige/gige_sockets.hpp"
#include "sim/stream/gige/gige_stream.hpp"

namespace pitviper {
namespace {

constexpr int kTick_ms = 100;  ///< heartbeats are counted in half seconds at least
constexpr int kAtOnce = 64;    ///< datagrams of one socket before the others have their turn
constexpr int kRequestBytes = 1 << 20;

/// What is wrong is said, what may be left out is filled in.
GigeSettings checked(GigeSettings s) {
  const auto fail = [&](const std::string& what) { throw std::runtime_error("camera '" + s.model + "' on the network: " + what); };
  if (s.width < 1 || s.height < 1 || static_cast<long long>(s.width) * s.height > kGigePixelsMost) fail("pictures have 1 to 2^26 pixels");
  if (s.bits < 8 || s.bits > 16) fail("codes have 8 to 16 bits");
  if (!(s.rate_hz >= 0) || !std::isfinite(s.rate_hz)) fail("the rate is not negative");
  if (s.line_Mbps < 1) fail("the line carries at least 1 Mbit/s");
  if (s.exposureMax_us <= 0) s.exposureMax_us = s.rate_hz > 0 ? 1e6 / s.rate_hz : 1e6;
  if (!std::isfinite(s.exposure_us) || !std::isfinite(s.gain_dB)) fail("exposure and gain are numbers");
  s.exposureMin_us = std::min(s.exposureMin_us, s.exposure_us);  // what it is set to is possible
  s.exposureMax_us = std::max(s.exposureMax_us, s.exposure_us);
  s.gainMin_dB = std::min(s.gainMin_dB, s.gain_dB);
  s.gainMax_dB = std::max(s.gainMax_dB, s.gain_dB);
  return s;
}

std::int64_t tai_ns() {
  timespec t{};
  clock_gettime(CLOCK_TAI, &t);
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}
std::int64_t steady_ms() { return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

class GigeDevice::Running final : private GigeActions {
 public:
  Running(const GigeSettings& settings, GigeCallbacks callbacks)
      : settings_(checked(settings)),
        callbacks_(std::move(callbacks)),
        sockets_(openGigeSockets(settings_.address)),
        end_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)),
        stream_(sockets_.pictures.number(), settings_, tally_, callbacks_.acquisition),
        control_(settings_, abilities(), GigeRegisters(settings_, sockets_.network, genicamXml(settings_, abilities())), *this, tally_) {
    if (end_.number() < 0) throw std::runtime_error("no event for a camera on the network");
    setsockopt(sockets_.control.number(), SOL_SOCKET, SO_RCVBUF, &kRequestBytes, sizeof kRequestBytes);
    thread_ = std::thread([this] { run(); });
  }
  ~Running() override {
    eventfd_write(end_.number(), 1);
    thread_.join();
  }

  void publish(std::shared_ptr<const GigePicture> picture) {
    const bool fits = picture && picture->width == settings_.width && picture->height == settings_.height &&
                      picture->codes.size() == static_cast<std::size_t>(settings_.width) * static_cast<std::size_t>(settings_.height);
    if (!fits) throw std::invalid_argument("a picture of another size than the camera '" + settings_.model + "'");
    stream_.publish(std::move(picture));
  }
  void triggerLine() { stream_.trigger(GigeTrigger::Line1); }
  bool isControlled() const { return isControlled_; }
  bool isStreaming() const { return stream_.isStreaming(); }
  GigeCounts counts() const { return tally_.now(); }

 private:
  GigeAbilities abilities() const { return {static_cast<bool>(callbacks_.exposure), static_cast<bool>(callbacks_.gain)}; }

  void configure(const GigePlan& plan) override { stream_.configure(plan); }
  void reopen() override { stream_.reopen(); }
  void acquire(bool isOn) override { stream_.acquire(isOn); }
  bool isAcquiring() const override { return stream_.isAcquiring(); }
  void trigger(GigeTrigger source) override {
    const bool isTaken = stream_.trigger(source);
    if (isTaken && callbacks_.softwareTrigger) callbacks_.softwareTrigger();
  }
  void resend(const GigeResend& request) override { stream_.resend(request); }
  void sendTestPacket(const GigePlan& plan) override { stream_.sendTestPacket(plan); }
  void setExposure(double exposure_us) override { callbacks_.exposure(exposure_us); }
  void setGain(double gain_dB) override { callbacks_.gain(gain_dB); }
  std::int64_t now_ns() override { return callbacks_.now_ns ? callbacks_.now_ns() : tai_ns(); }

  void run() {
    std::vector<pollfd> waits{{end_.number(), POLLIN, 0}, {sockets_.control.number(), POLLIN, 0}};
    for (const GigeSocket& s : sockets_.broadcasts) waits.push_back({s.number(), POLLIN, 0});
    while (true) {
      poll(waits.data(), waits.size(), control_.isControlled() ? kTick_ms : -1);
      if (waits[0].revents) return;
      for (std::size_t k = 1; k < waits.size(); ++k)
        if (waits[k].revents) serve(waits[k].fd, k > 1);
      control_.tick(steady_ms());
      isControlled_ = control_.isControlled();
    }
  }

  void serve(int socket, bool isBroadcast) {
    std::array<std::uint8_t, 2048> bytes;
    for (int k = 0; k < kAtOnce; ++k) {
      sockaddr_in from{};
      socklen_t size = sizeof from;
      // With MSG_TRUNC the size is that of the datagram, however much of it there was room for: a longer one is seen to be too long.
      const ssize_t n = recvfrom(socket, bytes.data(), bytes.size(), MSG_TRUNC, reinterpret_cast<sockaddr*>(&from), &size);
      if (n < 0) return;
      const std::size_t kept = std::min(static_cast<std::size_t>(n), bytes.size());
      control_.handle({bytes.data(), kept}, {ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)}, isBroadcast, steady_ms(), reply_);
      isControlled_ = control_.isControlled();  // before the client knows
      // Whether it arrives is the client's to find out: it asks again.
      if (reply_.size) (void)!sendto(sockets_.control.number(), reply_.bytes.data(), reply_.size, MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&from), size);
    }
  }

  const GigeSettings settings_;
  const GigeCallbacks callbacks_;
  const GigeSockets sockets_;
  const GigeSocket end_;
  GigeTally tally_;
  GigeStream stream_;
  std::atomic<bool> isControlled_{false};
  // Of the thread alone.
  GigeControl control_;
  GigeReply reply_;
  std::thread thread_;
};

GigeDevice::GigeDevice(const GigeSettings& settings, GigeCallbacks callbacks) : running_(std::make_unique<Running>(settings, std::move(callbacks))) {}
GigeDevice::~GigeDevice() = default;

void GigeDevice::publish(std::shared_ptr<const GigePicture> picture) { running_->publish(std::move(picture)); }
void GigeDevice::trigger() { running_->triggerLine(); }
bool GigeDevice::isControlled() const { return running_->isControlled(); }
bool GigeDevice::isStreaming() const { return running_->isStreaming(); }
GigeCounts GigeDevice::counts() const { return running_->counts(); }

}  // namespace pitviper
