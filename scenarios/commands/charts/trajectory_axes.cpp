#include "scenarios/commands/charts/trajectory_axes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenarios/commands/charts/space_shapes.hpp"
#include "scenarios/commands/charts/style.hpp"
#include "sim/image/draw_text.hpp"
#include "sim/image/ticks.hpp"

namespace pitviper {
namespace {

using namespace chart_style;

constexpr Rgb8 kFloor{246, 246, 244}, kLine{222, 222, 220};
constexpr double kThin_px = 0.45, kEdge_px = 0.8, kTick_px = 7.0;

struct Box {
  double left, top, right, bottom;
};

Box boxOf(const PictureLabel& l) {
  const double width = (l.bold ? boldFont() : plainFont()).width(l.text, l.size_px), left = l.at_px.x - l.anchor * width;
  return {left, l.at_px.y - 0.6 * l.size_px, left + width, l.at_px.y + 0.6 * l.size_px};
}

/// Round numbers in a range of lengths, with their texts; few where an edge is short on the picture.
struct Numbers {
  std::vector<double> at_m;
  std::vector<std::string> texts;
  std::string unit;
};

Numbers numbersIn(double low_m, double high_m, const LengthUnit& unit, double edge_px) {
  const Ticks ticks = chooseTicks(low_m / unit.metres, high_m / unit.metres);
  Numbers n;
  // A number takes so much of an edge.
  constexpr double kEach_px = 38.0;
  std::size_t every = 1;
  while (static_cast<double>(ticks.values.size()) / static_cast<double>(every) > std::max(2.0, edge_px / kEach_px)) ++every;
  for (std::size_t i = 0; i < ticks.values.size(); i += every) n.at_m.push_back(ticks.values[i] * unit.metres), n.texts.push_back(ticks.labels[i]);
  n.unit = powerText(ticks.power) + (ticks.power != 0 ? " " : "") + unit.name;
  return n;
}

}  // namespace

bool PictureLabels::addIfFree(const PictureLabel& label) {
  const Box a = boxOf(label);
  for (const PictureLabel& other : labels_) {
    const Box b = boxOf(other);
    constexpr double kApart_px = 2.0;
    if (a.left < b.right + kApart_px && b.left < a.right + kApart_px && a.top < b.bottom && b.top < a.bottom) return false;
  }
  add(label);
  return true;
}

void PictureLabels::write(Rgb8Image& picture) const {
  for (const PictureLabel& l : labels_) {
    const Box box = boxOf(l);
    // Digits and capitals are 0.73 of the em high in DejaVu.
    (l.bold ? boldFont() : plainFont())
        .draw(picture, static_cast<int>(std::lround(box.left)), static_cast<int>(std::lround(l.at_px.y + 0.36 * l.size_px)), l.text, l.size_px, l.colour);
  }
}

LengthUnit unitOf(const TrajectoryView& view) {
  constexpr double kMetresTo_m = 5000.0;
  const glm::dvec3 size = view.high_m() - view.low_m();
  const double largest = std::max({size.x, size.y, size.z});
  return largest > kMetresTo_m ? LengthUnit{1000.0, "km"} : LengthUnit{};
}

void addAxes(vtkRenderer& renderer, const TrajectoryView& view, PictureLabels& labels) {
  const LengthUnit unit = unitOf(view);
  const bool east = view.eastIsNear(), north = view.northIsNear();
  const glm::dvec3 low = view.low_m(), high = view.high_m();
  const auto corner = [&](bool e, bool n, bool u) { return view.drawn(view.atCorner(e, n, u)); };
  // Farther away along the view, which moves nothing on the picture: balls that touch the floor are not cut by it, nor paths at a wall.
  const glm::dvec3 below = -30.0 * view.back();
  addPlane(renderer,
           {corner(false, false, false) + below, corner(true, false, false) + below, corner(true, true, false) + below, corner(false, true, false) + below},
           kFloor);

  const double eastFar = east ? low.x : high.x, northFar = north ? low.y : high.y, eastNear = east ? high.x : low.x, northNear = north ? high.y : low.y;
  // The upright edge that is farthest left on the picture carries the heights.
  glm::dvec2 leftmost(1e9, 0.0);
  bool heightsEast = false, heightsNorth = false;
  for (int i = 0; i < 4; ++i)
    if (const glm::dvec2 at = view.onPicture(view.atCorner(i & 1, i & 2, false)); at.x < leftmost.x) leftmost = at, heightsEast = i & 1, heightsNorth = i & 2;
  const double heightsX = heightsEast ? high.x : low.x, heightsY = heightsNorth ? high.y : low.y;

  std::vector<SpaceLine> grid, edges;
  const auto line = [&](std::vector<SpaceLine>& to, const glm::dvec3& a, const glm::dvec3& b) { to.push_back({view.drawn(a) + below, view.drawn(b) + below}); };
  const glm::dvec2 middle = view.onPicture(0.5 * (view.atCorner(false, false, false) + view.atCorner(true, true, false)));
  const auto edgeLength = [&](const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(view.onPicture(a).x - view.onPicture(b).x) + std::abs(view.onPicture(a).y - view.onPicture(b).y);
  };
  /// Numbers along an edge, away from the middle of the floor; its name beyond them.
  const auto number = [&](const char* name, const Numbers& n, const std::function<glm::dvec3(double)>& place, const glm::dvec3& from, const glm::dvec3& to,
                          const glm::dvec2& outward) {
    std::size_t longest = 0;
    for (std::size_t i = 0; i < n.at_m.size(); ++i) {
      const glm::dvec2 at = view.onPicture(place(n.at_m[i])), end = at + kTick_px * outward;
      edges.push_back({view.inFront(at), view.inFront(end)});
      labels.addIfFree({n.texts[i], end + glm::dvec2(4.0 * outward.x, 9.0 * outward.y), 0.5 - 0.5 * outward.x, kText_px, kInk, false});
      longest = std::max(longest, n.texts[i].size());
    }
    const glm::dvec2 half = 0.5 * (view.onPicture(from) + view.onPicture(to));
    const double beyond = 30.0 + 8.0 * static_cast<double>(longest) * std::abs(outward.x);
    labels.add({std::string(name) + " [" + n.unit + "]", half + beyond * outward, 0.5 - 0.5 * outward.x, kText_px, kInk, true});
  };
  const auto outwardOf = [&](const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec2 along = view.onPicture(to) - view.onPicture(from), away = 0.5 * (view.onPicture(from) + view.onPicture(to)) - middle;
    const glm::dvec2 normal = glm::normalize(glm::dvec2(-along.y, along.x));
    return glm::dot(normal, away) < 0.0 ? -normal : normal;
  };

  const glm::dvec3 e0(low.x, northNear, low.z), e1(high.x, northNear, low.z), n0(eastNear, low.y, low.z), n1(eastNear, high.y, low.z);
  const Numbers easts = numbersIn(low.x, high.x, unit, edgeLength(e0, e1)), norths = numbersIn(low.y, high.y, unit, edgeLength(n0, n1));
  const glm::dvec3 u0(heightsX, heightsY, low.z), u1(heightsX, heightsY, high.z);
  const Numbers ups = numbersIn(low.z, high.z, unit, edgeLength(u0, u1));
  for (const double x : easts.at_m) line(grid, {x, low.y, low.z}, {x, high.y, low.z}), line(grid, {x, northFar, low.z}, {x, northFar, high.z});
  for (const double y : norths.at_m) line(grid, {low.x, y, low.z}, {high.x, y, low.z}), line(grid, {eastFar, y, low.z}, {eastFar, y, high.z});
  for (const double z : ups.at_m) line(grid, {low.x, northFar, z}, {high.x, northFar, z}), line(grid, {eastFar, low.y, z}, {eastFar, high.y, z});
  line(edges, e0, e1), line(edges, n0, n1), line(edges, u0, u1);
  number(
      "East", easts, [&](double v) { return glm::dvec3(v, northNear, low.z); }, e0, e1, outwardOf(e0, e1));
  number(
      "North", norths, [&](double v) { return glm::dvec3(eastNear, v, low.z); }, n0, n1, outwardOf(n0, n1));
  // Heights to the left of their edge, their name above it.
  for (std::size_t i = 0; i < ups.at_m.size(); ++i) {
    const glm::dvec2 at = view.onPicture({heightsX, heightsY, ups.at_m[i]}), end = at - glm::dvec2(kTick_px, 0.0);
    edges.push_back({view.inFront(at), view.inFront(end)});
    labels.addIfFree({ups.texts[i], end - glm::dvec2(4.0, 0.0), 1.0, kText_px, kInk, false});
  }
  labels.add({"Up [" + ups.unit + "]", view.onPicture(u1) - glm::dvec2(0.0, 14.0), 0.5, kText_px, kInk, true});
  addTubes(renderer, grid, kThin_px, kLine, false);
  addTubes(renderer, edges, kEdge_px, kAxis, false);
}

}  // namespace pitviper
