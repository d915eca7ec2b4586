#include "sensors/gimbal/jitter.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr int kWaves = 256;
constexpr double kCorners = 100.0;  // documented with AxisJitter

/// Its variance below a frequency, and the other way round.
class Cumulative {
 public:
  explicit Cumulative(const AxisJitter& jitter) : rms_(jitter.rms_rad), corner_Hz_(jitter.corner_Hz), points_(jitter.spectrum), sums_(points_.size(), 0.0) {
    for (std::size_t i = 1; i < points_.size(); ++i)
      sums_[i] = sums_[i - 1] + 0.5 * (points_[i - 1].density_rad2_Hz + points_[i].density_rad2_Hz) * (points_[i].frequency_Hz - points_[i - 1].frequency_Hz);
  }
  double least_Hz() const { return points_.empty() ? 0.0 : points_.front().frequency_Hz; }
  double most_Hz() const { return points_.empty() ? kCorners * corner_Hz_ : points_.back().frequency_Hz; }
  double total() const { return points_.empty() ? rms_ * rms_ : sums_.back(); }
  double below(double f_Hz) const {
    f_Hz = std::clamp(f_Hz, least_Hz(), most_Hz());
    if (points_.empty()) return rms_ == 0.0 ? 0.0 : rms_ * rms_ * std::atan(f_Hz / corner_Hz_) / std::atan(kCorners);
    const auto after = std::upper_bound(points_.begin(), points_.end(), f_Hz, [](double f, const AxisJitter::Point& p) { return f < p.frequency_Hz; });
    const auto i = static_cast<std::size_t>(after - points_.begin()) - 1;
    if (i + 1 == points_.size()) return sums_.back();
    const double in_Hz = f_Hz - points_[i].frequency_Hz, span_Hz = points_[i + 1].frequency_Hz - points_[i].frequency_Hz;
    const double rise = (points_[i + 1].density_rad2_Hz - points_[i].density_rad2_Hz) / span_Hz;
    return sums_[i] + in_Hz * (points_[i].density_rad2_Hz + 0.5 * rise * in_Hz);
  }

 private:
  double rms_, corner_Hz_;
  std::vector<AxisJitter::Point> points_;
  std::vector<double> sums_;
};

/// Where a function that does not fall reaches a value, by halving to the last digit.
template <class F>
double reached(const F& function, double value, double low, double high) {
  constexpr int kHalvings = 80;  // of any span that frequencies have, down to a double's spacing
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (function(middle) < value ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

std::uint64_t mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// FNV-1a (Fowler, Noll, Vo), 64 bits: the same on every machine, which std::hash need not be.
std::uint64_t hashOf(std::string_view text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return hash;
}

/// In (0, 1).
double uniform(std::uint64_t key, std::uint64_t counter) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
  return (static_cast<double>(mixed(key + (counter + 1) * kGolden) >> 12) + 0.5) * 0x1p-52;
}

}  // namespace

void requireSound(const AxisJitter& j) {
  const auto require = [](bool sound, const char* what) {
    if (!sound) throw std::invalid_argument(std::string("jitter: ") + what);
  };
  require(j.rms_rad >= 0.0 && std::isfinite(j.rms_rad) && j.corner_Hz >= 0.0 && std::isfinite(j.corner_Hz), "an rms or a corner that is negative or no number");
  require(j.rms_rad == 0.0 || j.spectrum.empty(), "an rms beside a spectrum");
  require(j.rms_rad == 0.0 || j.corner_Hz > 0.0, "an rms without a corner frequency");
  require(j.spectrum.size() != 1, "a spectrum of one point");
  for (std::size_t i = 0; i < j.spectrum.size(); ++i) {
    const auto& [f_Hz, density] = j.spectrum[i];
    require(f_Hz >= 0.0 && std::isfinite(f_Hz) && density >= 0.0 && std::isfinite(density), "a spectrum with what is negative or no number");
    require(i == 0 || f_Hz > j.spectrum[i - 1].frequency_Hz, "frequencies that do not rise");
  }
}

double variance_rad2(const AxisJitter& jitter) { return Cumulative(jitter).total(); }

double varianceBelow_rad2(const AxisJitter& jitter, double frequency_Hz) { return Cumulative(jitter).below(frequency_Hz); }

JitterCourse::JitterCourse(const Jitter& jitter, std::uint64_t seed, std::string_view camera) {
  const AxisJitter* axes[] = {&jitter.left, &jitter.up};
  for (std::uint64_t axis = 0; axis < 2; ++axis) {
    requireSound(*axes[axis]);
    const Cumulative power(*axes[axis]);
    if (!(power.total() > 0.0)) continue;
    const double least_Hz = power.least_Hz(), most_Hz = power.most_Hz();
    const auto below = [&](double f_Hz) { return power.below(f_Hz); };
    // Below the knee bins are even in frequency, above in its logarithm; it lies where a tenth of the variance does.
    const double knee_Hz = reached(below, 0.1 * power.total(), least_Hz, most_Hz) + 1e-3 * most_Hz;
    const auto logarithm = [&](double f_Hz) { return std::log1p((f_Hz - least_Hz) / knee_Hz) / std::log1p((most_Hz - least_Hz) / knee_Hz); };
    const auto share = [&](double f_Hz) { return 0.5 * (power.below(f_Hz) / power.total() + logarithm(f_Hz)); };
    const std::uint64_t key = mixed(mixed(seed) ^ hashOf(camera)) + axis * 0x632be59bd9b4e019u;
    double low_Hz = least_Hz;
    for (std::uint64_t i = 0; i < kWaves; ++i) {
      const double high_Hz = i + 1 == kWaves ? most_Hz : reached(share, static_cast<double>(i + 1) / kWaves, low_Hz, most_Hz);
      const double from = power.below(low_Hz), variance = power.below(high_Hz) - from;
      if (variance > 0.0)
        waves_[axis].push_back({reached(below, from + uniform(key, 2 * i) * variance, low_Hz, high_Hz), std::sqrt(2.0 * variance), uniform(key, 2 * i + 1)});
      low_Hz = high_Hz;
    }
  }
}

glm::dvec2 JitterCourse::at(double time_s) const {
  glm::dvec2 offset(0.0);
  for (int axis = 0; axis < 2; ++axis)
    for (const Wave& w : waves_[static_cast<std::size_t>(axis)]) {
      const double turns = w.frequency_Hz * time_s + w.phase_turns;
      offset[axis] += w.amplitude_rad * std::cos(2.0 * kPi * (turns - std::floor(turns)));
    }
  return offset;
}

}  // namespace pitviper
