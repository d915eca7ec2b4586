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

// Densest fog to the clearest air.
constexpr double kLeastVisibility_km = 0.02, kMostVisibility_km = 300.0;
/// Below this height aerosol stands on the ground.
constexpr double kSqueezed_m = 6000.0;
/// Over which a layer of particles begins and ends.
constexpr double kLayerEdge_m = 1.0;
/// Levels nearer to each other than this are one.
constexpr double kSameLevel_m = 0.1;

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
    table_.finishLevels();
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
    } else if (key == "reference") {
      readReference();
    } else if (key == "carbon_dioxide") {
      readCarbonDioxide();
    } else if (key == "level") {
      readLevel();
    } else if (key == "bin") {
      readBin();
    } else {
      fail(words_[0].column, "unknown word '" + std::string(key) + "'", "title, source, visibility_km, amount, reference, carbon_dioxide, level or bin");
    }
  }

  void readAmount() {
    if (!table_.levels_.empty() || !table_.bins_.empty()) fail(words_[0].column, "an amount after levels or bins");
    if (words_.size() < 5) expectWords(4);
    if (table_.absorbers_.size() == kMostAbsorbers) fail(words_[0].column, "more than " + std::to_string(kMostAbsorbers) + " amounts");
    Absorber absorber{std::string(words_[1].text), number(2, 0.1, 1.0, "exponent"), AbsorberKind::Gas};
    for (const Absorber& other : table_.absorbers_)
      if (other.name == absorber.name) fail(words_[1].column, "amount '" + absorber.name + "' twice");
    static constexpr std::array<std::pair<std::string_view, AbsorberKind>, 4> kinds = {
        {{"gas", AbsorberKind::Gas}, {"scattering", AbsorberKind::Scattering}, {"aerosol", AbsorberKind::Aerosol}, {"haze", AbsorberKind::Haze}}};
    const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const auto& k) { return k.first == words_[3].text; });
    if (kind == kinds.end()) fail(words_[3].column, "kind '" + std::string(words_[3].text) + "'", "gas, scattering, aerosol or haze");
    absorber.kind = kind->second;
    if (words_.size() > 4) {
      static constexpr std::array<std::pair<std::string_view, AbsorberLaw>, 6> laws = {{{"water", AbsorberLaw::Water},
                                                                                        {"ozone", AbsorberLaw::Ozone},
                                                                                        {"air", AbsorberLaw::Air},
                                                                                        {"self", AbsorberLaw::Self},
                                                                                        {"foreign", AbsorberLaw::Foreign},
                                                                                        {"pair", AbsorberLaw::Pair}}};
      const auto law = std::find_if(laws.begin(), laws.end(), [&](const auto& l) { return l.first == words_[4].text; });
      if (law == laws.end()) fail(words_[4].column, "law '" + std::string(words_[4].text) + "'", "water, ozone, air, self, foreign or pair");
      absorber.law = law->second;
      const bool hasPowers = law->second <= AbsorberLaw::Air;
      expectWords(hasPowers ? 7 : 5);
      if (hasPowers) absorber.byPressure = number(5, -5.0, 5.0, "power of the pressure"), absorber.byTemperature = number(6, -5.0, 5.0, "power of 1/T");
    }
    table_.absorbers_.push_back(std::move(absorber));
  }

  void readReference() {
    expectWords(6);
    table_.reference_ = AbsorberTable::Reference{100.0 * number(1, 1.0, 2000.0, "pressure [hPa]"), number(2, 100.0, 400.0, "temperature [K]"),
                                                 1e-6 * number(3, 1.0, 1e5, "water [ppmv]"), 1e-6 * number(4, 1e-4, 100.0, "ozone [ppmv]"),
                                                 1e-6 * number(5, 1.0, 1e5, "carbon dioxide [ppmv]")};
  }

  void readCarbonDioxide() {
    expectWords(4);
    const auto own = std::find_if(table_.absorbers_.begin(), table_.absorbers_.end(), [&](const Absorber& a) { return a.name == words_[1].text; });
    if (own == table_.absorbers_.end()) fail(words_[1].column, "no amount '" + std::string(words_[1].text) + "'", "the name of an amount above");
    const double low = number(2, 0.0, 1e5, "wavenumber [1/cm]"), high = number(3, low, 1e5, "wavenumber [1/cm]");
    table_.carbonDioxide_.push_back({static_cast<size_t>(own - table_.absorbers_.begin()), low, high});
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

void AbsorberTable::finishLevels() {
  steepest_.assign(levels_.size(), 0.0);
  for (Level& l : levels_) l.optical_m = l.altitude_m;
  for (size_t i = 0; i + 1 < levels_.size(); ++i)
    for (size_t k = 0; k < absorbers_.size(); ++k) {
      const double here = levels_[i].density[k], next = levels_[i + 1].density[k];
      const double log = here > 0.0 && next > 0.0 ? std::log(next / here) : std::numeric_limits<double>::quiet_NaN();
      levels_[i].logRatio[k] = log;
      steepest_[i] = std::fmax(steepest_[i], std::abs(log));
    }
}

std::array<double, kMostAbsorbers> AbsorberTable::tableDensities(double height_m) const {
  std::array<double, kMostAbsorbers> all{};
  if (height_m > top_m()) return all;
  const size_t i = intervalAt(height_m);
  AbsorberAmounts here;
  addDensities(i, partOf(i, height_m), 1.0, here);
  for (size_t k = 0; k < absorbers_.size(); ++k) all[k] = scale_[k] > 0.0 ? here.amount_km[k] / scale_[k] : 0.0;
  return all;
}

void AbsorberTable::relevel(std::vector<double> heights, const std::function<Level(double)>& levelAt) {
  std::sort(heights.begin(), heights.end());
  std::vector<Level> levels;
  for (double h : heights) {
    if (!levels.empty() && h < levels.back().altitude_m + kSameLevel_m) continue;
    levels.push_back(levelAt(h));
    levels.back().altitude_m = h;
  }
  levels_ = std::move(levels);
  finishLevels();
}

namespace {

/// Of an absorber's law, up to a factor: densities in mole fractions x pressure over temperature. Source: LOWTRAN's powers of pressure and temperature
/// (Pierluissi and Maragoudakis 1986, AFGL-TR-86-0272) and its continua of water and nitrogen (Kneizys et al. 1988, AFGL-TR-88-0177).
double lawOf(const Absorber& a, const AirLevel& l) {
  constexpr double kSelf = 4.4, kSelf_K = 296.0;
  const double air = l.pressure_Pa / l.temperature_K, water = l.water * air;
  const double powers = std::pow(l.pressure_Pa, a.byPressure) * std::pow(l.temperature_K, -a.byTemperature);
  switch (a.law) {
    case AbsorberLaw::Water:
      return water * powers;
    case AbsorberLaw::Ozone:
      return l.ozone * air * powers;
    case AbsorberLaw::Air:
      return air * powers;
    case AbsorberLaw::Self:
      return water * water * std::exp(kSelf * (kSelf_K / l.temperature_K - 1.0));
    case AbsorberLaw::Foreign:
      return water * (air - water);
    case AbsorberLaw::Pair:
      return air * air;
    case AbsorberLaw::None:
      break;
  }
  return 0.0;
}

}  // namespace

void AbsorberTable::setProfile(const AirProfile& profile, const Location& where) {
  const auto isGas = [](const Absorber& a) { return a.kind == AbsorberKind::Gas || a.kind == AbsorberKind::Scattering; };
  if (!reference_ || std::any_of(absorbers_.begin(), absorbers_.end(), [&](const Absorber& a) { return isGas(a) && a.law == AbsorberLaw::None; }))
    throw UserError(where, "an air table whose amounts do not say how they follow from pressure and temperature", "a table with laws and a reference",
                    "leave this key out, or take the table of a library air");
  std::vector<double> heights;
  for (const Level& l : levels_) heights.push_back(l.altitude_m);
  for (const AirLevel& l : profile.levels())
    if (l.altitude_m < top_m()) heights.push_back(l.altitude_m);
  const AirLevel usual{0.0, reference_->pressure_Pa, reference_->temperature_K, reference_->water, reference_->ozone};
  relevel(std::move(heights), [&](double h) {
    Level own;
    AirLevel air = profile.at(h);
    // Below the first and above the last row pressure goes on by its weight.
    air.pressure_Pa *= std::exp((profile.at(h).altitude_m - h) * 9.80665 / (287.05 * air.temperature_K));
    own.temperature_K = air.temperature_K;
    const auto here = tableDensities(h);
    for (size_t k = 0; k < absorbers_.size(); ++k) own.density[k] = isGas(absorbers_[k]) ? lawOf(absorbers_[k], air) / lawOf(absorbers_[k], usual) : here[k];
    return own;
  });
}

std::optional<double> AbsorberTable::referenceHumidity() const {
  if (!reference_) return std::nullopt;
  return reference_->water * reference_->pressure_Pa / AirProfile::saturation_Pa(reference_->temperature_K);
}

void AbsorberTable::setCarbonDioxide(double fraction, const Location& where) {
  if (!reference_ || carbonDioxide_.empty())
    throw UserError(where, "an air table that does not say what in it is carbon dioxide", "a table with 'carbon_dioxide'",
                    "leave this key out, or take the table of a library air");
  for (const Range& r : carbonDioxide_) {
    const double more = std::pow(fraction / reference_->carbonDioxide, absorbers_[r.absorber].exponent);
    for (Bin& b : bins_)
      if (b.wavenumber_per_cm >= r.low_per_cm && b.wavenumber_per_cm < r.high_per_cm) b.coefficient[r.absorber] *= more;
  }
  reference_->carbonDioxide = fraction;
}

void AbsorberTable::setHaze(const AerosolOptics& optics) {
  haze_ = optics;
  for (Bin& b : bins_) {
    const double own = hazeExtinction_per_km(visibility_km_) * optics.at(1e4 / b.wavenumber_per_cm).extinction;
    for (size_t k = 0; k < absorbers_.size(); ++k)
      if (absorbers_[k].kind == AbsorberKind::Haze) b.coefficient[k] = own;
  }
}

void AbsorberTable::setHazeTop(double height_m) {
  // What the table has of haze at a height comes to lie as much lower or higher as its top is.
  const double stretched = height_m / hazeTop_m_;
  std::vector<double> heights = levels_m();
  for (double h : levels_m())
    if (h > 0.0 && h <= 1.6 * hazeTop_m_ && h * stretched < top_m()) heights.push_back(h * stretched);
  relevel(std::move(heights), [&](double h) {
    Level own;
    own.temperature_K = this->temperature_K(h);
    own.density = tableDensities(h);
    const auto there = tableDensities(h / stretched);
    for (size_t k = 0; k < absorbers_.size(); ++k)
      if (absorbers_[k].kind == AbsorberKind::Haze) own.density[k] = there[k];
    return own;
  });
  hazeTop_m_ = height_m;
}

void AbsorberTable::setGround(double ground_m) {
  const double squeezed = (kSqueezed_m - ground_m) / kSqueezed_m;
  std::vector<double> heights{0.0};
  for (double h : levels_m()) {
    if (h > ground_m) heights.push_back(h - ground_m);
    if (h <= kSqueezed_m) heights.push_back(h * squeezed);
  }
  // A height in two intervals of the old table is in one of the new.
  std::erase_if(heights, [&](double h) { return h + ground_m > top_m(); });
  relevel(std::move(heights), [&](double h) {
    Level own;
    own.temperature_K = this->temperature_K(h + ground_m);
    own.density = tableDensities(h + ground_m);
    const auto aerosol = tableDensities(h < kSqueezed_m * squeezed ? h / squeezed : h + ground_m);
    for (size_t k = 0; k < absorbers_.size(); ++k)
      if (absorbers_[k].kind == AbsorberKind::Haze || absorbers_[k].kind == AbsorberKind::Aerosol) own.density[k] = aerosol[k];
    return own;
  });
  hazeTop_m_ *= squeezed;
}

void AbsorberTable::addLayer(const ParticleLayer& layer, const Location& where) {
  const auto same = std::find_if(layers_.begin(), layers_.end(), [&](const Layer& l) {
    return l.of.optics.extinction == layer.optics.extinction && l.of.optics.albedo == layer.optics.albedo && l.of.optics.asymmetry == layer.optics.asymmetry;
  });
  size_t own = same == layers_.end() ? absorbers_.size() : same->absorber;
  if (own == absorbers_.size()) {
    if (own == kMostAbsorbers)
      throw UserError(where, "more kinds of clouds and rain than the air can hold beside its " + std::to_string(own - layers_.size()) + " amounts",
                      "at most " + std::to_string(kMostAbsorbers - own + layers_.size()) + " of them that differ in kind or radius",
                      "give layers the same radius, or take one out");
    absorbers_.push_back({"layer " + std::to_string(own), 1.0, AbsorberKind::Layer});
    scale_[own] = 1.0;
    for (Bin& b : bins_) b.coefficient[own] = layer.optics.at(1e4 / b.wavenumber_per_cm).extinction;
  }
  layers_.push_back({own, layer});
  std::vector<double> heights;
  const double edges[] = {layer.low_m - 0.5 * kLayerEdge_m, layer.low_m + 0.5 * kLayerEdge_m, layer.high_m - 0.5 * kLayerEdge_m,
                          layer.high_m + 0.5 * kLayerEdge_m};
  // Its edges are levels themselves: what stands too near to one gives way.
  for (double h : levels_m())
    if (std::none_of(std::begin(edges), std::end(edges), [&](double e) { return std::abs(e - h) < kSameLevel_m; })) heights.push_back(h);
  for (double e : edges)
    if (e > heights.front()) heights.push_back(e);
  relevel(std::move(heights), [&](double h) {
    Level at;
    at.temperature_K = this->temperature_K(h);
    at.density = tableDensities(h);
    at.density[own] = 0.0;
    for (const Layer& l : layers_)
      if (l.absorber == own) {
        const double inside = std::min(h - l.of.low_m, l.of.high_m - h) / kLayerEdge_m + 0.5;
        at.density[own] += l.of.perKm * (inside > 0.999 ? 1.0 : inside < 0.001 ? 0.0 : inside);
      }
    return at;
  });
}

double AbsorberTable::validLow_um() const { return std::max(1e4 / bins_.back().wavenumber_per_cm, haze_ ? haze_->knownLow_um : 0.0); }

double AbsorberTable::validHigh_um() const { return std::min(1e4 / bins_.front().wavenumber_per_cm, haze_ ? haze_->knownHigh_um : INFINITY); }

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
  f.add(haze_.has_value());
  if (haze_) f.all(haze_->wavelength_um).all(haze_->extinction).all(haze_->albedo).all(haze_->asymmetry);
  for (const Absorber& a : absorbers_) f.add(a.exponent).add(static_cast<int>(a.kind));
  for (const Layer& l : layers_) {
    f.add(static_cast<int>(l.absorber)).add(l.of.low_m).add(l.of.high_m).add(l.of.perKm);
    f.all(l.of.optics.wavelength_um).all(l.of.optics.extinction).all(l.of.optics.albedo).all(l.of.optics.asymmetry);
  }
}

std::optional<double> AbsorberTable::hazeAsymmetry(double wavelength_um) const {
  return haze_ ? std::optional(haze_->at(wavelength_um).asymmetry) : std::nullopt;
}

double AbsorberTable::hazeAlbedo(double wavelength_um) const { return haze_ ? haze_->at(wavelength_um).albedo : aerosolAlbedo(wavelength_um); }

double AbsorberTable::aerosolAlbedo(double wavelength_um) const {
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
