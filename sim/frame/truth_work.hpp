#pragma once
// What tables of truth have in common: work in pieces, sums of a line by slot.
#include <span>
#include <vector>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

/// Each worker takes the next piece until there are none.
template <class OfPiece>
void eachPiece(int pieces, const OfPiece& ofPiece) {
  onAllThreads(static_cast<std::size_t>(pieces), [&](const auto& next) {
    for (auto piece = static_cast<int>(next()); piece < pieces; piece = static_cast<int>(next())) ofPiece(piece);
  });
}

/// Integrals of kernel x radiance, in the order of Plan::slotCount, of radiance per node.
inline std::vector<double> slotsOf(const Plan& plan, std::span<const double> radiance) {
  std::vector<double> slots(static_cast<std::size_t>(plan.slotCount), 0.0);
  for (std::size_t s = 0; s < slots.size(); ++s)
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) slots[s] += plan.weight[s][i] * radiance[i];
  return slots;
}

}  // namespace pitviper
