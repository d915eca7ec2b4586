// Light from all around by direction: closed forms, enclosures, mirrors, the air's own sky, the GPU against double, and what is predicted against what is
// found.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "sim/image/exr.hpp"
#include "sim/model/environment_map.hpp"
#include "sim/plan/planner.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiance/node_surroundings.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"
#include "tests/support/compare.hpp"
#include "tests/support/exr_bytes.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"
#include "tests/support/scene_builder.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

std::string ball(const std::string& component, const std::string& more, double kelvin = 0.0, int pixels = 41) {
  return "materials: {m: {components: [" + component + "]}}\n" + more +
         print("entities: [{name: b, shape: {model: sphere, radius: 1 m, segments: 96}, material: m, temperature: %g K}]\n", kelvin) +
         "cameras: [{name: c, film: {width: " + print("%d, height: %d", pixels, pixels) +
         "}, field_of_view: 11 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: b, channels: [{name: a, response: {band: [3.5 um, 4 um]}}]}]\n";
}
const std::string kHalf = "ambient: {gradient: [{elevation: 0 deg, radiance: \"0 W/(m2 sr um)\"}, {elevation: 0 deg, radiance: \"2 W/(m2 sr um)\"}]}\n";
const std::string kMatt = "{reflection: lambertian, reflectance: 0.6}", kMetal = "{reflection: microfacet, index: aluminium, roughness: 0.15}",
                  kMirror = "{reflection: microfacet, index: aluminium, roughness: 0.01}";

/// Of each pixel of a ball seen from +x: its normal's sine of elevation; none beside it.
template <class Visit>
void overBall(const Frame& f, const Visit& visit) {
  const double tangent = std::tan(5.5 * kPi / 180.0);
  for (int row = 0; row < f.height; ++row)
    for (int column = 0; column < f.width; ++column) {
      const double y = tangent * (2.0 * (column + 0.5) / f.width - 1.0), z = tangent * (1.0 - 2.0 * (row + 0.5) / f.height);
      const glm::dvec3 d = glm::normalize(glm::dvec3(-1.0, y, z));
      const double along = -10.0 * d.x, from2 = 100.0 - along * along;
      if (from2 > 0.8) continue;
      const glm::dvec3 normal = glm::normalize(glm::dvec3(10.0, 0.0, 0.0) + (along - std::sqrt(1.0 - from2)) * d);
      visit(normal, d, at(layer(f, "a.radiance"), f, column, row));
    }
}

// Half the sphere shines with 2: a matt surface sends rho (1 + n_z), whatever it faces.
TEST(Surroundings, HalfASphereOnMattSurfaces) {
  for (const char* accuracy : {"accuracy: reference\n", "accuracy: 1 %\n", ""}) {
    const Frame f = renderFrame(scene(accuracy + ball(kMatt, kHalf)));
    double worst = 0.0;
    overBall(f, [&](const glm::dvec3& n, const glm::dvec3&, double seen) { worst = std::max(worst, std::abs(seen / 0.5 - 0.6 * (1.0 + n.z))); });
    const bool full = std::string(accuracy).find("reference") != std::string::npos;
    bound(std::string("half a sphere of light on a matt ball against 0.6 (1 + n_z) [W/(m2 sr um)], ") + (full        ? "in full"
                                                                                                         : *accuracy ? "planned"
                                                                                                                     : "25 harmonics"),
          worst, 1e-3, "such light has odd degrees alone, a clamped cosine even ones and the first: nine harmonics are enough; facets of a ball of 96");
  }
}

// Light that changes with the sine of elevation is of degree 1, which is exact: rho (a + 2/3 b n_z).
TEST(Surroundings, LightOfDegreeOne) {
  std::string list;
  for (int e = -90; e <= 90; e += 3)
    list += print("%s{elevation: %d deg, radiance: \"%.9g W/(m2 sr um)\"}", e > -90 ? ", " : "", e, 3.0 + 2.0 * std::sin(e * kPi / 180.0));
  for (const char* accuracy : {"accuracy: reference\n", ""}) {
    const Frame f = renderFrame(scene(accuracy + ball(kMatt, "ambient: {gradient: [" + list + "]}\n")));
    double worst = 0.0;
    overBall(f, [&](const glm::dvec3& n, const glm::dvec3&, double seen) { worst = std::max(worst, std::abs(seen / 0.5 - 0.6 * (3.0 + 4.0 / 3.0 * n.z))); });
    bound(std::string("light of a + b sin(e) on a matt ball [W/(m2 sr um)]") + (*accuracy ? ", in full" : ""), worst, 4e-3,
          "a gradient in steps of 3 deg, facets of a ball of 96");
  }
}

// In an enclosure told as a gradient all is flat, whatever the surface: uniform light is exact.
TEST(Surroundings, EnclosuresAreFlat) {
  const std::string walls =
      "background: {temperature: 600 K}\nambient: {gradient: [{elevation: -90 deg, temperature: 600 K}, {elevation: 30 deg, temperature: 600 K}]}\n";
  for (const std::string& component : {kMatt, kMetal, kMirror, std::string("{reflection: microfacet, index: 1.45, roughness: 0.15, pigment: 0.6}"),
                                       std::string("{reflection: ward, reflectance: 0.6, roughness: 0.15}")})
    for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"}) {
      const Frame f = renderFrame(scene(accuracy + ball(component, walls, 600.0, 21)));
      double worst = 0.0;
      for (float x : layer(f, "a.radiance").pixels) worst = std::max(worst, std::abs(static_cast<double>(x) / blackBodyBand(3.5, 4.0, 600.0) - 1.0));
      bound("off the black body in an enclosure by directions, " + component.substr(0, 60) + (*accuracy ? std::string(", ") + accuracy : ""), worst, 1e-4,
            "asked for");
    }
}

// A smooth metal shows what is in the mirrored direction.
TEST(Surroundings, MirrorsShowIt) {
  const std::string sky =
      "ambient: {gradient: [{elevation: -90 deg, temperature: 330 K}, {elevation: 0 deg, temperature: 300 K}, {elevation: 0 deg, temperature: 280 K}, "
      "{elevation: 90 "
      "deg, temperature: 200 K}]}\n";
  for (const char* accuracy : {"accuracy: reference\n", ""}) {
    const Simulation sim = scene(accuracy + ball(kMirror, sky));
    const Frame f = renderFrame(sim);
    double worst = 0.0, most = 0.0;
    const auto& m = *sim.materials.front();
    overBall(f, [&](const glm::dvec3& n, const glm::dvec3& d, double seen) {
      const glm::dvec3 r = d - 2.0 * glm::dot(d, n) * n;
      const double e = std::asin(r.z) / kPi * 180.0;
      if (std::abs(e) < 8.0) return;  // about the horizon its width shows
      const double low = e > 0.0 ? 280.0 : 330.0, high = e > 0.0 ? 200.0 : 300.0, share = e > 0.0 ? e / 90.0 : (e + 90.0) / 90.0;
      const double expected =
          ((1.0 - share) * blackBodyBand(3.5, 4.0, low) + share * blackBodyBand(3.5, 4.0, high)) * m.reflectance(3.75, std::acos(-glm::dot(d, n)));
      worst = std::max(worst, std::abs(seen - expected)), most = std::max(most, expected);
    });
    bound(std::string("a mirroring ball against the mirrored sky, of the brightest") + (*accuracy ? ", in full" : ""), worst / most, 0.02,
          "facets of a ball of 96 (2 deg), tails of the lobe");
  }
}

// A map of (1, 1, 1) is its main light to an eye; a red one has its luminance's share of red and no blue.
TEST(Surroundings, ColoursAreRaisedToSpectra) {
  const TemporaryFolder folder;
  const auto xyz = [&](const std::string& ambient) {
    const Frame f = renderFrame(scene("accuracy: none\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.5}]}}\n" + ambient +
                                      "entities: [{name: b, shape: {model: plate, width: 9 m, height: 9 m}, material: m, temperature: 0 K}]\n"
                                      "cameras: [{name: c, film: {width: 1, height: 1}, field_of_view: 1 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], "
                                      "look_at: b, eye: true}]\n"));
    return glm::dvec3(sum(layer(f, "X.tristimulus")), sum(layer(f, "Y.tristimulus")), sum(layer(f, "Z.tristimulus")));
  };
  const auto mapOfOne = [&](const std::string& name, const glm::dvec3& rgb) {
    ExrImage image;
    image.width = 16, image.height = 8;
    for (int k = 0; k < 3; ++k) image.layers.push_back({std::string(1, "RGB"[k]), std::vector<float>(128, static_cast<float>(rgb[k]))});
    writeExr(folder.path() / name, image);
    return "ambient: {map: {file: " + (folder.path() / name).string() + ", light: {product: [\"0.1 W/(m2 sr um)\", cie_d65]}}}\n";
  };
  const glm::dvec3 white = xyz(mapOfOne("white.exr", glm::dvec3(1.0))), light = xyz("ambient: {radiance: {product: [\"0.1 W/(m2 sr um)\", cie_d65]}}\n"),
                   red = xyz(mapOfOne("red.exr", glm::dvec3(1.0, 0.0, 0.0)));
  for (int k = 0; k < 3; ++k)
    figure(print("%c of a white map under D65 [cd/m2]", "XYZ"[k]), white[k], light[k], 2e-3, "its main light; sums over 1 nm against 16 Gauss points");
  EXPECT_GT(red.x, red.y);
  EXPECT_LT(red.z / red.y, 0.5 * white.z / white.y);  // as a painted red
  EXPECT_LT(red.y, 0.5 * white.y);
}

const std::string kSky =
    "atmosphere: clear_us76\nsun: {azimuth: 200 deg, elevation: 40 deg, temperature: 5772 K}\nambient: {from: sky}\nground: {material: soil, temperature: 295 "
    "K}\n";

// What surfaces are lit by is what a camera sees there.
TEST(Surroundings, TheSkyIsTheSky) {
  for (double height : {0.0, 3000.0}) {
    const Simulation sim =
        scene(kSky + print("cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, %g m], "
                           "heading: 0 deg, pitch: 0 deg, channels: [{name: a, response: {band: [8 um, 9 um]}}]}]\n",
                           height + 0.01));
    const double at_um[] = {0.55, 4.0, 8.6, 11.0};
    std::vector<SpectralNode> nodes;
    for (double w : at_um) nodes.push_back(nodeAt(sim, w));
    const NodeSpectra spectra(sim, nodes);
    NodeSum sum(spectra);
    const WorldState state = advance(sim, 0.0);
    const Plan plan = makePlan(sim, sim.cameras[0].outputs, sim.cameras[0].spectral, {});
    double worst = 0.0;
    for (double e : {1.0, 5.0, 20.0, 60.0, -5.0, -30.0, -80.0})
      for (double a : {0.0, 120.0}) {
        const double elevation = e * kPi / 180.0, azimuth = a * kPi / 180.0;
        LineOfSight line{
            {0.0, 0.0, height + 0.01}, {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)}, {}, 0.0};
        sum.begin();
        radianceAlong({sim, plan.terms, plan.sunLegs.get(), state, {}, 0}, line, sum);
        const auto place = sim.surroundings->placeAt(height);
        const DirectionGrid& grid = sim.surroundings->grids()[place.height];
        const auto reading = grid.at(line.direction);
        for (size_t i = 0; i < nodes.size(); ++i) {
          double told = 0.0;
          for (size_t k = 0; k < 4; ++k)
            told += reading.weight[k] * static_cast<double>(sim.surroundings->light(at_um[i], place.height).radiance[reading.at[k]]);
          const double error = std::abs(told / sum.radiance()[i] - 1.0);
          if (error > 0.03) std::printf("  %g m, %g deg, azimuth %g deg, %g um: %g against %g\n", height, e, a, at_um[i], told, sum.radiance()[i]);
          worst = std::max(worst, error);
        }
      }
    bound(print("surroundings at %g m against lines of sight, relative", height), worst, 0.06,
          "13 stretches of a line, rings up to 8 deg apart; ground as a diffuse surface under the mean sky");
  }
}

// Plans are the same bytes whatever was asked before: light at a wavelength does not depend on which others are worked out with it.
TEST(Surroundings, TheSkyOfAWavelengthIsTheSameWhateverStandsBesideIt) {
  const std::string text = kSky +
                           "cameras: [{name: c, film: {width: 3, height: 3}, field_of_view: 1 deg, aperture: 5 mm, position: [0 m, 0 m, 1 m], heading: 0 deg, "
                           "pitch: 0 deg, channels: [{name: a, response: {band: [8 um, 9 um]}}]}]\n";
  for (std::size_t count : {2u, 3u, 31u, 32u, 33u, 71u}) {
    const Simulation together = scene(text), apart = scene(text);
    std::vector<double> at_um;
    for (std::size_t i = 0; i < count; ++i) at_um.push_back(0.45 * std::pow(30.0, static_cast<double>(i) / static_cast<double>(count)));
    for (std::size_t height : {0u, 3u}) {
      together.surroundings->prepare(at_um, height);
      for (double w : at_um) {
        const auto &a = together.surroundings->light(w, height), &b = apart.surroundings->light(w, height);
        EXPECT_TRUE(a.radiance == b.radiance && a.harmonics == b.harmonics) << count << " wavelengths, height " << height << ", " << w << " um";
        EXPECT_GT(*std::max_element(a.radiance.begin(), a.radiance.end()), 0.0f);
      }
    }
  }
}

/// A picture of all directions with a bright window to the south-east, by latitude and longitude or as a cube, in layers at 3 and 5 um.
std::string mapOf(const TemporaryFolder& folder, MapLayout layout) {
  ExrImage image;
  image.width = layout == MapLayout::Cube ? 192 : 128;
  image.height = layout == MapLayout::Cube ? 32 : 64;
  image.layers = {{"three", {}}, {"five", {}}};
  const glm::dvec3 window = glm::normalize(glm::dvec3(1.0, -1.0, 0.4));
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const glm::dvec3 d = mapDirection(layout, (x + 0.5) / image.width, (y + 0.5) / image.height, 0.0);
      const double value = 1.0 + 0.5 * d.z + 6.0 * std::exp(20.0 * (glm::dot(d, window) - 1.0));
      image.layers[0].pixels.push_back(static_cast<float>(value));
      image.layers[1].pixels.push_back(static_cast<float>(2.0 * value));
    }
  const auto file = folder.path() / (layout == MapLayout::Cube ? "cube.exr" : "sphere.exr");
  writeExr(file, image);
  return "ambient: {map: {file: " + file.string() + (layout == MapLayout::Cube ? ", layout: cube" : "") +
         ", layers: [{name: three, wavelength: 3 um}, {name: five, wavelength: 5 um}]}}\n";
}

// Pictures on the GPU against the same sums in double.
TEST(SurroundingsOnGpu, AgainstDouble) {
  const TemporaryFolder folder;
  for (const auto& [around, most, why] : {std::tuple{mapOf(folder, MapLayout::LatitudeLongitude), 2e-5, "single precision"},
                                          {kHalf, 2e-5, "single precision"},
                                          {kSky, 4e-4, "tables of the air"}})
    for (const std::string& component :
         {kMatt, kMetal, std::string("{reflection: microfacet, index: water, roughness: 0.05, slopes: normal}"),
          std::string("{reflection: lambertian, reflectance: 0.2, modifier: {rows: [[1], [0.5]]}}, {reflection: phong, reflectance: 0.4, exponent: 60}")}) {
      // The sky's light takes long to work out, and is read as a map's: by a lobe and by rows of a texture.
      if (around == kSky && component != kMetal && component.find("rows") == std::string::npos) continue;
      // Seen from a height at which no row of pixels mirrors the horizon itself.
      std::string text = ball(component, "", 300.0);
      text.replace(text.find("[10 m, 0 m, 0 m]"), 16, "[10 m, 0 m, 1.37 m]");
      const Worst w = compare(scene("accuracy: none\n" + around + text), 2);
      EXPECT_GT(w.covered, 175);
      bound("light from all around, GPU against CPU double, 99 of 100 pixels, " + around.substr(0, 30) + ", " + component.substr(0, 60), w.percentile99, most,
            why);
    }
}

// A cube and a sphere that show the same are the same.
TEST(Surroundings, MapsOfEitherLayout) {
  const TemporaryFolder folder;
  const Frame sphere = renderFrame(scene(mapOf(folder, MapLayout::LatitudeLongitude) + ball(kMatt, ""))),
              cube = renderFrame(scene(mapOf(folder, MapLayout::Cube) + ball(kMatt, "")));
  double worst = 0.0, most = 0.0;
  const FrameLayer &a = layer(sphere, "a.radiance"), &b = layer(cube, "a.radiance");
  for (size_t k = 0; k < a.pixels.size(); ++k)
    worst = std::max(worst, std::abs(static_cast<double>(a.pixels[k] - b.pixels[k]))), most = std::max(most, static_cast<double>(a.pixels[k]));
  EXPECT_GT(most, 0.4);
  bound("a cube map against a sphere map of the same light, of the brightest", worst / most, 0.01, "pixels of 3 deg");
  // The window lies to the east and south, and the camera in the east sees it on the left.
  EXPECT_GT(at(a, sphere, 12, 20), 1.1 * at(a, sphere, 28, 20));
}

// A sky of 1 W/(m2 sr um) from which a file leaves the lower half out, however its windows lie: a surface of reflectance 0.5 that faces up sends
// 0.5 W/(m2 sr) in a band of 1 um, one that faces down nothing.
TEST(Surroundings, AFileOfTheUpperHalfIsASkyAbove) {
  const TemporaryFolder folder;
  const auto one = [](char, int, int) { return 1.0f; };
  const std::vector<std::pair<std::string, std::string>> files = {{"half", exrBytes({0, 0, 63, 15}, {0, 0, 63, 31}, "ab", one)},
                                                                  {"tiles", exrBytes({0, 0, 63, 15}, {0, 0, 63, 31}, "ab", one, 8)},
                                                                  {"origin below 0", exrBytes({-20, -9, 43, 6}, {-20, -9, 43, 22}, "ab", one)},
                                                                  {"beyond the display", exrBytes({-7, -5, 90, 15}, {0, 0, 63, 31}, "ab", one, 16)}};
  for (const auto& [name, bytes] : files)
    for (int side : {1, -1}) {
      const std::string file = folder.put("sky.exr", bytes), sign = side > 0 ? "" : "-";
      const Frame f = renderFrame(scene("accuracy: none\nambient: {map: {file: " + file +
                                        ", layers: [{name: a, wavelength: 3.9 um}, {name: b, wavelength: 5.1 um}]}}\nmaterials: {m: {components: [{reflection: "
                                        "lambertian, reflectance: 0.5}]}}\n"
                                        "entities: [{name: p, shape: {model: plate, width: 10 m, height: 10 m}, pitch: " +
                                        sign +
                                        "90 deg, material: m, temperature: 1 K}]\n"
                                        "cameras: [{name: c, film: {width: 2, height: 2}, field_of_view: 1 deg, aperture: 20 mm, position: [0 m, -1 m, " +
                                        sign +
                                        "20 m], look_at: p, channels: [{name: a, "
                                        "response: {band: [4 um, 5 um]}}]}]\n"));
      const double seen = at(layer(f, "a.radiance"), f, 1, 1);
      if (side > 0)
        figure("a sky above by a file of its upper half, " + name, seen, 0.5, 2e-4,
               "0.5 L, L of 1 W/(m2 sr um) over 1 um; the horizon between two rows of 3 deg");
      else bound("the same from below, of the sky above", seen / 0.5, 2e-4, "nothing is below; the horizon between two rows of 3 deg");
      EXPECT_GE(seen, 0.0);
    }
}

TEST(Surroundings, LossIsPredicted) {
  for (const std::string& component : {kMatt, kMetal}) {
    const std::string text = kSky + ball(component, "", 300.0);
    const Simulation planned = scene("accuracy: 2 %\naudit: 0\n" + text);
    const Plan plan = planFor(planned, {&planned.cameras[0], nullptr});
    const Frame fast = renderFrame(planned), exact = renderFrame(scene("accuracy: reference\n" + text));
    const FrameLayer &a = layer(fast, "a.radiance"), &b = layer(exact, "a.radiance");
    double found = 0.0, most = 0.0;
    for (float v : b.pixels) most = std::max(most, static_cast<double>(v));
    for (size_t k = 0; k < a.pixels.size(); ++k) {
      // Silhouettes are geometry's.
      const bool inside = std::hypot(static_cast<double>(k % 41) - 20.0, static_cast<double>(k / 41) - 20.0) < 16.0;
      if (inside) found = std::max(found, std::abs(static_cast<double>(a.pixels[k]) / static_cast<double>(b.pixels[k]) - 1.0));
    }
    bound("found of predicted, by harmonics, " + component.substr(0, 60), found / plan.predictedError.front(), 1.0, "what a plan says");
    std::printf("  predicted %.3g, of it light from all around %.3g with degree %d; found %.3g\n", plan.predictedError.front(), plan.parts.front().surroundings,
                plan.surroundings, found);
  }
}

// Bodies that climb, meet in a place and part again: their light is that of where they are, whatever was drawn before.
TEST(SurroundingsOnGpu, BodiesThatClimb) {
  needContext();
  const auto mover = [](const char* name, double y, double from, double to) {
    return print(
        "{name: %s, shape: {model: sphere, radius: 140 m}, material: m, temperature: 300 K, motion: [{time: 0 s, position: [0 m, %g m, %g m]}, "
        "{time: 0.4 s, position: [0 m, %g m, %g m]}]}",
        name, y, from, y, to);
  };
  const Simulation sim = scene(
      "accuracy: none\n" + kSky + "time: {rate: 10 Hz, frames: 5}\nmaterials: {m: {components: [" + kMetal + "]}}\nentities: [" + mover("a", 350, 200, 1000) +
      ", " + mover("b", 0, 1000, 200) + ", " + mover("c", -350, 600, 600) +
      "]\ncameras: [{name: c, film: {width: 24, height: 96}, field_of_view: 20 deg, aperture: 20 mm, position: [4 km, 0 m, 600 m], look_at: [0 m, 0 m, 600 "
      "m], small_bodies: 0, spectral: {samples: 3}, channels: [{name: a, response: {band: [3.5 um, 4 um]}}]}]\n");
  const auto gpu = std::make_shared<const GpuScene>(sim);
  CameraRenderer one(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), gpu);
  for (const double t : {0.0, 0.1, 0.2, 0.4, 0.3, 0.0}) {
    CameraRenderer fresh(sim, sim.cameras[0], cameraPlan(sim, sim.cameras[0]), shaderLibrary(), gpu);
    EXPECT_EQ(one.render(advance(sim, t)).slots, fresh.render(advance(sim, t)).slots) << t << " s";
  }
  EXPECT_NE(one.render(advance(sim, 0.0)).slots, one.render(advance(sim, 0.4)).slots);
}

}  // namespace
}  // namespace pitviper::test
