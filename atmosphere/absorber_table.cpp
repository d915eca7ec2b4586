#include "atmosphere/absorber_table.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <sstream>

#include "sim/model/atmosphere.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

// Extinction of the haze at 0.55 um [1/km] at a meteorological visibility.
double hazeExtinction_per_km(double visibility_km) { return 3.912 / visibility_km - 0.0116; }

// Dense fog to the clearest air; below 0.5 km haze grows to droplets of other spectra than the table's.
constexpr double kLeastVisibility_km = 0.5, kMostVisibility_km = 300.0;

struct Word {
  std::string_view text;
  int column;
};

std::vector<Word> wordsOf(std::string_view line) {
  std::vector<Word> words;
  for (size_t at = 0; at < line.size();) {
    if (line[at] == '#') break;
    if (line[at] == ' ' || line[at] == '\t' || line[at] == '\r') {
      ++at;
      continue;
    }
    size_t end = at;
    while (end < line.size() && line[end] != ' ' && line[end] != '\t' && line[end] != '\r' && line[end] != '#') ++end;
    words.push_back({line.substr(at, end - at), static_cast<int>(at) + 1});
    at = end;
  }
  return words;
}

// Longer than any honest file: bounds the memory a broken one can take.
constexpr size_t kMostRows = 100000;
constexpr size_t kLongestLine = 4096;
constexpr std::uintmax_t kLargestFile = 64u << 20;

}  // namespace

// One line after the other; each kind of line knows what must have come before.
class AbsorberTableReader {
 public:
  explicit AbsorberTableReader(std::string name) : name_(std::move(name)) {}

  AbsorberTable read(std::istream& in) {
    std::string line;
    while (std::getline(in, line)) {
      ++line_;
      if (line.size() > kLongestLine) fail(1, "a line of more than 4096 characters");
      words_ = wordsOf(line);
      if (!words_.empty()) readLine(line);
    }
    ++line_;
    if (in.bad()) fail(1, "the file cannot be read to its end");
    if (!begun_) fail(1, "the file is empty", "a first line 'pitviper-air 1'");
    if (table_.absorbers_.empty()) fail(1, "no amounts", "lines 'amount <name> <exponent> <kind>'");
    if (table_.levels_.size() < 2) fail(1, "fewer than two levels");
    if (table_.bins_.size() < 2) fail(1, "fewer than two bins");
    finishLevels();
    table_.scale_.fill(1.0);
    return std::move(table_);
  }

 private:
  [[noreturn]] void fail(int column, const std::string& wrong, const std::string& expected = "") const {
    throw UserError(Location{name_, line_, column}, wrong, expected.empty() ? "an air table" : expected,
                    "correct the line; the format is at the head of atmosphere/library/us76_rural.air");
  }

  double number(size_t word, double low, double high, const std::string& what) const {
    const auto [text, column] = words_[word];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = end == text.data() + text.size() && std::isfinite(value);
    // What no double can hold, 1e999 or 1e-999, is refused as well.
    if (!whole || error != std::errc() || value < low || value > high)
      fail(column, what + " is '" + std::string(text) + "'", print("a number from %g to %g", low, high));
    return value;
  }

  void expectWords(size_t count) const {
    if (words_.size() == count) return;
    fail(words_.size() > count ? words_[count].column : words_.back().column,
         "'" + std::string(words_[0].text) + "' with " + std::to_string(words_.size() - 1) + " values", std::to_string(count - 1));
  }

  void readLine(const std::string& line) {
    const std::string_view key = words_[0].text;
    if (!begun_) {
      if (key != "pitviper-air" || words_.size() != 2 || words_[1].text != "1") fail(words_[0].column, "not an air table", "'pitviper-air 1'");
      begun_ = true;
    } else if (key == "title" || key == "source") {
      if (words_.size() < 2) fail(words_[0].column, "'" + std::string(key) + "' without words");
      std::string& text = key == "title" ? table_.title_ : table_.source_;
      const auto from = static_cast<size_t>(words_[1].column - 1);
      const Word& last = words_.back();
      text += (text.empty() ? "" : " ") + line.substr(from, static_cast<size_t>(last.column - 1) + last.text.size() - from);
    } else if (key == "visibility_km") {
      expectWords(2);
      table_.visibility_km_ = number(1, kLeastVisibility_km, kMostVisibility_km, "visibility [km]");
    } else if (key == "amount") {
      readAmount();
    } else if (key == "level") {
      readLevel();
    } else if (key == "bin") {
      readBin();
    } else {
      fail(words_[0].column, "unknown word '" + std::string(key) + "'", "title, source, visibility_km, amount, level or bin");
    }
  }

  void readAmount() {
    if (!table_.levels_.empty() || !table_.bins_.empty()) fail(words_[0].column, "an amount after levels or bins");
    expectWords(4);
    if (table_.absorbers_.size() == kMostAbsorbers) fail(words_[0].column, "more than " + std::to_string(kMostAbsorbers) + " amounts");
    Absorber absorber{std::string(words_[1].text), number(2, 0.1, 1.0, "exponent"), AbsorberKind::Gas};
    for (const Absorber& other : table_.absorbers_)
      if (other.name == absorber.name) fail(words_[1].column, "amount '" + absorber.name + "' twice");
    static constexpr std::array<std::pair<std::string_view, AbsorberKind>, 4> kinds = {
        {{"gas", AbsorberKind::Gas}, {"scattering", AbsorberKind::Scattering}, {"aerosol", AbsorberKind::Aerosol}, {"haze", AbsorberKind::Haze}}};
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == words_[3].text; });
    if (kind == kinds.end()) fail(words_[3].column, "kind '" + std::string(words_[3].text) + "'", "gas, scattering, aerosol or haze");
    absorber.kind = kind->second;
    table_.absorbers_.push_back(std::move(absorber));
  }

  void readLevel() {
    if (!table_.bins_.empty()) fail(words_[0].column, "a level after bins");
    if (table_.absorbers_.empty()) fail(words_[0].column, "a level before the amounts");
    if (table_.levels_.size() == kMostRows) fail(words_[0].column, "too many levels");
    expectWords(3 + table_.absorbers_.size());
    AbsorberTable::Level level;
    level.altitude_m = number(1, -1000.0, 200000.0, "altitude [m]");
    if (!table_.levels_.empty() && level.altitude_m < table_.levels_.back().altitude_m + 1.0)
      fail(words_[1].column, "altitude '" + std::string(words_[1].text) + "' [m] is not above the one before", "at least 1 m more");
    level.temperature_K = number(2, 50.0, 1000.0, "temperature [K]");
    for (size_t k = 0; k < table_.absorbers_.size(); ++k) level.density[k] = number(3 + k, 0.0, 1e6, "density of " + table_.absorbers_[k].name);
    table_.levels_.push_back(level);
  }

  void readBin() {
    if (table_.levels_.size() < 2) fail(words_[0].column, "a bin before two levels");
    if (table_.bins_.size() == kMostRows) fail(words_[0].column, "too many bins");
    expectWords(3 + table_.absorbers_.size());
    AbsorberTable::Bin bin;
    bin.wavenumber_per_cm = number(1, 1e4 / kLongestWavelength_um, 1e4 / kShortestWavelength_um, "wavenumber [1/cm]");
    if (!table_.bins_.empty() && bin.wavenumber_per_cm <= table_.bins_.back().wavenumber_per_cm)
      fail(words_[1].column, "wavenumber '" + std::string(words_[1].text) + "' is not above the one before");
    bin.albedo = number(2, 0.0, 1.0, "albedo");
    for (size_t k = 0; k < table_.absorbers_.size(); ++k) bin.coefficient[k] = number(3 + k, 0.0, 1e6, "coefficient of " + table_.absorbers_[k].name);
    table_.bins_.push_back(bin);
  }

  void finishLevels() {
    table_.steepest_.assign(table_.levels_.size(), 0.0);
    for (size_t i = 0; i + 1 < table_.levels_.size(); ++i)
      for (size_t k = 0; k < table_.absorbers_.size(); ++k) {
        const double here = table_.levels_[i].density[k], next = table_.levels_[i + 1].density[k];
        const double log = here > 0.0 && next > 0.0 ? std::log(next / here) : std::numeric_limits<double>::quiet_NaN();
        table_.levels_[i].logRatio[k] = log;
        table_.steepest_[i] = std::fmax(table_.steepest_[i], std::abs(log));
      }
  }

  std::string name_;
  int line_ = 0;
  bool begun_ = false;
  std::vector<Word> words_;
  AbsorberTable table_;
};

AbsorberTable AbsorberTable::read(std::istream& in, const std::string& name) { return AbsorberTableReader(name).read(in); }

AbsorberTable AbsorberTable::read(const std::filesystem::path& file) {
  std::istringstream in(readWholeFile(file, {.what = "an air table", .mostBytes = kLargestFile, .fix = "check its name and rights"}));
  return read(in, file.string());
}

void AbsorberTable::setVisibility(double visibility_km) {
  for (size_t k = 0; k < absorbers_.size(); ++k) {
    if (absorbers_[k].kind == AbsorberKind::Haze)
      scale_[k] = hazeExtinction_per_km(std::clamp(visibility_km, kLeastVisibility_km, kMostVisibility_km)) / hazeExtinction_per_km(visibility_km_);
    if (absorbers_[k].kind == AbsorberKind::Aerosol) scale_[k] = 1.0;
  }
}

void AbsorberTable::setTemperature(double temperature_K) {
  for (Level& level : levels_) level.temperature_K = temperature_K;
}

void AbsorberTable::removeAerosol() {
  for (size_t k = 0; k < absorbers_.size(); ++k)
    if (absorbers_[k].kind == AbsorberKind::Haze || absorbers_[k].kind == AbsorberKind::Aerosol) scale_[k] = 0.0;
}

void AbsorberTable::restoreAerosol() {
  for (size_t k = 0; k < absorbers_.size(); ++k)
    if ((absorbers_[k].kind == AbsorberKind::Haze || absorbers_[k].kind == AbsorberKind::Aerosol) && scale_[k] == 0.0) scale_[k] = 1.0;
}

std::vector<double> AbsorberTable::levels_m() const {
  std::vector<double> heights;
  for (const Level& level : levels_) heights.push_back(level.altitude_m);
  return heights;
}

std::vector<double> AbsorberTable::knots_um() const {
  std::vector<double> knots;
  for (auto b = bins_.rbegin(); b != bins_.rend(); ++b) knots.push_back(1e4 / b->wavenumber_per_cm);
  return knots;
}

std::pair<size_t, double> AbsorberTable::binAt(double wavelength_um) const {
  const double nu = 1e4 / wavelength_um;
  // The ends are given to the caller as wavelengths: what comes back may have lost its last digit.
  const double low = bins_.front().wavenumber_per_cm, high = bins_.back().wavenumber_per_cm;
  if (!(nu >= low * (1.0 - 1e-12) && nu <= high * (1.0 + 1e-12)))
    throw OutsideSpectrum("the air table has no data at " + std::to_string(wavelength_um) + " um");
  const auto above = std::upper_bound(bins_.begin() + 1, bins_.end() - 1, nu, [](double n, const Bin& b) { return n < b.wavenumber_per_cm; });
  const auto i = static_cast<size_t>(above - bins_.begin()) - 1;
  const double f = (nu - bins_[i].wavenumber_per_cm) / (bins_[i + 1].wavenumber_per_cm - bins_[i].wavenumber_per_cm);
  return {i, std::clamp(f, 0.0, 1.0)};
}

std::array<double, kMostAbsorbers> AbsorberTable::coefficients(double wavelength_um) const {
  const auto [i, f] = binAt(wavelength_um);
  std::array<double, kMostAbsorbers> c{};
  for (size_t k = 0; k < absorbers_.size(); ++k) c[k] = bins_[i].coefficient[k] * (1.0 - f) + bins_[i + 1].coefficient[k] * f;
  return c;
}

void AbsorberTable::addTo(Fingerprint& f) const {
  f.add(visibility_km_).all(levels_).all(bins_);
  for (double s : scale_) f.add(s);
  for (const Absorber& a : absorbers_) f.add(a.exponent).add(static_cast<int>(a.kind));
}

double AbsorberTable::hazeAlbedo(double wavelength_um) const {
  const auto [i, f] = binAt(wavelength_um);
  return bins_[i].albedo * (1.0 - f) + bins_[i + 1].albedo * f;
}

double AbsorberTable::depthOf(const std::array<double, kMostAbsorbers>& c, const AbsorberAmounts& amounts) const {
  double depth = 0.0;
  for (size_t k = 0; k < absorbers_.size(); ++k) {
    const double w = amounts.amount_km[k];
    if (c[k] > 0.0 && w > 0.0) depth += c[k] * (absorbers_[k].exponent == 1.0 ? w : std::pow(w, absorbers_[k].exponent));
  }
  return depth;
}

double AbsorberTable::opticalDepth(double wavelength_um, const AbsorberAmounts& amounts) const { return depthOf(coefficients(wavelength_um), amounts); }

double AbsorberTable::transmittance(double wavelength_um, const AbsorberAmounts& amounts) const { return std::exp(-opticalDepth(wavelength_um, amounts)); }

double AbsorberTable::pathRadiance(double wavelength_um, std::span<const PathStation> stations) const {
  const auto c = coefficients(wavelength_um);
  std::vector<double> depth, source, radiance(stations.size());
  for (const PathStation& s : stations) {
    depth.push_back(depthOf(c, s.amounts));
    source.push_back(physics::planckRadiance(wavelength_um, s.temperature_K));
  }
  AirLight{depth}.emitted(source, radiance);
  return radiance.empty() ? 0.0 : radiance.back();
}

double AbsorberTable::pathRadiance(double wavelength_um, double height_m, double sinElevation, double range_m, double earthRadius_m) const {
  return pathRadiance(wavelength_um, stations(height_m, sinElevation, range_m, earthRadius_m));
}

}  // namespace pitviper
