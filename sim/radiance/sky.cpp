#include "sim/radiance/sky.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/scene_fingerprint.hpp"
#include "sim/model/surroundings.hpp"
#include "sim/radiance/diffuse_light.hpp"
#include "sim/radiance/node_air.hpp"
#include "sim/radiance/sunlit_air.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

constexpr int kElevations = 6, kAzimuths = 6;
/// Of light scattered again: as it falls on surfaces; and of the mean sky, at all wavelengths that the air has.
constexpr int kStreams = 8, kMeanStreams = 4;
/// Kind of table in the cache.
constexpr const char* kMeanSky = "mean-sky";
/// Places on a line of sight: closer together near its beginning, where most of what is seen lies.
constexpr double kRanges_m[] = {0.0, 50.0, 200.0, 600.0, 1500.0, 3e3, 5e3, 8e3, 12e3, 18e3, 28e3, 50e3, 100e3, physics::kFar};
/// Of a line that ends at the ground, parts of its length.
constexpr double kParts[] = {0.0, 0.02, 0.06, 0.13, 0.22, 0.32, 0.43, 0.55, 0.67, 0.79, 0.9, 1.0};
/// Between the heights at which the sky is known it is linear.
constexpr double kHeights_m[] = {0.0, 100.0, 500.0, 1500.0, 3e3, 5e3, 8e3, 12e3, 18e3, 27e3, 40e3, 60e3};

/// Air on a line, and how it turns sunlight.
struct Sightline {
  SunlitAir air;
  double cosScatter;
};
/// With its share of a mean.
using WeightedLines = std::vector<std::pair<Sightline, double>>;

/// What lines send at some wavelengths. Each wavelength's figures are the same to the last bit whichever others stand beside it: their number is even, so that
/// all are worked out in vectors.
class SkyAt {
 public:
  SkyAt(const Atmosphere& air, std::span<const double> um, const Sun* sun, const Spectrum& background, std::shared_ptr<const DiffuseLight> diffuse)
      : count_(um.size()), nodes_(nodesAt(air, um)), air_(nodes_, std::move(diffuse)) {
    for (double w : um) {
      irradiance_.push_back(sun ? sun->irradiance(w) : 0.0);
      behind_.push_back(background(w));
    }
  }
  const AirNode& node(std::size_t i) const { return nodes_[i].air; }
  double irradiance(std::size_t i) const { return irradiance_[i]; }
  double behind(std::size_t i) const { return behind_[i]; }

  struct Sent {
    std::vector<double> radiance, depth;  ///< by wavelength; depth: of what it takes from what lies behind
  };
  Sent along(const Sightline& line, SameWay* way = nullptr) const {
    const NodeRadiance all = air_.along(line.air, way);
    const std::size_t last = (line.air.stations.size() - 1) * nodes_.size();
    const double rayleigh = physics::rayleighPhase(line.cosScatter);
    Sent sent;
    for (std::size_t i = 0; i < count_; ++i) {
      double radiance = all.thermal[last + i];
      if (!all.molecules.empty())
        radiance +=
            irradiance_[i] * (rayleigh * all.molecules[last + i] + physics::henyeyGreensteinPhase(line.cosScatter, node(i).meanAsymmetry) * all.haze[last + i]);
      if (!all.again.empty()) radiance += irradiance_[i] * hazeAgainPhase(line.cosScatter, node(i).meanAsymmetry) * all.again[last + i];
      sent.radiance.push_back(radiance);
      sent.depth.push_back(all.depth[last + i]);
    }
    return sent;
  }
  std::vector<double> meanOf(const WeightedLines& lines) const {
    std::vector<double> sum(count_, 0.0);
    for (const auto& [line, weight] : lines) {
      const Sent sent = along(line);
      for (std::size_t i = 0; i < count_; ++i) sum[i] += weight * (sent.radiance[i] + behind_[i] * std::exp(-sent.depth[i]));
    }
    return sum;
  }

 private:
  static std::vector<SpectralNode> nodesAt(const Atmosphere& air, std::span<const double> um) {
    std::vector<SpectralNode> nodes;
    for (std::size_t i = 0; i < um.size() + um.size() % 2; ++i) {
      const double w = um[std::min(i, um.size() - 1)];
      nodes.emplace_back();
      nodes.back().members = {{w, 1.0}};
      nodes.back().air = air.node(w);
    }
    return nodes;
  }

  std::size_t count_;
  std::vector<SpectralNode> nodes_;
  NodeAir air_;
  std::vector<double> irradiance_, behind_;
};

std::vector<AirStation> stationsOf(const Atmosphere& air, const AirRay& ray, std::span<const double> ranges_m) {
  return air.stationsAt(ray, withShellPlaces(air, ray, ranges_m));
}

class SkyAround final : public Surroundings {
 public:
  SkyAround(std::shared_ptr<const Atmosphere> air, const std::optional<Sun>& sun, const Spectrum& background, std::shared_ptr<const Material> ground,
            double ground_K, double earthRadius_m, bool sunlit)
      : Surroundings({std::begin(kHeights_m), std::end(kHeights_m)}, gridsFor(earthRadius_m, sunlit ? &*sun : nullptr)),
        air_(std::move(air)),
        sun_(sun),
        background_(background),
        ground_(std::move(ground)),
        ground_K_(ground_K),
        earthRadius_m_(earthRadius_m),
        lines_(grids().size()) {
    if (sunlit) legs_ = SunLegs::of(air_, sun_->toSun.z, earthRadius_m_);
    diffuse_ = DiffuseLight::of({air_, sunlit ? sun_ : std::nullopt, background_, ground_, ground_K_, earthRadius_m_}, kStreams);
  }

  std::vector<std::vector<double>> radiance(std::span<const double> um, std::size_t height) const override {
    const SkyAt sky(*air_, um, legs_ ? &*sun_ : nullptr, background_, diffuse_);
    const DirectionGrid& grid = grids()[height];
    const std::vector<double> falls = groundIrradiance(um, sky);
    const int half = grid.azimuths / 2;
    std::vector<std::vector<double>> own(um.size()), all(um.size());
    SameWay same;
    const std::vector<Line>& lines = linesAt(height);
    for (std::size_t n = 0; n < lines.size(); ++n) {
      const Line& line = lines[n];
      if (n % static_cast<std::size_t>(half + 1) == 0) same = {};
      const SkyAt::Sent sent = sky.along(line.sight, &same);
      for (std::size_t i = 0; i < um.size(); ++i) {
        double end = sky.behind(i);
        if (line.groundAngle_rad >= 0.0)
          end = ground_->emissivity(um[i], line.groundAngle_rad) * physics::planckRadiance(um[i], ground_K_) +
                ground_->reflectance(um[i], line.groundAngle_rad) / kPi * falls[i];
        own[i].push_back(sent.radiance[i] + end * std::exp(-sent.depth[i]));
      }
    }
    for (std::size_t i = 0; i < um.size(); ++i)
      for (int ring = 0; ring < grid.above + grid.below; ++ring)
        for (int a = 0; a < grid.azimuths; ++a) all[i].push_back(own[i][static_cast<size_t>(ring * (half + 1) + (a <= half ? a : grid.azimuths - a))]);
    return all;
  }

  void addTo(Fingerprint& f) const override {
    f.add(std::string_view("sky and ground")).add(legs_ != nullptr).add(ground_K_).add(earthRadius_m_);
    air_->addTo(f);
    if (legs_) f.add(sun_->toSun), pitviper::addTo(f, sun_->irradiance);
    pitviper::addTo(f, background_);
    pitviper::addTo(f, *ground_);
  }

 private:
  struct Line {
    Sightline sight;
    double groundAngle_rad;  ///< between it and the vertical where it meets the ground; below 0: it does not
  };

  static std::vector<DirectionGrid> gridsFor(double earthRadius_m, const Sun* sun) {
    std::vector<DirectionGrid> all;
    for (double h : kHeights_m) {
      DirectionGrid grid;
      if (sun) grid.turn_rad = std::atan2(sun->toSun.y, sun->toSun.x);
      else grid.azimuths = 1;
      grid.horizon_rad = -std::acos(earthRadius_m / (earthRadius_m + h));
      all.push_back(grid);
    }
    return all;
  }

  /// Of each ring, from the sun's azimuth on round to the opposite: the other side is the same.
  const std::vector<Line>& linesAt(std::size_t height) const {
    const std::lock_guard lock(busy_);
    std::vector<Line>& lines = lines_[height];
    if (!lines.empty()) return lines;
    const DirectionGrid& grid = grids()[height];
    for (int ring = 0; ring < grid.above + grid.below; ++ring)
      for (int a = 0; a <= grid.azimuths / 2; ++a)
        lines.push_back(lineTo(grid, ring, grid.direction(static_cast<size_t>(ring * grid.azimuths + a)), heights_m()[height]));
    return lines;
  }

  Line lineTo(const DirectionGrid& grid, int ring, const glm::dvec3& direction, double height_m) const {
    RaySun seen;
    if (legs_) seen = {sun_->toSun.z, glm::dot(direction, sun_->toSun)};
    const bool up = ring < grid.above;
    AirRay ray{height_m, direction.z, earthRadius_m_};
    if (up) return {{SunlitAir(*air_, ray, stationsOf(*air_, ray, kRanges_m), legs_.get(), seen), seen.cosScatter}, -1.0};
    // At the horizon itself a line just touches.
    const double range =
        std::min(physics::groundRange(height_m, direction.z - 1e-9, earthRadius_m_), std::sqrt(height_m * (height_m + 2.0 * earthRadius_m_)) + 1.0);
    std::vector<double> ranges;
    for (double part : kParts) ranges.push_back(part * std::max(range, 1e-3));
    const double sine = std::clamp(-((earthRadius_m_ + height_m) * direction.z + range) / earthRadius_m_, 0.0, 1.0);
    return {{SunlitAir(*air_, ray, stationsOf(*air_, ray, ranges), legs_.get(), seen), seen.cosScatter}, std::acos(sine)};
  }

  /// On the ground, of the sun and of the mean sky [W/(m2 um)].
  std::vector<double> groundIrradiance(std::span<const double> um, const SkyAt& sky) const {
    std::vector<double> all;
    if (ground_->reflections.empty()) return std::vector<double>(um.size(), 0.0);
    {
      const std::lock_guard lock(busy_);
      for (double w : um)
        if (const auto at = falls_.find(w); at != falls_.end()) all.push_back(at->second);
    }
    if (all.size() == um.size()) return all;
    all = sky.meanOf(skyLines());
    const RisenSun risen = legs_ ? risenSun(0.0, sun_->toSun.z, earthRadius_m_) : RisenSun{};
    for (std::size_t i = 0; i < um.size(); ++i) {
      all[i] *= kPi;
      if (legs_ && risen.share > 0.0)
        all[i] += sky.irradiance(i) * risen.share * std::max(risen.sinElevation, 0.0) * air_->transmittance(sky.node(i), legs_->at(0.0, risen.sinElevation));
    }
    const std::lock_guard lock(busy_);
    for (std::size_t i = 0; i < um.size(); ++i) falls_.try_emplace(um[i], all[i]);
    return all;
  }

  const WeightedLines& skyLines() const;

  std::shared_ptr<const Atmosphere> air_;
  std::optional<Sun> sun_;
  Spectrum background_;
  std::shared_ptr<const Material> ground_;
  double ground_K_, earthRadius_m_;
  std::shared_ptr<const SunLegs> legs_;
  std::shared_ptr<const DiffuseLight> diffuse_;
  mutable std::mutex busy_;
  mutable std::vector<std::vector<Line>> lines_;
  mutable std::map<double, double> falls_;
  mutable WeightedLines skyLines_;
};

/// Lines to the sky from height 0 with their weights, of sum 1, in its mean by the cosine to the zenith.
WeightedLines linesOfMean(const Atmosphere& air, const std::optional<Sun>& sun, const SunLegs* legs, double height_m, double earthRadius_m) {
  WeightedLines lines;
  for (const QuadratureNode& node : gaussLegendre(kElevations, 0.0, 1.0)) {
    const AirRay ray{height_m, node.x, earthRadius_m};
    const auto stations = stationsOf(air, ray, kRanges_m);
    const int azimuths = sun ? kAzimuths : 1;
    for (int a = 0; a < azimuths; ++a) {
      RaySun seen;
      if (sun) {
        const double across = std::sqrt((1.0 - node.x * node.x) * std::max(1.0 - sun->toSun.z * sun->toSun.z, 0.0));
        seen = {sun->toSun.z, node.x * sun->toSun.z + across * std::cos(kPi * (a + 0.5) / azimuths)};
      }
      lines.push_back({{SunlitAir(air, ray, stations, legs, seen), seen.cosScatter}, 2.0 * node.x * node.weight / azimuths});
    }
  }
  return lines;
}

const WeightedLines& SkyAround::skyLines() const {
  const std::lock_guard lock(busy_);
  if (skyLines_.empty()) skyLines_ = linesOfMean(*air_, legs_ ? sun_ : std::nullopt, legs_.get(), 0.0, earthRadius_m_);
  return skyLines_;
}

}  // namespace

Spectrum meanSky(const std::shared_ptr<const Atmosphere>& of, const std::optional<Sun>& sun, const Spectrum& background,
                 const std::shared_ptr<const Material>& ground, double ground_K, double height_m, double earthRadius_m) {
  Spectrum::Table table;
  table.name = "the sky of the air";
  table.wavelength_um = of->knots_um();
  const auto diffuse = DiffuseLight::of({of, sun, background, ground, ground_K, earthRadius_m}, kMeanStreams);
  const ContentKey key = diffuse ? contentKey("mean sky", diffuse->key()) : ContentKey{};
  if (const auto kept = diffuse ? readCachedTable(kMeanSky, key) : std::nullopt) {
    TableReader in(*kept);
    table.value = in.all<double>();
    if (!in.isWhole() || table.value.size() != table.wavelength_um.size()) table.value.clear();
  }
  if (table.value.empty()) {
    const auto legs = sun ? SunLegs::of(of, sun->toSun.z, earthRadius_m) : nullptr;
    table.value =
        SkyAt(*of, table.wavelength_um, sun ? &*sun : nullptr, background, diffuse).meanOf(linesOfMean(*of, sun, legs.get(), height_m, earthRadius_m));
    TableWriter out;
    out.all(table.value);
    if (diffuse) writeCachedTable(kMeanSky, key, out.bytes());
  }
  Spectrum sky(std::move(table));
  sky.setProvenance("mean of the sky of this scenario's air");
  return sky;
}

std::shared_ptr<const Surroundings> skyAndGround(std::shared_ptr<const Atmosphere> air, const std::optional<Sun>& sun, const Spectrum& background,
                                                 std::shared_ptr<const Material> ground, double ground_K, double earthRadius_m) {
  const bool sunlit = sun && air->traits().scattersSun && sun->toSun.z > kNight;
  return std::make_shared<SkyAround>(std::move(air), sun, background, std::move(ground), ground_K, earthRadius_m, sunlit);
}

}  // namespace pitviper
