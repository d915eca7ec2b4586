// Ambient light: a dome, the sky, what a list of elevations says, or a picture of all directions.
#include <algorithm>
#include <cmath>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "sim/model/environment_map.hpp"
#include "sim/radiance/sky.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// As of spectra: far below the end of a float, far above any light.
constexpr double kLargestRadiance = 1e30;

/// As fine as pictures of all directions are kept: 3 deg round the horizon, where rings lie closer than that.
DirectionGrid gridOfMap() {
  DirectionGrid grid;
  grid.above = grid.below = 31;
  grid.azimuths = 72;
  return grid;
}

}  // namespace

std::shared_ptr<const MixedSurroundings> Builder::gradientOf(const Record& ambient) const {
  DirectionGrid grid;
  grid.above = grid.below = 61;
  grid.azimuths = 1;
  std::vector<double> at_rad;
  std::vector<Spectrum> light;
  for (const Value& item : ambient.value("gradient").items) {
    const Record r(item, tables::gradientEntry());
    const double e = r.number("elevation");
    if (!at_rad.empty() && e < at_rad.back())
      throw UserError(r.where("elevation"), "elevations of a gradient that fall", "rising ones, two alike where it steps", "put them in order");
    if (at_rad.size() > 1 && e == at_rad[at_rad.size() - 2])
      throw UserError(r.where("elevation"), "three entries at one elevation", "two where it steps", "remove the one between");
    at_rad.push_back(e);
    light.push_back(blackOrGiven(r, "gradient entry"));
  }
  const auto shares = [&](double e, bool fromAbove) {
    std::vector<double> share(light.size(), 0.0);
    // A step counts to the side that it is looked at from.
    const auto next = static_cast<std::size_t>(
        (fromAbove ? std::upper_bound(at_rad.begin(), at_rad.end(), e) : std::lower_bound(at_rad.begin(), at_rad.end(), e)) - at_rad.begin());
    if (next == 0 || next == at_rad.size()) share[next == 0 ? 0 : next - 1] = 1.0;
    else share[next] = (e - at_rad[next - 1]) / (at_rad[next] - at_rad[next - 1]), share[next - 1] = 1.0 - share[next];
    return share;
  };
  std::vector<std::vector<double>> all;
  for (std::size_t g = 0; g < grid.size(); ++g) {
    const bool above = static_cast<int>(g) < grid.above;
    all.push_back(shares(grid.elevation_rad(static_cast<int>(g)), above));
  }
  return std::make_shared<MixedSurroundings>(grid, std::move(light), std::move(all));
}

std::shared_ptr<const MixedSurroundings> Builder::mapOf(const Record& ambient) const {
  const Record r(ambient.value("map"), tables::environmentMap());
  std::filesystem::path path = r.text("file");
  if (path.is_relative()) path = base_ / path;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored))
    throw UserError(r.where("file"), "cannot read the file '" + path.string() + "'", "an EXR", "check the name; it is relative to the scenario's folder");
  const ExrImage image = readExr(path);
  const MapLayout layout = r.text("layout") == "cube" ? MapLayout::Cube : MapLayout::LatitudeLongitude;
  if (layout == MapLayout::Cube && image.width != 6 * image.height)
    throw UserError(r.where("file"), "a cube map of " + std::to_string(image.width) + " x " + std::to_string(image.height) + " pixels",
                    "six square faces in a row", "put its faces side by side: ahead, right, behind, left, up, down");
  if (r.given("layers") == r.given("light"))
    throw UserError(r.where(), r.given("light") ? "an environment map with layers by wavelength and a main light" : "an environment map without a main light",
                    "'light' for a map in red, green and blue, or 'layers' with the wavelength of each", r.given("light") ? "remove one" : "add one of them");
  std::vector<const FloatLayer*> layers;
  std::vector<Spectrum> spectra;
  const auto radianceOf = [&](const FloatLayer& layer, std::ptrdiff_t at, double factor, const Location& where) {
    const float v = layer.pixels[static_cast<std::size_t>(at)];
    return UserError(where,
                     "layer '" + layer.name.substr(0, 60) + "' of " + path.string() + " holds " + briefNumber(factor * static_cast<double>(v)) + " at column " +
                         std::to_string(at % image.width) + ", row " + std::to_string(at / image.width) +
                         (factor == 1.0 ? "" : " with its 'scale' and under its light"),
                     "values from 0 to 1e30, of layers in W/(m2 sr um)", factor == 1.0 ? "mend the picture" : "lower 'scale' or 'light', or mend the picture");
  };
  const auto layerNamed = [&](const std::string& name, const Location& where) {
    const FloatLayer* layer = image.find(name);
    std::vector<std::string> names;
    for (const FloatLayer& l : image.layers) names.push_back(l.name);
    if (!layer) throw unknownWord(where, "the file has no layer", name, names);
    const auto wrong =
        std::find_if(layer->pixels.begin(), layer->pixels.end(), [](float v) { return !(v >= 0.0f && static_cast<double>(v) <= kLargestRadiance); });
    if (wrong != layer->pixels.end()) throw radianceOf(*layer, wrong - layer->pixels.begin(), 1.0, where);
    return layer;
  };
  if (r.given("light")) {
    for (const char* name : {"R", "G", "B"}) layers.push_back(layerNamed(name, r.where("file")));
    const Spectrum light = bounded(spectra_, r.value("light"), "W/(m2 sr um)", "light of an environment map", 0.0, INFINITY);
    const auto observer = [&](const char* name) {
      Value v = r.value("light");
      v.kind = Value::Kind::Scalar, v.text = name, v.items.clear();
      return spectra_.read(v, "", name, Outside::Zero);
    };
    try {
      for (const Spectrum& s : raisedPrimaries(light, observer("cie_x"), observer("cie_y"), observer("cie_z"))) spectra.push_back(s);
    } catch (const std::invalid_argument&) {
      throw UserError(r.where("light"), "a main light without colours", "light at all wavelengths from 0.4 to 0.7 um", "take daylight or a lamp");
    } catch (const OutsideSpectrum& e) {
      throw UserError(r.where("light"), std::string("the main light has no data that an eye needs: ") + e.what(), "a spectrum from 0.36 to 0.83 um",
                      "extend the table");
    }
  } else {
    std::vector<double> at_um;
    for (const Value& item : r.value("layers").items) {
      const Record layer(item, tables::environmentLayer());
      at_um.push_back(layer.number("wavelength"));
      if (at_um.size() > 1 && !(at_um.back() > at_um[at_um.size() - 2]))
        throw UserError(layer.where("wavelength"), "wavelengths of layers that do not rise", "rising ones", "put the layers in order");
      layers.push_back(layerNamed(layer.text("name"), layer.where("name")));
    }
    // Of each layer the hat that is 1 at its wavelength.
    for (std::size_t k = 0; k < at_um.size(); ++k) {
      Spectrum::Table hat;
      hat.name = "layers of an environment map";
      for (std::size_t j = 0; j < at_um.size(); ++j) hat.wavelength_um.push_back(at_um[j]), hat.value.push_back(j == k ? 1.0 : 0.0);
      spectra.push_back(Spectrum(std::move(hat)));
    }
  }
  const DirectionGrid grid = gridOfMap();
  auto share = layersOnGrid(grid, layers, image.width, image.height, layout, r.number("heading"));
  const double scale = r.number("scale");
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const double factor = scale * spectra[k].maximum(spectra[k].validLow(), spectra[k].validHigh());
    const auto most = std::max_element(layers[k]->pixels.begin(), layers[k]->pixels.end());
    if (!(factor * static_cast<double>(*most) <= kLargestRadiance))
      throw radianceOf(*layers[k], most - layers[k]->pixels.begin(), factor, r.where(r.given("light") ? "light" : "file"));
  }
  for (auto& row : share)
    for (double& v : row) v *= scale;
  return std::make_shared<MixedSurroundings>(grid, std::move(spectra), std::move(share));
}

void Builder::readAmbient(const Record& scenario) {
  if (!scenario.given("ambient")) return;
  const Record r(scenario.value("ambient"), tables::ambient());
  std::vector<const char*> given;
  for (const char* key : {"temperature", "radiance", "from", "gradient", "map"})
    if (r.given(key)) given.push_back(key);
  if (given.size() != 1)
    throw UserError(given.empty() ? r.where() : r.where(given[1]),
                    given.empty() ? "ambient light of nothing" : std::string("ambient light from '") + given[0] + "' and from '" + given[1] + "'",
                    "one of 'temperature', 'radiance', 'from', 'gradient', 'map'",
                    given.empty() ? "add 'temperature: 280 K'" : std::string("remove '") + given[1] + "'");
  if (r.given("gradient") || r.given("map")) {
    const auto around = r.given("gradient") ? gradientOf(r) : mapOf(r);
    simulation_.ambient = around->mean();
    simulation_.surroundings = around;
    return;
  }
  if (!r.given("from")) {
    simulation_.ambient = blackOrGiven(r, "ambient");
    return;
  }
  if (!simulation_.air->traits().liesOnGround)
    throw UserError(r.where("from"), "ambient light from the sky needs layered air", "a library air or a table under 'atmosphere'",
                    "add 'atmosphere: hazy_us76', or give a temperature or radiance");
  try {
    const auto& ground = simulation_.materials[static_cast<size_t>(simulation_.ground->material)];
    const double ground_K = simulation_.ground->temperature_K, radius_m = simulation_.frame.earthRadius_m();
    simulation_.ambient = meanSky(simulation_.air, simulation_.sun, simulation_.background, ground, ground_K, 0.0, radius_m);
    simulation_.surroundings = skyAndGround(simulation_.air, simulation_.sun, simulation_.background, ground, ground_K, radius_m);
  } catch (const OutsideSpectrum& e) {
    throw UserError(r.where("from"), std::string("the sky needs the sun and the background wherever the air has data: ") + e.what(),
                    "spectra from 0.4 to 14.2 um", "extend the table, or declare 'outside: hold' or 'outside: zero' if that is true");
  }
}

}  // namespace pitviper
