#pragma once
// Draws one camera of a simulation at a time: everything between a world state and an image of integrals.
#include <functional>
#include <memory>

#include "sim/camera/hot_parts.hpp"
#include "sim/camera/overlay.hpp"
#include "sim/camera/subpixels.hpp"
#include "sim/camera/visible_lights.hpp"
#include "sim/render/buffered_pass.hpp"
#include "sim/render/direct_pass.hpp"
#include "sim/render/reference/reference_drawer.hpp"

namespace pitviper {

/// Part of the time (sim/gl/timing.hpp) in which a camera's plan is made, or found again.
inline constexpr const char* kPlanningPart = "planning";

/// A camera's plan, made or found again. `planning`: told while it is made.
/// `earlier`: as planFor()'s.
Plan cameraPlan(const Simulation& simulation, const Camera& camera, const std::function<void(double share)>& planning = {}, const Plan* earlier = nullptr);

class CameraRenderer {
 public:
  /// The simulation, camera and library must outlive it. `plan`: cameraPlan() the camera. Needs a current GlContext.
  CameraRenderer(const Simulation& simulation, const Camera& camera, Plan plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene);
  CameraRenderer(const CameraRenderer&) = delete;
  CameraRenderer& operator=(const CameraRenderer&) = delete;

  /// What another's air was found to be, of the same air, lights, ground and plan; before the first picture.
  void takeAir(CameraRenderer& before);
  /// Draws and begins reading back; the caller may do other work before finish().
  void begin(const WorldState& state);
  CameraImage finish();
  /// What another's pictures of this film at this focal length had, instead of its own.
  void setSolidAngles(std::shared_ptr<const Pinhole::SolidAngles> angles, double focalLength_m) {
    solidAngles_ = std::move(angles);
    focalLength_m_ = focalLength_m;
  }
  /// Only these pixels are wanted of the pictures that follow (row x width + column, row 0 at the top); the others come out dark. Reference mode.
  void setWanted(const std::vector<int>& pixels);
  /// Reference mode: the pictures that follow are of one part alone (all parts add up to the whole); without one of all.
  void setOnly(const std::optional<Part>& only);
  /// Reference mode: the parts that the wanted pixels of pictures after watchParts() are made of, with those lamps that are seen in the last one.
  std::set<Part> parts() const;
  void watchParts();
  CameraImage render(const WorldState& state) {
    begin(state);
    return finish();
  }
  const Plan& plan() const { return plan_; }
  /// Reference mode: called now and then on the drawing thread with the share of the picture that is done, 0 to 1. The other modes never call it.
  void setProgress(std::function<void(double share)> progress);
  /// The bright parts of the next pictures, as another plan chose them: a picture is held against one of the same views.
  void setParts(std::vector<Ball> parts) { given_ = std::move(parts); }
  /// Of the mode that the last frame was drawn in.
  bool isBuffered() const { return buffered_ && drawer_ == buffered_.get(); }

 private:
  bool seesTransparent() const;
  void warmUp(const ShadowDemand& demand, const std::vector<char>& drawn);
  int viewsOfPicture() const;
  double zoomedLinesOn(std::size_t entity) const;
  WorldState lampsInView() const;
  const Simulation& simulation_;
  const Camera& camera_;
  Plan plan_;
  std::vector<AveragedFringes> fringes_;
  WaysToLights ways_;
  FilmWeights filmWeights_;
  std::vector<int> lines_;               ///< across each small body
  std::vector<glm::dvec3> areas_m2_;     ///< facingAreas()
  std::unique_ptr<const Plan> linesOf_;  ///< of a reference: the plan whose lines it looks along, if one was given
  HotParts hotParts_;
  std::optional<std::vector<Ball>> given_;
  bool warm_ = false;                           ///< both passes have drawn
  std::vector<Ball> parts_;                     ///< bright ones of the picture
  std::unique_ptr<ReferenceDrawer> reference_;  ///< instead of the other two
  std::unique_ptr<DirectPass> direct_;          ///< both where auto has to choose frame by frame
  std::unique_ptr<BufferedPass> buffered_;
  LineDrawer* drawer_ = nullptr;    ///< of the picture, or of its overlay and small bodies
  std::optional<Overlay> overlay_;  ///< over the direct pass' picture
  WorldState state_;
  View view_;
  std::optional<Part> only_;
  std::vector<char> small_, present_;
  std::shared_ptr<const std::vector<char>> wanted_;  ///< one flag per subpixel, row 0 at the bottom; null: all
  std::shared_ptr<const Pinhole::SolidAngles> solidAngles_;
  double focalLength_m_ = 0.0;  ///< that these are of
};

}  // namespace pitviper
