#include "sim/frame/frame_json.hpp"

#include <nlohmann/json.hpp>

#include "sim/frame/file_owner.hpp"

namespace pitviper {
namespace {

using Json = nlohmann::ordered_json;

const std::string* textOf(const Frame& frame, std::string_view name) {
  for (const Attribute& a : frame.attributes)
    if (a.name == name) return std::get_if<std::string>(&a.value);
  return nullptr;
}

}  // namespace

std::string frameJson(const Frame& frame, const std::vector<LayerCode>& codes) {
  Json json;
  // Whose it is, first: refuseForeignFile() looks at the beginning only.
  for (const char* name : {kScenarioName, kScenarioHash})
    if (const std::string* text = textOf(frame, name)) json[name] = *text;
  json["camera"] = frame.camera;
  json["frame"] = frame.number;
  json["time_s"] = frame.time_s;
  json["width"] = frame.width;
  json["height"] = frame.height;
  json["layers"] = Json::array();
  for (const FrameLayer& l : frame.layers)
    for (const LayerCode& c : codes) {
      if (c.layer != l.name) continue;
      Json layer = {{"name", l.name}, {"unit", l.unit}, {"type", c.type}};
      if (!c.file.empty()) layer["file"] = c.file;
      if (c.type == "uint16") layer["low"] = c.low, layer["step"] = c.step;
      if (c.zeroIsNone) layer["none"] = 0;
      json["layers"].push_back(std::move(layer));
    }
  Json& attributes = json["attributes"] = Json::object();
  for (const Attribute& a : frame.attributes) std::visit([&](const auto& value) { attributes[a.name] = value; }, a.value);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace pitviper
