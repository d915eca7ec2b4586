// An area light: a flat Lambertian face, by points that send as it does.
#include "materials/lights.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace physics {
#define PHYSICS inline
#include "materials/area.glsl"
#undef PHYSICS
}  // namespace physics

namespace {

bool isDisc(const Record& r) {
  const bool disc = r.given("diameter");
  for (const char* side : {"width", "height"})
    if (disc == r.given(side))
      throw UserError(disc ? r.where(side) : r.where(),
                      disc ? "an area light that is a disc and a rectangle" : "an area light that is neither a disc nor a rectangle",
                      "'diameter', or 'width' and 'height'", disc ? std::string("remove '") + side + "'" : "add them");
  return disc;
}

/// Gauss points of a rectangle across both sides; of a disc in the square of the radius, and evenly around.
std::vector<LightPoint> pointsOf(const Record& r) {
  const int across = static_cast<int>(r.integer("points"));
  std::vector<LightPoint> points;
  if (!isDisc(r)) {
    for (const auto& y : gaussLegendre(across, -0.5, 0.5))
      for (const auto& z : gaussLegendre(across, -0.5, 0.5)) points.push_back({{0.0, y.x * r.number("width"), z.x * r.number("height")}, y.weight * z.weight});
    return points;
  }
  const int around = 2 * across;
  for (const auto& square : gaussLegendre((across + 1) / 2, 0.0, 1.0))
    for (int k = 0; k < around; ++k) {
      const double radius = 0.5 * r.number("diameter") * std::sqrt(square.x), turn = 2.0 * kPi * (k + 0.5) / around;
      points.push_back({{0.0, radius * std::cos(turn), radius * std::sin(turn)}, square.weight / around});
    }
  return points;
}

}  // namespace

LightModel areaModel() {
  return {
      "area",
      "A flat Lambertian face (luminous panel, window) that lights what lies before it, by points that stand for it; it is not seen itself: let a body of "
      "its size stand there. Of its irradiance 4 points across are within 0.02 % from its longer side on and within 1 % from half of that on, 6 within 0.04 %.",
      {required(atLeast(spectrum("radiance", "W/(m2 sr um)", "spectral radiance of its face"), 0)),
       within(number("width", "m", "of a rectangle, along its y axis"), 1e-6, 1e4),
       within(number("height", "m", "of a rectangle, along its z axis"), 1e-6, 1e4), within(number("diameter", "m", "of a disc"), 1e-6, 1e4),
       withDefault(integer("points", "across it: their square is how many lights it counts as, and the steps of its penumbrae", 2, 16), "4"), levelParameter()},
      [](const ModelRecord& r, PointLight& light) {
        const Record& own = r.record;
        if (own.given("visible") && light.visible)
          throw UserError(own.where("visible"), "an area light that is seen itself", "a body of its size and radiance in its place", "remove 'visible'");
        light.visible = false;
        const double area_m2 = isDisc(own) ? 0.25 * kPi * own.number("diameter") * own.number("diameter") : own.number("width") * own.number("height");
        light.intensity = r.spectrum("radiance") * area_m2;
        light.pattern = {"materials/area.glsl", "areaPattern", physics::areaPattern, {1, 0, 0, 0}};
        readLevel(own, light);
      },
      true,
      {},
      pointsOf};
}

}  // namespace pitviper
