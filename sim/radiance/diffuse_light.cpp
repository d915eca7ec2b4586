#include "sim/radiance/diffuse_light.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/wide_loops.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

/// Edges of layers [m], where air is clear.
constexpr double kHeights_m[] = {0.0, 100.0, 250.0, 500.0, 750.0, 1000.0, 1250.0, 1500.0, 1750.0, 2000.0, 2500.0, 3e3,  3.5e3, 4e3,
                                 5e3, 6e3,   7e3,   8.5e3, 10e3,  12e3,   15e3,   18e3,   22e3,   27e3,   34e3,   45e3, 70e3};
/// Edges nearer to each other than this are one.
constexpr double kSameHeight_m = 0.6;
/// A layer scatters no more than this of light straight through, where air scatters most: between its edges light is linear in height.
constexpr double kDeepest = 0.12;
/// Deep within, where light changes slowly: as part of what lies between there and the nearer end.
constexpr double kDeeper = 0.15;
/// What the sun would send evenly from all sides, as part of what a black body of the lowest air's temperature sends.
constexpr double kUnseenSun = 0.005;
/// First thin layer, as Streams::thin: 8e-5 of the flattest stream.
constexpr double kThin = 0.03;
/// Of the phase function.
constexpr int kPhaseMoments = 40;
/// Moments that add less than this part of a mean radiance are left out.
constexpr double kFaint = 1e-4;
/// Sines and cosines of directions that are one to the light at an edge.
constexpr double kSameDirection = 0.003;
/// Kind of table in the cache.
constexpr const char* kTable = "diffuse";
/// Part of each node's norm that its patterns may leave out.
constexpr double kLeftOut = 2e-4;

double sumOver(const std::array<double, kMostAirAmounts>& c, const AirAmounts& powered) {
  double sum = 0.0;
  for (std::size_t k = 0; k < c.size(); ++k) sum += c[k] * powered.amount[k];
  return sum;
}

double scattered(const AirNode& n, const AirAmounts& above, const AirAmounts& below) {
  double sum = 0.0;
  for (std::size_t k = 0; k < kMostAirAmounts; ++k) sum += (n.molecules[k] + n.haze[k]) * std::max(below.amount[k] - above.amount[k], 0.0);
  return sum;
}

PITVIPER_WIDE void addTimes(const double* row, double factor, int count, double* __restrict into) {
  for (int i = 0; i < count; ++i) into[i] += factor * row[i];
}

/// By how many directions light is told of so many streams, and how often: what streams lose falls to a tenth, then to half each time.
FineDirections directionsFor(int streams) {
  if (streams <= 4) return {8, 10, 8, 2};
  if (streams <= 8) return {16, 20, 12, 3};
  return {24, 24, 16, 3};
}

}  // namespace

AirColumn columnOf(const Simulation& sim) {
  AirColumn c{sim.air, sim.sun, sim.background, nullptr, 0.0, sim.frame.earthRadius_m()};
  if (sim.ground) c.ground = sim.materials[static_cast<std::size_t>(sim.ground->material)], c.ground_K = sim.ground->temperature_K;
  return c;
}

std::shared_ptr<const DiffuseLight> DiffuseLight::of(const AirColumn& column, int streams) {
  if (!column.air || !column.air->traits().scattersSun || streams < 2) return nullptr;
  Fingerprint f;
  f.add(streams).add(column.ground_K).add(column.earthRadius_m).add(column.ground ? 1.0 : 0.0).add(column.sun ? 1.0 : 0.0);
  column.air->addTo(f);
  if (column.sun) f.add(column.sun->toSun), addTo(f, column.sun->irradiance);
  addTo(f, column.background);
  if (column.ground) addTo(f, *column.ground);
  static std::mutex mutex;
  static std::map<std::string, std::weak_ptr<const DiffuseLight>> all;
  const std::scoped_lock lock(mutex);
  std::erase_if(all, [](const auto& kept) { return kept.second.expired(); });
  auto& kept = all[f.bytes()];
  if (auto known = kept.lock()) return known;
  std::shared_ptr<DiffuseLight> made(new DiffuseLight(column, streams));
  made->key_ = contentKey(f.bytes());
  kept = made;
  return made;
}

DiffuseLight::DiffuseLight(const AirColumn& column, int streams) : column_(column), streams_(streams), fine_(directionsFor(streams)) {
  const Atmosphere& air = *column_.air;
  if (column_.sun && column_.sun->toSun.z > kNight) legs_ = SunLegs::of(column_.air, column_.sun->toSun.z, column_.earthRadius_m);
  shape_ = {fine_.degree, legs_ ? fine_.azimuths : 1};
  const auto aboveAt = [&](double h) { return air.powered(air.amounts({h, 1.0, column_.earthRadius_m}, physics::kFar)); };
  const AirNode node = air.node(std::max(air.validLow_um(), 0.45));
  const double whole = scattered(node, {}, aboveAt(0.0));
  std::vector<double> edges(std::begin(kHeights_m), std::end(kHeights_m));
  for (const AirShell& s : air.shells()) edges.push_back(s.low_m), edges.push_back(s.high_m);
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end(), [](double a, double b) { return b - a < kSameHeight_m; }), edges.end());
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double low = edges[k], high = std::min(k + 1 < edges.size() ? edges[k + 1] : air.top_m(), air.top_m());
    if (!(low < air.top_m())) break;
    const double under = scattered(node, {}, aboveAt(low)), over = scattered(node, {}, aboveAt(high));
    // Steps from the lower edge on, wider the deeper within.
    const auto step = [&](double depth) { return std::max(kDeepest, kDeeper * std::min(depth, whole - depth)); };
    const double depth = under - over;
    for (double at = 0.0; at < 1.0 - 1e-9;) {
      heights_m_.push_back(low + (high - low) * at);
      const double own = depth > 0.0 ? step(under - at * depth) / depth : 1.0, left = std::ceil((1.0 - at) / own - 1e-9);
      at += (1.0 - at) / std::max(left, 1.0);
    }
  }
  heights_m_.push_back(air.top_m());
  for (double h : heights_m_) {
    above_.push_back(aboveAt(h));
    temperature_K_.push_back(air.stationsAt({h, 1.0, column_.earthRadius_m}, std::array{0.0}).front().temperature_K);
    if (!legs_) continue;
    const RisenSun risen = risenSun(h, column_.sun->toSun.z, column_.earthRadius_m);
    risen_.push_back(risen.share);
    toSun_.push_back(risen.share > 0.0 ? air.powered(legs_->at(h, risen.sinElevation)) : AirAmounts{});
  }
}

const DiffuseLight::Moments& DiffuseLight::at(double wavelength_um) const {
  {
    const std::scoped_lock lock(busy_);
    if (const auto known = kept_.find(wavelength_um); known != kept_.end()) return known->second;
  }
  Moments own = made(wavelength_um);
  const std::scoped_lock lock(busy_);
  return kept_.try_emplace(wavelength_um, std::move(own)).first->second;
}

DiffuseLight::Moments DiffuseLight::made(double um) const {
  PlaneLayers layers;
  const AirNode n = column_.air->node(um);
  const std::size_t count = heights_m_.size();
  std::vector<double> black;
  for (double t : temperature_K_) black.push_back(t > 0.0 ? physics::planckRadiance(um, t) : 0.0);
  for (std::size_t k = count - 1; k-- > 0;) {
    const auto part = [&](const std::array<double, kMostAirAmounts>& c) { return std::max(sumOver(c, above_[k]) - sumOver(c, above_[k + 1]), 0.0); };
    const double all = part(n.extinction), molecules = part(n.molecules), both = molecules + part(n.haze);
    PlaneLayer layer{all, all > 0.0 ? std::min(both / all, 1.0) : 0.0, {}, black[k + 1], black[k]};
    if (both > 0.0) {
      layer.moments.assign(kPhaseMoments, 0.0);
      layer.moments[0] += molecules / both, layer.moments[2] += 0.1 * molecules / both;
      for (std::size_t a = 0; a < kMostAirAmounts; ++a) {
        double share = n.haze[a] * std::max(above_[k].amount[a] - above_[k + 1].amount[a], 0.0) / both;
        if (share > 0.0)
          for (double& m : layer.moments) m += share, share *= n.asymmetry[a];
      }
    }
    layers.layers.push_back(std::move(layer));
  }
  // Where air's own light is more than a hundred times the sun's, nobody sees what it scatters of that more than once.
  const double sun = legs_ ? column_.sun->irradiance(um) : 0.0;
  const bool isSunlit = sun > kUnseenSun * 4.0 * kPi * black.front();
  if (isSunlit) {
    layers.sunSine = column_.sun->toSun.z;
    layers.irradiance = 1.0;
    for (std::size_t k = count; k-- > 0;) layers.sunDepth.push_back(risen_[k] > 0.0 ? Atmosphere::depthOf(n, toSun_[k]) - std::log(risen_[k]) : INFINITY);
  }
  if (column_.ground) {
    layers.groundAlbedo = column_.ground->reflections.empty() ? 0.0 : std::clamp(column_.ground->reflectance(um, 0.0), 0.0, 1.0);
    layers.groundEmission = column_.ground->emissivity(um, 0.0) * physics::planckRadiance(um, column_.ground_K);
  }
  layers.spaceRadiance = column_.background(um);
  const LayerLight light = finer(layers, lightIn(layers, {streams_, isSunlit ? streams_ : 1, kThin}), fine_);
  // From the ground up.
  Moments out;
  out.air = n;
  out.irradiance = sun;
  for (std::size_t k = count; k-- > 0;) {
    const auto solar = light.solarAt(k), thermal = light.thermalAt(k);
    if (isSunlit) out.solar.insert(out.solar.end(), solar.begin(), solar.end());
    out.thermal.insert(out.thermal.end(), thermal.begin(), thermal.end());
  }
  if (legs_ && !isSunlit) out.solar.assign(count * static_cast<std::size_t>(shape_.moments()), 0.0);
  return out;
}

NodeDiffuse::NodeDiffuse(std::shared_ptr<const DiffuseLight> light, std::span<const SpectralNode> nodes, Nodes told)
    : light_(std::move(light)), nodes_(nodes.size()), told_(told) {
  std::vector<AirNode> air;
  for (const SpectralNode& n : nodes)
    for (const auto& m : n.members) air.push_back(light_->airAt(m.wavelength_um));
  kinds_ = particleKinds(air);
  each_ = 1 + kinds_.size();
  parts_.resize(light_->sunlit() ? 2 * each_ : each_);
  if (told != Nodes::Kept || nodes.empty()) {
    make(nodes);
    return;
  }
  Fingerprint f;
  for (const SpectralNode& n : nodes) f.all(n.members);
  const ContentKey key = contentKey(f.bytes(), light_->key());
  if (read(key)) return;
  make(nodes);
  write(key);
}

double shellAmount(const Atmosphere& air, std::size_t absorber) {
  double sum = 0.0;
  for (const AirShell& s : air.shells())
    if (static_cast<std::size_t>(s.amount) == absorber) sum += s.per_m * (s.high_m - s.low_m);
  return sum;
}

double turnedThrough(const Atmosphere& air, const AirNode& node, std::size_t absorber) {
  const double depth = node.extinction[absorber] * shellAmount(air, absorber);
  return node.haze[absorber] * (depth > 0.0 ? physics::oneMinusExp(depth) / depth : 1.0);
}

bool NodeDiffuse::read(const ContentKey& key) {
  const auto text = readCachedTable(kTable, key);
  if (!text) return false;
  TableReader in(*text);
  bool fits = true;
  for (Part& p : parts_) {
    p.moments = in.all<int>(), p.pattern = in.all<double>(), p.share = in.all<double>();
    p.patterns = p.share.size() / nodes_;
    fits &= p.share.size() == p.patterns * nodes_ && p.pattern.size() == p.patterns * p.moments.size() * light_->heights_m().size() &&
            std::all_of(p.moments.begin(), p.moments.end(), [&](int m) { return m >= 0 && m < light_->shape().moments(); });
  }
  return fits && in.isWhole();
}

void NodeDiffuse::write(const ContentKey& key) const {
  TableWriter out;
  for (const Part& p : parts_) out.all(p.moments), out.all(p.pattern), out.all(p.share);
  writeCachedTable(kTable, key, out.bytes());
}

void NodeDiffuse::make(std::span<const SpectralNode> nodes) {
  std::vector<double> um;
  for (const SpectralNode& n : nodes)
    for (const auto& m : n.members) um.push_back(m.wavelength_um);
  onAllThreads(um.size(), [&](const auto& next) {
    for (std::size_t i = next(); i < um.size(); i = next()) light_->at(um[i]);
  });
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    const std::size_t kind = p % each_;
    parts_[p] = partOf(nodes, p >= each_, kind > 0 ? &kinds_[kind - 1] : nullptr);
  }
}

NodeDiffuse::Part NodeDiffuse::partOf(std::span<const SpectralNode> nodes, bool solar, const std::vector<std::size_t>* kind) const {
  const bool haze = kind != nullptr;
  const auto scatteredBy = [&](const AirNode& air) {
    double sum = 0.0;
    if (!haze)
      for (double m : air.molecules) sum += m;
    else
      for (std::size_t k : *kind) sum += turnedThrough(light_->air(), air, k);
    return sum;
  };
  const LayerLight::Shape shape = light_->shape();
  const std::size_t heights = light_->heights_m().size(), each = static_cast<std::size_t>(solar ? shape.moments() : shape.streams);
  std::vector<std::size_t> moments;
  std::vector<int> degrees;
  for (int m = 0; m < (solar ? shape.azimuths : 1); ++m)
    for (int l = m; l < shape.streams; ++l)
      if (haze || l == 0 || l == 2) moments.push_back(static_cast<std::size_t>(shape.at(l, m))), degrees.push_back(l);
  // Of each node [height][moment]: means over its members by what they scatter, and of sunlight by what there is of it.
  const std::size_t count = moments.size();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(heights * count), static_cast<Eigen::Index>(nodes_));
  std::vector<double> phase(static_cast<std::size_t>(shape.streams)), weight(count);
  for (std::size_t i = 0; i < nodes_; ++i) {
    double sum = 0.0, light = 0.0;
    for (const auto& m : nodes[i].members) {
      const DiffuseLight::Moments& own = light_->at(m.wavelength_um);
      sum += m.share * scatteredBy(own.air), light += m.share * own.irradiance;
    }
    double* into = all.col(static_cast<Eigen::Index>(i)).data();
    for (const auto& m : nodes[i].members) {
      const DiffuseLight::Moments& own = light_->at(m.wavelength_um);
      double part = sum > 0.0 ? m.share * scatteredBy(own.air) / sum : m.share;
      if (solar) part *= light > 0.0 ? own.irradiance / light : 0.0;
      if (part == 0.0) continue;
      double power = 1.0;
      const double asymmetry = haze ? own.air.asymmetry[kind->front()] : 0.0;
      for (std::size_t l = 0; l < phase.size(); ++l, power *= asymmetry) phase[l] = haze ? power : l == 0 ? 1.0 : 0.1;
      for (std::size_t k = 0; k < count; ++k) weight[k] = part * phase[static_cast<std::size_t>(degrees[k])];
      const double* of = (solar ? own.solar : own.thermal).data();
      for (std::size_t h = 0; h < heights; ++h)
        for (std::size_t k = 0; k < count; ++k) into[h * count + k] += weight[k] * of[h * each + moments[k]];
    }
    // Lines tell what scattering makes of a black body of the mean radiance: what of thermal light goes with what scatters is told by its difference from that.
    for (std::size_t h = 0; !solar && sum > 0.0 && nodes[i].members.size() > 1 && h < heights; ++h)
      if (const double kelvin = light_->temperatures_K()[h]; kelvin > 0.0)
        for (const auto& m : nodes[i].members)
          into[h * count] += m.share * (1.0 - scatteredBy(light_->at(m.wavelength_um).air) / sum) * physics::planckRadiance(m.wavelength_um, kelvin);
  }
  const auto at = [&](std::size_t h, std::size_t k) { return all.row(static_cast<Eigen::Index>(h * count + k)); };
  Part part;
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < count; ++k) {
    bool matters = k == 0 || told_ == Nodes::Apart;
    for (std::size_t h = 0; h < heights && !matters; ++h) matters = ((2.0 * degrees[k] + 1.0) * at(h, k).array().abs() > kFaint * at(h, 0).array().abs()).any();
    if (matters) kept.push_back(k), part.moments.push_back(static_cast<int>(moments[k]));
  }
  const auto size = static_cast<Eigen::Index>(heights * kept.size());
  Eigen::MatrixXd light(size, all.cols());
  for (std::size_t h = 0; h < heights; ++h)
    for (std::size_t j = 0; j < kept.size(); ++j) light.row(static_cast<Eigen::Index>(h * kept.size() + j)) = at(h, kept[j]);
  if (told_ == Nodes::Apart) {
    part.share.resize(static_cast<std::size_t>(size) * nodes_);
    Eigen::Map<Eigen::MatrixXd>(part.share.data(), light.cols(), size) = light.transpose();
    return part;
  }
  // Of each node one column; the one that is told worst becomes a pattern, until none is told badly (Gram and Schmidt with pivots). What patterns leave of
  // a column is followed by its square alone.
  Eigen::RowVectorXd scale = light.colwise().norm();
  for (double& s : scale) s = s > 0.0 ? 1.0 / s : 0.0;
  Eigen::RowVectorXd left = (light.colwise().squaredNorm().array() * scale.array().square()).matrix();
  std::vector<Eigen::VectorXd> patterns;
  while (static_cast<Eigen::Index>(patterns.size()) < std::min(size, light.cols())) {
    Eigen::Index worst = 0;
    if (left.maxCoeff(&worst) <= kLeftOut * kLeftOut) break;
    Eigen::VectorXd p = light.col(worst) * scale[worst];
    for (int again = 0; again < 2; ++again)
      for (const Eigen::VectorXd& q : patterns) p -= q * q.dot(p);
    const double norm = p.norm();
    left[worst] = 0.0;
    if (!(norm > kLeftOut)) continue;
    patterns.emplace_back(p / norm);
    const Eigen::RowVectorXd shares = patterns.back().transpose() * light;
    part.share.insert(part.share.end(), shares.begin(), shares.end());
    left.array() = (left.array() - (shares.array() * scale.array()).square()).max(0.0);
  }
  part.patterns = patterns.size();
  part.pattern.resize(static_cast<std::size_t>(size) * part.patterns);
  for (std::size_t n = 0; n < static_cast<std::size_t>(size); ++n)
    for (std::size_t k = 0; k < part.patterns; ++k) part.pattern[n * part.patterns + k] = patterns[k][static_cast<Eigen::Index>(n)];
  return part;
}

void NodeDiffuse::tellEdge(std::size_t edge, double sine, double cosAzimuth, Of of, DiffuseMemory::Edge& into) const {
  const auto holds = [&](const DiffuseMemory::Terms& t, double room) { return std::abs(t.sine - sine) <= room && t.sun >= of.sun && t.thermal >= of.thermal; };
  const bool isHere = into.here < into.told.size() && holds(into.told[into.here], kSameDirection);
  if (isHere && std::abs(into.cosAzimuth - cosAzimuth) <= kSameDirection) return;
  const LayerLight::Shape shape = light_->shape();
  const std::size_t first = of.thermal ? 0 : each_, end = of.sun ? 2 * each_ : each_;
  into.of.resize(2 * each_);
  const auto widthOf = [&](const Part& part) { return told_ == Nodes::Apart ? nodes_ : part.patterns; };
  if (!isHere) {
    const auto known = std::find_if(into.told.begin(), into.told.end(), [&](const auto& t) { return holds(t, 0.0); });
    into.here = static_cast<std::size_t>(known - into.told.begin());
    if (known == into.told.end()) {
      DiffuseMemory::Terms& terms = into.told.emplace_back();
      terms.sine = sine, terms.sun = of.sun, terms.thermal = of.thermal;
      terms.of.resize(2 * each_);
      std::vector<double> turned(static_cast<std::size_t>(shape.moments()));
      // Light goes the other way than the line.
      turnedTo(-sine, 1.0, shape, turned);
      for (std::size_t n = first; n < end; ++n) {
        const Part& part = parts_[n];
        const std::size_t width = widthOf(part);
        const double* rows = (told_ == Nodes::Apart ? part.share : part.pattern).data() + edge * part.moments.size() * width;
        terms.of[n].assign(width * static_cast<std::size_t>(n < each_ ? 1 : shape.azimuths), 0.0);
        int m = 0;
        for (std::size_t k = 0; k < part.moments.size(); ++k) {
          while (n >= each_ && m + 1 < shape.azimuths && part.moments[k] >= shape.at(m + 1, m + 1)) ++m;
          addTimes(rows + k * width, turned[static_cast<std::size_t>(part.moments[k])], static_cast<int>(width),
                   terms.of[n].data() + static_cast<std::size_t>(m) * width);
        }
      }
    }
  }
  into.cosAzimuth = cosAzimuth;
  const double azimuth = std::acos(std::clamp(cosAzimuth, -1.0, 1.0));
  for (std::size_t n = first; n < end; ++n) {
    const std::size_t width = widthOf(parts_[n]);
    into.of[n].assign(width, 0.0);
    const std::vector<double>& terms = into.told[into.here].of[n];
    for (std::size_t m = 0; m * width < terms.size(); ++m)
      addTimes(terms.data() + m * width, std::cos(static_cast<double>(m) * azimuth), static_cast<int>(width), into.of[n].data());
  }
}

void NodeDiffuse::at(double height_m, double sine, double cosAzimuth, Of of, DiffuseMemory& memory, TurnedLight& out) const {
  const std::vector<double>& heights = light_->heights_m();
  const auto above = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(std::upper_bound(heights.begin(), heights.end(), height_m) - heights.begin(), 1, std::ssize(heights) - 1));
  const double low = heights[above - 1], high = heights[above];
  const double share = std::clamp((height_m - low) / (high - low), 0.0, 1.0);
  of.sun = of.sun && light_->sunlit();
  memory.edges.resize(heights.size());
  for (std::size_t edge : {above - 1, above}) tellEdge(edge, sine, cosAzimuth, of, memory.edges[edge]);
  const DiffuseMemory::Edge &below = memory.edges[above - 1], &over = memory.edges[above];
  const auto sum = [&](const Part& part, std::size_t n, std::vector<double>& into) {
    into.assign(nodes_, 0.0);
    if (told_ == Nodes::Apart) {
      addTimes(below.of[n].data(), 1.0 - share, static_cast<int>(nodes_), into.data());
      addTimes(over.of[n].data(), share, static_cast<int>(nodes_), into.data());
    }
    for (std::size_t p = 0; p < part.patterns; ++p)
      addTimes(part.share.data() + p * nodes_, (1.0 - share) * below.of[n][p] + share * over.of[n][p], static_cast<int>(nodes_), into.data());
  };
  out.thermal.resize(each_), out.solar.resize(each_);
  for (std::size_t k = 0; k < each_; ++k) {
    if (of.thermal) sum(parts_[k], k, out.thermal[k]);
    if (of.sun) sum(parts_[each_ + k], each_ + k, out.solar[k]);
  }
}

}  // namespace pitviper
