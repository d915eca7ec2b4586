#pragma once
// Small bright parts of large bodies (a nozzle of one pixel): where the outline of one, as the picture's subpixels have it, would put the body's intensity off,
// it is sampled by a zoomed view of its own, as fine as that takes.
#include <map>
#include <vector>

#include "sim/camera/zoomed_view.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

class HotParts {
 public:
  /// `accuracy` [1] asked of a body's intensity; 0: parts are as the picture has them. Simulation and plan must outlive it.
  HotParts(const Simulation& simulation, const Plan& plan, double accuracy);

  /// Those that need it now, of bodies that are there and not small. Law: a part of brightness b and area A beside others is off by
  /// |b - b_rest| A / sum(b A) times sqrt(0.0724 P h^3) / A, h the subpixel at its distance, P its ball's outline (see zoomedLines()): more
  /// than a quarter of the accuracy is too much. Areas are a quarter of the surface (Cauchy); brightness is the black body's in the channel that says most.
  std::vector<Ball> inView(const WorldState& state, const View& view, double limit_subpixels, const std::vector<char>& small, const std::vector<char>& present);

 private:
  struct Part {
    int surface = 0;
    glm::dvec3 centre{0.0};  ///< body frame
    double radius_m = 0.0, area_m2 = 0.0;
    double textured_K = 0.0;  ///< mean of its texture; 0: it has none
  };
  const std::vector<double>& brightness(double temperature_K);
  double weightOf(const std::vector<Part>& parts, std::size_t which, const std::vector<double>& temperatures_K);

  const Simulation& simulation_;
  const Plan& plan_;
  double accuracy_;
  std::vector<std::vector<Part>> parts_;              ///< of each entity; none where there is nothing to tell apart
  std::map<double, std::vector<double>> brightness_;  ///< by temperature: [slot]
};

}  // namespace pitviper
