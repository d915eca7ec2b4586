#pragma once
// Light in plane layers that scatter it any number of times, by adding and doubling.
//
// Law: mu dI/dt = I - (w / 4 pi) integral of P I over the sphere - (w / 4 pi) P(sun) F - (1 - w) B,
//   I radiance without the sun itself [W/(m2 sr um)]; t optical depth, downwards; mu sine of the elevation it goes on to; w single-scattering albedo; P phase
//   function of mean 1, P = sum of (2 l + 1) chi_l P_l; F irradiance that comes straight from the sun; B black body's radiance, linear in t within a layer.
//   Ground: sends groundEmission and albedo / pi of what falls on it, evenly (Lambert). Space: sends spaceRadiance from all sides.
// In azimuth I = sum of I_m cos(m phi); over mu by Gauss points of each hemisphere; forward peaks beyond the last moment are taken as not scattered (delta-M).
// Source: van de Hulst 1980, Multiple Light Scattering, chapter 4; Wiscombe 1976, J. Quant. Spectrosc. Radiat. Transfer 16, 637 (first thin layer: diamond);
//   Wiscombe 1977, J. Atmos. Sci. 34, 1408 (delta-M); Stamnes, Tsay, Wiscombe and Jayaweera 1988, Appl. Opt. 27, 2502 (azimuth, double Gauss).
// Valid: layers that do not end sideways. Scalar: without polarisation, by which skies of molecules differ up to 11 % sent back and 17 % let through (depth 1;
//   Natraj, Li and Yung 2009).
// Errors: against published tables and closed forms in tests/unit/test_adding_doubling.cpp; the same tests say what streams and azimuths lose.
#include <span>
#include <vector>

namespace pitviper {

struct PlaneLayer {
  double depth = 0.0;                         ///< optical, of all extinction
  double albedo = 0.0;                        ///< single-scattering, 0 to 1
  std::vector<double> moments;                ///< chi_l from l = 0 on, chi_0 = 1; those not given are 0
  double blackAbove = 0.0, blackBelow = 0.0;  ///< B at its edges
};

struct PlaneLayers {
  std::vector<PlaneLayer> layers;  ///< from the top down
  double sunSine = 1.0;            ///< of the sun's elevation; below 0 it shines from below
  double irradiance = 0.0;         ///< of the sun above all layers, on a plane that faces it [W/(m2 um)]
  std::vector<double> sunDepth;    ///< optical depth to the sun at each edge, from the top down; INFINITY: none of it gets there; empty: depth above / sunSine
  double groundAlbedo = 0.0, groundEmission = 0.0, spaceRadiance = 0.0;
};

struct Streams {
  int all = 8;       ///< Gauss points, both hemispheres together; even, 64 at most
  int azimuths = 8;  ///< terms cos(m phi), m from 0 on: at most as many as streams
  /// Depth of the first thin layer, in sines of the flattest stream: what it loses, thin^2 / 12, is 2e-6 of what that stream has.
  double thin = 0.005;
  std::vector<double> sines{};  ///< further directions at which radiance is asked for: of elevations above 0, the same below
};

/// Light at the edges of the layers, from the top down, by what sends it: the sun, or what is warm.
class LayerLight {
 public:
  struct Shape {
    int streams = 0, azimuths = 0;
    /// Moments of one edge: m from 0 on, in each l from m on.
    int moments() const { return azimuths * streams - azimuths * (azimuths - 1) / 2; }
    int at(int l, int m) const { return m * streams - m * (m - 1) / 2 + l - m; }
  };
  Shape shape;
  /// Of each edge, M_lm = integral over the sphere of I_m Lambda_lm(mu) dmu x 2 pi; thermal: m = 0 alone. What layers turn of it towards (mu, phi) is, per
  /// optical depth of scattering, sum of chi_l (2 l + 1) / (4 pi) cos(m phi) Lambda_lm(mu) M_lm: all light but that straight from the sun.
  std::vector<double> solar, thermal;
  /// Of each edge: of the streams, then of the directions asked for: radiance per azimuth term [edge][term][direction].
  std::vector<double> sines;
  std::vector<double> solarUp, solarDown, thermalUp, thermalDown;
  /// Irradiance on a level plane [W/(m2 um)], without the sun itself.
  std::vector<double> fluxUp, fluxDown;

  std::span<const double> solarAt(std::size_t edge) const {
    return std::span(solar).subspan(edge * static_cast<std::size_t>(shape.moments()), static_cast<std::size_t>(shape.moments()));
  }
  std::span<const double> thermalAt(std::size_t edge) const {
    return std::span(thermal).subspan(edge * static_cast<std::size_t>(shape.streams), static_cast<std::size_t>(shape.streams));
  }
};

LayerLight lightIn(const PlaneLayers& layers, const Streams& streams);

/// Lambda_lm(mu) of one m, l from m on and below `count`, 64 at most.
void legendreTerms(double mu, int m, int count, double* into);

/// (2 l + 1) / (4 pi) cos(m phi) Lambda_lm(mu) in the order of LayerLight::Shape, Lambda = sqrt((l - m)! / (l + m)!) P_l^m without the sign (-1)^m.
void turnedTo(double mu, double cosAzimuth, const LayerLight::Shape& shape, std::span<double> into);

}  // namespace pitviper
