#include "sim/stream/picture_sink.hpp"

#include <algorithm>

#include "sim/frame/file_owner.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/model/simulation.hpp"
#include "sim/parameters/units.hpp"
#include "sim/stream/frame_spool.hpp"

namespace pitviper {
namespace {

/// What pictures need of a frame.
Frame shown(const Frame& frame, const PictureStyle& style) {
  Frame some = frame;
  some.layers.clear();
  for (const FrameLayer& l : frame.layers)
    if (style.truth || l.name.rfind("truth.", 0) != 0) some.layers.push_back(l);
  std::erase_if(some.attributes, [](const Attribute& a) { return a.name != kScenarioName && a.name != kScenarioHash && a.name.rfind("band_um.", 0) != 0; });
  return some;
}

class PictureSink final : public Sink {
 public:
  PictureSink(const PictureStyle& style, std::vector<std::unique_ptr<PictureUser>> users, const SinkPlace& place)
      : style_(style), users_(std::move(users)), folder_(place.folder), spool_(place.folder) {}

  void start() override { ensureWritableFolder(folder_); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (!frame->kind.empty()) return;
    if (!style_.needsScales()) return hand(*frame, {});
    for (const FrameLayer* l : shownLayers(*frame, style_)) scales_[frame->camera][l->name].add(scaledValues(*frame, *l));
    spool_.add(shown(*frame, style_));
  }
  void finish(const std::function<void(double)>& progress) override {
    std::map<std::string, LayerScales> scales;
    for (const auto& [camera, layers] : scales_)
      for (const auto& [layer, common] : layers) scales[camera].emplace(layer, common.scale());
    spool_.each([&](const Frame& frame, double share) {
      hand(frame, scales[frame.camera]);
      if (progress) progress(share);
    });
    for (const auto& user : users_) user->finish();
  }
  std::vector<std::filesystem::path> filesOf(const std::string& camera, int number, const std::string& kind) const override {
    std::vector<std::filesystem::path> files;
    for (const auto& user : users_)
      if (kind.empty()) files.push_back(user->fileOf(camera, number));
    return files;
  }

 private:
  void hand(const Frame& frame, const LayerScales& scales) {
    if (shownLayers(frame, style_).empty()) return;
    std::optional<Rgb8Image> all, first;
    for (const auto& user : users_) {
      std::optional<Rgb8Image>& picture = user->takesFirst() ? first : all;
      if (!picture) picture = pictureOf(frame, style_, scales, user->takesFirst());
      user->take(frame, *picture);
    }
  }
  PictureStyle style_;
  std::vector<std::unique_ptr<PictureUser>> users_;
  std::filesystem::path folder_;
  FrameSpool spool_;
  std::map<std::string, std::map<std::string, CommonScale>> scales_;  ///< by camera and layer
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

std::unique_ptr<Sink> makePictureSink(const PictureStyle& style, std::vector<std::unique_ptr<PictureUser>> users, const SinkPlace& place) {
  return std::make_unique<PictureSink>(style, std::move(users), place);
}

void readScale(const std::string& text, const Location& where, PictureStyle& style) {
  style.ownScale = text == "frame";
  style.range.reset();
  if (text == "run" || text == "frame") return;
  const size_t colon = text.find(':');
  const auto low = splitQuantity(text.substr(0, colon)), high = splitQuantity(colon == std::string::npos ? std::string() : text.substr(colon + 1));
  if (!low || !high || !low->unit.empty() || !high->unit.empty() || !(low->value < high->value))
    throw UserError(where, "'" + text + "' is no scale", "run, frame, or low:high in the layers' own unit", "write 'run', 'frame' or, for instance, '28:45'");
  style.range = {low->value, high->value};
}

std::vector<Parameter> styleParameters() {
  std::vector<std::string> palettes = colourMapNames();
  palettes.insert(palettes.begin(), "auto");
  return {withDefault(
              text("scale", "`run`: one colour bar for all frames, which are drawn when the run ends; `frame`: each its own; `low:high`, in the layers' unit"),
              "run"),
          withDefault(choice("palette", palettes, "thermal: false colour; auto: grey below 0.9 um, else thermal"), "auto"),
          withDefault(boolean("plain", "the pixels alone, one to one"), "false"), withDefault(boolean("truth", "truth layers too"), "false"),
          map("ranges", "layer: [low, high], ends of its colour bar in the layer's own unit, whatever `scale` says")};
}

PictureStyle readStyle(const Record& r, const Simulation& sim) {
  PictureStyle style;
  style.ranges = readRanges(r, sim);
  readScale(r.text("scale"), r.where("scale"), style);
  style.palette = r.text("palette");
  style.plain = r.boolean("plain");
  style.truth = r.boolean("truth");
  return style;
}

}  // namespace pitviper
