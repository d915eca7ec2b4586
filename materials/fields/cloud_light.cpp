#include "materials/fields/cloud_light.hpp"

#include <array>

#include "sim/parameters/on_threads.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr float kInverse4Pi = 0.0795774715f;
/// Of the drops that the numbers are made for: in the visible and near infrared.
constexpr double kAsymmetry = 0.85;
/// Residual of the sources over what they begin with; steps at most.
constexpr double kTolerance = 1e-4;
constexpr int kMostSteps = 100;
/// Less light than this is none: what comes of it has a logarithm.
constexpr float kLeast = 1e-12f;

enum class From { Sun, Sky, Ground };

struct Ordinate {
  std::array<float, 3> to;
  float weight;
};

std::vector<Ordinate> ordinates() {
  constexpr float m = 0.3500212f, n = 0.8688903f;  // S4: Carlson and Lathrop 1968
  std::vector<Ordinate> all;
  for (const auto& d : {std::array{n, m, m}, std::array{m, n, m}, std::array{m, m, n}})
    for (int s = 0; s < 8; ++s) all.push_back({{(s & 1) ? -d[0] : d[0], (s & 2) ? -d[1] : d[1], (s & 4) ? -d[2] : d[2]}, 1.0f / 24.0f});
  return all;
}

/// Mean and first moments at nodes.
using Moments = std::array<std::vector<float>, 4>;

/// Carries light through the grid along all directions. Around the grid's nodes lies a layer of empty ones, which have what comes in from outside.
class Sweeper {
 public:
  Sweeper(const DensityGrid& grid, double scale, From from) : nodes_(grid.nodes + 2), stride_{1, nodes_.x, static_cast<std::ptrdiff_t>(nodes_.x) * nodes_.y} {
    const std::size_t count = size();
    sigma_.assign(count, 0.0f);
    for (int k = 0; k < grid.nodes.z; ++k)
      for (int j = 0; j < grid.nodes.y; ++j)
        for (int i = 0; i < grid.nodes.x; ++i) sigma_[at(i + 1, j + 1, k + 1)] = static_cast<float>(scale) * grid.value[grid.index(i, j, k)];
    for (const Ordinate& o : ordinates()) {
      Way& w = ways_.emplace_back();
      w.to = o.to, w.weight = o.weight;
      w.incoming = (from == From::Sky && o.to[2] < 0.0f) || (from == From::Ground && o.to[2] > 0.0f) ? 1.0f : 0.0f;
      setUpwind(w, grid.spacing);
    }
    intensity_.resize(count), source_.resize(count);
  }
  std::size_t size() const { return static_cast<std::size_t>(nodes_.x) * static_cast<std::size_t>(nodes_.y) * static_cast<std::size_t>(nodes_.z); }
  std::size_t at(int i, int j, int k) const { return static_cast<std::size_t>(i + j * stride_[1] + k * stride_[2]); }

  /// Moments of the light that sources (by mean and direction, per optical depth) make; `incoming`: with what comes in.
  void apply(const Moments& source, bool incoming, Moments& out) {
    for (auto& o : out) std::fill(o.begin(), o.end(), 0.0f);
    float *const light = intensity_.data(), *const s = source_.data();
    for (const Way& w : ways_) {
      for (std::size_t n = 0; n < source_.size(); ++n) s[n] = source[0][n] + w.to[0] * source[1][n] + w.to[1] * source[2][n] + w.to[2] * source[3][n];
      std::fill(intensity_.begin(), intensity_.end(), incoming ? w.incoming : 0.0f);
      const int x = w.to[0] > 0.0f ? 1 : -1, y = w.to[1] > 0.0f ? 1 : -1, z = w.to[2] > 0.0f ? 1 : -1;
      for (int kk = 1; kk <= nodes_.z - 2; ++kk)
        for (int jj = 1; jj <= nodes_.y - 2; ++jj) {
          std::ptrdiff_t n = static_cast<std::ptrdiff_t>(at(x > 0 ? 1 : nodes_.x - 2, y > 0 ? jj : nodes_.y - 1 - jj, z > 0 ? kk : nodes_.z - 1 - kk));
          for (int i = 1; i <= nodes_.x - 2; ++i, n += x) {
            float came = 0.0f, upwind = 0.0f;
            for (std::size_t q = 0; q < 4; ++q) {
              came += w.share[q] * light[n + w.offset[q]];
              upwind += w.share[q] * s[n + w.offset[q]];
            }
            const auto here = static_cast<std::size_t>(n);
            light[n] = came * w.pass[here] + upwind * w.far[here] + s[n] * w.near[here];
          }
        }
      for (std::size_t n = 0; n < intensity_.size(); ++n) {
        const float each = w.weight * light[n];
        out[0][n] += each;
        for (std::size_t a = 0; a < 3; ++a) out[a + 1][n] += w.to[a] * each;
      }
    }
  }

 private:
  struct Way {
    std::array<float, 3> to{};
    float weight = 0.0f, incoming = 0.0f;
    std::array<std::ptrdiff_t, 4> offset{};  ///< nodes of the face that a line came through, and their shares
    std::array<float, 4> share{};
    std::vector<float> pass, near, far;  ///< of the stretch from there: what it lets through, weights of the sources at its ends
  };

  void setUpwind(Way& w, const glm::dvec3& spacing) {
    int axis = 0;
    double length = INFINITY;
    for (int a = 0; a < 3; ++a)
      if (const double l = spacing[a] / std::abs(static_cast<double>(w.to[static_cast<std::size_t>(a)])); l < length) length = l, axis = a;
    std::array<std::ptrdiff_t, 3> back{};
    std::array<float, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
      back[a] = w.to[a] > 0.0f ? -stride_[a] : stride_[a];
      part[a] = static_cast<float>(length * std::abs(static_cast<double>(w.to[a])) / spacing[static_cast<int>(a)]);
    }
    const auto first = static_cast<std::size_t>(axis), u = (first + 1) % 3, v = (first + 2) % 3;
    for (std::size_t q = 0; q < 4; ++q) {
      w.offset[q] = back[first] + ((q & 1) ? back[u] : 0) + ((q & 2) ? back[v] : 0);
      w.share[q] = ((q & 1) ? part[u] : 1.0f - part[u]) * ((q & 2) ? part[v] : 1.0f - part[v]);
    }
    w.pass.assign(size(), 1.0f), w.near.assign(size(), 0.0f), w.far.assign(size(), 0.0f);
    for (int k = 1; k < nodes_.z - 1; ++k)
      for (int j = 1; j < nodes_.y - 1; ++j)
        for (int i = 1; i < nodes_.x - 1; ++i) {
          const std::size_t n = at(i, j, k);
          float up = 0.0f;
          for (std::size_t q = 0; q < 4; ++q) up += w.share[q] * sigma_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(n) + w.offset[q])];
          const float depth = 0.5f * static_cast<float>(length) * (up + sigma_[n]), left = std::exp(-depth),
                      mean = depth > 1e-3f ? (1.0f - left) / depth : 1.0f - 0.5f * depth;
          w.pass[n] = left, w.near[n] = 1.0f - mean, w.far[n] = mean - left;
        }
  }

  glm::ivec3 nodes_;
  std::array<std::ptrdiff_t, 3> stride_;
  std::vector<float> sigma_, intensity_, source_;
  std::vector<Way> ways_;
};

double product(const Moments& a, const Moments& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t n = 0; n < a[c].size(); ++n) sum += static_cast<double>(a[c][n]) * static_cast<double>(b[c][n]);
  return sum;
}

/// Mean intensity at the grid's nodes of light of an irradiance of 1 (the sun's, once scattered at least) or of a radiance of 1 from above or below.
std::vector<float> meanIntensity(const DensityGrid& grid, const std::vector<float>& tauSun, const glm::dvec3& toSun, double albedo, From from) {
  const physics::CloudOptics o = physics::cloudOptics(1.0, albedo, kAsymmetry);
  const double extinction = physics::cloudScale(albedo, kAsymmetry);
  Sweeper sweeper(grid, extinction, from);
  const std::size_t count = sweeper.size();
  const auto w = static_cast<float>(o.scaledAlbedo), g3 = static_cast<float>(3.0 * o.scaledAsymmetry);
  std::array<Moments, 9> all;
  for (Moments& m : all) m.fill(std::vector<float>(count, 0.0f));
  auto& [source, b, x, r, r0, direction, v, s, t] = all;
  const auto each = [&](const auto& f) {
    for (std::size_t c = 0; c < 4; ++c)
      for (std::size_t n = 0; n < count; ++n) f(c, n);
  };
  for (int k = 0; from == From::Sun && k < grid.nodes.z; ++k)
    for (int j = 0; j < grid.nodes.y; ++j)
      for (int i = 0; i < grid.nodes.x; ++i) {
        const float beam = w * kInverse4Pi * std::exp(-static_cast<float>(extinction) * tauSun[grid.index(i, j, k)]);
        const std::size_t n = sweeper.at(i + 1, j + 1, k + 1);
        source[0][n] = beam;
        for (int a = 0; a < 3; ++a) source[static_cast<std::size_t>(a) + 1][n] = -g3 * beam * static_cast<float>(toSun[a]);
      }
  sweeper.apply(source, true, b);
  const auto multiply = [&](const Moments& in, Moments& out) {
    each([&](std::size_t c, std::size_t n) { source[c][n] = (c == 0 ? w : w * g3) * in[c][n]; });
    sweeper.apply(source, false, out);
    each([&](std::size_t c, std::size_t n) { out[c][n] = in[c][n] - out[c][n]; });
  };
  x = b;
  multiply(x, r);
  each([&](std::size_t c, std::size_t n) { direction[c][n] = r0[c][n] = r[c][n] = b[c][n] - r[c][n]; });
  const double target = kTolerance * kTolerance * product(b, b);
  double rho = product(r0, r);
  for (int step = 0; step < kMostSteps && product(r, r) > target; ++step) {
    multiply(direction, v);
    const double alpha = rho / product(r0, v);
    each([&](std::size_t c, std::size_t n) { s[c][n] = r[c][n] - static_cast<float>(alpha) * v[c][n]; });
    multiply(s, t);
    const double tt = product(t, t), omega = tt > 0.0 ? product(t, s) / tt : 0.0;
    each([&](std::size_t c, std::size_t n) {
      x[c][n] += static_cast<float>(alpha) * direction[c][n] + static_cast<float>(omega) * s[c][n];
      r[c][n] = s[c][n] - static_cast<float>(omega) * t[c][n];
    });
    const double next = product(r0, r), beta = next / rho * alpha / omega;
    rho = next;
    each([&](std::size_t c, std::size_t n) { direction[c][n] = r[c][n] + static_cast<float>(beta) * (direction[c][n] - static_cast<float>(omega) * v[c][n]); });
  }
  std::vector<float> mean(grid.value.size());
  for (int k = 0; k < grid.nodes.z; ++k)
    for (int j = 0; j < grid.nodes.y; ++j)
      for (int i = 0; i < grid.nodes.x; ++i) mean[grid.index(i, j, k)] = std::max(x[0][sweeper.at(i + 1, j + 1, k + 1)], kLeast);
  return mean;
}

}  // namespace

std::vector<glm::vec4> cloudNumbers(const DensityGrid& extinction, const glm::dvec3& toSun, bool lit, const std::vector<float>& before) {
  const std::size_t count = extinction.value.size();
  DensityGrid tauSun(extinction.nodes, extinction.first, extinction.spacing);
  const auto planes = static_cast<std::size_t>(extinction.nodes.z);
  if (lit)
    onStretches(planes, 1, [&](std::size_t from, std::size_t to) {
      for (int k = static_cast<int>(from); k < static_cast<int>(to); ++k)
        for (int j = 0; j < extinction.nodes.y; ++j)
          for (int i = 0; i < extinction.nodes.x; ++i)
            tauSun.value[extinction.index(i, j, k)] = static_cast<float>(extinction.along(extinction.place(i, j, k), toSun, 1.0));
    });
  for (std::size_t n = 0; lit && n < before.size(); ++n) tauSun.value[n] += before[n];
  // Each by itself: nothing depends on how many threads there are.
  const glm::dvec4 albedos = physics::cloudAlbedos();
  std::array<std::vector<float>, 4> sun;
  std::array<std::vector<float>, 3> around;  // of the sky without and with absorption, of the ground with it
  onAllThreads(7, [&](const auto& next) {
    for (std::size_t job = next(); job < 7; job = next()) {
      if (job < 4) {
        const auto c = static_cast<int>(job);
        sun[job].assign(count, kLeast);
        if (!lit) continue;
        sun[job] = meanIntensity(extinction, tauSun.value, toSun, albedos[c], From::Sun);
        const auto w = static_cast<float>(physics::cloudOptics(1.0, albedos[c], kAsymmetry).scaledAlbedo);
        for (float& v : sun[job]) v /= w;
      } else {
        around[job - 4] = meanIntensity(extinction, tauSun.value, toSun, job == 4 ? 1.0 : physics::kCloudDarkest, job == 6 ? From::Ground : From::Sky);
      }
    }
  });
  std::vector<glm::vec4> texels(kCloudTexels * count);
  const glm::ivec3 last = extinction.nodes - 1;
  for (int k = 0; k <= last.z; ++k)
    for (int j = 0; j <= last.y; ++j)
      for (int i = 0; i <= last.x; ++i) {
        const std::size_t n = extinction.index(i, j, k);
        const float sky = std::clamp(around[0][n], 1e-4f, 1.0f - 1e-4f);
        const auto fall = [](float bright, float dark) { return std::acosh(std::max(1.0f, bright / dark)); };
        const auto slope = [&](int a) {
          glm::ivec3 low(i, j, k), high(i, j, k);
          low[a] = std::max(low[a] - 1, 0), high[a] = std::min(high[a] + 1, last[a]);
          return (sun[1][extinction.index(high.x, high.y, high.z)] - sun[1][extinction.index(low.x, low.y, low.z)]) /
                 static_cast<float>((high[a] - low[a]) * extinction.spacing[a]);
        };
        glm::vec4* const out = &texels[kCloudTexels * n];
        out[0] = {extinction.value[n], tauSun.value[n], sky, fall(sky, around[1][n])};
        out[1] = {sun[0][n], sun[1][n], sun[2][n], sun[3][n]};
        out[2] = {fall(1.0f - sky, around[2][n]), slope(0), slope(1), slope(2)};
      }
  return texels;
}

}  // namespace pitviper
