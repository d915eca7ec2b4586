// Responses that go on where a scene has no data: what is cut, what is refused, and what is said of it.
#include <gtest/gtest.h>

#include "sim/world/coverage.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

std::string yaml(const std::string& air, const std::string& response, const std::string& output = "radiance") {
  return "atmosphere: " + air +
         "\nmaterials: {m: {}}\n"
         "entities: [{name: wall, shape: {model: plate, width: 9 m, height: 9 m}, material: m, temperature: 300 K, position: [0 m, 1 km, 0 m]}]\n"
         "cameras: [{name: c, film: {width: 4, height: 4}, field_of_view: 0.1 deg, aperture: 5 mm, position: [0 m, 0 m, 0 m], look_at: wall, channels: [{name: "
         "lw, response: " +
         response + ", output: " + output + "}]}]\n";
}

ChannelOutput only(const std::string& text) { return test::scene(text).cameras.at(0).outputs.at(0); }

std::string refusal(const std::string& text) {
  try {
    test::scene(text);
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Rationale: the library's microbolometer responds to 14.8 um, the library's air ends near 14.2 um. Expected: taken, with the share left out in words;
// the share is that of the trapezoids of its table beyond the air's end.
TEST(Coverage, MicrobolometerIsCutWhereLibraryAirEnds) {
  for (const char* air : {"clear_us76", "hazy_us76", "clear_mls", "hazy_mls"}) {
    const ChannelOutput o = only(yaml(air, "microbolometer_lwir")), whole = only(yaml("none", "microbolometer_lwir"));
    const Simulation sim = test::scene(yaml(air, "microbolometer_lwir"));
    const double end = sim.air->validHigh_um();
    EXPECT_LT(end, 14.8);
    EXPECT_DOUBLE_EQ(o.kernel.supportHigh(), end);
    EXPECT_DOUBLE_EQ(o.bandHigh_um, end);
    EXPECT_TRUE(whole.cut.empty());
    const double share = whole.kernel.integral(end, 14.8) / whole.kernel.integral(7.4, 14.8);
    EXPECT_GT(share, 1e-4);
    EXPECT_LT(share, kMostCut);
    char said[32];
    std::snprintf(said, sizeof said, "%.2g %% of its response", 100.0 * share);
    EXPECT_TRUE(has(o.cut, said)) << o.cut;
    EXPECT_TRUE(has(o.cut, "where the atmosphere has no data")) << o.cut;
    // 1e-12: Gauss points between the same knots and one more.
    EXPECT_NEAR(o.kernel.integral(7.4, end) / whole.kernel.integral(7.4, end), 1.0, 1e-12);
  }
}

// Expected: what is above the share allowed is refused, the message names the share, and the fix it offers is taken as it stands.
TEST(Coverage, MoreIsRefusedWithAFixThatHelps) {
  const std::string said = refusal(yaml("clear_us76", "{band: [8 um, 15 um]}"));
  EXPECT_TRUE(has(said, "the atmosphere has no data for channel 'lw' (8 um to 15 um): ")) << said;
  const double end = test::scene(yaml("clear_us76", "{band: [8 um, 9 um]}")).air->validHigh_um();
  char share[32];
  std::snprintf(share, sizeof share, "%.2g %% of its response", 100.0 * (15.0 - end) / 7.0);
  EXPECT_TRUE(has(said, share)) << said;
  const size_t open = said.find("{product: [<the response>, "), close = said.find("]}'", open);
  ASSERT_NE(open, std::string::npos) << said;
  std::string fix = said.substr(open, close + 2 - open);
  fix.replace(fix.find("<the response>"), 14, "{band: [8 um, 15 um]}");
  EXPECT_EQ(refusal(yaml("clear_us76", fix)), "") << fix;
  EXPECT_TRUE(only(yaml("clear_us76", fix)).cut.empty());
  EXPECT_TRUE(has(refusal(yaml("clear_us76", "{band: [20 um, 25 um]}")), "all of its response lies beyond"));
}

// A band of width 1 whose last 0.4 % or 0.6 % a material's table does not cover.
TEST(Coverage, TheShareDecides) {
  auto withTable = [&](double end_um) {
    std::string text = yaml("none", "{band: [8 um, 9 um]}", "[radiance, radiance_per_um]");
    char material[160];
    std::snprintf(material, sizeof material,
                  "{components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[7, 0.1], [%.4f, 0.1]]}}]}", end_um);
    return text.replace(text.find("{m: {}}"), 7, std::string("{m: ") + material + "}");
  };
  const Simulation sim = test::scene(withTable(8.996));
  const auto& outputs = sim.cameras.at(0).outputs;
  EXPECT_TRUE(has(outputs[0].cut, "0.4 % of its response's integral lies beyond 8.996 um, where material 'm' has no data")) << outputs[0].cut;
  // Per the integral of what is left: a flat radiance of 1 stays 1.
  EXPECT_NEAR(outputs[1].scale * outputs[1].kernel.integral(8.0, 8.996), 1.0, 1e-12);
  const std::string said = refusal(withTable(8.994));
  EXPECT_TRUE(has(said, "material 'm' has no data for channel 'lw'")) << said;
  EXPECT_TRUE(has(said, "0.6 % of its response's integral lies beyond")) << said;
}

}  // namespace
}  // namespace pitviper
