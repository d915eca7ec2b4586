#include "tests/fuzz/fuzz_scenario.hpp"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <string_view>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/image/png.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// Of the processor's time, on whatever machine: the slowest case takes 1 s. What waits is ended by tests/support/main.cpp.
constexpr long kLongest_s = 60;
#if defined(__SANITIZE_ADDRESS__)
constexpr long kMostMemory_kB = 8L << 20;  // shadow memory and quarantine count too
#else
constexpr long kMostMemory_kB = 1L << 20;
#endif

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write(const fs::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// One damage to a text; the methods are the kinds.
class Mutator {
 public:
  Mutator(std::uint64_t seed, const std::vector<std::string>& corpus) : random_(seed), corpus_(corpus) {}

  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(random_() % n); }

  void damage(std::string& text) {
    switch (below(12)) {
      case 0:
        return flipBit(text);
      case 1:
        return eraseBytes(text);
      case 2:
        return insertBytes(text);
      case 3:
        return repeatLine(text);
      case 4:
        return swapLines(text);
      case 5:
        return dropLine(text);
      case 6:
        return splice(text);
      case 7:
        return text.resize(below(text.size() + 1));
      case 8:
        return changeDigit(text);
      case 9:
        return replaceToken(text);
      default:
        return replaceValue(text);
    }
  }

 private:
  struct Range {
    std::size_t first, count;
  };

  Range line(const std::string& text) {
    if (text.empty()) return {0, 0};
    const std::size_t at = below(text.size()), before = at == 0 ? std::string::npos : text.rfind('\n', at - 1), end = text.find('\n', at);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    return {first, (end == std::string::npos ? text.size() : end + 1) - first};
  }

  void flipBit(std::string& text) {
    if (text.empty()) return;
    char& c = text[below(text.size())];
    c = static_cast<char>(c ^ (1 << below(8)));
  }
  void eraseBytes(std::string& text) { text.erase(below(text.size() + 1), 1 + below(8)); }
  void insertBytes(std::string& text) {
    constexpr std::string_view kSigns = "[]{}:,-#&*!|>'\"%@`?~ \t\n\r.0eE+";
    std::string bytes;
    for (std::size_t n = 1 + below(6); n > 0; --n) bytes += below(4) == 0 ? static_cast<char>(random_()) : kSigns[below(kSigns.size())];
    text.insert(below(text.size() + 1), bytes);
  }
  void repeatLine(std::string& text) {
    const Range r = line(text);
    const std::string copy = text.substr(r.first, r.count);
    for (std::size_t n = below(8) == 0 ? 50 : 1; n > 0; --n) text.insert(r.first, copy);
  }
  void swapLines(std::string& text) {
    Range a = line(text), b = line(text);
    if (b.first < a.first) std::swap(a, b);
    if (a.first + a.count > b.first) return;
    const std::string first = text.substr(a.first, a.count), second = text.substr(b.first, b.count);
    text.replace(b.first, b.count, first);
    text.replace(a.first, a.count, second);
  }
  void dropLine(std::string& text) {
    const Range r = line(text);
    text.erase(r.first, r.count);
  }
  void splice(std::string& text) {
    const std::string& other = corpus_[below(corpus_.size())];
    const Range head = line(text), tail = line(other);
    text = text.substr(0, head.first) + other.substr(tail.first);
  }
  void changeDigit(std::string& text) {
    const std::size_t at = text.find_first_of("0123456789", below(text.size() + 1));
    if (at != std::string::npos) text[at] = static_cast<char>('0' + below(10));
  }
  /// Anything between separators.
  void replaceToken(std::string& text) { replaceBetween(text, " \t\n,:[]{}#"); }
  /// A whole value, its unit included.
  void replaceValue(std::string& text) {
    const std::size_t colon = text.find(": ", below(text.size() + 1));
    if (colon == std::string::npos) return replaceToken(text);
    const std::size_t end = text.find_first_of(",}\n", colon + 2);
    text.replace(colon + 2, (end == std::string::npos ? text.size() : end) - colon - 2, hostileValue());
  }
  void replaceBetween(std::string& text, const char* separators) {
    const std::size_t first = text.find_first_not_of(separators, below(text.size() + 1));
    if (first == std::string::npos) return;
    const std::size_t end = text.find_first_of(separators, first);
    text.replace(first, (end == std::string::npos ? text.size() : end) - first, hostileValue());
  }

  std::string hostileValue() {
    static constexpr std::array kValues = {"nan",
                                           ".nan",
                                           "nan K",
                                           ".inf",
                                           "-.inf",
                                           "inf m",
                                           "1e308",
                                           "1e308 m",
                                           "-1e308",
                                           "1e400 K",
                                           "1e-320",
                                           "1e-320 s",
                                           "1e-320 Hz",
                                           "-1",
                                           "-1 m",
                                           "-1 K",
                                           "0",
                                           "0 m",
                                           "0 s",
                                           "0 Hz",
                                           "0 K",
                                           "0 deg",
                                           "0 um",
                                           "1",
                                           "2",
                                           "2047",
                                           "1e30 m",
                                           "1e9 m",
                                           "1e-9 m",
                                           "1e5 K",
                                           "1e6 K",
                                           "1e6 km",
                                           "360 deg",
                                           "180 deg",
                                           "90 deg",
                                           "16384",
                                           "65536",
                                           "4294967296",
                                           "2147483647",
                                           "2147483648",
                                           "9223372036854775807",
                                           "99999999999999999999",
                                           "-9223372036854775808",
                                           "1000000000",
                                           "0x10",
                                           "1_000",
                                           "[]",
                                           "{}",
                                           "[[]]",
                                           "~",
                                           "null",
                                           "true",
                                           "''",
                                           "\"\\0\"",
                                           "\"\\x7f\\u2028\"",
                                           "|",
                                           ">",
                                           "*a",
                                           "&a 1",
                                           "!!binary aGk=",
                                           "[1, 2, 3]",
                                           "[nan m, 1 m, 2 m]",
                                           "{band: [3 um, 5 um]}",
                                           "{band: [5 um, 3 um]}",
                                           "{band: [0.1 um, 1000 um]}",
                                           "{blackbody: 300 K}",
                                           "{product: [0.5, 1e30, 1e30, 1e30]}",
                                           "{values: [[1, 0], [2, 0]], wavelength: um, unit: \"1\"}",
                                           "{values: [[1, 1], [1, 2]], wavelength: um, unit: \"1\"}",
                                           "{file: nothing.csv}",
                                           "{file: /dev/zero}",
                                           "{file: .}",
                                           "{library: cie_y}",
                                           "cie_y",
                                           "insb_mwir",
                                           "grass",
                                           "../../etc/passwd",
                                           "10 %",
                                           "3 furlong",
                                           "3 W/(m2 sr um)",
                                           "1 W/(m2",
                                           "m",
                                           "-",
                                           "- -",
                                           "? x",
                                           "<<",
                                           "{<<: {a: 1}}",
                                           "[0 m, 0 m, 0 m]",
                                           "[1e9 m, -1e9 m, 1e9 m]",
                                           "electrons",
                                           "[radiance, flux, electrons, volts, luminance]",
                                           "{width: 1, height: 1, pitch: 1 m}",
                                           "{width: 16384, height: 16384, pitch: 1 um}",
                                           "{model: sphere, radius: 1 m, segments: 512}",
                                           "{model: terrain, size: 1 m, columns: 256, relief: 10 km}",
                                           "{model: mesh, file: nothing.obj, unit: 1 m}",
                                           "jet",
                                           "terrain",
                                           "seeker"};
    if (below(24) == 0) return std::string(1 + below(50000), "a1[{-\" "[below(7)]);
    return kValues[below(kValues.size())];
  }

  std::mt19937_64 random_;
  const std::vector<std::string>& corpus_;
};

/// What a library file stands for, by its folder and, of a sensor's, its unit.
enum class Role { Scenario, Material, Substance, Air, Response, Light, Sun, Camera };

Role roleOf(const fs::path& file) {
  if (file.parent_path().filename() == "substances") return Role::Substance;
  if (file.parent_path().filename() != "library") return Role::Scenario;
  const std::string owner = file.parent_path().parent_path().filename().string();
  if (owner != "sensors") return owner == "materials" ? Role::Material : Role::Air;
  const std::string text = readAll(file);
  if (text.find("\ncamera:") != std::string::npos) return Role::Camera;
  if (text.find("W/(sr um)") != std::string::npos) return Role::Light;
  return text.find("W/(m2 um)") != std::string::npos ? Role::Sun : Role::Response;
}

/// The smallest scenario that reads the library file called "mutant".
std::string userOf(Role role) {
  if (role == Role::Camera) return "cameras: [{name: c, sensor: mutant, heading: 0 deg, position: [9 m, 0 m, 0 m]}]\n";
  const char* response = role == Role::Response ? "mutant" : "{band: [2.5 um, 2.6 um]}";
  const char* first = role == Role::Air ? "atmosphere: mutant\n"
                      // No body has it: each has a range of its own.
                      : role == Role::Substance ? "materials: {m: {components: [{reflection: microfacet, index: mutant, roughness: 0.1}]}}\n"
                      : role == Role::Light     ? "lights: [{name: l, intensity: mutant}]\n"
                      : role == Role::Sun       ? "sun: {azimuth: 0 deg, elevation: 40 deg, irradiance: mutant}\n"
                                                : "";
  return std::string(first) +
         "entities: [{name: p, shape: {model: box, length: 1 m, width: 1 m, height: 1 m}, material: " + (role == Role::Material ? "mutant" : "{}") +
         ", temperature: 300 K}]\ncameras: [{name: c, film: {width: 8, height: 8, pitch: 20 um}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: "
         "[9 m, 0 m, 0 m], "
         "channels: [{name: b, response: " +
         response + "}]}]\n";
}

/// Copies of the shipped libraries with a place for the damaged file beside its neighbours.
Libraries copyLibraries(const fs::path& root, const fs::path& folder) {
  const Libraries copies{folder / "materials", folder / "atmosphere", folder / "sensors"};
  for (const fs::path& copy : {copies.materials, copies.atmosphere, copies.sensors, folder / "substances"}) {
    fs::remove_all(copy);
    fs::create_directories(copy);
    for (const auto& entry : fs::directory_iterator(copy.filename() == "substances" ? root / "materials/substances" : root / copy.filename() / "library"))
      if (entry.path().extension() == ".yaml" || entry.path().extension() == ".air") fs::copy_file(entry.path(), copy / entry.path().filename());
  }
  fs::copy(root / "materials/library/gases", copies.materials / "gases", fs::copy_options::recursive);
  for (const char* tables : {"climates", "aerosols"}) fs::copy(root / "atmosphere/library" / tables, copies.atmosphere / tables, fs::copy_options::recursive);
  return copies;
}

/// The shipped scenarios beside small copies of the pictures they name: what is damaged is words, not texels.
void copyScenarios(const fs::path& from, const fs::path& to) {
  constexpr int kSide = 16;
  fs::create_directories(to / "assets");
  for (const auto& entry : fs::directory_iterator(from))
    if (entry.path().extension() == ".yaml") fs::copy_file(entry.path(), to / entry.path().filename(), fs::copy_options::overwrite_existing);
  for (const auto& entry : fs::directory_iterator(from / "assets")) {
    const fs::path copy = to / "assets" / entry.path().filename();
    if (entry.path().filename().string().starts_with("terrain_")) {
      const GreyImage whole = readPngGrey(entry.path());
      std::vector<std::uint16_t> few;
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
          few.push_back(static_cast<std::uint16_t>(
              65535.0 * static_cast<double>(whole.pixels[static_cast<std::size_t>(y * whole.height / kSide * whole.width + x * whole.width / kSide)])));
      writePngGrey(copy, kSide, kSide, few);
    } else if (entry.is_regular_file()) {
      fs::copy_file(entry.path(), copy, fs::copy_options::overwrite_existing);
    }
  }
}

/// `<file>:<line>:<column>: ...; fix: ...` in one line; the file's name may hold anything.
bool wellFormed(const std::string& message) {
  static const std::regex place("^[^:]*:[0-9]+:[0-9]+: .");
  return message.find('\n') == std::string::npos && message.size() < 10000 && message.find("; fix: ") != std::string::npos &&
         std::regex_search(message.substr(0, 4000), place);
}

extern "C" void tellHang(int) {
  constexpr std::string_view text =
      "fuzz_scenario: a case takes more than 60 s of the processor; its input is the file 'case.yaml' or 'mutant.yaml' in the fuzz folder\n";
  [[maybe_unused]] const auto written = ::write(2, text.data(), text.size());
  std::abort();
}

void limitProcessor(long seconds) {
  const itimerval limit{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

long peakMemory_kB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

class Run {
 public:
  Run(const std::vector<fs::path>& files, const fs::path& root, const fs::path& folder)
      : files_(files), folder_(folder), libraries_(copyLibraries(root, folder)) {
    copyScenarios(root / "scenarios", folder_ / "scenarios");
    static const std::regex columns("columns: *[0-9]+");
    for (const fs::path& file : files) {
      corpus_.push_back(std::regex_replace(readAll(file), columns, "columns: 8"));
      roles_.push_back(roleOf(file));
    }
  }

  void one(std::uint64_t seed) {
    Mutator mutator(seed, corpus_);
    const std::size_t chosen = mutator.below(files_.size());
    std::string text = corpus_[chosen];
    for (std::size_t n = 1 + mutator.below(4); n > 0; --n) mutator.damage(text);
    take(seed, chosen, text);
  }

  void undamaged(std::size_t chosen) { take(chosen, chosen, corpus_[chosen]); }

  FuzzReport report() const { return report_; }

 private:
  void take(std::uint64_t seed, std::size_t chosen, const std::string& text) {
    const Role role = roles_[chosen];
    const fs::path kept = fileOf(role);
    write(kept, text);
    const std::clock_t start = std::clock();
    limitProcessor(kLongest_s);
    const std::string wrong = read(role == Role::Scenario ? text : userOf(role), role == Role::Scenario ? folder_ / "scenarios" : files_[chosen].parent_path());
    limitProcessor(0);
    note(seed, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, wrong, kept);
  }

  fs::path fileOf(Role role) const {
    switch (role) {
      case Role::Material:
        return libraries_.materials / "mutant.yaml";
      case Role::Substance:
        return folder_ / "substances/mutant.yaml";
      case Role::Air:
        return libraries_.atmosphere / "mutant.yaml";
      case Role::Response:
      case Role::Light:
      case Role::Sun:
      case Role::Camera:
        return libraries_.sensors / "mutant.yaml";
      case Role::Scenario:
        break;
    }
    return folder_ / "case.yaml";
  }

  /// What is wrong with how the text was taken; empty where nothing is.
  std::string read(const std::string& text, const fs::path& base) {
    try {
      readScenarioText(text, "case.yaml", base, {}, libraries_);
      ++report_.accepted;
    } catch (const UserError& error) {
      ++report_.refused;
      if (std::getenv("PITVIPER_FUZZ_VERBOSE") != nullptr) std::fprintf(stderr, "%s\n", error.what());
      if (!wellFormed(error.what())) return std::string("a message without place or fix: ") + error.what();
    } catch (const std::exception& error) {
      return std::string("not a UserError: ") + error.what();
    }
    return "";
  }

  void note(std::uint64_t seed, double seconds, std::string wrong, const fs::path& input) {
    if (seconds > report_.slowest_s) report_.slowest_s = seconds, report_.slowestSeed = seed;
    const long before = report_.peakMemory_kB;
    report_.peakMemory_kB = peakMemory_kB();
    if (before <= kMostMemory_kB && report_.peakMemory_kB > kMostMemory_kB) wrong += " more than 1 GB of memory";
    if (wrong.empty()) return;
    ++report_.failed;
    const fs::path kept = folder_ / ("failed_" + std::to_string(seed) + ".yaml");
    fs::copy_file(input, kept, fs::copy_options::overwrite_existing);
    std::fprintf(stderr, "fuzz_scenario: seed %llu: %s: %s\n", static_cast<unsigned long long>(seed), kept.c_str(), wrong.c_str());
  }

  const std::vector<fs::path>& files_;
  fs::path folder_;
  Libraries libraries_;
  std::vector<std::string> corpus_;
  std::vector<Role> roles_;
  FuzzReport report_;
};

}  // namespace

std::vector<fs::path> shippedFiles(const fs::path& root) {
  std::vector<fs::path> files;
  for (const char* folder : {"scenarios", "materials/library", "materials/substances", "atmosphere/library", "sensors/library"})
    for (const auto& entry : fs::directory_iterator(root / folder))
      if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  // Scenarios exercise most of the reader: each stands in the list four times.
  const std::size_t count = files.size();
  for (std::size_t i = 0; i < count; ++i)
    if (roleOf(files[i]) == Role::Scenario) files.insert(files.end(), 3, fs::path(files[i]));
  std::sort(files.begin(), files.end());
  return files;
}

FuzzReport readShipped(const std::vector<fs::path>& files, const fs::path& root, const fs::path& folder) {
  fs::create_directories(folder);
  Run run(files, root, folder);
  // Each once, however often it stands in the list.
  for (std::size_t i = 0; i < files.size(); ++i)
    if (i == 0 || files[i] != files[i - 1]) run.undamaged(i);
  return run.report();
}

FuzzReport fuzzScenarios(std::uint64_t seed, int iterations, const std::vector<fs::path>& files, const fs::path& root, const fs::path& folder) {
  fs::create_directories(folder);
  Run run(files, root, folder);
  const auto before = std::signal(SIGPROF, tellHang);
  for (int i = 0; i < iterations; ++i) run.one(seed + static_cast<std::uint64_t>(i));
  std::signal(SIGPROF, before);
  return run.report();
}

}  // namespace pitviper
