// Origin, time, air, background, ground and sun.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/units.hpp"
#include "sim/plan/budget.hpp"
#include "sim/radiance/sky.hpp"
#include "sim/sky/sky_places.hpp"

namespace pitviper {
namespace {

/// Far below the end of a float, 3.4e38.
constexpr double kLargestFloatValue = 1e30;

/// The ends of what can be asked for: single precision and the tables' angles do 0.01 %.
constexpr double kLeastAccuracy = 0.0005, kMostAccuracy = 0.2;

/// Of limits: as far and as hot as a scenario's bodies can be.
constexpr double kFarthestRange_m = 1e9, kHottestBody_K = 1e5;

/// Two rising numbers above 0.
void readPair(const Record& r, const char* key, const char* unit, double most, const char* example, double& low, double& high) {
  if (!r.given(key)) return;
  const auto& ends = r.value(key).items;
  const std::string name = std::string(key) + " of limits", fix = "write '" + std::string(key) + ": " + example + "'";
  low = readNumber(ends[0], unit, name);
  high = readNumber(ends[1], unit, name);
  const std::string expected = "two rising values above 0, at most " + briefNumber(most) + " " + unit;
  for (const auto& [value, written] : {std::pair{low, ends[0]}, {high, ends[1]}})
    if (!(value > 0.0 && value <= most)) throw UserError(written.where, name + " has an end at " + written.text.substr(0, 40), expected, fix);
  if (!(low < high))
    throw UserError(r.where(key), name + " goes from " + ends[0].text.substr(0, 40) + " to " + ends[1].text.substr(0, 40), expected,
                    low > high ? "swap its ends" : fix);
}

}  // namespace

Builder::Builder(Simulation& simulation, std::filesystem::path base, Libraries libraries)
    : simulation_(simulation), base_(base), libraries_(libraries), spectra_([&] {
        SpectrumFiles files;
        files.base = std::move(base);
        files.library = {libraries.sensors};
        files.loadYaml = [](const std::filesystem::path& p, const Location& at) { return loadYaml(p, at); };
        return files;
      }()) {}

void Builder::checkUnique(const Value& name, std::map<std::string, Location>& names, const char* what) {
  const auto [at, fresh] = names.emplace(name.text, name.where);
  if (!fresh)
    throw UserError(name.where, std::string("a second ") + what + " is called '" + name.text.substr(0, 60) + "'",
                    "unique names (the first is at line " + std::to_string(at->second.line) + ")", "rename one");
  for (char c : name.text)
    if (!(std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'))
      throw UserError(name.where, std::string("the name of a ") + what + " holds the character '" + c + "'", "letters, digits, '_' and '-'", "rename it");
  if (name.text.size() > 64) throw UserError(name.where, std::string("the name of a ") + what + " is too long", "at most 64 characters", "shorten it");
}

Spectrum Builder::bounded(const SpectrumReader& spectra, const Value& value, std::string_view unit, std::string_view name, double low, double high,
                          Outside outside) {
  Spectrum s = spectra.read(value, unit, name, outside);
  const double from = std::max(s.validLow(), s.supportLow()), to = std::min(s.validHigh(), s.supportHigh());
  if (from > to) return s;  // no wavelength at which it says anything: whoever asks it for a band is told so
  const double least = s.minimum(from, to), most = s.maximum(from, to);
  // Products of allowed factors can still be beyond a float; such a maximum is infinite or, from 0 x infinity, none at all.
  if (!(least >= low && most <= std::min(high, kLargestFloatValue) && std::isfinite(least) && std::isfinite(most)))
    throw UserError(value.where, std::string(name) + " leaves its range: it goes from " + briefNumber(least) + " to " + briefNumber(most),
                    std::isfinite(high) ? "values from " + briefNumber(low) + " to " + briefNumber(high) : "values of at least 0, at most 1e30",
                    "correct its values");
  return s;
}

void Builder::readOrigin(const Record& scenario) {
  Geodetic origin;
  if (scenario.given("origin")) {
    const Record r(scenario.value("origin"), tables::origin());
    origin = {r.number("latitude"), r.number("longitude"), r.number("height")};
  }
  const double ground_m = scenario.given("ground") ? Record(scenario.value("ground"), tables::ground()).number("height") : 0.0;
  simulation_.frame = LocalFrame(origin, ground_m);
}

namespace {

/// Seconds since 1970, of UTC without leap seconds.
double readDate(const std::string& text, const Location& where) {
  int year = 0, month = 0, day = 0, hour = 0, minute = 0, end = 0;
  double second = 0.0;
  const int read = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d:%lf%n", &year, &month, &day, &hour, &minute, &second, &end);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  const std::string rest = text.substr(read == 6 ? static_cast<size_t>(end) : text.size());
  if (read != 6 || !(rest.empty() || rest == "Z") || year < 1 || !date.ok() || hour < 0 || hour > 23 || minute < 0 || minute > 59 ||
      !(second >= 0.0 && second < 60.0))
    throw UserError(where, "'" + text + "' is no date", "a date and time of UTC, such as 2026-06-21T12:00:00", "write it so");
  return static_cast<double>(std::chrono::sys_days(date).time_since_epoch().count()) * 86400.0 + hour * 3600.0 + minute * 60.0 + second;
}

}  // namespace

void Builder::readTime(const Record& scenario) {
  Value empty;
  empty.kind = Value::Kind::Map;
  empty.where = scenario.where();
  const Record r(scenario.given("time") ? scenario.value("time") : empty, tables::time());
  r.fill(simulation_.time);
  simulation_.time.step_s = 1.0 / r.number("rate");
  if (r.given("date")) simulation_.time.epoch_s = readDate(r.text("date"), r.where("date"));
}

void Builder::readLimits(const Record& scenario) {
  if (!scenario.given("limits")) return;
  const Record r(scenario.value("limits"), tables::limits());
  Limits& limits = simulation_.limits;
  readPair(r, "range", "m", kFarthestRange_m, "[100 m, 20 km]", limits.nearest_m, limits.farthest_m);
  readPair(r, "temperature", "K", kHottestBody_K, "[250 K, 900 K]", limits.coldest_K, limits.hottest_K);
  r.fill(limits);
  if (!limits.any())
    throw UserError(r.where(), "limits without any", "'range', 'temperature' or 'light'", "write 'limits: {range: [100 m, 20 km]}', or remove 'limits'");
}

namespace {

double readShare(const Value& v) {
  const auto q = v.kind == Value::Kind::Scalar ? splitQuantity(v.text) : std::nullopt;
  const auto share = q && !q->unit.empty() ? convert(*q, "") : std::nullopt;
  if (!share || !(*share >= kLeastAccuracy && *share <= kMostAccuracy))
    throw UserError(v.where, "accuracy '" + v.text.substr(0, 40) + "' is neither a share nor 'none' nor 'reference'", "0.05 % to 20 %, 'none' or 'reference'",
                    "write 'accuracy: 1 %'");
  return *share;
}

}  // namespace

void Builder::readAccuracy(const Record& scenario) {
  if (!scenario.given("accuracy")) {
    accuracy_.accuracy = simulation_.air->traits().isBanded ? kUsualAccuracy : 0.0;
    return;
  }
  if (scenario.value("accuracy").kind == Value::Kind::Map) {
    const Record r(scenario.value("accuracy"), tables::accuracy());
    accuracy_.atMost = readShare(r.value("at_most"));
    accuracy_.accuracy = r.given("asked") ? readShare(r.value("asked")) : std::min(kUsualAccuracy, accuracy_.atMost);
    if (accuracy_.accuracy > accuracy_.atMost)
      throw UserError(r.where("at_most"), "the accuracy asked for is coarser than at most", "'at_most' of no less than 'asked'", "raise 'at_most'");
    return;
  }
  const Value& v = scenario.value("accuracy");
  if (v.text == "none") return;
  if (v.text == "reference") {
    accuracy_.reference = true;
    return;
  }
  accuracy_.accuracy = readShare(v);
}

/// A map with either temperature or radiance.
Spectrum Builder::blackOrGiven(const Record& r, const char* what) const {
  if (r.given("temperature") == r.given("radiance"))
    throw UserError(r.where(), std::string(what) + (r.given("radiance") ? " has a temperature and a radiance" : " has neither temperature nor radiance"),
                    "one of the two", r.given("radiance") ? "remove one" : "add 'temperature: 280 K'");
  if (r.given("temperature")) return Spectrum(Spectrum::BlackBody{r.number("temperature"), 1.0});
  return bounded(spectra_, r.value("radiance"), "W/(m2 sr um)", what, 0.0, INFINITY);
}

void Builder::readBackground(const Record& scenario) {
  if (!scenario.given("background")) return;
  simulation_.background = blackOrGiven(Record(scenario.value("background"), tables::background()), "background");
}

void Builder::readGround(const Record& scenario) {
  const bool given = scenario.given("ground");
  if (!given && !simulation_.air->traits().liesOnGround) return;
  Value none;
  none.kind = Value::Kind::Map;
  none.where = scenario.where();
  const Record r(given ? scenario.value("ground") : none, tables::ground());
  Surface ground;
  if (r.given("material")) {
    ground.material = materialNamed(r.value("material"));
    const Material& m = simulation_.materialOf(ground);
    if (m.isTransparent() || m.hasModifiers())
      throw UserError(r.where("material"), "the ground's material '" + m.name + "' is " + (m.isTransparent() ? "transparent" : "textured"),
                      "an opaque material without textures", "choose another, or lay a body over the ground");
  } else {
    ground.material = static_cast<int>(simulation_.materials.size());
    auto black = std::make_shared<Material>();
    black->name = "black ground";
    simulation_.materials.push_back(std::move(black));
  }
  ground.temperature_K = r.given("temperature") ? r.number("temperature") : simulation_.air->groundTemperature_K();
  if (!r.given("temperature") && !(ground.temperature_K > 0.0))
    throw UserError(r.where(), "a ground without a temperature, under air that has none", "a temperature", "add 'temperature: 288 K'");
  checkTemperatures(ground.material, ground.temperature_K, ground.temperature_K, r.given("temperature") ? r.where("temperature") : r.where());
  simulation_.ground = ground;
}

namespace {

glm::dvec3 directionTo(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::sin(azimuth_rad), std::cos(elevation_rad) * std::cos(azimuth_rad), std::sin(elevation_rad)};
}

/// Beyond its bands the moon's reflectance is held.
Spectrum shareOf(const MoonLook& moon) {
  constexpr double kFrom_um = 0.34, kTo_um = 2.4;
  constexpr int kSteps = 600;
  Spectrum::Table t{{}, {}, Outside::Hold, "moonlight over sunlight"};
  for (int i = 0; i <= kSteps; ++i) {
    t.wavelength_um.push_back(kFrom_um * std::pow(kTo_um / kFrom_um, i / double(kSteps)));
    t.value.push_back(moonlightShare(moon, t.wavelength_um.back()));
  }
  return Spectrum(std::move(t));
}

/// When and where the sky is looked at: frame 0, the origin. `what`: whose place that is, for messages.
std::pair<Instant, GroundPlace> skyOf(const Record& scenario, const Location& asks, const std::string& what) {
  const Value* time = scenario.find("time");
  const Value* date = time ? time->find("date") : nullptr;
  if (!date || !scenario.given("origin"))
    throw UserError(asks, what + ", and the scenario no " + (date ? "origin" : "date"),
                    "azimuth and elevation of sun or moon, or 'time: {date: 2026-06-21T12:00:00Z}' and 'origin'",
                    date ? "add 'origin: {latitude: 48 deg, longitude: 11 deg}'" : "add a date to 'time'");
  std::string problem;
  std::optional<Instant> when = parseInstant(date->text, problem);
  if (!when) throw UserError(date->where, "'" + date->text + "' is no date that the sky is known of", problem, "correct it, or give azimuth and elevation");
  const Record start(*time, tables::time()), origin(scenario.value("origin"), tables::origin());
  when->fraction += start.number("start") / 86400.0;
  if (!isCovered(*when))
    throw UserError(start.where("start"), "frame 0 lies where earth and moon are not known", "from 1900-01-01 to 2100-01-01", "correct 'start' or 'date'");
  return {*when, {origin.number("latitude"), origin.number("longitude"), origin.number("height")}};
}

/// Where sun or moon stand, and how much of the sun's light at 1 au they send.
/// `bending`: by how much air lifts what stands at a true elevation; none: it does not.
void placeByDate(const Record& scenario, const Record& own, bool isMoon, const std::function<double(double)>& bending, Sun& sun) {
  const auto directionOf = [&](const SkyPlace& p) { return directionTo(p.azimuth_rad, p.elevation_rad + (bending ? bending(p.elevation_rad) : 0.0)); };
  const auto [when, where] = skyOf(scenario, own.where(), std::string(isMoon ? "the moon" : "the sun") + " has no azimuth and elevation");
  if (!isMoon) {
    const SkyPlace place = sunPlace(when, where);
    sun.toSun = directionOf(place);
    const double near = 149597870700.0 / place.distance_m;
    sun.irradiance = sun.irradiance * Spectrum(near * near);
    return;
  }
  const MoonLook moon = moonLook(when, where);
  sun.toSun = directionOf(moon.place);
  sun.irradiance = sun.irradiance * shareOf(moon);
}

}  // namespace

void Builder::readStars(const Record& scenario) {
  // Lower than any horizon that a camera may see them over.
  constexpr double kLowest_rad = -0.2, kFrom_um = 0.3, kTo_um = 14.0;
  constexpr int kSteps = 160;
  if (!scenario.given("stars") || !scenario.boolean("stars")) return;
  const auto [when, where] = skyOf(scenario, scenario.where("stars"), "stars have no places");
  const auto file = libraries_.atmosphere / "bright_stars.csv";
  std::string problem;
  const auto stars = pitviper::readStars(readWholeFile(file), problem);
  if (!stars) throw UserError({file.string(), 1, 1, -1}, "a damaged table of stars", problem, "take the one of this program's library");
  const std::vector<SkyPlace> places = starPlaces(*stars, when, where);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double elevation_rad = places[i].elevation_rad + (bending_ ? bending_(places[i].elevation_rad) : 0.0);
    if (elevation_rad < kLowest_rad) continue;
    Spectrum::Table t{{}, {}, Outside::Hold, "star " + (*stars)[i].name};
    for (int k = 0; k <= kSteps; ++k) {
      t.wavelength_um.push_back(kFrom_um * std::pow(kTo_um / kFrom_um, k / double(kSteps)));
      t.value.push_back(starIrradiance((*stars)[i], t.wavelength_um.back()));
    }
    simulation_.stars.push_back({(*stars)[i].name, directionTo(places[i].azimuth_rad, elevation_rad), Spectrum(std::move(t))});
  }
}

void Builder::readSun(const Record& scenario) {
  if (!scenario.given("sun")) return;
  const Record r(scenario.value("sun"), tables::sun());
  if (r.given("irradiance") == r.given("temperature"))
    throw UserError(r.where(), r.given("irradiance") ? "the sun has an irradiance and a temperature" : "the sun has neither irradiance nor temperature",
                    "one of the two", r.given("irradiance") ? "remove one" : "add 'temperature: 5772 K'");
  Sun sun;
  sun.irradiance = r.given("temperature") ? Spectrum(Spectrum::BlackBody{r.number("temperature"), r.number("solid_angle")})
                                          : bounded(spectra_, r.value("irradiance"), "W/(m2 um)", "sun irradiance", 0.0, INFINITY);
  if (r.given("azimuth") != r.given("elevation"))
    throw UserError(r.where(), std::string("the sun has no ") + (r.given("azimuth") ? "elevation" : "azimuth"), "both, or neither and 'time: {date}'",
                    std::string("add '") + (r.given("azimuth") ? "elevation" : "azimuth") + "'");
  const bool isMoon = r.text("body") == "moon";
  if (r.given("azimuth")) {
    if (isMoon)
      throw UserError(r.where("body"), "a moon at an azimuth and elevation", "one by date: its phase is in its light", "remove 'azimuth' and 'elevation'");
    sun.toSun = directionTo(r.number("azimuth"), r.number("elevation"));
  } else {
    placeByDate(scenario, r, isMoon, bending_, sun);
  }
  simulation_.sun = std::move(sun);
}

}  // namespace pitviper
