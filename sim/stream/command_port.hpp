#pragma once
// A way by which commands come while a stream runs, and by which their senders hear of frames.
#include <memory>
#include <string>

#include "sim/frame/frame.hpp"
#include "sim/stream/command_inbox.hpp"

namespace pitviper {

struct Simulation;

class CommandPort {
 public:
  virtual ~CommandPort() = default;
  /// Where it listens, in words.
  virtual std::string place() const = 0;
  /// A frame is out, and a tick is over: its frames have been before. Neither waits; from whatever thread hands frames over.
  virtual void frameOut(const Frame&) {}
  virtual void tickDone(const TickDone&) {}
};

/// Lines of JSON, one command each, with the words that a scenario's `commands` have (sim/stream/command_models.hpp), over TCP ("7380": on this machine
/// alone; "0.0.0.0:7380") or a Unix socket of this user ("/tmp/pitviper.sock"). Besides: `{"step": n}`, `{"run": false}`, `{"end": true}`, `{"follow": true}`,
/// `{"pulse": true}`,
/// `{"status": true}`; `"id"` asks for an answer, `"host_frame"` is given back with the frame. Errors: UserError.
struct JsonPortWish {
  std::string address;
  bool steps = false;                   ///< the clock is a host's
  double stale_s = 1.0;                 ///< what is for a time so long ago is not carried out
  std::function<double()> now_s;        ///< simulation time of the newest tick
  std::function<std::string()> status;  ///< a JSON object
  std::function<void()> pulse;          ///< of a trigger line
};
std::unique_ptr<CommandPort> openJsonPort(const JsonPortWish& wish, const Simulation& simulation, CommandInbox& inbox);

/// CIGI 3.3 in datagrams of UDP ("8004", or "0.0.0.0:8004"), and Start of Frame back to where the last whole message came from. `steps`: each IG Control is
/// one. Entities are numbered from 1 in the order of the scenario, views (cameras) too, 0 being the first. Errors: UserError.
std::unique_ptr<CommandPort> openCigiPort(const std::string& address, bool steps, const Simulation& simulation, CommandInbox& inbox);

/// "7380", "127.0.0.1:7380": an IPv4 address and a port; without an address this machine's own. Errors: UserError.
struct SocketPlace {
  std::string host = "127.0.0.1";
  int port = 0;
};
SocketPlace readSocketPlace(const std::string& text, const std::string& option);

}  // namespace pitviper
