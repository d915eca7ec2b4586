#include "tests/support/ray_march.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace pitviper::test {
namespace {
constexpr double kDegree = std::numbers::pi / 180.0;
}

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.15g", value);
  return buffer;
}

std::string text(const glm::dvec3& p) { return "[" + text(p.x) + " m, " + text(p.y) + " m, " + text(p.z) + " m]"; }

std::string Eye::yaml(const std::string& channels, const std::string& more) const {
  const std::string n = std::to_string(pixels);
  return "cameras:\n  - name: c\n    film: {width: " + n + ", height: " + n + "}\n    field_of_view: " + text(field_deg) +
         " deg\n    aperture: 20 mm\n    position: " + text(position) + "\n    look_at: " + text(target) + "\n" + more + "    channels: " + channels + "\n";
}

Line Eye::ray(int column, int row) const {
  const glm::dvec3 forward = glm::normalize(target - position), right = glm::normalize(glm::cross(forward, glm::dvec3(0, 0, 1)));
  const double step = 2.0 * std::tan(0.5 * field_deg * kDegree) / pixels;
  const glm::dvec3 to = forward + step * (column + 0.5 - 0.5 * pixels) * right + step * (0.5 * pixels - row - 0.5) * glm::cross(right, forward);
  return {position, glm::normalize(to)};
}

glm::dmat3 axesOf(double heading_deg, double pitch_deg) {
  const double h = heading_deg * kDegree, p = pitch_deg * kDegree;
  const glm::dvec3 x(std::sin(h) * std::cos(p), std::cos(h) * std::cos(p), std::sin(p)), y(-std::cos(h), std::sin(h), 0.0);
  return {x, y, glm::cross(x, y)};
}

Gauge ellipsoidGauge(const glm::dvec3& s) {
  return [s](const glm::dvec3& p) { return glm::length(p / s) - 1.0; };
}

Gauge frustumGauge(double h, double base, double top) {
  return [=](const glm::dvec3& p) { return std::max(std::abs(p.x) - h, std::hypot(p.y, p.z) - (0.5 * (base + top) + 0.5 * (top - base) / h * p.x)); };
}

Gauge boxGauge(const glm::dvec3& s) {
  return [s](const glm::dvec3& p) { return std::max({std::abs(p.x) - s.x, std::abs(p.y) - s.y, std::abs(p.z) - s.z}); };
}

Stretch chordOf(const Gauge& gauge, const Line& line, double from, double to) {
  auto f = [&](double s) { return gauge(line.at(s)); };
  // Golden section: the bracket shrinks to rounding in 80 steps; any point below 0 will do.
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double a = from, b = to, u = b - golden * (b - a), v = a + golden * (b - a), fu = f(u), fv = f(v);
  for (int i = 0; i < 90 && fu > -1e-12 && fv > -1e-12; ++i) {
    if (fu < fv) b = v, v = u, fv = fu, u = b - golden * (b - a), fu = f(u);
    else a = u, u = v, fu = fv, v = a + golden * (b - a), fv = f(v);
  }
  const double inside = fu < fv ? u : v;
  if (f(inside) >= 0.0) return {};
  auto edge = [&](double in, double out) {
    if (f(out) < 0.0) return out;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (in + out);
      (f(middle) < 0.0 ? in : out) = middle;
    }
    return in;
  };
  return {edge(inside, from), edge(inside, to)};
}

Stretch chordOf(const Gauge& gauge, const Line& line, const glm::dvec3& place, const glm::dmat3& axes, double reach) {
  const double middle = glm::dot(place - line.origin, line.direction);
  const glm::dmat3 turn = glm::transpose(axes);
  const Line near{turn * (line.origin + middle * line.direction - place), turn * line.direction};
  const Stretch s = chordOf(gauge, near, -reach, reach);
  return {middle + s.enter, middle + s.leave};
}

double march(double end, double behind, const std::vector<Fog>& fogs, const std::vector<Sheet>& sheets) {
  std::vector<double> stops{0.0, end};
  for (const auto& f : fogs) stops.insert(stops.end(), {f.where.enter, f.where.leave});
  for (const auto& s : sheets) stops.push_back(s.range);
  std::erase_if(stops, [&](double s) { return !(s >= 0.0 && s <= end); });
  std::sort(stops.begin(), stops.end(), std::greater<>());
  double radiance = behind;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    for (const auto& s : sheets)
      if (s.range == stops[i] && (i == 0 || stops[i - 1] != stops[i])) radiance = s.transmittance * radiance + s.own;
    if (i + 1 == stops.size() || stops[i] == stops[i + 1]) continue;
    const double length = stops[i] - stops[i + 1], middle = 0.5 * (stops[i] + stops[i + 1]);
    double absorption = 0.0, emission = 0.0;
    for (const auto& f : fogs)
      if (f.where.enter < middle && middle < f.where.leave) absorption += f.absorption_per_m, emission += f.absorption_per_m * f.source;
    const int steps = 16 + static_cast<int>(32.0 * absorption * length);
    const double h = length / steps;
    auto slope = [&](double l) { return emission - absorption * l; };
    for (int n = 0; n < steps; ++n) {
      const double k1 = slope(radiance), k2 = slope(radiance + 0.5 * h * k1), k3 = slope(radiance + 0.5 * h * k2), k4 = slope(radiance + h * k3);
      radiance += h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }
  return radiance;
}

double worstError(const Frame& frame, const std::function<double(int, int)>& expected, int* covered) {
  double worst = 0.0;
  int count = 0;
  for (int row = 0; row < frame.height; ++row)
    for (int column = 0; column < frame.width; ++column) {
      const double want = expected(column, row);
      if (std::isnan(want)) continue;
      ++count;
      const double got = static_cast<double>(frame.layers[0].pixels[static_cast<std::size_t>(row * frame.width + column)]);
      EXPECT_TRUE(std::isfinite(got));
      const double error = want != 0.0 ? std::abs(got - want) / std::abs(want) : std::abs(got);
      if (!(error <= worst)) worst = error;
    }
  EXPECT_GT(count, 0);
  if (covered) *covered = count;
  return worst;
}

}  // namespace pitviper::test
