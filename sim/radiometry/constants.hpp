#pragma once
// SI 2019 exact constants, in the units used here (wavelength in um).
namespace pitviper {
constexpr double kPi = 3.14159265358979323846;
/// Planck constant [J s] and speed of light [m/s] (CODATA 2018, exact).
constexpr double kPlanckConstant = 6.62607015e-34;
constexpr double kLightSpeed = 299792458.0;
constexpr double kBoltzmann = 1.380649e-23;
/// First radiation constant for spectral radiance 2 h c^2 [W um4/(m2 sr)] and second radiation constant h c / k [um K].
constexpr double kFirstRadianceConstant = 2.0 * kPlanckConstant * kLightSpeed * kLightSpeed * 1e24;
constexpr double kSecondRadiation_umK = kPlanckConstant * kLightSpeed / kBoltzmann * 1e6;
/// Stefan-Boltzmann constant [W/(m2 K4)], 2 pi^5 k^4 / (15 h^3 c^2).
constexpr double kStefanBoltzmann = 5.670374419184429e-8;
/// Photons per joule and micrometre: lambda / (h c) = lambda_um * kPhotonsPerJoulePerUm.
constexpr double kPhotonsPerJoulePerUm = 1e-6 / (kPlanckConstant * kLightSpeed);
/// Maximum spectral luminous efficacy as used with V(lambda) [lm/W].
constexpr double kLuminousEfficacy = 683.0;
}  // namespace pitviper
