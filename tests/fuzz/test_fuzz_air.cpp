// Damaged tables of air (tape7, MODTRAN's JSON and CSV, columns, CSV, .air) under a scenario: each must be read, with finite numbers, or refused in one line
// with its place and fix. PITVIPER_FUZZ_AIR sets their number (default 3000), PITVIPER_FUZZ_SEED the first seed.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "scenarios/reader/scenario_reader.hpp"
#include "tests/support/air_text.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

struct Corpus {
  const char* key;
  std::string text;
};

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::vector<Corpus> corpus() {
  const std::array<double, 1> one = {2.0};
  const std::array<double, 3> three = {0.5, 2.0, 10.0};
  const auto tau = [](double um, double km) { return std::exp(-0.1 * um * std::pow(km, 0.7)); };
  const auto sent = [&](double um, double km) { return 0.5 * um * (1.0 - tau(um, km)); };
  return {{"tape7", test::tape7Text(2000, 2500, 100, one, tau, sent)},
          {"tape7", test::tape7Text(2000, 2500, 100, three, tau, sent)},
          {"tape7", test::modtranJsonText(2000, 2500, 100, three, tau, sent)},
          {"range: 2 km, tape7", test::modtranCsvText(2000, 2500, 100, 2.0, tau, sent)},
          {"range: 2 km, columns_file", "0     WAVENUMBER      TRANSMISSION\n  2000.0  0.5\n  2250.0  0.6\n  2500.0  1.0E-03\n"},
          {"range: 2 km, columns_file",
           "# source solar kurudz\n# sza 30\n# output_quantity transmittance\n# output_user lambda zout edir\n 4000 0 4e-1\n 4500 0 0.2\n 5000 0 0.1\n"},
          {"columns: \"wavelength_nm, optical_depth_2km, path_radiance_2km_W/(m2 sr nm)\", columns_file", "4000 0.4 1e-4\n4500 0.5 2e-4\n5000 0.6 3e-4\n"},
          {"csv", test::airCsvText(4.0, 5.0, 0.25, three, tau, sent)},
          {"csv", "wavenumber [1/cm], extinction [1/km], source_radiance [W/(cm2 sr cm-1)]\n2000,0.2,1e-7\n2250,0.1,5e-8\n2500,1.5,2e-8\n"},
          {"csv", "wavelength_nm,transmittance_1km,transmittance_500m\n4000,0.5,0.7\n4500,0.7,0.8\n5000,0,0.001\n"},
          {"table", readAll(fs::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air")}};
}

class Damage {
 public:
  explicit Damage(std::uint64_t seed) : random_(seed) {}
  size_t below(size_t n) { return static_cast<size_t>(random_() % std::max<size_t>(n, 1)); }
  void apply(std::string& text) {
    static const char* const kWords[] = {"nan", "inf", "-inf", "1e999", "-1", "0", "1e30", "1e-300", "*******", "1.5.2", ",", "\xff", "-9999.", "\r", "\t"};
    const size_t at = below(text.size()), length = below(60);
    switch (below(8)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, text.substr(below(text.size()), length));
        break;
      case 2:
        text.resize(at);
        break;
      case 3:
        if (!text.empty()) text[at] = static_cast<char>(random_());
        break;
      case 4:
        if (!text.empty()) text[at] = "0123456789.-+eEDTF,* \n["[below(23)];
        break;
      case 5:
        text.insert(at, std::string(length, ' '));
        break;
      default: {  // over what stands there, so that columns stay
        const std::string word = kWords[below(std::size(kWords))];
        if (at + word.size() < text.size()) text.replace(at, word.size(), word);
      }
    }
  }

 private:
  std::mt19937_64 random_;
};

long long fromEnvironment(const char* name, long long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

/// Every number that a plan or a shader would ask for.
bool isFinite(const Atmosphere& path) {
  for (double um : path.knots_um()) {
    const AirNode node = path.node(um);
    if (!(std::isfinite(node.source) && node.source >= 0.0)) return false;
    for (double c : node.extinction)
      if (!(std::isfinite(c) && c >= 0.0)) return false;
    for (double range : {0.0, 1e-3, 1e3, 1e7, 1e30}) {
      const double tau = path.transmittance(node, path.amounts({100.0, 0.1, 6.371e6}, range));
      if (!(tau >= 0.0 && tau <= 1.0)) return false;
    }
  }
  return path.validLow_um() < path.validHigh_um();
}

TEST(FuzzAir, DamagedTablesAreReadOrRefused) {
  const auto seed = static_cast<std::uint64_t>(fromEnvironment("PITVIPER_FUZZ_SEED", 1));
  const int cases = static_cast<int>(fromEnvironment("PITVIPER_FUZZ_AIR", 3000));
  const auto sound = corpus();
  const fs::path folder = fs::temp_directory_path() / ("pitviper_fuzz_air_" + std::to_string(getpid())), home = PITVIPER_SOURCE_DIR;
  fs::create_directories(folder);
  const Libraries libraries{home / "materials/library", home / "atmosphere/library", home / "sensors/library"};
  const auto read = [&](const char* key, const std::string& text) {
    std::ofstream(folder / "air", std::ios::binary) << text;
    return readScenarioText(
        std::string("atmosphere: {") + key +
            ": air}\n"
            "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: 300 K}]\n"
            "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m], "
            "channels: [{name: mw, response: {band: [4.1 um, 4.9 um]}}]}]\n",
        "case.yaml", folder, {}, libraries);
  };
  for (const Corpus& c : sound) EXPECT_TRUE(isFinite(*read(c.key, c.text).air));  // undamaged: else all would be refused for a reason of the test's own

  int accepted = 0, refused = 0, failed = 0;
  double slowest_s = 0.0;
  for (int i = 0; i < cases; ++i) {
    const std::uint64_t own = seed + static_cast<std::uint64_t>(i);
    Damage damage(own);
    const Corpus& chosen = sound[damage.below(sound.size())];
    std::string text = chosen.text;
    for (size_t n = 1 + damage.below(3); n > 0; --n) damage.apply(text);
    const std::clock_t begin = std::clock();  // of the processor: a busy machine fails nothing
    std::string wrong;
    try {
      const Simulation sim = read(chosen.key, text);
      ++accepted;
      if (!isFinite(*sim.air)) wrong = "read, but not finite";
    } catch (const UserError& e) {
      ++refused;
      const std::string message = e.what();
      if (message.find('\n') != std::string::npos || message.find("; expected ") == std::string::npos || message.find("; fix: ") == std::string::npos ||
          message.size() > 2000 || (message.rfind((folder / "air").string() + ":", 0) != 0 && message.rfind("case.yaml:", 0) != 0))
        wrong = "a message without place, expectation or fix: " + message;
    } catch (const std::exception& e) {
      wrong = std::string("another exception: ") + e.what();
    }
    slowest_s = std::max(slowest_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    if (wrong.empty()) continue;
    ++failed;
    fs::copy_file(folder / "air", folder / ("failed_" + std::to_string(own)), fs::copy_options::overwrite_existing);
    ADD_FAILURE() << "seed " << own << " (" << chosen.key << "): " << wrong;
  }
  std::printf("%d damaged tables of air from seed %llu: %d accepted, %d refused, %d failed; slowest %.2f s\n", cases, static_cast<unsigned long long>(seed),
              accepted, refused, failed, slowest_s);
  EXPECT_GT(refused, cases / 4) << "the damage does not damage";
  EXPECT_GT(accepted, cases / 50) << "nothing is read";
  EXPECT_LT(slowest_s, 60.0);  // the slowest takes 0.1 s
  if (failed == 0) fs::remove_all(folder);
}

}  // namespace
}  // namespace pitviper
