#include "scenarios/view/edited_material.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/view/surface_import.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr std::array kSharers{CurveKind::Diffuse, CurveKind::Specular, CurveKind::Emissivity};

bool sharesEnergy(CurveKind kind) { return std::find(kSharers.begin(), kSharers.end(), kind) != kSharers.end(); }

}  // namespace

EditedMaterial::EditedMaterial(EditedSurface surface, Libraries libraries) : libraries_(std::move(libraries)), now_(std::move(surface)) {
  // What it is made from may be above by a tolerance.
  for (CurveKind kind : {CurveKind::Diffuse, CurveKind::Specular, CurveKind::Emissivity})
    if (has(kind)) now_.curve(kind) = std::make_shared<const EditedCurve>(ceilingOf(kind).under(curve(kind)));
}

EditedMaterial EditedMaterial::named(const std::string& word, const Libraries& libraries) { return {surfaceNamed(word, libraries), libraries}; }

CurveCeiling EditedMaterial::ceilingOf(CurveKind kind) const {
  if (!sharesEnergy(kind)) return {};
  std::vector<const EditedCurve*> others;
  for (CurveKind other : kSharers)
    if (other != kind && has(other)) others.push_back(&curve(other));
  return CurveCeiling(others);
}

void EditedMaterial::become(EditedSurface next) {
  if (next == now_) return;
  if (open_ == 0) done_.push_back(now_);
  undone_.clear();
  now_ = std::move(next);
  ++revision_;
}

void EditedMaterial::put(CurveKind kind, EditedCurve curve) {
  EditedSurface next = now_;
  next.curve(kind) = std::make_shared<const EditedCurve>(std::move(curve));
  become(std::move(next));
}

void EditedMaterial::setName(const std::string& name) {
  EditedSurface next = now_;
  next.name = name;
  become(std::move(next));
}

std::size_t EditedMaterial::addPoint(CurveKind kind, double wavelength_um, double value) {
  if (!has(kind)) return 0;
  const CurveCeiling ceiling = ceilingOf(kind);
  const auto with = [&](double v) {
    EditedCurve next = curve(kind);
    next.add(wavelength_um, v);
    return next;
  };
  EditedCurve next = ceiling.furthest([&](double part) { return with(part * value); });
  // A low point can make a smooth curve rise beside it.
  if (!ceiling.allows(next)) next = ceiling.under(with(std::min(value, curve(kind).at(wavelength_um))));
  put(kind, std::move(next));
  return curve(kind).nearest(wavelength_um);
}

void EditedMaterial::removePoint(CurveKind kind, std::size_t i) {
  if (!has(kind)) return;
  EditedCurve next = curve(kind);
  next.remove(i);
  put(kind, ceilingOf(kind).under(std::move(next)));
}

void EditedMaterial::movePoint(CurveKind kind, std::size_t i, double wavelength_um, double value) {
  if (!has(kind) || i >= curve(kind).points().size()) return;
  const CurveCeiling ceiling = ceilingOf(kind);
  const CurvePoint from = curve(kind).points()[i];
  const auto moved = [&](double um, double v) {
    EditedCurve next = curve(kind);
    next.move(i, um, v);
    return next;
  };
  EditedCurve next = ceiling.furthest([&](double part) { return moved(wavelength_um, part * value); });
  // A line that ends at it can rise elsewhere.
  if (!ceiling.allows(next))
    next = ceiling.furthest([&](double part) { return moved(std::lerp(from.wavelength_um, wavelength_um, part), std::lerp(from.value, value, part)); });
  put(kind, std::move(next));
}

void EditedMaterial::setSmooth(CurveKind kind, bool smooth) {
  if (!has(kind)) return;
  EditedCurve next = curve(kind);
  next.setSmooth(smooth);
  put(kind, ceilingOf(kind).under(std::move(next)));
}

void EditedMaterial::setCurve(CurveKind kind, const EditedCurve& curve) {
  put(kind, ceilingOf(kind).under(EditedCurve(curve.points(), curve.smooth(), axisOf(kind).bounds)));
}

void EditedMaterial::giveEmissivity(bool given) {
  if (given == has(CurveKind::Emissivity)) return;
  EditedSurface next = now_;
  if (!given) {
    next.curve(CurveKind::Emissivity) = nullptr;
  } else {
    Spectrum::Table left{{}, {}, Outside::Hold, "emissivity"};
    const Spectrum &diffuse = curve(CurveKind::Diffuse).spectrum(), &specular = curve(CurveKind::Specular).spectrum();
    left.wavelength_um = (diffuse * specular).knots();
    for (double w : left.wavelength_um) left.value.push_back(std::max(0.0, 1.0 - diffuse(w) - specular(w)));
    constexpr double kFollowed = 1e-4;
    const double low = left.wavelength_um.front(), high = left.wavelength_um.back();
    next.curve(CurveKind::Emissivity) = std::make_shared<const EditedCurve>(
        ceilingOf(CurveKind::Emissivity).under(EditedCurve::of(Spectrum(std::move(left)), low, high, kFollowed, axisOf(CurveKind::Emissivity).bounds)));
  }
  become(std::move(next));
}

void EditedMaterial::setFilm(const std::optional<EditedFilm>& film) {
  EditedSurface next = now_;
  next.film = film;
  if (film && !film->pigmentApparent && film->substrate.find_first_not_of("0123456789.") != std::string::npos)
    throw UserError({"film", 0, 0, -1}, "what scatters beneath is counted by the scattering, in '" + film->substrate.substr(0, 60) + "', which may absorb",
                    "a substrate that is a number, or an apparent reflectance", "count what comes out");
  auto made = madeMaterial(next, libraries_);
  become(std::move(next));
  made_ = std::move(made), madeAt_ = revision_;
}

void EditedMaterial::beginChange() {
  if (open_++ == 0) before_ = now_;
}

void EditedMaterial::endChange() {
  if (open_ == 0 || --open_ > 0) return;
  if (!(before_ == now_)) done_.push_back(std::move(before_));
}

void EditedMaterial::undo() {
  if (open_ > 0) open_ = 1, endChange();
  if (done_.empty()) return;
  undone_.push_back(std::move(now_));
  now_ = std::move(done_.back());
  done_.pop_back();
  ++revision_;
}

void EditedMaterial::redo() {
  if (open_ > 0) open_ = 1, endChange();
  if (undone_.empty()) return;
  done_.push_back(std::move(now_));
  now_ = std::move(undone_.back());
  undone_.pop_back();
  ++revision_;
}

double EditedMaterial::energyAt(double wavelength_um) const {
  const auto m = material();
  if (wavelength_um < m->validLow_um() || wavelength_um > m->validHigh_um()) return std::numeric_limits<double>::quiet_NaN();
  // Every 2 degrees, and every half beyond 80, as the reader looks at it.
  double most = 0.0;
  for (int i = 0; i <= 180; ++i)
    if (i % 4 == 0 || i > 160) most = std::max(most, m->reflectance(wavelength_um, 0.5 * kPi * i / 180));
  return most;
}

std::shared_ptr<const Material> EditedMaterial::material() const {
  // The one before is let go last: facets of one roughness share what takes long.
  if (!made_ || madeAt_ != revision_) made_ = madeMaterial(now_, libraries_), madeAt_ = revision_;
  return made_;
}

}  // namespace pitviper
