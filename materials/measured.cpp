// BRDFs over three angles from files: tables over two angles at a few azimuths, which a lobe each shares out. Source: Duvenhage 2006, section 5.2 (tables of
// more than two angles as several).

#include "materials/measured_files.hpp"
#include "materials/models.hpp"
#include "materials/reflection.hpp"

namespace pitviper {
namespace {

constexpr double kMostMeasured = 8.0;

MeasuredGrid readFile(const ComponentRecord& r) {
  std::filesystem::path path = r.record.text("file");
  if (path.is_relative()) path = r.base / path;
  const Location& asked = r.record.where("file");
  if (path.extension() != ".binary") {
    if (r.record.given("bands"))
      throw UserError(r.record.where("bands"), "'bands' of a file that has wavelengths of its own", "it with a MERL .binary", "remove it");
    return readBrdfCsv(path, asked);
  }
  std::array<double, 3> bands_um{0.6114, 0.5491, 0.4642};
  if (r.record.given("bands"))
    for (std::size_t k = 0; k < 3; ++k) bands_um[k] = readNumber(r.record.value("bands").items[k], "um", "a band");
  if (!(bands_um[0] > bands_um[1] && bands_um[1] > bands_um[2] && bands_um[2] >= 0.1 && bands_um[0] <= 1000.0))
    throw UserError(r.record.where("bands"), "bands that do not fall from red to blue", "three wavelengths of red, green and blue",
                    "write [0.61 um, 0.55 um, 0.46 um]");
  return readMerl(path, bands_um, asked);
}

MadeReflection makeMeasured(const ComponentRecord& r) {
  MeasuredGrid grid = readFile(r);
  const MeasuredAngles kind = grid.kind;
  MeasuredBrdf brdf = measuredBrdf(std::move(grid), static_cast<int>(r.record.integer("azimuths")), r.record.where("file"));
  MadeReflection made;
  made.notes = std::move(brdf.notes);
  for (std::size_t k = 0; k < brdf.parts.size(); ++k) {
    made.within.all(brdf.parts[k].wavelength_um).all(brdf.parts[k].values);
    const Lobe lobe = azimuthLobe(brdf, kind, k);
    made.components.push_back(makeTabulated(std::move(brdf.parts[k]), std::move(brdf.albedos[k]), lobe,
                                            [kind, lobe](const glm::dvec3& l, const glm::dvec3& v) { return azimuthLobeAt(kind, lobe, l, v); }));
  }
  return made;
}

}  // namespace

ReflectionModel measuredModel() {
  return {
      "measured",
      "A BRDF of an isotropic surface over three angles from a file: MERL's .binary, or a CSV with the columns wavelength [um], azimuth [deg], brdf [1/sr] and "
      "incidence [deg], view [deg] or half [deg], difference [deg]. It is made alike both ways, and scaled so that no view returns more than it receives, by "
      "up to 10 %: `pitviper material` says by how much.",
      {required(text("file", "MERL's .binary or a .csv, relative to the file that names it")),
       withDefault(integer("azimuths", "at most so many azimuths have tables, linear between; fewer where they keep it to 0.3 % rms", 1, 13), "7"),
       list("bands",
            "of a MERL file: wavelengths that its red, green and blue stand for (without it those of the primaries of sRGB, 611.4, 549.1 and 464.2 nm)", 3, 3)},
      {},
      [](const Record&) { return 1.0 / kMostMeasured; },
      {},
      {},
      makeMeasured};
}

}  // namespace pitviper
