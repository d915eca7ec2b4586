#pragma once
// The tables a plan's program reads, made in double precision: node constants, weights, material and temperature rows.
#include <array>
#include <cstdint>
#include <vector>

#include "sim/gl/shader_assembler.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

/// Mirrors MaterialShape of sim/render/glsl/materials.glsl (std430).
struct GpuMaterial {
  std::uint32_t counts[4];
  std::uint32_t kinds[4];
  float scale[4];
  float exponent[4];
  std::int32_t modifier[4];
  std::int32_t transmission[4];
};
static_assert(sizeof(GpuMaterial) == 96);

enum class DrawKind { Background, Ground, Solid, Layer, Medium };

/// A drawn part: entity and surface; the background is the first draw and has entity -1, as has the ground, which pixels of the background find. A medium is
/// one draw for its whole body.
struct DrawItem {
  DrawKind kind = DrawKind::Background;
  int entity = -1;
  int surface = -1;
  std::uint32_t row = 0;       ///< first entry of its row in the tables of its kind
  std::uint32_t material = 0;  ///< in the tables of its kind
};

/// What a program needs of the surfaces that it draws: the solid ones, or the transparent ones.
struct SurfaceTables {
  bool general = false;              ///< angular tables, modifiers or temperature textures
  bool tabulated = false;            ///< some reflection component is a table over angles
  bool lit = false;                  ///< there are lights for them to reflect
  std::vector<float> rows;           ///< simple: vec4 (R1, R2, R3, S) per node, unlit S alone; general: Planck radiance per node
  long long planckAt = -1;           ///< general: entry of `rows` where Planck radiance is tabulated over the inverse of the temperature, or -1
  std::vector<float> hemispherical;  ///< vec4 (D1, D2, D3, given emissivity) per view angle and node
  std::vector<float> columns;        ///< lit: vec4 (R1, R2, R3, 0) per angle 2, angle 1 and node
  std::vector<float> transmittance;  ///< per view angle and node
  std::vector<GpuMaterial> materials;
  int floatsPerRowEntry() const { return general || !lit ? 1 : 4; }
};

struct RenderTables {
  std::vector<DrawItem> draws;
  int ground = -1;             ///< its draw, where the scene has one
  SurfaceTables solid, layer;  ///< the background's material is the last solid one
  std::vector<float> media;    ///< vec4 (absorption [1/m], source radiance, 0, 0) per node
  std::vector<float> node;     ///< vec4 per node: extinction, source radiance, c2 / lambda, c1L / lambda^5
  std::vector<float> ambient;  ///< vec4 per node; empty without a dome's light, or where all rows hold it
  std::vector<float> weights;  ///< vec4s in the order of the integration text
  std::string integrateText;   ///< body of the spectral integral
  std::string targetsText;     ///< how the channel targets begin
};

/// Light intensities at the nodes, vec4 per group of four lights: changes with the lights' levels.
std::vector<float> lightTable(const Simulation& simulation, const Plan& plan, const WorldState& state);
int lightGroups(const Plan& plan);
/// Shader file of the lights. Up to so many each have registers of their own; of more, bodies list those that matter.
constexpr int kFewLights = 4;
std::string lightsFile(const Plan& plan);

/// Shader files and constants of a kind of surfaces: what light does to them, what they emit, their textures. All but the slots "surface" and
/// "transmission".
void addSurfaceSlots(const SurfaceTables& tables, const SurfaceTerms& terms, const Plan& plan, ShaderSlots& slots);

RenderTables makeTables(const Simulation& simulation, const Plan& plan);

/// Entries of a material's grid of view angles from 0 to 90 deg, linear between: 181 (every 0.5 deg), or as many more, up to 1441 (every
/// 0.0625 deg), as it takes to have all bends of an emissivity or table on the grid. Where no such grid exists, a bend between two entries
/// is cut off by at most a quarter of step times change of slope.
constexpr int kViewAngles = 181, kMostViewAngles = 1441;

}  // namespace pitviper
