#include "sim/render/shadow/shadow_reach.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace pitviper {
namespace {

/// Bodies that touch overlap by the rounding of their poses and vertices: single precision of their size.
constexpr double kTouch = 1e-6;
/// Texels left free around the caster, so that bilinear neighbours at its outline are there.
constexpr double kBorder = 2.0;
/// Of the depth range, at either end: nothing of the caster is cut off by rounding.
constexpr double kDepthMargin = 1e-5;

std::array<glm::dvec3, 8> cornersOf(const ShadowBox& box) {
  std::array<glm::dvec3, 8> c;
  for (int k = 0; k < 8; ++k)
    c[static_cast<size_t>(k)] = {(k & 1) ? box.high.x : box.low.x, (k & 2) ? box.high.y : box.low.y, (k & 4) ? box.high.z : box.low.z};
  return c;
}

}  // namespace

bool mayShade(const ShadowBox& caster, const ShadowBox& receiver, const glm::dmat3& axes, const glm::dvec3& origin, const LightPlace& light) {
  const glm::dvec3 centre = origin + axes * receiver.centre(), between = centre - caster.centre();
  const double radius = receiver.radius_m(), both = radius + caster.radius_m();
  if (light.sun) {
    const double ahead = glm::dot(between, light.at);  // how much nearer to the sun the receiver is
    if (ahead > both || glm::length(between - ahead * light.at) > both) return false;
  } else {
    const glm::dvec3 line = centre - light.at;
    const double l2 = glm::dot(line, line), t = l2 > 0.0 ? std::clamp(glm::dot(caster.centre() - light.at, line) / l2, 0.0, 1.0) : 0.0;
    if (glm::length(light.at + t * line - caster.centre()) > both) return false;
  }
  const glm::dvec3 half = 0.5 * (receiver.high - receiver.low);
  for (int k = 0; k < 3; ++k) {
    const double reach = std::abs(axes[0][k]) * half.x + std::abs(axes[1][k]) * half.y + std::abs(axes[2][k]) * half.z, slack = kTouch * both;
    const double low = centre[k] - reach, high = centre[k] + reach;
    if (low >= caster.high[k] - slack && (light.sun ? light.at[k] >= 0.0 : light.at[k] >= caster.high[k])) return false;
    if (high <= caster.low[k] + slack && (light.sun ? light.at[k] <= 0.0 : light.at[k] <= caster.low[k])) return false;
  }
  return true;
}

std::optional<ShadowProjection> fitShadowMap(const ShadowBox& caster, const LightPlace& light, int texels) {
  const glm::dvec3 line = light.sun ? light.at : light.at - caster.centre();
  if (!light.sun && glm::length(line) * std::sqrt(0.75) < caster.radius_m() + light.radius_m) return {};
  const glm::dvec3 z = glm::normalize(line), helper = std::abs(z.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 x = glm::normalize(glm::cross(helper, z)), y = glm::cross(z, x);
  glm::dvec2 low(INFINITY), high(-INFINITY);
  double near = INFINITY, far = -INFINITY;
  for (const glm::dvec3& corner : cornersOf(caster)) {
    const glm::dvec3 p = light.sun ? corner : corner - light.at;
    const double depth = -glm::dot(p, z);
    const glm::dvec2 at = glm::dvec2(glm::dot(p, x), glm::dot(p, y)) / (light.sun ? 1.0 : depth);
    low = glm::min(low, at), high = glm::max(high, at);
    near = std::min(near, depth), far = std::max(far, depth);
  }
  const double thick = std::max(far - near, 1e-6 * (caster.radius_m() + std::abs(far)));
  near -= kDepthMargin * thick, far += kDepthMargin * thick;
  // A caster seen edge on still has a texel's width.
  const glm::dvec2 wide = glm::max(high - low, glm::dvec2(1e-6 * std::max(high.x - low.x, high.y - low.y) + 1e-30));
  const glm::dvec2 scale = (texels - 2.0 * kBorder) / wide, middle = 0.5 * (low + high);
  const double at = 0.5 * texels;
  ShadowProjection map;
  const glm::dvec3 shift = light.sun ? glm::dvec3(0.0) : light.at;
  auto row = [&](const glm::dvec3& n, double constant) { return glm::dvec4(n, constant - glm::dot(n, shift)); };
  const double texel = std::max(wide.x, wide.y) / (texels - 2.0 * kBorder) * (light.sun ? 1.0 : far);
  if (light.sun) {
    map.row[0] = row(scale.x * x, at - scale.x * middle.x);
    map.row[1] = row(scale.y * y, at - scale.y * middle.y);
    map.row[2] = row(-z / (far - near), -near / (far - near));
    map.row[3] = {0, 0, 0, 1};
  } else {
    // Depth is affine in 1 / w, so that planes stay planes: (1/near - 1/w) / (1/near - 1/far).
    const double range = 1.0 / near - 1.0 / far;
    map.row[0] = row(scale.x * x - (at - scale.x * middle.x) * z, 0.0);
    map.row[1] = row(scale.y * y - (at - scale.y * middle.y) * z, 0.0);
    map.row[2] = row(-z / (near * range), -1.0 / range);
    map.row[3] = row(-z, 0.0);
  }
  map.texelDepth = light.sun ? texel / (far - near) : texel * near / (far * (far - near));  // dD = dw / w2 / range at the far end
  return map;
}

}  // namespace pitviper
