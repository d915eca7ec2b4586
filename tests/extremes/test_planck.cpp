// Planck's law where its exponential over- and underflows: 2 to 6000 K, 0.3 to 30 um; a result is right or 0, never NaN.
#include "sim/radiometry/constants.hpp"
#include "tests/extremes/extremes.hpp"
#include "tests/support/compare.hpp"

namespace pitviper::test {
namespace {

constexpr double kTemperatures_K[] = {2, 3, 5, 9, 20, 77, 200, 300, 1000, 2700, 6000};
constexpr double kWavelengths_um[] = {0.3, 0.5, 0.9, 1.6, 3, 5, 8, 12, 20, 30};
/// Bands so narrow that 16 Gauss points leave nothing even at c2 / (lambda T) = 87; reference mode takes the middle of its bins.
constexpr double kWidth = 1e-3;

std::pair<double, double> bandAt(double wavelength_um, bool reference) {
  if (!reference) return {wavelength_um, wavelength_um * (1 + kWidth)};
  const OneBin bin(wavelength_um);
  return {bin.low_um, bin.high_um};
}

double expected(double wavelength_um, double temperature_K, bool reference) {
  if (!reference) return blackBodyBand(wavelength_um, wavelength_um * (1 + kWidth), temperature_K);
  const OneBin bin(wavelength_um);
  return planck(bin.middle_um(), temperature_K) * bin.width_um();
}

std::string channels(bool reference) {
  std::string all;
  for (double w : kWavelengths_um) {
    const auto [low, high] = bandAt(w, reference);
    all += (all.empty() ? "[" : ", ") +
           ("{name: c" + std::to_string(static_cast<int>(10 * w)) + ", response: {band: [" + text(low) + " um, " + text(high) + " um]}}");
  }
  return all + "]";
}

double c2Over(double wavelength_um, double temperature_K) { return kSecondRadiation_umK / (wavelength_um * temperature_K); }

/// The least band radiance that is promised: sums of 16 normal floats. In a shader that evaluates Planck's law itself also where the
/// exponential is a normal float, x < 87.
double leastHeld(double wavelength_um, bool inShader) {
  const double width = kWidth * wavelength_um, exponential = kFirstRadianceConstant / std::pow(wavelength_um, 5) * std::exp(-87.33) * width;
  return std::max(100.0 * 1.2e-38, inShader ? 1.1 * exponential : 0.0);
}

std::string uniform(double t) { return text(t) + " K"; }
std::string texture(double t) { return "{rows: [[" + text(t) + " K, " + text(t) + " K]]}"; }

void sweep(const std::string& name, std::string (*temperature)(double), bool inShader, bool reference) {
  Range warm(name + ", c2/(lambda T) to 60", reference ? 1e-6 : 1e-5,
             reference ? "Planck's law in long double; pictures are single precision" : "Planck series; x rounds: 60 x 1.2e-7");
  Range cold(name + ", beyond, where not 0", 2e-5, "Planck series; x rounds: 87 x 1.2e-7");
  int zeros = 0;
  for (double t : kTemperatures_K) {
    Look look;
    look.channels = channels(reference);
    const std::string yaml =
        "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: " + temperature(t) + "}]\n" + look.yaml();
    const Frame f = finiteFrame(reference ? inDouble(yaml) : yaml);
    for (size_t k = 0; k < std::size(kWavelengths_um); ++k) {
      const double w = kWavelengths_um[k], got = middleOf(f, k), want = expected(w, t, reference);
      const std::string at = text(w) + " um, " + text(t) + " K";
      if (want < leastHeld(w, inShader)) {
        ++zeros;
        EXPECT_GE(got, 0.0) << at;
        EXPECT_LE(got, 1.01 * leastHeld(w, inShader)) << at;
      } else {
        (c2Over(w, t) <= 60.0 ? warm : cold).add(got, want, at);
      }
    }
  }
  EXPECT_GT(zeros, 10);
}

TEST(Planck, UniformTemperature) { sweep("Planck, 2-6000 K, 0.3-30 um", uniform, false, false); }
TEST(Planck, TemperatureTexture) { sweep("Planck of a temperature texture, 2-6000 K, 0.3-30 um", texture, true, false); }
TEST(Planck, InDouble) {
  sweep("Planck in double, 2-6000 K, 0.3-30 um", uniform, false, true);
  sweep("Planck of a texture in double, 2-6000 K, 0.3-30 um", texture, false, true);
}

// From 0 K to 100 000 K over one texture: what lies between two texels is mixed in kelvin; GPU against double pixel by pixel.
TEST(Planck, TextureFromAbsoluteZeroToTheHottest) {
  for (const auto& [low, high] : {std::pair{0.3, 0.4}, {3.0, 5.0}, {28.0, 30.0}}) {
    const Look look{.low_um = low, .high_um = high, .pixels = 32, .field_deg = 20};
    const std::string yaml =
        "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: blackbody, temperature: {rows: [[0 K, 6000 K], [100000 K, 0 K]]}}]\n" +
        look.yaml();
    const Worst w = compare(scene(yaml), 1);
    EXPECT_GT(w.covered, 500);
    bound("temperature texture from 0 to 100000 K, " + text(low) + "-" + text(high) + " um, worst pixel", w.error, 1e-4,
          "double, same wavelengths; x rounds, and so does the mixing of kelvin");
    finiteFrame(yaml);
    finiteFrame(inDouble(yaml));
  }
}

TEST(Planck, AbsoluteZeroIsBlack) {
  for (const std::string& yaml : {plate(0) + Look{}.yaml(), Look{}.yaml(),
                                  "entities: [{name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: "
                                  "blackbody, temperature: {rows: [[0 K]]}}]\n" +
                                      Look{}.yaml()}) {
    EXPECT_EQ(middle(yaml), 0.0);
    EXPECT_EQ(middle(inDouble(yaml)), 0.0);
  }
}

}  // namespace
}  // namespace pitviper::test
