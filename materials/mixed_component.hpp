#pragma once
// What lies between two reflection components of one kind.
#include <memory>

#include "sim/model/component.hpp"

namespace pitviper {

/// Do both have the same axes and the same lobe, so that sums of their columns are one's?
bool areAlike(const ReflectionComponent& a, const ReflectionComponent& b);

/// (1 - share) a + share b, share from 0 to 1. Both must be alike.
std::shared_ptr<ReflectionComponent> mixed(std::shared_ptr<const ReflectionComponent> a, std::shared_ptr<const ReflectionComponent> b, double share);

}  // namespace pitviper
