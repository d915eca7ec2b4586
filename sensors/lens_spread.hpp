#pragma once
// The lens of a camera: its transfer function for light of a channel, and from it what it makes of a cell's light near and far.
#include <optional>
#include <utility>
#include <vector>

#include "sensors/optical_transfer.hpp"
#include "sim/model/channel.hpp"

namespace pitviper {

struct Lens {
  bool diffraction = true;
  double fNumber = 1.0;
  double obscuration = 0.0;  ///< of the aperture's diameter
  double wavefront_m = 0.0;  ///< rms
  double defocus_m = 0.0;    ///< of the film along the axis
  double still_m = 0.0;      ///< blur of Gauss, rms along one direction on the film
  double jitter_rad = 0.0;
  double blur_m = 0.0;        ///< both
  double veilingGlare = 0.0;  ///< share of the light that is spread evenly
  double focalLength_m = 1.0, aperture_m = 1.0, pitch_m = 1.0;
  int cells = 1;
  double cell_m = 0.0;
  double leastShare = 0.99;  ///< of light within reachOf()

  void zoom(double focal_m);
  void setCells(int cellsOfPixel);
  double cutoff_per_m(double wavelength_um) const { return diffraction ? 1.0 / (wavelength_um * 1e-6 * fNumber) : blurCutoff_per_m(); }
  /// Where Gauss is 1e-9.
  double blurCutoff_per_m() const;
  double transfer(double wavelength_um, double frequency_per_m) const;
  /// The point spread function far from a point, its rings averaged, is wing / r^3 of its light per area (r: distance): s / (4 pi^2), s = -d OTF / df at 0.
  ///   s = lambda F (4 / pi / (1 - e) + 4 (W / 0.18)^2), e: obscuration; of Shannon's wavefront factor the second.
  /// Source: an OTF that has a cone's tip at 0 is a plane's transform of 1 / r^3 (R. N. Bracewell, The Fourier Transform and Its Applications); the lost
  /// overlap of shifted apertures is the shift times their edges' width. Of a clear aperture that is Airy's pattern averaged over its rings, lambda F / (pi
  /// r)^3.
  double wing_m(double wavelength_um) const;
};

/// Wavelengths within an output's kernel and their shares, of light that is even over it.
using Waves = std::vector<std::pair<double, double>>;
Waves wavesOf(const ChannelOutput& output);
double transferOf(const Lens& lens, const Waves& waves, double frequency_per_m);

/// The OTF of an output's light, round, as a table over frequency.
class LensTransfer {
 public:
  LensTransfer(const Lens& lens, const ChannelOutput& output);
  double cutoff_per_m() const { return cutoff_; }
  double operator()(double fx, double fy) const;

 private:
  double cutoff_ = 0.0, last_ = 0.0;
  std::vector<double> table_;
};

/// Cells to each side within which a lens keeps its least share of a point's light; none: more than kMostReach_cells.
constexpr int kMostReach_cells = 128;
std::optional<int> reachOf(const Lens& lens, const ChannelOutput& output);
/// Shares of a cell's light within a reach.
SpreadKernel kernelOf(const Lens& lens, const ChannelOutput& output, int reach);

/// 1 up to a distance, 0 from another on, and bent nowhere: by u^3 (10 - 15 u + 6 u^2).
struct SmoothStep {
  double begin = 0.0, end = 1.0;
  double operator()(double r) const {
    const double u = r <= begin ? 0.0 : r >= end ? 1.0 : (r - begin) / (end - begin);
    return 1.0 - u * u * u * (10.0 - 15.0 * u + 6.0 * u * u);
  }
};

/// What a lens makes of a cell's light at any distance r [cells], in pieces that end nowhere:
///   near(r) + (1 - cut(r)) wing / r^3,  near = cut (exact share x whole + (1 - whole) wing / r^3)
/// Exact shares, with their rings, give way to the mean fall-off between half of and all of the reach that they are worked out to, and what is near to what is
/// far, which coarser grids hold (FarWings), a little farther on. So no distance is the kernel's edge, however bright a thing is; all shares together are 1.
struct LensSpread {
  LensSpread(const Lens& lens, const ChannelOutput& output);
  double wing = 0.0;       ///< [cells]
  int enough = 0;          ///< reachOf() [cells]
  int exactReach = 0;      ///< cells
  SmoothStep whole, cut;
  SpreadKernel near;       ///< to cut's end
  double far(double r) const { return wing / (r * r * r); }
};

}  // namespace pitviper
