#include "sim/radiometry/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

std::string shortNumber(double v) {
  std::string s = std::to_string(v);
  while (s.size() > 3 && s.back() == '0') s.pop_back();
  return s;
}

double tableValue(const Spectrum::Table& t, double w) {
  const auto& x = t.wavelength_um;
  if (w < x.front() || w > x.back()) {
    switch (t.outside) {
      case Outside::Zero:
        return 0.0;
      case Outside::Hold:
        return w < x.front() ? t.value.front() : t.value.back();
      case Outside::Error:
        throw OutsideSpectrum((t.name.empty() ? std::string("a spectrum") : t.name) + " has no data at " + shortNumber(w) + " um (it covers " +
                              shortNumber(x.front()) + " to " + shortNumber(x.back()) + " um)");
    }
  }
  // The last knot at or below w: at a step the later value holds.
  const auto above = std::upper_bound(x.begin(), x.end(), w);
  const size_t i = static_cast<size_t>(above - x.begin()) - 1;
  if (i + 1 >= x.size()) return t.value.back();
  const double f = (w - x[i]) / (x[i + 1] - x[i]);
  return t.value[i] + f * (t.value[i + 1] - t.value[i]);
}

double factorValue(const Spectrum::Factor& factor, double w) {
  if (const auto* c = std::get_if<Spectrum::Constant>(&factor)) return c->value;
  if (const auto* t = std::get_if<Spectrum::Table>(&factor)) return tableValue(*t, w);
  const auto& b = std::get<Spectrum::BlackBody>(factor);
  return b.scale * physics::planckRadiance(w, b.temperature_K);
}

}  // namespace

Spectrum::Spectrum(Table table) {
  const auto& x = table.wavelength_um;
  if (x.empty() || x.size() != table.value.size()) throw std::invalid_argument("a spectrum table needs as many values as wavelengths, at least one");
  for (size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(table.value[i])) throw std::invalid_argument("a spectrum table holds a value that is not finite");
    if (i > 0 && (x[i] < x[i - 1] || (i > 1 && x[i] == x[i - 2]))) throw std::invalid_argument("a spectrum table does not rise in wavelength");
  }
  factors_.emplace_back(std::move(table));
}

Spectrum Spectrum::band(double low_um, double high_um, double value) { return Spectrum(Table{{low_um, high_um}, {value, value}, Outside::Zero, ""}); }

double Spectrum::operator()(double w) const {
  double v = 1.0;
  for (const auto& f : factors_) {
    v *= factorValue(f, w);
    if (v == 0.0) return 0.0;  // a response's zero hides what other factors don't know there
  }
  return v;
}

Spectrum Spectrum::operator*(const Spectrum& other) const {
  Spectrum product = *this;
  // Zero-outside tables first, so that their zeros are found before another factor is asked for data it has not.
  product.factors_.insert(product.factors_.end(), other.factors_.begin(), other.factors_.end());
  std::stable_partition(product.factors_.begin(), product.factors_.end(), [](const Factor& f) {
    const auto* t = std::get_if<Table>(&f);
    return t && t->outside == Outside::Zero;
  });
  if (!other.provenance_.empty()) product.provenance_ += (product.provenance_.empty() ? "" : " x ") + other.provenance_;
  return product;
}

Spectrum Spectrum::operator*(double scale) const {
  Spectrum product = *this;
  for (auto& f : product.factors_) {
    if (auto* c = std::get_if<Constant>(&f)) {
      c->value *= scale;
      return product;
    }
  }
  product.factors_.emplace_back(Constant{scale});
  return product;
}

std::vector<double> Spectrum::knots() const {
  std::vector<double> all;
  for (const auto& f : factors_)
    if (const auto* t = std::get_if<Table>(&f)) all.insert(all.end(), t->wavelength_um.begin(), t->wavelength_um.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

double Spectrum::supportLow() const {
  double low = kShortestWavelength_um;
  for (const auto& f : factors_) {
    const auto* t = std::get_if<Table>(&f);
    if (!t || t->outside != Outside::Zero) continue;
    size_t i = 0;  // skip leading zeros: the support begins at the last of them
    while (i + 1 < t->value.size() && t->value[i] == 0.0 && t->value[i + 1] == 0.0) ++i;
    low = std::max(low, t->wavelength_um[i]);
  }
  return low;
}

double Spectrum::supportHigh() const {
  double high = kLongestWavelength_um;
  for (const auto& f : factors_) {
    const auto* t = std::get_if<Table>(&f);
    if (!t || t->outside != Outside::Zero) continue;
    size_t i = t->value.size() - 1;
    while (i > 0 && t->value[i] == 0.0 && t->value[i - 1] == 0.0) --i;
    high = std::min(high, t->wavelength_um[i]);
  }
  return high;
}

double Spectrum::validLow() const {
  double low = kShortestWavelength_um;
  for (const auto& f : factors_)
    if (const auto* t = std::get_if<Table>(&f); t && t->outside == Outside::Error) low = std::max(low, t->wavelength_um.front());
  return low;
}

double Spectrum::validHigh() const {
  double high = kLongestWavelength_um;
  for (const auto& f : factors_)
    if (const auto* t = std::get_if<Table>(&f); t && t->outside == Outside::Error) high = std::min(high, t->wavelength_um.back());
  return high;
}

bool Spectrum::isZero() const {
  for (const auto& f : factors_) {
    if (const auto* c = std::get_if<Constant>(&f); c && c->value == 0.0) return true;
    if (const auto* b = std::get_if<BlackBody>(&f); b && (b->scale == 0.0 || b->temperature_K == 0.0)) return true;
    if (const auto* t = std::get_if<Table>(&f); t && std::all_of(t->value.begin(), t->value.end(), [](double v) { return v == 0.0; })) return true;
  }
  return false;
}

bool Spectrum::isConstant() const {
  return std::all_of(factors_.begin(), factors_.end(), [](const Factor& f) { return std::holds_alternative<Constant>(f); });
}

namespace {
template <class Visit>
void visitSamples(const Spectrum& s, double low, double high, Visit visit) {
  visit(s(low));
  visit(s(high));
  for (double k : s.knots())
    if (k > low && k < high) visit(s(k));
  for (const auto& f : s.factors())
    if (std::holds_alternative<Spectrum::BlackBody>(f)) {
      for (int i = 1; i < 256; ++i) visit(s(low * std::pow(high / low, i / 256.0)));
      return;
    }
}
}  // namespace

double Spectrum::minimum(double low, double high) const {
  double m = INFINITY;
  visitSamples(*this, low, high, [&m](double v) { m = std::min(m, v); });
  return m;
}
double Spectrum::maximum(double low, double high) const {
  double m = -INFINITY;
  visitSamples(*this, low, high, [&m](double v) { m = std::max(m, v); });
  return m;
}

double Spectrum::integral(double low, double high) const {
  return integrate([this](double w) { return (*this)(w); }, low, high, knots());
}

}  // namespace pitviper
