#pragma once
// Writes down what the radiance of one line of sight is a sum of.
#include <glm/glm.hpp>

#include "sim/model/ray_hits.hpp"
#include "sim/model/sunlit_air.hpp"
#include "sim/plan/sights.hpp"

namespace pitviper {

class SightWriter {
 public:
  SightWriter(const Simulation& simulation, const Plan& plan, SightBook& book, const SightRay& ray, RayHits hits, Dice& dice);
  /// All of the pixel.
  Sight pixel();
  /// A light in a pixel of its own, past everything else; no terms where it is out.
  Sight lamp(size_t light, double pixel_sr);

 private:
  void air(Sight& sight, double range_m);
  void surface(Sight& sight, const Hit& hit);
  void reflected(Sight& sight, const Hit& hit, const Material& material, const double* modifier);
  void media(Sight& sight);
  void scattered(Sight& sight, const SunlitAir& line, size_t station, double cosScatter);
  int pathTo(double range_m, const AirAmounts& air);
  std::vector<double> mediaUpTo(double range_m) const;
  int planck(double temperature_K);
  int reflectance(const Material& material, size_t component, double viewAngle_rad);
  void add(Sight& sight, double range_m, SightTerm term);
  void addThermal(Sight& sight, double range_m, double temperature_K, SightTerm term);

  const Simulation& sim_;
  const Plan& plan_;
  SightBook& book_;
  const SightRay& ray_;
  RayHits hits_;
  Dice& dice_;
  AirRay airRay_;
  std::vector<size_t> scatterers_;  ///< absorbers of the air that scatter
  /// Transparent surfaces by distance, each with what it lets through: a spectrum and a modifier.
  struct Filter {
    double range_m;
    int transmittance;
    double modifier;
  };
  std::vector<Filter> filters_;
};

}  // namespace pitviper
