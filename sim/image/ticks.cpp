#include "sim/image/ticks.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace pitviper {
namespace {

// Labels within these bounds are read faster plain than with a power of ten.
constexpr double largestPlain = 1e5;
constexpr double smallestPlain = 0.01;

std::string fixed(double value, int decimals) {
  std::array<char, 400> digits;  // 309 digits of the largest double, a sign, a point and decimals
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed, decimals).ptr;
  return {digits.data(), end};
}

std::string withMinus(std::string text) {
  if (!text.empty() && text[0] == '-') text.replace(0, 1, "\u2212");  // as wide as the digits, unlike the hyphen
  return text;
}

/// Index range of the multiples of `step` in [low, high].
struct Multiples {
  double first, last;
  double count() const { return last - first + 1; }
};

Multiples multiples(double low, double high, double step) {
  // An end that is a multiple but for rounding belongs in; a millionth of a step is not seen.
  constexpr double slack = 1e-6;
  return {std::ceil(low / step - slack), std::floor(high / step + slack)};
}

}  // namespace

Ticks chooseTicks(double low, double high) {
  if (!std::isfinite(low) || !std::isfinite(high) || !(low < high) || !std::isfinite(high - low)) throw std::invalid_argument("chooseTicks: no range");
  const int decade = static_cast<int>(std::floor(std::log10(high - low)));
  double best = 0, bestDistance = std::numeric_limits<double>::infinity();
  int bestDecade = 0;
  for (int exponent = decade - 1; exponent <= decade; ++exponent)
    for (const int factor : {1, 2, 5}) {
      const double step = factor * std::pow(10.0, exponent);
      const double distance = std::abs(multiples(low, high, step).count() - 5.5);  // between the wanted 5 and 6
      if (distance < bestDistance) bestDistance = distance, best = step, bestDecade = exponent;
    }
  Ticks ticks;
  const double largest = std::max(std::abs(low), std::abs(high));
  if (largest >= largestPlain || largest < smallestPlain) ticks.power = static_cast<int>(std::floor(std::log10(largest)));
  const int decimals = std::clamp(ticks.power - bestDecade, 0, 17);
  const Multiples range = multiples(low, high, best);
  for (double i = range.first; i <= range.last; ++i) {
    // Adding 0 turns -0 into 0.
    const double value = i * best + 0.0;
    ticks.values.push_back(value);
    ticks.labels.push_back(withMinus(fixed(value / std::pow(10.0, ticks.power) + 0.0, decimals)));
  }
  return ticks;
}

std::string powerText(int power) {
  if (power == 0) return "";
  constexpr std::array<const char*, 10> superscripts = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = "×10";
  for (const char c : std::to_string(power)) text += c == '-' ? "⁻" : superscripts[static_cast<std::size_t>(c - '0')];
  return text;
}

std::string shortNumber(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "\u2212inf";
  const double size = std::abs(value);
  if (size != 0 && (size < 1e-3 || size >= 1e5)) {
    std::array<char, 40> digits;
    const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::scientific, 1).ptr;
    std::string text(digits.data(), end);  // 4.1e-07, 4.1e+05
    const std::size_t e = text.find('e');
    std::string exponent = text.substr(e + 1);
    const bool negative = exponent[0] == '-';
    exponent.erase(0, std::min(exponent.find_first_not_of("+-0"), exponent.size() - 1));
    return withMinus(text.substr(0, e) + (negative ? "e-" : "e") + exponent);
  }
  const int digitsBefore = size >= 1 ? static_cast<int>(std::floor(std::log10(size))) + 1 : 1;
  std::string text = fixed(value + 0.0, std::max(0, 4 - digitsBefore));
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
  }
  return withMinus(text);
}

}  // namespace pitviper
