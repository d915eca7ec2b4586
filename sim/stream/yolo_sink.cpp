// Pictures and boxes of bodies as YOLO's trainers read them.
#include <algorithm>

#include "sim/parameters/print.hpp"
#include "sim/stream/labelled_sink.hpp"

namespace pitviper {
namespace {

constexpr const char *kClassesFile = "classes.txt", *kDataFile = "data.yaml";

class YoloFormat final : public LabelFormat {
 public:
  YoloFormat(LabelClasses classes, const DataSplit& split) : classes_(std::move(classes)), parts_(split.parts()) {}

  std::filesystem::path folderOf(const std::string& kind, const std::string& part) const override {
    return part.empty() ? std::filesystem::path(kind) : std::filesystem::path(kind) / part;
  }
  std::vector<std::string> kinds() const override { return {"labels"}; }
  std::vector<std::filesystem::path> filesOf(const std::string&, const std::string&) const override { return {}; }  // labels cannot say whose they are
  std::vector<std::filesystem::path> files() const override { return {}; }
  std::vector<std::filesystem::path> besides() const override { return {kClassesFile, kDataFile}; }

  void take(const LabelledFrame& labelled, DataSetFiles& files) override {
    const double width = labelled.frame.width, height = labelled.frame.height;
    std::string lines;
    for (const BodyMask& m : labelled.bodies)
      lines += print("%d %.9g %.9g %.9g %.9g\n", classes_.of(m.number), 0.5 * (m.left + m.right) / width, 0.5 * (m.top + m.bottom) / height,
                     (m.right - m.left) / width, (m.bottom - m.top) / height);
    files.writeTextBeside(folderOf("labels", labelled.part) / (labelled.stem + ".txt"), lines, labelled.picture);
  }

  void finish(DataSetFiles& files) override {
    std::string names, yaml;
    const DataSetFiles::Json owner = files.owner();
    for (const auto& [key, value] : owner.items()) yaml += "# " + key + " = " + value.get<std::string>() + "\n";
    // Trainers want both, whether there is a split or not.
    for (const char* wanted : {"train", "val", "test"}) {
      const bool has = std::find(parts_.begin(), parts_.end(), wanted) != parts_.end();
      if (has || wanted != std::string("test")) yaml += std::string(wanted) + ": " + folderOf("images", has ? wanted : parts_.front()).generic_string() + "\n";
    }
    yaml += "nc: " + std::to_string(classes_.names.size()) + "\nnames:\n";
    for (std::size_t c = 0; c < classes_.names.size(); ++c) {
      names += classes_.names[c] + "\n";
      yaml += "  " + std::to_string(c) + ": " + DataSetFiles::Json(classes_.names[c]).dump() + "\n";
    }
    files.writeTextBeside(kClassesFile, names, kManifest);
    files.writeTextBeside(kDataFile, yaml, kManifest);
  }

 private:
  LabelClasses classes_;
  std::vector<std::string> parts_;
};

}  // namespace

SinkModel yoloSink() {
  return {
      "yolo",
      "A data set for detectors as YOLO's trainers read it: `images/`, and in `labels/` a line for each body that `truth.entity` shows: its class, and middle "
      "and size of its box over the picture's; `classes.txt`, `data.yaml`; of a split `images/train` and so on. `manifest.json` as of `coco`. Cameras need "
      "`truth: [entity]`.",
      labelParameters("8"), [](const Record& r, const Simulation& sim) {
        return [wishes = readLabelWishes(r, sim, {"entity"})](const Simulation& simulation, const SinkPlace& place) {
          return makeLabelledSink("yolo", wishes, simulation, place, [](const LabelClasses& classes, const DataSplit& split, const std::vector<std::string>&) {
            return std::make_unique<YoloFormat>(classes, split);
          });
        };
      }};
}

}  // namespace pitviper
