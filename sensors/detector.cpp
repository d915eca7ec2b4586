// The detector: photoelectrons and dark current as they are counted, what read-out adds, the well, and the converter (DetectorLaw).
// Source: EMVA Standard 1288, release 4.0 (linear camera model: shot noise, dark signal that doubles with temperature, gain, DSNU, PRNU); the components of
// noise by frame, row and column: J. D'Agostino and C. Webb, Proc. SPIE 1488, 110 (1991).
#include <algorithm>
#include <cmath>
#include <map>

#include "sensors/noise_source.hpp"
#include "sensors/side_by_side.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"

namespace pitviper {
namespace {

class DetectorStage final : public SensorStage {
 public:
  explicit DetectorStage(const DetectorLaw& law) : law_(law) {}

  void run(const SensorTick& tick, SensorPictures& pictures) override {
    std::vector<std::pair<std::string, std::vector<float>>> read;  // counts by channel: they and what is told of them are of one read-out
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      const ChannelOutput& output = pictures.outputs[o];
      if (!output.detected) continue;
      auto own = std::find_if(read.begin(), read.end(), [&](const auto& r) { return r.first == output.channel; });
      if (own == read.end()) {
        const std::uint32_t channel = numberOf(output.channel);
        read.emplace_back(output.channel, pictures.values(o));
        own = read.end() - 1;
        expose(own->second, fixedOf(channel, tick.seed, pictures.width, pictures.height), channel, tick, pictures.width, pictures.height);
      }
      std::vector<float>& picture = pictures.values(o);
      picture = own->second;
      if (!output.asTemperature) continue;
      const double dark = law_.darkCurrent_per_s * tick.exposure_s;
      for (float& v : picture) v = static_cast<float>(((static_cast<double>(v) - law_.offset) / law_.gain - dark) / law_.fillFactor);
    }
  }

 private:
  /// What is the same in all frames.
  struct Fixed {
    std::vector<float> response, dark;
    std::vector<std::uint8_t> bad;  ///< 1: dead, 2: hot
  };

  /// Of its name alone, whatever other channels there are: 24 bits of FNV-1a.
  static std::uint32_t numberOf(const std::string& channel) {
    std::uint32_t hash = 0x811c9dc5u;
    for (unsigned char c : channel) hash = (hash ^ c) * 0x01000193u;
    return (hash >> 24) ^ (hash & 0xffffffu);
  }

  const Fixed& fixedOf(std::uint32_t channel, std::uint64_t seed, int width, int height) {
    Fixed& f = fixed_[channel];
    if (!f.response.empty()) return f;
    const auto source = [&](NoiseEffect e) { return NoiseSource(seed, channel, 0, e); };
    const NoiseSource gain = source(NoiseEffect::Gain), pixel = source(NoiseEffect::FixedPixel), row = source(NoiseEffect::FixedRow),
                      column = source(NoiseEffect::FixedColumn), bad = source(NoiseEffect::BadPixel);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const auto at = static_cast<std::uint32_t>(y * width + x);
        f.response.push_back(static_cast<float>(1.0 + (law_.prnu > 0.0 ? law_.prnu * gain.normal(at) : 0.0)));
        double dark = law_.sigmaVh > 0.0 ? law_.sigmaVh * pixel.normal(at) : 0.0;
        if (law_.sigmaV > 0.0) dark += law_.sigmaV * row.normal(static_cast<std::uint32_t>(y));
        if (law_.sigmaH > 0.0) dark += law_.sigmaH * column.normal(static_cast<std::uint32_t>(x));
        f.dark.push_back(static_cast<float>(dark));
        const double u = law_.badPixels > 0.0 ? bad.uniform(at) : 1.0;
        f.bad.push_back(u >= law_.badPixels ? 0 : u < 0.5 * law_.badPixels ? 1 : 2);
      }
    return f;
  }

  void expose(std::vector<float>& picture, const Fixed& fixed, std::uint32_t channel, const SensorTick& tick, int width, int height) const {
    const auto frame = static_cast<std::uint32_t>(tick.frame) + 1;
    const auto source = [&](NoiseEffect e) { return NoiseSource(tick.seed, channel, frame, e); };
    const NoiseSource shot = source(NoiseEffect::Shot), read = source(NoiseEffect::Read), ofRow = source(NoiseEffect::Row),
                      ofColumn = source(NoiseEffect::Column);
    const double darkMean = law_.darkCurrent_per_s * tick.exposure_s, most = law_.mostCount();
    const double whole = law_.sigmaT > 0.0 ? law_.sigmaT * source(NoiseEffect::Frame).normal(0) : 0.0;
    std::vector<double> columns(static_cast<std::size_t>(width), whole);
    for (int x = 0; law_.sigmaTh > 0.0 && x < width; ++x) columns[static_cast<std::size_t>(x)] += law_.sigmaTh * ofColumn.normal(static_cast<std::uint32_t>(x));
    const auto exposeRow = [&](int y) {
      const double row = law_.sigmaTv > 0.0 ? law_.sigmaTv * ofRow.normal(static_cast<std::uint32_t>(y)) : 0.0;
      for (int x = 0; x < width; ++x) {
        const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
        const auto place = static_cast<std::uint32_t>(at);
        const double mean = std::max(0.0, law_.fillFactor * static_cast<double>(fixed.response[at]) * static_cast<double>(picture[at])) + darkMean;
        // What the well holds is what is counted; read-out adds to what it says.
        double electrons = std::min(shot.poisson(mean, place), law_.fullWell);
        if (fixed.bad[at] > 0) electrons = fixed.bad[at] == 1 ? 0.0 : law_.fullWell;
        electrons += static_cast<double>(fixed.dark[at]) + row + columns[static_cast<std::size_t>(x)];
        if (law_.sigmaTvh > 0.0) electrons += law_.sigmaTvh * read.normal(place);
        picture[at] = static_cast<float>(std::clamp(std::floor(law_.gain * electrons + law_.offset + 0.5), 0.0, most));
      }
    };
    sideBySide(height, [&](int first, int last) {
      for (int y = first; y < last; ++y) exposeRow(y);
    });
  }

  DetectorLaw law_;
  std::map<std::uint32_t, Fixed> fixed_;  ///< by channel
};

DetectorLaw readLaw(const Record& r) {
  DetectorLaw law;
  law.fillFactor = r.number("fill_factor");
  law.fullWell = r.number("full_well");
  law.bits = static_cast<int>(r.integer("bits"));
  law.offset = r.number("offset");
  if (!(law.offset < law.mostCount()))
    throw UserError(r.where("offset"), "an offset of " + std::to_string(law.offset) + " counts of " + std::to_string(law.bits) + " bits",
                    "below " + std::to_string(static_cast<int>(law.mostCount())), "lower it, or give more bits");
  law.gain = r.given("gain") ? r.number("gain") : (law.mostCount() - law.offset) / law.fullWell;
  if (!(law.gain * law.fullWell >= 1.0 - 1e-9))
    throw UserError(r.where(r.given("gain") ? "gain" : "full_well"), "a full well is less than a count", "gain x full_well of 1 or more", "raise one of them");
  law.darkCurrent_per_s = r.number("dark_current");
  if (r.given("temperature") != r.given("dark_reference"))
    throw UserError(r.where(), "a detector's 'temperature' and 'dark_reference' go together",
                    "the detector's temperature, and that at which dark_current is meant", "give both or neither");
  if (r.given("temperature")) law.darkCurrent_per_s *= std::exp2((r.number("temperature") - r.number("dark_reference")) / r.number("dark_doubling"));
  law.sigmaTvh = r.number("read_noise"), law.sigmaTv = r.number("row_noise"), law.sigmaTh = r.number("column_noise"), law.sigmaT = r.number("frame_noise");
  law.sigmaVh = r.number("dsnu"), law.sigmaV = r.number("fixed_row_noise"), law.sigmaH = r.number("fixed_column_noise");
  law.prnu = r.number("prnu");
  law.badPixels = r.number("bad_pixels");
  return law;
}

Parameter electronsOf(const char* key, const char* description) { return withDefault(within(number(key, "", description), 0, 1e9), "0"); }

}  // namespace

StageModel detectorModel() {
  return {
      "detector",
      "Photoelectrons become counts: shot noise of light and dark current, fixed and temporal noise, the full well and the converter. Noises are in electrons "
      "rms, named as in EMVA 1288 and in the three-dimensional noise model. For the quantities `counts` and `apparent_temperature`; others stay ideal. A "
      "frame's noise depends on seed, camera, frame and pixel alone.",
      {required(within(number("full_well", "", "electrons that a pixel holds"), 1, 1e12)), withDefault(integer("bits", "of the converter", 1, 16), "14"),
       within(above(number("gain", "", "counts per electron; unless given a full well is the highest count"), 0), 0, 1e6),
       withDefault(within(number("offset", "", "counts that stand for no electrons"), 0, 65535), "0"),
       withDefault(within(above(number("fill_factor", "", "share of a pixel that takes light"), 0), 0, 1), "1"),
       withDefault(within(number("dark_current", "1/s", "electrons a second"), 0, 1e15), "0 /s"),
       within(above(number("temperature", "K", "of the detector"), 0), 0, 1000),
       within(above(number("dark_reference", "K", "temperature at which dark_current is meant"), 0), 0, 1000),
       withDefault(within(above(number("dark_doubling", "K", "warming that doubles it"), 0), 0, 1000), "8 K"),
       electronsOf("read_noise", "sigma_tvh: of each pixel and frame, with reset (kTC) noise"), electronsOf("row_noise", "sigma_tv: of each row and frame"),
       electronsOf("column_noise", "sigma_th: of each column and frame"), electronsOf("frame_noise", "sigma_t: of each frame"),
       electronsOf("dsnu", "sigma_vh: of each pixel, the same in all frames, after correction"), electronsOf("fixed_row_noise", "sigma_v: of each row"),
       electronsOf("fixed_column_noise", "sigma_h: of each column"),
       withDefault(within(number("prnu", "", "of pixels' response, relative, after correction"), 0, 0.5), "0"),
       withDefault(within(number("bad_pixels", "", "share of pixels, half of them dead, half hot"), 0, 1), "0")},
      [](const Record& r, const Camera&) {
        StageChoice choice;
        choice.onPixels = true;
        choice.detector = readLaw(r);
        choice.make = [law = *choice.detector](const ShaderLibrary&) { return std::make_unique<DetectorStage>(law); };
        return choice;
      },
      {},
      true};
}

}  // namespace pitviper
