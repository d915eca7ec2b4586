#include "scenarios/commands/gige_reader.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/gige/gige_plan.hpp"
#include "sim/stream/gige/gige_registers.hpp"
#include "sim/stream/gige/wire.hpp"

namespace pitviper {
namespace {

constexpr int kAnswer_ms = 1000, kTries = 3, kLook_ms = 100;
constexpr std::int64_t kHeartbeat_ns = 1000000000;

}  // namespace

GigeReader::GigeReader(const std::string& address, int packetBytes) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(kGvcpPort);
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1) throw std::runtime_error(address + " is no IPv4 address");
  control_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  stream_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (connect(control_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) throw std::runtime_error("camera " + address + ": " + std::strerror(errno));
  sockaddr_in own{};
  socklen_t size = sizeof own;
  getsockname(control_, reinterpret_cast<sockaddr*>(&own), &size);
  own.sin_port = 0;
  // Pictures of a megabyte come within a millisecond: as much as the system allows.
  const int buffer = 16 << 20;
  if (setsockopt(stream_, SOL_SOCKET, SO_RCVBUFFORCE, &buffer, sizeof buffer) != 0) setsockopt(stream_, SOL_SOCKET, SO_RCVBUF, &buffer, sizeof buffer);
  if (bind(stream_, reinterpret_cast<sockaddr*>(&own), sizeof own) != 0) throw std::runtime_error(std::string("no port for pictures: ") + std::strerror(errno));
  getsockname(stream_, reinterpret_cast<sockaddr*>(&own), &size);
  const auto write = [&](std::uint32_t reg, std::uint32_t value) { ask(static_cast<std::uint16_t>(GvcpCommand::WriteRegisters), reg, value); };
  const auto read = [&](std::uint32_t reg) { return ask(static_cast<std::uint16_t>(GvcpCommand::ReadRegisters), reg, 0); };
  write(bootstrap::kPrivilege, kControl);
  write(feature::kFormat, static_cast<std::uint32_t>(GigeFormat::Mono16));
  write(bootstrap::kStreamPort, ntohs(own.sin_port));
  write(bootstrap::kPacketSize, static_cast<std::uint32_t>(packetBytes));
  write(bootstrap::kDestination, ntohl(own.sin_addr.s_addr));
  pixels_ = static_cast<std::size_t>(read(feature::kWidth)) * read(feature::kHeight);
  write(feature::kStart, 1);
}

GigeReader::~GigeReader() {
  try {
    ask(static_cast<std::uint16_t>(GvcpCommand::WriteRegisters), feature::kStop, 1);
    ask(static_cast<std::uint16_t>(GvcpCommand::WriteRegisters), bootstrap::kPrivilege, 0);
  } catch (const std::runtime_error&) {
  }
  close(control_);
  close(stream_);
}

std::uint32_t GigeReader::ask(std::uint16_t command, std::uint32_t address, std::uint32_t value) {
  const bool writes = command == static_cast<std::uint16_t>(GvcpCommand::WriteRegisters);
  std::array<std::uint8_t, 16> out{kGvcpKey, kGvcpWantsAnswer};
  const std::size_t bytes = kGvcpHead + (writes ? 8 : 4);
  putWire16(&out[2], command);
  putWire16(&out[4], static_cast<std::uint16_t>(bytes - kGvcpHead));
  if (++request_ == 0) request_ = 1;
  putWire16(&out[6], request_);
  putWire32(&out[8], address);
  putWire32(&out[12], value);
  for (int k = 0; k < kTries; ++k) {
    if (send(control_, out.data(), bytes, 0) < 0) throw std::runtime_error(std::string("camera: ") + std::strerror(errno));
    pollfd fd{control_, POLLIN, 0};
    std::array<std::uint8_t, 600> in;
    while (poll(&fd, 1, kAnswer_ms) > 0) {
      const ssize_t count = recv(control_, in.data(), in.size(), 0);
      if (count < static_cast<ssize_t>(kGvcpHead) + 4 || wire16(&in[6]) != request_) {
        if (count >= static_cast<ssize_t>(kGvcpHead) && wire16(&in[6]) == request_ && wire16(&in[0]) != 0)
          throw std::runtime_error("the camera refuses a register");
        continue;
      }
      if (wire16(&in[0]) != 0) throw std::runtime_error("the camera refuses register " + std::to_string(address));
      return wire32(&in[8]);
    }
  }
  throw std::runtime_error("the camera does not answer");
}

void GigeReader::read(const std::atomic<bool>& ends, const std::function<void(std::span<const std::uint16_t>, std::int64_t)>& picture) {
  std::vector<std::uint8_t> codes(2 * pixels_);
  std::vector<std::uint16_t> own(pixels_);
  std::array<std::uint8_t, 65536> in;
  std::uint16_t block = 0;
  std::size_t got = 0, full = 0;
  std::int64_t beat_ns = monotonic_ns();
  while (!ends) {
    pollfd fd{stream_, POLLIN, 0};
    if (monotonic_ns() - beat_ns > kHeartbeat_ns) {
      ask(static_cast<std::uint16_t>(GvcpCommand::ReadRegisters), bootstrap::kPrivilege, 0);
      beat_ns = monotonic_ns();
    }
    if (poll(&fd, 1, kLook_ms) <= 0) continue;
    for (ssize_t count; (count = recv(stream_, in.data(), in.size(), MSG_DONTWAIT)) > 0;) {
      constexpr std::size_t kHead = 8;
      constexpr int kLeader = 1, kTrailer = 2, kData = 3;
      if (count < static_cast<ssize_t>(kHead) || wire16(&in[0]) != 0) continue;
      const std::uint16_t id = wire16(&in[2]);
      const int kind = in[4] & 0x0f;
      const std::size_t number = wire32(&in[4]) & 0xffffffu;
      if (id != block) {
        // Blocks are 1 to 65535 and 1 again: those between two are gone whole.
        if (block != 0) incomplete_ += static_cast<std::uint64_t>((id + 65535 - block) % 65535 - 1) + (got != 0 ? 1 : 0);
        block = id, got = 0;
      }
      if (kind == kLeader) continue;
      if (kind == kData && number > 0) {
        const std::size_t bytes = static_cast<std::size_t>(count) - kHead;
        // All but the last have the same size: a picture's place follows from its number and the first one's.
        if (number == 1) full = bytes;
        const std::size_t at = (number - 1) * full;
        if (at + bytes > codes.size()) continue;
        std::memcpy(&codes[at], &in[kHead], bytes);
        got += bytes;
      }
      if (kind == kTrailer && got == codes.size()) {
        const std::int64_t received = monotonic_ns();
        std::memcpy(own.data(), codes.data(), codes.size());  // both least significant byte first
        picture(own, received);
        got = 0;
      }
    }
  }
}

}  // namespace pitviper
