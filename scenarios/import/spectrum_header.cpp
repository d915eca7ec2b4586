#include "scenarios/import/spectrum_header.hpp"

#include <algorithm>
#include <cctype>
#include <set>

#include "scenarios/import/header_words.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

using Words = std::vector<std::string>;

const std::set<std::string> kAxisKeys = {"xunits",     "xunit",       "xaxis",    "xaxisunit",       "xaxisunits",     "xaxislabel",
                                         "xlabel",     "xtitle",      "abscissa", "wavelengthunits", "wavelengthunit", "unitsofwavelength",
                                         "wavelength", "wavelengths", "column1",  "xaxismode"};
const std::set<std::string> kValueKeys = {"yunits", "yunit",  "yaxis",    "yaxisunit", "yaxisunits", "yaxislabel",
                                          "ylabel", "ytitle", "ordinate", "column2",   "yaxismode"};
/// What they say is of the sample.
const std::set<std::string> kSampleKeys = {
    "name",  "title",  "samplename",     "description",           "class",   "subclass", "genus",   "species",  "type",   "particlesize", "sample", "sampleno",
    "owner", "origin", "collectiondate", "additionalinformation", "comment", "comments", "remarks", "material", "author", "reference",    "date"};

struct Line {
  std::string text, key, value;  ///< a key of letters alone, before ':' or '='
  Words words;
  int number = 0;
};

std::string trimmed(std::string_view text, const char* also = "") {
  const auto drop = [&](char c) { return c == ' ' || c == '\t' || std::string_view(also).find(c) != std::string_view::npos; };
  while (!text.empty() && drop(text.front())) text.remove_prefix(1);
  while (!text.empty() && drop(text.back())) text.remove_suffix(1);
  return std::string(text);
}

Line lineOf(const std::string& text, int number) {
  Line line{trimmed(text, "#!"), "", "", headerWords(text), number};
  if (const std::size_t mark = line.text.find_first_of(":="); mark != std::string::npos) {
    for (char c : line.text.substr(0, mark))
      if (std::isalnum(static_cast<unsigned char>(c))) line.key += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    line.value = trimmed(std::string_view(line.text).substr(mark + 1));
  }
  return line;
}

bool has(const Words& words, Meaning meaning) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& w) { return meaningOf(w) == meaning; });
}
bool has(const Words& words, std::initializer_list<const char*> any) {
  return std::any_of(any.begin(), any.end(), [&](const char* w) { return std::find(words.begin(), words.end(), w) != words.end(); });
}

/// "R", "%T", "E": a letter that stands for a quantity where nothing else is said of a column.
Words lettersSpelled(Words words) {
  const bool short_ = !words.empty() && std::all_of(words.begin(), words.end(), [](const std::string& w) {
    return w.size() == 1 || meaningOf(w) == Meaning::Percent || meaningOf(w) == Meaning::Share;
  });
  for (std::string& w : words)
    if (short_) w = w == "r" ? "reflectance" : w == "t" ? "transmittance" : w == "e" ? "emissivity" : w == "a" ? "absorbance" : w;
  return words;
}

/// What lines say, the stronger kind first.
template <class T>
struct Claims {
  std::vector<Said<T>> strong, weak;
};

class Reader {
 public:
  Reader(const std::vector<std::string>& head, std::size_t columns, CellStyle style, const ImportChoices& choices, const std::string& file)
      : columns_(columns), style_(style), choices_(choices), file_(file), ofColumn_(columns), lineOfColumn_(columns, 0) {
    for (std::size_t i = 0; i < head.size(); ++i)
      if (!trimmed(head[i]).empty()) lines_.push_back(lineOf(head[i], static_cast<int>(i) + 1));
  }

  SpectrumHeader read() {
    findColumns();
    for (const Line& line : lines_) readLine(line);
    chooseColumns();
    const Words& x = ofColumn_[header_.x];
    sayAxis(x, lineOfColumn_[header_.x], true, true);
    if (header_.y) sayValues(lettersSpelled(ofColumn_[*header_.y]), lineOfColumn_[*header_.y], true);
    findInstrument();
    if (!choices_.axis) settleAxis();
    if (!choices_.quantity) settleQuantity();
    if (!choices_.scale) header_.scale = settled(scale_, "per cent and shares", "'--unit %' or '--unit 1'");
    return header_;
  }

 private:
  [[noreturn]] void refuse(int line, const std::string& wrong, const std::string& expected, const std::string& fix) const {
    throw UserError({file_, std::max(line, 1), 1, -1}, wrong, expected, fix);
  }

  bool isKey(const Line& line) const {
    return kAxisKeys.count(line.key) || kValueKeys.count(line.key) || kSampleKeys.count(line.key) || line.key == "measurement";
  }

  /// The last lines above the numbers, where they have a cell for each column: names, units, or both.
  void findColumns() {
    constexpr std::size_t kMost = 3;
    for (std::size_t k = lines_.size() - std::min(lines_.size(), kMost); k < lines_.size(); ++k) {
      Line& line = lines_[k];
      if (isKey(line)) continue;
      std::vector<Words> cells;
      for (std::string_view cell : columnsOf(line.text)) cells.push_back(headerWords(cell));
      const auto tells = [](const Words& w) { return has(w, Meaning::AxisName) || has(w, Meaning::Unit); };
      const bool axis = std::any_of(cells.begin(), cells.end(), tells);
      const bool units = std::all_of(cells.begin(), cells.end(), [](const Words& w) {
        const Words spelled = lettersSpelled(w);
        return std::all_of(spelled.begin(), spelled.end(), [](const std::string& word) { return meaningOf(word) != Meaning::None; });
      });
      if (cells.size() == columns_ && columns_ > 1 && (axis || units)) {
        for (std::size_t c = 0; c < columns_; ++c) {
          ofColumn_[c].insert(ofColumn_[c].end(), cells[c].begin(), cells[c].end());
          lineOfColumn_[c] = line.number;
        }
        line.words.clear();
      } else if (axis || (k + 1 == lines_.size() && tells(line.words))) {
        refuseCommas(line);
        // Names that are no cells of their own tell of axis and values together.
        sayAxis(line.words, line.number, true, false);
        sayValues(line.words, line.number, true);
        deviation_ = deviation_ || has(line.words, Meaning::Deviation);
        line.words.clear();
      }
    }
  }

  /// 3,6,0,5 below the names of two columns.
  void refuseCommas(const Line& line) const {
    const auto half = [&](CellStyle style) { return 2 * cellsOf(line.text, style).size() == columns_; };
    if (style_ == CellStyle::Commas && columns_ > 2 && (half(CellStyle::Commas) || half(CellStyle::Semicolons)))
      refuse(line.number, "half as many names as the rows have cells: commas are both decimal points and what parts the cells",
             "cells parted by ';' or blanks, or numbers with points", "export it with points, or with semicolons");
  }

  std::vector<std::string> columnsOf(const std::string& text) const {
    std::vector<std::string> cells;
    if (style_ == CellStyle::Commas || style_ == CellStyle::Semicolons || style_ == CellStyle::SemicolonsDecimalComma) {
      for (std::string_view c : cellsOf(text, style_)) cells.emplace_back(c);
      if (cells.size() == columns_ + 1 && cells.back().empty()) cells.pop_back();
      return cells;
    }
    // Names may hold single blanks.
    for (std::string_view rest = text; !rest.empty();) {
      const std::size_t end = std::min({rest.find('\t'), rest.find("  "), rest.size()});
      if (end > 0) cells.push_back(trimmed(rest.substr(0, end)));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    std::erase(cells, "");
    if (cells.size() != columns_)
      if (const auto words = cellsOf(text, CellStyle::Blanks); words.size() == columns_) cells.assign(words.begin(), words.end());
    return cells;
  }

  void readLine(const Line& line) {
    if (header_.title.empty() && (line.key == "name" || line.key == "title" || line.key == "samplename")) header_.title = line.value;
    if (header_.title.empty() && line.text.rfind("splib", 0) == 0)
      header_.title = line.value.substr(line.value.find(':') == std::string::npos ? 0 : line.value.find(':') + 1);
    const Words value = headerWords(line.value);
    if (kAxisKeys.count(line.key)) return sayAxis(line.words, line.number, true, true);
    if (kValueKeys.count(line.key)) return sayValues(lettersSpelled(value), line.number, true);
    if (line.key == "units" || line.key == "unit") return sayAxis(value, line.number, true, false), sayValues(value, line.number, true);
    if (line.key == "measurement") return sayValues(value, line.number, false);
    if (kSampleKeys.count(line.key)) return;
    deviation_ = deviation_ || (has(line.words, Meaning::AxisName) && has(line.words, Meaning::Deviation));
    const Words spelled = lettersSpelled(line.words);
    const bool lone = !spelled.empty() && std::all_of(spelled.begin(), spelled.end(), [](const std::string& w) { return meaningOf(w) != Meaning::None; });
    if (lone && (spelled.size() > 1 || meaningOf(spelled[0]) == Meaning::Unit))
      return sayAxis(spelled, line.number, true, false), sayValues(spelled, line.number, true);
    if (has(line.words, Meaning::AxisName) || has(line.words, {"wavenumber", "unit", "units"})) sayAxis(line.words, line.number, false, false);
    sayValues(line.words, line.number, false);
  }

  /// `only`: the words are of the axis alone, so that a unit that is not known is the axis's.
  void sayAxis(const Words& words, int line, bool strong, bool only) {
    header_.wavelengths = header_.wavelengths || (strong && has(words, {"wavelength"}));
    auto& claims = strong ? axis_.strong : axis_.weak;
    bool known = false;
    for (const std::string& w : words)
      if (const auto axis = axisOf(w)) claims.push_back({*axis, line}), known = true;
    const bool other = has(words, {"frequency", "energy"}) || (only && has(words, Meaning::Unit));
    if (strong && !known && other && !choices_.axis)
      refuse(line, "an axis that is neither wavelength in um, nm or angstrom, nor wavenumber in 1/cm, nor energy in eV", "one of these",
             "convert it; or say what it is by '--axis um', nm, angstrom, 1/cm or eV");
  }

  void sayValues(const Words& words, int line, bool strong) {
    auto& quantities = strong ? quantity_.strong : quantity_.weak;
    auto& scales = strong ? scale_.strong : scale_.weak;
    for (std::size_t i = 0; i < words.size(); ++i) {
      const Meaning m = meaningOf(words[i]);
      if (m == Meaning::Reflectance) quantities.push_back({SpectrumQuantity::Reflectance, line});
      if (m == Meaning::Transmittance) quantities.push_back({SpectrumQuantity::Transmittance, line});
      if (m == Meaning::Emissivity) quantities.push_back({SpectrumQuantity::Emissivity, line});
      if (m == Meaning::NoSurface) (strong ? otherStrong_ : otherWeak_) = line;
      // "20 % of moisture" is none of the values.
      const bool ofNumber = i > 0 && std::all_of(words[i - 1].begin(), words[i - 1].end(), [](unsigned char c) { return std::isdigit(c); });
      const bool ofValues = strong || has(words, Meaning::Reflectance) || has(words, Meaning::Transmittance) || has(words, Meaning::Emissivity);
      if (m == Meaning::Percent && ofValues && !ofNumber) scales.push_back({0.01, line});
      if (m == Meaning::Share && ofValues) scales.push_back({1.0, line});
    }
  }

  template <class T>
  std::optional<Said<T>> settled(const Claims<T>& claims, const std::string& both, const std::string& option) const {
    for (const auto* kind : {&claims.strong, &claims.weak}) {
      for (std::size_t k = 1; k < kind->size(); ++k)
        if ((*kind)[k].value != kind->front().value)
          refuse((*kind)[k].line, "the words above the numbers speak of " + both + " (line " + std::to_string(kind->front().line) + " and here)", "one of them",
                 "say which by " + option);
      if (!kind->empty()) return kind->front();
    }
    return std::nullopt;
  }

  void settleAxis() {
    if (const auto said = settled(axis_, "several units of wavelength or wavenumber", "'--axis um', nm, angstrom, 1/cm or eV")) header_.axis = said;
    else if (instrument_) header_.axis = instrument_, header_.axisOfInstrument = true;
  }

  void settleQuantity() {
    const std::string option = "'--quantity reflectance', transmittance or emissivity";
    if (otherStrong_ > 0)
      refuse(otherStrong_, "the values are none of a surface's (absorbance, radiance, counts, attenuated total reflection ...)",
             "a reflectance, a transmittance or an emissivity", "convert the values; or, if they are one of these, say which by " + option);
    header_.quantity = settled(quantity_, "several quantities", option);
    for (const auto& other : quantity_.weak)
      if (header_.quantity && isMeasurement(other.line) && other.value != header_.quantity->value)
        refuse(other.line, "the measurement is of another quantity than line " + std::to_string(header_.quantity->line) + " says", "the same",
               "say which by " + option);
    if (!header_.quantity && otherWeak_ > 0)
      refuse(otherWeak_, "the values are none of a surface's, as this line has it", "a reflectance, a transmittance or an emissivity",
             "convert the values; or, if they are one of these, say which by " + option);
  }

  bool isMeasurement(int number) const {
    return std::any_of(lines_.begin(), lines_.end(), [&](const Line& l) { return l.number == number && l.key == "measurement"; });
  }

  void chooseColumns() {
    for (std::size_t c = 0; c < columns_; ++c)
      if (has(ofColumn_[c], Meaning::AxisName) || has(ofColumn_[c], Meaning::Unit)) {
        header_.x = c;
        break;
      }
    if (choices_.column) {
      header_.y = static_cast<std::size_t>(*choices_.column) - 1;
      if (header_.y == header_.x) header_.x = header_.x == 0 ? 1 : 0;
      return;
    }
    std::vector<std::size_t> rest, named;
    for (std::size_t c = 0; c < columns_; ++c) {
      const Words words = lettersSpelled(ofColumn_[c]);
      if (c == header_.x || has(words, Meaning::Deviation)) continue;
      rest.push_back(c);
      if (has(words, Meaning::Reflectance) || has(words, Meaning::Transmittance) || has(words, Meaning::Emissivity)) named.push_back(c);
    }
    if (named.size() == 1) header_.y = named[0];
    else if (rest.size() == 1) header_.y = rest[0];
    else if (rest.size() == 2 && deviation_) header_.y = rest[0];
  }

  /// The units that instruments and libraries write without saying so.
  void findInstrument() {
    int nanometres = 0, wavenumbers = 0, library = 0;
    for (const Line& line : lines_) {
      const Words words = headerWords(line.text);
      if (has(words, {"asd", "fieldspec", "viewspec", "labspec", "terraspec", "svc", "avantes", "avasoft", "oceanview", "spectrasuite"}) ||
          line.text.find("Ocean Optics") != std::string::npos)
        nanometres = nanometres ? nanometres : line.number;
      if (has(words, {"ftir", "opus", "bruker", "nicolet", "omnic", "fourier"}) || line.text.find("FT-IR") != std::string::npos)
        wavenumbers = wavenumbers ? wavenumbers : line.number;
      const std::string first = words.empty() ? "" : words[0];
      if (first.rfind("splib", 0) == 0 || first == "usgs") library = library ? library : line.number;
    }
    header_.sharesByCustom = library > 0;
    if (library > 0) instrument_ = Said<SpectralAxis>{SpectralAxis::Micrometre, library};
    else if (nanometres > 0 && wavenumbers == 0) instrument_ = Said<SpectralAxis>{SpectralAxis::Nanometre, nanometres};
    else if (wavenumbers > 0 && nanometres == 0 && !header_.wavelengths) instrument_ = Said<SpectralAxis>{SpectralAxis::PerCentimetre, wavenumbers};
  }

  std::size_t columns_;
  CellStyle style_;
  const ImportChoices& choices_;
  const std::string& file_;
  std::vector<Line> lines_;
  std::vector<Words> ofColumn_;
  std::vector<int> lineOfColumn_;
  Claims<SpectralAxis> axis_;
  Claims<SpectrumQuantity> quantity_;
  Claims<double> scale_;
  std::optional<Said<SpectralAxis>> instrument_;
  int otherStrong_ = 0, otherWeak_ = 0;
  bool deviation_ = false;
  SpectrumHeader header_;
};

}  // namespace

SpectrumHeader readSpectrumHeader(const std::vector<std::string>& head, std::size_t columns, CellStyle style, const ImportChoices& choices,
                                  const std::string& file) {
  return Reader(head, columns, style, choices, file).read();
}

}  // namespace pitviper
