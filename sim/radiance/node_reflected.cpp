// What surfaces turn of the surroundings' light at a plan's nodes.
#include <algorithm>
#include <cmath>

#include "sim/radiance/node_patterns.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Lobes narrower than cos^n of this, and tables about a mirrored direction or a half vector, are summed about where they are.
constexpr double kNarrow = 30.0;
/// Steps of their axes, at least.
constexpr int kSteps = 24;
/// Entries of a view angle's table of directional-hemispherical reflectances, as the shaders have them.
constexpr int kViews = 180;
glm::dvec3 acrossOf(const glm::dvec3& normal, const glm::dvec3& view) {
  const glm::dvec3 flat = view - glm::dot(view, normal) * normal;
  if (glm::length(flat) > 1e-9) return glm::normalize(flat);
  return glm::normalize(glm::cross(normal, std::abs(normal.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
}

bool isNarrow(const ReflectionComponent& r) {
  if (!r.lobe().file.empty() && r.lobe().exponent > kNarrow) return true;
  const auto axes = r.axes();
  return std::any_of(axes.begin(), axes.end(),
                     [](const AngleAxis& a) { return a.angle != Angle::None && a.angle != Angle::Incidence && a.angle != Angle::View; });
}

}  // namespace

const std::vector<std::vector<double>>& NodeSurroundings::columns(const ReflectionComponent& r) const {
  const std::lock_guard lock(busy_);
  auto& kept = columns_[&r];
  if (kept) return *kept;
  kept = std::make_unique<std::vector<std::vector<double>>>();
  for (const SpectralNode& n : nodes_) {
    std::vector<double> sum(columnEntries(r), 0.0);
    for (const auto& m : n.members) {
      const std::vector<double> own = columnsAt(r, m.wavelength_um);
      for (size_t e = 0; e < sum.size(); ++e) sum[e] += m.share * own[e];
    }
    kept->push_back(std::move(sum));
  }
  return *kept;
}

std::vector<double> NodeSurroundings::hemispherical(const ReflectionComponent& r, double angle) const {
  const auto entry = [&](int number) {
    {
      const std::lock_guard lock(busy_);
      if (const auto at = hemispherical_.find({&r, number}); at != hemispherical_.end()) return at->second;
    }
    std::vector<double> own;
    for (const SpectralNode& n : nodes_) own.push_back(n.mean([&](double w) { return r.hemispherical(w, 0.5 * kPi * number / kViews); }));
    const std::lock_guard lock(busy_);
    return hemispherical_.try_emplace({&r, number}, std::move(own)).first->second;
  };
  if (!r.hemisphericalVaries()) return entry(0);
  if (degree_ == Terms::kWhole) {
    std::vector<double> own;
    for (const SpectralNode& n : nodes_) own.push_back(n.mean([&](double w) { return r.hemispherical(w, angle); }));
    return own;
  }
  const double x = std::clamp(angle / (0.5 * kPi), 0.0, 1.0) * kViews;
  const int low = std::min(static_cast<int>(x), kViews - 1);
  std::vector<double> a = entry(low);
  const std::vector<double> b = entry(low + 1);
  for (size_t i = 0; i < a.size(); ++i) a[i] += (x - low) * (b[i] - a[i]);
  return a;
}

const NodeSurroundings::Responses& NodeSurroundings::responses(const ReflectionComponent& r) const {
  return responses(r, simulation_.surroundings->response(r, degree_, usual_um_).isSharp());
}

const NodeSurroundings::Responses& NodeSurroundings::responses(const Material& material, const Material& state, std::size_t component) const {
  const auto sharp = [&](const Material& m) { return simulation_.surroundings->response(*m.reflections[component], degree_, usual_um_).isSharp(); };
  const bool all = material.states ? std::all_of(material.states->entries.begin(), material.states->entries.end(), [&](const auto& e) { return sharp(*e); })
                                   : sharp(material);
  return responses(*state.reflections[component], all);
}

const NodeSurroundings::Responses& NodeSurroundings::responses(const ReflectionComponent& r, bool sharp) const {
  const auto& columns = this->columns(r);
  const HarmonicResponse& own = simulation_.surroundings->response(r, degree_, usual_um_);
  const std::lock_guard lock(busy_);
  auto& kept = responses_[{&r, sharp}];
  if (kept) return *kept;
  kept = std::make_unique<Responses>();
  kept->views = own.views();
  kept->isSharp = sharp;
  for (int j = 0; j < kept->views; ++j) kept->aims.push_back(own.aim(j));
  for (int j = 0; j < kept->views; ++j)
    for (size_t i = 0; i < nodes_.size(); ++i) kept->at.push_back(own.at(j, columns[i], sharp));
  return *kept;
}

std::vector<double> NodeSurroundings::reflected(const ReflectionComponent& r, const SurfaceView& view) const {
  if (degree_ == Terms::kWhole) return inFull(r, view);
  if (degree_ > 0) return byHarmonics(r, view);
  std::vector<double> all = hemispherical(r, std::acos(std::clamp(glm::dot(view.normal, view.toViewer), 0.0, 1.0)));
  for (size_t i = 0; i < all.size(); ++i) all[i] *= ofDome()[i];
  return all;
}

std::vector<double> NodeSurroundings::byHarmonics(const ReflectionComponent& r, const SurfaceView& view) const {
  const double cosine = std::clamp(glm::dot(view.normal, view.toViewer), 0.0, 1.0), angle = std::acos(cosine);
  const glm::dvec3 across = acrossOf(view.normal, view.toViewer);
  const Responses& own = responses(r);
  const std::vector<double> whole = hemispherical(r, angle);
  const Surroundings& around = *simulation_.surroundings;
  const auto place = around.placeAt(view.height_m);
  std::array<Harmonics, kPlaneTurns.size()> y;
  for (size_t k = 0; k < y.size(); ++k)
    realHarmonics(std::cos(kPi * kPlaneTurns[k]) * view.normal + std::sin(kPi * kPlaneTurns[k]) * across, kMostHarmonicOrder, y[k]);
  const double x = angle / (0.5 * kPi) * (own.views - 1);
  const auto low = static_cast<size_t>(std::min(x, std::max(own.views - 2.0, 0.0)));
  const double more = own.views > 1 ? x - static_cast<double>(low) : 0.0;
  const HarmonicResponse::Aim &a0 = own.aims[low], &a1 = own.aims[own.views > 1 ? low + 1 : low];
  const AimedLobe aimed =
      aimedAt({a0.tilt_rad + more * (a1.tilt_rad - a0.tilt_rad), a0.stretch + more * (a1.stretch - a0.stretch), 0}, angle, view.normal, across);
  std::vector<double> all(nodes_.size(), 0.0);
  for (size_t part = 0; part < 2; ++part) {
    const double share = part == 0 ? 1.0 - place.share : place.share;
    if (share == 0.0) continue;
    const Height& h = height(place.height + part);
    // The rest about a direction, of all nodes at once; of a lobe's blurs those that some node has.
    const auto restAt = [&](const DirectionGrid::Reading& reading, bool sharp, std::size_t blur) -> Eigen::VectorXd {
      const Eigen::MatrixXd& rest = h.of->rest(around, sharp ? 0 : degree_, blur);
      Eigen::VectorXd here = Eigen::VectorXd::Zero(rest.rows());
      for (size_t k = 0; k < 4; ++k) here += reading.weight[k] * rest.col(static_cast<Eigen::Index>(reading.at[k]));
      return h.mix * here;
    };
    const DirectionGrid::Reading reading = h.of->finer.at(aimed.direction);
    const Eigen::VectorXd matt = restAt(h.of->finer.at(view.normal), false, kCosine);
    std::array<Eigen::VectorXd, kBlurs> left;
    std::size_t four = nodes_.size(), sharper = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      const Harmonics& light = h.harmonics[i];
      const Response &a = own.at[low * nodes_.size() + i], &b = own.at[(own.views > 1 ? low + 1 : low) * nodes_.size() + i];
      const auto weight = [&](int k) { return a[static_cast<size_t>(k)] + more * (b[static_cast<size_t>(k)] - a[static_cast<size_t>(k)]); };
      double sum = whole[i] * light[0] / std::sqrt(4.0 * kPi);
      for (int l = 1; l <= degree_; ++l)
        for (int k = 0; k <= l; ++k) {
          double of = 0.0;
          for (int c = l * l; c < (l + 1) * (l + 1); ++c) of += light[static_cast<size_t>(c)] * y[static_cast<size_t>(k)][static_cast<size_t>(c)];
          sum += weight(planeWeightAt(l, k)) * of;
        }
      // Of what is no lobe, a matt surface's share of the rest.
      sum += (whole[i] - std::max(weight(kPlaneWeights), 0.0)) * matt[static_cast<Eigen::Index>(i)];
      if (const double d = weight(kPlaneWeights); d > 0.0) {
        // Four nodes have the two blurs about the first one's.
        const double blur = std::clamp(weight(0) / d + aimed.further, 0.0, kBlurs - 1.0);
        if (i / 4 != four) four = i / 4, sharper = std::min(static_cast<size_t>(blur), kBlurs - std::size_t{2});
        const double further = blur - static_cast<double>(sharper);
        for (size_t step = 0; step < 2; ++step) {
          Eigen::VectorXd& of = left[sharper + step];
          if (of.size() == 0) of = restAt(reading, own.isSharp, sharper + step);
          sum += d * (step == 0 ? 1.0 - further : further) * of[static_cast<Eigen::Index>(i)];
        }
      }
      all[i] += share * sum;
    }
  }
  return all;
}

std::vector<double> NodeSurroundings::inFull(const ReflectionComponent& r, const SurfaceView& view) const {
  const double cosine = std::clamp(glm::dot(view.normal, view.toViewer), 1e-6, 1.0), angle = std::acos(cosine);
  const glm::dvec3 across = acrossOf(view.normal, view.toViewer), aside = glm::cross(view.normal, across);
  const glm::dvec3 own(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
  const std::vector<std::vector<double>>& columns = this->columns(r);
  const std::vector<double> whole = hemispherical(r, angle);
  const auto place = simulation_.surroundings->placeAt(view.height_m);
  const bool narrow = isNarrow(r), plain = HarmonicResponse::isPlain(r);
  std::vector<double> all(nodes_.size(), 0.0);
  for (size_t part = 0; part < 2; ++part) {
    const double share = part == 0 ? 1.0 - place.share : place.share;
    if (share == 0.0) continue;
    const Height& h = height(place.height + part);
    // By entry of the column and, last, for light of 1: what uniform light is off by is put right, so that it is exact.
    Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(h.of->pattern.rows() + 1, static_cast<Eigen::Index>(columnEntries(r)));
    const auto add = [&](const glm::dvec3& light, double weight, const auto& here) {
      const ColumnReading reading = plain ? ColumnReading{{}, {1.0}} : readColumn(r, light, own);
      for (size_t e = 0; e < 4; ++e) {
        if (reading.weight[e] == 0.0) continue;
        auto to = sums.col(static_cast<Eigen::Index>(reading.at[e]));
        to.head(h.of->pattern.rows()) += weight * reading.weight[e] * here;
        to(h.of->pattern.rows()) += weight * reading.weight[e];
      }
    };
    if (narrow) {
      // Light jumps at the horizon: tables of few entries are looked at more closely.
      auto axes = r.integrationAxes(false);
      for (AngleAxis& a : axes)
        if (a.count > 1) a.count = 1 + (a.count - 1) * std::max(kSteps / (a.count - 1), 1);
      integrateHemisphere(axes, angle, [&](const LightSample& s) {
        const double weight = s.weight * r.lobeAt(s.light, own);
        if (weight == 0.0) return;
        Eigen::VectorXd here = Eigen::VectorXd::Zero(h.of->pattern.rows());
        for (const double side : {s.light.y, -s.light.y}) {
          const DirectionGrid::Reading at = h.of->grid.at(s.light.x * across + side * aside + s.light.z * view.normal);
          for (size_t k = 0; k < 4; ++k) here += 0.5 * at.weight[k] * h.of->pattern.col(static_cast<Eigen::Index>(at.at[k]));
        }
        add(s.light, weight, here);
      });
    } else {
      for (size_t s = 0; s < h.samples.size(); ++s) {
        const glm::dvec3& d = h.samples[s].direction;
        const glm::dvec3 light(glm::dot(d, across), glm::dot(d, aside), glm::dot(d, view.normal));
        if (light.z > 0.0) add(light, h.samples[s].solidAngle * light.z * (plain ? 1.0 : r.lobeAt(light, own)), h.atSamples.col(static_cast<Eigen::Index>(s)));
      }
    }
    for (size_t i = 0; i < all.size(); ++i) {
      const Eigen::Map<const Eigen::VectorXd> column(columns[i].data(), static_cast<Eigen::Index>(columns[i].size()));
      const Eigen::VectorXd of = sums * column;
      const double found = h.mix.row(static_cast<Eigen::Index>(i)).dot(of.head(h.of->pattern.rows()));
      all[i] += share * (found + (whole[i] - of(h.of->pattern.rows())) * h.harmonics[i][0] / std::sqrt(4.0 * kPi));
    }
  }
  return all;
}

}  // namespace pitviper
