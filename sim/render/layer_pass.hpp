#pragma once
// The ordered pass of buffered mode: transparent surfaces and bodies of emitting media, back to front over the spectral image of the
// solid scene, each node blended by its own transmittance. Source: Duvenhage 2006 section 5.3.2; PHYSICS section 2.
#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "sim/gl/blend_path.hpp"
#include "sim/render/field_draws.hpp"
#include "sim/render/gpu_scene.hpp"
#include "sim/render/layer_order.hpp"
#include "sim/render/pixel_classes.hpp"
#include "sim/render/shading_program.hpp"
#include "sim/render/surface_buffers.hpp"

namespace pitviper {

class LayerPass {
 public:
  /// All but the library must outlive it. `targets`: RGBA targets of the spectral image. `slots`: path, lights and constants of the
  /// plan's shading programs; nodes are named by numbers where they say so.
  LayerPass(const Simulation& simulation, const Plan& plan, const RenderTables& tables, std::shared_ptr<const GpuScene> scene, const ShaderLibrary& library,
            const ShaderSlots& slots, int targets);

  /// What follows temperatures, as the tables have it now.
  void updateTemperatures();

  /// Sorts what of `drawn` is in view.
  void order(const View& view, const WorldState& state, const std::vector<char>& drawn);
  bool isEmpty() const { return order_.pieces.empty(); }
  /// Nothing but fields is in view.
  bool isOfFields() const {
    return std::all_of(pieces_.begin(), pieces_.end(), [](const LayerPiece& p) { return p.field >= 0; });
  }

  /// What a blend goes over.
  struct Over {
    RenderTarget& spectrum;          ///< with the visibility pass' depth attached
    const RenderTarget& visibility;  ///< identity and depth of the solid scene
    int firstNode = 0;
    const View& view;                       ///< that it is a picture of
    const PixelClasses* covered = nullptr;  ///< what they leave out has the nearest depth of all, and nothing is to be drawn over it
  };
  /// Draws, view, lights and nodes are bound; changes the bound surface tables and the blend, cull and depth state's settings.
  void blend(const Over& over);

  /// Of all views since beginPicture(): the picture's own and those of small bodies; empty where nothing transparent was in them.
  void beginPicture() { faults_.reset(); }
  std::string describeOrder() const { return faults_ ? faults_->describe() : ""; }
  /// Those that the scenario's transparent things need: of surfaces, media, media in each other, meshed media.
  std::vector<NamedProgram> programs() const;

 private:
  struct Run {
    bool medium;
    std::uint32_t first, count;  ///< of order_.pieces
  };
  void drawLayers(const Run& run, const Over& over);
  void drawMedium(const LayerPiece& piece, const Over& over);
  void drawField(const LayerPiece& piece, const Over& over);
  void beginMedium(bool covered) const;
  void beginGroup(const Over& over);
  void setGroup(const std::vector<std::uint32_t>& draws) const;
  void drawThickness(const LayerPiece& piece, const Over& over);
  RenderTarget& sizedLike(std::deque<RenderTarget>& pool, const RenderTarget& target, std::size_t colours, bool depth = false) const;

  const Simulation& simulation_;
  const RenderTables& tables_;
  std::shared_ptr<const GpuScene> scene_;
  BlendPath path_, fewPath_, surfacePath_;  ///< of many surfaces; of media and few surfaces; of surfaces now
  SurfaceBuffers buffers_;
  Buffer sorted_, media_;
  std::unique_ptr<FieldDraws> fields_;  ///< null: none
  Program layer_, fewLayers_, volume_, group_, thickness_;
  std::vector<LayerPiece> pieces_;
  std::vector<std::vector<std::uint32_t>> groups_;
  LayerOrder order_;
  std::optional<OrderFaults> faults_;
  std::vector<Run> runs_;
  std::deque<RenderTarget> copies_, thicknesses_, groupDepths_;
};

}  // namespace pitviper
