// Surfaces that are others at other temperatures: states that the surface's own temperature drives.
#include <algorithm>
#include <cmath>

#include "materials/mixed_component.hpp"
#include "scenarios/reader/builder.hpp"
#include "scenarios/reader/tables.hpp"

namespace pitviper {
namespace {

/// Steps from the first temperature to the last by which every one given is told.
constexpr int kMostSteps = 64;

}  // namespace

void Builder::readTemperatureStates(const Value& list, const SpectrumReader& spectra, Material& m) {
  struct Given {
    double temperature_K;
    std::shared_ptr<Material> surface;
  };
  std::vector<Given> given;
  for (const Value& item : list.items) {
    const Record r(item, tables::temperatureState());
    const double temperature = r.number("temperature");
    if (!given.empty() && !(temperature > given.back().temperature_K))
      throw UserError(r.where("temperature"), "a surface's temperatures that do not rise", "rising temperatures, each once", "sort them");
    auto surface = std::make_shared<Material>();
    surface->name = m.name;
    surface->where = item.where;
    std::vector<std::shared_ptr<const Material>> none;
    for (const Value& c : r.value("components").items) {
      if (const Value* modifier = c.find("modifier"))
        throw UserError(modifier->where, "a texture on a surface that changes with temperature", "components without one", "remove it");
      readComponent(c, spectra, *surface, none);
      if (surface->states || surface->transmission)
        throw UserError(c.where, surface->states ? "a second state of a surface that changes with temperature" : "a pane that changes with temperature",
                        "an opaque surface whose components change with temperature alone", "give it numbers, or another component");
    }
    if (!given.empty()) {
      const auto &before = given.back().surface->reflections, &own = surface->reflections;
      bool alike = before.size() == own.size();
      for (size_t k = 0; alike && k < own.size(); ++k) alike = areAlike(*before[k], *own[k]);
      if (!alike)
        throw UserError(item.where, "components that are others in kind than at the temperature before",
                        "the same models with the same angles and widths, in the same order", "change their spectra only");
    }
    given.push_back({temperature, std::move(surface)});
  }
  const double first = given.front().temperature_K, range = given.back().temperature_K - first;
  int steps = 1;
  const auto fits = [&](const Given& g) {
    const double x = (g.temperature_K - first) / range * steps;
    return std::abs(x - std::round(x)) < 1e-6;
  };
  while (steps <= kMostSteps && !std::all_of(given.begin(), given.end(), fits)) ++steps;
  if (steps > kMostSteps)
    throw UserError(list.where, "temperatures that do not stand in steps of one size", "multiples of one step, 1/64 of their range or more",
                    "round them, say to 10 K");
  MaterialStates states;
  states.low = first;
  states.high = first + range;
  for (int k = 0; k <= steps; ++k) {
    const double at = first + range * k / steps;
    size_t above = 1;
    while (above + 1 < given.size() && given[above].temperature_K < at - 1e-9 * range) ++above;
    const Given &a = given[above - 1], &b = given[above];
    const double share = std::clamp((at - a.temperature_K) / (b.temperature_K - a.temperature_K), 0.0, 1.0);
    auto entry = std::make_shared<Material>(*a.surface);
    for (size_t c = 0; c < entry->reflections.size(); ++c) entry->reflections[c] = mixed(a.surface->reflections[c], b.surface->reflections[c], share);
    states.entries.push_back(std::move(entry));
  }
  m.reflections = states.entries.front()->reflections;
  m.modifiers = states.entries.front()->modifiers;
  m.states = std::move(states);
}

void Builder::checkTemperatures(int material, double low_K, double high_K, const Location& where) const {
  const auto& states = simulation_.materials[static_cast<size_t>(material)]->states;
  if (!states || states->texture >= 0 || (low_K >= states->low * (1.0 - 1e-9) && high_K <= states->high * (1.0 + 1e-9))) return;
  throw UserError(where,
                  "a temperature of " + briefNumber(low_K < states->low ? low_K : high_K) + " K, at which material '" +
                      simulation_.materials[static_cast<size_t>(material)]->name.substr(0, 60) + "' is not known",
                  briefNumber(states->low) + " to " + briefNumber(states->high) + " K", "change it, or add the material's surface at that temperature");
}

}  // namespace pitviper
