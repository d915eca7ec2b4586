#pragma once
// The third mode of drawing: the visibility pass says which triangle each subpixel sees; everything from there on is double precision on the
// CPU, at every wavelength of the plan, from the models themselves; no term left out. Zoomed views of small bodies are worked out where they bend, linear
// between within 2e-5 (ZoomedTile). Slow, for judging the other two.
#include <functional>

#include "sim/radiance/node_sum.hpp"
#include "sim/render/scene_pass.hpp"

namespace pitviper {

class ReferencePass final : public ScenePass {
 public:
  ReferencePass(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
                double apertureArea_m2);
  /// Called now and then on the drawing thread with the share of a picture that is done, 0 to 1.
  void setProgress(std::function<void(double share)> progress) { progress_ = std::move(progress); }
  /// Pictures from here on are of one part alone, which is linear in all of them; without one of all.
  void setOnly(const std::optional<Part>& only) { only_ = only; }
  /// The parts that were met since watchParts() was called.
  const std::set<Part>& met() const { return met_; }
  void watchParts() { watches_ = true; }
  /// A picture begins, of about so many views: its own and those of its small bodies.
  void beginPicture(int views);
  /// It is done, whatever it took.
  void endPicture() const;

 private:
  void beforeShading(const View& view, const WorldState& state, const std::vector<char>& drawn) override;
  void shade(RenderTarget& into, const RenderTarget& visibility) override;

  const Simulation& simulation_;
  std::shared_ptr<const NodeSpectra> spectra_;
  ShadingProgram truthProgram_;
  View view_;
  WorldState state_;
  std::vector<char> drawn_;
  std::function<void(double)> progress_;
  int views_ = 1, viewsDone_ = 0;
  std::optional<Part> only_;
  bool watches_ = false;
  std::set<Part> met_;
};

}  // namespace pitviper
