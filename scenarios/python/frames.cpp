// Frames: their layers are numpy arrays over the frame's own memory.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>

#include "scenarios/python/bindings.hpp"
#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/parameters/table.hpp"

namespace py = pybind11;

namespace pitviper {
namespace {

using FrameHolder = std::shared_ptr<Frame>;

/// (height, width), read-only; it keeps the frame.
py::array layerOf(const FrameHolder& frame, const std::string& name) {
  for (const FrameLayer& l : frame->layers) {
    if (l.name != name) continue;
    const py::capsule owner(new FrameHolder(frame), [](void* held) { delete static_cast<FrameHolder*>(held); });
    py::array_t<float> pixels({frame->height, frame->width}, l.pixels.data(), owner);
    pixels.attr("flags").attr("writeable") = false;
    return pixels;
  }
  throw py::key_error(name);
}

py::dict attributesOf(const Frame& frame) {
  py::dict all;
  for (const Attribute& a : frame.attributes) {
    // A list of numbers that a file holds as text.
    const auto numbers = std::holds_alternative<std::string>(a.value) ? numbersOf(a) : std::nullopt;
    if (numbers && numbers->size() > 1) all[py::str(a.name)] = *numbers;
    else std::visit([&](const auto& v) { all[py::str(a.name)] = py::cast(v); }, a.value);
  }
  return all;
}

py::list targetsOf(const Frame& frame) {
  py::list rows;
  for (const TargetRow& t : frame.targets) {
    py::dict row;
    row["name"] = t.name;
    row["kind"] = t.kind;
    row["column"] = t.column, row["row"] = t.row;
    row["box"] = py::make_tuple(t.left, t.top, t.right, t.bottom);
    row["range_m"] = t.range_m, row["range_rate_m_s"] = t.rangeRate_m_s;
    row["sight_rate_rad_s"] = py::make_tuple(t.sightRight_rad_s, t.sightUp_rad_s);
    row["visible"] = t.visible;
    py::dict channels;
    for (const TargetRow::Channel& c : t.channels) {
      py::dict channel;
      channel["unit"] = c.unit;
      channel["own"] = c.own, channel["total"] = c.total, channel["contrast"] = c.contrast;
      channel["snr"] = c.signalToNoise;
      channel["saturated"] = c.saturated < 0 ? py::object(py::none()) : py::object(py::int_(c.saturated));
      channels[py::str(c.channel)] = channel;
    }
    row["channels"] = channels;
    rows.append(row);
  }
  return rows;
}

void writeTo(const Frame& frame, const std::filesystem::path& file, const std::string& compression) {
  std::vector<std::string> endings;
  for (const FileFormat& f : fileFormats()) {
    endings.push_back(f.extension);
    if (file.extension() != f.extension && !(file.extension() == ".tiff" && f.name == "tiff")) continue;
    FileOptions options;
    if (compression == "zip") options.compression = ExrCompression::Zip;
    else if (compression != "none") throw unknownWord({"save", 0, 0, -1}, "there is no compression", compression, {"none", "zip"});
    py::gil_scoped_release others;
    f.write(file, frame, options);
    return;
  }
  throw UserError({file.string(), 0, 0, -1}, "no format of frames ends in '" + file.extension().string() + "'", listed(endings), "choose one of these");
}

/// A picture for people, by colour bar and unit.
void writePicture(const Frame& frame, const std::filesystem::path& file, const std::optional<std::string>& layer, bool truth,
                  const std::optional<std::pair<double, double>>& range) {
  if (range && !(std::isfinite(range->first) && std::isfinite(range->second) && range->first < range->second))
    throw UserError({"picture", 0, 0, -1}, "the range does not rise", "(low, high), in the layers' unit", "swap its ends");
  PictureStyle style;
  style.ownScale = true;
  style.truth = truth;
  style.range = range;
  if (!layer) return writePreviewFile(file, frame, style);
  Frame one = frame;
  std::erase_if(one.layers, [&](const FrameLayer& l) { return l.name != *layer; });
  if (one.layers.empty()) throw py::key_error(*layer);
  style.truth = true;
  writePreviewFile(file, one, style);
}

}  // namespace

void bindFrames(py::module_& m) {
  py::class_<Frame, FrameHolder>(m, "Frame")
      .def_readonly("camera", &Frame::camera)
      .def_readonly("number", &Frame::number)
      .def_readonly("time_s", &Frame::time_s)
      .def_readonly("width", &Frame::width)
      .def_readonly("height", &Frame::height)
      .def("layers",
           [](const Frame& f) {
             std::vector<std::string> names;
             for (const FrameLayer& l : f.layers) names.push_back(l.name);
             return names;
           })
      .def("units",
           [](const Frame& f) {
             py::dict units;
             for (const FrameLayer& l : f.layers) units[py::str(l.name)] = l.unit;
             return units;
           })
      .def("layer", &layerOf)
      .def("attributes", &attributesOf)
      .def("targets", &targetsOf)
      .def("write", &writeTo)
      .def("picture", &writePicture);
  m.def("read_frame", [](const std::filesystem::path& file) {
    py::gil_scoped_release others;
    return std::make_shared<Frame>(readFrame(file));
  });
  m.def("frames_in", [](const std::filesystem::path& folder) { return framesIn(folder); });
}

}  // namespace pitviper
