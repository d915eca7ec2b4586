#include "materials/lobe_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

constexpr double kQuarter = 0.5 * kPi;
constexpr int kRings = 64, kTurns = 96;

/// A ring of half vectors (or of lights) about the normal: its direction and what a share of it weighs per unit of f cos(theta_l).
struct Ring {
  double sine, cosine, weight;
};

/// dw_l = 4 (v.h) dw_h; D cos(theta_h) dw_h = du dphi / (2 pi) with tan^2 = a^2 u / (1 - u), or -a^2 ln(1 - u) for normal slopes.
std::vector<Ring> ringsOf(Sampled sampled, double a) {
  std::vector<Ring> rings;
  for (const auto& u : gaussLegendre(kRings, 0.0, 1.0)) {
    if (sampled == Sampled::Cosine) {
      rings.push_back({std::sqrt(u.x), std::sqrt(1.0 - u.x), kPi * u.weight});
      continue;
    }
    const bool wide = sampled == Sampled::Trowbridge;
    const double tan2 = wide ? a * a * u.x / (1.0 - u.x) : -a * a * std::log1p(-u.x), c = 1.0 / std::sqrt(1.0 + tan2);
    const double d = wide ? a * a / (kPi * std::pow(c * c * (a * a + tan2), 2.0)) : std::exp(-tan2 / (a * a)) / (kPi * a * a * std::pow(c, 4.0));
    rings.push_back({std::sqrt(tan2) * c, c, u.weight * 4.0 / (d * c)});
  }
  return rings;
}

}  // namespace

double AngleShares::sum() const { return std::accumulate(share.begin(), share.end(), 0.0); }

double AngleShares::of(const std::vector<double>& values) const {
  return std::inner_product(share.begin(), share.end(), values.begin() + static_cast<std::ptrdiff_t>(first), 0.0);
}

std::vector<AngleShares> lobeShares(const std::function<double(const glm::dvec3&, const glm::dvec3&)>& f, Sampled sampled, double width, Angle kind,
                                    int entries) {
  const auto rings = ringsOf(sampled, width);
  std::vector<AngleShares> all;
  for (int v = 0; v < kShareViews; ++v) {
    const double angle = std::min(kQuarter * v / (kShareViews - 1), kQuarter - 1e-5);
    const glm::dvec3 view(std::sin(angle), 0.0, std::cos(angle));
    std::vector<double> row(static_cast<size_t>(entries), 0.0);
    for (const Ring& ring : rings)
      for (int k = 0; k < kTurns; ++k) {
        const double phi = kPi * (k + 0.5) / kTurns;  // both sides of the plane of view are alike
        const glm::dvec3 direction(ring.sine * std::cos(phi), ring.sine * std::sin(phi), ring.cosine);
        glm::dvec3 light = direction;
        double weight = ring.weight / kTurns, cosine = 0.0;  // of the difference angle
        if (sampled == Sampled::Cosine) {
          cosine = glm::dot(view, glm::normalize(light + view));
        } else {
          cosine = glm::dot(view, direction);
          if (cosine <= 0.0) continue;
          light = 2.0 * cosine * direction - view;
          weight *= cosine;
          if (light.z <= 0.0) continue;
          weight *= light.z;
        }
        const double entry = std::acos(std::clamp(kind == Angle::Incidence ? light.z : cosine, 0.0, 1.0)) / kQuarter * (entries - 1);
        const size_t j = std::min(static_cast<size_t>(entry), static_cast<size_t>(entries - 2));
        weight *= f(light, view);
        row[j] += weight * (1.0 - (entry - static_cast<double>(j)));
        row[j + 1] += weight * (entry - static_cast<double>(j));
      }
    const auto some = [](double x) { return x > 0.0; };
    const auto first = std::find_if(row.begin(), row.end(), some), last = std::find_if(row.rbegin(), row.rend(), some).base();
    all.push_back({static_cast<size_t>(first - row.begin()), first < last ? std::vector<double>(first, last) : std::vector<double>()});
  }
  return all;
}

double byAngle(const std::vector<double>& values, double angle) {
  const double x = std::clamp(angle / kQuarter, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const size_t j = std::min(static_cast<size_t>(x), values.size() - 2);
  return values[j] + (x - static_cast<double>(j)) * (values[j + 1] - values[j]);
}

}  // namespace pitviper
