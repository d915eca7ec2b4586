#pragma once
// Classes of surfaces: what shades a surface is a program that has what its class needs, and nothing else. One costly material costs its own pixels.
#include <vector>

#include "sim/render/tables.hpp"

namespace pitviper {

/// What shading takes beyond the plainest surface; what is behind all surfaces is the plainest of all, and the first class.
struct SurfaceClass {
  bool sky = false;
  bool modifiers = false;  ///< textures of reflection or emission
  bool temperatureTextures = false;
  bool lobes = false;
  bool tabulated = false;  ///< reflection over angles
  bool states = false;
  bool operator==(const SurfaceClass&) const = default;
};

/// Classes of what is solid, and in each solid draw the number of its own (DrawItem::surfaceClass).
std::vector<SurfaceClass> sortIntoClasses(RenderTables& tables, const Simulation& simulation);

/// Changes the slots of a program for all solid surfaces into those of one class.
void addClassSlots(const SurfaceClass& own, const RenderTables& tables, ShaderSlots& slots);

}  // namespace pitviper
