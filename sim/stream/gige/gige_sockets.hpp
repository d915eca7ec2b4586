#pragma once
// Sockets of a camera: one at its own address for requests, some at broadcast addresses for those who look for cameras, one that pictures leave by.
#include <string>
#include <vector>

#include "sim/stream/gige/gige_registers.hpp"

namespace pitviper {

/// A file descriptor that closes itself.
class GigeSocket {
 public:
  explicit GigeSocket(int number = -1) : number_(number) {}
  GigeSocket(GigeSocket&& other) noexcept : number_(other.number_) { other.number_ = -1; }
  GigeSocket& operator=(GigeSocket&& other) noexcept;
  ~GigeSocket();
  int number() const { return number_; }

 private:
  int number_;
};

struct GigeSockets {
  GigeNetwork network;
  GigeSocket control;
  GigeSocket pictures;
  std::vector<GigeSocket> broadcasts;  ///< none where they could not be had: then cameras answer only who knows their address
};

/// Errors: std::runtime_error with one line: no IPv4 address, not one of this machine, port in use.
GigeSockets openGigeSockets(const std::string& address);

}  // namespace pitviper
