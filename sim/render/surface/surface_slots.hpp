#pragma once
// Which shader files a kind of surfaces is made of.
#include <string>

#include "sim/gl/shader_assembler.hpp"
#include "sim/render/assembly/tables.hpp"

namespace pitviper {

inline std::string surfaceShader(const char* name) { return std::string("sim/render/surface/glsl/") + name + ".glsl"; }

/// Shader files and constants of a kind of surfaces: what light does to them, what they emit, their textures. All but the slots "surface" and
/// "transmission".
void addSurfaceSlots(const SurfaceTables& tables, const SurfaceTerms& terms, const Plan& plan, ShaderSlots& slots);

}  // namespace pitviper
