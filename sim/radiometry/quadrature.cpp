#include "sim/radiometry/quadrature.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace pitviper {
namespace {

/// Eigenvalues of a symmetric tridiagonal matrix and the first components of its eigenvectors, by implicit QL with shifts.
/// Source: Golub and Welsch 1969, Math. Comp. 23, 221.
void tridiagonalEigen(std::vector<double>& diagonal, std::vector<double> offDiagonal, std::vector<double>& first) {
  const int n = static_cast<int>(diagonal.size());
  first.assign(diagonal.size(), 0.0);
  first[0] = 1.0;
  offDiagonal.resize(diagonal.size(), 0.0);
  auto& d = diagonal;
  auto& e = offDiagonal;
  for (int l = 0; l < n; ++l) {
    for (int iteration = 0;; ++iteration) {
      int m = l;
      for (; m < n - 1; ++m)
        if (std::abs(e[static_cast<size_t>(m)]) <= 1e-16 * (std::abs(d[static_cast<size_t>(m)]) + std::abs(d[static_cast<size_t>(m) + 1]))) break;
      if (m == l) break;
      if (iteration > 200) throw std::runtime_error("quadrature: the eigenvalue iteration did not converge");
      const auto L = static_cast<size_t>(l);
      double g = (d[L + 1] - d[L]) / (2.0 * e[L]);
      double r = std::hypot(g, 1.0);
      g = d[static_cast<size_t>(m)] - d[L] + e[L] / (g + std::copysign(r, g));
      double s = 1.0, c = 1.0, p = 0.0;
      int i = m - 1;
      for (; i >= l; --i) {
        const auto I = static_cast<size_t>(i);
        double f = s * e[I];
        const double b = c * e[I];
        r = std::hypot(f, g);
        e[I + 1] = r;
        if (r == 0.0) {
          d[I + 1] -= p;
          e[static_cast<size_t>(m)] = 0.0;
          break;
        }
        s = f / r;
        c = g / r;
        g = d[I + 1] - p;
        r = (d[I] - g) * s + 2.0 * c * b;
        p = s * r;
        d[I + 1] = g + p;
        g = c * r - b;
        f = first[I + 1];
        first[I + 1] = s * first[I] + c * f;
        first[I] = c * first[I] - s * f;
      }
      if (r == 0.0 && i >= l) continue;
      d[L] -= p;
      e[L] = g;
      e[static_cast<size_t>(m)] = 0.0;
    }
  }
}

std::vector<QuadratureNode> fromRecurrence(std::vector<double> alpha, const std::vector<double>& beta, double total) {
  std::vector<double> off;
  for (size_t k = 1; k < beta.size(); ++k) off.push_back(std::sqrt(beta[k]));
  std::vector<double> first;
  tridiagonalEigen(alpha, off, first);
  std::vector<QuadratureNode> nodes;
  for (size_t i = 0; i < alpha.size(); ++i) nodes.push_back({alpha[i], total * first[i] * first[i]});
  std::sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  return nodes;
}

}  // namespace

std::vector<QuadratureNode> gaussLegendre(int n, double low, double high) {
  std::vector<double> alpha(static_cast<size_t>(n), 0.0), beta(static_cast<size_t>(n), 0.0);
  for (int k = 1; k < n; ++k) beta[static_cast<size_t>(k)] = k * k / (4.0 * k * k - 1.0);
  auto nodes = fromRecurrence(alpha, beta, 2.0);
  for (auto& node : nodes) {
    node.x = 0.5 * (low + high) + 0.5 * (high - low) * node.x;
    node.weight *= 0.5 * (high - low);
  }
  return nodes;
}

std::vector<QuadratureNode> fineNodes(double low, double high, std::span<const double> knots, int minimumNodes) {
  static const std::vector<QuadratureNode> unit = gaussLegendre(16, 0.0, 1.0);
  std::vector<double> edges{low};
  for (double k : knots)
    if (k > low && k < high) edges.push_back(k);
  edges.push_back(high);
  const double longest = (high - low) * 16.0 / std::max(16, minimumNodes);
  std::vector<QuadratureNode> nodes;
  for (size_t i = 0; i + 1 < edges.size(); ++i) {
    const double a = edges[i], b = edges[i + 1];
    if (b <= a) continue;
    const double octave = a > 0.0 ? std::log2(b / a) * 16.0 : 1.0;
    const int pieces = std::clamp(static_cast<int>(std::ceil(std::max((b - a) / longest, octave))), 1, 4096);
    for (int j = 0; j < pieces; ++j) {
      const double step = (b - a) / pieces;
      for (const auto& node : unit) nodes.push_back({a + (j + node.x) * step, node.weight * step});
    }
  }
  return nodes;
}

double integrate(const RealFunction& f, double low, double high, std::span<const double> knots) {
  double sum = 0.0;
  for (const auto& node : fineNodes(low, high, knots, 16)) sum += node.weight * f(node.x);
  return sum;
}

std::vector<QuadratureNode> gaussRule(int n, const RealFunction& weight, double low, double high, std::span<const double> knots) {
  auto fine = fineNodes(low, high, knots, 32 * n);
  double total = 0.0;
  for (auto& node : fine) {
    node.weight *= weight(node.x);
    total += node.weight;
  }
  if (!(total > 0.0)) return {};
  // In t on [-1, 1], against loss of digits in narrow bands far from zero.
  const double centre = 0.5 * (low + high), half = 0.5 * (high - low);
  std::vector<double> t, w, previous, current;
  for (const auto& node : fine) {
    if (node.weight <= 0.0) continue;
    t.push_back((node.x - centre) / half);
    w.push_back(node.weight / total);
  }
  const auto points = std::min(static_cast<size_t>(n), t.size());
  previous.assign(t.size(), 0.0);
  current.assign(t.size(), 1.0);  // orthonormal polynomials by the Stieltjes recurrence (total weight 1)
  std::vector<double> alpha, beta{1.0};
  for (size_t k = 0; k < points; ++k) {
    double a = 0.0;
    for (size_t i = 0; i < t.size(); ++i) a += w[i] * t[i] * current[i] * current[i];
    alpha.push_back(a);
    if (k + 1 == points) break;
    double norm = 0.0;
    const double back = k == 0 ? 0.0 : std::sqrt(beta[k]);
    std::vector<double> next(t.size());
    for (size_t i = 0; i < t.size(); ++i) {
      next[i] = (t[i] - a) * current[i] - back * previous[i];
      norm += w[i] * next[i] * next[i];
    }
    if (norm < 1e-28) break;
    beta.push_back(norm);
    for (auto& v : next) v /= std::sqrt(norm);
    previous = std::move(current);
    current = std::move(next);
  }
  beta.resize(alpha.size());
  auto nodes = fromRecurrence(alpha, beta, total);
  for (auto& node : nodes) node.x = centre + half * node.x;
  return nodes;
}

}  // namespace pitviper
