// Deliberately broken input to the real program: exit code 2 (1 where disk or folder are at fault), one line on stderr that begins
// with the very place and names what was expected and the fix, and no output left behind.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "sim/image/png.hpp"
#include "tests/support/air_text.hpp"

namespace {

namespace fs = std::filesystem;

/// Stands in a text where the message must point to; removed before the file is written.
constexpr std::string_view kHere = "@@";

const std::string kPlate = "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: 300 K}]\n";
const std::string kCameraRest = "film: {width: 8, height: 8, pitch: 20 um}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m]";
const std::string kChannels = "channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}}]";
const std::string kCamera = "cameras: [{name: c, " + kCameraRest + ", " + kChannels + "}]\n";

std::string entity(const std::string& rest) { return "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, " + rest + "}]\n" + kCamera; }
std::string shape(const std::string& text) { return "entities: [{name: p, material: {}, temperature: 300 K, shape: " + text + "}]\n" + kCamera; }
std::string channel(const std::string& text) { return kPlate + "cameras:\n- {name: c, " + kCameraRest + ",\n   channels: [" + text + "]}\n"; }
std::string response(const std::string& text) { return channel("{name: mw, response: " + text + "}"); }

std::string light(const std::string& text) { return "lights: [" + text + "]\n" + kPlate + kCamera; }

std::string film(const std::string& text, const std::string& samples = "1") {
  return kPlate + "cameras: [{name: c, film: " + text + ", samples: " + samples +
         ", field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m], " + kChannels + "}]\n";
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// A list of channels c0, c1, ... with bands side by side: as many different kernels.
std::string manyChannels(int count) {
  std::string all;
  for (int i = 0; i < count; ++i)
    all += std::string(i == 0 ? "" : ", ") + "{name: c" + std::to_string(i) + ", response: {band: [" + std::to_string(300 + 10 * i) + "0 nm, " +
           std::to_string(300 + 10 * i) + "9 nm]}}";
  return all;
}

/// Nine levels of nine aliases: 9^9 values.
std::string billionLaughs() {
  std::string text = "a0: &a0 [lol, lol, lol, lol, lol, lol, lol, lol, lol]\n";
  for (int level = 1; level < 9; ++level) {
    const std::string below = "*a" + std::to_string(level - 1), own = "a" + std::to_string(level);
    text += own + ": &" + own + " [" + below + repeated(", " + below, 8) + "]\n";
  }
  return text;
}

struct Result {
  int code = -1;
  std::string out, err;
};

std::string quoted(const std::string& text) {
  std::string q = "'";
  for (char c : text) q += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return q + "'";
}

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// The messages of all cases, told at the end by their names.
std::map<std::string, std::string>& messages() {
  static std::map<std::string, std::string> all;
  return all;
}

/// A folder of its own, and the program run in it.
class Workplace {
 public:
  Workplace() : folder_(fs::temp_directory_path() / ("pitviper_bad_" + std::to_string(getpid()))) {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;
  ~Workplace() { fs::remove_all(folder_); }

  const fs::path& folder() const { return folder_; }

  Result run(const std::vector<std::string>& arguments, const std::string& before = "") const {
    std::string command =
        "cd " + quoted(folder_.string()) + " && " + before + " PITVIPER_HOME=" + quoted(PITVIPER_SOURCE_DIR) + " timeout 7200 " + quoted(PITVIPER_PROGRAM);
    for (const auto& a : arguments) command += " " + quoted(a);
    const int status = std::system((command + " >.stdout 2>.stderr").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readAll(folder_ / ".stdout"), readAll(folder_ / ".stderr")};
  }

  /// Writes a file and returns "name:line:column" of the marked place, or nothing where none is marked.
  std::string put(const std::string& name, std::string text) const {
    std::string place;
    if (const std::size_t at = text.find(kHere); at != std::string::npos) {
      text.erase(at, kHere.size());
      std::size_t line = 1, column = 1;
      for (std::size_t i = 0; i < at; ++i) text[i] == '\n' ? (++line, column = 1) : ++column;
      place = name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": ";
    }
    write(folder_ / name, text);
    return place;
  }

 private:
  fs::path folder_;
};

void expectOneLine(const Result& r, int code, const std::string& begin, const std::vector<std::string>& words) {
  EXPECT_EQ(r.code, code) << r.err;
  ASSERT_FALSE(r.err.empty());
  EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
  EXPECT_EQ(r.err.substr(0, begin.size()), begin) << r.err;
  EXPECT_NE(r.err.find("; fix: "), std::string::npos) << r.err;
  EXPECT_TRUE(code != 2 || r.err.find("; expected ") != std::string::npos) << r.err;
  for (const auto& word : words) EXPECT_NE(r.err.find(word), std::string::npos) << "'" << word << "' in: " << r.err;
  EXPECT_LT(r.err.size(), 2000u);
}

// --- scenarios -----------------------------------------------------------------------------------------------------------------

struct Bad {
  const char* name;
  std::string yaml;
  std::vector<std::string> words;
  std::map<std::string, std::string> files = {};  ///< beside the scenario; the marked place may be in one of them
  std::string place = "";                         ///< where no place can be marked: how the message begins
};

void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }

std::string colourPng() {
  const fs::path file = fs::temp_directory_path() / ("pitviper_colour_" + std::to_string(getpid()) + ".png");
  pitviper::Rgb8Image picture;
  picture.width = picture.height = 4;
  picture.rgb.assign(48, 90);
  pitviper::writePng(file, picture);
  const std::string bytes = readAll(file);
  fs::remove(file);
  return bytes;
}

/// A sound tape7 of one level path of 2 km, 2000 to 2500 1/cm, and the same changed in one place.
std::string tape7() {
  constexpr double kRange_km[] = {2.0};
  return pitviper::test::tape7Text(
      2000, 2500, 50, kRange_km, [](double, double) { return 0.75; }, [](double um, double) { return 0.25 * um; });
}

std::string tape7With(const std::string& what, const std::string& with) {
  std::string text = tape7();
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return at == std::string::npos ? text : text.replace(at, what.size(), with);
}

const char* const kAirHeader = "wavelength_um,range_km,transmittance,path_radiance_W/(m2 sr um)\n";

/// A scene in air from a file; its channel responds from 4.1 to 4.9 um.
std::string airScene(const std::string& air) {
  std::string camera = kCamera;
  const std::string band = "[3.6 um, 4.9 um]";
  return "atmosphere: " + air + "\n" + kPlate + camera.replace(camera.find(band), band.size(), "[4.1 um, 4.9 um]");
}

/// Air from tables: what the scenario says of it, and what is in the files.
std::vector<Bad> badAir() {
  const std::string csv = airScene("{csv: air.csv}"), t7 = airScene("{tape7: air.tp7}");
  const std::string row = " 2050.00 0.75000000 ";
  const auto air = [](const std::string& text) { return std::map<std::string, std::string>{{"air.csv", text}}; };
  const auto run = [](const std::string& text) { return std::map<std::string, std::string>{{"air.tp7", text}}; };
  std::string cut = tape7With(row, "@@" + row);
  cut.resize(cut.find(row) + 60);
  return {
      {"ColumnsMissing", airScene("{columns_file: @@nothing.dat, range: 1 km}"), {"there is no file 'nothing.dat'", "a file of columns"}},
      {"ColumnsThatNothingSays", airScene("{columns_file: air.csv, range: 1 km}"), {"nothing says what the columns hold"}, air("@@4 0.5\n5 0.6\n")},
      {"ColumnsOfAnUnknownName",
       airScene("{columns_file: air.csv, columns: \"wavelength_um, @@tau\", range: 1 km}"),
       {"unknown column 'tau'"},
       air("4 0.5\n5 0.6\n")},
      {"ColumnsWithoutARange",
       airScene("{columns_file: air.csv, columns: '@@wavelength_um, transmittance'}"),
       {"does not say over which range"},
       air("4 0.5\n5 0.6\n")},
      {"ColumnsWithNan",
       airScene("{columns_file: air.csv, columns: 'wavelength_um, extinction_1/km'}"),
       {"'nan' for extinction_1/km is not finite"},
       air("4 0.5\n5 @@nan\n")},
      {"Tape7Missing", airScene("{tape7: @@nothing.tp7}"), {"there is no file 'nothing.tp7'", "a tape7 of MODTRAN"}},
      {"AirCsvMissing", airScene("{csv: @@nothing.csv}"), {"there is no file 'nothing.csv'"}},
      {"AirTwice", airScene("{tape7: air.tp7, library: @@hazy_us76}"), {"given twice, by 'tape7' and by 'library'"}},
      {"AirFromTapeAndCsv", airScene("{tape7: air.tp7, csv: @@air.csv}"), {"given twice, by 'tape7' and by 'csv'"}},
      {"AirFromCsvWithATemperature",
       airScene("{csv: air.csv, temperature: @@280 K}"),
       {"'temperature' is of homogeneous or layered air, and this air is csv", "remove 'temperature'"}},
      {"RangeOfACsv", airScene("{csv: air.csv, range: @@5 km}"), {"'range' is of tape7 or columns air, and this air is csv"}},
      {"RangeAlone", airScene("{library: hazy_us76, range: @@5 km}"), {"'range' is of tape7 or columns air, and this air is layered"}},
      {"SoundingMissing", airScene("{library: hazy_us76, sounding: @@day.csv}"), {"cannot read the file 'day.csv'"}},
      {"SoundingTooDamp",
       airScene("{library: hazy_us76, sounding: day.csv}"),
       {"a relative humidity of 130 %", "0 to 100 %"},
       {{"day.csv", "altitude [m], pressure [hPa], temperature [degC], humidity [%]\n0, 1000, 20, 60\n@@500, 940, 17, 130\n"}}},
      {"SoundingWithAHole",
       airScene("{library: hazy_us76, sounding: day.csv}"),
       {"not a finite number"},
       {{"day.csv", "altitude [m], pressure [hPa], temperature [degC], humidity [%]\n0, 1000, 20, 60\n500, 940,@@ , 50\n"}}},
      {"HazeOfAHundredMetres", airScene("{library: hazy_us76, visibility: @@100 m}"), {"the aerosol is no fog", "add 'aerosol: radiation_fog'"}},
      {"WindOfTheCountry", airScene("{library: hazy_us76, aerosol: rural, wind: @@5 m/s}"), {"'wind' has no say here", "'aerosol: desert'"}},
      {"UnknownClimate", airScene("{library: hazy_us76, climate: @@polar}"), {"tropical, midlatitude_summer"}},
      {"CloudBelowTheGround", airScene("{library: hazy_us76, clouds: [{type: stratus, base: @@-50 m}]}"), {"base is out of range (-50 m)"}},
      {"CloudUpsideDown",
       airScene("{library: hazy_us76, clouds: [{type: stratus, base: 900 m, top: @@700 m}]}"),
       {"a cloud from 900 m to 700 m", "raise the top or lower the base"}},
      {"CloudOfAnotherName", airScene("{library: hazy_us76, clouds: [{type: @@stratos}]}"), {"write 'stratus'"}},
      {"FiveKindsOfClouds",
       airScene("{library: hazy_us76, clouds: [{type: stratus, radius: 5 um}, {type: stratus, radius: 6 um}, {type: stratus, radius: 7 um}, {type: stratus, "
                "radius: 8 um}, @@{type: stratus, radius: 9 um}]}"),
       {"more kinds of clouds and rain", "give layers the same radius"}},
      {"VisibilityOfNoAerosol", airScene("{library: hazy_us76, aerosol: none, visibility: @@5 km}"), {"'visibility' has no say here"}},
      {"TwoTemperatures", airScene("{library: hazy_us76, surface_temperature: 290 K, temperature: @@280 K}"), {"'temperature' has no say here"}},
      {"SoundingOfAnotherWeight",
       airScene("{library: hazy_us76, sounding: day.csv}"),
       {"by the weight of that air", "check the units"},
       {{"day.csv", "altitude [m], pressure [hPa], temperature [degC], humidity [%]\n0, 1000, 20, 60\n@@5000, 900, 10, 50\n"}}},
      {"RangeOfNothing", airScene("{tape7: air.tp7, range: @@0 km}"), {"range is out of range (0 km)"}},
      // CSV.
      {"AirCsvWithoutUnits", csv, {"'range' has no unit", "range_km or range_m"}, air("wavelength_um,@@range,transmittance\n4,1,0.5\n5,1,0.5\n")},
      {"AirCsvWavelengthWithoutUnit", csv, {"'wavelength' has no unit", "wavelength_um or wavelength_nm"}, air("@@wavelength,extinction_1/km\n4,1\n5,1\n")},
      {"AirCsvExtinctionWithoutUnit", csv, {"'extinction' has no unit", "extinction_1/km"}, air("wavelength_um,@@extinction\n4,1\n5,1\n")},
      {"AirCsvRadianceInAnotherUnit", csv, {"unknown unit", "convert the column"}, air("wavelength_um,extinction_1/km,@@source_radiance_W/m2\n4,1,1\n5,1,1\n")},
      {"AirCsvWithNan", csv, {"'nan' for transmittance is not finite"}, air(kAirHeader + std::string("4,1,0.5,0\n5,1,@@nan,0\n"))},
      {"AirCsvWithInfinity", csv, {"'inf' for path_radiance"}, air(kAirHeader + std::string("4,1,0.5,0\n5,1,0.5,@@inf\n"))},
      {"AirCsvOfTooMuchRadiance", csv, {"source radiance", "at most 1e30"}, air("@@" + std::string(kAirHeader) + "4,1,0.9999999,1e30\n5,1,0.5,1e30\n")},
      {"AirCsvDoesNotCoverTheBand",
       csv,
       {"channel 'mw'", "4.1 um to 4.9 um", "4 um to 4.5 um"},
       air("# measured\n@@wavelength_um,extinction_1/km\n4,1\n4.5,1\n")},
      // tape7.
      {"Tape7CutShort", t7, {"the file is cut short", "-9999."}, run(cut), "air.tp7:"},
      {"Tape7CutInAnEarlierRun", t7, {"numbers run together", "two decimal points"}, run(tape7With(row, " 2050.00@@0.75000000.")), "air.tp7:"},
      {"Tape7FieldsRunTogether", t7, {"asterisks for TOT_TRANS"}, run(tape7With(row, " 2050.00@@*********** "))},
      {"Tape7WithNan", t7, {"'NaN' for TOT_TRANS", "a finite number"}, run(tape7With(row, " 2050.00        @@NaN "))},
      {"Tape7OverWavelengths", t7, {"a table over wavelength", "FREQ, wavenumbers in cm-1"}, run(tape7With("    FREQ  TOT", "  @@WAVLEN  TOT"))},
      {"Tape7InPerCent", t7, {"TOT_TRANS"}, run(tape7With(" 0.75000000", "75.00000000")), "air.tp7:"},
      {"Tape7DoesNotCoverTheBand",
       airScene("{tape7: air.tp7}").replace(airScene("{tape7: air.tp7}").find("4.9 um"), 6, "5.2 um"),
       {"the atmosphere has no data for channel 'mw'", "4.1 um to 5.2 um", "4 um to 5 um", "1923 to 2440 1/cm"},
       run(tape7With("    2000.0    2500.0", "@@    2000.0    2500.0"))},
      {"Tape7WithoutARange", t7, {"the range of run 1 is not in the file", "give the range"}, run("@@" + tape7With("   2.00000", "   0.00000"))},
      {"RangeIsNotTheFiles", airScene("{tape7: air.tp7, range: 3 km}"), {"the range given, 3 km, is not the 2 km of run 1"}, run("@@" + tape7())},
      {"AirTableWithNan",
       airScene("{table: bad.air}"),
       {"is 'nan'", "a number from"},
       {{"bad.air", "pitviper-air 1\ntitle x\nsource y\namount a @@nan gas\n"}}},
  };
}

std::vector<Bad> badScenarios() {
  const std::string csvResponse = kPlate + "cameras: [{name: c, " + kCameraRest + ", channels: [{name: mw, response: {file: table.csv}}]}]\n";
  const std::string meshScene = shape("{model: mesh, file: body.obj, unit: 1 m}");
  const std::string missing = "cannot read the file";
  return {
      // Not YAML, or not text.
      {"RandomBytes", "@@\x93\xfa\x01\x88Q{{\xc3(", {"not UTF-8"}},
      {"NotUtf8", "name: caf@@\xe9\n" + kPlate + kCamera, {"0xe9", "UTF-8"}},
      {"ZeroByte", std::string("name: a@@\0b\n", 12), {"0x00"}},
      {"Utf16", std::string("@@\xff\xfen\0a\0m\0e\0", 12), {"UTF-8"}},
      {"TwentyThousandBrackets", repeated("[", 256) + "@@" + repeated("[", 20000), {"brackets nested deeper"}},
      {"Tabs", "name: x\ntime:\n\tframes@@: 3\n", {"not well-formed YAML"}},
      {"UnclosedQuote", "name: @@\"never closed\n" + kPlate + kCamera, {"never closed"}},
      {"Empty", "@@# nothing but a comment\n", {"the file holds nothing"}},
      {"TwoDocuments", "name: a\n---\n@@name: b\n", {"a second document"}},
      {"BillionLaughs", billionLaughs(), {"more than", "aliases"}, {}, "bad.yaml:6:"},
      // Keys and kinds.
      {"ListForMap", "@@- name: x\n- seed: 3\n", {"scenario is a list", "a map of keys"}},
      {"UnknownKey", "name: x\n@@atmosfere: none\n", {"unknown key 'atmosfere'", "did you mean 'atmosphere'?"}},
      {"DuplicateKey", "seed: 1\nname: x\n@@seed: 2\n", {"duplicate key 'seed'"}},
      {"MissingUnit", entity("material: {}, temperature: @@300"), {"temperature has no unit", "write '300 K'"}},
      {"WrongDimension", entity("material: {}, temperature: @@300 m"), {"wrong unit 'm'", "'300 K'"}},
      {"NotANumber", "background: {temperature: @@.nan}\n", {"not a finite number"}},
      {"OutOfRange", "background: {temperature: @@-3 K}\n", {"out of range (-3 K)", "0 to 100000 K"}},
      {"ZeroFrames", "time: {frames: @@0}\n", {"frames is out of range (0)"}},
      {"NegativeFilm", film("{width: @@-640, height: 8, pitch: 20 um}"), {"width is out of range (-640)", "1 to 16384"}},
      {"FilmOfABillion", film("{width: 8, height: @@1000000000, pitch: 20 um}"), {"height is out of range (1000000000)"}},
      {"SamplesInWords", film("{width: 8, height: 8, pitch: 20 um}", "@@many"), {"neither auto nor a whole number", "1 to 16"}},
      {"ABillionSamples", film("{width: 8, height: 8, pitch: 20 um}", "@@1000000000"), {"samples is out of range (1000000000)", "1 to 16"}},
      {"CountBeyondAnyInteger", film("{width: 8, height: 8, pitch: 20 um}", "@@99999999999999999999"), {"nor a whole number"}},
      {"TooManySubpixels", film("@@{width: 16384, height: 16384, pitch: 20 um}"), {"67 million"}},
      {"HostileSegments", shape("{model: sphere, radius: 1 m, segments: @@1000000}"), {"segments is out of range", "8 to 2048"}},
      // Lights with axes.
      {"SpotOfNoBeam", light("@@{name: l, model: spot, intensity: 1 W/(sr um), look_at: p}"), {"missing key 'beam_angle'"}},
      {"SpotThatLooksNowhere", light("@@{name: l, model: spot, intensity: 1 W/(sr um), beam_angle: 9 deg}"), {"light 'l' looks nowhere", "look_at: <entity>"}},
      {"SpotOfHalfASphere", light("{name: l, model: spot, intensity: 1 W/(sr um), look_at: p, beam_angle: @@190 deg}"), {"beam_angle is out of range"}},
      {"LampThatIsTurned", light("{name: l, intensity: 1 W/(sr um), @@heading: 9 deg}"), {"unknown key 'heading'"}},
      {"AreaOfNoSize",
       light("@@{name: l, model: area, radiance: 1 W/(m2 sr um), look_at: p}"),
       {"neither a disc nor a rectangle", "'diameter', or 'width' and 'height'"}},
      {"AreaInView",
       light("{name: l, model: area, radiance: 1 W/(m2 sr um), look_at: p, diameter: 1 m, visible: @@true}"),
       {"an area light that is seen itself", "a body of its size"}},
      // Names.
      {"UnknownMaterial", entity("material: @@green_gras, temperature: 300 K"), {"no material 'green_gras'", "did you mean 'green_grass'?"}},
      {"UnknownLibrarySpectrum", response("@@insb_mwr"), {"did you mean 'insb_mwir'?"}},
      {"LibraryAirOfAnotherModel", "atmosphere: {model: @@homogeneous, library: hazy_us76}\n", {"library air 'hazy_us76' is layered", "remove 'model'"}},
      {"UnknownAir", "atmosphere: @@hazy_us67\n", {"did you mean 'hazy_us76'?"}},
      {"CarriedByItself", entity("material: {}, temperature: 300 K, attached_to: @@p"), {"above this place there is no entity 'p'"}},
      // Materials.
      {"ReflectsMoreThanItReceives",
       "materials:\n  shiny: @@{components: [{reflection: lambertian, reflectance: 0.7}, {reflection: lambertian, reflectance: 0.6}]}\n",
       {"reflects more than it receives"}},
      {"ReflectsAndEmitsTooMuch",
       "materials:\n  warm: @@{components: [{reflection: lambertian, reflectance: 0.3}], emission: {emissivity: 0.8}}\n",
       {"reflects and emits more"}},
      {"ReflectanceBeyondOne", "materials: {m: {components: [{reflection: lambertian, reflectance: @@1.2}]}}\n", {"leaves its range", "0 to 1"}},
      {"MaterialDoesNotCoverTheBand",
       "materials:\n  paint: @@{components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[0.4, 0.1], [2.5, 0.2]]}}]}\n" +
           entity("material: paint, temperature: 300 K"),
       {"material 'paint'", "channel 'mw'", "3.6 um to 4.9 um", "0.4 um to 2.5 um"}},
      // Transparent surfaces and media.
      {"TransmissionWithoutTransmittance", "materials: {m: {transmission: @@{}}}\n", {"a transmission without a transmittance", "transmittance"}},
      {"TransmissionWithAngularAlone", "materials: {m: {transmission: @@{angular: [[0 deg, 1]]}}}\n", {"'angular' but without 'transmittance'"}},
      {"TransmissionTwice",
       "materials: {m: {transmission: @@{transmittance: 0.5, wavelength: [3 um, 5 um], angles: [{angle: view, count: 2, last: 90 deg}], values: [[0.1, 0.1], "
       "[0, 0]]}}}\n",
       {"a transmission that is both a spectrum and a table"}},
      {"TransmittanceBeyondOne", "materials: {m: {transmission: {transmittance: @@1.2}}}\n", {"transmittance", "leaves its range", "0 to 1"}},
      {"TransmittanceTableBeyondOne",
       "materials: {m: {transmission: {wavelength: [3 um, 5 um], angles: [{angle: view, count: 2, last: 90 deg}], values: [[0.1, @@1.3], [0, 0]]}}}\n",
       {"transmittance", "0 to 1"}},
      {"ReflectsAndTransmitsTooMuch",
       "materials:\n  pane: @@{components: [{reflection: lambertian, reflectance: 0.7}], transmission: {transmittance: 0.4}}\n",
       {"reflects and transmits more than it receives", "reflectance + transmittance <= 1"}},
      {"ReflectsTransmitsAndEmitsTooMuch",
       "materials:\n  pane: @@{components: [{reflection: lambertian, reflectance: 0.3}], transmission: {transmittance: 0.4}, emission: {emissivity: 0.4}}\n",
       {"reflects, transmits and emits more than it receives", "reflectance + transmittance + emissivity <= 1"}},
      {"TransmitsTooMuchAtAnAngle",
       "materials:\n  pane: @@{transmission: {transmittance: 0.4, angular: [[0 deg, 1], [80 deg, 2]]}, emission: {emissivity: 0.5}}\n",
       {"more than it receives", "130", "80 deg"}},
      {"TransparentMaterialDoesNotCoverTheBand",
       "materials:\n  pane: @@{transmission: {transmittance: {wavelength: um, unit: \"1\", values: [[0.4, 0.1], [2.5, 0.2]]}}}\n" +
           entity("material: pane, temperature: 300 K"),
       {"material 'pane'", "3.6 um to 4.9 um", "0.4 um to 2.5 um"}},
      {"DirectModeWithAPane",
       "render: {mode: @@direct}\n" + entity("material: {transmission: {transmittance: 0.5}}, temperature: 300 K"),
       {"direct mode cannot draw", "'auto' or 'buffered'"}},
      {"DirectModeWithAMedium",
       "render: {mode: @@direct}\nentities: [{name: p, shape: {model: sphere, radius: 1 m}, material: {absorption: 1 /m}, temperature: 300 K}]\n" + kCamera,
       {"direct mode cannot draw"}},
      {"MediumOfNegativeTemperature",
       "entities: [{name: p, shape: {model: sphere, radius: 1 m}, material: {absorption: 1 /m}, temperature: @@-5 K}]\n" + kCamera,
       {"temperature is out of range (-5 K)"}},
      {"MediumOfATexturedTemperature",
       "entities: [{name: p, shape: {model: sphere, radius: 1 m}, material: {absorption: 1 /m}, temperature: @@{rows: [[300 K, 310 K]]}}]\n" + kCamera,
       {"a temperature texture on 'p'", "one temperature"}},
      {"MediumOnAPlate",
       "entities: [{name: p, shape: @@{model: plate, width: 1 m, height: 1 m}, material: {absorption: 1 /m}, temperature: 300 K}]\n" + kCamera,
       {"the body of 'p' is not closed", "capped cone or cylinder"}},
      {"MediumInAnUncappedCone",
       "entities: [{name: p, shape: @@{model: cone, radius: 1 m, length: 2 m, capped: false}, material: {absorption: 1 /m}, temperature: 300 K}]\n" + kCamera,
       {"the body of 'p' is not closed"}},
      {"MediumInAnOpenMesh",
       "materials: {gas: {absorption: 1 /m}}\nentities: [{name: p, shape: @@{model: mesh, file: body.obj, unit: 1 m}, material: gas, temperature: 300 K}]\n" +
           kCamera,
       {"the body of 'p' is not closed", "'gas' is a medium"},
       {{"body.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\n"}}},
      {"MediumWithComponents",
       "materials: {gas: {absorption: 1 /m, components: @@[{reflection: lambertian, reflectance: 0.1}]}}\n",
       {"a medium with 'components'", "two entities"}},
      {"MediumWithEmission", "materials: {gas: {absorption: 1 /m, emission: @@{emissivity: 0.1}}}\n", {"a medium with 'emission'"}},
      {"MediumWithTransmission", "materials: {gas: {absorption: 1 /m, transmission: @@{transmittance: 0.1}}}\n", {"a medium with 'transmission'"}},
      {"RadianceWithoutAbsorption", "materials: {gas: {radiance: @@1 W/(m2 sr um)}}\n", {"'radiance' that is no medium", "absorption"}},
      {"NegativeAbsorption", "materials: {gas: {absorption: @@-1 /m}}\n", {"absorption of material", "leaves its range"}},
      {"NegativeRadianceOfAMedium", "materials: {gas: {absorption: 1 /m, radiance: @@-1 W/(m2 sr um)}}\n", {"radiance", "leaves its range"}},
      {"AbsorptionWithoutUnit", "materials: {gas: {absorption: @@1}}\n", {"absorption", "no unit"}},
      {"MediumDoesNotCoverTheBand",
       "materials:\n  gas: @@{absorption: {wavelength: um, unit: /m, values: [[0.4, 0.1], [2.5, 0.2]]}}\nentities: [{name: p, shape: {model: sphere, radius: 1 "
       "m}, "
       "material: gas, temperature: 300 K}]\n" +
           kCamera,
       {"material 'gas'", "channel 'mw'", "3.6 um to 4.9 um", "0.4 um to 2.5 um"}},
      {"RadianceOfAMediumDoesNotCoverTheBand",
       "materials:\n  gas: @@{absorption: 1 /m, radiance: {wavelength: um, unit: W/(m2 sr um), values: [[0.4, 0.1], [2.5, 0.2]]}}\nentities: [{name: p, shape: "
       "{model: "
       "sphere, radius: 1 m}, material: gas, temperature: 300 K}]\n" +
           kCamera,
       {"material 'gas'", "3.6 um to 4.9 um"}},
      {"PartsOfAMediumDiffer",
       "entities: [{name: p, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: {absorption: 1 /m}, temperature: 300 K, parts: @@{top: "
       "{temperature: "
       "310 K}}}]\n" +
           kCamera,
       {"the parts of 'p' differ", "make two entities"}},
      {"APartOfABodyIsAMedium",
       "entities: [{name: p, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: {}, temperature: 300 K, parts: @@{top: {material: "
       "{absorption: 1 "
       "/m}}}}]\n" +
           kCamera,
       {"the parts of 'p' differ", "is a medium"}},
      // Channels.
      {"CameraWithoutChannel", kPlate + "cameras: [{name: c, " + kCameraRest + ", channels: @@[]}]\n", {"channels has 0 entries"}},
      {"SeventeenChannels",
       kPlate + "cameras: [@@{name: c, " + kCameraRest + ", channels: [" + manyChannels(17) + "]}]\n",
       {"17 different spectral kernels", "at most 16"}},
      {"ThousandChannels",
       kPlate + "cameras: [{name: c, " + kCameraRest + ", channels: @@[" + manyChannels(1000) + "]}]\n",
       {"channels has 1000 entries", "1 to 64"}},
      {"ResponseZeroEverywhere", response("@@{wavelength: um, unit: \"1\", values: [[3, 0], [5, 0]]}"), {"channel 'mw' is zero everywhere"}},
      {"ResponseTableFalls", response("{wavelength: um, unit: \"1\", values: [[3, 0], [4, 1], @@[3.5, 1]]}"), {"do not rise"}},
      {"ResponseTableWithHole", response("{wavelength: um, unit: \"1\", values: [[3, 0], @@[4], [5, 0]]}"), {"a list of 1", "[wavelength, value]"}},
      {"ResponseTableWithNan", response("{wavelength: um, unit: \"1\", values: [[3, 0], [4, @@nan], [5, 0]]}"), {"not a plain finite number ('nan')"}},
      {"LinesByWavenumber", response("{wavelength: @@1/cm, unit: \"1\", lines: [[2500, 1]]}"), {"by wavenumber", "um"}},
      {"LinesThatFall", response("{wavelength: um, unit: \"1\", lines: [[4, 1], @@[3.99, 1]]}"), {"do not rise"}},
      {"LinesThatGoOn", response("{wavelength: um, unit: \"1\", values: [[3, 1], [5, 1]], lines: [[4, 1]], outside: @@hold}"), {"outside: zero"}},
      {"BandUpsideDown", response("{band: @@[5 um, 3 um]}"), {"rising edges"}},
      // Files.
      {"CsvMissing", kPlate + "cameras: [{name: c, " + kCameraRest + ", channels: [{name: mw, response: {file: @@nothing.csv}}]}]\n", {missing, "nothing.csv"}},
      {"CsvWithoutUnit", csvResponse, {"names no unit in column 2"}, {{"table.csv", "wavelength [um],@@response\n3,0\n4,1\n"}}},
      {"CsvDoesNotRise", csvResponse, {"do not rise"}, {{"table.csv", "# made by hand\nwavelength [um],response [1]\n3,0\n4,1\n@@3.9,1\n"}}},
      {"CsvWithNan", csvResponse, {"not a finite number: 'nan'"}, {{"table.csv", "wavelength [um],response [1]\n3,0\n4,@@nan\n"}}},
      {"CsvOfThreeColumns", csvResponse, {"a row of 3 cells"}, {{"table.csv", "wavelength [um],response [1]\n@@3,0,0\n"}}},
      {"MeshMissing", shape("{model: mesh, file: @@nothing.obj, unit: 1 m}"), {"nothing.obj", "cannot read the file"}},
      {"MeshWithNan", meshScene, {"'nan' is not a finite number"}, {{"body.obj", "v 0 0 0\nv 1 @@nan 0\nv 0 1 0\nf 1 2 3\n"}}},
      {"TextureRowsUneven", entity("material: {}, temperature: {rows: [[300 K, 310 K], @@[300 K]]}"), {"a texture row has 1 entries"}},
      {"TextureInColour",
       entity("material: {}, temperature: {file: colour.png, minimum: 0 K, maximum: 400 K}"),
       {"grey PNG"},
       {{"colour.png", colourPng()}},
       "colour.png: "},
      {"HeightMapTooSmall", shape("{model: terrain, size: 1 km, height_map: @@{rows: [[1 m, 2 m]]}}"), {"a height map of 2x1", "2x2 to 2048x2048"}},
  };
}

class BadScenario : public testing::TestWithParam<Bad> {};

TEST_P(BadScenario, IsRefusedAtItsPlace) {
  const Bad& bad = GetParam();
  const Workplace place;
  std::string begin = place.put("bad.yaml", bad.yaml);
  for (const auto& [name, text] : bad.files)
    if (const std::string marked = place.put(name, text); !marked.empty()) begin = marked;
  if (begin.empty()) begin = bad.place;
  ASSERT_FALSE(begin.empty());
  const Result r = place.run({"check", "bad.yaml"});
  expectOneLine(r, 2, begin, bad.words);
  EXPECT_EQ(r.out, "");
  messages()[bad.name] = r.err;
  // The same through the command that writes: nothing may be left.
  if (std::string(bad.name) == "MissingUnit") {
    EXPECT_EQ(place.run({"run", "bad.yaml", "--out", "frames"}).code, 2);
    EXPECT_FALSE(fs::exists(place.folder() / "frames"));
  }
}

INSTANTIATE_TEST_SUITE_P(Air, BadScenario, testing::ValuesIn(badAir()), [](const auto& one) { return std::string(one.param.name); });
INSTANTIATE_TEST_SUITE_P(All, BadScenario, testing::ValuesIn(badScenarios()), [](const auto& one) { return std::string(one.param.name); });

TEST(GoodScenario, MinimalAndWithAliases) {
  const Workplace place;
  place.put("plain.yaml", kPlate + kCamera);
  EXPECT_EQ(place.run({"check", "plain.yaml"}).code, 0) << place.run({"check", "plain.yaml"}).err;
  place.put("alias.yaml",
            "materials: {grey: &grey {emission: {emissivity: 0.9}}, again: *grey}\n"
            "entities:\n- &plate {name: p, shape: &square {model: plate, width: 1 m, height: 1 m}, material: grey, temperature: 300 K}\n"
            "- {name: q, shape: *square, material: again, temperature: 310 K}\n" +
                kCamera);
  EXPECT_EQ(place.run({"check", "alias.yaml"}).code, 0) << place.run({"check", "alias.yaml"}).err;
}

// --- the command line ----------------------------------------------------------------------------------------------------------

struct BadCommand {
  const char* name;
  std::vector<std::string> arguments;
  std::string begin;
  std::vector<std::string> words;
};

void PrintTo(const BadCommand& bad, std::ostream* out) { *out << bad.name; }

std::vector<BadCommand> badCommands() {
  return {
      {"UnknownCommand", {"chek", "good.yaml"}, "pitviper: ", {"did you mean 'check'?"}},
      {"UnknownOption", {"run", "good.yaml", "--frame", "0"}, "pitviper run: ", {"did you mean '--frames'?"}},
      {"NoFile", {"check"}, "pitviper check: ", {"too few arguments"}},
      {"ScenarioMissing", {"check", "nothing.yaml"}, "nothing.yaml: ", {"cannot read the file", "No such file"}},
      {"ScenarioIsAFolder", {"check", "."}, ".: ", {"cannot read the file"}},
      {"SetLeadsNowhere",
       {"check", "good.yaml", "--set", "cameras.0.cameras.0.samples=2"},
       "--set cameras.0.cameras.0.samples=2: ",
       {"unknown key 'cameras' in camera"}},
      {"SetOfAnUnknownKey", {"check", "good.yaml", "--set", "cameras.c.sampels=2"}, "--set cameras.c.sampels=2: ", {"did you mean 'samples'?"}},
      {"SetWithoutValue", {"check", "good.yaml", "--set", "cameras.c.samples"}, "--set cameras.c.samples: ", {"not an assignment"}},
      {"SetOutOfRange", {"check", "good.yaml", "--set", "cameras.0.samples=99"}, "--set cameras.0.samples=99: ", {"samples is out of range (99)"}},
      {"SetOfBrokenYaml", {"check", "good.yaml", "--set", "name=[a"}, "--set name=[a:", {"not well-formed YAML"}},
      {"FramesOutOfRange", {"run", "good.yaml", "--frames", "0:7"}, "--frames 0:7: ", {"within 0:0"}},
      {"FramesNoNumber", {"run", "good.yaml", "--frames", "all"}, "--frames: ", {"'all' is not a range"}},
      {"FramesBackwards", {"run", "good.yaml", "--frames", "0:-1"}, "--frames 0:-1: ", {"no such range"}},
      {"ExrMissing", {"info", "nothing.exr"}, "nothing.exr: ", {"cannot read the file"}},
      {"ExrDamaged", {"info", "damaged.exr"}, "damaged.exr: ", {}},
      {"ExrIsText", {"info", "good.yaml"}, "good.yaml: ", {}},
  };
}

class BadCommandLine : public testing::TestWithParam<BadCommand> {};

TEST_P(BadCommandLine, IsRefused) {
  const Workplace place;
  place.put("good.yaml", kPlate + kCamera);
  // The magic number and version of an EXR file, then nothing that is true.
  write(place.folder() / "damaged.exr", std::string("\x76\x2f\x31\x01\x02\0\0\0channels\0chlist\0\xff\xff\xff\x7f", 28) + repeated("R", 400));
  const Result r = place.run(GetParam().arguments);
  expectOneLine(r, 2, GetParam().begin, GetParam().words);
  messages()[GetParam().name] = r.err;
  EXPECT_FALSE(fs::exists(place.folder() / "out")) << "output of a run that was refused";
}

INSTANTIATE_TEST_SUITE_P(All, BadCommandLine, testing::ValuesIn(badCommands()), [](const auto& one) { return std::string(one.param.name); });

TEST(Disk, OutputFolderThatCannotBe) {
  const Workplace place;
  place.put("good.yaml", kPlate + kCamera);
  place.put("taken", "a file in the way\n");
  for (const char* folder : {"taken", "taken/deeper", "/proc/nothing"}) {
    const Result r = place.run({"run", "good.yaml", "--out", folder});
    expectOneLine(r, 1, "", {folder});
    messages()[std::string("OutputFolder ") + folder] = r.err;
  }
  EXPECT_EQ(readAll(place.folder() / "taken"), "a file in the way\n");
}

// A word that names no stage: the environment is at fault, not a scenario.
TEST(Environment, UnknownShadingStage) {
  const Workplace place;
  place.put("pane.yaml", "render: {mode: buffered}\n" + entity("material: {transmission: {transmittance: 0.5}}, temperature: 300 K"));
  const Result r = place.run({"run", "pane.yaml", "--out", "frames"}, "PITVIPER_SHADING=shade");
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
  for (const char* word : {"PITVIPER_SHADING", "'shade'", "fragment", "compute"}) EXPECT_NE(r.err.find(word), std::string::npos) << r.err;
  messages()["UnknownShadingStage"] = r.err;
  EXPECT_FALSE(fs::exists(place.folder() / "frames") && !fs::is_empty(place.folder() / "frames"));
  EXPECT_EQ(place.run({"run", "pane.yaml", "--out", "more"}, "PITVIPER_SHADING=compute").code, 0);
}

/// Ten messages as a user sees them.
class Showcase : public testing::Environment {
 public:
  void SetUp() override { ASSERT_TRUE(fs::exists(PITVIPER_PROGRAM)) << PITVIPER_PROGRAM; }
  void TearDown() override {
    std::printf("\nTen messages:\n");
    for (const char* name : {"UnknownKey", "MissingUnit", "WrongDimension", "FilmOfABillion", "MaterialDoesNotCoverTheBand", "ReflectsAndEmitsTooMuch",
                             "SeventeenChannels", "CsvDoesNotRise", "NotUtf8", "SetOfAnUnknownKey"})
      if (const auto found = messages().find(name); found != messages().end()) std::printf("  %s", found->second.c_str());
  }
};

[[maybe_unused]] const auto* const kShowcase = testing::AddGlobalTestEnvironment(new Showcase);

}  // namespace
