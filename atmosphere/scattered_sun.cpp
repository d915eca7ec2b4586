#include "atmosphere/scattered_sun.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

using Powers = std::array<double, kMostAbsorbers>;

double dot(const Powers& a, const Powers& b) {
  double sum = 0.0;
  for (size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

double cosineOf(double sine) { return std::sqrt(std::max(1.0 - sine * sine, 0.0)); }

// Camera at height, z upwards, sun in the xz plane.
struct Frame {
  double r0, radius_m, cosScatter, sinElevation, sinSun;

  Frame(const SunlitView& v, double radius)
      : r0(radius + v.height_m),
        radius_m(radius),
        cosScatter(cosineOf(v.sinElevation) * cosineOf(v.sinSunElevation) * std::cos(v.azimuthFromSun_rad) + v.sinElevation * v.sinSunElevation),
        sinElevation(v.sinElevation),
        sinSun(v.sinSunElevation) {}
  // Sine of the sun's elevation at a range, at a height that is known.
  double sunAt(double range_m, double height_m) const { return std::clamp((r0 * sinSun + range_m * cosScatter) / (radius_m + height_m), -1.0, 1.0); }
  // Ranges at which the view crosses the shadow's cylinder: |p|^2 - (p . sun)^2 = radius^2.
  std::vector<double> shadowEdges() const {
    const double a = 1.0 - cosScatter * cosScatter, b = r0 * (sinElevation - sinSun * cosScatter), c = r0 * r0 * (1.0 - sinSun * sinSun) - radius_m * radius_m;
    const double inside = b * b - a * c;
    if (a < 1e-12 || inside <= 0.0) return {};
    const double q = -(b + std::copysign(std::sqrt(inside), b));
    if (q == 0.0) return {};
    return {q / a, c / q};
  }
};

}  // namespace

Spectrum ruralAsymmetry() {
  Spectrum g(Spectrum::Table{{0.2, 0.3, 0.337, 0.55, 0.694, 1.06, 1.536, 2.0, 2.25, 2.5, 2.7, 3.0, 3.392, 3.75, 4.5},
                             {0.7632, 0.6928, 0.6865, 0.663, 0.6498, 0.6314, 0.644, 0.7098, 0.7303, 0.7522, 0.7953, 0.7816, 0.738, 0.731, 0.753},
                             Outside::Hold,
                             "rural haze's asymmetry"});
  g.setProvenance("Shettle and Fenn 1979, AFGL-TR-79-0214: rural, relative humidity 70 %");
  return g;
}

struct ScatteredSun::Optics {
  Powers extinction{}, molecules{}, haze{};  ///< optical depth per W^a: all of it; scattered by molecules, by haze
  double asymmetry = 0.0;
};

ScatteredSun::ScatteredSun(std::shared_ptr<const AbsorberTable> air, double earthRadius_m, Spectrum hazeAsymmetry)
    : air_(std::move(air)), radius_m_(earthRadius_m), asymmetry_(std::move(hazeAsymmetry)) {}

Powers ScatteredSun::powers(const AbsorberAmounts& amounts) const {
  Powers p{};
  const auto absorbers = air_->absorbers();
  for (size_t k = 0; k < absorbers.size(); ++k) {
    const double w = amounts.amount_km[k], a = absorbers[k].exponent;
    p[k] = a == 1.0 || w <= 0.0 ? w : std::pow(w, a);
  }
  return p;
}

bool ScatteredSun::inShadow(double height_m, double sinSunElevation) const {
  return sinSunElevation < 0.0 && (radius_m_ + height_m) * cosineOf(sinSunElevation) < radius_m_;
}

SunlitPath ScatteredSun::path(const SunlitView& view, double range_m, int count) const {
  const Frame frame(view, radius_m_);
  const auto edges = frame.shadowEdges();
  const auto stations = air_->stations(view.height_m, view.sinElevation, range_m, radius_m_, count, edges);
  SunlitPath path;
  path.cosScatter = std::clamp(frame.cosScatter, -1.0, 1.0);
  const auto litAt = [&](double range, double height) { return !inShadow(height, frame.sunAt(range, height)); };
  for (size_t i = 0; i < stations.size(); ++i) {
    SunlitPath::Station s{stations[i].range_m, stations[i].temperature_K, false, powers(stations[i].amounts), {}};
    if (i > 0) {
      const double middle = 0.5 * (stations[i - 1].range_m + stations[i].range_m);
      // The height of the middle, without the difference of large numbers: r^2 = r0^2 + s (2 r0 sin + s).
      const double grown = middle * (2.0 * frame.r0 * frame.sinElevation + middle);
      s.lit = litAt(middle, view.height_m + grown / (frame.r0 + std::sqrt(std::max(frame.r0 * frame.r0 + grown, 0.0))));
    }
    path.stations.push_back(s);
  }
  for (size_t i = 0; i < stations.size(); ++i) {
    if (!path.stations[i].lit && !(i + 1 < stations.size() && path.stations[i + 1].lit)) continue;
    const PathStation& s = stations[i];
    path.stations[i].bothPower = powers(s.amounts + air_->amounts(s.height_m, frame.sunAt(s.range_m, s.height_m), INFINITY, radius_m_));
  }
  return path;
}

SunlitPath ScatteredSun::pathToEnd(const SunlitView& view, int count) const {
  // To the ground: s from r0^2 + s (2 b + s) = ground^2, nearer root. A camera below sea level stands on it.
  const double ground_m = std::min(view.height_m, 0.0);
  const double r0 = radius_m_ + view.height_m, b = r0 * view.sinElevation, c = (view.height_m - ground_m) * (r0 + radius_m_ + ground_m);
  const double inside = b * b - c;
  const bool down = b < 0.0 && inside >= 0.0;
  return path(view, down ? c / (-b + std::sqrt(inside)) : INFINITY, count);
}

SkyDome ScatteredSun::dome(double height_m, double sinSunElevation, int elevations, int azimuths) const {
  SkyDome dome;
  for (const QuadratureNode& node : gaussLegendre(elevations, 0.0, 1.0))
    for (int i = 0; i < azimuths; ++i) {
      // Mean = 1/pi integral of L sin dsin dazimuth; left and right are alike.
      dome.weights.push_back(2.0 * node.x * node.weight / azimuths);
      dome.paths.push_back(pathToEnd({height_m, node.x, kPi * (i + 0.5) / azimuths, sinSunElevation}));
    }
  return dome;
}

ScatteredSun::Optics ScatteredSun::optics(double wavelength_um) const {
  Optics o;
  o.extinction = air_->coefficients(wavelength_um);
  o.asymmetry = asymmetry_(wavelength_um);
  const double albedo = air_->hazeAlbedo(wavelength_um);
  const auto absorbers = air_->absorbers();
  for (size_t k = 0; k < absorbers.size(); ++k) {
    const AbsorberKind kind = absorbers[k].kind;
    if (kind == AbsorberKind::Scattering) o.molecules[k] = o.extinction[k];
    if (kind == AbsorberKind::Haze || kind == AbsorberKind::Aerosol) o.haze[k] = albedo * o.extinction[k];
  }
  return o;
}

double ScatteredSun::scatteredRadiance(double wavelength_um, const SunlitPath& path, double irradiance) const {
  const Optics o = optics(wavelength_um);
  const double molecules = physics::rayleighPhase(path.cosScatter), haze = physics::henyeyGreensteinPhase(path.cosScatter, o.asymmetry);
  Powers source{};
  for (size_t k = 0; k < source.size(); ++k) source[k] = molecules * o.molecules[k] + haze * o.haze[k];
  double sum = 0.0;
  for (size_t i = 1; i < path.stations.size(); ++i) {
    if (!path.stations[i].lit) continue;
    const auto &near = path.stations[i - 1], &far = path.stations[i];
    const double scattered = dot(source, far.viewPower) - dot(source, near.viewPower);
    const double before = dot(o.extinction, near.bothPower), after = dot(o.extinction, far.bothPower);
    sum += scattered * physics::meanPassedBetween(before, after);
  }
  return irradiance * sum;
}

double ScatteredSun::thermalRadiance(double wavelength_um, const SunlitPath& path) const {
  const Powers extinction = air_->coefficients(wavelength_um);
  std::vector<double> depth, source, radiance(path.stations.size());
  for (const SunlitPath::Station& s : path.stations) {
    depth.push_back(dot(extinction, s.viewPower));
    source.push_back(physics::planckRadiance(wavelength_um, s.temperature_K));
  }
  AirLight{depth}.emitted(source, radiance);
  return radiance.empty() ? 0.0 : radiance.back();
}

double ScatteredSun::radiance(double wavelength_um, const SunlitPath& path, double irradiance) const {
  return thermalRadiance(wavelength_um, path) + scatteredRadiance(wavelength_um, path, irradiance);
}

double ScatteredSun::transmittance(double wavelength_um, const SunlitPath& path) const {
  return path.stations.empty() ? 1.0 : std::exp(-dot(air_->coefficients(wavelength_um), path.stations.back().viewPower));
}

double ScatteredSun::skyRadiance(double wavelength_um, const SunlitView& view, double irradiance) const {
  return radiance(wavelength_um, pathToEnd(view), irradiance);
}

double ScatteredSun::meanSky(double wavelength_um, const SkyDome& dome, double irradiance) const {
  double sum = 0.0;
  for (size_t i = 0; i < dome.paths.size(); ++i) sum += dome.weights[i] * radiance(wavelength_um, dome.paths[i], irradiance);
  return sum;
}

double ScatteredSun::directSun(double wavelength_um, double height_m, double sinSunElevation, double irradiance) const {
  if (inShadow(height_m, sinSunElevation)) return 0.0;
  return irradiance * air_->transmittance(wavelength_um, air_->amounts(height_m, sinSunElevation, INFINITY, radius_m_));
}

}  // namespace pitviper
