// What lens, detector and electronics a camera has, and its channels of their own.
#include <algorithm>

#include "scenarios/reader/builder.hpp"
#include "sensors/stages.hpp"

namespace pitviper {
namespace {

/// Frames that are drawn before the first for a detector's memory.
constexpr int kMostWarmUp = 256;

const StageModel* modelOf(const Value& stage) {
  const Value* name = stage.find("stage");
  return name ? stageModels().named(name->text) : nullptr;
}

/// The stages of a channel: its camera's, each of its own in place of the camera's of that name; others of its own behind these, before what takes pixels where
/// they do not.
std::vector<const Value*> together(const std::vector<Value>& cameras, const std::vector<Value>& own) {
  std::vector<const Value*> all;
  for (const Value& v : cameras) all.push_back(&v);
  std::vector<const Value*> left = all;  // of the camera's, those that none of its own takes the place of
  for (const Value& v : own) {
    const auto same = std::find_if(left.begin(), left.end(), [&](const Value* other) { return modelOf(v) && modelOf(*other) == modelOf(v); });
    if (same != left.end()) {
      *std::find(all.begin(), all.end(), *same) = &v;
      left.erase(same);
      continue;
    }
    const auto isDetector = [](const Value* other) { return modelOf(*other) && modelOf(*other)->isDetector; };
    all.insert(modelOf(v) && modelOf(v)->isDetector ? all.end() : std::find_if(all.begin(), all.end(), isDetector), &v);
  }
  return all;
}

/// `seen`: the camera with the outputs that they are of; gets them.
void readList(const std::vector<const Value*>& list, double step_s, Camera& seen) {
  for (const Value* s : list) {
    seen.stages.push_back(readStage(*s, seen));
    const StageChoice& own = seen.stages.back();
    const auto isBefore = [&](const StageChoice& other) { return &other != &own && other.onPixels && (!own.onPixels || other.detector); };
    if (std::any_of(seen.stages.begin(), seen.stages.end(), isBefore))
      throw UserError(s->where,
                      own.detector   ? "a second detector"
                      : own.onPixels ? "a stage of the film after its detector"
                                     : "optics after the detector",
                      "the order in which light meets them", "move it to the front, or remove it");
    if (const int frames = warmUpOf(seen, step_s); frames > kMostWarmUp)
      throw UserError(s->where, "a detector that remembers " + std::to_string(frames) + " frames", "at most " + std::to_string(kMostWarmUp),
                      "lower its time constant or lag, or the frame rate");
    const Camera drawn = drawnCamera(seen);
    if (tooLarge(drawn) || !drawn.pinhole.isFlat())
      throw UserError(s->where,
                      "with its margin and cells the picture would have " + std::to_string(drawn.pinhole.width) + "x" +
                          std::to_string(drawn.pinhole.height) + " cells of " + std::to_string(drawn.samples) + "x" + std::to_string(drawn.samples) +
                          " subpixels",
                      "at most 67 million, 16384 on a side, within 176 deg", "lower film or samples, or ask less of the stage");
  }
}

}  // namespace

bool makesCounts(const Value& stages) {
  return std::any_of(stages.items.begin(), stages.items.end(), [](const Value& v) { return modelOf(v) && modelOf(v)->isDetector; });
}

void Builder::readStages(const Record& r, Camera& camera) const {
  const std::vector<Value> none;
  const std::vector<Value>& cameras = r.given("stages") ? r.value("stages").items : none;
  const auto seenBy = [&](const auto& isSeen) {
    Camera seen = camera;
    seen.stages.clear();
    seen.ownChannels.clear();
    std::erase_if(seen.outputs, [&](const ChannelOutput& o) { return !isSeen(o.channel); });
    return seen;
  };
  Camera common = seenBy([&](const std::string& channel) { return !camera.ownChannel(channel); });
  readList(together(cameras, none), simulation_.time.step_s, common);
  std::vector<const Value*> unused;  // of the camera's: each channel has its own in their place
  for (const Value& v : cameras) unused.push_back(&v);
  // What a sensor's file has besides is no mistake of the scenario.
  std::erase_if(unused, [&](const Value* v) { return !common.outputs.empty() || v->where.file != camera.where.file; });
  if (r.given("channels"))
    for (const Value& channel : r.value("channels").items) {
      const auto own = camera.ownChannels.find(channel.find("name")->text);
      if (own == camera.ownChannels.end()) continue;
      const Value* list = channel.find("stages");
      const std::vector<Value>& stages = list ? list->items : none;
      Camera seen = seenBy([&](const std::string& name) { return name == own->first; });
      seen.exposure_s = camera.exposureOf(own->first);
      const std::vector<const Value*> all = together(cameras, stages);
      std::erase_if(unused, [&](const Value* v) { return std::find(all.begin(), all.end(), v) != all.end(); });
      readList(all, simulation_.time.step_s, seen);
      // Places in a picture, and in what is said of it, are the camera's.
      for (const Value& s : stages)
        if (modelOf(s) && std::any_of(seen.stages.begin(), seen.stages.end(), [&](const StageChoice& c) { return c.place && c.name == modelOf(s)->name; }))
          throw UserError(s.where, "a " + modelOf(s)->name + " of one channel, which would move its picture off the others'",
                          "it among the camera's own 'stages'", "move it there");
      own->second.stages = std::move(seen.stages);
    }
  if (!unused.empty())
    throw UserError(unused.front()->where, "a stage that no channel of camera '" + camera.name + "' has: each has its own in its place",
                    "it for channels that have none, or none", "remove it, or one of theirs");
  camera.stages = std::move(common.stages);
  const Camera drawn = drawnCamera(camera);
  if (tooLarge(drawn) || !drawn.pinhole.isFlat())
    throw UserError(r.where("channels"),
                    "with the margins and cells of all channels' stages the picture would have " + std::to_string(drawn.pinhole.width) + "x" +
                        std::to_string(drawn.pinhole.height) + " cells",
                    "at most 67 million subpixels, 16384 on a side, within 176 deg", "lower film or samples, or ask less of the stages");
}

}  // namespace pitviper
