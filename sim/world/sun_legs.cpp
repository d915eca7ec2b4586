#include "sim/world/sun_legs.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <tuple>

#include "sim/parameters/on_threads.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace {

/// Steps of sine on the horizon, where the air mass bends most (scale of its sine: 1/38), and their growth with the sun's height.
constexpr double kStep = 0.0035, kGrowth = 10.0;
/// Entries below the sun's own sine. Of a sun below the level, which high places see, they reach from the level to its depth below and so far beyond.
constexpr int kBelow = 6;
constexpr double kAbove = 0.025;

}  // namespace

RisenSun risenSun(double height_m, double sinElevation, double earthRadius_m) {
  const double x = physics::sunAboveHorizon(height_m, sinElevation, earthRadius_m);
  return {physics::sunShare(x),
          std::min(sinElevation + physics::sunRise(x) * physics::sunRadius() * std::sqrt(std::max(1.0 - sinElevation * sinElevation, 0.0)), 1.0)};
}

SunLegs::SunLegs(std::shared_ptr<const Atmosphere> path, double sinElevation, double earthRadius_m)
    : path_(std::move(path)),
      step_(sinElevation < 0.0 ? std::max(kStep, (kAbove - sinElevation) / (kElevations - 1)) : kStep * (1.0 + kGrowth * sinElevation)),
      first_(std::clamp(sinElevation - kBelow * step_, 0.0, std::max(1.0 - (kElevations - 1) * step_, 0.0))),
      radius_m_(earthRadius_m),
      top_m_(path_->top_m()),
      roots_(static_cast<size_t>(kElevations) * kHeights),
      made_(kHeights),
      bends_(dynamic_cast<const Refracts*>(path_.get())) {
  if (bends_ && !bends_->bends()) bends_ = nullptr;
}

const AirAmounts* SunLegs::rowAt(int height) const {
  AirAmounts* row = &roots_[static_cast<size_t>(height * kElevations)];
  std::call_once(made_[static_cast<size_t>(height)], [&] {
    for (int e = 0; e < kElevations; ++e) {
      row[e] = path_->amounts({heightAt(height, top_m_), first_ + step_ * e, radius_m_}, physics::kFar);
      dropShells(path_->shells(), row[e]);
      for (double& w : row[e].amount) w = std::sqrt(std::max(w, 0.0));
    }
  });
  return row;
}

void SunLegs::fill() const {
  onAllThreads(kHeights, [&](const auto& next) {
    for (size_t h = next(); h < kHeights; h = next()) rowAt(static_cast<int>(h));
  });
}

std::shared_ptr<const SunLegs> SunLegs::of(const std::shared_ptr<const Atmosphere>& path, double sinElevation, double earthRadius_m) {
  // Who keeps one keeps its path: no other has the same address meanwhile.
  using Key = std::tuple<const Atmosphere*, double, double>;
  static std::mutex mutex;
  static std::map<Key, std::weak_ptr<const SunLegs>> all;
  const std::scoped_lock lock(mutex);
  std::erase_if(all, [](const auto& kept) { return kept.second.expired(); });
  auto& kept = all[{path.get(), sinElevation, earthRadius_m}];
  if (auto legs = kept.lock()) return legs;
  auto legs = std::make_shared<const SunLegs>(path, sinElevation, earthRadius_m);
  kept = legs;
  return legs;
}

double SunLegs::heightAt(double entry, double top_m) {
  const double t = entry / (kHeights - 1);
  return kBottom_m + (top_m - kBottom_m) * t * t;
}

bool SunLegs::has(double height_m, double sine) const {
  return height_m < top_m_ && height_m >= kBottom_m && sine >= first_ && sine <= first_ + (kElevations - 1) * step_;
}

AirAmounts SunLegs::at(double height_m, double sine) const {
  const double lowest_m = sine < 0.0 ? lowestOn(height_m, sine) : 0.0;
  if (!has(height_m, std::abs(sine)) || (sine < 0.0 && !has(lowest_m, 0.0))) return path_->amounts({height_m, sine, radius_m_}, physics::kFar);
  AirAmounts a = upwards(height_m, std::abs(sine));
  if (sine < 0.0) {
    const AirAmounts half = upwards(lowest_m, 0.0);
    for (size_t k = 0; k < a.amount.size(); ++k) a.amount[k] = std::max(2.0 * half.amount[k] - a.amount[k], 0.0);
  }
  addShells(*path_, {height_m, sine, radius_m_}, physics::kFar, a);
  return a;
}

double SunLegs::lowestOn(double height_m, double sine) const {
  const double h = bends_ ? bends_->straightened_m(height_m) : height_m;
  const double lowest = h - (radius_m_ + h) * sine * sine / (1.0 + std::sqrt(std::max(1.0 - sine * sine, 0.0)));
  return bends_ ? bends_->bentBack_m(lowest) : lowest;
}

AirAmounts SunLegs::upwards(double height_m, double sine) const {
  const double x = (sine - first_) / step_, t = std::sqrt((height_m - kBottom_m) / (top_m_ - kBottom_m)) * (kHeights - 1);
  const int h = std::min(static_cast<int>(t), kHeights - 2), e = std::clamp(static_cast<int>(x) - 1, 0, kElevations - 4);
  // Linear in height, not in its root.
  const double low = heightAt(h, top_m_), high = (height_m - low) / (heightAt(h + 1, top_m_) - low), f = x - e;
  // Lagrange's cubic through four entries.
  const double weight[] = {(f - 1) * (f - 2) * (3 - f) / 6, f * (f - 2) * (f - 3) / 2, f * (f - 1) * (3 - f) / 2, f * (f - 1) * (f - 2) / 6};
  AirAmounts a;
  const size_t used = path_->exponents().size();
  const AirAmounts *below = rowAt(h) + e, *above = rowAt(h + 1) + e;
  for (size_t k = 0; k < used; ++k) {
    double root = 0.0;
    for (int j = 0; j < 4; ++j) root += weight[j] * ((1 - high) * below[j].amount[k] + high * above[j].amount[k]);
    a.amount[k] = root > 0.0 ? root * root : 0.0;
  }
  return a;
}

}  // namespace pitviper
