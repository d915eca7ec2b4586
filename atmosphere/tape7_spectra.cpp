#include "atmosphere/tape7_spectra.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

const char* sayKind(Tape7Kind kind) {
  constexpr const char* names[] = {"transmittance", "thermal radiance", "radiance with the sun", "solar irradiance"};
  return names[static_cast<int>(kind)];
}

const Tape7Column& columnOf(const Tape7Run& run, const char* name, const char* what, const char* iemsct) {
  const Tape7Column* column = run.find(name);
  if (!column)
    throw UserError({run.file, run.line, 11, -1}, "run " + std::to_string(run.number) + " (" + sayKind(run.kind) + ") holds no " + name + ", so no " + what,
                    std::string("a run with IEMSCT ") + iemsct, std::string("run MODTRAN with IEMSCT = ") + iemsct + ", or name a run that has it");
  if (column->gapLine > 0)
    throw UserError({run.file, column->gapLine, column->firstColumn, -1}, std::string(name) + " is blank here and not in other rows", "a number in every row",
                    "copy the whole file again, or run MODTRAN again");
  return *column;
}

Spectrum table(const Tape7Run& run, std::vector<double> value, const std::string& columns) {
  Spectrum s(Spectrum::Table{run.wavelength_um, std::move(value), Outside::Error, run.file + " run " + std::to_string(run.number)});
  s.setProvenance(run.file + " run " + std::to_string(run.number) + ": " + columns);
  return s;
}

Spectrum sun(const Tape7Run& run, const char* ofIrradiance, const char* ofRadiance, const char* what) {
  const char* name = run.kind == Tape7Kind::SolarIrradiance ? ofIrradiance : ofRadiance;
  return table(run, columnOf(run, name, what, "2 or 3").value, name);
}

/// Rounding of five digits in each of five columns is 7e-5 at most in the files known.
constexpr double kSumsAgree = 5e-4;

/// BBODY_T is what a black body of TOTAL_RAD has: radiances in other units (per um a factor of nu^2 / 1e4, per m2 1e4) are far from it. Three decimals
/// of it are 1e-4 at the shortest wavelengths; a factor of 5 leaves room for what was edited by hand, and finds all but 45 to 224 1/cm per um.
constexpr double kSameUnit = 5.0;

void checkUnit(const Tape7Run& run, const Tape7Column& total) {
  const Tape7Column* temperature = run.find("BBODY_T[K]");
  if (!temperature) return;
  for (size_t i = 0; i < total.value.size(); ++i) {
    const double kelvin = temperature->value[i], written = total.value[i];
    if (!(kelvin > 1.0) || !(written > 0.0)) continue;  // dark, or blank here
    const double ratio = written / physics::planckRadiance(run.wavelength_um[i], kelvin);
    if (ratio < kSameUnit && ratio > 1.0 / kSameUnit) continue;
    throw UserError(run.placeOf(total, i),
                    "TOTAL_RAD is " + briefNumber(ratio) + " times what a black body of BBODY_T, " + briefNumber(kelvin) + " K, sends: its unit is another",
                    "W/(cm2 sr cm-1), as MODTRAN writes it", "give the file as MODTRAN wrote it, its radiances not converted");
  }
}

}  // namespace

Spectrum totalTransmittance(const Tape7Run& run) {
  const char* name = run.kind == Tape7Kind::Transmittance ? "COMBIN_TRANS" : run.kind == Tape7Kind::SolarIrradiance ? "TRANS" : "TOT_TRANS";
  std::vector<double> value = columnOf(run, name, "transmittance", "0, 1, 2 or 3").value;
  for (double& v : value) v = std::min(v, 1.0);
  return table(run, std::move(value), name);
}

Spectrum pathRadiance(const Tape7Run& run) {
  const char* const what = "path radiance";
  const bool sunny = run.kind == Tape7Kind::SolarRadiance, apart = run.find("THRML_EM") != nullptr;
  if (!apart) columnOf(run, "PTH_THRML", what, "1 or 2");
  const Tape7Column& total = columnOf(run, "TOTAL_RAD", what, "1 or 2");
  std::vector<double> value(run.wavelength_um.size(), 0.0), surface(run.wavelength_um.size(), 0.0);
  const auto add = [&](const char* name, std::vector<double>& to) {
    const auto& more = columnOf(run, name, what, "1 or 2").value;
    std::transform(to.begin(), to.end(), more.begin(), to.begin(), std::plus<>());
  };
  checkUnit(run, total);
  std::string parts;
  const auto addAir = [&](const char* name) {
    add(name, value);
    parts += (parts.empty() ? "" : " + ") + std::string(name);
  };
  if (apart) {
    // MODTRAN 6: what is emitted, and what is scattered once and often, apart from each other; what it did not compute is blank.
    for (const char* name : {"THRML_EM", "THRML_SCT", "MULT_SCAT", "SING_SCAT"})
      if (run.find(name)) addAir(name);
  } else {
    addAir("PTH_THRML");
    if (sunny) addAir("SOL_SCAT");
  }
  for (const char* name : {"SURF_EMIS", "GRND_RFLT"})
    if (run.find(name)) add(name, surface);
  for (size_t i = 0; i < value.size(); ++i) {
    const Location where = run.placeOf(total, i);
    if (std::abs(value[i] + surface[i] - total.value[i]) > kSumsAgree * std::abs(total.value[i]))
      throw UserError(where, "TOTAL_RAD is not the sum of its parts (" + briefNumber((value[i] + surface[i]) / total.value[i]) + " times it)",
                      parts + " + SURF_EMIS + GRND_RFLT", "give the file as MODTRAN wrote it");
    if (value[i] < 0.0)
      throw UserError(where, "the path radiance is below zero", "zero or more", "run MODTRAN again with more streams or without multiple scattering");
  }
  return table(run, std::move(value), parts);
}

Spectrum sunAtObserver(const Tape7Run& run) { return sun(run, "SOL_TR", "SOL@OBS", "sunlight at the observer"); }
Spectrum sunAboveAir(const Tape7Run& run) { return sun(run, "SOLAR", "TOA_SUN", "sunlight above the air"); }

void requireBand(const Tape7Run& run, double low_um, double high_um, const std::string& sensor) {
  const double from = run.wavelength_um.front(), to = run.wavelength_um.back();
  constexpr double kRounding = 1e-9;
  if (low_um >= from * (1.0 - kRounding) && high_um <= to * (1.0 + kRounding)) return;
  throw UserError({run.file, run.bandLine, 1, -1},
                  "run " + std::to_string(run.number) + " covers " + briefNumber(from) + " to " + briefNumber(to) + " um, not the " + briefNumber(low_um) +
                      " to " + briefNumber(high_um) + " um of " + sensor,
                  "a run over all of it",
                  "run MODTRAN from V1 = " + std::to_string(static_cast<int>(std::floor(1e4 / high_um))) +
                      " to V2 = " + std::to_string(static_cast<int>(std::ceil(1e4 / low_um))) + " cm-1");
}

}  // namespace pitviper
