#pragma once
// Arrays on a regular grid, as a file of a flow solver's has them.
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pitviper {

/// Most nodes of an imported grid: 128 MB for each four arrays in single precision.
inline constexpr std::size_t kMostGridNodes = 8'000'000;

struct GridData {
  glm::ivec3 nodes{0};
  glm::dvec3 origin{0.0}, spacing{1.0};  ///< of the first node, and between nodes along each axis, in the file's units
  struct Array {
    std::string name;
    std::vector<float> values;  ///< x fastest, then y, then z
  };
  std::vector<Array> arrays;  ///< in the order asked for
  std::size_t count() const { return static_cast<std::size_t>(nodes.x) * static_cast<std::size_t>(nodes.y) * static_cast<std::size_t>(nodes.z); }
};

}  // namespace pitviper
