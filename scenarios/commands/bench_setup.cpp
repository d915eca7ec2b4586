#include "scenarios/commands/bench_setup.hpp"

#include <cmath>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {

Setup::Setup(const BenchOptions& options, const std::string& target, int frames, int samples, const std::string& commands) {
  simulation_ = readScenarioText(
      print("name: bench\nseed: %lld\ntime: {rate: %.9g Hz, frames: %d}\nbackground: {temperature: 3 K}\nmaterials: {black: {components: []}}\n", options.seed,
            1.0 / options.step_s, frames) +
          target + print("cameras:\n- name: bench\n  position: [0 m, 0 m, 0 m]\n  heading: 90 deg\n  samples: %d\n", samples) + options.camera + commands,
      "bench", options.base, options.changes, findLibraries());
  Camera& c = simulation_.cameras.front();
  c.window.reset();
  c.truth = {};
  c.spectralImage.reset();
  c.spectral.accuracy = 0.0;  // every wavelength of its own sampling
  c.motionBlur = false;
  film_ = {c.pinhole.width, c.pinhole.height};
  c.pinhole.width = std::min(c.pinhole.width, options.film_px);
  c.pinhole.height = std::min(c.pinhole.height, options.film_px);
  simulation_.audit = 0.0;
}

std::string plate(const char* name, double left_m, double right_m, double halfHeight_m, double kelvin, double roll_deg, double range_m) {
  // A plate faces along x; seen from the west its y runs to the left.
  return print(
      "  - {name: %s, shape: {model: plate, width: %.9g m, height: %.9g m}, material: black, temperature: %.9g K, position: [%.9g m, %.9g m, 0 m], heading: "
      "270 deg, roll: %.9g deg}\n",
      name, right_m - left_m, 2.0 * halfHeight_m, kelvin, range_m, -0.5 * (left_m + right_m), roll_deg);
}

std::vector<char> badPixels(const std::vector<double>& mean) {
  std::vector<double> off, sorted = mean;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2), sorted.end());
  const double median = sorted[sorted.size() / 2];
  for (double v : mean) off.push_back(std::abs(v - median));
  sorted = off;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<long>(sorted.size() / 2), sorted.end());
  const double most = std::max(10.0 * sorted[sorted.size() / 2], 1.0);
  std::vector<char> bad;
  for (double o : off) bad.push_back(o > most);
  return bad;
}

}  // namespace pitviper
