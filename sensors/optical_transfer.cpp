#include "sensors/optical_transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

double apertureTransfer(double shift, double obscuration, double defocus_waves) {
  const double s = std::abs(shift), e = obscuration;
  if (s >= 2.0) return 0.0;
  const double half = 0.5 * s, area = kPi * (1.0 - e * e);
  // Even in x. Chords bend like roots at x = 1 - s/2 and where an obscuration begins, is widest and ends.
  std::vector<double> edges{0.0, 1.0 - half};
  for (double x : {half - e, half, half + e})
    if (e > 0.0 && x > 0.0 && x < 1.0 - half) edges.push_back(x);
  // There a chord's end within one obscuration meets that of the other pupil's edge.
  if (e > 0.0 && s > 0.0 && (1.0 - e * e) / (2.0 * s) < 1.0 - half) edges.push_back((1.0 - e * e) / (2.0 * s));
  std::sort(edges.begin(), edges.end());
  const double waves = 4.0 * kPi * defocus_waves * s;
  // A rule of n points holds some n radians of a cosine; few rules, as each is worked out once.
  constexpr int kTogether = 16, kMost = 1024;
  const double most = std::abs(waves) * (1.0 - half);
  const int points = std::min(kTogether * (1 + static_cast<int>(std::ceil(most / kTogether))), kMost);
  static thread_local std::vector<std::vector<QuadratureNode>> rules(kMost + 1);
  if (rules[static_cast<std::size_t>(points)].empty()) rules[static_cast<std::size_t>(points)] = gaussLegendre(points, 0.0, 1.0);
  const auto root = [](double x) { return x > 0.0 ? std::sqrt(x) : 0.0; };
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < edges.size(); ++k)
    for (const QuadratureNode& q : rules[static_cast<std::size_t>(points)]) {
      // u^2 (3 - 2u): smooth at both ends of a piece.
      const double width = edges[k + 1] - edges[k], x = edges[k] + width * q.x * q.x * (3.0 - 2.0 * q.x), near = x - half, far = x + half;
      const double upper = root(1.0 - far * far), lower = root(e * e - near * near);  // the other pupil's is within it
      sum += q.weight * 6.0 * q.x * (1.0 - q.x) * width * 4.0 * std::max(0.0, upper - lower) * std::cos(waves * x);
    }
  return sum / area;
}

double wavefrontTransfer(double nu, double rms_waves) {
  const double w = rms_waves / kMostWavefront_waves, off = nu - 0.5;
  return nu <= 0.0 || nu >= 1.0 ? 1.0 : std::max(0.0, 1.0 - w * w * (1.0 - 4.0 * off * off));
}

double SpreadKernel::sum() const { return std::accumulate(share.begin(), share.end(), 0.0); }

double SpreadKernel::transfer(double cyclesPerCell) const {
  double sum = 0.0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) sum += at(i, j) * std::cos(2.0 * kPi * cyclesPerCell * i);
  return sum;
}

namespace {

/// A quarter of the plane of frequencies, as all is even in both.
struct Frequencies {
  std::vector<double> f, weight;
  /// Gauss points in pieces that follow the cosines of a cell so far away.
  Frequencies(double cutoff_per_m, double farthest_m) {
    const int pieces = std::max(1, static_cast<int>(std::ceil(cutoff_per_m * farthest_m)));
    for (int p = 0; p < pieces; ++p)
      for (const QuadratureNode& q : gaussLegendre(8, cutoff_per_m * p / pieces, cutoff_per_m * (p + 1) / pieces)) f.push_back(q.x), weight.push_back(q.weight);
  }
  /// 4 integral of g(fx, fy) cos(2 pi fx a) cos(2 pi fy b) for a and b of a list each: [b][a].
  template <class Of>
  std::vector<double> cosines(const Of& g, const std::vector<double>& places_m) const {
    const std::size_t n = f.size(), count = places_m.size();
    std::vector<double> plane(n * n), cosine(count * n), rows(count * n, 0.0), all;
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) plane[y * n + x] = g(f[x], f[y]) * weight[x] * weight[y];
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t x = 0; x < n; ++x) cosine[i * n + x] = 2.0 * std::cos(2.0 * kPi * places_m[i] * f[x]);
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t y = 0; y < n; ++y) rows[i * n + y] = std::inner_product(&cosine[i * n], &cosine[i * n] + n, &plane[y * n], 0.0);
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t i = 0; i < count; ++i) all.push_back(std::inner_product(&cosine[j * n], &cosine[j * n] + n, &rows[i * n], 0.0));
    return all;
  }
};

double sinc(double x) { return std::abs(x) > 1e-8 ? std::sin(kPi * x) / (kPi * x) : 1.0; }

}  // namespace

double cyclesOf(int reach) {
  constexpr double kCellsTimesCycles = 288.0;
  return std::clamp(std::floor(kCellsTimesCycles / (reach + 1)), 1.0, kMostCycles);
}

SpreadKernel spreadKernel(const std::function<double(double, double)>& transfer, double cutoff_per_m, double cell_m, int reach) {
  const bool isSampled = cutoff_per_m * cell_m <= kSampled;
  cutoff_per_m = std::min(cutoff_per_m, cyclesOf(reach) / cell_m);
  std::vector<double> places;
  for (int i = 0; i <= reach; ++i) places.push_back(cell_m * i);
  const auto averaged = [&](double f) { return isSampled ? 1.0 : sinc(cell_m * f) * sinc(cell_m * f); };
  const std::vector<double> quarter =
      Frequencies(cutoff_per_m, cell_m * (reach + 1))
          .cosines([&](double fx, double fy) { return cell_m * cell_m * transfer(fx, fy) * averaged(fx) * averaged(fy); }, places);
  SpreadKernel kernel;
  kernel.reach = reach;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) kernel.share.push_back(quarter[static_cast<std::size_t>(std::abs(j) * (reach + 1) + std::abs(i))]);
  return kernel;
}

PointResponse::PointResponse(const std::function<double(double, double)>& transfer, double cutoff_per_m, double cell_m, int reach) : reach_(reach) {
  // So that between entries a cubic is good to 1e-3 of what little the highest frequencies leave.
  constexpr double kEntriesACycle = 11.0, kMostEntries = 1500.0;
  const double cutoff = std::min(cutoff_per_m, cyclesOf(reach) / cell_m);
  steps_ = static_cast<int>(std::clamp(std::ceil(kEntriesACycle * cutoff * cell_m), 4.0, std::max(4.0, kMostEntries / (reach + 1))));
  side_ = (reach + 1) * steps_ + 3;
  std::vector<double> places;
  for (int i = 0; i < side_; ++i) places.push_back(cell_m * i / steps_);
  table_ = Frequencies(cutoff, cell_m * (reach + 2))
               .cosines([&](double fx, double fy) { return cell_m * cell_m * transfer(fx, fy) * sinc(cell_m * fx) * sinc(cell_m * fy); }, places);
}

double PointResponse::share(double x, double y) const {
  const double u = std::abs(x) * steps_, v = std::abs(y) * steps_;
  const int i = static_cast<int>(u), j = static_cast<int>(v);
  if (i + 2 >= side_ || j + 2 >= side_) return 0.0;
  // Lagrange's cubic through four neighbours each way.
  const auto weights = [](double t) {
    return std::array<double, 4>{-t * (t - 1.0) * (t - 2.0) / 6.0, (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0, -(t + 1.0) * t * (t - 2.0) / 2.0,
                                 (t + 1.0) * t * (t - 1.0) / 6.0};
  };
  const auto a = weights(u - i), b = weights(v - j);
  double sum = 0.0;
  for (int q = 0; q < 4; ++q)
    for (int p = 0; p < 4; ++p) sum += a[static_cast<std::size_t>(p)] * b[static_cast<std::size_t>(q)] * entry(i + p - 1, j + q - 1);
  return sum;
}

}  // namespace pitviper
