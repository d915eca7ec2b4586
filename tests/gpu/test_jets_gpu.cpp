// Exhaust and grids of a flow on the GPU against the same lines of sight in double, at a plan's own nodes: what steps along a line, air worked out for a
// stretch of them, tables of gases and single precision lose. Pixels are finer than the fields, so that each is one line.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "sim/parameters/module_on_demand.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr double kAsked = 0.01;
/// Darker pixels are told by this part of the brightest, as filmFloors() does.
constexpr double kFloor = 1e-3;

/// A film of 32 x 32 pixels, `wide_m` wide at a place that it looks at from a range, in degrees off the way that exhaust takes there (east).
std::string camera(const glm::dvec3& at, double range_m, double offAxis_deg, double wide_m) {
  const double off = glm::radians(offAxis_deg);
  const glm::dvec3 eye = at + range_m * glm::dvec3(std::cos(off), -std::sin(off), 0.0);
  const auto text = [](double v) { return std::to_string(v); };
  return "accuracy: 1 %\ncameras:\n  - name: c\n    film: {width: 32, height: 32}\n    field_of_view: " +
         text(glm::degrees(2.0 * std::atan(0.5 * wide_m / range_m))) + " deg\n    aperture: 10 mm\n    position: [" + text(eye.x) + " m, " + text(eye.y) +
         " m, " + text(eye.z) + " m]\n    heading: " + text(270.0 + offAxis_deg) + R"( deg
    channels:
      - {name: wide, response: {band: [3 um, 5 um]}}
      - {name: red, response: {band: [4.2 um, 4.7 um]}}
      - {name: long, response: {band: [8 um, 10 um]}}
)";
}

/// Every pixel is within what was asked for. Steps have a third of that on the few lines that were looked at to choose them (sim/plan/field_sampling.cpp); air
/// of a stretch has 2e-4 (volume_field.frag.glsl). The rest is for lines that nobody looked at: wavelengths, which have their share in other pictures, are the
/// same.
void check(const std::string& what, const Simulation& sim, bool all = true) {
  const Camera& c = sim.cameras[0];
  const WorldState state = advance(sim, 0.0);
  const View view = cameraView(c, state, 1);
  const FieldState* field = fieldOf(state, 0);
  ASSERT_TRUE(field);
  EXPECT_GE(fieldLines(view, *field).apart_px, 1.0) << "a pixel is one line";
  const Worst w = compare(sim, makePlan(sim, c.outputs, c.spectral, c.where), 1, kFloor);
  EXPECT_EQ(w.covered, 1024.0);
  bound(what + ": GPU against double, 99 % of pixels", w.percentile99, kAsked, "the accuracy asked for, a third of it for steps");
  if (all) bound(what + ", worst pixel", w.error, kAsked, "the accuracy asked for, a third of it for steps");
}

constexpr const char* kAirs[] = {"", "atmosphere: {library: clear_mls}\n"};
constexpr const char* kInAir[] = {"nothing around", "air"};

// Rationale: two nozzles beside each other; the core's edge, where both jets overlap, lines that pass both, and lines that run along them. Of the latter, those
// that touch a core's side just behind its nozzle are up to 3 % off with the 64 steps that there are at most, and that is not bounded: four pixels of 1024.
TEST(JetsOnTheGpu, AreThoseInDouble) {
  for (int air = 0; air < 2; ++air)
    for (double off : {90.0, 30.0}) {
      const Simulation sim = scene(std::string(kAirs[air]) + R"(
time: {frames: 1, rate: 1 Hz}
plumes: [{name: p, nozzles: [[0 m, 0.5 m, 1000 m], [0 m, -0.5 m, 1000 m]], direction: [1, 0, 0], engine: turbofan_afterburner, length: 20 m}]
)" + camera({0.8, 0.0, 1000.15}, 40.0, off, 0.4));
      check(std::string("two jets, ") + (off > 45.0 ? "from the side" : "30 deg off their axis") + ", " + kInAir[air], sim, off > 45.0);
    }
}

// Rationale: a flow that is hot where it is dense, with all that its texels hold; the picture has its borders, and lines that are oblique to its axes.
TEST(GridsOnTheGpu, AreThoseInDouble) {
  if (!std::filesystem::exists(std::filesystem::path(PITVIPER_BUILD_DIR) / "libpitviper_mesh_import.so")) GTEST_SKIP() << "built without VTK";
  setModuleFolder(PITVIPER_BUILD_DIR);
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "flow.vti";
  constexpr int kX = 24, kY = 17, kZ = 15;
  constexpr double kApart_m = 0.25;
  {
    std::ofstream out(file);
    out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<ImageData WholeExtent=\"0 " << kX - 1 << " 0 "
        << kY - 1 << " 0 " << kZ - 1 << "\" Origin=\"0 -2 -1.75\" Spacing=\"0.25 0.25 0.25\">\n<Piece Extent=\"0 " << kX - 1 << " 0 " << kY - 1 << " 0 "
        << kZ - 1 << "\">\n<PointData>\n";
    const auto array = [&out](const char* name, const auto& value) {
      out << "<DataArray type=\"Float32\" Name=\"" << name << "\" format=\"ascii\">";
      for (int z = 0; z < kZ; ++z)
        for (int y = 0; y < kY; ++y)
          for (int x = 0; x < kX; ++x) {
            const double along = x * kApart_m, r2 = std::pow(y * kApart_m - 2.0, 2) + std::pow(z * kApart_m - 1.75, 2), wide = 0.4 + 0.12 * along;
            out << " " << value(std::exp(-r2 / (wide * wide)) * 0.4 / wide);
          }
      out << "</DataArray>\n";
    };
    array("T", [](double part) { return 290.0 + 1100.0 * part; });
    array("CO2", [](double part) { return 4.2e-4 + 0.08 * part; });
    array("H2O", [](double part) { return 0.1 * part; });
    array("SOOT", [](double part) { return 1e-9 * part; });
    out << "</PointData>\n</Piece>\n</ImageData>\n</VTKFile>\n";
  }
  for (int air = 0; air < 2; ++air)
    for (double off : {90.0, 30.0}) {
      const Simulation sim = scene(std::string(kAirs[air]) + R"(
time: {frames: 1, rate: 1 Hz}
plumes:
  - name: g
    position: [0 m, 0 m, 1000 m]
    grid: {file: )" + file.string() +
                                   ", arrays: {temperature: T, co2: CO2, h2o: H2O, soot: SOOT}}\n" + camera({2.5, 0.3, 1000.2}, 40.0, off, 3.2));
      check(std::string("a grid's flow, ") + (off > 45.0 ? "from the side" : "30 deg off its axis") + ", " + kInAir[air], sim);
    }
  setModuleFolder({});
}

}  // namespace
}  // namespace pitviper::test
