#pragma once
// Programs of the visibility pass: the same for all passes over a scene, which share them.
#include "sim/gl/objects.hpp"

namespace pitviper {

struct SolidPrograms {
  explicit SolidPrograms(const ShaderLibrary& library);
  Program single, instanced, box;
};

}  // namespace pitviper
