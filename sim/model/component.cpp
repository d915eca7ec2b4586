#include "sim/model/component.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

constexpr size_t kLargestRule = 24;

/// Gauss-Legendre on [0, 1].
const std::vector<QuadratureNode>& unitRule(size_t n) {
  static const auto rules = [] {
    std::array<std::vector<QuadratureNode>, kLargestRule + 1> all;
    for (size_t k = 1; k <= kLargestRule; ++k) all[k] = gaussLegendre(static_cast<int>(k), 0.0, 1.0);
    return all;
  }();
  return rules[std::min(n, kLargestRule)];
}

/// The hemisphere in rings about a pole: normal (incidence), mirrored view (specular), view (difference), or, for half vectors, rings of
/// half vectors about the normal. `turn` is the angle between light and pole; of half vectors (and differences, which are half the angle
/// to the view) it is twice their own. In all four
///   cos(theta_l) = cos(turn) cos(tilt) + sin(turn) sin(tilt) cos(phi),   tilt: angle between pole and normal (half vectors: the view
/// angle), so that the horizon is a circle in closed form. The same law gives where a ring crosses an entry of the other axis; written
/// with haversines it keeps its digits for lobes of any width:
///   sin^2(k/2) = sin^2((turn - tilt)/2) + sin(turn) sin(tilt) sin^2(phi/2).
/// dw_l = sin(turn) dturn dphi; of half vectors 4 (v.h) dw_h. Source: Walter et al. 2007 (Jacobian of the half vector).
class Rings {
 public:
  Rings(const std::array<AngleAxis, 2>& axes, double viewAngle, const std::function<void(const LightSample&)>& visit, int azimuths)
      : view_(std::sin(viewAngle), 0.0, std::cos(viewAngle)), viewAngle_(viewAngle), visit_(visit), azimuths_(azimuths) {
    first_ = rank(axes[1].angle) > rank(axes[0].angle) ? 1 : 0;
    polar_ = axes[first_];
    if (rank(polar_.angle) == 0) polar_ = {Angle::Incidence, 1, 0.0};
    other_ = axes[1 - first_];
    crossed_ = rank(other_.angle) > 0;
    for (size_t k = 0; k < 2; ++k) viewAxis_[k] = axes[k].angle == Angle::View;
    half_ = polar_.angle == Angle::Half || polar_.angle == Angle::HalfRoot;
    twice_ = half_ || polar_.angle == Angle::Difference ? 2.0 : 1.0;
    tilt_ = polar_.angle == Angle::Incidence ? 0.0 : viewAngle;
    const double s = view_.x, c = view_.z;
    if (other_.angle == Angle::Difference && !half_) otherScale_ = 2.0;
    if (half_ && other_.angle == Angle::Difference) turnScale_ = 0.5;
    otherTilt_ = polar_.angle == Angle::Specular && other_.angle == Angle::Difference ? 2.0 * viewAngle : viewAngle;
    if (crossed_)
      for (int j = 0; j < other_.count; ++j) sineOfHalfEntry_.push_back(std::sin(0.5 * otherScale_ * std::min(other_.at(j), kPi / otherScale_)));
    if (polar_.angle == Angle::Specular) pole_ = {-s, 0, c}, side_ = {c, 0, s};
    if (polar_.angle == Angle::Difference) pole_ = {s, 0, c}, side_ = {-c, 0, s};
  }

  void run() {
    const double end = 0.5 * kPi + tilt_;
    addEdge(0.5 * kPi - tilt_, true);  // from here on the horizon cuts the rings
    for (int j = 0; j < polar_.count; ++j) addEdge(twice_ * (polar_.angle == Angle::HalfRoot ? halfOfRoot(polar_.at(j)) : polar_.at(j)), false);
    if (crossed_)
      for (int j = 0; j < other_.count; ++j) addTangents(other_.at(j));
    std::erase_if(edges_, [&](const Edge& e) { return !(e.turn > 0.0 && e.turn < end); });
    edges_.push_back({0.0, false});
    edges_.push_back({end, true});
    std::sort(edges_.begin(), edges_.end(), [](const Edge& a, const Edge& b) { return a.turn < b.turn; });
    for (size_t i = 0; i + 1 < edges_.size(); ++i) {
      const double a = edges_[i].turn, width = edges_[i + 1].turn - a;
      if (width <= 0.0) continue;
      const auto points = std::min<size_t>(2 + static_cast<size_t>(10.0 * width), 16);
      // A ring's share begins and ends like a root at the horizon: u^2 (3 - 2 u) makes that smooth. Narrow intervals don't need it.
      const bool bent = width > 0.02 && (edges_[i].root || edges_[i + 1].root);
      for (const auto& u : unitRule(bent ? points + 6 : points)) {
        const double x = bent ? u.x * u.x * (3.0 - 2.0 * u.x) : u.x, slope = bent ? 6.0 * u.x * (1.0 - u.x) : 1.0;
        ring(a + width * x, u.weight * slope * width);
      }
    }
  }

 private:
  struct Edge {
    double turn;
    bool root;
  };

  /// The axis with the higher rank is the polar one; a view axis needs no direction of its own.
  static int rank(Angle a) {
    switch (a) {
      case Angle::None:
      case Angle::View:
        return 0;
      case Angle::Incidence:
        return 1;
      case Angle::Difference:
        return 2;
      case Angle::Specular:
        return 3;
      case Angle::Half:
      case Angle::HalfRoot:
        return 4;
    }
    return 0;
  }

  /// Rings of half vectors cut by the specular angle follow a law of their own.
  bool ofHalf() const { return other_.angle == Angle::Specular; }
  void addEdge(double turn, bool root) { edges_.push_back({turn, root}); }

  /// Turns at which a ring touches an entry of the other axis.
  void addTangents(double entry) {
    if (ofHalf()) {
      addEdge(entry, true);
      const double s = std::sin(0.5 * entry) / std::max(view_.z, 1e-9);
      if (s < 1.0) addEdge(2.0 * std::asin(s), true);
      return;
    }
    addEdge((otherTilt_ + otherScale_ * entry) / turnScale_, true);
    addEdge(std::abs(otherTilt_ - otherScale_ * entry) / turnScale_, true);
  }

  /// The law for the other axis on one ring; of half vectors with the specular angle
  ///   sin^2(alpha/2) = sin^2(theta_h) (cos^2(theta_v) + sin^2(theta_v) cos^2(phi)).
  struct Law {
    double constant, factor;
  };
  Law lawAt(double turn) const {
    if (ofHalf()) {
      const double h = std::sin(0.5 * turn);
      return {view_.z * h, view_.x * h * view_.x * h};
    }
    const double t = turnScale_ * turn;
    return {std::sin(0.5 * (t - otherTilt_)), std::sin(t) * std::sin(otherTilt_)};
  }
  double otherAngle(const Law& law, double sine2OfHalfPhi) const {
    const double c = 1.0 - 2.0 * sine2OfHalfPhi, x = law.constant * law.constant + law.factor * (ofHalf() ? c * c : sine2OfHalfPhi);
    return 2.0 * std::asin(std::sqrt(std::clamp(x, 0.0, 1.0))) / otherScale_;
  }

  void addCrossings(const Law& law, double last) {
    if (law.factor <= 0.0) return;
    auto add = [&](double sine2) {
      const double phi = 2.0 * std::asin(std::sqrt(sine2));
      if (phi < last) cuts_.push_back(phi);
    };
    for (double k : sineOfHalfEntry_) {
      const double x = (k - law.constant) * (k + law.constant) / law.factor;
      if (!(x > 0.0 && x < 1.0)) continue;
      if (!ofHalf()) {
        add(x);
        continue;
      }
      add(0.5 * (1.0 - std::sqrt(x)));  // once on either side
      add(0.5 * (1.0 + std::sqrt(x)));
    }
  }

  void ring(double turn, double weight) {
    double last = kPi;
    if (turn > 0.5 * kPi - tilt_) {
      const double d = std::sin(0.5 * (turn - tilt_)), below = std::sin(turn) * std::sin(tilt_), sine2 = below > 0.0 ? (0.5 - d * d) / below : 0.0;
      last = sine2 <= 0.0 ? 0.0 : sine2 >= 1.0 ? kPi : 2.0 * std::asin(std::sqrt(sine2));
    }
    cuts_.assign(1, 0.0);
    const Law law = crossed_ ? lawAt(turn) : Law{0.0, 0.0};
    if (crossed_) addCrossings(law, last);
    for (int k = 1; k < azimuths_; ++k)
      if (const double phi = kPi * k / azimuths_; phi < last) cuts_.push_back(phi);
    cuts_.push_back(last);
    std::sort(cuts_.begin(), cuts_.end());
    const double own = turn / twice_, sine = std::sin(own), cosine = std::cos(own), sineOfTurn = std::sin(turn), cosineOfTurn = std::cos(turn);
    LightSample sample;
    sample.angle = {viewAxis_[0] ? viewAngle_ : 0.0, viewAxis_[1] ? viewAngle_ : 0.0};
    if (!viewAxis_[first_]) sample.angle[first_] = polar_.angle == Angle::HalfRoot ? rootOfHalf(own) : own;
    for (size_t i = 0; i + 1 < cuts_.size(); ++i) {
      const double width = cuts_[i + 1] - cuts_[i];
      if (width <= 0.0) continue;
      // Without another axis the azimuth is a polynomial of second degree in cos(phi); with one, narrow pieces are all but linear.
      const size_t points = !crossed_ ? 10 : width < 0.05 ? 1 : 2 + static_cast<size_t>(width / 0.3);
      for (const auto& u : unitRule(points)) {
        const double half = std::sin(0.5 * (cuts_[i] + width * u.x)), cosPhi = 1.0 - 2.0 * half * half, sinPhi = 2.0 * half * std::sqrt(1.0 - half * half);
        double jacobian = sineOfTurn;
        if (half_) {
          const glm::dvec3 h(sine * cosPhi, sine * sinPhi, cosine);
          const double vh = glm::dot(view_, h);
          sample.light = 2.0 * vh * h - view_;
          jacobian = 4.0 * vh * sine / twice_;
        } else {
          sample.light = cosineOfTurn * pole_ + sineOfTurn * (cosPhi * side_ + glm::dvec3(0.0, sinPhi, 0.0));
        }
        if (sample.light.z <= 0.0) continue;
        if (crossed_) sample.angle[1 - first_] = otherAngle(law, half * half);
        sample.weight = 2.0 * weight * u.weight * width * jacobian * sample.light.z;
        visit_(sample);
      }
    }
  }

  glm::dvec3 view_, pole_{0.0, 0.0, 1.0}, side_{1.0, 0.0, 0.0};
  double viewAngle_;
  const std::function<void(const LightSample&)>& visit_;
  int azimuths_;
  size_t first_ = 0;
  AngleAxis polar_, other_;
  bool crossed_ = false, half_ = false;
  std::array<bool, 2> viewAxis_{};
  double twice_ = 1.0, tilt_ = 0.0;
  /// The law for the other axis: k = otherScale x entry, of turnScale x turn, from a direction at otherTilt from the pole.
  double otherScale_ = 1.0, turnScale_ = 1.0, otherTilt_ = 0.0;
  std::vector<double> sineOfHalfEntry_;
  std::vector<Edge> edges_;
  std::vector<double> cuts_;
};

}  // namespace

double halfOfRoot(double root_rad) { return root_rad * root_rad / (0.5 * kPi); }

double rootOfHalf(double half_rad) { return std::sqrt(half_rad * 0.5 * kPi); }

double angleBetween(Angle kind, const glm::dvec3& l, const glm::dvec3& v) {
  auto between = [](const glm::dvec3& a, const glm::dvec3& b) { return 2.0 * std::asin(std::min(1.0, 0.5 * glm::length(a - b))); };
  const glm::dvec3 n(0, 0, 1);
  switch (kind) {
    case Angle::None:
      return 0.0;
    case Angle::Incidence:
      return between(n, l);
    case Angle::View:
      return between(n, v);
    case Angle::Specular:
      return between(glm::dvec3(-l.x, -l.y, l.z), v);
    case Angle::Half:
      return between(n, glm::normalize(l + v));
    case Angle::HalfRoot:
      return rootOfHalf(between(n, glm::normalize(l + v)));
    case Angle::Difference:
      return between(l, glm::normalize(l + v));
  }
  return 0.0;
}

void integrateHemisphere(const std::array<AngleAxis, 2>& axes, double viewAngle_rad, const std::function<void(const LightSample&)>& visit, int azimuths) {
  Rings(axes, std::clamp(viewAngle_rad, 0.0, 0.5 * kPi), visit, azimuths).run();
}

double ReflectionComponent::lobeAt(const glm::dvec3&, const glm::dvec3&) const { return 1.0; }

double ReflectionComponent::brdf(double wavelength_um, const glm::dvec3& l, const glm::dvec3& v) const {
  const auto a = axes();
  return column(wavelength_um, angleBetween(a[0].angle, l, v), angleBetween(a[1].angle, l, v)) * lobeAt(l, v);
}

std::array<AngleAxis, 2> ReflectionComponent::integrationAxes(bool bends) const {
  // A lobe counts as an axis about the mirrored direction, in steps of its width; cos^n is below 1e-17 at 9 / sqrt(n).
  if (const Lobe& own = lobe(); !own.file.empty())
    return {AngleAxis{Angle::Specular, 49, std::min(0.5 * kPi, 9.0 / std::sqrt(own.exponent + 1.0))}, bends ? axes()[0] : AngleAxis{}};
  return axes();
}

double ReflectionComponent::hemispherical(double wavelength_um, double viewAngle_rad) const {
  const auto grid = integrationAxes();
  const glm::dvec3 view(std::sin(viewAngle_rad), 0.0, std::cos(viewAngle_rad));
  double sum = 0.0;
  integrateHemisphere(grid, viewAngle_rad, [&](const LightSample& s) { sum += s.weight * brdf(wavelength_um, s.light, view); });
  return sum;
}

}  // namespace pitviper
