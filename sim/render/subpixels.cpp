#include "sim/render/subpixels.hpp"

#include <cmath>
#include <limits>

namespace pitviper {

TruthPixel truthAt(const RawImage& raw, size_t p) {
  const float *g = &raw.truth[0][4 * p], *n = &raw.truth[1][4 * p], *i = &raw.truth[2][4 * p];
  return {g[0], g[1], g[2], g[3], {n[0], n[1], n[2]}, n[3], i[0], i[1], i[2]};
}

Subpixels::Subpixels(const Plan& plan, const View& view, RawImage raw) : view_(view), depth_(std::move(raw.depth)) {
  const size_t pixels = static_cast<size_t>(raw.width) * static_cast<size_t>(raw.height);
  slots_.assign(static_cast<size_t>(plan.slotCount), std::vector<double>(pixels));
  for (size_t s = 0; s < slots_.size(); ++s)
    for (size_t p = 0; p < pixels; ++p) slots_[s][p] = static_cast<double>(raw.groups[s / 4][4 * p + s % 4]);
  if (raw.truth.empty()) return;
  truth_.reserve(pixels);
  for (size_t p = 0; p < pixels; ++p) truth_.push_back(truthAt(raw, p));
}

double Subpixels::axialDepth_m(size_t p) const {
  if (depth_.empty() || depth_[p] <= 0.0f) return std::numeric_limits<double>::infinity();
  return view_.near_m / static_cast<double>(depth_[p]);
}

double Subpixels::projectedSolidAngle_sr(int x, int y) const {
  const glm::dvec3 r = view_.ray(x + 0.5, y + 0.5);
  const double l2 = glm::dot(r, r);
  return view_.tanPerPixelX * view_.tanPerPixelY / (l2 * l2);
}

CameraImage Subpixels::resolve(const Pinhole& pinhole, int samples) const {
  CameraImage image;
  image.width = pinhole.width;
  image.height = pinhole.height;
  const size_t pixels = static_cast<size_t>(pinhole.width) * static_cast<size_t>(pinhole.height);
  image.slots.assign(slots_.size(), std::vector<double>(pixels, 0.0));
  if (!truth_.empty()) image.truth.resize(pixels);
  std::vector<double> weights(samples > 1 ? pixels * static_cast<size_t>(samples * samples) : 0);
  std::vector<size_t> first(pixels);
  for (int row = 0; row < pinhole.height; ++row)
    for (int column = 0; column < pinhole.width; ++column) {
      const size_t p = static_cast<size_t>(row) * static_cast<size_t>(pinhole.width) + static_cast<size_t>(column);
      const int x0 = column * samples, y0 = (pinhole.height - 1 - row) * samples;
      first[p] = index(x0, y0);
      if (!truth_.empty()) image.truth[p] = truth_[index(x0 + samples / 2, y0 + samples / 2)];
      double total = 0.0;
      double* w = samples > 1 ? &weights[p * static_cast<size_t>(samples * samples)] : nullptr;
      for (int k = 0; w && k < samples * samples; ++k) total += w[k] = projectedSolidAngle_sr(x0 + k % samples, y0 + k / samples);
      for (int k = 0; w && k < samples * samples; ++k) w[k] /= total;
    }
  for (size_t s = 0; s < slots_.size(); ++s)
    for (size_t p = 0; p < pixels; ++p) {
      if (samples == 1) {
        image.slots[s][p] = slots_[s][first[p]];
        continue;
      }
      const double* w = &weights[p * static_cast<size_t>(samples * samples)];
      for (int j = 0; j < samples; ++j)
        for (int i = 0; i < samples; ++i) image.slots[s][p] += *w++ * slots_[s][first[p] + static_cast<size_t>(j) * static_cast<size_t>(view_.width) + static_cast<size_t>(i)];
    }
  return image;
}

}  // namespace pitviper
