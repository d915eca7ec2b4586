#pragma once
// Light scattered by spheres, plain or coated, alone or in a distribution of sizes (Mie's theory).
//
// Law: S1 = sum of (2 n + 1) / (n (n + 1)) (a_n pi_n + b_n tau_n), S2 with a and b exchanged; a_n, b_n from what is continuous at the surfaces; time as
//   exp(-i omega t), so that k >= 0 in m = n + i k absorbs. Q_ext = 4 / x^2 Re S(0 deg), Q_sca = 2 / x^2 sum of (2 n + 1) (|a_n|^2 + |b_n|^2);
//   phase function of mean 1, P = 2 (|S1|^2 + |S2|^2) / (x^2 Q_sca) = sum of (2 l + 1) chi_l P_l.
// Cross sections and |S|^2 of a distribution are the sums of those of its spheres: no two of them shine on each other.
// Source: Bohren and Huffman 1983, Absorption and Scattering of Light by Small Particles, chapters 4 and 8 (signs as there); Wiscombe 1980, Appl. Opt. 19, 1505
//   (number of terms; more are summed here); Toon and Ackerman 1981, Appl. Opt. 20, 3657 and Yang 2003, Appl. Opt. 42, 1710 (shells by ratios that stay
//   bounded); de Rooij and van der Stap 1984, Astron. Astrophys. 131, 237 (moments by sums over two coefficients and 3j symbols); Schulten and Gordon 1975,
//   J. Math. Phys. 16, 1961 (3j symbols by recurrence); Hansen and Travis 1974, Space Sci. Rev. 16, 527 (sizes).
// Valid: spheres many wavelengths apart in a medium that does not absorb; x and m are relative to that medium. x from 1e-12 to 1e6, |m| from
//   1e-3 to 1e3, k at least 0. Anything else, or not finite: std::invalid_argument.
// Errors: against arithmetic of 60 digits or more 1e-12 of Q_ext, Q_sca and g, 1e-11 of backscatter, at x from 1e-6 to 1e4 and |m| to 140, shells as
//   well (these absorb 1e-16 x too much or too little, unless core and shell are clear); where m is close to 1, 3e-16 / |m - 1|. Against published
//   tables every digit that they hold (tests/unit/test_mie.cpp).
#include <complex>
#include <functional>
#include <vector>

namespace pitviper {

struct SphereScattering {
  double sizeParameter = 0.0;  ///< x = 2 pi radius / wavelength
  /// Efficiencies: cross sections over pi radius^2. backscatter = 4 |S(180 deg)|^2 / x^2: that of radars, 4 pi times the one per steradian.
  double extinction = 0.0, scattering = 0.0, backscatter = 0.0;
  double asymmetry = 0.0;                  ///< mean cosine of the phase function; 0 where nothing is scattered
  std::vector<std::complex<double>> a, b;  ///< n from 1 on, until 1e-16 is left
};

/// A sphere of refractive index m (k >= 0 absorbs).
SphereScattering sphereScattering(double x, std::complex<double> m);

/// A core of size parameter coreX, 0 to x, within a shell that ends at x.
SphereScattering coatedSphereScattering(double coreX, std::complex<double> coreM, double x, std::complex<double> shellM);

struct ScatteringAmplitudes {
  std::complex<double> s1, s2;  ///< across the plane of scattering and in it
};
ScatteringAmplitudes amplitudes(const SphereScattering& sphere, double cosine);

/// P at a cosine of the scattering angle; 1 where nothing is scattered.
double phaseFunction(const SphereScattering& sphere, double cosine);

/// chi_l for l below count; chi_0 = 1, chi_1 = asymmetry. Exact but for rounding, 1e-12; time as terms x count^2.
std::vector<double> legendreMoments(const SphereScattering& sphere, int count);

/// dn / d ln r as exp(-ln(r / median)^2 / (2 sigma^2)).
struct LogNormalMode {
  double medianRadius_um = 0.0;  ///< of the number of particles
  double sigma = 0.0;            ///< standard deviation of ln r: ln of the geometric standard deviation
  double number = 1.0;           ///< particles, beside those of other modes
};

/// dn / dr as r^power exp(-rate r^exponent), r in um (Deirmendjian 1969, Electromagnetic Scattering on Spherical Polydispersions).
struct ModifiedGamma {
  double power = 0.0, rate = 0.0, exponent = 1.0;
  /// Of an effective radius a and an effective variance b below 1/2: power (1 - 3 b) / b, rate 1 / (a b) (Hansen and Travis 1974).
  static ModifiedGamma of(double effectiveRadius_um, double effectiveVariance);
};

struct SizeSample {
  double radius_um = 0.0, density = 0.0;  ///< dn / dr, in any unit
};

/// How many particles there are of each radius.
class SizeDistribution {
 public:
  SizeDistribution(const std::vector<LogNormalMode>& modes);
  SizeDistribution(const ModifiedGamma& gamma);
  /// By rising radius; a power of r between neighbours, or, where one of them is 0, linear in ln r. None smaller or larger.
  SizeDistribution(const std::vector<SizeSample>& table);
  double density(double radius_um) const { return density_(radius_um); }  ///< [1/um] of one particle on average; of a table: as given
  bool smooth() const { return table_.empty(); }
  /// ln r between which a quadrature has to divide: of a table its radii; else evenly, over all that holds at least 1e-7 of geometric area, of what small
  /// spheres absorb (r^3) or of what they scatter (r^6).
  std::vector<double> knots(double wavelength_um) const;

 private:
  std::function<double(double)> density_;
  double low_ = 0.0, high_ = 0.0, width_ = 0.0;  ///< in ln r: beyond which nothing counts, and of the narrowest part
  std::vector<double> table_;                    ///< ln r
};

struct ParticleOptics {
  double extinction_um2 = 0.0;  ///< mean cross section of a particle
  double albedo = 0.0;          ///< single-scattering; 0 where nothing is taken away
  double asymmetry = 0.0;
  double effectiveRadius_um = 0.0;  ///< mean of r^3 over mean of r^2
  std::vector<double> moments;      ///< chi_l
  int spheres = 0;                  ///< that were summed
  double change = 0.0;              ///< the larger of what the last two doublings of their number changed, as a fraction
};

/// Particles of refractive index m, relative to the medium as the wavelength is in it; chi_l for l below moments.
/// Sizes: trapezoids in ln r (Simpson's rule between a table's radii). Their number is doubled until, twice running, extinction and scattering change by
/// less than the tolerance, as fractions, and asymmetry x scattering by less of scattering; or until there are 16384 spheres or 2e6 terms. Then change
/// stays above the tolerance: of large, clear spheres, whose resonances are narrower than any step. Errors seen at the tolerance of 1e-4: 1e-4 of all
/// three, 1e-7 where k is above 0.01; but 1 - albedo, where it is below 1e-3, to some per cent, for what hardly absorbs does so in its resonances.
ParticleOptics opticsOf(const SizeDistribution& sizes, std::complex<double> m, double wavelength_um, int moments, double tolerance = 1e-4);

}  // namespace pitviper
