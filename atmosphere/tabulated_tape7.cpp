#include "atmosphere/tabulated_tape7.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "atmosphere/depth_fit.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr std::array<double, 3> kFittedPowers = {0.55, 0.75, 1.0};

/// The powers of single components, as in the library's .air files.
constexpr std::array<double, 4> kComponentPowers = {0.552, 0.605, 0.767, 1.0};
struct Component {
  const char* column;
  size_t power;
};
constexpr Component kComponents[] = {{"H2O_TRANS", 0}, {"UMIX_TRANS", 1}, {"TRACE_TRANS", 1},   {"O3_TRANS", 2},  {"N2_CONT", 3},
                                     {"H2O_CONT", 3},  {"MOLEC_SCAT", 3}, {"AER+CLD_TRANS", 3}, {"HNO3_TRANS", 3}};

std::string sayRun(const Tape7Run& run) { return "run " + std::to_string(run.number); }

[[noreturn]] void refuse(const Tape7Run& run, const std::string& wrong, const std::string& expected, const std::string& fix) {
  throw UserError({run.file, run.line, 1, -1}, wrong, expected, fix);
}

bool radiates(const Tape7Run& run) { return run.kind == Tape7Kind::ThermalRadiance || run.kind == Tape7Kind::SolarRadiance; }
bool hasRange(const Tape7Run& run) { return run.geometry.path != Tape7Path::ToSpace && run.kind != Tape7Kind::SolarIrradiance; }
bool isLevel(const Tape7Run& run) { return run.geometry.path == Tape7Path::Horizontal; }

using Runs = std::vector<const Tape7Run*>;

std::string sayHeight(const Tape7Run& run) { return run.geometry.h1_km ? briefNumber(*run.geometry.h1_km) + " km" : "not known"; }
std::string sayDirection(const Tape7Run& run) {
  if (isLevel(run)) return "level";
  return run.geometry.zenith_deg ? briefNumber(90.0 - *run.geometry.zenith_deg) + " deg" : "not known";
}

/// What the runs have, each once.
std::string sayAll(const Runs& runs, std::string (*say)(const Tape7Run&)) {
  std::vector<std::string> words;
  for (const Tape7Run* run : runs)
    if (const std::string word = say(*run); std::find(words.begin(), words.end(), word) == words.end()) words.push_back(word);
  std::string all;
  for (const std::string& word : words) all += (all.empty() ? "" : ", ") + word;
  return all;
}

void requireSameGrid(const Tape7Run& run, const Tape7Run& first) {
  const auto &a = run.wavelength_um, &b = first.wavelength_um;
  if (a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](double x, double y) { return std::abs(x - y) < 1e-9 * y; })) return;
  throw UserError({run.file, run.bandLine, 1, -1}, sayRun(run) + " has other wavenumbers than " + sayRun(first), "the same V1, V2 and DV in all runs",
                  "run MODTRAN again with one band for all ranges");
}

/// Card 3 has angles to 0.00001 degrees and heights to 0.01 m; who asks for them writes fewer digits.
constexpr double kSameAngle_deg = 0.01, kSameHeight_km = 1e-3;

bool hasHeight(const Tape7Run& run, double km) { return run.geometry.h1_km && std::abs(*run.geometry.h1_km - km) < kSameHeight_km; }
bool hasElevation(const Tape7Run& run, double deg) {
  if (isLevel(run)) return std::abs(deg) < kSameAngle_deg;
  return run.geometry.zenith_deg && std::abs(90.0 - *run.geometry.zenith_deg - deg) < kSameAngle_deg;
}

/// Keeps those that the choice means.
void keepChosen(Runs& runs, const PathChoice& choice) {
  const auto keep = [&](const std::string& asked, std::string (*say)(const Tape7Run&), const auto& isMeant) {
    Runs kept;
    std::copy_if(runs.begin(), runs.end(), std::back_inserter(kept), [&](const Tape7Run* run) { return isMeant(*run); });
    if (kept.empty()) refuse(*runs.front(), "no run has " + asked, "one of those in the file: " + sayAll(runs, say), "ask for one that is there");
    runs = std::move(kept);
  };
  if (choice.height_m)
    keep("a height of " + briefNumber(1e-3 * *choice.height_m) + " km", sayHeight,
         [&](const Tape7Run& run) { return hasHeight(run, 1e-3 * *choice.height_m); });
  if (choice.elevation_rad) {
    const double deg = *choice.elevation_rad * 180.0 / kPi;
    keep("an elevation of " + briefNumber(deg) + " deg", sayDirection, [&](const Tape7Run& run) { return hasElevation(run, deg); });
  } else if (std::any_of(runs.begin(), runs.end(), [](const Tape7Run* run) { return isLevel(*run); })) {
    std::erase_if(runs, [](const Tape7Run* run) { return !isLevel(*run); });
  }
}

void requireSameAir(const Tape7Run& run, const Tape7Run& first, const Runs& all) {
  const auto same = [](std::optional<double> a, std::optional<double> b) { return std::abs(a.value_or(0.0) - b.value_or(0.0)) < 1e-6; };
  const Tape7Geometry &a = run.geometry, &b = first.geometry;
  const bool height = same(a.h1_km, b.h1_km), direction = isLevel(run) || same(a.zenith_deg, b.zenith_deg);
  if (height && direction && run.model == first.model && run.haze == first.haze && same(run.visibility_km, first.visibility_km)) return;
  std::string fix = "keep runs in one file that differ in range (and IEMSCT) alone";
  if (!height) fix = "choose a height: " + sayAll(all, sayHeight);
  else if (!direction) fix = "choose an elevation: " + sayAll(all, sayDirection);
  refuse(run, sayRun(run) + " is along another path or in other air than " + sayRun(first), "one height, direction, model, haze and visibility", fix);
}

double rangeOf(const Tape7Run& run, std::optional<double> given_m) {
  const auto own = run.geometry.range_km;
  if (own && *own > 0.0) {
    if (given_m && std::abs(1e-3 * *given_m / *own - 1.0) > 1e-3)
      refuse(run, "the range given, " + briefNumber(1e-3 * *given_m) + " km, is not the " + briefNumber(*own) + " km of " + sayRun(run), "one of the two",
             "leave the range out: the file has it");
    return *own;
  }
  if (given_m && *given_m > 0.0) return 1e-3 * *given_m;
  refuse(run, "the range of " + sayRun(run) + " is not in the file", "the length of the path", "give the range with the file");
}

/// What a column's last digit is worth: in a tape7 4 decimals of transmittance runs, 8 of the others.
double resolutionOf(const Tape7Run& run) { return run.resolution > 0.0 ? run.resolution : run.kind == Tape7Kind::Transmittance ? 1e-4 : 1e-8; }

RangeDepth rowOf(const Tape7Run& run, double range_km, const Spectrum& transmittance, size_t i) {
  RangeDepth row{range_km, transmittance(run.wavelength_um[i]), 0.0};
  row.depth = row.transmittance > 0.0 ? -std::log(row.transmittance) : INFINITY;
  const Tape7Column* log = run.find(run.kind == Tape7Kind::Transmittance ? "-LOG_COMBIN" : "DEPTH");
  // Three decimals of a depth beat four of a transmittance below e^-2.3; both end at a depth of 99.99.
  if (log && log->gapLine == 0 && row.transmittance < (resolutionOf(run) > 1e-5 ? 0.1 : 1e-6)) row.depth = log->value[i];
  if (!std::isfinite(row.depth)) row.depth = -std::log(0.5 * resolutionOf(run));
  return row;
}

/// Depths of the components, scaled so that the total is the run's own.
std::vector<double> componentDepths(const Tape7Run& run, double range_km, const RangeDepth& total, size_t i) {
  std::vector<double> c(kComponentPowers.size(), 0.0);
  double sum = 0.0;
  for (const Component& component : kComponents) {
    const Tape7Column* column = run.find(component.column);
    if (!column || std::isnan(column->value[i])) continue;
    const double depth = -std::log(std::clamp(column->value[i], 0.5 * resolutionOf(run), 1.0));
    c[component.power] += depth;
    sum += depth;
  }
  if (sum > 0.0)
    for (double& depth : c) depth *= total.depth / sum;
  else c.back() = total.depth;
  for (size_t k = 0; k < c.size(); ++k) c[k] /= std::pow(range_km, kComponentPowers[k]);
  return c;
}

/// One path: its range, what gives its transmittance and its radiance.
struct Leg {
  const Tape7Run* transmittance = nullptr;
  const Tape7Run* radiance = nullptr;
};

using Legs = std::map<double, Leg>;

/// `left`: how many runs along a range were left out.
Legs legsOf(std::span<const Tape7Run> runs, const PathChoice& choice, size_t& left) {
  Runs along;
  for (const Tape7Run& run : runs)
    if (hasRange(run)) along.push_back(&run);
  if (along.empty()) {
    const Tape7Run& run = runs.front();
    const bool sun = run.kind == Tape7Kind::SolarIrradiance;
    refuse(run, sayRun(run) + (sun ? " holds direct sunlight alone" : " is a path to space") + ", so no air along a range is known from it",
           "a horizontal or slant path (ITYPE 1 or 2) with IEMSCT 0, 1 or 2", "run MODTRAN with ITYPE = 1, IEMSCT = 1 and a RANGE");
  }
  const size_t all = along.size();
  keepChosen(along, choice);
  left = all - along.size();
  if (choice.range_m && along.size() > 1)
    refuse(*along[1], "a range is given for a file of " + std::to_string(along.size()) + " paths", "ranges in the file", "leave the range out");
  Legs legs;
  for (const Tape7Run* run : along) {
    requireSameGrid(*run, *along.front());
    requireSameAir(*run, *along.front(), along);
    const double range = rangeOf(*run, choice.range_m);
    Leg& leg = legs[range];
    const Tape7Run*& place = radiates(*run) ? leg.radiance : leg.transmittance;
    if (place)
      refuse(*run, "the range " + briefNumber(range) + " km comes twice, in runs " + std::to_string(place->number) + " and " + std::to_string(run->number),
             "each range once", "remove one of the runs");
    place = run;
  }
  return legs;
}

std::string describeLegs(const Legs& legs, size_t left) {
  const Tape7Run& run = legs.begin()->second.transmittance ? *legs.begin()->second.transmittance : *legs.begin()->second.radiance;
  std::string text = isLevel(run) ? "level air" : "air along a slant path, as if it were the same all along it";
  if (run.geometry.h1_km) text += ", " + briefNumber(*run.geometry.h1_km) + " km high";
  if (run.geometry.path == Tape7Path::Slant && run.geometry.zenith_deg) text += ", zenith angle " + briefNumber(*run.geometry.zenith_deg) + " deg";
  text += legs.size() == 1 ? ", from one range" : ", from " + std::to_string(legs.size()) + " ranges";
  for (auto leg = legs.begin(); leg != legs.end(); ++leg) text += (leg == legs.begin() ? " (" : ", ") + briefNumber(leg->first);
  text += " km)";
  if (left > 0) text += "; " + std::to_string(left) + (left == 1 ? " run" : " runs") + " of other heights or directions left out";
  return text;
}

/// From those that look up to space.
std::optional<TabulatedSky> skyOf(const Runs& runs) {
  std::vector<const Tape7Run*> seen;
  std::vector<TabulatedSky::View> views;
  for (const Tape7Run* looking : runs) {
    const Tape7Run& run = *looking;
    if (run.geometry.path != Tape7Path::ToSpace || !radiates(run)) continue;
    const auto& g = run.geometry;
    if (!g.zenith_deg)
      refuse(run, "the zenith angle of " + sayRun(run) + " is not in the file", "the angle at which it looks up",
             "run MODTRAN with ANGLE on card 3 (JSON: OBSZEN)");
    if (*g.zenith_deg > 90.0)
      refuse(run, sayRun(run) + " looks down, at a zenith angle of " + briefNumber(*g.zenith_deg) + " deg: it is no sky", "0 to 90 deg", "remove the run");
    const double elevation = (90.0 - *g.zenith_deg) * kPi / 180.0;
    for (size_t i = 0; i < views.size(); ++i)
      if (std::abs(views[i].elevation_rad - elevation) < 1e-9)
        refuse(run,
               "the zenith angle " + briefNumber(*g.zenith_deg) + " deg comes twice, in runs " + std::to_string(seen[i]->number) + " and " +
                   std::to_string(run.number),
               "each angle once", "remove one of the runs");
    if (!seen.empty()) {
      requireSameGrid(run, *seen.front());
      if (std::abs(g.h1_km.value_or(0.0) - seen.front()->geometry.h1_km.value_or(0.0)) > 1e-6)
        refuse(run, sayRun(run) + " looks up from another height than " + sayRun(*seen.front()), "one height", "keep one height in a file");
    }
    TabulatedSky::View view{elevation, {}};
    const Spectrum radiance = pathRadiance(run);
    for (double w : run.wavelength_um) view.radiance.push_back(radiance(w));
    views.push_back(std::move(view));
    seen.push_back(&run);
  }
  if (views.empty()) return std::nullopt;
  if (seen.front()->wavelength_um.size() < 2) refuse(*seen.front(), sayRun(*seen.front()) + " has one wavenumber", "two or more", "run MODTRAN over a band");
  return TabulatedSky(seen.front()->wavelength_um, std::move(views));
}

}  // namespace

std::optional<TabulatedSky> tabulatedSky(std::span<const Tape7Run> runs) {
  Runs all;
  for (const Tape7Run& run : runs) all.push_back(&run);
  return skyOf(all);
}

TabulatedAir tabulatedAir(std::span<const Tape7Run> runs, const PathChoice& choice) {
  size_t left = 0;
  const Legs legs = legsOf(runs, choice, left);
  const auto source = [](const Leg& leg) { return leg.radiance ? leg.radiance : leg.transmittance; };
  const Leg& first = legs.begin()->second;
  const Tape7Run& run = *source(first);
  if (run.wavelength_um.size() < 2) refuse(run, sayRun(run) + " has one wavenumber", "two or more", "run MODTRAN over a band");

  TabulatedAir::Data data;
  data.file = run.file;
  data.line = run.bandLine;
  data.wavelength_um = run.wavelength_um;
  data.shortest_m = 1e3 * legs.begin()->first;
  data.longest_m = 1e3 * legs.rbegin()->first;
  Runs below;
  for (const Tape7Run& each : runs)
    if (!choice.height_m || hasHeight(each, 1e-3 * *choice.height_m)) below.push_back(&each);
  data.sky = skyOf(below);
  const bool components = legs.size() == 1 && first.transmittance && first.transmittance->find("H2O_TRANS");
  if (components) data.exponents.assign(kComponentPowers.begin(), kComponentPowers.end());
  else if (legs.size() == 1) data.exponents = {1.0};
  else data.exponents.assign(kFittedPowers.begin(), kFittedPowers.end());
  data.description = describeLegs(legs, left) + (components         ? "; each gas by the power of its own bands of 20 1/cm, all else exponential"
                                                 : legs.size() == 1 ? "; exponential in range, which it is not in bands of lines: other ranges are worse"
                                                                    : "; powers of range fitted");

  std::vector<std::pair<const Tape7Run*, Spectrum>> totals;
  std::vector<double> ranges;
  double resolution = 0.0;
  for (const auto& [range, leg] : legs) {
    const Tape7Run* total = components ? leg.transmittance : source(leg);
    totals.push_back({total, totalTransmittance(*total)});
    ranges.push_back(range);
    resolution = std::max(resolution, resolutionOf(*total));
  }
  double squares = 0.0;
  for (size_t i = 0; i < data.wavelength_um.size(); ++i) {
    std::vector<RangeDepth> rows;
    for (size_t r = 0; r < ranges.size(); ++r) rows.push_back(rowOf(*totals[r].first, ranges[r], totals[r].second, i));
    DepthFit fit;
    if (components) {
      fit.coefficients = componentDepths(*totals[0].first, ranges[0], rows[0], i);
      fit.largest = std::abs(std::exp(-rows[0].depth) - rows[0].transmittance);
      fit.sumOfSquares = fit.largest * fit.largest;
    } else {
      fit = fitDepth(rows, data.exponents, resolution);
    }
    data.fit.largest = std::max(data.fit.largest, fit.largest);
    squares += fit.sumOfSquares;
    data.depth.push_back(std::move(fit.coefficients));
  }
  data.fit.rms = std::sqrt(squares / static_cast<double>(data.wavelength_um.size() * ranges.size()));
  std::vector<RangeRadiance> seen;
  for (const auto& [range, leg] : legs) {
    if (!leg.radiance) continue;
    const Spectrum radiance = pathRadiance(*leg.radiance);
    seen.push_back({range, {}});
    for (double w : data.wavelength_um) seen.back().radiance.push_back(radiance(w));
  }
  data.sourceRadiance = fitSource(data.depth, data.exponents, seen, data.fit.radiance);
  return TabulatedAir(std::move(data));
}

}  // namespace pitviper
