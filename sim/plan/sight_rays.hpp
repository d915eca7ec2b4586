#pragma once
// Random lines of sight of a camera or a probe, over a scenario's time: as its film draws them, aimed at bodies, and those at the extremes.
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "sim/radiance/radiance.hpp"
#include "sim/world/world.hpp"

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

/// A line of sight at a time, and what it meets.
struct SightRay {
  std::shared_ptr<const WorldState> state;
  LineOfSight line;
  double nearest_m = 0.0;
  double pixel_sr = 0.0;  ///< about the solid angle of a subpixel
  int lamp = -1;          ///< a light that is seen in the same pixel
  bool fromFilm = true;   ///< drawn as the film draws pixels, not aimed at something
  bool glints = false;    ///< aimed at a glint: what is lit there is lit
};

class SightRays {
 public:
  /// Both must outlive it.
  SightRays(const Simulation& simulation, const Eye& eye, unsigned long long seed);
  /// The middle of a random subpixel of a random frame; of a probe a random direction.
  SightRay fromFilm();
  /// So many of them, one from each of as many parts of the subpixels of all frames, or of one, in their order: none is drawn twice before all have been.
  std::vector<SightRay> overFilm(int count, std::optional<int> frame = {});
  /// A random line of one of the combinations of things (surface, panes and media before it) that the film has, all alike often.
  SightRay ofCombination();
  /// At a random place of a random part of a body, so that what is small is not missed. Where the scenario states limits, half of them come from
  /// any range, see any temperature and levels of lights within them.
  SightRay aimed();
  /// Lines at random places of random bodies in view that are drawn by views of their own (Camera::smallBody_px), as these see them: the film's pixels hold
  /// them, but few of its middles. None where there are no such bodies.
  std::vector<SightRay> ofSmallBodies(int count);
  /// Through a place on the film.
  SightRay through(const FilmPlace& place);
  /// Of every combination: the nearest, the farthest, the most grazing, the most level, the longest way through media, the hottest and the coldest texel, the
  /// glints of the sun and of lamps;
  /// in the first and in the last frame; bodies and lamps at their nearest and farthest.
  const std::vector<SightRay>& extremes();
  Dice& dice() { return dice_; }
  /// Lines from here on are those of another seed. What was surveyed stays.
  void reseed(unsigned long long seed) { dice_ = Dice(seed); }

 private:
  struct Candidate {
    SightRay ray;
    std::vector<std::pair<int, int>> things;  ///< entity and surface, -1 for a medium; sorted
  };
  std::shared_ptr<const WorldState> stateAt(int frame);
  int someFrame();
  SightRay startAt(int frame);
  void point(SightRay& ray, const Pose& pose) const;
  bool turnToward(SightRay& ray, int frame, const glm::dvec3& line);
  SightRay filmRay(int frame);
  SightRay cameraRay(int frame, std::size_t column, std::size_t row);
  SightRay probeRay(int frame);
  std::optional<SightRay> aimedAt(int frame, size_t surface, bool withinLimits = true);
  std::optional<SightRay> aimedAtField(int frame, size_t field);
  bool isSmall(const SightRay& ray, const Entity& entity, const Pose& pose) const;
  std::vector<SightRay> lamps(int frame);
  std::vector<SightRay> beams(int frame);
  std::vector<int> framesOfLevels() const;
  std::vector<int> framesOfTemperatures(const Surface& surface) const;
  void findLifetimes();
  int frameWith(std::size_t surface);
  void cast(SightRay& ray) const;
  int frameOf(double time_s) const;
  void survey();
  void findNearAndFar();
  std::array<double, 9> figuresOf(const SightRay& ray) const;
  void findExtremes();
  /// Where a light glints most on a surface (entity and surface), about; none where it does not.
  std::optional<SightRay> glint(const std::vector<size_t>& combination, std::pair<int, int> surface, size_t light);
  void findGlints(const std::vector<size_t>& combination);
  Candidate candidate(SightRay ray) const;
  glm::dvec3 placeOn(const WorldState& state, size_t surface);
  void stretch(SightRay& ray, double distance_m);
  bool inView(const SightRay& ray, const glm::dvec3& direction) const;

  const Simulation& simulation_;
  Eye eye_;
  Dice dice_;
  std::vector<char> drawn_;                          ///< one flag per entity: a camera does not see the body it rides on
  std::vector<std::pair<size_t, size_t>> surfaces_;  ///< entity and surface
  std::vector<std::pair<int, int>> lifetimes_;       ///< first and last frame in which an entity may be there; last < first: in none
  std::vector<Candidate> candidates_;
  std::vector<std::vector<size_t>> combinations_;  ///< candidates of each
  std::vector<SightRay> extremes_;
  std::map<int, std::shared_ptr<const WorldState>> states_;  ///< by frame, some
};

}  // namespace pitviper
