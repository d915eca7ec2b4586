#include "sensors/optical_transfer.hpp"

#include <algorithm>
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
  const int points = std::clamp(16 + static_cast<int>(std::abs(waves)), 16, 96);
  static thread_local std::vector<std::vector<QuadratureNode>> rules(97);
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

SpreadKernel spreadKernel(const std::function<double(double, double)>& transfer, double cutoff_per_m, double cell_m, int reach) {
  const bool isSampled = cutoff_per_m * cell_m <= kSampled;
  cutoff_per_m = std::min(cutoff_per_m, kMostCycles / cell_m);
  // Even in both: a quarter of the plane, Gauss points in pieces that follow the cosines of the farthest cell.
  const double turns = cutoff_per_m * cell_m * (reach + 1);
  const int pieces = std::max(1, static_cast<int>(std::ceil(turns)));
  std::vector<double> f, weight;
  for (int p = 0; p < pieces; ++p)
    for (const QuadratureNode& q : gaussLegendre(8, cutoff_per_m * p / pieces, cutoff_per_m * (p + 1) / pieces)) f.push_back(q.x), weight.push_back(q.weight);
  const auto averaged = [&](double x) {
    const double a = kPi * cell_m * x, s = a > 1e-8 && !isSampled ? std::sin(a) / a : 1.0;
    return s * s;
  };
  const std::size_t n = f.size(), cells = static_cast<std::size_t>(reach) + 1;
  std::vector<double> plane(n * n), cosine(cells * n);
  for (std::size_t y = 0; y < n; ++y)
    for (std::size_t x = 0; x < n; ++x) plane[y * n + x] = transfer(f[x], f[y]) * weight[x] * weight[y] * averaged(f[x]) * averaged(f[y]);
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t x = 0; x < n; ++x) cosine[i * n + x] = 2.0 * cell_m * std::cos(2.0 * kPi * cell_m * static_cast<double>(i) * f[x]);
  std::vector<double> rows(cells * n, 0.0);
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t y = 0; y < n; ++y)
      for (std::size_t x = 0; x < n; ++x) rows[i * n + y] += cosine[i * n + x] * plane[y * n + x];
  SpreadKernel kernel;
  kernel.reach = reach;
  kernel.share.assign((2 * cells - 1) * (2 * cells - 1), 0.0);
  for (int j = 0; j <= reach; ++j)
    for (int i = 0; i <= reach; ++i) {
      double sum = 0.0;
      for (std::size_t y = 0; y < n; ++y) sum += cosine[static_cast<std::size_t>(j) * n + y] * rows[static_cast<std::size_t>(i) * n + y];
      for (int a : {i, -i})
        for (int b : {j, -j}) kernel.share[static_cast<std::size_t>((b + reach) * (2 * reach + 1) + a + reach)] = sum;
    }
  return kernel;
}

}  // namespace pitviper
