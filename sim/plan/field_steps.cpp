#include "sim/plan/field_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/model/field_states.hpp"
#include "sim/model/world.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiance/node_sum.hpp"

namespace pitviper {
namespace {

constexpr std::array kCounts{6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64};
constexpr int kMany = 160;
/// Times and, at each, lines from each eye that are looked at; eyes.
constexpr int kTimes = 6, kLines = 5;
constexpr std::size_t kEyes = 3;
/// Parts of the accuracy that steps may spend; what is asked where no accuracy is.
constexpr double kPart = 1.0 / 3.0, kUsual = 0.01;

std::vector<double> slotsOf(const Plan& plan, const NodeSum& sum) {
  std::vector<double> slots(plan.weight.size(), 0.0);
  for (std::size_t s = 0; s < slots.size(); ++s)
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) slots[s] += plan.weight[s][i] * sum.radiance()[i];
  return slots;
}

}  // namespace

int fieldSteps(const Simulation& sim, const Plan& plan, std::size_t number) {
  const double allowed = kPart * (plan.accuracy > 0.0 ? plan.accuracy : kUsual);
  const NodeSpectra spectra(sim, plan.nodes, 0);
  NodeSum sum(spectra);
  Dice dice(11 + number);
  std::size_t needed = 0;
  for (int t = 0; t < kTimes; ++t) {
    const double time_s = sim.time.at(sim.time.frames > 1 ? t * (sim.time.frames - 1) / (kTimes - 1) : 0);
    const WorldState state = advance(sim, time_s);
    const FieldState* field = fieldOf(state, number);
    if (!field || field->elements.empty()) continue;
    std::vector<glm::dvec3> eyes;
    for (const Camera& c : sim.cameras) eyes.push_back(cameraAt(c, state).pose.position);
    for (const Probe& p : sim.probes) eyes.push_back(p.position);
    eyes.resize(std::min(eyes.size(), kEyes));
    for (const glm::dvec3& eye : eyes)
      for (int l = 0; l < kLines; ++l) {
        const FieldElement& e = field->elements[dice.below(field->elements.size())];
        // Near its middle, where a jet's core is, as well as anywhere.
        const double reach = l % 2 == 0 ? 0.6 : 0.03;
        const auto off = [&] { return reach * (2.0 * dice.unit() - 1.0); };
        const glm::dvec3 place = glm::clamp(e.centre + e.radius_m * glm::dvec3(off(), off(), off()), field->low, field->high);
        const glm::dvec3 line = field->origin + field->localFromField * place - eye;
        if (!(glm::length(line) > 0.0)) continue;
        LineOfSight sight{eye, glm::normalize(line), {}, 0.0};
        const auto radiance = [&](int steps) {
          std::vector<FieldStep> cut;
          field->along({sight.origin, sight.direction, 0.0, physics::kFar}, steps, cut);
          sight.hits.slabs.clear();
          for (const FieldStep& s : cut) sight.hits.slabs.push_back({static_cast<int>(number), s});
          sum.begin();
          radianceAlong({sim, plan.terms, plan.sunLegs.get(), state, {}, 0}, sight, sum);
          return slotsOf(plan, sum);
        };
        const std::vector<double> want = radiance(kMany);
        for (; needed + 1 < kCounts.size(); ++needed) {
          const std::vector<double> got = radiance(kCounts[needed]);
          double worst = 0.0;
          for (std::size_t s = 0; s < want.size(); ++s)
            if (want[s] > 0.0) worst = std::max(worst, std::abs(got[s] / want[s] - 1.0));
          if (worst <= allowed) break;
        }
      }
  }
  return kCounts[needed];
}

}  // namespace pitviper
