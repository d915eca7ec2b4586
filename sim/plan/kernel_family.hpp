#pragma once
// Responses of one band, as of a channel's radiance and of the electrons it makes: their integrals go over the same wavelengths, and in the same groups.
#include <span>
#include <vector>

#include "sim/model/channel.hpp"

namespace pitviper {

/// Whether two responses span the same wavelengths and their ratio is nowhere beyond a factor of 3 of its mean: groups for one then do for the other, or
/// nearly.
bool areAlike(const Spectrum& a, const Spectrum& b);

/// Indices of a plan's slots, those of alike kernels together, in the order of their first ones. What is apart shares no integral.
std::vector<std::vector<size_t>> kernelFamilies(std::span<const ChannelOutput* const> slots);

}  // namespace pitviper
