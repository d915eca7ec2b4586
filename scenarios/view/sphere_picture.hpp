#pragma once
// A sphere of a material under one light, drawn on the CPU at once: what stands beside a curve that is dragged.
#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/model/channel.hpp"
#include "sim/model/material.hpp"

namespace pitviper {

/// A far lamp, and light from all around.
struct SphereLight {
  Spectrum irradiance{0.0};              ///< [W/(m2 um)] on a plane that faces it
  glm::dvec3 direction{0.0, 0.0, 1.0};   ///< towards it, of any length: x to the right, y up, z to the viewer
  std::optional<Spectrum> ambient = {};  ///< radiance [W/(m2 sr um)], the same from everywhere
};

/// value = integral of kernel(lambda) L(lambda) dlambda, as a camera's channels have it.
struct SphereChannel {
  std::string name, unit;
  Spectrum kernel{0.0};
};

/// A sensor's outputs that are integrals over wavelength alone (radiance, tristimulus, ...).
std::vector<SphereChannel> sphereChannels(const std::vector<ChannelOutput>& outputs);

/// The sphere seen from far away.
struct SphereView {
  int side = 512;                      ///< of the picture [pixels]
  double radius_px = 240.0;            ///< of the sphere
  glm::dvec2 centre_px{256.0, 256.0};  ///< from the picture's upper left corner; the sphere may reach beyond the picture
  double temperature_K = 300.0;
  double tolerance = 1e-3;  ///< of what a pixel's middle shows, or of a thousandth of the largest
};

class SpherePicture {
 public:
  /// Prepares all that does not depend on a material: keep it while a curve changes. UserError where view, light or channels are none, or the light
  /// is not known where a channel looks.
  SpherePicture(std::vector<SphereChannel> channels, SphereLight light, SphereView view);

  /// [channel][pixel], rows from the top: light of the lamp by the components' BRDF, of what is around by their hemispherical reflectance, and emissivity x
  /// Planck's law (left out of channels in which a black body has less than 1e-9 of the lamp's light). 0 beside the sphere. One value per pixel's middle: edges
  /// are hard. Textures count as 1, states that a texture drives as their first; of a temperature's states those beside it. What is seen through a material is
  /// left out. Runs on as many threads as there are cores. UserError where it is a medium or has no data where a channel has light.
  std::vector<std::vector<float>> draw(const Material& material) const;

  const std::vector<SphereChannel>& channels() const { return channels_; }
  const SphereView& view() const { return view_; }

 private:
  /// Directions at a lit pixel in a frame whose z is the normal and whose y is across the plane of view.
  struct Place {
    glm::dvec3 light;
    double viewX, viewZ;
  };
  struct Part;

  void place();
  Part part(const Material& material, double share) const;
  void add(const Part& part, std::size_t from, std::size_t to, std::vector<std::vector<float>>& pictures) const;

  std::vector<SphereChannel> channels_;
  SphereLight light_;
  SphereView view_;
  double difference_rad_ = 0.0;      ///< between light and half vector, everywhere the same
  std::vector<std::size_t> pixels_;  ///< that show the sphere; the lit ones first
  std::vector<Place> lit_;
  std::array<std::vector<float>, 7> angle_rad_;  ///< by kind, of `pixels_`; those that need the light of the lit ones alone
};

}  // namespace pitviper
