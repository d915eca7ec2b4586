#pragma once
// What a plan's wavelengths lose of a target. Its contrast is a difference: a far one's is a hundredth of its pixel's light, of which a plan may lose as much.
// A few of its lines, told at every wavelength of the reference too, say how much all of them lose.
#include <functional>
#include <initializer_list>
#include <memory>
#include <span>

#include "sim/frame/target_lines.hpp"
#include "sim/plan/plan.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {

class LostWavelengths {
 public:
  /// Integrals of kernel x radiance of one line at a plan's wavelengths: all slots of one quantity after the other.
  using SumsOfLine = std::function<std::vector<double>(const glm::dvec2& at, const Plan& plan, const std::shared_ptr<const NodeSpectra>& spectra)>;

  /// `measured`: what the plan is of, whose nodes `spectra` are. All must outlive it.
  LostWavelengths(const Simulation& simulation, const Camera& camera, std::span<const ChannelOutput> measured, const Plan& plan,
                  const std::shared_ptr<const NodeSpectra>& spectra);
  /// Adds it to sums over solid angle, by slot of the plan: of quantities in the order that `sums` has them in. May be called by one thread at a time.
  void addTo(std::initializer_list<std::vector<double>*> quantities, const std::vector<TargetLine>& lines, const SumsOfLine& sums) const;

 private:
  struct Fine {
    Plan plan;
    std::shared_ptr<const NodeSpectra> spectra;
  };
  const Fine& fine() const;

  const Simulation& simulation_;
  const Camera& camera_;
  std::span<const ChannelOutput> measured_;
  const Plan& plan_;
  const std::shared_ptr<const NodeSpectra>& spectra_;
  mutable std::unique_ptr<const Fine> fine_;  ///< once it is needed
};

}  // namespace pitviper
