#pragma once
// Fields of a view on the GPU: their numbers, which tiles of the picture each of their parts may show in, the lines of the pixels where they do, and the
// programs that look along these.
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/plan/field_sampling.hpp"
#include "sim/render/assembly/named_program.hpp"
#include "sim/render/geometry/view_data.hpp"
#include "sim/render/media/field_tables.hpp"
#include "sim/world/field_lines.hpp"

namespace pitviper {

class FieldDraws {
 public:
  /// All but the library must outlive it. `slots`: of programs that work out entries of lists, nodes of a batch.
  FieldDraws(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, const ShaderSlots& slots);
  /// Those of a state that a view shows. The state must last while they are drawn.
  void place(const View& view, const WorldState& state);
  bool isEmpty() const;
  std::size_t count() const { return bodies_.size(); }
  /// Where they stand in that view, a draw each.
  void addDraws(std::vector<GpuDraw>& draws) const;
  /// How they are drawn from here on: for the pixels of this view, which sees the same.
  void look(const View& view);
  bool shows(std::size_t field) const { return !bodies_[field].lines.isEmpty(); }
  /// The part of the picture that it may show in (corner, size) [pixels].
  glm::ivec4 rectOf(std::size_t field) const;
  /// What sim/render/geometry/glsl/field_tiles.glsl reads.
  void setTiles(std::size_t field, const Program& program) const;
  /// What sim/render/media/glsl/field_lines.glsl reads.
  void setLines(const Program& program) const;
  /// Lines of all pixels that may meet each.
  const std::vector<std::size_t>& entries() const { return entries_; }
  /// Whether air across it is nearly even, so that its program for that serves.
  bool isEven(std::size_t field) const { return bodies_[field].range.y > 0.0f; }
  /// That program, or the one for any.
  const Program& program(std::size_t field, bool even) const;
  /// A field's buffers, but those of its list.
  void bind(std::size_t field) const;
  /// The same of its uniforms; the program is in use.
  void setUniforms(std::size_t field, const Program& program) const;
  /// Buffers for what bind() binds, of fields that are not there yet, too.
  void reserve();
  void addPrograms(std::vector<NamedProgram>& all) const;

 private:
  struct Tile {
    std::vector<std::uint32_t> texel;
    FieldLines lines;
    int steps = 1;
    glm::dvec2 range{0.0};  ///< [m] from the plane of the field's origin
  };
  struct Body {
    Body(const Simulation& simulation, const Plan& plan, const FieldBody& field) : tables(simulation, plan, field) {}
    FieldTables tables;
    StepsByKind steps{};  ///< by kind of element
    Buffer spectra, texels, tiles;
    const Program *far = nullptr, *near = nullptr;  ///< of those with nearly even air across them, or any
    std::shared_ptr<const FieldTexels> uploaded;
    const FieldState* state = nullptr;  ///< null: not there
    // Of the view.
    FieldLines lines;
    GpuDraw draw{};
    glm::vec2 range{0.0f};
    glm::ivec4 grid{0};  ///< first pixel, tiles across, pixels a side
    std::vector<Tile> listed;
    ApartByKind coarser{};  ///< lines of pictures, than of the reference
    const Tile* tileAt(int x, int y) const;
  };
  void listTiles(const View& view, Body& body) const;
  int mostAt(int x, int y) const;
  void listLines(const View& view);

  std::shared_ptr<const FieldSampling> sampling_;
  std::map<std::string, Program> programs_;
  std::deque<Body> bodies_;
  Buffer lines_;
  double mostWork_ = 0.0;  ///< of the lines of a pixel
  double shared_ = 1.0;    ///< by so many pixels of a zoomed view
  glm::ivec4 part_{0};     ///< of the film that has lines
  std::vector<std::size_t> entries_;
};

}  // namespace pitviper
