#include "sensors/gimbal/gimbal_choice.hpp"

#include <algorithm>
#include <cmath>

#include "sensors/gimbal/gimbal_follower.hpp"
#include "sensors/gimbal/gimbal_tables.hpp"
#include "sim/parameters/fingerprint.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Deviation of rounding to whole counts, 1 / sqrt(12).
constexpr double kRoundingOfCounts = 0.2886751345948129;

std::string brief(double v) { return print("%.4g", v); }
std::string degrees(double v_rad) { return brief(v_rad * 180.0 / kPi) + " deg"; }

/// Two numbers of one unit.
std::optional<glm::dvec2> pairOf(const Record& r, const char* key, const char* unit, double least, double most, const char* expected) {
  if (!r.given(key)) return std::nullopt;
  const Value& list = r.value(key);
  glm::dvec2 pair;
  for (int k = 0; k < 2; ++k) {
    const Value& item = list.items[static_cast<std::size_t>(k)];
    pair[k] = readNumber(item, unit, key);
    if (!(pair[k] >= least && pair[k] <= most)) throw UserError(item.where, std::string(key) + " is out of range", expected, "correct it");
  }
  return pair;
}

AxisJitter axisOf(const Record& r) {
  AxisJitter axis;
  if (r.given("spectrum")) {
    if (r.given("rms") || r.given("corner")) throw UserError(r.where("spectrum"), "a jitter by its spectrum and by its rms", "one of the two", "remove one");
    for (const Value& point : r.value("spectrum").items) {
      if (asList(point, "a point of a spectrum").items.size() != 2)
        throw UserError(point.where, "not a point of a spectrum", "[frequency, density], such as [1 Hz, 4 urad2/Hz]", "correct it");
      const double f = readNumber(point.items[0], "Hz", "frequency"), s = readNumber(point.items[1], "rad2/Hz", "density");
      if (!(f >= 0.0) || (!axis.spectrum.empty() && !(f > axis.spectrum.back().frequency_Hz)))
        throw UserError(point.items[0].where, "frequencies of a jitter that do not rise", "each above the one before, from 0 Hz", "sort them");
      if (!(s >= 0.0)) throw UserError(point.items[1].where, "a density below 0", "rad2/Hz, 0 or more", "correct it");
      axis.spectrum.push_back({f, s});
    }
    return axis;
  }
  if (r.given("rms") != r.given("corner"))
    throw UserError(r.where(), "a jitter's 'rms' and 'corner' go together", "both, or a 'spectrum'",
                    r.given("rms") ? "add 'corner: 20 Hz'" : "add 'rms: 20 urad'");
  r.fill(axis);
  return axis;
}

Jitter jitterOf(const Value& value) {
  const Record r(value, tablesOfGimbal().jitter);
  const bool own = r.given("left") || r.given("up"), both = r.given("rms") || r.given("corner") || r.given("spectrum");
  if (own && both) throw UserError(r.where(), "a jitter of both axes and one of an axis", "one of the two", "move it under 'left:' and 'up:'");
  if (!own && !both) throw UserError(r.where(), "a jitter of nothing", "'rms' and 'corner', or a 'spectrum'", "write 'jitter: {rms: 20 urad, corner: 20 Hz}'");
  if (both) return {axisOf(r), axisOf(r)};
  Jitter jitter;
  if (r.given("left")) jitter.left = axisOf(Record(r.value("left"), tablesOfGimbal().jitterAxis));
  if (r.given("up")) jitter.up = axisOf(Record(r.value("up"), tablesOfGimbal().jitterAxis));
  return jitter;
}

Scan scanOf(const Value& value) {
  const Record r(value, tablesOfGimbal().scan);
  struct Key {
    const char* name;
    bool required;
  };
  static const std::map<std::string, std::pair<Scan::Kind, std::vector<Key>>> patterns = {
      {"raster", {Scan::Kind::Raster, {{"width", true}, {"height", true}, {"lines", true}, {"line_rate", true}, {"flyback", false}}}},
      {"spiral", {Scan::Kind::Spiral, {{"radius", true}, {"frequency", true}, {"turns", true}}}},
      {"conical", {Scan::Kind::Conical, {{"radius", true}, {"frequency", true}, {"phase", false}}}},
      {"rosette", {Scan::Kind::Rosette, {{"radius", true}, {"frequency", true}, {"second_frequency", true}}}}};
  const std::string name = r.text("pattern");
  const auto& [kind, keys] = patterns.at(name);
  for (const Key& key : keys)
    if (key.required && !r.given(key.name))
      throw UserError(r.where(), "a " + name + " scan without '" + key.name + "'", "the keys of its pattern", std::string("add '") + key.name + ":'");
  for (std::size_t k = 0; k < r.whole().entries.size(); ++k) {
    const std::string& given = r.whole().entries[k].first;
    if (given != "pattern" && given != "by" && std::none_of(keys.begin(), keys.end(), [&](const Key& key) { return given == key.name; })) {
      std::vector<std::string> names;
      for (const Key& key : keys) names.emplace_back(key.name);
      throw unknownWord(r.whole().keyPlaces[k], "a " + name + " scan has no", given, names, "remove it");
    }
  }
  Scan s;
  s.kind = kind;
  r.fill(s);
  return s;
}

std::size_t outputNamed(const Record& tracker, const Camera& camera) {
  if (!tracker.given("channel")) return 0;
  const std::string name = tracker.text("channel");
  std::vector<std::string> names;
  for (std::size_t o = 0; o < camera.outputs.size(); ++o) {
    if (camera.outputs[o].channel == name) return o;
    names.push_back(camera.outputs[o].channel);
  }
  throw unknownWord(tracker.where("channel"), "camera '" + camera.name + "' has no channel", name, names);
}

TrackerOptions trackerOf(const Record& r, const ChannelOutput& output) {
  TrackerOptions t;
  if (output.isCount() || output.asDisplay) t.rule.leastNoise = kRoundingOfCounts;
  r.fill(t);
  r.fill(t.rule);
  if (const auto half = pairOf(r, "gate", "", 1.0, 16384.0, "half its width and height, from 1 pixel")) t.gateHalf_px = *half;
  return t;
}

Value emptyMap(const Location& where) {
  Value v;
  v.kind = Value::Kind::Map;
  v.where = where;
  return v;
}

/// A servo goes through every instant of its grid: of longer scenarios, or frames farther apart, that would take minutes (about 2 million a second).
void requireReachable(const GimbalOptions& g, const TimeAxis& time, const Location& where) {
  constexpr double kLongestStep_s = 1000.0, kLongest_s = 1e5;
  const double all_s = time.step_s * std::max(0, time.frames - 1);
  if (followsAtOnce(g) || (time.step_s <= kLongestStep_s && all_s <= kLongest_s)) return;
  const bool isStep = time.step_s > kLongestStep_s;
  throw UserError(where,
                  "a gimbal with a lag or limits of rate or acceleration, whose servo decides 2000 times a second, over " +
                      (isStep ? brief(time.step_s) + " s from frame to frame" : brief(all_s) + " s from the first frame to the last"),
                  isStep ? "frames at most " + brief(kLongestStep_s) + " s apart ('rate: 0.001 Hz' of 'time')" : "at most " + brief(kLongest_s) + " s in all",
                  isStep ? "raise the rate of 'time', or remove lag, rate and acceleration: it is then where it is demanded to be"
                         : "ask for fewer frames or a higher rate, or remove lag, rate and acceleration");
}

/// Within an exposure a picture is the mean of some; how many is found from where things are at its ends and its middle, which say nothing of a scan that comes
/// round in between.
void requireSeen(const Scan& scan, const Camera& camera, const Location& where) {
  constexpr double kOwn = 0.5, kPartsATurn = 8.0, kMostParts = 256.0;  // turns; parts as of `exposure_parts`
  double exposure_s = camera.exposure_s;
  for (const auto& [channel, own] : camera.ownChannels) exposure_s = std::max(exposure_s, own.exposure_s.value_or(0.0));
  const double turns = std::max({scan.frequency_Hz, scan.secondFrequency_Hz, scan.lineRate_Hz}) * exposure_s, wanted = std::ceil(kPartsATurn * turns);
  if (scan.kind == Scan::Kind::None || !camera.motionBlur || turns <= kOwn || camera.exposureParts >= wanted) return;
  throw UserError(where,
                  "a scan that goes through " + brief(turns) + (scan.kind == Scan::Kind::Raster ? " lines" : " turns") + " within an exposure with motion_blur",
                  wanted <= kMostParts ? "'exposure_parts' of the camera, " + brief(wanted) + " or more (8 a turn)"
                                       : "at most " + brief(kMostParts / kPartsATurn) + " in an exposure of 256 parts",
                  wanted <= kMostParts ? "add 'exposure_parts: " + brief(wanted) + "', or shorten the exposure"
                                       : "shorten the exposure, slow the scan down, or give what it blurs to `point_spread`");
}

std::string wordsOfField(const GimbalOptions& g) {
  std::string text = "gimbal: azimuth " + (std::isfinite(g.limits.azimuth_rad) ? "+-" + degrees(g.limits.azimuth_rad) : std::string("all round"));
  text += ", elevation " + degrees(g.limits.elevation_rad.x) + " to " + degrees(g.limits.elevation_rad.y);
  static const char* const scans[] = {"", "raster", "spiral", "conical", "rosette"};
  if (g.scan.kind != Scan::Kind::None) text += std::string(", ") + scans[static_cast<int>(g.scan.kind)] + " scan";
  return text;
}

/// What the plan of its field depends on.
std::string fieldOf(const GimbalOptions& g) {
  Fingerprint f;
  f.add(g.limits.azimuth_rad).add(g.limits.elevation_rad.x).add(g.limits.elevation_rad.y).add(g.roll_rad);
  for (const glm::dvec2& v : {g.boresight_rad, g.offset_rad}) f.add(v.x).add(v.y);
  const Scan& s = g.scan;
  f.add(static_cast<int>(s.kind)).add(static_cast<int>(s.by)).add(s.width_rad).add(s.height_rad).add(s.lines).add(s.lineRate_Hz).add(s.flyback);
  f.add(s.radius_rad).add(s.frequency_Hz).add(s.secondFrequency_Hz).add(s.turns).add(s.phase_rad);
  return f.bytes();
}

Pose sightOf(const GimbalOptions& g, const FollowerTick& then, const glm::dvec2& angles) {
  glm::dvec2 off = g.boresight_rad;
  if (g.scan.by == Scan::By::Optics) off += scanAt(g.scan, then.time_s);
  return {then.base.position, glm::normalize(then.base.orientation * orientationOf(angles) * orientationOf(off, g.roll_rad))};
}

/// Angles with which the line of sight, with its error and the scan of its optics, goes along a direction: by steps, each of which leaves the square of the
/// error.
glm::dvec2 anglesToward(const GimbalOptions& g, const FollowerTick& then, const glm::dvec3& direction) {
  const glm::dvec2 wanted = anglesOf(glm::conjugate(then.base.orientation) * direction);
  glm::dvec2 angles = wanted;
  constexpr int kSteps = 3;
  for (int k = 0; k < kSteps; ++k) {
    const glm::dvec2 got = anglesOf(glm::conjugate(then.base.orientation) * (sightOf(g, then, angles).orientation * glm::dvec3(1, 0, 0)));
    angles += glm::dvec2(std::remainder(wanted.x - got.x, 2.0 * kPi), wanted.y - got.y);
  }
  return angles;
}

}  // namespace

FollowTick followTick(const FollowerTick& tick) { return {tick.time_s, tick.frame, tick.base, tick.base.position, tick.target, tick.focalLength_m}; }

FollowerChoice gimbalChoice(const FollowOptions& options, std::optional<std::size_t> output, const Camera& camera, const Location& where) {
  FollowerChoice choice;
  choice.where = where;
  choice.driver = nameOf(options.driver);
  choice.words = wordsOfField(options.gimbal) + ", driven by " +
                 (options.driver == GimbalDriver::Truth      ? std::string("the truth")
                  : options.driver == GimbalDriver::Centroid ? "a centroid on '" + camera.outputs[*output].layer() + "'"
                                                             : "commands");
  choice.fingerprint = fieldOf(options.gimbal);
  if (options.driver == GimbalDriver::Centroid) choice.output = output;
  choice.takesCommands = options.driver == GimbalDriver::Commands;
  choice.recordHeader = posesHeader();
  choice.make = [options](const Simulation&, const Camera&) { return makeGimbalFollower(options); };
  choice.anywhere = [g = options.gimbal](const FollowerTick& then, const glm::dvec2& share) {
    const double round = std::min(g.limits.azimuth_rad, kPi);
    const glm::dvec2& e = g.limits.elevation_rad;
    return sightOf(g, then, {round * (2.0 * share.x - 1.0), e.x + (e.y - e.x) * share.y});
  };
  choice.toward = [g = options.gimbal](const FollowerTick& then, const glm::dvec3& direction) -> std::optional<Pose> {
    const glm::dvec2 angles = anglesToward(g, then, direction);
    if (!(glm::length(direction) > 0.0) || beyondLimits(g.limits, {azimuthNear(g.limits, angles.x, 0.0), angles.y}) != glm::dvec2(0.0)) return std::nullopt;
    return sightOf(g, then, angles);
  };
  return choice;
}

FollowerChoice readGimbal(const Value& value, const Simulation& simulation, const Camera& camera, const Location& target) {
  const Record r(value, gimbalTable());
  FollowOptions o;
  o.camera = camera.name;
  o.seed = static_cast<std::uint64_t>(simulation.seed);
  o.film = camera.pinhole;
  const std::string driver = r.text("driver");
  o.driver = *gimbalDriverOf(driver);
  GimbalOptions& g = o.gimbal;
  r.fill(o);
  r.fill(g);
  r.fill(g.limits);
  if (const auto e = pairOf(r, "elevation", "rad", -0.5 * kPi, 0.5 * kPi, "least and most, within -90 deg to 90 deg")) {
    if (!(e->x <= e->y)) throw UserError(r.where("elevation"), "limits of elevation that do not rise", "[least, most]", "swap them");
    g.limits.elevation_rad = *e;
  }
  if (r.given("lag") && r.given("bandwidth"))
    throw UserError(r.where("bandwidth"), "a lag and a bandwidth", "one of the two: bandwidth = 1 / (2 pi lag)", "remove one");
  if (r.given("bandwidth")) g.lag_s = 1.0 / (2.0 * kPi * r.number("bandwidth"));
  constexpr double kMostOff = 0.7853981633974483;
  g.boresight_rad = pairOf(r, "boresight", "rad", -kMostOff, kMostOff, "[left, up] within 45 deg").value_or(glm::dvec2(0.0));
  g.offset_rad = pairOf(r, "offset", "rad", -kMostOff, kMostOff, "[left, up] within 45 deg").value_or(glm::dvec2(0.0));
  if (r.given("jitter")) g.jitter = jitterOf(r.value("jitter"));
  if (r.given("scan")) g.scan = scanOf(r.value("scan"));
  requireReachable(g, simulation.time, r.where());
  if (r.given("scan")) requireSeen(g.scan, camera, r.where("scan"));
  std::optional<std::size_t> output;
  if (o.driver == GimbalDriver::Centroid) {
    const Value none = emptyMap(r.where());
    const Record tracker(r.given("tracker") ? r.value("tracker") : none, tablesOfGimbal().tracker);
    output = outputNamed(tracker, camera);
    o.tracker = trackerOf(tracker, camera.outputs[*output]);
  } else {
    for (const char* key : {"tracker", "latency"})
      if (r.given(key))
        throw UserError(r.where(key), std::string("a ") + key + " of a gimbal that " + driver + " drives", "'driver: centroid', whose pictures they are of",
                        "add that, or remove it");
  }
  const Mount& m = camera.mount;
  const bool looks = m.lookAtEntity >= 0 || m.lookAtLight >= 0 || m.looksAtPoint;
  if (o.driver == GimbalDriver::Truth && !looks && g.scan.kind == Scan::Kind::None)
    throw UserError(r.where("driver"), "a gimbal driven by the truth, and a camera that looks at nothing", "'look_at' of the camera, or a 'scan'",
                    "add 'look_at: <entity>'");
  const FollowerTick first = followerTick(camera, advance(simulation, simulation.time.start_s), 0);
  requireWithinLimits(g.limits, FollowLoop(o).demandAtStart(followTick(first)), camera.name, target);
  return gimbalChoice(o, output, camera, value.where);
}

FollowerChoice replayChoice(std::shared_ptr<const PoseRecord> record, const Camera& camera) {
  FollowerChoice choice;
  if (camera.follower) choice = *camera.follower;
  FollowOptions o;
  o.camera = camera.name;
  o.film = camera.pinhole;
  choice.driver = nameOf(GimbalDriver::Poses);
  choice.words = (camera.follower ? camera.follower->words + "; " : std::string()) + "poses of " + record->file;
  choice.output.reset();
  choice.takesCommands = choice.remembers = false;
  choice.recordHeader = posesHeader();
  choice.make = [o, record](const Simulation&, const Camera&) { return makeGimbalFollower(o, record); };
  if (camera.follower) return choice;
  // Of a camera that nothing points, what it may see is what the record says.
  Fingerprint f;
  for (const PoseRow& row : record->rows) f.add(static_cast<double>(row.frame)).add(row.pose.position).add(row.pose.orientation);
  choice.fingerprint = f.bytes();
  const auto nearest = [record](int frame) {
    const auto at = std::lower_bound(record->rows.begin(), record->rows.end(), frame, [](const PoseRow& row, int wanted) { return row.frame < wanted; });
    return at == record->rows.end() ? record->rows.back().pose : at->pose;
  };
  choice.anywhere = [nearest](const FollowerTick& then, const glm::dvec2&) { return nearest(then.frame); };
  choice.toward = [nearest](const FollowerTick& then, const glm::dvec3&) -> std::optional<Pose> { return nearest(then.frame); };
  return choice;
}

}  // namespace pitviper
