#pragma once
// Tables of a BRDF over wavelength and up to two angles as reflection components: alone, or as parts that lobes of one weigh.
#include <array>
#include <functional>
#include <memory>
#include <vector>

#include "sim/model/component.hpp"

namespace pitviper {

/// BRDF values [1/sr] at rising wavelengths [um] and equally spaced angles from 0, linear between, held beyond the last angle.
/// values[(a2 * count1 + a1) * wavelengths + w].
struct BrdfTable {
  std::vector<double> wavelength_um;
  std::array<AngleAxis, 2> axes;
  std::vector<double> values;
  /// OutsideSpectrum where it has no data.
  double at(double wavelength_um, double angle1_rad, double angle2_rad) const;
};

/// Directional-hemispherical reflectances of a table, linear between its rising view angles.
struct ViewAlbedo {
  std::vector<double> viewAngle_rad;
  std::vector<double> values;  ///< [view angle][wavelength of the table]
};

/// Values of each part's lobe for a light and a view, in a frame whose z is the normal.
using LobesAt = std::function<void(const glm::dvec3& light, const glm::dvec3& view, std::vector<double>& each)>;

/// Of parts with the same wavelengths and axes, in one walk over the hemisphere for each view: relative error as integrateHemisphere says;
/// `azimuths` as there.
std::vector<ViewAlbedo> albedosOf(const std::vector<BrdfTable>& parts, const LobesAt& lobesAt, int azimuths = 1);

/// A table by itself; its hemispherical reflectance is integrated numerically.
std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table);

/// A table times a lobe, with the reflectances that it then has. `lobeAt` as the lobe's shader.
std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table, ViewAlbedo albedo, Lobe lobe,
                                                   std::function<double(const glm::dvec3& light, const glm::dvec3& view)> lobeAt);

}  // namespace pitviper
