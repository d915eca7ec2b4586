// PLY (Turk, Stanford 1994), ascii and binary. The canonical copy is binary little-endian and holds the elements vertex
// (x y z, nx ny nz, u v as far as there) and face (one list of vertex indices).
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/far_origin.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/text_cursor.hpp"

namespace pitviper {
namespace {

struct Type {
  std::string_view name, otherName;
  std::size_t size;
  enum { Signed, Unsigned, Real } kind;
};

constexpr Type kTypes[] = {{"char", "int8", 1, Type::Signed},       {"uchar", "uint8", 1, Type::Unsigned}, {"short", "int16", 2, Type::Signed},
                           {"ushort", "uint16", 2, Type::Unsigned}, {"int", "int32", 4, Type::Signed},     {"uint", "uint32", 4, Type::Unsigned},
                           {"float", "float32", 4, Type::Real},     {"double", "float64", 8, Type::Real}};

struct Property {
  std::string name;
  const Type* type = nullptr;
  const Type* countType = nullptr;  ///< of a list; else null
  int slot = -1;                    ///< of a vertex: index into kSlots
};

struct Element {
  std::string name;
  long long count = 0;
  std::vector<Property> properties;
};

constexpr std::array<std::string_view, 8> kSlots{"x", "y", "z", "nx", "ny", "nz", "u", "v"};

int slotOf(std::string_view name) {
  if (name == "s" || name == "texture_u" || name == "texture_s") name = "u";
  if (name == "t" || name == "texture_v" || name == "texture_t") name = "v";
  const auto found = std::find(kSlots.begin(), kSlots.end(), name);
  return found == kSlots.end() ? -1 : static_cast<int>(found - kSlots.begin());
}

class PlyCheck {
 public:
  PlyCheck(const std::string& file, std::string_view bytes) : file_(file), bytes_(bytes), in_(file, bytes) {}

  CheckedFile run() {
    readHeader();
    const Element* vertices = find("vertex");
    const Element* faces = find("face");
    if (vertices == nullptr || faces == nullptr || vertices->count == 0 || faces->count == 0)
      in_.fail("the file has no vertices or no faces", "elements 'vertex' and 'face'", "points alone cannot be rendered");
    vertexCount_ = vertices->count;
    for (const Element& element : elements_) readElement(element);
    if (places_.empty()) in_.fail("the vertices have no x, y and z");
    if (triangles_ == 0) in_.fail("the file has no triangles");
    assemble();
    return std::move(out_);
  }

 private:
  const Element* find(std::string_view name) const {
    for (const Element& element : elements_)
      if (element.name == name) return &element;
    return nullptr;
  }

  const Type* typeOf(std::string_view word) const {
    for (const Type& type : kTypes)
      if (word == type.name || word == type.otherName) return &type;
    in_.fail("'" + TextCursor::shown(word) + "' is no type", "char, uchar, short, ushort, int, uint, float or double");
  }

  void readHeader() {
    if (in_.wordOfLine() != "ply") in_.fail("the file does not begin with 'ply'");
    in_.skipLine();
    for (bool done = false, formatKnown = false; !done; in_.skipLine()) {
      if (in_.atEnd()) in_.fail("the header has no end", "'end_header'");
      const std::string_view word = in_.wordOfLine();
      if (word == "format") {
        const std::string_view format = in_.wordOfLine();
        ascii_ = format == "ascii";
        swap_ = format == (std::endian::native == std::endian::little ? "binary_big_endian" : "binary_little_endian");
        if (!ascii_ && format != "binary_little_endian" && format != "binary_big_endian")
          in_.fail("'" + TextCursor::shown(format) + "' is no format", "ascii, binary_little_endian or binary_big_endian");
        formatKnown = true;
      } else if (word == "element") {
        Element element;
        element.name = in_.wordOfLine();
        element.count = in_.integer(in_.wordOfLine(), 0, static_cast<long long>(bytes_.size()));  // a byte each at least
        if (find(element.name) != nullptr) in_.fail("the element '" + element.name + "' is there twice");
        if (elements_.size() == 64) in_.fail("too many elements", "64 at most");  // real files have two to five
        elements_.push_back(element);
      } else if (word == "property") {
        readProperty();
      } else if (word == "end_header") {
        if (!formatKnown) in_.fail("the header does not say the format", "a 'format' line");
        done = true;
      } else if (word != "comment" && word != "obj_info" && !word.empty()) {
        in_.fail("'" + TextCursor::shown(word) + "' is not possible in a PLY header", "element, property or end_header");
      }
    }
    at_ = in_.offset();
  }

  void readProperty() {
    if (elements_.empty()) in_.fail("a property before the first element");
    Element& element = elements_.back();
    Property property;
    std::string_view word = in_.wordOfLine();
    if (word == "list") {
      property.countType = typeOf(in_.wordOfLine());
      if (property.countType->kind == Type::Real) in_.fail("a list cannot be counted by a real number");
      word = in_.wordOfLine();
    }
    property.type = typeOf(word);
    property.name = in_.wordOfLine();
    const bool isVertex = element.name == "vertex";
    if (isVertex && property.countType == nullptr) property.slot = slotOf(property.name);
    for (const Property& other : element.properties)
      if (other.name == property.name || (property.slot >= 0 && other.slot == property.slot))
        in_.fail("the property '" + TextCursor::shown(property.name) + "' is there twice");
    if (element.properties.size() == 256) in_.fail("too many properties", "256 at most");
    element.properties.push_back(property);
  }

  void readElement(const Element& element) {
    if (element.properties.empty()) return;
    const bool isVertex = element.name == "vertex", isFace = element.name == "face";
    if (isVertex) findSlots(element);
    if (isFace && std::none_of(element.properties.begin(), element.properties.end(), isIndexList))
      in_.fail("the faces have no vertices", "a list 'vertex_indices'");
    for (long long row = 0; row < element.count; ++row) {
      std::array<double, kSlots.size()> values{};
      for (const Property& property : element.properties) {
        if (property.countType != nullptr) {
          readList(property, isFace && isIndexList(property));
        } else if (property.slot >= 0) {
          values[property.slot] = real(*property.type);
        } else {
          skipValue(*property.type);
        }
      }
      if (!isVertex) continue;
      places_.emplace_back(values[0], values[1], values[2]);
      for (std::size_t k = hasNormals_ ? 3 : 6; k < (hasUv_ ? values.size() : 6u); ++k) attributes_.push_back(static_cast<float>(values[k]));
    }
  }

  static bool isIndexList(const Property& p) {
    return p.countType != nullptr && p.type->kind != Type::Real && (p.name == "vertex_indices" || p.name == "vertex_index");
  }

  void findSlots(const Element& element) {
    std::array<bool, kSlots.size()> there{};
    for (const Property& property : element.properties)
      if (property.slot >= 0) there[property.slot] = true;
    if (!there[0] || !there[1] || !there[2]) in_.fail("the vertices have no x, y and z");
    hasNormals_ = there[3] && there[4] && there[5];
    hasUv_ = there[6] && there[7];
  }

  void readList(const Property& property, bool isFace) {
    const std::uint64_t begin = at_;
    const long long count = whole(*property.countType, 0, isFace ? kMostCorners : std::numeric_limits<std::uint32_t>::max());
    std::vector<std::int32_t> face;
    if (isFace) face.push_back(static_cast<std::int32_t>(count));
    for (long long k = 0; k < count; ++k) {
      if (isFace) face.push_back(static_cast<std::int32_t>(whole(*property.type, 0, std::min(vertexCount_ - 1, 2'000'000'000ll))));
      else skipValue(*property.type);
    }
    if (!isFace || count < 3) return;  // lines and points among the faces are left out
    append(faceBytes_, face.data(), face.size());
    out_.placeOfFace.push_back(ascii_ ? static_cast<std::uint64_t>(in_.here().line) : begin);
    ++faceCount_;
    triangles_ += count - 2;
    if (triangles_ > static_cast<long long>(kMostImportedTriangles))
      failHere("the mesh has too many triangles", "at most " + std::to_string(kMostImportedTriangles));
  }

  [[noreturn]] void failHere(const std::string& wrong, const std::string& expected) const {
    if (ascii_) in_.fail(wrong, expected);
    failAtByte(file_, at_, wrong, expected);
  }

  std::uint64_t raw(const Type& type) {
    if (bytes_.size() - at_ < type.size) failHere("the file ends within its elements", "as many as the header says");
    unsigned char bytes[8] = {};
    std::memcpy(bytes, bytes_.data() + at_, type.size);
    at_ += type.size;
    if (swap_) std::reverse(bytes, bytes + type.size);
    std::uint64_t value = 0;
    std::memcpy(&value, bytes, sizeof value);
    return value;
  }

  void skipValue(const Type& type) {
    if (!ascii_) raw(type);
    else if (in_.word().empty()) in_.fail("the file ends within its elements", "as many as the header says");
  }

  long long whole(const Type& type, long long least, long long most) {
    if (ascii_) return in_.integer(in_.word(), least, most);
    const std::uint64_t bits = raw(type);
    const unsigned unused = static_cast<unsigned>(64 - 8 * type.size);
    const long long value = type.kind == Type::Signed ? static_cast<std::int64_t>(bits << unused) >> unused : static_cast<std::int64_t>(bits);
    if (value < least || value > most) {
      at_ -= type.size;
      failHere("the number " + std::to_string(value) + " is not possible here", std::to_string(least) + ".." + std::to_string(most));
    }
    return value;
  }

  double real(const Type& type) {
    if (ascii_) return in_.number(in_.word());
    if (type.kind != Type::Real) return static_cast<double>(whole(type, std::numeric_limits<long long>::min(), std::numeric_limits<long long>::max()));
    const std::uint64_t bits = raw(type);
    const double value = type.size == 8 ? std::bit_cast<double>(bits) : static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
    if (!(std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max()))) {
      at_ -= type.size;
      failHere("a number is not finite in single precision", "a finite number");
    }
    return value;
  }

  template <class T>
  static void append(std::string& out, const T* values, std::size_t count) {
    out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
  }

  void assemble() {
    std::string& out = out_.bytes;
    out = std::string("ply\nformat ") + (std::endian::native == std::endian::little ? "binary_little_endian" : "binary_big_endian") + " 1.0\n";
    out += "element vertex " + std::to_string(vertexCount_) + "\n";
    for (std::size_t slot = 0; slot < kSlots.size(); ++slot)
      if (slot < 3 || (slot < 6 ? hasNormals_ : hasUv_)) out += "property float " + std::string(kSlots[slot]) + "\n";
    out += "element face " + std::to_string(faceCount_) + "\nproperty list int int vertex_indices\nend_header\n";
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (std::size_t at = 0; at < faceBytes_.size();) {
      std::int32_t count = 0;
      std::memcpy(&count, faceBytes_.data() + at, sizeof count);
      for (at += sizeof count; count > 0; --count, at += sizeof count) {
        std::int32_t index = 0;
        std::memcpy(&index, faceBytes_.data() + at, sizeof index);
        low = glm::min(low, places_[static_cast<std::size_t>(index)]), high = glm::max(high, places_[static_cast<std::size_t>(index)]);
      }
    }
    out_.origin = farOrigin(low, high);
    out_.placesAreBytes = !ascii_;
    const std::size_t more = (hasNormals_ ? 3 : 0) + (hasUv_ ? 2 : 0);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const glm::vec3 p(places_[i] - out_.origin);
      append(out, &p.x, 3);
      append(out, attributes_.data() + i * more, more);
    }
    out += faceBytes_;
  }

  std::string file_;
  std::string_view bytes_;
  TextCursor in_;
  std::size_t at_ = 0;
  bool ascii_ = false, swap_ = false, hasNormals_ = false, hasUv_ = false;
  long long vertexCount_ = 0, faceCount_ = 0, triangles_ = 0;
  std::vector<Element> elements_;
  std::vector<glm::dvec3> places_;  ///< of vertices
  std::vector<float> attributes_;   ///< their normals and texture coordinates
  std::string faceBytes_;
  CheckedFile out_;
};

}  // namespace

CheckedFile checkPly(const std::string& file, std::string_view bytes) { return PlyCheck(file, bytes).run(); }

}  // namespace pitviper
