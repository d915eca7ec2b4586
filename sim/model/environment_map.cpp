#include "sim/model/environment_map.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/image/srgb.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Places at which a picture is looked at, at least: some for each entry of a grid.
constexpr double kPlaces = 2e5;
/// Ends and step of the primaries [um].
constexpr double kLow_um = 0.36, kHigh_um = 0.83, kStep_um = 0.005;

/// East, north, up of (right, ahead, up) as seen with a heading.
glm::dvec3 turned(const glm::dvec3& d, double heading_rad) {
  const double s = std::sin(heading_rad), c = std::cos(heading_rad);
  return {c * d.x + s * d.y, c * d.y - s * d.x, d.z};
}

/// Where red begins, where green lies and how wide, where blue ends: as painted samples are, that is, not pure.
double primary(int which, double um) {
  switch (which) {
    case 0:
      return 0.045 + 0.60 / (1.0 + std::exp(-(um - 0.605) / 0.012));
    case 1:
      return 0.055 + 0.27 * std::exp(-0.5 * std::pow((um - 0.535) / 0.037, 2.0));
    default:
      return 0.045 + 0.25 * std::exp(-0.5 * std::pow((um - 0.450) / 0.032, 2.0));
  }
}

}  // namespace

glm::dvec3 mapDirection(MapLayout layout, double across, double down, double heading_rad) {
  if (layout == MapLayout::LatitudeLongitude) {
    const double e = kPi * (0.5 - down), a = 2.0 * kPi * (across - 0.5);
    return turned({std::cos(e) * std::sin(a), std::cos(e) * std::cos(a), std::sin(e)}, heading_rad);
  }
  const int face = std::min(static_cast<int>(6.0 * across), 5);
  const double u = 2.0 * (6.0 * across - face) - 1.0, v = 1.0 - 2.0 * down;
  const glm::dvec3 of[] = {{u, 1, v}, {1, -u, v}, {-u, -1, v}, {-1, u, v}, {u, -v, 1}, {u, v, -1}};
  return turned(glm::normalize(of[face]), heading_rad);
}

double mapSolidAngle(MapLayout layout, double across, double down) {
  if (layout == MapLayout::LatitudeLongitude) return 2.0 * kPi * kPi * std::sin(kPi * down);
  const double u = 2.0 * (6.0 * across - std::floor(6.0 * across)) - 1.0, v = 1.0 - 2.0 * down;
  return 24.0 / std::pow(1.0 + u * u + v * v, 1.5);
}

std::vector<std::vector<double>> layersOnGrid(const DirectionGrid& grid, const std::vector<const FloatLayer*>& layers, int width, int height, MapLayout layout,
                                              double heading_rad) {
  const int finer = std::max(static_cast<int>(std::ceil(std::sqrt(kPlaces / (static_cast<double>(width) * height)))), 1);
  std::vector<std::vector<double>> sum(grid.size(), std::vector<double>(layers.size(), 0.0));
  std::vector<double> whole(grid.size(), 0.0);
  for (int y = 0; y < height * finer; ++y)
    for (int x = 0; x < width * finer; ++x) {
      const double across = (x + 0.5) / (static_cast<double>(width) * finer), down = (y + 0.5) / (static_cast<double>(height) * finer);
      const double weight = mapSolidAngle(layout, across, down);
      const DirectionGrid::Reading r = grid.at(mapDirection(layout, across, down, heading_rad));
      const auto pixel = static_cast<std::size_t>(y / finer) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x / finer);
      for (std::size_t k = 0; k < 4; ++k) {
        whole[r.at[k]] += weight * r.weight[k];
        for (std::size_t l = 0; l < layers.size(); ++l) sum[r.at[k]][l] += weight * r.weight[k] * static_cast<double>(layers[l]->pixels[pixel]);
      }
    }
  for (std::size_t g = 0; g < sum.size(); ++g)
    for (double& v : sum[g]) v = whole[g] > 0.0 ? v / whole[g] : 0.0;
  return sum;
}

std::array<Spectrum, 3> raisedPrimaries(const Spectrum& light, const Spectrum& x, const Spectrum& y, const Spectrum& z) {
  const auto colourOf = [&](const auto& spectrum) {
    glm::dvec3 xyz(0.0);
    const int steps = static_cast<int>(std::lround((kHigh_um - kLow_um) / (0.2 * kStep_um)));
    for (int i = 0; i < steps; ++i) {
      const double um = kLow_um + (i + 0.5) * 0.2 * kStep_um, value = spectrum(um);
      xyz += value * glm::dvec3(x(um), y(um), z(um));
    }
    return linearSrgb(xyz);
  };
  glm::dmat3 own;
  for (int k = 0; k < 3; ++k) own[k] = colourOf([&](double um) { return primary(k, um) * light(um); });
  const glm::dvec3 whole = colourOf([&](double um) { return light(um); });
  if (!(std::abs(glm::determinant(own)) > 1e-9 * std::pow(glm::length(whole), 3.0))) throw std::invalid_argument("a light without colours of its own");
  const glm::dvec3 weight = glm::inverse(own) * whole;
  std::array<Spectrum, 3> all;
  for (int k = 0; k < 3; ++k) {
    Spectrum::Table table;
    table.name = "a primary of an environment map";
    for (int i = 0; i <= static_cast<int>(std::lround((kHigh_um - kLow_um) / kStep_um)); ++i) {
      const double um = std::min(kLow_um + kStep_um * i, kHigh_um);
      table.wavelength_um.push_back(um), table.value.push_back(weight[k] * primary(k, um));
    }
    all[static_cast<std::size_t>(k)] = Spectrum(std::move(table)) * light;
  }
  return all;
}

}  // namespace pitviper
