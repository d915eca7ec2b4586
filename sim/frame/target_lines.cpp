#include "sim/frame/target_lines.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace pitviper {
namespace {

/// A kind of things counts by itself where it has one part in so many of a share.
constexpr double kPartsOfShare = 4.0;

struct Contrast {
  const TargetLine* line;
  double perSr, all;  ///< of all slots: with its sign, and without over its solid angle
};

void cut(std::vector<Contrast>& lines, double all, int shares, std::vector<Stratum>& strata) {
  std::stable_sort(lines.begin(), lines.end(), [](const Contrast& a, const Contrast& b) { return a.perSr < b.perSr; });
  double upTo = 0.0;
  int share = -1;
  for (const Contrast& l : lines) {
    const double middle = (upTo + 0.5 * l.all) / all * shares;
    upTo += l.all;
    if (const int its = std::min(static_cast<int>(middle), shares - 1); its != share)
      strata.push_back({l.line, 0.0, std::vector<double>(l.line->contrast.size(), 0.0)}), share = its;
    Stratum& last = strata.back();
    // The last before the middle of its share.
    if (middle - share <= 0.5) last.line = l.line;
    last.sr += l.line->sr;
    for (std::size_t s = 0; s < last.contrast.size(); ++s) last.contrast[s] += l.line->sr * l.line->contrast[s];
  }
}

}  // namespace

std::vector<Stratum> strataOf(const std::vector<TargetLine>& lines, int shares) {
  std::vector<Stratum> strata;
  if (lines.empty()) return strata;
  std::vector<double> whole(lines.front().contrast.size(), 0.0);
  for (const TargetLine& l : lines)
    for (std::size_t s = 0; s < whole.size(); ++s) whole[s] += l.sr * std::abs(l.contrast[s]);
  struct Class {
    std::vector<Contrast> lines;
    double all = 0.0;
  };
  std::map<std::size_t, Class> classes;
  double all = 0.0;
  for (const TargetLine& l : lines) {
    Contrast own{&l, 0.0, 0.0};
    for (std::size_t s = 0; s < whole.size(); ++s)
      if (whole[s] > 0.0) own.perSr += l.contrast[s] / whole[s], own.all += l.sr * std::abs(l.contrast[s]) / whole[s];
    Class& its = classes[l.things];
    its.lines.push_back(own);
    its.all += own.all;
    all += own.all;
  }
  // However many kinds of things there are: the least of them count as one.
  Class least;
  for (auto& [things, its] : classes) {
    if (its.all * shares * kPartsOfShare >= all) continue;
    least.lines.insert(least.lines.end(), its.lines.begin(), its.lines.end());
    least.all += std::exchange(its.all, 0.0);
  }
  const auto add = [&](Class& its) {
    if (its.all > 0.0) cut(its.lines, its.all, static_cast<int>(std::ceil(its.all / all * shares)), strata);
  };
  for (auto& [things, its] : classes) add(its);
  add(least);
  return strata;
}

}  // namespace pitviper
