#pragma once
// Textures: what one has at a place, and over what a pixel covers of it.
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace pitviper {

/// A texture at half the size, or half of that: means over as much of it as a texel covers. Source: Williams 1983, Pyramidal Parametrics.
struct TextureLevel {
  int width = 0, height = 0;
  std::vector<float> mean;
  std::vector<float> second, third;  ///< central moments of what a texel covers; empty where nobody asks
};

/// One channel of floats, row 0 at v = 0 (bottom), read bilinearly; beyond its edges held, or repeated.
struct Texture {
  std::string name;
  int width = 0, height = 0;
  std::vector<float> texels;
  bool repeats = false;
  TextureLevel cells{};                ///< what is read over the square of each texel; empty where nobody asks for moments
  std::vector<TextureLevel> levels{};  ///< from half the size down to one texel; empty: only single places are read
};

/// `moments`: of temperatures, whose mean radiance is not that of their mean.
void makeLevels(Texture& texture, bool moments);

/// How texture coordinates move over a pixel, by its sides; 0: a single place is looked at.
struct Footprint {
  glm::dvec2 across{0.0}, up{0.0};
};

/// How finely a pixel's part of a texture is read: places over ten texels at least, unless they are more than the most across
/// its narrower or along its longer side: then texels of a coarser level.
struct TextureTaps {
  int perTenTexels = 10, mostAcross = 1, mostAlong = 1;
};

/// For an accuracy [1]. Means over random footprints of noise whose texels have nothing to do with each other are off by so much of its range (root mean
/// square; places on average): 2.2 % (2.4), 1.5 % (6), 1.1 % (13), 0.7 % (41), of fields 16 texels wide by 2.1, 1.0, 0.6, 0.4 %. Of temperatures, whose spread
/// counts as well, by 1.8, 1.4, 1.2, 1.2 and 2.1, 1.0, 0.7, 0.7 %: test_texture_filter.cpp.
TextureTaps tapsFor(double accuracy);
/// Of the reference: no choice is finer.
constexpr double kFinestTextures = 1e-4;

/// What a texture has at a place, bilinear as the shader reads it.
double textureValue(const Texture& texture, glm::dvec2 uv);

/// Mean and central moments over a footprint. Levels without moments count as even.
struct TextureMoments {
  double mean = 0.0, second = 0.0, third = 0.0;
};
TextureMoments textureMoments(const Texture& texture, glm::dvec2 uv, const Footprint& footprint, const TextureTaps& taps);

}  // namespace pitviper
