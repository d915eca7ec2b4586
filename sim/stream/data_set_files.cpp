#include "sim/stream/data_set_files.hpp"

#include "sim/frame/file_owner.hpp"
#include "sim/frame/version.hpp"
#include "sim/image/png.hpp"
#include "sim/image/tiff.hpp"
#include "sim/stream/file_digest.hpp"

namespace pitviper {

DataSetFiles::DataSetFiles(std::string sink, const Simulation& sim, SinkPlace place)
    : sink_(std::move(sink)), scenario_(sim.name), sha256_(sim.sha256), content_(sim.content), seed_(sim.seed), place_(std::move(place)) {}

DataSetFiles::Json DataSetFiles::owner() const { return {{kScenarioName, scenario_}, {kScenarioHash, sha256_}, {"pitviper.version", kVersion}}; }

void DataSetFiles::noteFrame(const Frame& frame) {
  for (const Attribute& a : frame.attributes)
    if (const auto* text = std::get_if<std::string>(&a.value); text && a.name == "pitviper.plan") plans_[frame.camera].insert(*text);
}

void DataSetFiles::note(const std::filesystem::path& name, const Json& about) {
  Json entry = {{"file", name.generic_string()}, {"sha256", sha256OfFile(place_.folder / name)}};
  if (about.is_object()) entry.update(about);
  files_.push_back(std::move(entry));
}

MayReplace DataSetFiles::mayReplaceBeside(const std::filesystem::path& name) const {
  if (!place_.mayReplace) return {};
  return [mayReplace = place_.mayReplace, owner = place_.folder / name](const std::filesystem::path& file) {
    std::error_code failure;
    mayReplace(std::filesystem::exists(owner, failure) ? owner : file);
  };
}

void DataSetFiles::refuseForeignBeside(const std::filesystem::path& name, const std::filesystem::path& owner) const {
  std::error_code failure;
  const auto file = place_.folder / name;
  if (const MayReplace mayReplace = mayReplaceBeside(owner); mayReplace && std::filesystem::exists(std::filesystem::symlink_status(file, failure)))
    mayReplace(file);
}

void DataSetFiles::writeText(const std::filesystem::path& name, const std::string& text, const Json& about) {
  writeFileAtomically(place_.folder / name, text, place_.mayReplace);
  note(name, about);
}

void DataSetFiles::writeGrey(const std::filesystem::path& name, int width, int height, const std::vector<std::uint16_t>& codes,
                             const std::map<std::string, std::string>& texts, const Json& about) {
  writePngGrey(place_.folder / name, width, height, codes, texts, place_.mayReplace);
  note(name, about);
}

void DataSetFiles::writePicture(const std::filesystem::path& name, const Rgb8Image& picture, const std::map<std::string, std::string>& texts,
                                const Json& about) {
  writePng(place_.folder / name, picture, texts, place_.mayReplace);
  note(name, about);
}

void DataSetFiles::writeTextBeside(const std::filesystem::path& name, const std::string& text, const std::filesystem::path& owner, const Json& about) {
  writeFileAtomically(place_.folder / name, text, mayReplaceBeside(owner));
  note(name, about);
}

void DataSetFiles::writeTiffPageBeside(const std::filesystem::path& name, const Frame& frame, const FrameLayer& layer, const std::filesystem::path& owner,
                                       const Json& about) {
  writeTiff(place_.folder / name, frame.width, frame.height, {{layer.name, layer.name + " [" + layer.unit + "]", true, layer.pixels}}, mayReplaceBeside(owner));
  note(name, about);
}

void DataSetFiles::writeManifest(const DataSplit& split, const Json& more) {
  Json json = owner();
  json[kScenarioContent] = content_;
  json["pitviper.seed"] = seed_;
  json["sink"] = sink_;
  Json& plans = json["plans"] = Json::object();
  for (const auto& [camera, own] : plans_) plans[camera] = own;
  Json& parts = json["split"] = nullptr;
  if (!split.shares.empty()) {
    parts = {{"seed", split.seed}};
    for (const auto& [name, share] : split.shares) parts[name] = share;
  }
  if (more.is_object()) json.update(more);
  json["files"] = files_;
  writeFileAtomically(place_.folder / kManifest, jsonText(json), place_.mayReplace);
}

std::string jsonText(const DataSetFiles::Json& json) { return json.dump(1, ' ', false, DataSetFiles::Json::error_handler_t::replace) + "\n"; }

}  // namespace pitviper
