// Layers against an independent transfer matrix (Abeles), closed forms and the laws that any stack keeps.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <random>

#include "materials/film_stack.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

using Wide = std::complex<long double>;
constexpr long double kTurn = 6.283185307179586476925L;

/// Abeles' characteristic matrices in extended precision: none of the recursion's formulas. Source: Born and Wolf, Principles of Optics, section 1.6.
FilmPower byMatrix(const std::vector<FilmLayer>& layers, std::complex<double> beneath, double w, double sine) {
  FilmPower all;
  const Wide in = std::sqrt(Wide(1.0L - static_cast<long double>(sine) * sine));
  for (bool parallel : {false, true}) {
    const auto cosineIn = [&](Wide n) {
      Wide c = std::sqrt(Wide(1.0L) - static_cast<long double>(sine) * static_cast<long double>(sine) / (n * n));
      return (n * c).imag() < 0.0L ? -c : c;
    };
    const auto admittance = [&](Wide n) { return parallel ? n / cosineIn(n) : n * cosineIn(n); };
    Wide substrate(beneath.real(), beneath.imag());
    size_t last = layers.size();
    // What nothing comes back from is a half space: its matrix would not fit.
    for (size_t k = 0; k < layers.size(); ++k) {
      const Wide n(layers[k].index.real(), layers[k].index.imag());
      if ((n * cosineIn(n)).imag() * kTurn * layers[k].thickness_um / w > 200.0L) {
        substrate = n;
        last = k;
        break;
      }
    }
    const bool cut = last < layers.size();
    Wide b = 1.0L, c = admittance(substrate);
    for (size_t k = last; k-- > 0;) {
      const Wide n(layers[k].index.real(), layers[k].index.imag()), phase = kTurn * n * cosineIn(n) * static_cast<long double>(layers[k].thickness_um / w),
                                                                    own = admittance(n), i(0.0L, 1.0L);
      const Wide nextB = std::cos(phase) * b - i * std::sin(phase) / own * c, nextC = -i * own * std::sin(phase) * b + std::cos(phase) * c;
      b = nextB, c = nextC;
    }
    const Wide outside = parallel ? Wide(1.0L) / in : in, sum = outside * b + c;
    all.reflectance += static_cast<double>(0.5L * std::norm((outside * b - c) / sum));
    if (!cut) all.transmittance += static_cast<double>(2.0L * outside.real() * admittance(substrate).real() / std::norm(sum));
  }
  return all;
}

// Issue's range: thickness 0 to 1e5 nm, 0 to 89.9 degrees, n 0.05 to 6, k 0 to 60.
TEST(FilmStack, IsTheTransferMatrix) {
  std::mt19937_64 random(20061);
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto index = [&] {
    const double n = std::exp(uniform(std::log(0.05), std::log(6.0)));
    return std::complex<double>(n, uniform(0, 1) < 0.3 ? 0.0 : std::exp(uniform(std::log(1e-6), std::log(60.0))));
  };
  double worstR = 0.0, worstT = 0.0, made = 0.0;
  for (int i = 0; i < 20000; ++i) {
    std::vector<FilmLayer> layers;
    for (int k = static_cast<int>(uniform(0, 5.99)); k > 0; --k)
      layers.push_back({index(), uniform(0, 1) < 0.1 ? 0.0 : std::exp(uniform(std::log(1e-4), std::log(100.0))), true});
    const auto beneath = index();
    const double w = std::exp(uniform(std::log(0.3), std::log(30.0))), sine = std::sin(uniform(0.0, 89.9) * kPi / 180.0);
    const FilmPower own = filmPower(layers, beneath, w, sine), other = byMatrix(layers, beneath, w, sine);
    worstR = std::max(worstR, std::abs(own.reflectance - other.reflectance));
    worstT = std::max(worstT, std::abs(own.transmittance - other.transmittance));
    made = std::max(made, own.reflectance + own.transmittance - 1.0);
  }
  bound("20,000 random stacks against Abeles' matrices in extended precision, reflectance", worstR, 1e-5, "asked for");
  bound("20,000 random stacks against Abeles' matrices in extended precision, transmittance", worstT, 1e-5, "asked for");
  bound("energy that a stack makes", made, 1e-9, "rounding");
}

TEST(FilmStack, ClosedForms) {
  // A quarter wave of n1 on n2: ((n2 - n1^2) / (n2 + n1^2))^2. Source: Macleod, Thin-Film Optical Filters, section 3.1.
  const double n1 = 1.38, n2 = 1.52, expected = std::pow((n2 - n1 * n1) / (n2 + n1 * n1), 2.0);
  figure("magnesium fluoride's quarter wave on crown glass", filmPower({{n1, 0.55 / (4.0 * n1), true}}, n2, 0.55, 0.0).reflectance, expected, 1e-12,
         "closed form");
  // A half wave is as if it were not there.
  figure("a half wave of titanium dioxide on glass", filmPower({{2.3, 0.55 / (2.0 * 2.3), true}}, 1.52, 0.55, 0.0).reflectance, std::pow(0.52 / 2.52, 2.0),
         1e-12, "closed form");
  // Fresnel by Brewster's angle: r_p = 0, r_s = (1 - n^2) / (1 + n^2).
  figure("glass at Brewster's angle", filmPower({}, 1.5, 0.55, 1.5 / std::sqrt(3.25)).reflectance, 0.5 * std::pow(1.25 / 3.25, 2.0), 1e-12, "closed form");
  // Metals at normal incidence: ((n - 1)^2 + k^2) / ((n + 1)^2 + k^2).
  figure("n 0.2, k 3.4 at normal incidence", filmPower({}, {0.2, 3.4}, 0.55, 0.0).reflectance, (0.64 + 11.56) / (1.44 + 11.56), 1e-12, "closed form");
  // A free film at an angle: Airy's sum, 4 R sin^2 / ((1 - R)^2 + 4 R sin^2) for each polarisation.
  const double n = 1.33, d = 0.5, w = 0.6, sine = std::sin(0.7), ci = std::cos(0.7), ct = std::sqrt(1.0 - sine * sine / (n * n)),
               s2 = std::pow(std::sin(2.0 * kPi * n * d * ct / w), 2.0);
  double airy = 0.0;
  for (double r : {(ci - n * ct) / (ci + n * ct), (n * ci - ct) / (n * ci + ct)})
    airy += 0.5 * 4.0 * r * r * s2 / (std::pow(1.0 - r * r, 2.0) + 4.0 * r * r * s2);
  figure("a soap film at 40 degrees", filmPower({{n, d, true}}, 1.0, w, sine).reflectance, airy, 1e-12, "Airy's sum");
  // A thick pane without absorption: 2 R / (1 + R) for each polarisation, at normal incidence.
  const double face = std::pow(0.5 / 2.5, 2.0);
  figure("a thick pane of glass, reflectance", filmPower({{1.5, 4000.0, false}}, 1.0, 0.55, 0.0).reflectance, 2.0 * face / (1.0 + face), 1e-12, "closed form");
  figure("a thick pane of glass, transmittance", filmPower({{1.5, 4000.0, false}}, 1.0, 0.55, 0.0).transmittance, (1.0 - face) / (1.0 + face), 1e-12,
         "closed form");
  // One that absorbs: T = (1 - R)^2 a / (1 - R^2 a^2), a = exp(-4 pi k d / lambda).
  const std::complex<double> smoky(1.5, 1e-5);
  const double a = std::exp(-4.0 * kPi * 1e-5 * 4000.0 / 0.55), R = (0.25 + 1e-10) / (6.25 + 1e-10);
  figure("a thick pane that absorbs, transmittance", filmPower({{smoky, 4000.0, false}}, 1.0, 0.55, 0.0).transmittance,
         (1.0 - R) * (1.0 - R) * a / (1.0 - R * R * a * a), 1e-9, "closed form");
}

// The mean over fringes of a coherent layer is the incoherent one.
TEST(FilmStack, FringesAverageToPowers) {
  const double d = 20.0, w = 0.8, sine = 0.6;
  for (const std::complex<double> n : {std::complex<double>(1.5), std::complex<double>(2.4, 2e-4)}) {
    double r = 0.0, t = 0.0;
    const double across = std::sqrt(n.real() * n.real() - sine * sine), period = w / (2.0 * across);
    constexpr int kPlaces = 256;
    for (int k = 0; k < kPlaces; ++k) {
      const FilmPower p = filmPower({{n, d + period * k / kPlaces, true}}, 1.7, w, sine);
      r += p.reflectance / kPlaces, t += p.transmittance / kPlaces;
    }
    const FilmPower mean = filmPower({{n, d + 0.5 * period, false}}, 1.7, w, sine);
    figure("mean reflectance over a fringe", r, mean.reflectance, 1e-4, "coherent against incoherent; phases of an absorbing face are left out");
    figure("mean transmittance over a fringe", t, mean.transmittance, 1e-4, "coherent against incoherent");
  }
}

// Helmholtz: what goes through comes back the same way as well, absorbing layers or not.
TEST(FilmStack, GoesThroughAlikeBothWays) {
  const std::vector<FilmLayer> layers{{{2.3, 0.05}, 0.15, true}, {{1.4, 0.0}, 12.0, false}, {{0.3, 2.0}, 0.01, true}};
  for (double sine : {0.0, 0.4, 0.9}) {
    const double n = 1.6;
    figure("through and back", filmPowerFromBeneath(layers, n, 0.7, sine / n).transmittance, filmPower(layers, n, 0.7, sine).transmittance, 2e-3,
           "unpolarised powers of a thick layer: its two polarisations are alike each");
  }
  EXPECT_NEAR(filmPowerFromBeneath({}, 1.5, 0.7, 0.8).reflectance, 1.0, 1e-12);  // total reflection
}

}  // namespace
}  // namespace pitviper::test
