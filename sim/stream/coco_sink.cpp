// Pictures and masks of bodies as a COCO data set.
#include <algorithm>

#include "sim/frame/frame_picture.hpp"
#include "sim/stream/labelled_sink.hpp"

namespace pitviper {
namespace {

using Json = DataSetFiles::Json;

Rgb8 panopticColour(int id) {
  return {static_cast<std::uint8_t>(id & 255), static_cast<std::uint8_t>(id >> 8 & 255), static_cast<std::uint8_t>(id >> 16 & 255)};
}

class CocoFormat final : public LabelFormat {
 public:
  CocoFormat(LabelClasses classes, const DataSplit& split, std::vector<std::string> cameras, bool isPanoptic)
      : classes_(std::move(classes)), cameras_(std::move(cameras)), isPanoptic_(isPanoptic) {
    for (const std::string& part : split.parts()) parts_[part];
  }

  std::filesystem::path folderOf(const std::string& kind, const std::string&) const override { return kind; }
  std::vector<std::string> kinds() const override { return isPanoptic_ ? std::vector<std::string>{"panoptic"} : std::vector<std::string>{}; }
  std::vector<std::filesystem::path> filesOf(const std::string& stem, const std::string&) const override {
    if (!isPanoptic_) return {};
    return {panopticOf(stem)};
  }
  std::vector<std::filesystem::path> files() const override {
    std::vector<std::filesystem::path> names;
    for (const auto& [part, all] : parts_) {
      names.emplace_back(named("annotations", part));
      if (isPanoptic_) names.emplace_back(named("panoptic", part));
    }
    return names;
  }

  void take(const LabelledFrame& labelled, DataSetFiles& files) override {
    const Frame& frame = labelled.frame;
    Part& part = parts_.at(labelled.part);
    const auto camera = std::find(cameras_.begin(), cameras_.end(), frame.camera) - cameras_.begin();
    // The same in every run of the scenario, whichever frames it has.
    const std::int64_t image = static_cast<std::int64_t>(frame.number) * static_cast<std::int64_t>(cameras_.size()) + camera + 1;
    part.images.push_back({{"id", image},
                           {"file_name", labelled.picture.filename().string()},
                           {"width", frame.width},
                           {"height", frame.height},
                           {"time_s", frame.time_s},
                           {"camera", frame.camera},
                           {"number", frame.number}});
    Json segments = Json::array();
    for (const BodyMask& m : labelled.bodies) {
      const std::string& name = classes_.bodies[static_cast<std::size_t>(m.number) - 1];
      const Json box = {m.left, m.top, m.right - m.left, m.bottom - m.top};
      const int category = classes_.of(m.number) + 1;
      part.annotations.push_back({{"id", ++annotations_},
                                  {"image_id", image},
                                  {"category_id", category},
                                  {"bbox", box},
                                  {"area", m.pixels},
                                  {"iscrowd", 0},
                                  {"segmentation", {{"size", {frame.height, frame.width}}, {"counts", cocoCounts(m.runs)}}},
                                  {"name", name},
                                  {"entity", m.number},
                                  {"range_m", m.range_m},
                                  {"temperature_K", m.temperature_K},
                                  {"visible_share", visibleShare(frame, name)}});
      segments.push_back({{"id", m.number}, {"category_id", category}, {"area", m.pixels}, {"bbox", box}, {"iscrowd", 0}});
    }
    if (!isPanoptic_) return;
    writePanoptic(labelled, files);
    part.panoptic.push_back({{"image_id", image}, {"file_name", panopticOf(labelled.stem).filename().string()}, {"segments_info", std::move(segments)}});
  }

  void finish(DataSetFiles& files) override {
    for (auto& [name, part] : parts_) {
      const Json about = name.empty() ? Json() : Json{{"part", name}};
      Json json = head(files, part, false);
      json["annotations"] = std::move(part.annotations);
      files.writeText(named("annotations", name), jsonText(json), about);
      if (!isPanoptic_) continue;
      json = head(files, part, true);
      json["annotations"] = std::move(part.panoptic);
      files.writeText(named("panoptic", name), jsonText(json), about);
    }
  }

 private:
  struct Part {
    Json images = Json::array(), annotations = Json::array(), panoptic = Json::array();
  };

  static std::string named(const std::string& what, const std::string& part) { return what + (part.empty() ? "" : "_" + part) + ".json"; }
  static std::filesystem::path panopticOf(const std::string& stem) { return std::filesystem::path("panoptic") / (stem + ".png"); }

  /// Of its row in the truth; NaN where it has none.
  static double visibleShare(const Frame& frame, const std::string& name) {
    for (const TargetRow& t : frame.targets)
      if (t.name == name && (t.kind == "body" || t.kind == "medium")) return t.visible;
    return NAN;
  }

  /// All but annotations.
  Json head(const DataSetFiles& files, const Part& part, bool isPanoptic) const {
    Json json;
    json["info"] = files.owner();
    json["info"]["description"] = "infrared pictures of a simulated scene";
    json["info"]["version"] = "1.0";
    json["licenses"] = Json::array();
    Json& categories = json["categories"] = Json::array();
    for (std::size_t c = 0; c < classes_.names.size(); ++c) {
      categories.push_back({{"id", c + 1}, {"name", classes_.names[c]}, {"supercategory", "body"}});
      if (isPanoptic) categories.back()["isthing"] = 1;
    }
    json["images"] = part.images;
    return json;
  }

  void writePanoptic(const LabelledFrame& labelled, DataSetFiles& files) const {
    const Frame& frame = labelled.frame;
    Rgb8Image picture(frame.width, frame.height, {});
    for (const BodyMask& m : labelled.bodies) {
      std::size_t at = 0;
      for (std::size_t k = 0; k < m.runs.size(); at += m.runs[k++])
        for (std::size_t p = at; k % 2 == 1 && p < at + m.runs[k]; ++p) {
          const auto height = static_cast<std::size_t>(frame.height);
          picture.set(static_cast<int>(p / height), static_cast<int>(p % height), panopticColour(m.number));
        }
    }
    Json about = {{"camera", frame.camera}, {"frame", frame.number}};
    if (!labelled.part.empty()) about["part"] = labelled.part;
    files.writePicture(panopticOf(labelled.stem), picture, pictureTexts(frame), about);
  }

  LabelClasses classes_;
  std::vector<std::string> cameras_;
  bool isPanoptic_;
  std::map<std::string, Part> parts_;
  std::int64_t annotations_ = 0;
};

}  // namespace

SinkModel cocoSink() {
  std::vector<Parameter> parameters = labelParameters("16");
  parameters.push_back(
      withDefault(boolean("panoptic", "also `panoptic.json` and `panoptic/`, pictures of n = R + 256 G + 65536 B; 0 where nothing has a category"), "false"));
  return {"coco",
          "A data set for detectors as COCO has it: `images/`, and `annotations.json` with boxes and masks (run lengths, as pycocotools reads them) of what "
          "`truth.entity` shows of each body, its mean range and temperature, and how much of it is visible; of a split `annotations_train.json` and so on. "
          "`manifest.json` says what it was made of, and the SHA-256 of each file. Cameras need `truth: [entity, range, temperature, targets]`.",
          parameters, [](const Record& r, const Simulation& sim) {
            return [wishes = readLabelWishes(r, sim, {"entity", "range", "temperature", "targets"}), isPanoptic = r.boolean("panoptic")](
                       const Simulation& simulation, const SinkPlace& place) {
              return makeLabelledSink("coco", wishes, simulation, place,
                                      [isPanoptic](const LabelClasses& classes, const DataSplit& split, const std::vector<std::string>& cameras) {
                                        return std::make_unique<CocoFormat>(classes, split, cameras, isPanoptic);
                                      });
            };
          }};
}

}  // namespace pitviper
