#pragma once
// The ordered pass of buffered mode: what of transparent surfaces, bodies of emitting media and fields a line meets, each node by its own transmittance, from
// far to near over the spectral image of the solid scene. Source: Duvenhage 2006 section 5.3.2; PHYSICS section 2.
#include <functional>
#include <memory>
#include <optional>

#include "sim/render/assembly/surface_buffers.hpp"
#include "sim/render/geometry/gpu_scene.hpp"
#include "sim/render/geometry/hit_lists.hpp"
#include "sim/render/media/field_draws.hpp"
#include "sim/render/media/ordered_lines.hpp"
#include "sim/render/surface/shading_program.hpp"

namespace pitviper {

class SeenThrough {
 public:
  /// All but the library must outlive it. `targets`: RGBA targets of the spectral image. `slots`: path, lights and constants of the
  /// plan's shading programs; nodes are named by numbers where they say so.
  SeenThrough(const Simulation& simulation, const Plan& plan, const RenderTables& tables, std::shared_ptr<const GpuScene> scene, const ShaderLibrary& library,
              const ShaderSlots& slots, int targets);

  /// What follows temperatures, as the tables have it now.
  void updateTemperatures();

  /// What of `drawn` is in view.
  void place(const View& view, const WorldState& state, const std::vector<char>& drawn);
  bool isEmpty() const { return draws_.empty() && noFields(); }
  /// Nothing but fields is in view.
  bool isOfFields() const { return draws_.empty(); }
  /// Of the fields, after those of the tables.
  void addDraws(std::vector<GpuDraw>& draws) const {
    if (fields_) fields_->addDraws(draws);
  }

  /// A spectral image of the solid scene, of nodes from the first on.
  struct Over {
    RenderTarget& spectrum;
    const RenderTarget& visibility;  ///< identity and depth of the solid scene; what has the nearest depth of all is left out
    int firstNode = 0;
    const View& view;  ///< that it is a picture of
  };
  /// Draws, view, lights and nodes are bound; changes the bound textures of buffers and the blend, cull and depth state's settings. Of a picture's batches of
  /// nodes the first one comes first.
  void run(const Over& over);
  /// Has all programs compiled, for things that come into view later; those that work out entries of lists are only added to `first`, if given.
  void warmUp(const Over& over, FirstDraws* first = nullptr);
  /// Those that the scenario's transparent things need: to find and order them, of surfaces, media and fields, and to walk along lines.
  std::vector<NamedProgram> programs() const;

 private:
  bool noFields() const { return !fields_ || fields_->isEmpty(); }
  void findHits(const Over& over);
  void order(std::size_t first, std::size_t count);
  /// Entries of one list, which one program works out.
  struct List {
    const Program& program;
    std::size_t first, count, firstPassage;
    std::optional<std::size_t> field = {};
  };
  void forLists(bool all, const std::function<void(const List&)>& visit);
  void shade(const List& list, int firstNode);
  void addLists(const Over& over, bool all, FirstDraws& first);
  void shadePassages(const Over& over, bool all);
  void walk(const Over& over, std::size_t first, std::size_t count);

  const Simulation& simulation_;
  const RenderTables& tables_;
  std::shared_ptr<const GpuScene> scene_;
  int targets_;
  SurfaceBuffers buffers_;
  Buffer media_;
  Buffer sums_;                         ///< of pixels' lines
  Buffer passages_;                     ///< what each thing on a line lets through and what it adds, node by node
  std::unique_ptr<FieldDraws> fields_;  ///< null: none
  std::unique_ptr<HitLists> hits_;
  std::unique_ptr<OrderedLines> lines_;
  Program pane_, segment_, walk_;
  RenderTarget entries_;                               ///< without colours: where entries of lists are drawn
  std::vector<std::size_t> draws_;                     ///< of surfaces and media in view
  std::pair<std::size_t, std::size_t> ordered_{0, 0};  ///< of the picture, as `lists_` has them
  OrderedLines::Lists lists_;
};

}  // namespace pitviper
