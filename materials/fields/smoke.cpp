#include "materials/fields/smoke.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/flight/standard_atmosphere.hpp"
#include "sim/model/store.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

constexpr double kGravity_m_s2 = 9.80665, kHeat_J_kgK = 1004.7;  ///< of dry air
constexpr double kLapse_K_m = 0.0065;                            ///< US Standard Atmosphere 1976, troposphere
constexpr double kEntrainment = 0.6;                             ///< b
constexpr double kSlowest_m_s = 1.0;                             ///< U
constexpr double kAlpha = 0.65518535;                            ///< 1.5 (0.5/6)^(1/3)

double cubed(double x) { return x * x * x; }

struct Origin {
  glm::dvec3 place{0.0}, velocity{0.0};
  glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
};

Origin originOf(const SmokeOptions& o, const FieldWorld& world, double time_s) {
  Origin at;
  if (o.entity >= 0) {
    const Pose pose = world.poseAt(o.entity, time_s);
    at = {pose.position, velocityOf(*world.simulation, o.entity, time_s), pose.orientation};
  } else if (o.path) {
    const Pose pose = o.path->at(time_s);
    at = {pose.position, o.path->velocityAt(time_s), pose.orientation};
  }
  at.place += at.orientation * o.position;
  return at;
}

}  // namespace

double mixedSigma_m(double sigma0_m, double age_s, double dissipation_m2_s3, double diffusivity_m2_s) {
  if (!(age_s > 0.0)) return sigma0_m;
  const double rate = kAlpha * std::cbrt(dissipation_m2_s3);  // d sigma/da = rate sigma^(1/3)
  // Where rate sigma^(4/3) is K.
  const double turn_m = rate > 0.0 ? std::pow(diffusivity_m2_s / rate, 0.75) : 0.0;
  double from_m = sigma0_m, left_s = age_s;
  if (turn_m > sigma0_m) {
    const double start = std::cbrt(sigma0_m * sigma0_m), turn_s = (std::cbrt(turn_m * turn_m) - start) / (2.0 / 3.0 * rate);
    if (age_s <= turn_s) return std::pow(start + 2.0 / 3.0 * rate * age_s, 1.5);
    from_m = turn_m;
    left_s = age_s - turn_s;
  }
  return std::sqrt(from_m * from_m + 2.0 * (rate > 0.0 ? diffusivity_m2_s : 0.0) * left_s);
}

SmokeSource::SmokeSource(SmokeOptions options) : options_(std::move(options)) {
  if (!(options_.radius_m > 0.0)) throw std::invalid_argument("smoke without a radius");
  if (!(options_.lifetime_s > 0.0)) throw std::invalid_argument("smoke without a lifetime");
  if (options_.mostPuffs < 1) throw std::invalid_argument("smoke without puffs");
}

SmokeParcel SmokeSource::parcel(const FieldWorld& world, double released_s) const {
  const SmokeOptions& o = options_;
  const double age = std::max(world.time_s - released_s, 0.0), r0 = o.radius_m;
  const Origin from = originOf(o, world, released_s);
  const glm::dvec3 throughAir = from.velocity - o.wind_m_s;
  const glm::dvec3 leaves = o.share * throughAir + from.orientation * o.blown_m_s;
  const double height_m = world.simulation ? world.simulation->frame.altitude(from.place) : from.place.z;
  const double air_K = standardAir(height_m).temperature_K + o.airWarmer_K, hot_K = std::max(o.temperature_K, air_K);

  SmokeParcel p;
  p.place = from.place + age * o.wind_m_s;
  double variance = std::pow(mixedSigma_m(0.5 * r0, age, o.dissipation_m2_s3, o.diffusivity_m2_s), 2);
  if (const double u = glm::length(leaves); u > 0.0) {
    const double jet_m = std::cbrt(cubed(r0) + 3.0 * kEntrainment * r0 * r0 * u * age);
    p.place += (jet_m - r0) / kEntrainment / u * leaves;
    variance += 0.25 * (jet_m * jet_m - r0 * r0);
  }
  if (o.rises && hot_K > air_K) {
    const double past = glm::length(throughAir), out = glm::length(o.blown_m_s);
    const double buoyancy = kGravity_m_s2 * r0 * r0 * (1.0 - air_K / hot_K) * (out > 0.0 ? out : past) / std::max(past, kSlowest_m_s);
    const double stability = kGravity_m_s2 / air_K * (kGravity_m_s2 / kHeat_J_kgK - kLapse_K_m);
    const double turned = std::min(std::sqrt(stability) * age, kPi), half = std::sin(0.5 * turned);  // 1 - cos x = 2 sin^2(x/2): no cancellation
    const double start = r0 / kEntrainment;
    const double rise_m = std::cbrt(cubed(start) + 6.0 * buoyancy * half * half / (kEntrainment * kEntrainment * stability)) - start;
    p.place.z += rise_m;
    const double r = r0 + kEntrainment * rise_m;
    variance += 0.25 * (r * r - r0 * r0);
  }
  p.sigma_m = std::sqrt(variance);
  p.temperature_K = air_K + (hot_K - air_K) * 0.25 * r0 * r0 / variance;
  const double fades_s = o.fadeShare * o.lifetime_s, x = fades_s > 0.0 ? std::clamp((age - o.lifetime_s + fades_s) / fades_s, 0.0, 1.0) : age > o.lifetime_s;
  p.left = (1.0 - x) * (1.0 - x) * (1.0 + 2.0 * x);
  return p;
}

double SmokeSource::released_kg(double from_s, double to_s) const {
  const TimeCourse& rate = options_.rate_kg_s;
  from_s = std::max(from_s, options_.begin_s);
  to_s = std::min(to_s, options_.end_s);
  if (!(to_s > from_s)) return 0.0;
  std::vector<double> at{from_s};
  if (!rate.isConstant())
    for (double bend : rate.bends_s(from_s, to_s))
      if (bend > at.back() && bend < to_s) at.push_back(bend);
  at.push_back(to_s);
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < at.size(); ++k) {  // two Gauss points: exact for the cubics that a course is made of
    const double middle = 0.5 * (at[k] + at[k + 1]), half = 0.5 * (at[k + 1] - at[k]), apart = half * 0.57735026918962576;
    sum += half * (rate.at(middle - apart) + rate.at(middle + apart));
  }
  return sum;
}

/// The pieces of a trail at a time.
struct SmokeSource::Trail {
  const SmokeSource& smoke;
  const FieldWorld& world;
  double oldest_s, youngest_s;
  glm::dvec3 head{0.0}, tail{0.0};
  double coarse = 1.0;  ///< factor on all lengths that pieces are held against
  std::size_t most = 0;
  std::vector<Puff> puffs = {};

  // Figures of the header, but: halves of R in a piece's length keep round puffs even, a quarter of s keeps those drawn out between the ends of the trail.
  static constexpr double kLongest = 12.0, kOfWay = 0.25, kBend = 0.15, kPiece = 0.5;
  static constexpr double kGrowth = 1.25;  // of the radius within a piece
  static constexpr double kOfLife = 1.0 / 10.0;
  static constexpr double kNone_s = 1e-9;
  static constexpr double kShortest_s = 1e-5;  // nothing moves a tenth of a finest radius within it

  SmokeParcel at(double t) const { return smoke.parcel(world, t); }

  /// Gives a puff its axis and half-length.
  void draw(double t, const SmokeParcel& p, Puff& puff) const {
    const double r = p.radius_m();
    puff.centre = p.place;
    puff.radius_m = puff.halfLength_m = r;
    const double h = std::min((youngest_s - oldest_s) / 512.0, std::max(0.25 * (youngest_s - t), kShortest_s)), before = std::max(t - h, oldest_s),
                 after = std::min(t + h, youngest_s);
    if (!(after > before)) return;
    const glm::dvec3 velocity = (at(after).place - at(before).place) / (after - before);
    const double speed = glm::length(velocity), way = std::min(kOfWay * coarse, 1.0) * std::min(glm::length(p.place - head), glm::length(p.place - tail));
    double longest = way > 0.0 ? way / std::hypot(1.0, way / (kLongest * coarse * r)) : 0.0;
    if (!(speed > 0.0)) return;
    puff.axis = velocity / speed;
    for (int k = 0; k < 4 && longest > r; ++k) {  // a corner takes more than one step
      const double apart = std::min({longest / speed, t - oldest_s, youngest_s - t});
      const double bend = 0.5 * glm::length(at(t + apart).place + at(t - apart).place - 2.0 * p.place);
      if (bend <= kBend * coarse * r) break;
      longest *= std::sqrt(kBend * coarse * r / bend);
    }
    puff.halfLength_m = std::max(longest, r);
  }

  bool isFine(double from, double to, const SmokeParcel& a, const SmokeParcel& b, const SmokeParcel& middle, const Puff& puff) const {
    if (to - from <= kShortest_s) return true;
    if (to - from > kOfLife * coarse * smoke.options_.lifetime_s) return false;
    if (glm::length(b.place - a.place) > kPiece * std::max(kOfWay * coarse, 1.0) * puff.halfLength_m) return false;
    if (std::max(a.sigma_m, b.sigma_m) > (1.0 + (kGrowth - 1.0) * coarse) * std::min(a.sigma_m, b.sigma_m)) return false;
    return 0.5 * glm::length(a.place + b.place - 2.0 * middle.place) <= kBend * coarse * middle.radius_m();
  }

  /// A cell of the grid in time, as far as it lies within the trail. False: too many pieces.
  bool cut(double cellFrom, double cellTo, double from, double to, const SmokeParcel& a, const SmokeParcel& b) {
    if (!(to - from > kNone_s)) return true;  // the trail ends on the grid, but for rounding: no half of what is left lies within it
    const double half = 0.5 * (cellFrom + cellTo);
    if (half <= from || half >= to) return half <= from ? cut(half, cellTo, from, to, a, b) : cut(cellFrom, half, from, to, a, b);
    const double middle = 0.5 * (from + to);
    const SmokeParcel p = at(middle);
    Puff puff;
    draw(middle, p, puff);
    if (isFine(from, to, a, b, p, puff)) {
      puff.amount[0] = p.left * smoke.released_kg(from, to);
      puff.temperature_K = p.temperature_K;
      // A row of puffs d apart is as even gas of a variance d^2/12 less: with that back, what is cut finer and coarser meets without a step.
      const glm::dvec3 own = b.place - a.place;
      puff.halfLength_m = std::sqrt(puff.halfLength_m * puff.halfLength_m + kPuffSupport * kPuffSupport / 12.0 * glm::dot(own, own));
      if (puff.amount[0] > 0.0) puffs.push_back(puff);
      return puffs.size() <= most;
    }
    const SmokeParcel cutAt = at(half);
    return cut(half, cellTo, half, to, cutAt, b) && cut(cellFrom, half, from, half, a, cutAt);  // youngest first
  }

  void build() {
    const SmokeParcel a = at(oldest_s), b = at(youngest_s);
    head = b.place;
    tail = a.place;
    double length_s = 1.0;
    const double begin_s = smoke.options_.begin_s;
    while (length_s < youngest_s - begin_s) length_s *= 2.0;
    while (length_s > 2.0 * (youngest_s - begin_s)) length_s *= 0.5;
    most = static_cast<std::size_t>(smoke.options_.mostPuffs);
    for (;;) {
      puffs.clear();
      if (cut(begin_s, begin_s + length_s, oldest_s, youngest_s, a, b)) return;
      coarse *= 1.3;
      if (coarse > 1e3) return;  // 400 pieces then: a trail of any kind fits into fewer at lengths of a thousand radii
    }
  }
};

std::shared_ptr<const FieldState> SmokeSource::at(const FieldWorld& world) const {
  if (options_.store >= 0) {
    const auto flies = world.ejected ? world.ejected(options_.store) : nullptr;
    if (!flies) return nullptr;
    SmokeOptions its = options_;
    its.store = -1;
    its.path = flies->path;
    its.begin_s = flies->lit_s;
    its.end_s = flies->out_s;
    return SmokeSource(its).at(world);
  }
  const double youngest = std::min(world.time_s, options_.end_s), oldest = std::max(options_.begin_s, world.time_s - options_.lifetime_s);
  if (!(youngest - oldest > Trail::kNone_s)) return nullptr;
  Trail trail{*this, world, oldest, youngest};
  trail.build();
  std::vector<Puff>& puffs = trail.puffs;
  if (puffs.empty()) return nullptr;
  if (world.simulation && world.simulation->sun && world.sunAt) {
    // Shadows of bodies at every so-manyth piece, straight between: rays cost more than pieces.
    constexpr std::size_t kAsked = 48;
    const std::size_t apart = (puffs.size() + kAsked - 1) / kAsked;
    for (std::size_t k = 0; k < puffs.size(); k += apart) puffs[k].sun = world.sunAt(puffs[k].centre);
    for (std::size_t k = 0; k < puffs.size(); ++k) {
      const std::size_t low = k / apart * apart, high = low + apart;
      const double share = static_cast<double>(k - low) / static_cast<double>(apart);
      puffs[k].sun = puffs[low].sun + (high < puffs.size() ? share * (puffs[high].sun - puffs[low].sun) : 0.0);
    }
    shadeTowards(world.simulation->sun->toSun, puffs);
  }
  return std::make_shared<PuffsState>(std::move(puffs));
}

void SmokeSource::addTo(Fingerprint& f) const {
  const auto& [entity, store, path, position, rate_kg_s, begin_s, end_s, radius_m, temperature_K, blown_m_s, share, rises, dissipation_m2_s3, diffusivity_m2_s,
               lifetime_s, fadeShare, mostPuffs, wind_m_s, airWarmer_K] = options_;
  f.add("smoke")
      .add(entity)
      .add(store)
      .add(path != nullptr)
      .add(position)
      .add(begin_s)
      .add(end_s)
      .add(radius_m)
      .add(temperature_K)
      .add(blown_m_s)
      .add(share)
      .add(rises);
  f.add(dissipation_m2_s3).add(diffusivity_m2_s).add(lifetime_s).add(fadeShare).add(mostPuffs).add(wind_m_s).add(airWarmer_K);
  pitviper::addTo(f, rate_kg_s);
  if (path) path->addTo(f);
}

glm::dvec2 SmokeSource::temperatures_K() const {
  // The standard atmosphere's coldest is 187 K, its warmest 320 K at -5 km.
  return {187.0 + std::min(options_.airWarmer_K, 0.0), std::max(options_.temperature_K, 320.7 + std::max(options_.airWarmer_K, 0.0))};
}

}  // namespace pitviper
