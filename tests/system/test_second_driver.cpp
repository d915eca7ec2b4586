// The same pictures by a second driver, OpenGL over Vulkan on the processor (Mesa's zink over lavapipe), and programs that the standard's own compiler takes.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "sim/image/exr.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/long_tests.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

const std::string kChannels =
    "channels: [{name: vis, response: {band: [0.5 um, 0.6 um]}}, {name: mw, response: {band: [3.5 um, 4.5 um]}}, {name: lw, response: {band: [8 um, 10 um]}}]";

/// Ground, balls and their shadows in the sun and under a lamp, under a sky.
const std::string kLit =
    "accuracy: 5 %\natmosphere: hazy_us76\nsun: {azimuth: 160 deg, elevation: 30 deg, temperature: 5772 K}\nambient: {from: sky}\n"
    "materials: {m: {components: [{reflection: microfacet, index: aluminium, roughness: 0.2}]}, "
    "g: {components: [{reflection: lambertian, reflectance: 0.3}]}}\n"
    "ground: {material: g, temperature: 290 K}\nlights: [{name: l, intensity: {library: mtv_flare}, position: [3 m, 27 m, 8 m], radius: 0.1 m}]\n"
    "entities: [{name: b, shape: {model: sphere, radius: 1 m}, material: m, temperature: 320 K, position: [0 m, 30 m, 2 m]},\n"
    "  {name: d, shape: {model: sphere, radius: 0.5 m}, material: g, temperature: 300 K, position: [0.2 m, 28 m, 4 m]}]\n"
    "cameras: [{name: c, film: {width: 40, height: 32}, samples: 2, field_of_view: 16 deg, aperture: 20 mm, position: [0 m, 0 m, 4 m], look_at: b, truth: "
    "[range, entity], " +
    kChannels + "}]\n";

/// Gas in gas behind glass, and a jet through both.
const std::string kThrough =
    "accuracy: 5 %\nmaterials:\n  core: {absorption: 0.5 /m}\n  sheath: {absorption: 0.1 /m}\n"
    "entities:\n  - {name: sheath, shape: {model: sphere, radius: 2 m}, material: sheath, temperature: 600 K, position: [0 m, 50 m, 0 m]}\n"
    "  - {name: core, shape: {model: sphere, radius: 0.5 m}, material: core, temperature: 1500 K, position: [0 m, 50.5 m, 0 m]}\n"
    "  - {name: pane, shape: {model: plate, width: 3 m, height: 1 m}, material: {transmission: {transmittance: 0.4}, emission: {emissivity: 0}}, "
    "temperature: 0 K, position: [0 m, 30 m, 0 m], heading: 0 deg}\n"
    "plumes: [{name: p, nozzles: [[-4 m, 50 m, 0 m]], direction: [1, 0, 0], engine: turboshaft, length: 10 m}]\n"
    "cameras: [{name: c, film: {width: 40, height: 32}, field_of_view: 8 deg, aperture: 20 mm, position: [0 m, 0 m, 0 m], heading: 0 deg, " +
    kChannels + "}]\n";

struct SecondDriver : testing::Test {
  /// Draws the first frame and gives all pictures of it. Both drivers draw by the same plan; their programs lie beside each other in the cache.
  std::vector<fs::path> draw(const std::string& scenario, const std::string& out, const std::string& environment) const {
    const std::string there = folder.path().string();
    const Result r =
        run("cd " + there + " && " + environment + " XDG_CACHE_HOME=" + there + "/cache PITVIPER_HOME=" + PITVIPER_SOURCE_DIR + " " + PITVIPER_PROGRAM +
            " run " + scenario + " --frames 0:0 --set accuracy='5 %' --set cameras.0.film.width=40 --set cameras.0.film.height=32 --overwrite --out " + out);
    EXPECT_EQ(r.code, 0) << scenario << " " << out << "\n" << r.output;
    EXPECT_EQ(r.output.find("zink") != std::string::npos, out == "second") << r.output;
    std::vector<fs::path> all;
    for (const auto& f : fs::directory_iterator(folder.path() / out))
      if (f.path().extension() == ".exr") all.push_back(f.path());
    return all;
  }
  const TemporaryFolder folder;
};

// Rationale: what one driver takes another may not, and Mesa takes what the standard does not have. Expected: single precision, where compilers put products
// and sums together as they like; glslang takes every program.
TEST_F(SecondDriver, DrawsTheSameByStandardPrograms) {
  const bool draws = fs::exists("/usr/share/vulkan/icd.d/lvp_icd.x86_64.json"), checks = run("glslangValidator --version").code == 0;
  if (!draws && !checks) GTEST_SKIP() << "neither lavapipe (Debian's mesa-vulkan-drivers) nor glslangValidator (glslang-tools)";
  folder.put("lit.yaml", kLit);
  folder.put("through.yaml", kThrough);
  const std::string shipped = std::string(PITVIPER_SOURCE_DIR) + "/scenarios/", here = folder.path().string();
  // Few pixels of the same fields.
  for (const std::string& scenario : {std::string("lit.yaml"), std::string("through.yaml"), shipped + "jet_and_sky.yaml",
                                      shipped + "far_jet.yaml --set cameras.0.film.pitch='154 um'", shipped + "metamers.yaml"}) {
    // Hills and a small jet: the programs of the first and the third.
    if (scenario.find("far_jet") != std::string::npos && !runsLong()) continue;
    fs::remove_all(folder.path() / "first");
    fs::remove_all(folder.path() / "second");
    const auto first = draw(scenario, "first", "MESA_SHADER_DUMP_PATH=" + here);
    ASSERT_FALSE(first.empty()) << scenario;
    if (!draws) continue;
    draw(scenario, "second", "MESA_LOADER_DRIVER_OVERRIDE=zink LIBGL_ALWAYS_SOFTWARE=1 XDG_RUNTIME_DIR=" + here);
    double worst = 0.0;
    for (const fs::path& f : first) {
      const ExrImage a = readExr(f), b = readExr(folder.path() / "second" / f.filename());
      ASSERT_EQ(a.layers.size(), b.layers.size());
      for (std::size_t l = 0; l < a.layers.size(); ++l) {
        const auto &p = a.layers[l].pixels, &q = b.layers[l].pixels;
        ASSERT_EQ(p.size(), q.size());
        const double most = *std::max_element(p.begin(), p.end());
        EXPECT_GT(most, 0.0) << scenario << " " << a.layers[l].name;
        for (std::size_t i = 0; i < p.size(); ++i) worst = std::max(worst, std::abs(double(q[i]) - p[i]) / std::max(double(p[i]), 1e-3 * most));
      }
    }
    bound("pictures by a second driver, " + fs::path(scenario.substr(0, scenario.find(' '))).stem().string() + ", relative", worst, 3e-5,
          "single precision, sums of 340 narrow groups");
  }
  int count = 0;
  for (const auto& f : fs::directory_iterator(folder.path())) {
    const std::string name = f.path().filename(), stage = name.substr(0, 3);
    if (!checks || f.path().extension() != ".glsl") continue;
    const Result r = run("glslangValidator -S " + std::string(stage == "FS_" ? "frag " : stage == "VS_" ? "vert " : "comp ") + f.path().string());
    EXPECT_EQ(r.code, 0) << r.output;
    ++count;
  }
  EXPECT_GT(count, checks ? 30 : -1);
}

}  // namespace
}  // namespace pitviper::test
