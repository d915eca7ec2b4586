#pragma once
// Which part of a data set a picture belongs to: to train with, to validate, to test.
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "sim/parameters/table.hpp"

namespace pitviper {

/// By a hash of seed, camera and frame number alone: which other frames there are, and in what order, changes nothing.
struct DataSplit {
  std::vector<std::pair<std::string, double>> shares;  ///< of "train", "val", "test", those asked for, in this order; they sum to 1. None: one part, ""
  long long seed = 1;

  /// Empty where there is but one.
  std::string partOf(const std::string& camera, int number) const;
  /// Names of all; of none one without a name.
  std::vector<std::string> parts() const;
};

/// `split` and `seed`, and what a user wrote of them. Errors: UserError.
std::vector<Parameter> splitParameters();
DataSplit readSplit(const Record& record);

}  // namespace pitviper
