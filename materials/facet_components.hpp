#pragma once
// The components that a face of facets is drawn by.
#include "materials/facet_optics.hpp"
#include "materials/models.hpp"

namespace pitviper {

/// The facets, what lies beneath them where that is anything, and what a pane lets through. UserError at `where` where their substances have no
/// wavelength in common.
MadeReflection facetComponents(FacetSpec spec, const Location& where);

}  // namespace pitviper
