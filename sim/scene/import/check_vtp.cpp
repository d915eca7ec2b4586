// VTK XML PolyData and ImageData: the tags' nesting, what kind of file it is, and declared counts against the file's size. The arrays
// themselves (base64, compressed) are left to the reader and checked after it.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/text_cursor.hpp"

namespace pitviper {
namespace {

/// zlib reaches about 1000:1 at best (zlib.net, technical details), lz4 255:1; a coordinate takes a byte at least.
constexpr double kMostItemsPerByte = 1032.0;

class VtpCheck {
 public:
  VtpCheck(const std::string& file, std::string_view text, const std::string& type) : file_(file), text_(text), type_(type) {}

  void run() {
    std::vector<std::string> open;
    bool isType = false;
    for (std::size_t at = text_.find('<'); at != text_.npos; at = text_.find('<', at)) {
      if (text_.substr(at, 4) == "<!--") {
        at = ended(at, text_.find("-->", at));
        continue;
      }
      const std::size_t end = ended(at, text_.find('>', at));
      const std::string_view tag = text_.substr(at, end - at + 1);
      const std::string name(tag.substr(1, tag.find_first_of(" \t\r\n/>", 2) - 1));
      if (tag[1] == '?') {
        at = end;
        continue;
      }
      if (tag[1] == '!') fail(at, "a declaration is not possible here", "elements only");  // no entities, no bombs
      if (tag[1] == '/') {
        if (open.empty() || "/" + open.back() != name)
          fail(at, "the tag <" + shown(name) + "> closes nothing", open.empty() ? "nothing" : "</" + open.back() + ">");
        open.pop_back();
      } else {
        if (open.empty() && name != "VTKFile") fail(at, "the file is no VTK XML file", "<VTKFile type=\"" + type_ + "\" ...>");
        if (name == "VTKFile") isType = attribute(tag, "type") == type_;
        if (name == "VTKFile" && !isType) fail(at, "the file holds no " + type_, "type=\"" + type_ + "\"");
        checkCounts(at, tag);
        if (name == "ImageData") checkImage(at, tag);
        if (name == "Piece") checkNumbers(at, tag, "Extent", 6, true);
        if (name == "AppendedData") return;  // what follows may be raw bytes
        if (tag[tag.size() - 2] != '/') open.push_back(name);
        if (open.size() > 32) fail(at, "the tags are nested too deeply", "32 levels at most");  // a PolyData needs five
      }
      at = end;
    }
    if (!isType) fail(0, "the file is no VTK XML file", "<VTKFile type=\"" + type_ + "\" ...>");
    if (!open.empty()) fail(text_.size(), "the file ends within <" + shown(open.back()) + ">", "</" + open.back() + ">");
  }

 private:
  [[noreturn]] void fail(std::size_t offset, const std::string& wrong, const std::string& expected) const {
    const std::string_view before = text_.substr(0, offset);
    const std::size_t lineEnd = before.rfind('\n');
    throw ImportFailure{{file_, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
                         static_cast<int>(offset - (lineEnd == before.npos ? 0 : lineEnd + 1)) + 1},
                        wrong,
                        expected,
                        ""};
  }

  static std::string shown(const std::string& name) { return TextCursor::shown(name); }

  std::size_t ended(std::size_t at, std::size_t end) const {
    if (end == text_.npos || end == at + 1) fail(at, "a tag has no end or no name", "'>'");
    return end;
  }

  std::string attribute(std::string_view tag, const std::string& name) const {
    const std::size_t at = tag.find(" " + name + "=");
    if (at == tag.npos) return "";
    const std::size_t open = at + name.size() + 2;
    if (open >= tag.size() || (tag[open] != '"' && tag[open] != '\'')) return "";
    return std::string(tag.substr(open + 1, tag.find(tag[open], open + 1) - open - 1));
  }

  void checkCounts(std::size_t at, std::string_view tag) const {
    const double most = std::min(kMostItemsPerByte * static_cast<double>(text_.size()), 3.0 * static_cast<double>(kMostImportedTriangles));
    for (const char* name :
         {"NumberOfPoints", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys", "NumberOfTuples", "NumberOfComponents", "offset"}) {
      const std::string value = attribute(tag, name);
      if (value.empty()) continue;
      double count = -1.0;
      const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), count);
      const double limit = std::string_view(name) == "offset" ? static_cast<double>(text_.size()) : most;
      if (error != std::errc{} || end != value.data() + value.size() || !(count >= 0.0 && count <= limit))
        fail(at, std::string(name) + "=\"" + shown(value) + "\" is not possible in a file of this size",
             "at most " + std::to_string(static_cast<long long>(limit)));
    }
  }

  void checkImage(std::size_t at, std::string_view tag) const {
    checkNumbers(at, tag, "WholeExtent", 6, true);
    checkNumbers(at, tag, "Origin", 3, false);
    for (double step : checkNumbers(at, tag, "Spacing", 3, false))
      if (!(step > 0.0))
        fail(at, "Spacing=\"" + shown(attribute(tag, "Spacing")) + "\" has a step that is not above 0", "three steps above 0, along x, y and z");
  }

  /// The reader takes what it cannot read for 0 or 1.
  std::vector<double> checkNumbers(std::size_t at, std::string_view tag, const std::string& name, std::size_t count, bool whole) const {
    const std::string value = attribute(tag, name);
    if (value.empty() && tag.find(" " + name + "=") == tag.npos) return {};
    std::vector<double> all;
    const char* const end = value.data() + value.size();
    for (const char* p = value.data();;) {
      while (p < end && static_cast<unsigned char>(*p) <= ' ') ++p;
      if (p == end) break;
      double number = 0.0;
      const auto [next, error] = std::from_chars(p + (*p == '+' ? 1 : 0), end, number);
      const bool parted = next == end || static_cast<unsigned char>(*next) <= ' ';
      constexpr double kMostExtent = 2147483647.0;
      if (error != std::errc{} || !parted || !std::isfinite(number) || (whole && !(std::abs(number) <= kMostExtent && number == std::floor(number)))) {
        all.clear();
        break;
      }
      all.push_back(number);
      p = next;
    }
    if (all.size() != count)
      fail(at, name + "=\"" + shown(value) + "\" of the grid",
           std::to_string(count) + (whole ? " whole numbers" : " finite numbers") + " with blanks between them");
    return all;
  }

  std::string file_;
  std::string_view text_;
  std::string type_;
};

}  // namespace

CheckedFile checkVtp(const std::string& file, std::string_view bytes) {
  VtpCheck(file, bytes, "PolyData").run();
  return {};
}

void checkVti(const std::string& file, std::string_view bytes) { VtpCheck(file, bytes, "ImageData").run(); }

}  // namespace pitviper
