#pragma once
// The wavelengths that the reference, and the planner's own figures, are made of.
#include <span>

#include "sim/model/path.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Bins from edge to edge of a response, each 5 1/cm wide or 1 nm, whichever is wider, cut where the response bends: its middle, weighted by the
/// response's integral over it. Band models of the air have no finer structure.
/// `table`: wavelengths [um], rising, of air from a table. Where they lie closer than that width the bins are theirs, from middle to middle, and its
/// wavelengths the nodes: between two bins of lines the mean of what passes is not what passes at the mean of their depths.
std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, std::span<const double> table = {});

/// Of a scene: with the wavelengths of its air, which may be null, where that is from a table.
std::vector<QuadratureNode> fineGrid(const Spectrum& kernel, const Path* air);

}  // namespace pitviper
