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

constexpr std::array kCounts{1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96};
constexpr int kMany = 128;
/// Times and, at each, lines from each eye through each kind of element that are looked at; eyes.
constexpr int kTimes = 6;
constexpr std::size_t kLines = 3;
constexpr std::size_t kEyes = 3;
/// What is darker than this part of the field's brightest line counts as so much, as on the film: filmFloors().
constexpr double kDimmest = 1e-3;
/// Parts of the accuracy that steps may spend; what is asked where no accuracy is.
constexpr double kPart = 1.0 / 3.0, kUsual = 0.01;
/// What changes no line by more than this part of the accuracy is not drawn, as terms that small are.
constexpr double kUnseen = 0.05;

std::vector<double> slotsOf(const Plan& plan, const NodeSum& sum) {
  std::vector<double> slots(plan.weight.size(), 0.0);
  for (std::size_t s = 0; s < slots.size(); ++s)
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) slots[s] += plan.weight[s][i] * sum.radiance()[i];
  return slots;
}

}  // namespace

std::vector<std::array<int, kFieldKinds>> fieldSteps(const Simulation& sim, const Plan& plan) {
  const double asked = plan.accuracy > 0.0 ? plan.accuracy : kUsual, allowed = kPart * asked, unseen = kUnseen * asked;
  const NodeSpectra spectra(sim, plan.nodes, 0);
  NodeSum sum(spectra);
  std::vector<std::array<int, kFieldKinds>> steps(sim.fields.size());
  for (auto& of : steps) of.fill(0);
  Dice dice(11);
  for (int t = 0; t < kTimes; ++t) {
    const WorldState state = advance(sim, sim.time.at(sim.time.frames > 1 ? t * (sim.time.frames - 1) / (kTimes - 1) : 0));
    std::vector<glm::dvec3> eyes;
    for (const Camera& c : sim.cameras) eyes.push_back(cameraAt(c, state).pose.position);
    for (const Probe& p : sim.probes) eyes.push_back(p.position);
    eyes.resize(std::min(eyes.size(), kEyes));
    for (std::size_t f = 0; f < sim.fields.size(); ++f) {
      const FieldState* field = fieldOf(state, f);
      if (!field) continue;
      const auto radiance = [&](LineOfSight& sight, int count) {
        std::vector<FieldStep> cut;
        field->along({sight.origin, sight.direction, 0.0, physics::kFar}, count, cut);
        sight.hits.slabs.clear();
        for (const FieldStep& s : cut) sight.hits.slabs.push_back({static_cast<int>(f), s});
        sum.begin();
        radianceAlong({sim, plan.terms, plan.sunLegs.get(), state, {}, 0}, sight, sum);
        return slotsOf(plan, sum);
      };
      std::array<std::vector<const FieldElement*>, kFieldKinds> kinds;
      for (const FieldElement& e : field->elements) kinds[static_cast<std::size_t>(e.kind)].push_back(&e);
      struct Look {
        std::size_t kind;
        LineOfSight sight;
        std::vector<double> want, without;
      };
      std::vector<Look> looks;
      std::vector<double> floor(plan.weight.size(), 0.0);
      for (std::size_t k = 0; k < kinds.size(); ++k)
        for (std::size_t l = 0; l < kLines * eyes.size() && !kinds[k].empty(); ++l) {
          const FieldElement& e = *kinds[k][dice.below(kinds[k].size())];
          // Near its middle, where a jet's core is, as well as anywhere.
          const double reach = l % 2 == 0 ? 0.6 : 0.03;
          const auto off = [&] { return reach * (2.0 * dice.unit() - 1.0); };
          const glm::dvec3 place = glm::clamp(e.centre + e.radius_m * glm::dvec3(off(), off(), off()), field->low, field->high), eye = eyes[l / kLines];
          const glm::dvec3 line = field->origin + field->localFromField * place - eye;
          if (!(glm::length(line) > 0.0)) continue;
          Look look{k, {eye, glm::normalize(line), {}, 0.0}, {}, {}};
          look.want = radiance(look.sight, kMany);
          look.without = radiance(look.sight, 0);
          for (std::size_t s = 0; s < floor.size(); ++s) floor[s] = std::max(floor[s], kDimmest * look.want[s]);
          looks.push_back(std::move(look));
        }
      for (Look& look : looks) {
        const auto errorOf = [&](const std::vector<double>& got) {
          double worst = 0.0;
          for (std::size_t s = 0; s < got.size(); ++s)
            if (floor[s] > 0.0) worst = std::max(worst, std::abs(got[s] - look.want[s]) / std::max(look.want[s], floor[s]));
          return worst;
        };
        if (steps[f][look.kind] == 0 && errorOf(look.without) <= unseen) continue;
        for (const int count : kCounts) {
          if (count < steps[f][look.kind]) continue;
          steps[f][look.kind] = count;
          if (errorOf(radiance(look.sight, count)) <= allowed) break;
        }
      }
    }
  }
  return steps;
}

}  // namespace pitviper
