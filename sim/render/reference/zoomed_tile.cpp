#include "sim/render/reference/zoomed_tile.hpp"

#include <cmath>

namespace pitviper {
const std::vector<double>& ZoomedTile::at(int x, int y) {
  auto& place = seen_[index(x, y)];
  if (!place) place = slotsAt_(x, y);
  return *place;
}

bool ZoomedTile::seesOne(int x0, int y0, int x1, int y1) const {
  const std::size_t first = things_[index(x0, y0)];
  for (int y = y0; y <= y1; ++y)
    for (int x = x0; x <= x1; ++x)
      if (things_[index(x, y)] != first) return false;
  return true;
}

bool ZoomedTile::isLinear(int x0, int y0, int x1, int y1) {
  const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
  const auto &a = at(x0, y0), &b = at(x1, y0), &c = at(x0, y1), &d = at(x1, y1), &m = at(xm, ym);
  const double u = static_cast<double>(xm - x0) / (x1 - x0), v = static_cast<double>(ym - y0) / (y1 - y0);
  for (std::size_t s = 0; s < m.size(); ++s) {
    const double between = (1 - v) * ((1 - u) * a[s] + u * b[s]) + v * ((1 - u) * c[s] + u * d[s]);
    if (std::abs(between - m[s]) > linear_ * std::abs(m[s])) return false;
  }
  return true;
}

void ZoomedTile::part(int x0, int y0, int x1, int y1) {
  if (x1 - x0 >= 2 && y1 - y0 >= 2) {
    const bool one = seesOne(x0, y0, x1, y1);
    if (one && things_[index(x0, y0)] == 0) return;
    if (one && isLinear(x0, y0, x1, y1)) {
      const auto a = at(x0, y0), b = at(x1, y0), c = at(x0, y1), d = at(x1, y1);
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
          auto& place = seen_[index(x, y)];
          if (place) continue;
          place.emplace(a.size());
          const double u = static_cast<double>(x - x0) / (x1 - x0), v = static_cast<double>(y - y0) / (y1 - y0);
          for (std::size_t s = 0; s < a.size(); ++s) (*place)[s] = (1 - v) * ((1 - u) * a[s] + u * b[s]) + v * ((1 - u) * c[s] + u * d[s]);
        }
      return;
    }
  }
  if (x1 - x0 < 2 && y1 - y0 < 2) return;  // what is left is worked out as it is asked for
  const int xm = (x0 + x1) / 2, ym = (y0 + y1) / 2;
  for (const auto& [ya, yb] : {std::pair{y0, ym}, {ym, y1}})
    for (const auto& [xa, xb] : {std::pair{x0, xm}, {xm, x1}})
      if ((xb > xa || x1 == x0) && (yb > ya || y1 == y0)) part(xa, ya, xb, yb);
}

void ZoomedTile::fill(int x, int y, int width, int height, const std::function<void(int, int, const std::vector<double>&)>& put) {
  x_ = x, y_ = y, width_ = width;
  things_.clear();
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i) things_.push_back(thingsAt_(i, j));
  seen_.assign(things_.size(), {});
  part(x, y, x + width - 1, y + height - 1);
  for (int j = y; j < y + height; ++j)
    for (int i = x; i < x + width; ++i)
      if (things_[index(i, j)] != 0) put(i, j, at(i, j));
}

}  // namespace pitviper
