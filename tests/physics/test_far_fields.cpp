// A field beyond all bodies is seen through all of the air before it.
#include <gtest/gtest.h>

#include "sim/camera/camera_renderer.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

TEST(FarFields, SmokeBeyondTheHorizonsAir) {
  // From 2 m up the ground ends at 5 km; black smoke stands 8.5 km away, and what is seen is the air before it.
  const std::string yaml =
      "atmosphere: hazy_us76\nsun: {azimuth: 90 deg, elevation: 30 deg, temperature: 5772 K}\nground: {temperature: 288 K}\n"
      "smokes: [{name: s, extinction: 1000 m2/kg, position: [0 m, 8500 m, 80 m], rate: 20 kg/s, begin: -60 s, radius: 30 m, lifetime: 200 s}]\n"
      "cameras: [{name: e, film: {width: 9, height: 9}, field_of_view: 0.2 deg, aperture: 5 mm, position: [0 m, 0 m, 2 m], look_at: [0 m, 8500 m, 85 m], "
      "channels: [{name: v, response: {band: [0.5 um, 0.6 um]}, output: radiance}]}]\n";
  const Frame planned = renderFrame(scene("accuracy: 1 %\n" + yaml)), exact = renderFrame(scene("accuracy: reference\n" + yaml));
  figure("radiance of far black smoke [W/(m2 sr)]", at(planned.layers[0], planned, 4, 4), at(exact.layers[0], exact, 4, 4), 0.01,
         "in double precision; what is asked");
}

}  // namespace
}  // namespace pitviper::test
