#include "sim/parameters/units.hpp"

#include <charconv>
#include <cmath>
#include <map>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

enum Base { W, M, S, K, RAD, SR, V, COUNT, LM };

Unit base(std::initializer_list<std::pair<Base, int>> dims, double factor = 1.0) {
  Unit u;
  for (auto [b, e] : dims) u.dims[static_cast<size_t>(b)] += e;
  u.factor = factor;
  return u;
}

const std::map<std::string, Unit, std::less<>>& namedUnits() {
  static const std::map<std::string, Unit, std::less<>> units = [] {
    std::map<std::string, Unit, std::less<>> m;
    m["W"] = base({{W, 1}});
    m["kW"] = base({{W, 1}}, 1e3);
    m["MW"] = base({{W, 1}}, 1e6);
    m["mW"] = base({{W, 1}}, 1e-3);
    m["uW"] = base({{W, 1}}, 1e-6);
    m["J"] = base({{W, 1}, {S, 1}});
    m["m"] = base({{M, 1}});
    m["km"] = base({{M, 1}}, 1e3);
    m["cm"] = base({{M, 1}}, 1e-2);
    m["mm"] = base({{M, 1}}, 1e-3);
    m["um"] = base({{M, 1}}, 1e-6);
    m["nm"] = base({{M, 1}}, 1e-9);
    m["ft"] = base({{M, 1}}, 0.3048);
    m["nmi"] = base({{M, 1}}, 1852.0);
    m["s"] = base({{S, 1}});
    m["ms"] = base({{S, 1}}, 1e-3);
    m["us"] = base({{S, 1}}, 1e-6);
    m["min"] = base({{S, 1}}, 60.0);
    m["h"] = base({{S, 1}}, 3600.0);
    m["Hz"] = base({{S, -1}});
    m["kHz"] = base({{S, -1}}, 1e3);
    m["kn"] = base({{M, 1}, {S, -1}}, 1852.0 / 3600.0);
    // Kilogram and newton from watt, metre and second.
    m["kg"] = base({{W, 1}, {S, 3}, {M, -2}});
    m["g"] = base({{W, 1}, {S, 3}, {M, -2}}, 1e-3);
    m["N"] = base({{W, 1}, {S, 1}, {M, -1}});
    m["kN"] = base({{W, 1}, {S, 1}, {M, -1}}, 1e3);
    m["Pa"] = base({{W, 1}, {S, 1}, {M, -3}});
    m["hPa"] = base({{W, 1}, {S, 1}, {M, -3}}, 1e2);
    m["kPa"] = base({{W, 1}, {S, 1}, {M, -3}}, 1e3);
    m["atm"] = base({{W, 1}, {S, 1}, {M, -3}}, 101325.0);
    m["K"] = base({{K, 1}});
    m["mK"] = base({{K, 1}}, 1e-3);
    m["degC"] = base({{K, 1}});
    m["degC"].offset = 273.15;
    m["degF"] = base({{K, 1}}, 5.0 / 9.0);
    m["degF"].offset = 459.67;
    m["rad"] = base({{RAD, 1}});
    m["mrad"] = base({{RAD, 1}}, 1e-3);
    m["urad"] = base({{RAD, 1}}, 1e-6);
    m["deg"] = base({{RAD, 1}}, kPi / 180.0);
    m["sr"] = base({{SR, 1}});
    m["V"] = base({{V, 1}});
    m["mV"] = base({{V, 1}}, 1e-3);
    m["uV"] = base({{V, 1}}, 1e-6);
    m["count"] = base({{COUNT, 1}});
    m["ppm"] = base({}, 1e-6);
    m["photon"] = base({{COUNT, 1}});
    m["electron"] = base({{COUNT, 1}});
    m["lm"] = base({{LM, 1}});
    m["cd"] = base({{LM, 1}, {SR, -1}});
    m["lx"] = base({{LM, 1}, {M, -2}});
    m["%"] = base({}, 0.01);
    for (const char* name : {"\xC2\xB0"
                             "C",
                             "deg C", "celsius", "Celsius"})
      m[name] = m["degC"];
    for (const char* name : {"\xC2\xB0", "degree", "degrees"}) m[name] = m["deg"];
    for (const char* name : {"\xC2\xB5m", "\xCE\xBCm", "micron", "microns"}) m[name] = m["um"];
    m["1"] = base({});
    return m;
  }();
  return units;
}

void multiply(Unit& into, const Unit& u, int exponent) {
  for (size_t i = 0; i < into.dims.size(); ++i) into.dims[i] += u.dims[i] * exponent;
  into.factor *= std::pow(u.factor, exponent);
}

/// Recursive descent over: expression := factor { ('*' | '.' | ' ' | '/') factor }.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(text) {}

  std::optional<Unit> parse() {
    Unit unit;
    if (!expression(unit, 0)) return std::nullopt;
    skip();
    if (at_ != text_.size()) return std::nullopt;
    return unit;
  }

 private:
  void skip() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }

  bool expression(Unit& into, int depth) {
    if (depth > 8) return false;
    int sign = 1;
    bool first = true;
    while (true) {
      skip();
      if (at_ >= text_.size() || text_[at_] == ')') return !first;
      const char c = text_[at_];
      if (c == '/') {
        sign = -1;
        ++at_;
        first = false;
        skip();
      } else if ((c == '*' || c == '.') && !first) {
        sign = 1;
        ++at_;
        skip();
      } else if (!first) {
        sign = 1;
      }
      if (!factor(into, sign, depth)) return false;
      first = false;
    }
  }

  bool factor(Unit& into, int sign, int depth) {
    if (at_ >= text_.size()) return false;
    Unit u;
    if (text_[at_] == '(') {
      ++at_;
      if (!expression(u, depth + 1)) return false;
      skip();
      if (at_ >= text_.size() || text_[at_] != ')') return false;
      ++at_;
    } else {
      const size_t start = at_;
      while (at_ < text_.size() && (std::isalpha(static_cast<unsigned char>(text_[at_])) || text_[at_] == '%')) ++at_;
      if (at_ == start && text_[at_] == '1') ++at_;
      const auto found = namedUnits().find(text_.substr(start, at_ - start));
      if (found == namedUnits().end()) return false;
      u = found->second;
      u.offset = 0.0;
    }
    if (at_ < text_.size() && text_[at_] == '^') ++at_;
    int exponent = 1;
    if (at_ < text_.size() && (std::isdigit(static_cast<unsigned char>(text_[at_])) || text_[at_] == '-')) {
      const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), exponent);
      if (error != std::errc() || std::abs(exponent) > 9) return false;
      at_ = static_cast<size_t>(end - text_.data());
    }
    multiply(into, u, sign * exponent);
    return true;
  }

  std::string_view text_;
  size_t at_ = 0;
};

std::string_view trim(std::string_view t) {
  while (!t.empty() && (t.front() == ' ' || t.front() == '\t')) t.remove_prefix(1);
  while (!t.empty() && (t.back() == ' ' || t.back() == '\t')) t.remove_suffix(1);
  return t;
}

}  // namespace

std::optional<Unit> parseUnit(std::string_view text) {
  text = trim(text);
  if (text.empty() || text == "1" || text == "-") return Unit{};
  if (const auto lone = namedUnits().find(text); lone != namedUnits().end()) return lone->second;
  return UnitParser(text).parse();
}

std::optional<WrittenQuantity> splitQuantity(std::string_view text) {
  text = trim(text);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  const std::string_view rest = trim(text.substr(static_cast<size_t>(end - text.data())));
  return WrittenQuantity{value, std::string(rest)};
}

std::optional<double> convert(const WrittenQuantity& quantity, std::string_view canonical) {
  const auto from = parseUnit(quantity.unit);
  const auto to = parseUnit(canonical);
  if (!from || !to || from->dims != to->dims) return std::nullopt;
  if (from->factor == to->factor && from->offset == to->offset) return quantity.value;  // to the last bit: 1000 um are no more than 1000 um
  const double base = (quantity.value + from->offset) * from->factor;
  return base / to->factor - to->offset;
}

std::string unitExample(std::string_view canonical) {
  static const std::map<std::string, std::string, std::less<>> examples = {{"", "a plain number such as 0.92"},
                                                                           {"1", "a plain number such as 0.92"},
                                                                           {"m", "a length such as '120 m' or '2.5 km'"},
                                                                           {"um", "a wavelength such as '3.5 um'"},
                                                                           {"K", "a temperature such as '300 K' or '27 degC'"},
                                                                           {"rad", "an angle such as '12 deg' or '3 mrad'"},
                                                                           {"s", "a time such as '2 ms'"},
                                                                           {"1/m", "an extinction such as '0.2 /km'"},
                                                                           {"Hz", "a rate such as '60 Hz'"},
                                                                           {"sr", "a solid angle such as '6.79e-5 sr'"},
                                                                           {"m/s", "a speed such as '240 m/s'"},
                                                                           {"W/m2", "an irradiance such as '1361 W/m2'"}};
  const auto found = examples.find(canonical);
  if (found != examples.end()) return found->second;
  return "a quantity in " + std::string(canonical);
}

}  // namespace pitviper
