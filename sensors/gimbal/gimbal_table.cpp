// The keys of a camera's gimbal.
#include "sensors/gimbal/follow_loop.hpp"
#include "sensors/gimbal/gimbal_choice.hpp"
#include "sensors/gimbal/gimbal_tables.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Faster than any servo [Hz]: a scan or jitter beyond is a slip of a unit.
constexpr double kFastest_Hz = 1e6;

}  // namespace

const ParameterTable& gimbalTable() {
  static const ParameterTable t{
      "gimbal",
      "Two axes, azimuth outside and elevation inside, that follow what drives them. Angles are to its base: the body that carries the camera, turned by the "
      "camera's own heading, pitch and roll (of a camera that nothing carries: those alone); azimuth positive to the left of the base's forward axis, "
      "elevation up. What it looks at is the camera's `look_at`.",
      {withDefault(choice("driver", {"truth", "centroid", "commands"},
                          "who points it. truth: where its target is; centroid: a plain tracker on its own pictures, that of a frame acts before the next; "
                          "commands: `point` and `look` of a scenario or a stream"),
                   "truth"),
       above(within(number("azimuth", "rad", "most, each way; all round unless given", &GimbalLimits::azimuth_rad), 0, 100), 0),
       list("elevation", "least and most, within -90 deg to 90 deg, which they are unless given", 2, 2),
       above(within(number("rate", "rad/s", "most, of either axis; unlimited unless given", &GimbalLimits::rate_rad_s), 0, 1e4), 0),
       above(within(number("acceleration", "rad/s2", "most, of either axis; unlimited unless given", &GimbalLimits::acceleration_rad_s2), 0, 1e6), 0),
       within(number("lag", "s", "time constant of its loop: it turns at the demand's distance over this; none unless given", &GimbalOptions::lag_s), 0, 100),
       above(within(number("bandwidth", "Hz", "of its loop at 3 dB, instead of the lag: 1 / (2 pi lag)"), 0, kFastest_Hz), 0),
       withDefault(within(number("latency", "s", "from a frame's time until what was found in it acts (centroid)", &FollowOptions::latency_s), 0, 100), "0 s"),
       list("boresight", "error of its line of sight: [left, up] of where its angles say; none unless given", 2, 2),
       list("offset", "where it is to aim: [left, up] of its target; none unless given", 2, 2),
       withDefault(within(number("roll", "rad", "of the camera about its line of sight, right side down", &GimbalOptions::roll_rad), -kPi, kPi), "0 deg"),
       withDefault(
           boolean("stabilised",
                   "between demands it holds a line in space; else its angles to the base (what keeps the base itself level is the camera's own `stabilised`)",
                   &GimbalOptions::stabilised),
           "true"),
       map("jitter", "of the line of sight: what stabilisation leaves"), map("scan", "a pattern on top of where it looks"),
       map("tracker", "what `driver: centroid` looks for")}};
  return t;
}

namespace {

std::vector<Parameter> axisKeys() {
  return {
      within(number("rms", "rad", "of each axis; its spectrum falls beyond `corner` as that of a first-order Markov process", &AxisJitter::rms_rad), 0, 1.5),
      above(within(number("corner", "Hz", "where that spectrum has fallen by half", &AxisJitter::corner_Hz), 0, kFastest_Hz), 0),
      list("spectrum",
           "instead: [[frequency, density], ...] of an axis, one-sided, in rad2/Hz, such as [[1 Hz, 4 urad2/Hz], [50 Hz, 0.1 urad2/Hz]]; straight between, "
           "nothing beyond",
           2, 4096)};
}

const ParameterTable& jitterAxisTable() {
  static const ParameterTable t{"axis of a jitter", "", axisKeys()};
  return t;
}

const ParameterTable& jitterTable() {
  static const ParameterTable t{"jitter of a gimbal", "The same of both axes, or each its own.", [] {
                                  std::vector<Parameter> keys = axisKeys();
                                  keys.push_back(map("left", "of the axis that turns it left and right"));
                                  keys.push_back(map("up", "of the axis that turns it up and down"));
                                  return keys;
                                }()};
  return t;
}

const ParameterTable& scanTable() {
  const auto positive = [](const char* key, const char* unit, const char* description, double most, Binding into) {
    return above(within(number(key, unit, description, into), 0, most), 0);
  };
  static const ParameterTable t{
      "scan of a gimbal",
      "A pattern that the line of sight goes through, over the scenario's time.",
      {required(choice("pattern", {"raster", "spiral", "conical", "rosette"},
                       "raster: lines from the top down; spiral: from the middle to the edge and back; conical: a circle; rosette: two elements that turn "
                       "against one another")),
       withDefault(choice("by", {{"optics", Scan::By::Optics}, {"gimbal", Scan::By::Gimbal}},
                          "optics: a mirror or prism behind the gimbal; gimbal: it is demanded of the gimbal, with its limits and lag", &Scan::by),
                   "optics"),
       positive("width", "rad", "raster: of its field", kPi, &Scan::width_rad), positive("height", "rad", "raster: of its field", kPi, &Scan::height_rad),
       integer("lines", "raster", 1, 100000, &Scan::lines),
       positive("line_rate", "Hz", "raster: lines a second, each with its flyback", kFastest_Hz, &Scan::lineRate_Hz),
       within(number("flyback", "", "raster: share of a line's time in which it goes back; 0 unless given", &Scan::flyback), 0, 0.999),
       positive("radius", "rad", "spiral, conical, rosette: of the whole pattern", 0.5 * kPi, &Scan::radius_rad),
       positive("frequency", "Hz", "spiral, conical: turns a second; rosette: of the first element", kFastest_Hz, &Scan::frequency_Hz),
       positive("second_frequency", "Hz", "rosette: of the other element", kFastest_Hz, &Scan::secondFrequency_Hz),
       positive("turns", "", "spiral: from the middle to the edge", 1e4, &Scan::turns),
       within(number("phase", "rad", "conical: at time 0; 0 unless given", &Scan::phase_rad), -2 * kPi, 2 * kPi)}};
  return t;
}

const ParameterTable& trackerTable() {
  static const ParameterTable t{
      "tracker of a gimbal",
      "Centroid of what is above a threshold over the background's median, within a gate that follows; the whole picture until something is found. On a "
      "channel's first output, as the sensor's stages leave it.",
      {text("channel", "name of a channel of the camera; its first unless given"),
       withDefault(above(within(number("threshold", "", "above the background, in deviations of its noise", &ThresholdRule::sigmas), 0, 1e6), 0), "5"),
       within(number("least_noise", "", "least deviation, in the output's unit; 0.289 of counts (of their rounding), 0 of others unless given",
                     &ThresholdRule::leastNoise),
              0, 1e30),
       withDefault(within(number("share_of_peak", "", "the threshold lies at least so far from background to peak", &ThresholdRule::shareOfPeak), 0, 0.99),
                   "0"),
       withDefault(choice("background", {{"picture", ThresholdRule::Background::Picture}, {"gate", ThresholdRule::Background::GateBorder}},
                          "of the whole picture, or of a frame of 4 pixels around the gate", &ThresholdRule::background),
                   "picture"),
       withDefault(integer("least_pixels", "above the threshold: fewer are no target", 1, 1000000, &ThresholdRule::leastPixels), "1"),
       above(within(number("saturation", "", "in the output's unit: what is above counts as this; none unless given", &ThresholdRule::saturation), 0, 1e30), 0),
       list("gate", "half its width and height in pixels; [16, 16] unless given", 2, 2),
       withDefault(
           integer("reacquire_after", "frames without a target, after which the whole picture is searched", 1, 1000000, &TrackerOptions::reacquireAfter),
           "5")}};
  return t;
}

}  // namespace

const GimbalTables& tablesOfGimbal() {
  static const GimbalTables all{gimbalTable(), jitterTable(), jitterAxisTable(), scanTable(), trackerTable()};
  return all;
}

std::vector<ParameterTable> gimbalTables() { return {gimbalTable(), jitterTable(), jitterAxisTable(), scanTable(), trackerTable()}; }

}  // namespace pitviper
