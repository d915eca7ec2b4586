#include "scenarios/sweep/sweep_draw.hpp"

#include <cmath>

#include "scenarios/sweep/yaml_line.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {

long long SweepDraw::size() const { return plan_.design ? plan_.design->size() : static_cast<long long>(plan_.table.rows()); }

std::vector<double> SweepDraw::valuesOfRow(int number) const {
  const auto row = static_cast<std::size_t>(number);
  std::vector<double> values;
  for (std::size_t f = 0; f < plan_.factors.size(); ++f) {
    const double v = plan_.table.at(row, plan_.columns[f]);
    const std::size_t choices = plan_.factors[f].choices.size();
    if (choices > 0 && (v < 0.0 || v != std::floor(v) || v >= static_cast<double>(choices)))
      throw UserError(plan_.table.whereOf(row), print("'%s' is %g", plan_.factors[f].name.c_str(), v),
                      "the place of one of its " + std::to_string(choices) + " choices, from 0", "correct or remove the row");
    values.push_back(v);
  }
  return values;
}

std::vector<double> SweepDraw::values(int number, int attempt) const {
  if (!plan_.design) return valuesOfRow(number);
  std::vector<double> values = plan_.design->point(number, attempt);
  for (std::size_t f = 0; f < values.size(); ++f) values[f] = plan_.distributions[f].quantile(values[f]);
  return values;
}

const Constraint* SweepDraw::broken(const DrawnFactors& drawn) const {
  for (const Constraint& c : plan_.constraints)
    if (!meets(c, drawn)) return &c;
  return nullptr;
}

std::optional<Sample> SweepDraw::sample(int number) const {
  Sample s;
  s.number = number;
  s.seed = sampleSeed(plan_.seed, number);
  for (int attempt = 0;; ++attempt) {
    s.values = values(number, attempt);
    const Constraint* constraint = broken({plan_.factors, s.values});
    if (!constraint) break;
    if (!plan_.drawnAgain) return std::nullopt;
    if (attempt + 1 == kMostTries)
      throw UserError(constraint->where, "none of " + std::to_string(kMostTries) + " draws of sample " + std::to_string(number) + " meets the constraints",
                      "constraints that more of them meet", "loosen them, or draw the factors from where they hold");
  }
  setBy(s);
  return s;
}

std::optional<Sample> SweepDraw::sampleAt(int number, std::size_t factor, double value) const {
  Sample s;
  s.number = number;
  s.seed = sampleSeed(plan_.seed, number);
  s.values = values(number, 0);
  s.values[factor] = value;
  if (broken({plan_.factors, s.values})) return std::nullopt;
  setBy(s);
  return s;
}

void SweepDraw::setBy(Sample& s) const {
  const DrawnFactors drawn{plan_.factors, s.values};
  for (const auto& [path, value] : plan_.sets) s.sets.push_back(path + "=" + yamlLine(workedOut(value, drawn)));
}

}  // namespace pitviper
