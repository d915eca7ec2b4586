#include "scenarios/sweep/factor_reader.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/reader/expression.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/parameters/units.hpp"

namespace pitviper {
namespace {

/// Of a normal distribution, within its bounds: less would be a slip of the pen.
constexpr double kLeastShare = 1e-6;
constexpr std::size_t kMostFactorValues = 65536;

/// Numbers of one factor, told in the unit of the first.
class UnitOfFactor {
 public:
  explicit UnitOfFactor(std::string name) : name_(std::move(name)) {}

  double read(const Value& value) {
    const auto q = value.kind == Value::Kind::Scalar ? splitQuantity(value.text) : std::nullopt;
    if (!q)
      throw UserError(value.where, "a value of '" + name_ + "' is " + (value.kind == Value::Kind::Scalar ? tokenOf(value.text) : value.kindName()),
                      "a finite number with its unit", "write '5 km'");
    const std::string unit = q->unit == "1" || q->unit == "-" ? "" : q->unit;
    const auto parsed = parseUnit(unit);
    if (!parsed) throw UserError(value.where, "there is no unit " + tokenOf(unit), "a unit such as m, km/h, W/(m2 sr um)", "correct the unit");
    if (known_ && unit != unit_) {
      const auto same = convert(*q, unit_);
      // What counts from another zero is no difference: a sigma of 5 K is none of -268 degC.
      if (same && parsed->offset == 0.0 && !counted_) return *same;
      throw UserError(value.where, "'" + name_ + "' has the units " + shown(unit_) + " and " + shown(unit), "one unit within a factor",
                      same ? "write '" + numberText(*same) + (unit_.empty() ? "" : " " + unit_) + "'" : "correct the unit");
    }
    known_ = true, unit_ = unit, counted_ = parsed->offset != 0.0;
    return q->value;
  }
  const std::string& text() const { return unit_; }
  /// From another zero than the physical one: degC, degF.
  bool countedFromElsewhere() const { return counted_; }

 private:
  static std::string shown(const std::string& unit) { return unit.empty() ? "none" : "'" + unit + "'"; }
  std::string name_, unit_;
  bool known_ = false, counted_ = false;
};

struct FactorBounds {
  double low, high;
};

FactorBounds readFactorBounds(const Value& pair, const std::string& what, UnitOfFactor& unit) {
  const double low = unit.read(pair.items[0]), high = unit.read(pair.items[1]);
  if (low >= high)
    throw UserError(pair.where, what + " from " + pair.items[0].text + " to " + pair.items[1].text, "[low, high] with low < high",
                    low == high ? "write two different values" : "write [" + pair.items[1].text + ", " + pair.items[0].text + "]");
  return {low, high};
}

Distribution readLogUniform(const Value& pair, UnitOfFactor& unit) {
  const auto [low, high] = readFactorBounds(pair, "log_uniform", unit);
  if (low <= 0.0) throw UserError(pair.items[0].where, "log_uniform from " + pair.items[0].text, "a value above 0", "use 'uniform', or begin above 0");
  if (unit.countedFromElsewhere())
    throw UserError(pair.where, "log_uniform of values in " + unit.text(), "values that count from absolute zero", "write them in K");
  return Distribution::logUniform(low, high);
}

Distribution readNormal(const Record& factor, UnitOfFactor& unit) {
  const Record n(factor.value("normal"), normalTable());
  const double mean = unit.read(n.value("mean")), sigma = unit.read(n.value("sigma"));
  if (sigma <= 0.0)
    throw UserError(n.where("sigma"), "sigma is " + n.value("sigma").text, "a standard deviation above 0",
                    "write it without the minus, or give the scenario the mean itself");
  const Value* within = factor.find("within");
  if (!within) {
    const Distribution whole = Distribution::normal(mean, sigma);
    // The outermost shares that are drawn.
    if (!std::isfinite(whole.quantile(0x1p-53)) || !std::isfinite(whole.quantile(1.0 - 0x1p-53)))
      throw UserError(n.where("sigma"), "draws of this normal distribution are beyond what a number holds", "values within 1e308", "correct mean and sigma");
    return whole;
  }
  const auto [low, high] = readFactorBounds(*within, "within", unit);
  const double share = normalShare(mean, sigma, low, high);
  if (share < kLeastShare)
    throw UserError(within->where, print("within holds %.3g of the normal distribution", share), "bounds that hold at least 1e-6 of it",
                    "move the bounds to the mean, or use 'uniform'");
  return Distribution::normal(mean, sigma, low, high);
}

std::vector<double> readWeights(const Value& list, std::size_t count) {
  std::vector<double> weights;
  double sum = 0.0;
  for (const Value& item : list.items) {
    weights.push_back(readNumber(item, "", "a weight"));
    if (weights.back() < 0.0) throw UserError(item.where, "the weight " + item.text, "0 or more", "correct it");
    sum += weights.back();
  }
  if (weights.size() != count)
    throw UserError(list.where, std::to_string(weights.size()) + " weights of " + std::to_string(count) + " choices", "a weight for each",
                    weights.size() < count ? "add the missing ones" : "remove some");
  if (sum <= 0.0 || !std::isfinite(sum)) throw UserError(list.where, print("the weights' sum is %g", sum), "a finite sum above 0", "give one a weight of 1");
  return weights;
}

Distribution readChoice(const Record& factor, std::vector<std::string>& words) {
  std::vector<double> places;
  for (const Value& item : factor.value("choice").items) {
    const std::string word = readText(item, "a choice");
    if (std::find(words.begin(), words.end(), word) != words.end())
      throw UserError(item.where, "the choice '" + readable(word.substr(0, 60)) + "' is there twice", "different words",
                      "remove one; how often it is drawn is for 'weights'");
    words.push_back(word);
    places.push_back(static_cast<double>(places.size()));
  }
  const Value* weights = factor.find("weights");
  return Distribution::oneOf(places, weights ? readWeights(*weights, places.size()) : std::vector<double>{});
}

Distribution readFactorGrid(const Value& map, UnitOfFactor& unit) {
  const Record g(map, factorGridTable());
  const double from = unit.read(g.value("from")), to = unit.read(g.value("to"));
  if (from == to) throw UserError(g.where("to"), "the grid goes from " + g.value("from").text + " to itself", "two different values", "correct one of them");
  std::vector<double> values;
  const long long steps = g.integer("steps");
  for (long long i = 0; i < steps; ++i) values.push_back(std::lerp(from, to, static_cast<double>(i) / static_cast<double>(steps - 1)));
  return Distribution::oneOf(values);
}

Distribution readDistribution(const std::string& kind, const Record& factor, UnitOfFactor& unit, std::vector<std::string>& words) {
  const Value& value = factor.value(kind);
  if (kind == "uniform") {
    const auto [low, high] = readFactorBounds(value, "uniform", unit);
    return Distribution::uniform(low, high);
  }
  if (kind == "log_uniform") return readLogUniform(value, unit);
  if (kind == "normal") return readNormal(factor, unit);
  if (kind == "choice") return readChoice(factor, words);
  if (kind == "grid") return readFactorGrid(value, unit);
  std::vector<double> values;
  for (const Value& item : value.items) values.push_back(unit.read(item));
  return Distribution::oneOf(values);
}

const std::vector<std::string>& distributionKeys() {
  static const std::vector<std::string> keys = {"uniform", "log_uniform", "normal", "choice", "values", "grid"};
  return keys;
}

/// What says how it is drawn; empty where nothing does.
std::string distributionKeyOf(const Record& factor) {
  std::string found;
  for (const std::string& key : distributionKeys()) {
    if (!factor.given(key)) continue;
    if (!found.empty())
      throw UserError(factor.where(key), "a factor has both '" + found + "' and '" + key + "'", "one of " + listed(distributionKeys()),
                      "remove one of the two");
    found = key;
  }
  for (const auto& [key, of] : {std::pair{"within", "normal"}, {"weights", "choice"}})
    if (factor.given(key) && found != of)
      throw UserError(factor.where(key), std::string("'") + key + "' goes with '" + of + "' only", "'" + std::string(of) + "' beside it", "remove it");
  return found;
}

}  // namespace

const ParameterTable& factorTable() {
  static const ParameterTable t{
      "factor of a sweep",
      "An entry of `vary`: one of `uniform`, `log_uniform`, `normal`, `choice`, `values`, `grid`; of a table none of them, or `choice`. All numbers of a "
      "factor "
      "have one unit, which its column in the results has.",
      {required(text("name", "for `$name` in `set` and `constraints`, and the name of its column: letters, digits and '_'")),
       text("key", "path of the scenario's key that takes the value, as of --set; without it only $name is"),
       list("uniform", "[low, high]: everything between equally often", 2, 2), list("log_uniform", "[low, high] above 0: the logarithm uniform", 2, 2),
       map("normal", "normal distribution: `{mean: 300 K, sigma: 10 K}`"),
       list("within", "of a normal distribution: [low, high], beyond which it is cut off", 2, 2),
       list("choice", "words, names or other values, one of which is taken; in a table's column by its place, from 0", 1, 4096),
       list("weights", "of a choice: how often each is drawn, a number for each; not in a grid", 1, 4096),
       list("values", "numbers, one of which is taken, equally often; in a grid each", 1, kMostFactorValues),
       map("grid", "such values at equal distances: `{from: 1 km, to: 3 km, steps: 5}`")}};
  return t;
}

const ParameterTable& normalTable() {
  static const ParameterTable t{
      "normal distribution of a factor",
      "",
      {required(any("mean", "in the factor's unit, before it is cut off")), required(any("sigma", "standard deviation in the same unit, above 0"))}};
  return t;
}

const ParameterTable& factorGridTable() {
  static const ParameterTable t{"grid of a factor",
                                "",
                                {required(any("from", "first value")), required(any("to", "last value, in the same unit")),
                                 required(integer("steps", "number of values, first and last among them", 2, kMostFactorValues))}};
  return t;
}

void checkColumnName(const std::string& name, const Location& where) {
  constexpr std::size_t kLongest = 100;
  static const std::vector<std::string> taken = {"sample", "seed", "why"};
  if (name.empty() || name.size() > kLongest || nameLength(name) != name.size())
    throw UserError(where, "a column cannot be called " + tokenOf(name), "letters, digits and '_', no digit first, at most 100", "choose another name");
  if (std::find(taken.begin(), taken.end(), name) != taken.end())
    throw UserError(where, "every sweep has a column '" + name + "'", "another name than " + listed(taken), "write 'name: " + name + "_2'");
}

WrittenFactor readFactor(const Value& entry, Design design) {
  const Record r(entry, factorTable());
  WrittenFactor f;
  f.where = r.where("name");
  f.factor.name = r.text("name");
  checkColumnName(f.factor.name, f.where);
  if (r.given("key")) f.key = r.text("key"), f.keyPlace = r.where("key");
  const std::string kind = distributionKeyOf(r);
  const bool table = design == Design::Table;
  if (table && !kind.empty() && kind != "choice")
    throw UserError(r.where(kind), "'" + kind + "' of a factor whose values are in a table", "no distribution, or 'choice'", "remove it");
  if (!table && kind.empty())
    throw UserError(entry.where, "nothing says how '" + f.factor.name + "' is drawn", "one of " + listed(distributionKeys()), "write 'uniform: [2 km, 8 km]'");
  if ((table || design == Design::Grid) && r.given("weights"))
    throw UserError(r.where("weights"), std::string("weights in a ") + (table ? "table" : "grid") + ", where nothing is drawn", "a choice without weights",
                    "remove them");
  if (kind.empty()) return f;
  UnitOfFactor unit(f.factor.name);
  f.distribution = readDistribution(kind, r, unit, f.factor.choices);
  f.factor.unit = unit.text();
  if (design == Design::Grid && f.distribution->levels() == 0)
    throw UserError(r.where(kind), "'" + kind + "' has no single values, as a grid needs", "'values', 'grid' or 'choice'",
                    "write 'grid: {from: ..., to: ..., steps: 5}'");
  return f;
}

}  // namespace pitviper
