#include "atmosphere/layered_gpu.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

namespace pitviper {
namespace {

constexpr double kNothing = 1e-30;
/// Ways to lamps have so many pieces (tests/gpu/test_ways_to_lamps.cpp).
constexpr int kPieces = 3;
/// What sines of elevation may differ by in single precision.
constexpr double kRoom = 1e-6;

}  // namespace

LayeredOnGpu::LayeredOnGpu(const Simulation& simulation, const Plan& plan, bool perChannel)
    : simulation_(simulation), plan_(plan), perChannel_(perChannel), rows_(simulation, plan, perChannel), coefficients_(plan, rows_.vectors()) {
  if (plan.lightCount > 0) addHeights(heights_);  // ways on to them
}

void LayeredOnGpu::addSlots(ShaderSlots& slots) const {
  slots.files["path"] = perChannel_ ? "atmosphere/layered_channels.glsl" : "atmosphere/layered_nodes.glsl";
  coefficients_.addSlots(slots);
  slots.constants["AIR_AZIMUTHS"] = plan_.terms.scatteredSun ? plan_.air.azimuths : 1;
  slots.constants["AIR_HEIGHTS"] = SunLegs::kHeights;
  slots.constants["AIR_SUNS"] = plan_.sunLegs ? SunLegs::kElevations : 0;
  slots.constants["AIR_PIECES"] = kPieces;
  slots.constants["AIR_PARTS"] = rows_.parts();
  slots.constants["AIR_ASYMMETRIES"] = (rows_.values() + 3) / 4;
  slots.constants["AIR_BLACKS"] = (plan_.nodeCount() + 3) / 4;
}

void LayeredOnGpu::addHeights(std::vector<float>& out) const {
  const Atmosphere& path = *simulation_.air;
  const auto put = [&](const AirAmounts& logs) {
    for (size_t k = 0; k < static_cast<size_t>(4 * rows_.vectors()); ++k) out.push_back(static_cast<float>(logs.amount[k]));
  };
  for (int h = 0; plan_.sunLegs && h < SunLegs::kHeights; ++h)
    for (int e = 0; e < SunLegs::kElevations; ++e) put(plan_.sunLegs->rootAt(e, h));
  // From the top down, what lies above by Simpson's rule.
  const auto heightOf = [&](double h) { return SunLegs::heightAt(h, path.top_m()); };
  const int last = SunLegs::kHeights - 1;
  std::vector<AirAmounts> densities(static_cast<size_t>(last) + 1), columns(densities.size());
  for (int h = last; h >= 0; --h) {
    const auto at = static_cast<size_t>(h);
    densities[at] = path.densities(heightOf(h));
    if (h == last) continue;
    const double low = heightOf(h), high = heightOf(h + 1);
    const AirAmounts middle = path.densities(0.5 * (low + high));
    for (size_t k = 0; k < kMostAirAmounts; ++k)
      columns[at].amount[k] =
          columns[at + 1].amount[k] + (high - low) * 1e-3 / 6.0 * (densities[at].amount[k] + 4.0 * middle.amount[k] + densities[at + 1].amount[k]);
  }
  for (size_t h = 0; h < columns.size(); ++h) {
    for (double& d : densities[h].amount) d = std::log(std::max(d, kNothing));
    put(densities[h]);
    put(columns[h]);
  }
}

void LayeredOnGpu::update(const View& view, const WorldState& state) {
  if (!first_ && view.position == position_ && holds(grid_, simulation_, plan_, view, state)) return;
  const AirGrid grid = airGrid(simulation_, plan_, plan_.air, view, state);
  first_ = false;
  position_ = view.position;
  if (grid == grid_) return;
  grid_ = grid;
  rows_.begin(grid_);
  upload(fill());
}

/// [azimuth][elevation]
std::vector<AirRow> LayeredOnGpu::fill() const {
  const double horizon = grid_.horizon(simulation_.frame.earthRadius_m()), lowest = grid_.lowestHorizon(simulation_.frame.earthRadius_m());
  std::vector<AirRow> rows(static_cast<size_t>(grid_.azimuths * grid_.elevations));
  std::atomic<size_t> next{0};
  auto work = [&] {
    for (size_t n = next++; n < rows.size(); n = next++) {
      const int e = static_cast<int>(n) % grid_.elevations;
      AirLine line{grid_.sineAt(e), grid_.acrossAt(static_cast<int>(n) / grid_.elevations), false};
      line.reachesSpace = !simulation_.ground || grid_.sineAt(std::min(e + 1, grid_.elevations - 1)) >= lowest - kRoom;
      line.meetsHorizon = simulation_.ground && line.sine < horizon && grid_.sineAt(e + 1) >= horizon;
      rows[n] = rows_.at(line);
    }
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
  return rows;
}

void LayeredOnGpu::upload(const std::vector<AirRow>& rows) {
  const auto columns = static_cast<size_t>(rows_.columns()), parts = static_cast<size_t>(rows_.parts()), values = static_cast<size_t>(rows_.values());
  std::vector<float> amounts, radiance;
  amounts.reserve(static_cast<size_t>(grid_.elevations) * rows.front().amounts.size() + heights_.size());
  radiance.reserve(rows.size() * columns * parts * values);
  // Amounts are those of the first azimuth: of all.
  for (int e = 0; e < grid_.elevations; ++e)
    amounts.insert(amounts.end(), rows[static_cast<size_t>(e)].amounts.begin(), rows[static_cast<size_t>(e)].amounts.end());
  for (const AirRow& row : rows) radiance.insert(radiance.end(), row.radiance.begin(), row.radiance.end());
  amounts.insert(amounts.end(), heights_.begin(), heights_.end());
  amounts_.upload(amounts);
  radiance_.upload(radiance);

  std::vector<float> block;
  auto put = [&block](std::initializer_list<double> v) {
    for (double x : v) block.push_back(static_cast<float>(x));
  };
  const double from = spreadOf(grid_.low), width = spreadOf(grid_.high) - from;
  put({from, (grid_.elevations - 1) / width, grid_.scale_m, grid_.entriesPerLog()});
  put({grid_.acrossLow, grid_.azimuths > 1 ? (grid_.azimuths - 1) / std::max(grid_.acrossHigh - grid_.acrossLow, 1e-12) : 0.0,
       static_cast<double>(grid_.elevations), static_cast<double>(grid_.ranges)});
  put({SunLegs::kBottom_m, (SunLegs::kHeights - 1) / std::sqrt(simulation_.air->top_m() - SunLegs::kBottom_m), plan_.sunLegs ? plan_.sunLegs->firstSine() : 0.0,
       plan_.sunLegs ? 1.0 / plan_.sunLegs->step() : 0.0});
  const auto powers = simulation_.air->exponents();
  const auto absorbers = static_cast<size_t>(4 * rows_.vectors());
  for (size_t k = 0; k < absorbers; ++k) put({k < powers.size() ? powers[k] : 1.0});
  for (double g : rows_.asymmetries()) put({g});
  const auto& black = rows_.black();
  for (size_t i = 0; i < (plan_.nodes.size() + 3) / 4 * 4; ++i) put({i < black.size() ? black[i] : 0.0});
  block_.upload(block);
}

void LayeredOnGpu::bind() const {
  block_.bindUniform(3);
  coefficients_.bind();
  amounts_.bindTexture(20, 4);
  radiance_.bindTexture(21, perChannel_ ? 4 : 1);
}

}  // namespace pitviper
