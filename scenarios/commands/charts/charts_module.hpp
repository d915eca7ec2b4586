#pragma once
// The border between the program and the charts module: C functions. Both sides come from one build, so that C++ types may cross it.
#include <string>
#include <vector>

#include "scenarios/commands/charts.hpp"
#include "scenarios/commands/trajectory_picture.hpp"
#include "sim/image/picture.hpp"

namespace pitviper {

struct ChartsReply {
  Rgb8Image picture;
  std::string failure;  ///< why there is no picture; empty: there is one
};

inline constexpr const char* kChartsModule = "libpitviper_charts.so";
inline constexpr const char* kChartsFunction = "pitviperDrawCharts";
using ChartsFunction = void (*)(const std::vector<Chart>* charts, int columns, ChartsReply* reply);
inline constexpr const char* kTrajectoriesFunction = "pitviperDrawTrajectories";
using TrajectoriesFunction = void (*)(const FlownScene* scene, ChartsReply* reply);

}  // namespace pitviper
