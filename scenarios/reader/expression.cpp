#include "scenarios/reader/expression.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/table.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

/// Of a hand-written formula; keeps the parser's recursion short.
constexpr int kDeepest = 64;
/// As the parser of units takes them.
constexpr int kLargestExponent = 9;

using Dimensions = decltype(Unit::dims);

/// A number in its unit. `absolute`: a temperature that counted from another zero, of which two cannot be added.
struct Amount {
  double value = 0.0;
  std::string unit;
  Unit scale;  ///< of the unit, without offset
  bool absolute = false;

  bool plain() const { return scale.dims == Dimensions{}; }
  double inBase() const { return value * scale.factor; }
  std::string text() const { return numberText(value) + (unit.empty() ? "" : " " + unit); }
};

std::string baseUnit(const Dimensions& dims) {
  static const char* const names[] = {"W", "m", "s", "K", "rad", "sr", "V", "count", "lm"};
  std::string text;
  for (size_t i = 0; i < dims.size(); ++i)
    if (dims[i] != 0) text += (text.empty() ? "" : " ") + std::string(names[i]) + (dims[i] == 1 ? "" : std::to_string(dims[i]));
  return text;
}

Amount plainAmount(double value) {
  Amount a;
  a.value = value;
  return a;
}

bool isLetter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }
/// Names of units: m, %, and signs beyond ASCII such as those of degree and micro.
bool isUnitLetter(char c) { return isLetter(c) || c == '%' || static_cast<unsigned char>(c) >= 0x80; }

class Parser {
 public:
  Parser(std::string_view text, const Location& where, const NumberNamed& named) : text_(text), where_(where), named_(named) {}

  Amount whole() {
    const Amount a = sum(0);
    skip();
    if (at_ < text_.size()) unexpected("an operator or the end");
    return a;
  }

 private:
  [[noreturn]] void fail(const std::string& wrong, const std::string& expected, const std::string& fix) const { throw UserError(where_, wrong, expected, fix); }
  [[noreturn]] void unexpected(const std::string& expected) const {
    if (at_ >= text_.size()) fail("the expression ends too early", expected, "complete it");
    const std::string rest = readable(text_.substr(at_, 20));
    fail("the expression holds '" + rest + "' where it cannot be", expected,
         isLetter(text_[at_]) ? "write units right behind numbers ('3 m', '$n * 1 m'), parameters with a dollar ('$speed')" : "correct it");
  }
  void skip() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n')) ++at_;
  }
  bool take(char c) {
    skip();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  Amount sum(int depth) {
    if (depth > kDeepest) fail("an expression nested deeper than " + std::to_string(kDeepest) + " levels", "a simpler one", "use parameters for its parts");
    Amount a = product(depth);
    while (true) {
      if (take('+')) a = added(a, product(depth), 1.0);
      else if (take('-')) a = added(a, product(depth), -1.0);
      else return a;
    }
  }
  Amount product(int depth) {
    Amount a = signedPart(depth);
    while (true) {
      if (take('*')) a = multiplied(a, signedPart(depth), 1);
      else if (take('/')) a = multiplied(a, signedPart(depth), -1);
      else return a;
    }
  }
  Amount signedPart(int depth) {
    double sign = 1.0;
    while (true) {
      if (take('-')) sign = -sign;
      else if (!take('+')) break;
    }
    Amount a = part(depth);
    a.value *= sign;
    return a;
  }
  Amount part(int depth) {
    skip();
    if (at_ >= text_.size()) unexpected("a number, a parameter or a function");
    const char c = text_[at_];
    if (c == '(') {
      ++at_;
      const Amount a = sum(depth + 1);
      if (!take(')')) unexpected("')'");
      return a;
    }
    if (isDigit(c) || c == '.') return number();
    if (c == '$') return parameter();
    const size_t length = nameLength(text_.substr(at_));
    if (length == 0) unexpected("a number, a parameter or a function");
    const std::string name(text_.substr(at_, length));
    if (name == "pi") {
      at_ += length;
      return plainAmount(kPi);
    }
    return function(name, depth);
  }

  Amount number() {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
    if (error != std::errc()) unexpected("a finite number");
    at_ = static_cast<size_t>(end - text_.data());
    const size_t last = endOfUnit();
    const std::string unit(text_.substr(at_, last - at_));
    at_ = last;
    return amountOf({value, unit});
  }
  Amount parameter() {
    ++at_;
    const bool braces = at_ < text_.size() && text_[at_] == '{';
    if (braces) ++at_;
    const size_t length = nameLength(text_.substr(at_));
    if (length == 0) unexpected("the name of a parameter behind the dollar");
    const std::string_view name = text_.substr(at_, length);
    at_ += length;
    if (braces && (at_ >= text_.size() || text_[at_++] != '}')) fail("a '${' that is not closed", "'${name}'", "close it");
    return amountOf(named_(name));
  }
  Amount amountOf(const WrittenQuantity& q) const {
    size_t first = q.unit.find_first_not_of(' ');
    const std::string unit = first == std::string::npos ? "" : q.unit.substr(first);
    const auto parsed = parseUnit(unit);
    if (!parsed) fail("there is no unit '" + readable(unit.substr(0, 40)) + "'", "a unit such as m, km/h, W/(m2 sr um)", "correct the unit");
    Amount a;
    a.scale = *parsed;
    a.value = q.value;
    a.unit = unit == "1" || unit == "-" ? "" : unit;
    if (parsed->offset != 0.0) {
      a.value = (q.value + parsed->offset) * parsed->factor;
      a.unit = "K";
      a.scale.factor = 1.0;
      a.scale.offset = 0.0;
      a.absolute = true;
    }
    return a;
  }

  /// The end of the longest unit at the front: names with exponents, joined by '/', '*', '.' or blanks. What an operator joins to something else than a unit
  /// is not of it: in '3 m * 2' the unit is m.
  size_t endOfUnit() const {
    const auto past = [&](size_t p) {
      while (p < text_.size() && text_[p] == ' ') ++p;
      return p;
    };
    size_t end = at_;
    for (bool first = true;; first = false) {
      size_t p = past(end);
      if (p >= text_.size()) return end;
      const char joint = text_[p];
      const bool joined = joint == '/' || (!first && (joint == '*' || joint == '.'));
      if (joined) p = past(p + 1);
      if (p >= text_.size()) return end;
      if (text_[p] == '(') {
        const size_t close = text_.find(')', p);
        if (!joined || close == std::string_view::npos) return end;
        const std::string_view inside = text_.substr(p + 1, close - p - 1);
        if (inside.empty() || !isLetter(inside[0]) || !parseUnit(inside)) return end;
        p = close + 1;
      } else {
        const size_t start = p;
        while (p < text_.size() && isUnitLetter(text_[p])) ++p;
        if (p == start || !parseUnit(text_.substr(start, p - start))) return end;
        if (p < text_.size() && text_[p] == '(') return end;  // min(...): the function, not minutes
      }
      size_t q = p;
      const bool power = q < text_.size() && text_[q] == '^';
      if (power) ++q;
      if (power && q < text_.size() && text_[q] == '-') ++q;
      const size_t digits = q;
      while (q < text_.size() && isDigit(text_[q])) ++q;
      end = q > digits ? q : p;
    }
  }

  Amount function(const std::string& name, int depth) {
    static const std::vector<std::string> names = {"min", "max", "abs", "floor", "mod", "sqrt", "sin", "cos", "tan"};
    if (std::find(names.begin(), names.end(), name) == names.end())
      throw UserError(where_, "the expression holds the word '" + name.substr(0, 60) + "'",
                      "a function (" + listed(names) + "), 'pi', or '$" + name.substr(0, 60) + "' for a parameter",
                      didYouMean(name, names, "write '$" + name.substr(0, 60) + "' if a parameter is meant"));
    at_ += name.size();
    if (!take('(')) unexpected("'(' behind " + name);
    std::vector<Amount> a{sum(depth + 1)};
    while (take(',')) a.push_back(sum(depth + 1));
    if (!take(')')) unexpected("',' or ')'");
    const bool any = name == "min" || name == "max";
    const size_t wanted = name == "mod" ? 2 : 1;
    if (!any && a.size() != wanted)
      fail(name + " of " + std::to_string(a.size()) + " values", wanted == 2 ? "mod(value, divisor)" : name + "(value)", "correct it");
    if (any) {
      for (const Amount& other : a) {
        sameDimensions(a[0], other, "compared");
        if (name == "min" ? other.inBase() < a[0].inBase() : other.inBase() > a[0].inBase()) a[0] = other;
      }
      return a[0];
    }
    if (name == "abs") {
      a[0].value = std::abs(a[0].value);
      return a[0];
    }
    if (name == "floor") {
      if (!a[0].plain()) fail("floor of '" + a[0].text() + "'", "a plain number", "divide by the step first: floor($x / 1 m) * 1 m");
      return plainAmount(std::floor(a[0].inBase()));
    }
    if (name == "mod") {
      sameDimensions(a[0], a[1], "divided with a rest");
      const double divisor = a[1].inBase() / a[0].scale.factor;
      if (divisor == 0.0) fail("mod of '" + a[0].text() + "' by 0", "another divisor", "correct it");
      a[0].value = checked(a[0].value - divisor * std::floor(a[0].value / divisor));
      return a[0];
    }
    if (name == "sqrt") return root(a[0]);
    static const Unit radian = *parseUnit("rad");
    if (a[0].scale.dims != radian.dims)
      fail(name + " of '" + a[0].text() + "'", "an angle such as '30 deg' or '0.5 rad'", a[0].plain() ? "multiply by '1 rad' or '1 deg'" : "correct it");
    const double x = a[0].inBase();
    return plainAmount(checked(name == "sin" ? std::sin(x) : name == "cos" ? std::cos(x) : std::tan(x)));
  }
  Amount root(const Amount& of) const {
    if (of.value < 0.0) fail("the square root of '" + of.text() + "'", "0 or more", "correct it");
    Amount a;
    for (size_t i = 0; i < a.scale.dims.size(); ++i) {
      if (of.scale.dims[i] % 2 != 0) fail("the square root of '" + of.text() + "'", "a unit that is a square, such as m2", "correct it");
      a.scale.dims[i] = of.scale.dims[i] / 2;
    }
    a.value = checked(std::sqrt(of.inBase()));
    a.unit = baseUnit(a.scale.dims);
    return a;
  }

  void sameDimensions(const Amount& a, const Amount& b, const char* what) const {
    if (a.scale.dims != b.scale.dims)
      fail("'" + a.text() + "' and '" + b.text() + "' cannot be " + what, "two values of one kind, as lengths or times", "correct the units");
  }
  Amount added(Amount a, const Amount& b, double sign) const {
    sameDimensions(a, b, sign > 0.0 ? "added" : "subtracted");
    if (a.absolute && b.absolute && sign > 0.0)
      fail("two temperatures in degC or degF are added", "a temperature and a difference in K", "write the difference in K: '27 degC + 5 K'");
    a.value = checked(a.value + sign * (a.unit == b.unit ? b.value : b.inBase() / a.scale.factor));
    a.absolute = a.absolute != b.absolute;
    return a;
  }
  Amount multiplied(const Amount& a, const Amount& b, int power) const {
    if (power < 0 && b.value == 0.0) fail("'" + a.text() + "' is divided by 0", "another divisor", "correct it");
    const auto by = [&](double x, double y) { return checked(power > 0 ? x * y : x / y); };
    Amount result;
    if (b.plain() && !a.plain()) {
      result = a;
      result.value = by(a.value, b.inBase());
    } else if (a.plain() && !b.plain() && power > 0) {
      result = b;
      result.value = by(a.inBase(), b.value);
    } else if (a.unit == b.unit && power < 0) {
      result = plainAmount(by(a.value, b.value));
    } else {
      for (size_t i = 0; i < result.scale.dims.size(); ++i) {
        result.scale.dims[i] = a.scale.dims[i] + power * b.scale.dims[i];
        if (std::abs(result.scale.dims[i]) > kLargestExponent)
          fail("'" + a.text() + "' and '" + b.text() + "' give a unit to the power of " + std::to_string(result.scale.dims[i]), "at most 9", "correct it");
      }
      result.value = by(a.inBase(), b.inBase());
      result.unit = baseUnit(result.scale.dims);
    }
    result.absolute = false;
    return result;
  }
  double checked(double v) const {
    if (!std::isfinite(v)) fail("the expression is not finite", "numbers that a double holds", "correct it");
    return v;
  }

  std::string_view text_;
  const Location& where_;
  const NumberNamed& named_;
  size_t at_ = 0;
};

}  // namespace

std::string numberText(double v) {
  // Whole numbers up to here are exact in a double.
  if (v == std::floor(v) && std::abs(v) < 9007199254740992.0) return std::to_string(static_cast<long long>(v));
  char buffer[40];
  return {buffer, std::to_chars(buffer, buffer + sizeof buffer, v).ptr};
}

std::size_t nameLength(std::string_view text) {
  std::size_t n = 0;
  while (n < text.size() && (isLetter(text[n]) || text[n] == '_' || (n > 0 && isDigit(text[n])))) ++n;
  return n;
}

std::string evaluate(std::string_view text, const Location& where, const NumberNamed& named) { return Parser(text, where, named).whole().text(); }

}  // namespace pitviper
