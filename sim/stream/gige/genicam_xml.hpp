#pragma once
// What a client may ask of the camera, in the words of GenICam: names of the Standard Features Naming Convention, places of gige_registers.hpp.
#include <string>

#include "sim/stream/gige/gige_types.hpp"

namespace pitviper {

/// A description for GenApi 1.1.
std::string genicamXml(const GigeSettings& settings, const GigeAbilities& abilities);

}  // namespace pitviper
