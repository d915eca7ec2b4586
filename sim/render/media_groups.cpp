#include "sim/render/media_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace pitviper {
namespace {

glm::dvec3 corner(const LayerPiece& p, int k) {
  const glm::dvec3 body((k & 1) ? p.high.x : p.low.x, (k & 2) ? p.high.y : p.low.y, (k & 4) ? p.high.z : p.low.z);
  return p.origin + p.cameraFromBody * body;
}

/// Whether two turned boxes overlap by more than touching: no axis separates them. Source: separating axis theorem for convex bodies.
bool overlap(const LayerPiece& a, const LayerPiece& b) {
  constexpr double kTouching = 1e-3;  // of the size along the axis: boxes are drawn a little too large
  std::vector<glm::dvec3> axes;
  for (int i = 0; i < 3; ++i) axes.insert(axes.end(), {a.cameraFromBody[i], b.cameraFromBody[i]});
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) axes.push_back(glm::cross(a.cameraFromBody[i], b.cameraFromBody[j]));
  for (const glm::dvec3& axis : axes) {
    if (glm::dot(axis, axis) < 1e-12) continue;
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int side = 0; side < 2; ++side)
      for (int k = 0; k < 8; ++k) {
        const double at = glm::dot(axis, corner(side ? b : a, k));
        low[side] = std::min(low[side], at);
        high[side] = std::max(high[side], at);
      }
    const double slack = kTouching * std::min(high[0] - low[0], high[1] - low[1]);
    if (low[0] > high[1] - slack || low[1] > high[0] - slack) return false;
  }
  return true;
}

}  // namespace

void joinMedia(std::vector<LayerPiece>& pieces, std::vector<std::vector<std::uint32_t>>& groups) {
  groups.clear();
  std::vector<std::size_t> media;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (pieces[i].medium && pieces[i].form.kind != BodyForm::Kind::Mesh) media.push_back(i);
  std::vector<std::size_t> root(media.size());
  std::iota(root.begin(), root.end(), std::size_t{0});
  for (std::size_t i = 0; i < media.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (root[i] != root[j] && overlap(pieces[media[i]], pieces[media[j]]))
        std::replace(root.begin(), root.end(), std::max(root[i], root[j]), std::min(root[i], root[j]));
  std::vector<char> gone(pieces.size(), 0);
  for (std::size_t first = 0; first < media.size(); ++first) {
    std::vector<std::size_t> members;
    for (std::size_t i = 0; i < media.size(); ++i)
      if (root[i] == first) members.push_back(media[i]);
    if (members.size() < 2 || members.size() > static_cast<std::size_t>(kMostMembers)) continue;
    LayerPiece& whole = pieces[members.front()];
    const glm::dmat3 bodyFromCamera = glm::transpose(whole.cameraFromBody);
    glm::dvec3 low = whole.low, high = whole.high;
    std::vector<std::uint32_t> draws;
    for (std::size_t m : members) {
      draws.push_back(pieces[m].draw);
      gone[m] = m != members.front();
      for (int k = 0; k < 8; ++k) {
        const glm::dvec3 at = bodyFromCamera * (corner(pieces[m], k) - whole.origin);
        low = glm::min(low, at);
        high = glm::max(high, at);
      }
    }
    whole.low = low;
    whole.high = high;
    whole.form = {};  // in order of drawing it stands for its box
    whole.group = static_cast<int>(groups.size());
    groups.push_back(std::move(draws));
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (!gone[i]) pieces[kept++] = pieces[i];
  pieces.resize(kept);
}

}  // namespace pitviper
