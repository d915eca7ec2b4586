#include "sim/model/direction_grid.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

// Elevations go with the square of a ring's number, from the horizon on.
double DirectionGrid::elevation_rad(int ring) const {
  const bool up = ring < above;
  const double u = up ? static_cast<double>(ring) / (above - 1) : static_cast<double>(ring - above) / (below - 1);
  return up ? horizon_rad + (0.5 * kPi - horizon_rad) * u * u : horizon_rad - (0.5 * kPi + horizon_rad) * u * u;
}

glm::dvec3 DirectionGrid::direction(std::size_t entry) const {
  const double e = elevation_rad(static_cast<int>(entry / static_cast<size_t>(azimuths))),
               a = turn_rad + 2.0 * kPi * static_cast<double>(entry % static_cast<size_t>(azimuths)) / azimuths;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

DirectionGrid DirectionGrid::finer() const {
  constexpr int kRings = 49, kRound = 48;
  DirectionGrid all = *this;
  all.above = std::max(above, kRings);
  all.below = std::max(below, kRings);
  if (azimuths > 1) all.azimuths = azimuths * std::max((kRound + azimuths - 1) / azimuths, 1);
  return all;
}

DirectionGrid::Reading DirectionGrid::at(const glm::dvec3& d) const {
  const double e = std::atan2(d.z, std::hypot(d.x, d.y));
  const bool up = e >= horizon_rad;
  const int rings = up ? above : below;
  const double x =
      std::sqrt(std::clamp(up ? (e - horizon_rad) / (0.5 * kPi - horizon_rad) : (horizon_rad - e) / (0.5 * kPi + horizon_rad), 0.0, 1.0)) * (rings - 1);
  const int ring = std::min(static_cast<int>(x), rings - 2);
  const double across = x - ring;
  double turn = azimuths > 1 ? (std::atan2(d.y, d.x) - turn_rad) / (2.0 * kPi) * azimuths : 0.0;
  while (turn < 0.0) turn += azimuths;
  const int first = static_cast<int>(turn) % azimuths;
  const double round = azimuths > 1 ? turn - std::floor(turn) : 0.0;
  const auto place = [&](int r, int a) { return static_cast<std::size_t>((r + (up ? 0 : above)) * azimuths + a % azimuths); };
  return {{place(ring, first), place(ring, first + 1), place(ring + 1, first), place(ring + 1, first + 1)},
          {(1.0 - across) * (1.0 - round), (1.0 - across) * round, across * (1.0 - round), across * round}};
}

std::vector<DirectionGrid::Sample> DirectionGrid::samples(int points) const {
  const auto rule = gaussLegendre(points, 0.0, 1.0);
  // What is the same all around is still looked at all around.
  const int round = std::max(azimuths, 24);
  std::vector<Sample> all;
  for (int half = 0; half < 2; ++half) {
    const int rings = half == 0 ? above : below;
    const double whole = half == 0 ? 0.5 * kPi - horizon_rad : 0.5 * kPi + horizon_rad;
    for (int r = 0; r + 1 < rings; ++r)
      for (const QuadratureNode& across : rule) {
        const double u = (r + across.x) / (rings - 1), e = half == 0 ? horizon_rad + whole * u * u : horizon_rad - whole * u * u;
        const double ring_sr = across.weight / (rings - 1) * 2.0 * u * whole * std::cos(e);
        for (int a = 0; a < round; ++a)
          for (const QuadratureNode& turned : rule) {
            const double phi = turn_rad + 2.0 * kPi * (a + turned.x) / round;
            const glm::dvec3 d(std::cos(e) * std::cos(phi), std::cos(e) * std::sin(phi), std::sin(e));
            all.push_back({d, ring_sr * turned.weight * 2.0 * kPi / round, at(d)});
          }
      }
  }
  return all;
}

std::vector<Harmonics> DirectionGrid::harmonics() const {
  std::vector<Harmonics> all(size(), Harmonics{});
  for (const Sample& s : samples(4)) {
    Harmonics y;
    realHarmonics(s.direction, kMostHarmonicOrder, y);
    for (size_t k = 0; k < 4; ++k)
      for (size_t c = 0; c < y.size(); ++c) all[s.reading.at[k]][c] += s.solidAngle * s.reading.weight[k] * y[c];
  }
  return all;
}

}  // namespace pitviper
