#pragma once
// The same pixel in double precision on the CPU: geometry by rays or from the visibility pass, radiance by sim/radiance from the models themselves. The one
// table between is that of black bodies of air (NodeSpectra). For the reference mode, audits and tests.
#include <vector>

#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/radiance/shadow_rays.hpp"
#include "sim/render/geometry/raster_tracer.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

struct ReferencePixel {
  std::vector<double> slots;     ///< integrals of kernel x radiance
  std::vector<double> radiance;  ///< per node [W/(m2 sr um)]
  int entity = -1;
  int surface = -1;
  double range_m = 0.0;
};

/// Many pixels of one view; pixels may be asked for from several threads, each with a sum of its own over spectra().
class ReferenceShader {
 public:
  /// All must outlive it. `drawn`: one flag per entity, what is left out neither shows nor lets less through (it still casts shadows).
  /// `spectra`: of the plan's nodes, where they are at hand; null: made here.
  ReferenceShader(const Simulation& simulation, const Plan& plan, const View& view, const WorldState& state, const std::vector<char>& drawn,
                  std::shared_ptr<const NodeSpectra> spectra = nullptr);
  /// The centre of pixel (x, y), counted from the lower left: what a ray meets.
  ReferencePixel pixel(int x, int y, NodeSum& sum) const;
  /// Air is looked at in so many places besides those where something begins (RadianceScene::airPlaces).
  void setAirPlaces(int places) { airPlaces_ = places; }
  ReferencePixel pixel(int x, int y) const;
  /// One place of the film [pixels from the lower left]: textures are read there, not over a pixel.
  ReferencePixel place(double x, double y, NodeSum& sum) const;
  /// The line of sight of the same, given which triangles all lines of the view meet; and what comes along a line.
  LineOfSight line(int x, int y, const SeenLines& seen) const;
  ReferencePixel shade(const LineOfSight& line, NodeSum& sum) const;
  /// The same of a pixel whose middle the line goes through: over several lines through the fields that it passes, where they are finer than it.
  ReferencePixel shadeOver(LineOfSight line, int x, int y, NodeSum& sum) const;
  /// The same number, not 0, for lines that meet the same surface through the same panes and media.
  static std::size_t things(const RayHits& hits);
  /// The same number, not 0, for lines between which radiance changes smoothly: the same things, lit by the same lights, which glint about as strongly.
  std::size_t looks(const LineOfSight& line) const;

  const NodeSpectra& spectra() const { return *spectra_; }

 private:
  RadianceScene scene() const;
  LineOfSight lineThrough(double x, double y) const;
  static void addStretches(std::vector<Hit> borders, std::vector<Stretch>& stretches);
  /// What a pixel, whose middle is there, covers of the textures it sees.
  void addFootprints(LineOfSight& line, double x, double y) const;
  double nearest_m(double x, double y) const;
  const Simulation& simulation_;
  const Plan& plan_;
  const View& view_;
  const WorldState& state_;
  const std::vector<char>& drawn_;
  bool transparent_;
  int airPlaces_ = 0;
  std::vector<FieldLines> fields_;  ///< of those that are there
  ShadowCaster shadows_;
  std::shared_ptr<const NodeSpectra> spectra_;
};

}  // namespace pitviper
