#pragma once
// What every mode of drawing shares: a visibility pass (which triangle each pixel sees), then spectral shading once per visible pixel.
// Speed does not depend on how much is hidden. Direct mode and buffered mode differ in what shading leaves behind.
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>

#include "sim/render/assembly/air_on_gpu.hpp"
#include "sim/render/assembly/light_patterns.hpp"
#include "sim/render/assembly/named_program.hpp"
#include "sim/render/assembly/surface_buffers.hpp"
#include "sim/render/assembly/tables.hpp"
#include "sim/render/geometry/gpu_scene.hpp"
#include "sim/render/geometry/pixel_classes.hpp"
#include "sim/render/geometry/solid_pass.hpp"
#include "sim/render/geometry/view_data.hpp"
#include "sim/render/line_drawer.hpp"
#include "sim/render/resolve_pass.hpp"
#include "sim/render/shadow/shadow_pass.hpp"
#include "sim/render/shared_shading.hpp"
#include "sim/render/surface/light_relevance.hpp"
#include "sim/render/surface/shading_program.hpp"
#include "sim/render/surface/surface_classes.hpp"
#include "sim/render/surface/surroundings_buffer.hpp"

namespace pitviper {

class ScenePass : public LineDrawer {
 public:
  /// Shadows and the light from all around are from here on one with those of another pass of the same plan, which is told the same states.
  void shareLight(const ScenePass& other);
  /// Tables of the air that another pass has worked out, which was made of the same air, lights, ground and plan.
  void takeAir(ScenePass& before) {
    if (air_ && before.air_) air_->takeTables(*before.air_);
  }
  void setState(const WorldState& state, const ShadowDemand* demand = nullptr) override;
  void draw(const View& view, const WorldState& state, const std::vector<char>& drawn) override;
  void drawTiles(const std::vector<View>& views, const WorldState& state, const std::vector<char>& drawn,
                 const std::function<void(std::size_t, const RawImage&)>& take) override;
  void startReadback(bool identity = false) override;
  RawImage finishReadback() override;
  /// What a picture is drawn with besides the visibility pass, in order: shadow maps, shading, truth, transparent things, integration.
  virtual std::vector<NamedProgram> programs() const;
  const RenderTables& tables() const { return tables_; }

  /// As draw(), for a moving scene's first picture: shades nothing, but adds what shades it, and all that may come into view, to what is made together.
  void rehearse(const View& view, const WorldState& state, const std::vector<char>& drawn, FirstDraws& first);

 protected:
  /// Direct: in the shader, so that air is integrated over the channels beforehand; buffered: after it.
  enum class Shading { Direct, Buffered };
  /// The simulation, the plan and the library must outlive it. `shading`: where the spectral integral is done; `classes`: each class of surfaces by a program
  /// of its own.
  ScenePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
            double apertureArea_m2, Shading shading, bool classes);
  /// Shades what `visibility` shows into `into`: channel groups first, then truth. Buffers, textures and state are bound;
  /// the target is not. Where only one entity is shaded the target has been cleared.
  virtual void shade(RenderTarget& into, const RenderTarget& visibility) = 0;
  /// The same for one part (corner, size) of the target, where pixels of these classes are; cleared, and its depth is for the classes.
  virtual void shadeTile(RenderTarget&, const glm::ivec4&, const std::set<std::size_t>&) {}
  /// Only one entity is shaded: what was cleared stays elsewhere.
  bool isPartial() const { return partial_; }
  bool isOfWholePixels() const { return wholePixels_; }
  /// What is shaded is a picture of.
  const View& view() const { return shadedView_; }
  /// The tables follow other temperatures than before.
  virtual void onTemperatures() {}
  /// Whether this mode can shade several pixels as one where a view allows it (View::grouped).
  virtual bool sharesShading() const { return false; }
  /// What a mode has in a view besides the draws of the tables, which stand before its own.
  virtual void place(const View&, const WorldState&, const std::vector<char>&, std::vector<GpuDraw>&) {}
  /// The channels that whole pixels had before transparent things were drawn over them; null where there are none.
  virtual const RenderTarget* withoutTransparent() const { return nullptr; }
  /// What is transparent in view is drawn over whole pixels as it is on average over each.
  virtual bool transparentIsAveraged() const { return false; }
  /// Pixels that have been shaded as one are left out of what is shaded from here on, of this picture.
  virtual void leaveOut(RenderTarget&) {}

  const Plan& plan() const { return plan_; }
  bool drawsMore() const { return simulation_.drawsMore(); }
  const AirOnGpu* air() const { return air_.get(); }
  bool hasTruth() const { return truth_; }
  /// Classes of what is solid.
  const std::vector<SurfaceClass>& surfaceClasses() const { return surfaceClasses_; }
  /// Those that the current view may show.
  const std::set<std::size_t>& classesInView() const { return classesInView_; }
  /// Null: it draws.
  FirstDraws* rehearsal() const { return rehearsal_; }
  /// Of the picture's pixels, found before shade().
  const PixelClasses& pixelClasses() const { return pixelClasses_; }
  /// Slots and structural constants of this plan's shading programs, without targets, truth and integral.
  /// `writtenOut`: nodes are named by numbers, none by a loop.
  ShaderSlots shadingSlots(bool writtenOut) const;
  void addLightSlots(ShaderSlots& slots) const;
  bool isShaded() const { return simulation_.sunShade && plan_.lightCount > 0; }
  /// Of what finds pixels' classes.
  ShaderSlots classSlots(bool classes) const;
  /// Names of the channel targets, and of the truth targets, in order.
  std::vector<std::string> channelTargets() const;
  static std::vector<std::string> truthTargets() { return {"truthGeometry", "truthNormal", "truthIdentity"}; }
  void bindBuffers() const;
  std::shared_ptr<const GpuScene> sharedScene() const { return scene_; }

 private:
  struct Targets {
    RenderTarget visibility, shading;
  };
  struct Tile;
  GpuDraw drawOf(std::size_t draw, const View& view, const WorldState& state) const;
  void uploadLights(const WorldState& state);
  void findClassesIn(const View& view, const WorldState& state, const std::vector<char>& drawn);
  void clearShading();
  std::optional<SharedPixels> shadeTogether(const View& view);
  std::vector<Tile> tilesOf(std::span<const View> views, const WorldState& state, const std::vector<char>& drawn);
  void bindTile(std::size_t i) const;
  void drawTilePicture(const std::vector<Tile>& tiles, const WorldState& state);
  RawImage cut(const Readback::Pixels& picture, const Tile& tile) const;
  Targets& targetsFor(int width, int height);

  const Simulation& simulation_;
  const Plan& plan_;
  const ShaderLibrary& library_;
  std::shared_ptr<const GpuScene> scene_;
  bool truth_;
  double apertureArea_m2_;
  LightPatterns patterns_;
  RenderTables tables_;
  std::vector<SurfaceClass> surfaceClasses_;
  std::set<std::size_t> classesInView_;
  struct LightNeeds {
    bool sunAlone = true;  ///< no lamp may matter to some of it
    bool lamps = false;    ///< one may
    bool shadows = false;  ///< something may stand between some of it and a light that matters
  };
  std::vector<LightNeeds> lightNeeds_;   ///< of each entity
  std::optional<SharedShading> shared_;  ///< made when first needed
  PixelClasses pixelClasses_;
  SurfaceBuffers solid_;
  SolidPass solids_;
  LightRelevance relevance_;
  Buffer sunShade_;                             ///< where clouds of drops stand before the sun
  std::shared_ptr<SurroundingsBuffer> around_;  ///< where ambient light has directions
  std::unique_ptr<AirOnGpu> air_;               ///< null: none
  std::shared_ptr<ShadowPass> shadows_;         ///< where the plan has them
  Buffer nodes_, draws_, lights_, view_, pixelView_, tileDraws_;
  std::vector<Buffer> tileViews_;
  std::deque<std::pair<std::pair<int, int>, Targets>> targets_;  // references stay valid
  Targets* current_ = nullptr;
  bool partial_ = false, warm_ = false;
  FirstDraws* rehearsal_ = nullptr;
  bool wholePixels_ = false;  ///< pixels are shaded, not their subpixels
  View shadedView_;
  std::optional<ResolvePass> resolve_;      ///< made when first needed
  const RenderTarget* truthOf_ = nullptr;   ///< where truth is by itself
  const RenderTarget* resolved_ = nullptr;  ///< of the last drawn image, where it was
  View drawn_;
  Readback readback_, keptReadback_, truthReadback_;
};

/// A pass in the mode the scenario asks for. `classes`: as ScenePass's.
std::unique_ptr<ScenePass> makeScenePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene,
                                         bool truth, double apertureArea_m2, bool classes = true);

}  // namespace pitviper
