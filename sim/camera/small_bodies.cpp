#include "sim/camera/small_bodies.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/camera/beside_bodies.hpp"
#include "sim/camera/wanted_lines.hpp"

namespace pitviper {
namespace {

/// All sheets, each told with what a pass drew of it: those of bodies by themselves as tiles of few pictures where the pass can.
void drawSheets(const Sheets& sheets, LineDrawer& drawer, const WorldState& state, const std::vector<char>& present, const std::vector<char>* only, bool fields,
                const std::function<void(std::size_t, const RawImage&, const std::vector<char>*)>& take) {
  std::map<int, std::vector<std::size_t>> tiles;  // by size
  for (std::size_t i = 0; i < sheets.all().size(); ++i) {
    const Sheet& sheet = sheets.all()[i];
    const auto mayCount = sheets.mayCount(sheet, only);
    if (mayCount && std::find(mayCount->begin(), mayCount->end(), 1) == mayCount->end()) continue;
    if (sheet.view.onlyEntity >= 0 && !mayCount && drawer.drawsTiles()) {
      tiles[sheet.view.width].push_back(i);
      continue;
    }
    View view = sheet.view;
    view.wanted = mayCount;
    if (view.onlyEntity < 0) {
      take(i, drawWanted(drawer, view, state, present, fields), mayCount.get());
      continue;
    }
    drawer.draw(view, state, present);
    drawer.startReadback(true);
    take(i, drawer.finishReadback(), mayCount.get());
  }
  for (const auto& [size, numbers] : tiles) {
    std::vector<View> views;
    for (std::size_t i : numbers) views.push_back(sheets.all()[i].view);
    drawer.drawTiles(views, state, present, [&](std::size_t k, const RawImage& drawn) { take(numbers[k], drawn, nullptr); });
  }
}

/// Truth of a pixel is that of its middle, whatever it sees there.
void putMiddles(Subpixels& image, const WorldState& state, const std::vector<char>& small, const TruthAt& truthAt, const FineSubpixels& fine) {
  const auto width = static_cast<std::size_t>(image.view().width);
  for (const auto& [p, f] : fine) {
    const int x = static_cast<int>(p % width), y = static_cast<int>(p / width);
    if (!image.isMiddle(x, y)) continue;
    const TruthPixel truth = truthAt(state, {x + 0.5, y + 0.5});
    if (truth.entity > 0.0f && small[static_cast<std::size_t>(truth.entity) - 1]) image.setTruth(p, truth);
  }
}

}  // namespace

std::vector<char> findSmallBodies(const Simulation& sim, const WorldState& state, const View& v, double limit) {
  std::vector<char> small(sim.entities.size(), 0);
  for (size_t e = 0; e < sim.entities.size(); ++e) small[e] = state.isThere(e) && extentOf(ballOf(sim, state, static_cast<int>(e)), v) < limit;
  return small;
}

glm::ivec4 smallBodiesIn(const Simulation& sim, const WorldState& state, const View& v, const std::vector<char>& small, const std::vector<char>& present,
                         const std::vector<Ball>& parts) {
  // Half the diagonal of the square picture of the ball that zoomedView() makes, by the ball: 1.02 x 16 / 15.38 / sqrt(2) where it has fewest lines, its
  // middle shifted; and two subpixels.
  constexpr double kHalf = 0.8, kRoom = 2.0;
  std::vector<Ball> balls = parts;
  for (size_t e = 0; e < small.size(); ++e)
    if (small[e] && present[e]) balls.push_back(ballOf(sim, state, static_cast<int>(e)));
  glm::dvec2 low(INFINITY), high(-INFINITY);
  for (const Ball& ball : balls) {
    const double extent = extentOf(ball, v);
    if (!mayShow(v, ball.centre, ball.radius_m) || !std::isfinite(extent)) continue;
    const glm::dvec2 at = filmPosition(v, glm::transpose(v.localFromCamera) * (ball.centre - v.position));
    // Off the axis a ball's picture is longer.
    const glm::dvec2 off((at.x - v.axisX) * v.tanPerPixelX, (at.y - v.axisY) * v.tanPerPixelY);
    const double reach = kHalf * extent * (1.0 + glm::dot(off, off)) + kRoom;
    low = glm::min(low, at - reach), high = glm::max(high, at + reach);
  }
  const glm::ivec2 size(v.width, v.height);
  if (!(low.x < high.x) || high.x <= 0.0 || high.y <= 0.0 || low.x >= size.x || low.y >= size.y) return glm::ivec4(0);
  const glm::ivec2 first = glm::clamp(glm::ivec2(glm::floor(low)), glm::ivec2(0), size - 1),
                   last = glm::clamp(glm::ivec2(glm::ceil(high)), glm::ivec2(1), size);
  return {first, last - first};
}

void addSmallBodies(Subpixels& image, LineDrawer& drawer, const Simulation& sim, const WorldState& state, const std::vector<char>& small,
                    const std::vector<char>& present, const std::vector<int>& lines, const std::vector<Ball>& parts, const std::vector<char>* wanted,
                    const TruthAt& truthAt) {
  const Sheets sheets(sim, state, image.view(), small, present, lines, parts);
  if (sheets.all().empty()) return;
  BesideBodies beside(sim, state, image.view());
  std::vector<SheetShares> shares(sheets.all().size());
  drawSheets(sheets, drawer, state, present, wanted, beside.cells() != nullptr, [&](std::size_t i, const RawImage& drawn, const std::vector<char>* mayCount) {
    shares[i] = sharesOf(image, sheets, sheets.all()[i], drawn, mayCount, beside.cells());
  });
  FineSubpixels fine;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    gather(image, sheets.all()[i], shares[i], fine);
    if (!sheets.all()[i].bodies.empty()) beside.touch(shares[i]);
  }
  std::vector<char> without = present;
  for (std::size_t e = 0; e < without.size(); ++e) without[e] = present[e] && !small[e];
  beside.draw(image, drawer, state, without, fine);
  put(image, fine);
  if (truthAt) putMiddles(image, state, small, truthAt, fine);
}

}  // namespace pitviper
