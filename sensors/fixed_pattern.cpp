#include "sensors/fixed_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/noise_source.hpp"

namespace pitviper {
namespace {

/// Bad ones, so many side by side: each begins somewhere and walks on.
void markBad(const DetectorLaw& law, const NoiseSource& source, int width, int height, std::vector<std::uint8_t>& bad) {
  bad.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  if (!(law.badPixels > 0.0)) return;
  // Of those that begin a cluster so many that, with what they cover, the share is met but for clusters that meet.
  const double begins = law.badPixels / law.badTogether;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto place = static_cast<std::uint32_t>(y * width + x);
      const double u = source.uniform(place);
      if (u >= begins) continue;
      const std::uint8_t kind = u < 0.5 * begins ? 1 : 2;
      int column = x, row = y;
      std::uint32_t draw = 1;
      for (int left = law.badTogether; left > 0 && draw < 1000; ++draw) {
        std::uint8_t& at = bad[static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column)];
        if (at == 0) at = kind, --left;
        const int way = static_cast<int>(4.0 * source.uniform(place, draw));
        column = std::clamp(column + (way == 0) - (way == 1), 0, width - 1);
        row = std::clamp(row + (way == 2) - (way == 3), 0, height - 1);
      }
    }
}

}  // namespace

FixedPattern fixedPattern(const DetectorLaw& law, std::uint64_t seed, std::uint32_t channel, int width, int height) {
  const auto source = [&](NoiseEffect e) { return NoiseSource(seed, channel, 0, e); };
  const NoiseSource gain = source(NoiseEffect::Gain), pixel = source(NoiseEffect::FixedPixel), row = source(NoiseEffect::FixedRow),
                    column = source(NoiseEffect::FixedColumn), bends = source(NoiseEffect::Bend), gains = source(NoiseEffect::GainDrift),
                    offsets = source(NoiseEffect::OffsetDrift);
  FixedPattern f;
  const auto add = [](std::vector<float>& into, double sigma, const NoiseSource& from, std::uint32_t at) {
    if (sigma > 0.0) into.push_back(static_cast<float>(sigma * from.normal(at)));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const auto at = static_cast<std::uint32_t>(y * width + x);
      f.response.push_back(static_cast<float>(1.0 + (law.prnu > 0.0 ? law.prnu * gain.normal(at) : 0.0)));
      double dark = law.sigmaVh > 0.0 ? law.sigmaVh * pixel.normal(at) : 0.0;
      if (law.sigmaV > 0.0) dark += law.sigmaV * row.normal(static_cast<std::uint32_t>(y));
      if (law.sigmaH > 0.0) dark += law.sigmaH * column.normal(static_cast<std::uint32_t>(x));
      f.dark.push_back(static_cast<float>(dark));
      add(f.bend, law.nonlinearity / law.fullWell, bends, at);
      add(f.gainDrift, law.gainDrift_per_s, gains, at);
      add(f.darkDrift, law.offsetDrift_per_s, offsets, at);
    }
  markBad(law, source(NoiseEffect::BadPixel), width, height, f.bad);
  return f;
}

void learnCorrection(FixedPattern& f, const DetectorLaw& law, std::uint64_t seed, std::uint32_t channel, double low, double high, double lowNoise,
                     double highNoise) {
  const NoiseSource learning(seed, channel, 0, NoiseEffect::Correction);
  const double root = std::sqrt(static_cast<double>(law.correction->frames));
  f.gain.clear(), f.offset.clear();
  for (std::size_t p = 0; p < f.response.size(); ++p) {
    const auto at = static_cast<std::uint32_t>(p);
    const auto said = [&](double s, double noise, std::uint32_t draw) {
      return static_cast<double>(f.response[p]) * s + static_cast<double>(f.dark[p]) + (f.bend.empty() ? 0.0 : static_cast<double>(f.bend[p]) * s * s) +
             noise / root * learning.normal(at, draw);
    };
    const double a = said(low, lowNoise, 0), b = said(high, highNoise, 1);
    const double gain = f.bad[p] || !(std::abs(b - a) > 0.0) ? 1.0 : (high - low) / (b - a);
    f.gain.push_back(static_cast<float>(gain));
    f.offset.push_back(static_cast<float>(f.bad[p] ? 0.0 : low - gain * a));
  }
}

}  // namespace pitviper
