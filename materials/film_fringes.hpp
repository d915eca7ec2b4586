#pragma once
// Fringes of films over wavelength: how far apart they lie, how finely wavelengths must follow them, and their mean where they are finer than the reference's.
//
// Rule: fringes as far apart as the reference's wavelengths (referenceWidth_um) or farther are as Airy's formula has them, and wavelengths follow them. Where
// they are closer together a stack is the mean over a Gauss curve of wavelength, whose standard deviation grows to 0.24 of that width where two fringes lie
// in it: 1 % of their contrast is left there and nothing of closer ones. For one film that mean is the sum of powers; of several it keeps what is slow.
#include <complex>
#include <limits>
#include <span>
#include <vector>

#include "materials/film_stack.hpp"

namespace pitviper {

/// From one fringe to the next at normal incidence [um], lambda^2 / (2 sum of n d) of what interferes as one; infinite where nothing does.
double fringeApart_um(std::span<const FilmLayer> layers, double wavelength_um);

/// Standard deviation of the curve that fringes so far apart are averaged over [um]; 0: they are not.
double fringeSpread_um(double apart_um, double wavelength_um);

/// Wavelengths no farther apart than this see a stack's fringes, by what frequencies its reflectance and transmittance are made of.
double fringeStep_um(const std::vector<FilmLayer>& layers, std::complex<double> beneath, double wavelength_um);

/// A stack at wavelengths about one, as many times as its layers that interfere are thicker, with what each counts for; one of them where nothing is averaged.
struct FringeMean {
  FringeMean(std::span<const FilmLayer> layers, double wavelength_um);
  struct Place {
    double thicker, weight;
  };
  std::vector<Place> places;
  /// `power` of the layers at each, averaged.
  template <class Power>
  FilmPower of(const std::vector<FilmLayer>& layers, const Power& power) const {
    if (places.size() == 1) return power(layers);
    std::vector<FilmLayer> own = layers;
    FilmPower sum;
    for (const Place& p : places) {
      for (std::size_t k = 0; k < own.size(); ++k)
        if (layers[k].coherent) own[k].thickness_um = layers[k].thickness_um * p.thicker;
      const FilmPower one = power(own);
      sum.reflectance += p.weight * one.reflectance, sum.transmittance += p.weight * one.transmittance;
    }
    return sum;
  }
};

}  // namespace pitviper
