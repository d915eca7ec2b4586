// Optical depth from 1e-9 to 1e6 in air, panes and media: 1 - exp(-x) without cancellation, opaque without underflow.
#include <filesystem>

#include "atmosphere/absorber_table.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/extremes/extremes.hpp"
#include "tests/support/compare.hpp"

namespace pitviper::test {
namespace {

constexpr double kDepths[] = {0, 1e-9, 1e-6, 1e-3, 0.1, 1, 30, 1e3, 1e6};

long double lost(double x) { return -std::expm1(-static_cast<long double>(x)); }
double B(double kelvin) { return kelvin > 0.0 ? blackBodyBand(8, 12, kelvin) : 0.0; }

/// Grey air of a depth over 9 m.
std::string air(double depth, double kelvin) { return "atmosphere: {extinction: " + text(depth / 9.0) + " /m, temperature: " + text(kelvin) + " K}\n"; }

TEST(Depths, HomogeneousAir) {
  for (const char* mode : {"direct", "buffered", "reference"}) {
    Range cold(std::string("air before a cold plate, depth 0 to 1e6, ") + mode, 1e-5, "L (1 - exp(-x)), expm1l");
    const bool bins = std::string(mode) == "reference";
    Range warm(std::string("warm plate through cold air, depth 0 to 87, ") + mode, bins ? 2e-5 : 1e-5,
               bins ? "L exp(-x); bins of 5 1/cm" : "L exp(-x); x rounds: 87 x 1.2e-7");
    const std::string head = std::string(mode) == "reference" ? "accuracy: reference\n" : "render: {mode: " + std::string(mode) + "}\n";
    for (double x : kDepths) {
      cold.add(middle(head + air(x, 300) + plate(0) + Look{}.yaml()), static_cast<double>(lost(x)) * B(300), text(x));
      const double through = middle(head + air(x, 0) + plate(1000) + Look{}.yaml());
      if (x < 87.0) warm.add(through, B(1000) * std::exp(-x), text(x));
      else EXPECT_LE(through, B(1000) * std::exp(-87.0)) << x;
    }
  }
}

// A slab of medium across the line of sight, 1 m thick from x = 0 to -1, in air of depth y over the 9 m before it (so y / 9 inside), before a black wall of 0 K
// at its far side. Absorption adds up with the air's.
TEST(Depths, MediumInAir) {
  Range gpu("slab of medium, depth 0 to 1e6, in air of depth 0 to 1e3", 1e-5, "slab equation in long double");
  Range reference("slab of medium, depth 0 to 1e6, in air of depth 0 to 1e3, in double", 1e-5, "slab equation in long double");
  for (double x : kDepths)
    for (double y : {0.0, 1e-9, 1e-3, 1.0, 1e3}) {
      const std::string yaml =
          (y > 0.0 ? air(y, 250) : std::string()) +
          "entities:\n  - {name: fog, shape: {model: box, length: 1 m, width: 4 m, height: 4 m}, material: {absorption: " + text(x) +
          " /m}, temperature: 400 K, position: [-0.5 m, 0 m, 0 m]}\n"
          "  - {name: wall, shape: {model: plate, width: 8 m, height: 8 m}, material: blackbody, temperature: 0 K, position: [-1 m, 0 m, 0 m]}\n" +
          Look{.more = "small_bodies: 0, "}.yaml();
      const long double inside = static_cast<long double>(y) / 9.0L, sum = x + inside;
      const long double mixed =
          sum > 0.0L ? (x * static_cast<long double>(B(400)) + inside * static_cast<long double>(B(250))) / sum * -std::expm1(-sum) : 0.0L;
      const double want = static_cast<double>(lost(y) * static_cast<long double>(B(250)) + std::exp(-static_cast<long double>(y)) * mixed);
      gpu.add(middle(yaml), want, text(x) + " in " + text(y));
      reference.add(middle(inDouble(yaml)), want, text(x) + " in " + text(y));
    }
}

// Panes of transmittance from 1e-9 (almost opaque) to 1 - 1e-7 (all but absent), 50 K colder and hotter than what is behind; eight one behind the other.
TEST(Depths, Panes) {
  Range one("pane of transmittance 0 to 1 before a wall", 1e-5, "T B(wall) + (1 - T) B(pane)");
  Range eight("eight panes of transmittance 0 to 1", 1e-5, "T^8 B(wall) + (1 - T^8) B(pane)");
  for (double t : {0.0, 1e-9, 1e-4, 0.5, 0.999, 1.0 - 1e-7, 1.0})
    for (int panes : {1, 8}) {
      std::string yaml = "entities:\n  - {name: wall, shape: {model: plate, width: 8 m, height: 8 m}, material: blackbody, temperature: 350 K}\n";
      for (int k = 0; k < panes; ++k)
        yaml += "  - {name: w" + std::to_string(k) + ", shape: {model: plate, width: 4 m, height: 4 m}, material: {transmission: {transmittance: " + text(t) +
                "}}, temperature: 300 K, position: [" + text(1.0 + 0.5 * k) + " m, 0 m, 0 m]}\n";
      yaml += Look{.more = "small_bodies: 0, "}.yaml();
      const double through = std::pow(t, panes), want = through * B(350) + (1.0 - through) * B(300);
      (panes == 1 ? one : eight).add(middle(yaml), want, text(t));
      (panes == 1 ? one : eight).add(middle(inDouble(yaml)), want, text(t) + " in double");
    }
}

// A pane far out in layered air: what is behind it, its own radiance and the air before it, at depths that range does not resolve.
TEST(Depths, PanesInLayeredAir) {
  for (const auto& [low, high] : {std::pair{4.2, 4.4}, {8.0, 12.0}}) {
    const std::string yaml =
        "atmosphere: hazy_us76\nentities:\n  - {name: wall, shape: {model: plate, width: 8 m, height: 8 m}, material: blackbody, temperature: 350 K, "
        "position: [-20 km, 0 m, 1 km]}\n  - {name: pane, shape: {model: plate, width: 8 km, height: 8 km}, material: {transmission: {transmittance: "
        "0.5}}, temperature: 300 K, position: [-10 km, 0 m, 1 km]}\n" +
        Look{.from = "[0 m, 0 m, 1 km]", .at = "[-1 m, 0 m, 1 km]", .low_um = low, .high_um = high, .more = "small_bodies: 0, "}.yaml();
    const Worst w = compare(scene(yaml), 1);
    EXPECT_GT(w.covered, 20);
    bound("pane 10 km off in hazy air, " + text(low) + "-" + text(high) + " um", w.error, 1e-3, "double along each ray; the air's tables are linear between");
    finiteFrame(inDouble(yaml));
  }
}

// Layered air along 0.1 m to 1 km of level line at the sea: in the limit of no depth its radiance is share x B(T) x depth. Depth goes
// with powers of range down to 0.537: at 0.1 m it is still 1.7e-4. The share that absorbs comes from the table's own coefficients.
TEST(Depths, LayeredAirOverShortRanges) {
  const AbsorberTable table = AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air");
  Range gpu("radiance of 0.1 m to 1 km of layered air", 1e-3, "share B(T) (1 - exp(-x)) at sea level; the air's tables are linear between");
  Range reference("radiance of 0.1 m to 1 km of layered air, in double", 1e-4, "share B(T) (1 - exp(-x)); the line leaves sea level by range2 / 2R");
  AbsorberTable clear = table;
  clear.removeAerosol();
  double least = 1.0;
  for (double range : {0.1, 1.0, 30.0, 1000.0})
    for (double from : {2.0, 3.9, 4.3, 10.0}) {
      const OneBin bin(from);
      const double w = bin.middle_um();
      AbsorberAmounts amounts = clear.densities(0.0);
      for (double& a : amounts.amount_km) a *= 1e-3 * range;
      const auto c = clear.coefficients(w);
      double scattered = 0.0;
      for (size_t k = 0; k < clear.absorbers().size(); ++k)
        if (clear.absorbers()[k].kind == AbsorberKind::Scattering) scattered += c[k] * amounts.amount_km[k];
      const double depth = clear.opticalDepth(w, amounts), share = depth > scattered ? (depth - scattered) / depth : 0.0;
      if (share > 0.0) least = std::min(least, depth);
      const double mean = share * static_cast<double>(lost(depth)) * planck(w, clear.temperature_K(0.0));
      const Look look{
          .from = "[0 m, 0 m, 0 m]", .at = "[" + text(-range) + " m, 0 m, 0 m]", .low_um = bin.low_um, .high_um = bin.high_um, .more = "near: 0.01 m, "};
      const std::string yaml =
          "atmosphere: {table: ../atmosphere/library/us76_rural.air, aerosol: none}\nentities: [{name: p, shape: {model: plate, width: " + text(2 * range) +
          " m, height: " + text(2 * range) + " m}, material: blackbody, temperature: 0 K, position: [" + text(-range) + " m, 0 m, 0 m]}]\n" + look.yaml();
      const std::string at = text(range) + " m, " + text(w) + " um";
      gpu.add(middle(yaml), mean * bin.width_um(), at);
      reference.add(middle(inDouble(yaml)), mean * bin.width_um(), at);
    }
  EXPECT_LT(least, 2e-4) << "the least depth of all cases";
}

}  // namespace
}  // namespace pitviper::test
