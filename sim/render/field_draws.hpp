#pragma once
// Fields of a view on the GPU: their numbers, which tiles of the picture each of their parts may show in, and the programs that draw them.
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/model/field_lines.hpp"
#include "sim/render/field_tables.hpp"
#include "sim/render/layer_order.hpp"
#include "sim/render/shading_program.hpp"

namespace pitviper {

class FieldDraws {
 public:
  /// All but the library must outlive it. `slots`: of programs that blend over the spectral image, the slot `blend` for lines (addBlend()).
  FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots);
  /// What of them is in view; adds a piece of each to be sorted.
  void place(const View& view, const WorldState& state, std::vector<LayerPiece>& pieces);
  /// The program of a field that is in view, in use, its buffers and uniforms set but `firstNode`.
  const Program& use(int field);
  /// The part of the picture that it may show in (corner, size) [pixels].
  glm::ivec4 rectOf(int field) const;
  void addPrograms(std::vector<NamedProgram>& all) const;

 private:
  struct Body {
    FieldTables tables;
    int steps = 1;
    Buffer spectra, texels, tiles;
    const Program* program = nullptr;
    std::shared_ptr<const FieldTexels> uploaded;
    // Of the view.
    FieldLines lines;
    glm::vec4 row[3];
    float fine = 0.0f;
    glm::ivec4 grid{0};
  };
  void listTiles(const View& view, const FieldState& field, Body& body);

  const Simulation& simulation_;
  std::map<std::string, Program> programs_;
  std::vector<Body> bodies_;
};

}  // namespace pitviper
