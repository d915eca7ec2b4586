#include "sim/radiance/factor.hpp"

#include <cmath>
#include <stdexcept>

#include "sim/radiometry/physics.hpp"

namespace pitviper {

Factor Factor::emissivity(const Material& m, double angle) {
  const bool varies = m.given ? m.given->varies() : m.hemisphericalVaries();
  return {Kind::Emissivity, &m, varies ? angle : 0.0, 0.0, !varies};
}

Factor Factor::hemispherical(const ReflectionComponent& r, double angle) {
  const bool varies = r.hemisphericalVaries();
  return {Kind::Hemispherical, &r, varies ? angle : 0.0, 0.0, !varies};
}

Factor Factor::column(const ReflectionComponent& r, const glm::dvec3& light, const glm::dvec3& view) {
  const auto axes = r.axes();
  Factor f{Kind::Column, &r};
  if (axes[0].angle != Angle::None) f.x = angleBetween(axes[0].angle, light, view), f.lasting = false;
  if (axes[1].angle != Angle::None) f.y = angleBetween(axes[1].angle, light, view), f.lasting = false;
  return f;
}

Factor Factor::transmittance(const Material& m, double angle) {
  const bool varies = m.transmission && m.transmission->varies();
  return {Kind::Transmittance, &m, varies ? angle : 0.0, 0.0, !varies};
}

double valueOf(const Simulation& sim, const Factor& f, double w) {
  const auto material = [&f]() -> const Material& { return *static_cast<const Material*>(f.of); };
  const auto component = [&f]() -> const ReflectionComponent& { return *static_cast<const ReflectionComponent*>(f.of); };
  switch (f.kind) {
    case Factor::Kind::Planck:
      return physics::planckRadiance(w, f.x);
    case Factor::Kind::Emission:
      return material().emissivity(w, 0.0) * physics::planckRadiance(w, f.x);
    case Factor::Kind::Dome: {
      const double sky = (*sim.ambient)(w);
      return sky > 0.0 ? material().reflectance(w, 0.0) * sky : 0.0;
    }
    case Factor::Kind::Emissivity:
      return material().emissivity(w, f.x);
    case Factor::Kind::Hemispherical:
      return component().hemispherical(w, f.x);
    case Factor::Kind::Column:
      return component().column(w, f.x, f.y);
    case Factor::Kind::Transmittance:
      return material().transmittance(w, f.x);
    case Factor::Kind::Light:
      return static_cast<const PointLight*>(f.of)->intensity(w);
    case Factor::Kind::Sun:
      return sim.sun->irradiance(w);
    case Factor::Kind::Ambient:
      return (*sim.ambient)(w);
    case Factor::Kind::Reflected:
      throw std::logic_error("what a surface reflects of its surroundings has no value of its own");
    case Factor::Kind::Around: {
      // A_l / pi of degrees 0 to 2: 1, 2/3, 1/4.
      const Harmonics& light = sim.surroundings->light(w, static_cast<std::size_t>(f.z)).harmonics;
      Harmonics y;
      realHarmonics({std::cos(f.x) * std::cos(f.y), std::cos(f.x) * std::sin(f.y), std::sin(f.x)}, 2, y);
      double sum = 0.0;
      for (std::size_t c = 0; c < 9; ++c) sum += (c == 0 ? 1.0 : c < 4 ? 2.0 / 3.0 : 0.25) * light[c] * y[c];
      return sum;
    }
    case Factor::Kind::Background:
      return sim.background(w);
    case Factor::Kind::Medium: {
      const auto& medium = *static_cast<const Medium*>(f.of);
      return medium.source(w, f.x, f.y) + (medium.albedo && sim.ambient ? medium.albedoAt(w) * (*sim.ambient)(w) : 0.0);
    }
    case Factor::Kind::MediumSun:
      return static_cast<const Medium*>(f.of)->scattered(w, f.x) * sim.sun->irradiance(w);
    case Factor::Kind::SunShade:
      return std::exp(-f.x * static_cast<const Medium*>(f.of)->absorption_per_m(w));
  }
  return 0.0;
}

}  // namespace pitviper
