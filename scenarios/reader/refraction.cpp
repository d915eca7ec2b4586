// Refraction of a scenario: the earth's radius in the picture, lines of sight in the air, apparent places in the sky.
#include "sim/sky/refraction.hpp"

#include <cmath>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/model/refracts.hpp"

namespace pitviper {
namespace {

/// Nearer to 1 light goes round the earth.
constexpr double kMostRefraction = 0.9;

}  // namespace

void Builder::readRefraction(const Record& scenario) {
  if (!scenario.given("refraction")) return;
  const Value& v = scenario.value("refraction");
  const bool isMap = v.kind == Value::Kind::Map;
  if (!isMap && v.text == "none") return;
  if (!isMap && (v.kind != Value::Kind::Scalar || v.text != "standard"))
    throw UserError(v.where, "refraction is neither 'none' nor 'standard' nor a map", "one of these", "write 'refraction: standard'");
  const Geodetic origin = simulation_.frame.origin();
  const double height_m = origin.height_m - simulation_.frame.ground_m();
  const auto* air = dynamic_cast<const Refracts*>(simulation_.air.get());
  const auto own = air ? air->refractionCoefficient(height_m) : std::nullopt;
  const double k = isMap ? Record(v, tables::refraction()).number("coefficient") : own.value_or(kStandardRefraction);
  const auto bent = own && k <= kMostRefraction ? air->bent(k) : nullptr;
  if (own && !bent)
    throw UserError(v.where, "light does not leave this air: at some height its density falls so fast that lines bend as the earth does",
                    "air without ducts, -R dn/dh below 1", "smooth the sounding, or write 'refraction: none'");
  if (own) {
    // Of the air as it was read: bent lines are not bent again. Near the horizon the turn changes by a third of the elevation's change at most.
    bending_ = [kept = simulation_.air, air, height_m, radius_m = simulation_.frame.earthRadius_m()](double true_rad) {
      double shift = 0.0;
      for (int i = 0; i < 20; ++i) shift = air->bending_rad(height_m, std::sin(true_rad + shift), radius_m);
      return shift;
    };
    simulation_.air = bent;
  } else {
    bending_ = [here = standardAir(origin.height_m)](double true_rad) { return refraction_rad(true_rad, here.pressure_Pa, here.temperature_K); };
  }
  simulation_.frame = LocalFrame(origin, simulation_.frame.ground_m(), k);
}

}  // namespace pitviper
