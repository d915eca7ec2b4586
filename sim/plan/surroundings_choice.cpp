#include "sim/plan/surroundings_choice.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/plan_effort.hpp"

namespace pitviper {
namespace {

/// Where no degree keeps its account, the lowest is taken whose loss is at most this many times the least.
constexpr double kNoWorse = 1.1;
/// A line's radiance, and apart from that each term of ambient light by direction, to be told in another way.
class AroundSink final : public TermSink {
 public:
  struct Ambient {
    const ReflectionComponent* component;
    SurfaceView seen;
    std::vector<double> reach;  ///< per node, what of a radiance there is seen
  };
  struct Told {
    std::vector<double> slots;      ///< of all terms
    std::vector<double> ofAmbient;  ///< of ambient light, in full
    std::vector<Ambient> ambient;
  };
  explicit AroundSink(const NodesOfPlan& fine) : fine_(fine), sum_(fine.spectra) { sum_.keepParts(); }
  void begin() { sum_.begin(), ambient_.clear(); }
  Told finish() { return {slotsOf(fine_.plan, sum_.radiance()), slotsOf(fine_.plan, sum_.part(TermKind::Ambient)), std::move(ambient_)}; }

  void restart() override { sum_.restart(); }
  void segment(const Segment& s) override { sum_.segment(s); }
  void pane(const Factor& transmittance, double modifier) override { sum_.pane(transmittance, modifier); }
  void term(const Term& t) override {
    sum_.term(t);
    if (t.kind != TermKind::Ambient || t.factors.front().kind != Factor::Kind::Reflected) return;
    const Factor& f = t.factors.front();
    Ambient own{static_cast<const ReflectionComponent*>(f.of), *f.seen, sum_.reach()};
    for (double& r : own.reach) r *= t.coefficient;
    ambient_.push_back(std::move(own));
  }

 private:
  const NodesOfPlan& fine_;
  NodeSum sum_;
  std::vector<Ambient> ambient_;
};

struct Tried {
  int degree;
  std::vector<double> loss;  ///< [slot]
  double largest;
};

/// What ambient light by a degree is off by.
Tried tell(const Simulation& sim, const NodesOfPlan& fine, const std::vector<AroundSink::Told>& lines, const std::vector<double>& floor, int degree) {
  const NodeSpectra spectra(sim, fine.plan.nodes, withSurroundings(fine.plan.terms, degree), &fine.spectra);
  std::vector<std::vector<double>> off(lines.size());
  onAllThreads(lines.size(), [&](const auto& next) {
    std::vector<double> radiance(fine.plan.nodes.size());
    for (size_t n = next(); n < lines.size(); n = next()) {
      std::fill(radiance.begin(), radiance.end(), 0.0);
      for (const AroundSink::Ambient& a : lines[n].ambient) {
        const std::vector<double> sent = spectra.of(Factor::reflected(*a.component, a.seen));
        for (size_t i = 0; i < sent.size(); ++i) radiance[i] += a.reach[i] * sent[i];
      }
      off[n] = slotsOf(fine.plan, radiance);
    }
  });
  Tried tried{degree, std::vector<double>(floor.size(), 0.0), 0.0};
  for (size_t n = 0; n < lines.size(); ++n)
    for (size_t s = 0; s < floor.size(); ++s) {
      const double size = std::max(std::abs(lines[n].slots[s]), floor[s]), difference = std::abs(off[n][s] - lines[n].ofAmbient[s]);
      tried.loss[s] = std::max(tried.loss[s], size > 0.0 ? difference / size : difference > 0.0 ? INFINITY : 0.0);
    }
  for (double l : tried.loss) tried.largest = std::max(tried.largest, l);
  return tried;
}

}  // namespace

void chooseSurroundings(const Simulation& sim, const NodesOfPlan& fine, SightRays& rays, const std::vector<double>& floor, Plan& plan) {
  if (plan.terms.surroundings == 0) return;
  const int count = effortOf(plan.accuracy).around;
  // Half as many of small bodies and of all combinations of things: a canopy may be few pixels.
  std::vector<SightRay> lines = rays.overFilm(count);
  for (SightRay& ray : rays.ofSmallBodies(count / 2)) lines.push_back(std::move(ray));
  for (int n = 0; n < count / 2; ++n) lines.push_back(rays.ofCombination());
  std::vector<AroundSink::Told> told(lines.size());
  const ShadowCaster shadows(sim);
  onAllThreads(lines.size(), [&](const auto& next) {
    AroundSink sink(fine);
    for (size_t n = next(); n < lines.size(); n = next()) {
      const RadianceScene scene = sceneOf(sim, fine.plan, shadows, lines[n], kUsualPlaces);
      sink.begin();
      radianceAlong(scene, lines[n].line, sink);
      if (lines[n].lamp >= 0) lampAlong(scene, lines[n].line, static_cast<size_t>(lines[n].lamp), lines[n].pixel_sr, sink);
      told[n] = sink.finish();
    }
  });
  std::vector<Tried> all;
  const auto isEnough = [&](const Tried& t) { return t.largest <= budget::kSurroundings.of(plan.accuracy); };
  const auto look = [&](int degree) {
    all.push_back(tell(sim, fine, told, floor, degree));
    return isEnough(all.back());
  };
  for (const int degree : {0, 2, 3, kMostHarmonicOrder})
    if (plan.accuracy > 0.0 || degree > 2)
      if (look(degree)) break;
  // The first that keeps its account or, where none does, that loses about as little as any.
  double least = INFINITY;
  for (const Tried& t : all) least = std::min(least, t.largest);
  const Tried& taken = *std::find_if(all.begin(), all.end(), [&](const Tried& t) { return isEnough(t) || t.largest <= kNoWorse * least; });
  plan.surroundings = taken.degree;
  plan.surroundingsLoss = taken.loss;
}

}  // namespace pitviper
