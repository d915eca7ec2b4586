#include "scenarios/commands/run_sinks.hpp"

#include <algorithm>

#include "scenarios/commands/pose_files.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/spectral_image.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/table.hpp"
#include "sim/parameters/units.hpp"
#include "sim/plan/plan_origin.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

Location ofOption(const std::string& option) { return {option, 0, 0, -1}; }

/// "layer=a:b" in the layer's unit.
PreviewRanges previewRanges(const std::vector<std::string>& texts, const Simulation& sim) {
  PreviewRanges ranges;
  for (const auto& text : texts) {
    const Location where = ofOption("--preview-range " + text);
    const size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
    if (equals == std::string::npos || colon == std::string::npos)
      throw UserError(where, "not a range", "layer=low:high", "write --preview-range lw.radiance=28:45");
    const std::string layer = text.substr(0, equals);
    std::vector<std::string> layers;
    for (const auto& c : sim.cameras)
      for (const auto& out : c.outputs) layers.push_back(out.layer());
    if (std::find(layers.begin(), layers.end(), layer) == layers.end()) throw unknownWord(where, "there is no layer", layer, layers);
    auto number = [&](const std::string& t) {
      const auto q = splitQuantity(t);
      if (!q || !q->unit.empty())
        throw UserError(where, "'" + t + "' is not a number", "numbers in the layer's own unit", "write --preview-range " + layer + "=28:45");
      return q->value;
    };
    ranges[layer] = {number(text.substr(equals + 1, colon - equals - 1)), number(text.substr(colon + 1))};
    if (!(ranges[layer].first < ranges[layer].second)) throw UserError(where, "the range does not rise", "low:high", "swap its ends");
  }
  return ranges;
}

/// What a run would write, and who: more names than this are not held against each other.
constexpr size_t kMostNames = 200000;

/// Kinds of frames of a camera.
std::vector<const char*> kindsOf(const Camera& c) { return c.spectralImage ? std::vector<const char*>{"", kSpectralKind} : std::vector<const char*>{""}; }

/// Each is the plan of the camera that it is named after.
void readPlans(const std::vector<std::string>& names, Simulation& sim) {
  for (const std::string& name : names) {
    const std::filesystem::path file = name;
    const Location where{name, 0, 0, -1};
    const auto camera = std::find_if(sim.cameras.begin(), sim.cameras.end(), [&](const Camera& c) { return c.name == file.stem().string(); });
    if (camera == sim.cameras.end())
      throw UserError(where, "a plan of no camera of this scenario", "a file named after a camera, CAMERA.plan", "name the .plan file that a run wrote");
    camera->plan = readWholeFile(file, {}, where);
    camera->planFile = name;
    if (!camera->spectral.reference) continue;  // what draws by it looks whether it is its own
    if (const auto origin = readOrigin(camera->plan)) drawOnLinesOf(*camera, *origin);
    else
      throw UserError(where, "not a plan, or not one that says what it was made for", "the plan that a run of this scenario wrote, whole",
                      "name the .plan file whose pictures the reference is to be held beside");
  }
}

}  // namespace

void PictureWish::settle(const Simulation& sim) {
  style.ranges = previewRanges(ranges, sim);
  const bool ofStyle = !ranges.empty() || scaled || coloured || style.plain || style.truth;
  previews = previews || (ofStyle && !sheet && video.empty());
  // Of one film one scale: frames that differ in brightness are to look so.
  if (!scaled && (sheet || !video.empty())) style.ownScale = false;
}

std::vector<Option> drawOptions(DrawWish& w) {
  PictureWish& p = w.pictures;
  std::vector<std::string> palettes = colourMapNames();
  palettes.insert(palettes.begin(), "auto");
  const auto colour = [&p, palettes](const std::string& text, const Location& where) {
    if (std::find(palettes.begin(), palettes.end(), text) == palettes.end()) throw unknownWord(where, "there is no palette", text, palettes);
    p.style.palette = text, p.coloured = true;
  };
  const auto scale = [&p](const std::string& text, const Location& where) { readScale(text, where, p.style), p.scaled = true; };
  const auto video = [&p](const std::string& text, const Location& where) { readVideoName(text, where), p.video = text; };
  return joined(scenarioOptions(w.scenario),
                std::vector<Option>{{"--plan", "FILE...",
                                     "draws a camera with the plan of another run of this scenario, FOLDER/CAMERA.plan: the same scenario and plan give the "
                                     "same bytes; with --set accuracy=reference the reference of that run, along its lines; of anything else's it is refused",
                                     into(w.plans)},
                                    {"--poses", "FILE...",
                                     "CAMERA_poses.csv, as a run with a gimbal leaves it: the camera looks where that says, frame by frame", into(w.poses)},
                                    {"--overwrite", "", "also replaces files of other scenarios, and files that are not of this program", into(w.overwrites)},
                                    {"", "", "Pictures", {}},
                                    {"--preview", "", "also a PNG per frame: every channel with colour bar and unit", into(p.previews)},
                                    {"--preview-range", "LAYER=LOW:HIGH...",
                                     "ends of a layer's colour bar, in its unit (implies --preview). Without it the bar runs from the 0.5 to the 99.8 "
                                     "percentile, and is bent where a few bright things would hide the rest",
                                     into(p.ranges)},
                                    {"--video", "FILE.mp4", "also a film of the previews (of several cameras one each, FILE_<camera>.mp4); by ffmpeg", {video}},
                                    {"--sheet", "", "also <camera>_sheet.png: up to twenty pictures of the first layer, evenly over the run", into(p.sheet)},
                                    {"--scale",
                                     "WHICH",
                                     "of colour bars. frame: each picture its own (previews unless given); run: one for all, drawn when the run ends (films "
                                     "and sheets unless given); LOW:HIGH: these ends, in the layers' unit",
                                     {scale}},
                                    {"--palette", "NAME", "auto: white_hot below 0.9 um, else thermal", {colour, listed(palettes)}},
                                    {"--plain", "", "pixels alone, one to one: no bar, no words", into(p.style.plain)},
                                    {"--truth", "", "truth layers too", into(p.style.truth)}});
}

Simulation DrawWish::read() const {
  Simulation sim = scenario.read();
  refuseBeyondMemory(sim);
  readPlans(plans, sim);
  replayPoses(poses, sim);
  return sim;
}

std::vector<PlacedSink> makeSinks(const Simulation& sim, const SinkPlace& place, const PictureWish& pictures) {
  std::vector<PlacedSink> sinks;
  for (const SinkChoice& choice : sim.sinks) sinks.push_back({choice.make(sim, place), choice.where});
  if (sim.sinks.empty()) {
    sinks.push_back({sinkNamed("files", sim).make(sim, place), {}});
    if (std::any_of(sim.cameras.begin(), sim.cameras.end(), [](const Camera& c) { return c.truth.targets; }))
      sinks.push_back({sinkNamed("truth", sim).make(sim, place), {}});
  }
  for (PlacedSink& placed : makePictures(sim, place, pictures)) sinks.push_back(std::move(placed));
  return sinks;
}

std::vector<PlacedSink> makePictures(const Simulation& sim, const SinkPlace& place, const PictureWish& pictures) {
  std::vector<PlacedSink> sinks;
  if (!pictures.any()) return sinks;
  std::vector<std::unique_ptr<PictureUser>> users;
  if (pictures.previews) users.push_back(previewFiles(place));
  if (pictures.sheet) users.push_back(contactSheets(place));
  if (!pictures.video.empty()) users.push_back(videoFiles(sim, place, pictures.video, 0.0));
  sinks.push_back({makePictureSink(pictures.style, std::move(users), place), ofOption(pictures.previews ? "--preview"
                                                                                      : pictures.sheet  ? "--sheet"
                                                                                                        : "--video")});
  return sinks;
}

void refuseClashes(const Simulation& sim, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks) {
  std::map<std::string, std::pair<const PlacedSink*, std::string>> files;  // who writes it, and of which camera
  const auto clash = [](const Location& where, const std::filesystem::path& file) {
    throw UserError(where, "two sinks write '" + file.string() + "', or one writes into it as a folder", "sinks whose files lie apart",
                    "give this one a 'folder:' of its own, or remove it");
  };
  for (const auto& file : own) files[file.lexically_normal().string()] = {nullptr, ""};
  // One file may be of many frames of a camera, but of one camera and sink alone.
  for (int number = range.first; number <= range.last && files.size() < kMostNames; ++number)
    for (const Camera& c : sim.cameras)
      for (const PlacedSink& placed : sinks)
        for (const char* kind : kindsOf(c))
          for (const auto& file : placed.sink->filesOf(c.name, number, kind)) {
            const std::pair<const PlacedSink*, std::string> who{&placed, c.name};
            const auto [at, isNew] = files.emplace(file.lexically_normal().string(), who);
            if (!isNew && at->second != who) clash(placed.where, file);
          }
  for (const PlacedSink& placed : sinks)
    for (const Camera& c : sim.cameras)
      for (const auto& file : placed.sink->filesOf(c.name, range.first, "")) {
        const auto name = file.lexically_normal();
        for (auto above = name.parent_path(); !above.empty() && above != above.root_path(); above = above.parent_path())
          if (files.count(above.string())) clash(placed.where, above);
      }
}

void refuseForeignFiles(const Simulation& sim, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks) {
  std::filesystem::path last;
  for (int number = range.first; number <= range.last; ++number)
    for (const Camera& c : sim.cameras)
      for (const PlacedSink& placed : sinks)
        for (const char* kind : kindsOf(c))
          for (const auto& file : placed.sink->filesOf(c.name, number, kind))
            if (file != std::exchange(last, file)) refuseForeignFile(file, sim);
  for (const auto& file : own) refuseForeignFile(file, sim);
}

}  // namespace pitviper
