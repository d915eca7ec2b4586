// Scenes: what draws, and what is asked of it.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "scenarios/python/bindings.hpp"
#include "scenarios/session/open_scene.hpp"
#include "scenarios/session/scene_report.hpp"
#include "sim/parameters/table.hpp"
#include "sim/stream/json_value.hpp"

namespace py = pybind11;

namespace pitviper {
namespace {

/// As YAML tells numbers from words.
py::object scalarOf(const Value& value) {
  if (value.quoted) return py::str(value.text);
  if (value.text == "true" || value.text == "false") return py::bool_(value.text == "true");
  char* end = nullptr;
  const double number = std::strtod(value.text.c_str(), &end);
  if (value.text.empty() || *end != '\0') return py::str(value.text);
  if (value.text.find_first_not_of("+-0123456789") == std::string::npos)
    return py::reinterpret_steal<py::object>(PyLong_FromString(value.text.c_str(), nullptr, 10));
  if (value.text.find_first_of("0123456789") == std::string::npos || value.text.find_first_of("xX") != std::string::npos) return py::str(value.text);
  return py::float_(number);
}

py::object objectOf(const Value& value) {
  switch (value.kind) {
    case Value::Kind::Null:
      return py::none();
    case Value::Kind::Scalar:
      return scalarOf(value);
    case Value::Kind::List: {
      py::list all;
      for (const Value& item : value.items) all.append(objectOf(item));
      return all;
    }
    case Value::Kind::Map: {
      py::dict all;
      for (const auto& [key, item] : value.entries) all[py::str(key)] = objectOf(item);
      return all;
    }
  }
  return py::none();
}

/// Polls Python for signals, and tells whoever wants to know how far a plan is.
SceneProgress progressOf(const py::object& told) {
  return [&told](double share) {
    const py::gil_scoped_acquire python;
    // What a signal's handler or the function threw is Python's error from then on.
    if (PyErr_Occurred() || PyErr_CheckSignals() != 0) return true;
    return !told.is_none() && !py::reinterpret_steal<py::object>(PyObject_CallFunction(told.ptr(), "d", share));
  };
}

std::size_t cameraNamed(const Simulation& sim, const std::optional<std::string>& name) {
  if (sim.cameras.empty()) throw UserError({sim.file, 0, 0, -1}, "the scenario has no camera", "at least one under 'cameras:'", "add a camera");
  if (!name) return 0;
  std::vector<std::string> names;
  for (const Camera& c : sim.cameras) names.push_back(c.name);
  const auto at = std::find(names.begin(), names.end(), *name);
  if (at == names.end()) throw unknownWord({"camera", 0, 0, -1}, "there is no camera", *name, names);
  return static_cast<std::size_t>(at - names.begin());
}

void requireTime(const OpenScene& scene, double time_s) {
  const TimeAxis time = scene.simulation()->time;
  if (!std::isfinite(time_s)) throw UserError({"time", 0, 0, -1}, "a time that is no number", "seconds", "name a time of " + scene.source().file);
  if (!(std::abs((time_s - time.start_s) / time.step_s) < 1e9))
    throw UserError({"time", 0, 0, -1}, "a time of no frame that could be counted", "less than 1e9 frames from the scenario's first",
                    "name a time nearer to it");
}

/// With the interpreter's lock: what Python's own code threw meanwhile.
void throwPythons() {
  if (PyErr_Occurred()) throw py::error_already_set();
}

py::dict drawn(OpenScene& scene, const std::optional<std::string>& camera, double time_s, bool draft, bool audited, std::uint64_t noise,
               const py::object& progress) {
  requireTime(scene, time_s);
  const auto sim = scene.simulation();
  const DrawWish wish{cameraNamed(*sim, camera), time_s, draft, noise, audited};
  const SceneProgress tell = progressOf(progress);
  DrawnFrame d;
  {
    py::gil_scoped_release others;
    d = scene.draw(wish, tell);
  }
  throwPythons();
  py::dict result;
  result["frame"] = d.frame;
  result["draft"] = d.isDraft;
  result["outside_limits"] = d.isOutsideLimits;
  py::dict predicted;
  const Camera& c = sim->cameras[wish.camera];
  for (std::size_t o = 0; o < d.predicted.size() && o < c.outputs.size(); ++o) predicted[py::str(c.outputs[o].layer())] = d.predicted[o];
  result["predicted_error"] = predicted;
  if (d.audit.pixels > 0) {
    py::dict audit;
    audit["pixels"] = d.audit.pixels, audit["frames"] = d.audit.frames;
    audit["errors"] = d.audit.errors;
    audit["largest"] = d.audit.largest, audit["channel"] = d.audit.channel;
    audit["asked"] = d.audit.asked;
    audit["with_geometry"] = d.audit.whole;
    result["audit"] = audit;
  }
  return result;
}

py::dict worldOf(OpenScene& scene, double time_s) {
  requireTime(scene, time_s);
  const auto sim = scene.simulation();
  const WorldState w = scene.world(time_s);
  const auto triple = [](const glm::dvec3& v) { return py::make_tuple(v.x, v.y, v.z); };
  const auto turned = [](const glm::dquat& q) { return py::make_tuple(q.w, q.x, q.y, q.z); };
  py::dict entities, lights, cameras, all;
  for (std::size_t e = 0; e < sim->entities.size(); ++e) {
    const Pose pose = w.bodyPose(e);
    const glm::dvec3 velocity = w.velocities.count(static_cast<int>(e)) ? w.velocities.at(static_cast<int>(e)) : velocityOf(*sim, static_cast<int>(e), time_s);
    py::dict one;
    one["position_m"] = triple(pose.position), one["orientation_wxyz"] = turned(pose.orientation), one["velocity_m_s"] = triple(velocity);
    one["temperatures_K"] = w.temperatures_K[e];
    one["there"] = w.isThere(e);
    entities[py::str(sim->entities[e].name)] = one;
  }
  for (std::size_t l = 0; l < sim->lights.size(); ++l) {
    if (sim->lights[l].lamp >= 0) continue;
    py::dict one;
    one["position_m"] = triple(w.lights[l]), one["level"] = w.lightLevels[l];
    lights[py::str(sim->lights[l].name)] = one;
  }
  for (const Camera& c : sim->cameras) {
    const CameraState at = cameraAt(c, w);
    py::dict one;
    one["position_m"] = triple(at.pose.position), one["orientation_wxyz"] = turned(at.pose.orientation);
    one["focal_length_m"] = at.pinhole.focalLength_m, one["exposure_s"] = at.exposures_s.common;
    cameras[py::str(c.name)] = one;
  }
  all["entities"] = entities, all["lights"] = lights, all["cameras"] = cameras;
  return all;
}

py::list camerasOf(const OpenScene& scene) {
  py::list all;
  const auto sim = scene.simulation();
  for (const Camera& c : sim->cameras) {
    py::dict one, layers;
    for (const ChannelOutput& o : c.outputs) layers[py::str(o.layer())] = o.unit;
    one["name"] = c.name, one["width"] = c.pinhole.width, one["height"] = c.pinhole.height, one["layers"] = layers;
    one["focal_px"] = c.pinhole.focalLength_m / c.pinhole.pitchX_m;
    all.append(one);
  }
  return all;
}

py::dict termsAt(OpenScene& scene, const std::optional<std::string>& camera, double time_s, int column, int row) {
  requireTime(scene, time_s);
  const std::size_t number = cameraNamed(*scene.simulation(), camera);
  PixelParts parts;
  {
    py::gil_scoped_release others;
    parts = scene.parts(number, time_s, column, row);
  }
  py::dict all;
  for (std::size_t k = 0; k < parts.columns.size(); ++k) {
    py::dict column_of;
    column_of["unit"] = parts.columns[k].unit;
    column_of["all"] = parts.all[k];
    py::dict terms;
    for (const PixelParts::Row& r : parts.rows) terms[py::str(r.name)] = r.values[k];
    column_of["terms"] = terms;
    column_of["rest"] = parts.rest[k];
    const auto kelvin = apparentTemperature_K(parts.columns[k], parts.all[k]);
    column_of["apparent_temperature_K"] = kelvin ? py::object(py::float_(*kelvin)) : py::object(py::none());
    all[py::str(parts.columns[k].layer)] = column_of;
  }
  return all;
}

py::dict spectrumAt(OpenScene& scene, const std::optional<std::string>& camera, double time_s, int column, int row, double low_um, double high_um, int bins) {
  requireTime(scene, time_s);
  const std::size_t number = cameraNamed(*scene.simulation(), camera);
  PixelSpectrum s;
  {
    py::gil_scoped_release others;
    s = scene.spectrum(number, time_s, column, row, low_um, high_um, bins);
  }
  const auto array = [](const std::vector<double>& v) { return py::array_t<double>(static_cast<py::ssize_t>(v.size()), v.data()); };
  py::dict all, terms;
  all["edge_um"] = array(s.edge_um), all["wavelength_um"] = array(s.wavelength_um), all["all"] = array(s.all), all["rest"] = array(s.rest);
  for (const auto& curve : s.parts) terms[py::str(curve.name)] = array(curve.values);
  all["terms"] = terms;
  return all;
}

/// Other threads of Python run while what is made beside ends.
struct WithoutLock {
  void operator()(OpenScene* scene) const {
    const py::gil_scoped_release others;
    delete scene;
  }
};

}  // namespace

void bindScenes(py::module_& m) {
  py::class_<OpenScene, std::unique_ptr<OpenScene, WithoutLock>>(m, "Scene")
      .def(py::init([](const std::string& file, const std::optional<std::string>& text, const std::filesystem::path& base, const std::vector<std::string>& sets,
                       const std::vector<std::filesystem::path>& roots) {
        py::gil_scoped_release others;
        return std::unique_ptr<OpenScene, WithoutLock>(new OpenScene(SceneSource{file, text, base, sets, roots}));
      }))
      .def(
          "close", [](OpenScene& s) { s.close(); }, py::call_guard<py::gil_scoped_release>())
      .def_property_readonly("closed", &OpenScene::isClosed)
      .def_property_readonly("file", [](const OpenScene& s) { return s.source().file; })
      .def_property_readonly("sets", [](const OpenScene& s) { return s.source().sets; })
      .def_property_readonly("name", [](const OpenScene& s) { return s.simulation()->name; })
      .def_property_readonly("sha256", [](const OpenScene& s) { return s.simulation()->sha256; })
      .def("time", [](const OpenScene& s) { return std::make_tuple(s.simulation()->time.start_s, s.simulation()->time.step_s, s.simulation()->time.frames); })
      .def("cameras", &camerasOf)
      .def("change", &OpenScene::change, py::call_guard<py::gil_scoped_release>())
      .def(
          "set", [](OpenScene& s, const std::string& path, const std::string& yaml) { s.change(s.source().with(path, yaml).sets); },
          py::call_guard<py::gil_scoped_release>())
      .def("expect", &OpenScene::expect, py::call_guard<py::gil_scoped_release>())
      .def("get", [](const OpenScene& s, const std::string& path) { return objectOf(valueAt(s.expanded()->tree, path)); })
      .def("tree", [](const OpenScene& s) { return objectOf(s.expanded()->tree); })
      .def("command",
           [](OpenScene& s, const std::string& json, double time_s) {
             const Location where{"command", 0, 0, -1};
             requireTime(s, time_s);
             s.command(valueOf(nlohmann::ordered_json::parse(json), where), time_s);
           })
      .def("forget", &OpenScene::forgetCommands)
      .def("world", &worldOf)
      .def("draw", &drawn)
      .def("planned",
           [](OpenScene& s, const std::optional<std::string>& camera, double time_s) {
             requireTime(s, time_s);
             return s.isPlanned(cameraNamed(*s.simulation(), camera), time_s);
           })
      .def("plan",
           [](OpenScene& s, const std::optional<std::string>& camera, bool asJson, const py::object& progress) {
             const auto sim = s.simulation();
             const std::size_t number = cameraNamed(*sim, camera);
             const SceneProgress tell = progressOf(progress);
             std::string text;
             {
               const py::gil_scoped_release others;
               text = planText(*sim, sim->cameras[number], s.plan(number, tell), asJson);
             }
             throwPythons();
             return text;
           })
      .def(
          "check",
          [](const OpenScene& s) {
            const auto sim = s.simulation();
            return sceneText(*sim);
          },
          py::call_guard<py::gil_scoped_release>())
      .def("terms", &termsAt)
      .def("spectrum", &spectrumAt);
}

}  // namespace pitviper
