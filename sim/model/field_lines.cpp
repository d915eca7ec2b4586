#include "sim/model/field_lines.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Parts of the finest length that lines lie apart at most. A Gaussian profile sampled every 0.83 sigma is integrated to 1e-12 (Poisson's summation); the
/// finest length of a puff is 1.66 of its sigma.
constexpr double kApart = 0.5;
/// The same for pictures: every sigma of a Gaussian, 1e-8 of its integral; what ends, as puffs do, 2e-3 of it.
constexpr double kFewApart = 0.6;
/// A rectangle grows by a part of itself and by so many pixels: rounding in single precision.
constexpr double kMargin = 0.02, kMargin_px = 1e-4;

void cover(FieldLines& lines, const glm::dvec2& low, const glm::dvec2& high) {
  lines.low = glm::min(lines.low, low);
  lines.high = glm::max(lines.high, high);
}

/// The rectangle around the corners of its box; false where a corner is not before the camera.
bool ofBox(const View& v, const FieldState& f, FieldLines& lines) {
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  for (int c = 0; c < 8; ++c) {
    const glm::dvec3 corner((c & 1) ? f.high.x : f.low.x, (c & 2) ? f.high.y : f.low.y, (c & 4) ? f.high.z : f.low.z);
    const glm::dvec3 p = cameraFromLocal * (f.origin + f.localFromField * corner - v.position);
    if (!(-p.z > v.near_m)) return false;
    cover(lines, filmPosition(v, p), filmPosition(v, p));
  }
  return true;
}

/// Around a sphere; nothing where it is behind. False where it reaches the camera's plane: it may show everywhere.
bool ofSphere(const View& v, const FieldState& f, const FieldElement& e, FieldLines& lines) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (f.origin + f.localFromField * e.centre - v.position);
  if (-p.z < -e.radius_m) return true;
  if (!(-p.z > e.radius_m + v.near_m)) return false;
  glm::dvec2 low, high;
  for (int k = 0; k < 2; ++k) {
    // Planes through the eye that touch the sphere: angles of its middle -+ asin(radius / distance), in the plane of this axis and the camera's.
    const double distance = std::hypot(p[k], p.z), middle = std::atan2(p[k], -p.z), half = std::asin(std::min(e.radius_m / distance, 1.0));
    const double tan = k == 0 ? v.tanPerPixelX : v.tanPerPixelY, axis = k == 0 ? v.axisX : v.axisY;
    if (!(std::abs(middle) + half < 1.55)) return false;
    low[k] = axis + std::tan(middle - half) / tan;
    high[k] = axis + std::tan(middle + half) / tan;
  }
  cover(lines, low, high);
  return true;
}

bool ofElements(const View& v, const FieldState& f, FieldLines& lines) {
  return std::all_of(f.elements.begin(), f.elements.end(), [&](const FieldElement& e) { return ofSphere(v, f, e, lines); });
}

const FieldLines kNothing{glm::dvec2(INFINITY), glm::dvec2(-INFINITY), 1.0};

FieldLines cutToFilm(const View& view, const FieldLines& found) {
  const glm::dvec2 margin = kMargin * (found.high - found.low) + kMargin_px;
  return {glm::max(found.low - margin, glm::dvec2(0.0)), glm::min(found.high + margin, glm::dvec2(view.width, view.height)), found.apart_px};
}

}  // namespace

FieldLines fieldLines(const View& view, const FieldState& field) {
  const glm::dvec2 film(view.width, view.height);
  FieldLines all{glm::dvec2(0.0), film, 1.0};
  for (const auto& find : {ofBox, ofElements}) {
    FieldLines found = kNothing;
    if (!find(view, field, found)) continue;
    found = cutToFilm(view, found);
    all.low = glm::max(all.low, found.low);
    all.high = glm::min(all.high, found.high);
  }
  if (all.isEmpty()) return all;
  // Where its nearest part is: pixels are smallest there, compared with what it holds.
  double nearest = INFINITY;
  for (const FieldElement& e : field.elements)
    nearest = std::min(nearest, glm::length(field.origin + field.localFromField * e.centre - view.position) - e.radius_m);
  const double pixel = std::min(view.tanPerPixelX, view.tanPerPixelY) * std::max(nearest, view.near_m);
  all.apart_px = std::max(kApart * field.finest_m / pixel, 1e-6);
  return all;
}

ElementLines elementLines(const View& view, const FieldState& field, const FieldElement& element) {
  ElementLines lines;
  FieldLines found = kNothing;
  if (ofSphere(view, field, element, found)) lines.on = cutToFilm(view, found);
  else lines.on = {glm::dvec2(0.0), glm::dvec2(view.width, view.height), 1.0};
  const glm::dvec3 to = field.origin + field.localFromField * element.centre - view.position, axis = field.localFromField * element.drawnOut_m;
  const double range = std::max(glm::length(to), view.near_m), pixel = std::min(view.tanPerPixelX, view.tanPerPixelY) * range;
  const double aside = glm::length(axis - glm::dot(axis, to) / (range * range) * to);
  lines.across = pixel / (kFewApart * element.finest_m);
  lines.perPixel = lines.across * pixel / (kFewApart * std::max(aside, element.finest_m));
  return lines;
}

PixelLines pixelLines(std::span<const FieldLines> fields, int x, int y, int most) {
  const glm::dvec2 corner(x, y);
  glm::dvec2 low(INFINITY), high(-INFINITY);
  double apart = INFINITY;
  for (const FieldLines& f : fields) {
    const glm::dvec2 from = glm::max(f.low, corner), to = glm::min(f.high, corner + 1.0);
    if (f.isEmpty() || !(to.x > from.x && to.y > from.y)) continue;
    low = glm::min(low, from), high = glm::max(high, to);
    apart = std::min(apart, f.apart_px);
  }
  PixelLines lines;
  if (!(apart < 1.0) || !(high.x > low.x)) {
    lines.within.push_back({corner + 0.5, 1.0});
    return lines;
  }
  const glm::dvec2 size = high - low;
  const glm::ivec2 count(std::clamp(static_cast<int>(std::ceil(size.x / apart)), 1, most), std::clamp(static_cast<int>(std::ceil(size.y / apart)), 1, most));
  for (int j = 0; j < count.y; ++j)
    for (int i = 0; i < count.x; ++i)
      lines.within.push_back({low + size * glm::dvec2((i + 0.5) / count.x, (j + 0.5) / count.y), size.x * size.y / (count.x * count.y)});
  lines.outside = std::max(1.0 - size.x * size.y, 0.0);
  return lines;
}

}  // namespace pitviper
