// Cameras as machine-vision cameras on the network: stock clients open them.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>

#include "sim/frame/frame_number.hpp"
#include "sim/frame/version.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/controllable_sink.hpp"
#include "sim/stream/gige/gige_device.hpp"
#include "sim/stream/sink_models.hpp"
#include "sim/stream/stream_picture.hpp"

namespace pitviper {
namespace {

struct GigeWish {
  std::string address, camera, layer;
  StreamRange range;
  bool allowDestination = false;
  int line_Mbps = 10000;
  Location where;
};

/// The address `k` after one: 127.0.0.1, 127.0.0.2.
std::string addressAfter(const std::string& first, int k, const Location& where) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  char end = 0;
  if (std::sscanf(first.c_str(), "%u.%u.%u.%u%c", &a, &b, &c, &d, &end) != 4 || a > 255 || b > 255 || c > 255 || d > 255)
    throw UserError(where, "'" + first + "' is no IPv4 address", "one of this machine, such as 127.0.0.1", "write 'address: 127.0.0.1'");
  d += static_cast<unsigned>(k);
  if (d > 254) throw UserError(where, "there is no address left after " + first, "one for each camera", "begin with a lower one");
  return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c) + "." + std::to_string(d);
}

std::string number(double v, const char* unit) { return print("%.9g%s", v, unit); }

class GigeSink final : public Sink, public ControllableSink {
 public:
  GigeSink(const Simulation& simulation, GigeWish wish) : simulation_(simulation), wish_(std::move(wish)) {
    int k = 0;
    for (const Camera& c : simulation_.cameras)
      if (wish_.camera.empty() || wish_.camera == c.name) {
        Device d{addressAfter(wish_.address, k++, wish_.where), StreamCoder(c, wish_.layer, wish_.range, wish_.where), nullptr,
                 std::make_shared<std::atomic<std::uint64_t>>(0)};
        devices_.emplace(c.name, std::move(d));
      }
  }
  void control(const Controls& controls) override { controls_ = controls; }
  void pulse() override {
    for (auto& [camera, d] : devices_)
      if (d.device) d.device->trigger();
  }

  void start() override {
    for (const Camera& c : simulation_.cameras) {
      const auto found = devices_.find(c.name);
      if (found == devices_.end()) continue;
      Device& d = found->second;
      GigeSettings s;
      s.address = d.address;
      s.model = c.name;
      s.serial = simulation_.name.substr(0, 15);
      s.version = kVersion;
      s.width = d.coder.width(), s.height = d.coder.height(), s.bits = d.coder.bits();
      s.rate_hz = 1.0 / simulation_.time.step_s;
      // The device is of one layer: its channel's exposure and gain are what a client sets.
      const std::string channel = d.coder.layer().substr(0, d.coder.layer().rfind('.'));
      const OwnChannel* own = c.ownChannel(channel);
      s.exposure_us = 1e6 * c.exposureOf(channel);
      s.allowDestination = wish_.allowDestination;
      s.line_Mbps = wish_.line_Mbps;
      GigeCallbacks calls;
      calls.now_ns = [] { return taiOf_ns(monotonic_ns()); };
      if (controls_.command) {
        const auto send = [this](std::vector<std::pair<std::string, std::string>> words, const std::string& ofChannel) {
          if (!ofChannel.empty()) words.emplace_back("channel", ofChannel);
          controls_.command(words);
        };
        if (c.exposureOf(channel) > 0.0)
          calls.exposure = [send, name = c.name, of = own && own->exposure_s ? channel : ""](double us) {
            send({{"command", "look"}, {"camera", name}, {"exposure", number(us, " us")}}, of);
          };
        if (detectorOf(c, channel))
          calls.gain = [send, name = c.name, of = own && own->hasDetector ? channel : ""](double dB) {
            constexpr double kDecibelsOfTen = 20.0;
            send({{"command", "gain"}, {"camera", name}, {"factor", number(std::pow(10.0, dB / kDecibelsOfTen), "")}}, of);
          };
        else s.gainMax_dB = 0.0;
      }
      calls.softwareTrigger = [this] {
        if (controls_.trigger) controls_.trigger();
      };
      try {
        d.device = std::make_unique<GigeDevice>(s, calls);
      } catch (const std::runtime_error& e) {
        throw UserError(wish_.where, e.what(), "an address of this machine where no other camera listens", "choose another address");
      }
    }
  }

  void take(const std::shared_ptr<const Frame>& frame) override {
    const auto found = devices_.find(frame->camera);
    if (found == devices_.end() || !frame->kind.empty()) return;
    Device& d = found->second;
    ++*d.taken;
    auto picture = std::make_shared<GigePicture>();
    StreamPicture coded;
    d.coder.code(*frame, coded);
    const FrameStamp s = frame->stamp.value_or(FrameStamp{});
    picture->codes = std::move(coded.codes);
    picture->width = d.coder.width(), picture->height = d.coder.height();
    picture->sequence = frame->stamp ? s.sequence : static_cast<std::uint64_t>(frame->number);
    picture->timestamp_ns = taiOf_ns(monotonic_ns());
    picture->simulation_ns = s.time_ns;
    const std::string channel = d.coder.layer().substr(0, d.coder.layer().rfind('.'));
    picture->exposure_us = 1e6 * numberOf(*frame, "pitviper.exposure_s." + channel, 1e-9 * static_cast<double>(s.exposureEnd_ns - s.exposureStart_ns));
    constexpr double kDecibelsOfTen = 20.0;  // of a voltage
    picture->gain_dB = kDecibelsOfTen * std::log10(s.gain);
    picture->radianceScale = coded.gain, picture->radianceOffset = coded.offset;
    picture->flags = (s.isLate ? 1u : 0u) | (s.isRepeated ? 2u : 0u) | (s.isOutsideLimits ? 4u : 0u) | (coded.outside > 0 ? 8u : 0u);
    d.device->publish(picture);
  }
  /// What is on its way has left, or is given up.
  void finish(const std::function<void(double)>&) override {
    constexpr int kTries = 100;
    constexpr std::int64_t kStep_ns = 5000000;
    const auto busy = [](const SinkCounts& s) { return s.passedOn + s.skipped < s.taken; };
    for (int k = 0; k < kTries; ++k) {
      const auto all = counts();
      if (std::none_of(all.begin(), all.end(), busy)) return;
      sleepUntil_ns(monotonic_ns() + kStep_ns);
    }
  }
  bool neverWaits() const override { return true; }

  std::vector<SinkCounts> counts() const override {
    std::vector<SinkCounts> all;
    for (const auto& [camera, d] : devices_) {
      const GigeCounts c = d.device ? d.device->counts() : GigeCounts{};
      const std::uint64_t taken = *d.taken;
      all.push_back({"camera " + camera + " at " + d.address,
                     taken,
                     c.pictures,
                     c.skipped + c.cut + c.withoutConsumer + c.withoutTrigger,
                     {{"pictures without a client", c.withoutConsumer},
                      {"waiting for a trigger", c.withoutTrigger},
                      {"overtaken by newer ones", c.skipped},
                      {"cut short", c.cut},
                      {"packets", c.packets},
                      {"sent again", c.resent},
                      {"resends not served", c.resendsNotServed},
                      {"triggers", c.triggers},
                      {"triggers missed", c.triggersMissed},
                      {"requests", c.commands},
                      {"malformed", c.malformed},
                      {"refused", c.refused},
                      {"throttled", c.throttled},
                      {"heartbeats lost", c.heartbeatsLost}}});
    }
    return all;
  }

 private:
  struct Device {
    std::string address;
    StreamCoder coder;
    std::unique_ptr<GigeDevice> device;
    std::shared_ptr<std::atomic<std::uint64_t>> taken;
  };
  const Simulation& simulation_;
  GigeWish wish_;
  Controls controls_;
  std::map<std::string, Device> devices_;
};

}  // namespace

SinkModel gigeSink() {
  return {"gige",
          "Cameras on the network, compatible with GVCP and GVSP of machine vision (tested with Aravis): each camera of the scenario is one, at `address` and "
          "those after it. One layer: counts as they are, others as 16-bit codes of a fixed scale; Mono8, Mono12Packed and Mono16 with chunks. Clients may set "
          "exposure and gain of a stream, and trigger it.",
          {withDefault(text("address", "IPv4 address of this machine, of the first camera; port 3956"), "127.0.0.1"), text("camera", "this one alone"),
           text("layer", "such as mw.counts; the first counts unless given, or the first layer"),
           list("range", "[lowest, highest] of a layer that is no count, in its unit", 2, 2),
           withDefault(boolean("allow_destination", "pictures may go to whatever address the client asks for, not to its own alone"), "false"),
           withDefault(integer("line", "speed of the line that packets are spread over [Mbit/s]", 10, 400000), "10000")},
          [](const Record& r, const Simulation& sim) {
            GigeWish wish{r.text("address"),
                          r.given("camera") ? r.text("camera") : "",
                          r.given("layer") ? r.text("layer") : "",
                          {},
                          r.boolean("allow_destination"),
                          static_cast<int>(r.integer("line")),
                          r.where()};
            addressAfter(wish.address, 0, r.where("address"));
            std::vector<std::string> names;
            for (const Camera& c : sim.cameras) names.push_back(c.name);
            if (!wish.camera.empty() && std::find(names.begin(), names.end(), wish.camera) == names.end())
              throw unknownWord(r.where("camera"), "there is no camera", wish.camera, names);
            if (r.given("range")) {
              const std::vector<Value>& ends = r.value("range").items;
              wish.range = {readNumber(ends[0], "", "range"), readNumber(ends[1], "", "range")};
              if (!(wish.range->first < wish.range->second)) throw UserError(r.where("range"), "the range does not rise", "[lowest, highest]", "swap its ends");
            }
            return [wish](const Simulation& simulation, const SinkPlace&) -> std::unique_ptr<Sink> { return std::make_unique<GigeSink>(simulation, wish); };
          }};
}

}  // namespace pitviper
