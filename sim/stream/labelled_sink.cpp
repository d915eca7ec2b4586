#include "sim/stream/labelled_sink.hpp"

#include <algorithm>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/image/grey_codes.hpp"
#include "sim/image/whole_values.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/frame_spool.hpp"

namespace pitviper {
namespace {

/// What 16 bits can number.
constexpr std::size_t kMostBodies = 65535;

/// Ends of the codes of pictures: the lowest and the highest.
using CodeEnds = std::pair<double, double>;

const FrameLayer& layerOf(const Frame& frame, const std::string& name) {
  for (const FrameLayer& l : frame.layers)
    if (name.empty() || l.name == name) return l;
  throw std::runtime_error("camera " + frame.camera + ", frame " + std::to_string(frame.number) + " has no layer " + name);
}

class LabelledSink final : public Sink {
 public:
  LabelledSink(const std::string& name, LabelWishes wishes, const Simulation& sim, const SinkPlace& place, const MakeLabelFormat& format)
      : wishes_(std::move(wishes)),
        classes_(classesOf(wishes_.classes, sim, wishes_.cameras)),
        format_(format(classes_, wishes_.split, wishes_.cameras)),
        files_(name, sim, place),
        spool_(place.folder) {}

  void start() override {
    std::vector<std::string> kinds = format_->kinds();
    kinds.emplace_back("images");
    if (wishes_.masks != MaskFiles::None) kinds.emplace_back("masks");
    ensureWritableFolder(files_.place().folder);
    for (const std::string& part : wishes_.split.parts())
      for (const std::string& kind : kinds) ensureWritableFolder(files_.place().folder / format_->folderOf(kind, part));
    for (const auto& name : format_->besides()) files_.refuseForeignBeside(name, kManifest);  // now, not when the run has ended
  }

  void take(const std::shared_ptr<const Frame>& frame) override {
    if (!frame->kind.empty() || !takes(frame->camera)) return;
    files_.noteFrame(*frame);
    const std::string stem = frameFileStem(*frame), part = partOf(*frame);
    const FrameLayer& layer = layerOf(*frame, wishes_.layer);
    layerOf(*frame, "truth.entity");
    const std::vector<BodyMask> bodies = bodyMasks(*frame, [this](int number) { return classes_.of(number) >= 0; });
    writeMask(*frame, stem, part);
    format_->take({*frame, stem, part, pictureOf(stem, part), bodies}, files_);
    if (const auto ends = knownEnds(layer)) return writeImage(*frame, layer, *ends);
    CodeEnds& ends = ends_.try_emplace(frame->camera, INFINITY, -INFINITY).first->second;
    for (float v : layer.pixels)
      if (std::isfinite(v)) ends.first = std::min(ends.first, static_cast<double>(v)), ends.second = std::max(ends.second, static_cast<double>(v));
    spool_.add(pictureAlone(*frame, layer));
  }

  void finish(const std::function<void(double)>& progress) override {
    spool_.each([&](const Frame& frame, double share) {
      CodeEnds ends = ends_.at(frame.camera);
      if (!(ends.first < ends.second)) ends = std::isfinite(ends.first) ? CodeEnds{ends.first, ends.first + 1.0} : CodeEnds{0.0, 1.0};
      writeImage(frame, frame.layers.front(), ends);
      if (progress) progress(share);
    });
    format_->finish(files_);
    files_.writeManifest(wishes_.split, {{"categories", classes_.names}, {"scales", scales_}});
  }

  std::vector<std::filesystem::path> filesOf(const std::string& camera, int number, const std::string& kind) const override {
    if (!kind.empty() || !takes(camera)) return {};
    const std::string stem = frameFileStem(camera, number, kind), part = wishes_.split.partOf(camera, number);
    std::vector<std::filesystem::path> names = format_->filesOf(stem, part);
    names.push_back(pictureOf(stem, part));
    if (wishes_.masks == MaskFiles::Png) names.push_back(maskOf(stem, part));
    if (camera == wishes_.cameras.front()) {  // of all cameras, and told once
      for (const auto& name : format_->files()) names.push_back(name);
      names.emplace_back(kManifest);
    }
    for (auto& name : names) name = files_.place().folder / name;
    return names;
  }

 private:
  bool takes(const std::string& camera) const { return std::find(wishes_.cameras.begin(), wishes_.cameras.end(), camera) != wishes_.cameras.end(); }
  std::string partOf(const Frame& frame) const { return wishes_.split.partOf(frame.camera, frame.number); }
  std::filesystem::path pictureOf(const std::string& stem, const std::string& part) const { return format_->folderOf("images", part) / (stem + ".png"); }
  std::filesystem::path maskOf(const std::string& stem, const std::string& part) const {
    return format_->folderOf("masks", part) / (stem + (wishes_.masks == MaskFiles::Png ? ".png" : ".tif"));
  }
  static DataSetFiles::Json aboutOf(const Frame& frame, const std::string& part) {
    DataSetFiles::Json about = {{"camera", frame.camera}, {"frame", frame.number}};
    if (!part.empty()) about["part"] = part;
    return about;
  }

  void writeMask(const Frame& frame, const std::string& stem, const std::string& part) {
    if (wishes_.masks == MaskFiles::None) return;
    const FrameLayer& entity = layerOf(frame, "truth.entity");
    const auto name = maskOf(stem, part);
    if (wishes_.masks == MaskFiles::Png)
      files_.writeGrey(name, frame.width, frame.height, wholeValues(entity.pixels), pictureTexts(frame), aboutOf(frame, part));
    else files_.writeTiffPageBeside(name, frame, entity, pictureOf(stem, part), aboutOf(frame, part));
  }

  /// None where the whole run's values have to be known first.
  std::optional<CodeEnds> knownEnds(const FrameLayer& layer) const {
    if (wishes_.scale) return wishes_.scale;
    if (isCounts(layer) && wishes_.depth_bits == 16) return CodeEnds{0.0, 65535.0};
    return screenEnds(layer);
  }

  static Frame pictureAlone(const Frame& frame, const FrameLayer& layer) {
    Frame alone;
    alone.camera = frame.camera, alone.number = frame.number, alone.time_s = frame.time_s, alone.width = frame.width, alone.height = frame.height;
    alone.layers = {layer};
    for (const Attribute& a : frame.attributes)
      if (a.name == kScenarioName || a.name == kScenarioHash) alone.attributes.push_back(a);
    return alone;
  }

  void writeImage(const Frame& frame, const FrameLayer& layer, const CodeEnds& ends) {
    const std::uint16_t most = wishes_.depth_bits == 16 ? 65535 : 255;
    const double step = (ends.second - ends.first) / most;
    std::vector<std::uint16_t> codes(layer.pixels.size());
    toGreyCodes(layer.pixels, ends.first, step, most, codes);
    const std::string part = partOf(frame);
    const auto name = pictureOf(frameFileStem(frame), part);
    auto texts = pictureTexts(frame);
    texts["pitviper.layer"] = layer.name + " [" + layer.unit + "]";
    texts["pitviper.low"] = print("%.17g", ends.first);
    texts["pitviper.step"] = print("%.17g", step);
    scales_[frame.camera] = {{"layer", layer.name}, {"unit", layer.unit}, {"low", ends.first}, {"step", step}};
    if (wishes_.depth_bits == 16) return files_.writeGrey(name, frame.width, frame.height, codes, texts, aboutOf(frame, part));
    Rgb8Image picture(frame.width, frame.height, {});
    for (std::size_t p = 0; p < codes.size(); ++p)
      for (std::size_t c = 0; c < 3; ++c) picture.rgb[3 * p + c] = static_cast<std::uint8_t>(codes[p]);
    files_.writePicture(name, picture, texts, aboutOf(frame, part));
  }

  LabelWishes wishes_;
  LabelClasses classes_;
  std::unique_ptr<LabelFormat> format_;
  DataSetFiles files_;
  FrameSpool spool_;
  std::map<std::string, CodeEnds> ends_;  ///< by camera, so far
  DataSetFiles::Json scales_ = DataSetFiles::Json::object();
};

std::string readPictureLayer(const Record& r, const Simulation& sim, const std::vector<std::string>& cameras) {
  if (!r.given("layer")) return "";
  const std::string layer = r.text("layer");
  for (const Camera& c : sim.cameras) {
    if (std::find(cameras.begin(), cameras.end(), c.name) == cameras.end()) continue;
    std::vector<std::string> layers;
    for (const ChannelOutput& o : c.outputs) layers.push_back(o.layer());
    if (std::find(layers.begin(), layers.end(), layer) == layers.end())
      throw unknownWord(r.where("layer"), "camera '" + c.name + "' has no layer", layer, layers, "choose one, or leave the camera out of 'cameras'");
  }
  return layer;
}

std::optional<CodeEnds> readCodeEnds(const Record& r) {
  if (!r.given("scale")) return std::nullopt;
  const Value& ends = asList(r.value("scale"), "scale");
  if (ends.items.size() != 2) throw UserError(ends.where, "no scale", "[low, high] in the layer's own unit", "write two numbers");
  const CodeEnds scale = {readNumber(ends.items[0], "", "the scale"), readNumber(ends.items[1], "", "the scale")};
  if (!(scale.first < scale.second)) throw UserError(ends.where, "the scale does not rise", "[low, high]", "swap its ends");
  return scale;
}

bool hasTruth(const Camera& c, const std::string& word) {
  return word == "entity" ? c.truth.entity : word == "range" ? c.truth.range : word == "temperature" ? c.truth.temperature : c.truth.targets;
}

}  // namespace

Parameter camerasParameter() { return list("cameras", "names of those whose frames it takes; all unless given", 1); }

std::vector<std::string> readCameraNames(const Record& r, const Simulation& sim) {
  std::vector<std::string> all, some;
  for (const Camera& c : sim.cameras) all.push_back(c.name);
  if (all.empty()) throw UserError(r.where(), "a sink of pictures without a camera", "a scenario with one", "add it under 'cameras:', or remove the sink");
  if (!r.given("cameras")) return all;
  for (const Value& v : asList(r.value("cameras"), "cameras").items) {
    const std::string name = readText(v, "a camera");
    if (std::find(all.begin(), all.end(), name) == all.end()) throw unknownWord(v.where, "there is no camera", name, all);
    if (std::find(some.begin(), some.end(), name) == some.end()) some.push_back(name);
  }
  return some;
}

std::vector<Parameter> labelParameters(const char* depth) {
  std::vector<Parameter> parameters = {
      folderParameter(),
      camerasParameter(),
      text("layer", "that pictures are of, such as `mw.radiance`; unless given each camera's first"),
      withDefault(choice("depth", {"8", "16"}, "bits of a pixel. 16: grey; 8: three equal values, as programs read that expect colours"), depth),
      list("scale",
           "[low, high] in the layer's unit: what the lowest and the highest code stand for. Without it counts at 16 bits are codes as they are, and others "
           "have one scale for all pictures of a camera, from its lowest value to its highest: they are then written when the run ends",
           2, 2),
      categoriesParameter()};
  for (Parameter& p : splitParameters()) parameters.push_back(std::move(p));
  parameters.push_back(
      withDefault(choice("masks", {"none", "png", "tiff"}, "beside each picture, n of `truth.entity` in 16 bits, bodies without a category too"), "none"));
  return parameters;
}

LabelWishes readLabelWishes(const Record& r, const Simulation& sim, const std::vector<std::string>& truth) {
  LabelWishes w;
  w.folder = readFolder(r);
  w.cameras = readCameraNames(r, sim);
  const auto takes = [&](const Camera& c) { return std::find(w.cameras.begin(), w.cameras.end(), c.name) != w.cameras.end(); };
  for (const Camera& c : sim.cameras) {
    std::vector<std::string> missing;
    for (const std::string& word : truth)
      if (takes(c) && !hasTruth(c, word)) missing.push_back(word);
    if (!missing.empty())
      throw UserError(c.where, "camera '" + c.name + "' has no truth for the sink '" + r.text("sink") + "': " + listed(missing),
                      listed(truth) + " in its 'truth'", "add 'truth: [" + listed(truth) + "]' to the camera, or leave it out of the sink's 'cameras'");
  }
  w.layer = readPictureLayer(r, sim, w.cameras);
  w.depth_bits = r.text("depth") == "16" ? 16 : 8;
  w.scale = readCodeEnds(r);
  w.classes = readClasses(r, sim);
  w.split = readSplit(r);
  w.masks = r.text("masks") == "png" ? MaskFiles::Png : r.text("masks") == "tiff" ? MaskFiles::Tiff : MaskFiles::None;
  if (classesOf(w.classes, sim, w.cameras).names.empty())
    throw UserError(r.where("categories"), "there is no body to label", "a body that is no terrain and does not carry the cameras", "give one a category");
  if (w.masks != MaskFiles::None && sim.entities.size() > kMostBodies)
    throw UserError(r.where("masks"), "masks of " + std::to_string(sim.entities.size()) + " bodies", "at most 65535, which 16 bits can number",
                    "write 'masks: none'");
  return w;
}

std::unique_ptr<Sink> makeLabelledSink(const std::string& name, const LabelWishes& wishes, const Simulation& sim, const SinkPlace& place,
                                       const MakeLabelFormat& format) {
  return std::make_unique<LabelledSink>(name, wishes, sim, place.below(wishes.folder), format);
}

}  // namespace pitviper
