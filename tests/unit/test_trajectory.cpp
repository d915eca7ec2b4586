// Paths between points and beyond their ends, and those read from CSV files.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "sim/flight/trajectory_csv.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/scene/trajectory.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = kPi / 180.0;
using Interpolation = Trajectory::Interpolation;

double angleBetween(const glm::dquat& a, const glm::dquat& b) { return 2.0 * std::acos(std::min(1.0, std::abs(glm::dot(a, b)))); }

/// Around a circle of 100 m with 0.5 rad/s and a steady climb of 3 m/s.
TrajectoryPoint onHelix(double t) {
  const double w = 0.5, c = std::cos(w * t), s = std::sin(w * t), r = 100.0;
  return {t, {r * c, r * s, 3.0 * t}, {-r * w * s, r * w * c, 3.0}, {-r * w * w * c, -r * w * w * s, 0.0}, orientationAlong({-s, c, 0.0})};
}

std::vector<TrajectoryPoint> helix(double from, double to, double step) {
  std::vector<TrajectoryPoint> points;
  const auto count = static_cast<int>(std::lround((to - from) / step));
  for (int i = 0; i <= count; ++i) points.push_back(onHelix(from + i * step));
  return points;
}

TEST(Trajectory, PolynomialsAreThemselves) {
  const auto at = [](double t, int degree) {
    TrajectoryPoint p;
    p.time_s = t;
    const auto power = [t](int n) { return n < 0 ? 0.0 : std::pow(t, n); };
    p.position = {power(degree), 2.0 - power(degree - 1), 5.0};
    p.velocity = {degree * power(degree - 1), -(degree - 1) * power(degree - 2), 0.0};
    p.acceleration = {degree * (degree - 1) * power(degree - 2), -(degree - 1) * (degree - 2) * power(degree - 3), 0.0};
    return p;
  };
  for (const auto& [degree, way] : {std::pair(5, Interpolation::Quintic), std::pair(3, Interpolation::Cubic)}) {
    const Trajectory path({at(0.5, degree), at(1.0, degree), at(3.0, degree)}, AtEnd::Hold, AtEnd::Hold, way);
    for (double t : {0.5, 0.7, 1.0, 1.9, 2.999, 3.0}) {
      // Numbers up to 3^5 = 243, their derivatives up to 540: rounding times the coefficients' sums.
      EXPECT_LT(glm::length(path.at(t).position - at(t, degree).position), 1e-11) << degree << " " << t;
      EXPECT_LT(glm::length(path.velocityAt(t) - at(t, degree).velocity), 1e-11) << degree << " " << t;
      EXPECT_LT(glm::length(path.accelerationAt(t) - at(t, degree).acceleration), 1e-10) << degree << " " << t;
    }
  }
}

TEST(Trajectory, ErrorsStayBelowHermites) {
  for (const auto& [way, limit] : {std::pair(Interpolation::Cubic, std::pow(0.4, 4) / 384.0 * 100.0 * std::pow(0.5, 4)),
                                   std::pair(Interpolation::Quintic, std::pow(0.4, 6) / 46080.0 * 100.0 * std::pow(0.5, 6))}) {
    const Trajectory path(helix(0.0, 10.0, 0.4), AtEnd::Hold, AtEnd::Hold, way);
    double worst = 0.0;
    for (double t = 0.0; t <= 10.0; t += 0.0173) worst = std::max(worst, glm::length(path.at(t).position - onHelix(t).position));
    // Each coordinate keeps the bound, and sine and cosine share it: the circle's error is that of its radius.
    bound(way == Interpolation::Cubic ? "helix by cubics [m]" : "helix by quintics [m]", worst, limit, "error of Hermite interpolation");
    EXPECT_GT(worst, 0.5 * limit);  // and is not far below: the bound is met mid-way
  }
}

TEST(Trajectory, PointsAreMetAndOrientationTurnsTheShorterWay) {
  const auto points = helix(2.0, 12.0, 0.5);
  const Trajectory path(points);
  for (const auto& p : points) {
    EXPECT_LT(glm::length(path.at(p.time_s).position - p.position), 1e-12);
    EXPECT_LT(angleBetween(path.at(p.time_s).orientation, p.orientation), 1e-7);  // acos next to 1
  }
  // A body that turns evenly about one axis: slerp is exact.
  for (double t = 2.1; t < 12.0; t += 0.7) EXPECT_LT(angleBetween(path.at(t).orientation, onHelix(t).orientation), 1e-7) << t;
  TrajectoryPoint a, b;
  a.orientation = orientationFrom({350 * kDegree, 0, 0});
  b.time_s = 1.0, b.orientation = -orientationFrom({10 * kDegree, 0, 0});  // the other quaternion of the same turn
  EXPECT_LT(angleBetween(Trajectory({a, b}).at(0.5).orientation, orientationFrom({0, 0, 0})), 1e-7);
}

TEST(Trajectory, EndsHoldGoOnLoopOrVanish) {
  const auto points = helix(2.0, 12.0, 0.5);
  const TrajectoryPoint &first = points.front(), &last = points.back();
  const auto of = [&](AtEnd end) { return Trajectory(points, end, end); };
  for (const double before : {1.9, -50.0})
    for (const double after : {12.1, 99.0}) {
      for (const AtEnd end : {AtEnd::Hold, AtEnd::Vanish}) {
        const Trajectory path = of(end);
        EXPECT_EQ(path.at(before).position, first.position);
        EXPECT_EQ(path.at(after).position, last.position);
        EXPECT_EQ(path.velocityAt(after), glm::dvec3(0.0));
        EXPECT_EQ(path.accelerationAt(before), glm::dvec3(0.0));
        EXPECT_EQ(path.presentAt(before), end == AtEnd::Hold);
        EXPECT_EQ(path.presentAt(after), end == AtEnd::Hold);
      }
      const Trajectory on = of(AtEnd::GoOn);
      EXPECT_LT(glm::length(on.at(before).position - (first.position + (before - 2.0) * first.velocity)), 1e-11);
      EXPECT_LT(glm::length(on.at(after).position - (last.position + (after - 12.0) * last.velocity)), 1e-11);
      EXPECT_EQ(on.velocityAt(after), last.velocity);
      EXPECT_LT(angleBetween(on.at(after).orientation, last.orientation), 1e-7);
      EXPECT_TRUE(on.presentAt(before) && on.presentAt(after));
    }
  const Trajectory again = of(AtEnd::Loop);
  for (double t : {2.3, 7.7, 11.9})
    for (int turn : {-3, -1, 1, 4}) {
      // Times of some tens carry 1e-14, which a speed of 50 m/s takes to 1e-12 m.
      EXPECT_LT(glm::length(again.at(t + 10.0 * turn).position - again.at(t).position), 1e-11) << t << " " << turn;
      EXPECT_LT(glm::length(again.velocityAt(t + 10.0 * turn) - again.velocityAt(t)), 1e-10);
      EXPECT_TRUE(again.presentAt(t + 10.0 * turn));
    }
  const Trajectory mixed = again.withEnds(AtEnd::Vanish, AtEnd::GoOn);
  EXPECT_FALSE(mixed.presentAt(1.0));
  EXPECT_EQ(mixed.velocityAt(13.0), last.velocity);
  EXPECT_EQ(&mixed.points(), &again.points()) << "copies share their points";
  EXPECT_EQ(Trajectory({points[0]}, AtEnd::Loop, AtEnd::Loop).at(77.0).position, points[0].position);
}

TEST(Trajectory, WhatIsNoPathIsRefused) {
  EXPECT_THROW(Trajectory({}), std::invalid_argument);
  EXPECT_THROW(Trajectory({onHelix(1.0), onHelix(1.0)}), std::invalid_argument);
  EXPECT_THROW(Trajectory({onHelix(1.0), onHelix(0.5)}), std::invalid_argument);
  TrajectoryPoint bad;
  bad.position.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(Trajectory({bad}), std::invalid_argument);
  TrajectoryPoint unturned;
  unturned.orientation = glm::dquat(0.0, 0.0, 0.0, 0.0);
  EXPECT_THROW(Trajectory({unturned}), std::invalid_argument);
}

class TrajectoryCsv : public ::testing::Test {
 protected:
  std::filesystem::path written(const std::string& text) { return folder_.put("path" + std::to_string(++count_) + ".csv", text); }
  std::string complaint(const std::string& text) {
    const auto file = written(text);
    try {
      readTrajectoryCsv(file, frame_);
    } catch (const UserError& e) {
      std::string message = e.what();
      const std::string name = file.string();
      if (const auto at = message.find(name); at != std::string::npos) message.replace(at, name.size(), "F");
      return message;
    }
    return "";
  }
  TemporaryFolder folder_;
  int count_ = 0;
  LocalFrame frame_{{48.0 * kDegree, 11.0 * kDegree, 520.0}};
};

std::string cells(std::initializer_list<double> values) {
  std::string line;
  for (double v : values) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", v);
    line += (line.empty() ? "" : ", ") + std::string(text);
  }
  return line + "\n";
}

TEST_F(TrajectoryCsv, EveryFrameGivesTheSamePath) {
  std::string local = "time_s, x_m, y_m, z_m, heading_deg, pitch_deg, roll_deg\n", ned = "# a log\r\ntime_s,north_m,east_m,down_m,qw,qx,qy,qz\r\n",
              geodetic = "\xEF\xBB\xBFlatitude_deg,longitude_deg,height_m,time_s,heading_deg,pitch_deg,roll_deg\n",
              ecef = "time_s,ecef_x_m,ecef_y_m,ecef_z_m,ned_qw,ned_qx,ned_qy,ned_qz\n";
  std::vector<Pose> truth;
  for (int i = 0; i < 20; ++i) {
    const double t = 0.5 * i;
    const glm::dvec3 p(30000.0 + 200.0 * t, -20000.0 + 5.0 * t * t, 3000.0 - 40.0 * t);
    // Turned about the place's own north and horizon, 36 km from the origin.
    const Attitude there{(340.0 + 4.0 * i) * kDegree, 10.0 * kDegree, -25.0 * kDegree};
    const Geodetic g = frame_.toGeodetic(p);
    const glm::dmat3 turn = glm::transpose(frame_.ecefFromLocal()) * LocalFrame(g).ecefFromLocal();
    const glm::dmat3 m = turn * glm::mat3_cast(orientationFrom(there));
    const glm::dquat q = glm::quat_cast(m);
    truth.push_back({p, q});
    const double heading = std::atan2(m[0].x, m[0].y) + 4 * kPi, pitch = std::asin(m[0].z), roll = std::atan2(m[1].z, m[2].z);
    local += cells({t, p.x, p.y, p.z, heading / kDegree, pitch / kDegree, roll / kDegree});
    ned += cells({t, p.y, p.x, -p.z, q.w, q.x, q.y, q.z});
    geodetic += cells({g.latitude_rad / kDegree, g.longitude_rad / kDegree, g.height_m, t, there.heading_rad / kDegree, 10.0, -25.0});
    const glm::dvec3 e = frame_.toEcef(p);
    // Columns of the body's forward, right and down in north, east, down.
    const auto inNed = [](const glm::dvec3& v) { return glm::dvec3(v.y, v.x, -v.z); };
    const glm::dquat n = glm::quat_cast(glm::dmat3(inNed(m[0]), inNed(-m[1]), inNed(-m[2])));
    ecef += cells({t, e.x, e.y, e.z, n.w, n.x, n.y, n.z});
  }
  double place = 0.0, turn = 0.0;
  const Trajectory first = readTrajectoryCsv(written(local), frame_);
  for (const std::string& text : {local, ned, geodetic, ecef}) {
    const Trajectory path = readTrajectoryCsv(written(text), frame_);
    ASSERT_EQ(path.points().size(), truth.size());
    for (std::size_t i = 0; i < truth.size(); ++i) {
      place = std::max(place, glm::length(path.points()[i].position - truth[i].position));
      turn = std::max(turn, angleBetween(path.points()[i].orientation, truth[i].orientation));
    }
    for (double t = 0.0; t < 9.5; t += 0.21) place = std::max(place, glm::length(path.at(t).position - first.at(t).position));
  }
  bound("CSV in four frames, position [m]", place, 1e-7, "ECEF metres carry 1e-9 m; geodetic ones 1e-8 m by their solution");
  bound("CSV in four frames, attitude [rad]", turn, 1e-7, "acos next to 1 shows 1.5e-8 rad at least");
}

TEST_F(TrajectoryCsv, EvenAccelerationIsExactAndAttitudesFollow) {
  std::string text = "time_s,x_m,y_m,z_m\n";
  for (double t : {0.0, 0.3, 1.0, 1.5, 3.0}) text += cells({t, 10.0 + 4.0 * t - 3.0 * t * t, 7.0 * t, 100.0 - 4.905 * t * t});
  const Trajectory path = readTrajectoryCsv(written(text), frame_, AtEnd::Vanish, AtEnd::GoOn);
  for (double t = 0.0; t <= 3.0; t += 0.1) {
    EXPECT_LT(glm::length(path.at(t).position - glm::dvec3(10.0 + 4.0 * t - 3.0 * t * t, 7.0 * t, 100.0 - 4.905 * t * t)), 1e-11) << t;
    EXPECT_LT(glm::length(path.velocityAt(t) - glm::dvec3(4.0 - 6.0 * t, 7.0, -9.81 * t)), 1e-11) << t;
  }
  EXPECT_GT(glm::dot(path.at(1.0).orientation * glm::dvec3(1, 0, 0), glm::normalize(path.velocityAt(1.0))), 1.0 - 1e-12);
  EXPECT_FALSE(path.presentAt(-0.1));
  EXPECT_TRUE(path.presentAt(3.1));
  // 359 and 1 are 2 degrees apart, as are 359 and 361.
  for (const char* second : {"1", "361", "-359"}) {
    const Trajectory turn =
        readTrajectoryCsv(written("time_s,x_m,y_m,z_m,heading_deg,pitch_deg,roll_deg\n0,0,0,0,359,0,0\n1,0,9,0," + std::string(second) + ",0,0\n"), frame_);
    EXPECT_LT(angleBetween(turn.at(0.5).orientation, orientationFrom({0, 0, 0})), 1e-7) << second;
  }
  // Who stands keeps his heading.
  const Trajectory stands = readTrajectoryCsv(written("time_s,x_m,y_m,z_m\n0,0,0,0\n1,9,0,0\n2,9,0,0\n3,9,0,0\n4,9,0,0\n"), frame_);
  EXPECT_GT((stands.at(4.0).orientation * glm::dvec3(1, 0, 0)).x, 1.0 - 1e-12);
}

TEST_F(TrajectoryCsv, FaultsAreNamedWithTheirPlace) {
  const std::string head = "time_s,x_m,y_m,z_m\n";
  const auto expect = [&](const std::string& text, const std::string& begins, const std::string& holds) {
    const std::string message = complaint(text);
    EXPECT_EQ(message.substr(0, begins.size()), begins) << message;
    EXPECT_NE(message.find(holds), std::string::npos) << message;
  };
  expect("", "F:1:1: ", "empty");
  expect("# only words\n\n", "F:1:1: ", "empty");
  expect(head, "F:2:1: ", "no row");
  expect("time_s,x_m,y_m,hight_m\n0,0,0,0\n", "F:1:16: ", "height_m");
  expect("time_s,x_m,y_m,z_m,x_m\n", "F:1:20: ", "second column 'x_m'");
  expect("x_m,y_m,z_m\n", "F:1:1: ", "time_s");
  expect("time_s,heading_deg,pitch_deg,roll_deg\n", "F:1:1: ", "no position");
  expect("time_s,x_m,z_m\n", "F:1:8: ", "'y_m' is missing");
  expect("time_s,x_m,y_m,z_m,heading_deg\n", "F:1:20: ", "'pitch_deg' is missing");
  expect("time_s,x_m,y_m,z_m,north_m,east_m,down_m\n", "F:1:20: ", "beside");
  expect("time_s,x_m,y_m,z_m,qw,qx,qy,qz,heading_deg,pitch_deg,roll_deg\n", "F:1:20: ", "beside");
  expect(head + "0,0,0\n", "F:2:1: ", "3 cells");
  expect(head + "0,0,0,0\n1,2,x,4\n", "F:3:5: ", "not a finite number: 'x'");
  expect(head + "0,0,0,nan\n", "F:2:7: ", "not a finite number");
  expect(head + "0,0,0,1e999\n", "F:2:7: ", "not a finite number");
  expect(head + "0,0,0, 2e9\n", "F:2:8: ", "too large");
  expect(head + "0,0,0,0\n\n1,1,1,1\n1,2,2,2\n", "F:5:1: ", "time goes back or stands");
  expect(head + "0,0,0,0\n-1,1,1,1\n", "F:3:1: ", "time goes back or stands");
  expect("time_s,latitude_deg,longitude_deg,height_m\n0,91,0,0\n", "F:2:3: ", "90");
  expect("time_s,x_m,y_m,z_m,qw,qx,qy,qz\n0,0,0,0,1,1,0,0\n", "F:2:9: ", "quaternion of length 1.414");
  expect(head + std::string(5000, ',') + "\n", "F:2:1: ", "4096");
  EXPECT_THROW(readTrajectoryCsv(folder_.path() / "none.csv", frame_), UserError);
}

}  // namespace
}  // namespace pitviper::test
