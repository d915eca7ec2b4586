// Flows on grids as fields: a Gaussian against its closed form, and their files: what is read, and what is wrong with them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <sstream>

#include "materials/fields/grid_field.hpp"
#include "sim/model/simulation.hpp"
#include "sim/parameters/module_on_demand.hpp"
#include "sim/scene/grid_import.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

constexpr double kWidth_m = 0.8, kTop_atm = 0.1;

std::shared_ptr<GridFlow> gaussian(std::size_t gases = 1) {
  auto flow = std::make_shared<GridFlow>();
  flow->nodes = {61, 65, 57};
  flow->spacing = glm::dvec3(kWidth_m / 8.0);
  flow->first = -0.5 * flow->spacing * glm::dvec3(flow->nodes - 1);
  flow->perMetre.resize(gases);
  for (int z = 0; z < flow->nodes.z; ++z)
    for (int y = 0; y < flow->nodes.y; ++y)
      for (int x = 0; x < flow->nodes.x; ++x) {
        const glm::dvec3 p = flow->first + flow->spacing * glm::dvec3(x, y, z);
        flow->temperature_K.push_back(static_cast<float>(500.0 + 20.0 * p.x));
        for (std::size_t g = 0; g < gases; ++g)
          flow->perMetre[g].push_back(static_cast<float>(static_cast<double>(g + 1) * kTop_atm * std::exp(-glm::dot(p, p) / (kWidth_m * kWidth_m))));
      }
  return flow;
}

// Amount along a line at a distance b from a Gaussian's middle: p sqrt(pi) w exp(-b^2/w^2). Linear interpolation between nodes an eighth of the width apart
// misses at most 1/8 f'' h^2 in each of two directions across: 2 (1/8)(2)(1/64) = 0.8 % of the top.
TEST(GridField, AmountsAreThoseOfAGaussian) {
  const GridSource source({gaussian(5), -1, {}, glm::dmat3(1.0), {}});
  const auto state = source.state();
  for (double b : {0.0, 0.33, 0.9})
    for (const glm::dvec3 way : {glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(1, 2, -0.7))})
      for (int steps : {8, 32}) {
        const glm::dvec3 beside = glm::normalize(glm::cross(way, glm::dvec3(0.3, -0.2, 0.9)));
        std::vector<FieldStep> out;
        state->along({b * beside - 100.0 * way, way, 0.0, 200.0}, steps, out);
        std::array<double, 5> sum{};
        double heat = 0.0;
        for (const FieldStep& f : out) {
          for (std::size_t g = 0; g < 5; ++g) sum[g] += f.amount[g];
          heat += f.amount[0] * f.temperature_K;
        }
        const double expected = kTop_atm * std::sqrt(std::acos(-1.0)) * kWidth_m * std::exp(-b * b / (kWidth_m * kWidth_m));
        for (std::size_t g = 0; g < 5; ++g) EXPECT_NEAR(sum[g], static_cast<double>(g + 1) * expected, 0.008 * static_cast<double>(g + 1) * kTop_atm * 1.42);
        EXPECT_NEAR(heat / sum[0], 500.0 + 20.0 * b * beside.x, 0.2);  // by symmetry the mean along a line is that at its middle
      }
  std::vector<FieldStep> out;
  state->along({{0.0, 0.0, 50.0}, {1.0, 0.0, 0.0}, 0.0, 200.0}, 16, out);
  EXPECT_TRUE(out.empty());
  EXPECT_EQ(source.temperatures_K().x, source.temperatures_K().x);
  EXPECT_NEAR(source.temperatures_K().y, 560.0, 1e-3);
}

// Where it stands: with its body, turned as its file's axes are, while it is there.
TEST(GridField, LiesInItsBodysAxes) {
  GridSetup setup{gaussian(), 0, {-3.0, 0.0, 1.0}, glm::transpose(glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1))), {1.0, 2.0}};
  const GridSource source(setup);
  Simulation sim;
  FieldWorld world{&sim, 1.5, [](int, double t) { return Pose{{10.0 * t, 0.0, 0.0}, glm::dquat(1.0, 0.0, 0.0, 0.0)}; }, {}};
  const auto state = source.at(world);
  ASSERT_TRUE(state);
  EXPECT_NEAR(glm::length(state->origin - glm::dvec3(12.0, 0.0, 1.0)), 0.0, 1e-12);
  EXPECT_NEAR(glm::length(state->localFromField * glm::dvec3(0, 1, 0) - glm::dvec3(1, 0, 0)), 0.0, 1e-12);
  EXPECT_EQ(state->texels, source.state()->texels);
  world.time_s = 2.5;
  EXPECT_FALSE(source.at(world));
}

/// A .vti in words.
std::string vti(glm::ivec3 nodes, const std::vector<std::pair<std::string, std::function<double(int)>>>& arrays, bool cells = false) {
  std::ostringstream out;
  out.precision(9);
  const glm::ivec3 last = nodes - (cells ? 0 : 1);
  const std::string extent = "0 " + std::to_string(last.x) + " 0 " + std::to_string(last.y) + " 0 " + std::to_string(last.z);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<ImageData WholeExtent=\"" << extent
      << "\" Origin=\"1 2 3\" Spacing=\"0.5 0.25 2\">\n<Piece Extent=\"" << extent << "\">\n<" << (cells ? "CellData" : "PointData") << ">\n";
  for (const auto& [name, value] : arrays) {
    out << "<DataArray type=\"Float32\" Name=\"" << name << "\" format=\"ascii\">";
    for (int i = 0; i < nodes.x * nodes.y * nodes.z; ++i)
      if (std::isnan(value(i))) out << " nan";
      else out << " " << value(i);
    out << "</DataArray>\n";
  }
  out << "</" << (cells ? "CellData" : "PointData") << ">\n</Piece>\n</ImageData>\n</VTKFile>\n";
  return out.str();
}

std::filesystem::path written(const TemporaryFolder& folder, const std::string& name, const std::string& text) {
  std::ofstream(folder.path() / name) << text;
  return folder.path() / name;
}

std::string wrongWith(const std::function<void()>& work) {
  try {
    work();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

class GridFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    setModuleFolder(PITVIPER_BUILD_DIR);
    if (!std::filesystem::exists(std::filesystem::path(PITVIPER_BUILD_DIR) / "libpitviper_mesh_import.so")) GTEST_SKIP() << "built without VTK";
  }
  void TearDown() override { setModuleFolder({}); }
  TemporaryFolder folder_;
};

TEST_F(GridFiles, VtkImageDataIsRead) {
  const auto number = [](int i) { return 300.0 + i; };
  const auto file = written(folder_, "flow.vti", vti({3, 2, 4}, {{"T", number}, {"X CO2", [](int i) { return 0.01 * i; }}, {"more", number}}));
  const GridData points = importGrid(file, {"X CO2", "T"}, {"s.yaml", 1, 1});
  EXPECT_EQ(points.nodes, glm::ivec3(3, 2, 4));
  EXPECT_EQ(points.origin, glm::dvec3(1, 2, 3));
  EXPECT_EQ(points.spacing, glm::dvec3(0.5, 0.25, 2));
  ASSERT_EQ(points.arrays.size(), 2u);
  EXPECT_FLOAT_EQ(points.arrays[0].values[23], 0.23f);
  EXPECT_FLOAT_EQ(points.arrays[1].values[5], 305.0f);
  EXPECT_EQ(gridIndex(points, 23), "node [2, 1, 3]");
  // Of cells: nodes at their middles.
  const GridData cells = importGrid(written(folder_, "cells.vti", vti({3, 2, 4}, {{"T", number}}, true)), {"T"}, {});
  EXPECT_EQ(cells.nodes, glm::ivec3(3, 2, 4));
  EXPECT_EQ(cells.origin, glm::dvec3(1.25, 2.125, 4));
  EXPECT_FLOAT_EQ(cells.arrays[0].values[23], 323.0f);
}

// Each names file, and array and place where there is one, and says what to do.
TEST_F(GridFiles, WhatIsWrongIsNamed) {
  const auto number = [](int i) { return 300.0 + i; };
  const Location asked{"s.yaml", 7, 3};
  const auto file = written(folder_, "flow.vti", vti({3, 2, 4}, {{"T", number}, {"Y", number}}));
  const auto of = [&](const std::filesystem::path& f, const std::vector<std::string>& names) { return wrongWith([&] { importGrid(f, names, asked); }); };
  EXPECT_NE(of(folder_.path() / "none.vti", {"T"}).find("s.yaml:7:3"), std::string::npos);
  EXPECT_NE(of(folder_.path() / "flow.dat", {"T"}).find(".vti (VTK image data) or .vdb (OpenVDB)"), std::string::npos);
  const std::string missing = of(file, {"T", "CO2"});
  EXPECT_NE(missing.find("flow.vti: there is no array 'CO2'"), std::string::npos) << missing;
  EXPECT_NE(missing.find("'T', 'Y'"), std::string::npos) << missing;
  const auto holed = written(folder_, "nan.vti", vti({3, 2, 4}, {{"T", [](int i) { return i == 16 ? std::numeric_limits<double>::quiet_NaN() : 300.0; }}}));
  const std::string nan = of(holed, {"T"});
  EXPECT_NE(nan.find("array 'T' is no number at node [1, 1, 2]"), std::string::npos) << nan;
  EXPECT_NE(of(written(folder_, "flat.vti", vti({3, 1, 4}, {{"T", number}})), {"T"}).find("3x1x4 nodes"), std::string::npos);
  std::string text = vti({3, 2, 4}, {{"T", number}});
  EXPECT_NE(of(written(folder_, "cut.vti", text.substr(0, text.size() / 2)), {"T"}).find("cut.vti"), std::string::npos);
  std::string other = text;
  other.replace(other.find("ImageData"), 9, "PolyData");
  EXPECT_NE(of(written(folder_, "poly.vti", other), {"T"}).find("holds no ImageData"), std::string::npos);
  for (const char* extent : {"0 2 0 1 0 3"}) {
    std::string vast = text;
    for (std::size_t at; (at = vast.find(extent)) != std::string::npos;) vast.replace(at, 11, "0 9999 0 9999 0 9999");
    EXPECT_NE(of(written(folder_, "vast.vti", vast), {"T"}).find("vast.vti"), std::string::npos);
  }
  // What the reader would take for 0 or 1.
  for (const auto& [from, to, words] :
       {std::tuple<std::string, std::string, std::string>{"Spacing=\"0.5 0.25 2\"", "Spacing=\"nan 1 1\"", "3:1: Spacing=\"nan 1 1\" of the grid"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1 inf 1\"", "3:1: Spacing"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1 1\"", "3 finite numbers"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1,5 1 1\"", "3:1: Spacing"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1 0 1\"", "a step that is not above 0"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1 -1 1\"", "a step that is not above 0"},
        {"Spacing=\"0.5 0.25 2\"", "Spacing=\"1e999 1 1\"", "3:1: Spacing"},
        {"Origin=\"1 2 3\"", "Origin=\"1 2 NaN\"", "3:1: Origin"},
        {"Origin=\"1 2 3\"", "Origin=\"\"", "3:1: Origin"},
        {"WholeExtent=\"0 2 0 1 0 3\"", "WholeExtent=\"0 nan 0 1 0 3\"", "3:1: WholeExtent"},
        {"WholeExtent=\"0 2 0 1 0 3\"", "WholeExtent=\"0 2 0 1 0 3.5\"", "6 whole numbers"},
        {"Piece Extent=\"0 2 0 1 0 3\"", "Piece Extent=\"0 2 0 1 0\"", "4:1: Extent"}}) {
    std::string bad = text;
    ASSERT_NE(bad.find(from), std::string::npos);
    bad.replace(bad.find(from), from.size(), to);
    const std::string said = of(written(folder_, "bad.vti", bad), {"T"});
    EXPECT_NE(said.find(words), std::string::npos) << to << ": " << said;
    EXPECT_NE(said.find("bad.vti:"), std::string::npos) << said;
  }
  EXPECT_NE(of(written(folder_, "empty.vti", ""), {"T"}).find("empty.vti"), std::string::npos);
  setModuleFolder(folder_.path());
  EXPECT_NE(of(file, {"T"}).find("libvtk9-dev"), std::string::npos);
  setModuleFolder(PITVIPER_BUILD_DIR);
}

// OpenVDB: the same Gaussian by its own library (tests/support/gaussian.vdb: 'T' and 'CO2' on 13x11x9 voxels of 0.25 m, values as below).
TEST_F(GridFiles, OpenVdbIsRead) {
  if (!std::filesystem::exists(std::filesystem::path(PITVIPER_BUILD_DIR) / "libpitviper_vdb_import.so")) GTEST_SKIP() << "built without OpenVDB";
  const std::filesystem::path file = std::filesystem::path(PITVIPER_SOURCE_DIR) / "tests/support/gaussian.vdb";
  const GridData grid = importGrid(file, {"T", "CO2"}, {"s.yaml", 1, 1});
  ASSERT_EQ(grid.nodes, glm::ivec3(13, 11, 9));
  EXPECT_NEAR(glm::length(grid.spacing - glm::dvec3(0.25)), 0.0, 1e-9);
  EXPECT_NEAR(glm::length(grid.origin - glm::dvec3(-1.5, -1.25, -1.0)), 0.0, 1e-9);
  for (int z = 0, i = 0; z < 9; ++z)
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 13; ++x, ++i) {
        const glm::dvec3 p = grid.origin + grid.spacing * glm::dvec3(x, y, z);
        EXPECT_NEAR(grid.arrays[0].values[static_cast<std::size_t>(i)], 300.0 + 100.0 * std::exp(-glm::dot(p, p)), 1e-3);
        EXPECT_NEAR(grid.arrays[1].values[static_cast<std::size_t>(i)], 0.05 * std::exp(-glm::dot(p, p)), 1e-6);
      }
  const std::string missing = wrongWith([&] { importGrid(file, {"T", "H2O"}, {}); });
  EXPECT_NE(missing.find("there is no grid of floats 'H2O'"), std::string::npos) << missing;
  EXPECT_NE(missing.find("'CO2'"), std::string::npos) << missing;
  const std::string broken = wrongWith([&] { importGrid(written(folder_, "broken.vdb", "VDB?"), {"T"}, {}); });
  EXPECT_NE(broken.find("broken.vdb"), std::string::npos) << broken;
}

}  // namespace
}  // namespace pitviper::test
