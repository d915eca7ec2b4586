#pragma once
// A square of sea whose waves are drawn one by one: heights by a Fourier sum over the wind's spectrum. Metres, x and y level, z up.
#include <cstdint>
#include <vector>

#include "sim/scene/mesh.hpp"
#include "sim/scene/wave_spectrum.hpp"

namespace pitviper {

/// The square repeats itself after its size. std::invalid_argument where a number is out of its range.
struct SeaPatch {
  double wind_m_s = 10.0;   ///< 10 m above the sea, as WaveSpectrum
  double windTo_rad = 0.0;  ///< where it blows to, from x towards y
  double inverseWaveAge = WaveSpectrum::kFullyDeveloped;
  double size_m = 200.0;    ///< side, 0.01 to 1e5 m: longer waves are left out
  int points = 256;         ///< along a side, a power of two from 4 to 2048: waves shorter than two steps are left out
  double time_s = 0.0;      ///< each wave travels at its own speed (waveFrequency_rad_s), within 90 degrees of the wind
  double choppiness = 0.0;  ///< 0 to 1: share of a first-order wave's level motion, which draws crests together and troughs apart; not skewed heights
  std::uint64_t seed = 0;
};

/// What a square holds at each of points x points places, x fastest, the first at -size/2, -size/2.
struct SeaField {
  std::vector<double> height_m, slopeX, slopeY;         ///< of the first-order surface, at the place
  std::vector<double> shiftX_m, shiftY_m;               ///< by which the place itself has moved; empty without choppiness
  std::vector<double> stretchXX, stretchYY, stretchXY;  ///< derivatives of the shift; empty without choppiness
};

/// Amplitude of wave (m, n), of wavenumbers 2 pi m / size and 2 pi n / size: complex and normally distributed, its mean square Psi (2 pi / size)^2.
/// It depends on the seed and on m and n, not on the number of points: more points add short waves to the same long ones.
/// Law: h = sum of A exp(i (k x - omega t)). Source: J. Tessendorf, Simulating Ocean Water, SIGGRAPH course (2001), equations 36 to 44, with all of Psi on
/// waves that go with the wind.
SeaField seaField(const SeaPatch& patch);

/// As a mesh of 2 points^2 triangles between (points + 1)^2 vertices, its normals those of the waves. heightField where no crest folds over.
/// `drawn` and `unresolved` add up to the spectrum's whole.
struct SeaMesh {
  Mesh mesh;
  WaveMoments nodes;       ///< of all places: expected from the spectrum, without choppiness
  WaveMoments drawn;       ///< of slopes between vertices, which reading them linearly takes short waves' slopes from
  WaveMoments unresolved;  ///< slopes that are left for the material's facets
};
SeaMesh makeSea(const SeaPatch& patch);

/// Only the expectations: nothing is drawn.
SeaMesh seaMoments(const SeaPatch& patch);

/// Mean square slope, both directions together, that a square of step_m between its places draws, whatever its size: for a material that lies on it.
/// Within 3 % of seaMoments().drawn where the square is longer than the longest waves.
double drawnSlope(const WaveSpectrum& spectrum, double step_m);

}  // namespace pitviper
