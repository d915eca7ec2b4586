#include "materials/energy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kTolerance = 1e-6;
constexpr size_t kMostCorners = 4000000;
/// Texels times competing wavelengths and angles: about 0.2 s.
constexpr size_t kMostProducts = 200000000;
/// Competing wavelengths and angles that are kept as they are: 48 MB.
constexpr size_t kMostExact = 1000000;

using Parts = std::vector<double>;  ///< the given emissivity, the transmittance and the components' reflectances, or their modifiers
constexpr size_t kGiven = 0, kTransmitted = 1, kReflected = 2;

double product(const Parts& a, const Parts& b) { return std::inner_product(a.begin(), a.end(), b.begin(), 0.0); }

struct Candidate {
  Parts parts;
  double wavelength_um, viewAngle_rad;
};

std::vector<double> wavelengths(const Material& m) {
  const double low = std::max(m.validLow_um(), kShortestWavelength_um), high = std::min(m.validHigh_um(), kLongestWavelength_um);
  std::vector<double> all;
  if (low > high) return all;
  for (const auto& r : m.reflections) {
    const auto knots = r->knots_um();
    all.insert(all.end(), knots.begin(), knots.end());
  }
  for (const auto* v : {&m.given, &m.transmission})
    if (*v) {
      const auto knots = (*v)->knots_um();
      all.insert(all.end(), knots.begin(), knots.end());
    }
  for (int i = 0; i <= 64; ++i) all.push_back(std::clamp(low * std::pow(high / low, i / 64.0), low, high));  // rounding must not lead out of the data
  std::erase_if(all, [&](double w) { return w < low || w > high; });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  const size_t knots = all.size();
  for (size_t i = 0; i + 1 < knots; ++i) all.push_back(0.5 * (all[i] + all[i + 1]));  // products of spectra bend between their rows
  return all;
}

std::vector<double> viewAngles(const Material& m) {
  if (!m.hemisphericalVaries()) return {0.0};
  std::vector<double> all = m.viewKnots_rad();
  for (int i = 0; i <= 180; ++i)
    if (i % 4 == 0 || i > 160) all.push_back(0.5 * kPi * i / 180);
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Parts partsAt(const Material& m, double wavelength, double angle) {
  Parts parts(kReflected + m.reflections.size(), 0.0);
  for (size_t k = 0; k < m.reflections.size(); ++k) parts[kReflected + k] = m.reflections[k]->hemispherical(wavelength, angle);
  if (m.given) parts[kGiven] = m.given->at(wavelength, angle);
  parts[kTransmitted] = m.transmittance(wavelength, angle);
  return parts;
}

/// Those of the candidates that can be the worst for some modifiers: none is below another in all parts. Where they would be more than
/// `most`, they are rounded up to ever coarser steps until few enough differ.
class Envelope {
 public:
  explicit Envelope(size_t most) : most_(most) {}
  void add(Candidate c) {
    round(c);
    insert(c);
    while (kept_.size() > most_) {
      step_ = std::max(kTolerance, 4.0 * step_);
      auto before = std::move(kept_);
      kept_.clear();
      for (auto& k : before) {
        round(k);
        insert(k);
      }
    }
  }
  const std::vector<Candidate>& kept() const { return kept_; }
  bool rounded() const { return step_ > 0.0; }

 private:
  static bool below(const Parts& a, const Parts& b) { return std::equal(a.begin(), a.end(), b.begin(), std::less_equal<>()); }
  void round(Candidate& c) const {
    if (step_ > 0.0)
      for (double& p : c.parts) p = std::ceil(p / step_) * step_;
  }
  void insert(const Candidate& c) {
    if (std::any_of(kept_.begin(), kept_.end(), [&](const Candidate& k) { return below(c.parts, k.parts); })) return;
    std::erase_if(kept_, [&](const Candidate& k) { return below(k.parts, c.parts); });
    kept_.push_back(c);
  }
  size_t most_;
  double step_ = 0.0;
  std::vector<Candidate> kept_;
};

/// Where two textures' texels lie along one axis, in texture coordinates.
std::vector<double> lines(const std::vector<const Texture*>& textures, int Texture::*side) {
  std::vector<double> all;
  for (const Texture* t : textures)
    if (t)
      for (int i = 0; i < t->*side; ++i) all.push_back((i + 0.5) / (t->*side));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Bilinear, repeating: as the renderer reads it.
double valueAt(const Texture& t, double u, double v) {
  const double x = u * t.width - 0.5, y = v * t.height - 0.5;
  const double cx = std::floor(x), cy = std::floor(y), fx = x - cx, fy = y - cy;
  auto at = [&](double i, double j) {
    auto wrap = [](double k, int n) { return static_cast<size_t>(k - std::floor(k / n) * n); };
    return static_cast<double>(t.texels[wrap(j, t.height) * static_cast<size_t>(t.width) + wrap(i, t.width)]);
  };
  return (1 - fy) * ((1 - fx) * at(cx, cy) + fx * at(cx + 1, cy)) + fy * ((1 - fx) * at(cx, cy + 1) + fx * at(cx + 1, cy + 1));
}

/// The modifiers of a material: their greatest values, and where they have to be looked at together.
class Modifiers {
 public:
  Modifiers(const Material& m, std::span<const Texture> textures) : textures_(kReflected + m.reflections.size(), nullptr), greatest_(textures_.size(), 1.0) {
    auto take = [&](size_t k, int index) {
      if (index < 0) return;
      const Texture& t = textures[static_cast<size_t>(index)];
      textures_[k] = &t;
      greatest_[k] = static_cast<double>(*std::max_element(t.texels.begin(), t.texels.end()));
    };
    for (size_t k = 0; k < m.modifiers.size(); ++k) take(kReflected + k, m.modifiers[k]);
    if (m.given) take(kGiven, m.given->modifier);
    if (m.transmission) take(kTransmitted, m.transmission->modifier);
    const Texture* largest = nullptr;
    for (const Texture* t : textures_)
      if (t && (!largest || t->texels.size() > largest->texels.size())) largest = t;
    if (!largest) return;
    auto differs = [&](const Texture* t) { return t && (t->width != largest->width || t->height != largest->height); };
    sameSize_ = std::none_of(textures_.begin(), textures_.end(), differs);
    if (!sameSize_) {
      x_ = lines(textures_, &Texture::width);
      y_ = lines(textures_, &Texture::height);
      if (x_.size() * y_.size() > kMostCorners) {
        for (auto& t : textures_)
          if (differs(t)) t = nullptr;  // its greatest value stands for it
        sameSize_ = true;
      }
    }
    points_ = sameSize_ ? largest->texels.size() : x_.size() * y_.size();
  }
  const Parts& greatest() const { return greatest_; }
  /// Fewer than two textures: their greatest values are taken on together.
  bool together() const { return std::count(textures_.begin(), textures_.end(), nullptr) >= static_cast<std::ptrdiff_t>(textures_.size()) - 1; }
  size_t points() const { return points_; }
  Parts at(size_t point) const {
    Parts parts = greatest_;
    for (size_t k = 0; k < textures_.size(); ++k)
      if (textures_[k])
        parts[k] = sameSize_ ? static_cast<double>(textures_[k]->texels[point]) : valueAt(*textures_[k], x_[point % x_.size()], y_[point / x_.size()]);
    return parts;
  }

 private:
  std::vector<const Texture*> textures_;
  Parts greatest_;
  bool sameSize_ = true;
  std::vector<double> x_, y_;
  size_t points_ = 0;
};

}  // namespace

std::optional<EnergyExcess> energyExcess(const Material& m, std::span<const Texture> textures) {
  const Modifiers modifiers(m, textures);
  const auto angles = viewAngles(m);
  EnergyExcess worst;
  Envelope envelope(modifiers.points() > 0 ? std::clamp<size_t>(kMostProducts / modifiers.points(), 4, 1024) : 1);
  std::vector<Candidate> exact;
  for (double w : wavelengths(m))
    for (double angle : angles) {
      const Parts parts = partsAt(m, w, angle);
      const double sum = product(parts, modifiers.greatest());
      if (!std::isfinite(sum)) return EnergyExcess{sum, w, angle};
      if (sum <= 1.0 + kTolerance) continue;
      if (sum > worst.sum) worst = {sum, w, angle};
      if (modifiers.together()) continue;
      envelope.add({parts, w, angle});
      if (exact.size() < kMostExact) exact.push_back({parts, w, angle});
    }
  if (worst.sum == 0.0) return std::nullopt;
  if (modifiers.together()) return worst;

  worst = {};
  auto look = [&worst](const std::vector<Candidate>& candidates, const Parts& at) {
    for (const Candidate& c : candidates)
      if (const double sum = product(c.parts, at); sum > worst.sum) worst = {sum, c.wavelength_um, c.viewAngle_rad};
  };
  // What only rounding up has made too much is looked at again as it is, while that lasts no longer than the first look.
  size_t left = envelope.rounded() && exact.size() < kMostExact ? kMostProducts / exact.size() : 0;
  for (size_t point = 0; point < modifiers.points(); ++point) {
    const Parts at = modifiers.at(point);
    const EnergyExcess before = worst;
    look(envelope.kept(), at);
    if (worst.sum <= std::max(before.sum, 1.0 + kTolerance) || left == 0) continue;
    --left;
    worst = before;
    look(exact, at);
  }
  if (worst.sum <= 1.0 + kTolerance) return std::nullopt;
  return worst;
}

}  // namespace pitviper
