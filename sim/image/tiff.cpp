#include "sim/image/tiff.hpp"

#include <tiffio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "sim/image/whole_values.hpp"

namespace pitviper {
namespace {

/// A file in memory: a full disk then shows in our own checked write, not inside the library.
struct Memory {
  std::string bytes;
  std::size_t at = 0;
};

Memory& memoryOf(thandle_t handle) { return *static_cast<Memory*>(handle); }

tmsize_t readBytes(thandle_t handle, void* to, tmsize_t count) {
  Memory& m = memoryOf(handle);
  const std::size_t size = std::min(static_cast<std::size_t>(count), m.bytes.size() - std::min(m.at, m.bytes.size()));
  std::memcpy(to, m.bytes.data() + m.at, size);
  m.at += size;
  return static_cast<tmsize_t>(size);
}

tmsize_t writeBytes(thandle_t handle, void* from, tmsize_t count) {
  Memory& m = memoryOf(handle);
  const auto size = static_cast<std::size_t>(count);
  try {
    if (m.at + size > m.bytes.size()) m.bytes.resize(m.at + size);
  } catch (const std::bad_alloc&) {
    return 0;
  }
  std::memcpy(m.bytes.data() + m.at, from, size);
  m.at += size;
  return count;
}

toff_t seek(thandle_t handle, toff_t offset, int from) {
  Memory& m = memoryOf(handle);
  m.at = static_cast<std::size_t>(offset) + (from == SEEK_CUR ? m.at : from == SEEK_END ? m.bytes.size() : 0);
  return m.at;
}

int closeNothing(thandle_t) { return 0; }
toff_t sizeOf(thandle_t handle) { return memoryOf(handle).bytes.size(); }

using Tiff = std::unique_ptr<TIFF, decltype(&TIFFClose)>;

bool writePage(TIFF* tiff, std::uint32_t width, std::uint32_t height, const TiffPage& page) {
  const std::uint16_t bits = page.isWhole ? 16 : 32;
  bool good = TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width) && TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height) &&
              TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1) && TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits) &&
              TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, page.isWhole ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP) &&
              TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK) && TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG) &&
              TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE) && TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height) &&
              TIFFSetField(tiff, TIFFTAG_PAGENAME, page.name.c_str()) && TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, page.description.c_str());
  if (!good) return false;
  if (page.isWhole) {
    std::vector<std::uint16_t> codes = wholeValues(page.pixels);
    good = TIFFWriteEncodedStrip(tiff, 0, codes.data(), static_cast<tmsize_t>(2 * codes.size())) >= 0;
  } else {
    std::vector<float> values = page.pixels;
    good = TIFFWriteEncodedStrip(tiff, 0, values.data(), static_cast<tmsize_t>(4 * values.size())) >= 0;
  }
  return good && TIFFWriteDirectory(tiff);
}

}  // namespace

void writeTiff(const std::filesystem::path& path, int width, int height, const std::vector<TiffPage>& pages, const MayReplace& mayReplace) {
  const bool wrong = std::any_of(pages.begin(), pages.end(), [&](const TiffPage& p) {
    return p.pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  });
  if (pages.empty() || wrong) throw std::invalid_argument("writeTiff: no pages, or one that is not width * height");
  Memory memory;
  {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    // "l": the same bytes on every machine.
    const Tiff tiff(TIFFClientOpen("memory", "wl", &memory, readBytes, writeBytes, seek, closeNothing, sizeOf, nullptr, nullptr), &TIFFClose);
    bool good = tiff != nullptr;
    for (const TiffPage& page : pages) good = good && writePage(tiff.get(), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), page);
    if (!good) throw OutputError(path, "cannot encode the TIFF file", 0, "free memory, or write fewer layers");
  }
  writeFileAtomically(path, memory.bytes, mayReplace);
}

}  // namespace pitviper
