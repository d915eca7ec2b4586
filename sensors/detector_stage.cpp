#include "sensors/detector_stage.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "sensors/display_codes.hpp"
#include "sensors/fixed_pattern.hpp"
#include "sensors/flicker_noise.hpp"
#include "sensors/noise_source.hpp"
#include "sensors/side_by_side.hpp"
#include "sensors/signal_memory.hpp"
#include "sim/radiometry/wide_loops.hpp"

namespace pitviper {
namespace {

/// What pixels share with the four beside them: at the film's edges what would leave it stays.
void share(std::vector<float>& picture, double part, int width, int height) {
  if (!(part > 0.0)) return;
  const std::vector<float> before = picture;
  const auto at = [&](int x, int y) {
    return static_cast<double>(before[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
                                      static_cast<std::size_t>(std::clamp(x, 0, width - 1))]);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      picture[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] =
          static_cast<float>((1.0 - 4.0 * part) * at(x, y) + part * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1)));
}

/// What a row of electrons is as counts: round(gain x electrons + offset) within 0 and `most`, a whole number.
PITVIPER_WIDE void toCounts(const double* electrons, double gain, double offset, double most, float* counts, int width) {
  for (int x = 0; x < width; ++x) {
    const double value = gain * electrons[x] + offset + 0.5, kept = value > 0.0 ? (value < most ? value : most) : 0.0;
    counts[x] = static_cast<float>(static_cast<std::int32_t>(kept));  // of what is not negative that is its floor
  }
}

/// A row's electrons from what the wells have counted: what the well holds, dark signal, and read-out's noise.
PITVIPER_WIDE void readOut(const double* counted, const double* normal, const float* dark, const double* column, double fullWell, double row, double noise,
                           double* electrons, int width) {
  for (int x = 0; x < width; ++x)
    electrons[x] = (counted[x] < fullWell ? counted[x] : fullWell) + (static_cast<double>(dark[x]) + row + column[x]) + noise * normal[x];
}

class DetectorStage final : public SensorStage {
 public:
  DetectorStage(const DetectorLaw& law, DetectorDesign design) : law_(law), design_(std::move(design)) {}

  void run(const SensorTick& tick, SensorPictures& pictures) override {
    struct Read {
      std::string channel;
      std::vector<float> counts, signalToNoise;
      std::vector<CountMark> marks;
    };
    std::vector<Read> read;  // counts by channel: they and what is told of them are of one read-out
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      const ChannelOutput& output = pictures.outputs[o];
      if (!output.detected) continue;
      auto own = std::find_if(read.begin(), read.end(), [&](const auto& r) { return r.channel == output.channel; });
      if (own == read.end()) {
        read.push_back({output.channel, pictures.values(o), {}, {}});
        own = read.end() - 1;
        const bool wanted = std::any_of(pictures.outputs.begin(), pictures.outputs.end(),
                                        [&](const ChannelOutput& other) { return other.asSignalToNoise && other.channel == output.channel; });
        expose(own->counts, own->marks, wanted ? &own->signalToNoise : nullptr, output, tick, pictures.width, pictures.height);
      }
      std::vector<float>& picture = pictures.values(o);
      picture = output.asSignalToNoise ? own->signalToNoise : own->counts;
      if (output.asDisplay) toDisplayCodes(picture, law_, noiseAtMedian(picture, tick));
      if (output.asMark) std::transform(own->marks.begin(), own->marks.end(), picture.begin(), [](CountMark m) { return static_cast<float>(m); });
      if (!output.asTemperature) continue;
      const double dark = law_.darkCurrent_per_s * tick.exposure_s;
      const std::vector<float>* lens = o < pictures.ownLight.size() && !pictures.ownLight[o].empty() ? &pictures.ownLight[o] : nullptr;
      for (std::size_t p = 0; p < picture.size(); ++p)
        picture[p] =
            static_cast<float>((saidElectrons(picture[p], own->marks[p], tick.gain) - dark) / law_.fillFactor - (lens ? static_cast<double>((*lens)[p]) : 0.0));
    }
    for (Read& r : read) pictures.marks[r.channel] = std::move(r.marks);
  }

 private:
  /// From frame to frame, of a pixel that counts as many as the picture's middle one [count].
  double noiseAtMedian(std::vector<float> counts, const SensorTick& tick) const {
    const auto middle = counts.begin() + static_cast<std::ptrdiff_t>(counts.size() / 2);
    std::nth_element(counts.begin(), middle, counts.end(), [](float a, float b) { return a < b || (!std::isnan(a) && std::isnan(b)); });
    const double gain = law_.gain * tick.gain,
                 electrons = std::isnan(*middle) ? law_.fullWell : std::max(0.0, (static_cast<double>(*middle) - law_.offset) / gain);
    return gain * std::sqrt(electrons + law_.readoutVariance(tick.step_s));
  }

  /// What a count stands for; where it says nothing no number, or the most that the pixel tells.
  double saidElectrons(float count, CountMark mark, double gain) const {
    if (mark == CountMark::Bad || (mark != CountMark::None && law_.unread == WhereUnread::Nan)) return NAN;
    return mark == CountMark::Full ? law_.saturation(gain) : (static_cast<double>(count) - law_.offset) / (law_.gain * gain);
  }

  /// Signal to noise where a count says nothing: none, or that of a pixel that is just full.
  double markedSignalToNoise(float own, CountMark mark, double gain, double dark, double variance) const {
    if (mark == CountMark::Bad || law_.unread == WhereUnread::Nan) return NAN;
    const double most = law_.saturation(gain);
    return mark == CountMark::Full ? std::max(0.0, most - dark) / std::sqrt(most + variance) : static_cast<double>(own);
  }

  /// Learnt with the camera's own lens and exposure, whatever commands make of them: a frame's counts depend on no other.
  const FixedPattern& patternOf(const ChannelOutput& output, std::uint32_t channel, const SensorTick& tick, int width, int height) {
    FixedPattern& f = patterns_[channel];
    if (!f.response.empty()) return f;
    f = fixedPattern(law_, tick.seed, channel, width, height);
    if (!law_.correction) return f;
    const auto electronsAt = [&](double kelvin) {
      return law_.fillFactor * (design_.ownLight(output) + output.scale * design_.exposure_s * design_.axis_sr * output.temperature->integral(kelvin));
    };
    const double dark = law_.darkCurrent_per_s * design_.exposure_s, low = electronsAt(law_.correction->low_K), high = electronsAt(law_.correction->high_K);
    const auto noise = [&](double signal) { return std::sqrt(signal + dark + law_.sigmaTvh * law_.sigmaTvh); };
    learnCorrection(f, law_, tick.seed, channel, low, high, noise(low), noise(high));
    return f;
  }

  void expose(std::vector<float>& picture, std::vector<CountMark>& marks, std::vector<float>* signalToNoise, const ChannelOutput& output,
              const SensorTick& tick, int width, int height) {
    const std::uint32_t channel = channelNumber(output.channel);
    const FixedPattern& fixed = patternOf(output, channel, tick, width, height);
    share(picture, law_.crosstalk, width, height);
    if (law_.lag > 0.0 || law_.timeConstant_s > 0.0) memory_.apply(channel, tick.frame, memoryWeights(law_, tick.step_s), picture);
    const std::vector<float>* flicker = nullptr;
    const double octave = std::sqrt(law_.flickerVariance(tick.step_s));
    // Golden ratio: a draw of 0 is the seed's own, and neighbouring ones are far apart.
    const std::uint64_t seed = tick.seed ^ (tick.noise * 0x9e3779b97f4a7c15u);
    if (std::exchange(flickerSeed_, seed) != seed) flicker_.clear();
    if (octave > 0.0) flicker = &flicker_.try_emplace(channel, seed, channel, picture.size()).first->second.at(tick.frame);
    const auto frame = static_cast<std::uint32_t>(tick.frame) + 1;
    const auto source = [&](NoiseEffect e) { return NoiseSource(seed, channel, frame, e); };
    const NoiseSource shot = source(NoiseEffect::Shot), ofRow = source(NoiseEffect::Row),
                      ofColumn = source(NoiseEffect::Column);
    const double darkMean = law_.darkCurrent_per_s * tick.exposure_s, most = law_.mostCount(), gain = law_.gain * tick.gain;
    const double whole = law_.sigmaT > 0.0 ? law_.sigmaT * source(NoiseEffect::Frame).normal(0) : 0.0;
    const double variance = law_.readoutVariance(tick.step_s);
    if (signalToNoise) signalToNoise->resize(picture.size());
    marks.assign(picture.size(), CountMark::None);
    std::vector<double> columns(static_cast<std::size_t>(width), whole);
    for (int x = 0; law_.sigmaTh > 0.0 && x < width; ++x) columns[static_cast<std::size_t>(x)] += law_.sigmaTh * ofColumn.normal(static_cast<std::uint32_t>(x));
    struct Row {
      std::vector<double> count, normal;
    };
    const auto exposeRow = [&](int y, Row& drawn) {
      const double row = law_.sigmaTv > 0.0 ? law_.sigmaTv * ofRow.normal(static_cast<std::uint32_t>(y)) : 0.0;
      const auto from = static_cast<std::size_t>(y) * static_cast<std::size_t>(width);
      for (int x = 0; x < width; ++x) {
        const auto at = from + static_cast<std::size_t>(x);
        const double ideal = law_.fillFactor * static_cast<double>(picture[at]);
        double response = static_cast<double>(fixed.response[at]);
        if (!fixed.gainDrift.empty()) response += static_cast<double>(fixed.gainDrift[at]) * tick.time_s;
        double signal = response * ideal;
        if (!fixed.bend.empty()) {  // a bend is known up to a full well: beyond, it would turn the brightest dark
          const double known = std::min(ideal, law_.fullWell);
          signal += static_cast<double>(fixed.bend[at]) * known * known;
        }
        const double mean = std::max(0.0, signal) + darkMean;
        if (signalToNoise) (*signalToNoise)[at] = static_cast<float>(std::max(0.0, signal) / std::sqrt(mean + variance));
        drawn.count[static_cast<std::size_t>(x)] = mean;
      }
      shot.poissonAndNormal(static_cast<std::uint32_t>(from), drawn.count, drawn.normal);
      // What the well holds is what is counted; read-out adds to what it says.
      for (std::size_t x = 0; x < drawn.count.size(); ++x) {
        if (drawn.count[x] >= law_.fullWell) marks[from + x] = CountMark::Full;
        if (const int bad = fixed.bad[from + x]; bad > 0) drawn.count[x] = bad == 1 ? 0.0 : law_.fullWell, marks[from + x] = CountMark::Bad;
      }
      std::vector<double>& electrons = drawn.count;
      readOut(drawn.count.data(), drawn.normal.data(), &fixed.dark[from], columns.data(), law_.fullWell, row, law_.sigmaTvh, electrons.data(), width);
      for (std::size_t x = 0; !fixed.darkDrift.empty() && x < electrons.size(); ++x)
        electrons[x] += static_cast<double>(fixed.darkDrift[from + x]) * tick.time_s;
      for (std::size_t x = 0; flicker && x < electrons.size(); ++x) electrons[x] += octave * static_cast<double>((*flicker)[from + x]);
      // The correction knows the mean dark signal as what there is without light.
      for (std::size_t x = 0; !fixed.gain.empty() && x < electrons.size(); ++x)
        electrons[x] = static_cast<double>(fixed.gain[from + x]) * (electrons[x] - darkMean) + static_cast<double>(fixed.offset[from + x]) + darkMean;
      toCounts(electrons.data(), gain, law_.offset, most, &picture[from], width);
      for (std::size_t at = from; at < from + electrons.size(); ++at) {
        const auto count = static_cast<double>(picture[at]);
        if (marks[at] == CountMark::None && !(count > 0.0 && count < most)) marks[at] = count > 0.0 ? CountMark::Full : CountMark::Lowest;
        if (signalToNoise && marks[at] != CountMark::None)
          (*signalToNoise)[at] = static_cast<float>(markedSignalToNoise((*signalToNoise)[at], marks[at], tick.gain, darkMean, variance));
      }
    };
    sideBySide(height, [&](int first, int last) {
      Row drawn{std::vector<double>(static_cast<std::size_t>(width)), std::vector<double>(static_cast<std::size_t>(width))};
      for (int y = first; y < last; ++y) exposeRow(y, drawn);
    });
  }

  DetectorLaw law_;
  DetectorDesign design_;
  std::map<std::uint32_t, FixedPattern> patterns_;  ///< by channel
  std::map<std::uint32_t, FlickerNoise> flicker_;
  std::uint64_t flickerSeed_ = 0;
  SignalMemory memory_;
};

}  // namespace

std::uint32_t channelNumber(const std::string& channel) {
  std::uint32_t hash = 0x811c9dc5u;  // FNV-1a
  for (unsigned char c : channel) hash = (hash ^ c) * 0x01000193u;
  return (hash >> 24) ^ (hash & 0xffffffu);
}

std::unique_ptr<SensorStage> makeDetectorStage(const DetectorLaw& law, const DetectorDesign& design) { return std::make_unique<DetectorStage>(law, design); }

}  // namespace pitviper
