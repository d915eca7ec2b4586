#include "scenarios/session/surface_physics.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/session/array_checks.hpp"
#include "scenarios/view/material_text.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/table.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Angles and lengths that are worked out elsewhere are rounded.
constexpr double kRoundedAngle = 1e-9;

constexpr const char* kMaterialCall = "material()";

std::vector<std::string> libraryNamesIn(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  return names;
}

/// Of length 1, above the horizon.
glm::dvec3 requireSurfaceDirection(const glm::dvec3& direction, const std::string& name) {
  const double length = glm::length(direction);
  if (!(std::abs(length - 1.0) < 1e-6 && direction.z > 0.0))
    throw UserError({"brdf()", 0, 0, -1}, print("%s is [%g, %g, %g]", name.c_str(), direction.x, direction.y, direction.z),
                    "a vector of length 1 whose z, along the normal, is above 0", "give directions from the surface, in axes whose z is its normal");
  return direction / length;
}

}  // namespace

std::shared_ptr<const Material> materialOf(const Simulation& simulation, const std::string& name) {
  std::vector<std::string> names;
  for (const auto& m : simulation.materials) {
    if (m->name == name) return m;
    names.push_back(m->name);
  }
  throw unknownWord({simulation.file.empty() ? kMaterialCall : simulation.file, 0, 0, -1}, "there is no material", name, names);
}

std::shared_ptr<const Material> materialOf(const std::string& name, const Libraries& libraries) {
  // As messages are to call it.
  const auto called = [&name](const std::shared_ptr<const Material>& read) {
    auto own = std::make_shared<Material>(*read);
    own->name = name;
    return own;
  };
  const std::filesystem::path folder = libraries.materials, substances = folder.parent_path() / "substances";
  std::error_code ignored;
  if (std::filesystem::is_regular_file(name, ignored)) return called(readMaterialFile(name, libraries));
  // A name, not a way out of the library.
  if (name.find('/') == std::string::npos) {
    if (const auto file = folder / (name + ".yaml"); std::filesystem::is_regular_file(file, ignored)) return called(readMaterialFile(file, libraries));
    if (std::filesystem::is_regular_file(substances / (name + ".yaml"), ignored))
      return called(readMaterialText("components:\n  - {reflection: microfacet, index: " + name + ", roughness: 0.05}\n", ".", libraries));
  }
  std::vector<std::string> names = libraryNamesIn(folder);
  const std::vector<std::string> further = libraryNamesIn(substances);
  names.insert(names.end(), further.begin(), further.end());
  std::sort(names.begin(), names.end());
  throw unknownWord({kMaterialCall, 0, 0, -1}, "there is no material, substance or file", name, names, "'pitviper material' lists them");
}

glm::dvec3 directionAt(double angle_rad, double azimuth_rad) {
  return {std::sin(angle_rad) * std::cos(azimuth_rad), std::sin(angle_rad) * std::sin(azimuth_rad), std::cos(angle_rad)};
}

SurfacePhysics::SurfacePhysics(std::shared_ptr<const Material> material, std::optional<double> state) : material_(std::move(material)) {
  const Location where{kMaterialCall, 0, 0, -1};
  const std::string name = "material '" + material_->name.substr(0, 60) + "'";
  if (material_->medium) throw UserError(where, name + " is a medium", "a surface", "ask for the material of a body's surface");
  if (!state) {
    mix_ = {{material_.get(), 1.0}};
    return;
  }
  if (!material_->states) throw UserError(where, name + " has no states", "one that changes with temperature, or that a texture drives", "leave the state out");
  const MaterialStates& states = *material_->states;
  if (!(*state >= states.low && *state <= states.high))
    throw UserError(where, print("%s in state %g%s", name.c_str(), *state, states.texture < 0 ? " K" : ""), print("%g to %g", states.low, states.high),
                    "choose one of these");
  const double last = static_cast<double>(states.entries.size() - 1), x = (*state - states.low) / (states.high - states.low) * last,
               below = std::min(std::floor(x), last - 1.0);
  const auto first = static_cast<std::size_t>(below);
  mix_ = {{states.entries[first].get(), 1.0 - (x - below)}, {states.entries[first + 1].get(), x - below}};
}

std::optional<SurfacePhysics::States> SurfacePhysics::states() const {
  if (!material_->states) return {};
  return States{material_->states->texture < 0, material_->states->low, material_->states->high};
}

void SurfacePhysics::requireData(const char* function, std::span<const double> wavelength_um) const {
  requireWavelengths({function, "wavelength_um"}, wavelength_um);
  double low = 0.0, high = INFINITY;
  for (const auto& [m, share] : mix_) low = std::max(low, m->validLow_um()), high = std::min(high, m->validHigh_um());
  for (std::size_t i = 0; i < wavelength_um.size(); ++i)
    if (!(wavelength_um[i] >= low && wavelength_um[i] <= high))
      throw UserError({function, 0, 0, -1}, print("wavelength_um[%zu] is %g, where material '%s' has no data", i, wavelength_um[i], material_->name.c_str()),
                      print("%.6g to %.6g um", low, high), "ask within these");
}

std::vector<double> SurfacePhysics::brdf(std::span<const double> wavelength_um, const glm::dvec3& light, std::span<const glm::dvec3> views) const {
  requireData("brdf()", wavelength_um);
  const glm::dvec3 from = requireSurfaceDirection(light, "light");
  std::vector<double> all;
  all.reserve(views.size() * wavelength_um.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const glm::dvec3 to = requireSurfaceDirection(views[v], print("views[%zu]", v));
    for (const double um : wavelength_um) {
      double sum = 0.0;
      for (const auto& [m, share] : mix_)
        for (const auto& r : m->reflections) sum += share * r->brdf(um, from, to);
      all.push_back(sum);
    }
  }
  return all;
}

template <class OfMaterial>
std::vector<double> SurfacePhysics::byAngle(const char* function, std::span<const double> wavelength_um, std::span<const double> angle_rad,
                                            OfMaterial&& value) const {
  requireData(function, wavelength_um);
  requireNotNegative({function, "angle_rad"}, angle_rad);
  std::vector<double> all;
  all.reserve(angle_rad.size() * wavelength_um.size());
  for (std::size_t a = 0; a < angle_rad.size(); ++a) {
    if (angle_rad[a] > 0.5 * kPi + kRoundedAngle)
      throw UserError({function, 0, 0, -1}, print("angle_rad[%zu] is %g", a, angle_rad[a]), "0 to pi/2, from the normal", "angles are in radians");
    for (const double um : wavelength_um) {
      double sum = 0.0;
      for (const auto& [m, share] : mix_) sum += share * value(*m, um, std::min(angle_rad[a], 0.5 * kPi));
      all.push_back(sum);
    }
  }
  return all;
}

std::vector<double> SurfacePhysics::reflectance(std::span<const double> wavelength_um, std::span<const double> angle_rad) const {
  return byAngle("reflectance()", wavelength_um, angle_rad, [](const Material& m, double um, double angle) { return m.reflectance(um, angle); });
}

std::vector<double> SurfacePhysics::emissivity(std::span<const double> wavelength_um, std::span<const double> angle_rad) const {
  return byAngle("emissivity()", wavelength_um, angle_rad, [](const Material& m, double um, double angle) { return m.emissivity(um, angle); });
}

std::vector<double> SurfacePhysics::transmittance(std::span<const double> wavelength_um, std::span<const double> angle_rad) const {
  return byAngle("transmittance()", wavelength_um, angle_rad, [](const Material& m, double um, double angle) { return m.transmittance(um, angle); });
}

}  // namespace pitviper
