#include "sim/camera/overlay.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"

namespace pitviper {
namespace {

/// Of a view: from there on all of it is drawn as one.
constexpr double kMostOfView = 0.5;
/// Pixels drawn around what counts; across, at least.
constexpr int kRoom_px = 2;
constexpr unsigned kFewest_px = 16;

struct Box {
  glm::dvec2 low{INFINITY}, high{-INFINITY};
  bool isEmpty() const { return !(high.x > low.x && high.y > low.y); }
  void add(const glm::dvec2& from, const glm::dvec2& to) { low = glm::min(low, from), high = glm::max(high, to); }
};

/// Around a ball, or all of the view where it is too near to tell.
void addBall(Box& box, const View& v, const glm::dvec3& centre, double radius_m) {
  const glm::dvec3 p = glm::transpose(v.localFromCamera) * (centre - v.position);
  for (int k = 0; k < 2; ++k) {
    const double distance = std::hypot(p[k], p.z), middle = std::atan2(p[k], -p.z), half = std::asin(std::min(radius_m / distance, 1.0));
    if (!(radius_m < distance) || !(std::abs(middle) + half < 1.55)) return box.add(glm::dvec2(0.0), glm::dvec2(v.width, v.height));
  }
  const auto at = [&](int k, double side) {
    const double angle = std::atan2(p[k], -p.z) + side * std::asin(radius_m / std::hypot(p[k], p.z));
    return (k == 0 ? v.axisX : v.axisY) + std::tan(angle) / (k == 0 ? v.tanPerPixelX : v.tanPerPixelY);
  };
  box.add({at(0, -1.0), at(1, -1.0)}, {at(0, 1.0), at(1, 1.0)});
}

/// Of two parts (corner, size); of size 0 where they are apart.
glm::ivec4 common(const glm::ivec4& a, const glm::ivec4& b) {
  const glm::ivec2 low = glm::max(glm::ivec2(a), glm::ivec2(b)), high = glm::min(glm::ivec2(a.x + a.z, a.y + a.w), glm::ivec2(b.x + b.z, b.y + b.w));
  return high.x > low.x && high.y > low.y ? glm::ivec4(low, high - low) : glm::ivec4(0);
}

/// Whole pixels around a box, and so many more, within the view.
glm::ivec4 pixelsAround(const Box& box, const View& v, int more) {
  const int each = v.subpixels;
  const glm::dvec2 film(v.width, v.height);
  const glm::ivec2 low = (glm::ivec2(glm::floor(glm::clamp(box.low, glm::dvec2(0.0), film))) / each - more) * each;
  const glm::ivec2 high = ((glm::ivec2(glm::ceil(glm::clamp(box.high, glm::dvec2(0.0), film))) + each - 1) / each + more) * each;
  const glm::ivec2 from = glm::max(low, glm::ivec2(0)), to = glm::min(high, glm::ivec2(v.width, v.height));
  return {from, glm::max(to - from, glm::ivec2(0))};
}

/// Grown to a power of two of pixels each way, within the view: passes keep their targets by size, and what is seen through grows and shrinks frame by frame.
glm::ivec4 ofFewSizes(glm::ivec4 part, const View& v) {
  const glm::ivec2 film(v.width, v.height);
  for (int k = 0; k < 2; ++k) {
    const int size = v.subpixels * static_cast<int>(std::bit_ceil(std::max(static_cast<unsigned>(part[k + 2] / v.subpixels), kFewest_px)));
    part[k + 2] = std::min(size, film[k]);
    part[k] = std::min(part[k], film[k] - part[k + 2]);
  }
  return part;
}

}  // namespace

std::optional<Overlay> overlayIn(const Simulation& sim, const WorldState& state, const View& v, const std::vector<char>& bodies) {
  Box box;
  for (size_t f = 0; f < sim.fields.size(); ++f) {
    const FieldState* field = fieldOf(state, f);
    if (!field || field->elements.empty()) continue;
    if (const FieldLines lines = fieldLines(v, *field); !lines.isEmpty()) box.add(lines.low, lines.high);
  }
  for (size_t e = 0; e < sim.entities.size(); ++e) {
    const Entity& entity = sim.entities[e];
    if (!bodies[e] || !sim.isTransparent(entity)) continue;
    const glm::dvec3 centre = state.entities[e].position + state.entities[e].orientation * glm::dvec3(entity.boundingCentre);
    if (mayShow(v, centre, entity.boundingRadius_m)) addBall(box, v, centre, entity.boundingRadius_m);
  }
  Overlay overlay;
  if (box.isEmpty()) return overlay;
  overlay.counts = pixelsAround(box, v, 0);
  overlay.drawn = ofFewSizes(pixelsAround(box, v, kRoom_px), v);
  if (static_cast<double>(overlay.drawn.z) * overlay.drawn.w > kMostOfView * v.width * v.height) return {};
  return overlay;
}

View overlayView(const View& view, const Overlay& overlay) {
  View part = view;
  const glm::ivec4& d = overlay.drawn;
  part.width = d.z, part.height = d.w;
  part.axisX -= d.x, part.axisY -= d.y;
  part.wanted = nullptr;
  part.kept = common(overlay.counts, view.kept);
  if (part.kept.z > 0) part.kept -= glm::ivec4(d.x, d.y, 0, 0);
  return part;
}

void lay(const RawImage& part, const View& view, const Overlay& overlay, RawImage& picture) {
  const int each = view.width / picture.width;  // subpixels of what was read back
  const glm::ivec4 counts = overlay.counts / each, drawn = overlay.drawn / each;
  // `rows` of `size` pixels, from a corner in pictures so wide.
  const auto over = [](const std::vector<std::vector<float>>& from, const glm::ivec2& corner, int width, std::vector<std::vector<float>>& to,
                       const glm::ivec2& place, int wide, const glm::ivec2& size) {
    for (size_t g = 0; g < to.size(); ++g)
      for (int y = 0; y < size.y; ++y)
        std::copy_n(from[g].begin() + 4L * ((corner.y + y) * width + corner.x), 4L * size.x, to[g].begin() + 4L * ((place.y + y) * wide + place.x));
  };
  const glm::ivec2 corner(counts.x - drawn.x, counts.y - drawn.y), place(counts.x, counts.y), size(counts.z, counts.w);
  over(part.groups, corner, part.width, picture.groups, place, picture.width, size);
  over(part.truth, corner, part.width, picture.truth, place, picture.width, size);
  if (part.kept.z > 0)
    over(part.keptGroups, glm::ivec2(0), part.kept.z, picture.keptGroups,
         glm::ivec2(part.kept.x + overlay.drawn.x - picture.kept.x, part.kept.y + overlay.drawn.y - picture.kept.y), picture.kept.z,
         glm::ivec2(part.kept.z, part.kept.w));
}

}  // namespace pitviper
