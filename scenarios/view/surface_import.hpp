#pragma once
// Materials of the library and of files as curves to be edited.
#include <string>

#include "scenarios/view/edited_surface.hpp"

namespace pitviper {

/// Curves follow what they are made from within this (exponents: of themselves).
constexpr double kCurveTolerance = 1e-3;

/// `word`: a material of the library, the file of one, or a file of others that importedMaterial() takes. Lambertian components, Phong lobes of one exponent or
/// one spectral_phong become curves within kCurveTolerance; facets under one film become a film over its substrate; of anything else the
/// directional-hemispherical reflectance at normal view becomes the diffuse curve. notes: what that leaves out. UserError where there is no such surface.
EditedSurface surfaceNamed(const std::string& word, const Libraries& libraries);

/// A material as a scenario has it: by what the file says of it under 'materials:', or in the library; of one that is said elsewhere, as of any other kind.
EditedSurface surfaceWithin(const std::filesystem::path& scenario, const std::string& name, const std::shared_ptr<const Material>& material,
                            const Libraries& libraries);

/// Names of the library's materials and substances.
std::vector<std::string> libraryMaterials(const Libraries& libraries);
std::vector<std::string> librarySubstances(const Libraries& libraries);

}  // namespace pitviper
