#include "sim/camera/subpixels.hpp"

#include <stdexcept>

namespace pitviper {

TruthPixel truthAt(const RawImage& raw, size_t p) {
  const float *g = &raw.truth[0][4 * p], *n = &raw.truth[1][4 * p], *i = &raw.truth[2][4 * p];
  return {g[0], g[1], g[2], g[3], {n[0], n[1], n[2]}, n[3], i[0], i[1], i[2]};
}

Subpixels::Subpixels(const Plan& plan, const View& view, RawImage raw) : view_(view), slotCount_(static_cast<size_t>(plan.slotCount)), raw_(std::move(raw)) {}

double Subpixels::slot(size_t s, size_t p) const {
  double drawn = 0.0;
  if (raw_.subpixels == 1) {
    drawn = static_cast<double>(raw_.groups[s / 4][4 * p + s % 4]);
  } else {
    const auto width = static_cast<size_t>(view_.width);
    const int x = static_cast<int>(p % width) - raw_.kept.x, y = static_cast<int>(p / width) - raw_.kept.y;
    if (x < 0 || y < 0 || x >= raw_.kept.z || y >= raw_.kept.w) throw std::logic_error("a subpixel that was not kept");
    drawn = static_cast<double>(raw_.keptGroups[s / 4][4 * (static_cast<size_t>(y) * static_cast<size_t>(raw_.kept.z) + static_cast<size_t>(x)) + s % 4]);
  }
  const auto more = added_.find(p);
  return more == added_.end() ? drawn : drawn + more->second[s];
}

void Subpixels::add(size_t s, size_t p, double value) {
  auto& sums = added_[p];
  sums.resize(slotCount_, 0.0);
  sums[s] += value;
}

namespace {

double projectedSolidAngle_sr(const View& view, int x, int y) {
  // As Pinhole's: 3-point Gauss-Legendre in each direction, of cos^4(psi).
  static const double at[3] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417}, weight[3] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const glm::dvec3 r = view.ray(x + at[i], y + at[j]);
      const double l2 = glm::dot(r, r);
      sum += weight[i] * weight[j] / (l2 * l2);
    }
  return view.tanPerPixelX * view.tanPerPixelY * sum;
}

}  // namespace

double Subpixels::projectedSolidAngle_sr(int x, int y) const { return pitviper::projectedSolidAngle_sr(view_, x, y); }

void FilmWeights::follow(const View& v, int samples) {
  const std::vector<double> key{static_cast<double>(v.width), static_cast<double>(v.height), v.tanPerPixelX, v.tanPerPixelY, v.axisX, v.axisY,
                                static_cast<double>(samples)};
  if (key == key_) return;
  key_ = key;
  const auto columns = static_cast<size_t>(v.width / samples), rows = static_cast<size_t>(v.height / samples);
  subpixel_sr_.clear();
  pixel_sr_.assign(columns * rows, 0.0);
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x) {
      subpixel_sr_.push_back(projectedSolidAngle_sr(v, x, y));
      pixel_sr_[(rows - 1 - static_cast<size_t>(y / samples)) * columns + static_cast<size_t>(x / samples)] += subpixel_sr_.back();
    }
}

/// What the GPU has resolved, and what was added since.
void Subpixels::takePixels(CameraImage& image, int samples) const {
  const size_t width = static_cast<size_t>(image.width), rows = static_cast<size_t>(image.height);
  for (size_t s = 0; s < slotCount_; ++s) {
    const float* in = raw_.groups[s / 4].data() + s % 4;
    for (size_t row = rows; row-- > 0;)
      for (size_t x = 0; x < width; ++x, in += 4) image.slots[s][row * width + x] = static_cast<double>(*in);
  }
  for (const auto& [p, sums] : added_) {
    const int x = static_cast<int>(p % static_cast<size_t>(view_.width)), y = static_cast<int>(p / static_cast<size_t>(view_.width));
    double all = 0.0;
    for (int j = 0; j < samples; ++j)
      for (int i = 0; i < samples; ++i) all += projectedSolidAngle_sr(x / samples * samples + i, y / samples * samples + j);
    const double weight = projectedSolidAngle_sr(x, y) / all;
    const size_t pixel = (rows - 1 - static_cast<size_t>(y / samples)) * width + static_cast<size_t>(x / samples);
    for (size_t s = 0; s < slotCount_; ++s) image.slots[s][pixel] += weight * sums[s];
  }
}

void Subpixels::takeSubpixels(CameraImage& image, int samples, FilmWeights& weights) const {
  const size_t width = static_cast<size_t>(image.width), pixels = width * static_cast<size_t>(image.height);
  auto pixelOf = [&](int x, int y) { return static_cast<size_t>(image.height - 1 - y / samples) * width + static_cast<size_t>(x / samples); };
  if (samples > 1) weights.follow(view_, samples);
  // Slot by slot and row by row: what is written stays in the cache.
  for (size_t s = 0; s < slotCount_; ++s) {
    const float* from = raw_.groups[s / 4].data() + s % 4;
    for (int y = 0; y < view_.height; ++y) {
      double* out = &image.slots[s][pixelOf(0, y)];
      const float* in = from + 4 * index(0, y);
      if (samples == 1) {
        for (size_t x = 0; x < width; ++x) out[x] = static_cast<double>(in[4 * x]);
        continue;
      }
      const double* weight = &weights.subpixel_sr()[index(0, y)];
      for (size_t x = 0; x < width; ++x)
        for (int k = 0; k < samples; ++k, in += 4, ++weight) out[x] += *weight * static_cast<double>(*in);
    }
  }
  for (const auto& [p, sums] : added_) {
    const int x = static_cast<int>(p % static_cast<size_t>(view_.width)), y = static_cast<int>(p / static_cast<size_t>(view_.width));
    const double weight = samples == 1 ? 1.0 : weights.subpixel_sr()[p];
    for (size_t s = 0; s < slotCount_; ++s) image.slots[s][pixelOf(x, y)] += weight * sums[s];
  }
  if (samples > 1)
    for (auto& slot : image.slots)
      for (size_t p = 0; p < pixels; ++p) slot[p] /= weights.pixel_sr()[p];
}

/// The subpixel that truth is of.
size_t Subpixels::middleOf(size_t pixel, int samples) const {
  const int columns = view_.width / samples, row = static_cast<int>(pixel) / columns, column = static_cast<int>(pixel) % columns;
  return index(column * samples + samples / 2, (view_.height / samples - 1 - row) * samples + samples / 2);
}

CameraImage Subpixels::resolve(const Pinhole& pinhole, int samples, FilmWeights& weights) const {
  CameraImage image;
  image.width = pinhole.width;
  image.height = pinhole.height;
  const size_t width = static_cast<size_t>(pinhole.width), pixels = width * static_cast<size_t>(pinhole.height);
  image.slots.assign(slotCount_, std::vector<double>(pixels, 0.0));
  const bool resolved = raw_.subpixels > 1;
  if (resolved) takePixels(image, samples);
  else takeSubpixels(image, samples, weights);
  for (const FilmPoint& p : points_) {
    const int x = p.pixel % view_.width / samples, y = pinhole.height - 1 - p.pixel / view_.width / samples;
    image.points.push_back({p.column / samples, pinhole.height - p.row / samples, p.slot, y * pinhole.width + x, p.flux});
  }
  if (!hasTruth()) return image;
  image.truth.resize(pixels);
  for (size_t p = 0; p < pixels; ++p) {
    const size_t middle = middleOf(p, samples);
    const auto replaced = truth_.find(middle);
    image.truth[p] = replaced != truth_.end() ? replaced->second
                                              : truthAt(raw_, resolved ? (static_cast<size_t>(pinhole.height) - 1 - p / width) * width + p % width : middle);
  }
  return image;
}

}  // namespace pitviper
