#include "sensors/edge_transfer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

double EdgeTransfer::at(double f) const {
  const auto above = std::lower_bound(frequency.begin(), frequency.end(), f);
  if (above == frequency.begin()) return contrast.front();
  if (above == frequency.end()) return contrast.back();
  const auto k = static_cast<std::size_t>(above - frequency.begin());
  const double u = (f - frequency[k - 1]) / (frequency[k] - frequency[k - 1]);
  return contrast[k - 1] + u * (contrast[k] - contrast[k - 1]);
}

EdgeTransfer edgeTransfer(const std::vector<double>& picture, std::size_t width, std::size_t height) {
  constexpr int kBins = 4;  // a pixel
  if (width < 16 || height < 16 || picture.size() != width * height) throw std::invalid_argument("edgeTransfer: a picture of 16 x 16 pixels or more");
  // Centroids of the rows' derivatives; around the edge alone, once it is about known, as noise far away moves them.
  std::vector<double> centre(height, 0.5 * static_cast<double>(width));
  double slope = 0.0, offset = 0.0;
  for (int pass = 0; pass < 3; ++pass) {
    const double reach = pass == 0 ? static_cast<double>(width) : std::max(6.0, 0.1 * static_cast<double>(width));
    for (std::size_t y = 0; y < height; ++y) {
      double sum = 0.0, moment = 0.0;
      const double about = pass == 0 ? 0.5 * static_cast<double>(width) : offset + slope * static_cast<double>(y);
      for (std::size_t x = 0; x + 1 < width; ++x) {
        const double place = static_cast<double>(x) + 1.0, d = picture[y * width + x + 1] - picture[y * width + x];
        if (std::abs(place - about) > reach) continue;
        sum += d, moment += d * place;
      }
      if (sum == 0.0) throw std::invalid_argument("edgeTransfer: a row without an edge");
      centre[y] = moment / sum;
    }
    double my = 0.0, mc = 0.0, yy = 0.0, yc = 0.0;
    for (std::size_t y = 0; y < height; ++y) my += static_cast<double>(y) / static_cast<double>(height), mc += centre[y] / static_cast<double>(height);
    for (std::size_t y = 0; y < height; ++y) {
      const double d = static_cast<double>(y) - my;
      yy += d * d, yc += d * (centre[y] - mc);
    }
    slope = yc / yy;
    offset = mc - slope * my;
  }
  // The edge's profile along its normal, in quarters of a pixel.
  const double cosine = 1.0 / std::sqrt(1.0 + slope * slope);
  const int half = kBins * std::min<int>(64, static_cast<int>(0.35 * static_cast<double>(width)));
  std::vector<double> profile(static_cast<std::size_t>(2 * half), 0.0), count = profile;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const double place = (static_cast<double>(x) + 0.5 - (offset + slope * static_cast<double>(y))) * cosine;
      const auto bin = static_cast<long>(std::floor(place * kBins)) + half;
      if (bin < 0 || bin >= 2 * half) continue;
      profile[static_cast<std::size_t>(bin)] += picture[y * width + x];
      count[static_cast<std::size_t>(bin)] += 1.0;
    }
  for (std::size_t k = 0; k < profile.size(); ++k) {
    if (count[k] > 0.0) profile[k] /= count[k];
    else if (k > 0) profile[k] = profile[k - 1];
  }
  std::vector<double> line;
  for (std::size_t k = 1; k + 1 < profile.size(); ++k) line.push_back(0.5 * (profile[k + 1] - profile[k - 1]));
  const double middle = 0.5 * static_cast<double>(line.size() - 1);
  for (std::size_t k = 0; k < line.size(); ++k) line[k] *= 0.54 + 0.46 * std::cos(kPi * (static_cast<double>(k) - middle) / (middle + 0.5));
  EdgeTransfer transfer;
  transfer.slope = slope;
  double none = 0.0;
  for (double d : line) none += d;
  if (none == 0.0) throw std::invalid_argument("edgeTransfer: no edge");
  constexpr int kFrequencies = 50;
  const auto sinc = [](double x) { return x > 1e-9 ? std::sin(kPi * x) / (kPi * x) : 1.0; };
  for (int k = 0; k <= kFrequencies; ++k) {
    const double f = static_cast<double>(k) / kFrequencies;
    double re = 0.0, im = 0.0;
    for (std::size_t j = 0; j < line.size(); ++j) {
      const double phase = 2.0 * kPi * f * (static_cast<double>(j) - middle) / kBins;
      re += line[j] * std::cos(phase), im += line[j] * std::sin(phase);
    }
    // A difference over two bins is a derivative through sinc(2 f / 4); a bin is a mean over a quarter pixel.
    transfer.frequency.push_back(f);
    transfer.contrast.push_back(std::hypot(re, im) / std::abs(none) / (sinc(2.0 * f / kBins) * sinc(f / kBins)));
  }
  return transfer;
}

}  // namespace pitviper
