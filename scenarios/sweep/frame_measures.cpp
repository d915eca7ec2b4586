#include "scenarios/sweep/frame_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "sim/frame/region.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

/// A column of the table of targets: its name there, without the unit.
struct TargetColumn {
  const char* name;
  const char* unit;
  double (*of)(const TargetRow&);
};
constexpr TargetColumn kColumns[] = {
    {"column", "pixel", [](const TargetRow& t) { return t.column; }},
    {"row", "pixel", [](const TargetRow& t) { return t.row; }},
    {"left", "pixel", [](const TargetRow& t) { return t.left; }},
    {"top", "pixel", [](const TargetRow& t) { return t.top; }},
    {"right", "pixel", [](const TargetRow& t) { return t.right; }},
    {"bottom", "pixel", [](const TargetRow& t) { return t.bottom; }},
    {"range", "m", [](const TargetRow& t) { return t.range_m; }},
    {"range rate", "m/s", [](const TargetRow& t) { return t.rangeRate_m_s; }},
    {"sight right", "rad/s", [](const TargetRow& t) { return t.sightRight_rad_s; }},
    {"sight up", "rad/s", [](const TargetRow& t) { return t.sightUp_rad_s; }},
    {"visible", "1", [](const TargetRow& t) { return t.visible; }},
};
struct ChannelColumn {
  const char* name;
  bool isIntensity;  ///< in the channel's unit
  double (*of)(const TargetRow::Channel&);
};
constexpr ChannelColumn kChannelColumns[] = {
    {"own", true, [](const TargetRow::Channel& c) { return c.own; }},
    {"total", true, [](const TargetRow::Channel& c) { return c.total; }},
    {"contrast", true, [](const TargetRow::Channel& c) { return c.contrast; }},
    {"snr", false, [](const TargetRow::Channel& c) { return c.signalToNoise; }},
    {"saturated", false, [](const TargetRow::Channel& c) { return c.saturated < 0 ? NAN : static_cast<double>(c.saturated); }},
};

std::vector<std::string> columnsOf(const Camera& camera) {
  std::vector<std::string> all;
  for (const TargetColumn& c : kColumns) all.emplace_back(c.name);
  for (const ChannelOutput& o : camera.outputs)
    for (const ChannelColumn& c : kChannelColumns)
      if (const std::string name = o.channel + "." + c.name; std::find(all.begin(), all.end(), name) == all.end()) all.push_back(name);
  return all;
}

std::vector<std::string> targetsOf(const Simulation& sim) {
  std::vector<std::string> all;
  for (const Entity& e : sim.entities) all.push_back(e.name);
  for (const FieldBody& f : sim.fields) all.push_back(f.name);
  for (const PointLight& l : sim.lights)
    if (l.lamp < 0) all.push_back(l.name);
  return all;
}

std::vector<std::string> layersOf(const Camera& camera) {
  std::vector<std::string> all;
  for (const ChannelOutput& o : camera.outputs) all.push_back(o.layer());
  return all;
}

MeasuredValue ofTruth(const Frame& frame, const Measure& m) {
  for (const TargetRow& t : frame.targets) {
    if (t.name != m.target) continue;
    for (const TargetColumn& c : kColumns)
      if (m.value == c.name) return {c.of(t), c.unit};
    for (const TargetRow::Channel& channel : t.channels)
      for (const ChannelColumn& c : kChannelColumns)
        if (m.value == channel.channel + "." + c.name) return {c.of(channel), c.isIntensity ? channel.unit : "1"};
  }
  return {NAN, ""};
}

/// Linear between the order statistics on either side.
double quantile(std::vector<float> values, double share) {
  const double place = share * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(place);
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(low), values.end());
  const double at = static_cast<double>(values[low]);
  if (low + 1 == values.size()) return at;
  const double next = static_cast<double>(*std::min_element(values.begin() + static_cast<std::ptrdiff_t>(low) + 1, values.end()));
  return at + (place - static_cast<double>(low)) * (next - at);
}

std::vector<float> valuesIn(const Frame& frame, const FrameLayer& layer, const PixelBox& box) {
  std::vector<float> values;
  for (int row = box.top; row < box.bottom; ++row)
    for (int column = box.left; column < box.right; ++column)
      if (const float v = layer.pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(column)];
          std::isfinite(v))
        values.push_back(v);
  return values;
}

double statisticOf(const Frame& frame, const FrameLayer& layer, const Measure& m) {
  PixelBox box{0, 0, frame.width, frame.height};
  if (!m.region.empty()) box = {m.region[0], m.region[1], m.region[0] + m.region[2], m.region[1] + m.region[3]};
  if (m.statistic.starts_with("p")) {
    const std::vector<float> values = valuesIn(frame, layer, box);
    return values.empty() ? NAN : quantile(values, 0.01 * std::strtod(m.statistic.c_str() + 1, nullptr));
  }
  const RegionFigures f = regionOf(layer, frame.width, frame.height, box, 0);
  if (m.statistic == "mean") return f.mean;
  if (m.statistic == "sigma") return f.standardDeviation;
  if (m.statistic == "min") return f.minimum;
  if (m.statistic == "max") return f.maximum;
  if (m.statistic == "median") return f.median;
  return f.count ? f.mean * static_cast<double>(f.count) : NAN;  // sum
}

}  // namespace

std::size_t cameraOf(const Simulation& sim, const Measure& m) {
  std::vector<std::string> names;
  for (const Camera& c : sim.cameras) names.push_back(c.name);
  if (names.empty()) throw UserError(m.where, "the scenario has no camera", "a camera whose frames are measured", "add one to the scenario");
  if (m.camera.empty()) return 0;
  const auto at = std::find(names.begin(), names.end(), m.camera);
  if (at == names.end()) throw unknownWord(m.where, "there is no camera", m.camera, names);
  return static_cast<std::size_t>(at - names.begin());
}

void refuseUnknownMeasures(const Simulation& sim, const std::vector<Measure>& measures) {
  for (const Measure& m : measures) {
    const Camera& camera = sim.cameras[cameraOf(sim, m)];
    if (m.kind == Measure::Kind::Truth) {
      if (!camera.truth.targets)
        throw UserError(m.where, "camera '" + camera.name + "' tells no truth of targets", "a camera with 'truth: [targets]'",
                        "add 'cameras." + camera.name + ".truth: [targets]' under 'set:', or to the scenario");
      if (const auto names = targetsOf(sim); std::find(names.begin(), names.end(), m.target) == names.end())
        throw unknownWord(m.where, "there is no body, plume, flare or lamp", m.target, names);
      if (const auto names = columnsOf(camera); std::find(names.begin(), names.end(), m.value) == names.end())
        throw unknownWord(m.where, "the truth of a target has no value", m.value, names);
    }
    if (m.kind == Measure::Kind::Statistic) {
      const auto names = layersOf(camera);
      if (!m.layer.starts_with("truth.") && std::find(names.begin(), names.end(), m.layer) == names.end())
        throw unknownWord(m.where, "camera '" + camera.name + "' has no layer", m.layer, names);
      if (!m.region.empty() && (m.region[0] < 0 || m.region[1] < 0 || m.region[2] < 1 || m.region[3] < 1 || m.region[0] + m.region[2] > camera.pinhole.width ||
                                m.region[1] + m.region[3] > camera.pinhole.height))
        throw UserError(m.where, "the region is not within the film",
                        "left, top, width, height within " + std::to_string(camera.pinhole.width) + "x" + std::to_string(camera.pinhole.height), "lower it");
    }
  }
}

MeasuredValue measured(const Frame& frame, const Measure& m) {
  if (m.kind == Measure::Kind::Truth) return ofTruth(frame, m);
  for (const FrameLayer& l : frame.layers)
    if (l.name == m.layer) return {statisticOf(frame, l, m), l.unit};
  throw UserError(m.where, "the frame has no layer '" + m.layer + "'", "a layer of camera '" + frame.camera + "'", "add it to the camera's 'truth'");
}

}  // namespace pitviper
