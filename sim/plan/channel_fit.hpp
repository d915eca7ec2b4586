#pragma once
// The groups of wavelengths of one channel: fitted to some lines of sight, checked on others.
#include "sim/plan/sights.hpp"

namespace pitviper {

struct ChannelFit {
  FineGrid grid;
  std::vector<int> absorbers;         ///< columns of the groups' extinction: see Sights::absorbers
  std::vector<SpectralGroup> groups;  ///< members: wavelengths of the grid
  double error = 0.0;                 ///< the largest on all lines of sight drawn, most of which were not fitted to
};

/// Lines of sight to draw for a fit.
constexpr int kSights = 1100;

/// Holds an accuracy (relative error) on the sights: groups are fitted to some, checked on others, fitted to the worst of those too.
ChannelFit fitChannel(const Simulation& simulation, const Sights& sights, const Spectrum& kernel, double accuracy);

}  // namespace pitviper
