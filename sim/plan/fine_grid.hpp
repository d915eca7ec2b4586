#pragma once
// The wavelengths that the reference, and the planner's own figures, are made of.
#include "sim/radiometry/quadrature.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Bins from edge to edge of a response, each 5 1/cm wide or 1 nm, whichever is wider, cut where the response bends: its middle, weighted by the
/// response's integral over it. Band models of the air have no finer structure.
std::vector<QuadratureNode> fineGrid(const Spectrum& kernel);

}  // namespace pitviper
