#pragma once
// What NodeSurroundings keeps of a height: the light of all nodes as sums of a few directional patterns.
#include <Eigen/Core>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "sim/radiance/node_surroundings.hpp"

namespace pitviper {

/// Directional patterns of one of the surroundings' heights, which the light of all nodes is a sum of. Shared with nodes that are made of these.
struct NodeSurroundings::Patterns {
  Eigen::MatrixXd pattern;  ///< [pattern, entry of the grid]
  std::size_t number = 0;
  DirectionGrid grid, finer;
  /// [pattern, entry of the finer grid]: what harmonics up to a degree leave, by blur; made when asked for.
  const Eigen::MatrixXd& rest(const Surroundings& around, int degree, std::size_t wanted) const {
    Rest* found = nullptr;
    {
      const std::lock_guard lock(busy);
      auto& kept = rests[{degree, wanted}];
      if (!kept) kept = std::make_unique<Rest>();
      found = kept.get();
    }
    std::call_once(found->isTold, [&] { found->of = tellRest(around, degree, wanted); });
    return found->of;
  }
  Eigen::MatrixXd tellRest(const Surroundings& around, int degree, std::size_t wanted) const;

 private:
  struct Rest {
    std::once_flag isTold;
    Eigen::MatrixXd of;
  };
  mutable std::mutex busy;
  mutable std::map<std::pair<int, std::size_t>, std::unique_ptr<Rest>> rests;
};

/// The light at one of the surroundings' heights: node by node a sum of a few directional patterns.
struct NodeSurroundings::Height {
  std::shared_ptr<const Patterns> of;
  Eigen::MatrixXd mix;                         ///< [node, pattern]
  std::vector<Harmonics> harmonics;            ///< by node
  std::vector<DirectionGrid::Sample> samples;  ///< where it is in full
  Eigen::MatrixXd atSamples;                   ///< [pattern, sample]
};

}  // namespace pitviper
