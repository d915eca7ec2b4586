#pragma once
// The spectral Phong component, made while a hand draws its curves: materials/spectral_phong.cpp's law without the seconds that its albedo tables take.
#include <memory>

#include "sim/model/component.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {

/// Directional-hemispherical reflectance of Phong's lobe of unit reflectance at normal view:
///   A = cos(theta) (1 - sin^(n+2) theta) + (n + 2) / pi integral_0^sin(theta) c^n (phi c cos(theta) + sqrt(sin^2 theta - c^2)) dc,
/// cos phi = -c cos(theta) / (sin(theta) sqrt(1 - c^2)): rings about the mirrored direction, whole above the horizon in closed form, the cut ones by 32
/// points. 1 at most, at normal view. Error below 1e-5.
double phongLobeAlbedo(double exponent, double viewAngle_rad);

/// f = diffuse / pi + specular (n + 2) / (2 pi) cos^n(alpha): axes, columns and, within 1e-3 of `specular`, reflectance of the reader's. Microseconds but for
/// the first, which takes some 10 ms.
std::shared_ptr<ReflectionComponent> makeEditedPhong(Spectrum diffuse, Spectrum specular, Spectrum exponent);

}  // namespace pitviper
