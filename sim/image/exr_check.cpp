#include "sim/image/exr_check.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "sim/image/exr_names.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper::exr {
namespace {

// OpenEXR file layout: https://openexr.com/en/latest/OpenEXRFileLayout.html
constexpr std::uint32_t magic = 20000630;
constexpr std::uint32_t longNamesFlag = 0x400, tiledFlag = 0x200;
constexpr std::uint32_t formatVersion = 2;

// No compression of EXR packs tighter than deflate on constant data, 1032 to 1 (zlib, "Maximum Compression Factor"), except PIZ and DWA on
// constant images; up to the free size nothing is compared.
constexpr std::uint64_t maxCompressionFactor = 1100;
constexpr std::uint64_t freePixelBytes = std::uint64_t{256} << 20;

/// Size in the file of the attribute types that OpenEXR may parse; -1: any size.
struct KnownType {
  std::string_view name;
  std::int64_t size;
};
constexpr std::array<KnownType, 15> knownTypes = {{{"box2i", 16},
                                                   {"chlist", -1},
                                                   {"compression", 1},
                                                   {"double", 8},
                                                   {"float", 4},
                                                   {"floatvector", -1},
                                                   {"int", 4},
                                                   {"lineOrder", 1},
                                                   {"m44f", 64},
                                                   {"rational", 8},
                                                   {"string", -1},
                                                   {"tiledesc", 9},
                                                   {"v2f", 8},
                                                   {"v3d", 24},
                                                   {"v3f", 12}}};

struct Window {
  std::int64_t left = 0, top = 0, width = 0, height = 0;
  bool meets(const Window& o) const { return left < o.left + o.width && o.left < left + width && top < o.top + o.height && o.top < top + height; }
};

class Walk {
 public:
  Walk(std::string& bytes, const std::string& file) : bytes_(bytes), file_(file), end_(bytes.size()) {}

  void run() {
    if (bytes_.size() < 8 || u32() != magic) fail("is not an EXR file", "the bytes 76 2f 31 01 at the start");
    const std::uint32_t version = u32();
    if ((version & 0xff) != formatVersion) fail("EXR version " + std::to_string(version & 0xff) + " is not known", "version 2");
    if ((version & ~(0xffu | longNamesFlag | tiledFlag)) != 0) fail("is deep or multi-part", "a single-part EXR in scan lines or tiles");
    while (attribute()) {
    }
    if (channels_ < 1 || data_.width < 1 || display_.width < 1) fail("the header lacks channels, dataWindow or displayWindow", "a complete EXR header");
    if (((version & tiledFlag) != 0) != (tileArea_ > 0)) fail("has tiles by its version or by its header, not by both; it is damaged");
    if (tileArea_ * bytesPerPixel_ > freePixelBytes) fail("has tiles of more than 256 MB", "smaller tiles");
    if (!data_.meets(display_)) fail("the data window and the display window have no pixel in common", "pixels within the display window");
    for (const Window* own : {&data_, &display_}) {
      const Window& w = *own;
      // What is placed is kept as floats, whatever it is in the file.
      const std::uint64_t bytesPerPixel = own == &data_ ? bytesPerPixel_ : 4 * static_cast<std::uint64_t>(channels_);
      const std::uint64_t pixelBytes = static_cast<std::uint64_t>(w.width) * static_cast<std::uint64_t>(w.height) * bytesPerPixel;
      if (pixelBytes > freePixelBytes && pixelBytes / maxCompressionFactor > bytes_.size())
        fail("is far too short for " + std::to_string(w.width) + " x " + std::to_string(w.height) + " pixels; it is truncated or damaged");
    }
  }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& expected = "") const {
    throw UserError(Location{.file = file_, .byte = static_cast<long long>(at_)}, wrong, expected.empty() ? "a whole EXR file" : expected,
                    expected.empty() ? "copy or render the file again" : "convert the file");
  }

  void need(std::size_t count) const {
    if (count > end_ - at_) fail("the EXR header ends early or is damaged");
  }

  std::uint32_t u32() {
    need(4);
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes_[at_ + static_cast<std::size_t>(i)]);
    at_ += 4;
    return value;
  }

  std::int64_t i32() { return static_cast<std::int32_t>(u32()); }

  std::string_view name() {
    const std::size_t limit = std::min(end_, at_ + maxNameBytes + 1);
    const std::size_t zero = bytes_.find('\0', at_);
    if (zero >= limit) fail("the EXR header ends early or is damaged");
    const std::string_view text(bytes_.data() + at_, zero - at_);
    at_ = zero + 1;
    return text;
  }

  bool attribute() {
    const std::string_view called = name();
    if (called.empty()) return false;
    const std::size_t typeAt = at_;
    const std::string_view type = name();
    if (type.empty()) fail("the EXR header is damaged");
    const std::int64_t size = i32();
    if (size < 0) fail("the EXR header is damaged");
    need(static_cast<std::size_t>(size));
    const std::size_t next = at_ + static_cast<std::size_t>(size);
    const auto known = std::find_if(knownTypes.begin(), knownTypes.end(), [&](const KnownType& k) { return k.name == type; });
    if (known == knownTypes.end()) {
      bytes_[typeAt] = '?';
    } else if (known->size >= 0 && known->size != size) {
      fail("attribute '" + std::string(called) + "' has a size other than its type; the file is damaged");
    } else if (type == "floatvector" && size % 4 != 0) {
      fail("attribute '" + std::string(called) + "' has a size other than its type; the file is damaged");
    } else if (called == "channels" && type == "chlist") {
      channelList(next);
    } else if (type == "chlist") {
      bytes_[typeAt] = '?';
    } else if (called == "dataWindow" && type == "box2i") {
      data_ = window("data");
    } else if (called == "displayWindow" && type == "box2i") {
      display_ = window("display");
    } else if (called == "tiles" && type == "tiledesc") {
      tiles();
    }
    at_ = next;
    return true;
  }

  void channelList(std::size_t next) {
    if (channels_ > 0) fail("has two channel lists; the file is damaged");  // the library would join them
    const std::size_t end = end_;
    end_ = next;
    std::string before;
    while (true) {
      const std::string called(name());
      if (called.empty()) break;
      // The writer sorts them; two of one name would be one channel to the library.
      if (channels_ > 0 && called == before) fail("two channels are named '" + called + "'");
      const std::uint32_t type = u32();  // 0 unsigned int, 1 half, 2 float
      need(4);
      at_ += 4;  // perceptual linearity
      const std::int64_t xSampling = i32(), ySampling = i32();
      if (type > 2) fail("channel '" + called + "' has an unknown pixel type; the file is damaged");
      if (xSampling != 1 || ySampling != 1) fail("channel '" + called + "' is subsampled", "channels of full size");
      bytesPerPixel_ += type == 1 ? 2 : 4;
      if (++channels_ > maxChannels) fail("has more than 1024 channels", "at most 1024 channels");
      before = called;
    }
    if (at_ != next) fail("the channel list is damaged");
    end_ = end;
  }

  void tiles() {
    const std::int64_t width = i32(), height = i32();
    if (width < 1 || height < 1 || width > maxSide || height > maxSide)
      fail("has tiles of " + std::to_string(width) + " x " + std::to_string(height) + " pixels", "1 to 32768 on a side");
    tileArea_ = static_cast<std::uint64_t>(width * height);
  }

  Window window(const std::string& which) {
    const std::int64_t x0 = i32(), y0 = i32(), x1 = i32(), y1 = i32();
    if (x1 < x0 || y1 < y0 || x1 - x0 >= maxSide || y1 - y0 >= maxSide)
      fail("the " + which + " window is " + std::to_string(x1 - x0 + 1) + " x " + std::to_string(y1 - y0 + 1) + " pixels", "1 to 32768 on a side");
    // Addresses are formed relative to the window's corner; nobody needs one farther out.
    constexpr std::int64_t farthest = std::int64_t{1} << 24;
    if (std::max(std::max(-x0, x0), std::max(-y0, y0)) > farthest) fail("the " + which + " window lies absurdly far out", "a corner within 2^24");
    return {x0, y0, x1 - x0 + 1, y1 - y0 + 1};
  }

  std::string& bytes_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t end_;
  int channels_ = 0;
  std::uint64_t bytesPerPixel_ = 0;
  std::uint64_t tileArea_ = 0;
  Window data_, display_;
};

}  // namespace

void checkHeader(std::string& bytes, const std::string& file) { Walk(bytes, file).run(); }

std::optional<std::string> textIn(std::string_view bytes, std::string_view attribute) {
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
    return value;
  };
  if (bytes.size() < 8 || word(0) != magic) return std::nullopt;
  for (std::size_t at = 8; at < bytes.size() && bytes[at] != 0;) {
    const std::size_t name = at, type = bytes.find('\0', name) + 1;
    const std::size_t size = type == 0 ? 0 : bytes.find('\0', type) + 1;
    if (size == 0 || size > bytes.size() || bytes.size() - size < 4) return std::nullopt;
    const std::size_t length = word(size), value = size + 4;
    if (length > bytes.size() - value) return std::nullopt;
    if (bytes.substr(name, type - 1 - name) == attribute && bytes.substr(type, size - 1 - type) == "string") return std::string(bytes.substr(value, length));
    at = value + length;
  }
  return std::nullopt;
}

}  // namespace pitviper::exr
