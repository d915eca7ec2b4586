#pragma once
// Air with structure as a path: amounts of absorbers by height, thermal emission by the temperature of each height.
#include <memory>

#include "atmosphere/absorber_table.hpp"
#include "atmosphere/models.hpp"
#include "sim/model/atmosphere.hpp"

namespace pitviper {

/// What a record of the table of layered air says. Errors: UserError.
AbsorberTable readAirTable(const AirRecord& air);

std::shared_ptr<const Atmosphere> makeLayeredAir(AbsorberTable table);

}  // namespace pitviper
