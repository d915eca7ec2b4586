#include "sim/model/harmonic_response.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Degrees beyond the order by which a mirror is told, and bands by which its blur is: that which first is this much less, as narrow lobes have long tails.
constexpr int kTelling = 4, kBandWidth = 4;
constexpr std::array<int, 6> kBands = {9, 14, 30, 62, 126, 254};
constexpr double kLess = 0.6;
/// Variances of sharp lobes are below this one's square.
constexpr double kSharp_rad = 0.06;
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

/// l (l + 1) in the middle of a band.
double bandOf(int band) { return meanOf(kBands[static_cast<size_t>(band)], kBands[static_cast<size_t>(band)] + kBandWidth); }

/// ln I_0(x). Source: Abramowitz and Stegun 9.8.1, 9.8.2.
double logBessel0(double x) {
  x = std::abs(x);
  if (x < 3.75) {
    const double t = x * x / 14.0625;
    return std::log(1.0 + t * (3.5156229 + t * (3.0899424 + t * (1.2067492 + t * (0.2659732 + t * (0.0360768 + t * 0.0045813))))));
  }
  const double t = 3.75 / x;
  return x - 0.5 * std::log(x) +
         std::log(0.39894228 +
                  t * (0.01328592 +
                       t * (0.00225319 + t * (-0.00157565 + t * (0.00916281 + t * (-0.02057706 + t * (0.02635537 + t * (-0.01647633 + t * 0.00392377))))))));
}

/// z of I_1(z)/I_0(z), the slope of logBessel0, within 1 % up to 0.98. Source: Best and Fisher 1981.
double inverseBesselRatio(double r) {
  r = std::clamp(r, -0.98, 0.98);
  const double a = std::abs(r);
  const double z = a < 0.53   ? 2.0 * a + a * a * a + 5.0 * std::pow(a, 5) / 6.0
                   : a < 0.85 ? -0.4 + 1.39 * a + 0.43 / (1.0 - a)
                              : 1.0 / (a * a * a - 4.0 * a * a + 3.0 * a);
  return std::copysign(z, r);
}

/// Variance of a lobe of which two bands are as 1 to exp(-logRatio): by chords of what is nearly a line, between ends that always have it.
double varianceOf(double logRatio, double stretch, double first, double last) {
  double low = 0.0, high = blurOf_rad(kBlurs - 1) * blurOf_rad(kBlurs - 1);
  const auto over = [&](double v) {
    return 0.5 * v * (last - first) + logBessel0(0.5 * stretch * v * first) - logBessel0(0.5 * stretch * v * last) - logRatio;
  };
  double atLow = -logRatio, atHigh = over(high);
  if (!(atHigh > 0.0)) return high;
  if (!(atLow < 0.0)) return low;
  constexpr int kMost = 40;
  constexpr double kNear = 1e-10;  // of the whole range: blurs' numbers are then within 2e-6
  for (int k = 0, side = 0; k < kMost; ++k) {
    const double v = (low * atHigh - high * atLow) / (atHigh - atLow), here = over(v), moved = here < 0.0 ? v - low : high - v;
    if (here < 0.0) {
      low = v, atLow = here;
      if (side < 0) atHigh *= 0.5;  // the end that stays counts less (Illinois)
      side = -1;
    } else {
      high = v, atHigh = here;
      if (side > 0) atLow *= 0.5;
      side = 1;
    }
    if (moved < kNear * blurOf_rad(kBlurs - 1) * blurOf_rad(kBlurs - 1) || here == 0.0) return v;
  }
  return 0.5 * (low + high);
}

/// P_l and its first two slopes by the cosine.
struct Legendre {
  static constexpr size_t kMost = static_cast<size_t>(kBands.back() + kBandWidth) + 1;
  std::array<double, kMost> p, first, second;
  Legendre(double x, int order) {
    p[0] = 1.0, p[1] = x, first[0] = 0.0, first[1] = 1.0, second[0] = second[1] = 0.0;
    for (size_t l = 1; l < static_cast<size_t>(order); ++l) {
      const double d = static_cast<double>(l);
      p[l + 1] = ((2.0 * d + 1.0) * x * p[l] - d * p[l - 1]) / (d + 1.0);
      first[l + 1] = first[l - 1] + (2.0 * d + 1.0) * p[l];
      second[l + 1] = second[l - 1] + (2.0 * d + 1.0) * first[l];
    }
  }
};

/// What a lobe sends from a direction, times its share of the hemisphere.
struct Sent {
  glm::dvec3 light;
  double weight;
};

struct Plane {
  glm::dvec3 to, up;
  explicit Plane(double angle) : to(-std::sin(angle), 0.0, std::cos(angle)), up(std::cos(angle), 0.0, std::sin(angle)) {}
};

/// Where some of the kernel's degrees are at their most, from the mirrored direction towards the normal. `start`: about there.
double tiltOf(const std::vector<Sent>& sent, double angle, int first, int last, double start) {
  constexpr double kMost = 0.6, kStep = 0.05;
  for (int step = 0; step < 8; ++step) {
    const Plane plane(angle - start);
    double slope = 0.0, bend = 0.0;
    for (const Sent& s : sent) {
      const double x = glm::dot(s.light, plane.to), t = glm::dot(s.light, plane.up);
      const Legendre p(x, last);
      for (size_t l = static_cast<size_t>(first); l <= static_cast<size_t>(last); ++l) {
        const double w = s.weight * (2.0 * static_cast<double>(l) + 1.0);
        slope += w * p.first[l] * t, bend += w * (p.second[l] * t * t - p.first[l] * x);
      }
    }
    const double further = bend < 0.0 ? std::clamp(-slope / bend, -kStep, kStep) : std::copysign(kStep, slope);
    start = std::clamp(start + further, -kMost, kMost);
    if (std::abs(further) < 1e-6) break;
  }
  return start;
}

/// A band's moments about an aim: of J_0, and of J_2 cos(2 psi).
struct Moments {
  double even = 0.0, twist = 0.0;
};
Moments momentsOf(const std::vector<Sent>& sent, const Plane& plane, int first, int last) {
  Moments m;
  double all = 0.0;
  for (int l = first; l <= last; ++l) all += 2 * l + 1;
  for (const Sent& s : sent) {
    const double t = glm::dot(s.light, plane.up), b = s.light.y;
    const Legendre p(glm::dot(s.light, plane.to), last);
    for (int l = first; l <= last; ++l) {
      const double w = s.weight * (2 * l + 1) / all;
      m.even += w * p.p[static_cast<size_t>(l)];
      m.twist += w * p.second[static_cast<size_t>(l)] * (t * t - b * b) / std::sqrt((l - 1.0) * l * (l + 1.0) * (l + 2.0));
    }
  }
  return m;
}

/// `before`: of a view angle a little less.
HarmonicResponse::Aim aimOf(const std::vector<Sent>& sent, double angle, int order, const HarmonicResponse::Aim& before) {
  double albedo = 0.0;
  for (const Sent& s : sent) albedo += s.weight;
  HarmonicResponse::Aim aim{tiltOf(sent, angle, order + 1, order + kTelling, before.tilt_rad), 0.0, 0, 0.0};
  const Moments near = momentsOf(sent, Plane(angle - aim.tilt_rad), order + 1, order + kTelling);
  if (!(near.even > kNone * albedo)) return before;
  Moments previous = near, far;
  for (;; ++aim.band) {
    const int first = kBands[static_cast<size_t>(aim.band)];
    far = momentsOf(sent, Plane(angle - aim.tilt_rad), first, first + kBandWidth);
    if (!(far.even > kLess * near.even) || static_cast<size_t>(aim.band) + 1 == kBands.size()) break;
    previous = far;
    aim.tilt_rad = tiltOf(sent, angle, first, first + kBandWidth, aim.tilt_rad);
  }
  // How far it is stretched, by the last band that still has most of it.
  const double k1 = meanOf(order + 1, order + kTelling), k2 = bandOf(aim.band), before2 = aim.band > 0 ? bandOf(aim.band - 1) : k1;
  const double of = 2.0 * inverseBesselRatio(previous.twist / previous.even) / before2;
  constexpr double kMostStretch = 0.95;
  const double variance = far.even > 0.0 ? 2.0 * (std::log(near.even / far.even) + logBessel0(0.5 * of * k2) - logBessel0(0.5 * of * k1)) / (k2 - k1) : 0.0;
  aim.variance = std::max(variance, 0.0);
  if (variance > 0.0) aim.stretch = std::clamp(of / variance, -kMostStretch, kMostStretch);
  return aim;
}

}  // namespace

double blurOf_rad(int number) { return number > 0 ? kFirstBlur_rad * std::exp2(0.5 * (number - 1)) : 0.0; }

double blurNumber(double variance) {
  const double x = variance / (kFirstBlur_rad * kFirstBlur_rad);
  return std::min(x < 1.0 ? x : 1.0 + std::log2(x), kBlurs - 1.0);
}

AimedLobe aimedAt(const HarmonicResponse::Aim& aim, double viewAngle_rad, const glm::dvec3& normal, const glm::dvec3& across) {
  const double turned = viewAngle_rad - aim.tilt_rad, c = std::cos(turned), s = std::sin(turned);
  const double along = c * across.z + s * normal.z, aside = normal.x * across.y - normal.y * across.x;
  const double both = along * along + aside * aside;
  return {c * normal - s * across, both > 1e-12 ? std::log2(1.0 + aim.stretch * (along * along - aside * aside) / both) : 0.0};
}

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

HarmonicResponse::HarmonicResponse(const ReflectionComponent& component, int order, std::span<const double> usual) : order_(order) {
  const int views = isPlain(component) ? 1 : kViews;
  const auto grid = component.integrationAxes(false);  // uniform light is told apart, and the column is smooth
  struct Read {
    ColumnReading at;
    double weight;
  };
  std::vector<Sent> sent;
  std::vector<Read> read;
  for (int j = 0; j < views; ++j) {
    const double angle = views > 1 ? std::min(0.5 * kPi * j / (views - 1), kLastView) : 0.0;
    const glm::dvec3 view(std::sin(angle), 0.0, std::cos(angle));
    sent.clear(), read.clear();
    integrateHemisphere(grid, angle, [&](const LightSample& s) {
      const double own = s.weight * component.lobeAt(s.light, view);
      if (own == 0.0) return;
      read.push_back({readColumn(component, s.light, view), own});
      double value = 0.0;
      for (size_t e = 0; e < 4; ++e) value += read.back().at.weight[e] * usual[read.back().at.at[e]];
      sent.push_back({s.light, own * value});
    });
    aims_.push_back(views > 1 ? aimOf(sent, angle, order, j > 0 ? aims_.back() : Aim{}) : Aim{});
    const Plane plane(angle - aims_.back().tilt_rad);
    const int far = kBands[static_cast<size_t>(aims_.back().band)];
    std::map<std::size_t, Weights> even;  // coefficients of Y_lm at planeWeightAt(l, m), and both bands
    for (size_t k = 0; k < sent.size(); ++k) {
      const glm::dvec3& light = sent[k].light;
      Harmonics y;
      realHarmonics(light, order, y);
      const Legendre p(glm::dot(light, plane.to), far + kBandWidth);
      const auto meanIn = [&](int first, int last) {
        double sum = 0.0, all = 0.0;
        for (int l = first; l <= last; ++l) sum += (2 * l + 1) * p.p[static_cast<size_t>(l)], all += 2 * l + 1;
        return sum / all;
      };
      const double like = views > 1 ? meanIn(order + 1, order + kTelling) : 0.0, beyond = views > 1 ? meanIn(far, far + kBandWidth) : 0.0;
      for (std::size_t e = 0; e < 4; ++e) {
        if (read[k].at.weight[e] == 0.0) continue;
        Weights& into = even.try_emplace(read[k].at.at[e]).first->second;
        Response& to = into.of;
        const double w = read[k].weight * read[k].at.weight[e];
        into.albedo += w;
        for (int l = 1; l <= order; ++l)
          for (int m = 0; m <= l; ++m) to[static_cast<size_t>(planeWeightAt(l, m))] += w * y[static_cast<size_t>(l * l + l + m)];
        to.back() += w * like;
        to.front() += w * beyond;
      }
    }
    auto& at = weights_.emplace_back();
    for (const auto& [entry, sums] : even) {
      std::array<double, kPlaneWeights> half;
      std::copy_n(sums.of.begin(), kPlaneWeights, half.begin());
      half.front() = 0.0;
      const auto across = planeWeights(half);
      Response r{};
      std::copy(across.begin(), across.end(), r.begin());
      r.front() = sums.of.front();
      r.back() = sums.of.back();
      at.emplace_back(entry, Weights{r, sums.albedo});
    }
    Harmonics y;
    realHarmonics(plane.to, order, y);
    std::array<double, kPlaneWeights> about{};
    for (int l = 1; l <= order; ++l)
      for (int m = 0; m <= l; ++m) about[static_cast<size_t>(planeWeightAt(l, m))] = y[static_cast<size_t>(l * l + l + m)];
    zonal_.push_back(planeWeights(about));
  }
  isSharp_ = std::all_of(aims_.begin(), aims_.end(), [](const Aim& a) { return a.variance * (1.0 + std::abs(a.stretch)) < kSharp_rad * kSharp_rad; });
}

Response HarmonicResponse::at(int view, std::span<const double> columns, bool sharp) const {
  Response sum{};
  double albedo = 0.0;
  for (const auto& [entry, weights] : weights_[static_cast<std::size_t>(view)]) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += columns[entry] * weights.of[k];
    albedo += columns[entry] * weights.albedo;
  }
  const double near = sum.back(), far = sum.front();
  sum.front() = sum.back() = 0.0;
  if (!(near > kNone * albedo)) return sum;
  const Aim& aim = aims_[static_cast<std::size_t>(view)];
  const double first = meanOf(order_ + 1, order_ + kTelling), stretch = aim.stretch;
  const double variance = varianceOf(far > 0.0 ? std::log(near / far) : HUGE_VAL, stretch, first, bandOf(aim.band));
  sum.back() = near * std::exp(0.5 * first * variance - logBessel0(0.5 * stretch * variance * first));
  sum.front() = sum.back() * blurNumber(variance);
  if (sharp)
    for (int l = 1; l <= order_; ++l)
      for (int k = 0; k <= l; ++k) {
        const auto c = static_cast<size_t>(planeWeightAt(l, k));
        sum[c] -= sum.back() * std::exp(-0.5 * l * (l + 1.0) * variance) * zonal_[static_cast<std::size_t>(view)][c];
      }
  return sum;
}

}  // namespace pitviper
