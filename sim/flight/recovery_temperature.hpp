#pragma once
// What air heats a skin to that it flows along and that gives off no heat.
namespace pitviper {

enum class BoundaryLayer { Laminar, Turbulent };

/// Recovery factor r: Pr^(1/2) laminar, Pr^(1/3) turbulent, with Pr = 0.71 of air: 0.843 and 0.892.
/// Source: White, Viscous Fluid Flow, sections 4-3.2 and 7-4 (flat plate; compressible boundary layers); Schlichting and Gersten, Boundary-Layer Theory, ch. 9
/// and 19.
double recoveryFactor(BoundaryLayer layer);

/// T_r = T (1 + r (gamma - 1)/2 M^2) [K], gamma = 1.4.
/// Source: as above; r = 1 is the total temperature (NACA Report 1135, equation (43)).
/// Valid: attached flow, Mach 0 to about 5 (air of constant heat capacity; at Mach 5 in the stratosphere the total temperature is 2 % too high), a skin that
/// neither radiates nor conducts: a true skin is colder.
double recoveryTemperature_K(double airTemperature_K, double mach, BoundaryLayer layer);

/// The same in the standard atmosphere, for a speed relative to the air.
double recoveryTemperatureAt_K(double height_m, double airSpeed_m_s, BoundaryLayer layer);

}  // namespace pitviper
