#include "sim/frame/file_owner.hpp"

#include <optional>
#include <string_view>

#include "sim/frame/version.hpp"
#include "sim/image/exr.hpp"
#include "sim/image/fits.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

struct Owner {
  std::string name, hash;
};

constexpr std::string_view kTableBegin = "# pitviper ", kTableScenario = ", scenario ", kTableHash = ", sha256 ";

std::optional<Owner> ownerInTable(const std::filesystem::path& file) {
  constexpr std::size_t kLongestLine = 8192;  // a scenario's name has at most 4000 characters
  std::string start;
  try {
    start = readFileStart(file, kLongestLine);
  } catch (const UserError&) {
    return std::nullopt;
  }
  const std::string_view line = std::string_view(start).substr(0, start.find('\n'));
  const std::size_t name = line.find(kTableScenario), hash = line.rfind(kTableHash);
  if (!line.starts_with(kTableBegin) || hash == line.npos || name >= hash) return std::nullopt;
  const std::size_t from = name + kTableScenario.size();
  return Owner{std::string(line.substr(from, hash - from)), std::string(line.substr(hash + kTableHash.size()))};
}

/// The value after a name: JSON's ("name": "value"), a comment's or ENVI's (name = value).
std::optional<std::string> valueAfter(std::string_view text, std::string_view name) {
  for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
    std::size_t from = at + name.size();
    if (from >= text.size() || std::string_view("\": =").find(text[from]) == std::string_view::npos) continue;  // a longer name
    while (from < text.size() && std::string_view("\": =").find(text[from]) != std::string_view::npos) ++from;
    return std::string(text.substr(from, text.find_first_of("\n\";", from) - from));
  }
  return std::nullopt;
}

std::optional<Owner> ownerInText(const std::filesystem::path& file) {
  constexpr std::size_t kFarthest = 1u << 18;  // ENVI's headers have all attributes before it, some 100 bytes a body and layer
  std::string start;
  try {
    start = readFileStart(file, kFarthest);
  } catch (const UserError&) {
    return std::nullopt;
  }
  const auto name = valueAfter(start, kScenarioName), hash = valueAfter(start, kScenarioHash);
  if (!name || !hash) return std::nullopt;
  return Owner{*name, *hash};
}

std::optional<Owner> ownerOf(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  if (kind == ".csv" || kind == ".plan") return ownerInTable(file);
  // What has no place for words is of whom the file beside it says.
  if (kind == ".tif") return ownerInText(std::filesystem::path(file).replace_extension(".json"));
  if (kind == ".img") return ownerInText(std::filesystem::path(file).replace_extension(".hdr"));
  if (kind == ".json" || kind == ".raw" || kind == ".hdr" || kind == ".mp4" || kind == ".html") return ownerInText(file);
  const auto text = [&](const char* name, const char* ofFits) {
    return kind == ".png" ? readPngText(file, name) : kind == ".fits" ? readFitsText(file, ofFits) : readExrText(file, name);
  };
  const auto name = text(kScenarioName, kFitsScenario), hash = text(kScenarioHash, kFitsHash);
  if (!name || !hash) return std::nullopt;
  return Owner{*name, *hash};
}

}  // namespace

namespace {

std::string oneLine(std::string name) {
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 32) c = ' ';
  return name;
}

}  // namespace

std::string ownerMark(const Simulation& simulation) {
  return std::string(kScenarioName) + " = " + oneLine(simulation.name) + "; " + kScenarioHash + " = " + simulation.sha256 + ";";
}

std::string tableMark(const Simulation& simulation) {
  return std::string(kTableBegin) + kVersion + std::string(kTableScenario) + oneLine(simulation.name) + std::string(kTableHash) + simulation.sha256 + "\n";
}

void refuseForeignFile(const std::filesystem::path& file, const Simulation& simulation) {
  std::error_code failure;
  const auto status = std::filesystem::symlink_status(file, failure);
  if (!std::filesystem::exists(status)) return;
  const auto owner = ownerOf(file);
  if (owner && owner->hash == simulation.sha256) return;
  constexpr std::size_t kLongestName = 60;
  const std::string wrong = !owner                           ? "is there already and was not written by a run of this program"
                            : owner->name == simulation.name ? "is there already, of another version of the scenario '" + owner->name.substr(0, kLongestName) +
                                                                   "' (its text or --set differ)"
                                                             : "is there already, of another scenario, '" + owner->name.substr(0, kLongestName) + "'";
  throw UserError({file.string(), 0, 0, -1}, wrong, "no file of this name, or one of the same scenario",
                  "choose another folder with --out, or add --overwrite to replace it");
}

}  // namespace pitviper
