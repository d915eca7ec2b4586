#include "sim/radiance/node_surroundings.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <set>
#include <thread>

#include "sim/parameters/fingerprint.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

/// Part of each node's norm that its patterns may leave out.
constexpr double kLeftOut = 1e-5;
/// Points a side of each cell of a grid where light is summed over the whole sphere.
constexpr int kPoints = 3;
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

/// Wavelengths that stand for all that a scene is looked at by: of each band the middles of its thirds.
std::vector<double> lookedAt_um(const Simulation& sim) {
  constexpr int kEach = 3;
  std::set<double> all;
  const auto add = [&](const std::vector<ChannelOutput>& outputs) {
    for (const ChannelOutput& o : outputs)
      for (int k = 0; k < kEach; ++k) all.insert(o.bandLow_um + (o.bandHigh_um - o.bandLow_um) * (k + 0.5) / kEach);
  };
  for (const auto& c : sim.cameras) add(c.outputs);
  for (const auto& p : sim.probes) add(p.outputs);
  return {all.begin(), all.end()};
}

bool isNarrow(const ReflectionComponent& r) {
  if (!r.lobe().file.empty() && r.lobe().exponent > kNarrow) return true;
  const auto axes = r.axes();
  return std::any_of(axes.begin(), axes.end(),
                     [](const AngleAxis& a) { return a.angle != Angle::None && a.angle != Angle::Incidence && a.angle != Angle::View; });
}

}  // namespace

/// Directional patterns of one of the surroundings' heights, which the light of all nodes is a sum of. Shared with nodes that are made of these.
struct NodeSurroundings::Patterns {
  Eigen::MatrixXd pattern;  ///< [pattern, entry of the grid]
  std::size_t number = 0;
  DirectionGrid grid, finer;
  /// [pattern, entry of the finer grid]: what harmonics up to a degree leave, by blur; made when asked for.
  const Eigen::MatrixXd& rest(const Surroundings& around, int degree, std::size_t wanted) const {
    Rest* found = nullptr;
    {
      const std::lock_guard lock(busy);
      auto& kept = rests[{degree, wanted}];
      if (!kept) kept = std::make_unique<Rest>();
      found = kept.get();
    }
    std::call_once(found->isTold, [&] { found->of = tellRest(around, degree, wanted); });
    return found->of;
  }
  Eigen::MatrixXd tellRest(const Surroundings& around, int degree, std::size_t wanted) const;

 private:
  struct Rest {
    std::once_flag isTold;
    Eigen::MatrixXd of;
  };
  mutable std::mutex busy;
  mutable std::map<std::pair<int, std::size_t>, std::unique_ptr<Rest>> rests;
};

/// Of one of the surroundings' heights. Node by node as sums of a few directional patterns.
struct NodeSurroundings::Height {
  std::shared_ptr<const Patterns> of;
  Eigen::MatrixXd mix;               ///< [node, pattern]
  std::vector<Harmonics> harmonics;  ///< by node
  std::vector<DirectionGrid::Sample> samples;  ///< where it is in full
  Eigen::MatrixXd atSamples;                   ///< [pattern, sample]
};

NodeSurroundings::~NodeSurroundings() = default;

NodeSurroundings::NodeSurroundings(const Simulation& simulation, std::span<const SpectralNode> nodes, int degree, const NodeSurroundings* parts)
    : simulation_(simulation), nodes_(nodes), degree_(degree), parts_(parts), usual_um_(lookedAt_um(simulation)) {}

Eigen::MatrixXd NodeSurroundings::Patterns::tellRest(const Surroundings& around, int degree, std::size_t wanted) const {
  const auto entries = pattern.cols(), patterns = pattern.rows(), used = static_cast<Eigen::Index>(harmonicCount(degree));
  const Eigen::Index round = grid.azimuths, rings = grid.above + grid.below, told = finer.above + finer.below, phases = finer.azimuths / round;
  const Surroundings::Blur& blur = around.blur(number, wanted == kCosine ? Surroundings::kByCosine : blurOf_rad(static_cast<int>(wanted)));
  const std::vector<Harmonics>& each = around.projection(number);
  Eigen::MatrixXd lost = Eigen::MatrixXd::Zero(patterns, used);
  for (Eigen::Index g = 0; g < entries; ++g)
    for (Eigen::Index c = 0; c < used; ++c) lost.col(c) += each[static_cast<size_t>(g)][static_cast<size_t>(c)] * pattern.col(g);
  for (Eigen::Index c = 0; c < used; ++c) lost.col(c) *= blur.ofDegree[static_cast<size_t>(std::sqrt(static_cast<double>(c)))];
  Eigen::MatrixXd left(patterns, static_cast<Eigen::Index>(finer.size()));
  for (Eigen::Index g = 0; g < left.cols(); ++g) {
    Harmonics y;
    realHarmonics(finer.direction(static_cast<size_t>(g)), kMostHarmonicOrder, y);
    left.col(g) = -lost * Eigen::Map<const Eigen::VectorXd>(y.data(), used);
  }
  // Patterns' azimuths by rings; for each turn between what is read and what is told.
  Eigen::MatrixXd from(patterns * round, rings);
  for (Eigen::Index p = 0; p < patterns; ++p)
    for (Eigen::Index g = 0; g < entries; ++g) from(p * round + g % round, g / round) = pattern(p, g);
  using Strides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  for (Eigen::Index phase = 0; phase < phases; ++phase) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(patterns * round, told);
    for (Eigen::Index turn = 0; turn < round; ++turn) {
      const Eigen::MatrixXd shares = Eigen::Map<const Eigen::MatrixXd, 0, Strides>(blur.shares.data() + phase * entries + turn, rings, told,
                                                                                   Strides(phases * entries, round));  // [ring read, ring told]
      if (shares.isZero(0.0)) continue;
      const Eigen::MatrixXd all = from * shares;
      for (Eigen::Index p = 0; p < patterns; ++p) {
        sum.middleRows(p * round, round - turn) += all.middleRows(p * round + turn, round - turn);
        sum.middleRows(p * round + round - turn, turn) += all.middleRows(p * round, turn);
      }
    }
    for (Eigen::Index p = 0; p < patterns; ++p)
      for (Eigen::Index r = 0; r < told; ++r)
        for (Eigen::Index a = 0; a < round; ++a) left(p, (r * round + a) * phases + phase) += sum(p * round + a, r);
  }
  return left;
}

NodeSurroundings::Blurs NodeSurroundings::blursInUse(bool sharp) const {
  double least = kBlurs, most = -1.0;
  const auto look = [&](const Material& m, const Material& state) {
    for (size_t k = 0; k < state.reflections.size(); ++k) {
      const Responses& own = responses(m, state, k);
      if (own.isSharp != sharp) continue;
      for (size_t j = 0; j < own.aims.size(); ++j)
        for (size_t i = 0; i < nodes_.size(); ++i) {
          const Response& at = own.at[j * nodes_.size() + i];
          if (!(at.back() > 0.0)) continue;
          const double number = at.front() / at.back(), stretch = std::abs(own.aims[j].stretch);
          least = std::min(least, number + std::log2(1.0 - stretch)), most = std::max(most, number + std::log2(1.0 + stretch));
        }
    }
  };
  for (const auto& m : simulation_.materials) {
    if (!m->states) look(*m, *m);
    else
      for (const auto& entry : m->states->entries) look(*m, *entry);
  }
  const int first = std::clamp(static_cast<int>(std::floor(least)), 0, kBlurs - 2);
  return most < 0.0 ? Blurs{} : Blurs{first, std::clamp(static_cast<int>(std::ceil(most)), first + 1, kBlurs - 1) - first + 1};
}

const NodeSurroundings::Height& NodeSurroundings::height(std::size_t number) const {
  const std::lock_guard lock(busy_);
  auto& kept = heights_[number];
  if (kept) return *kept;
  kept = std::make_unique<Height>();
  Height& h = *kept;
  if (!takeParts(number, h)) makePatterns(number, h);
  if (degree_ != Terms::kWhole) return h;
  const Patterns& of = *h.of;
  h.samples = of.grid.samples(kPoints);
  h.atSamples.resize(of.pattern.rows(), static_cast<Eigen::Index>(h.samples.size()));
  for (size_t s = 0; s < h.samples.size(); ++s) {
    Eigen::VectorXd here = Eigen::VectorXd::Zero(of.pattern.rows());
    for (size_t k = 0; k < 4; ++k) here += h.samples[s].reading.weight[k] * of.pattern.col(static_cast<Eigen::Index>(h.samples[s].reading.at[k]));
    h.atSamples.col(static_cast<Eigen::Index>(s)) = here;
  }
  return h;
}

/// As averages of nodes of single wavelengths that are known already; false where some are missing.
bool NodeSurroundings::takeParts(std::size_t number, Height& h) const {
  if (!parts_) return false;
  std::map<double, std::size_t> at_um;
  for (std::size_t i = 0; i < parts_->nodes_.size(); ++i)
    if (const auto& members = parts_->nodes_[i].members; members.size() == 1) at_um[members.front().wavelength_um] = i;
  for (const SpectralNode& n : nodes_)
    for (const auto& m : n.members)
      if (!at_um.contains(m.wavelength_um)) return false;
  const Height& parts = parts_->height(number);
  h.of = parts.of;
  h.mix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(nodes_.size()), parts.mix.cols());
  h.harmonics.assign(nodes_.size(), Harmonics{});
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (const auto& m : nodes_[i].members) {
      const std::size_t part = at_um.at(m.wavelength_um);
      h.mix.row(static_cast<Eigen::Index>(i)) += m.share * parts.mix.row(static_cast<Eigen::Index>(part));
      for (size_t c = 0; c < h.harmonics[i].size(); ++c) h.harmonics[i][c] += m.share * parts.harmonics[part][c];
    }
  return true;
}

void NodeSurroundings::makePatterns(std::size_t number, Height& h) const {
  const auto made = std::make_shared<Patterns>();
  h.of = made;
  const Surroundings& around = *simulation_.surroundings;
  made->grid = around.grids()[number];
  made->number = number;
  made->finer = made->grid.finer();
  prepareLight(number);
  const auto entries = static_cast<Eigen::Index>(made->grid.size()), count = static_cast<Eigen::Index>(nodes_.size());
  Eigen::MatrixXd light = Eigen::MatrixXd::Zero(entries, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Harmonics sum{};
    for (const auto& m : nodes_[static_cast<size_t>(i)].members) {
      const Surroundings::Light& own = around.light(m.wavelength_um, number);
      light.col(i) += m.share * Eigen::Map<const Eigen::VectorXf>(own.radiance.data(), entries).cast<double>();
      for (size_t c = 0; c < sum.size(); ++c) sum[c] += m.share * own.harmonics[c];
    }
    h.harmonics.push_back(sum);
  }
  // The node that is told worst becomes a pattern, until none is told badly (Gram and Schmidt with pivots).
  Eigen::MatrixXd left = light;
  for (Eigen::Index i = 0; i < count; ++i)
    if (const double norm = light.col(i).norm(); norm > 0.0) left.col(i) /= norm;
  std::vector<Eigen::VectorXd> patterns;
  while (static_cast<Eigen::Index>(patterns.size()) < std::min(count, entries)) {
    Eigen::Index worst = 0;
    const double most = left.colwise().norm().maxCoeff(&worst);
    if (most <= kLeftOut) break;
    const Eigen::VectorXd pattern = left.col(worst) / most;
    left -= pattern * (pattern.transpose() * left);
    patterns.push_back(pattern);
  }
  made->pattern.resize(static_cast<Eigen::Index>(patterns.size()), entries);
  for (size_t p = 0; p < patterns.size(); ++p) made->pattern.row(static_cast<Eigen::Index>(p)) = patterns[p];
  h.mix = (made->pattern * light).transpose();
}

NodeSurroundings::Told NodeSurroundings::makeTold(std::size_t number) const {
  const Height& h = height(number);
  struct Rest {
    bool sharp;
    std::size_t blur;
  };
  std::vector<Rest> rests;
  for (const bool sharp : {false, true}) {
    const Blurs blurs = blursInUse(sharp);
    for (int b = 0; b < blurs.count; ++b) rests.push_back({sharp, static_cast<size_t>(blurs.first + b)});
  }
  rests.push_back({false, kCosine});
  const std::size_t padded = (nodes_.size() + 3) / 4 * 4, entries = h.of->finer.size();
  Told told{h.harmonics, std::vector<float>(rests.size() * entries * padded, 0.0f)};
  for (std::size_t b = 0; b < rests.size(); ++b) {
    const Eigen::MatrixXd all = h.mix * h.of->tellRest(*simulation_.surroundings, rests[b].sharp ? 0 : degree_, rests[b].blur);
    for (std::size_t g = 0; g < entries; ++g)
      for (std::size_t i = 0; i < nodes_.size(); ++i)
        told.rest[(b * entries + g) * padded + i] = static_cast<float>(all(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(g)));
  }
  return told;
}

const NodeSurroundings::Told& NodeSurroundings::told(std::size_t number) const {
  const std::lock_guard lock(telling_);
  auto& told = told_[number];
  if (!told) told = sharedTold(number);
  return *told;
}

std::shared_ptr<const NodeSurroundings::Told> NodeSurroundings::sharedTold(std::size_t number) const {
  const DirectionGrid& grid = simulation_.surroundings->grids()[number];
  Fingerprint f;
  simulation_.surroundings->addTo(f);
  f.add(static_cast<double>(number)).add(degree_).add(grid.above).add(grid.below).add(grid.azimuths).add(grid.turn_rad).add(grid.horizon_rad);
  for (const bool sharp : {false, true}) f.add(blursInUse(sharp).first).add(blursInUse(sharp).count);
  for (const SpectralNode& n : nodes_) f.all(n.members);
  constexpr const char* kWhat = "surroundings-1";
  const ContentKey key = contentKey(f.bytes());
  static std::mutex sharing;
  static std::map<ContentKey, std::weak_ptr<const Told>> shared;
  const std::lock_guard lock(sharing);
  std::weak_ptr<const Told>& known = shared[key];
  if (auto own = known.lock()) return own;
  auto told = std::make_shared<Told>();
  known = told;
  if (const auto kept = readCachedTable(kWhat, key)) {
    TableReader in(*kept);
    told->harmonics = in.all<Harmonics>(), told->rest = in.all<float>();
    if (in.isWhole() && told->harmonics.size() == nodes_.size()) return told;
  }
  *told = makeTold(number);
  TableWriter out;
  out.all(told->harmonics), out.all(told->rest);
  writeCachedTable(kWhat, key, out.bytes());
  return told;
}

NodeSurroundings::Light NodeSurroundings::lightAt(const Surroundings::Place& place) const {
  const Told &low = told(place.height), &high = told(place.height + (place.share > 0.0 ? 1 : 0));
  const DirectionGrid& above = simulation_.surroundings->grids()[place.height + (place.share > 0.0 ? 1 : 0)];
  const double share = place.share;
  Light light;
  light.grid = simulation_.surroundings->grids()[place.height].finer();
  light.grid.horizon_rad = (1.0 - share) * light.grid.horizon_rad + share * above.horizon_rad;
  light.harmonics.assign(nodes_.size(), Harmonics{});
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (std::size_t c = 0; c < static_cast<std::size_t>(harmonicCount(degree_)); ++c)
      light.harmonics[i][c] = (1.0 - share) * low.harmonics[i][c] + share * high.harmonics[i][c];
  light.rest = low.rest;
  if (share > 0.0) {
    const auto mix = static_cast<float>(share);
    for (std::size_t k = 0; k < high.rest.size(); ++k) light.rest[k] += mix * (high.rest[k] - light.rest[k]);
  }
  return light;
}

/// Light by wavelength is kept by the surroundings: made beforehand, on all cores.
void NodeSurroundings::prepareLight(std::size_t number) const {
  std::set<double> wanted_um;
  for (const SpectralNode& n : nodes_)
    for (const auto& m : n.members) wanted_um.insert(m.wavelength_um);
  const std::vector<double> all_um(wanted_um.begin(), wanted_um.end());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k = next++; k < all_um.size(); k = next++) simulation_.surroundings->light(all_um[k], number);
  };
  std::vector<std::future<void>> others;
  for (unsigned n = 1; n < std::thread::hardware_concurrency(); ++n) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
}

const std::vector<double>& NodeSurroundings::ofDome() const {
  std::call_once(isDomeKnown_, [&] {
    for (const SpectralNode& n : nodes_) ofDome_.push_back(n.mean(*simulation_.ambient));
  });
  return ofDome_;
}

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
