#pragma once
// What a lens makes of a point: its optical transfer function, and from it shares of light on cells of the film.
#include <cstdlib>
#include <functional>
#include <vector>

namespace pitviper {

/// OTF of a circular aperture of radius 1 with a central obscuration of radius `obscuration`, `defocus_waves` of defocus at its edge, for pupils shifted by
/// `shift` (0 to 2; frequency = shift / (2 lambda F)): real, 1 at 0.
///   OTF(s) = 1/A integral over both pupils of cos(4 pi W s x) dx dy, by chords in y.
/// Source: H. H. Hopkins, Proc. R. Soc. A 231, 91 (1955); unaberrated and unobscured it is 2/pi (acos(s/2) - s/2 sqrt(1 - s^2/4)).
double apertureTransfer(double shift, double obscuration, double defocus_waves);

/// Factor of a wavefront that is off by `rms_waves`: 1 - (W / 0.18)^2 (1 - 4 (nu - 1/2)^2), nu of the cut-off. Source: R. R. Shannon, The Art and Science of
/// Optical Design (1997). Valid to 0.18 waves, at which contrast vanishes at half the cut-off.
double wavefrontTransfer(double nu, double rms_waves);
constexpr double kMostWavefront_waves = 0.18;

/// Shares of the light of a cell that fall on it and its neighbours, of square cells, spread evenly within.
struct SpreadKernel {
  int reach = 0;              ///< cells to each side
  std::vector<double> share;  ///< (2 reach + 1)^2, row by row
  double sum() const;
  /// Contrast it leaves of a pattern of so many cycles a cell, cells being what they are.
  double transfer(double cyclesPerCell) const;
  double at(int i, int j) const { return share[static_cast<std::size_t>((j + reach) * (2 * reach + 1) + i + reach)]; }
};

/// A pattern of half a cycle a pixel of two cells has no alias then.
constexpr double kSampled = 0.75;
/// Beyond so many cycles a cell nothing is looked at: cells are then far wider than the point spread function, and a hundredth of a cell's light may be told as
/// its neighbours'. A whole number, at which sinc is 0, so that all shares together stay 1.
constexpr double kMostCycles = 32.0;
/// Of kernels that reach farther fewer cycles count, down to one: what is so wide has nothing finer in it, and their work (frequencies by frequencies by cells)
/// stays within a second.
double cyclesOf(int reach);

/// `transfer`: real and even, by frequency along x and y [1/m]; nothing beyond `cutoff`. Cells are means of what falls on them before it is spread.
/// Frequencies up to cyclesOf(reach) a cell count.
///   share(i, j) = c^2 integral of OTF(f) s(f) cos(2 pi c (i f_x + j f_y)) d2f
/// Where cells are fine enough to sample the point spread function (c cutoff <= kSampled; all shares together are then 1), s is 1: the means before stand for
/// those after. Where they are coarser, s = sinc^2(c f_x) sinc^2(c f_y): light lies evenly on the cell it comes from, and is averaged over the one it falls on.
SpreadKernel spreadKernel(const std::function<double(double fx, double fy)>& transfer, double cutoff_per_m, double cell_m, int reach);

/// Share of a point's light that falls on a cell, by how far the cell's middle is from the point: the point spread function averaged over the cell, once.
///   share(x, y) = c^2 integral of OTF(f) sinc(c f_x) sinc(c f_y) cos(2 pi c (x f_x + y f_y)) d2f, x and y in cells
/// Frequencies up to cyclesOf(reach) a cell count. Tabulated, cubic between entries.
class PointResponse {
 public:
  PointResponse(const std::function<double(double fx, double fy)>& transfer, double cutoff_per_m, double cell_m, int reach);
  int reach() const { return reach_; }  ///< cells to each side of the point's own
  double share(double x, double y) const;

 private:
  double entry(int i, int j) const {
    return table_[static_cast<std::size_t>(std::abs(j)) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(std::abs(i))];
  }
  int reach_, steps_, side_;  ///< entries a cell; a side of the quarter that is kept
  std::vector<double> table_;
};

}  // namespace pitviper
