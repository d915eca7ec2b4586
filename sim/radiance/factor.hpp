#pragma once
// A spectrum that the radiance of a line of sight is a product of: what it is a property of, and the numbers it depends on.
#include <compare>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// From where a surface is looked at, in the scenario's axes.
struct SurfaceView {
  glm::dvec3 normal{0.0, 0.0, 1.0}, toViewer{0.0, 0.0, 1.0};
  double height_m = 0.0;  ///< of the body's origin: whose surroundings it has
};

struct Factor {
  enum class Kind {
    Planck,         ///< black body at x [K]
    Emission,       ///< of a material (`of`) at x [K] seen from its normal: emissivity and black body as one spectrum
    Dome,           ///< of a material: reflected uniform sky, reflectance and ambient light as one
    Emissivity,     ///< of a material at a view angle x [rad], given or what is neither reflected nor let through; modifiers at 1
    Hemispherical,  ///< of a reflection component at a view angle x
    Column,         ///< of a reflection component at its two angles x and y
    Transmittance,  ///< of a material at a view angle x; modifier at 1
    Light,          ///< intensity of a point light
    Sun,            ///< irradiance
    Ambient,
    Reflected,  ///< of a reflection component: what it sends of the surroundings' light to a view; a NodeSpectra has it
    Around,     ///< irradiance / pi from the surroundings on a plane whose normal has elevation x and azimuth y, at their height of number z
    Background,
    Medium,     ///< source radiance of a medium at x [K], y times its own; light that it scatters from all around
    MediumSun,  ///< sunlight that a medium turns towards the eye, x the cosine of the angle [W/(m2 sr um)]
    SunShade    ///< what clouds of drops (`of`: their medium) of an optical depth x at 0.55 um let through of the sun
  };
  Kind kind = Kind::Background;
  const void* of = nullptr;
  double x = 0.0, y = 0.0;
  bool lasting = true;  ///< other lines have it too: worth keeping
  double z = 0.0;
  const SurfaceView* seen = nullptr;  ///< of Reflected, while its term is told

  /// The same spectrum.
  bool operator==(const Factor& o) const { return kind == o.kind && of == o.of && x == o.x && y == o.y && z == o.z && seen == o.seen; }
  auto operator<=>(const Factor& o) const {
    if (const auto c = kind <=> o.kind; c != 0) return std::partial_ordering(c);
    if (of != o.of) return std::less<>()(of, o.of) ? std::partial_ordering::less : std::partial_ordering::greater;
    if (const auto c = x <=> o.x; c != 0) return c;
    if (const auto c = y <=> o.y; c != 0) return c;
    if (seen != o.seen) return std::less<>()(seen, o.seen) ? std::partial_ordering::less : std::partial_ordering::greater;
    return z <=> o.z;
  }

  static Factor planck(double temperature_K, bool lasting) { return {Kind::Planck, nullptr, temperature_K, 0.0, lasting}; }
  static Factor emission(const Material& m, double temperature_K) { return {Kind::Emission, &m, temperature_K}; }
  static Factor dome(const Material& m) { return {Kind::Dome, &m}; }
  static Factor emissivity(const Material& m, double viewAngle_rad);
  static Factor hemispherical(const ReflectionComponent& r, double viewAngle_rad);
  static Factor column(const ReflectionComponent& r, const glm::dvec3& light, const glm::dvec3& view);
  static Factor transmittance(const Material& m, double viewAngle_rad);
  static Factor light(const PointLight& l) { return {Kind::Light, &l}; }
  static Factor sun() { return {Kind::Sun}; }
  static Factor ambient() { return {Kind::Ambient}; }
  static Factor reflected(const ReflectionComponent& r, const SurfaceView& seen) { return {Kind::Reflected, &r, 0.0, 0.0, false, 0.0, &seen}; }
  static Factor around(double elevation_rad, double azimuth_rad, std::size_t height) {
    return {Kind::Around, nullptr, elevation_rad, azimuth_rad, true, static_cast<double>(height)};
  }
  static Factor background() { return {Kind::Background}; }
  static Factor medium(const Medium& m, double temperature_K, double gain = 1.0, bool lasting = true) {
    return {Kind::Medium, &m, temperature_K, gain, lasting};
  }
  static Factor sunShade(const Simulation& simulation, double depth) {
    return {Kind::SunShade, &*simulation.materials[static_cast<std::size_t>(simulation.sunShade->material)]->medium, depth, 0.0, false};
  }
  static Factor mediumSun(const Medium& m, double cosScatter) { return {Kind::MediumSun, &m, cosScatter, 0.0, false}; }
};

/// Its value at a wavelength [of its kind: W/(m2 sr um), 1, 1/sr, W/(sr um), W/(m2 um)].
double valueOf(const Simulation& simulation, const Factor& factor, double wavelength_um);

}  // namespace pitviper
