#pragma once
// EXR files of any windows, in scan lines or tiles, byte by byte: what other programs write and this one does not.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <string>

namespace pitviper::test {

struct ExrWindow {
  int left, top, right, bottom;  ///< the last column and row included
};

/// Single precision, uncompressed, channels in the order of their names; `value`: of a channel at a place of the data window. `tile`: side of the tiles, 0 for
/// scan lines. Source: OpenEXR file layout, https://openexr.com/en/latest/OpenEXRFileLayout.html
inline std::string exrBytes(const ExrWindow& data, const ExrWindow& display, const std::string& channels,
                            const std::function<float(char channel, int x, int y)>& value, int tile = 0) {
  std::string out;
  const auto put32 = [](std::string& to, std::int64_t v) {
    for (int i = 0; i < 4; ++i) to += static_cast<char>(static_cast<std::uint32_t>(v) >> (8 * i) & 0xff);
  };
  const auto putFloat = [&](std::string& to, float v) { to.append(reinterpret_cast<const char*>(&v), 4); };
  const auto attribute = [&](const char* name, const char* type, const std::string& bytes) {
    out += std::string(name) + '\0' + type + '\0';
    put32(out, static_cast<std::int64_t>(bytes.size()));
    out += bytes;
  };
  const auto box = [&](const ExrWindow& w) {
    std::string bytes;
    for (int v : {w.left, w.top, w.right, w.bottom}) put32(bytes, v);
    return bytes;
  };
  put32(out, 20000630);
  put32(out, tile ? 0x202 : 2);
  std::string list, one, none(8, '\0');
  for (char c : channels) {
    list += std::string(1, c) + '\0';
    put32(list, 2), put32(list, 0), put32(list, 1), put32(list, 1);
  }
  putFloat(one, 1.0f);
  attribute("channels", "chlist", list + '\0');
  attribute("compression", "compression", std::string(1, '\0'));
  attribute("dataWindow", "box2i", box(data));
  attribute("displayWindow", "box2i", box(display));
  attribute("lineOrder", "lineOrder", std::string(1, '\0'));
  attribute("pixelAspectRatio", "float", one);
  attribute("screenWindowCenter", "v2f", none);
  attribute("screenWindowWidth", "float", one);
  if (tile) {
    std::string sizes;
    put32(sizes, tile), put32(sizes, tile);
    attribute("tiles", "tiledesc", sizes + '\0');
  }
  out += '\0';
  std::string chunks, offsets;
  const int width = data.right - data.left + 1, height = data.bottom - data.top + 1;
  const int across = tile ? (width + tile - 1) / tile : 1, down = tile ? (height + tile - 1) / tile : height;
  const std::size_t first = out.size() + 8 * static_cast<std::size_t>(across * down);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      put32(offsets, static_cast<std::int64_t>(first + chunks.size())), put32(offsets, 0);
      const int side = tile ? tile : 1, x0 = data.left + i * side, x1 = tile ? std::min(x0 + side - 1, data.right) : data.right;
      const int y0 = data.top + j * side, y1 = std::min(y0 + side - 1, data.bottom);
      std::string pixels;
      for (int y = y0; y <= y1; ++y)
        for (char c : channels)
          for (int x = tile ? x0 : data.left; x <= x1; ++x) putFloat(pixels, value(c, x, y));
      if (tile) put32(chunks, i), put32(chunks, j), put32(chunks, 0), put32(chunks, 0);
      else put32(chunks, y0);
      put32(chunks, static_cast<std::int64_t>(pixels.size()));
      chunks += pixels;
    }
  return out + offsets + chunks;
}

}  // namespace pitviper::test
