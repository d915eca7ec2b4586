#pragma once
// Work on as many threads as the machine has.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <future>
#include <thread>
#include <vector>

namespace pitviper {

/// Threads that onAllThreads() has started and that are still at work: within them only as many more are started as cores are left.
inline std::atomic<unsigned> startedThreads{0};

/// Calls work(next) on each; next() gives each number from 0 on once, all below `count` and then more.
template <class Work>
void onAllThreads(std::size_t count, const Work& work) {
  std::atomic<std::size_t> taken{0};
  const auto next = [&] { return taken++; };
  std::vector<std::future<void>> others;
  const unsigned cores = std::max(std::thread::hardware_concurrency(), 1u);
  while (others.size() + 1 < count) {
    if (startedThreads++ + 1 >= cores) {
      --startedThreads;
      break;
    }
    others.push_back(std::async(std::launch::async, [&] {
      struct Ended {
        ~Ended() { --startedThreads; }
      } ended;
      work(next);
    }));
  }
  work(next);
  for (auto& o : others) o.get();
}

/// Calls work(from, to) on stretches of 0 to count, of `least` each at least, on all threads: what one gives must not depend on where it ends.
template <class Work>
void onStretches(std::size_t count, std::size_t least, const Work& work) {
  if (count == 0) return;
  constexpr std::size_t kPerThread = 4;
  const std::size_t most = kPerThread * std::max(std::thread::hardware_concurrency(), 1u), parts = std::clamp<std::size_t>(count / least, 1, most);
  onAllThreads(parts, [&](const auto& next) {
    for (std::size_t k = next(); k < parts; k = next()) work(k * count / parts, (k + 1) * count / parts);
  });
}

}  // namespace pitviper
