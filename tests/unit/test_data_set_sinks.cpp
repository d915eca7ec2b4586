// Data sets for detectors: what is in their files, against the frames that went in, by readers of their own.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/version.hpp"
#include "sim/image/png.hpp"
#include "sim/image/tiff.hpp"
#include "sim/model/simulation.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/stream/body_masks.hpp"
#include "sim/stream/data_split.hpp"
#include "sim/stream/hdf5/hdf5_module.hpp"
#include "sim/stream/label_classes.hpp"
#include "sim/stream/sink_models.hpp"
#include "tests/support/read_png.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

using Json = nlohmann::ordered_json;

const std::vector<std::string> kBodies = {"jet", "hill", "tank", "decoy", "carrier", "boat"};
constexpr int kHill = 2, kDecoy = 4, kCarrier = 5;  // as truth.entity numbers them, from 1

/// Two cameras on one carrier, with all truth that data sets want; terrain among the bodies.
Simulation labelledScene() {
  Simulation sim;
  sim.name = "labelled";
  sim.sha256 = std::string(64, 'a');
  sim.content = std::string(64, 'c');
  sim.seed = 77;
  for (std::size_t e = 0; e < kBodies.size(); ++e) {
    Entity body;
    body.name = kBodies[e];
    auto mesh = std::make_shared<Mesh>();
    mesh->heightField = e + 1 == kHill;
    body.mesh = mesh;
    sim.entities.push_back(body);
  }
  for (const char* name : {"wide", "narrow"}) {
    Camera c;
    c.name = name;
    c.where = {"scene.yaml", name == std::string("wide") ? 10 : 20, 5, -1};
    c.truth.entity = c.truth.range = c.truth.temperature = c.truth.targets = true;
    c.mount.carrier = kCarrier - 1;
    ChannelOutput radiance;
    radiance.channel = "mw", radiance.quantity = "radiance", radiance.unit = "W/(m2 sr)";
    c.outputs = {radiance};
    sim.cameras.push_back(c);
  }
  return sim;
}

/// Rectangles of random bodies over each other, with holes: runs of all kinds.
Frame labelledFrame(const std::string& camera, int number) {
  Frame f;
  f.camera = camera, f.number = number, f.time_s = 0.04 * number;
  f.width = camera == "wide" ? 37 : 16, f.height = camera == "wide" ? 23 : 40;
  const auto count = static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height);
  std::mt19937 random(static_cast<unsigned>(number) * 2u + (camera == "wide"));
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  FrameLayer radiance{"mw.radiance", "W/(m2 sr)", std::vector<float>(count)}, entity{"truth.entity", "1", std::vector<float>(count)},
      range{"truth.range", "m", std::vector<float>(count)}, temperature{"truth.temperature", "K", std::vector<float>(count)};
  for (int k = 0; k < 9; ++k) {
    const int body = upTo(static_cast<int>(kBodies.size()) + 1), x0 = upTo(f.width), y0 = upTo(f.height), w = 1 + upTo(f.width), h = 1 + upTo(f.height);
    if (body == kCarrier) continue;  // no camera sees what carries it
    for (int y = y0; y < std::min(y0 + h, f.height); ++y)
      for (int x = x0; x < std::min(x0 + w, f.width); ++x)
        if (upTo(7) > 0) entity.pixels[static_cast<std::size_t>(y * f.width + x)] = static_cast<float>(body);
  }
  for (std::size_t p = 0; p < count; ++p) {
    radiance.pixels[p] = 1.0f + 0.001f * static_cast<float>(upTo(4000));
    range.pixels[p] = 500.0f + 10.0f * entity.pixels[p] + 0.01f * static_cast<float>(upTo(100));
    temperature.pixels[p] = 280.0f + entity.pixels[p] + 0.1f * static_cast<float>(upTo(10));
  }
  f.layers = {radiance, range, entity, temperature};
  f.attributes = {
      {kScenarioName, std::string("labelled")}, {kScenarioHash, std::string(64, 'a')}, {"pitviper.plan", std::string(camera == "wide" ? "1234abcd" : "77ee")}};
  for (int body : {1, 3, 6}) {
    TargetRow row;
    row.name = kBodies[static_cast<std::size_t>(body) - 1], row.kind = "body";
    row.column = 0.5 * body, row.range_m = 500.0 + body, row.visible = 0.1 * body + 0.001 * number;
    row.channels = {{"mw", "W/sr", 2.0 * body, 3.0 * body, 4.0 * body, 5.0 * body, body}};
    if (number % 2 == 0 || body != 3) f.targets.push_back(row);  // one that is not always there
  }
  return f;
}

const std::vector<int> kNumbers = {0, 1, 4, 17, 18, 90, 4711};  // rising, with gaps

std::vector<Frame> labelledFrames() {
  std::vector<Frame> frames;
  for (int number : kNumbers)
    for (const char* camera : {"wide", "narrow"}) frames.push_back(labelledFrame(camera, number));
  return frames;
}

/// A sink as a scenario has it.
std::unique_ptr<Sink> sinkOf(const std::string& yaml, const Simulation& sim, const SinkPlace& place) {
  return readSink(parseYaml(yaml, "scene.yaml"), sim).make(sim, place);
}

void pass(Sink& sink, const std::vector<Frame>& frames) {
  sink.start();
  for (const Frame& f : frames) sink.take(std::make_shared<Frame>(f));
  sink.finish({});
}

std::string refusalOf(const std::string& yaml, const Simulation& sim) {
  try {
    readSink(parseYaml(yaml, "scene.yaml"), sim);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

Json jsonOf(const std::filesystem::path& file) { return Json::parse(readWholeFile(file)); }

const std::vector<float>& pixelsOf(const Frame& f, const std::string& layer) {
  return std::find_if(f.layers.begin(), f.layers.end(), [&](const FrameLayer& l) { return l.name == layer; })->pixels;
}

/// Run lengths from COCO's text, by its description: base 32 with a bit that says there is more, of signed differences from the run but one before.
std::vector<long> runsOf(const std::string& text) {
  std::vector<long> runs;
  for (std::size_t at = 0; at < text.size();) {
    long value = 0, weight = 1;
    for (int group = 32; group & 32; weight *= 32) {
      group = text.at(at++) - 48;
      value += weight * (group & 31);
      if (!(group & 32) && (group & 16)) value -= 32 * weight;
    }
    runs.push_back(runs.size() > 2 ? value + runs[runs.size() - 2] : value);
  }
  return runs;
}

/// Row-major, 1 where the mask is.
std::vector<int> maskOf(const std::string& text, int width, int height) {
  std::vector<int> mask(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  long at = 0;
  int value = 0;
  for (long run : runsOf(text)) {
    for (long end = at + run; at < end; ++at) mask.at(static_cast<std::size_t>(at % height * width + at / height)) = value;
    value = 1 - value;
  }
  EXPECT_EQ(at, static_cast<long>(mask.size())) << "runs cover the picture";
  return mask;
}

// By hand from maskApi.c: 100 = 4 + 3 x 32, "4 and more" is 48 + 36 = 'T', 3 is '3', which pycocotools says of ten by ten zeros; the runs of its header's two
// examples; 1000 = 8 + 31 x 32, whose 31 wants a third group for its sign, as 16 does a second; 3 - 1000 = -997 = 27 - 32 x 32, -32 = 0 - 32, -1.
TEST(BodyMasks, TextIsCocos) {
  EXPECT_EQ(cocoCounts({100}), "T3");
  EXPECT_EQ(cocoCounts({2, 3, 1, 1}), "231N");
  EXPECT_EQ(cocoCounts({0, 6, 1}), "061");
  EXPECT_EQ(cocoCounts({5, 1000, 7, 3}), "5Xo07kPO");
  EXPECT_EQ(cocoCounts({15, 16, 0, 0}), "?`00@");
}

// What pycocotools' own tests have: a box of rows 2, 3 and columns 3 to 5 in ten by ten; and an L of two by two from the first pixel's neighbours on.
TEST(BodyMasks, BoxesAndRunsOfSmallMasks) {
  Frame f;
  f.width = f.height = 10;
  f.layers = {{"truth.entity", "1", std::vector<float>(100)}};
  for (std::size_t y : {2u, 3u})
    for (std::size_t x : {3u, 4u, 5u}) f.layers[0].pixels[10 * y + x] = 2.0f;
  const auto all = [](int) { return true; };
  std::vector<BodyMask> masks = bodyMasks(f, all);
  ASSERT_EQ(masks.size(), 1u);
  EXPECT_EQ(std::vector<int>({masks[0].left, masks[0].top, masks[0].right, masks[0].bottom, masks[0].number}), std::vector<int>({3, 2, 6, 4, 2}));
  EXPECT_EQ(masks[0].runs, std::vector<std::uint32_t>({32, 2, 8, 2, 8, 2, 46}));
  f.width = f.height = 2;
  f.layers[0].pixels = {0, 1, 1, 1};
  masks = bodyMasks(f, all);
  EXPECT_EQ(masks[0].runs, std::vector<std::uint32_t>({1, 3})) << "down the first column, on into the second, and no run of nothing at the end";
  f.layers[0].pixels = {1, 0, 0, 0};
  EXPECT_EQ(bodyMasks(f, all)[0].runs, std::vector<std::uint32_t>({0, 1, 3}));
  EXPECT_TRUE(bodyMasks(f, [](int n) { return n > 1; }).empty());
}

TEST(BodyMasks, RunsOfAnyLengthComeBack) {
  std::mt19937 random(5);
  for (int round = 0; round < 300; ++round) {
    std::vector<std::uint32_t> runs;
    for (int k = 0; k < 1 + round % 9; ++k) runs.push_back(static_cast<std::uint32_t>(random() >> (1 + random() % 31)));
    EXPECT_EQ(runsOf(cocoCounts(runs)), std::vector<long>(runs.begin(), runs.end()));
  }
}

// Every mask, pixel by pixel, by a decoder of its own; boxes, areas, means, shares and categories by loops over the layers.
TEST(CocoSink, MasksAreTheEntityLayer) {
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  const std::vector<Frame> frames = labelledFrames();
  const auto sink =
      sinkOf("{sink: coco, folder: set, categories: {jet: vehicle, tank: vehicle, decoy: null}, masks: png, panoptic: true}", sim, {folder.path(), {}});
  pass(*sink, frames);
  const std::filesystem::path set = folder.path() / "set";
  const Json coco = jsonOf(set / "annotations.json"), panoptic = jsonOf(set / "panoptic.json");
  EXPECT_EQ(coco["categories"], Json::parse(R"([{"id":1,"name":"vehicle","supercategory":"body"},{"id":2,"name":"boat","supercategory":"body"}])"));
  EXPECT_EQ(panoptic["categories"][1]["isthing"], 1);
  EXPECT_EQ(coco["info"][kScenarioHash], sim.sha256);
  ASSERT_EQ(coco["images"].size(), frames.size());
  ASSERT_EQ(panoptic["annotations"].size(), frames.size());
  const std::map<int, int> categoryOf = {{1, 1}, {3, 1}, {6, 2}};
  std::set<long> images, ids;
  std::size_t seen = 0;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Frame& f = frames[k];
    const Json& image = coco["images"][k];
    const std::string name = frameFileStem(f) + ".png";
    EXPECT_EQ(image["file_name"], name);
    EXPECT_EQ(image["width"], f.width);
    EXPECT_EQ(image["height"], f.height);
    EXPECT_EQ(image["time_s"], f.time_s);
    EXPECT_EQ(image["camera"], f.camera);
    EXPECT_EQ(image["number"], f.number);
    EXPECT_TRUE(images.insert(image["id"].get<long>()).second);
    const auto &entity = pixelsOf(f, "truth.entity"), &range = pixelsOf(f, "truth.range"), &temperature = pixelsOf(f, "truth.temperature");
    const GreyImage masks = readPngGrey(set / "masks" / name);
    const Rgb8Image colours = readPng(set / "panoptic" / name);
    EXPECT_EQ(masks.bits, 16);
    std::vector<int> left(entity.size());  // of pixels that no annotation has claimed
    for (std::size_t p = 0; p < entity.size(); ++p) {
      EXPECT_EQ(std::lround(masks.pixels[p] * 65535.0f), std::lround(entity[p]));
      const int id = colours.rgb[3 * p] + 256 * colours.rgb[3 * p + 1] + 65536 * colours.rgb[3 * p + 2], body = static_cast<int>(entity[p]);
      EXPECT_EQ(id, categoryOf.count(body) ? body : 0);
      left[p] = categoryOf.count(body) ? body : 0;
    }
    std::size_t own = 0;
    for (const Json& a : coco["annotations"]) {
      if (a["image_id"] != image["id"]) continue;
      ++seen, ++own;
      EXPECT_TRUE(ids.insert(a["id"].get<long>()).second);
      EXPECT_GT(a["id"], 0) << "pycocotools takes 0 for no match";
      EXPECT_EQ(a["iscrowd"], 0);
      EXPECT_EQ(a["segmentation"]["size"], Json({f.height, f.width}));
      const std::vector<int> mask = maskOf(a["segmentation"]["counts"], f.width, f.height);
      const int body = a["entity"];
      EXPECT_EQ(a["category_id"], categoryOf.at(body));
      EXPECT_EQ(a["name"], kBodies[static_cast<std::size_t>(body) - 1]);
      int x0 = f.width, y0 = f.height, x1 = -1, y1 = -1;
      double ranges = 0.0, temperatures = 0.0, area = 0.0;
      for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x) {
          const auto p = static_cast<std::size_t>(y * f.width + x);
          ASSERT_EQ(mask[p], entity[p] == static_cast<float>(body)) << name << " " << x << "," << y;
          if (!mask[p]) continue;
          left[p] = 0;
          x0 = std::min(x0, x), x1 = std::max(x1, x), y0 = std::min(y0, y), y1 = std::max(y1, y);
          ranges += static_cast<double>(range[p]), temperatures += static_cast<double>(temperature[p]), area += 1.0;
        }
      EXPECT_EQ(a["bbox"], Json({x0, y0, x1 - x0 + 1, y1 - y0 + 1}));
      EXPECT_EQ(a["area"].get<double>(), area);
      // Sums of less than 900 doubles in another order.
      EXPECT_NEAR(a["range_m"].get<double>(), ranges / area, 1e-10);
      EXPECT_NEAR(a["temperature_K"].get<double>(), temperatures / area, 1e-10);
      const auto row = std::find_if(f.targets.begin(), f.targets.end(), [&](const TargetRow& t) { return t.name == a["name"]; });
      if (row == f.targets.end()) EXPECT_TRUE(a["visible_share"].is_null());
      else EXPECT_EQ(a["visible_share"], row->visible);
    }
    EXPECT_EQ(std::count(left.begin(), left.end(), 0), static_cast<long>(left.size())) << "all bodies with a category have their annotation";
    EXPECT_EQ(panoptic["annotations"][k]["segments_info"].size(), own);
    EXPECT_EQ(panoptic["annotations"][k]["image_id"], image["id"]);
  }
  EXPECT_EQ(seen, coco["annotations"].size());
  EXPECT_GT(seen, frames.size()) << "more than one body a picture";
}

/// Codes of a grey PNG.
std::vector<long> codesOf(const std::filesystem::path& file) {
  const GreyImage image = readPngGrey(file);
  std::vector<long> codes;
  for (float v : image.pixels) codes.push_back(std::lround(v * 65535.0f));
  return codes;
}

// Unless a scale is given there is one for all pictures of a camera: its lowest value is code 0, its highest 65535.
TEST(CocoSink, PicturesHaveOneScale) {
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  const std::vector<Frame> frames = labelledFrames();
  pass(*sinkOf("coco", sim, {folder.path(), {}}), frames);
  const Json manifest = jsonOf(folder.path() / "manifest.json");
  for (const Frame& f : frames) {
    double low = INFINITY, high = -INFINITY;
    for (const Frame& other : frames)
      for (float v : other.layers[0].pixels)
        if (other.camera == f.camera) low = std::min(low, static_cast<double>(v)), high = std::max(high, static_cast<double>(v));
    const Json& scale = manifest["scales"][f.camera];
    EXPECT_EQ(scale["low"], low);
    EXPECT_EQ(scale["step"], (high - low) / 65535.0);
    EXPECT_EQ(scale["layer"], "mw.radiance");
    const auto codes = codesOf(folder.path() / "images" / (frameFileStem(f) + ".png"));
    // Half a code, and three roundings in single precision of up to 65535: 0.012.
    for (std::size_t p = 0; p < codes.size(); ++p)
      EXPECT_NEAR(static_cast<double>(codes[p]), (static_cast<double>(f.layers[0].pixels[p]) - low) / (high - low) * 65535.0, 0.5 + 0.012);
  }
  const TemporaryFolder given;
  pass(*sinkOf("{sink: coco, depth: 8, scale: [2, 4], layer: mw.radiance, cameras: [narrow]}", sim, {given.path(), {}}), frames);
  EXPECT_FALSE(std::filesystem::exists(given.path() / "images/wide_00000.png"));
  const Rgb8Image picture = readPng(given.path() / "images/narrow_00004.png");
  const Frame f = labelledFrame("narrow", 4);
  for (std::size_t p = 0; p < f.layers[0].pixels.size(); ++p) {
    const double code = std::clamp((static_cast<double>(f.layers[0].pixels[p]) - 2.0) / 2.0 * 255.0, 0.0, 255.0);
    EXPECT_NEAR(picture.rgb[3 * p], code, 0.5 + 1e-4) << "half a code and single precision of up to 510";
    EXPECT_TRUE(picture.rgb[3 * p] == picture.rgb[3 * p + 1] && picture.rgb[3 * p] == picture.rgb[3 * p + 2]);
  }
  // Counts are whole: their codes are they.
  Simulation counting = sim;
  std::vector<Frame> counts = frames;
  for (Camera& c : counting.cameras) c.outputs[0].quantity = "counts", c.outputs[0].unit = "count";
  for (Frame& counted : counts) {
    counted.layers[0].name = "mw.counts", counted.layers[0].unit = "count";
    for (float& v : counted.layers[0].pixels) v = std::round(3000.0f * v);
  }
  const TemporaryFolder third;
  pass(*sinkOf("coco", counting, {third.path(), {}}), counts);
  const auto codes = codesOf(third.path() / "images/wide_00017.png");
  const Frame& counted = *std::find_if(counts.begin(), counts.end(), [](const Frame& c) { return c.camera == "wide" && c.number == 17; });
  for (std::size_t p = 0; p < codes.size(); ++p) EXPECT_EQ(codes[p], std::lround(counted.layers[0].pixels[p]));
}

// Files are what the manifest says of them, and all that there is.
TEST(DataSetManifest, KnowsAllFiles) {
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  const std::vector<Frame> frames = labelledFrames();
  const auto sink = sinkOf("{sink: coco, masks: tiff, panoptic: true, split: {train: 0.5, val: 0.3, test: 0.2}, seed: 9}", sim, {folder.path(), {}});
  pass(*sink, frames);
  const Json manifest = jsonOf(folder.path() / "manifest.json");
  EXPECT_EQ(manifest[kScenarioName], "labelled");
  EXPECT_EQ(manifest[kScenarioHash], sim.sha256);
  EXPECT_EQ(manifest[kScenarioContent], sim.content);
  EXPECT_EQ(manifest["pitviper.seed"], 77);
  EXPECT_EQ(manifest["pitviper.version"], kVersion);
  EXPECT_EQ(manifest["plans"], Json::parse(R"({"narrow":["77ee"],"wide":["1234abcd"]})"));
  EXPECT_EQ(manifest["split"], Json::parse(R"({"seed":9,"train":0.5,"val":0.3,"test":0.2})"));
  std::set<std::string> told, there;
  std::map<std::string, std::string> partOf;
  for (const Json& entry : manifest["files"]) {
    const std::string name = entry["file"];
    EXPECT_TRUE(told.insert(name).second) << name;
    EXPECT_EQ(entry["sha256"], sha256(readWholeFile(folder.path() / name))) << name;
    if (entry.contains("part")) partOf[name] = entry["part"];
  }
  for (const auto& at : std::filesystem::recursive_directory_iterator(folder.path()))
    if (at.is_regular_file()) there.insert(std::filesystem::relative(at.path(), folder.path()).string());
  EXPECT_EQ(there.erase("manifest.json"), 1u);
  EXPECT_EQ(told, there) << "and nothing under a temporary name";
  // Each picture is in one part's file, that which the manifest says; its mask is the entity layer.
  std::size_t images = 0;
  for (const char* part : {"train", "val", "test"})
    for (const char* file : {"annotations_", "panoptic_"}) {
      const Json json = jsonOf(folder.path() / (std::string(file) + part + ".json"));
      for (const Json& image : json["images"]) {
        const std::string name = image["file_name"];
        EXPECT_EQ(partOf["images/" + name], part);
        EXPECT_EQ(partOf["panoptic/" + name], part);
        ++images;
      }
    }
  EXPECT_EQ(images, 2 * frames.size());
  const PictureFile mask = readTiff(folder.path() / "masks/wide_00090.tif");
  ASSERT_EQ(mask.pictures.size(), 1u);
  EXPECT_EQ(mask.pictures[0].pixels, pixelsOf(labelledFrame("wide", 90), "truth.entity"));
  // What it says before the run that it will write is there.
  for (int number : kNumbers)
    for (const char* camera : {"wide", "narrow"})
      for (const auto& file : sink->filesOf(camera, number, "")) EXPECT_TRUE(std::filesystem::exists(file)) << file;
  EXPECT_TRUE(sink->filesOf("wide", 0, "spectral").empty());
}

// 20000 frames of two cameras. A share's count is binomial: five standard deviations are passed once in 1.7 million. Whether both cameras' frames of a number
// are in train is two coins: the same bound on their number together.
TEST(DataSplit, SharesAreKept) {
  const int count = 20000;
  DataSplit split{{{"train", 0.8}, {"val", 0.15}, {"test", 0.05}}, 3};
  const auto bound = [&](double p) { return 5.0 * std::sqrt(count * p * (1.0 - p)); };
  std::map<std::string, int> wide, narrow;
  int both = 0, sameOfOtherSeed = 0, runs = 0;
  DataSplit other = split;
  other.seed = 4;
  for (int n = 0; n < count; ++n) {
    const std::string part = split.partOf("wide", n);
    ++wide[part], ++narrow[split.partOf("narrow", n)];
    both += part == "train" && split.partOf("narrow", n) == "train";
    sameOfOtherSeed += part == "train" && other.partOf("wide", n) == "train";
    runs += part == "train" && split.partOf("wide", n + 1) == "train";
  }
  for (const auto& [name, share] : split.shares) {
    EXPECT_NEAR(wide[name], count * share, bound(share)) << name;
    EXPECT_NEAR(narrow[name], count * share, bound(share)) << name;
  }
  EXPECT_NEAR(both, count * 0.64, bound(0.64));
  EXPECT_NEAR(sameOfOtherSeed, count * 0.64, bound(0.64));
  EXPECT_NEAR(runs, count * 0.64, 2.0 * bound(0.64)) << "neighbours are independent; pairs share a frame, which at most doubles their deviation";
  EXPECT_EQ(DataSplit().partOf("wide", 1), "");
  const DataSplit whole{{{"train", 1.0}, {"val", 0.0}, {"test", 0.0}}, 1};
  for (int n = 0; n < 1000; ++n) EXPECT_EQ(whole.partOf("wide", n), "train");
}

// A picture's part, and its identity in COCO, are its own: those of a run of some frames, from the last to the first, are those of the whole run.
TEST(DataSplit, OthersDoNotMatter) {
  const Simulation sim = labelledScene();
  const std::string yaml = "{sink: coco, scale: [0, 10], split: {train: 0.5, val: 0.5}}";
  const auto partsOf = [&](const std::vector<Frame>& frames) {
    const TemporaryFolder folder;
    pass(*sinkOf(yaml, sim, {folder.path(), {}}), frames);
    std::map<std::string, std::string> parts;
    for (const char* part : {"train", "val"}) {
      const Json json = jsonOf(folder.path() / (std::string("annotations_") + part + ".json"));
      for (const Json& image : json["images"]) parts[image["file_name"]] = part + image["id"].dump();
    }
    return parts;
  };
  std::vector<Frame> frames = labelledFrames();
  const auto all = partsOf(frames);
  frames.erase(frames.begin() + 2, frames.begin() + 7);
  std::reverse(frames.begin(), frames.end());
  const auto some = partsOf(frames);
  EXPECT_EQ(all.size(), 2 * kNumbers.size());
  EXPECT_EQ(some.size(), all.size() - 5);
  for (const auto& [name, part] : some) EXPECT_EQ(all.at(name), part) << name;
}

TEST(YoloSink, BoxesAreThoseOfTheMasks) {
  const TemporaryFolder folder;
  Simulation sim = labelledScene();
  for (Camera& c : sim.cameras) c.truth.range = c.truth.temperature = c.truth.targets = false;
  const std::vector<Frame> frames = labelledFrames();
  pass(*sinkOf("{sink: yolo, categories: {hill: terrain, decoy: \"jet \\\"2\\\"\"}, split: {train: 0.5, test: 0.5}}", sim, {folder.path(), {}}), frames);
  EXPECT_EQ(readWholeFile(folder.path() / "classes.txt"), "jet\nterrain\ntank\njet \"2\"\nboat\n");
  const Value yaml = parseYaml(readWholeFile(folder.path() / "data.yaml"), "data.yaml");
  EXPECT_EQ(yaml.find("train")->text, "images/train");
  EXPECT_EQ(yaml.find("val")->text, "images/train") << "trainers want one";
  EXPECT_EQ(yaml.find("test")->text, "images/test");
  EXPECT_EQ(yaml.find("nc")->text, "5");
  EXPECT_EQ(yaml.find("names")->find("3")->text, "jet \"2\"");
  const std::map<int, int> bodyOf = {{0, 1}, {1, kHill}, {2, 3}, {3, kDecoy}, {4, 6}};
  int boxes = 0;
  for (const Frame& f : frames) {
    const bool isTrain = std::filesystem::exists(folder.path() / "images/train" / (frameFileStem(f) + ".png"));
    EXPECT_NE(isTrain, std::filesystem::exists(folder.path() / "images/test" / (frameFileStem(f) + ".png")));
    EXPECT_EQ(readPng(folder.path() / "images" / (isTrain ? "train" : "test") / (frameFileStem(f) + ".png")).width, f.width);
    std::istringstream lines(readWholeFile(folder.path() / "labels" / (isTrain ? "train" : "test") / (frameFileStem(f) + ".txt")));
    std::set<int> labelled;
    int index = -1;
    double xc = 0.0, yc = 0.0, w = 0.0, h = 0.0;
    while (lines >> index >> xc >> yc >> w >> h) {
      const int body = bodyOf.at(index);
      EXPECT_TRUE(labelled.insert(body).second);
      ++boxes;
      int x0 = f.width, y0 = f.height, x1 = 0, y1 = 0;
      for (int y = 0; y < f.height; ++y)
        for (int x = 0; x < f.width; ++x)
          if (pixelsOf(f, "truth.entity")[static_cast<std::size_t>(y * f.width + x)] == static_cast<float>(body))
            x0 = std::min(x0, x), x1 = std::max(x1, x + 1), y0 = std::min(y0, y), y1 = std::max(y1, y + 1);
      // Nine digits of numbers up to 1, times up to 40 pixels.
      EXPECT_NEAR((xc - 0.5 * w) * f.width, x0, 1e-7);
      EXPECT_NEAR((xc + 0.5 * w) * f.width, x1, 1e-7);
      EXPECT_NEAR((yc - 0.5 * h) * f.height, y0, 1e-7);
      EXPECT_NEAR((yc + 0.5 * h) * f.height, y1, 1e-7);
    }
    std::set<int> there;
    for (float v : pixelsOf(f, "truth.entity"))
      if (v > 0.0f) there.insert(static_cast<int>(v));
    EXPECT_EQ(labelled, there);
  }
  EXPECT_GT(boxes, static_cast<int>(frames.size()));
}

TEST(DataSetSinks, SayWhatTheyNeed) {
  Simulation sim = labelledScene();
  EXPECT_EQ(refusalOf("coco", sim), "");
  EXPECT_EQ(refusalOf("{sink: yolo, split: {train: 0.7, val: 0.2, test: 0.1}}", sim), "");
  sim.cameras[1].truth.range = sim.cameras[1].truth.targets = false;
  const std::string lacks = refusalOf("coco", sim);
  EXPECT_NE(lacks.find("scene.yaml:20:5"), std::string::npos) << lacks;
  EXPECT_NE(lacks.find("has no truth for the sink 'coco': range, targets"), std::string::npos) << lacks;
  EXPECT_NE(lacks.find("add 'truth: [entity, range, temperature, targets]'"), std::string::npos) << lacks;
  EXPECT_EQ(refusalOf("{sink: coco, cameras: [wide]}", sim), "");
  EXPECT_EQ(refusalOf("yolo", sim), "");
  EXPECT_EQ(refusalOf("hdf5", sim), "");
  const auto isTold = [&](const std::string& yaml, const std::string& words) {
    EXPECT_NE(refusalOf(yaml, sim).find(words), std::string::npos) << yaml << ": " << refusalOf(yaml, sim);
  };
  isTold("{sink: yolo, cameras: [wid]}", "did you mean 'wide'?");
  isTold("{sink: yolo, layer: mw.radance}", "did you mean 'mw.radiance'?");
  isTold("{sink: yolo, categories: {jett: a}}", "did you mean 'jet'?");
  isTold("{sink: yolo, categories: {jot*: a}}", "there is no entity");
  isTold("{sink: yolo, categories: {jet: null, tank: null, decoy: null, boat: null}}", "there is no body to label");
  isTold("{sink: yolo, categories: {jet: \"a\\nb\"}}", "no line of text");
  isTold("{sink: yolo, split: {train: 0.7, val: 0.2}}", "sum to 0.9");
  isTold("{sink: yolo, split: {trian: 1}}", "did you mean 'train'?");
  isTold("{sink: yolo, split: {train: 1.5, val: -0.5}}", "a share of 1.5");
  isTold("{sink: yolo, scale: [3, 2]}", "does not rise");
  isTold("{sink: yolo, depth: 12}", "depth");
  isTold("{sink: hdf5, compression: 10}", "compression");
  isTold("{sink: yolo, folder: ../elsewhere}", "outside");
}

// Files that cannot say whose they are go with those beside them that can.
TEST(DataSetSinks, FilesOfOthersStay) {
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  const std::vector<Frame> frames = labelledFrames();
  const std::string yaml = "{sink: yolo, scale: [0, 10], masks: tiff}";
  const auto of = [&](const Simulation& whose) {
    return SinkPlace{folder.path(), [&whose](const std::filesystem::path& file) { refuseForeignFile(file, whose); }};
  };
  pass(*sinkOf(yaml, sim, of(sim)), frames);
  EXPECT_NO_THROW(pass(*sinkOf(yaml, sim, of(sim)), frames)) << "once more";
  Simulation other = sim;
  other.sha256 = std::string(64, 'b');
  EXPECT_THROW(pass(*sinkOf(yaml, other, of(other)), frames), UserError);
  const TemporaryFolder mine;
  const SinkPlace place{mine.path(), [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); }};
  std::filesystem::create_directories(mine.path() / "labels");
  mine.put("labels/narrow_00000.txt", "a user's own");
  EXPECT_THROW(pass(*sinkOf(yaml, sim, place), frames), UserError);
  EXPECT_EQ(readWholeFile(mine.path() / "labels/narrow_00000.txt"), "a user's own");
  EXPECT_FALSE(std::filesystem::exists(mine.path() / "manifest.json"));
  std::filesystem::remove(mine.path() / "labels/narrow_00000.txt");
  mine.put("data.yaml", "a user's own");
  EXPECT_THROW(sinkOf(yaml, sim, place)->start(), UserError) << "before anything is drawn";
}

TEST(LabelClasses, NamesEndInAnything) {
  Simulation sim;
  for (const char* name : {"guard_0", "guard_1", "guard_10", "gate", "guardian"}) sim.entities.emplace_back().name = name;
  sim.cameras.emplace_back().name = "eye";
  const LabelClasses classes = classesOf({{"guard_*", "person"}, {"guard_1", "chief"}, {"gu*", std::nullopt}}, sim, {"eye"});
  EXPECT_EQ(classes.names, std::vector<std::string>({"person", "chief", "gate"}));
  EXPECT_EQ(classes.ofBody, std::vector<int>({0, 1, 0, 2, -1}));
  EXPECT_EQ(classes.of(1), 0);
  EXPECT_EQ(classes.of(0), -1);
  EXPECT_EQ(classes.of(6), -1);
}

// What h5py reads, a reader that shares nothing with this program but the library: values bit for bit, shapes, filters, units, attributes.
TEST(Hdf5Sink, IsReadByH5py) {
  const ModuleOnDemand module{kHdf5Module, kHdf5Function, "", "", "", ""};
  try {
    if (std::string problem; !functionIn(fileOf(module, {}), kHdf5Function, problem)) GTEST_SKIP() << problem;
  } catch (const UserError&) {
    GTEST_SKIP() << "built without HDF5";
  }
  const std::string python = run("/usr/bin/python3 -c 'import h5py'").code == 0 ? "/usr/bin/python3" : "python3";
  if (run(python + " -c 'import h5py'").code != 0) GTEST_SKIP() << "no h5py here: sudo apt-get install python3-h5py";
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  std::vector<Frame> frames = labelledFrames();
  frames[0].layers[0].pixels[3] = NAN;
  pass(*sinkOf("{sink: hdf5, folder: cubes, compression: 6}", sim, {folder.path(), {}}), frames);
  const std::string script = folder.put("read.py", R"(
import h5py, json, sys
out = {'sets': {}, 'names': []}
with h5py.File(sys.argv[1], 'r') as f:
    out['attributes'] = {k: str(v) for k, v in f.attrs.items()}
    def visit(name, d):
        out['names'].append(name)
        if not isinstance(d, h5py.Dataset):
            return
        if d.dtype.kind == 'O':
            out['sets'][name] = {'texts': list(d.asstr()[:])}
            return
        open(sys.argv[2] + '/' + name.replace('/', '_') + '.raw', 'wb').write(d[:].tobytes())
        out['sets'][name] = {'shape': d.shape, 'type': d.dtype.str, 'chunks': d.chunks, 'shuffle': d.shuffle, 'compression': d.compression,
                             'level': d.compression_opts, 'unit': d.attrs.get('unit')}
    f.visititems(visit)
print(json.dumps(out))
)");
  for (const std::string camera : {"wide", "narrow"}) {
    const Result result = run(python + " " + script + " " + (folder.path() / "cubes" / (camera + ".h5")).string() + " " + folder.path().string());
    ASSERT_EQ(result.code, 0) << result.output;
    const Json read = Json::parse(result.output);
    const std::map<std::string, std::string> attributes = {
        {kScenarioContent, sim.content}, {"pitviper.camera", camera}, {"pitviper.plan", camera == "wide" ? "1234abcd" : "77ee"},
        {kScenarioName, "labelled"},     {kScenarioHash, sim.sha256}, {"pitviper.seed", "77"},
        {"pitviper.version", kVersion}};
    EXPECT_EQ((read["attributes"].get<std::map<std::string, std::string>>()), attributes);
    const auto rawOf = [&](const std::string& name) { return readWholeFile(folder.path() / (name + ".raw")); };
    const auto bytesOf = [](const auto& values) { return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(values[0])); };
    std::vector<int> numbers;
    std::vector<double> times, ranges, saturated;
    std::map<std::string, std::string> layers;
    int width = 0, height = 0;
    for (const Frame& f : frames) {
      if (f.camera != camera) continue;
      width = f.width, height = f.height;
      numbers.push_back(f.number), times.push_back(f.time_s);
      for (const FrameLayer& l : f.layers) layers[l.name] += bytesOf(l.pixels);
      for (const char* name : {"jet", "tank", "boat"}) {
        const auto row = std::find_if(f.targets.begin(), f.targets.end(), [&](const TargetRow& t) { return t.name == name; });
        ranges.push_back(row == f.targets.end() ? static_cast<double>(NAN) : row->range_m);
        saturated.push_back(row == f.targets.end() ? static_cast<double>(NAN) : row->channels[0].saturated);
      }
    }
    for (const auto& [name, bytes] : layers) {
      const Json& set = read["sets"][name];
      EXPECT_EQ(rawOf(name), bytes) << name;
      EXPECT_EQ(set["shape"], Json({kNumbers.size(), height, width}));
      EXPECT_EQ(set["chunks"], Json({1, height, width}));
      EXPECT_EQ(set["type"], "<f4");
      EXPECT_EQ(set["shuffle"], true);
      EXPECT_EQ(set["compression"], "gzip");
      EXPECT_EQ(set["level"], 6);
    }
    EXPECT_EQ(read["sets"]["mw.radiance"]["unit"], "W/(m2 sr)");
    EXPECT_EQ(read["sets"]["truth.range"]["unit"], "m");
    EXPECT_EQ(rawOf("number"), bytesOf(numbers));
    EXPECT_EQ(rawOf("time_s"), bytesOf(times));
    EXPECT_EQ(read["sets"]["targets/names"]["texts"], Json({"jet", "tank", "boat"}));
    EXPECT_EQ(read["sets"]["targets/kinds"]["texts"], Json({"body", "body", "body"}));
    EXPECT_EQ(read["sets"]["targets/range"]["shape"], Json({kNumbers.size(), 3}));
    EXPECT_EQ(read["sets"]["targets/mw.own"]["unit"], "W/sr");
    const auto isSame = [&](const std::string& name, const std::vector<double>& wanted) {
      const std::string raw = rawOf(name);
      ASSERT_EQ(raw.size(), wanted.size() * sizeof(double));
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        double value = 0.0;
        std::memcpy(&value, raw.data() + k * sizeof(double), sizeof(double));
        EXPECT_TRUE(value == wanted[k] || (std::isnan(value) && std::isnan(wanted[k]))) << name << " " << k << ": " << value;
      }
    };
    isSame("targets_range", ranges);
    isSame("targets_mw.saturated", saturated);
    EXPECT_EQ(read["sets"].size(), 4u + 2u + 2u + 11u + 5u) << "layers, number and time, names and kinds, columns of a row and of its channel";
  }
  // Twice the same bytes, and nothing under another name.
  const TemporaryFolder again;
  const SinkPlace place{again.path(), [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); }};
  pass(*sinkOf("{sink: hdf5, compression: 1}", sim, place), frames);
  pass(*sinkOf("{sink: hdf5, compression: 6}", sim, place), frames);
  std::set<std::string> names;
  for (const auto& at : std::filesystem::directory_iterator(again.path())) names.insert(at.path().filename().string());
  EXPECT_EQ(names, std::set<std::string>({"manifest.json", "narrow.h5", "wide.h5"}));
  const Json manifest = jsonOf(again.path() / "manifest.json");
  for (const Json& entry : manifest["files"]) {
    const std::string bytes = readWholeFile(again.path() / entry["file"].get<std::string>());
    EXPECT_EQ(entry["sha256"], sha256(bytes));
    EXPECT_EQ(bytes, readWholeFile(folder.path() / "cubes" / entry["file"].get<std::string>()));
  }
  std::filesystem::remove(again.path() / "manifest.json");
  EXPECT_THROW(pass(*sinkOf("hdf5", sim, place), frames), UserError) << "whose these are nobody can say";
}

// A run that ends early leaves no file that looks whole.
TEST(Hdf5Sink, LeavesNothingHalfWritten) {
  const ModuleOnDemand module{kHdf5Module, kHdf5Function, "", "", "", ""};
  try {
    if (std::string problem; !functionIn(fileOf(module, {}), kHdf5Function, problem)) GTEST_SKIP() << problem;
  } catch (const UserError&) {
    GTEST_SKIP() << "built without HDF5";
  }
  const TemporaryFolder folder;
  const Simulation sim = labelledScene();
  {
    const auto sink = sinkOf("hdf5", sim, {folder.path(), {}});
    sink->start();
    sink->take(std::make_shared<Frame>(labelledFrame("wide", 2)));
    Frame other = labelledFrame("wide", 3);
    other.layers.pop_back();
    EXPECT_THROW(sink->take(std::make_shared<Frame>(other)), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "wide.h5"));
    ensureWritableFolder(folder.path());
    EXPECT_FALSE(std::filesystem::is_empty(folder.path())) << "what is being written stays, whoever tidies up";
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace pitviper::test
