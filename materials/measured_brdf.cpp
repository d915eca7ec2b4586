#include "materials/measured_brdf.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/measured.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

/// What laws may change of a measurement, and how much of it fewer azimuths may lose, rms of flux.
constexpr double kMostChange = 0.1, kAzimuthLoss = 0.003;
/// Of an axis that has all measured angles on it; and of both.
constexpr int kMostCells = 512;
constexpr std::size_t kMostPairs = 65536;
constexpr double kSame = 1e-5;

using Axis = std::vector<double>;

std::string percent(double part) { return print("%.3g %%", 100.0 * part); }

double last(MeasuredAngles kind) { return kind == MeasuredAngles::Directions ? kPi : 0.5 * kPi; }

/// Cosines of light and view from the normal.
std::array<double, 2> cosinesOf(MeasuredAngles kind, double angle1, double angle2, double azimuth) {
  if (kind == MeasuredAngles::Directions) return {std::cos(angle1), std::cos(angle2)};
  const double h = kind == MeasuredAngles::HalfRoot ? halfOfRoot(angle1) : angle1;
  const double both = std::cos(h) * std::cos(angle2), apart = std::sin(h) * std::sin(angle2) * std::cos(azimuth);
  return {both - apart, both + apart};
}

/// Shares of the flux that all directions send to all, of cells of one size along each angle: cos cos dw dw, of half and difference angles 4 cos(d) dw_h dw_d.
/// Source: Walter et al. 2007 (Jacobian of the half vector).
double weightOf(MeasuredAngles kind, double angle1, double angle2, double azimuth) {
  const auto [light, view] = cosinesOf(kind, angle1, angle2, azimuth);
  constexpr double kHorizon = 1e-9;
  if (light < kHorizon || view < kHorizon) return 0.0;
  const double h = kind == MeasuredAngles::HalfRoot ? halfOfRoot(angle1) : angle1;
  double weight = light * view * std::sin(h) * std::sin(angle2);
  if (kind != MeasuredAngles::Directions) weight *= std::cos(angle2);
  return kind == MeasuredAngles::HalfRoot ? weight * angle1 : weight;
}

/// Root mean square of a change, relative to that of what is changed.
class Change {
 public:
  void add(double weight, double before, double after) { off_ += weight * (after - before) * (after - before), of_ += weight * before * before; }
  double rms() const { return of_ > 0.0 ? std::sqrt(off_ / of_) : 0.0; }

 private:
  double off_ = 0.0, of_ = 0.0;
};

struct Shape {
  std::size_t wavelengths, first, second, azimuths;
  explicit Shape(const MeasuredGrid& g)
      : wavelengths(g.wavelength_um.size()), first(g.angle1_rad.size()), second(g.angle2_rad.size()), azimuths(g.azimuth_rad.size()) {}
  std::size_t at(std::size_t p, std::size_t j, std::size_t i, std::size_t w) const { return ((p * second + j) * first + i) * wavelengths + w; }
  std::size_t all() const { return wavelengths * first * second * azimuths; }
  template <class Visit>
  void each(const Visit& visit) const {
    for (std::size_t p = 0; p < azimuths; ++p)
      for (std::size_t j = 0; j < second; ++j)
        for (std::size_t i = 0; i < first; ++i) visit(p, j, i);
  }
};

struct Between {
  std::size_t low, high;
  double share;
};

/// Held beyond the ends.
Between between(const Axis& axis, double x) {
  const auto above = static_cast<std::size_t>(std::upper_bound(axis.begin(), axis.end(), x) - axis.begin());
  if (above == 0) return {0, 0, 0.0};
  if (above == axis.size()) return {above - 1, above - 1, 0.0};
  return {above - 1, above, (x - axis[above - 1]) / (axis[above] - axis[above - 1])};
}

/// An isotropic surface looks the same in a mirror, and light and view may change places: azimuths that are the same so are one, their mean.
MeasuredGrid folded(MeasuredGrid g, Change& change) {
  const double end = last(g.kind);
  const auto fold = [&](double azimuth) { return std::abs(std::remainder(azimuth, 2.0 * end)); };
  Axis own;
  for (double a : g.azimuth_rad) own.push_back(fold(a));
  Axis sorted = own;
  std::sort(sorted.begin(), sorted.end());
  sorted.erase(std::unique(sorted.begin(), sorted.end(), [](double a, double b) { return b - a < kSame; }), sorted.end());
  MeasuredGrid to = g;
  to.azimuth_rad = sorted;
  const Shape from(g), shape(to);
  to.values.assign(shape.all(), std::numeric_limits<double>::quiet_NaN());
  shape.each([&](std::size_t p, std::size_t j, std::size_t i) {
    const double weight = weightOf(g.kind, g.angle1_rad[i], g.angle2_rad[j], sorted[p]);
    for (std::size_t w = 0; w < shape.wavelengths; ++w) {
      double sum = 0.0;
      int count = 0;
      const auto over = [&](const auto& visit) {
        for (std::size_t q = 0; q < own.size(); ++q)
          if (std::abs(own[q] - sorted[p]) < 2.0 * kSame)
            if (const double v = g.values[from.at(q, j, i, w)]; !std::isnan(v)) visit(v);
      };
      over([&](double v) { sum += v, ++count; });
      if (count == 0) continue;
      to.values[shape.at(p, j, i, w)] = sum / count;
      over([&](double v) { change.add(weight / count, v, sum / count); });
    }
  });
  return to;
}

/// Of incidence and view: each pair also stands for the other way round.
MeasuredGrid alikeBothWays(const MeasuredGrid& g, Change& change) {
  Axis both = g.angle1_rad;
  both.insert(both.end(), g.angle2_rad.begin(), g.angle2_rad.end());
  std::sort(both.begin(), both.end());
  both.erase(std::unique(both.begin(), both.end(), [](double a, double b) { return b - a < kSame; }), both.end());
  MeasuredGrid to = g;
  to.angle1_rad = to.angle2_rad = both;
  const Shape from(g), shape(to);
  to.values.assign(shape.all(), 0.0);
  const auto isWithin = [](const Axis& axis, double x) { return x > axis.front() - kSame && x < axis.back() + kSame; };
  shape.each([&](std::size_t p, std::size_t j, std::size_t i) {
    const double in = both[i], out = both[j], weight = weightOf(g.kind, in, out, g.azimuth_rad[p]);
    const auto read = [&](double first, double second, std::size_t w) {
      const Between a = between(g.angle1_rad, first), b = between(g.angle2_rad, second);
      const auto v = [&](std::size_t x, std::size_t y) { return g.values[from.at(p, y, x, w)]; };
      return (1 - b.share) * ((1 - a.share) * v(a.low, b.low) + a.share * v(a.high, b.low)) +
             b.share * ((1 - a.share) * v(a.low, b.high) + a.share * v(a.high, b.high));
    };
    const bool direct = isWithin(g.angle1_rad, in) && isWithin(g.angle2_rad, out), turned = isWithin(g.angle1_rad, out) && isWithin(g.angle2_rad, in);
    for (std::size_t w = 0; w < shape.wavelengths; ++w) {
      const double first = read(in, out, w), second = read(out, in, w), mean = 0.5 * (first + second);
      to.values[shape.at(p, j, i, w)] = direct == turned ? mean : direct ? first : second;
      if (direct && turned) change.add(weight, first, mean);
    }
  });
  return to;
}

/// The share of what both directions can see that is missing. What is missing, or one cannot see, is as at the next smaller second angle; at the first of
/// them, as at the next that is there.
double fillHoles(MeasuredGrid& g) {
  const Shape shape(g);
  std::size_t seen = 0, holes = 0;
  shape.each([&](std::size_t p, std::size_t j, std::size_t i) {
    const auto cosines = cosinesOf(g.kind, g.angle1_rad[i], g.angle2_rad[j], g.azimuth_rad[p]);
    const bool isSeen = std::min(cosines[0], cosines[1]) > 1e-9;
    for (std::size_t w = 0; w < shape.wavelengths; ++w) {
      double& v = g.values[shape.at(p, j, i, w)];
      seen += isSeen;
      holes += isSeen && std::isnan(v);
      if (!std::isnan(v)) continue;
      if (j > 0) v = g.values[shape.at(p, j - 1, i, w)];
      else
        for (std::size_t k = 1; std::isnan(v) && k < shape.second; ++k) v = g.values[shape.at(p, k, i, w)];
      if (std::isnan(v) && i > 0) v = g.values[shape.at(p, j, i - 1, w)];
      if (std::isnan(v)) v = 0.0;
    }
  });
  return seen > 0 ? static_cast<double>(holes) / static_cast<double>(seen) : 1.0;
}

/// Entries of the coarsest even grid from 0 that has all of an axis's angles on it; 0: none of so many cells.
int evenEntries(const Axis& axis) {
  const double end = axis.back();
  for (int cells = 1; cells <= kMostCells; ++cells)
    if (std::all_of(axis.begin(), axis.end(), [&](double a) { return std::abs(a / end * cells - std::round(a / end * cells)) * end < kSame * cells; }))
      return cells + 1;
  return 0;
}

AngleAxis evenAxis(const Axis& axis, Angle angle, int entries, const Location& where) {
  if (entries > 0) return {angle, entries, 0.5 * kPi};
  if (axis.back() < kSame) return {};
  if (const int found = evenEntries(axis); found > 0) return {angle, found, axis.back()};
  throw UserError(where, "a BRDF at angles that stand on no even grid", "multiples of one step, 1/512 of the largest angle or more",
                  "round them, say to 0.5 deg");
}

/// Values at even angles, [azimuth][angle 2][angle 1][wavelength].
std::vector<double> atEven(const MeasuredGrid& g, const std::array<AngleAxis, 2>& axes) {
  const Shape from(g);
  std::vector<double> all;
  for (std::size_t p = 0; p < from.azimuths; ++p)
    for (int j = 0; j < axes[1].count; ++j) {
      const Between b = between(g.angle2_rad, axes[1].at(j));
      for (int i = 0; i < axes[0].count; ++i) {
        const Between a = between(g.angle1_rad, axes[0].at(i));
        for (std::size_t w = 0; w < from.wavelengths; ++w) {
          const auto v = [&](std::size_t x, std::size_t y) { return g.values[from.at(p, y, x, w)]; };
          all.push_back((1 - b.share) * ((1 - a.share) * v(a.low, b.low) + a.share * v(a.high, b.low)) +
                        b.share * ((1 - a.share) * v(a.low, b.high) + a.share * v(a.high, b.high)));
        }
      }
    }
  return all;
}

/// Values at `count` even azimuths out of those at others, as least squares over all azimuths have it (those given: linear between, held beyond); what is lost
/// so of them, as a matrix that makes the one from the other.
struct Fewer {
  Eigen::MatrixXd of;       ///< [even azimuth, given azimuth]
  Eigen::MatrixXd residue;  ///< [place between 0 and the last, given azimuth]
};

Fewer fewerAzimuths(const Axis& given, double end, int count) {
  constexpr int kPlaces = 180;
  Eigen::MatrixXd read = Eigen::MatrixXd::Zero(kPlaces, static_cast<Eigen::Index>(given.size())), hats = Eigen::MatrixXd::Zero(kPlaces, count);
  for (int k = 0; k < kPlaces; ++k) {
    const double azimuth = end * (k + 0.5) / kPlaces, x = azimuth / end * (count - 1);
    const Between b = between(given, azimuth);
    read(k, static_cast<Eigen::Index>(b.low)) += 1.0 - b.share;
    read(k, static_cast<Eigen::Index>(b.high)) += b.share;
    const int low = std::min(static_cast<int>(x), std::max(count - 2, 0));
    hats(k, low) += count > 1 ? 1.0 - (x - low) : 1.0;
    if (count > 1) hats(k, low + 1) += x - low;
  }
  Fewer fewer;
  fewer.of = (hats.transpose() * hats).ldlt().solve(hats.transpose() * read);
  fewer.residue = hats * fewer.of - read;
  return fewer;
}

}  // namespace

Lobe azimuthLobe(const MeasuredBrdf& brdf, MeasuredAngles kind, std::size_t part) {
  if (brdf.parts.size() < 2) return {};
  Lobe lobe;
  lobe.file = "materials/measured.glsl";
  lobe.function = kind == MeasuredAngles::Directions ? "azimuthBetween" : "differenceAzimuth";
  lobe.parameters = {static_cast<double>(part), static_cast<double>(brdf.parts.size() - 1) / brdf.last_rad, 0.0, 0.0};
  return lobe;
}

double azimuthLobeAt(MeasuredAngles kind, const Lobe& lobe, const glm::dvec3& light, const glm::dvec3& view) {
  if (lobe.file.empty()) return 1.0;
  const glm::dvec3 normal(0.0, 0.0, 1.0);
  return kind == MeasuredAngles::Directions ? physics::azimuthBetween(lobe.parameters, normal, light, view)
                                            : physics::differenceAzimuth(lobe.parameters, normal, light, view);
}

namespace {

/// Cells of a pair of even axes.
class Cells {
 public:
  Cells(MeasuredAngles kind, const std::array<AngleAxis, 2>& axes) : kind_(kind), axes_(axes), along_(static_cast<std::size_t>(axes[0].count)) {}
  std::size_t count() const { return along_ * static_cast<std::size_t>(axes_[1].count); }
  /// Seen along the normal, or mirrored about it, an azimuth means nothing.
  bool isMiddle(std::size_t cell) const { return (axes_[0].count > 1 && cell % along_ == 0) || (axes_[1].count > 1 && cell / along_ == 0); }
  double weight(std::size_t cell, double azimuth) const {
    return weightOf(kind_, axes_[0].at(static_cast<int>(cell % along_)), axes_[1].at(static_cast<int>(cell / along_)), azimuth);
  }

 private:
  MeasuredAngles kind_;
  std::array<AngleAxis, 2> axes_;
  std::size_t along_;
};

/// As few azimuths as lose no more than kAzimuthLoss, `most` at most; all of those given where they are even, and no more than that.
Eigen::MatrixXd azimuthsOf(const MeasuredGrid& grid, const Eigen::MatrixXd& all, const Cells& cells, int most, MeasuredBrdf& brdf) {
  const auto given = static_cast<int>(grid.azimuth_rad.size()), wavelengths = static_cast<int>(grid.wavelength_um.size());
  const bool isWhole = given > 1 && grid.azimuth_rad.front() < kSame && grid.azimuth_rad.back() > brdf.last_rad - kSame;
  const int own = given == 1 ? 1 : isWhole ? evenEntries(grid.azimuth_rad) : 0;
  if (own > 0) most = std::min(most, own);
  double lost = 0.0;
  Eigen::MatrixXd of;
  for (int count = 1; count <= most; ++count) {
    const Fewer fewer = fewerAzimuths(grid.azimuth_rad, brdf.last_rad, count);
    of = fewer.of;
    double off = 0.0, whole = 0.0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
      const double weight = cells.weight(cell, 0.5 * brdf.last_rad);
      if (cells.isMiddle(cell) || weight == 0.0) continue;
      const auto values = all.middleCols(static_cast<Eigen::Index>(cell) * wavelengths, wavelengths);
      off += weight * (fewer.residue * values).squaredNorm() / static_cast<double>(fewer.residue.rows());
      whole += weight * values.squaredNorm() / given;
    }
    lost = whole > 0.0 ? std::sqrt(off / whole) : 0.0;
    if (lost <= kAzimuthLoss) break;
  }
  if (lost > 1e-6) brdf.notes.push_back("tables at " + std::to_string(of.rows()) + " azimuths lose " + percent(lost) + " rms of the BRDF");
  return of;
}

/// Wavelength by wavelength, so that no view gets back more than all.
void boundEnergy(MeasuredBrdf& brdf, const Location& where) {
  const auto& wavelengths = brdf.parts.front().wavelength_um;
  double most = 1.0, worst_um = 0.0;
  for (std::size_t w = 0; w < wavelengths.size(); ++w) {
    const auto over = [&](std::vector<double>& values, const auto& visit) {
      for (std::size_t k = w; k < values.size(); k += wavelengths.size()) visit(k / wavelengths.size(), values[k]);
    };
    std::vector<double> sums(brdf.albedos.front().viewAngle_rad.size(), 0.0);
    for (ViewAlbedo& albedo : brdf.albedos) over(albedo.values, [&](std::size_t view, double v) { sums[view] += v; });
    const double greatest = *std::max_element(sums.begin(), sums.end());
    if (greatest > most) most = greatest, worst_um = wavelengths[w];
    if (greatest <= 1.0) continue;
    for (std::size_t k = 0; k < brdf.parts.size(); ++k)
      for (auto* values : {&brdf.parts[k].values, &brdf.albedos[k].values}) over(*values, [&](std::size_t, double& v) { v /= greatest; });
  }
  const std::string wavelength = print("%.4g um", worst_um);
  if (most > 1.0 + kMostChange)
    throw UserError(where, "a BRDF that returns " + percent(most) + " of what it receives at " + wavelength, "at most 110 %, which is then scaled",
                    "check its unit, 1/sr");
  if (most > 1.0 + 1e-9)
    brdf.notes.push_back("scaled by up to " + percent(1.0 - 1.0 / most) + " (" + wavelength + ") so that no view returns more than it receives");
}

}  // namespace

MeasuredBrdf measuredBrdf(MeasuredGrid grid, int mostAzimuths, const Location& where) {
  const MeasuredAngles kind = grid.kind;
  MeasuredBrdf brdf;
  brdf.last_rad = last(kind);
  Change change;
  grid = folded(std::move(grid), change);
  if (const double holes = fillHoles(grid); holes > grid.mostHoles)
    throw UserError(where, percent(holes) + " of the BRDF is missing where light and view are above the surface",
                    grid.mostHoles > 0.0 ? "at most " + percent(grid.mostHoles) : "a value at every crossing of its wavelengths and angles", "fill the holes");
  else if (holes > 0.0) brdf.notes.push_back(percent(holes) + " of the BRDF was missing; it is taken as at the next smaller angle");
  if (kind == MeasuredAngles::Directions) grid = alikeBothWays(grid, change);
  if (change.rms() > kMostChange)
    throw UserError(where, "a BRDF that is not alike both ways, or not in a mirror: made so it would change by " + percent(change.rms()) + " rms",
                    "an isotropic surface, at most " + percent(kMostChange), "check the order of its angles");
  if (change.rms() > 1e-6) brdf.notes.push_back("made alike both ways and in a mirror, the BRDF changes by " + percent(change.rms()) + " rms");

  const std::array<Angle, 2> angles = kind == MeasuredAngles::Directions ? std::array{Angle::Incidence, Angle::View}
                                      : kind == MeasuredAngles::Half     ? std::array{Angle::Half, Angle::Difference}
                                                                         : std::array{Angle::HalfRoot, Angle::Difference};
  std::array<AngleAxis, 2> axes{evenAxis(grid.angle1_rad, angles[0], grid.entries[0], where), evenAxis(grid.angle2_rad, angles[1], grid.entries[1], where)};
  const Cells cells(kind, axes);
  if (cells.count() > kMostPairs)
    throw UserError(where, "a BRDF over " + std::to_string(cells.count()) + " pairs of angles", "at most " + std::to_string(kMostPairs), "thin it out");
  const std::vector<double> even = atEven(grid, axes);
  const std::size_t wavelengths = grid.wavelength_um.size(), each = cells.count() * wavelengths;
  const Eigen::MatrixXd all = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      even.data(), static_cast<Eigen::Index>(grid.azimuth_rad.size()), static_cast<Eigen::Index>(each));
  const Eigen::MatrixXd of = azimuthsOf(grid, all, cells, mostAzimuths, brdf), values = of * all;
  const Eigen::RowVectorXd middle = values.colwise().mean();
  if (axes[0].angle == Angle::None) std::swap(axes[0], axes[1]);  // the first of two is the one that a table has
  for (Eigen::Index k = 0; k < of.rows(); ++k) {
    BrdfTable part{grid.wavelength_um, axes, std::vector<double>(each)};
    for (std::size_t v = 0; v < each; ++v) {
      const auto column = static_cast<Eigen::Index>(v);
      part.values[v] = std::max(0.0, cells.isMiddle(v / wavelengths) ? middle(column) : values(k, column));
    }
    brdf.parts.push_back(std::move(part));
  }
  std::vector<Lobe> lobes;
  for (std::size_t k = 0; k < brdf.parts.size(); ++k) lobes.push_back(azimuthLobe(brdf, kind, k));
  brdf.albedos = albedosOf(
      brdf.parts,
      [&](const glm::dvec3& light, const glm::dvec3& view, std::vector<double>& shares) {
        for (std::size_t k = 0; k < lobes.size(); ++k) shares[k] = azimuthLobeAt(kind, lobes[k], light, view);
      },
      2 * std::max(1, static_cast<int>(lobes.size()) - 1));
  boundEnergy(brdf, where);
  return brdf;
}

}  // namespace pitviper
