#pragma once
// A number among a frame's attributes.
#include <string_view>

#include "sim/frame/frame.hpp"

namespace pitviper {

/// `otherwise` where there is none of that name, or it is no number.
inline double numberOf(const Frame& frame, std::string_view name, double otherwise) {
  for (const Attribute& a : frame.attributes)
    if (a.name == name)
      if (const double* value = std::get_if<double>(&a.value)) return *value;
  return otherwise;
}

}  // namespace pitviper
