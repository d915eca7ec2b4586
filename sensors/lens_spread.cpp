#include "sensors/lens_spread.hpp"

#include <algorithm>
#include <cmath>

#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {

void Lens::zoom(double focal_m) {
  focalLength_m = focal_m;
  fNumber = focal_m / aperture_m;
  blur_m = std::hypot(still_m, focal_m * jitter_rad);
}

void Lens::setCells(int cellsOfPixel) {
  cells = cellsOfPixel;
  cell_m = pitch_m / cellsOfPixel;
}

double Lens::blurCutoff_per_m() const { return std::sqrt(2.0 * 20.7) / (2.0 * kPi * blur_m); }

double Lens::transfer(double wavelength_um, double frequency_per_m) const {
  const double f = frequency_per_m, w = wavelength_um * 1e-6;
  double value = std::exp(-2.0 * kPi * kPi * blur_m * blur_m * f * f);
  if (!diffraction) return value;
  const double nu = f * w * fNumber;  // of the cut-off
  if (nu >= 1.0) return 0.0;
  value *= apertureTransfer(2.0 * nu, obscuration, defocus_m / (8.0 * fNumber * fNumber * w));
  return wavefront_m > 0.0 ? value * wavefrontTransfer(nu, wavefront_m / w) : value;
}

double Lens::wing_m(double wavelength_um) const {
  if (!diffraction) return 0.0;
  const double w = wavelength_um * 1e-6, waves = wavefront_m / w / kMostWavefront_waves;
  return w * fNumber * (4.0 / kPi / (1.0 - obscuration) + 4.0 * waves * waves) / (4.0 * kPi * kPi);
}

Waves wavesOf(const ChannelOutput& output) {
  constexpr int kWavelengths = 24;
  Waves all;
  double sum = 0.0;
  for (int k = 0; k < kWavelengths; ++k) {
    const double w = output.bandLow_um + (output.bandHigh_um - output.bandLow_um) * (k + 0.5) / kWavelengths, share = output.kernel(w);
    if (share > 0.0) all.emplace_back(w, share), sum += share;
  }
  if (all.empty()) all.emplace_back(0.5 * (output.bandLow_um + output.bandHigh_um), 1.0), sum = 1.0;
  for (auto& [w, share] : all) share /= sum;
  return all;
}

double transferOf(const Lens& lens, const Waves& waves, double frequency_per_m) {
  double sum = 0.0;
  for (const auto& [w, share] : waves) sum += share * lens.transfer(w, frequency_per_m);
  return sum;
}

namespace {

constexpr std::size_t kEntries = 2000;

}  // namespace

LensTransfer::LensTransfer(const Lens& lens, const ChannelOutput& output) {
  const Waves waves = wavesOf(output);
  for (const auto& [w, share] : waves) cutoff_ = std::max(cutoff_, lens.cutoff_per_m(w));
  if (lens.blur_m > 0.0) cutoff_ = std::min(cutoff_, lens.blurCutoff_per_m());
  last_ = std::min(cutoff_, std::sqrt(2.0) * kMostCycles / lens.cell_m);
  for (std::size_t k = 0; k <= kEntries; ++k) table_.push_back(transferOf(lens, waves, last_ * static_cast<double>(k) / kEntries));
}

double LensTransfer::operator()(double fx, double fy) const {
  const double x = std::sqrt(fx * fx + fy * fy) / last_ * kEntries;
  const auto k = static_cast<std::size_t>(x);
  return k >= kEntries ? 0.0 : table_[k] + (table_[k + 1] - table_[k]) * (x - static_cast<double>(k));
}

SpreadKernel kernelOf(const Lens& lens, const ChannelOutput& output, int reach) {
  const LensTransfer transfer(lens, output);
  return spreadKernel(transfer, transfer.cutoff_per_m(), lens.cell_m, reach);
}

std::optional<int> reachOf(const Lens& lens, const ChannelOutput& output) {
  // What a table and frequencies to 32 cycles a cell leave of a sum of 1.
  constexpr double kRounding = 1e-3;
  const LensTransfer transfer(lens, output);
  for (int reach = 2; reach <= kMostReach_cells; reach *= 2) {
    const SpreadKernel kernel = spreadKernel(transfer, transfer.cutoff_per_m(), lens.cell_m, reach);
    if (kernel.sum() < lens.leastShare - (reach == kMostReach_cells ? kRounding : 0.0)) continue;
    // The smallest square that has it.
    double within = kernel.at(0, 0);
    for (int r = 1; r < reach; ++r) {
      for (int i = -r; i <= r; ++i) within += 2.0 * (kernel.at(i, r) + (std::abs(i) < r ? kernel.at(r, i) : 0.0));
      if (r >= 2 && within >= lens.leastShare) return r;
    }
    return reach;
  }
  return std::nullopt;
}

LensSpread::LensSpread(const Lens& lens, const ChannelOutput& output) {
  const LensTransfer transfer(lens, output);
  enough = reachOf(lens, output).value_or(kMostReach_cells);
  if (!lens.diffraction) {
    // Gauss falls below 1e-12 of its middle.
    constexpr double kSigmas = 7.5;
    exactReach = std::max(enough, static_cast<int>(std::ceil(kSigmas * lens.blur_m / lens.cell_m)));
    near = spreadKernel(transfer, transfer.cutoff_per_m(), lens.cell_m, exactReach);
    whole = cut = {exactReach + 1.0, exactReach + 2.0};
    return;
  }
  for (const auto& [w, share] : wavesOf(output)) wing += share * lens.wing_m(w) / lens.cell_m;
  // Where cells are far wider than the point spread function its mean holds from the third on; far grids are to be coarser than the picture's cells.
  constexpr int kLeastExact = 6, kLeastCut = 64;
  exactReach = std::max(kLeastExact, 2 * enough);
  whole = {0.5 * exactReach, static_cast<double>(exactReach)};
  near.reach = std::max(kLeastCut, exactReach);
  cut = {0.5 * near.reach, static_cast<double>(near.reach)};
  const SpreadKernel exact = spreadKernel(transfer, transfer.cutoff_per_m(), lens.cell_m, exactReach);
  double sum = 0.0, exactSum = 0.0;
  for (int j = -near.reach; j <= near.reach; ++j)
    for (int i = -near.reach; i <= near.reach; ++i) {
      const double r = std::hypot(i, j), w = whole(r), own = w > 0.0 ? cut(r) * w * exact.at(i, j) : 0.0, wings = w < 1.0 ? cut(r) * (1.0 - w) * far(r) : 0.0;
      near.share.push_back(own + wings);
      sum += own + wings, exactSum += own;
    }
  // What lies far: 2 pi wing integral of (1 - cut) / r^2 dr.
  double beyond = 2.0 * kPi * wing / cut.end;
  for (const QuadratureNode& q : gaussLegendre(32, cut.begin, cut.end)) beyond += q.weight * 2.0 * kPi * wing * (1.0 - cut(q.x)) / (q.x * q.x);
  // Frequencies that are left out are of what is nearest.
  const double missing = 1.0 - beyond - sum;
  for (int j = -exactReach; j <= exactReach; ++j)
    for (int i = -exactReach; i <= exactReach; ++i)
      if (const double r = std::hypot(i, j), w = whole(r); w > 0.0)
        near.share[static_cast<std::size_t>((j + near.reach) * (2 * near.reach + 1) + i + near.reach)] += missing / exactSum * cut(r) * w * exact.at(i, j);
}

}  // namespace pitviper
