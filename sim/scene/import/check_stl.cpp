// STL, binary and ASCII. The canonical copy is binary, without normals and with a header that cannot pass for ASCII.
#include <bit>
#include <cmath>
#include <cstring>

#include "sim/scene/import/checks.hpp"
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

CheckedFile checkBinary(const std::string& file, std::string_view bytes, std::uint32_t count) {
  if (count == 0) failAtByte(file, 80, "the file has no triangles");
  if (count > kMostImportedTriangles)
    failAtByte(file, 80, "the file has " + std::to_string(count) + " triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh");
  CheckedFile out{emptyStl(), {}, {}, {}};
  out.bytes.append(bytes.substr(kHeader, count * kRecord));
  for (std::size_t at = kHeader; at < out.bytes.size(); at += kRecord) {
    float numbers[12] = {};
    std::memcpy(numbers + 3, out.bytes.data() + at + 12, 36);
    for (std::size_t k = 3; k < 12; ++k)
      if (!std::isfinite(numbers[k])) failAtByte(file, at + 4 * k, "a coordinate is not finite", "a finite number");
    std::memcpy(out.bytes.data() + at, numbers, 48);
  }
  setCount(out.bytes);
  return out;
}

CheckedFile checkAscii(const std::string& file, std::string_view text) {
  CheckedFile out{emptyStl(), {}, {}, {}};
  TextCursor in(file, text);
  const auto expect = [&](std::string_view keyword) {
    const std::string_view word = in.word();
    if (word != keyword)
      in.fail(word.empty() ? "the file ends here" : "'" + TextCursor::shown(word) + "' is not possible here", "'" + std::string(keyword) + "'");
  };
  expect("solid");
  in.skipLine();
  for (std::string_view word = in.word(); !word.empty(); word = in.word()) {
    if (word == "endsolid" || word == "solid") {  // several solids may follow one another
      in.skipLine();
      continue;
    }
    if (word != "facet") in.fail("'" + TextCursor::shown(word) + "' is not possible here", "'facet' or 'endsolid'");
    float numbers[12] = {};
    expect("normal");
    for (int k = 0; k < 3; ++k) in.word();  // often missing the mark; not used
    expect("outer");
    expect("loop");
    for (int k = 3; k < 12; ++k) {
      if (k % 3 == 0) expect("vertex");
      numbers[k] = in.number(in.word());
    }
    expect("endloop");
    expect("endfacet");
    char record[kRecord] = {};
    std::memcpy(record, numbers, 48);
    out.bytes.append(record, kRecord);
    if (out.bytes.size() > kHeader + kRecord * kMostImportedTriangles)
      in.fail("the file has too many triangles", "at most " + std::to_string(kMostImportedTriangles), "simplify the mesh");
  }
  if (out.bytes.size() == kHeader) in.fail("the file has no triangles");
  setCount(out.bytes);
  return out;
}

}  // namespace

CheckedFile checkStl(const std::string& file, std::string_view bytes) {
  std::uint32_t count = 0;
  if (bytes.size() >= kHeader) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::uint64_t needed = kHeader + std::uint64_t{count} * kRecord;
  if (bytes.size() >= kHeader && bytes.size() == needed) return checkBinary(file, bytes, count);
  // Binary headers may start with "solid" too, but a count below 2^24 has a zero byte.
  if (bytes.starts_with("solid") && bytes.substr(0, kHeader).find('\0') == bytes.npos) return checkAscii(file, bytes);
  if (bytes.size() < kHeader) failAtByte(file, bytes.size(), "the file ends within its header", "84 bytes or more");
  if (bytes.size() < needed)
    failAtByte(file, 80, std::to_string(count) + " triangles need " + std::to_string(needed) + " bytes",
               "a file of that size; it has " + std::to_string(bytes.size()) + " bytes");
  return checkBinary(file, bytes, count);
}

}  // namespace pitviper
