// STL, binary and ASCII. The canonical copy is binary, without normals and with a header that cannot pass for ASCII.
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>

#include "sim/scene/import/checks.hpp"
#include "sim/scene/import/far_origin.hpp"
#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/import/text_cursor.hpp"

namespace pitviper {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian and copied as it is");

constexpr std::size_t kHeader = 84, kRecord = 50;  // 80 bytes and a count; a normal, three vertices, two bytes

std::string emptyStl() { return std::string(kHeader, '\0'); }

void setCount(std::string& stl) {
  const auto count = static_cast<std::uint32_t>((stl.size() - kHeader) / kRecord);
  std::memcpy(stl.data() + 80, &count, sizeof count);
}

/// The numbers of a record: a normal, which is often missing the mark and not used, and three vertices.
constexpr std::size_t kNumbers = 12;

void putRecord(char* record, const std::array<glm::dvec3, 3>& vertices) {
  float numbers[kNumbers] = {};
  for (std::size_t k = 0; k < 9; ++k) numbers[3 + k] = static_cast<float>(vertices[k / 3][static_cast<int>(k % 3)]);
  std::memcpy(record, numbers, sizeof numbers);
}

CheckedFile checkBinary(const std::string& file, std::string_view bytes, std::uint32_t count) {
  if (count == 0) failAtByte(file, 80, "the file has no triangles");
  if (count > kMostImportedTriangles)
    failAtByte(file, 80, "the file has " + std::to_string(count) + " triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh");
  CheckedFile out;
  out.bytes = emptyStl();
  out.bytes.append(bytes.substr(kHeader, count * kRecord));
  const auto verticesAt = [&](std::size_t at) {
    float numbers[kNumbers];
    std::memcpy(numbers, out.bytes.data() + at, sizeof numbers);
    std::array<glm::dvec3, 3> vertices;
    for (std::size_t k = 3; k < kNumbers; ++k) {
      if (!std::isfinite(numbers[k])) failAtByte(file, at + 4 * k, "a coordinate is not finite", "a finite number");
      vertices[k / 3 - 1][static_cast<int>(k % 3)] = static_cast<double>(numbers[k]);
    }
    return vertices;
  };
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (std::size_t at = kHeader; at < out.bytes.size(); at += kRecord)
    for (const glm::dvec3& p : verticesAt(at)) low = glm::min(low, p), high = glm::max(high, p);
  out.origin = farOrigin(low, high);
  for (std::size_t at = kHeader; at < out.bytes.size(); at += kRecord) {
    auto vertices = verticesAt(at);
    for (glm::dvec3& p : vertices) p -= out.origin;
    putRecord(out.bytes.data() + at, vertices);
  }
  setCount(out.bytes);
  return out;
}

/// Letters of keywords as lower ones: some programs write them large.
std::string lower(std::string_view word) {
  std::string out(word.substr(0, 16));
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

CheckedFile checkAscii(const std::string& file, std::string_view text) {
  std::vector<std::array<glm::dvec3, 3>> triangles;
  glm::dvec3 low(INFINITY), high(-INFINITY);
  TextCursor in(file, text);
  const auto expect = [&](std::string_view keyword) {
    const std::string_view word = in.word();
    if (lower(word) != keyword)
      in.fail(word.empty() ? "the file ends here" : "'" + TextCursor::shown(word) + "' is not possible here", "'" + std::string(keyword) + "'");
  };
  expect("solid");
  in.skipLine();
  for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
    const std::string keyword = lower(word);
    if (keyword == "endsolid" || keyword == "solid") {  // several solids may follow one another
      in.skipLine();
      continue;
    }
    if (keyword != "facet") in.fail("'" + TextCursor::shown(word) + "' is not possible here", "'facet' or 'endsolid'");
    if (triangles.size() == kMostImportedTriangles)
      in.fail("the file has too many triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh");
    expect("normal");
    for (int k = 0; k < 3; ++k) in.word();
    expect("outer");
    expect("loop");
    for (glm::dvec3& p : triangles.emplace_back()) {
      expect("vertex");
      for (int k = 0; k < 3; ++k) p[k] = in.number(in.word());
      low = glm::min(low, p), high = glm::max(high, p);
    }
    expect("endloop");
    expect("endfacet");
  }
  if (triangles.empty()) in.fail("the file has no triangles");
  CheckedFile out;
  out.origin = farOrigin(low, high);
  out.bytes = emptyStl();
  out.bytes.resize(kHeader + kRecord * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (glm::dvec3& p : triangles[t]) p -= out.origin;
    putRecord(out.bytes.data() + kHeader + kRecord * t, triangles[t]);
  }
  setCount(out.bytes);
  return out;
}

/// Whether what is no binary file of its size is meant as text: by its first word, or by a facet near its begin. Binary headers may start with "solid" too,
/// but a count below 2^24 has a zero byte.
bool isText(std::string_view text) {
  if (text.substr(0, kHeader).find('\0') != text.npos) return false;
  const std::size_t first = text.find_first_not_of(" \t\r\n\v\f");
  if (first == text.npos) return false;
  constexpr std::size_t kNear = 1000;
  std::string begin(text.substr(first, kNear));
  for (char& c : begin) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return begin.starts_with("solid") || begin.find("facet") != begin.npos;
}

}  // namespace

CheckedFile checkStl(const std::string& file, std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::uint64_t needed = kHeader + std::uint64_t{count} * kRecord;
  if (bytes.size() >= kHeader && bytes.size() == needed) return checkBinary(file, bytes, count);
  if (isText(bytes)) return checkAscii(file, bytes);
  if (bytes.starts_with("\xff\xfe") || bytes.starts_with("\xfe\xff")) failAtByte(file, 0, "the text is in UTF-16", "ASCII or UTF-8", "save it as UTF-8");
  if (bytes.size() < kHeader) failAtByte(file, bytes.size(), "the file ends within its header", "84 bytes or more");
  if (bytes.size() < needed)
    failAtByte(file, 80, std::to_string(count) + " triangles need " + std::to_string(needed) + " bytes",
               "a file of that size; it has " + std::to_string(bytes.size()) + " bytes");
  return checkBinary(file, bytes, count);
}

}  // namespace pitviper
