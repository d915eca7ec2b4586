#include "atmosphere/tape7_layout.hpp"

#include <algorithm>

#include "atmosphere/tape7_rows.hpp"

namespace pitviper::tape7 {
namespace {

struct Word {
  int first, last;
  std::string text;
};

std::vector<Word> wordsOf(std::string_view text) {
  std::vector<Word> words;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == ' ') continue;
    if (i == 0 || text[i - 1] == ' ') words.push_back({static_cast<int>(i) + 1, 0, ""});
    words.back().text += text[i];
    words.back().last = static_cast<int>(i) + 1;
  }
  return words;
}

[[noreturn]] void refuse(const Line& line, int column, const std::string& wrong, const std::string& expected) {
  throw UserError(line.at(column), wrong, expected, "give MODTRAN's own tape7 of this run, in wavenumbers");
}

void checkFirst(const Line& line, const std::vector<Word>& words) {
  const std::string& first = words.front().text;
  if (first == "FREQ") return;
  if (first.rfind("WAVLEN", 0) == 0)
    refuse(line, words.front().first, "a table over wavelength (" + inQuotes(first) + "), with other units than a tape7", "FREQ, wavenumbers in cm-1");
  refuse(line, words.front().first, inQuotes(first) + " heads the first column, as in a tape7.scn", "FREQ, wavenumbers in cm-1");
}

/// Two lines of names, the lower one at the right edge of each column.
Layout transmittanceLayout(const std::vector<Line>& lines, size_t at) {
  const Line& names = lines[at];
  if (at + 1 >= lines.size()) refuse(names, 1, "the file ends within the names of the columns", "two lines of names, rows and -9999.");
  const Line& lower = lines[at + 1];
  const auto words = wordsOf(lower.text);
  if (words.size() < 2 || words[0].text != "CM-1")
    refuse(lower, 1, "the second line of column names is missing: IEMSCT is 0 (transmittance) here", "CM-1 TRANS TRANS ... below FREQ COMBIN H2O ...");
  Layout layout;
  layout.nameLines = 2;
  int end = 0;
  for (const Word& w : words) {
    Field field{end + 1, w.last, std::string(trim(names.cut(end + 1, w.last))), Tape7Quantity::Transmittance};
    end = w.last;
    if (field.name.empty()) refuse(names, field.first, "no name above " + inQuotes(w.text), "a name above each");
    if (!layout.fields.empty()) field.name += "_" + w.text;
    if (field.name.rfind("-LOG", 0) == 0) field.quantity = Tape7Quantity::OpticalDepth;
    std::replace(field.name.begin(), field.name.end(), ' ', '_');
    layout.fields.push_back(field);
  }
  // Names one column left of their numbers, and five wide, are of the programs before MODTRAN 4: their columns are not known here.
  if (layout.fields[0].last != 8 || layout.fields[1].name != "COMBIN_TRANS")
    refuse(names, layout.fields[1].first,
           "the columns of a transmittance run are not MODTRAN 4's or later (the second is " + inQuotes(layout.fields[1].name) + ")",
           "FREQ to column 8, then COMBIN");
  return layout;
}

/// One line of names at the right edge of each column; before MODTRAN 4 without underscores, and the wavenumber's one column short.
Layout radianceLayout(const Line& names) {
  std::string text(names.text);
  for (const char* two : {"TOT TRANS", "PTH THRML", "THRML SCT", "SURF EMIS", "SOL SCAT", "SING SCAT", "GRND RFLT", "DRCT RFLT", "TOTAL RAD", "REF SOL"})
    if (const size_t i = text.find(two); i != std::string::npos) text[text.find(' ', i)] = '_';
  const auto words = wordsOf(text);
  constexpr int kTransmittanceWidth = 11;
  if (words.size() < 2 || words[1].text != "TOT_TRANS" || words[1].last <= kTransmittanceWidth + 4)
    refuse(names, words.size() < 2 ? 1 : words[1].first,
           "no TOT_TRANS behind FREQ: these are not the columns of a radiance run (IEMSCT 1 or 2, as card 1 says)", "FREQ TOT_TRANS PTH_THRML ...");
  Layout layout;
  int end = words[1].last - kTransmittanceWidth;
  layout.fields.push_back({1, end, "FREQ", Tape7Quantity::Unknown});
  for (size_t i = 1; i < words.size(); ++i) {
    layout.fields.push_back({end + 1, words[i].last, words[i].text, radianceQuantity(words[i].text)});
    end = words[i].last;
  }
  return layout;
}

/// One line of names that do not stand over their numbers: the columns are MODTRAN 4's, or one to the left as before it.
Layout irradianceLayout(const Line& names, const std::vector<Word>& words) {
  using Q = Tape7Quantity;
  if (words.size() != 5 || words[1].text != "TRANS" || words[2].text != "SOL" || words[3].text != "TR" || words[4].text != "SOLAR" ||
      (words[0].last != 8 && words[0].last != 6))
    refuse(names, 1, "not the columns of a solar irradiance run (IEMSCT 3, as card 1 says)", "FREQ TRANS SOL TR SOLAR");
  const int shift = words[0].last == 8 ? 0 : -1;
  Layout layout;
  layout.fields = {{1, 8 + shift, "FREQ", Q::Unknown},
                   {9 + shift, 16 + shift, "TRANS", Q::Transmittance},
                   {17 + shift, 25 + shift, "SOL_TR", Q::Irradiance},
                   {26 + shift, 34 + shift, "SOLAR", Q::Irradiance}};
  if (shift == 0) layout.fields.push_back({95, 105, "DEPTH", Q::OpticalDepth});
  return layout;
}

}  // namespace

bool isNames(const Line& line) {
  const std::string_view text = line.trimmed();
  return text.rfind("FREQ", 0) == 0 || text.rfind("WAVLEN", 0) == 0;
}

Layout layoutOf(Tape7Kind kind, const std::vector<Line>& lines, size_t at) {
  const auto words = wordsOf(lines[at].text);
  for (const Word& w : words)
    if (w.text == "LOS")
      throw UserError(lines[at].at(w.first), "a column LOS: several lines of sight in one run, as MODTRAN 5.3 and later write them, are not read",
                      "one line of sight to a run", kOneLineOfSight);
  checkFirst(lines[at], words);
  if (kind == Tape7Kind::Transmittance) return transmittanceLayout(lines, at);
  if (kind == Tape7Kind::SolarIrradiance) return irradianceLayout(lines[at], words);
  return radianceLayout(lines[at]);
}

}  // namespace pitviper::tape7
