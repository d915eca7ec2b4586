#pragma once
// The radiance equation, once, in double precision: what a line of sight is a sum of, told from the eye outwards.
//
// Law, at one wavelength: L = sum of terms  c x product of spectra x exp(-depth of the air on all legs - depth of media) x transmittances of panes,
//   surfaces: emission (Kirchhoff), the dome's light, light of the sun and of points; and, of every stretch of the way, what air and media send:
//   integral of J exp(-t) dt, J = sum of (depth share) x (source), linear in depth; sunlight scattered once by the air.
// Source: Duvenhage 2006 sections 4.2 to 4.7 in the cancelled, energy-conserving form; Chandrasekhar 1960 chapter I (formal solution).
// Depths of the air come from amounts on the whole way (both legs of reflected light), raised to their powers; they don't multiply by parts.
// The shaders are the second, independent writing of it.
#include <functional>
#include <span>

#include "sim/radiance/factor.hpp"
#include "sim/radiance/sunlit_air.hpp"
#include "sim/radiance/terms.hpp"
#include "sim/world/light_legs.hpp"
#include "sim/world/ray_hits.hpp"

namespace pitviper {

enum class TermKind { Emission, Ambient, Sun, Lights, AirEmission, ScatteredSun, Background, Media, LampsInView, ScatteredAgain };
constexpr int kTermKinds = 10;
const char* nameOf(TermKind kind);

/// What a part of a line's radiance is.
struct Part {
  TermKind kind = TermKind::Emission;
  int entity = -1;  ///< whose surface sends it; -1: no body's
  int light = -1;   ///< whose light it is: an index into Simulation::lights; -1: of none of them
  auto operator<=>(const Part&) const = default;
};

/// coefficient x product of spectra x exp(-depth on its way) x what the panes and media so far let through.
struct Term {
  TermKind kind = TermKind::Emission;
  double coefficient = 1.0;
  std::span<const Factor> factors;
  const AirAmounts* air = nullptr;  ///< on all legs, raised to their powers; null: from the eye to here alone
  int entity = -1, light = -1;      ///< as of Part
  Part part() const { return {kind, entity, light}; }
};

/// A place on the line of sight, with the air between the eye and it.
struct AirPlace {
  double range_m = 0.0;
  double temperature_K = 0.0;  ///< of the air; 0: it emits nothing but AirNode::source
  AirAmounts powered;          ///< raised to their powers
  AirAmounts both;             ///< with the way on to the sun, where there is one
  double sun = 0.0;            ///< share of its disc that reaches it
  double height_m = 0.0;
  double sine = 0.0;  ///< of the line's elevation there
};

/// A body of gas or smoke on a stretch of the line, or one gas of a field at one temperature.
struct MediumInside {
  const Medium* medium = nullptr;
  int entity = -1, material = 0;
  double temperature_K = 0.0;
  double length_m = 0.0;                      ///< of a field: amount
  bool lasting = true;                        ///< other lines meet it at this temperature
  double gain = 1.0;                          ///< factor of Medium::radiance
  double sun = 0.0;                           ///< share of the sun that reaches it, not counting what the air and this medium take
  double sunAmount = 0.0;                     ///< of the same medium on the way to the sun
  double drift_perK = 0.0;                    ///< 1 / temperature at the segment's far end, less that at its near end
  int field = -1;                             ///< index into Simulation::fields; -1: a body's
  const physics::CloudStep* cloud = nullptr;  ///< of drops
  Factor source() const { return Factor::medium(*medium, temperature_K, gain, lasting); }
};

/// A part of the way with nothing but air and media in it.
struct Segment {
  const AirPlace &near, &far;
  std::span<const MediumInside> media;
  bool air = false, sunlit = false;    ///< whether there is air, and sunlight for it to scatter
  double cosScatter = 0.0;             ///< between the line and the direction to the sun
  double cosAzimuth = 0.0;             ///< of the line's azimuth to the sun's
  bool dark = false;                   ///< only what it lets through is asked for
  const AirAmounts* sunAir = nullptr;  ///< from the eye to `near` and on to the sun, powered, where media scatter its light; null: no air
};

/// Takes a line of sight in the order from the eye outwards.
class TermSink {
 public:
  virtual ~TermSink() = default;
  /// The way begins at the eye, anew for a second line that adds to the first (a lamp in the same pixel).
  virtual void restart() = 0;
  /// Radiance that begins at the place reached.
  virtual void term(const Term& term) = 0;
  /// The way goes on over a stretch: what it sends, and what it lets through from then on.
  virtual void segment(const Segment& segment) = 0;
  /// The way goes on through a pane.
  virtual void pane(const Factor& transmittance, double modifier) = 0;
};

struct LineOfSight {
  glm::dvec3 origin{0.0}, direction{0.0, 0.0, 1.0};  ///< local frame; unit
  RayHits hits;                                      ///< what it meets, cut off at what is solid
  double temperature_K = 0.0;                        ///< of bodies without a temperature texture; 0: their own
};

/// What all lines of sight at a time have in common. All must outlive it.
struct RadianceScene {
  const Simulation& simulation;
  const Terms& terms;
  const SunLegs* sunLegs = nullptr;  ///< of layered air in sunlight
  const WorldState& state;
  /// Share of a light (an index into Simulation::lights, or their number for the sun) that reaches a place; empty: all of it.
  std::function<double(const Hit&, std::size_t light, const LightLeg&)> lit;
  /// Places at which the air is looked at, besides those where something begins; 0: as many as the reference needs.
  int airPlaces = 0;
  TextureTaps taps{};  ///< of hits that know what a pixel covers
};

void radianceAlong(const RadianceScene& scene, const LineOfSight& line, TermSink& sink);

/// The air, media and panes of a line as far as a range: what they let through.
void wayAlong(const RadianceScene& scene, const LineOfSight& line, double range_m, TermSink& sink);
/// The same with what air, media and panes on the way send.
void lightOfWay(const RadianceScene& scene, const LineOfSight& line, double range_m, TermSink& sink);

/// A light itself, seen at its distance through all that lies before it: one term, of an intensity of 1 / solid angle [sr] of a pixel.
void lampAlong(const RadianceScene& scene, const LineOfSight& line, std::size_t light, double pixel_sr, TermSink& sink);

}  // namespace pitviper
