#include "sim/plan/averaged_fringes.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/model/fringes.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/reference_width.hpp"

namespace pitviper {
namespace {

/// Wavelengths of a channel that are looked at.
constexpr int kLooks = 64;
/// So many bins average fringes by themselves: what is left at both ends is below 1e-2 of their contrast.
constexpr double kManyBins = 20.0;

}  // namespace

std::vector<AveragedFringes> averagedFringes(const Simulation& sim, const std::vector<ChannelOutput>& outputs) {
  std::vector<AveragedFringes> all;
  std::set<std::string> seen;
  for (const ChannelOutput& o : outputs) {
    if (!seen.insert(o.channel).second) continue;
    const double low = o.kernel.supportLow(), high = o.kernel.supportHigh();
    for (const auto& material : sim.materials) {
      AveragedFringes worst{material->name, o.channel, 0.0, 0.0, 0.0, false};
      double closest = INFINITY;
      for (const auto& r : material->reflections) {
        const auto* fringed = dynamic_cast<const HasFringes*>(r.get());
        for (int k = 0; fringed && k <= kLooks; ++k) {
          const double w = low + (high - low) * k / kLooks;
          if (w < r->validLow_um() || w > r->validHigh_um()) continue;
          const double apart = fringed->averagedFringe_um(w), width = referenceWidth_um(w);
          if (!(apart > 0.0) || apart / width >= closest) continue;
          closest = apart / width;
          worst.apart_um = apart, worst.at_um = w, worst.width_um = width;
        }
      }
      if (!(worst.apart_um > 0.0)) continue;
      worst.narrow = high - low < kManyBins * worst.width_um;
      all.push_back(std::move(worst));
    }
  }
  return all;
}

std::string wordsOf(const AveragedFringes& f) {
  return print("fringes of '%s' are %.2g nm apart at %.4g um, closer than the wavelengths of the reference (%.2g nm): they are averaged, %s",
               f.material.substr(0, 60).c_str(), 1e3 * f.apart_um, f.at_um, 1e3 * f.width_um,
               f.narrow ? "and this channel is so narrow that it could see some of them" : "as if powers of its thick layers added");
}

}  // namespace pitviper
