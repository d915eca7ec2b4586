#pragma once
// Programs of the visibility pass: the same for all passes over a scene, which share them.
#include "sim/gl/objects.hpp"

namespace pitviper {

struct SolidPrograms {
  explicit SolidPrograms(const ShaderLibrary& library);
  Program single, ofPart, instanced, box;  // two of one text: llvmpipe finds only the first of a program's states in its cache
};

}  // namespace pitviper
