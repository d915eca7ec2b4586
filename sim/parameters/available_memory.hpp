#pragma once
// The memory that the machine has left for this process.
#include <optional>

namespace pitviper {

/// What this process may still take: free memory and caches that the system would give, the limits of its control groups, its own limit of address
/// space (ulimit -v). Nothing where the system tells none of them.
std::optional<double> availableMemory_bytes();

}  // namespace pitviper
