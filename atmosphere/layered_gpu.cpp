#include "atmosphere/layered_gpu.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <future>
#include <thread>

#include "sim/model/refracts.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

constexpr double kNothing = 1e-30;
/// Ways to lamps have so many pieces (tests/gpu/test_ways_to_lamps.cpp).
constexpr int kPieces = 3;
/// What sines of elevation may differ by in single precision.
constexpr double kRoom = 1e-6;

/// Places on a lattice, told apart whatever they were counted from.
std::pair<long long, long long> keyOf(double across, double sine) {
  constexpr double kFine = 1099511627776.0;  // 2^40
  return {std::llround(across * kFine), std::llround(sine * kFine)};
}

/// Null where its lines are straight.
const Refracts* bendOf(const Simulation& simulation) {
  const auto* air = dynamic_cast<const Refracts*>(simulation.air.get());
  return air && air->bends() ? air : nullptr;
}

}  // namespace

LayeredOnGpu::LayeredOnGpu(const Simulation& simulation, const Plan& plan, bool perChannel)
    : simulation_(simulation), plan_(plan), perChannel_(perChannel), rows_(simulation, plan, perChannel), coefficients_(plan, rows_.vectors()) {
  if (plan.lightCount > 0 || (plan.terms.fields && plan.sunLegs))
    addHeights(heights_);  // ways on to them; fields scatter the sun's light where nothing else does
}

void LayeredOnGpu::addSlots(ShaderSlots& slots) const {
  slots.files["path"] = perChannel_ ? "atmosphere/layered_channels.glsl" : "atmosphere/layered_nodes.glsl";
  coefficients_.addSlots(slots);
  slots.constants["AIR_AZIMUTHS"] = plan_.terms.scatteredSun ? plan_.air.azimuths : 1;
  slots.constants["AIR_HEIGHTS"] = SunLegs::kHeights;
  slots.constants["AIR_SUNS"] = plan_.sunLegs ? SunLegs::kElevations : 0;
  slots.constants["AIR_PIECES"] = kPieces;
  slots.constants["AIR_BENDS"] = bendOf(simulation_) ? 1 : 0;
  slots.constants["AIR_PARTS"] = rows_.parts();
  slots.constants["AIR_VALUES"] = rows_.values() / 4;
  slots.constants["AIR_BLACKS"] = (plan_.nodeCount() + 3) / 4;
  slots.constants["AIR_SHELLS"] = static_cast<int>(simulation_.air->shells().size());
}

void LayeredOnGpu::addHeights(std::vector<float>& out) const {
  const Atmosphere& path = *simulation_.air;
  const auto put = [&](const AirAmounts& logs) {
    for (size_t k = 0; k < static_cast<size_t>(4 * rows_.vectors()); ++k) out.push_back(static_cast<float>(logs.amount[k]));
  };
  if (plan_.sunLegs) plan_.sunLegs->fill();
  for (int h = 0; plan_.sunLegs && h < SunLegs::kHeights; ++h)
    for (int e = 0; e < SunLegs::kElevations; ++e) put(plan_.sunLegs->rootAt(e, h));
  // From the top down, what lies above by Simpson's rule.
  const auto heightOf = [&](double h) { return SunLegs::heightAt(h, path.top_m()); };
  const int last = SunLegs::kHeights - 1;
  std::vector<AirAmounts> densities(static_cast<size_t>(last) + 1), columns(densities.size());
  for (int h = last; h >= 0; --h) {
    const auto at = static_cast<size_t>(h);
    densities[at] = path.densities(heightOf(h));
    dropShells(path.shells(), densities[at]);
    if (h == last) continue;
    const double low = heightOf(h), high = heightOf(h + 1);
    AirAmounts middle = path.densities(0.5 * (low + high));
    dropShells(path.shells(), middle);
    for (size_t k = 0; k < kMostAirAmounts; ++k)
      columns[at].amount[k] =
          columns[at + 1].amount[k] + (high - low) * 1e-3 / 6.0 * (densities[at].amount[k] + 4.0 * middle.amount[k] + densities[at + 1].amount[k]);
  }
  for (size_t h = 0; h < columns.size(); ++h) {
    for (double& d : densities[h].amount) d = std::log(std::max(d, kNothing));
    put(densities[h]);
    put(columns[h]);
  }
  if (const Refracts* bend = bendOf(simulation_))
    for (int h = 0; h <= last; ++h)
      for (double v : {bend->straightened_m(heightOf(h)), bend->bentBack_m(heightOf(h)), 0.0, 0.0}) out.push_back(static_cast<float>(v));
}

void LayeredOnGpu::begin() {
  first_ = true;
  for (Rows& r : kept_) {
    std::erase_if(r.at, [](const auto& row) { return !row.second.used; });
    for (auto& [where, row] : r.at) row.used = false;
  }
  kept_.remove_if([](const Rows& r) { return r.at.empty(); });
}

void LayeredOnGpu::update(const View& view, const WorldState& state) {
  if (!first_ && view.position == position_ && holds(grids_.below, simulation_, plan_, view, state)) return;
  first_ = false;
  position_ = view.position;
  const AirGrids grids = airGrids(simulation_, plan_, plan_.air, view, state);
  const Rows& below = rowsOf(grids.below);
  const Rows& above = grids.share > 0.0 ? rowsOf(grids.above) : below;
  if (grids == grids_) return;
  grids_ = grids;
  upload(below, above);
}

LayeredOnGpu::Rows& LayeredOnGpu::rowsOf(const AirGrid& grid) {
  auto known = std::find_if(kept_.begin(), kept_.end(), [&](const Rows& r) { return r.places == grid.places; });
  if (known == kept_.end()) {
    known = kept_.emplace(kept_.end());
    known->places = grid.places;
  }
  fill(*known, grid);
  return *known;
}

/// Those that it has not yet.
void LayeredOnGpu::fill(Rows& rows, const AirGrid& grid) {
  const double radius = simulation_.frame.earthRadius_m(), horizon = grid.horizon(radius), lowest = grid.lowestHorizon(radius);
  // By elevation: lines that differ in azimuth alone have most in common.
  std::vector<std::vector<std::pair<AirLine, AirRow*>>> missing;
  for (int e = 0; e < grid.elevations; ++e) {
    std::vector<std::pair<AirLine, AirRow*>> own;
    for (int a = 0; a < grid.azimuths; ++a) {
      AirLine line{grid.sineAt(e), grid.acrossAt(a), false};
      const auto [at, fresh] = rows.at.try_emplace(keyOf(line.across, line.sine));
      at->second.used = true;
      if (!fresh) continue;
      line.reachesSpace = !simulation_.ground || grid.sineAt(e + 1) >= lowest - kRoom;
      line.meetsHorizon = simulation_.ground && line.sine < horizon && grid.sineAt(e + 1) >= horizon;
      own.emplace_back(line, &at->second.row);
    }
    if (!own.empty()) missing.push_back(std::move(own));
  }
  if (missing.empty()) return;
  rows_.begin(grid);
  rows.black = rows_.black();
  std::atomic<size_t> next{0};
  auto work = [&] {
    for (size_t n = next++; n < missing.size(); n = next++) {
      SameElevation known;
      for (const auto& [line, row] : missing[n]) *row = rows_.at(line, &known);
    }
  };
  std::vector<std::future<void>> others;
  for (unsigned t = 1; t < std::thread::hardware_concurrency(); ++t) others.push_back(std::async(std::launch::async, work));
  work();
  for (auto& o : others) o.get();
}

namespace {

template <class T>
void mix(std::vector<T>& into, const std::vector<T>& a, const std::vector<T>& b, double share) {
  const T of = static_cast<T>(share);
  const size_t from = into.size();
  into.resize(from + a.size());
  for (size_t i = 0; i < a.size(); ++i) into[from + i] = a[i] + of * (b[i] - a[i]);
}

}  // namespace

void LayeredOnGpu::upload(const Rows& below, const Rows& above) {
  const AirGrid& grid = grids_.below;
  std::vector<float> amounts, radiance;
  std::vector<double> black;
  mix(black, below.black, above.black, grids_.share);
  for (int a = 0; a < grid.azimuths; ++a)
    for (int e = 0; e < grid.elevations; ++e) {
      const RowKey at = keyOf(grid.acrossAt(a), grid.sineAt(e));
      const AirRow &low = below.at.at(at).row, &high = above.at.at(at).row;
      if (a == 0) mix(amounts, low.amounts, high.amounts, grids_.share);  // of all azimuths
      mix(radiance, low.radiance, high.radiance, grids_.share);
    }
  amounts.insert(amounts.end(), heights_.begin(), heights_.end());
  amounts_.upload(amounts);
  radiance_.upload(radiance);

  std::vector<float> block;
  auto put = [&block](std::initializer_list<double> v) {
    for (double x : v) block.push_back(static_cast<float>(x));
  };
  put({grid.first, 1.0 / grid.places.step, grid.places.scale_m, grid.entriesPerLog()});
  put({grid.firstAcross, grid.azimuths > 1 ? 1.0 / grid.places.stepAcross : 0.0, static_cast<double>(grid.elevations),
       static_cast<double>(grid.places.ranges)});
  const Refracts* bend = bendOf(simulation_);
  put({static_cast<double>(grid.azimuths), bend ? bend->straightened_m(grid.places.height_m) - grid.places.height_m : 0.0, 0.0, 0.0});
  put({SunLegs::kBottom_m, (SunLegs::kHeights - 1) / std::sqrt(simulation_.air->top_m() - SunLegs::kBottom_m), plan_.sunLegs ? plan_.sunLegs->firstSine() : 0.0,
       plan_.sunLegs ? 1.0 / plan_.sunLegs->step() : 0.0});
  const auto powers = simulation_.air->exponents();
  const auto absorbers = static_cast<size_t>(4 * rows_.vectors());
  for (size_t k = 0; k < absorbers; ++k) put({k < powers.size() ? powers[k] : 1.0});
  for (double g : rows_.asymmetries()) put({g});
  for (size_t i = 0; i < (plan_.nodes.size() + 3) / 4 * 4; ++i) put({i < black.size() ? black[i] : 0.0});
  if (simulation_.air->shells().empty()) put({0.0, 0.0, 0.0, 0.0});
  for (const AirShell& s : straightShells(*simulation_.air)) put({s.low_m, s.high_m, s.per_m, static_cast<double>(s.amount)});
  block_.upload(block);
}

void LayeredOnGpu::takeTables(AirOnGpu& other) {
  if (auto* same = dynamic_cast<LayeredOnGpu*>(&other); same && same->perChannel_ == perChannel_) kept_ = std::move(same->kept_);
}

void LayeredOnGpu::bind() const {
  block_.bindUniform(3);
  coefficients_.bind();
  amounts_.bindTexture(20, 4);
  radiance_.bindTexture(21, 4);
}

}  // namespace pitviper
