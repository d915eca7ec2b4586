#pragma once
// Fields of a view on the GPU: their numbers, which tiles of the picture each of their parts may show in, and the programs that draw them.
#include <array>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/field_lines.hpp"
#include "sim/plan/field_sampling.hpp"
#include "sim/render/field_tables.hpp"
#include "sim/render/layer_order.hpp"
#include "sim/render/shading_program.hpp"

namespace pitviper {

class FieldDraws {
 public:
  /// All but the library must outlive it. `slots`: of programs that blend over the spectral image, the slot `targets` of addTargets().
  FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots);
  /// What of them is in view; adds a piece of each to be sorted. The state must last while they are drawn.
  void place(const View& view, const WorldState& state, std::vector<LayerPiece>& pieces);
  /// How they are drawn from here on: for the pixels of this view, which sees the same.
  void look(const View& view);
  /// The program of a field that is in view, in use, its buffers and uniforms set but `firstNode`.
  /// `covered`: with a depth test; each of the two has a program of its own, as llvmpipe finds only the first of a program's states in its cache.
  const Program& use(int field, bool covered);
  /// The part of the picture that it may show in (corner, size) [pixels].
  glm::ivec4 rectOf(int field) const;
  void addPrograms(std::vector<NamedProgram>& all) const;

 private:
  struct Body {
    Body(const Simulation& simulation, const Plan& plan, const FieldBody& field) : tables(simulation, plan, field) {}
    FieldTables tables;
    StepsByKind steps{};  ///< by kind of element
    Buffer spectra, texels, tiles;
    const std::array<Program, 2>*far = nullptr, *near = nullptr;  ///< of those with nearly even air across them, or any; not covered, covered
    std::shared_ptr<const FieldTexels> uploaded;
    const FieldState* state = nullptr;  ///< null: not there
    // Of the view.
    FieldLines lines;
    glm::vec4 row[3];
    float fine = 0.0f;
    glm::vec2 range{0.0f};
    glm::ivec4 grid{0};
    int firstPixel = 0;
    double coarser = 1.0;  ///< lines of pictures, than of the reference
  };
  void listTiles(const View& view, const FieldState& field, Body& body);

  std::shared_ptr<const FieldSampling> sampling_;
  std::map<std::string, std::array<Program, 2>> programs_;
  std::deque<Body> bodies_;
};

}  // namespace pitviper
