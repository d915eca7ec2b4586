#pragma once
// Smoke let out along a path: a trail of puffs that grow, rise, drift and thin out. Where each parcel is at a time follows in closed form from when and where
// it left, so that any time can be asked for without those before it.
//
// A parcel of age a, let out at P with the velocity u relative to the air (a share of its source's and what it is blown out with) in a stream of radius r0:
//   drift   P + wind a
//   jet     r_m^3 = r0^3 + 3 b r0^2 |u| a, carried by (r_m - r0)/b along u: its momentum stays, its radius grows by b times its way through the air.
//   rise    z = ((r0/b)^3 + 3 B (1 - cos(min(sqrt(s) a, pi)))/(b^2 s))^(1/3) - r0/b, and its radius with it: r_b = r0 + b z.
//           B = g r0^2 (1 - Ta/T0) w/U buoyancy per length [m3/s2]: w speed of the stream out of its source (that of the source through the air where nothing
//           is blown out), U of the source through the air, 1 m/s at least (below Briggs's formulas don't hold); s = (g/Ta)(g/cp - 0.0065 K/m) of the standard
//           troposphere. With r0 = 0: (3 B/(2 b^2))^(1/3) a^(2/3) at first, 2.6 (B/s)^(1/3) at last.
//   b = 0.6 for both. Source: G. A. Briggs, Plume rise predictions, in Lectures on Air Pollution and Environmental Impact Analyses (AMS 1975),
//           bent-over plumes; b: his, of buoyant ones, taken for momentum too.
//   mixing  by the turbulence of the air, sigma the standard deviation of a parcel's gas:  d sigma^2/da = 2 alpha e^(1/3) sigma^(4/3): the law of 4/3
//           (L. F. Richardson, Proc. R. Soc. London A 110 (1926) 709), e dissipation; until that diffusivity reaches K, then 2 K. At great age of the first
//           sigma^2 = g e a^3/6, g = 0.5 the constant of pairs (S. Ott, J. Mann, J. Fluid Mech. 422 (2000) 207): alpha = 1.5 (g/6)^(1/3) = 0.655.
//   together sigma^2 = that from sigma = r0/2 on, + (r_m^2 - r0^2)/4 + (r_b^2 - r0^2)/4: causes taken as independent; a uniform disc of radius r has r/2.
//   heat    T - Ta = (T0 - Ta)(r0/(2 sigma))^2: heat per length of trail stays.
//   end     over the last share of its lifetime a parcel's amount fades as 1 - 3 x^2 + 2 x^3; before that nothing is lost.
// Valid: trails whose radius is small against what the wind changes over; even wind, no chemistry, no fall of particles, air at rest around a calm source.
//
// The trail is cut into pieces, each a puff in its middle drawn out along the trail, of half-length L = max(R, l), 1/l^2 = 1/(12 R)^2 + 1/(s/4)^2, s the way to
// the nearer end of the trail, less where the trail bends by over 0.15 R within it; pieces are L/2 long at most. L varies slowly along the trail, so that
// pieces add up to an even column: ripple below 2.5 % (tests/unit/test_smoke.cpp), as are the changes where pieces are cut anew with time. Pieces are halves of
// halves of a grid in time. Where that takes more puffs than are allowed, all of these lengths grow by a factor.
#include <functional>
#include <memory>

#include "materials/fields/puffs.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/trajectory.hpp"

namespace pitviper {

struct SmokeOptions {
  // Where it comes from: an entity, a path of its own, or a fixed place.
  int entity = -1;
  int store = -1;  ///< index into Simulation::stores: path, begin_s and end_s are of what is ejected of it
  std::shared_ptr<const Trajectory> path;
  glm::dvec3 position{0.0};  ///< in its axes; of a fixed place in the local frame
  TimeCourse rate_kg_s;      ///< of the simulation's time
  double begin_s = 0.0, end_s = 1e9;
  double radius_m = 0.2;       ///< r0
  double temperature_K = 0.0;  ///< T0; that of the air at most if less
  glm::dvec3 blown_m_s{0.0};   ///< out of its source, in its axes
  double share = 0.0;          ///< of its source's velocity through the air that it leaves with
  bool rises = true;
  double dissipation_m2_s3 = 1e-3, diffusivity_m2_s = 5.0;
  double lifetime_s = 60.0, fadeShare = 0.4;
  int mostPuffs = 400;
  glm::dvec3 wind_m_s{0.0};
  double airWarmer_K = 0.0;  ///< than the standard atmosphere
};

/// A parcel at a time.
struct SmokeParcel {
  glm::dvec3 place{0.0};
  double sigma_m = 0.0, temperature_K = 0.0;
  double left = 1.0;  ///< share that hasn't faded
  double radius_m() const { return kPuffSupport * sigma_m; }
};

/// sigma of what turbulence mixes from sigma0 on: above, in closed form.
double mixedSigma_m(double sigma0_m, double age_s, double dissipation_m2_s3, double diffusivity_m2_s);

class SmokeSource : public FieldSource {
 public:
  /// Errors: std::invalid_argument for a radius, lifetime or number of puffs that is not above 0.
  explicit SmokeSource(SmokeOptions options);
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return kPuffsShader; }
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override;
  const SmokeOptions& options() const { return options_; }
  /// Let out at a time, seen at the world's.
  SmokeParcel parcel(const FieldWorld& world, double released_s) const;
  /// Let out between two times [kg].
  double released_kg(double from_s, double to_s) const;

 private:
  struct Trail;
  SmokeOptions options_;
};

}  // namespace pitviper
