#include "atmosphere/air_profile.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "sim/parameters/csv_table.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// Above this surface and weather have no say.
constexpr double kTropopause_m = 11e3;
/// Levels of a radiosonde that lines between their neighbours tell so well are left out.
constexpr double kSameTemperature_K = 0.2, kSameWater = 0.02, kSamePressure = 1e-3;
/// Longer than any honest file.
constexpr std::size_t kMostRows = 20000;
/// Sane values: what a row may hold.
constexpr double kLowest_m = -500.0, kHighest_m = 200e3, kColdest_K = 100.0, kWarmest_K = 400.0;
/// Of water over that of saturated air, and of what is warmer than this: ice decides in colder air.
constexpr double kMostSaturated = 1.1, kColdWater_K = 258.0;
/// Rows so far apart are held to the weight of the air between them, which moisture and a lapse that bends change by less.
constexpr double kThickRow_m = 300.0, kWeightRoom = 0.15, kEvenAir_m = 30e3;
/// Gas constant of dry air over gravity [m/K].
constexpr double kScale_m_K = 287.05 / 9.80665;

struct Quantity {
  const char* name;
  const char* unit;  ///< that values are kept in
};
constexpr Quantity kQuantities[] = {{"altitude", "m"}, {"pressure", "Pa"}, {"temperature", "K"}, {"water", "ppmv"},
                                    {"humidity", ""},  {"dew_point", "K"}, {"ozone", "ppmv"}};
enum Column { Altitude, Pressure, Temperature, Water, Humidity, DewPoint, Ozone, kColumns };

/// By name, in units of their own.
struct Columns {
  std::optional<std::size_t> at[kColumns];

  explicit Columns(const CsvTable& t) {
    for (std::size_t c = 0; c < t.columns.size(); ++c) {
      const auto known = std::find_if(std::begin(kQuantities), std::end(kQuantities), [&](const Quantity& q) { return q.name == t.columns[c].name; });
      if (known == std::end(kQuantities))
        throw UserError(t.columns[c].where, "a column '" + t.columns[c].name + "'", "altitude, pressure, temperature, water, humidity, dew_point, ozone",
                        "correct the name or leave the column out");
      auto& place = at[known - std::begin(kQuantities)];
      if (place) throw UserError(t.columns[c].where, "the column '" + t.columns[c].name + "' twice", "once", "leave one out");
      place = c;
    }
    const Location head{t.file, 1, 1, -1};
    for (Column needed : {Altitude, Pressure, Temperature})
      if (!at[needed])
        throw UserError(head, std::string("no column '") + kQuantities[needed].name + "'", "altitude [m], pressure [hPa], temperature [K] and water",
                        std::string("add '") + kQuantities[needed].name + "'");
    if (at[Water].has_value() + at[Humidity].has_value() + at[DewPoint].has_value() != 1)
      throw UserError(head, "water is told by none or several columns", "one of water [ppmv], humidity [%], dew_point [K]", "keep one of them");
  }
};

double valueOf(const CsvTable& t, std::size_t row, std::size_t column, Column what) {
  const CsvColumn& c = t.columns[column];
  const double v = t.at(row, column);
  if (what == Water || what == Ozone) {
    if (c.unit == "ppmv" || c.unit == "ppm") return 1e-6 * v;
    if (c.unit == "1") return v;
    throw UserError(c.where, "unit '" + c.unit + "' of " + c.name, "ppmv or 1 (of volume)", "convert the column");
  }
  // As soundings are written.
  const std::string unit = c.unit == "C" || c.unit == "deg C" ? "degC" : c.unit == "mb" || c.unit == "mbar" ? "hPa" : c.unit;
  const auto converted = convert({v, unit}, kQuantities[what].unit);
  if (!converted) throw UserError(c.where, "unit '" + c.unit + "' of " + c.name, "a unit of " + std::string(kQuantities[what].unit), "convert the column");
  return *converted;
}

double mixed(double a, double b, double f) { return a > 0.0 && b > 0.0 ? a * std::pow(b / a, f) : a + f * (b - a); }

AirLevel between(const AirLevel& a, const AirLevel& b, double altitude_m) {
  const double f = (altitude_m - a.altitude_m) / (b.altitude_m - a.altitude_m);
  return {altitude_m, mixed(a.pressure_Pa, b.pressure_Pa, f), a.temperature_K + f * (b.temperature_K - a.temperature_K), mixed(a.water, b.water, f),
          mixed(a.ozone, b.ozone, f)};
}

/// Without those that their neighbours tell.
std::vector<AirLevel> thinned(const std::vector<AirLevel>& all) {
  std::vector<AirLevel> kept{all.front()};
  std::size_t last = 0;
  for (std::size_t n = 2; n < all.size(); ++n) {
    bool isTold = true;
    for (std::size_t k = last + 1; k < n && isTold; ++k) {
      const AirLevel line = between(all[last], all[n], all[k].altitude_m);
      const auto same = [](double x, double y, double part) { return std::abs(x - y) <= part * y; };
      isTold = std::abs(line.temperature_K - all[k].temperature_K) <= kSameTemperature_K && same(line.water, all[k].water, kSameWater) &&
               same(line.ozone, all[k].ozone, kSameWater) && same(line.pressure_Pa, all[k].pressure_Pa, kSamePressure);
    }
    if (!isTold) last = n - 1, kept.push_back(all[last]);
  }
  if (all.size() > 1) kept.push_back(all.back());
  return kept;
}

}  // namespace

double AirProfile::saturation_Pa(double temperature_K) {
  const double t = temperature_K - 273.15;
  return 610.94 * std::exp(17.625 * t / (t + 243.04));
}

AirProfile AirProfile::read(const std::filesystem::path& file, const Location& askedAt, const AirProfile* above) {
  const CsvTable t = readCsvTable(file, {.what = "a profile of the air by height", .mostBytes = 16u << 20, .fix = "check the path"}, kMostRows, askedAt);
  const Columns columns(t);
  std::vector<AirLevel> all;
  for (std::size_t row = 0; row < t.rows(); ++row) {
    const auto value = [&](Column c) { return valueOf(t, row, *columns.at[c], c); };
    const auto refuse = [&](const std::string& wrong, const std::string& expected, const std::string& fix) {
      throw UserError(t.whereOf(row), wrong, expected, fix);
    };
    AirLevel l{value(Altitude), value(Pressure), value(Temperature), 0.0, 0.0};
    if (!(l.altitude_m >= kLowest_m && l.altitude_m <= kHighest_m)) refuse(print("an altitude of %g m", l.altitude_m), "-500 m to 200 km", "correct the row");
    if (!(l.temperature_K >= kColdest_K && l.temperature_K <= kWarmest_K))
      refuse(print("a temperature of %g K", l.temperature_K), "100 to 400 K", "correct the row or the column's unit; take a row without a value out");
    if (!(l.pressure_Pa > 0.0 && l.pressure_Pa <= 120e3))
      refuse(print("a pressure of %g hPa", 0.01 * l.pressure_Pa), "above 0, at most 1200 hPa", "correct the row; take a row without a value out");
    if (!all.empty() && !(l.altitude_m > all.back().altitude_m)) refuse("an altitude that is not above the one before", "rows that rise", "sort the rows");
    if (!all.empty() && !(l.pressure_Pa < all.back().pressure_Pa))
      refuse("a pressure that is not below the one before", "pressure that falls with height", "correct the row");
    if (columns.at[Water]) l.water = value(Water);
    if (columns.at[Humidity]) {
      const double humidity = value(Humidity);
      if (!(humidity >= 0.0 && humidity <= 1.0))
        refuse(print("a relative humidity of %g %%", 100.0 * humidity), "0 to 100 %",
               humidity > 1.0 && humidity <= 100.0 ? "correct it, or name the unit: humidity [%]" : "correct the row");
      l.water = humidity * saturation_Pa(l.temperature_K) / l.pressure_Pa;
    }
    if (columns.at[DewPoint]) {
      const double dew_K = value(DewPoint);
      if (!(dew_K > 0.0 && dew_K <= l.temperature_K + 0.01))
        refuse(print("a dew point of %g K in air of %g K", dew_K, l.temperature_K), "at most the air's own temperature", "correct the row");
      l.water = saturation_Pa(dew_K) / l.pressure_Pa;
    }
    if (!(l.water >= 0.0 && l.water <= 0.2)) refuse(print("water of %g ppmv", 1e6 * l.water), "0 to 200000 ppmv", "correct the row");
    if (columns.at[Ozone]) l.ozone = value(Ozone);
    else if (above) l.ozone = above->at(l.altitude_m).ozone;
    // What warm and cold air holds over water; a tenth more is found in clouds.
    if (columns.at[Water] && l.temperature_K > kColdWater_K && l.water * l.pressure_Pa > kMostSaturated * saturation_Pa(l.temperature_K))
      refuse(print("water of %g ppmv in air of %g K that holds %.4g", 1e6 * l.water, l.temperature_K, 1e6 * saturation_Pa(l.temperature_K) / l.pressure_Pa),
             "at most what saturates it", "correct the row or the column's unit");
    if (!all.empty() && l.altitude_m - all.back().altitude_m > kThickRow_m && l.altitude_m < kEvenAir_m) {
      const AirLevel& under = all.back();
      const double thick_m = kScale_m_K * 0.5 * (under.temperature_K + l.temperature_K) * std::log(under.pressure_Pa / l.pressure_Pa);
      if (std::abs(thick_m / (l.altitude_m - under.altitude_m) - 1.0) > kWeightRoom)
        refuse(print("%g hPa %g m above %g hPa", 0.01 * l.pressure_Pa, l.altitude_m - under.altitude_m, 0.01 * under.pressure_Pa),
               print("by the weight of that air %.0f m between them", thick_m), "check the units of altitude and pressure; take a damaged row out");
    }
    if (!(l.ozone >= 0.0 && l.ozone <= 1e-3)) refuse(print("ozone of %g ppmv", 1e6 * l.ozone), "0 to 1000 ppmv", "correct the row");
    all.push_back(l);
  }
  if (all.size() < 2) throw UserError({t.file, 1, 1, -1}, "fewer than two rows", "a row for each height", "add rows");
  AirProfile profile;
  profile.levels_ = thinned(all);
  profile.soundedTo_m_ = all.back().altitude_m;
  if (!above) return profile;
  // What lies above goes on from the pressure that is there.
  const AirLevel top = profile.levels_.back();
  const double share = top.pressure_Pa / above->at(top.altitude_m).pressure_Pa;
  for (AirLevel l : above->levels())
    if (l.altitude_m > top.altitude_m + 1e3) l.pressure_Pa *= share, profile.levels_.push_back(l);
  return profile;
}

AirLevel AirProfile::at(double altitude_m) const {
  const auto over = std::upper_bound(levels_.begin(), levels_.end(), altitude_m, [](double h, const AirLevel& l) { return h < l.altitude_m; });
  if (over == levels_.begin()) return levels_.front();
  if (over == levels_.end()) return levels_.back();
  return between(*(over - 1), *over, altitude_m);
}

void AirProfile::cutAt(double altitude_m) {
  if (!(altitude_m > levels_.front().altitude_m)) return;
  const AirLevel first = at(altitude_m);
  std::erase_if(levels_, [&](const AirLevel& l) { return l.altitude_m <= altitude_m; });
  levels_.insert(levels_.begin(), first);
}

double AirProfile::humidity() const {
  const AirLevel& l = levels_.front();
  return l.water * l.pressure_Pa / saturation_Pa(l.temperature_K);
}

void AirProfile::setGround(const AirAtGround& ground) {
  const AirLevel first = levels_.front();
  const double warmer_K = ground.temperature_K ? *ground.temperature_K - first.temperature_K : 0.0;
  const double heavier = ground.pressure_Pa ? *ground.pressure_Pa / first.pressure_Pa : 1.0;
  const double before = humidity(), wetter = ground.humidity ? *ground.humidity / std::max(before, 1e-6) : 1.0;
  double log = std::log(heavier), lastOld = 0.0, lastNew = 0.0;  // of new pressure over old
  for (std::size_t n = 0; n < levels_.size(); ++n) {
    AirLevel& l = levels_[n];
    const AirLevel old = l;
    const double share = std::clamp((kTropopause_m - l.altitude_m) / (kTropopause_m - first.altitude_m), 0.0, 1.0);
    l.temperature_K += share * warmer_K;
    const double oldInverse = 1.0 / old.temperature_K, newInverse = 1.0 / l.temperature_K;
    if (n > 0) log += 0.5 * (lastOld + oldInverse - lastNew - newInverse) * (l.altitude_m - levels_[n - 1].altitude_m) / kScale_m_K;
    lastOld = oldInverse, lastNew = newInverse;
    l.pressure_Pa *= std::exp(log);
    if (share == 0.0 || (warmer_K == 0.0 && heavier == 1.0 && wetter == 1.0)) continue;
    const double humidity = std::min(old.water * old.pressure_Pa / saturation_Pa(old.temperature_K) * wetter, 1.0);
    l.water = humidity * saturation_Pa(l.temperature_K) / l.pressure_Pa;
  }
}

}  // namespace pitviper
