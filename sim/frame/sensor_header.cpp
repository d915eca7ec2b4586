#include "sim/frame/sensor_header.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Seconds since 1970 as ISO 8601, to the millisecond, which FITS has too.
std::string dateOf(double epoch_s) {
  using namespace std::chrono;
  const sys_time<milliseconds> when{milliseconds(std::llround(epoch_s * 1e3))};
  const auto day = floor<days>(when);
  const year_month_day date(day);
  const hh_mm_ss time(when - day);
  return print("%04d-%02u-%02uT%02d:%02d:%02d.%03d", static_cast<int>(date.year()), static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
               static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()), static_cast<int>(time.seconds().count()),
               static_cast<int>(time.subseconds().count()));
}

/// Where curves bend, within a channel's band: its ends, knots, and, so that smooth ones are told too, an even choice between.
std::vector<double> wavelengthsOf(const ChannelOutput& o) {
  constexpr int kEven = 64;
  constexpr std::size_t kMost = 4096;
  std::vector<double> all;
  for (int k = 0; k <= kEven; ++k) all.push_back(o.bandLow_um + (o.bandHigh_um - o.bandLow_um) * k / kEven);
  const auto add = [&](const Spectrum& s) {
    for (double w : s.knots())
      if (w > o.bandLow_um && w < o.bandHigh_um) all.push_back(w);
  };
  add(o.curves->response);
  add(o.curves->optics);
  if (o.curves->quantumEfficiency) add(*o.curves->quantumEfficiency);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end(), [](double a, double b) { return static_cast<float>(a) == static_cast<float>(b); }), all.end());
  if (all.size() <= kMost) return all;
  std::vector<double> some;
  for (std::size_t k = 0; k < kMost; ++k) some.push_back(all[k * (all.size() - 1) / (kMost - 1)]);
  return some;
}

void addCurves(Frame& frame, const ChannelOutput& o) {
  const std::string name = "curve." + o.channel + ".";
  const std::vector<double> wavelengths = wavelengthsOf(o);
  const auto add = [&](const char* of, const auto& value) {
    std::vector<float> curve;
    for (double w : wavelengths) curve.push_back(static_cast<float>(value(w)));
    frame.attributes.push_back({name + of, std::move(curve)});
  };
  add("wavelength_um", [](double w) { return w; });
  add("response", o.curves->response);
  if (!o.curves->optics.isConstant() || o.curves->optics(1.0) != 1.0) add("optics", o.curves->optics);
  if (o.curves->quantumEfficiency) add("quantum_efficiency", *o.curves->quantumEfficiency);
}

/// Black bodies from far colder than anything seen to where it saturates.
std::vector<double> temperatures(const BandTemperature& band, double mostIntegral) {
  constexpr int kSteps = 128;
  constexpr double kColdest_K = 200.0, kHottest_K = 3000.0;
  const double hottest = std::clamp(band(mostIntegral), 1.05 * kColdest_K, kHottest_K);
  std::vector<double> all;
  for (int k = 0; k <= kSteps; ++k) all.push_back(kColdest_K * std::pow(hottest / kColdest_K, static_cast<double>(k) / kSteps));
  return all;
}

void addCalibration(Frame& frame, const Camera& camera, const CameraState& eye, const ChannelOutput& o) {
  const std::string name = "calibration." + o.layer() + ".";
  const auto add = [&](const char* of, double value) { frame.attributes.push_back({name + of, value}); };
  const auto addTable = [&](const char* of, const std::vector<double>& values) {
    frame.attributes.push_back({name + of, std::vector<float>(values.begin(), values.end())});
  };
  const Pinhole& p = eye.pinhole;
  if (!o.temperature) return;
  const BandTemperature& band = *o.temperature;
  const DetectorLaw* law = detectorOf(camera, o.channel);
  if (!law || !o.detected) {
    const std::vector<double> all = temperatures(band, INFINITY);
    std::vector<double> radiances;
    for (double t : all) radiances.push_back(band.integral(t));
    addTable("temperature_K", all);
    addTable("radiance", radiances);
    return;
  }
  const double exposure_s = eye.exposures_s.of(o.channel), gain = law->gain * eye.gains.of(o.channel), dark = law->darkCurrent_per_s * exposure_s;
  const double axis_sr = p.projectedSolidAngle_sr(p.width / 2, p.height / 2), perIntegral = law->fillFactor * o.scale * exposure_s * axis_sr;
  const double own = law->fillFactor * ownLightOf(camera, o, axis_sr, exposure_s) + dark;
  if (o.isCount()) {
    // Of light even over the response: integral of S L over integral of kernel L.
    const double perElectron = o.curves->response.integral(o.bandLow_um, o.bandHigh_um) / o.kernel.integral(o.bandLow_um, o.bandHigh_um) / perIntegral;
    add("gain_count_per_electron", gain);
    add("offset_count", law->offset);
    add("dark_electrons", dark);
    add("fill_factor", law->fillFactor);
    add("own_electrons", own - dark);
    add("radiance_per_count", perElectron / gain);
    add("radiance_at_0", -(law->offset / gain + own) * perElectron);
  }
  const std::vector<double> all = temperatures(band, std::max(0.0, law->saturation(eye.gains.of(o.channel)) - own) / perIntegral);
  std::vector<double> counts;
  for (double t : all) counts.push_back(gain * (perIntegral * band.integral(t) + own) + law->offset);
  addTable("temperature_K", all);
  addTable("count", counts);
}

}  // namespace

void addStandard(Frame& frame, const Simulation& sim, const Camera& camera, const CameraState& eye) {
  const glm::dmat3 cameraFromLocal = glm::transpose(localFromCamera(eye.pose));
  const glm::dvec3 origin = -(cameraFromLocal * eye.pose.position);
  std::vector<double> rows;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) rows.push_back(j < 3 ? cameraFromLocal[i][j] : 0.0);
  rows.insert(rows.end(), {origin.x, origin.y, origin.z, 1.0});
  frame.attributes.push_back({"worldToCamera", std::move(rows)});
  frame.attributes.push_back({"framesPerSecond", 1.0 / sim.time.step_s});
  if (const double longest_s = longestExposure_s(camera, eye.exposures_s); longest_s > 0.0) frame.attributes.push_back({"expTime", longest_s});
  frame.attributes.push_back({"aperture", eye.pinhole.focalLength_m / camera.pinhole.apertureDiameter_m});
  if (sim.time.epoch_s) frame.attributes.push_back({"pitviper.date_utc", dateOf(*sim.time.epoch_s + frame.time_s)});
}

void addSensor(Frame& frame, const Camera& camera, const CameraState& eye) {
  std::set<std::string> told;
  for (const ChannelOutput& o : camera.outputs) {
    if (!o.curves) continue;
    if (told.insert(o.channel).second) addCurves(frame, o);
    if (o.detected || o.asTemperature) addCalibration(frame, camera, eye, o);
  }
}

}  // namespace pitviper
