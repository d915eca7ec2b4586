// Frames in every format, opened by readers that know nothing of this project; films; sheets; the page of a run.
#include <fitsio.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "sim/image/exr.hpp"
#include "sim/image/png.hpp"
#include "tests/support/read_png.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& program) { return run("command -v " + program).code == 0; }
std::string bytes(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream s;
  s << in.rdbuf();
  return s.str();
}

/// A hot ball before a wall, as counts and radiance; the ball moves.
std::string scenario(const std::string& sinks, const std::string& more = "") {
  return "name: formats\nseed: 3\ntime: {rate: 25 Hz, frames: 4, date: 2026-06-21T12:00:00}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: "
         "[]}}\nentities:\n- {name: ball, shape: "
         "{model: sphere, radius: 2 m}, material: m, temperature: 350 K, motion: [{time: 0 s, position: [1000 m, -3 m, 0 m]}, {time: 1 s, position: [1000 m, "
         "30 m, 0 m]}]}\ncameras:\n- {name: c, "
         "film: {width: 40, height: 30, pitch: 15 um}, focal_length: 50 mm, f_number: 2, exposure: 2 ms, position: [0 m, 0 m, 0 m], heading: 90 deg, truth: "
         "[range, targets], stages: [{stage: "
         "detector, full_well: 7e6, offset: 100, read_noise: 300}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: "
         "[counts, radiance]}]}\n" +
         more + (sinks.empty() ? "" : "sinks: " + sinks + "\n");
}

class FileFormats : public ::testing::Test {
 protected:
  /// Draws frame 0 in a format; the same as EXR beside it.
  ExrImage draw(const std::string& format) {
    const Result r =
        pitviper("run " + folder_.put("s.yaml", scenario("[files, {sink: files, format: " + format + "}]")) + " --frames 0 --out " + out().string());
    EXPECT_EQ(r.code, 0) << r.output;
    return readExr(out() / "c_00000.exr");
  }
  fs::path out() const { return folder_.path() / "out"; }
  TemporaryFolder folder_;
};

TEST_F(FileFormats, TiffByLibtiff) {
  const ExrImage exr = draw("tiff");
  TIFF* tiff = TIFFOpen((out() / "c_00000.tif").c_str(), "r");
  ASSERT_NE(tiff, nullptr);
  int pages = 0;
  do {
    const char* name = nullptr;
    std::uint32_t width = 0;
    std::uint16_t bits = 0, form = 0;
    TIFFGetField(tiff, TIFFTAG_PAGENAME, &name);
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &width);
    TIFFGetField(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetField(tiff, TIFFTAG_SAMPLEFORMAT, &form);
    ASSERT_EQ(width, 40u);
    const FloatLayer* layer = exr.find(name);
    ASSERT_NE(layer, nullptr) << name;
    const bool counts = std::string(name) == "mw.counts";
    EXPECT_EQ(bits, counts ? 16 : 32);
    EXPECT_EQ(form, counts ? SAMPLEFORMAT_UINT : SAMPLEFORMAT_IEEEFP);
    std::vector<char> row(static_cast<size_t>(TIFFScanlineSize(tiff)));
    for (std::uint32_t y = 0; y < 30; ++y) {
      ASSERT_EQ(TIFFReadScanline(tiff, row.data(), y), 1);
      for (size_t x = 0; x < 40; ++x) {
        std::uint16_t code = 0;
        float value = 0.0f;
        if (counts) std::memcpy(&code, row.data() + 2 * x, 2), value = code;
        else std::memcpy(&value, row.data() + 4 * x, 4);
        ASSERT_EQ(value, layer->pixels[y * 40 + x]) << name;
      }
    }
    ++pages;
  } while (TIFFReadDirectory(tiff));
  TIFFClose(tiff);
  EXPECT_EQ(pages, 3);
  const std::string json = bytes(out() / "c_00000.json");
  for (const char* part : {"\"mw.counts\"", "\"unit\": \"count\"", "curve.mw.response", "calibration.mw.counts.radiance_per_count"})
    EXPECT_NE(json.find(part), std::string::npos) << part;
}

TEST_F(FileFormats, FitsByCfitsio) {
  const ExrImage exr = draw("fits");
  fitsfile* file = nullptr;
  int status = 0, images = 0;
  fits_open_file(&file, (out() / "c_00000.fits").c_str(), READONLY, &status);
  ASSERT_EQ(status, 0);
  char unit[80] = "", date[80] = "";
  double exposure = 0.0;
  fits_read_key(file, TSTRING, "BUNIT", unit, nullptr, &status);
  fits_read_key(file, TSTRING, "DATE-OBS", date, nullptr, &status);
  fits_read_key(file, TDOUBLE, "EXPTIME", &exposure, nullptr, &status);
  EXPECT_EQ(status, 0);
  EXPECT_STREQ(unit, "count");
  EXPECT_STREQ(date, "2026-06-21T12:00:00.000");
  EXPECT_DOUBLE_EQ(exposure, 2e-3);
  int all = 0, kind = 0;
  fits_get_num_hdus(file, &all, &status);
  bool curves = false;
  for (int h = 1; h <= all; ++h) {
    fits_movabs_hdu(file, h, &kind, &status);
    char name[80] = "";
    fits_read_key(file, TSTRING, "EXTNAME", name, nullptr, &status);
    if (kind != IMAGE_HDU) {
      curves |= std::string(name) == "curve.mw";
      continue;
    }
    ++images;
    std::vector<float> pixels(1200);
    int any = 0;
    fits_read_img(file, TFLOAT, 1, 1200, nullptr, pixels.data(), &any, &status);
    const FloatLayer* layer = exr.find(name);
    ASSERT_NE(layer, nullptr) << name;
    for (size_t y = 0; y < 30; ++y)
      for (size_t x = 0; x < 40; ++x) ASSERT_EQ(pixels[(29 - y) * 40 + x], layer->pixels[y * 40 + x]) << name << ": FITS counts rows from the bottom";
  }
  fits_close_file(file, &status);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(images, 3);
  EXPECT_TRUE(curves);
}

TEST_F(FileFormats, PngByLibpng) {
  const ExrImage exr = draw("png");
  const GreyImage counts = readPngGrey(out() / "c_00000_mw.counts.png");
  EXPECT_EQ(counts.bits, 16);
  for (size_t p = 0; p < counts.pixels.size(); ++p) ASSERT_EQ(std::lround(counts.pixels[p] * 65535.0f), std::lround(exr.find("mw.counts")->pixels[p]));
  // The rest by codes whose value the JSON gives.
  const std::string json = bytes(out() / "c_00000.json");
  const size_t at = json.find("c_00000_mw.radiance.png");
  ASSERT_NE(at, std::string::npos);
  const auto number = [&](const char* key) { return std::stod(json.substr(json.find(':', json.find(key, at)) + 1)); };
  const double low = number("\"low\""), step = number("\"step\"");
  const GreyImage radiance = readPngGrey(out() / "c_00000_mw.radiance.png");
  for (size_t p = 0; p < radiance.pixels.size(); ++p)
    ASSERT_NEAR(low + step * static_cast<double>(std::lround(radiance.pixels[p] * 65535.0f)), static_cast<double>(exr.find("mw.radiance")->pixels[p]),
                0.51 * step);
}

TEST_F(FileFormats, EnviByGdal) {
  const ExrImage exr = draw("envi");
  const std::string pixels = bytes(out() / "c_00000.img");
  ASSERT_EQ(pixels.size(), 3u * 1200u * 4u);
  EXPECT_EQ(std::memcmp(pixels.data(), exr.find("mw.counts")->pixels.data(), 4800), 0);
  if (!has("gdalinfo")) GTEST_SKIP() << "gdalinfo (Debian: gdal-bin) is not installed";
  const Result r = run("gdalinfo " + (out() / "c_00000.img").string());
  EXPECT_NE(r.output.find("Driver: ENVI"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("Size is 40, 30"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("mw.radiance [W/(m2 sr)]"), std::string::npos) << r.output;
}

TEST_F(FileFormats, RawByItsDescription) {
  const ExrImage exr = draw("raw");
  const std::string raw = bytes(out() / "c_00000.raw");
  ASSERT_EQ(raw.substr(0, 8), "PITVRAW1");
  std::array<std::uint32_t, 4> head{};
  std::memcpy(head.data(), raw.data() + 8, 16);
  EXPECT_EQ(head[1], 40u);
  EXPECT_EQ(head[2], 30u);
  EXPECT_EQ(head[3], 3u);
  std::vector<std::uint16_t> counts(1200);
  std::memcpy(counts.data(), raw.data() + head[0], 2400);
  for (size_t p = 0; p < 1200; ++p) ASSERT_EQ(static_cast<float>(counts[p]), exr.find("mw.counts")->pixels[p]);
  EXPECT_EQ(raw.size(), head[0] + 1200u * (2 + 4 + 4));
}

// The same again may replace every file; two formats that share a file beside theirs may not share a folder; long names are told somehow.
TEST_F(FileFormats, RunAgainSideBySideAndWithLongNames) {
  for (const char* format : {"envi", "tiff", "png", "fits", "raw"}) {
    const std::string file = folder_.put("s.yaml", scenario("[{sink: files, format: " + std::string(format) + "}]"));
    const std::string line = "run " + file + " --frames 0 --out " + (folder_.path() / format).string();
    ASSERT_EQ(pitviper(line).code, 0) << format;
    const Result again = pitviper(line);
    EXPECT_EQ(again.code, 0) << format << ": " << again.output;
  }
  const Result both = pitviper("run " + folder_.put("b.yaml", scenario("[{sink: files, format: tiff}, {sink: files, format: png}]")) + " --frames 0 --out " +
                               (folder_.path() / "both").string());
  EXPECT_EQ(both.code, 2);
  EXPECT_NE(both.output.find("two sinks write"), std::string::npos) << both.output;
  std::string text = scenario("[{sink: files, format: fits}]");
  const std::string longName = "a_body_with_a_name_of_more_than_fifty_letters_as_they_come";
  text.replace(text.find("name: ball"), 10, "name: " + longName);
  text.replace(text.find("{name: mw"), 9, "{name: midwave_infrared_one");
  const Result names = pitviper("run " + folder_.put("n.yaml", text) + " --frames 0 --out " + (folder_.path() / "names").string());
  EXPECT_EQ(names.code, 0) << names.output;
}

// What programs show that know nothing of layers; what other programs look for in the header.
TEST_F(FileFormats, ExrHasAPictureAndAHeader) {
  draw("exr, folder: again");
  if (has("exrheader")) {
    const Result r = run("exrheader " + (out() / "c_00000.exr").string());
    for (const char* part : {"R, 16-bit", "worldToCamera (type m44f)", "framesPerSecond (type rational)", "25/1", "mw.counts, 32-bit"})
      EXPECT_NE(r.output.find(part), std::string::npos) << part << "\n" << r.output;
  }
  if (has("oiiotool")) {
    const Result r = run("oiiotool --info -v " + (out() / "c_00000.exr").string());
    EXPECT_NE(r.output.find("40 x   30"), std::string::npos) << r.output;
  }
  const ExrImage exr = readExr(out() / "c_00000.exr");
  const Attribute* rate = exr.findAttribute("framesPerSecond");
  ASSERT_NE(rate, nullptr);
  EXPECT_DOUBLE_EQ(std::get<double>(rate->value), 25.0);
  EXPECT_EQ(exr.find("R"), nullptr) << "the picture is no layer";
  const Attribute* world = exr.findAttribute("worldToCamera");
  ASSERT_NE(world, nullptr);
  // The camera looks east from the origin: what is 10 m east of it is at z = -10 before it.
  const auto m = std::get<std::vector<double>>(world->value);
  EXPECT_NEAR(10.0 * m[2] + m[14], -10.0, 1e-5);
  EXPECT_NEAR(10.0 * m[0] + m[12], 0.0, 1e-5);
}

// Counts become radiance and temperature by the header alone.
TEST_F(FileFormats, TheHeaderCalibratesCounts) {
  const ExrImage exr = draw("exr, folder: again");
  const auto number = [&](const std::string& name) { return numbersOf(*exr.findAttribute("calibration.mw.counts." + name))->front(); };
  const auto list = [&](const std::string& name) { return *numbersOf(*exr.findAttribute("calibration.mw.counts." + name)); };
  const auto temperature = list("temperature_K"), count = list("count");
  double mean = 0.0, radiance = 0.0;
  int pixels = 0;
  for (size_t p = 0; p < 200; ++p) {  // the top rows, where the ball is not
    mean += static_cast<double>(exr.find("mw.counts")->pixels[p]);
    radiance += static_cast<double>(exr.find("mw.radiance")->pixels[p]);
    ++pixels;
  }
  mean /= pixels, radiance /= pixels;
  const size_t k = static_cast<size_t>(std::lower_bound(count.begin(), count.end(), mean) - count.begin());
  const double kelvin = temperature[k - 1] + (temperature[k] - temperature[k - 1]) * (mean - count[k - 1]) / (count[k] - count[k - 1]);
  EXPECT_NEAR(kelvin, 290.0, 0.15) << "off the axis cos^4 takes up to 0.3 %";
  EXPECT_NEAR((number("radiance_per_count") * mean + number("radiance_at_0")) / radiance, 1.0, 0.06)
      << "of light even over the band; a black body of 290 K is not";
}

TEST_F(FileFormats, FilmsSheetsAndThePage) {
  const Result r = pitviper("run " + folder_.put("s.yaml", scenario("")) + " --video film.mp4 --report --out " + out().string());
  ASSERT_EQ(r.code, 0) << r.output;
  const Result probe =
      run("ffprobe -v error -count_frames -select_streams v -show_entries stream=codec_name,width,height,nb_read_frames,r_frame_rate -of csv=p=0 " +
          (out() / "film.mp4").string());
  EXPECT_NE(probe.output.find("h264"), std::string::npos) << probe.output;
  EXPECT_NE(probe.output.find("25/1"), std::string::npos) << probe.output;
  EXPECT_NE(probe.output.find(",4"), std::string::npos) << probe.output;
  const Rgb8Image sheet = readPng(out() / "c_sheet.png");
  EXPECT_GT(sheet.width, 1000);
  const std::string page = bytes(out() / "report.html");
  for (const char* part : {"<!doctype html>", "data:image/png;base64,", "Camera c", "mw.counts", "NETD", "film.mp4", "name: formats"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(page.find("src=\"http"), std::string::npos) << "nothing is fetched";
  const std::string truth = bytes(out() / "c_truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 6) << truth;
  // The same again may replace them; another scenario may not.
  EXPECT_EQ(pitviper("run " + (folder_.path() / "s.yaml").string() + " --video film.mp4 --report --out " + out().string()).code, 0);
  const Result other = pitviper("run " + folder_.put("t.yaml", scenario("[]", "ambient: {temperature: 3 K}\n")) + " --video film.mp4 --out " + out().string());
  EXPECT_EQ(other.code, 2) << other.output;
}

// One scale for a run: a film's pictures have one size and one bar; frames by themselves their own.
TEST_F(FileFormats, OneScaleForARun) {
  const std::string file = folder_.put("s.yaml", scenario(""));
  ASSERT_EQ(pitviper("run " + file + " --preview --scale run --plain --out " + out().string()).code, 0);
  const Rgb8Image first = readPng(out() / "c_00000.png"), last = readPng(out() / "c_00003.png");
  EXPECT_EQ(first.width, last.width);
  EXPECT_EQ(first.height % 2, 0);
  const Result bad = pitviper("run " + file + " --scale warm --out " + out().string());
  EXPECT_EQ(bad.code, 2);
  EXPECT_NE(bad.output.find("is no scale"), std::string::npos) << bad.output;
  const Result name = pitviper("run " + file + " --video film.avi --out " + out().string());
  EXPECT_EQ(name.code, 2);
  EXPECT_NE(name.output.find("ends in .mp4"), std::string::npos) << name.output;
}

// A disk that fills leaves a film of whole frames: fragments of a second, as many as there was room for.
TEST_F(FileFormats, AFullDiskLeavesWholeFrames) {
  const std::string file = folder_.put(
      "s.yaml",
      "name: long\ntime: {rate: 25 Hz, frames: 150}\nbackground: {temperature: 290 K}\ncameras: [{name: c, film: {width: 64, height: 48, pitch: 15 um}, "
      "focal_length: 50 mm, f_number: 2, exposure: 2 ms, position: [0 m, 0 m, 0 m], heading: 90 deg, stages: [{stage: detector, full_well: 7e6, "
      "read_noise: 90000}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: counts}]}]\nsinks: [{sink: video, "
      "scale: frame}]\n");
  // A limit on a file's size stands for the disk.
  const Result whole = pitviper("run " + file + " --out " + (folder_.path() / "whole").string());
  ASSERT_EQ(whole.code, 0) << whole.output;
  const auto size = fs::file_size(folder_.path() / "whole/video.mp4");
  const Result r = run("bash -c 'ulimit -f " + std::to_string(size / 1024 / 2) + "; PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM + " run " +
                       file + " --out " + out().string() + "'");
  EXPECT_EQ(r.code, 1) << r.output;
  ASSERT_TRUE(fs::exists(out() / "video.mp4")) << r.output;
  const Result probe =
      run("ffprobe -v error -count_frames -select_streams v -show_entries stream=nb_read_frames -of csv=p=0 " + (out() / "video.mp4").string());
  EXPECT_EQ(probe.output.find("rror"), std::string::npos) << probe.output;
  const int frames = std::atoi(probe.output.c_str());
  EXPECT_GE(frames, 25) << probe.output;
  EXPECT_EQ(frames % 25, 0) << "fragments of a second";
  EXPECT_LT(frames, 150);
}

}  // namespace
}  // namespace pitviper::test
