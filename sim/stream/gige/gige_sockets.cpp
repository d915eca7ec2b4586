#include "sim/stream/gige/gige_sockets.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace pitviper {
namespace {

/// Room for several pictures: a burst then waits in the kernel, not in the sender. The kernel grants what net.core.wmem_max allows.
constexpr int kSendBytes = 8 << 20;
/// Packets are as large as the network card takes. Loopback takes 64 kB; there a packet with all that the kernel adds to it is to fit into the 8 kB pieces of
/// its memory: the next larger ones have 16 kB, and clients' buffers are measured in them.
constexpr std::uint32_t kJumbo = 9000, kOfLoopback = 7800;

sockaddr_in at(std::uint32_t address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(address);
  result.sin_port = htons(port);
  return result;
}

GigeSocket udpSocket() {
  GigeSocket s(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (s.number() < 0) throw std::runtime_error(std::string("no socket for a camera on the network: ") + std::strerror(errno));
  return s;
}

bool isBoundTo(const GigeSocket& s, std::uint32_t address, std::uint16_t port) {
  const sockaddr_in place = at(address, port);
  return bind(s.number(), reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0;
}

struct Interface {
  std::uint32_t mask = 0xFFFFFFFFu;
  std::uint32_t packetBytes = 1500;
};

/// The network card of an address: the one that has it, or the loopback, which has all of 127.
Interface interfaceOf(std::uint32_t address) {
  Interface found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list)) return found;
  const std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> owner(list, freeifaddrs);
  for (const ifaddrs* i = list; i; i = i->ifa_next) {
    if (!i->ifa_addr || !i->ifa_netmask || i->ifa_addr->sa_family != AF_INET) continue;
    const std::uint32_t own = ntohl(reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr.s_addr);
    const std::uint32_t mask = ntohl(reinterpret_cast<const sockaddr_in*>(i->ifa_netmask)->sin_addr.s_addr);
    if (own != address && !(i->ifa_flags & IFF_LOOPBACK && (own & mask) == (address & mask))) continue;
    found.mask = mask;
    ifreq request{};
    std::strncpy(request.ifr_name, i->ifa_name, sizeof request.ifr_name - 1);
    const GigeSocket any = udpSocket();
    if (ioctl(any.number(), SIOCGIFMTU, &request) == 0) found.packetBytes = static_cast<std::uint32_t>(request.ifr_mtu);
    if (found.packetBytes > kJumbo) found.packetBytes = kOfLoopback;
    if (own == address) break;
  }
  return found;
}

}  // namespace

GigeSocket& GigeSocket::operator=(GigeSocket&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}
GigeSocket::~GigeSocket() {
  if (number_ >= 0) close(number_);
}

GigeSockets openGigeSockets(const std::string& address) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) throw std::runtime_error("'" + address + "' is no IPv4 address");
  const std::uint32_t own = ntohl(parsed.s_addr);
  if (!own || own >= 0xE0000000u) throw std::runtime_error("a camera needs an address of its own, which " + address + " cannot be");

  GigeSockets sockets;
  sockets.control = udpSocket();
  if (!isBoundTo(sockets.control, own, kGvcpPort)) {
    if (errno == EADDRNOTAVAIL) throw std::runtime_error(address + " is not an address of this machine");
    if (errno == EADDRINUSE)
      throw std::runtime_error("port " + std::to_string(kGvcpPort) + " of " + address +
                               " is in use: another camera has this address; give each camera its own");
    throw std::runtime_error("port " + std::to_string(kGvcpPort) + " of " + address + ": " + std::strerror(errno));
  }
  sockets.pictures = udpSocket();
  if (!isBoundTo(sockets.pictures, own, 0)) throw std::runtime_error("no port of " + address + " for pictures: " + std::strerror(errno));
  setsockopt(sockets.pictures.number(), SOL_SOCKET, SO_SNDBUF, &kSendBytes, sizeof kSendBytes);
  sockaddr_in source{};
  socklen_t size = sizeof source;
  getsockname(sockets.pictures.number(), reinterpret_cast<sockaddr*>(&source), &size);

  const Interface card = interfaceOf(own);
  sockets.network = {own, card.mask, card.packetBytes, ntohs(source.sin_port)};
  for (const std::uint32_t broadcast : {0xFFFFFFFFu, own | ~card.mask}) {
    if (broadcast == own) continue;  // a network of one
    GigeSocket s = udpSocket();
    const int yes = 1;
    setsockopt(s.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);  // all cameras of the machine hear it
    if (isBoundTo(s, broadcast, kGvcpPort)) sockets.broadcasts.push_back(std::move(s));
  }
  return sockets;
}

}  // namespace pitviper
