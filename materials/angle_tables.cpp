#include "materials/angle_tables.hpp"

#include "sim/parameters/spectrum_value.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// As many as one YAML file can hold.
constexpr std::size_t kMostTableValues = 400000;

Angle angleNamed(const std::string& word) {
  if (word == "incidence") return Angle::Incidence;
  if (word == "view") return Angle::View;
  if (word == "specular") return Angle::Specular;
  if (word == "half") return Angle::Half;
  return Angle::Difference;
}

/// values[angle 2][angle 1][wavelength], with a nesting level left out for each missing axis.
void flatten(const Value& v, const AngleTableKind& kind, const std::vector<size_t>& extents, size_t level, std::vector<double>& into) {
  if (level == extents.size()) {
    const double x = readNumber(v, "", "a value of " + aTable(kind));
    if (!(x >= 0.0 && x <= kind.most))
      throw UserError(v.where, std::string(kind.name) + " value is " + (x < 0.0 ? "negative" : "above 1"), kind.range, "correct the table");
    into.push_back(x);
    return;
  }
  if (v.kind != Value::Kind::List || v.items.size() != extents[level])
    throw UserError(v.where, "a level of " + aTable(kind) + " has " + std::to_string(v.kind == Value::Kind::List ? v.items.size() : 0) + " entries",
                    std::to_string(extents[level]) + ", as its axis says", "fill the hole or change 'count'");
  for (const Value& item : v.items) flatten(item, kind, extents, level + 1, into);
}

}  // namespace

std::vector<double> readTableWavelengths(const Value& list, const AngleTableKind& kind) {
  std::vector<double> all;
  for (const Value& w : list.items) {
    const double x = onAxis(readNumber(w, "um", "wavelength"));
    if (x < kShortestWavelength_um || x > kLongestWavelength_um || (!all.empty() && x <= all.back()))
      throw UserError(w.where, "the wavelengths of " + aTable(kind) + " do not rise or leave the spectral axis", "rising, within 0.1 to 1000 um", "sort them");
    all.push_back(x);
  }
  return all;
}

AngleAxis readAngleAxis(const Value& value) {
  const Record axis(value, angleAxisTable());
  return {angleNamed(axis.text("angle")), static_cast<int>(axis.integer("count")), axis.number("last")};
}

std::vector<double> readTableValues(const Record& r, const AngleTableKind& kind, const std::vector<size_t>& extents) {
  size_t total = 1;
  for (size_t e : extents) total *= e;
  if (total > kMostTableValues)
    throw UserError(r.where("values"), aTable(kind) + " of " + std::to_string(total) + " values", "at most " + std::to_string(kMostTableValues), "thin it out");
  std::vector<double> values;
  flatten(r.value("values"), kind, extents, 0, values);
  return values;
}

std::string aTable(const AngleTableKind& kind) { return std::string(kind.name) + " table"; }

const ParameterTable& angleAxisTable() {
  static const ParameterTable t{
      "angle axis",
      "Equally spaced angles from 0 of a BRDF table.",
      {required(choice("angle", {"incidence", "view", "specular", "half", "difference"},
                       "from the normal to the light or viewer; between viewer and mirrored light; of the half vector to normal or light")),
       required(integer("count", "entries", 2, 1024)), required(within(number("last", "rad", "angle of the last entry"), 1e-6, kPi))}};
  return t;
}

}  // namespace pitviper
