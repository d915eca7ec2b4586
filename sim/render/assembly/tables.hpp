#pragma once
// The tables a plan's program reads, made in double precision: node constants, weights, material and temperature rows.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "sim/gl/shader_assembler.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class NodeSurroundings;

/// Mirrors MaterialShape of sim/render/assembly/glsl/materials.glsl, which ends with so many components as its program has.
struct GpuMaterial {
  std::array<std::uint32_t, 4> counts{}, kinds{};
  std::array<float, 4> scale{};
  std::array<std::int32_t, 4> transmission{}, state{};
  std::array<float, 4> stateScale{};
  std::array<std::uint32_t, 4> second{1, 1, 0, 0};
  std::array<std::uint32_t, 4> response{0, 0, 1, 0};
  std::vector<std::array<std::int32_t, 4>> components;  ///< lobe + 1, texture or -1, 1 where there is one, 1 where its texture is an image of the last one's
  std::vector<std::array<float, 4>> images;             ///< of the last one's texture: factor, then what is added
  std::vector<std::array<float, 4>> lobes;
};

enum class DrawKind { Background, Ground, Solid, Layer, Medium };

/// A drawn part: entity and surface; the background is the first draw and has entity -1, as has the ground, which pixels of the background find. A medium is
/// one draw for its whole body.
struct DrawItem {
  DrawKind kind = DrawKind::Background;
  int entity = -1;
  int surface = -1;
  std::uint32_t row = 0;       ///< of its row in the tables of its kind: first texel (packed), else first node's entry
  std::uint32_t material = 0;  ///< in the tables of its kind
  double temperature_K = 0.0;  ///< that its row is of
  int surfaceClass = 0;        ///< of what is solid (surface_classes.hpp)
  int unshadowed = 0;          ///< the class for where lamps matter and shadows don't; everyLight where there is none
  int everyLight = 0;          ///< the class for where lamps or shadows matter; the same where there is one
};

/// Of all parts that are drawn, without what only tables know.
std::vector<DrawItem> drawItems(const Simulation& simulation);

/// What a program needs of the surfaces that it draws: the solid ones, or the transparent ones.
struct SurfaceTables {
  bool general = false;    ///< angular tables, modifiers or temperature textures
  bool tabulated = false;  ///< some reflection component is a table over angles
  bool second = false;     ///< some material's components run over more angles than one table has
  bool lit = false;        ///< there are lights for them to reflect
  bool states = false;     ///< some material has states
  std::size_t nodes = 0;
  int vectors = 1;                   ///< so many vec4 hold a material's components at a node: (R1, R2, R3, S), (R4, R5, R6, 0) ...
  std::vector<float> rows;           ///< vec4s; simple: these per node, unlit S alone; general: Planck radiance per node
  long long planckAt = -1;           ///< general: texel of `rows` where Planck radiance is tabulated over the inverse of the temperature, or -1
  std::vector<float> hemispherical;  ///< (D1, D2, D3, given emissivity), (D4, D5, D6, 0) ... per state, view angle and node
  std::vector<float> columns;        ///< lit: (R1, R2, R3, 0) ... per state, angle 2, angle 1 and node; then a material's second table, if any
  std::vector<float> transmittance;  ///< per view angle and node
  std::vector<GpuMaterial> materials;
  bool packed() const { return general || !lit; }  ///< a number a node, four of them to a texel
  std::size_t texelsOfRow() const { return packed() ? (nodes + 3) / 4 : nodes * static_cast<std::size_t>(vectors); }
  /// Where in `rows` is what a surface sends by itself.
  std::size_t selfAt(std::uint32_t row, std::size_t node) const {
    return packed() ? 4 * std::size_t{row} + node : 4 * static_cast<std::size_t>(vectors) * (row + node) + 3;
  }
  /// The materials as the shader reads them.
  std::vector<std::uint32_t> packedMaterials() const;
};

struct RenderTables {
  std::shared_ptr<const NodeSurroundings> around;  ///< null without ambient light by direction
  std::vector<DrawItem> draws;
  int ground = -1;             ///< its draw, where the scene has one
  SurfaceTables solid, layer;  ///< the background's material is the last solid one
  std::vector<float> media;    ///< of four nodes each: absorption [1/m]; source radiance
  std::vector<float> node;     ///< vec4 per node: extinction, source radiance, c2 / lambda, c1L / lambda^5
  std::vector<float> ambient;  ///< vec4 per node; empty without a dome's light, or where all rows hold it
  std::vector<float> weights;  ///< vec4s in the order of the integration text
  std::string integrateText;   ///< body of the spectral integral
  bool writtenOut = false;     ///< without loops over nodes
  std::string targetsText;     ///< how the channel targets begin
};

/// Light intensities at the nodes, vec4 per group of four lights: changes with the lights' levels.
std::vector<float> lightTable(const Simulation& simulation, const Plan& plan, const WorldState& state);
int lightGroups(const Simulation& simulation, const Plan& plan);
/// Up to so many lights each have registers of their own; of more, bodies list those that matter.
constexpr int kFewLights = 4;

/// Entries over the inverse of the temperature: at 250 to 2000 K 0.6 K apart at 300 K, where 4 um is straight to 1e-4 between two.
constexpr int kPlanckEntries = 512;
RenderTables makeTables(const Simulation& simulation, const Plan& plan);

/// Rows of surfaces and media whose temperatures are no longer those they were made for are made anew, at their places. False where there are none.
bool updateTemperatures(RenderTables& tables, const Simulation& simulation, const Plan& plan, const WorldState& state);

/// Entries of a material's grid of view angles from 0 to 90 deg, linear between: 181 (every 0.5 deg), or as many more, up to 1441 (every
/// 0.0625 deg), as it takes to have all bends of an emissivity or table on the grid. Where no such grid exists, a bend between two entries
/// is cut off by at most a quarter of step times change of slope.
constexpr int kViewAngles = 181, kMostViewAngles = 1441;

}  // namespace pitviper
