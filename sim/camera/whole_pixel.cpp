#include "sim/camera/whole_pixel.hpp"

#include <cmath>
#include <future>
#include <thread>

#include "sim/render/reference/reference_pixel.hpp"

namespace pitviper {
namespace {

/// Places a side.
constexpr int kPlaces = 32;
/// Sets of places, spread over the pixel alike, whose means tell how far the whole of it can be trusted.
constexpr int kSets = 4;

double unit(std::uint64_t x) { return static_cast<double>(mixed(x) >> 11) * 0x1p-53; }

}  // namespace

std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

WholePixels::WholePixels(const Simulation& simulation, const Camera& camera, const Plan& plan, std::uint64_t seed)
    : simulation_(simulation), camera_(camera), plan_(plan), seed_(seed), spectra_(std::make_shared<const NodeSpectra>(simulation, plan.nodes, plan.terms)) {}

std::optional<WholePixel> WholePixels::look(const WorldState& state, int pixel) const {
  const View view = cameraView(camera_, state, 1);
  const int column = pixel % camera_.pinhole.width, row = camera_.pinhole.height - 1 - pixel / camera_.pinhole.width;
  for (std::size_t l = 0; l < state.lights.size(); ++l) {
    const glm::dvec3 to = glm::transpose(view.localFromCamera) * (state.lights[l] - view.position);
    if (!(state.lightLevels[l] > 0.0) || to.z >= 0.0) continue;
    const glm::dvec2 off = glm::abs(filmPosition(view, to) - glm::dvec2(column + 0.5, row + 0.5));
    if (off.x < 1.5 && off.y < 1.5) return {};
  }
  std::vector<char> drawn(simulation_.entities.size(), 1);
  if (camera_.mount.carrier >= 0) drawn[static_cast<std::size_t>(camera_.mount.carrier)] = 0;
  const ReferenceShader shader(simulation_, plan_, view, state, drawn, spectra_);
  const auto slots = static_cast<std::size_t>(plan_.slotCount);
  const auto rows = [&](int first, int last) {
    std::vector<std::vector<double>> sums(kSets, std::vector<double>(slots, 0.0));
    NodeSum sum(shader.spectra());
    for (int y = first; y < last; ++y)
      for (int x = 0; x < kPlaces; ++x) {
        const auto number = static_cast<std::uint64_t>(pixel) * (2 * kPlaces * kPlaces) + static_cast<std::uint64_t>(2 * (y * kPlaces + x));
        const ReferencePixel seen = shader.place(column + (x + unit(seed_ ^ number)) / kPlaces, row + (y + unit(seed_ ^ (number + 1))) / kPlaces, sum);
        auto& own = sums[static_cast<std::size_t>((x & 1) + 2 * (y & 1))];
        for (std::size_t s = 0; s < slots; ++s) own[s] += seen.slots[s];
      }
    return sums;
  };
  const int workers = static_cast<int>(std::max(std::thread::hardware_concurrency(), 1u));
  std::vector<std::future<std::vector<std::vector<double>>>> parts;
  for (int w = 0; w < workers; ++w) parts.push_back(std::async(std::launch::async, rows, kPlaces * w / workers, kPlaces * (w + 1) / workers));
  std::vector<std::vector<double>> sums(kSets, std::vector<double>(slots, 0.0));
  for (auto& part : parts) {
    const auto own = part.get();
    for (int k = 0; k < kSets; ++k)
      for (std::size_t s = 0; s < slots; ++s) sums[static_cast<std::size_t>(k)][s] += own[static_cast<std::size_t>(k)][s];
  }
  WholePixel whole;
  for (std::size_t s = 0; s < slots; ++s) {
    double mean = 0.0, square = 0.0;
    for (const auto& own : sums) mean += own[s] / (kPlaces * kPlaces);
    for (const auto& own : sums) square += std::pow(own[s] * kSets / (kPlaces * kPlaces) - mean, 2.0);
    whole.mean.push_back(mean);
    whole.error.push_back(std::sqrt(square / (kSets * (kSets - 1))));
  }
  return whole;
}

}  // namespace pitviper
