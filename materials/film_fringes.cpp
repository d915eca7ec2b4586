#include "materials/film_fringes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/reference_width.hpp"

namespace pitviper {
namespace {

/// Fringes closer together than this part of the reference's width begin to be averaged, and are where they are closer than the second.
constexpr double kResolved = 1.0, kAveraged = 0.5;
/// Of the reference's width: exp(-2 pi^2 0.24^2 / 0.5^2) = 1 % is left of fringes at kAveraged.
constexpr double kSpread = 0.24;
/// A Gauss curve ends there: 0.3 % lie beyond; a fringe takes so many places at least, and a curve as many at most.
constexpr double kEnd = 3.0, kPlacesOfFringe = 12.0, kPlacesOfSpread = 4.0;
constexpr int kMostPlaces = 401;
/// What a sum over wavelengths may lose: frequencies that are less than this of what is reflected, or not, are left out.
constexpr double kSeen = 2e-4;
/// Middles of bins miss a band's ends by (pi / so many)^2 / 6 of half a fringe; of one with overtones, two for each turn of the highest.
constexpr double kLeastOfFringe = 16.0;
/// No bin is smaller than this part of the reference's width, and no smaller than the second where fringes are averaged.
constexpr double kFinest = 1.0 / 8.0, kOfMeans = 1.0 / 4.0;
/// Frequencies are looked for over so many fringes.
constexpr int kFringes = 4, kLooks = 512;
/// Sines of incidence at which they are.
constexpr double kSines[] = {0.0, 0.95};

}  // namespace

double fringeApart_um(std::span<const FilmLayer> layers, double w) {
  double path = 0.0, most = 0.0;
  for (const FilmLayer& l : layers) {
    path = l.coherent ? path + 2.0 * l.index.real() * l.thickness_um : 0.0;
    most = std::max(most, path);
  }
  return most > 0.0 ? w * w / most : std::numeric_limits<double>::infinity();
}

double fringeSpread_um(double apart, double w) {
  const double width = referenceWidth_um(w), t = std::clamp((kResolved - apart / width) / (kResolved - kAveraged), 0.0, 1.0);
  return kSpread * width * t * t * (3.0 - 2.0 * t);
}

double fringeStep_um(const std::vector<FilmLayer>& layers, std::complex<double> beneath, double w) {
  const double apart = fringeApart_um(layers, w), width = referenceWidth_um(w);
  // So many bins a fringe do whatever it is made of.
  if (!(apart < 1.5 * kLeastOfFringe * width)) return std::numeric_limits<double>::infinity();
  if (apart < kAveraged * width) return kOfMeans * width;
  if (apart < kResolved * width) return kFinest * width;
  // Blackman and Harris's window of four terms: what leaks beside a frequency is below 1e-4.6 of it.
  static const auto window = [] {
    std::array<double, kLooks> all{};
    for (int k = 0; k < kLooks; ++k) {
      const double a = 2.0 * kPi * (k + 0.5) / kLooks;
      all[static_cast<std::size_t>(k)] = 1.0 - (0.48829 * std::cos(a) - 0.14128 * std::cos(2.0 * a) + 0.01168 * std::cos(3.0 * a)) / 0.35875;
    }
    return all;
  }();
  static const auto turns = [] {
    std::array<std::complex<double>, kLooks> all{};
    for (int k = 0; k < kLooks; ++k) all[static_cast<std::size_t>(k)] = std::polar(1.0, 2.0 * kPi * k / kLooks);
    return all;
  }();
  int highest = 0;
  std::vector<FilmLayer> own = layers;
  for (double sine : kSines) {
    std::array<FilmPower, kLooks> seen{};
    FilmPower mean;
    for (int k = 0; k < kLooks; ++k) {
      const double thicker = 1.0 + kFringes * ((k + 0.5) / kLooks - 0.5) * apart / w;
      for (std::size_t j = 0; j < own.size(); ++j)
        if (layers[j].coherent) own[j].thickness_um = layers[j].thickness_um * thicker;
      FilmPower& at = seen[static_cast<std::size_t>(k)] = filmPower(own, beneath, w, sine);
      mean.reflectance += at.reflectance / kLooks, mean.transmittance += at.transmittance / kLooks;
    }
    const double least = kSeen * kLooks * std::max(1e-3, std::min(mean.reflectance, 1.0 - mean.reflectance));
    for (int f = kLooks / 2 - 1; f > highest; --f) {
      std::complex<double> r = 0.0, t = 0.0;
      for (std::size_t k = 0; k < kLooks; ++k) {
        const auto turn = window[k] * turns[static_cast<std::size_t>(f) * k % kLooks];
        r += turn * (seen[k].reflectance - mean.reflectance), t += turn * (seen[k].transmittance - mean.transmittance);
      }
      if (std::max(std::abs(r), std::abs(t)) > least) highest = f;
    }
  }
  if (highest == 0) return std::numeric_limits<double>::infinity();
  return std::max(apart / std::max(2.0 * highest / kFringes, kLeastOfFringe), kFinest * width);
}

FringeMean::FringeMean(std::span<const FilmLayer> layers, double w) {
  const double apart = fringeApart_um(layers, w), spread = fringeSpread_um(apart, w);
  if (!(spread > 0.0)) {
    places = {{1.0, 1.0}};
    return;
  }
  const double step = std::min(apart / kPlacesOfFringe, spread / kPlacesOfSpread);
  const int half = std::clamp(static_cast<int>(std::ceil(kEnd * spread / step)), 1, kMostPlaces / 2);
  double sum = 0.0;
  for (int k = -half; k <= half; ++k) {
    const double away = kEnd * k / half, weight = std::exp(-0.5 * away * away);
    // As thick as if the wavelength were so much shorter.
    places.push_back({1.0 + away * spread / w, weight});
    sum += weight;
  }
  for (Place& p : places) p.weight /= sum;
}

}  // namespace pitviper
