#include "sim/frame/frame_notes.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "sim/image/picture_file.hpp"

namespace pitviper {
namespace {

using NotedJson = nlohmann::ordered_json;

/// What is not finite was written as null.
double notedNumber(const NotedJson& value) { return value.is_null() ? NAN : value.get<double>(); }

Attribute notedAttribute(const std::string& name, const NotedJson& value) {
  if (value.is_string()) return {name, value.get<std::string>()};
  if (value.is_number_integer() && value.get<double>() == static_cast<double>(value.get<int>())) return {name, value.get<int>()};
  if (!value.is_array()) return {name, notedNumber(value)};
  std::vector<double> list;
  for (const NotedJson& v : value) list.push_back(notedNumber(v));
  return {name, list};
}

FrameNotes notesIn(const NotedJson& json, const Location& where) {
  FrameNotes notes;
  notes.frame.camera = json.value("camera", "");
  notes.frame.number = json.value("frame", 0);
  if (json.contains("time_s")) notes.frame.time_s = notedNumber(json.at("time_s"));
  const auto width = json.at("width").get<double>(), height = json.at("height").get<double>();
  if (!(width >= 1.0 && height >= 1.0 && width <= kMostPictureSide && height <= kMostPictureSide))
    throw UserError(where, "a side is not in 1 to 32768", "the width and height of a frame", "write the frame again");
  notes.frame.width = static_cast<int>(width), notes.frame.height = static_cast<int>(height);
  const NotedJson& layers = json.at("layers");
  if (layers.empty() || layers.size() > kMostPictures)
    throw UserError(where, "the frame has no layers or more than 1024", "1 to 1024", "write the frame again");
  for (const NotedJson& l : layers) {
    LayerCode code{l.at("name").get<std::string>(), l.value("file", ""), l.at("type").get<std::string>()};
    if (l.contains("low")) code.low = notedNumber(l.at("low"));
    if (l.contains("step")) code.step = notedNumber(l.at("step"));
    code.zeroIsNone = l.contains("none");
    notes.frame.layers.push_back({code.layer, l.value("unit", ""), {}});
    notes.codes.push_back(std::move(code));
  }
  if (json.contains("attributes"))
    for (const auto& [name, value] : json.at("attributes").items()) notes.frame.attributes.push_back(notedAttribute(name, value));
  return notes;
}

}  // namespace

FrameNotes frameNotes(const std::string& json, const Location& where) {
  try {
    return notesIn(NotedJson::parse(json), where);
  } catch (const NotedJson::exception& failure) {
    throw UserError(where, std::string("cannot read the frame's JSON: ") + failure.what(), "what a frame's writer wrote", "write the frame again");
  }
}

}  // namespace pitviper
