// Spectra, air and surfaces as functions over arrays, and charts.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>

#include "scenarios/commands/charts.hpp"
#include "scenarios/python/bindings.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "scenarios/session/air_physics.hpp"
#include "scenarios/session/band_physics.hpp"
#include "scenarios/session/open_scene.hpp"
#include "scenarios/session/surface_physics.hpp"

namespace py = pybind11;

namespace pitviper {
namespace {

/// Of any shape, read in C order; numbers of other kinds are taken over.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Place = std::array<double, 3>;

std::span<const double> spanOf(const Numbers& n) { return {n.data(), static_cast<std::size_t>(n.size())}; }

py::array_t<double> arrayOf(const std::vector<double>& values, const std::vector<py::ssize_t>& shape) {
  py::array_t<double> result(shape);
  std::copy(values.begin(), values.end(), result.mutable_data());
  return result;
}

std::vector<py::ssize_t> shapeOf(const Numbers& n) { return {n.shape(), n.shape() + n.ndim()}; }

/// (shape of the first, shape of the second)
std::vector<py::ssize_t> outer(const Numbers& a, const Numbers& b) {
  std::vector<py::ssize_t> shape = shapeOf(a);
  for (const py::ssize_t n : shapeOf(b)) shape.push_back(n);
  return shape;
}

LightUnit unitOf(const std::string& word) {
  if (word == "W") return LightUnit::Watts;
  if (word == "photon/s") return LightUnit::Photons;
  throw UserError({"unit", 0, 0, -1}, "there is no unit of light '" + word + "'", "'W' or 'photon/s'", "choose one");
}

glm::dvec3 vectorOf(const Place& p) { return {p[0], p[1], p[2]}; }

/// A band (low, high) or a table (wavelengths, values).
struct Band {
  Responsivity responsivity;
};
Band bandOf(const py::object& band) {
  const auto two = py::cast<py::sequence>(band);
  if (two.size() != 2) throw UserError({"band", 0, 0, -1}, "no band", "(low, high) in um, or (wavelengths, values)", "write (3.7, 4.8)");
  const Numbers a = Numbers::ensure(two[0]), b = Numbers::ensure(two[1]);
  if (!a || !b) {
    PyErr_Clear();
    throw UserError({"band", 0, 0, -1}, "what is no numbers", "(low, high) in um, or (wavelengths, values)", "write (3.7, 4.8)");
  }
  if (a.ndim() == 0 && b.ndim() == 0) return {Responsivity(*a.data(), *b.data())};
  return {Responsivity(spanOf(a), spanOf(b))};
}

/// Of angles (their shape) and wavelengths.
template <class Of>
py::array_t<double> byAngle(const SurfacePhysics& s, const Numbers& wavelength_um, const Numbers& angle_rad, Of of) {
  return arrayOf((s.*of)(spanOf(wavelength_um), spanOf(angle_rad)), outer(angle_rad, wavelength_um));
}

void bindBands(py::module_& m) {
  m.def("planck", [](const Numbers& wavelength_um, const Numbers& temperature_K, const std::string& unit) {
    return arrayOf(planckRadiance(spanOf(wavelength_um), spanOf(temperature_K), unitOf(unit)), outer(temperature_K, wavelength_um));
  });
  m.def("planck_slope", [](const Numbers& wavelength_um, const Numbers& temperature_K, const std::string& unit) {
    return arrayOf(planckSlope(spanOf(wavelength_um), spanOf(temperature_K), unitOf(unit)), outer(temperature_K, wavelength_um));
  });
  m.def("band_radiance", [](const Numbers& temperature_K, const py::object& band, const std::string& unit) {
    return arrayOf(bandRadiance(spanOf(temperature_K), bandOf(band).responsivity, unitOf(unit)), shapeOf(temperature_K));
  });
  m.def("band_radiance_slope", [](const Numbers& temperature_K, const py::object& band, const std::string& unit) {
    return arrayOf(bandRadianceSlope(spanOf(temperature_K), bandOf(band).responsivity, unitOf(unit)), shapeOf(temperature_K));
  });
  m.def("apparent_temperature", [](const Numbers& radiance, const py::object& band, const std::string& unit) {
    return arrayOf(apparentTemperature(spanOf(radiance), bandOf(band).responsivity, unitOf(unit)), shapeOf(radiance));
  });
  m.def("band_integral", [](const Numbers& wavelength_um, const Numbers& values, const py::object& band) {
    if (band.is_none()) return bandIntegral(spanOf(wavelength_um), spanOf(values));
    return bandIntegral(spanOf(wavelength_um), spanOf(values), bandOf(band).responsivity);
  });
  m.def("band_mean", [](const Numbers& wavelength_um, const Numbers& values, const py::object& band) {
    return bandMean(spanOf(wavelength_um), spanOf(values), bandOf(band).responsivity);
  });
}

void bindAir(py::module_& m) {
  m.def("air_path", [](const OpenScene& scene, const Place& from, const Place& to, const Numbers& wavelength_um) {
    const auto sim = scene.simulation();
    AirPath path;
    {
      const py::gil_scoped_release others;
      path = pathThrough(*sim, vectorOf(from), vectorOf(to), spanOf(wavelength_um));
    }
    py::dict all;
    all["range_m"] = path.range_m;
    all["optical_depth"] = arrayOf(path.opticalDepth, shapeOf(wavelength_um));
    all["transmittance"] = arrayOf(path.transmittance, shapeOf(wavelength_um));
    all["path_radiance"] = arrayOf(path.pathRadiance, shapeOf(wavelength_um));
    return all;
  });
  m.def("sky_radiance", [](const OpenScene& scene, const Place& from, const Place& direction, const Numbers& wavelength_um) {
    const auto sim = scene.simulation();
    std::vector<double> values;
    {
      const py::gil_scoped_release others;
      values = skyRadiance(*sim, vectorOf(from), vectorOf(direction), spanOf(wavelength_um));
    }
    return arrayOf(values, shapeOf(wavelength_um));
  });
  m.def("band_transmittance", [](const OpenScene& scene, const Place& from, const Place& to, const py::object& band, double source_K) {
    const auto sim = scene.simulation();
    const Band b = bandOf(band);
    const py::gil_scoped_release others;
    return bandTransmittance(*sim, vectorOf(from), vectorOf(to), b.responsivity, source_K);
  });
}

void bindSurfaces(py::module_& m) {
  py::class_<SurfacePhysics>(m, "Surface")
      .def_property_readonly("valid_um", [](const SurfacePhysics& s) { return std::make_pair(s.low_um(), s.high_um()); })
      .def_property_readonly("states",
                             [](const SurfacePhysics& s) -> py::object {
                               const auto states = s.states();
                               if (!states) return py::none();
                               py::dict d;
                               d["temperature"] = states->isTemperature, d["low"] = states->low, d["high"] = states->high;
                               return d;
                             })
      .def("brdf",
           [](const SurfacePhysics& s, const Numbers& wavelength_um, const Place& light, const std::vector<Place>& views) {
             std::vector<glm::dvec3> directions;
             for (const Place& v : views) directions.push_back(vectorOf(v));
             return arrayOf(s.brdf(spanOf(wavelength_um), vectorOf(light), directions),
                            {static_cast<py::ssize_t>(views.size()), static_cast<py::ssize_t>(wavelength_um.size())});
           })
      .def("reflectance",
           [](const SurfacePhysics& s, const Numbers& w, const Numbers& angle_rad) { return byAngle(s, w, angle_rad, &SurfacePhysics::reflectance); })
      .def("emissivity",
           [](const SurfacePhysics& s, const Numbers& w, const Numbers& angle_rad) { return byAngle(s, w, angle_rad, &SurfacePhysics::emissivity); })
      .def("transmittance",
           [](const SurfacePhysics& s, const Numbers& w, const Numbers& angle_rad) { return byAngle(s, w, angle_rad, &SurfacePhysics::transmittance); });
  m.def("surface", [](const std::string& name, const std::optional<double>& state) { return SurfacePhysics(materialOf(name, findLibraries()), state); });
  m.def("surface_of", [](const OpenScene& scene, const std::string& name, const std::optional<double>& state) {
    return SurfacePhysics(materialOf(*scene.simulation(), name), state);
  });
}

/// Panels as dicts: title, x, y (labels), log_x, log_y, series [{name, x, y, dashed}].
void drawPanels(const py::list& panels, int columns, const std::filesystem::path& png) {
  std::vector<Chart> charts;
  for (const py::handle panel : panels) {
    Chart chart;
    chart.title = panel["title"].cast<std::string>();
    chart.xLabel = panel["x"].cast<std::string>();
    chart.yLabel = panel["y"].cast<std::string>();
    chart.logX = panel["log_x"].cast<bool>();
    chart.logY = panel["log_y"].cast<bool>();
    for (const py::handle series : panel["series"]) {
      Series s;
      s.name = series["name"].cast<std::string>();
      s.x = series["x"].cast<std::vector<double>>();
      s.y = series["y"].cast<std::vector<double>>();
      s.dashed = series["dashed"].cast<bool>();
      if (s.x.size() != s.y.size())
        throw UserError({"chart", 0, 0, -1}, "series '" + s.name + "' has " + std::to_string(s.x.size()) + " x and " + std::to_string(s.y.size()) + " y",
                        "as many of each", "give both");
      chart.series.push_back(std::move(s));
    }
    if (chart.series.empty()) throw UserError({"chart", 0, 0, -1}, "nothing to draw", "at least one curve", "give one");
    charts.push_back(std::move(chart));
  }
  if (charts.empty()) throw UserError({"chart", 0, 0, -1}, "nothing to draw", "at least one panel", "give a series");
  const py::gil_scoped_release others;
  drawCharts(charts, columns, png);
}

}  // namespace

void bindPhysics(py::module_& m) {
  bindBands(m);
  bindAir(m);
  bindSurfaces(m);
  m.def("charts", &drawPanels);
}

}  // namespace pitviper
