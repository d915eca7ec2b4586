#pragma once
// Files of a data set, and what tells of them all: `manifest.json`.
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/image/picture.hpp"
#include "sim/model/simulation.hpp"
#include "sim/stream/data_split.hpp"

namespace pitviper {

/// Names are relative to the data set's folder. Errors of all that writes: OutputError, and what the place's `mayReplace` throws.
class DataSetFiles {
 public:
  using Json = nlohmann::ordered_json;
  /// `sink`: by its name. `simulation` is read here only.
  DataSetFiles(std::string sink, const Simulation& simulation, SinkPlace place);

  const SinkPlace& place() const { return place_; }
  /// {"pitviper.scenario", "pitviper.scenario_sha256", "pitviper.version"}: what files of text begin with.
  Json owner() const;

  /// A plan's fingerprint, of a frame that is in the data set.
  void noteFrame(const Frame& frame);
  /// `about`: more keys of its entry in the manifest.
  void writeText(const std::filesystem::path& name, const std::string& text, const Json& about = {});
  void writeGrey(const std::filesystem::path& name, int width, int height, const std::vector<std::uint16_t>& codes,
                 const std::map<std::string, std::string>& texts, const Json& about = {});
  void writePicture(const std::filesystem::path& name, const Rgb8Image& picture, const std::map<std::string, std::string>& texts, const Json& about = {});
  /// What stands there under its name, written by others.
  void note(const std::filesystem::path& name, const Json& about = {});
  /// For a file that cannot say whose it is, beside one that does: it may be replaced where that one may.
  MayReplace mayReplaceBeside(const std::filesystem::path& name) const;
  /// Where such a file exists: throws what is to be said where it must stay.
  void refuseForeignBeside(const std::filesystem::path& name, const std::filesystem::path& owner) const;
  /// The same as writeText, of such a file.
  void writeTextBeside(const std::filesystem::path& name, const std::string& text, const std::filesystem::path& owner, const Json& about = {});
  /// Whole numbers as a TIFF of one page.
  void writeTiffPageBeside(const std::filesystem::path& name, const Frame& frame, const FrameLayer& layer, const std::filesystem::path& owner,
                           const Json& about = {});

  /// manifest.json: scenario, hashes, seed, version, plans, split, and each file with its SHA-256. `more`: keys of its own.
  void writeManifest(const DataSplit& split, const Json& more = {});

 private:
  std::string sink_, scenario_, sha256_, content_;
  long long seed_;
  SinkPlace place_;
  std::map<std::string, std::set<std::string>> plans_;  ///< by camera
  Json files_ = Json::array();
};

inline constexpr const char* kManifest = "manifest.json";

/// JSON as files have it: one space of indent, what is no text replaced.
std::string jsonText(const DataSetFiles::Json& json);

}  // namespace pitviper
