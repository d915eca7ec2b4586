#pragma once
// Nodes of a batch in a shader: each written out, or all by one loop where each has a loop of its own inside. LLVM's time to compile doubles with each loop
// that follows another (ScalarEvolution asks of each whether those before it bound it): 0.5 s with 8, 2 s with 12, over four minutes with 32.
#include <string>

#include "sim/gl/shader_assembler.hpp"

namespace pitviper {

/// So many nodes with loops inside may be written out.
constexpr int kMostLoopsWrittenOut = 8;

/// Sets LIGHT_LOOPS, or LIGHT_TERMS, to 1: which of the two texts of nodesText() counts. After the slot `lights` and WRITTEN_OUT.
void setLightLoops(ShaderSlots& slots);

/// Statements that fill `targets` vectors NAME0, NAME1, ... of four nodes each by CALL + "node)" of a node. `nodes`: of a batch that is alone, all there are,
/// their numbers written out; else 0, and numbers go on from `firstNode`. `reads`: the call begins with what the vector held.
std::string nodesText(const std::string& name, int targets, int nodes, const std::string& call, bool reads);

}  // namespace pitviper
