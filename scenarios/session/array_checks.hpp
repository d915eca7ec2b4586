#pragma once
// What arrays that callers hand over have to be, said of the entry that is not.
#include <span>

#include "sim/parameters/error.hpp"

namespace pitviper {

/// An array that a function takes: both by the names that its caller knows.
struct ArrayArgument {
  const char* function;  ///< "planck_radiance()"
  const char* name;      ///< "temperature_K"
  Location where() const { return {function, 0, 0, -1}; }
};

/// Each of these: UserError at the function, naming the first entry that is not so.
void requireFinite(const ArrayArgument& of, std::span<const double> values);
/// Finite, and 0 or more.
void requireNotNegative(const ArrayArgument& of, std::span<const double> values);
/// Within the spectral axis, 0.1 to 1000 um.
void requireWavelengths(const ArrayArgument& of, std::span<const double> wavelength_um);
/// Two or more of these, rising; two equal neighbours, not three, are a step.
void requireSpectralAxis(const ArrayArgument& of, std::span<const double> wavelength_um);
/// As many as there are wavelengths.
void requireSameLength(const ArrayArgument& of, std::span<const double> values, std::span<const double> wavelength_um);

}  // namespace pitviper
