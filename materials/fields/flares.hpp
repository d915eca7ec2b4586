#pragma once
// Flares: what burns and shines, how it flies, and the cloud that is seen of it.
//
// Intensity = I(lambda) level(t); level = burn(t) speed(V) height(p):
//   burn    rises within rise_s as 3 x^2 - 2 x^3, holds, falls so within the last fall_s of burn_s
//   speed   f + (1 - f) exp(-V/V0): cooled and thinned out by the air that streams past. The two numbers of each type are of the published order (a flare in a
//           windstream sends a half to a tenth of what it sends standing still: N. Brune, Expendable Decoys, in D. Pollock (ed.), Countermeasure Systems, The
//           Infrared and Electro-Optical Systems Handbook vol. 7 (1993); E.-C. Koch, Metal-Fluorocarbon Based Energetic Materials (2012)); the form is chosen.
//   height  (p/p0)^m: burning slows down with pressure (Vieille's law) and with less oxygen around; m chosen within 0.3 ... 1.
//
// Cloud: one soft puff (materials/fields/puff.glsl), or six in a row where air streams past: where they stand, their share of the gas falls as exp(-x/(V
// glow_s)).
//   Its gas is grey, so that its optical depth is a column of cross-sections [m2/m2], and has a radiance of I/(1 m2) times gain; gain = level 1 m2/A,
//   A = int (1 - exp(-depth)) dA over its outline as seen from the side of its way: so what it sends there is I level, whatever its shape. Seen along its way
//   it hides itself: less by A there over A here. Its gas besides emits as a black body of the air's temperature: I is what is sent above air of that
//   temperature. Of one puff with a depth d through its middle A = 2 pi R^2 (1/2 - int_0^1 y exp(-d y^7) dy) = 2 pi R^2 sum_k (-1)^(k+1) d^k/(k! (7k + 2)). R
//   at level 1: where a puff of the type's depth and of its temperature's black body (times emissivity) sends I; at others R ~ level^(1/4) (chosen: a weaker
//   flame is smaller and cooler, half of each).
#include <span>
#include <string_view>

#include "materials/fields/puffs.hpp"
#include "sim/flight/flights.hpp"
#include "sim/model/medium.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Figures of a generic store of its kind; which of them are published and which chosen is in `source`.
struct FlareType {
  std::string_view name, description, source;
  double temperature_K = 0.0;
  std::span<const std::array<double, 2>> emissivity{};  ///< wavelength [um], emissivity; linear between, held beyond
  double intensity_W_sr = 0.0;                          ///< from 3 to 5 um, standing still at sea level
  double ignition_s = 0.0;                              ///< since ejection
  double rise_s = 0.0, burn_s = 0.0, fall_s = 0.0;
  double stillShare = 1.0, speedScale_m_s = 100.0, pressureExponent = 0.0;
  double mass_kg = 0.0, burntShare = 0.0, burnExponent = 1.0;
  double dragArea_m2 = 0.0;               ///< drag coefficient times area
  double depth = 3.0;                     ///< optical, through the cloud's middle at level 1, standing still
  double glow_s = 0.0, spread_m_s = 0.0;  ///< how long what is left behind shines; how fast the cloud's radius grows
  std::string_view smoke{};               ///< of smokeTypes(); empty: none to speak of
  double smokeYield = 0.0;                ///< mass of smoke per mass burnt
};

std::span<const FlareType> flareTypes();
/// Null where there is none of that name.
const FlareType* findFlareType(std::string_view name);

/// I(lambda) of a type [W/(sr um)].
Spectrum flareIntensity(const FlareType& type);
/// Area of a black body of a temperature that sends as much from 1 to 14 um, or of the type's emissivities [m2].
double flareArea_m2(const FlareType& type);
double areaOf_m2(const Spectrum& intensity, double temperature_K);

/// Shares of the level: burning since ignition, air speed, pressure.
double flareBurn(const FlareType& type, double sinceIgnition_s);
double flareInWind(const FlareType& type, double airspeed_m_s);
double flareAtPressure(const FlareType& type, double pressure_Pa);

struct FlareFlight {
  Trajectory path;
  TimeCourse level;  ///< over the simulation's time; 0 outside
  double lit_s = 0.0, out_s = 0.0;
};
/// Flies it until it has burnt out; on the ground it burns on. Errors: FlightError.
FlareFlight flyFlare(const FlareType& type, const Launch& launch, const FlightWorld& world);

/// 2 sum_k ... above: A/(pi R^2) of a puff by its depth through the middle.
double puffOpacity(double depth);
/// A of puffs whose axes are all the same, seen at right angles to it; the first gas counts, 1 m2 of cross-section per unit.
double areaFromTheSide_m2(std::span<const Puff> puffs);

struct FlareCloudOptions {
  int store = -1;  ///< index into Simulation::stores: path, level and lit_s are of what is ejected of it
  std::shared_ptr<const Trajectory> path;
  TimeCourse level;
  double area_m2 = 0.1;  ///< A at level 1, standing still
  double depth = 3.0, glow_s = 0.0, spread_m_s = 0.0;
  double lit_s = 0.0;
  glm::dvec3 wind_m_s{0.0};
  double airWarmer_K = 0.0;  ///< than the standard atmosphere
};

class FlareCloud : public FieldSource {
 public:
  explicit FlareCloud(FlareCloudOptions options);
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return kPuffsShader; }
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override;
  std::string target() const override { return "flare"; }
  /// At level 1, standing still.
  double radius_m() const { return radius_m_; }
  const FlareCloudOptions& options() const { return options_; }

 private:
  FlareCloudOptions options_;
  double radius_m_;
};

/// The cloud's gas: 1 m2 of grey cross-section per unit; radiance as above.
Medium flareGas(const Spectrum& intensity);

}  // namespace pitviper
