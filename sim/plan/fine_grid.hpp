#pragma once
// The wavelengths that the reference, and the planner's own figures, are made of.
#include <span>

#include "sim/plan/scene_spectra.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Bins from edge to edge of a response, each 5 1/cm wide or 1 nm, whichever is wider, but no wider than 1 % of its wavelength; cut where the response
/// bends: its middle, weighted by the response's integral over it. Band models of the air have no finer structure.
/// `table`: wavelengths [um], rising, of air from a table. Where they lie closer than that width the bins are theirs, from middle to middle, and its
/// wavelengths the nodes: between two bins of lines the mean of what passes is not what passes at the mean of their depths.
std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, std::span<const double> table = {});

/// Of a scene: with the wavelengths of its air where that is from a table, edges where layered air bends, and bins cut where some spectrum of the scene
/// (spectraOf) bends so much that the middle of a bin is not its mean: lines narrower than a bin keep their energy. Bins
/// are as small as fringes take (fringedOf).
std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, const Simulation& simulation);

/// The same for kernels that are alike (kernel_family.hpp): the same wavelengths with weights for each, edges where any of them bends.
std::vector<std::vector<QuadratureNode>> fineGrids(std::span<const Spectrum* const> kernels, const Simulation& simulation);

}  // namespace pitviper
