#pragma once
// Every spectrum that a scene's light goes through, with the wavelengths at which it bends: what a grid of wavelengths must not step over.
#include <functional>
#include <vector>

#include "sim/model/fringes.hpp"
#include "sim/model/simulation.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

struct BentSpectrum {
  std::vector<double> knots_um;  ///< rising
  std::function<double(double wavelength_um)> at;
  bool isDepth = false;  ///< light dies away by its exponential: the mean of what passes is not what passes at its mean
};

/// Lights, sun, background, ambient light, and what materials and media send, reflect, let through and absorb. Those without bends are left out.
/// Valid while the simulation is, at wavelengths that all of it covers.
std::vector<BentSpectrum> spectraOf(const Simulation& simulation);

/// Its components that have fringes between their knots.
std::vector<const HasFringes*> fringedOf(const Simulation& simulation);

/// The same of the air: the sum of its extinction coefficients.
BentSpectrum airSpectrum(const Atmosphere& air);

/// Knots of a spectrum between two wavelengths, both left out.
std::vector<double> knotsWithin(const BentSpectrum& spectrum, double low_um, double high_um);

/// Narrow lines of a scene (a lamp of sodium, a filter of 1 nm) in the band of a response: stretches of bends closer together than the samples of a
/// rule can tell, which it does not integrate within 0.1 %. None where such stretches are more than a twentieth of the band: a spectrum that is
/// rough all over is sampled, not cut.
struct SpectralLine {
  std::vector<double> knots_um;  ///< from its beginning to its end
};
std::vector<SpectralLine> narrowLines(const std::vector<BentSpectrum>& spectra, const Spectrum& kernel, const std::vector<QuadratureNode>& rule);

/// Nodes of lines by themselves: Gauss points between all their bends, weighted by the response.
std::vector<QuadratureNode> lineNodes(const std::vector<SpectralLine>& lines, const Spectrum& kernel);
/// 1 outside the lines, 0 inside.
Spectrum betweenLines(const std::vector<SpectralLine>& lines);

}  // namespace pitviper
