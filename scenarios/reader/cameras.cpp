// Cameras, their channels, and probes.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/steadied.hpp"
#include "scenarios/reader/tables.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "sensors/gimbal/gimbal_choice.hpp"
#include "sensors/quantity.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/parameters/units.hpp"
#include "sim/plan/plan.hpp"
#include "sim/world/coverage.hpp"

namespace pitviper {

bool tooLarge(const Camera& c) {
  const double columns = static_cast<double>(c.pinhole.width) * c.samples, rows = static_cast<double>(c.pinhole.height) * c.samples;
  return columns > 16384 || rows > 16384 || columns * rows > 16384.0 * 4096.0;
}

namespace {

/// Rows of one channel's spectra; each makes 16 nodes of 56 bytes in the quadrature: 230 MB.
constexpr std::size_t kMostKnots = 250000;
/// Wavelengths x nodes of all quadrature rules of a scenario, at about 6 ns each: 3 s.
constexpr std::size_t kMostPlanSteps = 500000000;

constexpr std::pair<const char*, bool TruthLayers::*> kTruthLayers[] = {{"range", &TruthLayers::range},
                                                                        {"entity", &TruthLayers::entity},
                                                                        {"temperature", &TruthLayers::temperature},
                                                                        {"normal", &TruthLayers::normal},
                                                                        {"area", &TruthLayers::area},
                                                                        {"solid_angles", &TruthLayers::solidAngles},
                                                                        {"pixel_solid_angle", &TruthLayers::pixelSolidAngle},
                                                                        {"terms", &TruthLayers::terms},
                                                                        {"targets", &TruthLayers::targets}};

Gain readGain(const Value& v) {
  const auto q = v.kind == Value::Kind::Scalar ? splitQuantity(v.text) : std::nullopt;
  if (q) {
    if (const auto g = convert(*q, "V/W")) return {*g, false};
    if (const auto g = convert(*q, "V/(W/m2)")) return {*g, true};
  }
  throw UserError(v.where, "gain is not in volts per watt or per irradiance", "'2e6 V/W' or '40 V/(W/m2)'", "write it with its unit");
}

/// Of F number, focal length and aperture any two say the third; three must agree.
void readAperture(const Record& r, Pinhole& p) {
  if (!r.given("aperture") && !r.given("f_number"))
    throw UserError(r.where(), "a camera without an aperture", "'aperture', its diameter, or 'f_number'", "add 'aperture: 25 mm' or 'f_number: 4'");
  const bool ownFocal = r.given("focal_length");
  if (r.given("aperture")) p.apertureDiameter_m = r.number("aperture");
  if (!r.given("f_number")) return;
  const double fNumber = r.number("f_number");
  if (!r.given("aperture")) {
    p.apertureDiameter_m = p.focalLength_m / fNumber;
    return;
  }
  constexpr double kAgree = 0.005;  // figures are given to two or three digits
  const double own = p.focalLength_m / p.apertureDiameter_m;
  if (std::abs(own / fNumber - 1.0) > kAgree)
    throw UserError(r.where("f_number"),
                    "an F number of " + r.value("f_number").text + ", and " + (ownFocal ? "focal length" : "field of view and pitch") + " over aperture is " +
                        std::to_string(own),
                    "three that agree, or two of them", "remove one");
}

/// Pixels that are read as one, and the part of the film that is read.
void readReadOut(const Record& film, Camera& c) {
  Pinhole& p = c.pinhole;
  c.binning = static_cast<int>(film.integer("binning"));
  if (p.width % c.binning || p.height % c.binning)
    throw UserError(film.where("binning"), "a film that its binning does not divide", "a width and height that are multiples of it", "change one");
  p.width /= c.binning, p.height /= c.binning;
  p.pitchX_m *= c.binning, p.pitchY_m *= c.binning;
  if (!film.given("window")) return;
  const Value& list = film.value("window");
  std::array<int, 4> w{};
  for (std::size_t k = 0; k < w.size(); ++k) {
    const double number = readNumber(list.items[k], "", "the window");
    if (!(number >= 0.0 && number <= 16384.0) || number != std::floor(number))
      throw UserError(list.items[k].where, "a window of no whole pixels", "[left, top, width, height] in whole pixels", "correct it");
    w[k] = static_cast<int>(number);
  }
  if (w[2] < 1 || w[3] < 1 || w[0] + w[2] > p.width || w[1] + w[3] > p.height)
    throw UserError(list.where, "a window that is not within the film's " + std::to_string(p.width) + "x" + std::to_string(p.height) + " pixels",
                    "[left, top, width, height] within it", "correct it");
  c.window = glm::ivec4(w[0], w[1], w[2], w[3]);
}

/// Focal lengths over time, of a film so wide [m]; empty where they stay.
TimeCourse focalLengths(const Record& r, double width_m) {
  if (r.given("focal_length")) {
    const TimeCourse given = r.course("focal_length");
    if (!given.isConstant()) return given;
  }
  if (!r.given("field_of_view")) return {};
  const TimeCourse angles = r.course("field_of_view");
  if (angles.isConstant()) return {};
  std::vector<TimeCourse::Point> points = angles.points();
  for (TimeCourse::Point& p : points) p.value = 0.5 * width_m / std::tan(0.5 * p.value);
  return TimeCourse(std::move(points), angles.interpolation(), angles.outside());
}

constexpr int kAuto = 2;

/// Where an accuracy is asked for, pixels have subpixels where that needs them, and those of the reference it is held against all of them; pictures at exact
/// wavelengths are of pixels' middles.
void setSamples(Camera& c) {
  c.sharesShading = c.spectral.accuracy > 0.0 && !c.spectral.reference;
  c.samples = c.sharesShading || c.spectral.reference ? kAuto : 1;
  if (!tooLarge(c)) return;
  c.sharesShading = false;
  c.samples = 1;
}

void readSamples(const Value& value, Camera& c) {
  constexpr int kMost = 16;
  const bool word = value.kind == Value::Kind::Scalar;
  c.sharesShading = word && value.text == "auto";
  int number = 0;
  const auto [end, error] = std::from_chars(value.text.data(), value.text.data() + value.text.size(), number);
  const bool isNumber = word && error == std::errc() && end == value.text.data() + value.text.size();
  if (!c.sharesShading && !(isNumber && number >= 1 && number <= kMost))
    throw UserError(value.where,
                    isNumber ? "samples is out of range (" + value.text.substr(0, 40) + ")"
                             : "samples is " + (word ? "neither auto nor a whole number ('" + value.text.substr(0, 40) + "')" : std::string(value.kindName())),
                    "'auto', or 1 to 16", "write 'samples: 2' or 'samples: auto'");
  c.samples = c.sharesShading ? kAuto : number;
}

}  // namespace

SpectralSampling Builder::readSpectral(const Record& owner) {
  SpectralSampling s = accuracy_;
  if (!owner.given("spectral")) return s;
  s = {};
  const Record r(owner.value("spectral"), tables::spectral());
  r.fill(s);
  return s;
}

Spectrum Builder::readResponse(const Record& channel) const {
  const Location where = channel.where("response");
  const std::string name = "the response of channel '" + channel.text("name") + "'";
  Spectrum s = bounded(spectra_, channel.value("response"), "", name, 0.0, INFINITY, Outside::Zero);
  // A response that ends at the very end of the axis has an edge there; one that is never zero has none.
  const bool ends = std::any_of(s.factors().begin(), s.factors().end(), [](const Spectrum::Factor& f) {
    const auto* table = std::get_if<Spectrum::Table>(&f);
    return table && table->outside == Outside::Zero;
  });
  if (!ends) throw UserError(where, name + " has no band", "a table, a library name, or {band: [3 um, 5 um]}", "give it edges");
  const double low = std::max(s.supportLow(), s.validLow()), high = std::min(s.supportHigh(), s.validHigh());
  // 1e-30: what is left of a product of responses that hardly overlap; its quadrature would be one of rounding errors.
  if (!(low < high) || s.maximum(low, high) < 1e-30)
    throw UserError(where, name + " is zero everywhere", "a response above zero somewhere", "check its band or table, and whether its factors overlap");
  return s;
}

void Builder::keepOutput(std::vector<ChannelOutput>& outputs, const std::function<ChannelOutput()>& make, const Location& where) const {
  try {
    outputs.push_back(make());
  } catch (const OutsideSpectrum& e) {
    throw UserError(where, "channel: " + std::string(e.what()), "factors of a response that cover its band", "extend the table or declare 'outside: zero'");
  }
  ChannelOutput& output = outputs.back();
  spectra_.count(output.kernel, where);
  const double left = cutToData(simulation_, output);
  if (output.quantity == "radiance_per_um") output.scale /= left;  // per integral of what is left of the response
  if (!(std::isfinite(output.scale) && std::abs(output.scale) < 1e30))
    throw UserError(where, "the factor of '" + output.layer() + "' is larger than any that can be drawn", "a pixel of usual size",
                    "check film, focal length, aperture, exposure and gain");
}

void Builder::planned(const std::vector<ChannelOutput>& outputs, const SpectralSampling& sampling, const Location& where) {
  const auto samples = static_cast<std::size_t>(sampling.samples);
  for (const ChannelOutput& output : outputs) {
    const std::size_t knots = output.kernel.knots().size();
    if (knots > kMostKnots)
      throw UserError(output.where, "the spectra of channel '" + output.channel + "' have " + std::to_string(knots) + " rows together",
                      "at most " + std::to_string(kMostKnots), "thin the tables out");
    planSteps_ += samples * (16 * knots + 32 * samples);
    if (planSteps_ > kMostPlanSteps)
      throw UserError(output.where, "the channels of this scenario take too long to plan with " + std::to_string(samples) + " wavelengths",
                      "fewer or smaller tables, or fewer wavelengths", "lower 'samples' under 'spectral:', or thin the tables out");
  }
  SpectralSampling quick = sampling;
  quick.accuracy = 0.0;  // its mistakes are the scenario's; a plan for an accuracy takes its time and is made where it is drawn
  quick.reference = false;
  makePlan(simulation_, outputs, quick, where);
}

namespace {

/// A camera's keys, and a sensor's where it has none of its own.
Value withSensor(const Value& camera, const Libraries& libraries, const std::filesystem::path& base) {
  const Value* asked = camera.kind == Value::Kind::Map ? camera.find("sensor") : nullptr;
  if (!asked) return camera;
  std::filesystem::path file;
  if (asked->kind == Value::Kind::Map) {
    file = Record(*asked, tables::sensorFile()).text("file");
    if (file.is_relative()) file = base / file;
  } else {
    const std::string name = readText(*asked, "sensor");
    file = libraries.sensors / (name + ".yaml");
    std::error_code ignored;
    if (name.find('/') != std::string::npos || name.size() > 100 || !std::filesystem::is_regular_file(file, ignored)) {
      std::vector<std::string> names;
      for (const auto& entry : std::filesystem::directory_iterator(libraries.sensors, ignored))
        if (entry.path().extension() == ".yaml" && loadYaml(entry.path(), asked->where).find("camera")) names.push_back(entry.path().stem().string());
      std::sort(names.begin(), names.end());
      throw unknownWord(asked->where, "there is no sensor", name, names, "write 'sensor: {file: mine.yaml}', or its keys here");
    }
  }
  const Value tree = loadYaml(file, asked->where);
  const Record sensor(tree, tables::cameraPreset());
  Value merged = camera;
  const Value& preset = asMap(sensor.value("camera"), "a sensor's 'camera'");
  for (std::size_t k = 0; k < preset.entries.size(); ++k) {
    if (preset.entries[k].first == "sensor") throw UserError(preset.keyPlaces[k], "a sensor that names another", "a camera's own keys", "write them here");
    // Of a projection two of three say all: one's own field of view leaves out the sensor's focal length.
    const std::string& key = preset.entries[k].first;
    if (camera.find(key) || (key == "focal_length" && camera.find("field_of_view")) || (key == "field_of_view" && camera.find("focal_length")) ||
        (key == "aperture" && camera.find("f_number")) || (key == "f_number" && camera.find("aperture")))
      continue;
    merged.entries.push_back(preset.entries[k]);
    merged.keyPlaces.push_back(preset.keyPlaces[k]);
  }
  return merged;
}

/// A camera's channels, and an eye's after them.
Value channelsOf(const Record& camera) {
  Value all;
  all.kind = Value::Kind::List;
  all.where = camera.where();
  if (camera.given("channels")) all = camera.value("channels");
  if (!camera.given("eye") || !camera.boolean("eye")) return all;
  for (const char* name : {"X", "Y", "Z"}) {
    Value channel;
    channel.kind = Value::Kind::Map;
    channel.where = camera.where("eye");
    const std::pair<const char*, std::string> keys[] = {
        {"name", name}, {"response", std::string("cie_") + static_cast<char>(std::tolower(name[0]))}, {"output", "tristimulus"}};
    for (const auto& [key, text] : keys) {
      Value scalar;
      scalar.kind = Value::Kind::Scalar;
      scalar.where = channel.where;
      scalar.text = text;
      channel.entries.emplace_back(key, std::move(scalar));
      channel.keyPlaces.push_back(channel.where);
    }
    all.items.push_back(std::move(channel));
  }
  return all;
}

}  // namespace

void Builder::readOwn(const Record& r, Camera* camera, Collector& collector) const {
  for (const char* key : {"exposure", "stages"})
    if (r.given(key) && !camera)
      throw UserError(r.where(key), std::string("'") + key + "' of a channel that is not a camera's", "a channel of a camera in a scenario",
                      std::string("remove '") + key + "'");
  if (!camera || (!r.given("exposure") && !r.given("stages"))) return;
  OwnChannel& own = camera->ownChannels[r.text("name")];
  if (r.given("exposure")) {
    const TimeCourse exposure = r.course("exposure");
    own.exposure_s = collector.exposure_s = exposure.at(simulation_.time.at(0));
    if (!exposure.isConstant()) own.exposureOverTime_s = exposure;
  }
  own.hasDetector = r.given("stages") && makesCounts(r.value("stages"));
  collector.hasDetector = collector.hasDetector || own.hasDetector;
}

std::vector<ChannelOutput> Builder::readChannels(const Value& list, const Spectrum* optics, const Pinhole* pinhole, double exposure_s, bool hasDetector,
                                                 Camera* camera) {
  if (list.items.empty())
    throw UserError(list.where, "no channel", "at least one channel with name and response", "add '- {name: mw, response: {band: [3 um, 5 um]}}'");
  std::map<std::string, Location> names;
  std::vector<ChannelOutput> outputs;
  Collector common = pinhole ? Collector(*pinhole, exposure_s) : Collector();
  common.hasDetector = hasDetector;
  const auto allowed = quantityNames(!pinhole);
  for (const Value& v : list.items) {
    const Record r(v, tables::channel());
    Detector d;
    d.channel = r.text("name");
    d.where = v.where;
    checkUnique(r.value("name"), names, "channel");
    Collector collector = common;
    readOwn(r, camera, collector);
    d.response = readResponse(r);
    if (optics) d.optics = *optics;
    if (r.given("quantum_efficiency"))
      d.quantumEfficiency = bounded(spectra_, r.value("quantum_efficiency"), "", "quantum efficiency", 0.0, 1.0, Outside::Zero);
    if (r.given("gain")) d.gain = readGain(r.value("gain"));
    std::vector<std::pair<std::string, Location>> wanted;
    if (r.given("output") && r.value("output").kind == Value::Kind::List && r.value("output").items.empty())
      throw UserError(r.where("output"), "output is an empty list", "at least one quantity", "write 'output: radiance'");
    if (!r.given("output")) {
      wanted.emplace_back(allowed.front(), v.where);
    } else if (r.value("output").kind == Value::Kind::List) {
      for (const Value& q : r.value("output").items) wanted.emplace_back(readText(q, "output"), q.where);
    } else {
      wanted.emplace_back(r.text("output"), r.where("output"));
    }
    for (const auto& [quantity, where] : wanted) {
      if (std::find(allowed.begin(), allowed.end(), quantity) == allowed.end())
        throw unknownWord(where, pinhole ? "a camera has no quantity" : "a probe has no quantity", quantity, allowed);
      d.where = where;
      d.photopic = [this, &place = where] {
        Value photopic;
        photopic.kind = Value::Kind::Scalar;
        photopic.where = place;
        photopic.text = "cie_y";
        return spectra_.read(photopic, "", "V(lambda)", Outside::Zero);
      };
      keepOutput(
          outputs, [&, &q = quantity] { return makeOutput(d, q, collector); }, where);
      if (camera && camera->ownChannel(d.channel)) outputs.back().apart = d.channel;
      for (size_t i = 0; i + 1 < outputs.size(); ++i)
        if (outputs[i].layer() == outputs.back().layer())
          throw UserError(where, "'" + quantity + "' twice in channel '" + d.channel + "'", "each quantity once", "remove one");
    }
  }
  return outputs;
}

void Builder::tellTemperature(ChannelOutput& output) {
  if (output.asTemperature || output.detected) output.temperature = std::make_shared<BandTemperature>(output.kernel, output.bandLow_um, output.bandHigh_um);
}

void Builder::readCameras(const Record& scenario) {
  if (!scenario.given("cameras")) return;
  for (const Value& written : scenario.value("cameras").items) {
    const Value v = withSensor(written, libraries_, base_);
    const Record r(v, tables::camera());
    Camera c;
    r.fill(c);
    c.where = v.where;
    checkUnique(r.value("name"), cameraNames_, "camera");

    const Record film(r.value("film"), tables::film());
    Pinhole& p = c.pinhole;
    p.width = static_cast<int>(film.integer("width"));
    p.height = static_cast<int>(film.integer("height"));
    c.spectral = readSpectral(r);
    if (r.given("samples")) readSamples(r.value("samples"), c);
    else setSamples(c);
    if (tooLarge(c))
      throw UserError(r.where("film"),
                      "a picture of " + std::to_string(p.width) + "x" + std::to_string(p.height) + " pixels with " + std::to_string(c.samples) + "x" +
                          std::to_string(c.samples) + " subpixels",
                      "at most 67 million subpixels, 16384 on a side", "lower film or samples");
    const int ways = (r.given("focal_length") ? 1 : 0) + (r.given("field_of_view") ? 1 : 0) + (film.given("pitch") ? 1 : 0);
    if (ways != 2 && !(ways == 1 && r.given("field_of_view")))
      throw UserError(r.where(), ways == 3 ? "focal length, pitch and field of view together say too much" : "the projection is not determined",
                      "focal_length and film.pitch; or field_of_view with one of them (or alone: 50 mm)",
                      ways == 3 ? "remove one" : "add 'field_of_view: 5 deg' or 'focal_length' and 'pitch'");
    // What changes over time is as of the first frame here.
    const double first_s = simulation_.time.at(0);
    const double tangent = r.given("field_of_view") ? 2.0 * std::tan(0.5 * r.course("field_of_view").at(first_s)) : 0.0;
    if (film.given("pitch") && r.given("field_of_view")) {
      p.pitchX_m = film.number("pitch");
      p.focalLength_m = p.pitchX_m * p.width / tangent;
    } else {
      p.focalLength_m = r.given("focal_length") ? r.course("focal_length").at(first_s) : 0.05;
      p.pitchX_m = film.given("pitch") ? film.number("pitch") : p.focalLength_m * tangent / p.width;
    }
    p.pitchY_m = film.given("pitch_y") ? film.number("pitch_y") : p.pitchX_m;
    readAperture(r, p);
    readReadOut(film, c);
    c.focalLengthOverTime_m = focalLengths(r, p.focalLength_m * tangent);
    Pinhole widest = p;
    if (!c.focalLengthOverTime_m.empty()) widest.focalLength_m = c.focalLengthOverTime_m.range(first_s, simulation_.time.at(simulation_.time.frames - 1)).first;
    if (!widest.isFlat())
      throw UserError(r.where("film"), "the field of view is wider than a flat film can hold", "below 176 deg",
                      "use a longer focal length, or several cameras");

    if (r.given("exposure")) {
      const TimeCourse exposure = r.course("exposure");
      c.exposure_s = exposure.at(first_s);
      if (!exposure.isConstant()) c.exposureOverTime_s = exposure;
    }

    Placement place = readPlacement(r, Mover::Camera);
    if (place.fliesLater) flyNow(r, Mover::Camera, place);
    c.mount.motion = place.motion;
    c.mount.carrier = place.carrier;
    readLookAt(r, "camera", c.mount);
    c.mount.steadied = readSteadied(r, c.mount, simulation_);

    Spectrum optics(1.0);
    if (r.given("optics")) optics = bounded(spectra_, r.value("optics"), "", "optics transmission", 0.0, 1.0, Outside::Zero);
    if (!r.given("channels") && !(r.given("eye") && r.boolean("eye")))
      throw UserError(v.where, "a camera without channels", "'channels', or 'eye: true'",
                      "add '- {name: mw, response: {band: [3 um, 5 um]}}' under 'channels:'");
    c.outputs = readChannels(channelsOf(r), &optics, &p, c.exposure_s, r.given("stages") && makesCounts(r.value("stages")), &c);
    const auto hasOwnExposure = [&](const ChannelOutput& o) { return c.ownChannel(o.channel) && c.ownChannel(o.channel)->exposure_s; };
    if (written.find("exposure") && std::all_of(c.outputs.begin(), c.outputs.end(), hasOwnExposure))
      throw UserError(r.where("exposure"), "an exposure that no channel of camera '" + c.name + "' has: each has its own",
                      "it for channels that have none, or none", "remove it, or theirs");
    for (const ChannelOutput& o : c.outputs)
      if (c.motionBlur && !(c.exposureOf(o.channel) > 0.0))
        throw UserError(r.where("motion_blur"), "motion within an exposure of no time, in channel '" + o.channel + "'",
                        "'exposure' of the camera, such as '5 ms'", "add it, or remove motion_blur");
    if (r.given("truth"))
      for (const Value& t : r.value("truth").items) {
        const std::string word = readText(t, "truth");
        std::vector<std::string> names;
        for (const auto& [name, layer] : kTruthLayers)
          if (names.emplace_back(name) == word) c.truth.*layer = true;
        if (std::find(names.begin(), names.end(), word) == names.end()) throw unknownWord(t.where, "there is no truth layer", word, names);
      }
    planned(c.outputs, c.spectral, c.where);
    for (ChannelOutput& o : c.outputs) tellTemperature(o);
    if (r.given("gimbal")) c.follower = readGimbal(r.value("gimbal"), simulation_, c, r.given("look_at") ? r.where("look_at") : r.where("gimbal"));
    c.outlineAccuracy = c.spectral.reference ? 0.0 : c.spectral.accuracy;
    c.textureAccuracy = c.spectral.reference ? kFinestTextures : c.spectral.accuracy;
    readStages(r, c);
    if (r.given("spectral_image")) c.spectralImage = readSpectralBins(Record(r.value("spectral_image"), tables::spectralImage()), p);
    simulation_.cameras.push_back(std::move(c));
  }
}

void Builder::readProbes(const Record& scenario) {
  if (!scenario.given("probes")) return;
  std::map<std::string, Location> names;
  for (const Value& v : scenario.value("probes").items) {
    const Record r(v, tables::probe());
    Probe p;
    r.fill(p);
    p.where = v.where;
    checkUnique(r.value("name"), names, "probe");
    if (!(glm::length(p.normal) > 0.0)) throw UserError(r.where("normal"), "a normal of length 0", "a direction such as [0, 0, 1]", "correct it");
    p.resolution = p.resolution / 2 * 2;
    p.spectral = readSpectral(r);
    p.outputs = readChannels(r.value("channels"), nullptr, nullptr, 0.0);
    planned(p.outputs, p.spectral, p.where);
    simulation_.probes.push_back(std::move(p));
  }
}

}  // namespace pitviper
