#include "scenarios/commands/measure_bench.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <stdexcept>

#include "scenarios/commands/bench_setup.hpp"
#include "scenarios/commands/measure_mrtd.hpp"
#include "sensors/edge_transfer.hpp"
#include "sensors/figures.hpp"
#include "sensors/spot_detection.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

double meanOf(const Counts& c) {
  double sum = 0.0;
  for (float v : c) sum += static_cast<double>(v);
  return sum / static_cast<double>(c.size());
}

/// A least-squares line.
struct Line {
  double slope = 0.0, offset = 0.0;
};
Line lineThrough(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& weight) {
  double w = 0.0, mx = 0.0, my = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) w += weight[k], mx += weight[k] * x[k], my += weight[k] * y[k];
  mx /= w, my /= w;
  double xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) xx += weight[k] * (x[k] - mx) * (x[k] - mx), xy += weight[k] * (x[k] - mx) * (y[k] - my);
  const double slope = xx > 0.0 ? xy / xx : 0.0;
  return {slope, my - slope * mx};
}

class Bench {
 public:
  Bench(const BenchOptions& options, const Camera& camera, glm::ivec2 film, const ChannelOutput& output,
        std::function<void(const std::string&, double)> progress)
      : options_(options), camera_(camera), output_(output), progress_(std::move(progress)), law_(*detectorOf(camera, output.channel)), layer_(output.layer()) {
    const Pinhole& p = camera.pinhole;
    axis_sr_ = p.projectedSolidAngle_sr(p.width / 2, p.height / 2);
    perIntegral_ = law_.fillFactor * output.scale * camera.exposureOf(output.channel) * axis_sr_;
    own_ =
        law_.fillFactor * ownLightOf(camera, output, axis_sr_, camera.exposureOf(output.channel)) + law_.darkCurrent_per_s * camera.exposureOf(output.channel);
    settle_ = warmUpOf(camera, options.step_s);
    pixel_m_ = p.pitchX_m / p.focalLength_m * kFar_m;
    result_.channel = output.channel;
    // At 300 K where that gives a hundredth of what it holds; else where it is half full.
    const double room = law_.saturation() - own_;
    result_.temperature_K = perIntegral_ * output.temperature->integral(300.0) > 0.01 * room && perIntegral_ * output.temperature->integral(300.0) < 0.9 * room
                                ? 300.0
                                : kelvinFor(0.5 * room);
    design_ = *figuresOf(camera, output, options.step_s, result_.temperature_K).detected;
    BenchSight& sight = result_.sight;
    sight.output = output;
    sight.seesHeat = result_.temperature_K == 300.0;
    sight.electrons_per_K = design_.electrons_per_K, sight.noise_electrons = design_.netd_K * design_.electrons_per_K;
    sight.pixel_sr = axis_sr_, sight.shareInMiddle = pixelShareOf(camera, output, p.focalLength_m),
    sight.shareInCorner = pixelShareOf(camera, output, p.focalLength_m, 0.5, 0.5);
    sight.pixels_per_s = static_cast<double>(film.x) * film.y / options.step_s;
    sight.design = {tabulated([this](double f) { return contrastAt(f); }),
                    p.pitchX_m / p.focalLength_m,
                    p.pitchY_m / p.focalLength_m,
                    film.y,
                    1.0 / options.step_s,
                    {},
                    {}};
  }

  BenchResult measure() {
    flatFields();
    levels();
    slantedEdge();
    points();
    bars();
    tellResolvable(result_);
    return std::move(result_);
  }

 private:
  double kelvinFor(double electrons) const { return (*output_.temperature)(electrons / perIntegral_); }
  double countsFor(double kelvin) const { return law_.gain * (perIntegral_ * output_.temperature->integral(kelvin) + own_) + law_.offset; }
  std::string wall(double kelvin) const {
    const double half = 3.0 * options_.film_px * pixel_m_;
    return "entities:\n" + plate("wall", -half, half, half, kelvin);
  }
  void figure(const char* name, const char* unit, double design, double measured, double error = 0.0, bool absolute = false) {
    result_.figures.push_back({name, unit, design, measured, error, absolute});
  }
  void tell(const char* what, double share) const {
    if (progress_) progress_(output_.channel + ": " + what, share);
  }

  /// Two temperatures, each with so many frames: SiTF, NETD and the components of noise at the first.
  void flatFields() {
    tell("flat fields", 0.0);
    const double kelvin = result_.temperature_K, step_K = 0.02 * law_.saturation() / std::max(design_.electrons_per_K, 1e-300),
                 off = std::min(std::min(5.0, 0.02 * kelvin), std::max(step_K, 8.0 * design_.netd_K));
    const Setup setup(options_, wall(kelvin), options_.frames);
    width_ = setup.camera().pinhole.width;
    std::vector<Counts> frames;
    std::vector<double> mean(static_cast<std::size_t>(width_ * setup.camera().pinhole.height), 0.0);
    setup.each(layer_, [&](int, const Counts& c) {
      frames.push_back(c);
      for (std::size_t p = 0; p < c.size(); ++p) mean[p] += static_cast<double>(c[p]) / options_.frames;
    });
    bad_ = badPixels(mean);
    const auto count = std::count(bad_.begin(), bad_.end(), 1);
    figure("bad pixels, share", "1", law_.badPixels, static_cast<double>(count) / static_cast<double>(bad_.size()),
           std::sqrt(std::max<double>(1.0, static_cast<double>(count))) / static_cast<double>(bad_.size()));
    if (count > 0) result_.notes.push_back(print("%ld bad pixels are replaced by means of those around them in what follows", static_cast<long>(count)));
    mend(mean, bad_, width_);
    const std::vector<double> fall = fallOff(mean);
    NoiseCube cube(static_cast<std::size_t>(width_), mean.size() / static_cast<std::size_t>(width_));
    for (Counts& c : frames) {
      mend(c, bad_, width_);
      for (std::size_t p = 0; p < c.size(); ++p) c[p] = static_cast<float>(static_cast<double>(c[p]) - fall[p]);
      cube.add(std::move(c));
    }
    std::array<double, 2> means{};
    for (int k = 0; k < 2; ++k) {
      double sum = 0.0;
      const Setup at(options_, wall(kelvin + (k == 0 ? -off : off)), options_.frames);
      at.each(layer_, [&](int, Counts c) {
        mend(c, bad_, width_);
        sum += meanOf(c) / options_.frames;
      });
      means[static_cast<std::size_t>(k)] = sum;
    }
    sitf_ = (means[1] - means[0]) / (2.0 * off);
    figure("SiTF", "count/K", law_.gain * design_.electrons_per_K, sitf_);
    netd_ = cube.temporal() / sitf_;
    figure("NETD (rms over the film)", "mK", 1e3 * design_.netd_K, 1e3 * netd_);
    const auto found = cube.components();
    const std::array<double, 7> wanted = designComponents();
    Series designed{"design", {}, {}, true, false}, measured{"measured", {}, {}, false, true};
    for (std::size_t k = 0; k < found.size(); ++k) {
      figure((std::string(kNoiseNames[k]) + " over signal").c_str(), "mK", 1e3 * wanted[k] / sitf_, 1e3 * found[k].sigma / sitf_, 1e3 * found[k].error / sitf_);
      designed.x.push_back(static_cast<double>(k)), designed.y.push_back(1e3 * wanted[k] / sitf_);
      measured.x.push_back(static_cast<double>(k)), measured.y.push_back(1e3 * found[k].sigma / sitf_);
    }
    const auto noise = [&](auto&& counts, double counts_per_K) {
      const auto of = [&](std::size_t k) { return counts(k) / counts_per_K; };
      return ThermalNoise{of(6), of(3), of(4), of(5), of(1), of(2)};  // in the order of kNoiseNames
    };
    result_.sight.design.noise = noise([&](std::size_t k) { return wanted[k]; }, law_.gain * design_.electrons_per_K);
    found_ = noise([&](std::size_t k) { return found[k].sigma; }, sitf_);
    Chart chart{"Noise in three dimensions", "", "mK", false, false, true, {measured, designed}, {}, {}};
    for (const char* name : kNoiseNames) chart.categories.push_back(name);
    result_.charts.push_back(chart);
  }

  /// What falls off towards the corners as the square of the distance from the middle (cos^4 of the lens): no noise. Of mean 0.
  std::vector<double> fallOff(const std::vector<double>& mean) const {
    const int height = static_cast<int>(mean.size()) / width_;
    std::vector<double> r2;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width_; ++x) r2.push_back(std::pow(x + 0.5 - 0.5 * width_, 2.0) + std::pow(y + 0.5 - 0.5 * height, 2.0));
    const Line line = lineThrough(r2, mean, std::vector<double>(r2.size(), 1.0));
    double middle = 0.0;
    for (double r : r2) middle += r / static_cast<double>(r2.size());
    for (double& r : r2) r = line.slope * (r - middle);
    return r2;
  }

  /// Counts, rms.
  std::array<double, 7> designComponents() const {
    const double signal = design_.electronsAt300K, lens = own_ - law_.darkCurrent_per_s * camera_.exposureOf(output_.channel);
    const auto square = [](double x) { return x * x; };
    const double octave = law_.flickerVariance(options_.step_s);
    // Octaves that are faster than the frames taken; slower ones stand still.
    const double fast = std::min(12.0, std::log2(static_cast<double>(options_.frames)));
    const double tvh = signal + own_ + square(law_.sigmaTvh) + fast * octave + 1.0 / (12.0 * square(law_.gain));
    double vh = square(law_.prnu * (signal + lens)) + square(law_.sigmaVh) + square(law_.nonlinearity * square(signal + lens) / law_.fullWell);
    double v = square(law_.sigmaV), h = square(law_.sigmaH);
    if (law_.correction) {
      const double low = perIntegral_ * output_.temperature->integral(law_.correction->low_K),
                   high = perIntegral_ * output_.temperature->integral(law_.correction->high_K), at = (signal - low) / (high - low),
                   learnt = 1.0 / law_.correction->frames;
      // What bends leave, and the correction's own noise at its two points.
      vh = square(law_.nonlinearity / law_.fullWell * (signal - low) * (signal - high)) +
           learnt * (square(1.0 - at) * (low + own_ + square(law_.sigmaTvh)) + square(at) * (high + own_ + square(law_.sigmaTvh)));
      v = h = 0.0;
    }
    vh += (12.0 - fast) * octave;
    const auto counts = [&](double variance) { return law_.gain * std::sqrt(variance); };
    return {counts(square(law_.sigmaT)), counts(v), counts(h), counts(square(law_.sigmaTv)), counts(square(law_.sigmaTh)), counts(vh), counts(tvh)};
  }

  /// From dark to more than it holds: photon transfer, linearity, full well.
  void levels() {
    tell("levels", 0.25);
    constexpr int kLevels = 12, kFrames = 8;
    const double room = law_.saturation() - own_;
    std::string commands = "commands:\n";
    std::vector<double> ideal;
    const int each = kFrames + settle_;
    for (int k = 0; k < kLevels; ++k) {
      const double part = k == kLevels - 1 ? 1.5 : (k + 0.5) / (kLevels - 1), kelvin = kelvinFor(std::max(part * room, 1e-9));
      ideal.push_back(perIntegral_ * output_.temperature->integral(kelvin));
      commands += print("- {command: temperature, at: %.9g s, entity: wall, value: %.12g K}\n", each * k * options_.step_s, kelvin);
    }
    const Setup setup(options_, wall(result_.temperature_K), each * kLevels, 1, commands);
    std::vector<double> means(kLevels, 0.0), variances(kLevels, 0.0);
    std::vector<Counts> before;
    double most = 0.0;
    setup.each(layer_, [&](int number, Counts c) {
      mend(c, bad_, width_);
      const auto level = static_cast<std::size_t>(number / each);
      if (number % each < settle_) return;
      if (number % each == settle_) before.clear();
      means[level] += meanOf(c) / kFrames;
      // Half the variance of differences of neighbouring frames: what is fixed falls out.
      if (!before.empty()) {
        double sum = 0.0, off = 0.0;
        for (std::size_t p = 0; p < c.size(); ++p) sum += static_cast<double>(c[p]) - static_cast<double>(before.back()[p]);
        sum /= static_cast<double>(c.size());
        for (std::size_t p = 0; p < c.size(); ++p) off += std::pow(static_cast<double>(c[p]) - static_cast<double>(before.back()[p]) - sum, 2.0);
        variances[level] += 0.5 * off / static_cast<double>(c.size() - 1) / (kFrames - 1);
      }
      before = {c};
      if (level + 1 == kLevels)
        for (float v : c) most = std::max(most, static_cast<double>(v));
    });
    std::vector<double> x, y, weight;
    for (int k = 0; k + 2 < kLevels; ++k) {
      const auto i = static_cast<std::size_t>(k);
      x.push_back(means[i]), y.push_back(variances[i]), weight.push_back(1.0 / std::max(variances[i] * variances[i], 1e-12));
    }
    const Line transfer = lineThrough(x, y, weight);
    const double atSaturation = means.back();
    // What noise of read-out, rows and columns and steps add is the same at all levels.
    const double steps = 1.0 / 12.0;
    // How well a line through these can be known: a variance of n pixels and frames is good to the root of 2 / n.
    double middle = 0.0, spread = 0.0, all = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) middle += weight[k] * x[k], all += weight[k];
    for (std::size_t k = 0; k < x.size(); ++k) spread += weight[k] * (x[k] - middle / all) * (x[k] - middle / all);
    const double error = std::sqrt(2.0 / ((kFrames - 1.0) * static_cast<double>(bad_.size())) / spread);
    if (error < 0.1 * law_.gain) figure("gain (photon transfer)", "count/electron", law_.gain, transfer.slope, error);
    else result_.notes.push_back("gain cannot be told by photon transfer: read noise is far above shot noise");
    if (error < 0.1 * law_.gain && transfer.slope > 0.0)
      figure("full well, or what the converter holds", "electron", law_.saturation(), (atSaturation - law_.offset) / law_.gain);
    std::vector<double> light(ideal.begin(), ideal.end() - 2), said(means.begin(), means.end() - 2), even(light.size(), 1.0);
    const Line straight = lineThrough(light, said, even);
    double worst = 0.0;
    for (std::size_t k = 0; k < light.size(); ++k) worst = std::max(worst, std::abs(said[k] - straight.offset - straight.slope * light[k]));
    figure("largest deviation from a line", "% of full scale", 0.0, 100.0 * worst / std::max(said.back() - said.front(), 1.0), 0.0, true);
    Series points{"measured", {}, {}, false, false}, designed{"design", {}, {}, true, false};
    for (int k = 0; k + 1 < kLevels; ++k) {
      const auto i = static_cast<std::size_t>(k);
      points.x.push_back(means[i] - law_.offset), points.y.push_back(variances[i]);
      const double readout = variances[i] > 0.0 ? law_.gain * law_.gain * (ideal[i] + own_ + law_.sigmaTvh * law_.sigmaTvh) + steps : 0.0;
      designed.x.push_back(means[i] - law_.offset), designed.y.push_back(readout);
    }
    result_.charts.push_back(
        {"Photon transfer", "mean count less offset", "variance from frame to frame, count^2", true, true, false, {points, designed}, {}, {}});
    Series response{"measured", {}, {}, false, false}, line{"design", {}, {}, true, false};
    for (int k = 0; k < kLevels; ++k) {
      const auto i = static_cast<std::size_t>(k);
      response.x.push_back(ideal[i]), response.y.push_back(means[i]);
      line.x.push_back(ideal[i]),
          line.y.push_back(std::min({law_.gain * (ideal[i] + own_) + law_.offset, law_.gain * law_.fullWell + law_.offset, law_.mostCount()}));
    }
    result_.charts.push_back({"Response", "photoelectrons of an ideal pixel", "mean count", false, false, true, {response, line}, {}, {}});
  }

  void slantedEdge() {
    tell("slanted edge", 0.5);
    const double room = law_.saturation() - own_, hot = kelvinFor(0.75 * room), cold = kelvinFor(0.15 * room), half = 3.0 * options_.film_px * pixel_m_;
    // A hot plate before a cold one, its edge through the middle.
    const double tilt_deg = 5.0, shift = 0.5 * half / std::cos(tilt_deg * kPi / 180.0);
    const std::string target = "entities:\n" + plate("cold", -half, half, half, cold, 0.0, 1.001 * kFar_m) +
                               print(
                                   "  - {name: hot, shape: {model: plate, width: %.9g m, height: %.9g m}, material: black, temperature: %.9g K, position: "
                                   "[%.9g m, %.9g m, 0 m], heading: 270 deg, "
                                   "roll: %.9g deg}\n",
                                   half, 4.0 * half, hot, kFar_m, shift, tilt_deg);
    const Setup setup(options_, target, std::max(4, options_.frames / 4), kSubpixels);
    const std::vector<double> picture = meanPicture(setup);
    const auto width = static_cast<std::size_t>(setup.camera().pinhole.width), height = static_cast<std::size_t>(setup.camera().pinhole.height);
    EdgeTransfer found;
    try {
      found = edgeTransfer(picture, width, height);
    } catch (const std::invalid_argument& e) {
      result_.notes.push_back(std::string("no MTF: ") + e.what());
      return;
    }
    result_.sight.measured = result_.sight.design;
    result_.sight.measured->noise = found_;
    result_.sight.measured->transfer = tabulated([&](double f) { return found.at(f); });
    const auto designed = [&](double f) { return contrastAt(f); };
    Series design{"design", {}, {}, true, false}, measured{"measured", {}, {}, false, false};
    double worst = 0.0;
    for (std::size_t k = 0; k < found.frequency.size(); ++k) {
      const double f = found.frequency[k];
      design.x.push_back(f), design.y.push_back(designed(f));
      measured.x.push_back(f), measured.y.push_back(found.contrast[k]);
      if (f <= 0.5) worst = std::max(worst, std::abs(found.contrast[k] - designed(f)));
    }
    for (double f : {0.25, 0.5})
      figure(print("MTF at %g cycles a pixel%s", f, f == 0.5 ? " (Nyquist)" : "").c_str(), "1", designed(f), found.at(f), 0.0, true);
    figure("largest difference of MTF up to Nyquist", "1", 0.0, worst, 0.0, true);
    result_.charts.push_back({"MTF by a slanted edge", "cycles a pixel", "contrast", false, false, true, {measured, design}, {}, {}});
  }

  /// A star in the middle of a pixel, on its edge and in its corner.
  void points() {
    tell("a point", 0.65);
    const double room = law_.saturation() - own_, share = std::max(pixelShareOf(camera_, output_, camera_.pinhole.focalLength_m), 1e-3);
    // Even over the band: half a well on its pixel.
    const double all = output_.kernel.integral(output_.bandLow_um, output_.bandHigh_um),
                 perIntensity = law_.fillFactor * output_.scale * camera_.exposureOf(output_.channel) * all / (kFar_m * kFar_m),
                 watts = 0.5 * room / share / perIntensity;
    Series design{"design", {}, {}, true, true}, measured{"measured", {}, {}, false, true};
    const std::vector<double> without = meanPicture(Setup(options_, "", options_.frames));
    Chart chart{"Share of a star's light on one pixel", "", "share", false, false, true, {}, {}, {"middle", "edge", "corner"}};
    int place = 0;
    for (const auto& [x, y, name] : {std::tuple{0.0, 0.0, "in its middle"}, std::tuple{0.5, 0.0, "on its edge"}, std::tuple{0.5, 0.5, "in its corner"}}) {
      const auto at = [&](double offset) { return offset * pixel_m_; };
      // The middle of the film is a pixel's corner where it has an even number of them.
      const double column = std::min(camera_.pinhole.width, options_.film_px) % 2 ? 0.0 : 0.5,
                   row = std::min(camera_.pinhole.height, options_.film_px) % 2 ? 0.0 : 0.5;
      const std::string target = print(
          "lights: [{name: star, radius: 1 mm, intensity: {wavelength: um, unit: W/(sr um), outside: zero, values: [[%.9g, %.9g], [%.9g, %.9g]]}, position: "
          "[%.9g m, %.9g m, %.9g m]}]\n",
          output_.bandLow_um, watts, output_.bandHigh_um, watts, kFar_m, -at(column + x), -at(row + y));
      const Setup setup(options_, target, options_.frames);
      const std::vector<double> picture = meanPicture(setup);
      const int width = setup.camera().pinhole.width, height = setup.camera().pinhole.height;
      const int px = width / 2, py = height / 2;
      double sum = 0.0;
      // Within 20 pixels: beyond, noise of many pixels is more than what is left of the star.
      for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i)
          if (std::abs(i - px) <= 20 && std::abs(j - py) <= 20) {
            const auto p = static_cast<std::size_t>(j * width + i);
            sum += picture[p] - without[p];
          }
      const auto own = static_cast<std::size_t>(py * width + px);
      const double found = (picture[own] - without[own]) / sum;
      // By the design, of what falls within the same square.
      double within = 0.0;
      for (int j = -20; j <= 20; ++j)
        for (int i = -20; i <= 20; ++i) within += reachShare(i - x, j - y);
      const double wanted = reachShare(-x, -y) / within;
      figure((std::string("a star ") + name + ", share of that pixel").c_str(), "1", wanted, found);
      const double onAperture_W_m2 = watts * (output_.bandHigh_um - output_.bandLow_um) / (kFar_m * kFar_m);
      const double atOne = design_.noiseEquivalent_W_m2 / reachShare(-x, -y), foundAtOne = onAperture_W_m2 * netd_ * sitf_ / (picture[own] - without[own]);
      figure((std::string("irradiance of a star ") + name + " at a TNR of 1").c_str(), "W/m2", atOne, foundAtOne);
      const double seen = tnrFor(0.9, thresholdForRate(1.0, result_.sight.pixels_per_s));
      figure((std::string("... ") + name + ", found with 90 %, 1 false alarm/h").c_str(), "W/m2", seen * atOne, seen * foundAtOne);
      design.x.push_back(place), design.y.push_back(wanted), measured.x.push_back(place), measured.y.push_back(found);
      ++place;
    }
    chart.series = {measured, design};
    result_.charts.push_back(chart);
  }
  /// A contrast over cycles a pixel as one over cycles/rad, to half a cycle a pixel: a table of it, linear between.
  std::function<double(double)> tabulated(const std::function<double(double)>& contrast) const {
    constexpr int kSteps = 256;
    std::vector<double> table;
    for (int k = 0; k <= kSteps; ++k) table.push_back(contrast(0.5 * k / kSteps));
    return [table, pixel_rad = camera_.pinhole.pitchX_m / camera_.pinhole.focalLength_m](double cycles_per_rad) {
      const double at = std::clamp(cycles_per_rad * pixel_rad / 0.5, 0.0, 1.0) * kSteps;
      const auto k = std::min(static_cast<std::size_t>(at), table.size() - 2);
      return table[k] + (at - static_cast<double>(k)) * (table[k + 1] - table[k]);
    };
  }
  double contrastAt(double f) const {
    double value = f > 0.0 ? std::sin(kPi * f) / (kPi * f) : 1.0;
    for (const StageChoice& s : camera_.stagesOf(output_.channel))
      if (s.transfer) value *= s.transfer(output_, f / camera_.pinhole.pitchX_m);
    return value;
  }
  /// The part of the bars' frequency in a row of pixels across four bars of 1 on 0, by the design: s(x) = 2 integral of P(f) T(f) cos(2 pi f x) df,
  /// P = 2 sum over two bars of their cosines.
  double barsThroughLens(int width_px, int half, double off_px) const {
    constexpr int kSteps = 1500;
    constexpr double kMost = 1.5;  // cycles a pixel: no lens of a camera lets more through a pixel
    std::vector<double> row(static_cast<std::size_t>(2 * half), 0.0);
    for (int k = 0; k < kSteps; ++k) {
      const double f = kMost * (k + 0.5) / kSteps, w = 2.0 * kPi * f;
      const double bars = 2.0 * (std::sin(1.5 * w * width_px) - std::sin(0.5 * w * width_px) + std::sin(3.5 * w * width_px) - std::sin(2.5 * w * width_px)) / w,
                   part = 2.0 * bars * contrastAt(f) * kMost / kSteps;
      for (int i = -half; i < half; ++i) row[static_cast<std::size_t>(i + half)] += part * std::cos(w * (i + 0.5 - off_px));
    }
    double re = 0.0, im = 0.0;
    for (int i = -half; i < half; ++i) {
      const double phase = kPi / width_px * (i + 0.5), value = row[static_cast<std::size_t>(i + half)];
      re += value * std::cos(phase) / half, im += value * std::sin(phase) / half;
    }
    return std::hypot(re, im);
  }
  /// The mean over places of the bars within a pixel, as they move.
  double barsThroughLens(int width_px, int half) const {
    constexpr int kPlaces = 8;
    double sum = 0.0;
    for (int k = 0; k < kPlaces; ++k) sum += barsThroughLens(width_px, half, (k + 0.5) / kPlaces - 0.5) / kPlaces;
    return sum;
  }
  /// The mean of all frames, bad pixels replaced.
  std::vector<double> meanPicture(const Setup& setup) const {
    std::vector<double> sum;
    const int frames = setup.simulation().time.frames;
    setup.each(layer_, [&](int, const Counts& counts) {
      sum.resize(counts.size(), 0.0);
      for (std::size_t p = 0; p < counts.size(); ++p) sum[p] += static_cast<double>(counts[p]) / frames;
    });
    mend(sum, bad_, width_);
    return sum;
  }
  /// Once for each distance.
  double reachShare(double x, double y) {
    const auto [at, isNew] = shares_.try_emplace({std::min(std::abs(x), std::abs(y)), std::max(std::abs(x), std::abs(y))}, 0.0);
    if (isNew) at->second = pixelShareOf(camera_, output_, camera_.pinhole.focalLength_m, x, y);
    return at->second;
  }

  /// Four bars of a height of seven widths: what they leave of their contrast.
  void bars() {
    tell("four bars", 0.85);
    const double kelvin = result_.temperature_K, difference = std::min(20.0 * std::max(design_.netd_K, 1e-9) + 0.01 * kelvin, 0.1 * kelvin);
    for (int width_px : {8, 4, 2}) {  // of a bar: 1/16, 1/8 and 1/4 cycle a pixel
      const double f = 0.5 / width_px;
      // They move by a pixel while they are looked at: what is alike in a picture's cells and in bars does not stay so.
      const int frames = std::max(8, options_.frames / 4);
      std::string target = wall(kelvin);
      for (int b = 0; b < 4; ++b) {
        const double left = (2.0 * b - 3.5) * width_px * pixel_m_, right = left + width_px * pixel_m_, range = 0.999 * kFar_m, y = -0.5 * (left + right);
        target += print(
            "  - {name: bar%d, shape: {model: plate, width: %.9g m, height: %.9g m}, material: black, temperature: %.12g K, motion: [{time: 0 s, position: "
            "[%.9g m, %.9g m, 0 m], "
            "heading: 270 deg}, {time: %.9g s, position: [%.9g m, %.9g m, 0 m], heading: 270 deg}]}\n",
            b, right - left, 7.0 * width_px * pixel_m_, kelvin + difference, range, y + 0.5 * pixel_m_, frames * options_.step_s, range, y - 0.5 * pixel_m_);
      }
      const Setup setup(options_, target, frames, kSubpixels);
      const int width = setup.camera().pinhole.width, height = setup.camera().pinhole.height, half = 4 * width_px;
      if (2 * half + 2 > width || 7 * width_px > height) continue;
      // The part of the bars' own frequency in the mean of their middle rows, over four whole periods.
      const int rows = std::max(1, 5 * width_px);
      double amplitude = 0.0;
      setup.each(layer_, [&](int, Counts c) {
        mend(c, bad_, width_);
        double re = 0.0, im = 0.0;
        for (int j = -rows / 2; j < rows - rows / 2; ++j)
          for (int i = -half; i < half; ++i) {
            const double value = static_cast<double>(c[static_cast<std::size_t>((height / 2 + j) * width + width / 2 + i)]), phase = 2.0 * kPi * f * (i + 0.5);
            re += value * std::cos(phase) / (rows * half), im += value * std::sin(phase) / (rows * half);
          }
        amplitude += std::hypot(re, im) / frames;
      });
      const double slope = (countsFor(kelvin + difference) - countsFor(kelvin)) * 2.0 / kPi, found = amplitude / slope;
      const double wanted = barsThroughLens(width_px, half) * kPi / 2.0;
      figure(print("contrast of four bars of %d pixels", width_px).c_str(), "1", wanted, found, 0.0, true);
    }
  }

  const BenchOptions& options_;
  const Camera& camera_;
  const ChannelOutput& output_;
  std::function<void(const std::string&, double)> progress_;
  const DetectorLaw& law_;
  std::string layer_;
  double axis_sr_ = 0.0, perIntegral_ = 0.0, own_ = 0.0, pixel_m_ = 0.0, sitf_ = 1.0, netd_ = 0.0;
  int settle_ = 0, width_ = 0;
  ThermalNoise found_;
  std::vector<char> bad_;
  SensorFigures::Detected design_;
  std::map<std::pair<double, double>, double> shares_;
  BenchResult result_;
};

}  // namespace

std::vector<BenchResult> measureCamera(const BenchOptions& options, const std::function<void(const std::string&, double)>& progress) {
  const Setup setup(options, "", 1);
  std::vector<BenchResult> results;
  std::vector<const ChannelOutput*> counted;
  for (const ChannelOutput& o : setup.camera().outputs)
    if (o.isCount()) counted.push_back(&o);
  if (counted.empty())
    throw UserError({options.base, 0, 0, -1}, "a camera that makes no counts", "a channel with 'output: counts' and 'stage: detector' among its 'stages'",
                    "add them");
  for (std::size_t k = 0; k < counted.size(); ++k)
    results.push_back(Bench(options, setup.camera(), setup.film(), *counted[k], [&](const std::string& what, double share) {
                        if (progress) progress(what, (static_cast<double>(k) + share) / static_cast<double>(counted.size()));
                      }).measure());
  return results;
}

}  // namespace pitviper
