// Air from a tape7 or a CSV file as the air of a scene: pixels against the table's own numbers and against closed forms.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "atmosphere/modtran_files.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "tests/support/air_text.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

/// A file while it is needed.
class Table {
 public:
  Table(const std::string& name, const std::string& text) : file_(fs::temp_directory_path() / ("pitviper_" + std::to_string(getpid()) + "_" + name)) {
    std::ofstream(file_) << text;
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  ~Table() { fs::remove(file_); }
  std::string path() const { return file_.string(); }

 private:
  fs::path file_;
};

/// A plate at the origin seen from the east, in 200 even wavelengths unless something else is said.
std::string plateAt(double range_km, const std::string& body, double low_um, double high_um,
                    const std::string& sampling = "spectral: {samples: 200, spacing: even}, ") {
  char camera[500];
  std::snprintf(
      camera, sizeof camera,
      "cameras: [{name: c, film: {width: 9, height: 9}, field_of_view: 0.1 deg, aperture: 20 mm, position: [%.17g km, 0 m, 0 m], look_at: [0 m, 0 m, 0 m], "
      "%schannels: [{name: a, response: {band: [%.17g um, %.17g um]}}]}]\n",
      range_km, sampling.c_str(), low_um, high_um);
  return "entities: [{name: p, shape: {model: plate, width: " + std::to_string(20.0 * range_km) + " m, height: " + std::to_string(20.0 * range_km) + " m}, " +
         body + "}]\n" + camera;
}

double middle(const std::string& yaml) {
  const Frame f = renderFrame(scene(yaml));
  return at(f.layers[0], f, 4, 4);
}

/// Integral over a band by 20000 midpoints.
double overBand(double low_um, double high_um, const std::function<double(double)>& f) {
  constexpr int kCells = 20000;
  const double step = (high_um - low_um) / kCells;
  double sum = 0.0;
  for (int i = 0; i < kCells; ++i) sum += f(low_um + (i + 0.5) * step);
  return sum * step;
}

// tau = exp(-k r) with k falling from 0.4 to 0.1 1/km, path radiance B(280 K) (1 - tau).
TEST(AirFromTables, CsvOfAClosedForm) {
  const auto extinction = [](double um) { return 0.4 - 0.15 * (um - 3.0); };
  const auto tau = [&](double um, double km) { return std::exp(-extinction(um) * km); };
  const auto sent = [&](double um, double km) { return -physics::planckRadiance(um, 280.0) * std::expm1(-extinction(um) * km); };
  const Table table("air.csv", airCsvText(3.0, 5.0, 0.01, std::vector{1.0, 4.0, 10.0}, tau, sent));
  const char* const why = "exp(-k r), Planck at 280 K; the source is linear between rows of 0.01 um: 2e-5 of it";
  for (const double km : {0.5, 4.0, 25.0}) {
    const double seen = overBand(3.2, 4.8, [&](double um) { return physics::planckRadiance(um, 310.0) * tau(um, km) + sent(um, km); });
    figure("black plate at " + std::to_string(km) + " km through air from CSV [W/(m2 sr)]",
           middle("atmosphere: {csv: " + table.path() + "}\n" + plateAt(km, "material: blackbody, temperature: 310 K", 3.2, 4.8)), seen, 2e-5, why);
  }
  // No end: what meets nothing sees the source alone.
  const auto sky =
      "atmosphere: {csv: " + table.path() + "}\n" + plateAt(4.0, "material: blackbody, temperature: 310 K, position: [-50 km, 30 km, 0 m]", 3.2, 4.8);
  figure("sky of air from CSV [W/(m2 sr)]", middle(sky), blackBodyBand(3.2, 4.8, 280.0), 2e-5, why);
}

// A lamp beside the camera: the length of both legs together goes into the powers.
TEST(AirFromTables, BothLegsBeforeThePower) {
  const auto depth = [](double km) { return 0.3 * std::pow(km, 0.55) + 0.02 * km; };
  const auto tau = [&](double, double km) { return std::exp(-depth(km)); };
  const Table table("legs.csv", airCsvText(3.0, 5.0, 1.0, std::vector{0.5, 1.0, 3.0, 10.0}, tau, [](double, double) { return 0.0; }));
  const std::string lit =
      "lights: [{name: l, intensity: 1e7 W/(sr um), visible: false, position: [3 km, 4 km, 0 m]}]\n"
      "materials: {grey: {components: [{reflection: lambertian, reflectance: 0.4}]}}\n";
  figure("plate lit by a lamp at 5 km, seen from 2 km [W/(m2 sr)]",
         middle("atmosphere: {csv: " + table.path() + "}\n" + lit + plateAt(2.0, "material: grey, temperature: 0 K", 3.5, 4.5)),
         0.4 / kPi * 1e7 * 0.6 / 25e6 * std::exp(-depth(7.0)), 2e-5, "exp(-sum c (d + R)^a); twelve digits in the table, single precision");
}

// Two powers of range that a fit finds again, between the file's ranges and at them.
TEST(AirFromTables, Tape7OfSeveralRanges) {
  const auto depth = [](double um, double km) { return (0.5 + 0.3 * std::cos(9.0 * um)) * std::pow(km, 0.55) + 0.05 * km; };
  const auto tau = [&](double um, double km) { return std::exp(-depth(um, km)); };
  const auto sent = [&](double um, double km) { return -physics::planckRadiance(um, 285.0) * std::expm1(-depth(um, km)); };
  const Table table("several.tp7", tape7Text(2000, 2500, 5, std::vector{0.5, 1.0, 2.0, 5.0, 10.0}, tau, sent));
  for (const double km : {1.0, 3.0, 10.0}) {
    const double seen = overBand(4.05, 4.95, [&](double um) { return physics::planckRadiance(um, 320.0) * tau(um, km) + sent(um, km); });
    figure("black plate at " + std::to_string(km) + " km through tape7 air [W/(m2 sr)]",
           middle("atmosphere: {tape7: " + table.path() + "}\n" + plateAt(km, "material: blackbody, temperature: 320 K", 4.05, 4.95)), seen, 1e-4,
           "the functions behind the tape7's numbers, which are linear between 5 1/cm; five digits of radiance");
  }
}

// One run whose card 3 says no range: the scenario does.
TEST(AirFromTables, RangeOfAScenario) {
  const auto tau = [](double, double km) { return std::exp(-0.2 * km); };
  std::string text = tape7Text(2000, 2500, 100, std::vector{5.0}, tau, [](double, double) { return 0.0; });
  const std::string range = "   5.00000   0.00000   0.00000    0";
  ASSERT_NE(text.find(range), std::string::npos);
  text.replace(text.find(range), 10, "   0.00000");
  const Table table("range.tp7", text);
  figure("black plate at 8 km through air of one run of 5 km [W/(m2 sr)]",
         middle("atmosphere: {tape7: " + table.path() + ", range: 5 km}\n" + plateAt(8.0, "material: blackbody, temperature: 320 K", 4.05, 4.95)),
         std::exp(-1.6) * blackBodyBand(4.05, 4.95, 320.0), 2e-5, "exp(-0.2 x 8); eight decimals, single precision");
}

// A program's own file: its transmittance and radiance at its own range, wavenumber by wavenumber.
TEST(AirFromTables, TheRangeOfAProgramsOwnFile) {
  fs::path folder = fs::path(PITVIPER_SOURCE_DIR) / ".." / "shared" / "data" / "tape7";
  if (const char* given = std::getenv("PITVIPER_TAPE7")) folder = given;
  if (!fs::exists(folder / "tape7-02b")) GTEST_SKIP() << "no MODTRAN samples: set PITVIPER_TAPE7 to a folder that holds them";
  const Tape7Run run = readModtran(folder / "tape7-02b").at(0);
  const Spectrum tau = totalTransmittance(run), radiance = pathRadiance(run);
  const double low = run.wavelength_um.front(), high = run.wavelength_um.back();
  const double range = *run.geometry.range_km;
  const std::string air = "atmosphere: {tape7: " + (folder / "tape7-02b").string() + "}\n";
  // Its sums over its own wavelengths, which the reference goes through. Bins from middle to middle, so those at both ends are half.
  for (const double t : {0.0, 300.0}) {
    double seen = 0.0;
    for (size_t i = 0; i < run.wavelength_um.size(); ++i) {
      const double um = run.wavelength_um[i];
      const double from = i == 0 ? low : 0.5 * (um + run.wavelength_um[i - 1]), to = um == high ? high : 0.5 * (um + run.wavelength_um[i + 1]);
      seen += (to - from) * ((t > 0.0 ? physics::planckRadiance(um, t) * tau(um) : 0.0) + radiance(um));
    }
    figure("tape7-02b at its range, plate of " + std::to_string(static_cast<int>(t)) + " K [W/(m2 sr)]",
           middle("accuracy: reference\n" + air + plateAt(range, "material: blackbody, temperature: " + std::to_string(t) + " K", low, high, "")), seen, 1e-6,
           "sum of TOT_TRANS B + PTH_THRML over the rows; the frame is single precision");
    figure("the same planned for 1 %, on the GPU [W/(m2 sr)]",
           middle("accuracy: 1 %\n" + air + plateAt(range, "material: blackbody, temperature: " + std::to_string(t) + " K", low, high, "")), seen, 1e-2,
           "the accuracy asked for");
  }
  // The GPU's pixel, at one row at a time.
  for (const size_t i : {size_t{3}, size_t{20}, size_t{41}}) {
    const double um = run.wavelength_um[i], half = 1e-7;
    figure("tape7-02b at " + std::to_string(std::lround(1e4 / um)) + " 1/cm [W/(m2 sr um)]",
           middle(air + plateAt(range, "material: blackbody, temperature: 300 K", um - half, um + half)) / (2 * half),
           physics::planckRadiance(um, 300.0) * tau(um) + radiance(um), 2e-5, "TOT_TRANS B + PTH_THRML; the band's own width, single precision");
  }
}

}  // namespace
}  // namespace pitviper::test
