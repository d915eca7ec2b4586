#include "sim/image/colour_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace pitviper {
namespace {

// A curve in OKLab whose lightness grows evenly from 0.13 to 0.975 while the hue turns from violet over red to yellow, the chroma kept
// inside sRGB; neighbours differ by 0.030 to 0.035. In the manner of matplotlib's inferno, the values are our own.
// Source: B. Ottosson, "A perceptual color space for image processing", 2020, https://bottosson.github.io/posts/oklab/
const ColourMap& thermal() {
  static const ColourMap map({{6, 5, 20},      {13, 8, 31},     {22, 10, 42},    {31, 12, 53},    {41, 14, 64},   {51, 15, 73},   {63, 17, 82},
                              {75, 19, 88},    {87, 22, 93},    {101, 24, 97},   {115, 26, 98},   {129, 28, 98},  {144, 31, 96},  {159, 33, 91},
                              {174, 35, 85},   {188, 38, 78},   {202, 44, 69},   {214, 52, 59},   {224, 64, 50},  {231, 79, 42},  {236, 94, 37},
                              {240, 109, 35},  {244, 124, 36},  {247, 138, 42},  {249, 151, 51},  {251, 165, 64}, {252, 178, 80}, {252, 191, 99},
                              {252, 204, 118}, {252, 216, 139}, {252, 228, 161}, {252, 239, 183}, {253, 249, 208}});
  return map;
}

// sRGB codes are close to even in lightness by themselves.
const ColourMap& grey() {
  static const ColourMap map({{0, 0, 0}, {255, 255, 255}});
  return map;
}

const ColourMap& blackHot() {
  static const ColourMap map({{255, 255, 255}, {0, 0, 0}});
  return map;
}

// A curve in OKLab whose lightness grows evenly from 0.16 to 0.96 from blue over grey to yellow: people without cones for long or medium waves see the same
// order. After the design of cividis (J. Nunez, C. Anderton, R. Renslow, PLoS ONE 13(7), 2018); the values are our own.
const ColourMap& blueYellow() {
  static const ColourMap map({{0, 5, 53},      {0, 15, 59},     {5, 25, 66},     {14, 34, 72},    {24, 43, 78},    {35, 52, 84},    {45, 61, 90},
                              {56, 70, 96},    {67, 79, 101},   {79, 88, 106},   {90, 98, 111},   {103, 107, 115}, {116, 116, 116}, {128, 127, 112},
                              {140, 138, 111}, {152, 148, 111}, {164, 159, 110}, {175, 169, 110}, {187, 180, 109}, {200, 191, 109}, {212, 202, 109},
                              {224, 213, 108}, {237, 224, 107}, {249, 235, 106}, {255, 246, 156}});
  return map;
}

std::uint8_t mix(std::uint8_t a, std::uint8_t b, float t) {
  const float low = a, high = b;
  return static_cast<std::uint8_t>(std::lround(low + (high - low) * t));
}

}  // namespace

Rgb8 ColourMap::operator()(float value) const {
  const std::size_t last = anchors_.size() - 1;
  const float place = value > 0.0f ? std::min(value, 1.0f) * static_cast<float>(last) : 0.0f;  // NaN is not > 0
  const std::size_t i = std::min(static_cast<std::size_t>(place), last - 1);
  const float t = place - static_cast<float>(i);
  const Rgb8 a = anchors_[i], b = anchors_[i + 1];
  return {mix(a.r, b.r, t), mix(a.g, b.g, t), mix(a.b, b.b, t)};
}

const ColourMap& colourMap(std::string_view name) {
  if (name == "thermal") return thermal();
  if (name == "white_hot") return grey();
  if (name == "black_hot") return blackHot();
  if (name == "blue_yellow") return blueYellow();
  throw std::invalid_argument("no colour map is named '" + std::string(name) + "'");
}

std::vector<std::string> colourMapNames() { return {"thermal", "white_hot", "black_hot", "blue_yellow"}; }

}  // namespace pitviper
