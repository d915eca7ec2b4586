#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <list>
#include <set>
#include <thread>

#include "sim/model/simulation.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/stream/command_port.hpp"
#include "sim/stream/json_value.hpp"

namespace pitviper {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kLongestLine = 64 << 10, kMostClients = 64, kMostWaiting = 4 << 20, kMostTickets = 1024;

struct Client {
  int socket = -1;
  std::uint64_t number = 0;
  std::string in, out;  ///< what is no whole line yet; what the socket did not take
  long long lines = 0;
  std::uint64_t hostFrame = 0;  ///< newest
  bool follows = false, gone = false;
  std::vector<std::uint64_t> tickets;  ///< of steps that it waits for
};

/// What points the camera, where something does.
void addGimbal(Json& j, const Frame& frame) {
  constexpr std::string_view kPrefix = "pitviper.gimbal.";
  for (const Attribute& a : frame.attributes)
    if (a.name.starts_with(kPrefix)) std::visit([&](const auto& v) { j["gimbal"][a.name.substr(kPrefix.size())] = v; }, a.value);
}

class JsonPort final : public CommandPort {
 public:
  JsonPort(const JsonPortWish& wish, const Simulation& simulation, CommandInbox& inbox) : wish_(wish), simulation_(simulation), inbox_(inbox) {
    listen();
    wake_ = eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
    thread_ = std::thread([this] { serve(); });
  }
  ~JsonPort() override {
    ends_ = true;
    eventfd_write(wake_, 1);
    thread_.join();
    for (Client& c : clients_) close(c.socket);
    close(listener_);
    close(wake_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  std::string place() const override { return "JSON lines at " + wish_.address; }

  void frameOut(const Frame& frame) override {
    const std::lock_guard lock(mutex_);
    if (!frame.kind.empty() || std::none_of(clients_.begin(), clients_.end(), [](const Client& c) { return c.follows || !c.tickets.empty(); })) return;
    Json j = {{"camera", frame.camera}};
    if (const auto& s = frame.stamp) {
      if (!std::isnan(s->column_px)) j["target"] = {s->column_px, s->row_px};
      j["geodetic_deg_deg_m"] = {s->latitude_deg, s->longitude_deg, s->height_m};
      j["sight_ecef"] = {s->sight_ecef.x, s->sight_ecef.y, s->sight_ecef.z};
      j["exposure_ns"] = {s->exposureStart_ns, s->exposureEnd_ns};
      j["accuracy"] = s->accuracy;
      j["predicted_error"] = s->predictedError;
      j["pose_age_ns"] = s->poseAge_ns;
      addGimbal(j, frame);
      if (s->isLate) j["late"] = true;
      if (s->isRepeated) j["repeated"] = true;
      if (s->isOutsideLimits) j["outside_limits"] = true;
    }
    cameras_.emplace_back(frame.stamp ? frame.stamp->sequence : 0, std::move(j));
  }

  void tickDone(const TickDone& tick) override {
    const std::lock_guard lock(mutex_);
    std::string line;
    for (Client& c : clients_) {
      const auto waits = tick.ticket ? std::find(c.tickets.begin(), c.tickets.end(), *tick.ticket) : c.tickets.end();
      const bool own = waits != c.tickets.end();
      if (own) c.tickets.erase(waits);
      if (c.gone || (!own && !c.follows)) continue;
      if (line.empty()) {
        Json j = {{"frame", tick.frame}, {"sequence", tick.sequence}, {"time_s", tick.time_s}};
        if (tick.hostFrame) j["host_frame"] = tick.hostFrame;
        j["cameras"] = Json::array();
        for (const auto& [sequence, camera] : cameras_)
          if (sequence == tick.sequence) j["cameras"].push_back(camera);
        if (tick.dropped > 0) j["dropped"] = tick.dropped;
        line = j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
      }
      send(c, line);
    }
    std::erase_if(cameras_, [&](const auto& c) { return c.first <= tick.sequence; });
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw UserError({"--commands " + wish_.address, 0, 0, -1}, what + " (" + std::strerror(errno) + ")", "a free port, or a path for a socket",
                    "choose another, or end what has it");
  }

  void listen() {
    if (wish_.address.find('/') != std::string::npos) {
      sockaddr_un at{};
      at.sun_family = AF_UNIX;
      if (wish_.address.size() >= sizeof at.sun_path)
        throw UserError({"--commands " + wish_.address, 0, 0, -1}, "the path is too long", "up to 107 letters", "choose a shorter one");
      std::memcpy(at.sun_path, wish_.address.c_str(), wish_.address.size());
      listener_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
      // One that nobody listens at any more is in the way.
      struct stat status {};
      if (lstat(wish_.address.c_str(), &status) == 0) {
        const int probe = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const bool dead = S_ISSOCK(status.st_mode) && connect(probe, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0 && errno == ECONNREFUSED;
        close(probe);
        if (dead) unlink(wish_.address.c_str());
      }
      const mode_t before = umask(0177);
      const int bound = bind(listener_, reinterpret_cast<sockaddr*>(&at), sizeof at);
      umask(before);
      if (bound != 0) fail("the socket cannot be made");
      path_ = wish_.address;
    } else {
      const SocketPlace place = readSocketPlace(wish_.address, "--commands");
      sockaddr_in at{};
      at.sin_family = AF_INET;
      at.sin_port = htons(static_cast<std::uint16_t>(place.port));
      inet_pton(AF_INET, place.host.c_str(), &at.sin_addr);
      listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
      const int yes = 1;
      setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
      if (bind(listener_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) fail("it cannot be listened at");
    }
    if (::listen(listener_, 16) != 0) fail("it cannot be listened at");
  }

  void serve() {
    std::vector<pollfd> fds;
    while (!ends_) {
      fds = {{wake_, POLLIN, 0}, {listener_, POLLIN, 0}};
      std::vector<Client*> order;
      {
        const std::lock_guard lock(mutex_);
        for (auto c = clients_.begin(); c != clients_.end();) {
          if (c->gone) {
            close(c->socket);
            c = clients_.erase(c);
            continue;
          }
          fds.push_back({c->socket, static_cast<short>(POLLIN | (c->out.empty() ? 0 : POLLOUT)), 0});
          order.push_back(&*c);
          ++c;
        }
      }
      if (poll(fds.data(), fds.size(), -1) < 0) continue;
      eventfd_t ignored = 0;
      if (fds[0].revents) eventfd_read(wake_, &ignored);
      for (std::size_t k = 2; k < fds.size(); ++k) {
        Client& c = *order[k - 2];
        if (fds[k].revents & POLLOUT) flush(c);
        if (fds[k].revents & (POLLIN | POLLHUP | POLLERR)) receive(c);
      }
      if (fds[1].revents) accept();
    }
  }

  void accept() {
    const int s = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (s < 0) return;
    const std::lock_guard lock(mutex_);
    if (clients_.size() >= kMostClients) {
      inbox_.refuse("too many connections", "more than " + std::to_string(kMostClients));
      close(s);
      return;
    }
    const int yes = 1;
    setsockopt(s, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);  // of a Unix socket it is refused, and not needed
    clients_.push_back({});
    clients_.back().socket = s;
    clients_.back().number = ++connections_;
  }

  /// One buffer a turn: who sends without end waits for the others as they for it.
  void receive(Client& c) {
    char buffer[16 << 10];
    const ssize_t count = recv(c.socket, buffer, sizeof buffer, 0);
    if (count < 0 && (errno == EINTR || errno == EAGAIN || errno == EWOULDBLOCK)) return;
    if (count <= 0) return hangUp(c);
    c.in.append(buffer, static_cast<std::size_t>(count));
    std::size_t from = 0;
    for (std::size_t end = 0; (end = c.in.find('\n', from)) != std::string::npos && !ends_; from = end + 1) {
      handle(c, std::string_view(c.in).substr(from, end - from));
      const std::lock_guard lock(mutex_);
      if (c.gone) return;
    }
    c.in.erase(0, from);
    if (c.in.size() <= kLongestLine) return;
    inbox_.refuse("too long a line", "more than " + std::to_string(kLongestLine) + " bytes; the connection is closed");
    hangUp(c);
  }

  void hangUp(Client& c) {
    const std::lock_guard lock(mutex_);
    c.gone = true;
  }

  void answer(Client& c, const Json& j) {
    const std::lock_guard lock(mutex_);
    send(c, j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
  }

  /// Under the lock.
  void send(Client& c, const std::string& line) {
    if (c.gone) return;
    if (c.out.empty()) {
      const ssize_t count = ::send(c.socket, line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
      if (count == static_cast<ssize_t>(line.size())) return;
      if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) {
        c.gone = true;
        eventfd_write(wake_, 1);
        return;
      }
      c.out.append(line, static_cast<std::size_t>(std::max<ssize_t>(0, count)));
    } else {
      c.out += line;
    }
    if (c.out.size() > kMostWaiting) {
      c.gone = true;
      inbox_.refuse("a client that does not read", "its connection is closed");
    }
    eventfd_write(wake_, 1);
  }

  void flush(Client& c) {
    const std::lock_guard lock(mutex_);
    const ssize_t count = ::send(c.socket, c.out.data(), c.out.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count > 0) c.out.erase(0, static_cast<std::size_t>(count));
    else if (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR) c.gone = true;
  }

  void handle(Client& c, std::string_view text) {
    const std::int64_t received = monotonic_ns();
    const Location where{"commands, connection " + std::to_string(c.number), static_cast<int>(std::min<long long>(++c.lines, 1000000000)), 1, -1};
    if (text.find_first_not_of(" \t\r") == std::string_view::npos) return;
    Json id;
    try {
      if (text.size() > kLongestLine) throw UserError(where, "a line of more than 64 kB", "a command a line", "split it");
      const Json j = parsed(text, where);
      if (j.contains("id")) id = j["id"];
      handle(c, j, where, received);
      if (!id.is_null()) answer(c, {{"id", id}, {"ok", true}});
    } catch (const UserError& e) {
      inbox_.refuse(isStale_ ? "stale" : "malformed lines", e.what());
      isStale_ = false;
      Json reply = {{"error", readable(e.what())}};
      if (!id.is_null()) reply["id"] = id;
      answer(c, reply);
    } catch (const std::exception& e) {
      inbox_.refuse("malformed lines", e.what());
      answer(c, {{"error", readable(e.what())}});
    }
  }

  static Json parsed(std::string_view text, const Location& where) {
    // Values are copied, printed and read by functions that call themselves.
    constexpr int kDeepest = 64;
    std::vector<std::set<std::string>> keys;
    std::string twice;
    bool tooDeep = false;
    const auto look = [&](int depth, Json::parse_event_t event, Json& value) {
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      else if (event == Json::parse_event_t::object_end && !keys.empty()) keys.pop_back();
      else if (event == Json::parse_event_t::key && !keys.empty() && !keys.back().insert(value.get<std::string>()).second) twice = value.get<std::string>();
      return !(tooDeep |= depth > kDeepest);
    };
    Json j = Json::parse(text, look, false);
    if (tooDeep)
      throw UserError(where, "lists and objects in each other, more than " + std::to_string(kDeepest) + " deep", "one object with its values",
                      "send a flat one");
    if (j.is_discarded() || !j.is_object())
      throw UserError(where, "not a JSON object", R"(a line such as {"command": "light", "light": "flare", "level": 0})", "send one object a line");
    if (!twice.empty()) throw UserError(where, "key '" + twice + "' stands there twice", "each key once", "remove one");
    return j;
  }

  static bool flag(const Json& j, const char* key, const Location& where) {
    if (!j[key].is_boolean())
      throw UserError(where, std::string("'") + key + "' is not true or false", "true or false", std::string("write {\"") + key + "\": true}");
    return j[key].get<bool>();
  }

  /// All of it is read before any of it is carried out.
  void handle(Client& c, Json j, const Location& where, std::int64_t received) {
    j.erase("id");
    std::uint64_t hostFrame = 0, ticks = 0;
    if (j.contains("host_frame")) {
      if (!j["host_frame"].is_number_unsigned()) throw UserError(where, "'host_frame' is no whole number", "a number that rises", "count your frames from 1");
      hostFrame = j["host_frame"].get<std::uint64_t>();
      j.erase("host_frame");
      if (hostFrame < c.hostFrame) {
        isStale_ = true;
        throw UserError(where, "host frame " + std::to_string(hostFrame) + " after " + std::to_string(c.hostFrame), "numbers that rise",
                        "send commands in their order");
      }
    }
    if (j.contains("step")) {
      constexpr std::uint64_t kMostTicks = 1000000000;
      if (!wish_.steps)
        throw UserError(where, "a step of a clock that nobody holds", "'--clock lockstep'",
                        "start the stream with it, or ask for lines with {\"follow\": true}");
      if (!j["step"].is_number_unsigned() || j["step"].get<std::uint64_t>() < 1 || j["step"].get<std::uint64_t>() > kMostTicks)
        throw UserError(where, "'step' is no number of ticks", "a whole number from 1", R"(write {"step": 1})");
      ticks = j["step"].get<std::uint64_t>();
      j.erase("step");
      const std::lock_guard lock(mutex_);
      if (c.tickets.size() >= kMostTickets)
        throw UserError(where, "too many steps that wait", "at most " + std::to_string(kMostTickets), "read the frames' lines");
    }
    std::vector<std::pair<std::string, bool>> flags;
    for (const char* key : {"run", "follow", "pulse", "status", "end"})
      if (j.contains(key)) {
        flags.emplace_back(key, flag(j, key, where));
        j.erase(key);
      }
    std::optional<Command> command;
    if (!j.empty()) {
      command = readCommand(valueOf(j, where), simulation_, NAN);
      command->words.clear();  // nobody compares those of a stream
      if (wish_.now_s && command->at_s < wish_.now_s() - wish_.stale_s) {
        isStale_ = true;
        throw UserError(where, "a command for " + std::to_string(command->at_s) + " s, and it is " + std::to_string(wish_.now_s()) + " s",
                        "at most " + std::to_string(wish_.stale_s) + " s ago", "send it sooner, or without 'at'");
      }
    }
    if (hostFrame) c.hostFrame = hostFrame;
    if (command) inbox_.put({std::move(*command), received, hostFrame});
    if (ticks > 0) {
      const Step step{ticks, hostFrame, ++tickets_};
      {
        const std::lock_guard lock(mutex_);
        c.tickets.push_back(step.ticket);
      }
      if (!inbox_.step(step)) {
        const std::lock_guard lock(mutex_);
        c.tickets.pop_back();
      }
    }
    for (const auto& [word, on] : flags) {
      if (word == "run") inbox_.setRunning(on);
      else if (word == "end" && on) inbox_.endAfterSteps();
      else if (word == "pulse" && on && wish_.pulse) wish_.pulse();
      else if (word == "status" && on) answer(c, wish_.status ? Json::parse(wish_.status(), nullptr, false) : Json::object());
      else if (word == "follow") {
        const std::lock_guard lock(mutex_);
        c.follows = on;
      }
    }
  }

  JsonPortWish wish_;
  const Simulation& simulation_;
  CommandInbox& inbox_;
  int listener_ = -1, wake_ = -1;
  std::string path_;
  std::mutex mutex_;  ///< clients_, cameras_
  std::list<Client> clients_;
  std::vector<std::pair<std::uint64_t, Json>> cameras_;  ///< of ticks that are not over, by their numbers
  std::uint64_t connections_ = 0, tickets_ = 0;
  bool isStale_ = false;
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace

SocketPlace readSocketPlace(const std::string& text, const std::string& option) {
  SocketPlace place;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  if (colon != std::string::npos) place.host = text.substr(0, colon);
  in_addr ignored{};
  const bool digits = !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (!digits || inet_pton(AF_INET, place.host.c_str(), &ignored) != 1 || (place.port = std::stoi(port)) < 1 || place.port > 65535)
    throw UserError({option + " " + text, 0, 0, -1}, "no place to listen at", "a port from 1 to 65535, or an IPv4 address and a port, 127.0.0.1:7380",
                    "write " + option + " 7380");
  return place;
}

std::unique_ptr<CommandPort> openJsonPort(const JsonPortWish& wish, const Simulation& simulation, CommandInbox& inbox) {
  return std::make_unique<JsonPort>(wish, simulation, inbox);
}

}  // namespace pitviper
