// An output quantity in one file: photons a second on a pixel, in millions. No other file knows it.
#include <gtest/gtest.h>

#include "scenarios/reader/scenario_reader.hpp"
#include "sensors/quantity.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper {
namespace {

Quantity megaphotonFlux() {
  return {"megaphoton_flux", "Mphoton/s", "photons a second on a pixel behind the optics, in millions",
          [](const Detector& d, const Collector& c, ChannelOutput& o) {
            o.perEtendue = true;
            o.kernel = d.response * d.optics * photonsPerJoule();
            o.scale = 1e-6 * c.apertureArea_m2;
          }};
}

[[maybe_unused]] const bool kRegistered = quantities().add(megaphotonFlux());

}  // namespace

namespace test {
namespace {

std::string wall(const std::string& output) {
  return "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: blackbody, temperature: 400 K}]\n"
         "cameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 0.1 deg, aperture: 20 mm, exposure: 4 ms, optics: 0.7, position: [10 m, 0 m, 0 m], "
         "look_at: p, "
         "channels: [{name: mw, response: {band: [3 um, 5 um]}, output: " +
         output + "}]}]\n";
}

// By its definition from another quantity: photons of an exposure by its time.
TEST(PhotonFlux, IsPhotonsByTime) {
  for (const char* accuracy : {"", "accuracy: 1 %\n", "accuracy: reference\n"}) {
    const Frame f = renderFrame(scene(accuracy + wall("[photons, megaphoton_flux]")));
    figure(std::string("photons a second on a pixel [Mphoton/s] ") + accuracy, at(layer(f, "mw.megaphoton_flux"), f, 4, 4),
           at(layer(f, "mw.photons"), f, 4, 4) / 0.004 * 1e-6, 2e-7, "photons / exposure time, single precision of the frame");
    EXPECT_EQ(layer(f, "mw.megaphoton_flux").unit, "Mphoton/s");
  }
}

TEST(PhotonFlux, IsInTheReference) {
  EXPECT_NE(keyReference().find("| `megaphoton_flux` | Mphoton/s |"), std::string::npos);
  try {
    scene(wall("megaphoton_flx"));
    FAIL();
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'megaphoton_flux'?"), std::string::npos) << e.what();
  }
}

TEST(Quantities, TwoOfOneNameAreRefused) {
  Registry<Quantity> two("quantity", {megaphotonFlux(), megaphotonFlux()});
  EXPECT_THROW(two.all(), std::logic_error);
}

}  // namespace
}  // namespace test
}  // namespace pitviper
