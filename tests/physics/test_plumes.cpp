// Exhaust through the whole pipeline against sums over lines of sight that this file makes itself, in double precision, from the law of the jet
// (FreeJet::stateAt) and the tables of the gases (absorptionOf, all levels) alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "materials/fields/jets.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const SpeciesTable& tableOf(Species s) { return speciesTable(s, std::filesystem::path(PITVIPER_SOURCE_DIR) / "materials/library"); }

/// Absorption by level at wavelengths, so that the sums below look up nothing.
struct Absorber {
  Species species;
  std::vector<double> temperature_K;
  std::vector<std::vector<double>> at;  ///< by level, by wavelength
};

struct Band {
  double low_um, high_um;
};

/// Intensities [W/sr] of a jet from the side in bands, all within the first: lines across it in even midpoints, each in slabs of one temperature, black
/// emission and absorption of all gases in excess over the air. 60 places along by the square of x, 24 lines across, 192 slabs (a thick gas shows its skin: 48
/// send 0.45 % more), the middle of every step of the tables: between their knots gases absorb alike, and what else is smooth there has at most 10 nm to change
/// in.
std::vector<double> intensityFromTheSide(const FreeJet& jet, const CoFlow& around, double length_m, const std::vector<Species>& species,
                                         const std::vector<Band>& bands) {
  constexpr int kPlaces = 60, kLines = 12, kSlabs = 96;
  constexpr double kWidest_um = 0.01;
  std::vector<double> knots, um, width_um;
  for (const Band& b : bands) knots.insert(knots.end(), {b.low_um, b.high_um});
  for (Species s : species)
    for (const Spectrum& level : tableOf(s).absorption)
      for (double knot : level.knots())
        if (knot > bands[0].low_um && knot < bands[0].high_um) knots.push_back(knot);
  std::sort(knots.begin(), knots.end());
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double width = knots[i + 1] - knots[i];
    const int parts = static_cast<int>(std::ceil(width / kWidest_um));
    for (int part = 0; part < parts; ++part) um.push_back(knots[i] + width * (part + 0.5) / parts), width_um.push_back(width / parts);
  }
  std::vector<Absorber> absorbers;
  for (Species s : species) {
    Absorber a{s, tableOf(s).temperature_K, {}};
    for (std::size_t l = 0; l < a.temperature_K.size(); ++l) {
      a.at.emplace_back();
      for (double w : um) a.at.back().push_back(tableOf(s).absorption[l](w));
    }
    absorbers.push_back(std::move(a));
  }
  std::vector<double> intensity(bands.size(), 0.0), depth(um.size()), radiance(um.size()), passed(um.size());
  for (int i = 0; i < kPlaces; ++i) {
    // From where it begins to where it has faded: kJetRamp, and the last fifth of its length.
    const double ramp = kJetRamp * jet.constants().radius_m, part = (i + 0.5) / kPlaces, place = (length_m + ramp) * part * part - ramp,
                 dx = (length_m + ramp) * 2.0 * part / kPlaces, x = std::max(place, 0.0), begun = std::min(0.5 * (place + ramp) / ramp, 1.0);
    const JetRow row = jet.at(x);
    const double wide = row.coreZ_m + 3.5 * row.widthZ_m;
    const double left = std::clamp((length_m - x) / (0.2 * length_m), 0.0, 1.0),
                 present = left * left * (3.0 - 2.0 * left) * begun * begun * (3.0 - 2.0 * begun);
    for (int j = 0; j < kLines; ++j) {
      const double y = wide * (j + 0.5) / kLines, half = std::sqrt(wide * wide - y * y), dz = half / kSlabs;
      std::fill(radiance.begin(), radiance.end(), 0.0);
      std::fill(passed.begin(), passed.end(), 1.0);
      // From the middle outwards: a line has each slab twice, before and behind those nearer to the axis.
      for (int k = 0; k < kSlabs; ++k) {
        const JetState s = jet.stateAt(x, std::hypot(y, (k + 0.5) * dz));
        std::fill(depth.begin(), depth.end(), 0.0);
        for (const Absorber& a : absorbers) {
          const double amount = dz * present *
                                (a.species == Species::CO2    ? (s.co2_Pa - around.co2 * around.pressure_Pa) / 101325.0
                                 : a.species == Species::H2O  ? (s.h2o_Pa - around.h2o * around.pressure_Pa) / 101325.0
                                 : a.species == Species::CO   ? s.co_Pa / 101325.0
                                 : a.species == Species::Soot ? s.sootVolumeFraction
                                                              : s.alumina_kg_m3);
          const BetweenLevels b = betweenLevels(tableOf(a.species), s.temperature_K);
          const std::size_t upper = std::min(b.lower + 1, a.at.size() - 1);
          for (std::size_t w = 0; w < um.size(); ++w) depth[w] += amount * ((1.0 - b.part) * a.at[b.lower][w] + b.part * a.at[upper][w]);
        }
        // Planck's law once per slab, as a line in ln(wavelength) would not do: at every wavelength.
        for (std::size_t w = 0; w < um.size(); ++w) {
          if (!(depth[w] > 0.0)) continue;
          const double absorbed = -std::expm1(-depth[w]), through = 1.0 - absorbed;
          radiance[w] = through * radiance[w] + absorbed * physics::planckRadiance(um[w], s.temperature_K) * (1.0 + through * passed[w]);
          passed[w] *= through * through;
        }
      }
      for (std::size_t b = 0; b < bands.size(); ++b)
        for (std::size_t w = 0; w < um.size(); ++w)
          if (um[w] > bands[b].low_um && um[w] < bands[b].high_um) intensity[b] += radiance[w] * width_um[w] * 2.0 * dx * wide / kLines;
    }
  }
  return intensity;
}

struct Case {
  const char* what;
  const char* engine;
  double length_m, range_m, wind_m_s;
};

// A camera looks at jets from the side, 2 km and more away, through nothing, before nothing. What its pixels add up to is the band's intensity; within the 1 %
// asked for.
TEST(Plumes, BandIntensityFromTheSide) {
  for (const Case& c :
       {Case{"double-base motor", "double_base_motor", 12.0, 2000.0, 0.0}, Case{"turbofan without afterburner", "turbofan_military", 60.0, 9000.0, 0.0},
        Case{"turbofan with afterburner in a flow of 150 m/s", "turbofan_afterburner", 80.0, 9000.0, 150.0}}) {
    const std::string range = std::to_string(c.range_m), half = std::to_string(0.5 * c.length_m);
    const std::string wind = c.wind_m_s > 0.0 ? "wind: {speed: " + std::to_string(c.wind_m_s) + " m/s, direction: 270 deg}\n" : "";
    const std::string yaml = wind + R"(
time: {start: 1 s, frames: 1}
accuracy: 1 %
plumes: [{name: p, position: [0 m, 0 m, 0 m], direction: [1, 0, 0], engine: )" +
                             c.engine + ", length: " + std::to_string(c.length_m) + R"( m, begin: 0 s}]
cameras:
  - name: c
    film: {width: 96, height: 48}
    field_of_view: )" + std::to_string(2.0 * std::atan(0.55 * c.length_m / c.range_m) * 180.0 / kPi) +
                             R"( deg
    aperture: 10 mm
    position: [)" + half + " m, -" +
                             range + R"( m, 0 m]
    heading: 0 deg
    truth: [targets]
    channels:
      - {name: wide, response: {band: [3 um, 5 um]}}
      - {name: red, response: {band: [4.1 um, 4.6 um]}}
)";
    const Simulation sim = scene(yaml);
    const Frame frame = renderFrame(sim);
    const auto& source = dynamic_cast<const JetsSource&>(*sim.fields[0].source);
    const auto at = source.conditionsAt(1.0, 0.0, c.wind_m_s);
    ASSERT_TRUE(at);
    const CoFlow around = source.around(*at);
    const FreeJet jet(*source.flowAt(*at), around);
    const double length_m = std::min(c.length_m, jet.length_m());
    const std::vector<Band> bands = {{3.0, 5.0}, {4.1, 4.6}};
    const std::vector<double> intensities = intensityFromTheSide(jet, around, length_m, source.setup().species(), bands);
    for (std::size_t b = 0; b < bands.size(); ++b) {
      double seen = 0.0;
      for (int y = 0; y < 48; ++y)
        for (int x = 0; x < 96; ++x) {
          // Area across the axis: solid angle times range^2 / cos^3.
          const double u = (x + 0.5 - 48.0) / 48.0 * 0.55 * c.length_m / c.range_m, v = (y + 0.5 - 24.0) / 48.0 * 0.55 * c.length_m / c.range_m;
          seen += pitviper::test::at(frame.layers[b], frame, x, y) * sim.cameras[0].pinhole.solidAngle_sr(x, y) * c.range_m * c.range_m *
                  std::pow(1.0 + u * u + v * v, 1.5);
        }
      const double want = intensities[b];
      char what[200];
      std::snprintf(what, sizeof what, "%s, %.1f-%.1f um from the side: %.1f W/sr; over the sum of lines", c.what, bands[b].low_um, bands[b].high_um, want);
      figure(what, seen / want, 1.0, 0.01, "the accuracy asked for");
      figure(std::string(what) + ", of its row in truth", frame.targets.at(0).channels[b].contrast / want, 1.0, 0.01, "the accuracy asked for");
    }
  }
}

}  // namespace
}  // namespace pitviper::test
