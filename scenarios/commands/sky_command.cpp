// pitviper sky: where sun, moon and bright stars stand at a date and place, and what they send.
#include <algorithm>
#include <cstdio>
#include <optional>

#include "scenarios/commands/commands.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/flight/standard_atmosphere.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/sky/refraction.hpp"
#include "sim/sky/sky_places.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0;

struct SkyWish {
  std::string date;
  std::optional<double> latitude_deg, longitude_deg;
  std::optional<double> height_m;
};

/// Where the standard atmosphere shows it.
double apparent_rad(const SkyPlace& p, double height_m) {
  const StandardAir air = standardAir(height_m);
  return p.elevation_rad + refraction_rad(p.elevation_rad, air.pressure_Pa, air.temperature_K);
}

std::string placeOf(const SkyPlace& p, double height_m) {
  return print("azimuth %.3f deg, elevation %.3f deg, with refraction %.3f deg", p.azimuth_rad / kDegree, p.elevation_rad / kDegree,
               apparent_rad(p, height_m) / kDegree);
}

int showSky(const SkyWish& wish) {
  std::string problem;
  const auto when = parseInstant(wish.date, problem);
  if (!when) throw UserError({"--date", 0, 0, -1}, "'" + wish.date + "' is no date", problem, "write it as 2026-06-21T12:00:00Z");
  if (!wish.latitude_deg || !wish.longitude_deg)
    throw UserError({"sky", 0, 0, -1}, "no place on the earth", "--latitude and --longitude in degrees", "add '--latitude 48.1 --longitude 11.6'");
  const GroundPlace where{*wish.latitude_deg * kDegree, *wish.longitude_deg * kDegree, wish.height_m.value_or(0.0)};
  const SkyPlace sun = sunPlace(*when, where);
  const MoonLook moon = moonLook(*when, where);
  const double near = 149597870700.0 / sun.distance_m;
  std::printf("%s at %.4f, %.4f deg, %g m: %s. Refraction is that of the standard atmosphere, azimuth clockwise from north.\n\n", wish.date.c_str(),
              *wish.latitude_deg, *wish.longitude_deg, where.height_m, std::string(nameOf(twilightAt(sun.elevation_rad))).c_str());
  std::printf("sun   %s; %.5f au, radius %.3f deg, %.2f %% of its irradiance at 1 au\n", placeOf(sun, where.height_m).c_str(), 1.0 / near,
              sun.angularRadius_rad / kDegree, 100.0 * near * near);
  std::printf(
      "moon  %s; %.0f km, radius %.3f deg, phase angle %.2f deg, %.1f %% lit; of the sun's irradiance at 1 au %.3g at 0.55 um, %.3g at 1.06 um, %.3g at 2.2 "
      "um\n\n",
      placeOf(moon.place, where.height_m).c_str(), 1e-3 * moon.place.distance_m, moon.place.angularRadius_rad / kDegree, moon.phaseAngle_rad / kDegree,
      100.0 * moon.litFraction, moonlightShare(moon, 0.55), moonlightShare(moon, 1.06), moonlightShare(moon, 2.2));
  const auto file = findLibraries().atmosphere / "bright_stars.csv";
  const auto stars = readStars(readWholeFile(file), problem);
  if (!stars) throw UserError({file.string(), 1, 1, -1}, "a damaged table of stars", problem, "take the one of this program's library");
  const std::vector<SkyPlace> places = starPlaces(*stars, *when, where);
  std::printf(
      "| star above the horizon | azimuth [deg] | elevation [deg] | with refraction [deg] | V | 0.55 um [W/(m2 um)] | 1.25 um | 2.2 um "
      "|\n|---|---|---|---|---|---|---|---|\n");
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < stars->size(); ++i)
    if (places[i].elevation_rad > 0.0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return (*stars)[a].magnitude < (*stars)[b].magnitude; });
  for (std::size_t i : order) {
    const Star& s = (*stars)[i];
    std::printf("| %s | %.2f | %.2f | %.2f | %.2f | %.3g | %.3g | %.3g |\n", s.name.c_str(), places[i].azimuth_rad / kDegree, places[i].elevation_rad / kDegree,
                apparent_rad(places[i], where.height_m) / kDegree, s.magnitude, starIrradiance(s, 0.55), starIrradiance(s, 1.25), starIrradiance(s, 2.2));
  }
  return 0;
}

}  // namespace

CommandLine skyCommand() {
  const auto w = std::make_shared<SkyWish>();
  return {{"sky", "", "where sun, moon and bright stars stand at a date and place, and what they send"},
          "Sun within 0.02 and moon within 20 arc seconds, from 1900 to 2100 (ERFA); the moon's light by its phase (ROLO); stars brighter than V = 2.5. A "
          "scenario takes the "
          "sun or the moon by 'time: {date}', 'origin' and a 'sun' without azimuth and elevation.",
          {{"--date", "DATE", "of UTC, or with an offset: 2026-06-21T12:00:00Z, 2026-06-21T14:00+02:00", into(w->date)},
           {"--latitude", "DEG", "north positive", number(w->latitude_deg, {-90.0, 90.0, "deg", true})},
           {"--longitude", "DEG", "east positive", number(w->longitude_deg, {-180.0, 360.0, "deg", true})},
           {"--height", "M", "above the ellipsoid; 0 unless given", number(w->height_m, {-1000.0, 1e5, "m", true})}},
          [w](const Arguments&) { return showSky(*w); }};
}

}  // namespace pitviper
