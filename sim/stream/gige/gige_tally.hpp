#pragma once
// Counts that several threads add to.
#include <mutex>

#include "sim/stream/gige/gige_types.hpp"

namespace pitviper {

class GigeTally {
 public:
  void add(std::uint64_t GigeCounts::*what, std::uint64_t number = 1) {
    const std::lock_guard lock(mutex_);
    counts_.*what += number;
  }
  GigeCounts now() const {
    const std::lock_guard lock(mutex_);
    return counts_;
  }

 private:
  mutable std::mutex mutex_;
  GigeCounts counts_;
};

}  // namespace pitviper
