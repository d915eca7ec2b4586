#include "sim/render/geometry/solid_programs.hpp"

namespace pitviper {
namespace {

Program visibilityProgram(const ShaderLibrary& library, bool instances) {
  ShaderSlots vertex, fragment;
  vertex.files["drawn"] = instances ? "sim/render/geometry/glsl/drawn_instances.vert.glsl" : "sim/render/geometry/glsl/drawn_one.glsl";
  fragment.files["drawn"] = instances ? "sim/render/geometry/glsl/drawn_instances.frag.glsl" : "sim/render/geometry/glsl/drawn_one.glsl";
  return Program(assembleShader(library, "sim/render/geometry/glsl/visibility.vert.glsl", vertex),
                 assembleShader(library, "sim/render/geometry/glsl/visibility.frag.glsl", fragment));
}

}  // namespace

SolidPrograms::SolidPrograms(const ShaderLibrary& library)
    : single(visibilityProgram(library, false)),
      instanced(visibilityProgram(library, true)),
      box(assembleShader(library, "sim/render/geometry/glsl/box.vert.glsl", {}), assembleShader(library, "sim/render/geometry/glsl/nothing.frag.glsl", {})) {}

}  // namespace pitviper
