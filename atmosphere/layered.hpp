#pragma once
// Air with structure as a path: amounts of absorbers by height, thermal emission by the temperature of each height.
#include <filesystem>
#include <memory>

#include "atmosphere/absorber_table.hpp"
#include "sim/model/atmosphere.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// What a record of the table of layered air says. Errors: UserError.
AbsorberTable readAirTable(const Record& record, const std::filesystem::path& folder, const std::filesystem::path& library);

std::shared_ptr<const Atmosphere> makeLayeredAir(AbsorberTable table);

}  // namespace pitviper
