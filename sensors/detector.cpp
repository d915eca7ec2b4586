// The detector: photoelectrons and dark current as they are counted, what read-out adds, the well, and the converter (DetectorLaw).
// Source: EMVA Standard 1288, release 4.0 (linear camera model: shot noise, dark signal that doubles with temperature, gain, DSNU, PRNU); the components of
// noise by frame, row and column: J. D'Agostino and C. Webb, Proc. SPIE 1488, 110 (1991).
#include <cmath>

#include "sensors/detector_stage.hpp"
#include "sensors/netd_design.hpp"
#include "sensors/signal_memory.hpp"
#include "sensors/stages.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

const ParameterTable& correctionTable() {
  static const ParameterTable t{"correction of a detector",
                                "Two-point correction of pixels' offsets and gains at time 0, from black bodies.",
                                {withDefault(within(above(number("low", "K", "of the colder one", &DetectorLaw::Correction::low_K), 0), 0, 20000), "290 K"),
                                 withDefault(within(above(number("high", "K", "of the hotter one", &DetectorLaw::Correction::high_K), 0), 0, 20000), "310 K"),
                                 withDefault(integer("frames", "that each is averaged over", 1, 1000000, &DetectorLaw::Correction::frames), "64")}};
  return t;
}

DetectorLaw::Correction readCorrection(const Record& detector) {
  const Record r(detector.value("correction"), correctionTable());
  DetectorLaw::Correction c;
  r.fill(c);
  if (!(c.low_K < c.high_K)) throw UserError(r.where(), "a correction whose black bodies do not rise", "'low' below 'high'", "swap them");
  return c;
}

DisplayLaw readDisplay(const Record& r) {
  const std::string agc = r.text("agc");
  DisplayLaw law;
  r.fill(law);
  for (const char* key : {"agc_plateau", "agc_linear"})
    if (r.given(key) && law.agc != Agc::Plateau)
      throw UserError(r.where(key), std::string("'") + key + "' beside 'agc: " + agc + "'", "'agc: plateau', which it is of", "write that, or remove it");
  for (const char* key : {"agc_tails", "agc_gain"})
    if (r.given(key) && law.agc == Agc::Fixed)
      throw UserError(r.where(key), std::string("'") + key + "' beside 'agc: fixed'", "'agc: linear' or 'plateau'", "write one, or remove it");
  return law;
}

DetectorLaw readLaw(const Record& r, const Camera& camera) {
  DetectorLaw law;
  r.fill(law);
  if (!(law.offset < law.mostCount()))
    throw UserError(r.where("offset"), "an offset of " + std::to_string(law.offset) + " counts of " + std::to_string(law.bits) + " bits",
                    "below " + std::to_string(static_cast<int>(law.mostCount())), "lower it, or give more bits");
  if (!r.given("gain")) law.gain = (law.mostCount() - law.offset) / law.fullWell;
  if (!(law.gain * law.fullWell >= 1.0 - 1e-9))
    throw UserError(r.where(r.given("gain") ? "gain" : "full_well"), "a full well is less than a count", "gain x full_well of 1 or more", "raise one of them");
  if (r.given("temperature") != r.given("dark_reference"))
    throw UserError(r.where(), "a detector's 'temperature' and 'dark_reference' go together",
                    "the detector's temperature, and that at which dark_current is meant", "give both or neither");
  if (r.given("temperature")) law.darkCurrent_per_s *= std::exp2((r.number("temperature") - r.number("dark_reference")) / r.number("dark_doubling"));
  law.sigmaTvh = std::hypot(r.number("read_noise"), r.number("reset_noise"));
  if (law.flickerCorner_Hz > 0.0 && !(law.sigmaTvh > 0.0) && !r.given("netd"))
    throw UserError(r.where("flicker_corner"), "a corner of 1/f noise without white noise to meet", "'read_noise' or 'reset_noise'", "give one, or remove it");
  if (r.given("correction")) law.correction = readCorrection(r);
  // Pixels that are read as one: their charges add up, and what differs from one to the next goes together as independent.
  law.darkCurrent_per_s *= camera.binning * camera.binning;
  law.sigmaVh *= camera.binning, law.offsetDrift_per_s *= camera.binning;
  law.prnu /= camera.binning, law.gainDrift_per_s /= camera.binning, law.crosstalk /= camera.binning;
  law.display = readDisplay(r);
  designNoise(r, camera, law);
  return law;
}

Parameter electronsOf(const char* key, const char* description, Binding into = {}) {
  return withDefault(within(number(key, "", description, into), 0, 1e9), "0");
}

}  // namespace

StageModel detectorModel() {
  return {
      "detector",
      "Photoelectrons become counts: shot noise of light and dark current, fixed and temporal noise, the full well and the converter. Noises are in electrons "
      "rms, named as in EMVA 1288 and in the three-dimensional noise model. For the quantities `counts`, `apparent_temperature`, `snr` and `display`; others "
      "stay ideal. A frame's noise depends on seed, camera, frame and pixel alone.",
      {required(within(number("full_well", "", "electrons that a pixel, or those that are read as one, hold", &DetectorLaw::fullWell), 1, 1e12)),
       withDefault(integer("bits", "of the converter", 1, 16, &DetectorLaw::bits), "14"),
       within(above(number("gain", "", "counts per electron; unless given a full well is the highest count", &DetectorLaw::gain), 0), 0, 1e6),
       withDefault(within(number("offset", "", "counts that stand for no electrons", &DetectorLaw::offset), 0, 65535), "0"),
       withDefault(within(above(number("fill_factor", "", "share of a pixel that takes light", &DetectorLaw::fillFactor), 0), 0, 1), "1"),
       withDefault(within(number("dark_current", "1/s", "electrons a second", &DetectorLaw::darkCurrent_per_s), 0, 1e15), "0 /s"),
       within(above(number("temperature", "K", "of the detector"), 0), 0, 1000),
       within(above(number("dark_reference", "K", "temperature at which dark_current is meant"), 0), 0, 1000),
       withDefault(within(above(number("dark_doubling", "K", "warming that doubles it"), 0), 0, 1000), "8 K"),
       electronsOf("read_noise", "sigma_tvh: of each pixel and frame"),
       electronsOf("reset_noise", "kTC noise of each pixel and frame, besides read noise"),
       above(
           within(number("netd", "K",
                         "instead of read noise: the NETD that it is to have at `netd_at`, through this camera's own lens and exposure, without what is fixed"),
                  0, 100),
           0),
       withDefault(within(above(number("netd_at", "K", "of the black body that `netd` is meant for"), 0), 0, 20000), "300 K"),
       text("netd_channel", "of several that count, the one that `netd` is of"),
       withDefault(within(number("flicker_corner", "Hz", "where 1/f noise is as dense as read and reset noise", &DetectorLaw::flickerCorner_Hz), 0, 1e6),
                   "0 Hz"),
       electronsOf("row_noise", "sigma_tv: of each row and frame", &DetectorLaw::sigmaTv),
       electronsOf("column_noise", "sigma_th: of each column and frame", &DetectorLaw::sigmaTh),
       electronsOf("frame_noise", "sigma_t: of each frame", &DetectorLaw::sigmaT),
       electronsOf("dsnu", "sigma_vh: of each pixel, the same in all frames; with `correction` before it, else what one has left", &DetectorLaw::sigmaVh),
       electronsOf("fixed_row_noise", "sigma_v: of each row", &DetectorLaw::sigmaV),
       electronsOf("fixed_column_noise", "sigma_h: of each column", &DetectorLaw::sigmaH),
       withDefault(within(number("prnu", "", "of pixels' response, relative; as dsnu", &DetectorLaw::prnu), 0, 0.5), "0"),
       withDefault(within(number("nonlinearity", "", "of pixels' own bends, rms at a full well, relative: what a correction cannot take away",
                                 &DetectorLaw::nonlinearity),
                          0, 0.2),
                   "0"),
       map("correction", "two-point correction: low, high, frames"),
       withDefault(
           within(number("offset_drift", "1/s", "electrons a second by which pixels go apart after time 0, rms", &DetectorLaw::offsetDrift_per_s), 0, 1e9),
           "0 /s"),
       withDefault(within(number("gain_drift", "1/s", "the same of their response, relative", &DetectorLaw::gainDrift_per_s), 0, 1), "0 /s"),
       withDefault(within(number("bad_pixels", "", "share of pixels, half of them dead, half hot", &DetectorLaw::badPixels), 0, 1), "0"),
       withDefault(integer("bad_cluster", "of them so many side by side", 1, 100, &DetectorLaw::badTogether), "1"),
       withDefault(within(number("crosstalk", "", "share of a pixel's photoelectrons that each of the four beside it gets", &DetectorLaw::crosstalk), 0, 0.2),
                   "0"),
       withDefault(within(number("lag", "", "share of a frame's signal that is left in the next", &DetectorLaw::lag), 0, 0.9), "0"),
       withDefault(within(number("time_constant", "s", "of a bolometer: its signal follows the light so slowly", &DetectorLaw::timeConstant_s), 0, 10), "0 s"),
       withDefault(
           within(number("line_time", "s", "rolling read-out: each row is exposed so much later than the one above, the middle of the film at the frame's time",
                         &DetectorLaw::lineTime_s),
                  0, 1),
           "0 s"),
       withDefault(choice("saturated", {{"nan", WhereUnread::Nan}, {"limit", WhereUnread::Limit}},
                          "what `apparent_temperature` and `snr` are where a count says nothing (the well or the converter is full, the converter's lowest "
                          "code): no number, or the limit, that of what just fills the pixel; of bad pixels no number either way",
                          &DetectorLaw::unread),
                   "nan"),
       withDefault(choice("agc", {{"linear", Agc::Linear}, {"percentile", Agc::Linear}, {"plateau", Agc::Plateau}, {"fixed", Agc::Fixed}},
                          "how `display` maps counts to a screen's 256 codes. linear, or percentile: evenly over the picture's range but for its tails; "
                          "plateau: by its histogram, no count of which weighs more than a plateau; fixed: the converter's whole range",
                          &DisplayLaw::agc),
                   "linear"),
       withDefault(within(number("agc_tails", "", "share of the pixels at either end that the range passes over", &DisplayLaw::tails), 0, 0.2), "0.5 %"),
       above(within(number("agc_gain", "", "most codes that a count gets; unless given noise from frame to frame becomes 4 codes rms at most",
                           &DisplayLaw::most_codesPerCount),
                    0, 255),
             0),
       withDefault(within(above(number("agc_plateau", "", "share of the pixels beyond which a count weighs no more", &DisplayLaw::plateau), 0), 0, 1), "2 %"),
       withDefault(
           within(number("agc_linear", "", "share of the codes that go evenly over the range, so that what is far hotter looks it", &DisplayLaw::linear), 0, 1),
           "20 %")},
      [](const Record& r, const Camera& camera) {
        StageChoice choice;
        choice.onPixels = true;
        choice.detector = readLaw(r, camera);
        choice.warmUp_frames = [law = *choice.detector](double step_s) { return static_cast<int>(memoryWeights(law, step_s).size()) - 1; };
        if (const double part = choice.detector->crosstalk; part > 0.0)
          choice.transfer = choice.drawnTransfer = [part, pitch = camera.pinhole.pitchX_m](const ChannelOutput&, double frequency_per_m) {
            return 1.0 - 2.0 * part * (1.0 - std::cos(2.0 * kPi * frequency_per_m * pitch));
          };
        const Pinhole& p = camera.pinhole;
        DetectorDesign design{camera.exposure_s, p.projectedSolidAngle_sr(p.width / 2, p.height / 2), {}};
        design.ownLight = [stages = camera.stages, design](const ChannelOutput& o) {
          Camera before;
          before.stages = stages;
          return ownLightOf(before, o, design.axis_sr, design.exposure_s);
        };
        choice.make = [law = *choice.detector, design](const ShaderLibrary&) { return makeDetectorStage(law, design); };
        return choice;
      },
      {},
      true};
}

}  // namespace pitviper
