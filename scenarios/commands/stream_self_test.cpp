#include "scenarios/commands/stream_self_test.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <thread>

#include "scenarios/commands/gige_reader.hpp"
#include "scenarios/commands/stream_report.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/clock/durations.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_port.hpp"
#include "sim/stream/pipeline_sinks.hpp"
#include "sim/stream/ring/pitviper_stream.h"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kPictures = 8;
constexpr int kPacketBytes = 8000;
const char* const kAddress = "127.0.0.9";

/// A camera whose frames nobody draws.
Simulation benchOf(const SelfTestWish& w) {
  return readScenarioText(
      print("name: self_test\ntime: {rate: %.9g Hz}\nentities:\n  - {name: ball, shape: {model: sphere, radius: 1 m}, temperature: 300 K, material: "
            "grey_aircraft_paint}\n"
            "cameras:\n  - name: bench\n    position: [100 m, 0 m, 0 m]\n    look_at: ball\n    film: {width: %d, height: %d, pitch: 15 um}\n    "
            "focal_length: 100 mm\n    aperture: 25 mm\n    exposure: 1 ms\n"
            "    channels:\n      - {name: mw, response: {band: [3.7 um, 4.8 um]}, quantum_efficiency: insb_mwir, output: counts}\n"
            "    stages:\n      - {stage: detector, full_well: 6.5e6, bits: 16}\n",
            w.rate_hz, w.width, w.height),
      "self-test", ".", {}, findLibraries());
}

/// Pictures made before: a disc goes round over noise; in the first pixel which of them it is.
std::vector<std::shared_ptr<const Frame>> picturesOf(const SelfTestWish& w) {
  std::vector<std::shared_ptr<const Frame>> all;
  for (std::size_t k = 0; k < kPictures; ++k) {
    auto frame = std::make_shared<Frame>();
    frame->camera = "bench";
    frame->width = w.width, frame->height = w.height;
    FrameLayer layer{"mw.counts", "count", {}};
    const double angle = 2.0 * M_PI * static_cast<double>(k) / kPictures, x = w.width * (0.5 + 0.3 * std::cos(angle)),
                 y = w.height * (0.5 + 0.3 * std::sin(angle));
    std::uint32_t noise = 1;
    for (int row = 0; row < w.height; ++row)
      for (int column = 0; column < w.width; ++column) {
        noise = noise * 1664525u + 1013904223u;
        layer.pixels.push_back((std::hypot(column - x, row - y) < 0.05 * w.width ? 40000.0f : 1000.0f) + static_cast<float>(noise >> 26));
      }
    frame->layers.push_back(std::move(layer));
    all.push_back(std::move(frame));
  }
  return all;
}

struct Way {
  std::string name;
  std::uint64_t sent = 0, received = 0, wrong = 0, counted = 0;  ///< counted: as lost, by who lost them
  Durations delay, period;
  std::string note;
};

/// When each frame was handed over, by its number modulo 2^16, which travels in its first pixel.
class SentTimes {
 public:
  void put(std::uint16_t number, std::int64_t t) { times_[number] = t; }
  std::int64_t of(std::uint16_t number) const { return times_[number]; }

 private:
  std::vector<std::atomic<std::int64_t>> times_ = std::vector<std::atomic<std::int64_t>>(65536);
};

/// Hands frames over at the rate; the bare cost of what a stream does besides drawing.
void produce(const SelfTestWish& w, Sink& sink, const std::vector<std::shared_ptr<const Frame>>& pictures, SentTimes& times, Way& way) {
  const auto period = static_cast<std::int64_t>(1e9 / w.rate_hz);
  const auto count = static_cast<std::uint64_t>(w.duration_s * w.rate_hz);
  std::int64_t next = monotonic_ns() + period;
  for (std::uint64_t k = 0; k < count; ++k, next += period) {
    auto frame = std::make_shared<Frame>(*pictures[k % kPictures]);
    frame->number = static_cast<int>(k);
    frame->stamp = FrameStamp{};
    frame->stamp->sequence = k;
    frame->stamp->time_ns = static_cast<std::int64_t>(k) * period;
    frame->layers[0].pixels[0] = static_cast<float>(k % 65536);
    sleepUntil_ns(next);
    times.put(static_cast<std::uint16_t>(k), monotonic_ns());
    sink.take(frame);
    ++way.sent;
  }
  sleepUntil_ns(monotonic_ns() + 200000000);  // what is on its way arrives
}

/// Whether a picture is the one that was handed over: three pixels of it, and when.
class Receiver {
 public:
  Receiver(Way& way, const SentTimes& times, const std::vector<std::shared_ptr<const Frame>>& pictures) : way_(way), times_(times), pictures_(pictures) {}
  void take(std::span<const std::uint16_t> codes, std::int64_t now) {
    const std::uint16_t number = codes[0];
    const std::vector<float>& pixels = pictures_[number % kPictures]->layers[0].pixels;
    bool same = codes.size() == pixels.size();
    for (std::size_t p = 1; same && p < codes.size(); p += 997) same = codes[p] == static_cast<std::uint16_t>(pixels[p]);
    ++way_.received;
    if (!same) ++way_.wrong;
    way_.delay.add(now - times_.of(number));
    if (last_ > 0) way_.period.add(now - last_);
    last_ = now;
  }

 private:
  Way& way_;
  const SentTimes& times_;
  const std::vector<std::shared_ptr<const Frame>>& pictures_;
  std::int64_t last_ = 0;
};

Way throughSharedMemory(const SelfTestWish& w, const Simulation& sim, const std::vector<std::shared_ptr<const Frame>>& pictures) {
  Way way{"shared memory", 0, 0, 0, 0, {}, {}, ""};
  const std::string name = "/pitviper.self_test." + std::to_string(getpid());
  const auto sink = sinkNamed("shared_memory", sim, {{"name", name}}).make(sim, {});
  sink->start();
  pitviper_stream stream{};
  if (pitviper_stream_open(&stream, name.c_str()) != 0) throw std::runtime_error("shared memory " + name + " cannot be read: " + std::strerror(errno));
  std::atomic<bool> ends{false};
  SentTimes times;
  std::thread reader([&] {
    Receiver receiver(way, times, pictures);
    constexpr int kLook_ms = 50;
    while (!ends)
      if (const pitviper_stream_frame* f = pitviper_stream_next(&stream, kLook_ms)) {
        const std::int64_t now = monotonic_ns();
        const auto* codes = static_cast<const std::uint16_t*>(pitviper_stream_pixels(&stream, f, 0));
        receiver.take({codes, static_cast<std::size_t>(w.width) * static_cast<std::size_t>(w.height)}, now);
        if (!pitviper_stream_held(&stream, f)) ++way.wrong;
      }
  });
  produce(w, *sink, pictures, times, way);
  ends = true;
  reader.join();
  way.counted = stream.lost;
  pitviper_stream_close(&stream);
  return way;
}

Way throughNetwork(const SelfTestWish& w, const Simulation& sim, const std::vector<std::shared_ptr<const Frame>>& pictures) {
  Way way{"GVSP, packets of " + std::to_string(kPacketBytes) + " bytes", 0, 0, 0, 0, {}, {}, ""};
  const auto sink = sinkNamed("gige", sim, {{"address", kAddress}}).make(sim, {});
  sink->start();
  std::atomic<bool> ends{false};
  SentTimes times;
  GigeReader client(kAddress, kPacketBytes);
  std::thread reader([&] {
    Receiver receiver(way, times, pictures);
    client.read(ends, [&](std::span<const std::uint16_t> codes, std::int64_t now) { receiver.take(codes, now); });
  });
  produce(w, *sink, pictures, times, way);
  ends = true;
  reader.join();
  way.counted = client.incomplete() + sink->counts().front().skipped;
  return way;
}

Way throughPipeline(const SelfTestWish& w, const Simulation& sim, const std::vector<std::shared_ptr<const Frame>>& pictures) {
  Way way{"GStreamer, fdsink", 0, 0, 0, 0, {}, {}, ""};
  int ends[2] = {-1, -1};
  if (pipe(ends) != 0) throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
  SentTimes times;
  std::thread reader;
  try {
    const auto sink = makeGstreamerSink(sim, sim.cameras[0], "fdsink sync=false fd=" + std::to_string(ends[1]));
    sink->start();
    reader = std::thread([&] {
      Receiver receiver(way, times, pictures);
      std::vector<std::uint16_t> codes(static_cast<std::size_t>(w.width) * static_cast<std::size_t>(w.height));
      for (std::size_t got = 0;;) {
        const ssize_t count = read(ends[0], reinterpret_cast<char*>(codes.data()) + got, 2 * codes.size() - got);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return;
        if ((got += static_cast<std::size_t>(count)) < 2 * codes.size()) continue;
        receiver.take(codes, monotonic_ns());
        got = 0;
      }
    });
    produce(w, *sink, pictures, times, way);
    sink->finish({});
    way.counted = sink->counts().front().skipped;
  } catch (const UserError& e) {
    way.note = e.what();
  }
  close(ends[1]);
  if (reader.joinable()) reader.join();
  close(ends[0]);
  return way;
}

/// Commands there, an answer back: the loop's part is a thread that takes each step at once.
Way throughPort(const std::string& name, const Simulation& sim, const std::function<std::unique_ptr<CommandPort>(CommandInbox&)>& open,
                const std::function<bool()>& ask, const std::function<void()>& connect, int rounds) {
  Way way{name, 0, 0, 0, 0, {}, {}, ""};
  CommandInbox inbox;
  const auto port = open(inbox);
  connect();
  std::thread loop([&] {
    for (std::uint64_t tick = 0; !inbox.isEnding();) {
      constexpr std::int64_t kLook_ns = 50000000;
      if (const auto step = inbox.waitForStep(kLook_ns)) {
        inbox.take();
        port->tickDone({tick, step->hostFrame, static_cast<int>(tick), sim.time.at(static_cast<int>(tick)), step->ticket});
        ++tick;
      }
    }
  });
  for (int k = 0; k < rounds; ++k) {
    const std::int64_t from = monotonic_ns();
    ++way.sent;
    if (!ask()) continue;
    ++way.received;
    way.delay.add(monotonic_ns() - from);
  }
  inbox.end();
  loop.join();
  return way;
}

Way throughJson(const Simulation& sim) {
  const std::string path = "/tmp/pitviper.self_test." + std::to_string(getpid());
  int s = -1;
  const auto connectTo = [&] {
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::memcpy(at.sun_path, path.c_str(), std::min(path.size(), sizeof at.sun_path - 1));
    s = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (connect(s, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) throw std::runtime_error(std::string("no socket: ") + std::strerror(errno));
  };
  const auto ask = [&] {
    const std::string line = R"({"command": "move", "entity": "ball", "position": ["1 m", "2 m", "3 m"], "step": 1})"
                             "\n";
    if (send(s, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size())) return false;
    char answer[4096];
    for (std::size_t got = 0;;) {
      const ssize_t count = recv(s, answer + got, sizeof answer - got, 0);
      if (count <= 0) return false;
      got += static_cast<std::size_t>(count);
      if (answer[got - 1] == '\n') return true;
      if (got == sizeof answer) return false;
    }
  };
  Way way = throughPort(
      "JSON lines: a move and a step, there and back", sim,
      [&](CommandInbox& inbox) {
        return openJsonPort({path, true, 1.0, {}, {}, {}}, sim, inbox);
      },
      ask, connectTo, 2000);
  close(s);
  return way;
}

Way throughCigi(const Simulation& sim) {
  // Some free port.
  int s = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0), probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  if (bind(probe, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0) throw std::runtime_error(std::string("no port: ") + std::strerror(errno));
  getsockname(probe, reinterpret_cast<sockaddr*>(&at), &size);
  close(probe);
  const timeval patience{1, 0};
  setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  std::uint32_t frame = 0;
  const auto ask = [&] {
    // IG Control of CIGI 3.3, operate, little-endian.
    std::uint8_t packet[24] = {1, 24, 3, 0, 0x31};
    packet[6] = 0x00, packet[7] = 0x80;
    ++frame;
    std::memcpy(packet + 8, &frame, 4);
    if (sendto(s, packet, sizeof packet, 0, reinterpret_cast<const sockaddr*>(&at), sizeof at) != sizeof packet) return false;
    std::uint8_t answer[64];
    constexpr ssize_t kStartOfFrame = 24;
    return recv(s, answer, sizeof answer, 0) == kStartOfFrame;
  };
  const std::string place = std::to_string(ntohs(at.sin_port));
  Way way = throughPort(
      "CIGI 3.3: IG Control and Start of Frame", sim, [&](CommandInbox& inbox) { return openCigiPort(place, true, sim, inbox); }, ask, [] {}, 2000);
  close(s);
  return way;
}

}  // namespace

int streamSelfTest(const SelfTestWish& wish) {
  const Simulation sim = benchOf(wish);
  const auto pictures = picturesOf(wish);
  std::printf("%d x %d pixels of 16 bits, %.6g Hz, %.6g s each, pictures made before; sender and reader on this machine\n", wish.width, wish.height,
              wish.rate_hz, wish.duration_s);
  std::vector<std::vector<std::string>> rows{
      {"", "sent", "received", "counted as lost", "wrong", "delay p50 [ms]", "p99", "p99.9", "largest", "period's deviation [ms]"}};
  std::uint64_t unaccounted = 0;
  const auto add = [&](const Way& way, bool isFrames) {
    const auto ms = [](double ns) { return print("%.3f", 1e-6 * ns); };
    rows.push_back({way.name, std::to_string(way.sent), std::to_string(way.received), std::to_string(way.counted), std::to_string(way.wrong),
                    ms(way.delay.quantile_ns(0.5)), ms(way.delay.quantile_ns(0.99)), ms(way.delay.quantile_ns(0.999)), ms(way.delay.most_ns()),
                    isFrames ? ms(way.period.deviation_ns()) : ""});
    unaccounted += way.wrong + (way.sent > way.received + way.counted ? way.sent - way.received - way.counted : 0);
  };
  add(throughSharedMemory(wish, sim, pictures), true);
  add(throughNetwork(wish, sim, pictures), true);
  const Way pipeline = throughPipeline(wish, sim, pictures);
  if (pipeline.note.empty()) add(pipeline, true);
  add(throughJson(sim), false);
  add(throughCigi(sim), false);
  std::fputs(alignedTable(rows).c_str(), stdout);
  if (!pipeline.note.empty()) std::printf("  not tried: %s\n", pipeline.note.c_str());
  std::printf("  unaccounted for: %llu\n", static_cast<unsigned long long>(unaccounted));
  constexpr int kUnaccounted = 3;
  return unaccounted > 0 ? kUnaccounted : 0;
}

}  // namespace pitviper
