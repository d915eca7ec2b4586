// Every frame as a picture for people.
#include <algorithm>

#include "sim/frame/frame_files.hpp"
#include "sim/model/simulation.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

class PreviewsSink final : public Sink {
 public:
  PreviewsSink(SinkPlace place, PreviewRanges ranges) : place_(std::move(place)), ranges_(std::move(ranges)) {}
  void start() override { ensureWritableFolder(place_.folder); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (frame->kind.empty()) writePreview(place_.folder, *frame, ranges_, place_.mayReplace);
  }
  std::filesystem::path fileOf(const std::string& camera, int number, const std::string& kind) const override {
    return kind.empty() ? place_.folder / (frameFileStem(camera, number, kind) + ".png") : std::filesystem::path();
  }

 private:
  SinkPlace place_;
  PreviewRanges ranges_;
};

PreviewRanges readRanges(const Record& r, const Simulation& sim) {
  PreviewRanges ranges;
  if (!r.given("ranges")) return ranges;
  std::vector<std::string> layers;
  for (const Camera& c : sim.cameras)
    for (const ChannelOutput& o : c.outputs) layers.push_back(o.layer());
  const Value& map = asMap(r.value("ranges"), "ranges");
  for (size_t k = 0; k < map.entries.size(); ++k) {
    const auto& [layer, value] = map.entries[k];
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) throw unknownWord(map.keyPlaces[k], "there is no layer", layer, layers);
    if (ranges.count(layer)) throw UserError(map.keyPlaces[k], "a second range for layer '" + layer + "'", "one", "remove one");
    const Value& ends = asList(value, "a range");
    if (ends.items.size() != 2) throw UserError(value.where, "not a range", "[low, high] in the layer's own unit", "write two numbers");
    ranges[layer] = {readNumber(ends.items[0], "", "the range"), readNumber(ends.items[1], "", "the range")};
    if (!(ranges[layer].first < ranges[layer].second)) throw UserError(value.where, "the range does not rise", "[low, high]", "swap its ends");
  }
  return ranges;
}

}  // namespace

std::unique_ptr<Sink> makePreviewsSink(const SinkPlace& place, const PreviewRanges& ranges) { return std::make_unique<PreviewsSink>(place, ranges); }

SinkModel previewsSink() {
  return {
      "previews",
      "Every frame as a PNG with a colour bar: its channels side by side.",
      {folderParameter(), map("ranges", "layer: [low, high], ends of its colour bar in the layer's own unit; those not given fit themselves to each frame")},
      [](const Record& r, const Simulation& sim) {
        return [folder = readFolder(r), ranges = readRanges(r, sim)](const Simulation&, const SinkPlace& place) {
          return makePreviewsSink(place.below(folder), ranges);
        };
      }};
}

}  // namespace pitviper
