#include "sim/radiance/node_surroundings.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>

#include "sim/parameters/fingerprint.hpp"
#include "sim/radiance/node_patterns.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

/// Part of each node's norm that its patterns may leave out.
constexpr double kLeftOut = 1e-5;
/// Points a side of each cell of a grid where light is summed over the whole sphere.
constexpr int kPoints = 3;
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

}  // namespace

NodeSurroundings::~NodeSurroundings() = default;

namespace {

/// Real discrete Fourier transform of values evenly around: [azimuth, frequency], and of how much each frequency is of a value.
struct Waves {
  explicit Waves(Eigen::Index round) : cosines(round, round / 2 + 1), sines(round, round / 2 + 1), part(round / 2 + 1) {
    for (Eigen::Index w = 0; w < count(); ++w) {
      part[w] = (w == 0 || 2 * w == round ? 1.0 : 2.0) / static_cast<double>(round);
      for (Eigen::Index a = 0; a < round; ++a) {
        const double angle = 2.0 * kPi * static_cast<double>(w * a % round) / static_cast<double>(round);
        cosines(a, w) = std::cos(angle), sines(a, w) = std::sin(angle);
      }
    }
  }
  Eigen::Index count() const { return part.size(); }
  Eigen::MatrixXd cosines, sines;
  Eigen::VectorXd part;
};

}  // namespace

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
  // What is told at an azimuth is read at all others by how far they are turned: of each frequency around, a product of rings read by rings told.
  const Waves waves(round);
  const Eigen::Index count = waves.count();
  Eigen::MatrixXd from(patterns * rings, round);
  for (Eigen::Index p = 0; p < patterns; ++p)
    for (Eigen::Index g = 0; g < entries; ++g) from(p + patterns * (g / round), g % round) = pattern(p, g);
  const Eigen::MatrixXd fromCos = from * waves.cosines, fromSin = from * waves.sines;  // [pattern, ring read; frequency]
  using Strides = Eigen::Stride<Eigen::Dynamic, Eigen::Dynamic>;
  const auto at = [](const Eigen::MatrixXd& all, Eigen::Index wave, Eigen::Index rows, Eigen::Index columns) {
    return Eigen::Map<const Eigen::MatrixXd>(all.data() + wave * rows * columns, rows, columns);
  };
  for (Eigen::Index phase = 0; phase < phases; ++phase) {
    Eigen::MatrixXd shares(rings * told, round);  // [ring read, ring told; turn]
    for (Eigen::Index turn = 0; turn < round; ++turn)
      Eigen::Map<Eigen::MatrixXd>(shares.col(turn).data(), rings, told) =
          Eigen::Map<const Eigen::MatrixXd, 0, Strides>(blur.shares.data() + phase * entries + turn, rings, told, Strides(phases * entries, round));
    const Eigen::MatrixXd sharesCos = shares * waves.cosines, sharesSin = shares * waves.sines;
    Eigen::MatrixXd real(patterns * told, count), imaginary(patterns * told, count);
    for (Eigen::Index w = 0; w < count; ++w) {
      const auto xc = at(fromCos, w, patterns, rings), xs = at(fromSin, w, patterns, rings), sc = at(sharesCos, w, rings, told),
                 ss = at(sharesSin, w, rings, told);
      Eigen::Map<Eigen::MatrixXd>(real.col(w).data(), patterns, told) = xc * sc + xs * ss;
      Eigen::Map<Eigen::MatrixXd>(imaginary.col(w).data(), patterns, told) = xc * ss - xs * sc;
    }
    const Eigen::MatrixXd sum = (real * waves.part.asDiagonal()) * waves.cosines.transpose() - (imaginary * waves.part.asDiagonal()) * waves.sines.transpose();
    for (Eigen::Index p = 0; p < patterns; ++p)
      for (Eigen::Index r = 0; r < told; ++r)
        for (Eigen::Index a = 0; a < round; ++a) left(p, (r * round + a) * phases + phase) += sum(p + patterns * r, a);
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
  std::set<double> wanted_um;
  for (const SpectralNode& n : nodes_)
    for (const auto& m : n.members) wanted_um.insert(m.wavelength_um);
  around.prepare(std::vector<double>(wanted_um.begin(), wanted_um.end()), number);
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
  constexpr const char* kWhat = "surroundings";
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
const std::vector<double>& NodeSurroundings::ofDome() const {
  std::call_once(isDomeKnown_, [&] {
    for (const SpectralNode& n : nodes_) ofDome_.push_back(n.mean(*simulation_.ambient));
  });
  return ofDome_;
}

}  // namespace pitviper
