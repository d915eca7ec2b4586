#include "sim/image/png.hpp"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstddef>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/read_file.hpp"

namespace pitviper {
namespace {

constexpr png_uint_32 maxSide = 16384;
constexpr std::size_t maxGreyPixels = std::size_t{8192} * 4096;   // a small file can claim 16384 x 16384: over 1 GB as floats
constexpr std::size_t maxChunkBytes = std::size_t{16} << 20;      // of text, profiles and the like; pixels are not counted
constexpr std::uintmax_t maxFileBytes = std::uintmax_t{2} << 30;  // 16384 x 16384 of 16 bits, packed badly, has 0.5 GB
constexpr std::size_t maxDeflateFactor = 1032;                    // zlib, "Maximum Compression Factor"

// libpng leaves on an error by longjmp, which must not pass objects with destructors. So all objects live in Job, outside the functions
// that call setjmp, and those functions hold plain values only. Callbacks into C code may not throw either.
struct Job {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::string bytes;  // of the file
  std::size_t at = 0;
  std::array<char, 200> message = {};
  std::vector<png_byte> pixels;
  std::vector<png_bytep> rows;
  std::vector<png_text> texts;
  png_uint_32 width = 0, height = 0;
  int bits = 0, colour = 0;
};

[[noreturn]] void onError(png_structp png, png_const_charp message) {
  Job& job = *static_cast<Job*>(png_get_error_ptr(png));
  std::strncpy(job.message.data(), message, job.message.size() - 1);
  png_longjmp(png, 1);
}

void onWarning(png_structp, png_const_charp) {}  // harmless oddities of ancillary chunks

void onRead(png_structp png, png_bytep to, std::size_t count) {
  Job& job = *static_cast<Job*>(png_get_io_ptr(png));
  if (count > job.bytes.size() - job.at) png_error(png, "the file ends early");
  std::memcpy(to, job.bytes.data() + job.at, count);
  job.at += count;
}

void onWrite(png_structp png, png_bytep from, std::size_t count) {
  Job& job = *static_cast<Job*>(png_get_io_ptr(png));
  bool stored = true;
  try {
    job.bytes.append(reinterpret_cast<const char*>(from), count);
  } catch (...) {
    stored = false;
  }
  if (!stored) png_error(png, "out of memory");
}

void onFlush(png_structp) {}

void setRows(Job& job, std::size_t rowBytes) {
  job.rows.resize(job.height);
  for (std::size_t y = 0; y < job.rows.size(); ++y) job.rows[y] = job.pixels.data() + y * rowBytes;
}

class Reader {
 public:
  explicit Reader(const std::filesystem::path& path) : where_{.file = path.string()} {
    job_.bytes = readWholeFile(path, {.what = "a PNG file", .mostBytes = maxFileBytes, .fixLarge = "make a smaller picture"});
    job_.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &job_, onError, onWarning);
    if (job_.png != nullptr) job_.info = png_create_info_struct(job_.png);
    if (job_.info == nullptr) {
      release();
      throw std::bad_alloc();
    }
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { release(); }

  const Job& job() const { return job_; }
  const Location& where() const { return where_; }

  void header() {
    if (!readHeader(job_)) fail();
    if (job_.width > maxSide || job_.height > maxSide)
      throw UserError(where_, "the picture is " + std::to_string(job_.width) + " x " + std::to_string(job_.height) + " pixels", "at most 16384 on a side",
                      "make a smaller picture");
  }

  /// Grey codes, unpacked to 8 or 16 bits.
  void pixels() {
    std::size_t rowBytes = 0;
    if (!setTransforms(job_, rowBytes)) fail();
    const std::size_t total = rowBytes * job_.height;
    // Packed codes of 1 bit grow up to 8 times; beyond that the pixels cannot be in the file, and need no memory.
    if (total / (8 * maxDeflateFactor) > job_.bytes.size())
      throw UserError(where_, "is far too short for its pixels; it is truncated or damaged", "a whole PNG file", "copy the file again");
    if (std::size_t{job_.width} * job_.height > maxGreyPixels)
      throw UserError(where_, "the picture is " + std::to_string(job_.width) + " x " + std::to_string(job_.height) + " pixels",
                      "at most 33 million pixels in a texture, such as 8192 x 4096", "make a smaller picture");
    try {
      job_.pixels.resize(total);
      setRows(job_, rowBytes);
    } catch (const std::bad_alloc&) {
      throw UserError(where_, "the picture is too large for this machine's memory", "a smaller picture", "scale it down");
    }
    if (!readPixels(job_)) fail();
  }

 private:
  [[noreturn]] void fail() const {
    throw UserError(where_, std::string("cannot read the PNG picture: ") + job_.message.data(), "a whole PNG file", "copy or convert the file again");
  }

  void release() { png_destroy_read_struct(&job_.png, &job_.info, nullptr); }

  static bool readHeader(Job& job) {
    if (setjmp(png_jmpbuf(job.png)) != 0) return false;
    png_set_read_fn(job.png, &job, onRead);
    png_set_user_limits(job.png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);  // ours is checked after, with a clearer message
    png_set_chunk_malloc_max(job.png, maxChunkBytes);
    png_read_info(job.png, job.info);
    png_get_IHDR(job.png, job.info, &job.width, &job.height, &job.bits, &job.colour, nullptr, nullptr, nullptr);
    return true;
  }

  static bool setTransforms(Job& job, std::size_t& rowBytes) {
    if (setjmp(png_jmpbuf(job.png)) != 0) return false;
    if (job.bits < 8) png_set_expand_gray_1_2_4_to_8(job.png);
    png_set_interlace_handling(job.png);
    png_read_update_info(job.png, job.info);
    rowBytes = png_get_rowbytes(job.png, job.info);
    return true;
  }

  static bool readPixels(Job& job) {
    if (setjmp(png_jmpbuf(job.png)) != 0) return false;
    png_read_image(job.png, job.rows.data());
    png_read_end(job.png, nullptr);
    return true;
  }

  Location where_;
  Job job_;
};

bool encode(Job& job) {
  if (setjmp(png_jmpbuf(job.png)) != 0) return false;
  png_set_write_fn(job.png, &job, onWrite, onFlush);
  png_set_compression_level(job.png, 6);
  png_set_filter(job.png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
  png_set_IHDR(job.png, job.info, job.width, job.height, job.bits, job.colour, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (job.colour == PNG_COLOR_TYPE_RGB) png_set_sRGB(job.png, job.info, PNG_sRGB_INTENT_RELATIVE);
  if (!job.texts.empty()) png_set_text(job.png, job.info, job.texts.data(), static_cast<int>(job.texts.size()));
  png_write_info(job.png, job.info);
  png_write_image(job.png, job.rows.data());
  png_write_end(job.png, nullptr);
  return true;
}

void write(const std::filesystem::path& path, Job& job, std::size_t rowBytes, const std::map<std::string, std::string>& texts, const MayReplace& mayReplace) {
  for (const auto& [keyword, text] : texts) {
    png_text entry = {};
    entry.compression = PNG_TEXT_COMPRESSION_NONE;
    // The library takes one pointer type for reading and writing; it only reads from these.
    entry.key = const_cast<char*>(keyword.c_str());
    entry.text = const_cast<char*>(text.c_str());
    entry.text_length = text.size();
    job.texts.push_back(entry);
  }
  setRows(job, rowBytes);
  job.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &job, onError, onWarning);
  if (job.png != nullptr) job.info = png_create_info_struct(job.png);
  const bool whole = job.info != nullptr && encode(job);
  png_destroy_write_struct(&job.png, &job.info);
  if (!whole) throw OutputError(path, std::string("cannot encode the picture: ") + job.message.data(), 0, "free memory or make a smaller picture");
  writeFileAtomically(path, job.bytes, mayReplace);
}

/// Of a picture of `count` values, `each` of them a pixel.
Job jobOf(int width, int height, std::size_t count, std::size_t each, int bits, int colour) {
  const int limit = static_cast<int>(maxSide);
  if (width < 1 || height < 1 || width > limit || height > limit) throw std::invalid_argument("writePng: a side is not in 1..16384");
  if (count != each * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("writePng: values are not width * height");
  Job job;
  job.width = static_cast<png_uint_32>(width);
  job.height = static_cast<png_uint_32>(height);
  job.bits = bits;
  job.colour = colour;
  return job;
}

}  // namespace

void writePng(const std::filesystem::path& path, const Rgb8Image& picture, const std::map<std::string, std::string>& texts, const MayReplace& mayReplace) {
  Job job = jobOf(picture.width, picture.height, picture.rgb.size(), 3, 8, PNG_COLOR_TYPE_RGB);
  job.pixels = picture.rgb;
  write(path, job, 3 * static_cast<std::size_t>(picture.width), texts, mayReplace);
}

void writePngGrey(const std::filesystem::path& path, int width, int height, const std::vector<std::uint16_t>& codes,
                  const std::map<std::string, std::string>& texts, const MayReplace& mayReplace) {
  Job job = jobOf(width, height, codes.size(), 1, 16, PNG_COLOR_TYPE_GRAY);
  for (const std::uint16_t code : codes) {  // big-endian
    job.pixels.push_back(static_cast<png_byte>(code >> 8));
    job.pixels.push_back(static_cast<png_byte>(code & 0xff));
  }
  write(path, job, 2 * static_cast<std::size_t>(width), texts, mayReplace);
}

std::optional<std::string> readPngText(const std::filesystem::path& path, std::string_view keyword) {
  constexpr std::size_t kFarthest = 1u << 16;  // what is written before the pixels has less than 1 kB
  std::string bytes;
  try {
    bytes = readFileStart(path, kFarthest);
  } catch (const UserError&) {
    return std::nullopt;
  }
  if (bytes.size() < 8 || png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) != 0) return std::nullopt;
  const std::string_view all = bytes;
  // A chunk: length (big-endian), type, content, checksum.
  for (std::size_t at = 8; at + 12 <= all.size();) {
    const std::size_t length = png_get_uint_32(reinterpret_cast<png_const_bytep>(bytes.data() + at));
    const std::string_view type = all.substr(at + 4, 4);
    if (type == "IDAT" || length > all.size() - at - 12) return std::nullopt;
    const std::string_view content = all.substr(at + 8, length);
    if (type == "tEXt" && content.size() > keyword.size() && content.starts_with(keyword) && content[keyword.size()] == '\0')
      return std::string(content.substr(keyword.size() + 1));
    at += 12 + length;
  }
  return std::nullopt;
}

GreyImage readPngGrey(const std::filesystem::path& path) {
  Reader reader(path);
  reader.header();
  const Job& job = reader.job();
  if (job.colour != PNG_COLOR_TYPE_GRAY)
    throw UserError(reader.where(), "the picture has colour, a palette or alpha", "a grey PNG of 8 or 16 bits",
                    "convert it, for example: convert in.png -alpha off -colorspace Gray out.png");
  reader.pixels();
  GreyImage image;
  image.width = static_cast<int>(job.width);
  image.height = static_cast<int>(job.height);
  image.bits = job.bits;
  image.pixels.resize(static_cast<std::size_t>(job.width) * job.height);
  if (job.bits == 16) {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(job.pixels[2 * i] << 8 | job.pixels[2 * i + 1]) / 65535.0f;
  } else {
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = static_cast<float>(job.pixels[i]) / 255.0f;
  }
  return image;
}

}  // namespace pitviper
