#include "scenarios/commands/bench_scenarios.hpp"

#include <cmath>
#include <numbers>
#include <sstream>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/scene/primitives.hpp"

namespace pitviper {
namespace {

/// The camera, 300 m off, sees 106 m of the wall; 110 m also fill the film from a few metres behind it.
constexpr double kPlate_m = 110.0;

std::string materials(const BenchSetting& s) {
  std::ostringstream y;
  y << "materials:\n"
    << "  wall: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[2.9, 0.1], [5.1, 0.4]]}}]}\n";
  if (s.layers == 0) return y.str();
  y << "  layer: {transmission: {transmittance: 0.8}";
  if (s.layerKind == LayerKind::Attenuating) y << ", emission: {emissivity: 0}";
  if (s.layerKind == LayerKind::Reflecting) y << ", components: [{reflection: lambertian, reflectance: 0.1}]";
  y << "}\n";
  return y.str();
}

/// On a circle before the wall, so that every one of them lights every pixel. One light stands where the paper's figures had it.
std::string lights(const BenchSetting& s) {
  std::ostringstream y;
  if (s.lights + s.farLights > 0) y << "lights:\n";
  for (int i = 0; i < s.farLights; ++i)
    y << "  - {name: far" << i << ", intensity: 1 W/(sr um), visible: false, position: [600 km, " << 800 + 10 * i << " km, 0 m]}\n";
  for (int i = 0; i < s.lights; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / s.lights;
    y << "  - {name: lamp" << i << ", intensity: {blackbody: 2000 K, area: 0.1 m2}, visible: false, position: [40 m, " << 20.0 * std::cos(turn) << " m, "
      << 10.0 + 20.0 * std::sin(turn) << " m]}\n";
  }
  return y.str();
}

void addPlate(std::ostringstream& y, const std::string& name, double x_m, const char* material, double temperature_K) {
  y << "  - {name: " << name << ", shape: {model: plate, width: " << kPlate_m << " m, height: " << kPlate_m << " m}, material: " << material
    << ", temperature: " << temperature_K << " K, position: [" << x_m << " m, 0 m, 0 m]}\n";
}

std::string scenarioText(const BenchSetting& s) {
  std::ostringstream y;
  if (s.air) y << "atmosphere: {extinction: {wavelength: um, unit: 1/km, values: [[2.9, 0.3], [4.2, 2.0], [5.1, 0.4]]}, temperature: 288 K}\n";
  y << "background: {temperature: 250 K}\nrender: {mode: " << (s.mode == RenderMode::Direct ? "direct" : "buffered") << "}\n"
    << materials(s) << lights(s) << "entities:\n";
  for (int hidden = s.overdraw - 1; hidden >= 1; --hidden) addPlate(y, "hidden" + std::to_string(hidden), -hidden, "wall", 290.0);
  for (int layer = 1; layer <= s.layers; ++layer) addPlate(y, "layer" + std::to_string(layer), layer, "layer", 280.0);
  addPlate(y, "wall", 0.0, "wall", 300.0);
  const int across = static_cast<int>(std::ceil(std::sqrt(s.bodies)));
  for (int i = 0; i < s.bodies; ++i) {
    const double each = 0.9 * 106.0 / across, middle = 0.5 * (across - 1);
    y << "  - {name: body" << i << ", shape: {model: sphere, radius: " << std::min(0.3 * each, 3.0) << " m, segments: 32}, material: wall, temperature: "
      << 310 + i % 40 << " K, position: [20 m, " << (i % across - middle) * each << " m, " << (i / across - middle) * each << " m]}\n";
  }
  y << "cameras:\n  - name: c\n    film: {width: " << s.film_px << ", height: " << s.film_px << "}\n    field_of_view: 20 deg\n    aperture: 50 mm\n"
    << "    position: [300 m, 0 m, 0 m]\n    look_at: wall\n    spectral: {samples: " << s.wavelengths << ", spacing: even, shared: true}\n    channels:\n";
  for (int c = 0; c < s.channels; ++c)
    y << "      - {name: c" << c << ", response: {wavelength: um, unit: \"1\", values: [[3, " << 0.2 + 0.05 * c << "], [5, " << 1.0 - 0.05 * c << "]]}}\n";
  return y.str();
}

}  // namespace

Simulation benchSimulation(const BenchSetting& setting) {
  Simulation sim = readScenarioText(scenarioText(setting), "bench", ".", {}, findLibraries());
  if (setting.triangles > 2) {
    const int across = std::max(static_cast<int>(std::lround(std::sqrt(0.5 * setting.triangles))), 1);
    const auto mesh = std::make_shared<const Mesh>(makePlate(kPlate_m, kPlate_m, across, across));
    for (Entity& e : sim.entities)
      if (e.name.starts_with("wall") || e.name.starts_with("hidden")) {
        e.mesh = mesh;
        for (Surface& s : e.surfaces) s.meshPart = 0;
      }
  }
  return sim;
}

}  // namespace pitviper
