// Frames read back as they were written, and files that are damaged.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tiffio.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "sim/frame/file_formats.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

class ReadFrame : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("pitviper_read_frame_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void put(const std::string& name, const std::string& bytes) const { std::ofstream(folder_ / name, std::ios::binary) << bytes; }
  std::string bytesAt(const fs::path& file) const {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }
  std::string messageOf(const std::string& name) const {
    try {
      readFrame(folder_ / name);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  }

  fs::path folder_;
};

Frame sampleFrame() {
  Frame frame;
  frame.camera = "seeker", frame.number = 12, frame.time_s = 0.4;
  frame.width = 5, frame.height = 3;
  FrameLayer radiance{"mw.radiance", "W/(m2 sr)", {}}, counts{"mw.counts", "count", {}}, range{"truth.range", "m", {}};
  for (int p = 0; p < 15; ++p) {
    radiance.pixels.push_back(1.0f / static_cast<float>(p + 3));
    counts.pixels.push_back(static_cast<float>(p * 4681));
    range.pixels.push_back(p % 4 ? 1000.1f * static_cast<float>(p) : NAN);
  }
  radiance.pixels[7] = -0.0f, radiance.pixels[8] = std::numeric_limits<float>::denorm_min(), radiance.pixels[9] = INFINITY;
  frame.layers = {radiance, counts, range};
  frame.attributes = {{"pitviper.camera", frame.camera},
                      {"pitviper.frame", frame.number},
                      {"pitviper.time_s", frame.time_s},
                      {"pitviper.exposure_s", 0.002},
                      {"target.jet.place", std::vector<double>{1.5, 2.25, -3.0}}};
  for (const FrameLayer& l : frame.layers) frame.attributes.push_back({"unit." + l.name, l.unit});
  return frame;
}

const FrameLayer* layerOf(const Frame& frame, const std::string& name) {
  for (const FrameLayer& l : frame.layers)
    if (l.name == name) return &l;
  return nullptr;
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](float x, float y) {
           return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y) || (std::isnan(x) && std::isnan(y));
         });
}

/// The most memory that this process had so far [kB].
long peakMemory_kB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

/// A frame or a UserError; anything else fails the test.
void expectFrameOrUserError(const fs::path& file, const std::string& what) {
  try {
    const Frame frame = readFrame(file);
    for (const FrameLayer& l : frame.layers) ASSERT_EQ(l.pixels.size(), static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height)) << what;
  } catch (const UserError&) {
  } catch (const std::exception& e) {
    FAIL() << what << ": " << e.what();
  }
}

std::string enviHeader(const std::string& rest) { return "ENVI\nsamples = 2\nlines = 2\nbands = 2\n" + rest; }

/// A header of cards, filled up to a block.
std::string fitsHeader(const std::vector<std::string>& cards) {
  std::string text;
  for (std::string card : cards) {
    card.resize(80, ' ');
    text += card;
  }
  std::string end = "END";
  end.resize(80, ' ');
  text += end;
  text.resize((text.size() + 2879) / 2880 * 2880, ' ');
  return text;
}

}  // namespace

TEST_F(ReadFrame, WhatEveryFormatWritesComesBack) {
  const Frame frame = sampleFrame();
  for (const FileFormat& format : fileFormats()) {
    const fs::path file = folder_ / (format.name + "_00012" + format.extension);
    format.write(file, frame, {});
    const Frame back = readFrame(file);
    EXPECT_EQ(back.camera, "seeker") << format.name;
    EXPECT_EQ(back.number, 12) << format.name;
    EXPECT_DOUBLE_EQ(back.time_s, 0.4) << format.name;
    ASSERT_EQ(back.width, 5) << format.name;
    ASSERT_EQ(back.height, 3) << format.name;
    ASSERT_EQ(back.layers.size(), 3u) << format.name;
    EXPECT_EQ(back.layers.back().name, "truth.range") << format.name;
    for (const FrameLayer& l : frame.layers) {
      const FrameLayer* read = layerOf(back, l.name);
      ASSERT_TRUE(read) << format.name << " " << l.name;
      EXPECT_EQ(read->unit, l.unit) << format.name;
      if (format.name != "png" || l.unit == "count") {
        EXPECT_TRUE(sameBits(read->pixels, l.pixels)) << format.name << " " << l.name;
        continue;
      }
      float low = INFINITY, high = -INFINITY;
      for (float v : l.pixels)
        if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
      for (std::size_t p = 0; p < l.pixels.size(); ++p) {
        if (!std::isfinite(l.pixels[p])) EXPECT_TRUE(std::isnan(read->pixels[p])) << l.name;
        else EXPECT_NEAR(read->pixels[p], l.pixels[p], 0.51f * (high - low) / 65534.0f) << l.name;  // half a code, and rounding of floats
      }
    }
    bool hasExposure = false, hasPlace = false;
    for (const Attribute& a : back.attributes) hasPlace |= a.name == "target.jet.place" && numbersOf(a) == std::vector<double>{1.5, 2.25, -3.0};
    EXPECT_TRUE(hasPlace) << format.name;
    for (const Attribute& a : back.attributes) hasExposure |= a.name == "pitviper.exposure_s" && numbersOf(a) == std::vector<double>{0.002};
    EXPECT_TRUE(hasExposure) << format.name;
  }
}

TEST_F(ReadFrame, EnviOfEveryTypeInterleaveAndByteOrder) {
  // Bands {1 2; 3 4} and {5 6; 7 8}.
  const std::map<std::string, std::vector<int>> orders = {
      {"bsq", {1, 2, 3, 4, 5, 6, 7, 8}}, {"bil", {1, 2, 5, 6, 3, 4, 7, 8}}, {"bip", {1, 5, 2, 6, 3, 7, 4, 8}}};
  for (const int type : {1, 2, 3, 4, 5, 12, 13})
    for (const bool big : {false, true})
      for (const auto& [order, values] : orders) {
        std::string bytes = "skip";
        for (const int value : values) {
          std::string one;
          const auto add = [&](auto v) { one.assign(reinterpret_cast<const char*>(&v), sizeof v); };
          if (type == 1) add(static_cast<std::uint8_t>(value));
          else if (type == 2 || type == 12) add(static_cast<std::int16_t>(value));
          else if (type == 3 || type == 13) add(std::int32_t{value});
          else if (type == 4) add(static_cast<float>(value));
          else add(static_cast<double>(value));
          if (big) std::reverse(one.begin(), one.end());
          bytes += one;
        }
        put("cube.img", bytes);
        put("cube.hdr", enviHeader("header offset = 4\ndata type = " + std::to_string(type) + "\ninterleave = " + order +
                                   "\nbyte order = " + (big ? "1" : "0") + "\nband names = {first [K],\n second}\nwavelength = {3.5, 4.5}\n"));
        for (const char* name : {"cube.hdr", "cube.img"}) {
          const Frame frame = readFrame(folder_ / name);
          ASSERT_EQ(frame.layers.size(), 2u);
          EXPECT_EQ(frame.layers[0].name, "first");
          EXPECT_EQ(frame.layers[0].unit, "K");
          EXPECT_EQ(frame.layers[1].name, "second");
          EXPECT_EQ(frame.layers[0].pixels, (std::vector<float>{1, 2, 3, 4})) << type << order << big;
          EXPECT_EQ(frame.layers[1].pixels, (std::vector<float>{5, 6, 7, 8})) << type << order << big;
          ASSERT_EQ(frame.attributes.size(), 1u);
          EXPECT_EQ(numbersOf(frame.attributes[0]), (std::vector<double>{3.5, 4.5}));
        }
      }
  put("cube.hdr", enviHeader("data type = 6\n"));
  EXPECT_NE(messageOf("cube.hdr").find("data type 6"), std::string::npos);
  put("cube.hdr", enviHeader("data type = 5\nheader offset = 999999999999\n"));
  EXPECT_NE(messageOf("cube.hdr").find("too short"), std::string::npos);
}

TEST_F(ReadFrame, FitsScalesBlanksAndCubes) {
  // 2 x 2 x 2 of 16 bits, row 0 at the bottom: 1 2 3 -9 | 5 6 7 8.
  std::string data;
  for (const int v : {1, 2, 3, -9, 5, 6, 7, 8}) data += {static_cast<char>(v >> 8), static_cast<char>(v)};
  data.resize(2880, '\0');
  put("cube.fits",
      fitsHeader({"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    3", "NAXIS1  =                    2",
                  "NAXIS2  =                    2", "NAXIS3  =                    2", "BSCALE  =                0.5D0", "BZERO   =                 10.0",
                  "BLANK   =                   -9", "BUNIT   = 'K       '           / unit", "OBJECT  = 'it''s here'"}) +
          data);
  const Frame frame = readFrame(folder_ / "cube.fits");
  ASSERT_EQ(frame.layers.size(), 2u);
  EXPECT_EQ(frame.layers[0].name, "001");
  EXPECT_EQ(frame.layers[1].unit, "K");
  EXPECT_TRUE(sameBits(frame.layers[0].pixels, {11.5f, NAN, 10.5f, 11.0f}));
  EXPECT_EQ(frame.layers[1].pixels, (std::vector<float>{13.5f, 14.0f, 12.5f, 13.0f}));
  ASSERT_EQ(frame.attributes.size(), 1u);
  EXPECT_EQ(std::get<std::string>(frame.attributes[0].value), "it's here");
  put("huge.fits", fitsHeader({"SIMPLE  =                    T", "BITPIX  =                  -64", "NAXIS   =                    2",
                               "NAXIS1  =           1000000000", "NAXIS2  =           1000000000"}));
  EXPECT_NE(messageOf("huge.fits").find("ends before"), std::string::npos);
}

TEST_F(ReadFrame, TiffOfOtherProgramsInTilesOrPacked) {
  const auto write = [&](int bits, int format, bool tiled, int compression) {
    TIFF* tiff = TIFFOpen((folder_ / "other.tif").c_str(), "wb");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, 20), TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, 3), TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1), TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, format), TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK), TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    if (tiled) TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16), TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    else TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
    for (std::uint32_t part = 0; part < 2; ++part) {
      const std::size_t wide = tiled ? 16 : 20, high = tiled ? 16 : part ? 1 : 2;
      std::string bytes;
      for (std::size_t y = 0; y < high; ++y)
        for (std::size_t x = 0; x < wide; ++x) {
          const auto value = static_cast<double>(tiled ? x + 16 * part + 20 * y : x + 20 * (y + 2 * part)) - (format == SAMPLEFORMAT_UINT ? 0 : 30);
          const auto add = [&](auto v) { bytes.append(reinterpret_cast<const char*>(&v), sizeof v); };
          if (format == SAMPLEFORMAT_IEEEFP && bits == 64) add(value);
          else if (format == SAMPLEFORMAT_IEEEFP && bits == 32) add(static_cast<float>(value));
          else if (bits == 8) add(static_cast<std::int8_t>(value));
          else if (bits == 16) add(static_cast<std::int16_t>(value));
          else add(static_cast<std::int32_t>(value));
        }
      if (tiled) TIFFWriteEncodedTile(tiff, part, bytes.data(), static_cast<tmsize_t>(bytes.size()));
      else TIFFWriteEncodedStrip(tiff, part, bytes.data(), static_cast<tmsize_t>(bytes.size()));
    }
    TIFFClose(tiff);
  };
  const std::vector<std::pair<int, int>> types = {{8, SAMPLEFORMAT_UINT}, {8, SAMPLEFORMAT_INT},     {16, SAMPLEFORMAT_INT},   {32, SAMPLEFORMAT_UINT},
                                                  {32, SAMPLEFORMAT_INT}, {32, SAMPLEFORMAT_IEEEFP}, {64, SAMPLEFORMAT_IEEEFP}};
  for (const auto& [bits, format] : types)
    for (const bool tiled : {false, true})
      for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE}) {
        write(bits, format, tiled, compression);
        const Frame frame = readFrame(folder_ / "other.tif");
        ASSERT_EQ(frame.layers.size(), 1u);
        EXPECT_EQ(frame.layers[0].name, "layer_1");
        ASSERT_EQ(frame.layers[0].pixels.size(), 60u);
        for (std::size_t p = 0; p < 60; ++p)
          ASSERT_EQ(frame.layers[0].pixels[p], static_cast<float>(p) - (format == SAMPLEFORMAT_UINT ? 0.0f : 30.0f)) << bits << " " << format << " " << tiled;
      }
  write(16, SAMPLEFORMAT_IEEEFP, false, COMPRESSION_NONE);
  EXPECT_NE(messageOf("other.tif").find("floats of 16 bits"), std::string::npos);
}

TEST_F(ReadFrame, GreyPngAndStrangers) {
  writePngGrey(folder_ / "plain.png", 2, 1, {7, 65535});
  EXPECT_EQ(readFrame(folder_ / "plain.png").layers[0].pixels, (std::vector<float>{7.0f, 65535.0f}));
  put("text.txt", "hello");
  EXPECT_NE(messageOf("text.txt").find("no frame"), std::string::npos);
  EXPECT_FALSE(messageOf("absent.exr").empty());
  put("away.json", R"({"width": 1, "height": 1, "layers": [{"name": "a", "type": "uint16", "file": "../plain.png"}]})");
  EXPECT_NE(messageOf("away.json").find("beside this one"), std::string::npos);
}

TEST_F(ReadFrame, FolderInNaturalOrder) {
  const Frame frame = sampleFrame();
  for (const char* stem : {"a_10", "a_2", "a_1"}) fileFormat("raw").write(folder_ / (std::string(stem) + ".raw"), frame, {});
  fileFormat("tiff").write(folder_ / "a_2.tif", frame, {});
  fileFormat("png").write(folder_ / "b_3.json", frame, {});
  fileFormat("envi").write(folder_ / "b_1.hdr", frame, {});
  put("notes.json", "{}");
  put("c.raw", "no frame");
  writePng(folder_ / "colour.png", {1, 1, {1, 2, 3}});
  std::vector<std::string> names;
  for (const fs::path& f : framesIn(folder_)) names.push_back(f.filename().string());
  EXPECT_EQ(names, (std::vector<std::string>{"a_1.raw", "a_2.raw", "a_2.tif", "a_10.raw", "b_1.hdr", "b_3.json"}));
  EXPECT_EQ(framesIn(folder_ / "c.raw"), std::vector<fs::path>{folder_ / "c.raw"});
  EXPECT_THROW(framesIn(folder_ / "absent"), UserError);
}

TEST_F(ReadFrame, DifferenceOfTwo) {
  Frame a, b;
  a.width = b.width = 2, a.height = b.height = 2;
  a.layers = {{"x", "K", {100.0f, 0.0f, NAN, 4.0f}}};
  b.layers = {{"x", "K", {101.0f, 0.0f, 1.0f, 2.0f}}};
  const FrameDifference d = differenceOf(a, b, "x");
  EXPECT_TRUE(sameBits(d.pixels, {1.0f, 0.0f, NAN, -2.0f}));
  EXPECT_EQ(d.compared, 3u);
  EXPECT_DOUBLE_EQ(d.rms, std::sqrt(5.0 / 3.0));
  EXPECT_EQ(d.largest, 2.0);
  EXPECT_EQ(d.column, 1);
  EXPECT_EQ(d.row, 1);
  EXPECT_DOUBLE_EQ(d.largestRelative, 0.5);
  EXPECT_THROW(differenceOf(a, b, "y"), UserError);
  b.width = 4, b.height = 1;
  EXPECT_THROW(differenceOf(a, b, "x"), UserError);
}

TEST_F(ReadFrame, DamagedFilesGiveAFrameOrAUserError) {
  const Frame frame = sampleFrame();
  std::mt19937 random(7);
  const long before_kB = peakMemory_kB();
  for (const FileFormat& format : fileFormats()) {
    const fs::path file = folder_ / (format.name + format.extension);
    format.write(file, frame, {});
    std::vector<fs::path> parts = {file};
    if (format.name == "png") parts.push_back(folder_ / "png_mw.counts.png");
    for (const fs::path& part : parts) {
      const std::string whole = bytesAt(part);
      const std::string name = part.filename().string();
      for (std::size_t size = 0; size < whole.size(); size += std::max<std::size_t>(1, whole.size() / 200)) {
        put(name, whole.substr(0, size));
        expectFrameOrUserError(file, format.name + " of " + std::to_string(size) + " bytes");
      }
      for (int k = 0; k < 500; ++k) {
        std::string damaged = whole;
        for (int flips = 0; flips < 1 + k % 4; ++flips) damaged[random() % damaged.size()] ^= static_cast<char>(1u << random() % 8);
        put(name, damaged);
        expectFrameOrUserError(file, format.name + " with flips " + std::to_string(k));
      }
      put(name, whole);
    }
  }
  EXPECT_LT(peakMemory_kB() - before_kB, 64 * 1024);  // files have 2 kB at most; what libraries take once is some MB
}

}  // namespace pitviper::test
