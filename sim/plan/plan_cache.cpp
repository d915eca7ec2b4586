#include "sim/plan/plan_cache.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "sim/plan/sights.hpp"
#include "sim/scene/content_cache.hpp"

namespace pitviper {
namespace {

constexpr const char* kFormat = "pitviper plan 5";

constexpr const char* kTable = "plan";

/// Hexadecimal floating point: every digit, both ways.
class Writer {
 public:
  void put(double v) {
    char s[40];
    std::snprintf(s, sizeof s, "%a ", v);
    text += s;
  }
  void put(size_t v) { text += std::to_string(v) + " "; }
  template <class Range>
  void all(const Range& values) {
    put(static_cast<size_t>(values.size()));
    for (double v : values) put(v);
  }
  std::string text;
};

class Reader {
 public:
  explicit Reader(const std::string& text) : in_(text) {}
  double number() {
    std::string word;
    if (!(in_ >> word)) return fail();
    char* end = nullptr;
    const double v = std::strtod(word.c_str(), &end);
    return *end == '\0' && std::isfinite(v) ? v : fail();
  }
  size_t count(size_t most) {
    const double v = number();
    if (v >= 0.0 && v <= static_cast<double>(most) && v == std::floor(v)) return static_cast<size_t>(v);
    fail();
    return 0;
  }
  std::vector<double> all(size_t most) {
    std::vector<double> values(count(most));
    for (double& v : values) v = number();
    return values;
  }
  void into(std::array<double, kMostAirAmounts>& values) {
    const auto read = all(values.size());
    if (read.size() == values.size()) std::copy(read.begin(), read.end(), values.begin());
    else fail();
  }
  bool ok() const { return ok_; }

 private:
  double fail() {
    ok_ = false;
    return 0.0;
  }
  std::istringstream in_;
  bool ok_ = true;
};

constexpr size_t kMostNodes = 4096, kMostMembers = 100000, kMostEntries = 1025, kMostStreams = 128;

}  // namespace

std::string writePlanned(const Plan& plan) {
  Writer w;
  w.put(plan.nodes.size());
  for (const SpectralNode& n : plan.nodes) {
    w.put(n.members.size());
    for (const auto& m : n.members) w.put(m.wavelength_um), w.put(m.share);
    w.all(n.air.extinction), w.all(n.air.molecules), w.all(n.air.haze), w.all(n.air.asymmetry);
    w.put(n.air.meanAsymmetry), w.put(n.air.source);
    w.all(n.absorption_per_m);
  }
  w.put(plan.blocks.size());
  for (const NodeBlock& b : plan.blocks) {
    w.put(static_cast<size_t>(b.first)), w.put(static_cast<size_t>(b.count)), w.put(b.slots.size());
    for (int s : b.slots) w.put(static_cast<size_t>(s));
    w.put(static_cast<size_t>(b.lit));
  }
  w.put(plan.weight.size());
  for (const auto& row : plan.weight) w.all(row);
  w.all(plan.predictedError);
  for (const PredictedParts& p : plan.parts)
    w.all(std::array{p.wavelengths, p.tables, p.dropped, p.precision, p.surroundings, p.streams, p.fields, p.extremes});
  for (int n : {plan.air.elevations, plan.air.ranges, plan.air.azimuths}) w.put(static_cast<size_t>(n));
  w.put(plan.air.over), w.put(plan.air.across), w.put(plan.air.near_m), w.put(plan.air.same), w.put(plan.air.sunDepth);
  w.put(static_cast<size_t>(plan.lines)), w.put(static_cast<size_t>(plan.surroundings));
  w.all(plan.surroundingsLoss);
  w.put(static_cast<size_t>(plan.streams));
  w.all(plan.streamsLoss);
  w.all(plan.fineCount);
  w.put(plan.shares.size());
  for (const TermShare& s : plan.shares) w.all(s.share);
  const ContentKey sum = contentKey(w.text);
  return std::string(kFormat) + " " + std::to_string(sum[0]) + " " + std::to_string(sum[1]) + "\n" + w.text + "\n";
}

std::string planFingerprint(const Plan& plan) { return digitsOf(contentKey(writePlanned(plan))); }

bool drawAlike(const Plan& a, const Plan& b) {
  Plan as = a;
  as.predictedError = b.predictedError;
  as.parts = b.parts;
  as.lines = b.lines;
  return writePlanned(as) == writePlanned(b);
}

bool readPlanned(const std::string& text, Plan& into) {
  const size_t line = text.find('\n');
  if (line == std::string::npos || text.back() != '\n' || line + 1 >= text.size()) return false;
  const std::string body = text.substr(line + 1, text.size() - line - 2);
  const ContentKey sum = contentKey(body);
  if (text.substr(0, line) != std::string(kFormat) + " " + std::to_string(sum[0]) + " " + std::to_string(sum[1])) return false;
  Reader r(body);
  Plan plan = into;
  plan.nodes.assign(r.count(kMostNodes), {});
  for (SpectralNode& n : plan.nodes) {
    n.members.assign(r.count(kMostMembers), {});
    for (auto& m : n.members) m.wavelength_um = r.number(), m.share = r.number();
    r.into(n.air.extinction), r.into(n.air.molecules), r.into(n.air.haze), r.into(n.air.asymmetry);
    n.air.meanAsymmetry = r.number(), n.air.source = r.number();
    n.absorption_per_m = r.all(kMostMembers);
    if (!r.ok() || n.members.empty()) return false;
  }
  plan.blocks.assign(r.count(kMostSlots), {});
  for (NodeBlock& b : plan.blocks) {
    b.first = static_cast<int>(r.count(plan.nodes.size())), b.count = static_cast<int>(r.count(plan.nodes.size()));
    for (size_t k = r.count(kMostSlots); k > 0; --k) b.slots.push_back(static_cast<int>(r.count(kMostSlots)));
    b.lit = r.count(1) != 0;
  }
  plan.weight.assign(r.count(kMostSlots), {});
  for (auto& row : plan.weight) row = r.all(plan.nodes.size());
  plan.predictedError = r.all(kMostSlots);
  plan.parts.clear();
  for (size_t k = 0; k < plan.predictedError.size(); ++k) {
    const auto p = r.all(8);
    if (p.size() != 8) return false;
    plan.parts.push_back({p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]});
  }
  for (int* n : {&plan.air.elevations, &plan.air.ranges, &plan.air.azimuths}) *n = static_cast<int>(r.count(kMostEntries));
  plan.air.over = r.number(), plan.air.across = r.number(), plan.air.near_m = r.number(), plan.air.same = r.number(), plan.air.sunDepth = r.number();
  plan.lines = static_cast<int>(r.count(kMostMembers));
  plan.surroundings = static_cast<int>(r.count(kMostHarmonicOrder));
  plan.surroundingsLoss = r.all(kMostSlots);
  plan.streams = static_cast<int>(r.count(kMostStreams));
  plan.streamsLoss = r.all(kMostSlots);
  plan.fineCount.clear();
  for (double n : r.all(kMostSlots)) plan.fineCount.push_back(static_cast<int>(n));
  plan.shares.assign(r.count(kTermKinds), {});
  for (size_t k = 0; k < plan.shares.size(); ++k) plan.shares[k] = {nameOf(static_cast<TermKind>(k)), r.all(kMostSlots), true};
  // The air has tables or it has none: makePlan() has asked it.
  const bool tables = plan.air.elevations > 1 && plan.air.ranges > 1, none = plan.air.elevations == 0 && plan.air.ranges == 0;
  // Errors are told of all slots, or of none.
  const auto ofAllOrNone = [&](const auto& of) { return of.size() == plan.weight.size() || (into.accuracy == 0.0 && of.empty()); };
  bool fits = r.ok() && (into.air.elevations > 0 ? tables : none) && plan.air.azimuths > 0 && plan.weight.size() == static_cast<size_t>(into.slotCount) &&
              ofAllOrNone(plan.predictedError) && ofAllOrNone(plan.fineCount) &&
              // Terms are looked at only where an accuracy says which of them matter.
              plan.shares.size() == (into.accuracy > 0.0 ? static_cast<size_t>(kTermKinds) : 0);
  for (const TermShare& s : plan.shares) fits &= s.share.size() == plan.weight.size();
  for (const auto& row : plan.weight) fits &= row.size() == plan.nodes.size();
  if (fits) into = std::move(plan);
  return fits;
}

bool readCachedPlan(const ContentKey& key, Plan& into) {
  const auto text = readCachedTable(kTable, key);
  return text && readPlanned(*text, into);
}

void writeCachedPlan(const ContentKey& key, const Plan& plan) { writeCachedTable(kTable, key, writePlanned(plan)); }

}  // namespace pitviper
