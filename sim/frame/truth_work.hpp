#pragma once
// What tables of truth have in common: work in pieces, sums of a line by slot.
#include <atomic>
#include <future>
#include <span>
#include <thread>
#include <vector>

#include "sim/plan/plan.hpp"

namespace pitviper {

/// Each worker takes the next piece until there are none.
template <class OfPiece>
void eachPiece(int pieces, const OfPiece& ofPiece) {
  std::atomic<int> next{0};
  const auto work = [&] {
    for (int piece = next++; piece < pieces; piece = next++) ofPiece(piece);
  };
  std::vector<std::future<void>> workers;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) workers.push_back(std::async(std::launch::async, work));
  work();
  for (auto& w : workers) w.get();
}

/// Integrals of kernel x radiance, in the order of Plan::slotCount, of radiance per node.
inline std::vector<double> slotsOf(const Plan& plan, std::span<const double> radiance) {
  std::vector<double> slots(static_cast<std::size_t>(plan.slotCount), 0.0);
  for (std::size_t s = 0; s < slots.size(); ++s)
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) slots[s] += plan.weight[s][i] * radiance[i];
  return slots;
}

}  // namespace pitviper
