#include "scenarios/session/array_checks.hpp"

#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

[[noreturn]] void refuseEntry(const ArrayArgument& of, std::size_t i, double value, const char* expected, const char* fix) {
  throw UserError(of.where(), print("%s[%zu] is %g", of.name, i, value), expected, fix);
}

}  // namespace

void requireFinite(const ArrayArgument& of, std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i])) refuseEntry(of, i, values[i], "a number", "leave such entries out, or put a number in their place");
}

void requireNotNegative(const ArrayArgument& of, std::span<const double> values) {
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(std::isfinite(values[i]) && values[i] >= 0.0)) refuseEntry(of, i, values[i], "0 or more", "leave such entries out, or put a number in their place");
}

void requireWavelengths(const ArrayArgument& of, std::span<const double> wavelength_um) {
  for (std::size_t i = 0; i < wavelength_um.size(); ++i)
    if (!(wavelength_um[i] >= kShortestWavelength_um && wavelength_um[i] <= kLongestWavelength_um))
      refuseEntry(of, i, wavelength_um[i], print("%g to %g um", kShortestWavelength_um, kLongestWavelength_um).c_str(),
                  "wavelengths are in micrometres: of wavenumbers in 1/cm they are 1e4 / wavenumber");
}

void requireSpectralAxis(const ArrayArgument& of, std::span<const double> wavelength_um) {
  requireWavelengths(of, wavelength_um);
  if (wavelength_um.size() < 2)
    throw UserError(of.where(), print("%s has %zu entr%s", of.name, wavelength_um.size(), wavelength_um.size() == 1 ? "y" : "ies"), "two or more",
                    "give the wavelengths of a table");
  for (std::size_t i = 1; i < wavelength_um.size(); ++i) {
    const bool step = wavelength_um[i] == wavelength_um[i - 1] && (i < 2 || wavelength_um[i - 2] < wavelength_um[i]);
    if (!(wavelength_um[i] > wavelength_um[i - 1] || step))
      refuseEntry(of, i, wavelength_um[i], print("more than the %g before it", wavelength_um[i - 1]).c_str(),
                  "sort the wavelengths with their values; two equal neighbours are a step");
  }
  if (wavelength_um.front() == wavelength_um.back())
    throw UserError(of.where(), print("%s is one wavelength, %g um", of.name, wavelength_um.front()), "a range of wavelengths", "give both its ends");
}

void requireSameLength(const ArrayArgument& of, std::span<const double> values, std::span<const double> wavelength_um) {
  if (values.size() != wavelength_um.size())
    throw UserError(of.where(), print("%s has %zu entries", of.name, values.size()), print("%zu, one for each wavelength", wavelength_um.size()),
                    "give both arrays the same length");
}

}  // namespace pitviper
