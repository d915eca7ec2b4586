#include "sim/scene/mesh_units.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Longer than the longest ship built (458 m): hardly a body in metres. Shorter than 2 cm: hardly anything that a scene is made of.
constexpr double kLongest_m = 500.0, kShortest_m = 0.02;
/// From here on a body in metres is large, and the same numbers as feet are a usual aircraft or vehicle (12 m and more).
constexpr double kFeetFrom_m = 40.0;
constexpr double kFoot_m = 0.3048;

std::string metres(double v) { return print(v < 1e3 ? "%.3g m" : "%.0f m", v); }

bool isGltf(const std::string& file) {
  std::string e = std::filesystem::path(file).extension().string();
  for (char& c : e) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return e == ".gltf" || e == ".glb";
}

}  // namespace

std::string doubtAboutUnit(const glm::dvec3& size_m, double metresPerUnit, const std::string& file) {
  const double longest = std::max({size_m.x, size_m.y, size_m.z}), units = longest / metresPerUnit;
  const bool inMetres = std::abs(metresPerUnit - 1.0) < 1e-9;
  if (isGltf(file) && !inMetres)
    return metres(longest) + " long with the unit given; glTF files are in metres by their standard, it would then be " + metres(units);
  if (longest > kLongest_m)
    return metres(longest) + " long; it would be " + metres(units * 1e-3) + " if the file is in millimetres, " + metres(units * 1e-2) + " in centimetres, " +
           metres(units * kFoot_m) + " in feet";
  if (longest < kShortest_m) return metres(longest) + " long; it would be " + metres(units) + " if the file is in metres";
  if (inMetres && longest > kFeetFrom_m) return metres(longest) + " long; it would be " + metres(units * kFoot_m) + " if the file is in feet";
  return "";
}

}  // namespace pitviper
