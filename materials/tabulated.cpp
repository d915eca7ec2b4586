// A BRDF table as scenarios write it.
#include <algorithm>
#include <cmath>

#include "materials/angle_tables.hpp"
#include "materials/brdf_table.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Two angles that both depend on the light: up to 1.4 s to integrate over the hemisphere. Others take 3 ms and, with the most entries,
/// half a second.
constexpr std::size_t kMostAnglePairs = 65536;
constexpr double kMostTables = 64.0, kMostTableWavelengths = 1024.0;
constexpr AngleTableKind kBrdf{"a BRDF", "at least 0 per steradian", INFINITY};

std::shared_ptr<ReflectionComponent> readTable(const Record& r) {
  BrdfTable t;
  t.wavelength_um = readTableWavelengths(r.value("wavelength"), kBrdf);
  std::vector<size_t> extents{t.wavelength_um.size()};
  if (r.given("angles")) {
    size_t k = 0;
    for (const Value& a : r.value("angles").items) {
      t.axes[k] = readAngleAxis(a);
      extents.insert(extents.begin(), static_cast<size_t>(t.axes[k++].count));
    }
    if (k == 2 && t.axes[0].angle == t.axes[1].angle) throw UserError(r.where("angles"), "both axes are the same angle", "two different angles", "change one");
  }
  const auto ofLight = [](const AngleAxis& a) { return a.angle != Angle::None && a.angle != Angle::View; };
  const auto pairs = static_cast<std::size_t>(t.axes[0].count) * static_cast<std::size_t>(t.axes[1].count);
  if (ofLight(t.axes[0]) && ofLight(t.axes[1]) && pairs > kMostAnglePairs)
    throw UserError(r.where("angles"), "a BRDF table over " + std::to_string(pairs) + " pairs of angles", "at most " + std::to_string(kMostAnglePairs),
                    "thin it out");
  t.values = readTableValues(r, kBrdf, extents);
  return makeTabulated(std::move(t));
}

}  // namespace

ReflectionModel tabulatedModel() {
  return {"table",
          "A BRDF by wavelength and up to two angles, linear between.",
          {required(list("wavelength", "rising wavelengths", 1, 1024)), list("angles", "up to two axes", 0, 2),
           required(list("values", "BRDF [1/sr], nested as values[angle 2][angle 1][wavelength]", 1, 4096))},
          [](const ComponentRecord& r) { return readTable(r.record); },
          [](const Record& r) { return std::max(1.0 / kMostTables, static_cast<double>(r.value("wavelength").items.size()) / kMostTableWavelengths); }};
}

}  // namespace pitviper
