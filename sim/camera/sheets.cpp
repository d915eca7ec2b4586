#include "sim/camera/sheets.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/camera/zoomed_lines.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/ray_hits.hpp"

namespace pitviper {
namespace {

/// Of cones of balls: a sheet's corners are 1.5 of its ball off; bodies that are near each other.
constexpr double kSheetRoom = 1.6, kNearRoom = 1.1;
/// Lines across a bright part at most, and across bodies that share a sheet.
constexpr double kMostOfParts = 512.0, kMostTogether = 512.0;
/// Lines that take as long as what a sheet costs besides.
constexpr double kSheet = 16384.0;

/// At least 8 a subpixel; 4 where the accuracy leaves few to the body as a whole: an edge then leaves a subpixel off by 3 % of its contrast, not 1.
int linesAcross(double extent, int lines) {
  constexpr int kFew = 64;
  int size = lines;
  while (size < (lines <= kFew ? 4.0 : 8.0) * extent && size < 4096) size *= 2;
  return size;
}

/// Bodies side by side (slices of a plume) share a sheet of the finest one's density: each is a picture of its own, with all that is transparent in it.
void join(std::vector<Sheet>& sheets, const View& v) {
  constexpr double kAlike = 2.0, kEmpty = 1.5;  // densities; lines beside the bodies
  const auto samples = [](double lines) { return lines * lines; };
  for (std::size_t i = 0; i < sheets.size(); ++i)
    for (std::size_t j = i + 1; j < sheets.size();) {
      Sheet &one = sheets[i], &other = sheets[j];
      const double finest = std::max(one.density, other.density);
      const Ball both = around(one.ball, other.ball);
      const double needed = finest * extentOf(both, v);
      const int size = needed <= kMostTogether ? evenSize(needed) : 0;
      if (size == 0 || finest > kAlike * std::min(one.density, other.density) ||
          samples(size) > kEmpty * (samples(one.view.width) + samples(other.view.width)) + kSheet) {
        ++j;
        continue;
      }
      one.ball = both;
      one.view.width = size;
      one.density = size / extentOf(both, v);
      one.bodies.insert(one.bodies.end(), other.bodies.begin(), other.bodies.end());
      sheets.erase(sheets.begin() + static_cast<long>(j));
      j = i + 1;
    }
}

/// Whether some part of a field may show in the same pixels: its mean over them is not what the body hides.
bool nearField(const Simulation& sim, const WorldState& state, const Ball& ball, const View& v) {
  for (std::size_t f = 0; f < sim.fields.size(); ++f) {
    const FieldState* field = fieldOf(state, f);
    if (!field) continue;
    const FieldLines lines = fieldLines(v, *field);
    if (lines.isEmpty()) continue;
    const glm::dvec3 p = glm::transpose(v.localFromCamera) * (ball.centre - v.position);
    if (!(-p.z > ball.radius_m)) return true;
    const glm::dvec2 at = filmPosition(v, p);
    const double pixels = ball.radius_m / -p.z / std::min(v.tanPerPixelX, v.tanPerPixelY) + 1.0;
    if (at.x + pixels > lines.low.x && at.y + pixels > lines.low.y && at.x - pixels < lines.high.x && at.y - pixels < lines.high.y) return true;
  }
  return false;
}

}  // namespace

Sheets::Sheets(const Simulation& sim, const WorldState& state, const View& film, const std::vector<char>& small, const std::vector<char>& present,
               const std::vector<int>& lines, const std::vector<Ball>& parts)
    : sim_(sim), state_(state), film_(film) {
  for (std::size_t e = 0; e < small.size(); ++e) {
    transparent_.push_back(sim.isTransparent(sim.entities[e]));
    const Ball ball = ballOf(sim, state, static_cast<int>(e));
    if (small[e] && present[e] && mayShow(film, ball.centre, ball.radius_m)) bodies_.push_back(static_cast<int>(e));
  }
  addBodies(lines);
  for (const Ball& part : parts) {
    Sheet sheet{zoomedView(part, film, evenSize(std::min(2.0 * part.radius_m * part.lines_per_m, kMostOfParts))), part, {}, subpixelsOf(part), {}, 0.0};
    sheet.view.onlyEntity = -1;
    sheet.density = sheet.view.width / extentOf(part, film);
    sheets_.push_back(std::move(sheet));
  }
  std::stable_sort(sheets_.begin(), sheets_.end(), [](const Sheet& a, const Sheet& b) { return a.density > b.density; });
  for (std::size_t i = 0; i < sheets_.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (mayOverlap(sheets_[i].ball, sheets_[j].ball, film.position, kSheetRoom)) sheets_[i].finer.push_back(j);
}

/// Solid, and neither what is small and seen through nor a field is near.
bool Sheets::isAlone(int entity) const {
  const Ball own = ballOf(sim_, state_, entity);
  return !transparent_[static_cast<std::size_t>(entity)] && !nearField(sim_, state_, own, film_) && std::none_of(bodies_.begin(), bodies_.end(), [&](int e) {
    return transparent_[static_cast<std::size_t>(e)] && mayOverlap(own, ballOf(sim_, state_, e), film_.position, kNearRoom);
  });
}

void Sheets::addBodies(const std::vector<int>& lines) {
  std::vector<Sheet> among;
  for (int e : bodies_) {
    const Ball ball = ballOf(sim_, state_, e);
    const double extent = extentOf(ball, film_);
    const int most = lines[static_cast<std::size_t>(e)];
    Sheet sheet;
    sheet.ball = ball;
    sheet.bodies = {e};
    const bool alone = isAlone(e);
    sheet.view.width = linesAcross(extent, !alone && sim_.mediumOf(sim_.entities[static_cast<std::size_t>(e)]) ? most / 2 : most);
    sheet.density = sheet.view.width / extent;
    if (alone) sheet.view = zoomedView(ball, film_, sheet.view.width);
    (alone ? sheets_ : among).push_back(std::move(sheet));
  }
  join(among, film_);
  for (Sheet& sheet : among) {
    sheet.view = zoomedView(sheet.ball, film_, sheet.view.width);
    sheet.view.onlyEntity = -1;
    sheets_.push_back(std::move(sheet));
  }
}

/// Flags of those that a part of a body may show in: of all surfaces within its ball, around each triangle.
std::vector<char> Sheets::subpixelsOf(const Ball& part) const {
  constexpr double kMargin = 0.01;  // of a subpixel
  const View& v = film_;
  const auto width = static_cast<std::size_t>(v.width);
  std::vector<char> flags(width * static_cast<std::size_t>(v.height), 0);
  const Entity& entity = sim_.entities[static_cast<std::size_t>(part.entity)];
  const Pose& pose = state_.entities[static_cast<std::size_t>(part.entity)];
  const glm::dmat3 cameraFromLocal = glm::transpose(v.localFromCamera);
  for (const Surface& surface : entity.surfaces) {
    const MeshPart& own = entity.mesh->parts[surface.meshPart];
    std::vector<glm::dvec2> corners;
    bool within = true;
    for (std::uint32_t t = own.firstTriangle; t < own.firstTriangle + own.triangleCount && within; ++t)
      for (int k = 0; k < 3 && within; ++k) {
        const glm::dvec3 at = pose.position + pose.orientation * glm::dvec3(entity.mesh->positions[entity.mesh->triangles[t][k]]);
        within = glm::length(at - part.centre) <= part.radius_m;  // which lies before the camera
        corners.push_back(filmPosition(v, cameraFromLocal * (at - v.position)));
      }
    for (std::size_t c = 0; within && c < corners.size(); c += 3) {
      const glm::dvec2 size(v.width - 1, v.height - 1), low = glm::min(glm::min(corners[c], corners[c + 1]), corners[c + 2]) - kMargin,
                                                        high = glm::max(glm::max(corners[c], corners[c + 1]), corners[c + 2]) + kMargin;
      if (high.x < 0.0 || high.y < 0.0 || low.x > v.width || low.y > v.height) continue;
      const glm::ivec2 from(glm::clamp(low, glm::dvec2(0.0), size)), to(glm::clamp(high, glm::dvec2(0.0), size));
      for (int y = from.y; y <= to.y; ++y)
        for (int x = from.x; x <= to.x; ++x) flags[static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x)] = 1;
    }
  }
  return flags;
}

template <class Meets>
bool Sheets::isOf(const Sheet& sheet, const glm::dvec3& direction, std::size_t subpixel, const Meets& meets) const {
  if (sheet.bodies.empty()) return sheet.subpixels[subpixel] && looksAt(sheet.view, direction);
  return std::any_of(sheet.bodies.begin(), sheet.bodies.end(), meets);
}

bool Sheets::counts(const Sheet& sheet, const glm::dvec2& place, std::size_t subpixel, int seen) const {
  if (sheet.view.onlyEntity >= 0 && sheet.view.onlyEntity != seen) return false;
  const glm::dvec3 ray = sheet.view.ray(place.x, place.y), direction = sheet.view.localFromCamera * ray / glm::length(ray);
  const auto meets = [&](int e) {
    return e == seen ||
           (transparent_[static_cast<std::size_t>(e)] && meetsBody(sim_, state_, film_.position, direction, sheet.view.near_m * glm::length(ray), e));
  };
  return isOf(sheet, direction, subpixel, meets) &&
         std::none_of(sheet.finer.begin(), sheet.finer.end(), [&](std::size_t j) { return isOf(sheets_[j], direction, subpixel, meets); });
}

std::shared_ptr<const std::vector<char>> Sheets::mayCount(const Sheet& sheet, const std::vector<char>* only) const {
  const bool alone = sheet.view.onlyEntity >= 0;
  if (alone && !only) return nullptr;
  auto marks = std::make_shared<std::vector<char>>(static_cast<std::size_t>(sheet.view.width) * static_cast<std::size_t>(sheet.view.height), 0);
  eachLine(film_, sheet.view, [&](const SheetLine& line) {
    if (only && !(*only)[line.subpixel]) return;
    char& mark = (*marks)[line.number];
    if (alone) {
      mark = 1;
      return;
    }
    const glm::dvec3 ray = sheet.view.ray(line.place.x, line.place.y), direction = sheet.view.localFromCamera * ray / glm::length(ray);
    const double near_m = sheet.view.near_m * glm::length(ray);
    const auto meets = [&](int e) { return meetsBody(sim_, state_, film_.position, direction, near_m, e); };
    const auto surelyMeets = [&](int e) { return transparent_[static_cast<std::size_t>(e)] && meets(e); };
    mark = isOf(sheet, direction, line.subpixel, meets) &&
           std::none_of(sheet.finer.begin(), sheet.finer.end(), [&](std::size_t j) { return isOf(sheets_[j], direction, line.subpixel, surelyMeets); });
  });
  return marks;
}

void eachLine(const View& v, const View& z, const std::function<void(const SheetLine&)>& visit) {
  const glm::dmat3 filmFromSheet = glm::transpose(v.localFromCamera) * z.localFromCamera;
  SheetLine line;
  for (int j = 0; j < z.height; ++j)
    for (int i = 0; i < z.width; ++i) {
      line.place = {i + 0.5, j + 0.5};
      const glm::dvec3 ray = z.ray(line.place.x, line.place.y), seen = filmFromSheet * ray;
      if (seen.z >= 0.0) continue;
      const glm::dvec2 at = filmPosition(v, seen);
      if (!(at.x >= 0.0 && at.y >= 0.0 && at.x < v.width && at.y < v.height)) continue;
      const double l2 = glm::dot(ray, ray);
      line.number = static_cast<std::size_t>(j) * static_cast<std::size_t>(z.width) + static_cast<std::size_t>(i);
      line.subpixel = static_cast<std::size_t>(at.y) * static_cast<std::size_t>(v.width) + static_cast<std::size_t>(at.x);
      line.fromMiddle = {at.x - std::floor(at.x) - 0.5, at.y - std::floor(at.y) - 0.5};
      line.cosPsi = -seen.z / std::sqrt(l2);
      line.etendue_sr = z.tanPerPixelX * z.tanPerPixelY / (l2 * std::sqrt(l2)) * line.cosPsi;
      visit(line);
    }
}

}  // namespace pitviper
