#include "sim/camera/fine_subpixels.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// True where a subpixel lies wholly inside the zoomed picture: its samples then make up the whole of it.
bool isInside(const View& main, const View& zoomed, const glm::dmat3& zoomFromMain, int x, int y) {
  for (int corner = 0; corner < 4; ++corner) {
    const glm::dvec3 p = zoomFromMain * main.ray(x + (corner & 1), y + (corner >> 1));
    if (p.z >= 0.0) return false;
    const glm::dvec2 at = filmPosition(zoomed, p);
    if (at.x < 0.0 || at.y < 0.0 || at.x > zoomed.width || at.y > zoomed.height) return false;
  }
  return true;
}

/// What a subpixel's small bodies send beyond what the image has there, as points that have its middle and its spread.
void putPoints(Subpixels& image, size_t subpixel, const FineSubpixel& f) {
  const auto width = static_cast<size_t>(image.view().width);
  const glm::dvec2 corner(static_cast<double>(subpixel % width), static_cast<double>(subpixel / width));
  const Place whole = placeOf(f.covered_sr, f.placed).value_or(Place{});
  for (size_t s = 0; s < f.sum.size(); ++s) {
    const double behind = f.covered_sr > 0.0 ? f.under[s] / f.covered_sr : 0.0, flux = f.sum[s] - f.under[s];
    if (flux == 0.0) continue;
    Moments m = f.moments[s];
    for (size_t k = 0; k < m.size(); ++k) m[k] -= behind * f.placed[k];
    const Place p = placeOf(flux, m).value_or(whole);
    const glm::dvec2 at = corner + 0.5 + p.middle;
    const std::vector<glm::dvec2> steps = pointsOf(p);
    for (const glm::dvec2& step : steps) image.addPoint(at + step, subpixel, s, flux / static_cast<double>(steps.size()));
  }
}

}  // namespace

SheetShares sharesOf(const Subpixels& image, const Sheets& sheets, const Sheet& sheet, const RawImage& drawn, const std::vector<char>* mayCount,
                     CoveredCells* cells) {
  SheetShares shares;
  const View& v = image.view();
  const auto slots = image.slotCount(), width = static_cast<std::size_t>(v.width);
  SheetShare* last = nullptr;
  std::size_t lastOf = 0;
  eachLine(v, sheet.view, [&](const SheetLine& line) {
    if (!last || line.subpixel != lastOf) last = &shares[line.subpixel], lastOf = line.subpixel;  // neighbours mostly fall into the same
    SheetShare& share = *last;
    share.looked_sr += line.etendue_sr;
    if ((mayCount && !(*mayCount)[line.number]) || !sheets.counts(sheet, line.place, line.subpixel, drawn.entity[line.number])) return;
    share.covered_sr += line.etendue_sr;
    share.sum.resize(slots, 0.0);
    if (image.keepsPoints()) share.moments.resize(slots);
    for (std::size_t s = 0; s < slots; ++s) {
      const double sent = line.etendue_sr * static_cast<double>(drawn.groups[s / 4][4 * line.number + s % 4]);
      share.sum[s] += sent;
      if (image.keepsPoints()) addMoments(share.moments[s], line.fromMiddle, sent);
    }
    if (image.keepsPoints()) addMoments(share.placed, line.fromMiddle, line.etendue_sr);
    if (cells) {
      const double subpixel_sr = v.tanPerPixelX * v.tanPerPixelY * std::pow(line.cosPsi, 4);
      cells->add(glm::dvec2(line.subpixel % width, line.subpixel / width) + 0.5 + line.fromMiddle, line.etendue_sr / subpixel_sr);
    }
  });
  return shares;
}

void gather(const Subpixels& image, const Sheet& sheet, const SheetShares& shares, FineSubpixels& fine) {
  const View& v = image.view();
  const glm::dmat3 sheetFromFilm = glm::transpose(sheet.view.localFromCamera) * v.localFromCamera;
  for (const auto& [p, share] : shares) {
    if (share.covered_sr <= 0.0) continue;
    const int x = static_cast<int>(p % static_cast<std::size_t>(v.width)), y = static_cast<int>(p / static_cast<std::size_t>(v.width));
    const bool inside = isInside(v, sheet.view, sheetFromFilm, x, y);
    // What sees anything of a part lies wholly in its sheet; at the sheet's border others are cut.
    if (sheet.bodies.empty() && !inside) continue;
    FineSubpixel& f = fine[p];
    f.sum.resize(image.slotCount(), 0.0);
    f.under.resize(image.slotCount(), 0.0);
    f.moments.resize(share.moments.size());
    f.whole_sr = image.projectedSolidAngle_sr(x, y);
    // Lines fall to one side or the other of a subpixel's edge: all of them are all of it, and no more than finer sheets have left.
    const double all = inside ? f.whole_sr / share.looked_sr : 1.0;
    const double each = std::min(all, std::max(f.whole_sr - f.covered_sr, 0.0) / share.covered_sr);
    f.covered_sr += each * share.covered_sr;
    for (std::size_t s = 0; s < f.sum.size(); ++s) {
      f.sum[s] += each * share.sum[s];
      f.under[s] += each * share.covered_sr * image.slot(s, p);
    }
    for (std::size_t k = 0; k < f.placed.size(); ++k) {
      f.placed[k] += each * share.placed[k];
      for (std::size_t s = 0; s < share.moments.size(); ++s) f.moments[s][k] += each * share.moments[s][k];
    }
  }
}

void put(Subpixels& image, const FineSubpixels& fine) {
  // More are no point: on so many subpixels a picture is as good.
  constexpr size_t kMostPoints = 16;
  if (image.keepsPoints() && fine.size() <= kMostPoints) {
    for (const auto& [p, f] : fine) putPoints(image, p, f);
    return;
  }
  for (const auto& [p, f] : fine)
    for (size_t s = 0; s < f.sum.size(); ++s) image.add(s, p, (f.sum[s] - f.under[s]) / f.whole_sr);
}

}  // namespace pitviper
