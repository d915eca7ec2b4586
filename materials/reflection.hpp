#pragma once
// The reflection components shipped: Lambertian, Phong, and tables over wavelength and up to two angles.
#include <memory>

#include "sim/model/component.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// f = rho(lambda) / pi.
std::shared_ptr<ReflectionComponent> makeLambertian(Spectrum reflectance);

/// f = rho(lambda) (n + 2) / (2 pi) cos^n(alpha); rho is the reflectance at normal view.
std::shared_ptr<ReflectionComponent> makePhong(Spectrum reflectance, double exponent);

/// BRDF values [1/sr] at rising wavelengths [um] and equally spaced angles from 0, linear between.
/// values[(a2 * count1 + a1) * wavelengths + w]; its hemispherical reflectance is integrated numerically.
struct BrdfTable {
  std::vector<double> wavelength_um;
  std::array<AngleAxis, 2> axes;
  std::vector<double> values;
};
std::shared_ptr<ReflectionComponent> makeTabulated(BrdfTable table);

struct ReflectionModel;
struct ParameterTable;
ReflectionModel lambertianModel();
ReflectionModel phongModel();
ReflectionModel tabulatedModel();
ReflectionModel microfacetModel();
ReflectionModel seaModel();
ReflectionModel spectralPhongModel();
ReflectionModel wardModel();
ReflectionModel sandfordRobertsonModel();
ReflectionModel beardMaxwellModel();
/// A layer of a stack of films.
const ParameterTable& filmLayerTable();

}  // namespace pitviper
