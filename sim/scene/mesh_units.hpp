#pragma once
// Whether the unit given for a mesh file is likely, by the size it makes of the body.
#include <glm/glm.hpp>
#include <string>

namespace pitviper {

/// In words what is odd about it and what other units would make of it; empty: nothing. size_m: the box around the body; file: by its name,
/// since glTF is in metres by its standard. A guess for people to look at, never a mistake by itself.
std::string doubtAboutUnit(const glm::dvec3& size_m, double metresPerUnit, const std::string& file);

}  // namespace pitviper
