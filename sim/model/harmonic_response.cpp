#include "sim/model/harmonic_response.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Degrees beyond the order by which a mirror is told, and those by which its blur is.
constexpr int kTelling = 4, kFirstBlurring = 14, kLastBlurring = 18;
/// Where the first band has less of the reflectance, there is no lobe that harmonics could not hold: one of 0.35 rad has so much.
constexpr double kNone = 0.05;
/// Grazing views, where some kernels have no end [rad].
constexpr double kLastView = 89.9 / 180.0 * kPi;

double mixOf(const AngleAxis& axis, double angle, std::size_t& low) {
  if (axis.count < 2) return low = 0, 0.0;
  const double x = std::clamp(angle / axis.last_rad, 0.0, 1.0) * (axis.count - 1);
  low = std::min(static_cast<std::size_t>(x), static_cast<std::size_t>(axis.count - 2));
  return x - static_cast<double>(low);
}

/// Mean of l (l + 1) over degrees, weighted with 2l + 1.
double meanOf(int from, int to) {
  double sum = 0.0, all = 0.0;
  for (int l = from; l <= to; ++l) sum += (2.0 * l + 1.0) * l * (l + 1.0), all += 2.0 * l + 1.0;
  return sum / all;
}

double blurNumber(double sigma_rad) {
  std::size_t k = 0;
  while (k + 2 < kBlurs_rad.size() && sigma_rad > kBlurs_rad[k + 1]) ++k;
  return static_cast<double>(k) + std::min((sigma_rad - kBlurs_rad[k]) / (kBlurs_rad[k + 1] - kBlurs_rad[k]), 1.0);
}

}  // namespace

std::size_t columnEntries(const ReflectionComponent& component) {
  const auto axes = component.axes();
  return static_cast<std::size_t>(axes[0].count) * static_cast<std::size_t>(axes[1].count);
}

ColumnReading readColumn(const ReflectionComponent& component, const glm::dvec3& light, const glm::dvec3& view) {
  const auto axes = component.axes();
  ColumnReading r;
  std::size_t i = 0, j = 0;
  const double u = axes[0].angle == Angle::None ? 0.0 : mixOf(axes[0], angleBetween(axes[0].angle, light, view), i);
  const double v = axes[1].angle == Angle::None ? 0.0 : mixOf(axes[1], angleBetween(axes[1].angle, light, view), j);
  const auto along = static_cast<std::size_t>(axes[0].count);
  const std::size_t right = i + (along > 1 ? 1 : 0), up = j + (axes[1].count > 1 ? 1 : 0);
  r.at = {i + along * j, right + along * j, i + along * up, right + along * up};
  r.weight = {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v, u * v};
  return r;
}

std::vector<double> columnsAt(const ReflectionComponent& component, double wavelength_um) {
  const auto axes = component.axes();
  std::vector<double> all;
  for (int j = 0; j < axes[1].count; ++j)
    for (int i = 0; i < axes[0].count; ++i) all.push_back(component.column(wavelength_um, axes[0].at(i), axes[1].at(j)));
  return all;
}

bool HarmonicResponse::isPlain(const ReflectionComponent& component) { return component.lobe().file.empty() && component.axes()[0].angle == Angle::None; }

HarmonicResponse::HarmonicResponse(const ReflectionComponent& component, int order) : order_(order) {
  const int views = isPlain(component) ? 1 : kViews;
  const auto grid = component.integrationAxes(false);  // uniform light is told apart, and the column is smooth
  double whole = 0.0, blurred = 0.0;
  for (int l = order + 1; l <= order + kTelling; ++l) whole += 2 * l + 1;
  for (int l = kFirstBlurring; l <= kLastBlurring; ++l) blurred += 2 * l + 1;
  for (int j = 0; j < views; ++j) {
    const double angle = views > 1 ? std::min(0.5 * kPi * j / (views - 1), kLastView) : 0.0;
    const glm::dvec3 view(std::sin(angle), 0.0, std::cos(angle)), mirrored(-view.x, 0.0, view.z);
    std::map<std::size_t, Weights> even;  // coefficients of Y_lm at planeWeightAt(l, m), and D
    integrateHemisphere(grid, angle, [&](const LightSample& s) {
      const double own = s.weight * component.lobeAt(s.light, view);
      if (own == 0.0) return;
      Harmonics y;
      realHarmonics(s.light, order, y);
      std::array<double, kLastBlurring + 1> p{};
      legendreTimes(glm::dot(s.light, mirrored), kLastBlurring, p);
      double like = 0.0, beyond = 0.0;
      for (int l = order + 1; l <= order + kTelling; ++l) like += p[static_cast<size_t>(l)];
      for (int l = kFirstBlurring; l <= kLastBlurring; ++l) beyond += p[static_cast<size_t>(l)];
      const ColumnReading r = readColumn(component, s.light, view);
      for (std::size_t e = 0; e < 4; ++e) {
        if (r.weight[e] == 0.0) continue;
        Weights& into = even.try_emplace(r.at[e]).first->second;
        Response& to = into.of;
        const double w = own * r.weight[e];
        into.albedo += w;
        for (int l = 1; l <= order; ++l)
          for (int m = 0; m <= l; ++m) to[static_cast<size_t>(planeWeightAt(l, m))] += w * y[static_cast<size_t>(l * l + l + m)];
        to.back() += w * like / whole;
        to.front() += w * beyond / blurred;
      }
    });
    auto& at = weights_.emplace_back();
    for (const auto& [entry, sums] : even) {
      std::array<double, kPlaneWeights> half;
      std::copy_n(sums.of.begin(), kPlaneWeights, half.begin());
      half.front() = 0.0;
      const auto turned = planeWeights(half);
      Response r{};
      std::copy(turned.begin(), turned.end(), r.begin());
      r.front() = views > 1 ? sums.of.front() : 0.0;
      r.back() = views > 1 ? sums.of.back() : 0.0;
      at.emplace_back(entry, Weights{r, sums.albedo});
    }
  }
}

Response HarmonicResponse::at(int view, std::span<const double> columns) const {
  Response sum{};
  double albedo = 0.0;
  for (const auto& [entry, weights] : weights_[static_cast<std::size_t>(view)]) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += columns[entry] * weights.of[k];
    albedo += columns[entry] * weights.albedo;
  }
  const double near = sum.back(), far = sum.front();
  sum.front() = sum.back() = 0.0;
  if (!(near > kNone * albedo)) return sum;
  // l (l + 1) in the middle of each band, by its terms' weights.
  const double first = meanOf(order_ + 1, order_ + kTelling), last = meanOf(kFirstBlurring, kLastBlurring);
  const double most = kBlurs_rad.back(), sigma2 = far > 0.0 ? std::clamp(2.0 * std::log(near / far) / (last - first), 0.0, most * most) : most * most;
  sum.back() = near * std::exp(0.5 * first * sigma2);
  sum.front() = sum.back() * blurNumber(std::sqrt(sigma2));
  return sum;
}

}  // namespace pitviper
