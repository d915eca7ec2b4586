#include "sim/model/sun_shade.hpp"

namespace pitviper {

double SunShadeGrid::at(const glm::dvec3& point) const {
  const glm::dvec3 from = point - origin;
  const glm::dvec3 last(nodes - 1),
      p = glm::clamp(glm::dvec3(glm::dot(axis[0], from), glm::dot(axis[1], from), glm::dot(axis[2], from)), glm::dvec3(0.0), last);
  const glm::ivec3 c = glm::min(glm::ivec3(p), nodes - 2);
  const glm::dvec3 part = p - glm::dvec3(c);
  const std::size_t y = static_cast<std::size_t>(nodes.x), z = y * static_cast<std::size_t>(nodes.y);
  const float* v = depth.data() + (static_cast<std::size_t>(c.x) + y * static_cast<std::size_t>(c.y) + z * static_cast<std::size_t>(c.z));
  const auto row = [&](std::size_t n) { return v[n] + part.x * (v[n + 1] - v[n]); };
  const double low = row(0) + part.y * (row(y) - row(0)), high = row(z) + part.y * (row(y + z) - row(z));
  return low + part.z * (high - low);
}

}  // namespace pitviper
