#include "scenarios/commands/pixel_terms.hpp"

#include <algorithm>
#include <cstdio>
#include <set>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/frame/pixel_parts.hpp"
#include "sim/gl/context.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {
namespace {

std::string textAttribute(const ExrImage& image, const std::string& name) {
  const Attribute* a = image.findAttribute(name);
  const auto* text = a ? std::get_if<std::string>(&a->value) : nullptr;
  return text ? *text : "";
}

int wholeAttribute(const ExrImage& image, const std::string& name) {
  const Attribute* a = image.findAttribute(name);
  const auto* value = a ? std::get_if<int>(&a->value) : nullptr;
  return value ? *value : -1;
}

/// The frame's camera.
const Camera& cameraOf(const ExrImage& frame, const std::string& file, const Simulation& sim) {
  const std::string name = textAttribute(frame, "pitviper.camera");
  for (const Camera& c : sim.cameras)
    if (c.name == name && c.pinhole.width == frame.width && c.pinhole.height == frame.height) return c;
  throw UserError({file, 0, 0, -1}, "a frame of a camera '" + name + "' that the scenario does not have", "a frame that a run of it wrote",
                  "name the frame's own scenario");
}

/// Where the frame says that its camera was.
Pose poseOf(const ExrImage& frame, const Simulation& sim, const std::string& file) {
  const auto numbers = [&](const char* name, std::size_t count) {
    const Attribute* a = frame.findAttribute(name);
    const auto values = a ? numbersOf(*a) : std::nullopt;
    if (!values || values->size() != count)
      throw UserError({file, 0, 0, -1}, std::string("a frame without '") + name + "'", "a frame as a run wrote it", "draw the frame again");
    return *values;
  };
  const auto p = numbers("pitviper.pose_local_m", 3), q = numbers("pitviper.orientation_ecef_wxyz", 4);
  return {{p[0], p[1], p[2]}, glm::normalize(glm::inverse(glm::quat_cast(sim.frame.ecefFromLocal())) * glm::dquat(q[0], q[1], q[2], q[3]))};
}

/// Of each channel the first output that the frame has a layer of, in its unit.
std::vector<size_t> toldOutputs(const ExrImage& frame, const Camera& camera) {
  std::vector<size_t> told;
  std::set<std::string> channels;
  for (size_t o = 0; o < camera.outputs.size(); ++o)
    if (frame.find(camera.outputs[o].layer()) && channels.insert(camera.outputs[o].channel).second) told.push_back(o);
  return told;
}

}  // namespace

void printPixelTerms(const ExrImage& frame, const std::string& file, int column, int row, const ScenarioWish& scenario) {
  const Simulation sim = scenario.read();
  if (textAttribute(frame, kScenarioHash) != sim.sha256 || textAttribute(frame, kScenarioContent) != sim.content)
    throw UserError({file, 0, 0, -1}, "not a frame of '" + scenario.file + "' as it is now", "the scenario that the frame was drawn from, with the same --set",
                    "name that one, or draw the frame again");
  const Camera& camera = cameraOf(frame, file, sim);
  const GlContext context;
  PixelPartsMeter meter(sim, camera, shaderLibrary(), std::make_shared<const GpuScene>(sim));
  const int number = wholeAttribute(frame, "pitviper.frame");
  WorldState state = advance(sim, sim.time.at(number));
  if (camera.follower) state = pointed(std::move(state), camera, poseOf(frame, sim, file));
  const size_t pixel = static_cast<size_t>(row) * static_cast<size_t>(frame.width) + static_cast<size_t>(column);
  const auto outputs = toldOutputs(frame, camera);
  const PixelParts parts = meter.at(state, column, row);

  std::printf("camera %s, frame %d, pixel %d,%d: every wavelength, in double precision\n\n%-44s", camera.name.c_str(), number, column, row, "");
  for (size_t o : outputs) std::printf(" %26s", (parts.columns[o].layer + " [" + parts.columns[o].unit + "]").c_str());
  std::printf("\n");
  const auto ofOutputs = [&](const std::vector<double>& values) {
    std::vector<double> told;
    for (size_t o : outputs) told.push_back(values[o]);
    return told;
  };
  const std::vector<double> all = ofOutputs(parts.all);
  const auto print = [&](const std::string& name, const std::vector<double>& values) {
    std::printf("%-44s", name.c_str());
    for (size_t k = 0; k < values.size(); ++k) std::printf(" %14.6g %9.4g %%", values[k], all[k] != 0.0 ? 100.0 * values[k] / all[k] : 0.0);
    std::printf("\n");
  };
  for (const PixelParts::Row& part : parts.rows) {
    const auto values = ofOutputs(part.values);
    if (std::any_of(values.begin(), values.end(), [](double v) { return v != 0.0; })) print(part.name, values);
  }
  print(!camera.hasStages() ? "all of it" : "all of it, before the sensor's stages", all);
  std::vector<double> own;
  for (size_t o : outputs) own.push_back(static_cast<double>(frame.find(camera.outputs[o].layer())->pixels[pixel]));
  print(!camera.hasStages() ? "this frame" : "this frame, after them", own);
}

}  // namespace pitviper
