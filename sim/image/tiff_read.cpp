// Reads TIFF files.
#include <tiffio.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <new>
#include <optional>

#include "sim/image/number_bytes.hpp"
#include "sim/image/tiff.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

struct TiffBytes {
  const std::string& bytes;
  std::uint64_t at = 0;
};

TiffBytes& tiffBytesOf(thandle_t handle) { return *static_cast<TiffBytes*>(handle); }

tmsize_t readTiffBytes(thandle_t handle, void* to, tmsize_t count) {
  TiffBytes& m = tiffBytesOf(handle);
  if (count <= 0 || m.at >= m.bytes.size()) return 0;
  const std::size_t size = std::min<std::size_t>(static_cast<std::size_t>(count), m.bytes.size() - m.at);
  std::memcpy(to, m.bytes.data() + m.at, size);
  m.at += size;
  return static_cast<tmsize_t>(size);
}

tmsize_t writeNoBytes(thandle_t, void*, tmsize_t) { return 0; }

toff_t seekTiffBytes(thandle_t handle, toff_t offset, int from) {
  TiffBytes& m = tiffBytesOf(handle);
  m.at = offset + (from == SEEK_CUR ? m.at : from == SEEK_END ? m.bytes.size() : 0);
  return m.at;
}

int closeTiffBytes(thandle_t) { return 0; }
toff_t sizeOfTiffBytes(thandle_t handle) { return tiffBytesOf(handle).bytes.size(); }

std::optional<NumberType> tiffNumberType(int bits, int format) {
  const bool whole = format == SAMPLEFORMAT_UINT || format == SAMPLEFORMAT_VOID, sign = format == SAMPLEFORMAT_INT, real = format == SAMPLEFORMAT_IEEEFP;
  if (bits == 8 && (whole || sign)) return whole ? NumberType::UInt8 : NumberType::Int8;
  if (bits == 16 && (whole || sign)) return whole ? NumberType::UInt16 : NumberType::Int16;
  if (bits == 32 && (whole || sign || real)) return real ? NumberType::Float32 : whole ? NumberType::UInt32 : NumberType::Int32;
  if (bits == 64 && (whole || sign || real)) return real ? NumberType::Float64 : whole ? NumberType::UInt64 : NumberType::Int64;
  return std::nullopt;
}

/// One reading of a file.
class TiffReader {
 public:
  TiffReader(const std::string& bytes, const std::string& file) : source_{bytes}, where_{.file = file} {}

  PictureFile all() {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(
        TIFFClientOpen("memory", "rmC", &source_, readTiffBytes, writeNoBytes, seekTiffBytes, closeTiffBytes, sizeOfTiffBytes, nullptr, nullptr), &TIFFClose);
    if (!tiff) fail("cannot read the TIFF header");
    tiff_ = tiff.get();
    for (std::size_t pages = 1;; ++pages) {
      if (pages > kMostPictures) throw UserError(where_, "the file has more than 1024 pages", "at most 1024 pages", "split the file");
      std::uint32_t subfile = 0;
      TIFFGetFieldDefaulted(tiff_, TIFFTAG_SUBFILETYPE, &subfile);
      if (!(subfile & FILETYPE_REDUCEDIMAGE) || (pages == 1 && TIFFLastDirectory(tiff_))) page();
      if (TIFFLastDirectory(tiff_)) break;
      if (!TIFFReadDirectory(tiff_)) fail("page " + std::to_string(pages + 1) + " cannot be read");
    }
    if (file_.pictures.empty()) fail("the file has no page but reduced copies");
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw UserError(where_, what, "a whole TIFF file", "copy or write the file again"); }
  [[noreturn]] void refuse(const std::string& what) const {
    throw UserError(where_, what, "one value a pixel: whole numbers of 8 to 64 bits, or floats of 32 or 64; no compression, LZW, deflate or PackBits",
                    "convert the file, for example: gdal_translate -ot Float32 in.tif out.tif");
  }

  template <class T>
  T field(ttag_t tag) const {
    T value{};
    TIFFGetFieldDefaulted(tiff_, tag, &value);
    return value;
  }
  std::string text(ttag_t tag) const {
    const char* value = nullptr;
    return TIFFGetField(tiff_, tag, &value) && value ? value : "";
  }

  void page() {
    const auto width = field<std::uint32_t>(TIFFTAG_IMAGEWIDTH), height = field<std::uint32_t>(TIFFTAG_IMAGELENGTH);
    if (width < 1 || height < 1 || width > kMostPictureSide || height > kMostPictureSide)
      throw UserError(where_, print("a page is %u x %u pixels", width, height), "1 to 32768 on a side", "cut the picture");
    if (!file_.pictures.empty() && (static_cast<int>(width) != file_.width || static_cast<int>(height) != file_.height))
      throw UserError(where_, print("pages are %d x %d and %u x %u pixels", file_.width, file_.height, width, height), "pages of one size",
                      "split the file, for example with tiffsplit");
    if (const int samples = field<std::uint16_t>(TIFFTAG_SAMPLESPERPIXEL); samples != 1) refuse(print("a pixel has %d values", samples));
    const int bits = field<std::uint16_t>(TIFFTAG_BITSPERSAMPLE), format = field<std::uint16_t>(TIFFTAG_SAMPLEFORMAT);
    const auto type = tiffNumberType(bits, format);
    if (!type)
      refuse(format == SAMPLEFORMAT_IEEEFP ? print("values are floats of %d bits", bits) : print("values have %d bits, sample format %d", bits, format));
    std::uint16_t meaning = PHOTOMETRIC_MINISBLACK;
    TIFFGetField(tiff_, TIFFTAG_PHOTOMETRIC, &meaning);
    if (meaning == PHOTOMETRIC_PALETTE) refuse("values are places in a palette");
    const int compression = field<std::uint16_t>(TIFFTAG_COMPRESSION);
    const bool packed = compression != COMPRESSION_NONE;
    if (packed && compression != COMPRESSION_LZW && compression != COMPRESSION_ADOBE_DEFLATE && compression != COMPRESSION_DEFLATE &&
        compression != COMPRESSION_PACKBITS)
      refuse(print("compression %d is none that is read here", compression));
    file_.width = static_cast<int>(width), file_.height = static_cast<int>(height);
    const std::string description = text(TIFFTAG_IMAGEDESCRIPTION), name = text(TIFFTAG_PAGENAME);
    ReadPicture picture = namedWithUnit(description);
    if (!name.empty()) picture.name = name;
    picture.pixels = pixels(*type, packed);
    file_.pictures.push_back(std::move(picture));
  }

  std::vector<float> pixels(NumberType type, bool packed) {
    const auto width = static_cast<std::uint64_t>(file_.width), height = static_cast<std::uint64_t>(file_.height);
    const bool tiled = TIFFIsTiled(tiff_);
    // A strip is a tile as wide as the page, cut off at its end.
    std::uint64_t across = width, down = std::min<std::uint64_t>(field<std::uint32_t>(TIFFTAG_ROWSPERSTRIP), height);
    if (tiled) across = field<std::uint32_t>(TIFFTAG_TILEWIDTH), down = field<std::uint32_t>(TIFFTAG_TILELENGTH);
    constexpr std::uint64_t kMostTileSide = 65536;
    if (across < 1 || down < 1 || across > kMostTileSide || down > kMostTileSide) fail("a page has strips or tiles of no size");
    const std::uint64_t columns = (width + across - 1) / across, rows = (height + down - 1) / down;
    const std::uint64_t size = bytesOf(type);
    needed_ += size * (tiled ? columns * rows * across * down : width * height);
    // Deflate packs at most 1032 to 1 (zlib, "Maximum Compression Factor"), the others less. Pages that share bytes count each.
    constexpr std::uint64_t kMostFactor = 1032;
    if (needed_ / (packed ? kMostFactor : 1) > source_.bytes.size()) fail("the file is far too short for its pixels; it is truncated or damaged");
    std::vector<char> some(static_cast<std::size_t>(size * across * down));
    std::vector<float> values(static_cast<std::size_t>(width * height));
    for (std::uint64_t r = 0; r < rows; ++r)
      for (std::uint64_t c = 0; c < columns; ++c) {
        const std::uint64_t tall = std::min(down, height - r * down), wide = std::min(across, width - c * across);
        const auto index = static_cast<std::uint32_t>(r * columns + c);
        const auto wanted = static_cast<tmsize_t>(size * across * (tiled ? down : tall));
        const tmsize_t got = tiled ? TIFFReadEncodedTile(tiff_, index, some.data(), wanted) : TIFFReadEncodedStrip(tiff_, index, some.data(), wanted);
        if (got != wanted) fail("pixels are missing or damaged");
        for (std::uint64_t y = 0; y < tall; ++y) {
          float* to = values.data() + (r * down + y) * width + c * across;
          eachNumber(type, some.data() + size * across * y, static_cast<std::size_t>(wide), std::endian::native == std::endian::big,
                     [&](std::size_t i, auto value) { to[i] = static_cast<float>(value); });
        }
      }
    return values;
  }

  TiffBytes source_;
  Location where_;
  TIFF* tiff_ = nullptr;
  PictureFile file_;
  std::uint64_t needed_ = 0;  ///< bytes of pixels so far, unpacked
};

}  // namespace

PictureFile readTiff(const std::filesystem::path& path) {
  const std::string bytes = readWholeFile(path, {.what = "a TIFF file"});
  try {
    return TiffReader(bytes, path.string()).all();
  } catch (const std::bad_alloc&) {
    throw UserError({.file = path.string()}, "the picture is too large for this machine's memory", "a smaller picture", "use a machine with more memory");
  }
}

}  // namespace pitviper
