#include "sim/frame/make_frame.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <set>
#include <stdexcept>

#include "sim/frame/file_owner.hpp"
#include "sim/frame/limits_check.hpp"
#include "sim/frame/mark_header.hpp"
#include "sim/frame/sensor_header.hpp"
#include "sim/frame/target_rows.hpp"
#include "sim/frame/version.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/haze_not_fog.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

void addTruth(Frame& frame, const Camera& camera, const CameraImage& image, const Pinhole& pinhole, const SensorChain* chain) {
  if (camera.truth.pixelSolidAngle) {
    const std::vector<double> omega_sr = chain ? pinhole.solidAngles().plain_sr : image.solidAngles->plain_sr;
    frame.layers.push_back({"truth.pixel_solid_angle", "sr", std::vector<float>(omega_sr.begin(), omega_sr.end())});
  }
  if (image.truth.empty()) return;
  auto add = [&](const char* name, const char* unit, auto value) {
    FrameLayer layer{std::string("truth.") + name, unit, {}};
    layer.pixels.reserve(static_cast<size_t>(frame.width) * static_cast<size_t>(frame.height));
    for (int row = 0; row < frame.height; ++row)
      for (int column = 0; column < frame.width; ++column) {
        const size_t own = static_cast<size_t>(row) * static_cast<size_t>(frame.width) + static_cast<size_t>(column);
        layer.pixels.push_back(value(image.truth[chain ? chain->middleCell(column, row) : own]));
      }
    frame.layers.push_back(std::move(layer));
  };
  const TruthLayers& t = camera.truth;
  if (t.range) add("range", "m", [](const TruthPixel& p) { return p.range_m; });
  if (t.entity) {
    add("entity", "1", [](const TruthPixel& p) { return p.entity; });
    add("part", "1", [](const TruthPixel& p) { return p.part; });
  }
  if (t.temperature) add("temperature", "K", [](const TruthPixel& p) { return p.temperature_K; });
  if (t.normal) {
    add("normal_east", "1", [](const TruthPixel& p) { return p.normal[0]; });
    add("normal_north", "1", [](const TruthPixel& p) { return p.normal[1]; });
    add("normal_up", "1", [](const TruthPixel& p) { return p.normal[2]; });
  }
  // What was drawn are cells of pixels.
  const float cells = chain ? static_cast<float>(cellsOf(camera) * cellsOf(camera)) : 1.0f;
  if (t.area) add("area", "m2", [cells](const TruthPixel& p) { return cells * p.area_m2; });
  if (t.solidAngles) {
    add("solid_angle_from_light", "sr", [cells](const TruthPixel& p) { return cells * p.solidAngleFromLight_sr; });
    add("solid_angle_of_aperture", "sr", [](const TruthPixel& p) { return p.solidAngleOfAperture_sr; });
  }
}

/// How wavelengths were chosen. A spectral image has its own: no plan is made for it.
void addMode(Frame& frame, const SpectralSampling& sampling) {
  const bool planned = sampling.accuracy > 0.0 && frame.kind.empty();
  frame.attributes.push_back({"pitviper.mode", std::string(sampling.reference ? "reference" : planned ? "planned" : "sampled")});
}

/// What was asked of the plan, if anything was, and what it expects: of a channel's quantities the worst.
void addAccuracy(Frame& frame, const Camera& camera, const CameraImage& image) {
  if (image.accuracy > 0.0) frame.attributes.push_back({"pitviper.accuracy", image.accuracy});
  if (image.isDraft) frame.attributes.push_back({"pitviper.draft", std::string("by a plan of few groups; the one asked for is being made")});
  std::map<std::string, double> errorOf;
  for (size_t o = 0; o < camera.outputs.size() && !image.predictedError.empty(); ++o) {
    double& error = errorOf[camera.outputs[o].channel];
    error = std::max(error, image.predictedError[static_cast<size_t>(image.slotOfOutput[o])]);
  }
  for (const auto& [channel, error] : errorOf) frame.attributes.push_back({"pitviper.predicted_error." + channel, error});
}

/// What the reference says of some of its pixels: of a channel's quantities the first.
void addAudit(Frame& frame, const Camera& camera, const CameraImage& image) {
  if (!image.plan.empty()) frame.attributes.push_back({"pitviper.plan", image.plan});
  std::set<std::string> told;
  for (size_t o = 0; o < camera.outputs.size() && !image.audit.empty(); ++o) {
    const SlotAudit& a = image.audit[static_cast<size_t>(image.slotOfOutput[o])];
    if (a.pixels == 0 || !told.insert(camera.outputs[o].channel).second) continue;
    const std::string name = "pitviper.audit." + camera.outputs[o].channel;
    frame.attributes.push_back({name + ".pixels", static_cast<double>(a.pixels)});
    frame.attributes.push_back({name + ".median", a.median});
    frame.attributes.push_back({name + ".largest", a.largest});
    if (a.doubt >= 0.0) frame.attributes.push_back({name + ".doubt", a.doubt});
    if (image.accuracy > 0.0 && std::max(a.largest, a.doubt) > image.accuracy) frame.attributes.push_back({name + ".broken", std::string("more than asked")});
  }
}

}  // namespace

Frame startFrame(const Camera& camera, const WorldState& state, int number) {
  Frame frame;
  frame.camera = camera.name;
  frame.number = number;
  frame.time_s = state.time_s;
  frame.width = camera.pinhole.width;
  frame.height = camera.pinhole.height;
  return frame;
}

namespace {

/// Of its own for each camera, whatever else there is.
std::uint64_t noiseSeed(const Simulation& sim, const Camera& camera) {
  std::uint64_t hash = 0xcbf29ce484222325u;  // FNV-1a
  for (unsigned char c : camera.name) hash = (hash ^ c) * 0x100000001b3u;
  return hash ^ (static_cast<std::uint64_t>(sim.seed) * 0x9e3779b97f4a7c15u);
}

std::string nameOf(const std::string& camera, int number) { return "camera " + camera + ", frame " + std::to_string(number); }

/// What is no number, or beyond all that a file or a sensor's stage can hold, ends the run: no stage, and nobody who reads a frame, could tell it from a
/// measurement. Marks that a user asks for come later, and are not looked at.
void refuseNotFinite(const std::string& frame, int width, const ChannelOutput& output, const std::vector<float>& values) {
  constexpr std::uint32_t kExponent = 0x7f800000u;
  std::uint32_t any = 0;
  for (float v : values) any |= (std::bit_cast<std::uint32_t>(v) & kExponent) == kExponent;  // as whole numbers: several at once
  if (!any) return;
  const auto isWrong = [](float v) { return !std::isfinite(v); };
  const auto first = std::find_if(values.begin(), values.end(), isWrong);
  const auto at = static_cast<int>(first - values.begin()), count = static_cast<int>(std::count_if(first, values.end(), isWrong));
  throw std::runtime_error(
      frame + ", " + output.layer() + ": pixel " + std::to_string(at % width) + "," + std::to_string(at / width) +
      (count > 1 ? " and " + std::to_string(count - 1) + " more are" : " is") + (std::isnan(*first) ? " no number" : " beyond the largest number") +
      "; expected up to 3e38; fix: look at what is seen there: temperatures, intensities, scales and distances at the end of their ranges");
}

std::vector<float> valuesOf(const std::string& frame, const ChannelOutput& output, size_t o, const CameraImage& image) {
  const auto& slot = image.slots[static_cast<size_t>(image.slotOfOutput[o])];
  const double scale = output.scale * (output.perExposure ? image.exposures_s.of(output.channel) : 1.0);
  std::vector<float> values(slot.size());
  for (size_t p = 0; p < slot.size(); ++p) values[p] = static_cast<float>(scale * slot[p] * (output.perEtendue ? image.solidAngles->projected_sr[p] : 1.0));
  refuseNotFinite(frame, image.width, output, values);
  return values;
}

}  // namespace

void toApparentTemperatures(std::vector<float>& values, const ChannelOutput& output, const std::vector<double>& projected_sr, double exposure_s) {
  const double scale = output.scale * (output.perExposure ? exposure_s : 1.0);
  for (size_t p = 0; p < values.size(); ++p)
    if (!std::isnan(values[p]))  // no number: a pixel whose count says nothing
      values[p] = static_cast<float>((*output.temperature)(static_cast<double>(values[p]) / (scale * (output.perEtendue ? projected_sr[p] : 1.0))));
}

void addOutputs(Frame& frame, const Camera& camera, const CameraImage& image) {
  for (size_t o = 0; o < camera.outputs.size(); ++o) {
    frame.layers.push_back({camera.outputs[o].layer(), camera.outputs[o].unit, valuesOf(nameOf(frame.camera, frame.number), camera.outputs[o], o, image)});
    if (camera.outputs[o].asTemperature)
      toApparentTemperatures(frame.layers.back().pixels, camera.outputs[o], image.solidAngles->projected_sr, image.exposures_s.of(camera.outputs[o].channel));
  }
}

void addOptics(Frame& frame, const Pinhole& p, double exposure_s) {
  auto add = [&](const char* name, double value) { frame.attributes.push_back({name, value}); };
  add("pitviper.focal_length_m", p.focalLength_m);
  add("pitviper.pitch_x_m", p.pitchX_m);
  add("pitviper.pitch_y_m", p.pitchY_m);
  add("pitviper.aperture_m", p.apertureDiameter_m);
  add("pitviper.aperture_area_m2", p.apertureArea_m2());
  add("pitviper.exposure_s", exposure_s);
}

void addUnits(Frame& frame, const std::vector<ChannelOutput>& outputs) {
  for (const auto& layer : frame.layers) frame.attributes.push_back({"unit." + layer.name, layer.unit});
  for (const auto& o : outputs) {
    frame.attributes.push_back({"band_um." + o.layer(), print("%.6g to %.6g", o.bandLow_um, o.bandHigh_um)});
    if (!o.cut.empty()) frame.attributes.push_back({"pitviper.response_cut." + o.layer(), o.cut});
  }
}

void addMetadata(Frame& frame, const Simulation& sim, const Camera& camera, const WorldState& state) {
  auto add = [&](std::string name, auto value) { frame.attributes.push_back({std::move(name), value}); };
  add("pitviper.version", std::string(kVersion));
  add(kScenarioName, sim.name);
  add(kScenarioHash, sim.sha256);
  add(kScenarioContent, sim.content);
  add("pitviper.seed", std::to_string(sim.seed));
  add("pitviper.camera", camera.name);
  add("pitviper.frame", frame.number);
  add("pitviper.time_s", state.time_s);
  const CameraState eye = cameraAt(camera, state);
  const Pinhole& p = eye.pinhole;
  addOptics(frame, p, longestExposure_s(camera, eye.exposures_s));
  for (const ChannelOutput& o : camera.outputs)
    if (const std::string own = "pitviper.exposure_s." + o.channel;
        !camera.ownChannels.empty() && (frame.attributes.empty() || frame.attributes.back().name != own))
      add(own, eye.exposures_s.of(o.channel));
  addStandard(frame, sim, camera, eye);
  addSensor(frame, camera, eye);
  add("pitviper.samples", camera.samples);
  if (camera.sharesShading) add("pitviper.samples_shared", "where neighbouring pixels are alike");
  addMode(frame, camera.spectral);
  const Pose& pose = eye.pose;
  const Geodetic g = sim.frame.toGeodetic(pose.position);
  constexpr double kDegrees = 180.0 / kPi;
  add("pitviper.pose_geodetic_deg_deg_m", std::vector<double>{g.latitude_rad * kDegrees, g.longitude_rad * kDegrees, g.height_m});
  const glm::dvec3 ecef = sim.frame.toEcef(pose.position);
  add("pitviper.pose_ecef_m", std::vector<double>{ecef.x, ecef.y, ecef.z});
  add("pitviper.pose_local_m", std::vector<double>{pose.position.x, pose.position.y, pose.position.z});
  const glm::dquat q = glm::normalize(glm::quat_cast(sim.frame.ecefFromLocal()) * pose.orientation);
  add("pitviper.orientation_ecef_wxyz", std::vector<double>{q.w, q.x, q.y, q.z});
  addUnits(frame, camera.outputs);
  const glm::dmat3 cameraFromLocal = glm::transpose(localFromCamera(pose));
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const glm::dvec3 x = cameraFromLocal * (state.entities[e].position - pose.position);
    // Behind the camera: no place in the picture; not there: no range either.
    std::vector<double> seen = {state.isThere(e) ? glm::length(x) : NAN, NAN, NAN};
    if (x.z < 0.0 && state.isThere(e)) {
      const glm::dvec2 at = placeOnFilm(
          camera, p.focalLength_m, {0.5 * p.width + x.x / -x.z * p.focalLength_m / p.pitchX_m, 0.5 * p.height - x.y / -x.z * p.focalLength_m / p.pitchY_m});
      seen[1] = at.x;
      seen[2] = at.y;
    }
    add("entity." + std::to_string(e + 1) + ".name", sim.entities[e].name);
    add("entity." + std::to_string(e + 1) + ".range_column_row", seen);
  }
  if (const std::string outside = outsideLimits(sim, camera, state); !outside.empty()) add("pitviper.outside_limits", outside);
}

namespace {

/// Points of a picture in the units of the outputs that have their slots.
std::vector<SensorPoint> pointsOf(const Camera& camera, const CameraImage& image) {
  std::vector<SensorPoint> points;
  for (const FilmPoint& p : image.points)
    for (size_t o = 0; o < camera.outputs.size(); ++o)
      if (image.slotOfOutput[o] == p.slot)
        points.push_back(
            {p.column, p.row, o, camera.outputs[o].scale * (camera.outputs[o].perExposure ? image.exposures_s.of(camera.outputs[o].channel) : 1.0) * p.flux});
  return points;
}

/// The part of the film that is read out; places in what is said of it follow.
void cutOut(Frame& frame, CountMarks& marks, const glm::ivec4& window) {
  const auto left = static_cast<size_t>(window.x), top = static_cast<size_t>(window.y), width = static_cast<size_t>(window.z),
             height = static_cast<size_t>(window.w);
  const auto cut = [&](auto& pixels) {
    std::remove_reference_t<decltype(pixels)> part;
    part.reserve(width * height);
    for (size_t row = top; row < top + height; ++row) {
      const auto first = pixels.begin() + static_cast<std::ptrdiff_t>(row * static_cast<size_t>(frame.width) + left);
      part.insert(part.end(), first, first + static_cast<std::ptrdiff_t>(width));
    }
    pixels = std::move(part);
  };
  for (FrameLayer& l : frame.layers) cut(l.pixels);
  for (auto& [channel, pixels] : marks) cut(pixels);
  frame.width = window.z;
  frame.height = window.w;
  for (Attribute& a : frame.attributes)
    if (auto* list = std::get_if<std::vector<double>>(&a.value); list && a.name.ends_with(".range_column_row")) (*list)[1] -= window.x, (*list)[2] -= window.y;
  for (TargetRow& t : frame.targets) {
    for (double* x : {&t.column, &t.left, &t.right}) *x -= window.x;
    for (double* y : {&t.row, &t.top, &t.bottom}) *y -= window.y;
  }
  frame.attributes.push_back({"pitviper.window", std::vector<double>{static_cast<double>(window.x), static_cast<double>(window.y),
                                                                     static_cast<double>(window.z), static_cast<double>(window.w)}});
}

/// Of the axis: the middle of the film, wherever the part is that is read out.
void addAxis(Frame& frame, const Camera& camera) {
  frame.attributes.push_back({"pitviper.axis_column", 0.5 * camera.pinhole.width - (camera.window ? camera.window->x : 0)});
  frame.attributes.push_back({"pitviper.axis_row", 0.5 * camera.pinhole.height - (camera.window ? camera.window->y : 0)});
}

}  // namespace

namespace {

SensorTick sensorTick(const Simulation& sim, const Camera& camera, const CameraImage& image, const WorldState& state, int number,
                      const SensorChain& chain) {
  const CameraState eye = cameraAt(camera, state);
  const Pinhole& now = eye.pinhole;
  return {number,
          state.time_s,
          image.exposure_s,
          sim.time.step_s,
          now.projectedSolidAngle_sr(now.width / 2, now.height / 2),
          now.focalLength_m,
          noiseSeed(sim, camera),
          eye.gains.common,
          chain.noise(),
          eye.exposures_s,
          eye.gains};
}

}  // namespace

std::vector<std::vector<float>> sensed(const Simulation& sim, const Camera& camera, const CameraImage& image, const WorldState& state, int number,
                                       SensorChain& chain) {
  std::vector<std::vector<float>> drawn;
  for (size_t o = 0; o < camera.outputs.size(); ++o) drawn.push_back(valuesOf(nameOf(camera.name, number), camera.outputs[o], o, image));
  return chain.run(std::move(drawn), image.solidAngles->projected_sr, sensorTick(sim, camera, image, state, number, chain), pointsOf(camera, image));
}

Frame makeFrame(const Simulation& sim, const Camera& camera, const CameraImage& image, const WorldState& state, int number, SensorChain* chain,
                std::vector<TargetRow> targets, std::vector<FrameLayer> terms) {
  Frame frame = startFrame(camera, state, number);
  if (chain) {
    auto pixels = sensed(sim, camera, image, state, number, *chain);
    for (size_t o = 0; o < camera.outputs.size(); ++o) {
      if (camera.outputs[o].asTemperature)
        toApparentTemperatures(pixels[o], camera.outputs[o], chain->seenSolidAngles(o), image.exposures_s.of(camera.outputs[o].channel));
      frame.layers.push_back({camera.outputs[o].layer(), camera.outputs[o].unit, std::move(pixels[o])});
    }
  } else {
    addOutputs(frame, camera, image);
  }
  addTruth(frame, camera, image, cameraAt(camera, state).pinhole, chain);
  for (FrameLayer& l : terms) frame.layers.push_back(std::move(l));
  frame.targets = std::move(targets);
  addMetadata(frame, sim, camera, state);
  addAxis(frame, camera);
  addAccuracy(frame, camera, image);
  addAudit(frame, camera, image);
  if (const std::string words = hazeNotFog(sim); !words.empty()) frame.attributes.push_back({"pitviper.haze_not_fog", words});
  for (const AveragedFringes& f : image.averagedFringes) {
    const std::string key = "pitviper.averaged_fringes." + f.channel;
    const bool told = std::any_of(frame.attributes.begin(), frame.attributes.end(), [&](const auto& a) { return a.name == key; });
    if (!told) frame.attributes.push_back({key, wordsOf(f)});
  }
  if (image.exposureParts > 1) {
    frame.attributes.push_back({"pitviper.exposure_parts", image.exposureParts});
    frame.attributes.push_back({"pitviper.exposure_motion_px", image.exposureMotion_px});
    frame.attributes.push_back({"pitviper.exposure_error", image.exposureError});
    if (image.streakError > 0.0) frame.attributes.push_back({"pitviper.exposure_streak_error", image.streakError});
  }
  CountMarks marks = chain ? chain->marks() : CountMarks();
  if (camera.window) cutOut(frame, marks, *camera.window);
  addMarks(frame, marks);
  finishTargets(frame, marks);
  return frame;
}

}  // namespace pitviper
