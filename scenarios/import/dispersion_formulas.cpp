#include "scenarios/import/dispersion_formulas.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/import/import_yaml.hpp"
#include "sim/parameters/spectrum_value.hpp"

namespace pitviper {
namespace {

constexpr std::size_t kMostSellmeier = 16, kMostCauchy = 8;

/// Coefficients left out at the end are 0, and so are their terms, whatever their poles.
double at(const std::vector<double>& c, std::size_t i) { return i < c.size() ? c[i] : 0.0; }
double term(double factor, double value) { return factor == 0.0 ? 0.0 : factor * value; }

bool isIndex(double n) { return n > 0.0 && n <= kLargestIndex; }

bool isCauchy(const DispersionFormula& f) {
  if (f.number != 5 || f.c.size() / 2 + 1 > kMostCauchy) return false;
  for (std::size_t i = 2; i < f.c.size(); i += 2)
    if (f.c[i] != -static_cast<double>(i)) return false;
  return true;
}

[[noreturn]] void refuse(const DispersionFormula& f, double um, const Location& where) {
  const double n = f(um);
  throw UserError(
      where, "formula " + std::to_string(f.number) + (std::isfinite(n) ? " gives n = " + exactNumber(n) : " has no real n") + " at " + exactNumber(um) + " um",
      "n above 0, up to 1000, all over its wavelength_range", "correct its coefficients, or its range");
}

/// Nodes between which lines hold.
std::vector<std::vector<double>> tableOf(const DispersionFormula& f, double low, double high, const Location& where) {
  constexpr int kStart = 32, kDeepest = 30;
  const auto n = [&](double um) {
    const double value = f(um);
    if (!isIndex(value)) refuse(f, um, where);
    return value;
  };
  std::vector<std::vector<double>> rows{{low, n(low)}};
  struct Piece {
    double low, high;
    int depth;
  };
  std::vector<Piece> open;
  for (int i = kStart; i-- > 0;) {
    const auto edge = [&](int k) { return k == 0 ? low : k == kStart ? high : low * std::pow(high / low, k / double(kStart)); };
    open.push_back({edge(i), edge(i + 1), 0});
  }
  while (!open.empty()) {
    const Piece p = open.back();
    open.pop_back();
    const double first = n(p.low), last = n(p.high);
    bool straight = true;
    for (double t : {0.25, 0.5, 0.75})
      straight = straight && std::abs(n(p.low + t * (p.high - p.low)) / (first + t * (last - first)) - 1.0) < 0.5 * kTableError;
    const double middle = 0.5 * (p.low + p.high);
    if (!straight && p.depth < kDeepest && middle > p.low && middle < p.high) {
      open.push_back({middle, p.high, p.depth + 1});
      open.push_back({p.low, middle, p.depth + 1});
      continue;
    }
    if (!straight) refuse(f, middle, where);
    rows.push_back({p.high, last});
    if (rows.size() > kMostSpectrumRows)
      throw UserError(where, "formula " + std::to_string(f.number) + " bends more than a table of " + std::to_string(kMostSpectrumRows) + " rows can tell",
                      "a formula without poles in its wavelength_range", "correct its coefficients, or its range");
  }
  return rows;
}

}  // namespace

double DispersionFormula::operator()(double l) const {
  const double l2 = l * l;
  double sum = at(c, 0);
  const auto pairs = [&](std::size_t from, auto of) {
    for (std::size_t i = from; i + 1 < c.size(); i += 2) sum += term(c[i], of(c[i + 1]));
  };
  const auto power = [&](double p) { return std::pow(l, p); };
  switch (number) {
    case 1:
      pairs(1, [&](double x) { return l2 / (l2 - x * x); });
      return std::sqrt(1.0 + sum);
    case 2:
      pairs(1, [&](double x) { return l2 / (l2 - x); });
      return std::sqrt(1.0 + sum);
    case 3:
      pairs(1, power);
      return std::sqrt(sum);
    case 4:
      for (std::size_t i : {1u, 5u}) sum += term(at(c, i), std::pow(l, at(c, i + 1)) / (l2 - std::pow(at(c, i + 2), at(c, i + 3))));
      pairs(9, power);
      return std::sqrt(sum);
    case 5:
      pairs(1, power);
      return sum;
    case 6:
      pairs(1, [&](double x) { return 1.0 / (x - 1.0 / l2); });
      return 1.0 + sum;
    case 7: {
      const double h = 1.0 / (l2 - 0.028);
      return sum + term(at(c, 1), h) + term(at(c, 2), h * h) + at(c, 3) * l2 + at(c, 4) * l2 * l2 + at(c, 5) * l2 * l2 * l2;
    }
    case 8: {
      const double a = sum + term(at(c, 1), l2 / (l2 - at(c, 2))) + at(c, 3) * l2;
      return std::sqrt((1.0 + 2.0 * a) / (1.0 - a));
    }
    default: {
      const double d = l - at(c, 4);
      return std::sqrt(sum + term(at(c, 1), 1.0 / (l2 - at(c, 2))) + term(at(c, 3), d / (d * d + at(c, 5))));
    }
  }
}

void checkCoefficients(const DispersionFormula& f, const Location& where) {
  const std::size_t n = f.c.size();
  const bool pairs = f.number <= 3 || f.number == 5 || f.number == 6;
  const auto refuse = [&](const std::string& expected, const std::string& fix) {
    throw UserError(where, "formula " + std::to_string(f.number) + " with " + std::to_string(n) + " coefficients", expected, fix);
  };
  if (pairs && n % 2 == 0) refuse("an odd number: a constant, then pairs", "complete the last pair");
  if (f.number == 4 && n != 1 && n != 5 && (n < 9 || n % 2 == 0))
    refuse("1, 5, 9, 11 ...: a constant, two terms of four, then pairs", "complete the last term");
  const std::size_t most = f.number == 7 || f.number == 9 ? 6 : f.number == 8 ? 4 : n;
  if (n == 0 || n > most) refuse("1 to " + std::to_string(most), "correct them");
}

std::string indexOf(const DispersionFormula& f, double low, double high, const Location& where) {
  const bool sellmeier = f.number <= 2 && f.c.size() > 1 && f.c.size() / 2 <= kMostSellmeier, cauchy = isCauchy(f);
  const std::string range = "  from: " + exactNumber(low) + " um\n  to: " + exactNumber(high) + " um\n";
  std::string terms;
  for (std::size_t i = 1; sellmeier && i < f.c.size(); i += 2) {
    const double pole = f.number == 1 ? tidy(f.c[i + 1] * f.c[i + 1]) : f.c[i + 1];
    if (f.c[i] != 0.0 && pole >= low * low && pole <= high * high)
      throw UserError(where, "formula " + std::to_string(f.number) + " has a pole at " + exactNumber(std::sqrt(pole)) + " um, within its range",
                      "a range between its poles", "correct its coefficients, or its wavelength_range");
    terms += (terms.empty() ? "[" : ", [") + exactNumber(f.c[i]) + ", " + exactNumber(pole) + "]";
  }
  if (!sellmeier && !cauchy) return "  n: {wavelength: um, unit: \"1\", values: " + rowsOfNumbers(tableOf(f, low, high, where)) + "}\n";
  constexpr int kPlaces = 1000;
  for (int i = 0; i <= kPlaces; ++i) {
    const double um = std::clamp(low * std::pow(high / low, i / double(kPlaces)), low, high);
    if (!isIndex(f(um))) refuse(f, um, where);
  }
  if (sellmeier) return "  constant: " + exactNumber(tidy(1.0 + f.c[0])) + "\n  sellmeier: [" + terms + "]\n" + range;
  std::string of = exactNumber(f.c[0]);
  for (std::size_t i = 1; i < f.c.size(); i += 2) of += ", " + exactNumber(f.c[i]);
  return "  cauchy: [" + of + "]\n" + range;
}

}  // namespace pitviper
