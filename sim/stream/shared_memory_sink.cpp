// Frames in shared memory: the shortest way to another program on the machine.
#include <algorithm>
#include <map>

#include "sim/model/simulation.hpp"
#include "sim/stream/ring/ring_writer.hpp"
#include "sim/stream/sink_models.hpp"
#include "sim/stream/stream_picture.hpp"

namespace pitviper {
namespace {

class SharedMemorySink final : public Sink {
 public:
  SharedMemorySink(const Simulation& simulation, std::string name, int slots, Location where)
      : simulation_(simulation), name_(std::move(name)), slots_(slots), where_(std::move(where)) {}

  void start() override {
    for (const Camera& c : simulation_.cameras) {
      RingDesign d{simulation_.cameras.size() > 1 ? name_ + "." + c.name : name_, simulation_.name, c.name, 0, 0, slots_, 1.0 / simulation_.time.step_s, {}};
      d.width = c.window ? c.window->z : c.pinhole.width;
      d.height = c.window ? c.window->w : c.pinhole.height;
      if (c.outputs.size() > PITVIPER_STREAM_LAYERS)
        throw UserError(where_, "camera '" + c.name + "' has " + std::to_string(c.outputs.size()) + " layers",
                        "at most " + std::to_string(PITVIPER_STREAM_LAYERS) + " in shared memory", "ask for fewer outputs, or split it into two cameras");
      for (const ChannelOutput& o : c.outputs) {
        const bool counts = isCounts(c, o);
        const DetectorLaw* law = detectorOf(c, o.channel);
        d.layers.push_back({o.layer(), o.unit, counts, !o.asDisplay, static_cast<std::uint16_t>(o.asDisplay ? 255.0 : law ? law->mostCount() : 65535.0)});
      }
      try {
        rings_.emplace(c.name, std::make_unique<RingWriter>(d));
      } catch (const std::runtime_error& e) {
        throw UserError(where_, e.what());
      }
      names_[c.name] = d.name;
    }
  }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (frame->kind.empty())
      if (const auto ring = rings_.find(frame->camera); ring != rings_.end()) ring->second->publish(*frame);
  }
  bool neverWaits() const override { return true; }
  std::vector<SinkCounts> counts() const override {
    std::vector<SinkCounts> all;
    for (const auto& [camera, ring] : rings_) all.push_back({"shared memory " + names_.at(camera), ring->published(), ring->published(), 0, {}});
    return all;
  }

 private:
  const Simulation& simulation_;
  std::string name_;
  int slots_;
  Location where_;
  std::map<std::string, std::unique_ptr<RingWriter>> rings_;
  std::map<std::string, std::string> names_;
};

}  // namespace

SinkModel sharedMemorySink() {
  return {"shared_memory",
          "Frames in POSIX shared memory, of this user alone: all channels, counts as 16-bit whole numbers, the rest as floats, with what there is to say of "
          "each frame. sim/stream/ring/pitviper_stream.h is its description, and all that a reader in C needs; scenarios/clients has readers.",
          {withDefault(text("name", "of the object; of several cameras each has its name behind it"), "/pitviper"),
           withDefault(integer("slots", "frames that it holds", 2, 4096), "8")},
          [](const Record& r, const Simulation&) {
            const std::string name = r.text("name");
            if (const std::string wrong = wrongRingName(name); !wrong.empty())
              throw UserError(r.where("name"), "'" + name + "' is no name of shared memory", wrong, "write 'name: /pitviper'");
            return [name, slots = static_cast<int>(r.integer("slots")), where = r.where()](const Simulation& simulation,
                                                                                           const SinkPlace&) -> std::unique_ptr<Sink> {
              return std::make_unique<SharedMemorySink>(simulation, name, slots, where);
            };
          }};
}

}  // namespace pitviper
