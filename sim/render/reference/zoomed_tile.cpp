#include "sim/render/reference/zoomed_tile.hpp"

#include <cmath>

namespace pitviper {
namespace {

/// What a middle may be off by and still count as between the corners, relative to it: a thirtieth of the least error that can be asked for (0.05 %), and
/// an error of second order is greatest there.
constexpr double kLinear = 2e-5;

}  // namespace

const ZoomedTile::Seen& ZoomedTile::at(int x, int y) {
  auto& place = seen_[static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x - x_)];
  if (!place) place = see_(x, y);
  return *place;
}

bool ZoomedTile::isLinear(int x0, int y0, int x1, int y1) {
  const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
  const Seen &a = at(x0, y0), &b = at(x1, y0), &c = at(x0, y1), &d = at(x1, y1), &m = at(xm, ym);
  if (a.things != m.things || b.things != m.things || c.things != m.things || d.things != m.things) return false;
  if (m.things == 0) return true;
  const double u = static_cast<double>(xm - x0) / (x1 - x0), v = static_cast<double>(ym - y0) / (y1 - y0);
  for (std::size_t s = 0; s < m.slots.size(); ++s) {
    const double between = (1 - v) * ((1 - u) * a.slots[s] + u * b.slots[s]) + v * ((1 - u) * c.slots[s] + u * d.slots[s]);
    if (std::abs(between - m.slots[s]) > kLinear * std::abs(m.slots[s])) return false;
  }
  return true;
}

void ZoomedTile::part(int x0, int y0, int x1, int y1) {
  if (x1 - x0 < 2 && y1 - y0 < 2) {
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) at(x, y);
    return;
  }
  if (x1 - x0 >= 2 && y1 - y0 >= 2 && isLinear(x0, y0, x1, y1)) {
    const Seen a = at(x0, y0), b = at(x1, y0), c = at(x0, y1), d = at(x1, y1);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        auto& place = seen_[static_cast<std::size_t>(y - y_) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x - x_)];
        if (place) continue;
        place = Seen{std::vector<double>(a.slots.size()), a.things};
        const double u = static_cast<double>(x - x0) / (x1 - x0), v = static_cast<double>(y - y0) / (y1 - y0);
        for (std::size_t s = 0; s < a.slots.size(); ++s)
          place->slots[s] = (1 - v) * ((1 - u) * a.slots[s] + u * b.slots[s]) + v * ((1 - u) * c.slots[s] + u * d.slots[s]);
      }
    return;
  }
  const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
  for (const auto& [ya, yb] : {std::pair{y0, ym}, {ym, y1}})
    for (const auto& [xa, xb] : {std::pair{x0, xm}, {xm, x1}})
      if ((xb > xa || x1 == x0) && (yb > ya || y1 == y0)) part(xa, ya, xb, yb);
}

void ZoomedTile::fill(int x, int y, int width, int height, const std::function<void(int, int, const std::vector<double>&)>& put) {
  x_ = x, y_ = y, width_ = width;
  seen_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), {});
  part(x, y, x + width - 1, y + height - 1);
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i)
      if (const Seen& s = at(i, j); s.things != 0) put(i, j, s.slots);
}

}  // namespace pitviper
