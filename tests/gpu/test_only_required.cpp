// Only what the scene requires: a feature taken out of a scenario leaves neither code in the programs that draw it nor numbers in their tables. Each
// case names what must be there with the feature and gone without it.
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>

#include "scenarios/commands/commands.hpp"
#include "sim/camera/camera_renderer.hpp"
#include "sim/plan/planner.hpp"
#include "sim/render/buffered_pass.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/render/surface/shading_program.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

/// A scenario with one of everything, and what to leave out.
struct Features {
  bool air = true, sun = true, lamp = true, ambient = true, shadows = true, truth = true;
  bool temperatureTexture = true, modifier = true, angular = true, phong = true, reflection = true;
  bool pane = true, paneReflects = true, plume = true, secondPlume = true, meshedSmoke = true;
  bool visible = true;  ///< a channel in the visible beside the long-wave one
  std::string sampling = ", spectral: {samples: 4}";
  std::string accuracy;
  std::string atmosphere = "hazy_us76", ball = "300 K", lampArea = "0.01 m2", elevation = "40 deg", lens = "20 deg";
};

std::string textOf(const Features& f) {
  std::string s = f.accuracy;
  if (f.air) s += "atmosphere: " + f.atmosphere + "\n";
  if (f.sun) s += "sun: {azimuth: 200 deg, elevation: " + f.elevation + ", temperature: 5772 K}\n";
  if (f.ambient) s += "ambient: {temperature: 260 K}\n";
  if (!f.shadows) s += "render: {shadows: false}\n";
  s += "materials:\n";
  s += std::string("  plain: {components: [") + (f.reflection ? "{reflection: lambertian, reflectance: 0.1" : "") +
       (f.reflection && f.modifier ? ", modifier: {rows: [[0.2, 1]]}" : "") + (f.reflection ? "}" : "") + "]}\n";
  if (f.angular)
    s += "  angular: {components: [{reflection: table, wavelength: [0.3 um, 15 um], angles: [{angle: specular, count: 3, last: 90 deg}], "
         "values: [[0.2, 0.2], [0.05, 0.05], [0, 0]]}]}\n";
  if (f.phong) s += "  shiny: {components: [{reflection: phong, reflectance: 0.3, exponent: 20}]}\n";
  if (f.pane)
    s += std::string("  pane: {transmission: {transmittance: 0.7}") + (f.paneReflects ? ", components: [{reflection: lambertian, reflectance: 0.1}]" : "") +
         "}\n";
  s += "  gas: {absorption: 0.01 /m}\n";
  if (f.lamp) s += "lights: [{name: lamp, intensity: {blackbody: 2500 K, area: " + f.lampArea + "}, position: [20 m, 180 m, 40 m]}]\n";
  s += "entities:\n";
  auto body = [&](const std::string& name, const std::string& shape, const std::string& material, const std::string& temperature, const std::string& at) {
    s += "- {name: " + name + ", shape: {" + shape + "}, material: " + material + ", temperature: " + temperature + ", position: [" + at + "]}\n";
  };
  body("ground", "model: box, length: 200 m, width: 200 m, height: 1 m", "plain", f.temperatureTexture ? "{rows: [[280 K, 300 K]]}" : "290 K",
       "0 m, 200 m, 0 m");
  body("ball", "model: sphere, radius: 5 m", "plain", f.ball, "0 m, 200 m, 20 m");
  if (f.angular) body("tabulated", "model: sphere, radius: 5 m", "angular", "300 K", "12 m, 200 m, 20 m");
  if (f.phong) body("glossy", "model: sphere, radius: 5 m", "shiny", "300 K", "-12 m, 200 m, 20 m");
  if (f.pane) body("window", "model: plate, width: 8 m, height: 8 m", "pane", "290 K", "0 m, 150 m, 20 m");
  if (f.plume) body("plume", "model: cone, radius: 2 m, length: 10 m", "gas", "600 K", "5 m, 170 m, 20 m");
  if (f.secondPlume) body("puff", "model: sphere, radius: 3 m", "gas", "500 K", "6 m, 170 m, 20 m");
  if (f.meshedSmoke) body("smoke", "model: box, length: 4 m, width: 4 m, height: 4 m", "gas", "310 K", "-6 m, 170 m, 20 m");
  s += "cameras: [{name: c, film: {width: 16, height: 16}, field_of_view: " + f.lens +
       ", aperture: 10 mm, position: [0 m, 0 m, 30 m], look_at: ball" + f.sampling;
  if (f.truth) s += ", truth: [range, temperature, solid_angles]";
  s += ",\n  channels: [{name: lw, response: {band: [8 um, 12 um]}}" + std::string(f.visible ? ", {name: vis, response: {band: [0.5 um, 0.7 um]}}" : "") +
       "]}]\n";
  return s;
}

/// Everything that is not opaque: buffered mode is for it alone.
Features opaque(Features f = {}) {
  f.pane = f.plume = f.secondPlume = f.meshedSmoke = false;
  return f;
}

/// A scenario with its plan and the pass that draws it; program texts without comments.
struct Built {
  explicit Built(const Features& f) : sim(scene(textOf(f))), plan(planFor(sim, {&sim.cameras[0], nullptr})) {
    needContext();
    pass = makeScenePass(sim, plan, shaderLibrary(), std::make_shared<const GpuScene>(sim), sim.cameras[0].truth.any(), 1.0);
    static const std::regex comment("//[^\n]*");
    for (const NamedProgram& p : pass->programs()) programs.push_back({p.name, std::regex_replace(p.text, comment, "")});
  }
  /// Whether any program, or all of a name, holds a text.
  bool holds(const std::string& text, const std::string& program = "") const {
    return std::any_of(programs.begin(), programs.end(),
                       [&](const NamedProgram& p) { return (program.empty() || p.name == program) && p.text.find(text) != std::string::npos; });
  }
  long long count(const std::string& program) const {
    return std::count_if(programs.begin(), programs.end(), [&](const NamedProgram& p) { return p.name == program; });
  }
  const RenderTables& tables() const { return pass->tables(); }
  size_t nodes() const { return static_cast<size_t>(plan.nodeCount()); }

  Simulation sim;
  Plan plan;
  std::unique_ptr<ScenePass> pass;
  /// Of programs: those of several classes of surfaces are of one kind.
  std::set<std::string> kinds() const {
    std::set<std::string> all;
    for (const NamedProgram& p : programs) all.insert(p.name);
    return all;
  }
  std::vector<NamedProgram> programs;
};

void expectGone(const Built& with, const Built& without, const std::vector<std::string>& texts, const std::string& program = "") {
  for (const auto& t : texts) {
    EXPECT_TRUE(with.holds(t, program)) << "'" << t << "' is nowhere: the test looks for the wrong thing";
    EXPECT_FALSE(without.holds(t, program)) << "'" << t << "' stays";
  }
}

/// Names of uniform blocks, buffers and samplers of a program: what it can read.
std::set<std::string> readsOf(const std::string& text) {
  static const std::regex declared("layout\\([^)]*binding[^)]*\\)\\s*(?:readonly |writeonly )?(?:uniform|buffer)\\s+(\\w+)(?:\\s+(\\w+)\\s*;)?");
  std::set<std::string> names;
  for (std::sregex_iterator m(text.begin(), text.end(), declared), end; m != end; ++m) names.insert((*m)[2].matched ? (*m)[2].str() : (*m)[1].str());
  return names;
}

// Rationale: a change of a number compiles nothing, for no program has it in its text; found where a text is another.
TEST(OnlyRequired, NumbersAreInBuffers) {
  for (const Features& f : {Features{}, opaque()}) {
    Features other = f;
    other.atmosphere = "{library: hazy_us76, visibility: 9 km}";
    other.ball = "317 K", other.lampArea = "0.02 m2", other.elevation = "31 deg", other.lens = "17 deg";
    const Built one(f), two(other);
    ASSERT_EQ(one.programs.size(), two.programs.size());
    EXPECT_NE(one.plan.fingerprint, two.plan.fingerprint) << "they are two plans";
    for (size_t i = 0; i < one.programs.size(); ++i) EXPECT_TRUE(one.programs[i].text == two.programs[i].text) << one.programs[i].name;
  }
}

TEST(OnlyRequired, Air) {
  for (const Features& f : {Features{}, opaque()}) {
    Features less = f;
    less.air = false;
    const Built with(f), without(less);
    expectGone(with, without, {"airAmounts", "airRadiance", "AirBlock", "AIR_VECTORS", "airDepth", "airHeight", "airPart"});
    EXPECT_TRUE(with.plan.terms.air && with.plan.terms.scatteredSun && with.plan.sunLegs);
    EXPECT_FALSE(without.plan.terms.air || without.plan.terms.scatteredSun || without.plan.sunLegs);
  }
}

TEST(OnlyRequired, Sun) {
  Features less;
  less.sun = false;
  const Built with(Features{}), without(less);
  expectGone(with, without, {"const int LIGHTS = 2;", "const int SUN = 1;", "const int AIR_PARTS = 4;"});
  EXPECT_TRUE(without.holds("const int LIGHTS = 1;") && without.holds("const int SUN = 0;") && without.holds("const int AIR_PARTS = 1;"));
}

// Neither sun nor lamp: no light in any program, no shadows, no reflection columns, no lobes.
TEST(OnlyRequired, Lights) {
  for (const Features& f : {Features{}, opaque()}) {
    Features less = f;
    less.sun = less.lamp = false;
    const Built with(f), without(less);
    expectGone(with, without,
               {"lightAt", "samplerBuffer lights", "nodeLight", "Real lobeOf(", "Vec3 lobes(", "0.159154943091895", "Vec3 reflectionColumns(",
                "reflectionColumns", "shareSeen", "meetsTree", "shadowMaps", "angleOf"});
    EXPECT_EQ(with.count("shadow maps"), 1);
    EXPECT_EQ(without.count("shadow maps"), 0);
    EXPECT_GT(with.tables().solid.columns.size(), 0u);
    EXPECT_EQ(without.tables().solid.columns.size(), 0u);
    const WorldState state = advance(with.sim, 0.0), dark = advance(without.sim, 0.0);
    EXPECT_EQ(lightTable(with.sim, with.plan, state).size(), 4 * with.nodes());
    EXPECT_EQ(lightTable(without.sim, without.plan, dark).size(), 0u);
  }
  // Of plain surfaces a row is four numbers a node where light falls on them, else one.
  Features plain = opaque();
  plain.temperatureTexture = plain.modifier = plain.angular = plain.phong = false;
  Features dark = plain;
  dark.sun = dark.lamp = false;
  const Built with(plain), without(dark);
  EXPECT_EQ(with.tables().solid.rows.size(), 4 * with.nodes() * with.tables().draws.size());
  EXPECT_EQ(without.tables().solid.rows.size(), 4 * ((without.nodes() + 3) / 4) * without.tables().draws.size());
  expectGone(with, without, {"usamplerBuffer materials", "lobeOf"});
}

// Surfaces that reflect nothing ask for no light, unless truth layers show its geometry.
TEST(OnlyRequired, LightThatNothingReflects) {
  Features black = opaque();
  black.reflection = black.angular = black.phong = black.truth = false;
  black.modifier = false;
  Features grey = black;
  grey.reflection = true;
  const Built with(grey), without(black);
  expectGone(with, without, {"lightAt", "nodeLight", "shareSeen", "shadowMaps"});
  EXPECT_EQ(with.plan.lightCount, 2);
  EXPECT_EQ(without.plan.lightCount, 0);
  black.truth = true;
  EXPECT_EQ(Built(black).plan.lightCount, 2);
}

TEST(OnlyRequired, AmbientLight) {
  for (const Features& f : {Features{}, opaque()}) {
    Features less = f;
    less.ambient = false;
    const Built with(f), without(less);
    expectGone(with, without, {"nodeAmbient"});
    EXPECT_EQ(with.tables().ambient.size(), 4 * with.nodes());
    EXPECT_EQ(without.tables().ambient.size(), 0u);
  }
}

TEST(OnlyRequired, Textures) {
  const Built all(opaque());
  Features f = opaque();
  f.temperatureTexture = false;
  const Built uniform(f);
  expectGone(all, uniform, {"planckFromConstants(nodes"});
  EXPECT_TRUE(uniform.holds("textureValue(")) << "of the modifier";
  f = opaque();
  f.modifier = false;
  const Built plain(f);
  EXPECT_TRUE(plain.holds("textureValue(")) << "of the temperature";
  expectGone(all, plain, {"modifierAt(int texture) { return texture < 0"});
  f.temperatureTexture = false;
  const Built none(f);
  expectGone(all, none, {"textureValue", "samplerBuffer texels", "usamplerBuffer textureShapes"});
}

// Of plain surfaces, whose rows hold the dome's light, the plan has to ask for it by itself.
TEST(OnlyRequired, AmbientLightOfPlainSurfacesIsPlannedFor) {
  Features f = opaque();
  f.air = f.sun = f.lamp = f.truth = f.temperatureTexture = f.modifier = f.angular = f.phong = false;
  f.sampling = "";
  f.accuracy = "accuracy: 1 %\n";
  const Built plain(f);
  EXPECT_FALSE(plain.tables().solid.general);
  EXPECT_TRUE(plain.plan.terms.ambient);
  EXPECT_FALSE(plain.holds("nodeAmbient"));
  // A dome of 60 K adds nothing that a channel would notice beside 300 K.
  Simulation cold = plain.sim;
  cold.ambient = Spectrum(Spectrum::BlackBody{60.0, 1.0});
  EXPECT_FALSE(planFor(cold, {&cold.cameras[0], nullptr}).terms.ambient);
}

// With an accuracy nodes are groups of wavelengths, whose mean Planck radiance is a table where a temperature is a texture.
TEST(OnlyRequired, PlanckTable) {
  Features f = opaque();
  f.sampling = "";
  f.accuracy = "accuracy: 5 %\n";
  f.visible = f.modifier = f.angular = f.phong = false;
  Features less = f;
  less.temperatureTexture = false;
  const Built with(f), without(less);
  expectGone(with, without, {"PLANCK_AT", "PLANCK_ENTRIES", "uniform samplerBuffer hemispherical"});
  const size_t row = (with.nodes() + 3) / 4, parts = row * with.tables().draws.size();  // texels of four nodes; the background is a draw
  EXPECT_EQ(with.tables().solid.rows.size(), 4 * (parts + 1 + 512 * row));
  EXPECT_EQ(with.tables().solid.planckAt, static_cast<long long>(parts));
  EXPECT_EQ(without.tables().solid.planckAt, -1);
}

TEST(OnlyRequired, TablesOverAngles) {
  Features f = opaque();
  f.modifier = f.temperatureTexture = f.phong = false;
  Features less = f;
  less.angular = false;
  const Built with(f), without(less);
  expectGone(with, without, {"angleOf", "angleFromChord", "uniform samplerBuffer hemispherical", "uniform samplerBuffer columns", "material_"});
  EXPECT_GT(with.tables().solid.columns.size(), 0u);
  EXPECT_GT(with.tables().solid.hemispherical.size(), 0u);
  EXPECT_EQ(without.tables().solid.columns.size() + without.tables().solid.hemispherical.size(), 0u);
  // A table over angles among textured materials: the others need no angles but the view's.
  less.modifier = true;
  expectGone(with, Built(less), {"angleOf"});
}

TEST(OnlyRequired, Lobes) {
  Features less = opaque();
  less.phong = false;
  expectGone(Built(opaque()), Built(less), {"0.159154943091895"}, "shading");
}

TEST(OnlyRequired, Shadows) {
  for (const Features& f : {Features{}, opaque()}) {
    Features less = f;
    less.shadows = false;
    const Built with(f), without(less);
    expectGone(with, without, {"shadowMaps", "meetsTree", "usamplerBuffer trees", "mapSays"});
    EXPECT_EQ(with.count("shadow maps"), 1);
    EXPECT_EQ(without.count("shadow maps"), 0);
    EXPECT_TRUE(without.holds("lightAt")) << "light stays";
  }
}

TEST(OnlyRequired, TransparentThings) {
  const Built all(Features{});
  const auto kMedia = {"media", "hits of media", "borders of meshed media"}, kPanes = {"transparent surfaces", "hits of panes"};
  for (const auto& names : {kMedia, kPanes, {"order of hits", "lines through what is transparent", "integration"}})
    for (const char* name : names) EXPECT_EQ(all.count(name), 1) << name;
  EXPECT_GT(all.tables().layer.transmittance.size(), 0u);

  Features f;
  f.pane = false;
  const Built noPane(f);
  for (const char* name : kPanes) EXPECT_EQ(noPane.count(name), 0) << name;
  for (const char* name : kMedia) EXPECT_EQ(noPane.count(name), 1) << name;
  expectGone(all, noPane, {"transmittances"});
  EXPECT_EQ(noPane.tables().layer.transmittance.size() + noPane.tables().layer.rows.size() + noPane.tables().layer.materials.size(), 0u);

  f = {};
  f.plume = f.secondPlume = f.meshedSmoke = false;
  const Built noMedia(f);
  for (const char* name : kMedia) EXPECT_EQ(noMedia.count(name), 0) << name;
  EXPECT_EQ(noMedia.count("transparent surfaces"), 1);
  expectGone(all, noMedia, {"uniform samplerBuffer media", "pathDepth(i, near_"});
  EXPECT_EQ(all.tables().media.size(), 3 * 8 * ((all.nodes() + 3) / 4));
  EXPECT_EQ(noMedia.tables().media.size(), 0u);

  f = {};
  f.meshedSmoke = false;
  const Built noMesh(f);
  EXPECT_EQ(noMesh.count("borders of meshed media"), 0);
  EXPECT_EQ(noMesh.count("hits of media"), 1);
  f = {};
  f.plume = f.secondPlume = false;
  EXPECT_EQ(Built(f).count("hits of media"), 0);

  f = {};
  f.paneReflects = false;
  expectGone(all, Built(f), {"lightAt", "nodeLight[i", "shareSeen"}, "transparent surfaces");

  // Nothing transparent: no spectral image, no passes over it.
  const Built none(opaque());
  EXPECT_NE(dynamic_cast<const BufferedPass*>(all.pass.get()), nullptr);
  EXPECT_NE(dynamic_cast<const DirectPass*>(none.pass.get()), nullptr);
  expectGone(all, none, {"spectrum0"});
  EXPECT_EQ(none.kinds().size(), 2u) << "shadow maps and shading";
  EXPECT_EQ(all.kinds().size(), 11u);
}

// A program for each class of surfaces has what these need: the sky no light, the plainest surfaces no textures, lobes and tables.
TEST(OnlyRequired, EachClassHasItsOwn) {
  const Built b(opaque());
  const auto having = [&](const std::string& text) {
    return std::count_if(b.programs.begin(), b.programs.end(),
                         [&](const NamedProgram& p) { return p.name == "shading" && p.text.find(text) != std::string::npos; });
  };
  EXPECT_EQ(b.count("shading"), 8) << "sky; plain, the ground that air lies on; with textures; with lobes and tables over angles: but the last each with all "
                                      "lights, with these where nothing stands before any, and with the sun alone";
  EXPECT_EQ(having("LightHere lightAt("), 7);
  EXPECT_EQ(having("bool meetsTree("), 3) << "shadows";
  EXPECT_EQ(having("AirPath lightAir0_"), 5) << "lamps";
  EXPECT_EQ(having("Real phongLobe("), 1);
  EXPECT_EQ(having("float angleOf("), 1);
  EXPECT_EQ(having("int planckEntry_") + having("planckFromConstants(nodes.node[i].z"), 3);
  EXPECT_EQ(having("float textureValue("), 3);
}

TEST(OnlyRequired, TruthLayers) {
  for (const Features& f : {Features{}, opaque()}) {
    Features less = f;
    less.truth = false;
    const Built with(f), without(less);
    expectGone(with, without, {"truthGeometry", "truthNormal", "truthIdentity"});
    EXPECT_EQ(with.programs.size() - without.programs.size(), f.pane ? 1u : 0u) << "a pass of its own in buffered mode";
  }
}

// Wavelengths, targets and weights follow the channels.
TEST(OnlyRequired, Channels) {
  Features less = opaque();
  less.visible = false;
  const Built with(opaque()), without(less);
  EXPECT_EQ(with.nodes(), 8u);
  EXPECT_EQ(without.nodes(), 4u);
  EXPECT_EQ(with.tables().weights.size(), 8u) << "each node feeds one channel";
  EXPECT_EQ(without.tables().weights.size(), 4u);
  EXPECT_EQ(with.tables().node.size(), 2 * without.tables().node.size());
  EXPECT_EQ(with.tables().solid.columns.size(), 2 * without.tables().solid.columns.size());
  EXPECT_EQ(with.tables().solid.hemispherical.size(), 2 * without.tables().solid.hemispherical.size());
}

// What is left when everything is left out: black bodies in a vacuum.
TEST(OnlyRequired, BarestProgram) {
  Features f = opaque();
  f.air = f.sun = f.lamp = f.ambient = f.truth = f.temperatureTexture = f.modifier = f.angular = f.phong = f.reflection = f.visible = false;
  const Built bare(f);
  EXPECT_EQ(bare.kinds(), std::set<std::string>{"shading"});
  std::set<std::string> least{"visibility", "viewTexels", "NodeBlock", "rows", "draws", "vertices", "indices", "weightsNumbers"};
  if (chooseShadingStage() == ShadingStage::Compute) least.insert({"classes", "image0"});  // what a fragment has from depth and targets
  EXPECT_EQ(readsOf(bare.programs.back().text), least);
  std::set<std::string> all;
  for (const NamedProgram& p : Built(opaque()).programs)
    if (p.name == "shading") all.merge(readsOf(p.text));
  for (const char* name : {"hemispherical", "columns", "materials", "texels", "textureShapes", "lights", "shadows", "trees", "shadowMaps", "AirBlock",
                           "airAmounts", "airRadiance"})
    EXPECT_TRUE(all.count(name)) << name;
  const RenderTables& t = bare.tables();
  EXPECT_EQ(t.solid.rows.size(), 4u * t.draws.size()) << "a number a node for each part and the background";
  EXPECT_EQ(t.node.size(), 4u * 4u);
  EXPECT_EQ(t.weights.size(), 4u);
  EXPECT_EQ(t.solid.columns.size() + t.solid.hemispherical.size() + t.solid.transmittance.size() + t.media.size() + t.ambient.size(), 0u);
}

// What the plan finds too little of to matter at the accuracy: sunlight in the long wave.
TEST(OnlyRequired, WhatNoChannelWouldNotice) {
  Features f = opaque();
  f.lamp = f.truth = f.angular = f.phong = false;
  f.sampling = "";
  f.accuracy = "accuracy: 10 %\n";
  Features lw = f;
  lw.visible = false;
  const Built both(f), longWave(lw);
  // The sun is in the scenario of either; in the visible it is all there is.
  EXPECT_TRUE(both.plan.terms.lights && both.plan.terms.shadows && both.plan.terms.scatteredSun);
  EXPECT_FALSE(longWave.plan.terms.lights || longWave.plan.terms.shadows || longWave.plan.terms.scatteredSun);
  EXPECT_EQ(longWave.plan.lightCount, 0);
  expectGone(both, longWave, {"lightAt", "nodeLight", "shareSeen", "shadowMaps", "const int AIR_PARTS = 4;", "Vec3 reflectionColumns("});
  EXPECT_EQ(both.count("shadow maps"), 1);
  EXPECT_EQ(longWave.count("shadow maps"), 0);
  // With both channels the sun is looked for in the visible one's loop alone.
  ASSERT_EQ(both.plan.blocks.size(), 2u);
  EXPECT_FALSE(both.plan.blocks[0].lit);
  EXPECT_TRUE(both.plan.blocks[1].lit);
  EXPECT_TRUE(both.holds("= nodeRadianceUnlit(0)") && both.holds("= nodeRadiance(" + std::to_string(both.plan.blocks[1].first) + ")"));
  // Asked for more closely it counts.
  Features close = lw;
  close.accuracy = "accuracy: 0.1 %\n";
  EXPECT_TRUE(Built(close).plan.terms.lights);
  // No sight of it without an accuracy: nothing is known of its share.
  Features sampled = lw;
  sampled.accuracy = "";
  sampled.sampling = ", spectral: {samples: 4}";
  EXPECT_TRUE(Built(sampled).plan.terms.lights);
}

// A frame costs no more passes than it has use for: of a scenario with a window the camera draws a view without it in direct mode.
TEST(OnlyRequired, NoSpectralImageWhereNothingTransparentIsInView) {
  Features f;
  f.plume = f.secondPlume = f.meshedSmoke = false;
  const Simulation seen = scene(textOf(f));
  Simulation hidden = seen;
  for (Entity& e : hidden.entities)
    if (e.name == "window") e.motion = Motion(Pose{{0.0, -500.0, 20.0}, {1.0, 0.0, 0.0, 0.0}});
  for (const bool behind : {false, true}) {
    const Simulation& sim = behind ? hidden : seen;
    CameraRenderer renderer(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), std::make_shared<const GpuScene>(sim));
    renderer.render(advance(sim, 0.0));
    EXPECT_EQ(renderer.isBuffered(), !behind);
  }
}

}  // namespace
}  // namespace pitviper::test
