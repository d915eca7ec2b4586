#pragma once
// Integrals over wavelength of a product as sums over few wavelengths: which ones, and with what weights.
#include <functional>
#include <vector>

#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// integral of weight k(lambda) f(lambda) dlambda = sum over places of weight[k][place] f(wavelength_um[place]).
struct BandRule {
  std::vector<double> wavelength_um;        ///< rising
  std::vector<std::vector<double>> weight;  ///< of each given weight: [weight][place]
};

/// Functions that stand for all that is integrated with some of the weights.
struct BandProbe {
  std::vector<std::size_t> weights;                                           ///< by their numbers
  std::size_t count = 0;                                                      ///< of functions
  std::function<void(double wavelength_um, std::vector<double>& values)> at;  ///< puts `count` values in the first places
};

/// A composite Gauss rule between all knots, of which as few places are kept, by parabolas over stretches of them, as leave the integrals of the probes with
/// their weights within `accuracy` of their own, or of a thousandth of the largest of one probe. `knots_um`: where the functions bend; `longest_um`: cells no
/// wider than this at a wavelength see all that they do between. Outside all weights' supports there are no places. The probes are asked on several threads at
/// once.
BandRule bandRule(const std::vector<Spectrum>& weights, const std::vector<double>& knots_um, const std::function<double(double)>& longest_um,
                  const std::vector<BandProbe>& probes, double accuracy);

}  // namespace pitviper
