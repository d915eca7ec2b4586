#include "sim/scene/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// What a cell of n evenly over m has of each of those: first, and weights that add up to 1.
struct Parts {
  int first = 0;
  std::vector<double> weight;
};

std::vector<Parts> partsOf(int m, int n) {
  std::vector<Parts> all(static_cast<size_t>(n));
  for (int i = 0; i < n; ++i) {
    const double from = static_cast<double>(i) * m / n, to = (i + 1.0) * m / n;
    Parts& p = all[static_cast<size_t>(i)];
    p.first = static_cast<int>(from);
    for (int k = p.first; k < m && static_cast<double>(k) < to - 1e-9; ++k)
      p.weight.push_back((std::min(to, k + 1.0) - std::max(from, static_cast<double>(k))) * n / m);
  }
  return all;
}

/// Room for its texels and no more.
void reserve(TextureLevel& l, bool moments) {
  const auto texels = static_cast<size_t>(l.width) * static_cast<size_t>(l.height);
  l.mean.reserve(texels);
  if (moments) l.second.reserve(texels), l.third.reserve(texels);
}

TextureLevel halved(const TextureLevel& from, bool moments) {
  TextureLevel l;
  l.width = (from.width + 1) / 2;
  l.height = (from.height + 1) / 2;
  const auto columns = partsOf(from.width, l.width), rows = partsOf(from.height, l.height);
  reserve(l, moments);
  for (const Parts& y : rows)
    for (const Parts& x : columns) {
      const auto over = [&](const auto& value) {
        double sum = 0.0;
        for (size_t j = 0; j < y.weight.size(); ++j)
          for (size_t i = 0; i < x.weight.size(); ++i)
            sum += y.weight[j] * x.weight[i] * value((static_cast<size_t>(y.first) + j) * static_cast<size_t>(from.width) + static_cast<size_t>(x.first) + i);
        return sum;
      };
      const double mean = over([&](size_t t) { return static_cast<double>(from.mean[t]); });
      l.mean.push_back(static_cast<float>(mean));
      if (!moments) continue;
      const auto own = [](const std::vector<float>& m, size_t t) { return m.empty() ? 0.0 : static_cast<double>(m[t]); };
      l.second.push_back(static_cast<float>(over([&](size_t t) {
        const double d = static_cast<double>(from.mean[t]) - mean;
        return own(from.second, t) + d * d;
      })));
      l.third.push_back(static_cast<float>(over([&](size_t t) {
        const double d = static_cast<double>(from.mean[t]) - mean;
        return own(from.third, t) + d * (3.0 * own(from.second, t) + d * d);
      })));
    }
  return l;
}

/// The four texels about a place, and their weights.
struct Corners {
  std::array<size_t, 4> texel;
  std::array<double, 4> weight;
};

Corners cornersOf(int width, int height, bool repeats, glm::dvec2 at) {
  at -= 0.5;
  const glm::dvec2 cell = glm::floor(at), f = at - cell;
  const auto held = [repeats](double k, int n) { return static_cast<size_t>(repeats ? k - std::floor(k / n) * n : std::clamp(k, 0.0, n - 1.0)); };
  const size_t x0 = held(cell.x, width), x1 = held(cell.x + 1, width), y0 = held(cell.y, height) * static_cast<size_t>(width),
               y1 = held(cell.y + 1, height) * static_cast<size_t>(width);
  return {{y0 + x0, y0 + x1, y1 + x0, y1 + x1}, {(1 - f.x) * (1 - f.y), f.x * (1 - f.y), (1 - f.x) * f.y, f.x * f.y}};
}

double bilinear(const std::vector<float>& texels, const Corners& c) {
  double sum = 0.0;
  for (size_t k = 0; k < 4; ++k) sum += c.weight[k] * static_cast<double>(texels[c.texel[k]]);
  return sum;
}

/// What is read between the middles of texels, over the square of each: two Gauss points a side of each quarter take a cube of what is straight exactly.
TextureLevel cellsOf(const Texture& t, bool moments) {
  constexpr double kGauss = 0.28867513459481287;
  constexpr std::array kAt{0.25 - 0.5 * kGauss, 0.25 + 0.5 * kGauss, 0.75 - 0.5 * kGauss, 0.75 + 0.5 * kGauss};
  const auto held = [&t](int k, int n) { return static_cast<size_t>(t.repeats ? (k + n) % n : std::clamp(k, 0, n - 1)); };
  TextureLevel cells{t.width, t.height, {}, {}, {}};
  reserve(cells, moments);
  for (int y = 0; y < t.height; ++y)
    for (int x = 0; x < t.width; ++x) {
      // A texel and the eight about it, less itself.
      std::array<std::array<double, 3>, 3> near;
      const auto at = [&](int i, int j) { return static_cast<double>(t.texels[held(y + j, t.height) * static_cast<size_t>(t.width) + held(x + i, t.width)]); };
      const double middle = at(0, 0);
      bool even = true;
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          double& n = near[static_cast<size_t>(j)][static_cast<size_t>(i)];
          n = at(i - 1, j - 1) - middle;
          even = even && n == 0.0;
        }
      double s1 = 0.0, s2 = 0.0, s3 = 0.0;
      for (size_t k = 0; !even && k < 16; ++k) {
        const double u = kAt[k % 4], v = kAt[k / 4];
        const size_t i = u < 0.5 ? 0 : 1, j = v < 0.5 ? 0 : 1;
        const double fx = u < 0.5 ? u + 0.5 : u - 0.5, fy = v < 0.5 ? v + 0.5 : v - 0.5;
        const double d = (1.0 - fy) * ((1.0 - fx) * near[j][i] + fx * near[j][i + 1]) + fy * ((1.0 - fx) * near[j + 1][i] + fx * near[j + 1][i + 1]);
        s1 += d / 16.0, s2 += d * d / 16.0, s3 += d * d * d / 16.0;
      }
      cells.mean.push_back(static_cast<float>(middle + s1));
      if (!moments) continue;
      cells.second.push_back(static_cast<float>(s2 - s1 * s1));
      cells.third.push_back(static_cast<float>(s3 - 3.0 * s1 * s2 + 2.0 * s1 * s1 * s1));
    }
  return cells;
}

}  // namespace

void makeLevels(Texture& t, bool moments) {
  t.levels.clear();
  TextureLevel own = cellsOf(t, moments);
  for (const TextureLevel* from = &own; from->width > 1 || from->height > 1; from = &t.levels.back()) {
    TextureLevel next = halved(*from, moments);
    t.levels.push_back(std::move(next));
  }
  if (moments) t.cells = std::move(own);
}

TextureTaps tapsFor(double accuracy) {
  if (accuracy >= 0.05) return {7, 1, 8};
  if (accuracy >= 0.005) return {8, 2, 8};
  if (accuracy >= 0.0005) return {10, 3, 16};
  return {14, 6, 32};
}

double textureValue(const Texture& t, glm::dvec2 uv) { return bilinear(t.texels, cornersOf(t.width, t.height, t.repeats, uv * glm::dvec2(t.width, t.height))); }

TextureMoments textureMoments(const Texture& t, glm::dvec2 uv, const Footprint& footprint, const TextureTaps& asked) {
  const glm::dvec2 size(t.width, t.height), middle = uv * size;
  const physics::Taps taps = physics::tapsOf(footprint.across * size, footprint.up * size, 0.1 * asked.perTenTexels, asked.mostAcross, asked.mostAlong,
                                             static_cast<int>(t.levels.size()));
  const TextureLevel* level = taps.level > 0 ? &t.levels[static_cast<size_t>(taps.level) - 1] : t.cells.mean.empty() ? nullptr : &t.cells;
  const int width = level ? level->width : t.width, height = level ? level->height : t.height;
  // Of the texture itself a few places may by chance all be its brightest ones: what lies over the squares of texels is taken as the pixel grows to one, and
  // nothing of it below half of one, where the squares would bring in what the pixel does not see.
  const auto share = [](double texels) { return std::clamp(2.0 * texels - 1.0, 0.0, 1.0); };
  const double spread = taps.level > 0 ? 1.0
                        : level        ? share(glm::length(taps.along) * taps.alongCount) * share(glm::length(taps.across) * taps.acrossCount)
                                       : 0.0;
  const double from = textureValue(t, uv);
  double s1 = 0.0, s2 = 0.0, s3 = 0.0;
  for (int j = 0; j < taps.acrossCount; ++j)
    for (int i = 0; i < taps.alongCount; ++i) {
      const glm::dvec2 at = middle + (i + 0.5 - 0.5 * taps.alongCount) * taps.along + (j + 0.5 - 0.5 * taps.acrossCount) * taps.across;
      const Corners c = cornersOf(width, height, t.repeats, at / size * glm::dvec2(width, height));
      if (spread < 1.0) {
        const double d = bilinear(t.texels, c) - from, part = 1.0 - spread;
        s1 += part * d, s2 += part * d * d, s3 += part * d * d * d;
      }
      for (size_t k = 0; spread > 0.0 && k < 4; ++k) {
        const double d = static_cast<double>(level->mean[c.texel[k]]) - from, part = spread * c.weight[k];
        const double second = level->second.empty() ? 0.0 : static_cast<double>(level->second[c.texel[k]]),
                     third = level->third.empty() ? 0.0 : static_cast<double>(level->third[c.texel[k]]);
        s1 += part * d, s2 += part * (second + d * d), s3 += part * (third + d * (3.0 * second + d * d));
      }
    }
  const double n = taps.alongCount * taps.acrossCount, m = s1 / n;
  return {from + m, s2 / n - m * m, s3 / n - 3.0 * m * s2 / n + 2.0 * m * m * m};
}

}  // namespace pitviper
