// The frames of a folder.
#include <algorithm>
#include <map>
#include <set>

#include "sim/frame/frame_notes.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Runs of digits are numbers: "a_2" before "a_10".
bool naturallyBefore(const std::string& a, const std::string& b) {
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!isDigit(a[i]) || !isDigit(b[j])) {
      if (a[i] != b[j]) return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
      ++i, ++j;
      continue;
    }
    const auto run = [](const std::string& text, std::size_t& at) {
      while (at < text.size() && text[at] == '0') ++at;
      const std::size_t begin = at;
      while (at < text.size() && isDigit(text[at])) ++at;
      return text.substr(begin, at - begin);
    };
    const std::string m = run(a, i), n = run(b, j);
    if (m.size() != n.size()) return m.size() < n.size();
    if (m != n) return m < n;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // "a_02" and "a_2"
}

std::string startOf(const std::filesystem::path& file) {
  try {
    return readFileStart(file, 64);
  } catch (const UserError&) {
    return "";
  }
}

/// By extension and beginning: a grey PNG, not a colour one; an ENVI header, not a Radiance picture.
bool looksLikeFrame(const std::filesystem::path& file) {
  static const std::multimap<std::string, std::string> beginnings = {
      {".exr", "\x76\x2f\x31\x01"}, {".tif", "II"},        {".tif", "MM"},      {".tiff", "II"},      {".tiff", "MM"}, {".fits", "SIMPLE  ="},
      {".fit", "SIMPLE  ="},        {".fts", "SIMPLE  ="}, {".png", "\x89PNG"}, {".raw", "PITVRAW1"}, {".hdr", "ENVI"}};
  const auto [first, last] = beginnings.equal_range(file.extension().string());
  if (first == last) return false;
  const std::string start = startOf(file);
  constexpr std::size_t kPngColour = 25;
  if (first->first == ".png" && (start.size() <= kPngColour || start[kPngColour] != 0)) return false;
  return std::any_of(first, last, [&](const auto& b) { return start.starts_with(b.second); });
}

/// The files that a frame's JSON names; none of other JSON.
std::set<std::string> filesNamedIn(const std::filesystem::path& json) {
  std::set<std::string> files;
  try {
    const FrameNotes notes = frameNotes(readWholeFile(json, {.mostBytes = std::uintmax_t{256} << 20}), {.file = json.string()});
    for (const LayerCode& c : notes.codes) files.insert(c.file);
  } catch (const UserError&) {
    return {};
  }
  files.erase("");
  return files;
}

}  // namespace

std::vector<std::filesystem::path> framesIn(const std::filesystem::path& fileOrFolder) {
  std::error_code failure;
  if (std::filesystem::is_regular_file(fileOrFolder, failure)) return {fileOrFolder};
  std::filesystem::directory_iterator entries(fileOrFolder, failure);
  if (failure) throw UserError({.file = fileOrFolder.string()}, "cannot be listed: " + failure.message(), "a file or a folder", "check the path");
  std::vector<std::filesystem::path> frames;
  std::set<std::string> parts;  // pictures of a JSON
  for (; !failure && entries != std::filesystem::directory_iterator(); entries.increment(failure)) {
    const std::filesystem::path file = entries->path();
    std::error_code unknown;
    if (!std::filesystem::is_regular_file(file, unknown)) continue;
    if (file.extension() == ".json") {
      const std::set<std::string> named = filesNamedIn(file);
      if (named.empty() || std::any_of(named.begin(), named.end(), [](const std::string& n) { return !n.ends_with(".png"); })) continue;
      parts.insert(named.begin(), named.end());
      frames.push_back(file);
    } else if (looksLikeFrame(file)) frames.push_back(file);
  }
  std::erase_if(frames, [&](const std::filesystem::path& f) { return parts.contains(f.filename().string()); });
  std::sort(frames.begin(), frames.end(), [](const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::string m = a.stem().string(), n = b.stem().string();
    return m == n ? a.extension() < b.extension() : naturallyBefore(m, n);
  });
  return frames;
}

}  // namespace pitviper
