// What was flown, against closed forms: parabolas, circles, straight lines that pass each other.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "sim/radiometry/constants.hpp"
#include "sim/run/encounters.hpp"
#include "sim/run/history.hpp"
#include "sim/scene/gravity.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {
namespace {

using glm::dvec3;

Motion along(const dvec3& from, const dvec3& velocity, const dvec3& acceleration, double end_s, AtEnd end = AtEnd::Hold) {
  const auto point = [&](double t) {
    return TrajectoryPoint{t, from + velocity * t + 0.5 * acceleration * t * t, velocity + acceleration * t, acceleration, orientationAlong(velocity)};
  };
  return Motion(Trajectory({point(0.0), point(end_s)}, end, end));
}

Simulation world(std::vector<Entity> entities) {
  Simulation sim;
  sim.name = "test";
  sim.time = {0.0, 0.1, 11, {}};
  sim.entities = std::move(entities);
  return sim;
}

Entity body(const std::string& name, const Motion& motion, int parent = -1) {
  Entity e;
  e.name = name;
  e.motion = motion;
  e.parent = parent;
  return e;
}

/// Rows as maps from column to cell.
struct Row {
  std::map<std::string, std::string> cells;
  double number(const std::string& column) const { return cells.at(column).empty() ? NAN : std::stod(cells.at(column)); }
  dvec3 vector(const std::string& before, const std::string& after) const {
    return {number(before + "east" + after), number(before + "north" + after), number(before + "up" + after)};
  }
};

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells(1);
  for (char c : line)
    if (c == ',') cells.emplace_back();
    else cells.back() += c;
  return cells;
}

std::vector<Row> rowsOf(const std::string& text) {
  const std::string head = History::head();
  const std::vector<std::string> names = split(head.substr(0, head.size() - 1));
  std::vector<Row> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::vector<std::string> cells = split(line);
    EXPECT_EQ(cells.size(), names.size()) << line;
    Row& row = rows.emplace_back();
    for (std::size_t i = 0; i < std::min(cells.size(), names.size()); ++i) row.cells[names[i]] = cells[i];
  }
  return rows;
}

std::vector<Row> flown(const Simulation& sim) {
  History history(sim);
  for (int f = 0; f < sim.time.frames; ++f) history.look(f, advance(sim, sim.time.at(f)));
  history.finish();
  return rowsOf(history.take());
}

std::vector<Row> of(const std::vector<Row>& rows, const std::string& name) {
  std::vector<Row> own;
  for (const Row& r : rows)
    if (r.cells.at("name") == name) own.push_back(r);
  return own;
}

// Rationale: three positions of a parabola give its velocity and acceleration exactly, whatever the steps; of a circle the chord does, whose relative errors
// are (w h)^2 / 6 and (w h)^2 / 12.
TEST(HistorySlopes, ExactForParabolasSecondOrderForCircles) {
  const dvec3 v(3, -2, 5), a(0, 1, -9.81);
  const auto parabola = [&](double t) { return v * t + 0.5 * a * t * t; };
  const Slopes s = slopesThrough(0.9, parabola(0.9), 1.0, parabola(1.0), 1.25, parabola(1.25));
  // Positions of 10 m are rounded to 2e-15 m, which steps of 0.1 s raise to 1e-12 m/s2.
  EXPECT_LT(glm::distance(s.velocity, v + a), 1e-12);
  EXPECT_LT(glm::distance(s.acceleration, a), 1e-11);
  const double w = 2.0, h = 0.05, r = 100.0;
  const auto circle = [&](double t) { return r * dvec3(std::cos(w * t), std::sin(w * t), 0.0); };
  const Slopes c = slopesThrough(-h, circle(-h), 0.0, circle(0.0), h, circle(h));
  EXPECT_NEAR(c.velocity.y / (r * w), 1.0 - w * h * w * h / 6.0, 1e-6);  // the next term is (w h)^4 / 120
  EXPECT_NEAR(-c.acceleration.x / (r * w * w), 1.0 - w * h * w * h / 12.0, 1e-6);
}

TEST(HistorySlopes, AttitudesComeBack) {
  for (const double heading : {0.0, 1.0, 3.0, 6.0})
    for (const double pitch : {-1.5, -0.3, 0.0, 1.2})
      for (const double roll : {-3.0, -0.5, 0.0, 2.5}) {
        const Attitude a = attitudeOf(orientationFrom({heading, pitch, roll}));
        // asin near 1.5 rad raises rounding by 1 / cos(1.5) = 14.
        EXPECT_NEAR(std::remainder(a.heading_rad - heading, 2.0 * kPi), 0.0, 1e-12);
        EXPECT_NEAR(a.pitch_rad, pitch, 1e-13);
        EXPECT_NEAR(a.roll_rad, roll, 1e-12);
      }
  const dvec3 turn = turned(orientationFrom({0.3, 0.1, 0.0}), orientationFrom({0.3, 0.1, 0.2}));
  EXPECT_LT(glm::distance(turn, dvec3(0.2, 0.0, 0.0)), 1e-14);
}

// Rationale: a trajectory's own velocity and acceleration are told, at its ends too; a body in free fall feels no load, one that flies level feels 1 g.
TEST(HistoryRows, TellWhatAMotionSaysExactly) {
  const dvec3 g = normalGravity(LocalFrame(), dvec3(0, 0, 1000));
  Simulation sim = world({body("shell", along({0, 0, 1000}, {100, 50, 0}, g, 1.0)), body("level", along({5, 0, 1000}, {0, 200, 0}, {}, 1.0)),
                          body("turns", along({5, 0, 1000}, {0, 200, 0}, {std::sqrt(3.0) * glm::length(g), 0, 0}, 1.0))});
  const std::vector<Row> rows = flown(sim);
  ASSERT_EQ(rows.size(), 33u);
  for (const Row& r : of(rows, "shell")) {
    const double t = r.number("time_s");
    EXPECT_LT(glm::distance(r.vector("", "_m"), dvec3(100, 50, 0) * t + 0.5 * g * t * t + dvec3(0, 0, 1000)), 1e-8) << t;  // twelve digits of 1000 m
    EXPECT_LT(glm::distance(r.vector("velocity_", "_m_s"), dvec3(100, 50, 0) + g * t), 1e-8) << t;
    EXPECT_LT(glm::distance(r.vector("acceleration_", "_m_s2"), g), 1e-9) << t;
    EXPECT_LT(r.number("load_g"), 1e-5);  // gravity changes by 3e-6 of itself over 10 m
    EXPECT_EQ(r.cells.at("present"), "1");
  }
  for (const Row& r : of(rows, "level")) {
    EXPECT_NEAR(r.number("load_g"), glm::length(g) / kStandardGravity, 1e-6);
    EXPECT_NEAR(r.number("heading_deg"), 0.0, 1e-9);
    EXPECT_NEAR(r.number("speed_m_s"), 200.0, 1e-9);
    // US Standard Atmosphere 1976, table 1: 336.43 m/s at 1 km.
    EXPECT_NEAR(r.number("mach"), 200.0 / 336.43, 2e-5);
    EXPECT_NEAR(r.number("height_m"), 1000.0, 0.01);  // 200 m away the ellipsoid has sunk by 3 mm
  }
  // Banked by 60 deg: 2 g, at the beginning, where the turn is across the way.
  EXPECT_NEAR(of(rows, "turns").front().number("load_g"), 2.0 * glm::length(g) / kStandardGravity, 1e-6);
}

// Rationale: on a carrier that spins, what is d off its axis has the velocity w d and the acceleration w^2 d; rates are in body axes with the signs of pilots.
TEST(HistoryRows, KnowWhatACarriersTurningAdds) {
  const double w = 2.0, d = 3.0;
  Motion spins = Motion(Pose{}).withSpin({{0, 0, 1}, w, 0.0, {}});
  std::vector<Waypoint> slide{{0.0, {d, 0, 0}, Attitude{0.5 * kPi, 0, 0}, 0.0}, {10.0, {d + 1e-9, 0, 0}, Attitude{0.5 * kPi, 0, 0}, 0.0}};
  const Simulation sim =
      world({body("hub", spins), body("arm", Motion(slide, Motion::Interpolation::Linear), 0), body("fixed", Motion(Pose{{1, 0, 0}, {1, 0, 0, 0}}), 0)});
  const std::vector<Row> rows = flown(sim);
  EXPECT_TRUE(of(rows, "fixed").empty());
  ASSERT_EQ(of(rows, "arm").size(), 11u);
  for (const Row& r : of(rows, "arm")) {
    const double t = r.number("time_s");
    const dvec3 out(std::cos(w * t), std::sin(w * t), 0.0), across(-out.y, out.x, 0.0);
    EXPECT_LT(glm::distance(r.vector("velocity_", "_m_s"), w * d * across), 1e-7) << t;  // (w h)^2 / 6 of 6 m/s, h = 0.1 ms
    EXPECT_LT(glm::distance(r.vector("acceleration_", "_m_s2"), -w * w * d * out), 1e-5) << t;
    EXPECT_NEAR(r.number("yaw_rate_deg_s"), -w * 180.0 / kPi, 1e-6) << t;  // to the left
  }
}

// Rationale: at a corner acceleration is not a number; elsewhere on straight legs it is 0.
TEST(HistoryRows, SayNothingOfAccelerationAtACorner) {
  const std::vector<Waypoint> legs{{0.0, {0, 0, 0}, {}, 0.0}, {0.5, {50, 0, 0}, {}, 0.0}, {1.0, {50, 50, 0}, {}, 0.0}};
  const std::vector<Row> rows = of(flown(world({body("zigzag", Motion(legs, Motion::Interpolation::Linear))})), "zigzag");
  ASSERT_EQ(rows.size(), 11u);
  for (const Row& r : rows) {
    if (r.number("frame") == 5.0) {
      EXPECT_TRUE(r.cells.at("acceleration_east_m_s2").empty());
      EXPECT_TRUE(r.cells.at("yaw_rate_deg_s").empty());
    } else {
      EXPECT_EQ(r.number("acceleration_east_m_s2"), 0.0) << r.cells.at("frame");
      EXPECT_EQ(r.number("yaw_rate_deg_s"), 0.0) << r.cells.at("frame");
    }
  }
}

// Rationale: what a command moves is known at ticks alone; its parabola through three of them is told, and nothing where one is missing.
TEST(HistoryRows, AreOfTicksWhereCommandsMove) {
  Simulation sim = world({body("ball", Motion(Pose{{0, 0, 100}, {1, 0, 0, 0}}))});
  EXPECT_FALSE(hasHistory(sim));
  const dvec3 v(10, 0, 0), a(0, 4, 0);
  sim.commands.push_back({0.3, "move", [=](Courses& c, double at) {
                            c.positions[0] = [=](double t) { return dvec3(0, 0, 100) + v * (t - at) + 0.5 * a * (t - at) * (t - at); };
                          }});
  EXPECT_TRUE(hasHistory(sim));
  const std::vector<Row> rows = flown(sim);
  ASSERT_EQ(rows.size(), 8u);  // from the last tick at its place on, that of 0.3 s
  for (const Row& r : rows) {
    const double t = r.number("time_s") - 0.3;
    if (r.number("frame") == 3.0) continue;  // it has stood still until then
    if (r.number("frame") == 10.0) {
      EXPECT_TRUE(r.cells.at("velocity_east_m_s").empty());
      continue;
    }
    EXPECT_LT(glm::distance(r.vector("velocity_", "_m_s"), v + a * t), 1e-9) << t;
    EXPECT_LT(glm::distance(r.vector("acceleration_", "_m_s2"), a), 1e-9) << t;
  }
}

TEST(HistoryRows, LeaveCellsEmptyOfWhatIsNotThere) {
  Simulation sim = world({body("shell", along({1e6, 0.001, 1000}, {100, 0, 0}, {}, 0.45, AtEnd::Vanish))});
  const std::vector<Row> rows = flown(sim);
  ASSERT_EQ(rows.size(), 11u);
  EXPECT_EQ(rows[4].cells.at("present"), "1");
  EXPECT_NEAR(rows[0].number("north_m"), 0.001, 1e-12);
  EXPECT_NEAR(rows[4].number("east_m"), 1e6 + 40.0, 1e-5);  // 1 mm over 1000 km, and better
  EXPECT_EQ(rows[5].cells.at("present"), "0");
  EXPECT_TRUE(rows[5].cells.at("east_m").empty());
}

// Rationale: rows leave as ticks come, so that memory does not grow.
TEST(HistoryRows, AreReadyATickLater) {
  const Simulation sim = world({body("level", along({0, 0, 0}, {0, 200, 0}, {}, 1.0))});
  History history(sim);
  history.look(0, advance(sim, 0.0));
  EXPECT_EQ(history.take(), "");
  history.look(1, advance(sim, 0.1));
  history.look(2, advance(sim, 0.2));
  EXPECT_EQ(rowsOf(history.take()).size(), 1u);
  history.finish();
  EXPECT_EQ(rowsOf(history.take()).size(), 2u);
}

// Rationale: two straight lines pass at the distance of geometry, at a time that no step falls on.
TEST(Encounters, OfTwoStraightLines) {
  const double miss = 3.0;
  Simulation sim =
      world({body("target", along({0, 0, 0}, {200, 0, 0}, {}, 10.0)), body("missile", along({200 * 7.7137, -500 * 7.7137, miss}, {0, 500, 0}, {}, 10.0))});
  Entity& missile = sim.entities[1];
  missile.flight = std::make_shared<const FlightRecord>(FlightRecord{"missile", *missile.motion.path(), "duration", "target", {}});
  const std::vector<Encounter> all = encountersOf(sim, 0.0, 1.0);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].time_s, 7.7137, 1e-9);
  EXPECT_NEAR(all[0].distance_m, miss, 1e-9);
  EXPECT_TRUE(all[0].passed);
  EXPECT_NEAR(all[0].relativeSpeed_m_s, std::hypot(200.0, 500.0), 1e-9);
  EXPECT_NEAR(all[0].aspect_rad, std::acos(200.0 / std::hypot(200.0, 500.0)), 1e-12);  // it comes from ahead as much as the target flies on
  // A record that says more is believed, and a camera beside them tells its own.
  missile.flight =
      std::make_shared<const FlightRecord>(FlightRecord{"missile", *missile.motion.path(), "closest approach", "target", FlightRecord::Closest{7.7137, 3.0}});
  Camera eye;
  eye.name = "eye";
  eye.mount.motion = Motion(Pose{{100, 30, 40}, {1, 0, 0, 0}});
  eye.mount.lookAtEntity = 0;
  sim.cameras.push_back(eye);
  const std::vector<Encounter> both = encountersOf(sim, 0.0, 1.0);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both[1].time_s, 0.5, 1e-9);
  EXPECT_NEAR(both[1].distance_m, 50.0, 1e-9);
  EXPECT_NEAR(both[1].aspect_rad, 0.5 * kPi, 1e-9);
  const std::string text = encountersText(both);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 3);
  EXPECT_NE(text.find("\nmissile,target,flight,7.7137,3,1,"), std::string::npos) << text;
}

}  // namespace
}  // namespace pitviper
