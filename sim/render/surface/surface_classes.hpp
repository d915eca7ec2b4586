#pragma once
// Classes of surfaces: what shades a surface is a program that has what its class needs, and nothing else. Costly materials cost their own pixels. What is
// behind all surfaces is a class, the plainest surfaces are one, those with textures whose albedo is the same at all angles, and all others together; the
// first two once with every light and its shadows, once with the sun alone, and once with every light where nothing stands before any. More would gain little,
// and each takes a driver a tenth of a second or more to compile.
#include <vector>

#include "sim/render/assembly/tables.hpp"

namespace pitviper {

/// What shading takes beyond the plainest surface.
struct SurfaceClass {
  bool sky = false;
  bool sunAlone = false;    ///< for pixels that no lamp and no shadow matters to
  bool unshadowed = false;  ///< for pixels that no shadow matters to
  bool modifiers = false;   ///< textures of reflection or emission
  bool emissionModifiers = false;
  bool viewAngles = false;  ///< what the hemisphere sends depends on them
  bool columns = false;     ///< that are not albedo / pi
  int components = 0;       ///< at most
  bool temperatureTextures = false;
  bool lobes = false;
  bool tabulated = false;  ///< reflection over angles
  bool states = false;
  bool around = false;  ///< what they send of light from all around depends on the view
  bool operator==(const SurfaceClass&) const = default;
};

/// Classes of what is solid, the sky first, and in each solid draw the numbers of its own (DrawItem::surfaceClass, unshadowed, everyLight). `apart`: false puts
/// all into one, of which each pixel costs as the costliest, but which takes a driver no longer to compile than a single program.
std::vector<SurfaceClass> sortIntoClasses(RenderTables& tables, const Simulation& simulation, const Plan& plan, bool truth, bool apart);

/// Whether some pixels of a plan's pictures may need no lamps and no shadows where others do. Truth tells of the first lamp, whatever it adds; only the
/// program with the sun does.
bool lightsVary(const Plan& plan, const Simulation& simulation, bool truth);

/// Whether lamps may matter to some of them that nothing stands before.
bool shadowsVary(const Plan& plan, const Simulation& simulation, bool truth);

/// Changes the slots of a program for all solid surfaces into those of one class.
void addClassSlots(const SurfaceClass& own, const RenderTables& tables, ShaderSlots& slots);

}  // namespace pitviper
