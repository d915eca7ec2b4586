// Jets as fields: what lies along a line against a fine sum through the jet's own profiles, steps, what is kept, how they come and go.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "materials/fields/gas_levels.hpp"
#include "materials/fields/jets.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/model/simulation.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper::test {
namespace {

JetsSetup engineSetup(const char* name) {
  JetsSetup s;
  s.engine = findEnginePreset(name);
  s.life.begin_s = 0.0;
  return s;
}

/// A jet as the field has it, and as FreeJet has it.
struct Pair {
  explicit Pair(const JetsSetup& setup, double speed_m_s, double height_m = 0.0)
      : source(setup),
        conditions(*source.conditionsAt(1.0, height_m, speed_m_s)),
        flow(*source.flowAt(conditions)),
        around(source.around(conditions)),
        jet(flow, around),
        state(source.stateOf(conditions)),
        length_m(state->high.x) {}
  JetsSource source;
  JetsSource::Conditions conditions;
  NozzleFlow flow;
  CoFlow around;
  FreeJet jet;
  std::shared_ptr<const FieldState> state;
  double length_m;
};

/// Sent at 4.3 um by a thin gas more than by air, in any unit.
double excessSent(double temperature_K, double air_K) { return physics::planckRadiance(4.3, temperature_K) - physics::planckRadiance(4.3, air_K); }

struct Sums {
  double co2 = 0.0, soot = 0.0, sent = 0.0, fourth = 0.0;
};

Sums ofSteps(const std::vector<FieldStep>& steps, double air_K) {
  Sums s;
  for (const FieldStep& f : steps) {
    s.co2 += f.amount[0];
    s.soot += f.amount[3];
    s.sent += f.amount[0] * excessSent(f.temperature_K, air_K);
    s.fourth += f.amount[0] * (std::pow(f.temperature_K, 4) - std::pow(air_K, 4));
  }
  return s;
}

/// What there is of a jet around its nozzle's plane: kJetRamp.
double begunAt(double x_m, double ramp_m) {
  const double begun = std::clamp(0.5 * (x_m + ramp_m) / ramp_m, 0.0, 1.0);
  return begun * begun * (3.0 - 2.0 * begun);
}

/// Even midpoints through stateAt(), 10000 of them where a line is within `wide_m` of the axis: some hundredths of the nozzle's radius each.
Sums fine(const Pair& p, const FieldLine& line, double wide_m) {
  constexpr int kPoints = 10000;
  const glm::dvec3 o = line.origin, d = line.direction;
  const double ramp = kJetRamp * p.jet.constants().radius_m;
  double from = 0.0, to = 1e6;
  if (std::abs(d.x) > 1e-12) {
    const double a = (-ramp - o.x) / d.x, b = (p.length_m - o.x) / d.x;
    from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
  }
  const double across = d.y * d.y + d.z * d.z;
  if (across > 1e-12) {
    const double nearest = -(o.y * d.y + o.z * d.z) / across, y = o.y + nearest * d.y, z = o.z + nearest * d.z, left = wide_m * wide_m - y * y - z * z;
    if (!(left > 0.0)) return {};
    from = std::max(from, nearest - std::sqrt(left / across)), to = std::min(to, nearest + std::sqrt(left / across));
  }
  Sums s;
  if (!(to > from)) return s;
  const double step = (to - from) / kPoints;
  for (int i = 0; i < kPoints; ++i) {
    const glm::dvec3 q = o + (from + (i + 0.5) * step) * d;
    const JetState there = p.jet.stateAt(std::max(q.x, 0.0), std::hypot(q.y, q.z));
    const double left = std::clamp((p.length_m - q.x) / (0.2 * p.length_m), 0.0, 1.0);
    if (left < 1.0) continue;  // lines of these tests stay before the fade
    const double present = begunAt(q.x, ramp);
    const double co2 = present * (there.co2_Pa - p.around.co2 * p.around.pressure_Pa) / 101325.0 * step;
    s.co2 += co2;
    s.soot += present * there.sootVolumeFraction * step;
    s.sent += co2 * excessSent(there.temperature_K, p.around.temperature_K);
    s.fourth += co2 * (std::pow(there.temperature_K, 4) - std::pow(p.around.temperature_K, 4));
  }
  return s;
}

/// Lines of a kind, each within the first 0.75 of the length.
std::vector<FieldLine> linesOf(const Pair& p, const std::string& kind, int count) {
  std::mt19937 random(7);
  const auto between = [&random](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::vector<FieldLine> lines;
  const double d = p.flow.diameter_m;
  while (static_cast<int>(lines.size()) < count) {
    glm::dvec3 at(0.0), way(0.0, 0.0, 1.0);
    double back = 5.0 * p.length_m;
    if (kind == "side, near") {
      at = {between(0.0, 3.0 * d), between(-0.7 * d, 0.7 * d), 0.0};
    } else if (kind == "side") {
      at.x = between(3.0 * d, 0.7 * p.length_m);
      const JetRow row = p.jet.at(at.x);
      at.y = between(-1.0, 1.0) * (row.coreZ_m + row.widthZ_m);
    } else if (kind == "oblique") {
      at.x = between(0.0, 0.3 * p.length_m);
      const JetRow row = p.jet.at(at.x);
      at.y = between(-1.0, 1.0) * (row.coreZ_m + row.widthZ_m);
      const double angle = between(0.3, 2.8);
      way = {std::cos(angle), 0.0, std::sin(angle)};
    } else {  // along the axis out of the nozzle, left before the fade
      at = {0.0, between(-0.4 * d, 0.4 * d), between(-0.4 * d, 0.4 * d)};
      const double angle = between(0.0, 0.01);
      way = {std::cos(angle), std::sin(angle), 0.0};
      back = 1.0;
    }
    FieldLine line{at - back * way, way, 0.0, 10.0 * p.length_m};
    if (kind == "along") line.farthest_m = back + 0.7 * p.length_m;
    lines.push_back(line);
  }
  return lines;
}

struct Case {
  const char* engine;
  double speed_m_s, height_m;
};
constexpr Case kCases[] = {
    {"turbofan_military", 0.0, 0.0}, {"turbofan_afterburner", 250.0, 9000.0}, {"turboshaft", 40.0, 0.0}, {"double_base_motor", 400.0, 3000.0}};

// The amounts that lines pass and what they would send thinly at 4.3 um, against the fine sum through FreeJet::stateAt(). Bounds: twice what was measured
// when this was written (printed), of the sum over 60 lines each way; single lines near the jet's edge, which count for little, are further off.
TEST(Jets, LinesPassWhatTheFreeJetHolds) {
  struct Bound {
    int steps;
    double amount, sent;
  };
  constexpr Bound kBounds[] = {{8, 0.04, 0.16}, {10, 0.03, 0.14}, {16, 0.01, 0.04}, {32, 0.003, 0.007}, {64, 0.001, 0.002}};
  for (const Case& c : kCases) {
    const Pair p(engineSetup(c.engine), c.speed_m_s, c.height_m);
    const JetRow last = p.jet.at(p.length_m);
    for (const char* kind : {"side, near", "side", "oblique", "along"}) {
      const auto lines = linesOf(p, kind, 60);
      std::array<Sums, std::size(kBounds)> ours{};
      Sums truth;
      for (const FieldLine& line : lines) {
        FieldLine cut = line;
        // Oblique lines end where it begins to fade.
        const double x = line.origin.x, dx = line.direction.x;
        if (std::string(kind) == "oblique" && dx > 0.0) cut.farthest_m = (0.8 * p.length_m - x) / dx;
        if (std::string(kind) == "oblique" && dx < 0.0) cut.nearest_m = (0.8 * p.length_m - x) / dx;
        Sums f;
        {
          FieldLine whole = cut;
          whole.origin += cut.nearest_m * cut.direction;
          f = fine(p, whole, 5.0 * last.widthZ_m);
          if (std::string(kind) == "along") {  // fine() goes to the fade; lines to 0.7
            f = Sums{};
            constexpr int kPoints = 10000;
            const double ramp = kJetRamp * p.jet.constants().radius_m, before = ramp / cut.direction.x, step = (0.7 * p.length_m + before) / kPoints;
            for (int i = 0; i < kPoints; ++i) {
              const glm::dvec3 q = cut.origin + (1.0 - before + (i + 0.5) * step) * cut.direction;
              const JetState there = p.jet.stateAt(std::max(q.x, 0.0), std::hypot(q.y, q.z));
              const double present = begunAt(q.x, ramp), co2 = present * (there.co2_Pa - p.around.co2 * p.around.pressure_Pa) / 101325.0 * step;
              f.co2 += co2, f.soot += present * there.sootVolumeFraction * step;
              f.sent += co2 * excessSent(there.temperature_K, p.around.temperature_K);
              f.fourth += co2 * (std::pow(there.temperature_K, 4) - std::pow(p.around.temperature_K, 4));
            }
          }
        }
        truth.co2 += f.co2, truth.soot += f.soot, truth.sent += f.sent, truth.fourth += f.fourth;
        for (std::size_t b = 0; b < std::size(kBounds); ++b) {
          std::vector<FieldStep> steps;
          p.state->along(cut, kBounds[b].steps, steps);
          const Sums s = ofSteps(steps, p.around.temperature_K);
          ours[b].co2 += s.co2, ours[b].soot += s.soot, ours[b].sent += s.sent, ours[b].fourth += s.fourth;
        }
      }
      ASSERT_GT(truth.sent, 0.0);
      std::cout << c.engine << ", " << kind << ":";
      for (std::size_t b = 0; b < std::size(kBounds); ++b) {
        const double amount = ours[b].co2 / truth.co2 - 1.0, sent = ours[b].sent / truth.sent - 1.0, fourth = ours[b].fourth / truth.fourth - 1.0;
        std::printf(" %d steps %+.4f %+.4f %+.4f;", kBounds[b].steps, amount, sent, fourth);
        EXPECT_NEAR(amount, 0.0, kBounds[b].amount) << c.engine << ", " << kind << ", " << kBounds[b].steps;
        EXPECT_NEAR(sent, 0.0, kBounds[b].sent) << c.engine << ", " << kind << ", " << kBounds[b].steps;
        EXPECT_NEAR(fourth, 0.0, kBounds[b].sent) << c.engine << ", " << kind << ", " << kBounds[b].steps;
        if (p.flow.sootMassFraction > 0.0) {
          EXPECT_NEAR(ours[b].soot / truth.soot, 1.0, kBounds[b].amount) << c.engine << ", " << kind << ", " << kBounds[b].steps;
        }
      }
      std::cout << std::endl;
    }
  }
}

// Steps rise without a gap from where the line meets the jet to where it leaves it, and end at what the line is asked for.
TEST(Jets, StepsAdjoinAndStayWithinTheLine) {
  const Pair p(engineSetup("turbofan_afterburner"), 200.0);
  for (const FieldLine& line : linesOf(p, "oblique", 40))
    for (double share : {0.3, 0.5, 1.0}) {
      std::vector<FieldStep> whole, steps;
      p.state->along(line, 12, whole);
      ASSERT_GE(whole.size(), 2u);
      FieldLine part = line;
      part.nearest_m = whole.front().enter_m + 0.2 * (whole.back().leave_m - whole.front().enter_m);
      part.farthest_m = part.nearest_m + share * 0.8 * (whole.back().leave_m - whole.front().enter_m);
      p.state->along(part, 12, steps);
      for (std::size_t i = 0; i < steps.size(); ++i) {
        EXPECT_GT(steps[i].leave_m, steps[i].enter_m);
        EXPECT_GE(steps[i].enter_m, part.nearest_m - 1e-9 * part.nearest_m);
        EXPECT_LE(steps[i].leave_m, part.farthest_m + 1e-9 * part.farthest_m);
        if (i > 0) {
          EXPECT_DOUBLE_EQ(steps[i].enter_m, steps[i - 1].leave_m);
        }
        EXPECT_GT(steps[i].temperature_K, 0.5 * p.around.temperature_K);
        EXPECT_LT(steps[i].temperature_K, p.flow.temperature_K * 1.001);
      }
    }
}

// The box and the spheres hold all that lines meet; beside them there is nothing.
TEST(Jets, NothingIsOutsideItsBounds) {
  JetsSetup setup = engineSetup("turbofan_military");
  setup.nozzles = {{0.0, 0.5, 0.0}, {0.0, -0.5, 0.0}};
  const Pair p(setup, 100.0);
  const FieldState& s = *p.state;
  std::mt19937 random(3);
  const auto between = [&random](double a, double b) { return std::uniform_real_distribution<>(a, b)(random); };
  std::size_t met = 0;
  for (int n = 0; n < 3000; ++n) {
    const glm::dvec3 at(between(-5.0, 1.2 * s.high.x), between(-2.0, 2.0) * s.high.y, between(-2.0, 2.0) * s.high.z);
    const glm::dvec3 way = glm::normalize(glm::dvec3(between(-1, 1), between(-1, 1), between(-1, 1)));
    std::vector<FieldStep> steps;
    s.along({at - 1000.0 * way, way, 0.0, 2000.0}, 10, steps);
    for (const FieldStep& f : steps)
      for (double t : {f.enter_m, f.leave_m}) {
        const glm::dvec3 q = at + (t - 1000.0) * way;
        ++met;
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(q, s.low - 1e-6)) && glm::all(glm::lessThanEqual(q, s.high + 1e-6)));
        bool inElement = false;
        for (const FieldElement& e : s.elements)
          inElement = inElement || (glm::length(q - e.centre) <= e.radius_m * (1.0 + 1e-9) &&
                                    glm::all(glm::lessThanEqual(glm::abs(q - e.centre), e.half_m * (1.0 + 1e-9) + 1e-9)));
        EXPECT_TRUE(inElement);
      }
  }
  EXPECT_GT(met, 1000u);
}

// Rationale: tables reach as hot as a source says; where a fast jet is slowed down it is hotter than where it leaves.
TEST(Jets, AreNeverHotterThanTheySay) {
  for (const char* engine : {"turbofan_afterburner", "aluminised_motor", "reduced_smoke_motor", "double_base_motor"}) {
    const Pair p(engineSetup(engine), 0.0);
    const glm::dvec2 range = p.source.temperatures_K();
    double hottest = 0.0;
    std::vector<FieldStep> steps;
    for (int k = 0; k < 40; ++k) {
      p.state->along({{-1.0, 0.05 * k * p.flow.diameter_m, 0.0}, {1.0, 0.0, 0.0}, 0.0, 1e4}, 200, steps);
      for (const FieldStep& s : steps) hottest = std::max(hottest, s.temperature_K);
    }
    EXPECT_LE(hottest, range.y) << engine;
    EXPECT_GE(hottest, p.flow.temperature_K * 0.999) << engine;
  }
}

// Exhaust of what the air is made of, only hotter: no gas in excess, though its heat is there. The same jet with more has what it has more.
TEST(Jets, OnlyWhatIsInExcessOverTheAirCounts) {
  JetsSetup setup;
  NozzleFlow flow{0.5, 800.0, 300.0, {420e-6, 0.0, 0.0, 0.2095}, 0.0289647, 0.0, 0.0, 0.0};
  setup.nozzle = flow;
  const Pair same(setup, 0.0);
  std::vector<FieldStep> steps;
  same.state->along({{2.0, 0.0, -10.0}, {0.0, 0.0, 1.0}, 0.0, 20.0}, 20, steps);
  ASSERT_FALSE(steps.empty());
  double hottest = 0.0;
  for (const FieldStep& f : steps) {
    hottest = std::max(hottest, f.temperature_K);
    EXPECT_NEAR(f.amount[0], 0.0, 1e-12);  // of 420e-6 atm times a step of 0.1 m: 4e-5 atm m, to rounding
  }
  EXPECT_GT(hottest, 700.0);
}

// The same conditions, to what changes a jet by less than a thousandth, are the same state with the same texels; many are not kept for ever.
TEST(Jets, StatesAreKeptByConditions) {
  const JetsSource source(engineSetup("turbofan_afterburner"));
  const auto a = *source.conditionsAt(1.0, 1000.0, 200.0), b = *source.conditionsAt(1.0, 1001.0, 200.05), c = *source.conditionsAt(1.0, 1000.0, 201.0);
  EXPECT_EQ(source.stateOf(a), source.stateOf(b));
  EXPECT_NE(source.stateOf(a), source.stateOf(c));
  EXPECT_EQ(source.kept(), 2u);
  for (int k = 0; k < 80; ++k) source.stateOf(JetsSource::Conditions{2000, k, 0, 256});
  EXPECT_LE(source.kept(), 64u);

  // Emission from the side over all its length, one step of each condition on.
  const auto sent = [&source](const JetsSource::Conditions& at) {
    const auto state = source.stateOf(at);
    double sum = 0.0;
    std::vector<FieldStep> steps;
    for (int i = 0; i < 120; ++i)
      for (int j = 0; j < 40; ++j) {
        const double part = (i + 0.5) / 120, x = 100.0 * part * part, dx = 2.0 * 100.0 * part / 120;
        const double y = 8.0 * ((j + 0.5) / 40 - 0.5) * (0.15 + part * part);
        state->along({{x, y, -100.0}, {0.0, 0.0, 1.0}, 0.0, 200.0}, 32, steps);
        sum += ofSteps(steps, source.around(at).temperature_K).sent * dx * (0.15 + part * part);
      }
    return sum;
  };
  for (const auto& at : {JetsSource::Conditions{1500, 800, 200, 256}, JetsSource::Conditions{2000, 1000, 2000, 256}}) {
    const double here = sent(at);
    JetsSource::Conditions throttled = at, faster = at, higher = at;
    throttled.throttle -= 1, faster.speed += 1, higher.height += 1;
    std::printf("a step of throttle, speed, height changes what is sent by %+.5f %+.5f %+.5f\n", sent(throttled) / here - 1.0, sent(faster) / here - 1.0,
                sent(higher) / here - 1.0);
    for (const auto& next : {throttled, faster, higher}) EXPECT_NEAR(sent(next) / here, 1.0, 2e-3);  // half a step away at most: 1e-3
  }
}

// A motor comes and goes within a tenth of a second, by small steps; an engine idles at throttle 0, a written nozzle is then out.
TEST(Jets, ComesAndGoesWithoutAStep) {
  JetsSetup motor = engineSetup("double_base_motor");
  motor.life.begin_s = 2.0;
  const JetsSource source(motor);
  EXPECT_FALSE(source.conditionsAt(1.999, 0.0, 0.0));
  EXPECT_TRUE(source.conditionsAt(2.05, 0.0, 0.0));
  EXPECT_FALSE(source.conditionsAt(2.0 + 8.2, 0.0, 0.0));  // boost 3 s and sustain 5 s
  long long before = 0;
  for (double t = 1.99; t < 10.5; t += 0.005) {
    const auto c = source.conditionsAt(t, 0.0, 0.0);
    const long long now = c ? c->throttle : 0;
    EXPECT_LE(std::llabs(now - before), 110) << t;  // of 2000 steps: a twentieth of the rise a 200th of a second, and rounding
    before = now;
  }
  const JetsSource lit(motor);
  EXPECT_EQ(lit.conditionsAt(4.0, 0.0, 0.0)->throttle, 2000);

  JetsSetup engine = engineSetup("turbofan_military");
  engine.throttle = TimeCourse(0.0);
  const JetsSource idle(engine);
  ASSERT_TRUE(idle.conditionsAt(1.0, 0.0, 0.0));
  EXPECT_TRUE(idle.stateOf(*idle.conditionsAt(1.0, 0.0, 0.0)));
  engine.life.end_s = 5.0;
  const JetsSource ends(engine);
  EXPECT_EQ(ends.conditionsAt(4.0, 0.0, 0.0)->presence, 256);
  const auto fading = ends.conditionsAt(5.05, 0.0, 0.0);
  ASSERT_TRUE(fading);
  EXPECT_NEAR(fading->presencePart(), 0.5, 0.03);
  EXPECT_FALSE(ends.conditionsAt(5.2, 0.0, 0.0));

  JetsSetup nozzle;
  nozzle.nozzle = NozzleFlow{0.3, 900.0, 300.0, {0.05, 0.05, 0.0, 0.1}};
  nozzle.throttle = TimeCourse({{0.0, 1.0}, {1.0, 0.0}});
  const JetsSource out(nozzle);
  EXPECT_TRUE(out.conditionsAt(0.5, 0.0, 0.0));
  EXPECT_FALSE(out.conditionsAt(1.5, 0.0, 0.0));
  // Its mass flow is that part of what it is at 1.
  EXPECT_NEAR(out.flowAt({500, 0, 0, 256})->diameter_m, 0.15, 1e-12);
}

/// A world with one body on a path.
FieldWorld worldOf(const Simulation& s, double time_s, std::function<Pose(double)> path) {
  FieldWorld w;
  w.simulation = &s;
  w.time_s = time_s;
  w.poseAt = [path = std::move(path)](int, double t) { return path(t); };
  return w;
}

// The flow past the nozzle is the body's way through the air along the exhaust's axis; the field stands at the first nozzle, its x where the exhaust goes.
TEST(Jets, StandAtTheirNozzlesInTheFlowOfFlight) {
  Simulation sim;
  JetsSetup setup = engineSetup("turbofan_military");
  setup.nozzles = {{-7.0, 0.5, 0.1}, {-7.0, -0.5, 0.1}};
  setup.entity = 0;
  const JetsSource source(setup);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(1.0, 2.0, 0.5));
  const glm::dquat turned = orientationAlong(forward, 0.3);
  const auto path = [&](double t) { return Pose{glm::dvec3(0.0, 0.0, 3000.0) + 230.0 * t * forward, turned}; };
  const auto state = source.at(worldOf(sim, 2.0, path));
  ASSERT_TRUE(state);
  const glm::dvec3 nozzle = path(2.0).position + turned * setup.nozzles[0];
  EXPECT_NEAR(glm::length(state->origin - nozzle), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(state->localFromField[0] + forward), 0.0, 1e-9);
  EXPECT_NEAR(glm::determinant(state->localFromField), 1.0, 1e-12);
  EXPECT_NEAR(glm::length(state->origin + state->localFromField * (state->elements[state->elements.size() / 2].centre - state->elements[0].centre) -
                          (path(2.0).position + turned * setup.nozzles[1])),
              0.0, 1e-9);
  // The state for 230 m/s at that height has the same texels.
  const double height = sim.frame.toGeodetic(state->origin).height_m;
  const auto same = source.stateOf(*source.conditionsAt(2.0, height, 230.0));
  EXPECT_EQ(state->texels, same->texels);
  // A wind from ahead is added to it; a path that begins now flies as it will.
  sim.wind_m_s = -20.0 * forward;
  EXPECT_EQ(source.at(worldOf(sim, 2.0, path))->texels, source.stateOf(*source.conditionsAt(2.0, height, 250.0))->texels);
  sim.wind_m_s = glm::dvec3(0.0);
  const auto held = [&](double t) { return path(std::max(t, 2.0)); };
  EXPECT_EQ(source.at(worldOf(sim, 2.0, held))->texels, same->texels);
}

// Two nozzles far apart hold twice what one does; two at one place have no more than the pure exhaust, and of what is thin twice as much.
TEST(Jets, NozzlesAddUp) {
  const Pair one(engineSetup("turbofan_military"), 200.0);
  const auto amounts = [](const FieldState& s, double x, double y0, double wide, double& hottest) {
    double sum = 0.0;
    std::vector<FieldStep> steps;
    hottest = 0.0;
    for (int j = 0; j < 400; ++j) {
      s.along({{x, y0 + wide * ((j + 0.5) / 400 - 0.5), -50.0}, {0.0, 0.0, 1.0}, 0.0, 100.0}, 32, steps);
      for (const FieldStep& f : steps) sum += f.amount[0], hottest = std::max(hottest, f.temperature_K);
    }
    return sum * wide;
  };
  const auto twins = [](double apart) {
    JetsSetup s = engineSetup("turbofan_military");
    s.nozzles = {{0.0, 0.0, 0.0}, {0.0, -apart, 0.0}};  // +y of the field
    return Pair(s, 200.0);
  };
  double t1, t2;
  const Pair far = twins(20.0), near = twins(0.0);
  EXPECT_NEAR(amounts(*far.state, 5.0, 10.0, 30.0, t2) / amounts(*one.state, 5.0, 0.0, 30.0, t1), 2.0, 0.01);  // sampled every 0.08 m
  EXPECT_NEAR(t1, t2, 3.0);  // the hottest middles of steps that lie elsewhere
  // In the core: the same place twice is one place full, and what has begun of it is there once.
  const auto alongAxis = [](const FieldState& s) {
    std::vector<FieldStep> steps;
    s.along({{-5.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, 0.0, 5.2}, 32, steps);
    double sum = 0.0;
    for (const FieldStep& f : steps) sum += f.amount[0];
    return sum;
  };
  EXPECT_NEAR(alongAxis(*near.state) / alongAxis(*one.state), 1.0, 1e-6);
  amounts(*near.state, 0.05, 0.0, 2.0, t2), amounts(*one.state, 0.05, 0.0, 2.0, t1);
  EXPECT_NEAR(t1, t2, 1e-6);
  const double x = 0.6 * one.length_m, ratio = amounts(*near.state, x, 0.0, 30.0, t2) / amounts(*one.state, x, 0.0, 30.0, t1);
  EXPECT_NEAR(ratio, 2.0, 0.05);  // colder, thus denser, single jets: the excess of temperature is some percent of it
  EXPECT_NEAR((t2 - one.around.temperature_K) / (t1 - one.around.temperature_K), 2.0, 0.1);
}

// Levels of temperature left out: what jets of real engines send more than the air in five bands, as thin gas, against all levels of the tables.
TEST(Jets, FewLevelsOfTemperatureSendWhatAllDo) {
  for (const Case& c : {Case{"turbofan_afterburner", 0.0, 0.0}, Case{"turbofan_afterburner", 250.0, 9000.0}, Case{"aluminised_motor", 300.0, 0.0},
                        Case{"turbofan_military", 100.0, 0.0}}) {
    const JetsSetup setup = engineSetup(c.engine);
    const Pair p(setup, c.speed_m_s, c.height_m);
    // Mixture by temperature, weighted by how much gas a volume holds.
    std::map<int, double> spread;
    for (int i = 0; i < 300; ++i) {
      const double part = (i + 0.5) / 300, x = p.length_m * part * part, dx = p.length_m * 2.0 * part / 300;
      const JetRow row = p.jet.at(x);
      const double wide = row.coreZ_m + 3.0 * row.widthZ_m;
      for (int j = 0; j < 80; ++j) {
        const double r = wide * (j + 0.5) / 80;
        const JetState s = p.jet.stateAt(x, r);
        spread[static_cast<int>(s.temperature_K / 10.0)] += s.mixture / s.temperature_K * r * dx * wide / 80;
      }
    }
    const glm::dvec2 range = p.source.temperatures_K();
    for (Species species : {Species::CO2, Species::H2O, Species::CO}) {
      const SpeciesTable& table = speciesTable(species, std::filesystem::path(PITVIPER_SOURCE_DIR) / "materials/library");
      const GasLevels chosen = gasLevels(table, range.x, range.y);
      EXPECT_LE(chosen.level.size(), 9u);
      EXPECT_LE(chosen.error, kLevelError);
      for (const auto& band : kLevelBands_um) {
        double all = 0.0, few = 0.0;
        constexpr int kPoints = 200;
        for (int n = 0; n < kPoints; ++n) {
          const double um = band[0] + (band[1] - band[0]) * (n + 0.5) / kPoints;
          for (const auto& [bin, amount] : spread) {
            const double t = 10.0 * bin + 5.0, black = physics::planckRadiance(um, t) - physics::planckRadiance(um, p.around.temperature_K);
            const auto at = [&](std::size_t l) { return table.absorption[chosen.level[l]](um); };
            std::size_t l = 0;
            while (l + 2 < chosen.level.size() && t >= table.temperature_K[chosen.level[l + 1]]) ++l;
            const double low = table.temperature_K[chosen.level[l]], high = table.temperature_K[chosen.level[l + 1]];
            const double part = std::clamp((t - low) / (high - low), 0.0, 1.0);
            few += amount * black * ((1.0 - part) * at(l) + part * at(l + 1));
            all += amount * black * absorptionOf(table, um, t);
          }
        }
        if (!(all > 0.0)) continue;
        std::printf("%s %.0f m/s %s, %zu levels, %.1f-%.1f um: %+.4f\n", c.engine, c.speed_m_s, table.name.c_str(), chosen.level.size(), band[0], band[1],
                    few / all - 1.0);
        EXPECT_NEAR(few / all, 1.0, 0.01);  // kLevelError is of three typical spreads over temperature; these have their own
      }
    }
  }
}

}  // namespace
}  // namespace pitviper::test
