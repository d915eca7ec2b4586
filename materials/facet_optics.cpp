#include "materials/facet_optics.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "materials/film_fringes.hpp"
#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/microfacet.glsl"
#include "materials/slopes.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

constexpr double kQuarter = 0.5 * kPi;
/// Wavelengths that are kept: about 20 MB.
constexpr std::size_t kMostRows = 4096;
/// Steps between a facet's angles until reading linearly is off by no more than this, at most.
constexpr double kAngleError = 2e-4;
constexpr int kMostFacetAngles = 361;
/// Angles of a facet whose film has states: by the dozen they may not be fine; a degree of a film of 1 um is a tenth of a radian.
constexpr int kStateAngles = 91;
constexpr std::size_t kStateRows = 1024;
/// Phase from one state to the next: linear between them, a fringe is off by up to an eighth of its square, 3 % at 0.36 um and 1 % at 0.6.
constexpr double kStatePhase = 0.5, kShortest_um = 0.36;

double angleAt(int entry, int count) { return kQuarter * entry / (count - 1); }

/// 2 integral f cos sin over the hemisphere, f linear between its entries.
double cosineMean(const std::vector<double>& f) {
  static const auto weights = [](size_t n) {
    // Exact for hats: Gauss points within each cell.
    std::vector<double> w(n, 0.0);
    const auto rule = gaussLegendre(4, 0.0, 1.0);
    for (size_t j = 0; j + 1 < n; ++j)
      for (const auto& u : rule) {
        const double a = kQuarter * (static_cast<double>(j) + u.x) / static_cast<double>(n - 1), x = u.weight * kQuarter / static_cast<double>(n - 1);
        w[j] += (1.0 - u.x) * x * std::sin(2.0 * a);
        w[j + 1] += u.x * x * std::sin(2.0 * a);
      }
    return w;
  }(FacetOptics::kViews);
  return std::inner_product(f.begin(), f.end(), weights.begin(), 0.0);
}

std::uint64_t nextNumber() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

/// What ideal mirrors send on; quadrature of grazing views must not make more of it than there is.
std::vector<AngleShares> sharesOf(Slopes slopes, double a, int angles) {
  auto all = lobeShares([&](const glm::dvec3& l, const glm::dvec3& v) { return facetLobeAt(slopes, a, l, v); },
                        slopes == Slopes::Trowbridge ? Sampled::Trowbridge : Sampled::NormalSlopes, a, Angle::Difference, angles);
  for (AngleShares& view : all)
    if (const double sum = view.sum(); sum > 1.0)
      for (double& x : view.share) x /= sum;
  return all;
}

/// The same for all of one roughness: states by the dozen share them.
std::shared_ptr<const std::vector<AngleShares>> knownShares(Slopes slopes, double roughness, int angles) {
  static std::mutex mutex;
  static std::map<std::tuple<int, double, int>, std::weak_ptr<const std::vector<AngleShares>>> all;
  const std::lock_guard lock(mutex);
  auto& known = all[{static_cast<int>(slopes), roughness, angles}];
  auto own = known.lock();
  if (!own) known = own = std::make_shared<const std::vector<AngleShares>>(sharesOf(slopes, roughness, angles));
  return own;
}

}  // namespace

Lobe facetLobe(Slopes slopes, double a) {
  // cos(theta_l) times it is at most D(0) / (2 a): where both directions graze.
  return {slopes == Slopes::Trowbridge ? "materials/microfacet.glsl" : "materials/slopes.glsl",
          slopes == Slopes::Trowbridge ? "trowbridgeLobe" : "slopeLobe",
          {a, 0.0, 0.0, 0.0},
          // Of normal slopes up to 1.27 times as much is found (tests/unit/test_lobe_maximum.cpp).
          (slopes == Slopes::Normal ? 1.5 : 1.0) / (2.0 * kPi * a * a * a),
          // As wide in the mirrored direction as a cosine of this power: exp(-alpha^2 / (4 a^2)).
          std::max(0.0, 0.5 / (a * a) - 1.0)};
}

double facetLobeAt(Slopes slopes, double a, const glm::dvec3& light, const glm::dvec3& view) {
  const glm::dvec4 parameters(a, 0.0, 0.0, 0.0);
  return slopes == Slopes::Trowbridge ? physics::trowbridgeLobe(parameters, {0, 0, 1}, light, view) : physics::slopeLobe(parameters, {0, 0, 1}, light, view);
}

FacetOptics::FacetOptics(FacetSpec spec)
    : spec_(std::move(spec)), low_um_(spec_.beneath.validLow_um()), high_um_(spec_.beneath.validHigh_um()), number_(nextNumber()) {
  for (const auto* films : {&spec_.layers, &spec_.back})
    for (const FilmSpec& f : *films) low_um_ = std::max(low_um_, f.index.validLow_um()), high_um_ = std::min(high_um_, f.index.validHigh_um());
  if (spec_.pigment) low_um_ = std::max(low_um_, spec_.pigment->validLow()), high_um_ = std::min(high_um_, spec_.pigment->validHigh());
  if (low_um_ > high_um_) return;  // its makers refuse it
  statesPerUm_ = findStates();
  chooseAngles();
  share_ = knownShares(spec_.slopes, spec_.roughness, facetAngles_);
  for (const AngleShares& view : *share_) lost_.push_back(std::max(0.0, 1.0 - view.sum()));
  mostLost_ = cosineMean(lost_);
}

void FacetOptics::chooseAngles() {
  const double low = std::clamp(0.3, low_um_, high_um_), high = std::clamp(30.0, low_um_, high_um_);
  constexpr int kWavelengths = 24;
  for (facetAngles_ = statesPerUm_ > 0.0 ? kStateAngles : 46;; facetAngles_ = 2 * facetAngles_ - 1) {
    angleError_ = 0.0;
    const bool last = statesPerUm_ > 0.0 || 2 * facetAngles_ - 1 > kMostFacetAngles;
    // Steps that one wavelength shows to be too coarse are not looked at by the others.
    for (int i = 0; i <= kWavelengths && (last || angleError_ <= kAngleError); ++i) {
      const double w = std::clamp(low * std::pow(high / low, i / double(kWavelengths)), low, high);
      const Stack stack = stackAt(w);
      const FringeMean fringes(stack.layers, w);
      const auto at = [&](double angle) {
        return fringes.of(stack.layers, [&](const auto& layers) { return filmPower(layers, stack.last, w, std::sin(angle)); }).reflectance;
      };
      double before = at(0.0);
      for (int j = 0; j + 1 < facetAngles_; ++j) {
        const double next = at(angleAt(j + 1, facetAngles_)), middle = at(0.5 * (angleAt(j, facetAngles_) + angleAt(j + 1, facetAngles_)));
        angleError_ = std::max(angleError_, std::abs(middle - 0.5 * (before + next)));
        before = next;
      }
    }
    if (last || angleError_ <= kAngleError) return;
  }
}

double FacetOptics::findStates() const {
  double most = 0.0;
  for (const auto* films : {&spec_.layers, &spec_.back})
    for (const FilmSpec& f : *films)
      for (int i = 0; f.varies && i <= 64; ++i) {
        const double low = std::clamp(kShortest_um, low_um_, high_um_), w = std::clamp(low * std::pow(high_um_ / low, i / 64.0), low, high_um_);
        most = std::max(most, 4.0 * kPi * f.index(w).real() / (w * kStatePhase));
      }
  return most;
}

std::vector<FilmLayer> FacetOptics::layersAt(const std::vector<FilmSpec>& films, double w) const {
  std::vector<FilmLayer> layers;
  for (const FilmSpec& f : films) layers.push_back({f.index(w), f.thickness_um, f.coherent});
  return layers;
}

FacetOptics::Stack FacetOptics::stackAt(double w) const {
  Stack stack{layersAt(spec_.layers, w), spec_.beneath(w)};
  if (!spec_.paneThickness_um) return stack;
  stack.layers.push_back({stack.last, *spec_.paneThickness_um, false});
  for (const FilmLayer& l : layersAt(spec_.back, w)) stack.layers.push_back(l);
  stack.last = 1.0;
  return stack;
}

FacetRow FacetOptics::rowAt(double w) const {
  FacetRow row;
  const auto n = spec_.beneath(w);
  const Stack stack = stackAt(w);
  const FringeMean fringes(stack.layers, w);
  const auto powerAt = [&](double sine) { return fringes.of(stack.layers, [&](const auto& layers) { return filmPower(layers, stack.last, w, sine); }); };
  // What a facet lets in of what it does not reflect, at the views.
  std::vector<double> passed(kViews, 0.0);
  const int perView = (facetAngles_ - 1) % (kViews - 1) == 0 ? (facetAngles_ - 1) / (kViews - 1) : 0;
  const auto inside = [](const FilmPower& p) { return p.reflectance < 1.0 ? std::min(1.0, p.transmittance / (1.0 - p.reflectance)) : 0.0; };
  for (int j = 0; j < facetAngles_; ++j) {
    const FilmPower p = powerAt(std::sin(angleAt(j, facetAngles_)));
    row.facet.push_back(p.reflectance);
    if (perView > 0 && j % perView == 0) passed[static_cast<size_t>(j / perView)] = inside(p);
  }
  const bool goesIn = spec_.pigment || spec_.paneThickness_um;
  for (int v = 0; goesIn && v < kViews; ++v)
    if (perView == 0 || v == kViews - 1) passed[static_cast<size_t>(v)] = inside(powerAt(std::sin(std::min(angleAt(v, kViews), kQuarter - 1e-6))));
  for (int v = 0; v < kViews; ++v) {
    const double sent = (*share_)[static_cast<size_t>(v)].of(row.facet);
    // Smooth faces lose at grazing views alone, less than is worth a component: counted as if their lobe sent it on.
    row.hemispherical.push_back(mostLost_ > kWorthBeneath || lost_[static_cast<size_t>(v)] >= 1.0 ? sent : sent / (1.0 - lost_[static_cast<size_t>(v)]));
  }
  // What facets send on to other facets, reflected once more: two of them share the turn of one, so each meets light halfway between that one's angle and
  // grazing. (A face of reflectance exp(-c x elevation), as water's is where it grazes, returns as much by two as by one.) Held against rays traced over
  // seas (tests/physics/test_sea_emissivity.cpp). As a lobe it is a product of both directions: Kulla and Conty, SIGGRAPH courses 2017.
  if (mostLost_ > kWorthBeneath) {
    std::vector<double> twice;
    for (int j = 0; j < facetAngles_; ++j) {
      const double each = byAngle(row.facet, 0.5 * (kQuarter + angleAt(j, facetAngles_)));
      twice.push_back(each * each);
    }
    for (size_t k = 0; k < lost_.size(); ++k) row.returned.push_back(lost_[k] < 1.0 ? lost_[k] * (*share_)[k].of(twice) / (1.0 - lost_[k]) : lost_[k]);
    const double mean = cosineMean(row.returned);
    row.again = mean > 0.0 ? 1.0 / (kPi * mean) : 0.0;
  }
  for (int v = 0; v < kViews; ++v) {
    const auto k = static_cast<size_t>(v);
    row.beneath.push_back(row.returned.empty() ? 0.0 : row.returned[k]);
    row.through.push_back(passed[k] * std::max(0.0, 1.0 - row.hemispherical[k] - row.beneath[k]));
  }
  if (spec_.paneThickness_um) row.transmitted = row.through;
  if (spec_.pigment) {
    // f = T(in) T(out) rho / (pi n^2 (1 - rho R)), R the hemispherical reflectance from inside: what does not come out and is not absorbed on the way.
    const double albedo = (*spec_.pigment)(w), n2 = n.real() * n.real(), mean = cosineMean(row.through);
    // Apparent: of what goes in, so much comes out, however often it went round within.
    row.scattered = mean > 0.0 ? albedo / (kPi * mean) : 0.0;
    if (!spec_.pigmentApparent) {
      std::vector<double> absorbed;
      for (int v = 0; v < kViews; ++v) {
        const FilmPower p =
            fringes.of(stack.layers, [&](const auto& layers) { return filmPowerFromBeneath(layers, n.real(), w, std::sin(angleAt(v, kViews))); });
        absorbed.push_back(std::clamp(1.0 - p.reflectance - p.transmittance, 0.0, 1.0));
      }
      const double back = std::clamp(1.0 - mean / n2 - cosineMean(absorbed), 0.0, 1.0);
      row.scattered = albedo / (kPi * n2 * (1.0 - albedo * back));
    }
    for (size_t k = 0; k < row.beneath.size(); ++k) row.beneath[k] += kPi * row.scattered * mean * row.through[k];
  }
  return row;
}

const FacetRow& FacetOptics::at(double w) const {
  // Tables are filled wavelength by wavelength.
  struct Last {
    std::uint64_t number = 0;
    double wavelength_um = 0.0;
    std::shared_ptr<const FacetRow> row;
  };
  thread_local Last last;
  if (last.number == number_ && last.wavelength_um == w) return *last.row;
  // Threads of a reference look the same up again and again: each remembers it, or they would wait for each other most of the time.
  struct Hash {
    std::size_t operator()(const std::pair<std::uint64_t, double>& key) const { return std::hash<double>()(key.second) ^ key.first * 0x9e3779b97f4a7c15u; }
  };
  thread_local std::unordered_map<std::pair<std::uint64_t, double>, std::shared_ptr<const FacetRow>, Hash> known;
  if (known.size() > kMostRows) known.clear();
  std::shared_ptr<const FacetRow>& row = known[{number_, w}];
  if (!row) {
    const std::lock_guard lock(mutex_);
    if (const auto found = rows_.find(w); found != rows_.end()) row = found->second;
  }
  if (!row) {
    row = std::make_shared<const FacetRow>(rowAt(w));
    const std::lock_guard lock(mutex_);
    if (rows_.size() >= (statesPerUm_ > 0.0 ? kStateRows : kMostRows)) rows_.clear();
    rows_[w] = row;
  }
  last = {number_, w, row};
  return *last.row;
}

std::vector<double> FacetOptics::knots_um() const {
  std::vector<double> all = spec_.beneath.knots_um();
  const auto add = [&all](const std::vector<double>& more) { all.insert(all.end(), more.begin(), more.end()); };
  for (const auto* films : {&spec_.layers, &spec_.back})
    for (const FilmSpec& f : *films) add(f.index.knots_um());
  if (spec_.pigment) add(spec_.pigment->knots());
  std::erase_if(all, [&](double w) { return w < low_um_ || w > high_um_; });
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

double FacetOptics::resolvedBy_um(double w) const {
  const Stack stack = stackAt(w);
  return fringeStep_um(stack.layers, stack.last, w);
}

double FacetOptics::averagedFringe_um(double w) const {
  const double apart = fringeApart_um(stackAt(w).layers, w);
  return fringeSpread_um(apart, w) > 0.0 ? apart : 0.0;
}

void FacetOptics::addTo(Fingerprint& f) const {
  spec_.beneath.addTo(f);
  for (const auto* films : {&spec_.layers, &spec_.back}) {
    f.add(static_cast<double>(films->size()));
    for (const FilmSpec& film : *films) {
      film.index.addTo(f);
      f.add(film.thickness_um).add(film.coherent);
    }
  }
  f.add(spec_.roughness)
      .add(static_cast<int>(spec_.slopes))
      .add(spec_.pigmentApparent)
      .add(spec_.paneThickness_um.value_or(-1.0))
      .add(spec_.pigment.has_value())
      .add(spec_.share);
  if (spec_.pigment) pitviper::addTo(f, *spec_.pigment);
}

}  // namespace pitviper
