#pragma once
// Where sun, moon and stars stand in the sky of a place on the ground by date, how the moon looks, and what moon and stars send there above the air.
//
// Law: earth's place by VSOP2000, shortened (epv00), the moon's by ELP2000-82 as Meeus shortened it (moon98); precession and nutation of IAU 2006/2000A, earth
//   rotation angle of IAU 2000; light time, aberration by earth's path and turn, parallax from WGS84's ellipsoid. No refraction: places are those above air.
// Time: UTC -> TAI -> TT by leap seconds, UT1 = UTC + dut1. Before 1960 ERFA has no UTC: the date is UT1 there, and TT = UT1 + delta T of Espenak and Meeus.
// Source: ERFA 2.0 (the IAU's SOFA); Simon et al. 1994, Astron. Astrophys. 282, 663; Meeus 1998, Astronomical Algorithms, chapter 47; Espenak and Meeus 2006,
//   NASA/TP-2006-214141; Archinal et al. 2011, Celest. Mech. Dyn. Astr. 109, 101 (how the moon is turned); IAU 2015, resolution B3 (the sun's radius).
// Valid: 1900-01-01 to 2100-01-01, where epv00 is; any place on or above the ground.
// Errors: against JPL's DE405, every 0.37 days of 1960 to 2060: sun 0.015" and 6 km at most; moon 3.0" and 3 km rms, 18.3" and 13 km at most. Besides: polar
//   motion, left out: up to 0.6". dut1 where it isn't given: up to 0.9 s, by which all turn up to 13.5". TT: 1 s moves the moon by 0.55", the sun by 0.04";
//   leap seconds after ERFA's last aren't known, by 2100 that may be a minute; before 1960 delta T, a second or so. Stars: no parallax, 0.75" at most.
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace pitviper {

/// UTC as ERFA's quasi-Julian date in two parts: a day with a leap second has 86401 equal seconds.
struct Instant {
  double day = 2451544.5, fraction = 0.0;
};

/// Reads "2026-06-21T12:30:00Z" (ISO 8601): seconds and their fraction may lack, second 60 is read where UTC has a leap second, and behind it may stand Z or an
/// offset such as +02:00; without, it is UTC. Where it can't be read or lies outside 1900 to 2100: nothing, and `problem` says what was expected.
std::optional<Instant> parseInstant(std::string_view text, std::string& problem);

/// Whether earth and moon are known of it, as parseInstant() asks of what it reads.
bool isCovered(const Instant& when);

/// Geodetic, on WGS84. Longitude is positive to the east, height is above the ellipsoid.
struct GroundPlace {
  double latitude_rad = 0.0, longitude_rad = 0.0, height_m = 0.0;
};

struct SkyPlace {
  double azimuth_rad = 0.0;    ///< from north over east, 0 to 2 pi
  double elevation_rad = 0.0;  ///< of its centre, as seen from the place without refraction
  double distance_m = 0.0;     ///< from the place; 0: a star
  double angularRadius_rad = 0.0;
};

SkyPlace sunPlace(const Instant& when, const GroundPlace& where, double dut1_s = 0.0);

/// The moon as seen from a place. Angles on the sky count from the direction of the zenith to the left, as seen by who faces the moon.
struct MoonLook {
  SkyPlace place;
  double phaseAngle_rad = 0.0;  ///< at the moon, between sun and place: 0 is full, pi is new
  double litFraction = 0.0;     ///< of the disc's area: (1 + cos phaseAngle) / 2
  double brightLimb_rad = 0.0;  ///< where the middle of the lit limb stands, -pi to pi
  double northPole_rad = 0.0;   ///< where the moon's own north pole stands, -pi to pi
  double sunDistance_m = 0.0;   ///< from the moon
  /// Selenographic (mean earth and polar axes), east positive: where the place and the sun stand in the moon's zenith. Axes within 0.006 degrees of DE405's.
  double placeLatitude_rad = 0.0, placeLongitude_rad = 0.0, sunLatitude_rad = 0.0, sunLongitude_rad = 0.0;
};
/// Eclipses aren't seen in it: within 1.6 degrees of full it may be in earth's shadow.
MoonLook moonLook(const Instant& when, const GroundPlace& where, double dut1_s = 0.0);

/// Reflectance of the moon's whole disc, dimensionless: a white plate of its size that faces sun and place has 1.
/// Law: ROLO 311g, ln A = sum a_i g^i + sum b_j Phi^(2j-1) + c1 theta + c2 phi + c3 Phi theta + c4 Phi phi + d1 exp(-g/p1) + d2 exp(-g/p2) + d3 cos((g-p3)/p4);
///   linear between its 32 bands, beyond them as the last; beyond 97 degrees dimmed on by 0.026 g + 4e-9 g^4 magnitudes.
/// Source: Kieffer and Stone 2005, Astron. J. 129, 2887, equations 10 and 11, table 4; Krisciunas and Schaefer 1991, PASP 103, 1033 (dimming).
/// Valid: 0.35 to 2.38 um, phase angles of 1.55 to 97 degrees; further out as said, without eclipses. The moon's own warmth, which is more than its sunlight
///   beyond some 3 um, isn't in it.
/// Errors: the fit's 1 %; of the scale 5 to 10 %; from band to band some 3 %, since the paper's smoothing by Apollo's samples isn't in the coefficients.
///   Beyond 97 degrees not known; at new moon 3e-4 of full moon's is left, where there should be none.
double moonReflectance(const MoonLook& moon, double wavelength_um);

/// Irradiance of the moon on a plane that faces it, above the air, over that of the sun at 1 au. Multiply by a solar spectrum at 1 au.
double moonlightShare(const MoonLook& moon, double wavelength_um);

/// By the sun's centre, without refraction: day ends where its upper limb sinks under a level horizon as air of 34' refraction shows it.
enum class Twilight { Day, Civil, Nautical, Astronomical, Night };
Twilight twilightAt(double sunElevation_rad);
/// "day", "civil twilight", "nautical twilight", "astronomical twilight", "night".
std::string_view nameOf(Twilight twilight);

/// A row of atmosphere/library/bright_stars.csv: ICRS, at 2000.0.
struct Star {
  std::string name;
  double rightAscension_rad = 0.0, declination_rad = 0.0;
  double eastMotion_radPerYear = 0.0, northMotion_radPerYear = 0.0;
  double magnitude = 0.0, colour = 0.0;     ///< Johnson's V and B - V
  std::optional<double> infraredMagnitude;  ///< K, where it is known
};
/// Reads the table; where a line can't be read: nothing, and `problem` says which and what was expected.
std::optional<std::vector<Star>> readStars(std::string_view csv, std::string& problem);

/// In the order of the stars.
std::vector<SkyPlace> starPlaces(std::span<const Star> stars, const Instant& when, const GroundPlace& where, double dut1_s = 0.0);

/// Temperature of a star's colour [K]. Source: Ballesteros 2012, Europhys. Lett. 97, 34008. Valid: B - V of -0.4 to 2, without dust before it.
double starTemperature_K(double colour);

/// Irradiance of a star above the air [W/(m2 um)].
/// Law: black body of starTemperature_K, so high that V is right at 0.545 um; where K is known, times a power of the wavelength from there to 2.19 um that
///   makes K right, and beyond as at 2.19 um. V = 0 is 3.631e-8 W/(m2 um), K = 0 is 3.961e-10.
/// Source: zero points of Bessell, Castelli and Plez 1998, Astron. Astrophys. 333, 231, table A2.
/// Errors: lines and bands aren't in it. Without K: J and K within 0.2 magnitudes up to B - V of 1.2; redder, too faint: K by 0.3 (Aldebaran) to 0.5 (Mirach),
///   J by 0.4 (Betelgeuse), and more of M giants, whose B - V no longer grows. Variable stars go by their mean.
double starIrradiance(const Star& star, double wavelength_um);

}  // namespace pitviper
