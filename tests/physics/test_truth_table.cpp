// Rows of targets and terms of light against closed forms and against the reference.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "materials/fields/flares.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/frame/truth_table.hpp"
#include "sim/model/stage.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

const TargetRow& row(const Frame& f, const std::string& name) {
  for (const TargetRow& t : f.targets)
    if (t.name == name) return t;
  throw std::runtime_error("no target " + name);
}

std::string camera(const std::string& more, const std::string& place = "position: [0 m, 0 m, 0 m], heading: 90 deg") {
  return "cameras: [{name: c, film: {width: 128, height: 96, pitch: 15 um}, focal_length: 100 mm, aperture: 25 mm, exposure: 4 ms, truth: [targets, terms], " +
         place + ", " + more + "channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n";
}

// A ball far away: epsilon B pi r^2, less what it hides for the contrast; at any range.
TEST(TruthTable, ABallsIntensityAtAnyRange) {
  const double own = 0.7 * blackBodyBand(3.6, 4.9, 400.0), behind = blackBodyBand(3.6, 4.9, 290.0), area = kPi * 4.0;
  for (double range : {300.0, 2000.0, 20000.0, 2e5}) {  // 90 pixels across to a tenth
    const Frame f =
        renderFrame(scene("background: {temperature: 290 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\nentities: [{name: "
                          "ball, shape: {model: sphere, radius: 2 m, segments: "
                          "256}, material: m, temperature: 400 K, position: [" +
                          std::to_string(range) + " m, 0 m, 0 m]}]\n" + camera("")));
    const TargetRow& t = row(f, "ball");
    // Seen from a range R a ball shows the cap up to its horizon: pi r^2 / (1 - (r / R)^2) of solid angle times R^2, nearly.
    const double seen = 2.0 * kPi * (1.0 - std::sqrt(1.0 - std::pow(2.0 / range, 2.0))) * range * range;
    figure(print("own intensity of a ball at %g m [W/sr]", range), t.channels[0].own, own * seen, 3e-3, "256 segments are 1e-4 short; outline on its lines");
    figure(print("its contrast at %g m [W/sr]", range), t.channels[0].contrast, (own - behind) * seen, 3e-3, "the same");
    EXPECT_NEAR(t.channels[0].total, t.channels[0].own, 1e-9 * t.channels[0].own) << "no air, nothing reflected";
    EXPECT_NEAR(seen, area, 0.01 * area);
    EXPECT_NEAR(t.visible, 1.0, 1e-12);
    EXPECT_NEAR(t.column, 64.0, 1e-6);
    EXPECT_NEAR(t.range_m, range, 1e-6 * range);
    EXPECT_NEAR(t.right - t.left, 4.0 / range * 100e-3 / 15e-6, 0.02 * 4.0 / range * 100e-3 / 15e-6);
  }
}

// Against the reference: what its pixels add up to within the accuracy asked, in air, with a lamp, a plume before it and a hot part.
TEST(TruthTable, AgreesWithTheReference) {
  const std::string world =
      "atmosphere: {model: homogeneous, extinction: 0.05 /km, temperature: 288 K}\nbackground: {temperature: 200 K}\nmaterials: {m: {components: [{reflection: "
      "lambertian, reflectance: 0.4}]}, g: "
      "{medium: gas, absorption: 0.05 /m}}\nlights: [{name: lamp, visible: false, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 3e5], [6, 3e5]]}, "
      "position: [-100 m, 300 m, 100 m]}]\n"
      "entities:\n- {name: jet, shape: {model: jet}, material: m, temperature: 330 K, position: [RANGE m, 0 m, 0 m], heading: 30 deg}\n- {name: plume, shape: "
      "{model: ellipsoid, length: 12 m, "
      "width: 2 m, height: 2 m}, material: g, temperature: 700 K, position: [RANGE m, -12 m, 0 m]}\n";
  double empty = -1.0;  // of the film without bodies, whatever they were: over steradians
  for (double range : {300.0, 3000.0, 60000.0}) {
    std::string here = world;
    for (size_t k = here.find("RANGE"); k != std::string::npos; k = here.find("RANGE")) here.replace(k, 5, std::to_string(range));
    const Frame f = renderFrame(scene("accuracy: 1 %\n" + here + camera("")));
    const auto sumOf = [&](const std::string& bodies) {  // of the reference, L w_pix R^2
      std::string text = here;
      if (bodies == "none") text = text.substr(0, text.find("entities:"));
      Simulation sim = scene("accuracy: reference\n" + text + camera("samples: 4, "));
      sim.cameras[0].truth = {};
      sim.cameras[0].zoomedSamples = 64;  // of each subpixel's side: an outline to a thousandth
      const Frame g = renderFrame(sim);
      const auto sr = sim.cameras[0].pinhole.solidAngles().plain_sr;
      double all = 0.0;
      for (size_t p = 0; p < sr.size(); ++p) all += sr[p] * static_cast<double>(layer(g, "mw.radiance").pixels[p]);
      return all;
    };
    if (empty < 0.0) empty = sumOf("none");
    // Both together: contrasts of things that hide each other do not add up, but the plume's beside the jet do.
    const double both = (sumOf("all") - empty) * range * range;
    const double told = row(f, "jet").channels[0].contrast + row(f, "plume").channels[0].contrast;
    figure(print("contrast of a jet and its plume at %g m [W/sr]", range), told, both, 0.02,
           "1 % of each asked for; where one is before the other both count it");
  }
}

// Far things in a spectral air, lit by the sun: of contrasts that are a small part of their pixels' light the accuracy is kept too. In narrow bands,
// as the reference is dear; a plume's is the dearest.
TEST(TruthTable, FaintContrastsHaveEveryWavelength) {
  const std::string air = "sun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\natmosphere: {library: clear_us76, visibility: 10 km}\n";
  const std::string bodies =
      "materials: {m: {components: [{reflection: lambertian, reflectance: 0.4}]}}\nentities: [{name: ball, shape: {model: sphere, radius: 2 m, segments: 48}, "
      "material: m, temperature: 300 K, position: [RANGE m, 0 m, 600 m]}]\nlights: [{name: lamp, intensity: {blackbody: 1500 K, area: 0.01 m2}, position: "
      "[RANGE m, -30 m, 600 m]}]\n";
  const std::string plume =
      "plumes: [{name: p, position: [RANGE m, 0 m, 600 m], direction: [0, 1, 0], length: 12 m, engine: turbofan_military, begin: -1 s}]\n";
  const auto rows = [&](const std::string& things, const char* band, double range, const char* accuracy) {
    std::string world = air + things +
                        "cameras: [{name: c, film: {width: 64, height: 48, pitch: 15 um}, focal_length: 60 mm, aperture: 25 mm, truth: [targets], " +
                        "position: [0 m, 0 m, 100 m], heading: 90 deg, pitch: " + print("%g deg", std::atan2(500.0, range) * 180.0 / kPi) +
                        ", channels: [{name: mw, response: {band: " + band + "}}]}]\n";
    for (size_t k = world.find("RANGE"); k != std::string::npos; k = world.find("RANGE")) world.replace(k, 5, std::to_string(range));
    const Simulation sim = scene("accuracy: " + std::string(accuracy) + "\n" + world);
    needContext();
    return TruthMeter(sim, sim.cameras[0]).targets(advance(sim, 0.0));
  };
  const auto compare = [&](const std::string& things, const char* band, double range) {
    const std::vector<TargetRow> planned = rows(things, band, range, "1 %"), exact = rows(things, band, range, "reference");
    ASSERT_EQ(planned.size(), exact.size());
    for (size_t k = 0; k < planned.size(); ++k)
      figure("contrast of a " + planned[k].kind + print(" at %g km [W/sr]", 1e-3 * range), planned[k].channels[0].contrast, exact[k].channels[0].contrast, 0.01,
             "as asked; it is a hundredth of its pixel's light and less");
  };
  compare(bodies, "[4.4 um, 4.8 um]", 25000.0);
  compare(plume, "[4.5 um, 4.6 um]", 25000.0);
}

// What hides a body, the film's edge, the turning of the line of sight.
TEST(TruthTable, SharesAndRates) {
  const Frame f =
      renderFrame(scene("time: {rate: 50 Hz, frames: 2}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: []}}\nentities:\n- {name: ball, shape: "
                        "{model: sphere, radius: 2 m}, material: m, temperature: 400 "
                        "K, motion: [{time: -1 s, position: [1000 m, 100 m, -50 m]}, {time: 1 s, position: [1000 m, -100 m, 50 m]}]}\n- {name: wall, shape: "
                        "{model: plate, width: 10 m, height: 10 m}, material: m, "
                        "temperature: 290 K, position: [900 m, 5 m, 0 m], heading: 270 deg}\n- {name: edge, shape: {model: sphere, radius: 2 m}, material: m, "
                        "temperature: 400 K, position: [1000 m, -9.6 m, 0 m]}\n" +
                        camera("")));
  const TargetRow& ball = row(f, "ball");
  figure("turning of the line of sight to the right [rad/s]", ball.sightRight_rad_s, 0.1, 1e-4, "100 m/s at 1 km");
  figure("turning upwards [rad/s]", ball.sightUp_rad_s, 0.05, 1e-4, "50 m/s at 1 km");
  EXPECT_NEAR(ball.rangeRate_m_s, 0.0, 1e-3);
  figure("share of a ball that a wall's edge leaves", ball.visible, 0.5, 0.03, "half");
  figure("share of a ball that the film's edge leaves", row(f, "edge").visible, 0.5, 0.03, "half");
  EXPECT_GT(row(f, "wall").channels[0].total, 0.0);
  const double hidden = 0.5 * kPi * 4.0 * 0.81 * (blackBodyBand(3.6, 4.9, 400.0) - blackBodyBand(3.6, 4.9, 290.0));
  figure("contrast of a wall as warm as what is behind it, but for half a ball [W/sr]", row(f, "wall").channels[0].contrast, -hidden, 0.02,
         "what it hides, at its own range");
}

// The same bits every time, however many work at it.
TEST(TruthTable, IsTheSameEveryTime) {
  const Simulation sim = scene(
      "background: {temperature: 290 K}\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\nentities: [{name: ball, shape: {model: "
      "sphere, radius: 2 m}, material: m, "
      "temperature: 400 K, position: [300 m, 0 m, 0 m]}]\n" +
      camera(""));
  needContext();
  const TruthMeter meter(sim, sim.cameras[0]);
  const WorldState state = advance(sim, 0.0);
  const double first = meter.targets(state)[0].channels[0].own;
  for (int k = 0; k < 8; ++k) EXPECT_EQ(meter.targets(state)[0].channels[0].own, first);
}

// What a lens brings onto the film from beyond a pinhole's is on it.
TEST(TruthTable, FollowsTheLens) {
  const Frame f =
      renderFrame(scene("background: {temperature: 3 K}\nmaterials: {m: {components: []}}\nentities: [{name: ball, shape: {model: sphere, radius: 5 m}, "
                        "material: m, temperature: 500 K, position: [1000 m, 0 m, 262 m]}]\n"
                        "cameras: [{name: c, film: {width: 64, height: 48, pitch: 20 um}, focal_length: 2 mm, aperture: 1 mm, position: [0 m, 0 m, 0 m], "
                        "heading: 90 deg, truth: [targets], stages: [{stage: distortion, "
                        "k1: -0.4}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]}]\n"));
  const TargetRow& t = row(f, "ball");
  const double r = 0.262, rd = r * (1.0 - 0.4 * r * r);
  EXPECT_NEAR(t.row, 24.0 - rd * 100.0, 1e-3);
  ASSERT_LT(t.row, 24.0);
  EXPECT_GT(t.row, -2.0);
  EXPECT_EQ(t.visible > 0.0, t.bottom > 0.0);
}

// A lamp is its own intensity times the air's transmittance.
TEST(TruthTable, Lamps) {
  const Frame f =
      renderFrame(scene("atmosphere: {model: homogeneous, extinction: 0.2 /km, temperature: 288 K}\nlights: [{name: flare, intensity: {wavelength: um, unit: "
                        "W/(sr um), values: [[3, 100], [5, "
                        "100]]}, position: [3000 m, 0 m, 0 m]}]\n" +
                        camera("")));
  figure("intensity of a flare through 3 km [W/sr]", row(f, "flare").channels[0].contrast, 130.0 * std::exp(-0.6), 1e-5, "I tau");
  EXPECT_EQ(row(f, "flare").kind, "lamp");
}

// Terms of a pixel add up to it; each is what it says.
TEST(TruthTable, TermsAddUp) {
  const Frame f =
      renderFrame(scene("atmosphere: {model: homogeneous, extinction: 0.1 /km, temperature: 280 K}\nbackground: {temperature: 250 K}\nambient: {temperature: "
                        "270 K}\nsun: {azimuth: 200 deg, elevation: 40 deg, irradiance: 10 W/(m2 um)}\n"
                        "materials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}, g: {medium: gas, absorption: 0.2 /m}}\nlights: [{name: "
                        "lamp, visible: false, intensity: {wavelength: um, unit: W/(sr "
                        "um), values: [[3, 1e5], [6, 1e5]]}, position: [900 m, 0 m, 30 m]}]\nentities:\n- {name: wall, shape: {model: plate, width: 8 m, "
                        "height: 8 m}, material: m, temperature: 320 K, position: "
                        "[1000 m, 0 m, 0 m], heading: 270 deg}\n- {name: puff, shape: {model: sphere, radius: 2 m}, material: g, temperature: 500 K, position: "
                        "[950 m, 3 m, 0 m]}\n" +
                        camera("")));
  double worst = 0.0, most = 0.0;
  const auto& whole = layer(f, "mw.radiance").pixels;
  std::vector<double> sums(whole.size(), 0.0);
  int parts = 0;
  for (const FrameLayer& l : f.layers) {
    if (!l.name.starts_with("truth.terms.mw.")) continue;
    ++parts;
    for (size_t p = 0; p < sums.size(); ++p) sums[p] += static_cast<double>(l.pixels[p]);
  }
  EXPECT_EQ(parts, 7) << "emission, ambient, sun, air, background, media, a lamp's";
  for (size_t p = 0; p < sums.size(); ++p) most = std::max(most, static_cast<double>(whole[p]));
  int off = 0;
  for (size_t p = 0; p < sums.size(); ++p) {
    const double error = std::abs(sums[p] - static_cast<double>(whole[p])) / most;
    if (error > 1e-4) ++off;  // an outline, on which a ray and the rasteriser may see different things
    else worst = std::max(worst, error);
  }
  bound("sum of a pixel's terms against its radiance, of the brightest", worst, 2e-5, "double against single precision");
  bound("pixels on outlines that differ", off, 40.0, "of 12288");
  const double tau = std::exp(-0.1);
  figure("emission of a wall through 1 km of air", at(layer(f, "truth.terms.mw.emission"), f, 64, 48), 0.7 * blackBodyBand(3.6, 4.9, 320.0) * tau, 1e-4,
         "e B tau");
  figure("ambient light that it reflects", at(layer(f, "truth.terms.mw.ambient"), f, 64, 48), 0.3 * blackBodyBand(3.6, 4.9, 270.0) * tau, 1e-4, "rho B tau");
}

/// A still camera looks east at what burns 2 km away and 100 m up.
const std::string kMidwave = "{name: mw, response: {band: [3 um, 5 um]}}";
std::string watch(const std::string& more = "", const std::string& heading = "heading: 90 deg",
                  const std::string& channels = kMidwave + ", {name: lw, response: {band: [8 um, 12 um]}}") {
  return "cameras: [{name: c, film: {width: 64, height: 48, pitch: 15 um}, focal_length: 60 mm, aperture: 25 mm, exposure: 4 ms, truth: [targets], position: "
         "[0 m, 0 m, 100 m], " +
         heading + ", " + more + "channels: [" + channels + "]}]\n";
}

bool hasRow(const Frame& f, const std::string& name) {
  return std::any_of(f.targets.begin(), f.targets.end(), [&](const TargetRow& t) { return t.name == name; });
}

// A flare that falls from rest, seen from the side: its stated intensity, by what its air leaves of it; each of a sequence while it burns.
TEST(TruthTable, FlaresHaveTheirStatedIntensity) {
  struct Case {
    const char *type, *more;
    double factor;
  };
  for (const Case& c :
       {Case{"mtv", "", 1.0}, Case{"mtv", ", intensity: 2.5", 2.5}, Case{"spectrally_matched", "", 1.0}, Case{"pyrophoric", ", intensity: 0.5", 0.5}}) {
    const Simulation sim =
        scene("accuracy: 1 %\ntime: {rate: 2 Hz, frames: 20}\nbackground: {temperature: 0 K}\nflares: [{name: f, type: " + std::string(c.type) + c.more +
              ", position: [2 km, 0 m, 100 m], speed: 0 m/s, time: 0.5 s, smoke: false, sequence: {count: 2, interval: 1 s}}]\n" + watch());
    const FlareType& type = *findFlareType(c.type);
    const auto& cloud = dynamic_cast<const FlareCloud&>(*sim.fields[0].source).options();
    EXPECT_FALSE(hasRow(renderFrame(sim, 1), "f_0")) << "ejected, not lit";
    for (int frame : {2, 3}) {
      const double t = 0.5 * frame, fallen = glm::length(cloud.path->velocityAt(t));
      // What burns in still air, at 100 m: rise, hold, fall by its age, less in the wind of its fall.
      const double level =
          flareBurn(type, t - 0.5 - type.ignition_s) * flareInWind(type, fallen) * flareAtPressure(type, standardAir(cloud.path->at(t).position.z).pressure_Pa);
      const Frame f = renderFrame(sim, frame);
      if (!(level > 0.0)) {
        EXPECT_FALSE(hasRow(f, "f_0"));
        continue;
      }
      const TargetRow& row0 = row(f, "f_0");
      EXPECT_EQ(row0.kind, "flare");
      figure(print("a %s", c.type) + print(" flare at %g s, 3-5 um [W/sr]", t), row0.channels[0].own, level * c.factor * type.intensity_W_sr, 0.01,
             "as stated, seen from the side; accuracy asked. Air of 288 K in its cloud adds below 1e-3");
      EXPECT_NEAR(row0.channels[0].contrast, row0.channels[0].own, 1e-3 * row0.channels[0].own) << "nothing behind it";
      EXPECT_NEAR(row0.range_m, 2000.0, 0.1);
      EXPECT_NEAR(row0.visible, 1.0, 1e-9);
      EXPECT_EQ(hasRow(f, "f_1"), 0.5 * frame > 1.5 + type.ignition_s && row(f, "f_0").range_m > 0.0) << frame;
      // Its box: around its place, as wide as what shows of a cloud of its radius.
      const double across = (row0.right - row0.left) * 2000.0 * 15e-6 / 60e-3;
      EXPECT_GT(across, 0.5 * dynamic_cast<const FlareCloud&>(*sim.fields[0].source).radius_m()) << c.type;
      EXPECT_LT(across,
                4.0 * dynamic_cast<const FlareCloud&>(*sim.fields[0].source).radius_m() * std::pow(std::max(level, 1e-4), 0.25) + 4.0 * type.spread_m_s * t)
          << c.type;
      EXPECT_TRUE(row0.column > row0.left - 1.0 && row0.column < row0.right + 1.0 && row0.row > row0.top - 1.0 && row0.row < row0.bottom + 1.0);
    }
  }
}

// Against the picture: what its pixels add up to, at all sizes; a plume before sky, in air, on a body that flies.
TEST(TruthTable, PlumesAndFlaresAreWhatThePictureHas) {
  double empty = -1.0;  // of a picture of the air and what is behind it, over steradians
  for (double range : {1500.0, 4000.0, 30000.0})
    for (const char* engine : {"turbofan_military", "double_base_motor"}) {
      if (range != 4000.0 && (range < 4000.0) == (std::string(engine) == "double_base_motor")) continue;  // one of them near, the other far
      const std::string world =
          "accuracy: 1 %\ntime: {start: 1 s, rate: 10 Hz, frames: 2}\natmosphere: {model: homogeneous, extinction: 0.02 /km, temperature: 285 K}\nbackground: "
          "{temperature: 220 K}\n";
      const std::string place = print("position: [%g m, -6 m, 100 m]", range);
      const std::string burning =
          "plumes: [{name: p, " + place + ", direction: [0, 1, 0], length: 12 m, engine: " + engine + ", begin: 0 s}]\n" +
          (std::string(engine) == "turbofan_military" ? "flares: [{name: f, type: mtv, " + print("position: [%g m, -9 m, 100 m]", range) +
                                                            ", speed: 0 m/s, time: 0.2 s, smoke: false, light: false}]\n"
                                                      : "");
      const auto sumOf = [&](const std::string& text, Frame* frame) {
        const Simulation sim = scene(world + text + watch("samples: 2, ", "heading: 90 deg", kMidwave));
        const Frame f = renderFrame(sim);
        const auto sr = sim.cameras[0].pinhole.solidAngles().plain_sr;
        double all = 0.0;
        for (size_t p = 0; p < sr.size(); ++p) all += sr[p] * static_cast<double>(layer(f, "mw.radiance").pixels[p]);
        if (frame) *frame = f;
        return all;
      };
      if (empty < 0.0) empty = sumOf("", nullptr);
      Frame f;
      const double seen = (sumOf(burning, &f) - empty) * range * range;
      double told = 0.0;
      for (const TargetRow& t : f.targets) told += t.channels[0].contrast;
      figure(print("plume and flare of a %s", engine) + print(" at %g m: rows of truth over the picture's sum", range), told / seen, 1.0, 0.02,
             "1 % asked of each");
      EXPECT_EQ(row(f, "p").kind, "plume");
      figure("place of a nozzle on the film [column]", row(f, "p").column, 32.0 + 6.0 / range * 4000.0, 1e-6, "a pinhole");
      EXPECT_LT(row(f, "p").right, row(f, "p").column + std::max(1.0, 4000.0 / range)) << "it goes to the left";
    }
}

// What hides them, how their lines of sight turn, what a detector makes of them; names that a body has too.
TEST(TruthTable, PlumesHaveSharesRatesAndNoise) {
  const std::string jet =
                        "time: {start: 1 s, rate: 10 Hz, frames: 2}\nbackground: {temperature: 250 K}\nmaterials: {m: {components: []}}\nentities:\n- {name: "
                        "jet, shape: {model: sphere, radius: 20 cm}, material: m, temperature: 290 K, "
                        "motion: [{time: 0 s, position: [2 km, 100 m, 100 m]}, {time: 2 s, position: [2 km, -100 m, 100 m]}]}\n",
                    burning =
                        "plumes: [{name: jet, on: jet, engine: turbofan_military, length: 20 m}]\nflares: [{name: f, type: mtv, position: [2 km, 0 m, 105 m], "
                        "speed: 0 m/s, time: 0.2 s, smoke: false}]\n";
  const Frame f = renderFrame(
      scene("accuracy: 10 %\n" + jet + burning + watch("stages: [{stage: detector, full_well: 7e6, read_noise: 300}], ", "heading: 90 deg", kMidwave)));
  const TargetRow& plume = row(f, "jet_plume");
  EXPECT_EQ(row(f, "jet").kind, "body");
  figure("turning of the line of sight to a nozzle [rad/s]", plume.sightRight_rad_s, 0.05, 1e-3, "100 m/s at 2 km");
  EXPECT_NEAR(plume.rangeRate_m_s, 0.0, 0.1);
  EXPECT_GT(plume.visible, 0.9) << "but for what the ball hides that carries it";
  // A wall that is down a frame later: the same plan.
  const Simulation walled = scene("accuracy: 1 %\n" + jet +
                                  "- {name: wall, shape: {model: plate, width: 40 m, height: 10 m}, material: m, temperature: 250 K, motion: {model: "
                                  "waypoints, interpolation: linear, points: [{time: 1 s, "
                                  "position: [1900 m, 0 m, 94.98 m], heading: 270 deg}, {time: 1.1 s, position: [1900 m, 0 m, 60 m], heading: 270 deg}]}}\n" +
                                  burning + watch());
  const Frame hidden = renderFrame(walled, 0), open = renderFrame(walled, 1);
  // The wall's upper edge is at 99.98 m, which hides what is below 99.979 m at 2 km: the lower half of a level jet, and none of the flare.
  figure("share of a plume that a wall's edge leaves", row(hidden, "jet_plume").visible, 0.5, 0.06, "half, and 2 cm of a jet of half a metre");
  EXPECT_NEAR(row(hidden, "f").visible, 1.0, 1e-9);
  const auto left = [&](std::size_t channel) { return row(hidden, "jet_plume").channels[channel].own / row(open, "jet_plume").channels[channel].own; };
  figure("intensity of what is left of it, of all, mean of two channels", 0.5 * (left(0) + left(1)),
         row(hidden, "jet_plume").visible / row(open, "jet_plume").visible, 0.01,
         "the share is by what it sends, here past the ball that carries it too; 1 % asked");
  EXPECT_LT(plume.visible, 1.0);
  const Frame cut =
      renderFrame(scene("accuracy: 10 %\n" + jet + burning + watch("", "heading: 90.229 deg", kMidwave)));  // the film's edge is 0.46 degrees away
  EXPECT_LE(row(cut, "jet_plume").visible, 1.0);
  const Frame behind = renderFrame(scene("accuracy: 10 %\n" + jet + burning + watch("", "heading: 270 deg", kMidwave)));
  EXPECT_EQ(row(behind, "f").visible, 0.0);
  EXPECT_EQ(row(behind, "f").channels[0].own, 0.0);
  EXPECT_TRUE(std::isnan(row(behind, "f").column));
}

// What a response has beyond its air's data is cut, as of what is drawn.
TEST(TruthTable, AMicrobolometerInLayeredAir) {
  for (const char* air : {"clear_us76", "hazy_mls", "clear_mls"}) {
    const std::string world = "accuracy: 1 %\natmosphere: " + std::string(air) +
                              "\nmaterials: {m: {components: []}}\nentities: [{name: wall, shape: {model: plate, width: 10 m, height: 10 m}, material: m, "
                              "temperature: 350 K, position: [1 km, 0 m, 100 m], heading: 270 deg}]\n";
    const Frame f = renderFrame(scene(world + "cameras: [{name: c, film: {width: 48, height: 48, pitch: 17 um}, focal_length: 60 mm, aperture: 50 mm, truth: "
                                              "[targets], position: [0 m, 0 m, 100 m], heading: 90 deg, "
                                              "channels: [{name: lw, response: microbolometer_lwir}]}]\n"));
    const TargetRow& t = row(f, "wall");
    figure(std::string("radiance of a wall by a microbolometer in ") + air + ", of its pixel", t.channels[0].total / 100.0,
           at(layer(f, "lw.radiance"), f, 24, 24), 0.01, "L A over A; accuracy asked, and 10 m at 1 km");
  }
}

}  // namespace
}  // namespace pitviper::test
