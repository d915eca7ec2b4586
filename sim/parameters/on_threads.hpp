#pragma once
// Work on as many threads as the machine has.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace pitviper {

/// Calls work(next) on each; next() gives each number from 0 on once, all below `count` and then more.
template <class Work>
void onAllThreads(std::size_t count, const Work& work) {
  std::atomic<std::size_t> taken{0};
  const auto next = [&] { return taken++; };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::min<std::size_t>(std::thread::hardware_concurrency(), count); ++t)
    others.push_back(std::async(std::launch::async, [&] { work(next); }));
  work(next);
  for (auto& o : others) o.get();
}

}  // namespace pitviper
