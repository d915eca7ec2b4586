#include "sim/plan/field_sampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <span>

#include "sim/model/field_drift.hpp"
#include "sim/model/scene_fingerprint.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/plan/budget.hpp"
#include "sim/plan/plan_cache.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/radiance/node_sum.hpp"
#include "sim/scene/content_cache.hpp"
#include "sim/world/field_lines.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/ground.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

constexpr std::array kCounts{1, 2, 3, 4, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64, 96};
constexpr int kMany = 128;
/// How many times are looked at; lines from each eye through a field, and at least through each kind of its elements; eyes.
constexpr int kTimes = 8;
constexpr std::size_t kLines = 32, kLinesOfKind = 4;
constexpr std::size_t kEyes = 3;
/// Distances between lines through a pixel, the farthest tried first; pixels that are looked at of all fields together, and of one field at least and at most,
/// of so many times as many; tries to find them; the most lines each way in one, and in what they are held against; and steps of such a line.
constexpr std::array kApart{6.0, 4.0, 3.0, 2.2, 1.6, 1.0, 0.7, 0.5, 0.35};
constexpr int kPixels = 96, kFewestPixels = 16, kMostPixels = 48, kCandidates = 6, kTried = 2000, kAcross = 28, kMoreAcross = 40, kSteps = 8;
/// What lines are held against has so many times as many, found by bringing these closer step by step, down to a distance.
constexpr std::size_t kMoreLines = 2;
constexpr double kCloser = 0.7, kClosest = 0.2;
/// The least that a line counts as where an error is relative to it, of the brightest line of the field: as on the film (filmFloors()).
constexpr double kDimmest = 1e-3;
/// Steps of elements that were not there when they were looked for; steps taken for such as never were.
constexpr int kNotSeen = -1, kUnknown = 16;
/// Places at which the air of a line is looked at.
constexpr int kAirPlaces = 8;

/// Nodes of each block of a plan that tell how finely to look.
constexpr int kNodes = 24;

/// Where its dice begin.
constexpr std::uint64_t kDice = 11;

constexpr const char* kWhat = "fields";

/// A plan with at most so many nodes of each block: its nodes in the order of what fields absorb at them, which is what steps depend on, in as many groups; of
/// each group that which absorbs nearest to its mean, with the weights of all: what is thin sends as much as with every node.
Plan fewNodes(const Simulation& sim, const Plan& plan, int most) {
  struct Node {
    std::size_t index;
    double absorbed = 0.0, weight = 0.0;
  };
  std::vector<Node> order;
  for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
    Node& n = order.emplace_back(Node{i});
    for (const FieldBody& f : sim.fields)
      for (const FieldGas& g : f.gases) n.absorbed += plan.nodes[i].absorption_per_m[static_cast<std::size_t>(g.levels.front().material)];
    for (const auto& w : plan.weight) n.weight += w[i];
  }
  Plan few = plan;
  few.nodes.clear(), few.blocks.clear();
  for (auto& w : few.weight) w.clear();
  for (const NodeBlock& b : plan.blocks) {
    const std::span block(order.data() + b.first, static_cast<std::size_t>(b.count));
    std::ranges::stable_sort(block, {}, &Node::absorbed);
    const auto count = std::min(block.size(), static_cast<std::size_t>(most));
    few.blocks.push_back({few.nodeCount(), static_cast<int>(count), b.slots, b.lit});
    for (std::size_t k = 0; k < count; ++k) {
      const std::span group = block.subspan(k * block.size() / count, (k + 1) * block.size() / count - k * block.size() / count);
      double weight = 0.0, mean = 0.0;
      for (const Node& n : group) weight += n.weight, mean += n.weight * n.absorbed;
      if (weight > 0.0) mean /= weight;
      const Node& chosen = *std::ranges::min_element(group, {}, [mean](const Node& n) { return std::abs(n.absorbed - mean); });
      few.nodes.push_back(plan.nodes[chosen.index]);
      for (std::size_t s = 0; s < plan.weight.size(); ++s) {
        double& sum = few.weight[s].emplace_back(0.0);
        for (const Node& n : group) sum += plan.weight[s][n.index];
      }
    }
  }
  return few;
}

/// Radiance of lines through one field at a time, in the plan's slots.
class FieldLooks {
 public:
  FieldLooks(const Simulation& sim, const Plan& plan, const WorldState& state, std::size_t index, NodeSum& sum)
      : plan_(plan),
        field_(*fieldOf(state, index)),
        index_(static_cast<int>(index)),
        clear_(plan.terms),
        sum_(sum),
        scene_{sim, plan.terms, plan.sunLegs.get(), state, {}, kAirPlaces},
        airless_{sim, clear_, nullptr, state, {}, 0} {
    clear_.air = false;
  }
  const FieldState& field() const { return field_; }
  std::vector<double> along(LineOfSight& sight, int steps) {
    cut(sight, steps);
    radianceAlong(scene_, sight, sum_);
    return slotsOf(sum_.radiance());
  }
  /// Per node, without the field.
  std::vector<double> behind(LineOfSight& sight) {
    cut(sight, 0);
    radianceAlong(scene_, sight, sum_);
    return {sum_.radiance().begin(), sum_.radiance().end()};
  }
  /// Of the field in clear air before what is behind it, per node: air is even over a pixel.
  std::vector<double> before(const std::vector<double>& behind, LineOfSight& sight, int steps) {
    cut(sight, steps);
    const auto ground = groundHit(scene_.simulation, sight.origin, sight.direction);
    lightOfWay(airless_, sight, ground ? ground->distance : physics::kFar, sum_);
    std::vector<double> seen = sum_.transmittance();
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = sum_.radiance()[i] + seen[i] * behind[i];
    return slotsOf(seen);
  }

 private:
  /// Its steps on a line, of which nothing is told yet.
  void cut(LineOfSight& sight, int steps) {
    field_.along({sight.origin, sight.direction, 0.0, physics::kFar}, steps, cut_);
    setDrifts(cut_);
    sight.hits.slabs.clear();
    for (const FieldStep& s : cut_) sight.hits.slabs.push_back({index_, s});
    sum_.begin();
  }
  std::vector<double> slotsOf(std::span<const double> radiance) const {
    std::vector<double> slots(plan_.weight.size(), 0.0);
    for (std::size_t s = 0; s < slots.size(); ++s)
      for (std::size_t i = 0; i < plan_.nodes.size(); ++i) slots[s] += plan_.weight[s][i] * radiance[i];
    return slots;
  }

  const Plan& plan_;
  const FieldState& field_;
  int index_;
  Terms clear_;
  NodeSum& sum_;
  RadianceScene scene_, airless_;
  std::vector<FieldStep> cut_;
};

StepsByKind stepsFor(FieldLooks& looks, const std::vector<glm::dvec3>& eyes, double asked, Dice& dice) {
  const double allowed = budget::kFields.of(asked), unseen = budget::kFaintFields.of(asked);
  const FieldState& field = looks.field();
  StepsByKind steps;
  steps.fill(kNotSeen);
  std::array<std::vector<const FieldElement*>, kFieldKinds> kinds;
  for (const FieldElement& e : field.elements) kinds[static_cast<std::size_t>(e.kind)].push_back(&e);
  const auto present = static_cast<std::size_t>(std::count_if(kinds.begin(), kinds.end(), [](const auto& of) { return !of.empty(); }));
  const std::size_t lines = std::max(kLinesOfKind, kLines / std::max(present, std::size_t{1}));
  struct Look {
    std::size_t kind;
    LineOfSight sight;
    std::vector<double> want, without;
  };
  std::vector<Look> all;
  std::vector<double> floor;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    for (std::size_t l = 0; l < lines * eyes.size() && !kinds[k].empty(); ++l) {
      const FieldElement& e = *kinds[k][dice.below(kinds[k].size())];
      // Near its middle, where a jet's core is, as well as anywhere.
      const double reach = l % 2 == 0 ? 0.6 : 0.03;
      const auto off = [&] { return reach * (2.0 * dice.unit() - 1.0); };
      const glm::dvec3 place = glm::clamp(e.centre + e.radius_m * glm::dvec3(off(), off(), off()), field.low, field.high), eye = eyes[l / lines];
      const glm::dvec3 line = field.origin + field.localFromField * place - eye;
      if (!(glm::length(line) > 0.0)) continue;
      Look look{k, {eye, glm::normalize(line), {}, 0.0}, {}, {}};
      look.want = looks.along(look.sight, kMany);
      look.without = looks.along(look.sight, 0);
      floor.resize(look.want.size(), 0.0);
      for (std::size_t s = 0; s < floor.size(); ++s) floor[s] = std::max(floor[s], kDimmest * look.want[s]);
      all.push_back(std::move(look));
    }
  for (Look& look : all) {
    const auto errorOf = [&](const std::vector<double>& got) {
      double worst = 0.0;
      for (std::size_t s = 0; s < got.size(); ++s)
        if (floor[s] > 0.0) worst = std::max(worst, std::abs(got[s] - look.want[s]) / std::max(look.want[s], floor[s]));
      return worst;
    };
    int& own = steps[look.kind];
    own = std::max(own, 0);
    if (own == 0 && errorOf(look.without) <= unseen) continue;
    for (const int count : kCounts) {
      if (count < own) continue;
      own = count;
      if (errorOf(looks.along(look.sight, count)) <= allowed) break;
    }
  }
  return steps;
}

/// The farthest apart that lines may lie in pixels of this view, through each kind of elements, or as far as said already.
void coarserFor(FieldLooks& looks, const View& view, int pixels, double asked, Dice& dice, ApartByKind& already) {
  const FieldLines lines = fieldLines(view, looks.field());
  if (lines.parts.empty()) return;
  const auto through = [&](double x, double y) { return LineOfSight{view.position, glm::normalize(view.localFromCamera * view.ray(x, y)), {}, 0.0}; };
  const auto mean = [&](const PixelLines& pixel, const std::vector<double>& behind) {
    std::vector<double> sum;
    for (const FilmLine& l : pixel.within) {
      LineOfSight sight = through(l.at.x, l.at.y);
      const auto own = looks.before(behind, sight, kSteps);
      sum.resize(own.size(), 0.0);
      for (std::size_t s = 0; s < own.size(); ++s) sum[s] += l.share * own[s];
    }
    return sum;
  };
  // Places that are finer than a pixel: those between whose halves there is most, and some others.
  struct Place {
    int x, y;
    std::vector<double> a, b;
    double change;
  };
  std::vector<Place> places;
  std::vector<double> brightest, behindAny;  // to find these one sky does for all
  for (int tried = 0; static_cast<int>(places.size()) < kCandidates * pixels && tried < kTried; ++tried) {
    const FieldLines::Part& part = lines.parts[dice.below(lines.parts.size())];
    const glm::dvec2 at = part.low + (part.high - part.low) * glm::dvec2(dice.unit(), dice.unit());
    Place place{std::clamp(static_cast<int>(at.x), 0, view.width - 1), std::clamp(static_cast<int>(at.y), 0, view.height - 1), {}, {}, 0.0};
    if (pixelLines(std::array{&lines}, place.x, place.y, kAcross).within.size() < 2) continue;
    const double across = places.size() % 2 == 0 ? 0.25 : -0.25;
    LineOfSight one = through(place.x + 0.5 - across, place.y + 0.25), other = through(place.x + 0.5 + across, place.y + 0.75);
    if (behindAny.empty()) behindAny = looks.behind(one);
    place.a = looks.before(behindAny, one, kSteps), place.b = looks.before(behindAny, other, kSteps);
    brightest.resize(place.a.size(), 0.0);
    for (std::size_t s = 0; s < brightest.size(); ++s) brightest[s] = std::max({brightest[s], place.a[s], place.b[s]});
    places.push_back(std::move(place));
  }
  const auto off = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0.0;
    for (std::size_t s = 0; s < a.size(); ++s) worst = std::max(worst, std::abs(a[s] - b[s]) / std::max({b[s], kDimmest * brightest[s], 1e-300}));
    return worst;
  };
  for (Place& p : places) p.change = std::max(off(p.a, p.b), off(p.b, p.a));
  const auto most = std::min<std::size_t>(static_cast<std::size_t>(pixels), places.size());
  std::partial_sort(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(most / 2), places.end(),
                    [](const Place& a, const Place& b) { return a.change > b.change; });
  for (double& a : already)
    if (a == 0.0 && most > 0) a = kApart.front();
  for (std::size_t p = 0; p < most; ++p) {
    const int x = places[p].x, y = places[p].y;
    FieldLines here;
    for (const FieldLines::Part& part : lines.parts)
      if (part.high.x > x && part.high.y > y && part.low.x < x + 1.0 && part.low.y < y + 1.0) here.parts.push_back(part);
    const auto kindOf = [&](const FieldLines::Part& part) { return static_cast<std::size_t>(looks.field().elements[part.element].kind); };
    const auto linesOf = [&](double coarser, int atMost) {
      for (FieldLines::Part& part : here.parts) part.coarser = std::min(already[kindOf(part)], coarser);
      return pixelLines(std::array{static_cast<const FieldLines*>(&here)}, x, y, atMost);
    };
    // What is wider than a pixel wants no lines of its own.
    const auto wants = [](const FieldLines::Part& part) { return std::min(part.apart_px.x, part.apart_px.y) < 1.0; };
    double farthest = 0.0, wanted = 1.0;
    for (const FieldLines::Part& part : here.parts)
      if (wants(part)) farthest = std::max(farthest, already[kindOf(part)]);
    PixelLines fine = linesOf(1.0, kMoreAcross);
    LineOfSight middle = through(x + 0.5, y + 0.5);
    const std::vector<double> behind = looks.behind(middle);
    std::vector<double> want;  // as soon as it is asked for
    for (const double coarser : kApart) {
      if (coarser > farthest) continue;
      const PixelLines own = linesOf(coarser, kAcross);
      for (const FieldLines::Part& part : here.parts)
        if (wants(part)) already[kindOf(part)] = std::min(already[kindOf(part)], coarser);
      // Against lines that are at least so many more.
      while (fine.within.size() < kMoreLines * own.within.size() && fine.within.size() < kMoreAcross * kMoreAcross && wanted > kClosest) {
        wanted *= kCloser;
        fine = linesOf(wanted, kMoreAcross);
        want.clear();
      }
      if (fine.within.size() <= own.within.size()) break;  // nothing is left to tell more by
      if (want.empty()) want = mean(fine, behind);
      if (off(mean(own, behind), want) <= budget::kFields.of(asked)) break;
    }
  }
}

}  // namespace

FieldSampling::Needs FieldSampling::needsOf(const Simulation& sim, const Plan& plan, const WorldState& state, std::size_t f, int pixels, double asked,
                                            NodeSum& sum, Dice& dice) {
  Needs needs;
  needs.steps.fill(kNotSeen);
  if (!fieldOf(state, f)) return needs;
  std::vector<glm::dvec3> eyes;
  for (const Camera& c : sim.cameras) eyes.push_back(cameraAt(c, state).pose.position);
  for (const Probe& p : sim.probes) eyes.push_back(p.position);
  eyes.resize(std::min(eyes.size(), kEyes));
  FieldLooks looks(sim, plan, state, f, sum);
  needs.steps = stepsFor(looks, eyes, asked, dice);
  for (std::size_t c = 0; c < std::min(sim.cameras.size(), kEyes); ++c)
    coarserFor(looks, cameraView(sim.cameras[c], state, sim.cameras[c].sharesShading ? 1 : sim.cameras[c].samples), pixels, asked, dice, needs.coarser);
  return needs;
}

FieldSampling::FieldSampling(const Simulation& sim, const Plan& whole, int most) {
  const double asked = whole.accuracy > 0.0 ? whole.accuracy : kUsualAccuracy;
  const Plan plan = fewNodes(sim, whole, most);
  const NodeSpectra spectra(sim, plan.nodes, withSurroundings(plan.terms, 0));
  const int pixels = std::clamp(kPixels / std::max(static_cast<int>(sim.fields.size()), 1), kFewestPixels, kMostPixels);
  const int times = sim.fields.empty() ? 0 : std::clamp(sim.time.frames, 1, kTimes);
  std::vector<WorldState> states;
  for (int t = 0; t < times; ++t) {
    time_s_.push_back(sim.time.at(times > 1 ? t * (sim.time.frames - 1) / (times - 1) : 0));
    states.push_back(withEjected(sim, time_s_.back(), t));
    of_.emplace_back(sim.fields.size());
  }
  const std::size_t all = states.size() * sim.fields.size();
  onAllThreads(all, [&](const auto& next) {
    NodeSum sum(spectra);
    for (std::size_t k = next(); k < all; k = next()) {
      const std::size_t t = k / sim.fields.size(), f = k % sim.fields.size();
      // Dice of its own: what is looked at of one is the same whatever else there is, and whenever that came.
      Dice dice(kDice + k);
      of_[t][f] = needsOf(sim, plan, states[t], f, pixels, asked, sum, dice);
    }
  });
}

std::string FieldSampling::bytes() const {
  TableWriter out;
  out.all(time_s_);
  for (const auto& needs : of_) out.all(needs);
  return out.bytes();
}

std::optional<FieldSampling> FieldSampling::from(std::string_view bytes, std::size_t fields) {
  TableReader in(bytes);
  FieldSampling all;
  all.time_s_ = in.all<double>();
  for (std::size_t t = 0; t < all.time_s_.size(); ++t) {
    all.of_.push_back(in.all<Needs>());
    if (all.of_.back().size() != fields) return std::nullopt;
  }
  if (!in.isWhole()) return std::nullopt;
  return all;
}

std::shared_ptr<const FieldSampling> FieldSampling::of(const Simulation& simulation, const Plan& plan) {
  static std::mutex mutex;
  static std::weak_ptr<const FieldSampling> last;
  static const Simulation* lastOf = nullptr;
  static double lastAccuracy = 0.0;
  static std::vector<std::vector<double>> lastWeights;
  const std::lock_guard lock(mutex);
  if (auto kept = last.lock(); kept && lastOf == &simulation && lastAccuracy == plan.accuracy && lastWeights == plan.weight) return kept;
  const ContentKey key = contentKeyOf([&](Fingerprint& f) {
    f.add(plan.accuracy).add(writePlanned(plan));
    addTo(f, simulation);
    for (const Camera& c : simulation.cameras) addTo(f, c);
    for (const Probe& p : simulation.probes) addTo(f, p);
  });
  std::shared_ptr<const FieldSampling> made;
  if (const auto kept = readCachedTable(kWhat, key))
    if (auto read = from(*kept, simulation.fields.size())) made = std::make_shared<const FieldSampling>(std::move(*read));
  if (!made) {
    made = std::make_shared<const FieldSampling>(simulation, plan, kNodes);
    writeCachedTable(kWhat, key, made->bytes());
  }
  last = made, lastOf = &simulation, lastAccuracy = plan.accuracy, lastWeights = plan.weight;
  return made;
}

std::pair<const FieldSampling::Needs*, const FieldSampling::Needs*> FieldSampling::around(std::size_t field, double time_s) const {
  const auto after = static_cast<std::size_t>(std::lower_bound(time_s_.begin(), time_s_.end(), time_s) - time_s_.begin());
  return {&of_[after > 0 ? after - 1 : 0][field], &of_[std::min(after, of_.size() - 1)][field]};
}

StepsByKind FieldSampling::steps(std::size_t field, double time_s) const {
  const auto [last, next] = around(field, time_s);
  StepsByKind steps;
  for (std::size_t k = 0; k < steps.size(); ++k) {
    steps[k] = std::max(last->steps[k], next->steps[k]);
    // What comes and goes between the two: as at any time.
    if (steps[k] <= 0)
      for (const auto& of : of_) steps[k] = std::max(steps[k], of[field].steps[k]);
    if (steps[k] == kNotSeen) steps[k] = kUnknown;
  }
  return steps;
}

ApartByKind FieldSampling::coarser(std::size_t field, double time_s) const {
  const auto [last, next] = around(field, time_s);
  ApartByKind least;
  least.fill(INFINITY);
  const auto take = [&least](const Needs& n) {
    for (std::size_t k = 0; k < least.size(); ++k)
      if (n.coarser[k] > 0.0) least[k] = std::min(least[k], n.coarser[k]);
  };
  take(*last), take(*next);
  for (const auto& of : of_)
    if (!std::isfinite(least.front())) take(of[field]);
  if (!std::isfinite(least.front())) least.fill(1.0);
  return least;
}

}  // namespace pitviper
