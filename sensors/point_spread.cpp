// The lens: a point spread function by diffraction, wavefront, defocus, blur and jitter, of each channel its own.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <memory>
#include <tuple>

#include "sensors/convolution.hpp"
#include "sensors/far_wings.hpp"
#include "sensors/lens_spread.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// The first of a camera's outputs that is spread as this one is: counts and what is told of them begin as the same photoelectrons.
std::size_t firstAlike(const std::vector<ChannelOutput>& outputs, std::size_t o) {
  for (std::size_t k = 0; outputs[o].detected && k < o; ++k)
    if (outputs[k].detected && outputs[k].channel == outputs[o].channel) return k;
  return o;
}

/// The fewest cells of a pixel on which contrast at half a cycle a pixel is the lens's own, in all channels; at most so many that pictures still fit.
int fewestCells(Lens lens, const Camera& camera) {
  constexpr int kMost = 4;
  constexpr double kOff = 0.01;
  const double nyquist = 0.5 / lens.pitch_m;
  for (int cells = 1; cells < kMost; ++cells) {
    lens.setCells(cells);
    const auto isGood = [&](const ChannelOutput& o) {
      const LensTransfer transfer(lens, o);
      // Light that lies evenly on its cell, or stands in its middle, and is averaged over a pixel of cells.
      const SpreadKernel kernel = kernelOf(lens, o, reachOf(lens, o).value_or(kMostReach_cells));
      const double x = nyquist * lens.cell_m, ofCells = std::sin(kPi * x * cells) / (cells * std::sin(kPi * x)), own = 2.0 / kPi;
      return std::abs(kernel.transfer(x) * ofCells * std::sin(kPi * x) / (kPi * x) - transfer(nyquist, 0.0) * own) <= kOff;
    };
    if (std::all_of(camera.outputs.begin(), camera.outputs.end(), isGood)) return cells;
  }
  return kMost;
}

/// What a picture is beside its bright things: the middle of its values.
double levelOf(const std::vector<float>& picture) {
  constexpr std::size_t kLookedAt = 16384;
  std::vector<float> some;
  const std::size_t step = picture.size() / kLookedAt + 1;
  for (std::size_t k = 0; k < picture.size(); k += step) some.push_back(picture[k]);
  std::nth_element(some.begin(), some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2), some.end());
  return static_cast<double>(some[some.size() / 2]);
}

class PointSpreadStage final : public SensorStage {
 public:
  explicit PointSpreadStage(const Lens& lens) : lens_(lens) {}
  void run(const SensorTick& tick, SensorPictures& pictures) override {
    follow(tick, pictures);
    const std::vector<SensorPoint> points = std::move(pictures.points);
    pictures.points.clear();
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      std::vector<float>& picture = pictures.values(o);
      if (const std::size_t alike = firstAlike(pictures.outputs, o); alike < o) {
        picture = pictures.values(alike);
        continue;
      }
      Spread& spread = spreadOf(o, pictures);
      // Beyond what is drawn a picture goes on as it is in the middle of its values: bright things end with it.
      const double level = levelOf(picture);
      std::vector<double> sum = spread.near->operator()(picture, level);
      double mean = 0.0;
      for (float v : picture) mean += static_cast<double>(v) / static_cast<double>(picture.size());
      if (spread.far) spread.far->gather(picture, level);
      for (const SensorPoint& p : points)
        if (p.output == o) mean += addPoint(p, spread, pictures, sum) / static_cast<double>(picture.size());
      if (spread.far) spread.far->spread(sum);
      const double within = 1.0 - lens_.veilingGlare, veil = lens_.veilingGlare * mean;
      for (std::size_t c = 0; c < sum.size(); ++c) picture[c] = static_cast<float>(std::max(0.0, within * (sum[c] + level) + veil));
    }
  }

 private:
  struct Spread {
    LensSpread law;
    std::unique_ptr<Convolution> near;
    std::unique_ptr<FarWings> far;            ///< none of a lens that does not diffract
    std::unique_ptr<PointResponse> response;  ///< once there are points
  };

  Spread& spreadOf(std::size_t o, const SensorPictures& pictures) {
    const auto at = spreads_.find(o);
    if (at != spreads_.end()) return at->second;
    Spread s{LensSpread(lens_, pictures.outputs[o]), nullptr, nullptr, nullptr};
    s.near = std::make_unique<Convolution>(s.law.near, pictures.width, pictures.height, std::min(s.law.enough, pictures.margin_px * pictures.cells));
    if (s.law.wing > 0.0) s.far = std::make_unique<FarWings>(s.law, pictures.width, pictures.height);
    return spreads_.emplace(o, std::move(s)).first->second;
  }

  /// A point at its own place: shares of it on the cells around, and what goes far. Returns its light as that of one cell.
  double addPoint(const SensorPoint& p, Spread& spread, const SensorPictures& pictures, std::vector<double>& sum) {
    if (!spread.response) {
      const LensTransfer transfer(lens_, pictures.outputs[p.output]);
      spread.response = std::make_unique<PointResponse>(transfer, transfer.cutoff_per_m(), lens_.cell_m, spread.law.exactReach);
    }
    const int column = static_cast<int>(std::floor(p.column)), row = static_cast<int>(std::floor(p.row)), reach = spread.law.near.reach;
    for (int y = std::max(0, row - reach); y <= std::min(pictures.height - 1, row + reach); ++y)
      for (int x = std::max(0, column - reach); x <= std::min(pictures.width - 1, column + reach); ++x) {
        const double dx = x + 0.5 - p.column, dy = y + 0.5 - p.row, r = std::sqrt(dx * dx + dy * dy), whole = spread.law.whole(r);
        double share = whole > 0.0 ? whole * spread.response->share(dx, dy) : 0.0;
        if (whole < 1.0) share += (1.0 - whole) * spread.law.far(r);
        const auto cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(x);
        sum[cell] += spread.law.cut(r) * share * pictures.inCell(p, cell);
      }
    const int nearestX = std::clamp(column, 0, pictures.width - 1), nearestY = std::clamp(row, 0, pictures.height - 1);
    const double light = pictures.inCell(p, static_cast<std::size_t>(nearestY) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(nearestX));
    if (spread.far && nearestX == column && nearestY == row) spread.far->gather(p.column, p.row, light);
    return light;
  }

  /// Another stage may ask for finer cells, and a lens zooms.
  void follow(const SensorTick& tick, const SensorPictures& pictures) {
    const double focal = tick.focalLength_m > 0.0 ? tick.focalLength_m : lens_.focalLength_m;
    if (pictures.cells == lens_.cells && std::abs(focal / lens_.focalLength_m - 1.0) < 1e-9) return;
    lens_.zoom(focal);
    lens_.setCells(pictures.cells);
    spreads_.clear();
  }

  Lens lens_;
  std::map<std::size_t, Spread> spreads_;  ///< by output
};

/// Of three digits, not rounded up.
std::string brief(double v) { return print(v < 1000.0 ? "%.3g" : "%.0f", 0.995 * v); }

/// Rms or defocus that makes a lens too wide, as a scenario says it.
struct Width {
  const char* key;
  double Lens::*value;
  double perLength;   ///< of the value: the radius on the film that most of the light lies in [m]
  const char* unit;
  double perUnit;
};

/// Refuses a lens whose light goes beyond 128 cells, with the largest value of what makes it so that is taken; without working out what is far too wide.
void refuseTooWide(const Record& r, const Lens& lens, const std::vector<ChannelOutput>& outputs) {
  const double most_m = kMostReach_cells * lens.cell_m;
  constexpr double kSigmas = 3.0;
  /// More waves of defocus than a transfer function is worked out for.
  constexpr double kMostDefocus_waves = 250.0;
  double shortest_um = INFINITY;
  for (const ChannelOutput& o : outputs) shortest_um = std::min(shortest_um, o.bandLow_um);
  const double mostDefocus_m =
      lens.diffraction && std::isfinite(shortest_um) ? kMostDefocus_waves * 8.0 * lens.fNumber * lens.fNumber * shortest_um * 1e-6 : INFINITY;
  const Width widths[] = {{"defocus", &Lens::defocus_m, 0.5 / lens.fNumber, "um", 1e-6},
                          {"blur", &Lens::still_m, kSigmas, "um", 1e-6},
                          {"jitter", &Lens::jitter_rad, kSigmas * lens.focalLength_m, "urad", 1e-6}};
  const Width& widest = *std::max_element(std::begin(widths), std::end(widths),
                                          [&](const Width& a, const Width& b) { return a.perLength * lens.*a.value < b.perLength * lens.*b.value; });
  const auto fits = [&](const Lens& some) {
    for (const Width& w : widths)
      if (w.perLength * some.*w.value > most_m) return false;
    if (some.defocus_m > mostDefocus_m) return false;
    for (std::size_t o = 0; o < outputs.size(); ++o)
      if (firstAlike(outputs, o) == o && !reachOf(some, outputs[o])) return false;
    return true;
  };
  if (fits(lens)) return;
  double low = 0.0, high = std::min(lens.*widest.value, most_m / widest.perLength);
  constexpr int kHalvings = 8;
  for (int k = 0; k < kHalvings && high > 0.0; ++k) {
    Lens less = lens;
    less.*widest.value = 0.5 * (low + high);
    less.zoom(less.focalLength_m);
    (fits(less) ? low : high) = less.*widest.value;
  }
  const std::string wide =
      "a point spread function that is wider than " + std::to_string(kMostReach_cells) + " cells of " + brief(lens.cell_m * 1e6 / 0.995) + " um";
  if (!(low > 0.0)) throw UserError(r.where(), wide, "most of its light within them", "lower 'cells', or let more of it lie 'beyond'");
  throw UserError(r.where(widest.key), wide,
                  "a '" + std::string(widest.key) + "' of at most " + brief(low / widest.perUnit) + " " + widest.unit + " with all else as it is",
                  std::string("lower '") + widest.key + "'" + (lens.cells > 1 ? ", or 'cells'" : ""));
}

StageChoice readPointSpread(const Record& r, const Camera& camera) {
  Lens lens;
  r.fill(lens);
  const Pinhole& p = camera.pinhole;
  if (std::abs(p.pitchX_m / p.pitchY_m - 1.0) > 1e-9)
    throw UserError(r.where(), "a point spread function on pixels that are not square", "'pitch' without 'pitch_y'", "remove pitch_y, or the stage");
  StageChoice choice;
  choice.cells = r.given("cells") ? static_cast<int>(r.integer("cells")) : 1;
  lens.aperture_m = p.apertureDiameter_m;
  lens.pitch_m = p.pitchX_m;
  lens.setCells(choice.cells);
  lens.zoom(p.focalLength_m);
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
  refuseTooWide(r, lens, camera.outputs);
  if (!r.given("cells")) {
    choice.cells = fewestCells(lens, camera);
    lens.setCells(choice.cells);
  }
  for (std::size_t o = 0; o < camera.outputs.size(); ++o)
    if (firstAlike(camera.outputs, o) == o)
      choice.margin_px = std::max(choice.margin_px, (reachOf(lens, camera.outputs[o]).value_or(kMostReach_cells) + choice.cells - 1) / choice.cells);
  constexpr int kLeast_px = 2;  // of the smallest kernel
  if (choice.margin_px > kLeast_px && 2 * choice.margin_px > std::max(p.width, p.height))
    throw UserError(r.where(), "a point spread function wider than the film: " + std::to_string(choice.margin_px) + " pixels to each side",
                    "half the film at most", "let more of its light lie 'beyond', or enlarge the film");
  const double within = 1.0 - lens.veilingGlare;
  choice.transfer = [lens, within](const ChannelOutput& o, double frequency_per_m) { return within * transferOf(lens, wavesOf(o), frequency_per_m); };
  choice.drawnTransfer = [lens, within](const ChannelOutput& o, double frequency_per_m) {
    return within * LensSpread(lens, o).near.transfer(frequency_per_m * lens.cell_m);
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
      const LensTransfer transfer(zoomed, o);
      at = known->emplace(std::tuple(o.layer(), focal_m, reach), PointResponse(transfer, transfer.cutoff_per_m(), zoomed.pitch_m, reach)).first;
    }
    return within * at->second.share(x, y);
  };
  choice.make = [lens](const ShaderLibrary&) { return std::make_unique<PointSpreadStage>(lens); };
  return choice;
}

}  // namespace

StageModel pointSpreadModel() {
  return {
      "point_spread",
      "What the lens makes of points: diffraction at the aperture, wavelength by wavelength within a channel (for light that is even over it), with wavefront "
      "error, defocus, blur and jitter, on cells of a pixel; near a point with its rings, and far from it by their mean, as the cube of the distance, as far "
      "as the picture reaches.",
      {withDefault(boolean("diffraction", "at a circular aperture of the camera's F number", &Lens::diffraction), "true"),
       withDefault(within(number("obscuration", "", "of the aperture, by diameter", &Lens::obscuration), 0, 0.9), "0"),
       withDefault(within(number("wavefront_error", "m", "rms, after Shannon; up to 0.18 waves", &Lens::wavefront_m), 0, 1e-3), "0 um"),
       withDefault(within(number("defocus", "m", "of the film along the axis", &Lens::defocus_m), 0, 1), "0 um"),
       withDefault(within(number("blur", "m", "of Gauss on the film, rms along one direction", &Lens::still_m), 0, 1), "0 um"),
       withDefault(within(number("jitter", "rad", "of the line of sight within an exposure, rms along one direction", &Lens::jitter_rad), 0, 0.1), "0 rad"),
       withDefault(within(number("veiling_glare", "", "share of the light that the lens spreads evenly", &Lens::veilingGlare), 0, 0.9), "0"),
       integer("cells", "cells a side of a pixel; unless given the fewest, up to 4, that leave contrast at half a cycle a pixel within 0.01", 1, 16),
       withDefault(within(above(number("beyond", "",
                                       "share of a point's light that may lie farther than the margin that is drawn around the film; its rings are told twice "
                                       "as far as that, beyond that their mean"),
                                0),
                          0, 0.2),
                   "0.01")},
      readPointSpread};
}

}  // namespace pitviper
