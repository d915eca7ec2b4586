#include "materials/fields/jets.hpp"

#include <algorithm>
#include <cmath>
#include <list>
#include <mutex>
#include <stdexcept>

#include "sim/flight/standard_atmosphere.hpp"
#include "sim/model/simulation.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/fields/glsl/cuts.glsl"
#include "materials/fields/glsl/jet.glsl"
#undef PHYSICS

/// The shader's own text, in double.
class JetLine {
 public:
  explicit JetLine(const std::vector<glm::dvec4>& texels) : texels_(texels) {}
  Vec3 q_{0.0}, d_{1.0, 0.0, 0.0};
  Real perT_ = 1.0, enter_ = 0.0, leave_ = 0.0;
  Vec4 amountLow_{0.0};
  Real weight_ = 0.0, heat_ = 0.0;
  const Vec4& fieldTexel(int i) const { return texels_[static_cast<std::size_t>(i)]; }
#include "materials/fields/glsl/jets.field.glsl"

 private:
  const std::vector<glm::dvec4>& texels_;
};
}  // namespace physics

namespace {

constexpr double kGasConstant = 8.314462618;  // J/(mol K), CODATA 2018
constexpr double kAtmosphere_Pa = 101325.0;   // amounts of gases are per this
constexpr double kOutside = 2.63;             // exp(-2.63^2) = 0.001
constexpr double kFadedFrom = 0.8;            // of the length
constexpr double kFinestOfWidth = 0.5;        // of a Gaussian's width: what is hot of it is narrower than its gas
constexpr double kAlong = 0.3;                // of the way from the nozzle: over that it changes along itself
constexpr double kFirstPiece = 2.0;           // of a nozzle's radius; then each piece ends so much farther: lines lie closer together where it is finer
constexpr double kNextPiece = 1.6;
constexpr double kFirstAlong = 0.4;  // of a nozzle's radius: the same of the first, where it begins within one
constexpr double kFadeAlong = 0.5;   // of the stretch that it fades on: the same there
constexpr int kLooks = 64;
constexpr double kSlowedWithin = 60.0;        // diameters: behind that it is far colder than where it leaves
constexpr int kAcross = 24;                   // places across it that are looked at
constexpr double kBetween = 1.003;            // it is hotter between these by so much at most
constexpr int kCones = 4;              // jets.field.glsl
constexpr std::size_t kMostKept = 64;  // 4 s of a ramp at 15 frames a second; 10 kB each
constexpr double kHalf_s = 0.005;      // half of the time that a speed is told over: 1 g changes it by 0.1 m/s in twice that
constexpr double kPresenceSteps = 256.0, kThrottleSteps = 2000.0, kSpeedStep_m_s = 0.25, kHeightStep_m = 5.0;

glm::dmat3 axesAlong(const glm::dvec3& direction) {
  const glm::dvec3 x = glm::normalize(direction);
  // Beside whichever axis it is furthest from.
  const glm::dvec3 beside = std::abs(x.z) < 0.9 ? glm::dvec3(0.0, 0.0, 1.0) : glm::dvec3(0.0, 1.0, 0.0);
  const glm::dvec3 y = glm::normalize(glm::cross(beside, x));
  return {x, y, glm::cross(x, y)};
}

/// Radii at both ends of cones whose common inside holds a jet's outline: lines along the outline's upper hull.
std::array<glm::dvec2, kCones> boundsOf(const std::vector<glm::dvec2>& outline, double ramp_m, double length_m) {
  std::vector<glm::dvec2> hull;
  for (const glm::dvec2& p : outline) {
    while (hull.size() > 1) {
      const glm::dvec2 a = hull[hull.size() - 2], b = hull.back();
      if ((b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x) < 0.0) break;
      hull.pop_back();
    }
    hull.push_back(p);
  }
  const auto endsOf = [ramp_m, length_m](const glm::dvec2& a, const glm::dvec2& b) {
    const double slope = (b.y - a.y) / (b.x - a.x);
    return glm::dvec2(a.y - slope * (a.x + ramp_m), a.y + slope * (length_m - a.x));
  };
  std::array<glm::dvec2, kCones> cones;
  // Sides of the hull at even steps of the logarithm of x.
  for (int k = 0; k < kCones; ++k) {
    const double x = length_m * std::pow(0.02, 1.0 - (k + 0.5) / kCones);
    std::size_t i = 0;
    while (i + 2 < hull.size() && hull[i + 1].x < x) ++i;
    cones[static_cast<std::size_t>(k)] = hull.size() > 1 ? endsOf(hull[i], hull[i + 1]) : glm::dvec2(hull[0].y);
  }
  return cones;
}

bool isMolecule(Species s) { return s == Species::CO2 || s == Species::H2O || s == Species::CO; }

/// Molecules come in the proportions of the nozzle; particles each by itself, by density.
std::vector<int> mixturesOf(const std::vector<Species>& species) {
  std::vector<int> mixture;
  int next = std::any_of(species.begin(), species.end(), isMolecule) ? 1 : 0;
  for (Species s : species) mixture.push_back(isMolecule(s) ? 0 : next++);
  return mixture;
}

class JetsState : public FieldState {
 public:
  JetsState(const FreeJet& jet, double length_m, double presence, const std::vector<glm::dvec3>& nozzles, const std::vector<Species>& species)
      : mixture_(mixturesOf(species)), gases_(species.size()) {
    const JetConstants& k = jet.constants();
    length_m = std::min(length_m, k.length_m);
    const int count = static_cast<int>(nozzles.size());
    auto& t = own_;
    const double ramp = kJetRamp * k.radius_m;
    for (int j = 0; j < count; ++j) t.emplace_back(nozzles[static_cast<std::size_t>(j)], count - j);
    for (const glm::dvec3& nozzle : nozzles) source += nozzle / static_cast<double>(count);
    const double faded = kFadedFrom * length_m;
    t.emplace_back(k.radius_m, length_m, faded, 1.0 / (length_m - faded));
    t.emplace_back(1.0 / k.rowScale_m, 1.0 / k.rowLogRatio, k.coreLength_m, 1.0 / k.farLogRatio);
    t.emplace_back(k.coreRow, k.rowCount - 2, presence, count);
    t.emplace_back(k.ambientTemperature_K, k.excessSpeed_m_s, k.ambientSpeed_m_s, k.excessEnthalpy_J_kg - k.cpExcess_J_kgK * k.ambientTemperature_K);
    t.emplace_back(k.cp_J_kgK, k.cpExcess_J_kgK, k.moles_mol_kg, k.molesExcess_mol_kg);
    // Excess of a mole fraction: (a + b Z)/(m + n Z) - a/m = Z (b - a n/m)/(m + n Z). Density = pressure/(R T (m + n Z)).
    const double pressure_atm = k.pressure_Pa / kAtmosphere_Pa, perKelvin = k.pressure_Pa / kGasConstant, dilution = k.molesExcess_mol_kg / k.moles_mol_kg;
    glm::dvec4 moles(0.0), densities(0.0);
    for (std::size_t i = 0; i < species.size(); ++i) {
      (isMolecule(species[i]) ? moles : densities)[mixture_[i]] = 1.0;
      switch (species[i]) {
        case Species::CO2:
          share[i] = pressure_atm * std::max(0.0, k.co2Excess_mol_kg - k.co2_mol_kg * dilution);
          break;
        case Species::H2O:
          share[i] = pressure_atm * std::max(0.0, k.h2oExcess_mol_kg - k.h2o_mol_kg * dilution);
          break;
        case Species::CO:
          share[i] = pressure_atm * k.coExcess_mol_kg;
          break;
        case Species::Soot:
          share[i] = perKelvin * k.soot_m3_kg;
          break;
        case Species::Alumina:
          share[i] = perKelvin * k.alumina;
          break;
      }
    }
    t.push_back(moles);
    t.push_back(densities);
    const auto outlineAt = [](const JetRow& row) { return row.coreZ_m + kOutside * row.widthZ_m; };
    std::vector<glm::dvec2> outline{{-ramp, outlineAt(jet.rows().front())}};
    for (const JetRow& row : jet.rows()) {
      const double x = std::min(row.x_m, length_m);
      const JetRow here = x < row.x_m ? jet.at(x) : row;
      outline.emplace_back(x, outlineAt(here));
      if (row.x_m >= length_m) break;
    }
    const auto cones = boundsOf(outline, ramp, length_m);
    t.emplace_back(cones[0].x, cones[0].y, cones[1].x, cones[1].y);
    t.emplace_back(cones[2].x, cones[2].y, cones[3].x, cones[3].y);
    const double coreLength = std::min(k.coreLength_m, length_m);
    t.emplace_back(coreLength, jet.at(coreLength).coreZ_m, jet.at(0.0).coreZ_m, ramp);
    for (const JetRow& row : jet.rows()) t.emplace_back(row.x_m, row.shapeU, row.widthU_m, row.shapeZ);

    const auto radiusAt = [&](double x) {
      double radius = 1e300;
      for (const auto& c : cones) radius = std::min(radius, c.x + (c.y - c.x) * (x + ramp) / (length_m + ramp));
      return radius;
    };
    // The common inside of cones bulges: its widest place is at an end or where two of them cross.
    const auto widestIn = [&](double from, double to) {
      double wide = 0.0;
      for (int i = 0; i <= kLooks; ++i) wide = std::max(wide, radiusAt(from + (to - from) * i / kLooks));
      return wide * (1.0 + 2.0 / kLooks);
    };
    const double widest = widestIn(-ramp, length_m);
    std::vector<double> border{-ramp};
    for (double x = std::min(kFirstPiece * k.radius_m, length_m); border.back() < length_m; x = kNextPiece * x < 0.9 * length_m ? kNextPiece * x : length_m)
      border.push_back(x);
    const int pieces = static_cast<int>(border.size()) - 1;
    low = glm::dvec3(1e300), high = glm::dvec3(-1e300);
    for (int j = 0; j < count; ++j) {
      const glm::dvec3 at = nozzles[static_cast<std::size_t>(j)];
      low = glm::min(low, at - glm::dvec3(ramp, widest, widest));
      high = glm::max(high, at + glm::dvec3(length_m, widest, widest));
      for (int s = 0; s < pieces; ++s) {
        const double from = border[static_cast<std::size_t>(s)], to = border[static_cast<std::size_t>(s) + 1];
        double along = s == 0 ? kFirstAlong * k.radius_m : std::max(kFirstPiece * k.radius_m, kAlong * 0.5 * (from + to));
        if (to > faded) along = std::min(along, kFadeAlong * (length_m - faded));
        const double wide = widestIn(from, to), half = 0.5 * (to - from);
        elements.push_back({at + glm::dvec3(0.5 * (from + to), 0.0, 0.0), std::hypot(half, wide), j, kFinestOfWidth * jet.at(from).widthZ_m,
                            s * kFieldKinds / pieces, glm::dvec3(along, 0.0, 0.0), glm::dvec3(half, wide, wide)});
      }
    }
    finest_m = elements.front().finest_m;
    auto single = std::make_shared<FieldTexels>();
    for (const glm::dvec4& v : t) single->texel.emplace_back(v);
    texels = single;
    nozzles_ = count;
  }

  void along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const override {
    out.clear();
    physics::JetLine at(own_);
    at.q_ = (line.origin - origin) * localFromField;  // transposed: into field axes
    at.d_ = line.direction * localFromField;
    at.enter_ = physics::kFar, at.leave_ = -physics::kFar;
    int first = -1;
    for (int j = 0; j < nozzles_; ++j) {
      const glm::dvec2 chord = at.fieldChord(j);
      if (!(chord.y > chord.x)) continue;
      if (first < 0) first = j;
      at.enter_ = std::min(at.enter_, chord.x);
      at.leave_ = std::max(at.leave_, chord.y);
    }
    at.enter_ = std::max(at.enter_, line.nearest_m);
    at.leave_ = std::min(at.leave_, line.farthest_m);
    if (first < 0 || steps < 1 || !(at.leave_ > at.enter_)) return;
    at.fieldLine(first, steps);
    double from = at.enter_;
    for (int i = 0; i < steps; ++i) {
      const double to = at.fieldCut((i + 1.0) / steps);
      at.amountLow_ = glm::dvec4(0.0);
      at.weight_ = at.heat_ = 0.0;
      for (int j = 0; j < nozzles_; ++j) at.fieldAdd(j, from, to);
      if (at.weight_ > 0.0) {
        FieldStep step;
        step.enter_m = from;
        step.leave_m = to;
        for (std::size_t g = 0; g < gases_; ++g) step.amount[g] = share[g] * at.amountLow_[mixture_[g]];
        step.temperature_K = at.heat_ / at.weight_;
        out.push_back(step);
      }
      from = to;
    }
  }

 private:
  std::vector<glm::dvec4> own_;
  std::vector<int> mixture_;
  std::size_t gases_ = 0;
  int nozzles_ = 0;
};

}  // namespace

struct JetsSource::Kept {
  std::mutex mutex;
  std::list<std::pair<Conditions, std::shared_ptr<const JetsState>>> recent;  ///< the last used first
};

std::vector<Species> JetsSetup::species() const {
  // What an engine may have at any throttle; of a motor and a nozzle what is said.
  NozzleFlow flow;
  if (nozzle) flow = *nozzle;
  else if (engine)
    if (const auto full = nozzleOf(*engine, 1.0, CoFlow{})) flow = *full;
  std::vector<Species> all;
  if (flow.gas.co2 > 0.0) all.push_back(Species::CO2);
  if (flow.gas.h2o > 0.0) all.push_back(Species::H2O);
  if (flow.gas.co > 0.0) all.push_back(Species::CO);
  if (flow.sootMassFraction > 0.0) all.push_back(Species::Soot);
  if (flow.aluminaMassFraction > 0.0) all.push_back(Species::Alumina);
  return all;
}

CoFlow JetsSource::around(const Conditions& c) const {
  const StandardAir air = standardAir(static_cast<double>(c.height) * kHeightStep_m);
  CoFlow flow;
  flow.pressure_Pa = air.pressure_Pa;
  flow.temperature_K = air.temperature_K + setup_.airWarmer_K;
  flow.speed_m_s = static_cast<double>(c.speed) * kSpeedStep_m_s;
  return flow;
}

JetsSource::JetsSource(JetsSetup setup) : setup_(std::move(setup)), kept_(std::make_unique<Kept>()) {
  if (setup_.nozzles.empty() || setup_.nozzles.size() > kMostNozzles) throw std::invalid_argument("jets: 1 to 16 nozzles");
  if ((setup_.engine != nullptr) == setup_.nozzle.has_value()) throw std::invalid_argument("jets: an engine, or a nozzle");
  const double length = glm::length(setup_.direction);
  if (!std::isfinite(length) || !(length > 0.0)) throw std::invalid_argument("jets: their direction is none");
  bodyFromField_ = axesAlong(setup_.direction);
  for (const glm::dvec3& n : setup_.nozzles) places_.push_back((n - setup_.nozzles.front()) * bodyFromField_);
}

JetsSource::~JetsSource() = default;

std::vector<int> JetsSource::mixtures() const { return mixturesOf(setup_.species()); }

double JetsSource::askedThrottle(double time_s, const ThrottleSet& commanded) const {
  const std::optional<double> set = commanded ? commanded(time_s) : std::nullopt;
  return std::clamp(set ? *set : setup_.throttle.at(time_s), 0.0, 1.0);
}

double JetsSource::throttleAt(double time_s, const ThrottleSet& commanded) const {
  if (!setup_.life.has(time_s)) return 0.0;
  const double ignited_s = std::isfinite(setup_.life.begin_s) ? setup_.life.begin_s : 0.0;
  const double burning = setup_.engine ? burnThrottle(*setup_.engine, time_s - ignited_s) : 1.0;
  return burning > 0.0 ? burning * askedThrottle(time_s, commanded) : 0.0;
}

namespace {
/// The mean of something over the time kJetRise_s before, by its values in the middle of even parts.
template <class Value>
double meanBefore(double time_s, const Value& value) {
  constexpr int kParts = 20;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) sum += value(time_s - kJetRise_s * (i + 0.5) / kParts);
  return sum / kParts;
}
}  // namespace

double JetsSource::presenceAt(double time_s) const {
  if (setup_.life.isEndless()) return 1.0;
  return meanBefore(time_s, [this](double t) { return setup_.life.has(t) ? 1.0 : 0.0; });
}

std::optional<JetsSource::Conditions> JetsSource::conditionsAt(double time_s, double height_m, double speed_m_s, const ThrottleSet& commanded) const {
  Conditions c;
  const bool breathes = setup_.engine && setup_.engine->breathesAir();
  double throttle = 0.0, presence = 1.0;
  if (breathes) {  // comes and goes as a whole; its throttle is of the time that it is there
    presence = presenceAt(time_s);
    const double begin = setup_.life.begin_s, end = setup_.life.end_s;
    throttle = askedThrottle(std::clamp(time_s, begin, std::max(begin, end)), commanded);
  } else {
    throttle = meanBefore(time_s, [&](double t) { return throttleAt(t, commanded); });
  }
  c.throttle = std::llround(throttle * kThrottleSteps);
  c.presence = std::llround(presence * kPresenceSteps);
  c.speed = std::llround(std::max(speed_m_s, 0.0) / kSpeedStep_m_s);
  c.height = std::llround(height_m / kHeightStep_m);
  if (c.presence == 0 || (!breathes && c.throttle == 0)) return std::nullopt;
  return c;
}

std::optional<NozzleFlow> JetsSource::flowAt(const Conditions& c) const {
  if (setup_.engine) return nozzleOf(*setup_.engine, c.throttlePart(), around(c));
  NozzleFlow flow = *setup_.nozzle;
  flow.diameter_m *= std::sqrt(c.throttlePart());
  return flow;
}

std::shared_ptr<const FieldState> JetsSource::stateOf(const Conditions& c) const {
  const std::lock_guard lock(kept_->mutex);
  auto& recent = kept_->recent;
  const auto known = std::find_if(recent.begin(), recent.end(), [&](const auto& k) { return k.first == c; });
  if (known != recent.end()) {
    recent.splice(recent.begin(), recent, known);
    return recent.front().second;
  }
  std::shared_ptr<const JetsState> state;
  if (const auto flow = flowAt(c)) {
    const FreeJet jet(*flow, around(c));
    const double length_m = setup_.length_m > 0.0 ? setup_.length_m : JetsSetup::kUsualLength * flow->diameter_m;
    state = std::make_shared<JetsState>(jet, length_m, c.presencePart(), places_, setup_.species());
  }
  recent.emplace_front(c, state);
  if (recent.size() > kMostKept) recent.pop_back();
  return state;
}

std::size_t JetsSource::kept() const {
  const std::lock_guard lock(kept_->mutex);
  return kept_->recent.size();
}

std::shared_ptr<const FieldState> JetsSource::at(const FieldWorld& world) const {
  const double now = world.time_s;
  Pose pose;
  glm::dvec3 velocity(0.0);
  if (setup_.entity >= 0) {
    pose = world.poseAt(setup_.entity, now);
    // Where its motion begins or ends only one of the two tells its speed. Neither asks for the pose now, which a command may have set.
    const glm::dvec3 before = world.poseAt(setup_.entity, now - 2.0 * kHalf_s).position, middle = world.poseAt(setup_.entity, now - 1e-6 * kHalf_s).position,
                     after = world.poseAt(setup_.entity, now + 2.0 * kHalf_s).position;
    const glm::dvec3 past = (middle - before) / (2.0 * kHalf_s), coming = (after - middle) / (2.0 * kHalf_s);
    const auto moved = world.velocityNow ? world.velocityNow(setup_.entity) : std::nullopt;
    velocity = moved                                           ? *moved
               : glm::length(past) > 2.0 * glm::length(coming) ? past
               : glm::length(coming) > 2.0 * glm::length(past) ? coming
                                                               : 0.5 * (past + coming);
  }
  const glm::dmat3 localFromField = glm::mat3_cast(pose.orientation) * bodyFromField_;
  const glm::dvec3 origin = pose.position + glm::mat3_cast(pose.orientation) * setup_.nozzles.front();
  const Simulation& s = *world.simulation;
  const double speed = -glm::dot(velocity - s.wind_m_s, localFromField[0]);
  const auto conditions = conditionsAt(now, s.frame.toGeodetic(origin).height_m, speed, world.throttleAt);
  const auto there = conditions ? std::static_pointer_cast<const JetsState>(stateOf(*conditions)) : nullptr;
  if (!there) return nullptr;
  auto placed = std::make_shared<JetsState>(*there);
  placed->origin = origin;
  placed->localFromField = localFromField;
  return placed;
}

void JetsSource::addTo(Fingerprint& f) const {
  f.add("jets").add(setup_.entity).all(setup_.nozzles).add(setup_.direction).add(setup_.engine ? setup_.engine->name : "");
  if (setup_.nozzle) {
    const NozzleFlow& n = *setup_.nozzle;
    for (double v : {n.diameter_m, n.temperature_K, n.speed_m_s, n.gas.co2, n.gas.h2o, n.gas.co, n.gas.oxygen, n.gasMolarMass_kg_mol, n.specificHeat_J_kgK,
                     n.sootMassFraction, n.aluminaMassFraction})
      f.add(v);
  }
  pitviper::addTo(f, setup_.throttle);
  f.add(setup_.life.begin_s).add(setup_.life.end_s).add(setup_.length_m).add(setup_.airWarmer_K);
}

namespace {
/// Of a jet: where a fast one is slowed down it is hotter than where it leaves.
double hottest_K(const NozzleFlow& flow, const CoFlow& around) {
  const FreeJet jet(flow, around, kSlowedWithin * flow.diameter_m);
  double hottest = flow.temperature_K;
  for (const JetRow& row : jet.rows())
    for (int i = 0; i <= kAcross; ++i)
      hottest = std::max(hottest, jetState(jet.constants(), row, row.coreU_m + 2.0 * row.widthU_m * i / kAcross).temperature_K);
  return kBetween * hottest;
}
}  // namespace

glm::dvec2 JetsSource::temperatures_K() const {
  // The tropopause's air; the hottest of a preset's exits and of what follows, over the heights and speeds that it may meet (a motor's at a low throttle is
  // the hottest). In still air it is slowed down most.
  glm::dvec2 range(216.65, 216.65);
  const auto take = [&range](const NozzleFlow& flow, const CoFlow& around) {
    range.y = std::max(range.y, hottest_K(flow, around));
    range.x = std::min(range.x, flow.temperature_K);
  };
  const auto at = [](double throttle, double height_m, double speed_m_s) {
    Conditions c;
    c.throttle = std::llround(throttle * kThrottleSteps);
    c.height = std::llround(height_m / kHeightStep_m);
    c.speed = std::llround(speed_m_s / kSpeedStep_m_s);
    return c;
  };
  if (setup_.nozzle) {
    for (double height_m : {0.0, 11000.0}) take(*setup_.nozzle, around(at(1.0, height_m, 0.0)));
    return range;
  }
  // Whatever its own course is, a command may set any throttle of an engine.
  const bool commanded = setup_.engine->breathesAir();
  const glm::dvec2 own(setup_.throttle.range().first, setup_.throttle.range().second);
  const double least = commanded ? 0.0 : own.x, most = commanded ? 1.0 : own.y;
  for (double throttle : {std::clamp(least, 0.0, 1.0), std::clamp(most, 0.0, 1.0)})
    for (double height_m : {0.0, 11000.0})
      for (double speed_m_s : {0.0, 300.0, 600.0}) {
        const Conditions c = at(throttle, height_m, speed_m_s);
        if (const auto flow = flowAt(c)) take(*flow, around(c));
      }
  // Phases of a burn.
  for (const BurnPhase& phase : setup_.engine->burn)
    if (const auto flow = nozzleOf(*setup_.engine, std::clamp(phase.throttle * most, 0.0, 1.0), CoFlow{})) take(*flow, CoFlow{});
  return range;
}

}  // namespace pitviper
