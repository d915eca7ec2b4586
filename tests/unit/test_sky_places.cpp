// Places of sun, moon and stars against published worked examples, eclipses and ERFA's own ways; moonlight and starlight against published laws and magnitudes.
//
// Rationale: a sign or a time scale taken wrongly puts the sun elsewhere by minutes or degrees, and pictures would still look right.
// Expectation: the printed figures of NREL's SPA and of Meeus's examples within their own accuracy; sun and moon in line where eclipses were.
#include <erfa.h>
#include <erfam.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/radiometry/constants.hpp"
#include "sim/sky/sky_places.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0, kSecond = kDegree / 3600.0;
/// Geodetic place of earth's centre: places as seen from there are geocentric.
const GroundPlace kCentre{0.0, 0.0, -6378137.0};

Instant at(const std::string& text) {
  std::string problem;
  const auto instant = parseInstant(text, problem);
  EXPECT_TRUE(instant) << problem;
  return instant.value_or(Instant());
}

std::string refusal(const std::string& text) {
  std::string problem;
  EXPECT_FALSE(parseInstant(text, problem)) << text;
  return problem;
}

double apart(const SkyPlace& a, const SkyPlace& b) { return eraSeps(a.azimuth_rad, a.elevation_rad, b.azimuth_rad, b.elevation_rad); }

struct Apparent {
  double ra, dec, longitude, latitude;
};

/// Equatorial and ecliptic, true equinox of date, of a place as seen from kCentre: x is up there, y east, z north.
Apparent apparentOf(const SkyPlace& p, const Instant& when) {
  double tai[2], tt[2], ut1[2], dpsi, deps;
  eraUtctai(when.day, when.fraction, &tai[0], &tai[1]);
  eraTaitt(tai[0], tai[1], &tt[0], &tt[1]);
  eraUtcut1(when.day, when.fraction, 0.0, &ut1[0], &ut1[1]);
  eraNut06a(tt[0], tt[1], &dpsi, &deps);
  Apparent a{};
  a.ra = eraAnp(eraGst06a(ut1[0], ut1[1], tt[0], tt[1]) + std::atan2(std::cos(p.elevation_rad) * std::sin(p.azimuth_rad), std::sin(p.elevation_rad)));
  a.dec = std::asin(std::cos(p.elevation_rad) * std::cos(p.azimuth_rad));
  const double obliquity = eraObl06(tt[0], tt[1]) + deps;
  a.longitude = eraAnp(std::atan2(std::sin(a.ra) * std::cos(obliquity) + std::tan(a.dec) * std::sin(obliquity), std::cos(a.ra)));
  a.latitude = std::asin(std::sin(a.dec) * std::cos(obliquity) - std::cos(a.dec) * std::sin(obliquity) * std::sin(a.ra));
  return a;
}

/// As seen from kCentre, the direction of the celestial north pole at a place, from the zenith's to the left.
double northAt(const SkyPlace& p) { return std::atan2(std::sin(p.azimuth_rad), -std::sin(p.elevation_rad) * std::cos(p.azimuth_rad)); }

std::vector<Star> brightStars() {
  std::ifstream file(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/bright_stars.csv");
  std::stringstream text;
  text << file.rdbuf();
  std::string problem;
  const auto stars = readStars(text.str(), problem);
  EXPECT_TRUE(stars) << problem;
  return stars.value_or(std::vector<Star>());
}

TEST(SkyPlaces, ReadsDates) {
  const auto whole = [](const char* text) {
    const Instant i = at(text);
    return i.day + i.fraction;
  };
  EXPECT_DOUBLE_EQ(whole("2000-01-01T12:00:00Z"), 2451545.0);
  for (const char* same : {"2000-01-01T12:00", "2000-01-01t12:00:00.000z", "2000-01-01 14:00+02:00", "2000-01-01T05:00:00,0-0700", "2000-01-02T02:00+14"})
    EXPECT_DOUBLE_EQ(whole(same), 2451545.0) << same;
  EXPECT_NEAR((whole("2026-06-21T12:30:00.25Z") - whole("2026-06-21T12:30:00Z")) * 86400.0, 0.25, 1e-4);
  // The leap second at the end of 2016, as UTC has it and in another zone.
  EXPECT_LT(whole("2016-12-31T23:59:59.9Z"), whole("2016-12-31T23:59:60.9Z"));
  EXPECT_LT(whole("2016-12-31T23:59:60.9Z"), whole("2017-01-01T00:00:00Z"));
  EXPECT_DOUBLE_EQ(whole("2017-01-01T01:59:60+02:00"), whole("2016-12-31T23:59:60Z"));
}

TEST(SkyPlaces, SaysWhatItExpectedOfADate) {
  for (const auto& [text, part] : {std::pair{"2026-02-30T00:00Z", "01 to 28 in month 02 of 2026"},
                                   {"2026-13-01T00:00Z", "month of 01 to 12"},
                                   {"2026-00-01T00:00Z", "month of 01 to 12"},
                                   {"2026-06-21T24:00Z", "00:00 to 23:59"},
                                   {"2026-06-21T12:60Z", "00:00 to 23:59"},
                                   {"2015-12-31T23:59:60Z", "no leap second"},
                                   {"2016-12-31T23:59:61Z", "no leap second"},
                                   {"2026-06-21T12:00:75Z", "no leap second"},
                                   {"2026-06-21T12:00:00.Z", "digits"},
                                   {"2026-06-21T12:00:00+2", "offset"},
                                   {"2026-06-21T12:00:00+02:", "offset"},
                                   {"2026-06-21T12:00:00+25:00", "offset"},
                                   {"2026-06-21", "2026-06-21T12:30:00Z"},
                                   {"", "2026-06-21T12:30:00Z"},
                                   {"26-6-21T12:00", "2026-06-21T12:30:00Z"},
                                   {"2026-06-21T12:00:00Zulu", "2026-06-21T12:30:00Z"},
                                   {"1899-12-31T23:59:59Z", "1900-01-01T00:00Z to 2100"},
                                   {"2100-01-01T00:00:01Z", "1900-01-01T00:00Z to 2100"},
                                   {"0000-01-01T00:00:00Z", "1900-01-01T00:00Z to 2100"}})
    EXPECT_NE(refusal(text).find(part), std::string::npos) << text << " -> " << refusal(text);
}

// Reda and Andreas 2008, NREL/TP-560-34302, appendix A.5: 17 October 2003, 12:30:30 at UTC - 7, delta T 67 s; without refraction.
// It takes its date for UT1. TT = UT1 + 67 s is UTC + 64.184 s (32 leap seconds then), so UTC is 2.816 s after UT1.
TEST(SkyPlaces, SunOfSpa) {
  const SkyPlace sun = sunPlace(at("2003-10-17T12:30:32.816-07:00"), {39.742476 * kDegree, -105.1786 * kDegree, 1830.14}, 64.184 - 67.0);
  EXPECT_NEAR(sun.elevation_rad, 39.872046 * kDegree, 1.0 * kSecond);
  EXPECT_NEAR(sun.azimuth_rad, 194.34024 * kDegree, 1.0 * kSecond);
}

// Meeus 1998, page 165, example 25.a by the whole VSOP87: 13 October 1992, 0h TD: apparent longitude 199 54'21.56", latitude 0.72", right ascension
// 13h 13m 30.749s, declination -7 47'01.74", 0.99760853 au.
TEST(SkyPlaces, SunOfMeeus) {
  const Instant when = at("1992-10-12T23:59:00.816Z");
  const SkyPlace sun = sunPlace(when, kCentre);
  const Apparent a = apparentOf(sun, when);
  EXPECT_NEAR(a.longitude, (199.0 + 54.0 / 60.0 + 21.56 / 3600.0) * kDegree, 0.1 * kSecond);
  EXPECT_NEAR(a.latitude, 0.72 * kSecond, 0.1 * kSecond);
  EXPECT_NEAR(a.ra, (198.25 + 30.749 / 240.0) * kDegree, 0.1 * kSecond);
  EXPECT_NEAR(a.dec, -(7.0 + 47.0 / 60.0 + 1.74 / 3600.0) * kDegree, 0.1 * kSecond);
  EXPECT_NEAR(sun.distance_m / ERFA_DAU, 0.99760853, 5e-8);
  // 959.63" at 1 au by almanacs, 959.23" by the IAU's nominal radius.
  EXPECT_NEAR(sun.angularRadius_rad, 959.23 / 0.99760853 * kSecond, 0.01 * kSecond);
}

// Meeus 1998, examples 47.a, 48.a and 53.a: 12 April 1992, 0h TD.
TEST(SkyPlaces, MoonOfMeeus) {
  const Instant when = at("1992-04-11T23:59:01.816Z");
  const MoonLook moon = moonLook(when, kCentre);
  const Apparent a = apparentOf(moon.place, when);
  EXPECT_NEAR(a.longitude, 133.167265 * kDegree, 1.0 * kSecond);
  EXPECT_NEAR(a.latitude, -3.229127 * kDegree, 1.0 * kSecond);
  EXPECT_NEAR(a.ra, 134.688470 * kDegree, 1.0 * kSecond);
  EXPECT_NEAR(a.dec, 13.768368 * kDegree, 1.0 * kSecond);
  EXPECT_NEAR(moon.place.distance_m, 368409.7e3, 1e3);
  EXPECT_NEAR(moon.place.angularRadius_rad, std::asin(1737.4 / 368409.7), 1e-8);
  EXPECT_NEAR(moon.phaseAngle_rad, 69.0756 * kDegree, 0.001 * kDegree);
  EXPECT_NEAR(moon.litFraction, 0.6786, 5e-5);
  EXPECT_NEAR(eraAnp(moon.brightLimb_rad - northAt(moon.place)), 285.0 * kDegree, 0.05 * kDegree);
  // Meeus counts from axes of inertia, which lie up to 0.03 degrees beside the mean ones: 0.7 km on the moon.
  EXPECT_NEAR(eraAnp(moon.northPole_rad - northAt(moon.place)), 15.08 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(moon.placeLongitude_rad, -1.23 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(moon.placeLatitude_rad, 4.20 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(moon.sunLongitude_rad, 67.89 * kDegree, 0.03 * kDegree);
  EXPECT_NEAR(moon.sunLatitude_rad, 1.46 * kDegree, 0.03 * kDegree);
  // By JPL's DE405 on mean axes.
  EXPECT_NEAR(moon.placeLongitude_rad, -1.2306 * kDegree, 0.006 * kDegree);
  EXPECT_NEAR(moon.placeLatitude_rad, 4.1747 * kDegree, 0.006 * kDegree);
}

/// Seconds of a UTC day at which the moon's disc begins and ends to lie wholly before the sun's (or to touch it).
std::pair<double, double> coveredFrom(const std::string& day, int first_s, int last_s, const GroundPlace& where, bool touched) {
  std::pair<double, double> span{-1.0, -1.0};
  for (int s = first_s; s <= last_s; ++s) {
    char text[32];
    std::snprintf(text, sizeof text, "T%02d:%02d:%02dZ", s / 3600, s / 60 % 60, s % 60);
    const Instant when = at(day + text);
    const SkyPlace sun = sunPlace(when, where), moon = moonLook(when, where).place;
    if (apart(sun, moon) > moon.angularRadius_rad + (touched ? 1.0 : -1.0) * sun.angularRadius_rad) continue;
    if (span.first < 0.0) span.first = s;
    span.second = s;
  }
  return span;
}

// 8 April 2024 in downtown Dallas, as told by NASA: it begins at 12:23 CDT, is total from 1:40 to 1:44 pm (for 3 min 51 s), and ends at 3:02 pm.
TEST(SkyPlaces, EclipseOfDallas) {
  const GroundPlace dallas{32.7767 * kDegree, -96.797 * kDegree, 130.0};
  const int noon_s = 17 * 3600;
  const auto total = coveredFrom("2024-04-08", noon_s + 95 * 60, noon_s + 110 * 60, dallas, false);
  EXPECT_EQ(std::floor(total.first / 60.0), 18 * 60 + 40);
  EXPECT_EQ(std::floor(total.second / 60.0), 18 * 60 + 44);
  // Here valleys of the limb aren't seen through: a few seconds longer.
  EXPECT_NEAR(total.second - total.first, 231.0, 10.0);
  EXPECT_EQ(std::floor(coveredFrom("2024-04-08", noon_s + 20 * 60, noon_s + 30 * 60, dallas, true).first / 60.0), 17 * 60 + 23);
  EXPECT_EQ(std::floor(coveredFrom("2024-04-08", noon_s + 180 * 60, noon_s + 190 * 60, dallas, true).second / 60.0), 20 * 60 + 2);
  EXPECT_LT(moonLook(at("2024-04-08T18:42:45Z"), dallas).litFraction, 1e-6);
}

// Before there was UTC: 29 May 1919, greatest at 13:08:34 UT at 4.4 N 16.7 W, total for 6 min 51 s (Espenak, NASA).
TEST(SkyPlaces, EclipseOf1919) {
  const auto total = coveredFrom("1919-05-29", 13 * 3600, 13 * 3600 + 16 * 60, {4.4 * kDegree, -16.7 * kDegree, 0.0}, false);
  EXPECT_NEAR((total.first + total.second) / 2.0, 13 * 3600 + 8 * 60 + 34, 20.0);
  EXPECT_NEAR(total.second - total.first, 411.0, 8.0);
}

// Where one formula of delta T follows another, and UTC follows the last, the moon goes on from the sun as in the second before, but for 0.5" per second that
// they differ: 0.1 s.
TEST(SkyPlaces, DeltaTJoins) {
  struct Join {
    const char *earlier, *before, *after;
    double jump;
  };
  for (const Join& join : {Join{"1920-01-01T11:59:58Z", "1920-01-01T11:59:59Z", "1920-01-01T12:00:00Z", 0.05},
                           Join{"1940-12-31T17:59:58Z", "1940-12-31T17:59:59Z", "1940-12-31T18:00:00Z", 0.05},
                           Join{"1959-12-31T23:59:58Z", "1959-12-31T23:59:59Z", "1960-01-01T00:00:00Z", 0.05}}) {
    const auto gap = [](const char* text) { return apart(sunPlace(at(text), kCentre), moonLook(at(text), kCentre).place); };
    EXPECT_NEAR(gap(join.after) - gap(join.before), gap(join.before) - gap(join.earlier), join.jump * kSecond) << join.after;
  }
}

// Greatest eclipses of the moon: NASA's catalogue.
TEST(SkyPlaces, FullAndNewMoons) {
  for (const char* full : {"2018-07-27T20:21:44Z", "2022-11-08T10:59:11Z", "2025-03-14T06:58:43Z", "2026-03-03T11:33:37Z"}) {
    const MoonLook moon = moonLook(at(full), kCentre);
    EXPECT_GT(moon.litFraction, 0.99998) << full;
    EXPECT_LT(moon.phaseAngle_rad, 0.5 * kDegree) << full;
  }
  const MoonLook fresh = moonLook(at("2024-04-08T18:17:18Z"), kCentre);
  EXPECT_LT(fresh.litFraction, 2e-5);
  // At first quarter the sun stands over the moon's east.
  const MoonLook half = moonLook(at("2026-06-21T21:55:00Z"), kCentre);
  EXPECT_NEAR(half.litFraction, 0.5, 0.01);
  EXPECT_NEAR(half.sunLongitude_rad, 90.0 * kDegree, 8.0 * kDegree);
}

TEST(SkyPlaces, BrightLimbFacesTheSun) {
  // Evening in Greenwich, waxing: the sun stands to the right of the moon and below it.
  const MoonLook moon = moonLook(at("2026-06-18T21:00:00Z"), {51.4769 * kDegree, 0.0, 0.0});
  EXPECT_GT(moon.place.azimuth_rad, kPi);
  EXPECT_LT(moon.brightLimb_rad, -kPi / 2.0);
  EXPECT_GT(moon.northPole_rad, -kPi / 2.0);
}

// Sun and moon through a year stay within almanacs' sizes: sun 943.7" to 976.0", moon 14.7' to 16.8' (up to 17.1' overhead).
TEST(SkyPlaces, Sizes) {
  double least[2] = {1.0, 1.0}, most[2] = {0.0, 0.0};
  for (int day = 1; day <= 365; ++day) {
    const Instant when{at("2026-01-01T00:00Z").day, day - 1.0};
    const double sizes[2] = {sunPlace(when, kCentre).angularRadius_rad, moonLook(when, kCentre).place.angularRadius_rad};
    for (int i : {0, 1}) least[i] = std::min(least[i], sizes[i]), most[i] = std::max(most[i], sizes[i]);
  }
  EXPECT_NEAR(least[0], 943.5 * kSecond, 0.5 * kSecond);
  EXPECT_NEAR(most[0], 975.5 * kSecond, 0.5 * kSecond);
  EXPECT_GT(least[1], 14.6 / 60.0 * kDegree);
  EXPECT_LT(most[1], 16.8 / 60.0 * kDegree);
}

TEST(SkyPlaces, NothingBreaksAtTheEnds) {
  for (const char* text : {"1900-01-01T00:00:00Z", "1919-12-31T23:59:59Z", "1940-12-31T12:00:00Z", "1959-12-31T23:59:59Z", "1960-01-01T00:00:00Z",
                           "1972-01-01T00:00:00Z", "2016-12-31T23:59:60.5Z", "2026-03-20T14:46:00Z", "2100-01-01T00:00:00Z"})
    for (double latitude : {-90.0, -45.0, 0.0, 66.56, 90.0})
      for (double longitude : {-180.0, 0.0, 77.0, 180.0, 359.0})
        for (double height : {-400.0, 0.0, 20e3}) {
          const GroundPlace where{latitude * kDegree, longitude * kDegree, height};
          const Instant when = at(text);
          const MoonLook moon = moonLook(when, where);
          for (const SkyPlace& p : {sunPlace(when, where), moon.place}) {
            EXPECT_TRUE(p.azimuth_rad >= 0.0 && p.azimuth_rad < 2.0 * kPi);
            EXPECT_TRUE(std::abs(p.elevation_rad) <= kPi / 2.0);
            EXPECT_TRUE(p.distance_m > 3.5e8 && p.angularRadius_rad > 0.004 && p.angularRadius_rad < 0.005);
          }
          EXPECT_TRUE(moon.phaseAngle_rad >= 0.0 && moon.phaseAngle_rad <= kPi && moon.litFraction >= 0.0 && moon.litFraction <= 1.0);
          EXPECT_TRUE(std::abs(moon.brightLimb_rad) <= kPi && std::abs(moon.northPole_rad) <= kPi);
          EXPECT_LT(std::abs(moon.placeLatitude_rad), 8.0 * kDegree);
          EXPECT_LT(std::abs(moon.placeLongitude_rad), 9.3 * kDegree);
          EXPECT_LT(std::abs(moon.sunLatitude_rad), 1.7 * kDegree);
          for (double um : {0.1, 0.35, 0.55, 2.4, 12.0}) EXPECT_TRUE(moonlightShare(moon, um) >= 0.0 && moonlightShare(moon, um) < 2e-5);
        }
  // At the pole the sun's elevation is its declination, less parallax: 23.436 degrees at the solstice.
  EXPECT_NEAR(sunPlace(at("2026-06-21T08:24:00Z"), {kPi / 2.0, 0.0, 0.0}).elevation_rad, 23.436 * kDegree, 0.002 * kDegree);
  // Over the place right under the sun, and at the one opposite to it; there geocentric and geodetic verticals lie up to 0.2 degrees apart.
  const Instant when = at("2026-06-21T08:24:00Z");
  const SkyPlace sun = sunPlace(when, kCentre);
  const double latitude = std::asin(std::cos(sun.elevation_rad) * std::cos(sun.azimuth_rad));
  const double longitude = std::atan2(std::cos(sun.elevation_rad) * std::sin(sun.azimuth_rad), std::sin(sun.elevation_rad));
  EXPECT_NEAR(sunPlace(when, {latitude, longitude, 0.0}).elevation_rad, kPi / 2.0, 2e-6);
  EXPECT_NEAR(sunPlace(when, {-latitude, longitude + kPi, 0.0}).elevation_rad, -kPi / 2.0, 2e-6);
}

// Where the moon stands in the zenith it is nearer by earth's radius, and at the horizon it sinks by its horizontal parallax of 57' (asin of 6378 km /
// distance).
TEST(SkyPlaces, MoonSinksByParallax) {
  const Instant when = at("2026-08-20T18:00:00Z");
  const SkyPlace moon = moonLook(when, kCentre).place;
  const double latitude = std::asin(std::cos(moon.elevation_rad) * std::cos(moon.azimuth_rad));
  const double longitude = std::atan2(std::cos(moon.elevation_rad) * std::sin(moon.azimuth_rad), std::sin(moon.elevation_rad));
  EXPECT_NEAR(moon.distance_m - moonLook(when, {latitude, longitude, 0.0}).place.distance_m, 6371e3, 10e3);
  // On the equator, where verticals go through the centre.
  for (double hours : {-6.0, 6.0}) {
    const GroundPlace where{0.0, longitude + hours * 15.0 * kDegree, 0.0};
    EXPECT_NEAR(moonLook(when, where).place.elevation_rad, -std::asin(6378.137e3 / moon.distance_m), 0.01 * kDegree) << hours;
  }
}

TEST(SkyPlaces, NamesTwilights) {
  for (const auto& [degrees, name] : {std::pair{90.0, "day"},
                                      {-0.8, "day"},
                                      {-0.9, "civil twilight"},
                                      {-6.0, "civil twilight"},
                                      {-6.1, "nautical twilight"},
                                      {-12.1, "astronomical twilight"},
                                      {-17.9, "astronomical twilight"},
                                      {-18.1, "night"},
                                      {-90.0, "night"}})
    EXPECT_EQ(nameOf(twilightAt(degrees * kDegree)), name) << degrees;
}

MoonLook moonAt(double phase_deg, double sunLongitude_deg) {
  MoonLook moon;
  moon.phaseAngle_rad = phase_deg * kDegree, moon.sunLongitude_rad = sunLongitude_deg * kDegree;
  moon.place.distance_m = 384400e3, moon.sunDistance_m = ERFA_DAU;
  return moon;
}

TEST(SkyPlaces, MoonlightByRolo) {
  // All 32 bands at once, from a second copy of Kieffer and Stone's table, taken from another source and evaluated apart.
  MoonLook moon = moonAt(30.0, 25.0);
  moon.placeLatitude_rad = 3.0 * kDegree, moon.placeLongitude_rad = -4.0 * kDegree;
  double sum = 0.0;
  for (double nm : {350.0, 355.1, 405.0, 412.3, 414.4, 441.6, 465.8, 475.0, 486.9,  544.0,  549.1,  553.8,  665.1,  693.1,  703.6,  745.3,
                    763.7, 774.8, 865.3, 872.6, 882.0, 928.4, 939.3, 942.1, 1059.5, 1243.2, 1538.7, 1633.6, 1981.5, 2126.3, 2250.9, 2383.6})
    sum += moonReflectance(moon, nm / 1000.0);
  EXPECT_NEAR(sum, 2.509201449, 1e-8);
  EXPECT_NEAR(moonReflectance(moon, 0.5491), 0.05586566, 1e-8);
  // Between bands, and beyond the last ones.
  EXPECT_NEAR(moonReflectance(moon, (1.2432 + 1.5387) / 2.0), (moonReflectance(moon, 1.2432) + moonReflectance(moon, 1.5387)) / 2.0, 1e-12);
  EXPECT_EQ(moonReflectance(moon, 0.2), moonReflectance(moon, 0.35));
  EXPECT_EQ(moonReflectance(moon, 5.0), moonReflectance(moon, 2.3836));
  // ROLO's own solid angle: 6.4177e-5 sr at 384400 km.
  EXPECT_NEAR(moonlightShare(moon, 0.5491) / moonReflectance(moon, 0.5491), 6.4177e-5 / kPi, 2e-9);
  MoonLook far = moon;
  far.place.distance_m *= 1.05, far.sunDistance_m *= 1.02;
  EXPECT_NEAR(moonlightShare(far, 1.0) / moonlightShare(moon, 1.0), 1.0 / (1.05 * 1.05 * 1.02 * 1.02), 1e-12);
}

// Krisciunas and Schaefer 1991: V = -12.73 + 0.026 |g| + 4e-9 g^4, the sun's being -26.76. Their law leaves out the brightening towards full (up to 35 % within
// 7 degrees) and makes no difference between waxing and waning moon, which ROLO does.
TEST(SkyPlaces, MoonlightByPhase) {
  const auto law = [](double g) { return std::pow(10.0, -0.4 * (-12.73 + 0.026 * g + 4e-9 * std::pow(g, 4.0) + 26.76)); };
  for (double g = 6.0; g <= 178.0; g += 4.0) {
    const double waxing = moonlightShare(moonAt(g, g), 0.55), waning = moonlightShare(moonAt(g, -g), 0.55);
    EXPECT_NEAR((waxing + waning) / 2.0 / law(g), 1.0, 0.07) << g;
    EXPECT_GT(waxing, waning) << g;
  }
  EXPECT_NEAR(moonlightShare(moonAt(1.0, 1.0), 0.55) / law(1.0), 1.25, 0.1);
  double before = moonlightShare(moonAt(0.0, 0.0), 0.55);
  for (double g = 0.5; g <= 180.0; g += 0.5) {
    const double now = moonlightShare(moonAt(g, g), 0.55);
    EXPECT_LT(now, before) << g;
    EXPECT_GT(now, 0.9 * before) << g;
    before = now;
  }
  // Illuminance 5 degrees beside full: 0.25 to 0.32 lx are published; of the sun 2.54e-6 lx x 10^(0.4 x 26.76) = 128 klx (Allen).
  const double lux = 2.54e-6 * std::pow(10.0, 0.4 * 26.76) * moonlightShare(moonAt(5.0, 5.0), 0.55);
  EXPECT_GT(lux, 0.25);
  EXPECT_LT(lux, 0.32);
}

TEST(SkyPlaces, ReadsStars) {
  const std::vector<Star> stars = brightStars();
  ASSERT_EQ(stars.size(), 93u);
  EXPECT_EQ(stars.front().name, "Sirius (alp CMa)");
  for (const Star& s : stars) {
    EXPECT_TRUE(s.magnitude >= -1.46 && s.magnitude <= 2.5) << s.name;
    EXPECT_TRUE(s.colour > -0.3 && s.colour < 1.9) << s.name;
    EXPECT_LT(std::hypot(s.eastMotion_radPerYear, s.northMotion_radPerYear), 3.8 * kSecond) << s.name;
    for (const Star& other : stars)
      if (&s != &other) {
        EXPECT_GT(eraSeps(s.rightAscension_rad, s.declination_rad, other.rightAscension_rad, other.declination_rad), 10.0 * kSecond) << s.name;
      }
  }
  std::string problem;
  for (const char* bad : {"a,1,2,3,4,5", "a,1,2,3,4,5,x,", "a,1,91,3,4,5,6,", ",1,2,3,4,5,6,", "a,1,2,3,4,5,6,7,8", "a,1,2,nan,4,5,6,", "a,1,2,,4,5,6,"}) {
    EXPECT_FALSE(readStars(std::string("# source\nname,...\n") + bad + "\n", problem)) << bad;
    EXPECT_NE(problem.find("line 3: expected a name"), std::string::npos) << problem;
  }
  EXPECT_TRUE(readStars("", problem)->empty());
}

TEST(SkyPlaces, StarsAsErfaHasThem) {
  const std::vector<Star> stars = brightStars();
  const GroundPlace where{48.1 * kDegree, 11.6 * kDegree, 520.0};
  for (const char* text : {"1975-02-03T04:05:06Z", "2026-06-21T22:00:00Z", "2060-12-31T23:00:00Z"}) {
    const Instant when = at(text);
    const std::vector<SkyPlace> places = starPlaces(stars, when, where, 0.1);
    ASSERT_EQ(places.size(), stars.size());
    for (std::size_t i = 0; i < stars.size(); ++i) {
      const Star& s = stars[i];
      double azimuth, zenith, hour, dec, ra, origin;
      eraAtco13(s.rightAscension_rad, s.declination_rad, s.eastMotion_radPerYear / std::cos(s.declination_rad), s.northMotion_radPerYear, 0.0, 0.0, when.day,
                when.fraction, 0.1, where.longitude_rad, where.latitude_rad, where.height_m, 0.0, 0.0, 0.0, 0.0, 0.0, 0.55, &azimuth, &zenith, &hour, &dec, &ra,
                &origin);
      EXPECT_LT(eraSeps(azimuth, kPi / 2.0 - zenith, places[i].azimuth_rad, places[i].elevation_rad), 1e-9) << s.name;
    }
  }
  // Polaris keeps within 0.63 degrees of the pole in 2026.
  for (int hour = 0; hour < 24; ++hour)
    for (std::size_t i = 0; i < stars.size(); ++i)
      if (stars[i].name.starts_with("Polaris")) {
        const SkyPlace p = starPlaces({&stars[i], 1}, at("2026-06-21T" + std::string(hour < 10 ? "0" : "") + std::to_string(hour) + ":00Z"), where)[0];
        EXPECT_NEAR(p.elevation_rad, where.latitude_rad, 0.63 * kDegree);
        EXPECT_LT(std::min(p.azimuth_rad, 2.0 * kPi - p.azimuth_rad), 1.0 * kDegree);
      }
}

TEST(SkyPlaces, StarlightByMagnitudes) {
  const auto magnitude = [](const Star& s, double um, double zero) { return -2.5 * std::log10(starIrradiance(s, um) / zero); };
  constexpr double kV = 3.631e-8, kJ = 3.147e-9, kK = 3.961e-10;
  // Ballesteros 2012: the sun's colour of 0.65 gives 5770 K or so.
  EXPECT_NEAR(starTemperature_K(0.65), 5770.0, 40.0);
  for (const Star& s : brightStars()) {
    EXPECT_NEAR(magnitude(s, 0.545, kV), s.magnitude, 1e-9) << s.name;
    if (s.infraredMagnitude) {
      EXPECT_NEAR(magnitude(s, 2.19, kK), *s.infraredMagnitude, 1e-9) << s.name;
      // What K has to make good is what stars without it lack.
      Star without = s;
      without.infraredMagnitude.reset();
      const double lacking = magnitude(without, 2.19, kK) - *s.infraredMagnitude;
      EXPECT_NEAR(lacking, s.colour > 1.2 ? 0.4 : 0.0, s.colour > 1.2 ? 0.15 : 0.25) << s.name;
    }
    double before = starIrradiance(s, 2.19);
    for (double um = 2.3; um < 15.0; um *= 1.05) {
      const double now = starIrradiance(s, um);
      EXPECT_TRUE(now > 0.0 && now < before) << s.name;
      before = now;
    }
  }
  // J of IRTF's bright standards.
  for (const auto& [name, printed] : {std::pair{"Mirach", -0.92}, {"Hamal", 0.08}, {"Mirfak", 0.85}, {"Aldebaran", -1.86}, {"Rigel", 0.20}, {"Capella", -1.34}})
    for (const Star& s : brightStars())
      if (s.name.starts_with(name)) {
        EXPECT_NEAR(magnitude(s, 1.22, kJ), printed, 0.15) << name;
      }
}

}  // namespace
}  // namespace pitviper
