#pragma once
// A generic twin-engine fighter and a generic air-to-air missile, lofted from a few sections; no real type is meant.
// They are what jet.obj and missile.obj beside this file hold (tests/support/write_obj.hpp). Metres, nose along +x, origin near the
// middle. Every body is closed; bodies overlap, so that nothing shows between them.
#include "sim/scene/mesh.hpp"

namespace pitviper {

/// 15.1 m long, 10.5 m span. Parts: skin, wing_edges (leading edges of wings and tails), radome, canopy, intake,
/// tailpipe (outer shell and inner wall), nozzle (what is seen hot from behind: liner, flame holder cone and its disc).
Mesh makeJet();

/// 2.9 m long, 0.127 m thick, fins 0.63 m from tip to tip. Parts: dome, body, fins, nozzle.
Mesh makeMissile();

}  // namespace pitviper
