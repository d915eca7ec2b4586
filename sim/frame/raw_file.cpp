// Frames as bare bytes behind a short header, for programs that have no library for anything else. All little-endian:
//   offset 0: "PITVRAW1"; 8: uint32 bytes of the whole header, a multiple of 64; 12: uint32 width; 16: uint32 height; 20: uint32 number of layers; 24: uint64
//   0; 32: JSON (frame_json.hpp) with the layers' names, units and types in their order, filled up with spaces.
// After the header the layers one after another, row by row from the top: "uint16" (counts) or "float32".
#include <bit>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/frame_json.hpp"
#include "sim/image/whole_values.hpp"

namespace pitviper {
namespace {

static_assert(std::endian::native == std::endian::little);

template <class T>
void append(std::string& bytes, const std::vector<T>& values) {
  bytes.append(reinterpret_cast<const char*>(values.data()), sizeof(T) * values.size());
}

}  // namespace

void writeRawFile(const std::filesystem::path& file, const Frame& frame, const FileOptions& options) {
  constexpr std::size_t kFixed = 32, kMultiple = 64;
  std::vector<LayerCode> codes;
  for (const FrameLayer& l : frame.layers) codes.push_back({l.name, "", isCounts(l) ? "uint16" : "float32"});
  std::string json = frameJson(frame, codes);
  json.resize((kFixed + json.size() + kMultiple - 1) / kMultiple * kMultiple - kFixed, ' ');
  std::string bytes = "PITVRAW1";
  append(bytes, std::vector<std::uint32_t>{static_cast<std::uint32_t>(kFixed + json.size()), static_cast<std::uint32_t>(frame.width),
                                           static_cast<std::uint32_t>(frame.height), static_cast<std::uint32_t>(frame.layers.size()), 0, 0});
  bytes += json;
  for (const FrameLayer& l : frame.layers) {
    if (isCounts(l)) append(bytes, wholeValues(l.pixels));
    else append(bytes, l.pixels);
  }
  writeFileAtomically(file, bytes, options.mayReplace);
}

}  // namespace pitviper
