#include "sim/model/two_stream.hpp"

#include <algorithm>
#include <cmath>

namespace pitviper {
namespace {

/// Scattering without any loss has no decay to divide by: 1e-9 of loss is far below what matters.
constexpr double kMostAlbedo = 1.0 - 1e-9;
/// The sun no lower than this: one and a half degrees; a flat layer has no lower sun.
constexpr double kLowestSun = 0.026;

}  // namespace

TwoStream::TwoStream(double depth, double albedo, double asymmetry, double sinSun, double groundAlbedo) {
  const double w0 = std::clamp(albedo, 0.0, kMostAlbedo), peak = asymmetry * asymmetry;
  shrink_ = 1.0 - w0 * peak;
  const double w = std::min((1.0 - peak) * w0 / shrink_, kMostAlbedo), g = asymmetry / (1.0 + asymmetry);
  depth_ = scaled(depth);
  sun_ = std::max(sinSun, kLowestSun);
  const double g1 = (7.0 - w * (4.0 + 3.0 * g)) / 4.0, g2 = -(1.0 - w * (4.0 - 3.0 * g)) / 4.0;
  k_ = std::sqrt(std::max(g1 * g1 - g2 * g2, 1e-18));
  // The beam decays as fast as the layer's own light: a hair aside from it.
  if (std::abs(k_ * sun_ - 1.0) < 1e-6) sun_ *= 1.0 + 1e-5;
  const double g3 = (2.0 - 3.0 * g * sun_) / 4.0, g4 = 1.0 - g3;
  // What goes with the beam: (g1 + 1/m) up - g2 down = w g3, g2 up - (g1 - 1/m) down = -w g4.
  const double a = g1 + 1.0 / sun_, d = g1 - 1.0 / sun_, det = g2 * g2 - a * d;
  up_ = (-w * g3 * d - w * g4 * g2) / det;
  down_ = (-a * w * g4 - g2 * w * g3) / det;
  // And by itself: rising (1, mix) exp(k (t - depth)) + falling (mix, 1) exp(-k t).
  mix_ = g2 / (g1 + k_);
  const double through = std::exp(-k_ * depth_), beam = std::exp(-depth_ / sun_);
  const double a11 = mix_ * through, b1 = -down_;
  const double a21 = 1.0 - groundAlbedo * mix_, a22 = through * (mix_ - groundAlbedo), b2 = (groundAlbedo * (sun_ + down_) - up_) * beam;
  const double whole = a11 * a22 - a21;
  rising_ = (b1 * a22 - b2) / whole;
  falling_ = (a11 * b2 - a21 * b1) / whole;
}

TwoStream::Fluxes TwoStream::at(double depth) const {
  const double t = std::clamp(scaled(depth), 0.0, depth_), beam = std::exp(-t / sun_), rising = rising_ * std::exp(k_ * (t - depth_)),
               falling = falling_ * std::exp(-k_ * t);
  // Eddington's fluxes can come out below 0 by a little where next to nothing is scattered.
  return {beam, std::max(mix_ * rising + falling + down_ * beam, 0.0), std::max(rising + mix_ * falling + up_ * beam, 0.0)};
}

double TwoStream::onLevel(double depth) const {
  const Fluxes f = at(depth);
  return sun_ * f.beam + f.down;
}

}  // namespace pitviper
