#include <array>

#include "atmosphere/models.hpp"
#include "materials/lights.hpp"
#include "materials/models.hpp"
#include "scenarios/commands/commands.hpp"
#include "sensors/stages.hpp"

namespace pitviper {

std::span<const ShaderText> pv_radiometry_shaders();
std::span<const ShaderText> pv_render_shaders();
std::span<const ShaderText> pv_camera_shaders();
std::span<const ShaderText> pv_materials_shaders();
std::span<const ShaderText> pv_fields_shaders();
std::span<const ShaderText> pv_atmosphere_shaders();

const ShaderLibrary& shaderLibrary() {
  static const ShaderLibrary library = [] {
    ShaderLibrary l;
    l.add(pv_radiometry_shaders());
    l.add(pv_render_shaders());
    l.add(pv_camera_shaders());
    l.add(pv_materials_shaders());
    l.add(pv_fields_shaders());
    l.add(pv_atmosphere_shaders());
    for (const StageModel& m : stageModels().all())
      for (const auto& [path, text] : m.shaders) l.add(std::array{ShaderText{path, text}});
    for (const AirModel& m : airModels().all())
      for (const auto& [path, text] : m.shaders) l.add(std::array{ShaderText{path, text}});
    for (const ReflectionModel& m : reflectionModels().all())
      if (!m.shader.first.empty()) l.add(std::array{ShaderText{m.shader.first, m.shader.second}});
    for (const LightModel& m : lightModels().all())
      if (!m.shader.first.empty()) l.add(std::array{ShaderText{m.shader.first, m.shader.second}});
    return l;
  }();
  return library;
}

}  // namespace pitviper
