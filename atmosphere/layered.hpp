#pragma once
// Air with structure as a path: amounts of absorbers by height, thermal emission by the temperature of each height.
#include <memory>

#include "atmosphere/absorber_table.hpp"
#include "sim/model/atmosphere.hpp"

namespace pitviper {

std::shared_ptr<const Atmosphere> makeLayeredAir(AbsorberTable table);

}  // namespace pitviper
