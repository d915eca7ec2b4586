#pragma once
// Classes of surfaces: what shades a surface is a program that has what its class needs, and nothing else. Costly materials cost their own pixels. What is
// behind all surfaces is a class, the plainest surfaces are one, and all others together: more programs gain little (first_light: a fiftieth) and each takes a
// driver a tenth of a second or more to compile.
#include <vector>

#include "sim/render/tables.hpp"

namespace pitviper {

/// What shading takes beyond the plainest surface.
struct SurfaceClass {
  bool sky = false;
  bool modifiers = false;  ///< textures of reflection or emission
  bool temperatureTextures = false;
  bool lobes = false;
  bool tabulated = false;  ///< reflection over angles
  bool states = false;
  bool operator==(const SurfaceClass&) const = default;
};

/// Classes of what is solid, the sky first, and in each solid draw the number of its own (DrawItem::surfaceClass). `apart`: false puts all into one, of which
/// each pixel costs as the costliest, but which takes a driver no longer to compile than a single program.
std::vector<SurfaceClass> sortIntoClasses(RenderTables& tables, const Simulation& simulation, bool apart);

/// Changes the slots of a program for all solid surfaces into those of one class.
void addClassSlots(const SurfaceClass& own, const RenderTables& tables, ShaderSlots& slots);

}  // namespace pitviper
