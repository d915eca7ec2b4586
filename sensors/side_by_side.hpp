#pragma once
// Work on rows in bands, one for each processor.
#include <algorithm>
#include <thread>
#include <vector>

namespace pitviper {

/// ofBand(first, last) for bands that make up 0 to count.
template <class OfBand>
void sideBySide(int count, const OfBand& ofBand) {
  const int workers = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, 16);
  std::vector<std::jthread> threads;
  for (int w = 1; w < workers; ++w) threads.emplace_back([&, w] { ofBand(count * w / workers, count * (w + 1) / workers); });
  ofBand(0, count / workers);
}

}  // namespace pitviper
