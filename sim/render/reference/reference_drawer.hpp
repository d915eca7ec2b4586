#pragma once
// Lines in double precision: the rasteriser says which triangle each sees; everything from there on is worked out on the CPU, at every wavelength of the plan,
// from the models themselves; no term left out. Zoomed views of small bodies are worked out where they bend, linear between within 2e-5 (ZoomedTile). Slow, for
// judging pictures.
#include <functional>
#include <optional>
#include <set>

#include "sim/radiance/node_sum.hpp"
#include "sim/render/geometry/raster_tracer.hpp"
#include "sim/render/line_drawer.hpp"
#include "sim/render/reference/reference_pixel.hpp"

namespace pitviper {

class ReferenceDrawer final : public LineDrawer {
 public:
  /// The simulation, the plan and the library must outlive it. `truth`: RawImage::truth is told, of an aperture.
  ReferenceDrawer(const Simulation& simulation, const Plan& plan, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene, bool truth,
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

  void setState(const WorldState&, const ShadowDemand*) override {}
  void draw(const View& view, const WorldState& state, const std::vector<char>& drawn) override;
  void startReadback(bool) override {}
  RawImage finishReadback() override { return std::move(image_); }

 private:
  void tellTruth(const View& view, const WorldState& state, const ReferenceShader& shader, const SeenLines& seen);
  const Simulation& simulation_;
  const Plan& plan_;
  bool truth_;
  double apertureArea_m2_;
  std::shared_ptr<const NodeSpectra> spectra_;
  RasterTracer tracer_;
  RawImage image_;
  std::function<void(double)> progress_;
  int views_ = 1, viewsDone_ = 0;
  std::optional<Part> only_;
  bool watches_ = false;
  std::set<Part> met_;
};

}  // namespace pitviper
