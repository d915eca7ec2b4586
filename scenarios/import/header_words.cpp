#include "scenarios/import/header_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace pitviper {
namespace {

/// Spellings, the longest first, in small letters of ASCII or as they are in UTF-8.
constexpr std::array<std::array<const char*, 2>, 53> kSpellings = {{
    {"cm^{-1}", " percm "},
    {"cm^(-1)", " percm "},
    {"cm**-1", " percm "},
    {"cm^-1", " percm "},
    {"cm{-1}", " percm "},
    {"cm(-1)", " percm "},
    {"cm\xE2\x81\xBB\xC2\xB9", " percm "},
    {"cm\xE2\x88\x92"
     "1",
     " percm "},
    {"cm-1", " percm "},
    {"cm -1", " percm "},
    {"1/cm", " percm "},
    {"inverse centimet", " percm "},
    {"reciprocal centimet", " percm "},
    {"per centimet", " percm "},
    {"inverse cm", " percm "},
    {"per cm", " percm "},
    {"um^-1", " unknownunit "},
    {"um-1", " unknownunit "},
    {"nm^-1", " unknownunit "},
    {"nm-1", " unknownunit "},
    {"1/um", " unknownunit "},
    {"1/nm", " unknownunit "},
    {"\xC2\xB5", "u"},
    {"\xCE\xBC", "u"},
    {"\xC3\x85", "angstrom"},
    {"\xC3\xA5", "angstrom"},
    {"\xE2\x84\xAB", "angstrom"},
    {"\xCE\xBB", " lambda "},
    {"\xCE\xBD", " wavenumber "},
    {"\xC3\xA4", "ae"},
    {"\xC3\xA9", "e"},
    {"per cent", " percent "},
    {"%", " percent "},
    {"*100", " percent "},
    {"x100", " percent "},
    {"x 100", " percent "},
    {"0 to 100", " percent "},
    {"0..100", " percent "},
    {"0 - 100", " percent "},
    {"0-100", " percent "},
    {"0 to 1", " share "},
    {"0..1", " share "},
    {"0 - 1", " share "},
    {"0-1", " share "},
    {"[1]", " share "},
    {"(1)", " share "},
    {"wave number", " wavenumber "},
    {"wave length", " wavelength "},
    {"nombre d'onde", " wavenumber "},
    {"longueur d'onde", " wavelength "},
    {"photon energy", " energy "},
    {"standard deviation", " deviation "},
    {"std dev", " deviation "},
}};

bool isOneOf(const std::string& word, std::initializer_list<const char*> all) {
  return std::any_of(all.begin(), all.end(), [&](const char* w) { return word == w; });
}
bool beginsWith(const std::string& word, std::initializer_list<const char*> all) {
  return std::any_of(all.begin(), all.end(), [&](const char* w) { return word.rfind(w, 0) == 0; });
}

/// A number before or after would make another of it: "0-1" of "10-12".
bool stands(const std::string& text, std::size_t at, std::size_t length) {
  const auto part = [&](std::size_t i) { return std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.'; };
  return !(at > 0 && part(at - 1) && part(at)) && !(at + length < text.size() && part(at + length) && part(at + length - 1));
}

}  // namespace

std::vector<std::string> headerWords(std::string_view line) {
  std::string text(line);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  for (const auto& [from, to] : kSpellings)
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos;) {
      const std::size_t length = std::char_traits<char>::length(from);
      if (!stands(text, at, length)) {
        ++at;
        continue;
      }
      text.replace(at, length, to);
      at += std::char_traits<char>::length(to);
    }
  std::vector<std::string> words;
  std::string word;
  for (char c : text + " ") {
    if (std::isalnum(static_cast<unsigned char>(c))) word += c;
    else if (!word.empty()) words.push_back(std::exchange(word, ""));
  }
  for (std::string& w : words) {
    if (isOneOf(w, {"micron", "microns", "mum"}) || beginsWith(w, {"micromet"})) w = "um";
    if (beginsWith(w, {"nanomet"})) w = "nm";
    if (beginsWith(w, {"wavenumber", "wellenzahl"})) w = "wavenumber";
    if (beginsWith(w, {"wavelength", "wellenl"}) || isOneOf(w, {"wave", "waves", "wvl", "lambda"})) w = "wavelength";
    if (beginsWith(w, {"percent", "prozent", "pourcent"}) || isOneOf(w, {"pct", "perc"})) w = "percent";
  }
  return words;
}

std::optional<SpectralAxis> axisOf(const std::string& word) {
  if (word == "um") return SpectralAxis::Micrometre;
  if (word == "nm") return SpectralAxis::Nanometre;
  if (word == "percm" || word == "wavenumber" || word == "kayser") return SpectralAxis::PerCentimetre;
  if (word.rfind("angstr", 0) == 0) return SpectralAxis::Angstrom;
  if (word == "ev" || word.rfind("electronvolt", 0) == 0) return SpectralAxis::ElectronVolt;
  return std::nullopt;
}

Meaning meaningOf(const std::string& w) {
  if (isOneOf(w, {"unknownunit", "thz", "ghz", "hz", "mm", "cm", "m", "kev", "mev"})) return Meaning::Unit;
  if (w == "wavelength" || w == "frequency" || w == "energy") return Meaning::AxisName;
  if (axisOf(w)) return Meaning::Unit;
  if (w == "percent") return Meaning::Percent;
  if (isOneOf(w, {"share", "fraction", "fractional", "decimal", "unitless", "dimensionless", "ratio"})) return Meaning::Share;
  if (isOneOf(w, {"deviation", "stdev", "stddev", "std", "error", "uncertainty", "sigma"})) return Meaning::Deviation;
  if (beginsWith(w, {"transfl", "transref", "atr", "attenuat"}) && !beginsWith(w, {"attribut"})) return Meaning::NoSurface;
  if (beginsWith(w, {"reflect", "refl", "reflex"}) || isOneOf(w, {"rfl", "aref", "rref", "brf", "hcrf", "hdrf", "bhr", "dhr", "albedo"}))
    return Meaning::Reflectance;
  if (beginsWith(w, {"transmi"}) || isOneOf(w, {"trans", "tran", "rtgc"})) return Meaning::Transmittance;
  if (beginsWith(w, {"emissiv", "emissionsgrad", "emittan", "absorptanc", "absorptiv"}) || w == "emis") return Meaning::Emissivity;
  if (beginsWith(w, {"absorb", "absorption", "extinction", "kubelka", "radianc", "irradianc", "count", "raman", "intensit", "interferogram"}) ||
      isOneOf(w, {"dn", "log", "abs", "raw", "beam"}))
    return Meaning::NoSurface;
  return Meaning::None;
}

}  // namespace pitviper
