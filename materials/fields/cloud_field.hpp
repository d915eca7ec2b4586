#pragma once
// A cumulus as a field: drops on a grid, lit by sun, sky and ground as sim/radiometry/glsl/cloud.glsl has it.
#include <memory>
#include <mutex>

#include "materials/fields/cumulus.hpp"
#include "sim/model/field.hpp"
#include "sim/model/medium.hpp"

namespace pitviper {

struct CloudBodyOptions {
  CumulusShapeOptions shape;
  int across = 48;                             ///< nodes along x and y
  double mostDepth = 0.0;                      ///< largest vertical optical depth at 0.55 um; 0: as the shape has it
  double base_K = 288.15, lapse_K_m = 0.0065;  ///< of the drops: at the base, and what it falls by with height
};

/// A cloud's grid and light, made when first asked for and kept between runs by content; several may stand in several places.
class CloudBody {
 public:
  explicit CloudBody(const CloudBodyOptions& options);
  /// One of a given grid, for tests.
  CloudBody(DensityGrid grid, double base_K, double lapse_K_m);
  const CloudBodyOptions& options() const { return options_; }
  /// Of a world that always has the same sun. Safe to ask from several threads.
  std::shared_ptr<const FieldTexels> texels(const Simulation& simulation) const;
  /// Nodes, first of them, spacing; without values.
  const DensityGrid& frame() const { return frame_; }
  glm::dvec2 temperatures_K() const;
  void addTo(Fingerprint& fingerprint) const;

 private:
  std::shared_ptr<const FieldTexels> make(const Simulation& simulation) const;
  CloudBodyOptions options_;
  DensityGrid given_, frame_;
  mutable std::once_flag once_;
  mutable std::shared_ptr<const FieldTexels> texels_;
};

/// One that stands still. Errors: std::invalid_argument without a body.
class CloudSource : public FieldSource {
 public:
  /// `base`: middle of its base, in the local frame.
  CloudSource(std::shared_ptr<const CloudBody> body, const glm::dvec3& base, Droplets drops);
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return "materials/fields/glsl/cloud.field.glsl"; }
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override { return body_->temperatures_K(); }
  const Droplets* droplets() const override { return &drops_; }

 private:
  std::shared_ptr<const CloudBody> body_;
  glm::dvec3 base_;
  Droplets drops_;
};

/// The gas that a cloud's amounts are of, an optical depth at 0.55 um, by optics of single scattering at wavelengths.
struct DropOptics {
  std::vector<double> wavelength_um, extinction, albedo, asymmetry;  ///< extinction: over that at 0.55 um
};
Medium cloudGas(const DropOptics& optics);
Droplets dropletsOf(const DropOptics& optics, double height_m);

}  // namespace pitviper
