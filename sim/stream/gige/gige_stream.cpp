#include "sim/stream/gige/gige_stream.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <vector>

namespace pitviper {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kMailbox = 3;   ///< pictures; more would only be older when they arrive
constexpr std::size_t kMostResends = 64;  ///< requests that wait
/// Pictures kept for requests to send parts again. Aravis gives a picture up after 200 ms, which are 12 pictures at 60 Hz.
constexpr std::size_t kKeptPictures = 16, kKeptBytes = 128u << 20;
constexpr std::uint64_t kResendsOfPicture = 4;  ///< times its packets; more is no repair
/// Bytes that leave at once. A socket with the kernel's default buffer of 208 kB holds two bursts with all that the kernel adds to packets.
constexpr std::size_t kBurst = 60'000;
/// The first picture of a stream takes so long where the line allows less: Aravis enlarges its buffer only when it sees the first packet.
constexpr double kFirstPicture_ns = 5e6;
/// A picture whose packets the socket does not take for so long is given up. A gigabit line carries 12 MB in that time.
constexpr auto kPatience = 100ms;

sockaddr_in toSocket(const GigePlan& plan) {
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(plan.port);
  to.sin_addr.s_addr = htonl(plan.address);
  return to;
}

}  // namespace

/// Packets for one system call.
class GigeStream::Batch {
 public:
  static constexpr unsigned kMost = 64;
  explicit Batch(const GigePlan& plan) : to_(toSocket(plan)) {}
  bool isFull() const { return count_ == kMost || bytes_ >= kBurst; }
  std::size_t bytes() const { return bytes_; }
  void add(const GvspBlock::Packet& packet) {
    packets_[count_] = packet;
    parts_[count_][0] = {packets_[count_].head.data(), packet.headBytes};
    parts_[count_][1] = {const_cast<std::uint8_t*>(packet.data.data()), packet.data.size()};
    mmsghdr& m = messages_[count_];
    m = {};
    m.msg_hdr.msg_name = &to_;
    m.msg_hdr.msg_namelen = sizeof to_;
    m.msg_hdr.msg_iov = parts_[count_].data();
    m.msg_hdr.msg_iovlen = packet.data.empty() ? 1 : 2;
    bytes_ += GvspBlock::kHeadersOfIp + packet.headBytes + packet.data.size();
    ++count_;
  }
  /// Sends all; false where the socket refuses for too long. `sent` counts what went out.
  bool send(const GigeStream& stream, std::uint64_t& sent) {
    const auto until = Clock::now() + kPatience;
    unsigned done = 0;
    while (done < count_) {
      const int n = sendmmsg(stream.socket_, &messages_[done], count_ - done, MSG_DONTWAIT);
      if (n > 0) done += static_cast<unsigned>(n);
      else if (errno == EINTR) continue;
      else if ((errno != EAGAIN && errno != ENOBUFS) || !stream.waitForSocket(until)) break;
    }
    sent += done;
    const bool isAll = done == count_;
    count_ = 0;
    bytes_ = 0;
    return isAll;
  }

 private:
  sockaddr_in to_;
  unsigned count_ = 0;
  std::size_t bytes_ = 0;
  std::array<GvspBlock::Packet, kMost> packets_;
  std::array<std::array<iovec, 2>, kMost> parts_;
  std::array<mmsghdr, kMost> messages_;
};

GigeStream::GigeStream(int socket, const GigeSettings& settings, GigeTally& tally, std::function<void(bool)> acquisition)
    : socket_(socket), bits_(settings.bits), byte_ns_(8e3 / settings.line_Mbps), tally_(tally), acquisition_(std::move(acquisition)), thread_([this] {
        run();
      }) {}

GigeStream::~GigeStream() {
  {
    const std::lock_guard lock(mutex_);
    isEnding_ = true;
    ++generation_;
  }
  wake_.notify_all();
  thread_.join();
}

/// With the mutex held.
void GigeStream::giveUpWaiting() {
  tally_.add(&GigeCounts::cut, mailbox_.size());
  mailbox_.clear();
}

void GigeStream::configure(const GigePlan& plan) {
  const int discover = plan.isFragmentable ? IP_PMTUDISC_DONT : IP_PMTUDISC_PROBE;
  setsockopt(socket_, IPPROTO_IP, IP_MTU_DISCOVER, &discover, sizeof discover);
  const std::lock_guard lock(mutex_);
  if (!plan.isTriggered || plan.source != plan_.source) hasTrigger_ = false;
  if (plan.address != plan_.address || plan.port != plan_.port) {
    ++generation_;
    giveUpWaiting();
  }
  plan_ = plan;
  hasDestination_ = plan.hasDestination();
}

void GigeStream::reopen() {
  const std::lock_guard lock(mutex_);
  ++generation_;
  ++openings_;
  giveUpWaiting();
  resends_.clear();
  hasResends_ = false;
}

void GigeStream::acquire(bool isOn) {
  {
    const std::lock_guard lock(mutex_);
    if (isAcquiring_ == isOn) return;
    isAcquiring_ = isOn;
    picturesLeft_ = plan_.pictures;
    hasTrigger_ = false;
    giveUpWaiting();
    if (!isOn) ++generation_;
  }
  if (acquisition_) acquisition_(isOn);
}

bool GigeStream::trigger(GigeTrigger source) {
  const std::lock_guard lock(mutex_);
  if (!isAcquiring_ || !plan_.isTriggered || plan_.source != source) return false;
  const bool isMissed = hasTrigger_;
  tally_.add(isMissed ? &GigeCounts::triggersMissed : &GigeCounts::triggers);
  hasTrigger_ = true;
  return !isMissed;
}

void GigeStream::publish(std::shared_ptr<const GigePicture> picture) {
  {
    const std::lock_guard lock(mutex_);
    if (!isStreaming()) return tally_.add(&GigeCounts::withoutConsumer);
    if (plan_.isTriggered) {
      if (!hasTrigger_) return tally_.add(&GigeCounts::withoutTrigger);
      hasTrigger_ = false;
    }
    if (mailbox_.size() == kMailbox) {
      mailbox_.pop_front();
      tally_.add(&GigeCounts::skipped);
    }
    mailbox_.push_back(std::move(picture));
  }
  wake_.notify_one();
}

void GigeStream::resend(const GigeResend& request) {
  {
    const std::lock_guard lock(mutex_);
    if (resends_.size() == kMostResends) return tally_.add(&GigeCounts::resendsNotServed);
    resends_.push_back(request);
    hasResends_ = true;
  }
  wake_.notify_one();
}

void GigeStream::sendTestPacket(const GigePlan& plan) {
  const std::vector<std::uint8_t> zeros(plan.packetBytes - GvspBlock::kHeadersOfIp);
  const sockaddr_in to = toSocket(plan);
  const auto sent = sendto(socket_, zeros.data(), zeros.size(), MSG_DONTWAIT, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  if (sent > 0) tally_.add(&GigeCounts::testPackets);
}

void GigeStream::run() {
  prctl(PR_SET_TIMERSLACK, 1);  // packet delays are shorter than the 50 us that a sleep may else be late
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, [&] { return isEnding_ || hasResends_ || !mailbox_.empty(); });
    if (isEnding_) return;
    if (hasResends_) {
      lock.unlock();
      serveResends();
      lock.lock();
      continue;
    }
    const std::shared_ptr<const GigePicture> picture = std::move(mailbox_.front());
    mailbox_.pop_front();
    const GigePlan plan = plan_;
    const std::uint64_t generation = generation_;
    lock.unlock();
    send(*picture, plan, generation);
    lock.lock();
    const bool isLast = isAcquiring_ && generation == generation_ && picturesLeft_ && --picturesLeft_ == 0;
    if (!isLast) continue;
    lock.unlock();
    acquire(false);
    lock.lock();
  }
}

void GigeStream::send(const GigePicture& picture, const GigePlan& plan, std::uint64_t generation) {
  if (const std::uint64_t openings = openings_; openings != openingsSeen_) {
    openingsSeen_ = openings;
    sent_.clear();
    id_ = 0;
  }
  const std::uint64_t id = nextId(plan.hasWideIds);
  GvspBlock& block = freshBlock();
  block.compose(picture, plan, bits_, id);

  const double byte_ns = id == 1 ? std::max(byte_ns_, kFirstPicture_ns / static_cast<double>(block.bytes())) : byte_ns_;
  Batch batch(plan);
  std::uint64_t packets = 0;
  bool isGood = true;
  auto due = Clock::now();
  for (std::uint32_t k = 0; k < block.packets() && isGood; ++k) {
    batch.add(block.packet(k));
    const bool isLast = k + 1 == block.packets();
    if (!plan.delay_ns && !batch.isFull() && !isLast) continue;
    const double line_ns = byte_ns * static_cast<double>(batch.bytes());
    isGood = generation_ == generation && batch.send(*this, packets);
    if (hasResends_) serveResends();
    if (isLast) break;
    if (plan.delay_ns) due = std::max(due, Clock::now());  // the least between two packets; behind the line's time a late sender may catch up
    due += std::chrono::nanoseconds(std::max(static_cast<std::int64_t>(line_ns), static_cast<std::int64_t>(plan.delay_ns)));
    std::this_thread::sleep_until(due);
  }
  tally_.add(&GigeCounts::packets, packets);
  tally_.add(isGood ? &GigeCounts::pictures : &GigeCounts::cut);
}

void GigeStream::serveResends() {
  while (true) {
    GigeResend request;
    {
      const std::lock_guard lock(mutex_);
      hasResends_ = !resends_.empty();
      if (isEnding_ || resends_.empty()) return;
      request = resends_.front();
      resends_.pop_front();
    }
    serve(request);
  }
}

void GigeStream::serve(const GigeResend& request) {
  GigePlan plan;
  {
    const std::lock_guard lock(mutex_);
    plan = plan_;
  }
  if (!plan.hasDestination()) return tally_.add(&GigeCounts::resendsNotServed);
  Batch batch(plan);
  std::uint64_t sent = 0;
  const auto found = std::ranges::find_if(sent_, [&](const auto& b) { return b->id() == request.block && b->plan().hasWideIds == request.hasWideIds; });
  const bool isThere = found != sent_.end() && request.first < (*found)->packets() && openings_ == openingsSeen_;
  if (!isThere) {
    tally_.add(&GigeCounts::resendsNotServed);
    batch.add(GvspBlock::unavailable(request.block, request.first, request.hasWideIds));
    batch.send(*this, sent);
    return;
  }
  GvspBlock& block = **found;
  const std::uint32_t last = std::min(request.last, block.packets() - 1);
  if (block.resent + (last - request.first + 1) > kResendsOfPicture * block.packets()) return tally_.add(&GigeCounts::resendsNotServed);
  bool isGood = true;
  for (std::uint32_t k = request.first; k <= last && isGood; ++k) {
    batch.add(block.packet(k));
    if (batch.isFull() || k == last) isGood = !isEnding_ && batch.send(*this, sent);
  }
  block.resent += sent;
  tally_.add(&GigeCounts::resent, sent);
}

bool GigeStream::waitForSocket(Clock::time_point until) const {
  if (isEnding_ || Clock::now() >= until) return false;
  pollfd p{socket_, POLLOUT, 0};
  if (poll(&p, 1, 1) > 0) std::this_thread::sleep_for(50us);  // writable by its own count, yet the card's queue may be full
  return true;
}

std::uint64_t GigeStream::nextId(bool hasWideIds) {
  ++id_;
  if (!hasWideIds && id_ > 0xFFFF) id_ = 1;  // never 0: the protocol's word for no block
  return id_;
}

/// A block for the next picture, behind those sent before; the oldest is used again once there are enough.
GvspBlock& GigeStream::freshBlock() {
  std::size_t bytes = 0;
  for (const auto& b : sent_) bytes += b->bytes();
  std::unique_ptr<GvspBlock> block;
  while (!sent_.empty() && (sent_.size() >= kKeptPictures || bytes > kKeptBytes)) {
    bytes -= sent_.front()->bytes();
    block = std::move(sent_.front());
    sent_.pop_front();
  }
  if (!block) block = std::make_unique<GvspBlock>();
  sent_.push_back(std::move(block));
  return *sent_.back();
}

}  // namespace pitviper
