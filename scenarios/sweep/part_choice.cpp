#include "scenarios/sweep/part_choice.hpp"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// A whole number from 0 as it is printed: digits, none of them a 0 in front.
std::optional<int> plainNumber(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || std::to_string(value) != text || value < 0) return std::nullopt;
  return value;
}

std::optional<PartChoice> choiceOf(std::string_view part, std::string_view of) {
  const auto p = plainNumber(part), n = plainNumber(of);
  if (!p || !n || *n < 1 || *n > kMostParts || *p >= *n) return std::nullopt;
  return PartChoice{*p, *n};
}

/// Of "part_3_of_40.sqlite".
std::optional<PartChoice> choiceOfFile(std::string_view name) {
  constexpr std::string_view kBefore = "part_", kBetween = "_of_", kBehind = ".sqlite";
  if (!name.starts_with(kBefore) || !name.ends_with(kBehind) || name.size() < kBefore.size() + kBehind.size()) return std::nullopt;
  name.remove_prefix(kBefore.size());
  name.remove_suffix(kBehind.size());
  const std::size_t middle = name.find(kBetween);
  if (middle == name.npos) return std::nullopt;
  return choiceOf(name.substr(0, middle), name.substr(middle + kBetween.size()));
}

}  // namespace

PartChoice readPartChoice(const std::string& text, const Location& where) {
  const std::size_t slash = text.find('/');
  const auto choice = slash == text.npos ? std::nullopt : choiceOf(std::string_view(text).substr(0, slash), std::string_view(text).substr(slash + 1));
  if (!choice)
    throw UserError(where, "'" + readable(text) + "' is no part of a sweep",
                    "K/N, whole numbers: part K, from 0 to N - 1, of N parts, 1 to " + std::to_string(kMostParts),
                    "write 0/40 for the first of 40, 39/40 for the last");
  return *choice;
}

fs::path partFile(const fs::path& folder, const PartChoice& choice) {
  return folder / "parts" / ("part_" + std::to_string(choice.part) + "_of_" + std::to_string(choice.of) + ".sqlite");
}

PartFiles partFilesIn(const fs::path& folder) {
  PartFiles found;
  const fs::path parts = folder / "parts";
  std::error_code error;
  fs::directory_iterator entry(parts, error);
  if (error == std::errc::no_such_file_or_directory) return found;
  for (; !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const auto choice = choiceOfFile(entry->path().filename().string());
    if (!choice) continue;
    if (found.of != 0 && found.of != choice->of) {
      const auto [one, other] = std::minmax(found.of, choice->of);
      throw UserError({parts.string(), 0, 0, -1}, "parts of several divisions lie here, of " + std::to_string(one) + " and of " + std::to_string(other),
                      "those of one", "remove the others, or choose another folder with --out");
    }
    if (std::error_code ignored; !entry->is_regular_file(ignored))
      throw UserError({entry->path().string(), 0, 0, -1}, "has the name of a part, and is no file", "a part's file", "remove it");
    found.of = choice->of;
    found.files[choice->part] = entry->path();
  }
  if (error) throw UserError({parts.string(), 0, 0, -1}, "cannot be looked through: " + error.message(), "a folder", "check the path and its permissions");
  return found;
}

PartFiles partFilesIn(const fs::path& folder, int parts) {
  PartFiles found = partFilesIn(folder);
  if (found.of != 0 && found.of != parts)
    throw UserError({(folder / "parts").string(), 0, 0, -1}, "parts of another division lie here, of " + std::to_string(found.of),
                    "none, or those of " + std::to_string(parts),
                    "use " + std::to_string(found.of) + " parts again, remove them, or choose another folder with --out");
  return found;
}

}  // namespace pitviper
