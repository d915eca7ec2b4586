// The lab bench as a user runs it: what it measures from pictures against the camera's design.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

struct Row {
  double design = 0.0, measured = 0.0, error = 0.0;
};

// Rationale: figures that engineers compare are to be found in the pictures. Expected: SiTF, NETD, gain and well within 2 %, MTF within 0.02 up to Nyquist, a star's
// share within 1 %, each component of noise within 4 of its standard errors; a page, a table and charts.
TEST(Measure, FindsTheDesignInPictures) {
  const TemporaryFolder folder;
  const std::string camera = folder.put("mine.yaml",
                                        "description: a camera\ncamera:\n  film: {width: 160, height: 120, pitch: 15 um}\n  focal_length: 100 mm\n  f_number: 3\n  optics: 0.85\n  exposure: 3 ms\n"
                                        "  channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, quantum_efficiency: 0.8, output: counts}]\n  stages:\n  - {stage: point_spread, wavefront_error: 0.2 um}\n"
                                        "  - {stage: detector, full_well: 6e6, bits: 14, offset: 200, read_noise: 500, row_noise: 400, column_noise: 300, frame_noise: 250, dsnu: 600, fixed_row_noise: 350, "
                                        "fixed_column_noise: 300, prnu: 0.001, bad_pixels: 0.001}\n");
  const Result r = pitviper("measure " + camera + " --film 80 --frames 16 --out " + (folder.path() / "out").string());
  ASSERT_TRUE(r.code == 0 || r.output.find("libvtk9") != std::string::npos) << r.output;
  if (r.code != 0) GTEST_SKIP() << "built without VTK";
  std::ifstream in(folder.path() / "out/mine.csv");
  std::map<std::string, Row> rows;
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) {
    const size_t first = line.find('"'), last = line.find('"', first + 1);
    Row row;
    std::string unit, rest = line.substr(last + 2);
    std::stringstream cells(rest.substr(rest.find(',') + 1));
    char comma = 0;
    cells >> row.design >> comma >> row.measured >> comma >> row.error;
    rows[line.substr(first + 1, last - first - 1)] = row;
  }
  const auto within = [&](const std::string& name, double part) {
    ASSERT_TRUE(rows.count(name)) << name << "\n" << r.output;
    EXPECT_NEAR(rows[name].measured / rows[name].design, 1.0, part) << name;
  };
  within("SiTF", 0.02);
  within("NETD (rms over the film)", 0.02);
  within("gain (photon transfer)", 0.02);
  within("full well, or what the converter holds", 0.02);
  for (const char* star : {"a star in its middle, share of that pixel", "a star on its edge, share of that pixel", "a star in its corner, share of that pixel"}) within(star, 0.01);
  ASSERT_TRUE(rows.count("largest difference of MTF up to Nyquist"));
  EXPECT_LT(rows["largest difference of MTF up to Nyquist"].measured, 0.02);
  int components = 0;
  for (const auto& [name, row] : rows)
    if (name.starts_with("sigma_")) {
      ++components;
      EXPECT_LT(std::abs(row.measured - row.design), 4.0 * row.error) << name;
    }
  EXPECT_EQ(components, 7);
  for (const char* file : {"mine.html", "mine_mw.png"}) EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / file)) << file;
}

TEST(Measure, RefusesWhatMakesNoCounts) {
  const TemporaryFolder folder;
  const Result r = pitviper("measure " + folder.put("none.yaml", "camera: {film: {width: 64, height: 64, pitch: 15 um}, focal_length: 100 mm, f_number: 3, channels: [{name: mw, response: {band: [3.6 um, 4.9 "
                                                                 "um]}}]}\n"));
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.output.find("makes no counts"), std::string::npos) << r.output;
  const Result name = pitviper("measure insb_64x512");
  EXPECT_EQ(name.code, 2);
  EXPECT_NE(name.output.find("did you mean 'insb_640x512'?"), std::string::npos) << name.output;
  EXPECT_EQ(pitviper("measure insb_640x512 --frames 0").code, 2);
}

}  // namespace
}  // namespace pitviper::test
