#include "sim/world/field_lines.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Parts of the finest length that lines lie apart at most. A Gaussian profile sampled every 0.83 sigma is integrated to 1e-12 (Poisson's summation); the
/// finest length of a puff is 1.66 of its sigma.
constexpr double kApart = 0.5;
/// A rectangle grows by a part of itself and by so many pixels: rounding in single precision.
constexpr double kMargin = 0.02, kMargin_px = 1e-4;

void cover(FieldLines& lines, const glm::dvec2& low, const glm::dvec2& high) {
  lines.low = glm::min(lines.low, low);
  lines.high = glm::max(lines.high, high);
}

/// The rectangle around the corners of a box in the field's axes; false where a corner is not before the camera.
bool ofBox(const View& v, const FieldState& f, const glm::dvec3& low, const glm::dvec3& high, FieldLines& lines) {
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  for (int c = 0; c < 8; ++c) {
    const glm::dvec3 corner((c & 1) ? high.x : low.x, (c & 2) ? high.y : low.y, (c & 4) ? high.z : low.z);
    const glm::dvec3 p = cameraFromLocal * (f.origin + f.localFromField * corner - v.position);
    if (!(-p.z > v.near_m)) return false;
    cover(lines, filmPosition(v, p), filmPosition(v, p));
  }
  return true;
}

/// Around a sphere; nothing where it is behind, or beside all that the film's plane has. False where it may show everywhere.
bool ofSphere(const View& v, const FieldState& f, const FieldElement& e, FieldLines& lines) {
  constexpr double kAlongPlane = 1.570796;  // rad: so near the camera's plane a film of single precision ends
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (f.origin + f.localFromField * e.centre - v.position);
  if (-p.z < -e.radius_m) return true;
  glm::dvec2 low(-INFINITY), high(INFINITY);
  bool tells = false;
  for (int k = 0; k < 2; ++k) {
    // Planes through the eye that touch the sphere: angles of its middle -+ asin(radius / distance), in the plane of this axis and the camera's.
    const double distance = std::hypot(p[k], p.z), middle = std::atan2(p[k], -p.z);
    if (!(distance > e.radius_m)) continue;
    const double half = std::asin(e.radius_m / distance), from = middle - half, to = middle + half;
    if (from > kAlongPlane || to < -kAlongPlane) return true;
    tells = true;
    const double tan = k == 0 ? v.tanPerPixelX : v.tanPerPixelY, axis = k == 0 ? v.axisX : v.axisY;
    if (from > -kAlongPlane) low[k] = axis + std::tan(from) / tan;
    if (to < kAlongPlane) high[k] = axis + std::tan(to) / tan;
  }
  if (tells) cover(lines, low, high);
  return tells;
}

/// How far apart lines through an element may lie: over its finest length, and over more along its axis as it shows on the film.
glm::dvec2 apartOf(const View& v, const FieldState& f, const FieldElement& e, double range_m) {
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  const glm::dvec3 to = glm::normalize(cameraFromLocal * (f.origin + f.localFromField * e.centre - v.position));
  const glm::dvec3 axis = cameraFromLocal * (f.localFromField * e.drawnOut_m), aside = axis - glm::dot(axis, to) * to;
  const double pixel = std::min(v.tanPerPixelX, v.tanPerPixelY) * range_m, length = glm::length(aside), fine = kApart * e.finest_m / pixel,
               along = kApart * std::max(length, e.finest_m) / pixel;
  // What changes over `fine` at right angles to a direction and over `along` in it.
  const glm::dvec2 way = length > 0.0 ? glm::dvec2(aside.x, aside.y) / length : glm::dvec2(1.0, 0.0);
  const auto least = [&](double in, double beside) { return std::max(1.0 / std::max(std::abs(in) / along, std::abs(beside) / fine), 1e-6); };
  return {least(way.x, way.y), least(way.y, way.x)};
}

const FieldLines kNothing{glm::dvec2(INFINITY), glm::dvec2(-INFINITY), 1.0};

/// Around what both its sphere and its box hold; false where neither tells.
bool ofElement(const View& v, const FieldState& f, const FieldElement& e, FieldLines& lines) {
  FieldLines sphere = kNothing, box = kNothing;
  const bool round = ofSphere(v, f, e, sphere);
  if (round && sphere.isEmpty()) return true;
  const bool boxed = e.half_m != glm::dvec3(0.0) && ofBox(v, f, e.centre - e.half_m, e.centre + e.half_m, box);
  if (!round && !boxed) return false;
  if (!round) cover(lines, box.low, box.high);
  else if (!boxed) cover(lines, sphere.low, sphere.high);
  else cover(lines, glm::max(sphere.low, box.low), glm::min(sphere.high, box.high));
  return true;
}

bool ofElements(const View& v, const FieldState& f, FieldLines& lines) {
  return std::all_of(f.elements.begin(), f.elements.end(), [&](const FieldElement& e) { return ofElement(v, f, e, lines); });
}

bool ofWhole(const View& v, const FieldState& f, FieldLines& lines) { return ofBox(v, f, f.low, f.high, lines); }

FieldLines cutToFilm(const View& view, const FieldLines& found) {
  const glm::dvec2 film(view.width, view.height), low = glm::max(found.low, -film), high = glm::min(found.high, 2.0 * film);
  const glm::dvec2 margin = kMargin * glm::max(high - low, glm::dvec2(0.0)) + kMargin_px;
  return {glm::max(low - margin, glm::dvec2(0.0)), glm::min(high + margin, film), found.apart_px};
}

}  // namespace

FieldLines fieldLines(const View& view, const FieldState& field) {
  const glm::dvec2 film(view.width, view.height);
  FieldLines all{glm::dvec2(0.0), film, 1.0};
  for (const auto& find : {ofWhole, ofElements}) {
    FieldLines found = kNothing;
    if (!find(view, field, found)) continue;
    found = cutToFilm(view, found);
    all.low = glm::max(all.low, found.low);
    all.high = glm::min(all.high, found.high);
  }
  if (all.isEmpty()) return all;
  all.apart_px = INFINITY;
  for (std::size_t i = 0; i < field.elements.size(); ++i) {
    const FieldElement& e = field.elements[i];
    FieldLines found = kNothing;
    if (ofElement(view, field, e, found)) found = cutToFilm(view, found);
    else found = all;
    FieldLines::Part part{glm::max(found.low, all.low), glm::min(found.high, all.high), glm::dvec2(1.0), i};
    if (!(part.high.x > part.low.x && part.high.y > part.low.y)) continue;
    // Where its nearest place is pixels are smallest, compared with what it holds.
    const double nearest = glm::length(field.origin + field.localFromField * e.centre - view.position) - e.radius_m;
    part.apart_px = apartOf(view, field, e, std::max(nearest, view.near_m));
    all.apart_px = std::min({all.apart_px, part.apart_px.x, part.apart_px.y});
    all.parts.push_back(part);
  }
  return all;
}

namespace {

/// Of Gauss and Legendre, one to three points on [0, 1] and what each counts: what a pixel's border cuts in the middle of its slope is as good as what lies
/// within.
struct Points {
  int count;
  double at[3], share[3];
};
constexpr Points kPoints[3] = {{1, {0.5, 0.0, 0.0}, {1.0, 0.0, 0.0}},
                               {2, {0.211324865405187118, 0.788675134594812882, 0.0}, {0.5, 0.5, 0.0}},
                               {3, {0.112701665379258311, 0.5, 0.887298334620741689}, {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0}}};
/// Of a pixel's cells: parts so much coarser than its finest, or so much of it empty, is worth halving it.
constexpr double kCoarser = 1.5, kFilled = 0.7;
/// Lines of a pixel with too many of them lie so many times farther apart at most, found in such steps, the last of them in thirds of it: as many lines as may
/// be, since a limit of 784 would else be met by 324.
constexpr double kCoarsest = 1e3, kStep = 1.4;

/// A pixel's cells: halved until what is in each is about alike; given up where that takes more lines than `most`.
class PixelCells {
 public:
  PixelCells(const LinesApart& apart, double most) : apart_(apart), most_(most) {}
  void add(const glm::dvec2& low, const glm::dvec2& high, std::span<const FieldLines::Part> parts) {
    if (isFull()) return;
    std::vector<FieldLines::Part> here;
    glm::dvec2 from(INFINITY), to(-INFINITY), finest(INFINITY), least(INFINITY), most(0.0);
    double filled = 0.0;
    for (const FieldLines::Part& p : parts) {
      const FieldLines::Part cut{glm::max(p.low, low), glm::min(p.high, high), p.apart_px, p.element, p.coarser};
      if (!(cut.high.x > cut.low.x && cut.high.y > cut.low.y)) continue;
      here.push_back(cut);
      from = glm::min(from, cut.low), to = glm::max(to, cut.high);
      finest = glm::min(finest, p.apart_px);
      least = glm::min(least, p.coarser * p.apart_px), most = glm::max(most, p.coarser * p.apart_px);
      filled += (cut.high.x - cut.low.x) * (cut.high.y - cut.low.y);
    }
    if (here.empty()) return;
    const glm::dvec2 size = to - from, lines = size / (apart_.coarser * least), wanted = size / finest;
    const int across = lines.x >= lines.y ? 0 : 1;
    if (lines[across] > 6.0 && (most.x * most.y > kCoarser * least.x * least.y || filled < kFilled * size.x * size.y)) {
      glm::dvec2 end = to, begin = from;
      end[across] = begin[across] = 0.5 * (from[across] + to[across]);
      add(from, end, here);
      add(begin, to, here);
      return;
    }
    cells_.push_back({from, to, {axisOf(lines.x, wanted.x), axisOf(lines.y, wanted.y)}});
    lines_ += static_cast<double>(cells_.back().axis[0].lines()) * cells_.back().axis[1].lines();
  }
  /// All of it as one, with so many lines each way.
  void addWhole(const glm::dvec2& low, const glm::dvec2& high, int lines) {
    const Axis axis = lines < 3 ? Axis{1, &kPoints[std::max(lines, 1) - 1]} : Axis{lines / 3, &kPoints[2]};
    cells_.assign(1, {low, high, {axis, axis}});
  }
  bool isFull() const { return lines_ > most_; }
  PixelLines all() const {
    PixelLines found;
    found.outside = 1.0;
    for (const Cell& c : cells_) {
      const glm::dvec2 size = c.high - c.low;
      for (int j = 0; j < c.axis[1].lines(); ++j)
        for (int i = 0; i < c.axis[0].lines(); ++i)
          found.within.push_back({c.low + size * glm::dvec2(c.axis[0].at(i), c.axis[1].at(j)), size.x * size.y * c.axis[0].share(i) * c.axis[1].share(j)});
      found.outside -= size.x * size.y;
    }
    if (found.outside < 1e-9) found.outside = 0.0;
    return found;
  }

 private:
  struct Axis {
    int panels;
    const Points* points;
    int lines() const { return panels * points->count; }
    double at(int i) const { return (i / points->count + points->at[i % points->count]) / panels; }
    double share(int i) const { return points->share[i % points->count] / panels; }
  };
  Axis axisOf(double lines, double wanted) const {
    const int count = std::max(static_cast<int>(std::ceil(std::min(lines, 1e4))), wanted > 1.0 ? apart_.atLeast : 1);
    return count <= 3 ? Axis{1, &kPoints[count - 1]} : Axis{(count + 2) / 3, &kPoints[2]};
  }
  struct Cell {
    glm::dvec2 low, high;
    Axis axis[2];
  };
  LinesApart apart_;
  double most_, lines_ = 0.0;
  std::vector<Cell> cells_;
};

}  // namespace

PixelLines pixelLines(std::span<const FieldLines* const> fields, int x, int y, int most, const LinesApart& apart) {
  const glm::dvec2 corner(x, y);
  std::vector<FieldLines::Part> parts;
  double finest = INFINITY;
  for (const FieldLines* f : fields)
    for (const FieldLines::Part& p : f->parts) {
      if (!(p.high.x > corner.x && p.high.y > corner.y && p.low.x < corner.x + 1.0 && p.low.y < corner.y + 1.0)) continue;
      parts.push_back(p);
      finest = std::min({finest, p.apart_px.x, p.apart_px.y});
    }
  PixelLines lines;
  if (!(finest < 1.0)) {
    lines.within.push_back({corner + 0.5, 1.0});
    return lines;
  }
  const auto cellsOf = [&](double coarser) {
    PixelCells cells({coarser, apart.atLeast}, static_cast<double>(most) * most);
    cells.add(corner, corner + 1.0, parts);
    return cells;
  };
  double coarser = apart.coarser;
  PixelCells cells = cellsOf(coarser);
  if (!cells.isFull()) return cells.all();
  while (cells.isFull() && coarser <= kCoarsest) cells = cellsOf(coarser *= kStep);
  if (cells.isFull()) {
    cells.addWhole(corner, corner + 1.0, most);
    return cells.all();
  }
  for (const double back : {2.0 / 3.0, 1.0 / 3.0})
    if (PixelCells more = cellsOf(coarser * std::pow(kStep, -back)); !more.isFull()) return more.all();
  return cells.all();
}

}  // namespace pitviper
