// The lens: a point spread function by diffraction, wavefront, defocus, blur and jitter, of each channel its own.
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "sensors/convolution.hpp"
#include "sensors/side_by_side.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr int kMostReach_cells = 128;

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
  double leastShare = 0.99;  ///< of light within the kernel

  void zoom(double focal_m) {
    focalLength_m = focal_m;
    fNumber = focal_m / aperture_m;
    blur_m = std::hypot(still_m, focal_m * jitter_rad);
  }
  void setCells(int cellsOfPixel) {
    cells = cellsOfPixel;
    cell_m = pitch_m / cellsOfPixel;
  }
  double cutoff_per_m(double wavelength_um) const { return diffraction ? 1.0 / (wavelength_um * 1e-6 * fNumber) : blurCutoff_per_m(); }
  /// Where Gauss is 1e-9.
  double blurCutoff_per_m() const { return std::sqrt(2.0 * 20.7) / (2.0 * kPi * blur_m); }
  double transfer(double wavelength_um, double frequency_per_m) const {
    const double f = frequency_per_m, w = wavelength_um * 1e-6;
    double value = std::exp(-2.0 * kPi * kPi * blur_m * blur_m * f * f);
    if (!diffraction) return value;
    const double nu = f * w * fNumber;  // of the cut-off
    if (nu >= 1.0) return 0.0;
    value *= apertureTransfer(2.0 * nu, obscuration, defocus_m / (8.0 * fNumber * fNumber * w));
    return wavefront_m > 0.0 ? value * wavefrontTransfer(nu, wavefront_m / w) : value;
  }
};

/// Wavelengths within a kernel and their shares.
using Waves = std::vector<std::pair<double, double>>;

/// Of light that is even over an output's kernel.
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

/// The OTF of an output's light, round, as a table over frequency.
class Transfer {
 public:
  Transfer(const Lens& lens, const ChannelOutput& output) {
    const Waves waves = wavesOf(output);
    for (const auto& [w, share] : waves) cutoff_ = std::max(cutoff_, lens.cutoff_per_m(w));
    if (lens.blur_m > 0.0) cutoff_ = std::min(cutoff_, lens.blurCutoff_per_m());
    last_ = std::min(cutoff_, std::sqrt(2.0) * kMostCycles / lens.cell_m);
    for (int k = 0; k <= kEntries; ++k) table_.push_back(transferOf(lens, waves, last_ * k / kEntries));
  }
  double cutoff_per_m() const { return cutoff_; }
  double operator()(double fx, double fy) const {
    const double x = std::sqrt(fx * fx + fy * fy) / last_ * kEntries;
    const auto k = static_cast<std::size_t>(x);
    return k >= kEntries ? 0.0 : table_[k] + (table_[k + 1] - table_[k]) * (x - static_cast<double>(k));
  }

 private:
  static constexpr int kEntries = 2000;
  double cutoff_ = 0.0, last_ = 0.0;
  std::vector<double> table_;
};

SpreadKernel kernelOf(const Lens& lens, const ChannelOutput& output, int mostReach) {
  const Transfer transfer(lens, output);
  for (int reach = std::min(2, mostReach);; reach = std::min(2 * reach, mostReach)) {
    SpreadKernel kernel = spreadKernel(transfer, transfer.cutoff_per_m(), lens.cell_m, reach);
    if (kernel.sum() >= lens.leastShare || reach == mostReach) return kernel;
  }
}

/// The first of a camera's outputs that is spread as this one is: counts and what is told of them begin as the same photoelectrons.
std::size_t firstAlike(const std::vector<ChannelOutput>& outputs, std::size_t o) {
  for (std::size_t k = 0; outputs[o].detected && k < o; ++k)
    if (outputs[k].detected && outputs[k].channel == outputs[o].channel) return k;
  return o;
}

std::vector<SpreadKernel> kernelsOf(const Lens& lens, const std::vector<ChannelOutput>& outputs, int mostReach) {
  std::vector<SpreadKernel> all;
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const std::size_t alike = firstAlike(outputs, o);
    all.push_back(alike < o ? all[alike] : kernelOf(lens, outputs[o], mostReach));
  }
  return all;
}

/// The fewest cells of a pixel on which contrast at half a cycle a pixel is the lens's own, in all channels; at most so many that pictures still fit.
int fewestCells(Lens lens, const Camera& camera) {
  constexpr int kMost = 4;
  constexpr double kOff = 0.01;
  const double nyquist = 0.5 / lens.pitch_m;
  for (int cells = 1; cells < kMost; ++cells) {
    lens.setCells(cells);
    const auto isGood = [&](const ChannelOutput& o) {
      const Transfer transfer(lens, o);
      // Light that lies evenly on its cell, or stands in its middle, and is averaged over a pixel of cells.
      const SpreadKernel kernel = kernelOf(lens, o, kMostReach_cells);
      const double x = nyquist * lens.cell_m, ofCells = std::sin(kPi * x * cells) / (cells * std::sin(kPi * x)), own = 2.0 / kPi;
      return std::abs(kernel.transfer(x) * ofCells * std::sin(kPi * x) / (kPi * x) - transfer(nyquist, 0.0) * own) <= kOff;
    };
    if (std::all_of(camera.outputs.begin(), camera.outputs.end(), isGood)) return cells;
  }
  return kMost;
}

class PointSpreadStage final : public SensorStage {
 public:
  PointSpreadStage(const Lens& lens, std::vector<SpreadKernel> kernels) : lens_(lens), kernels_(std::move(kernels)) {}
  void run(const SensorTick& tick, SensorPictures& pictures) override {
    follow(tick, pictures);
    const std::vector<SensorPoint> points = std::move(pictures.points);
    pictures.points.clear();
    for (std::size_t o = 0; o < kernels_.size(); ++o) {
      if (spread_.size() <= o) spread_.emplace_back(kernels_[o], pictures.width, pictures.height);
      std::vector<float>& picture = pictures.values(o);
      if (const std::size_t alike = firstAlike(pictures.outputs, o); alike < o) {
        picture = pictures.values(alike);
        continue;
      }
      double mean = 0.0;
      for (float v : picture) mean += static_cast<double>(v) / static_cast<double>(picture.size());
      spread_[o].apply(picture);
      // What the kernel does not hold lies evenly over the film.
      const double within = 1.0 - lens_.veilingGlare, veil = mean * (lens_.veilingGlare + within * std::max(0.0, 1.0 - kernels_[o].sum()));
      for (float& v : picture) v = static_cast<float>(within * static_cast<double>(v) + veil);
      addPoints(points, o, pictures, picture);
    }
  }

 private:
  /// Points at their own places: shares of each on the cells around it, and what falls farther away.
  void addPoints(const std::vector<SensorPoint>& points, std::size_t o, const SensorPictures& pictures, std::vector<float>& picture) {
    std::vector<double> sum;
    const double within = 1.0 - lens_.veilingGlare;
    double veil = 0.0;
    // Each looks at all cells: of many points on large pictures the far light lies evenly, as that of cells does.
    constexpr double kMostSteps = 2e7;
    const auto own = std::count_if(points.begin(), points.end(), [&](const SensorPoint& p) { return p.output == o; });
    const bool tails = lens_.diffraction && static_cast<double>(own) * static_cast<double>(picture.size()) <= kMostSteps;
    for (const SensorPoint& p : points) {
      if (p.output != o) continue;
      if (sum.empty()) sum.assign(picture.begin(), picture.end());
      auto& response = responses_[o];
      if (!response) {
        const Transfer transfer(lens_, pictures.outputs[o]);
        response = std::make_unique<PointResponse>(transfer, transfer.cutoff_per_m(), lens_.cell_m, kernels_[o].reach);
      }
      const int column = static_cast<int>(std::floor(p.column)), row = static_cast<int>(std::floor(p.row)), reach = response->reach();
      double all = 0.0;
      for (int y = row - reach; y <= row + reach; ++y)
        for (int x = column - reach; x <= column + reach; ++x) {
          const double share = within * response->share(x + 0.5 - p.column, y + 0.5 - p.row);
          all += share;
          if (x < 0 || y < 0 || x >= pictures.width || y >= pictures.height) continue;
          const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(x);
          sum[cell] += share * pictures.inCell(p, cell);
        }
      const double far = std::max(0.0, within - all);
      veil += (1.0 - within + (tails ? 0.0 : far)) * pictures.inCell(p, picture.size() / 2) / static_cast<double>(picture.size());
      if (tails) addTail(p, far, reach, column, row, pictures, sum);
    }
    for (std::size_t c = 0; c < sum.size(); ++c) picture[c] = static_cast<float>(std::max(0.0, sum[c] + veil));
  }

  /// What diffraction sends beyond a square of cells around a point falls off as the cube of the distance from it (an edge of the aperture; J. W. Goodman, Introduction to
  /// Fourier Optics, of Airy's pattern averaged over its rings): c / r^3, whose integral beyond a square of half a side a is 4 sqrt(2) c / a.
  static void addTail(const SensorPoint& p, double far, int reach, int column, int row, const SensorPictures& pictures, std::vector<double>& sum) {
    const double c = far * (reach + 0.5) / (4.0 * std::sqrt(2.0));
    sideBySide(pictures.height, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = 0; x < pictures.width; ++x) {
          if (std::abs(x - column) <= reach && std::abs(y - row) <= reach) continue;
          const double dx = x + 0.5 - p.column, dy = y + 0.5 - p.row, r2 = dx * dx + dy * dy;
          const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(x);
          sum[cell] += c / (r2 * std::sqrt(r2)) * pictures.inCell(p, cell);
        }
    });
  }

  /// Another stage may ask for finer cells, and a lens zooms. Kernels stay within the margin that there is.
  void follow(const SensorTick& tick, const SensorPictures& pictures) {
    const double focal = tick.focalLength_m > 0.0 ? tick.focalLength_m : lens_.focalLength_m;
    if (pictures.cells == lens_.cells && std::abs(focal / lens_.focalLength_m - 1.0) < 1e-9) return;
    lens_.zoom(focal);
    lens_.setCells(pictures.cells);
    spread_.clear();
    responses_.clear();
    kernels_ = kernelsOf(lens_, pictures.outputs, std::min(kMostReach_cells, pictures.margin_px * lens_.cells));
  }

  Lens lens_;
  std::vector<SpreadKernel> kernels_;
  std::vector<Convolution> spread_;
  std::map<std::size_t, std::unique_ptr<PointResponse>> responses_;  ///< by output, once there are points
};

StageChoice readPointSpread(const Record& r, const Camera& camera) {
  Lens lens;
  const Pinhole& p = camera.pinhole;
  if (std::abs(p.pitchX_m / p.pitchY_m - 1.0) > 1e-9)
    throw UserError(r.where(), "a point spread function on pixels that are not square", "'pitch' without 'pitch_y'", "remove pitch_y, or the stage");
  StageChoice choice;
  choice.cells = r.given("cells") ? static_cast<int>(r.integer("cells")) : 1;
  lens.aperture_m = p.apertureDiameter_m;
  lens.pitch_m = p.pitchX_m;
  lens.setCells(choice.cells);
  lens.diffraction = r.boolean("diffraction");
  lens.obscuration = r.number("obscuration");
  lens.wavefront_m = r.number("wavefront_error");
  lens.defocus_m = r.number("defocus");
  lens.still_m = r.number("blur");
  lens.jitter_rad = r.number("jitter");
  lens.zoom(p.focalLength_m);
  lens.veilingGlare = r.number("veiling_glare");
  lens.leastShare = 1.0 - r.number("beyond");
  for (const char* key : {"obscuration", "wavefront_error", "defocus"})
    if (!lens.diffraction && r.number(key) > 0.0)
      throw UserError(r.where(key), std::string("'") + key + "' of a lens that does not diffract", "'diffraction: true'", "remove one of them");
  constexpr double kNarrow = 0.1;  // of a cell: beyond, shares are as good as those of none
  if (!lens.diffraction && lens.blur_m < kNarrow * lens.cell_m)
    throw UserError(r.where(), "a point spread function of no width", "'diffraction: true', or a 'blur' or 'jitter' of a tenth of a cell or more",
                    "give one, or remove the stage");
  for (const ChannelOutput& o : camera.outputs)
    if (lens.wavefront_m > kMostWavefront_waves * o.bandLow_um * 1e-6)
      throw UserError(r.where("wavefront_error"), "a wavefront error of more than 0.18 waves in channel '" + o.channel + "'",
                      "at most " + std::to_string(kMostWavefront_waves * o.bandLow_um) + " um", "lower it, or say it as 'blur'");
  if (!r.given("cells")) {
    choice.cells = fewestCells(lens, camera);
    lens.setCells(choice.cells);
  }
  const std::vector<SpreadKernel> kernels = kernelsOf(lens, camera.outputs, kMostReach_cells);
  for (std::size_t o = 0; o < kernels.size(); ++o) {
    choice.margin_px = std::max(choice.margin_px, (kernels[o].reach + choice.cells - 1) / choice.cells);
    if (kernels[o].sum() < lens.leastShare - 1e-3)
      throw UserError(r.where(), "a point spread function that is wider than 128 cells in channel '" + camera.outputs[o].channel + "'",
                      "most of its light within them", "lower 'cells', defocus or blur");
  }
  constexpr int kLeast_px = 2;  // of the smallest kernel
  if (choice.margin_px > kLeast_px && 2 * choice.margin_px > std::max(p.width, p.height))
    throw UserError(r.where(), "a point spread function wider than the film: " + std::to_string(choice.margin_px) + " pixels to each side",
                    "half the film at most", "let more of it go into the even veil ('beyond'), or enlarge the film");
  const double within = 1.0 - lens.veilingGlare;
  choice.transfer = [lens, within](const ChannelOutput& o, double frequency_per_m) { return within * transferOf(lens, wavesOf(o), frequency_per_m); };
  choice.drawnTransfer = [lens, within](const ChannelOutput& o, double frequency_per_m) {
    return within * kernelOf(lens, o, kMostReach_cells).transfer(frequency_per_m * lens.cell_m);
  };
  choice.takesPoints = true;
  // Tables are made once for each output and focal length: near ones, or far ones once those are asked for.
  const auto known = std::make_shared<std::map<std::tuple<std::string, double, int>, PointResponse>>();
  choice.pixelShare = [lens, within, known](const ChannelOutput& o, double focal_m, double x, double y) {
    constexpr int kNear = 2;
    const int needed = static_cast<int>(std::ceil(std::max(std::abs(x), std::abs(y)))), reach = needed <= kNear ? kNear : (needed + 31) / 32 * 32;
    auto at = known->find({o.layer(), focal_m, reach});
    if (at == known->end()) {
      Lens zoomed = lens;
      zoomed.zoom(focal_m);
      const Transfer transfer(zoomed, o);
      at = known->emplace(std::tuple(o.layer(), focal_m, reach), PointResponse(transfer, transfer.cutoff_per_m(), zoomed.pitch_m, reach)).first;
    }
    return within * at->second.share(x, y);
  };
  choice.make = [lens, kernels](const ShaderLibrary&) { return std::make_unique<PointSpreadStage>(lens, kernels); };
  return choice;
}

}  // namespace

StageModel pointSpreadModel() {
  return {
      "point_spread",
      "What the lens makes of points: diffraction at the aperture, wavelength by wavelength within a channel (for light that is even over it), with wavefront "
      "error, defocus, blur and jitter, on cells of a pixel. What it sends farther than its kernel reaches is an even veil.",
      {withDefault(boolean("diffraction", "at a circular aperture of the camera's F number"), "true"),
       withDefault(within(number("obscuration", "", "of the aperture, by diameter"), 0, 0.9), "0"),
       withDefault(within(number("wavefront_error", "m", "rms, after Shannon; up to 0.18 waves"), 0, 1e-3), "0 um"),
       withDefault(within(number("defocus", "m", "of the film along the axis"), 0, 1), "0 um"),
       withDefault(within(number("blur", "m", "of Gauss on the film, rms along one direction"), 0, 1), "0 um"),
       withDefault(within(number("jitter", "rad", "of the line of sight within an exposure, rms along one direction"), 0, 0.1), "0 rad"),
       withDefault(within(number("veiling_glare", "", "share of the light that the lens spreads evenly"), 0, 0.9), "0"),
       integer("cells", "cells a side of a pixel; unless given the fewest, up to 4, that leave contrast at half a cycle a pixel within 0.01", 1, 16),
       withDefault(within(above(number("beyond", "", "share of a point's light that may go into the veil rather than lie where it is"), 0), 0, 0.2), "0.01")},
      readPointSpread};
}

}  // namespace pitviper
