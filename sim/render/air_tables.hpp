#pragma once
// Layered air as the shader reads it (atmosphere/layered.glsl): tables by elevation and range for a view, made in double precision, and by
// height for ways to lights and to the sun.
#include <optional>

#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/plan/plan.hpp"
#include "sim/render/view.hpp"

namespace pitviper {

class AirTables {
 public:
  /// `perChannel`: path radiance is integrated over the channels (direct mode), else it is kept per node. Both must outlive it.
  AirTables(const Simulation& simulation, const Plan& plan, bool perChannel, bool wanted = true);
  /// Nothing to do for air that is not layered.
  bool isNeeded() const { return needed_; }
  void addConstants(ShaderSlots& slots) const;
  /// Makes the tables for a view, unless those at hand serve it.
  void update(const View& view, const WorldState& state);
  void bind() const;

 private:
  struct Grid {
    glm::dvec3 position{NAN};
    double height_m = 0.0;
    double sunAcross = 0.0;                    ///< in the view's middle, see sunAcrossOf()
    double acrossLow = 0.0, acrossHigh = 0.0;  ///< in all of it
    double low = 0.0, high = 0.0;              ///< sines of elevation
    double farthest_m = 0.0;
  };
  std::vector<double> rangesFrom(double entry_m) const;
  bool serves(const View& view, double low, double high, double farthest_m) const;
  double sunAcrossOf(const View& view, const glm::dvec3& direction) const;
  std::pair<double, double> sunAcrossIn(const View& view) const;
  double sunAcrossAtMost(const View& view) const;
  double acrossAt(int azimuth) const;
  double sineAt(int elevation) const;
  void fill(const View& view);
  double elevationError(const std::vector<double>& totals) const;
  void fillElevation(const View& view, int azimuth, int elevation, const std::vector<double>& asymmetry, std::vector<float>& amounts,
                     std::vector<float>& radiance, std::vector<double>& totals) const;
  std::vector<double> asymmetries() const;
  void addHeights(std::vector<float>& amounts) const;
  double planck(size_t node, double temperature_K) const;

  const Simulation& simulation_;
  const Plan& plan_;
  bool perChannel_, needed_;
  int azimuths_ = 1, elevations_ = 0, ranges_ = 0, vectors_ = 0, values_ = 0, texels_ = 0, parts_ = 1;
  std::vector<std::vector<double>> logPlanck_;  ///< per node, over the inverse of the temperature
  std::vector<double> sunIrradiance_;           ///< per node
  std::vector<double> black_;                   ///< per node, at the air's temperature where the tables begin
  std::vector<float> heights_;                  ///< by height: the same for every view
  Grid grid_;
  Buffer block_, amounts_, radiance_;
};

}  // namespace pitviper
