#include "sim/image/grey_codes.hpp"


namespace pitviper {

std::size_t toGreyCodes(std::span<const float> values, double low, double step, std::uint16_t most, std::span<std::uint16_t> codes) {
  const auto from = static_cast<float>(low), perStep = static_cast<float>(1.0 / step), top = static_cast<float>(most);
  unsigned outside = 0;
  for (std::size_t p = 0; p < values.size(); ++p) {
    const float code = (values[p] - from) * perStep + 0.5f;
    const float kept = code < 0.0f ? 0.0f : code < top ? code : top;  // NaN: the highest
    codes[p] = static_cast<std::uint16_t>(kept);
    outside += static_cast<unsigned>(!(code >= 0.0f)) + static_cast<unsigned>(code >= top);
  }
  return outside;
}

}  // namespace pitviper
