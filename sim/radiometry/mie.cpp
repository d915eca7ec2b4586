#include "sim/radiometry/mie.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

using Complex = std::complex<double>;
/// Smallest divisor of a ratio of Bessel functions: a zero hit exactly. Far below what rounding leaves of it.
constexpr double kAlmostZero = 1e-30;
/// Intervals that a smooth distribution begins with at least; spheres before and at which, and terms of them at which, doubling does not and does end.
constexpr int kIntervals = 32, kFewestSpheres = 64, kMostSpheres = 16384, kMostTerms = 2000000;
/// What is left out of a distribution's tails.
constexpr double kTail = 1e-7;

std::size_t at(int n) { return static_cast<std::size_t>(n); }

/// Plain arithmetic: std::complex looks for infinities, of which there are none here, and takes five times as long.
Complex times(Complex p, Complex q) { return {p.real() * q.real() - p.imag() * q.imag(), p.real() * q.imag() + p.imag() * q.real()}; }
Complex inverse(Complex z) {
  const double s = 1.0 / std::norm(z);
  return {z.real() * s, -z.imag() * s};
}
double inverse(double z) { return 1.0 / z; }
Complex ratio(Complex p, Complex q) { return times(p, inverse(q)); }
Complex timesI(Complex z) { return {-z.imag(), z.real()}; }

/// n beyond which |a_n| and |b_n| are below 1e-16 of the largest: psi_n / chi_n falls as exp(-4/3 zeta^(3/2)), zeta = 2^(1/3) (n - x) / x^(1/3).
int termsOf(double x) { return static_cast<int>(x + 7.5 * std::cbrt(x)) + 4; }

/// r_n = psi_n(z) / psi_(n-1)(z) for n from `low` to `high`, at index n - low: downwards, the way in which errors shrink.
template <class Z>
std::vector<Z> ratios(Z z, int low, int high) {
  std::vector<Z> r(at(high - low + 1));
  const Z step = inverse(z);
  Z below{};
  for (int n = std::max(high, termsOf(std::abs(z))) + 12 + static_cast<int>(2.0 * std::cbrt(high)); n >= low; --n) {
    Z divisor = (2.0 * n + 1.0) * step - below;
    if (std::abs(std::real(divisor)) + std::abs(std::imag(divisor)) < kAlmostZero) divisor = kAlmostZero;
    below = inverse(divisor);
    if (n <= high) r[at(n - low)] = below;
  }
  return r;
}

/// psi_n and chi_n of a real argument for n from 0 on; xi = psi - i chi.
struct RiccatiBessel {
  std::vector<double> psi, chi;
  RiccatiBessel(double x, int last) : psi(at(last + 1)), chi(at(last + 1)) {
    const double c = std::cos(x), s = std::sin(x);
    psi[0] = s, chi[0] = c;
    chi[1] = c / x + s;
    for (int n = 1; n < last; ++n) chi[at(n + 1)] = (2.0 * n + 1.0) / x * chi[at(n)] - chi[at(n - 1)];
    // Upwards as far as psi swings; beyond, where it falls and an upward error would grow, by ratios. There is no zero of psi_n below x = n.
    const int turn = std::min(static_cast<int>(x), last);
    if (turn >= 1) psi[1] = s / x - c;
    for (int n = 1; n < turn; ++n) psi[at(n + 1)] = (2.0 * n + 1.0) / x * psi[at(n)] - psi[at(n - 1)];
    if (turn == last) return;
    const std::vector<double> r = ratios(x, turn + 1, last);
    for (int n = turn + 1; n <= last; ++n) psi[at(n)] = psi[at(n - 1)] * r[at(n - turn - 1)];
  }
};

/// What is within the outermost surface: f and e, up to a common factor, of f' / f = (n + 1) / (m x) - e / f. By way of e, the leading (n + 1) / x of in- and
/// outside never has to be taken from each other, and small spheres lose no digits.
struct Inside {
  Complex fa, ea, fb, eb;
};

template <class InsideOf>
SphereScattering scatteredBy(double x, Complex m, InsideOf&& inside) {
  SphereScattering out;
  out.sizeParameter = x;
  const int terms = termsOf(x);
  out.a.resize(at(terms)), out.b.resize(at(terms));
  const RiccatiBessel outside(x, terms + 1);
  const Complex invM = inverse(m), contrast = times(times(1.0 - m, 1.0 + m), times(invM, invM)) / x;
  double ext = 0.0, sca = 0.0, turned = 0.0, sign = -1.0;
  Complex back = 0.0, lastA = 0.0, lastB = 0.0;
  for (int n = 1; n <= terms; ++n) {
    const Inside in = inside(n);
    const Complex ofA = times(in.fa, (n + 1.0) * contrast) - times(in.ea, invM), ofB = -times(in.eb, m);
    const auto coefficient = [&](Complex here, Complex next) {
      // Of psi and of chi apart, so that without absorption both are real and Re a = |a|^2 to the last digit.
      const Complex p = here * outside.psi[at(n)] + next * outside.psi[at(n + 1)];
      const Complex q = here * outside.chi[at(n)] + next * outside.chi[at(n + 1)];
      return ratio(p, p - timesI(q));
    };
    const Complex a = out.a[at(n - 1)] = coefficient(ofA, in.fa), b = out.b[at(n - 1)] = coefficient(ofB, in.fb);
    const auto alike = [](Complex p, Complex q) { return p.real() * q.real() + p.imag() * q.imag(); };
    ext += (2.0 * n + 1.0) * (a.real() + b.real());
    sca += (2.0 * n + 1.0) * (std::norm(a) + std::norm(b));
    turned += (n - 1.0) * (n + 1.0) / n * (alike(lastA, a) + alike(lastB, b)) + (2.0 * n + 1.0) / (n * (n + 1.0)) * alike(a, b);
    back += sign * (2.0 * n + 1.0) * (a - b);
    sign = -sign, lastA = a, lastB = b;
  }
  out.extinction = 2.0 / (x * x) * ext;
  out.scattering = 2.0 / (x * x) * sca;
  out.backscatter = std::norm(back) / (x * x);
  out.asymmetry = sca > 0.0 ? 2.0 * turned / sca : 0.0;
  return out;
}

void check(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(what);
}
void checkIndex(Complex m) {
  check(std::isfinite(m.real()) && std::isfinite(m.imag()) && m.real() > 0.0 && m.imag() >= 0.0, "mie: n must be above 0 and k not below 0");
  check(std::abs(m) >= 1e-3 && std::abs(m) <= 1e3, "mie: a refractive index must be from 1e-3 to 1e3");
}
void checkSize(double x) { check(x >= 1e-12 && x <= 1e6, "mie: a size parameter must be from 1e-12 to 1e6"); }

struct Weighted {
  const SphereScattering* sphere;
  double weight;
};

/// Moments of |S1|^2 + |S2|^2 of all spheres, over the zeroth. By chi_l ~ sum over n, n' of (2 n + 1) (2 n' + 1) (n n' l; 1 -1 0)^2 times
/// Re(a_n a_n'* + b_n b_n'*) where n + n' + l is even and Re(a_n b_n'* + b_n a_n'*) where it is odd.
std::vector<double> momentsOf(std::span<const Weighted> spheres, int count) {
  constexpr int kTogether = 32;  // n summed over all spheres at once, while the coefficients of one are at hand
  std::vector<double> chi(at(count)), even(at(kTogether * count)), odd(even.size());
  int terms = 0;
  for (const Weighted& s : spheres) terms = std::max(terms, static_cast<int>(s.sphere->a.size()));
  for (int n = 1; n <= terms; ++n) {
    const int slot = (n - 1) % kTogether;
    if (slot == 0) {
      std::fill(even.begin(), even.end(), 0.0), std::fill(odd.begin(), odd.end(), 0.0);
      for (const auto& [sphere, weight] : spheres)
        for (int k = 0; k < kTogether; ++k) {
          const int apart = std::min(count, static_cast<int>(sphere->a.size()) - n - k + 1);
          if (apart <= 0) break;
          const Complex *a = &sphere->a[at(n + k - 1)], *b = &sphere->b[at(n + k - 1)];
          const double ar = weight * a->real(), ai = weight * a->imag(), br = weight * b->real(), bi = weight * b->imag();
          double *same = &even[at(k * count)], *cross = &odd[at(k * count)];
          for (int d = 0; d < apart; ++d) {
            same[d] += ar * a[d].real() + ai * a[d].imag() + br * b[d].real() + bi * b[d].imag();
            cross[d] += ar * b[d].real() + ai * b[d].imag() + br * a[d].real() + bi * a[d].imag();
          }
        }
    }
    double square = 1.0 / (2.0 * n + 1.0);  // of the 3j symbol at l = d, n' = n + d
    for (int d = 0; d < std::min(count, terms - n + 1); ++d) {
      const double other = n + d, all = 2.0 * n + d + 1.0, factor = (d == 0 ? 1.0 : 2.0) * (2.0 * n + 1.0) * (2.0 * other + 1.0);
      double symbol = std::sqrt(square), last = 0.0, root = 0.0;
      for (int l = d; l < std::min(count, 2 * n + d + 1); ++l) {
        chi[at(l)] += factor * symbol * symbol * ((l + d) % 2 == 0 ? even : odd)[at(slot * count + d)];
        const double nextRoot = std::sqrt(((l + 1.0) * (l + 1.0) - 1.0 * d * d) * (all * all - (l + 1.0) * (l + 1.0)));
        if (nextRoot == 0.0) break;
        const double next = (2.0 * (2.0 * l + 1.0) * symbol - root * last) * (1.0 / nextRoot);
        last = symbol, symbol = next, root = nextRoot;
      }
      square *= 2.0 * (2.0 * d + 1.0) / (d + 1.0) * (other + 2.0) * other / ((2.0 * other + 3.0) * (2.0 * other + 2.0));
    }
  }
  if (count > 0 && chi[0] > 0.0) {
    for (std::size_t l = chi.size(); l-- > 0;) chi[l] /= chi[0];
  } else if (count > 0) {
    chi[0] = 1.0;  // nothing scattered: as if evenly
  }
  return chi;
}

}  // namespace

SphereScattering sphereScattering(double x, Complex m) {
  checkSize(x), checkIndex(m);
  if (m == 1.0) {
    SphereScattering none;
    none.sizeParameter = x;
    none.a.resize(at(termsOf(x))), none.b.resize(none.a.size());
    return none;
  }
  const std::vector<Complex> r = ratios(x * m, 2, termsOf(x) + 1);
  return scatteredBy(x, m, [&](int n) { return Inside{1.0, r[at(n - 1)], 1.0, r[at(n - 1)]}; });
}

SphereScattering coatedSphereScattering(double coreX, Complex coreM, double x, Complex shellM) {
  checkSize(x), checkIndex(coreM), checkIndex(shellM);
  check(coreX >= 0.0 && coreX <= x, "mie: a core must end within its shell");
  if (coreX < 1e-12 || coreM == shellM) return sphereScattering(x, shellM);
  if (coreX == x) return sphereScattering(x, coreM);
  const int last = termsOf(x) + 1;
  const Complex inner = coreX * shellM, outer = x * shellM;
  const std::vector<Complex> ofCore = ratios(coreX * coreM, 2, last), r1 = ratios(inner, 2, last), r2 = ratios(outer, 2, last);
  // In the shell psi_n(z) + R xi_n(z), R from the core's surface. Of xi, which decays outwards where the shell absorbs, only h_n = xi_n / xi_(n-1) and
  // rho = xi_n(outer) / xi_n(inner), at most about 1, are needed, because psi_n xi_n (r - h) = i with r and h of n + 1.
  const Complex step1 = inverse(inner), step2 = inverse(outer);
  const Complex contrast = (coreM - shellM) * (coreM + shellM) / (coreM * shellM * coreX);
  Complex h1 = step1 - Complex(0.0, 1.0), h2 = step2 - Complex(0.0, 1.0), rho = std::exp(timesI(outer - inner));
  return scatteredBy(x, shellM, [&](int n) {
    rho = times(rho, ratio(h2, h1));
    h1 = (2.0 * n + 1.0) * step1 - inverse(h1), h2 = (2.0 * n + 1.0) * step2 - inverse(h2);
    const Complex core = ofCore[at(n - 1)], p1 = r1[at(n - 1)], p2 = r2[at(n - 1)], free = inverse(p2 - h2);
    const Complex through = ratio(times(rho, rho), p1 - h1);
    const auto jumpA = [&](Complex q) { return (n + 1.0) * contrast - times(coreM, q) + times(shellM, core); };
    const auto jumpB = [&](Complex q) { return times(coreM, core) - times(shellM, q); };
    const Complex sentA = times(through, ratio(jumpA(p1), jumpA(h1))), sentB = times(through, ratio(jumpB(p1), jumpB(h1)));
    Inside in{free - sentA, times(p2, free) - times(sentA, h2), free - sentB, times(p2, free) - times(sentB, h2)};
    if (coreM.imag() == 0.0 && shellM.imag() == 0.0)  // a standing wave: without its phase it is real, and nothing is absorbed
      for (auto [f, e] : {std::pair{&in.fa, &in.ea}, {&in.fb, &in.eb}}) {
        const Complex phase = std::conj(std::norm(*f) > std::norm(*e) ? *f : *e);
        *f = times(*f, phase).real(), *e = times(*e, phase).real();
      }
    return in;
  });
}

ScatteringAmplitudes amplitudes(const SphereScattering& sphere, double cosine) {
  check(cosine >= -1.0 && cosine <= 1.0, "mie: a cosine must be from -1 to 1");
  ScatteringAmplitudes s;
  double pi = 1.0, below = 0.0;
  for (std::size_t k = 0; k < sphere.a.size(); ++k) {
    const double n = static_cast<double>(k) + 1.0, factor = (2.0 * n + 1.0) / (n * (n + 1.0)), tau = n * cosine * pi - (n + 1.0) * below;
    s.s1 += factor * (pi * sphere.a[k] + tau * sphere.b[k]);
    s.s2 += factor * (tau * sphere.a[k] + pi * sphere.b[k]);
    const double above = ((2.0 * n + 1.0) * cosine * pi - (n + 1.0) * below) / n;
    below = pi, pi = above;
  }
  return s;
}

double phaseFunction(const SphereScattering& sphere, double cosine) {
  if (sphere.scattering <= 0.0) return 1.0;
  const ScatteringAmplitudes s = amplitudes(sphere, cosine);
  return 2.0 * (std::norm(s.s1) + std::norm(s.s2)) / (sphere.sizeParameter * sphere.sizeParameter * sphere.scattering);
}

std::vector<double> legendreMoments(const SphereScattering& sphere, int count) {
  check(count >= 0, "mie: a number of moments must not be below 0");
  const Weighted one{&sphere, 1.0};
  return momentsOf({&one, 1}, count);
}

ModifiedGamma ModifiedGamma::of(double effectiveRadius_um, double effectiveVariance) {
  check(effectiveRadius_um > 0.0 && effectiveVariance > 0.0 && effectiveVariance < 0.5, "mie: an effective variance must be from 0 to 1/2");
  return {(1.0 - 3.0 * effectiveVariance) / effectiveVariance, 1.0 / (effectiveRadius_um * effectiveVariance), 1.0};
}

SizeDistribution::SizeDistribution(const std::vector<LogNormalMode>& modes) {
  double all = 0.0;
  for (const LogNormalMode& mode : modes) {
    check(std::isfinite(mode.medianRadius_um) && mode.medianRadius_um > 0.0 && mode.sigma > 0.0 && mode.sigma <= 5.0, "mie: no such log-normal mode");
    check(std::isfinite(mode.number) && mode.number >= 0.0, "mie: a mode cannot have such a number of particles");
    if (mode.number == 0.0) continue;
    const double middle = std::log(mode.medianRadius_um), low = middle - 7.0 * mode.sigma, high = middle + (7.0 + 6.0 * mode.sigma) * mode.sigma;
    low_ = all > 0.0 ? std::min(low_, low) : low, high_ = all > 0.0 ? std::max(high_, high) : high;
    width_ = all > 0.0 ? std::min(width_, mode.sigma) : mode.sigma;
    all += mode.number;
  }
  check(all > 0.0, "mie: a distribution needs particles");
  density_ = [modes, all](double r) {
    double sum = 0.0;
    for (const LogNormalMode& mode : modes) {
      const double u = std::log(r / mode.medianRadius_um) / mode.sigma;
      sum += mode.number / (all * std::sqrt(2.0 * kPi) * mode.sigma * r) * std::exp(-0.5 * u * u);
    }
    return sum;
  };
}

SizeDistribution::SizeDistribution(const ModifiedGamma& gamma) {
  const double power = gamma.power, rate = gamma.rate, exponent = gamma.exponent;
  check(std::isfinite(power) && power > -1.0 && std::isfinite(rate) && rate > 0.0 && std::isfinite(exponent) && exponent > 0.0,
        "mie: no such gamma distribution");
  const double order = (power + 1.0) / exponent;  // number of particles: Gamma(order) / (exponent rate^order)
  const double logOne = std::log(exponent) + order * std::log(rate) - std::lgamma(order);
  density_ = [=](double r) { return std::exp(logOne + power * std::log(r) - rate * std::pow(r, exponent)); };
  const double low = (power + 3.0) / exponent, high = (power + 7.0) / exponent;  // where r^3 and r^7 times density are largest: rate r^exponent
  low_ = std::log(low / rate) / exponent - 17.0 / (power + 3.0) - 6.0 / std::sqrt((power + 3.0) * exponent);
  width_ = 1.0 / std::sqrt((power + 3.0) * exponent);
  high_ = std::log((high + 40.0 + std::sqrt(80.0 * high)) / rate) / exponent;
}

SizeDistribution::SizeDistribution(const std::vector<SizeSample>& table) {
  check(table.size() >= 2, "mie: a table of sizes needs two radii");
  double most = 0.0;
  for (std::size_t i = 0; i < table.size(); ++i) {
    check(std::isfinite(table[i].radius_um) && table[i].radius_um > (i ? table[i - 1].radius_um : 0.0), "mie: radii of a table must rise from above 0");
    check(std::isfinite(table[i].density) && table[i].density >= 0.0, "mie: no such density of sizes");
    table_.push_back(std::log(table[i].radius_um));
    most = std::max(most, table[i].density);
  }
  check(most > 0.0, "mie: a distribution needs particles");
  low_ = table_.front(), high_ = table_.back();
  density_ = [table, knots = table_](double r) {
    const double u = std::log(r), slack = 1e-12;
    if (u < knots.front() - slack || u > knots.back() + slack) return 0.0;
    const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(knots.begin(), knots.end(), u) - knots.begin(), 1, std::ssize(knots) - 1);
    const auto i = static_cast<std::size_t>(above);
    const double f = std::clamp((u - knots[i - 1]) / (knots[i] - knots[i - 1]), 0.0, 1.0), p = table[i - 1].density, q = table[i].density;
    return p > 0.0 && q > 0.0 ? p * std::pow(q / p, f) : p + f * (q - p);
  };
}

std::vector<double> SizeDistribution::knots(double wavelength_um) const {
  if (!smooth()) return table_;
  constexpr int kScan = 2000;
  const double step = (high_ - low_) / kScan;
  int first = kScan, last = 0;
  for (const int order : {0, 1, 4}) {  // r^2, absorption of small spheres, scattering of small spheres
    std::vector<double> sums;
    for (int i = 0; i <= kScan; ++i) {
      const double r = std::exp(low_ + i * step), x = std::min(2.0 * kPi * r / wavelength_um, 1.0);
      sums.push_back((sums.empty() ? 0.0 : sums.back()) + density(r) * r * r * r * std::pow(x, order));
    }
    first = std::min(first, static_cast<int>(std::ranges::lower_bound(sums, kTail * sums.back()) - sums.begin()) - 1);
    last = std::max(last, static_cast<int>(std::ranges::lower_bound(sums, (1.0 - kTail) * sums.back()) - sums.begin()) + 1);
  }
  first = std::max(first, 0), last = std::min(last, kScan);
  const int count = std::max(kIntervals, static_cast<int>((last - first) * step / width_));
  std::vector<double> out;
  for (int i = 0; i <= count; ++i) out.push_back(low_ + step * (first + (last - first) * (i / static_cast<double>(count))));
  return out;
}

ParticleOptics opticsOf(const SizeDistribution& sizes, Complex m, double wavelength_um, int moments, double tolerance) {
  checkIndex(m);
  check(std::isfinite(wavelength_um) && wavelength_um > 0.0, "mie: a wavelength must be above 0");
  check(moments >= 0 && tolerance > 0.0, "mie: neither a number of moments nor a tolerance can be so");
  const std::vector<double> knots = sizes.knots(wavelength_um);
  struct Sample {
    SphereScattering sphere;
    double radius, number;  // of particles, as of one trapezoid per interval
    int level;
  };
  std::vector<Sample> samples;
  double terms = 0.0;
  const auto add = [&](double u, double length, int level) {
    const double r = std::exp(u), number = sizes.density(r) * r * length;
    if (number == 0.0) return;
    terms += termsOf(2.0 * kPi * r / wavelength_um);
    samples.push_back({sphereScattering(2.0 * kPi * r / wavelength_um, m), r, number, level});
    if (moments == 0) samples.back().sphere.a.clear(), samples.back().sphere.b.clear();
  };
  for (std::size_t i = 0; i < knots.size(); ++i)
    add(knots[i], 0.5 * ((i + 1 < knots.size() ? knots[i + 1] - knots[i] : 0.0) + (i ? knots[i] - knots[i - 1] : 0.0)), 0);
  ParticleOptics out;
  int level = 0;
  const auto weight = [&](const Sample& s) { return s.number * std::ldexp(sizes.smooth() ? 1.0 : (s.level == level ? 4.0 : 2.0) / 3.0, -level); };
  const auto part = [](double change, double of) { return of > 0.0 ? std::abs(change) / of : 0.0; };
  double ext = 0.0, sca = 0.0, turned = 0.0, lastChange = 1.0;
  for (bool done = false; !done;) {
    ++level;
    const int parts = 1 << (level - 1);
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
      for (int k = 0; k < parts; ++k) add(knots[i] + (knots[i + 1] - knots[i]) * (k + 0.5) / parts, knots[i + 1] - knots[i], level);
    double number = 0.0, second = 0.0, third = 0.0;
    const double wasExt = ext, wasSca = sca, wasTurned = turned;
    ext = sca = turned = 0.0;
    for (const Sample& s : samples) {
      const double w = weight(s), area = w * kPi * s.radius * s.radius;
      number += w, second += area, third += area * s.radius;
      ext += area * s.sphere.extinction, sca += area * s.sphere.scattering, turned += area * s.sphere.scattering * s.sphere.asymmetry;
    }
    const double now = std::max({part(ext - wasExt, ext), part(sca - wasSca, sca), part(turned - wasTurned, sca)});
    out.change = std::max(now, lastChange), lastChange = now;
    out.extinction_um2 = sizes.smooth() ? ext : ext / number;  // smooth ones are of one particle, tails and all
    out.effectiveRadius_um = second > 0.0 ? third / second : 0.0;
    done = (out.change < tolerance && samples.size() >= kFewestSpheres) || samples.size() > kMostSpheres || terms > kMostTerms;
  }
  out.spheres = static_cast<int>(samples.size());
  out.albedo = ext > 0.0 ? sca / ext : 0.0;
  out.asymmetry = sca > 0.0 ? turned / sca : 0.0;
  std::vector<Weighted> all;
  for (const Sample& s : samples) all.push_back({&s.sphere, weight(s)});
  out.moments = momentsOf(all, moments);
  return out;
}

}  // namespace pitviper
