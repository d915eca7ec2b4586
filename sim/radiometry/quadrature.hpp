#pragma once
// Numerical integration: Gauss rules for any positive weight, and composite integration between knots.
#include <functional>
#include <span>
#include <vector>

namespace pitviper {

struct QuadratureNode {
  double x;
  double weight;
};

using RealFunction = std::function<double(double)>;

/// Gauss-Legendre rule of n points on [low, high].
std::vector<QuadratureNode> gaussLegendre(int n, double low, double high);

/// Gauss rule of n points for integrals of weight(x) f(x) over [low, high]: exact for polynomials f of degree 2n-1 against the
/// discretised weight. The weight is >= 0 and smooth between the knots. Fewer points come back where the weight has
/// fewer points of support. Source: Golub and Welsch 1969; discretised Stieltjes procedure (Gautschi 1982).
std::vector<QuadratureNode> gaussRule(int n, const RealFunction& weight, double low, double high, std::span<const double> knots);

/// Integral of f over [low, high]: 16-point Gauss-Legendre on every interval between knots, intervals longer than a sixteenth of an
/// octave divided.
double integrate(const RealFunction& f, double low, double high, std::span<const double> knots);

/// The fine discretisation used by both.
std::vector<QuadratureNode> fineNodes(double low, double high, std::span<const double> knots, int minimumNodes);

}  // namespace pitviper
