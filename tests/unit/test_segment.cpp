// The law of a segment of path against long double with the C library's own functions, and against sums over the path.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

using physics::lostOf;

/// Depths from next to none to opaque, some beside the ends of series.
std::vector<double> depths() {
  std::vector<double> all{0.1249999, 0.125, 0.1250001};
  for (double d = 1e-15; d < 400.0; d *= 1.37) all.push_back(d);
  return all;
}

double off(double got, long double want) { return std::abs(static_cast<double>(got / want - 1.0L)); }

TEST(Segment, WeightsKeepTheirDigits) {
  double lost = 0.0, mean = 0.0, growth = 0.0;
  for (const double d : depths()) {
    const long double x = d, wanted = -std::expm1(-x);
    const double left = std::exp(-d);
    lost = std::max(lost, off(lostOf(d, left), wanted));
    mean = std::max({mean, off(physics::meanDecay(d), wanted / x), off(physics::meanDecayOf(d, left), wanted / x)});
    // g = (1 - exp(-d) (1 + d)) / d; where long double would lose its digits too, by 24 terms of n (-d)^(n-1) d / (n + 1)!.
    long double g = 0.0L, term = 1.0L;
    for (int n = 1; n <= 24; ++n) term *= (n == 1 ? 1.0L : -x) / (n + 1.0L), g += n * term * x;
    if (d > 0.5) g = (wanted - x * std::exp(-x)) / x;
    growth = std::max(growth, off(physics::growthOf(d, left, lostOf(d, left)), g));
  }
  bound("1 - exp(-d), exp(-d) known, relative", lost, 2e-13, "series to x^8 below 0.125: 0.125^8 / 9!");
  bound("(1 - exp(-d)) / d, relative", mean, 2e-13, "the same");
  bound("(1 - exp(-d) (1 + d)) / d, relative", growth, 4e-14, "rounding at 0.125: 2.2e-16 x 2 / 0.125^2");
}

// Gauss's rule over parts of the path, of what the law says.
TEST(Segment, IsWhatItsPathAddsUpTo) {
  double even = 0.0, drifting = 0.0, parts = 0.0, sun = 0.0;
  for (const double d : {1e-9, 1e-4, 0.03, 0.12, 0.13, 0.25, 0.3, 1.0, 4.0, 12.0, 30.0})
    for (const double near : {0.0, 1.0, 3.0})
      for (const double far : {0.0, 1.0, 2.5}) {
        const double left = std::exp(-d), lost = lostOf(d, left), got = physics::segmentRadiance(near, far, d, left, lost);
        double sum = 0.0, passed = 0.0;
        const double from = 0.7 + near, to = 0.2 + far;
        for (int part = 0; part < 8; ++part)
          for (const QuadratureNode& n : gaussLegendre(24, part / 8.0, (part + 1) / 8.0)) {
            sum += n.weight * d * (near + (far - near) * n.x) * std::exp(-d * n.x);
            passed += n.weight * std::exp(-d * (from + (to - from) * n.x));
          }
        const double size = (near + far) * lost;
        if (size > 0.0) {
          even = std::max(even, std::abs(got - sum) / size);
          drifting = std::max(drifting, std::abs(physics::driftingRadiance(0.5 * (near + far), far - near, d, left, lost) - sum) / size);
          // Seen through its near half, the far half adds what the whole has beyond that.
          const double half = std::exp(-0.5 * d), own = lostOf(0.5 * d, half), middle = 0.5 * (near + far);
          parts = std::max(parts, std::abs(physics::segmentRadiance(near, middle, 0.5 * d, half, own) +
                                           half * physics::segmentRadiance(middle, far, 0.5 * d, half, own) - got) /
                                      size);
        }
        sun = std::max({sun, off(physics::meanPassed(d * from, d * to, std::exp(-d * from), std::exp(-d * to)), passed),
                        off(physics::meanPassedBetween(d * from, d * to), passed)});
      }
  bound("segment with sources linear in depth, of what it sends", even, 2e-13, "series of 1 - exp(-d) below 0.125: 0.125^8 / 9!");
  bound("the same by its middle and its drift", drifting, 2e-13, "the same");
  bound("two halves against the whole", parts, 4e-13, "the two of them");
  bound("mean of exp(-D) between two depths", sun, 1e-12, "rounding of differences: 2.2e-16 / 0.125 times depths to 100");
}

// Into all directions a phase function sends 1, of mean cosine g.
TEST(Segment, PhaseFunctionsOfParticlesAreThoseOfTheirAsymmetry) {
  double whole = 0.0, mean = 0.0;
  for (const double g : {-0.99, -0.7, -0.2, 0.0, 0.1, 0.45, 0.8, 0.95, 0.99}) {
    double sum = 0.0, cosine = 0.0;
    for (int part = 0; part < 24; ++part)  // ever shorter towards the peak
      for (const QuadratureNode& n : gaussLegendre(32, std::exp2(-part), part < 23 ? std::exp2(-part - 1) : 0.0)) {
        const double x = std::copysign(1.0, g) * (1.0 - 2.0 * n.x), each = -4.0 * 3.14159265358979323846 * n.weight * physics::henyeyGreensteinPhase(x, g);
        sum += each, cosine += each * x;
      }
    whole = std::max(whole, std::abs(sum - 1.0)), mean = std::max(mean, std::abs(cosine - g));
  }
  bound("Henyey and Greenstein over the sphere, less 1", whole, 1e-11, "24 x 32 nodes of Gauss; rounding of 1 + g^2 - 2 g cos at its peak, 1e-4");
  bound("its mean cosine, less the asymmetry", mean, 1e-11, "the same");
}

}  // namespace
}  // namespace pitviper::test
