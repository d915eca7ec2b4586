#pragma once
// The reflection models shipped, and the two components that tests make by themselves.
#include <memory>

#include "sim/model/component.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// f = rho(lambda) / pi.
std::shared_ptr<ReflectionComponent> makeLambertian(Spectrum reflectance);

/// f = rho(lambda) (n + 2) / (2 pi) cos^n(alpha); rho is the reflectance at normal view.
std::shared_ptr<ReflectionComponent> makePhong(Spectrum reflectance, double exponent);

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
ReflectionModel measuredModel();
/// A layer of a stack of films.
const ParameterTable& filmLayerTable();

}  // namespace pitviper
