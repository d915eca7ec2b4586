#pragma once
// A cumulus as a field: drops on a grid, lit by sun, sky and ground as sim/radiometry/glsl/cloud.glsl has it.
#include <memory>
#include <mutex>
#include <optional>

#include "materials/fields/cumulus.hpp"
#include "sim/model/field.hpp"
#include "sim/model/medium.hpp"
#include "sim/model/sun_shade.hpp"

namespace pitviper {

struct CloudBodyOptions {
  CumulusShapeOptions shape;
  int across = 48;                             ///< nodes along x and y
  double mostDepth = 0.0;                      ///< largest vertical optical depth at 0.55 um; 0: as the shape has it
  double base_K = 288.15, lapse_K_m = 0.0065;  ///< of the drops: at the base, and what it falls by with height
};

/// The drops of a cloud, made when first asked for; it may stand in several places.
class CloudBody {
 public:
  explicit CloudBody(const CloudBodyOptions& options);
  /// One of a given grid, for tests.
  CloudBody(DensityGrid grid, double base_K, double lapse_K_m);
  const CloudBodyOptions& options() const { return options_; }
  /// Nodes, first of them, spacing; without values.
  const DensityGrid& frame() const { return frame_; }
  /// Extinction at 0.55 um [1/m]. Safe to ask from several threads.
  const DensityGrid& density() const;
  glm::dvec2 temperatures_K() const;
  void addTo(Fingerprint& fingerprint) const;

 private:
  CloudBodyOptions options_;
  DensityGrid given_, frame_;
  mutable std::once_flag once_;
  mutable DensityGrid density_;
};

/// The clouds of a scene under one sun: what shines in each, with the others before the sun, and what all take of it. Light is worked out when first asked for
/// and kept between runs by content. Safe to ask from several threads.
class CloudSet : public SunShade {
 public:
  /// `toSun`: unit; nothing: no sun. `shadows`: clouds stand before the sun of what is behind them.
  CloudSet(std::optional<glm::dvec3> toSun, bool shadows);
  /// `base`: middle of its base, in the local frame. Returns its number. Before anything is asked for. Errors: std::invalid_argument without a body.
  std::size_t add(std::shared_ptr<const CloudBody> body, const glm::dvec3& base);
  std::size_t size() const { return clouds_.size(); }
  const CloudBody& body(std::size_t cloud) const { return *clouds_[cloud].body; }
  const glm::dvec3& base(std::size_t cloud) const { return clouds_[cloud].base; }
  std::shared_ptr<const FieldTexels> texels(std::size_t cloud) const;
  /// The sun must be up.
  const SunShadeGrid& grid() const override;

 private:
  struct Cloud {
    std::shared_ptr<const CloudBody> body;
    glm::dvec3 base{0.0};
    std::shared_ptr<const FieldTexels> texels;
    bool alone = false;  ///< they are of one that nothing shades
  };
  /// Those that may stand between some of a cloud and the sun.
  std::vector<std::size_t> before(std::size_t cloud) const;
  std::shared_ptr<const FieldTexels> make(std::size_t cloud, const std::vector<std::size_t>& others) const;
  std::vector<float> depthBefore(std::size_t cloud, const std::vector<std::size_t>& others) const;
  SunShadeGrid makeGrid() const;
  std::optional<glm::dvec3> toSun_;
  bool shadows_;
  mutable std::mutex busy_;
  mutable std::vector<Cloud> clouds_;
  mutable std::once_flag once_;
  mutable SunShadeGrid grid_;
};

/// One that stands still.
class CloudSource : public FieldSource {
 public:
  CloudSource(std::shared_ptr<const CloudSet> clouds, std::size_t cloud, Droplets drops)
      : clouds_(std::move(clouds)), cloud_(cloud), drops_(std::move(drops)) {}
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return "materials/fields/glsl/cloud.field.glsl"; }
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override { return clouds_->body(cloud_).temperatures_K(); }
  const Droplets* droplets() const override { return &drops_; }

 private:
  std::shared_ptr<const CloudSet> clouds_;
  std::size_t cloud_;
  Droplets drops_;
};

/// The gas that a cloud's amounts are of, an optical depth at 0.55 um, by optics of single scattering at wavelengths.
struct DropOptics {
  std::vector<double> wavelength_um, extinction, albedo, asymmetry;  ///< extinction: over that at 0.55 um
};
Medium cloudGas(const DropOptics& optics);
Droplets dropletsOf(const DropOptics& optics, double height_m);

}  // namespace pitviper
