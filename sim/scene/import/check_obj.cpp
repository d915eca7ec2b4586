// Wavefront OBJ (Alias|Wavefront, Advanced Visualizer, appendix B1): v, vt, vn, f, g, o; everything else is left out.
#include <algorithm>
#include <array>
#include <map>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/far_origin.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/text_cursor.hpp"

namespace pitviper {
namespace {

/// Position, texture coordinate and normal of a face's corner, from 0; -1: none.
using Corner = std::array<int, 3>;

class ObjCheck {
 public:
  ObjCheck(const std::string& file, std::string_view text) : in_(file, text) {}

  CheckedFile run() {
    while (!in_.atEnd()) {
      const std::string_view command = in_.wordOfLine();
      if (command == "v") vertexLine(0, 3, 3);
      else if (command == "vt") vertexLine(1, 1, 2);
      else if (command == "vn") vertexLine(2, 3, 3);
      else if (command == "f") faceLine();
      else if (command == "g") groupLine(groups_);
      else if (command == "o") groupLine(objects_);
      in_.skipLine();
    }
    finish();
    return std::move(out_);
  }

 private:
  struct Naming {
    bool used = false;
    std::uint32_t current = 0;
    std::vector<std::string> names{"default"};
    std::map<std::string, std::uint32_t, std::less<>> known{{"default", 0}};
    std::vector<std::uint32_t> ofFace;
  };

  void vertexLine(int kind, int least, int most) {
    glm::dvec3 values(0.0);
    int count = 0;
    for (std::string_view word = in_.wordOfLine(); !word.empty() || count < least; word = in_.wordOfLine()) {
      const double value = in_.number(word);
      if (count < most) values[count++] = value;  // a weight or a colour may follow
    }
    if (kind == 0) places_.push_back(values);
    else if (kind == 1) putLine(out_.bytes, "vt", values, 2);
    else putLine(normals_, "vn", values, 3);
    if (++counts_[kind] > 3 * static_cast<long long>(kMostImportedTriangles)) in_.fail("the mesh has too many vertices");
  }

  static void putLine(std::string& text, const char* command, const glm::dvec3& values, int count) {
    text += command;
    for (int k = 0; k < count; ++k) {
      char digits[32];
      const auto end = std::to_chars(digits, digits + sizeof digits, static_cast<float>(values[k])).ptr;
      text += ' ';
      text.append(digits, end);
    }
    text += '\n';
  }

  void faceLine() {
    long long corners = 0;
    const int line = in_.here().line;
    for (std::string_view word = in_.wordOfLine(); !word.empty(); word = in_.wordOfLine(), ++corners) {
      if (corners == kMostCorners) in_.fail("this face has too many corners", "at most " + std::to_string(kMostCorners));
      corners_.push_back(corner(word));
    }
    if (corners < 3) in_.fail("a face has " + std::to_string(corners) + " corners", "three or more");
    faceSizes_.push_back(static_cast<std::uint32_t>(corners));
    out_.placeOfFace.push_back(static_cast<std::uint64_t>(line));
    triangles_ += corners - 2;
    if (triangles_ > static_cast<long long>(kMostImportedTriangles))
      in_.fail("the mesh has too many triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh");
    groups_.ofFace.push_back(groups_.current);
    objects_.ofFace.push_back(objects_.current);
  }

  Corner corner(std::string_view word) {
    Corner corner{-1, -1, -1};
    for (int kind = 0; kind < 3; ++kind) {
      const std::size_t slash = word.find('/');
      const std::string_view index = word.substr(0, slash);
      if (!index.empty() || kind == 0) corner[kind] = resolved(kind, index);
      if (slash == word.npos) return corner;
      word.remove_prefix(slash + 1);
    }
    in_.fail("a corner has more than three indices", "position/texture/normal");
  }

  /// Indices count from 1, or back from the last one so far. A later vertex may be meant: checked at the end.
  int resolved(int kind, std::string_view word) {
    constexpr long long kMost = 2'000'000'000;  // an int in the reader
    const long long index = in_.integer(word, -kMost, kMost);
    if (index == 0 || -index > counts_[kind])
      in_.fail("index " + std::to_string(index) + " is out of range", "1.." + std::to_string(counts_[kind]) + ", or negative to count back");
    const long long from0 = index > 0 ? index - 1 : counts_[kind] + index;
    if (from0 > farthest_[kind]) {
      farthest_[kind] = from0;
      farthestAt_[kind] = in_.here();
    }
    return static_cast<int>(from0);
  }

  void groupLine(Naming& naming) {
    std::string name;
    for (std::string_view word = in_.wordOfLine(); !word.empty(); word = in_.wordOfLine()) name.append(name.empty() ? "" : " ").append(word);
    if (name.empty()) name = "default";
    naming.used = true;
    const auto [entry, isNew] = naming.known.try_emplace(name, static_cast<std::uint32_t>(naming.names.size()));
    if (isNew) naming.names.push_back(name);
    naming.current = entry->second;
  }

  void finish() {
    for (int kind = 0; kind < 3; ++kind)
      if (farthest_[kind] >= counts_[kind])
        throw ImportFailure{farthestAt_[kind], "index " + std::to_string(farthest_[kind] + 1) + " is out of range", "1.." + std::to_string(counts_[kind]), ""};
    if (faceSizes_.empty()) in_.fail("the file has no faces", "at least one 'f' line");
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const Corner& c : corners_) {
      const glm::dvec3& p = places_[static_cast<std::size_t>(c[0])];
      low = glm::min(low, p), high = glm::max(high, p);
    }
    out_.origin = farOrigin(low, high);
    for (const glm::dvec3& p : places_) putLine(out_.bytes, "v", p - out_.origin, 3);
    places_ = {};
    // The reader drops faces that are not all alike: texture coordinates are filled up by 0 0, normals left out unless
    // every corner has one.
    const auto has = [](int kind) { return [kind](const Corner& c) { return c[kind] >= 0; }; };
    const bool anyUv = std::any_of(corners_.begin(), corners_.end(), has(1));
    const bool allUv = std::all_of(corners_.begin(), corners_.end(), has(1));
    const bool allNormals = std::all_of(corners_.begin(), corners_.end(), has(2));
    if (anyUv && !allUv) out_.bytes += "vt 0 0\n";
    if (allNormals) out_.bytes += normals_;
    normals_ = {};
    std::size_t next = 0;
    for (const std::uint32_t size : faceSizes_) {
      out_.bytes += 'f';
      for (std::uint32_t k = 0; k < size; ++k) {
        const Corner& c = corners_[next++];
        out_.bytes += ' ' + std::to_string(c[0] + 1);
        if (anyUv || allNormals) out_.bytes += '/';
        if (anyUv) out_.bytes += std::to_string(c[1] >= 0 ? c[1] + 1 : static_cast<int>(counts_[1]) + 1);
        if (allNormals) out_.bytes += '/' + std::to_string(c[2] + 1);
      }
      out_.bytes += '\n';
    }
    Naming& naming = groups_.used ? groups_ : objects_;
    if (!naming.used) return;
    out_.partOfFace = std::move(naming.ofFace);
    out_.partNames = std::move(naming.names);
  }

  TextCursor in_;
  CheckedFile out_;
  std::vector<glm::dvec3> places_;
  std::string normals_;  ///< the canonical copy's vn lines
  std::array<long long, 3> counts_{}, farthest_{-1, -1, -1};
  std::array<Location, 3> farthestAt_;
  std::vector<Corner> corners_;
  std::vector<std::uint32_t> faceSizes_;
  long long triangles_ = 0;
  Naming groups_, objects_;
};

}  // namespace

CheckedFile checkObj(const std::string& file, std::string_view text) { return ObjCheck(file, text).run(); }

}  // namespace pitviper
