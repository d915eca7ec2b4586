// Surfaces whose reflectance, and with it their emission, changes with their temperature.
#include <gtest/gtest.h>

#include "sim/parameters/error.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

// Emissivity 0.2 at 300 K, 0.3 at 500 K, 0.6 at 1100 K, linear between.
const std::string kSurface =
    "materials: {m: {temperatures: [{temperature: 300 K, components: [{reflection: lambertian, reflectance: 0.8}]}, "
    "{temperature: 500 K, components: [{reflection: lambertian, reflectance: 0.7}]}, "
    "{temperature: 1100 K, components: [{reflection: lambertian, reflectance: 0.4}]}]}}\n";
double emissivityAt(double kelvin) { return kelvin < 500.0 ? 0.2 + 0.1 * (kelvin - 300.0) / 200.0 : 0.3 + 0.3 * (kelvin - 500.0) / 600.0; }

std::string plate(const std::string& temperature, const std::string& more = "", const std::string& size = "2 m") {
  return kSurface + more +
         "time: {rate: 10 Hz, frames: 2}\n"
         "entities: [{name: p, shape: {model: plate, width: " +
         size + ", height: " + size + "}, material: m, temperature: " + temperature +
         "}]\n"
         "cameras: [{name: c, film: {width: 16, height: 16}, field_of_view: 4 deg, aperture: 20 mm, position: [10 m, 0 m, 0 m], look_at: p, "
         "channels: [{name: mw, response: {band: [3 um, 5 um]}}]}]\n";
}

TEST(TemperatureStates, EmissivityFollows) {
  for (const char* accuracy : {"", "accuracy: reference\n"})
    for (double t : {300.0, 350.0, 500.0, 640.0, 1100.0}) {
      const Frame f = renderFrame(scene(plate(std::to_string(t) + " K", accuracy)));
      figure("emissivity 0.2 at 300 K to 0.6 at 1100 K, plate of " + std::to_string(static_cast<int>(t)) + " K" + (*accuracy ? ", reference" : "") +
                 " [W/(m2 sr)]",
             at(layer(f, "mw.radiance"), f, 8, 8), emissivityAt(t) * blackBodyBand(3.0, 5.0, t), 3e-5, "linear in temperature; single precision");
    }
}

// What reflects is what does not emit: in an enclosure of its own temperature it is black.
TEST(TemperatureStates, EnclosuresAreFlat) {
  for (const char* kelvin : {"420 K", "930 K"}) {
    const Frame f = renderFrame(scene(plate(kelvin, std::string("ambient: {temperature: ") + kelvin + "}\n")));
    figure(std::string("enclosure of ") + kelvin, at(layer(f, "mw.radiance"), f, 8, 8), blackBodyBand(3.0, 5.0, std::stod(kelvin)), 3e-5, "Kirchhoff");
  }
}

TEST(TemperatureStates, TexturesAndCommandsDriveThem) {
  // Two halves, 400 K below and 900 K above.
  const Frame f = renderFrame(scene(plate("{rows: [[900 K], [400 K]]}", "", "0.6 m")));
  figure("upper half, of 900 K", at(layer(f, "mw.radiance"), f, 8, 2), emissivityAt(900.0) * blackBodyBand(3.0, 5.0, 900.0), 3e-4, "single precision");
  figure("lower half, of 400 K", at(layer(f, "mw.radiance"), f, 8, 13), emissivityAt(400.0) * blackBodyBand(3.0, 5.0, 400.0), 3e-4, "single precision");
  const Simulation heated = scene(plate("300 K", "commands: [{command: temperature, at: 0.1 s, entity: p, value: 800 K}]\n"));
  const Frame later = renderFrame(heated, 1);
  figure("heated by command to 800 K", at(layer(later, "mw.radiance"), later, 8, 8), emissivityAt(800.0) * blackBodyBand(3.0, 5.0, 800.0), 3e-5,
         "single precision");
}

TEST(TemperatureStates, MistakesAreNamed) {
  const auto said = [](const std::string& temperatures, const std::string& kelvin = "400 K") -> std::string {
    try {
      scene("materials: {m: {" + temperatures + "}}\n" + plate(kelvin).substr(kSurface.size()));
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  };
  const std::string a = "{temperature: 300 K, components: [{reflection: lambertian, reflectance: 0.8}]}",
                    b = "{temperature: 900 K, components: [{reflection: lambertian, reflectance: 0.4}]}",
                    phong = "{temperature: 900 K, components: [{reflection: phong, reflectance: 0.4, exponent: 20}]}";
  for (const auto& [text, kelvin, part] :
       {std::tuple<std::string, std::string, std::string>{"temperatures: [" + b + ", " + a + "]", "400 K", "do not rise"},
        {"temperatures: [" + a + ", " + phong + "]", "400 K", "others in kind"},
        {"temperatures: [" + a + ", {temperature: 431.7 K, components: [{reflection: lambertian, reflectance: 0.8}]}, " + b + "]", "400 K",
         "steps of one size"},
        {"temperatures: [" + a + ", " + b + "]", "1000 K", "is not known"},
        {"temperatures: [" + a + ", " + b + "]", "{rows: [[350 K], [250 K]]}", "is not known"},
        {"temperatures: [" + a + ", " + b + "], components: []", "400 K", "beside 'temperatures'"},
        {"temperatures: [" + a + ", {temperature: 900 K, components: [{reflection: lambertian, reflectance: 0.4, modifier: {rows: [[1]]}}]}]", "400 K",
         "a texture on a surface"},
        {"temperatures: [" + a + ", {temperature: 900 K, components: [{reflection: lambertian, reflectance: 1.4}]}]", "400 K", "reflectance"}}) {
    const std::string e = said(text, kelvin);
    EXPECT_NE(e.find(part), std::string::npos) << text << "\n" << e;
    EXPECT_NE(e.find("expected"), std::string::npos) << e;
  }
}

}  // namespace
}  // namespace pitviper::test
