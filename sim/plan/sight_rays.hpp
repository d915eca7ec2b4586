#pragma once
// Random lines of sight of a camera or a probe, over a scenario's time.
#include <random>
#include <vector>

#include "sim/model/simulation.hpp"

namespace pitviper {

/// What looks at the scene.
struct Eye {
  const Camera* camera = nullptr;
  const Probe* probe = nullptr;
};

/// The same numbers on every machine, which the standard's distributions are not.
class Dice {
 public:
  explicit Dice(unsigned long long seed) : engine_(seed) {}
  double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }  ///< in [0, 1)
  size_t below(size_t count) { return std::min(static_cast<size_t>(unit() * static_cast<double>(count)), count - 1); }

 private:
  std::mt19937_64 engine_;
};

struct SightRay {
  WorldState state;
  glm::dvec3 origin{0.0}, direction{0.0, 0.0, 1.0};
  double nearest_m = 0.0;
  double temperature_K = 0.0;  ///< of bodies without a temperature texture; 0: their own
  bool fromFilm = true;        ///< evenly over the film, not aimed at something
};

class SightRays {
 public:
  /// Both must outlive it.
  SightRays(const Simulation& simulation, const Eye& eye, unsigned long long seed);
  /// Half of them evenly over the film, half aimed at a random place of a random part of a body, so that what is small is not missed. Where the
  /// scenario states limits, half of the aimed ones come from any range, see any temperature and levels of lights within them.
  SightRay draw();
  /// About the solid angle of a subpixel.
  double pixel_sr() const;
  /// One flag per entity: a camera does not see the body it rides on.
  const std::vector<char>& drawn() const { return drawn_; }
  Dice& dice() { return dice_; }

 private:
  glm::dvec3 placeOn(const WorldState& state, size_t surface);
  void stretch(SightRay& ray, double distance_m);
  bool inView(const SightRay& ray, const glm::dmat3& localFromCamera, const glm::dvec3& direction) const;

  const Simulation& simulation_;
  Eye eye_;
  Dice dice_;
  std::vector<char> drawn_;
  std::vector<std::pair<size_t, size_t>> surfaces_;  ///< entity and surface
};

}  // namespace pitviper
