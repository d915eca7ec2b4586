#pragma once
// The least client of a camera on the network that measures it: opens it, starts it, puts its pictures together.
#include <atomic>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace pitviper {

class GigeReader {
 public:
  /// Takes control of a camera and has it stream Mono16 in packets of so many bytes, headers of IP and UDP counted. Errors: std::runtime_error, one line.
  GigeReader(const std::string& address, int packetBytes);
  ~GigeReader();
  GigeReader(const GigeReader&) = delete;
  GigeReader& operator=(const GigeReader&) = delete;
  /// Until `ends`: each whole picture, most significant codes in the machine's own order; `received_ns`: monotonic, of its last packet.
  void read(const std::atomic<bool>& ends, const std::function<void(std::span<const std::uint16_t> codes, std::int64_t received_ns)>& picture);
  std::uint64_t incomplete() const { return incomplete_; }

 private:
  std::uint32_t ask(std::uint16_t command, std::uint32_t address, std::uint32_t value);
  int control_ = -1, stream_ = -1;
  std::uint16_t request_ = 0;
  std::uint64_t incomplete_ = 0;
  std::size_t pixels_ = 0;
};

}  // namespace pitviper
