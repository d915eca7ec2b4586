#include "scenarios/commands/plan_report.hpp"

#include <algorithm>

#include "scenarios/commands/geometry_report.hpp"
#include "sim/parameters/print.hpp"
#include "sim/plan/budget.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/render/assembly/tables.hpp"

namespace pitviper {
namespace {

std::string quoted(const std::string& s) {
  std::string out = "\"";
  for (char c : s) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) < 0x20) out += print("\\u%04x", static_cast<unsigned>(c));
    else out += c;
  }
  return out + "\"";
}

std::string percent(double part) {
  const double p = 100.0 * part;
  return p == 0.0 ? "0" : p < 0.001 ? "<0.001" : print(p < 0.1 ? "%.3f" : p < 10.0 ? "%.2f" : "%.0f", p);
}

/// Columns of shares, unless their channel's name is wider.
constexpr size_t kShare = 9;

std::string padded(const std::string& s, size_t width, bool right) {
  const std::string blank(s.size() < width ? width - s.size() : 0, ' ');
  return right ? blank + s : s + blank;
}

int nodesOf(const Plan& plan, size_t slot) {
  return static_cast<int>(std::count_if(plan.weight[slot].begin(), plan.weight[slot].end(), [](double w) { return w != 0.0; }));
}

/// What a relative error is as a difference of temperature of a black body; 0 where it does not shine.
double kelvinOf(const Plan& plan, size_t slot, double error, double temperature_K) {
  double cold = 0.0, warm = 0.0;
  for (size_t i = 0; i < plan.nodes.size(); ++i) {
    if (plan.weight[slot][i] == 0.0) continue;
    cold += plan.weight[slot][i] * plan.nodes[i].planck(temperature_K - 0.5);
    warm += plan.weight[slot][i] * plan.nodes[i].planck(temperature_K + 0.5);
  }
  return warm > cold && cold > 1e-12 ? error * 0.5 * (cold + warm) / (warm - cold) : 0.0;
}

/// What each account of the budget may lose at most, and what it lost.
std::string accountsText(const Plan& plan, const std::vector<std::string>& names) {
  std::string out = print("\n  %-32s %10s", "lost, % of a pixel", plan.accuracy > 0.0 ? "at most" : "");
  for (const auto& n : names) out += " " + padded(n, kShare, true);
  out += "\n";
  const auto row = [&](std::string_view name, const std::string& most, double PredictedParts::*part) {
    out += print("  %-32s %10s", std::string(name).c_str(), plan.accuracy > 0.0 ? most.c_str() : "");
    for (size_t s = 0; s < plan.parts.size(); ++s) out += " " + padded(percent(plan.parts[s].*part), std::max(kShare, names[s].size()), true);
    out += "\n";
  };
  const auto most = [&](const Account& of) { return percent(of.of(plan.accuracy)); };
  row("wavelengths", "the rest", &PredictedParts::wavelengths);
  row(budget::kTables.name, most(budget::kTables), &PredictedParts::tables);
  row(budget::kTerms.name, most(budget::kTerms) + " each", &PredictedParts::dropped);
  if (!plan.surroundingsLoss.empty()) row(budget::kSurroundings.name, most(budget::kSurroundings), &PredictedParts::surroundings);
  if (plan.streams > 0) row(budget::kStreams.name, most(budget::kStreams), &PredictedParts::streams);
  if (plan.parts.front().fields > 0.0) row(budget::kFields.name, most(budget::kFields), &PredictedParts::fields);
  row("precision", "", &PredictedParts::precision);
  row("beside it, at the extremes", "", &PredictedParts::extremes);
  return out;
}

}  // namespace

std::vector<std::string> slotNames(const Plan& plan, const std::vector<ChannelOutput>& outputs) {
  std::vector<std::vector<const ChannelOutput*>> members(static_cast<size_t>(plan.slotCount));
  for (size_t o = 0; o < outputs.size(); ++o) members[static_cast<size_t>(plan.slotOfOutput[o])].push_back(&outputs[o]);
  // A channel that is one slot alone is named by itself; of one with several (radiance and photons, say) each says of what quantities.
  auto slotsOf = [&](const std::string& channel) {
    return std::count_if(members.begin(), members.end(), [&](const auto& slot) {
      return std::any_of(slot.begin(), slot.end(), [&](const ChannelOutput* o) { return o->channel == channel; });
    });
  };
  std::vector<std::string> names;
  for (const auto& slot : members) {
    std::vector<std::string> parts;
    for (const ChannelOutput* o : slot) {
      std::string part = slotsOf(o->channel) > 1 ? o->layer() : o->channel;
      if (std::find(parts.begin(), parts.end(), part) == parts.end()) parts.push_back(std::move(part));
    }
    std::string name;
    for (const auto& part : parts) name += (name.empty() ? "" : "+") + part;
    names.push_back(std::move(name));
  }
  return names;
}

NodeCost costOf(const Plan& plan) {
  NodeCost cost;
  for (const NodeBlock& b : plan.blocks) (b.lit && plan.terms.lights ? cost.lit : cost.unlit) += b.count;
  return cost;
}

double shadingTableBytes(const Simulation& sim, const Plan& plan) {
  const RenderTables t = makeTables(sim, plan);
  size_t floats = t.media.size() + t.node.size() + t.ambient.size() + t.weights.size();
  for (const SurfaceTables* s : {&t.solid, &t.layer}) floats += s->rows.size() + s->hemispherical.size() + s->columns.size() + s->transmittance.size();
  return static_cast<double>(floats * sizeof(float));
}

std::string planText(const PlannedEye& eye) {
  const Plan& plan = eye.plan;
  const auto names = slotNames(plan, eye.outputs);
  std::string out = eye.name + ": ";
  if (plan.accuracy > 0.0) out += "within " + percent(plan.accuracy) + " % of every wavelength\n";
  else out += "wavelengths as its 'spectral' says; no accuracy asked for" + std::string(plan.predictedError.empty() ? ", none predicted\n" : "\n");

  if (!eye.limits.empty()) out += "  for what the scenario shows at its times, and " + eye.limits + "\n";

  if (!plan.shares.empty()) {
    out += print("\n  %-26s", "greatest part of a pixel");
    for (const auto& n : names) out += " " + padded(n, kShare, true);
    out += "\n";
  }
  for (const TermShare& s : plan.shares) {
    if (std::all_of(s.share.begin(), s.share.end(), [](double v) { return v == 0.0; })) continue;
    out += print("  %-26s", s.term.c_str());
    for (size_t i = 0; i < s.share.size(); ++i) out += " " + padded(percent(s.share[i]) + " %", std::max(kShare, names[i].size()), true);
    out += s.kept ? "  kept\n" : "  dropped: no channel would notice\n";
  }
  std::string dark;
  for (const NodeBlock& b : plan.blocks)
    for (int s : b.slots)
      if (!b.lit && plan.terms.lights) dark += (dark.empty() ? "" : ", ") + names[static_cast<size_t>(s)];
  if (!dark.empty()) out += "  no reflected light of sun or lamps in " + dark + "\n";
  if (plan.terms.streams > 0) out += print("  light scattered again     by %d streams\n", plan.streams);
  if (plan.accuracy > 0.0) out += "  shadows                   " + std::string(plan.terms.shadows ? " kept\n" : " none\n");

  size_t widest = 16;
  for (const auto& n : names) widest = std::max(widest, n.size());
  out += "\n  " + padded("channel", widest, false) + print(" %8s %12s %16s\n", "nodes", "reference", "predicted error");
  for (size_t s = 0; s < names.size(); ++s) {
    out += "  " + padded(names[s], widest, false) + print(" %8d", nodesOf(plan, s));
    if (plan.predictedError.empty()) {
      out += "\n";
      continue;
    }
    out += print(" %12d %14s %%", plan.fineCount[s], percent(plan.predictedError[s]).c_str());
    if (const double k = kelvinOf(plan, s, plan.predictedError[s], 300.0); k > 0.0 && k < 10.0) out += print("  (%.2f K of a body at 300 K)", k);
    if (plan.accuracy > 0.0 && plan.predictedError[s] > plan.accuracy) out += "  MORE THAN ASKED FOR";
    out += "\n";
  }
  if (!plan.parts.empty()) out += accountsText(plan, names);
  if (eye.camera) {
    out += "  beside it geometry, " + edgeText(*eye.camera, plan.accuracy);
    if (eye.camera->outlineAccuracy > 0.0)
      out += "; the intensity of a small body or bright part by " + percent(budget::kOutlines.of(plan.accuracy)) + " % (1 sigma)";
    out += "\n";
  }
  if (plan.lines > 0)
    out += print("\n  found on %d lines of sight that no fit has seen: at most %.2g %% of pixels lie above their largest error (95 %%)\n", plan.lines,
                 300.0 / plan.lines);
  const NodeCost cost = costOf(plan);
  out += print("\n  %s; %d nodes a subpixel with reflected light, %d without; %.3g million evaluations a frame\n",
               eye.buffered ? "buffered where something transparent is in view, else direct" : "direct", cost.lit, cost.unlit,
               1e-6 * eye.subpixels * (cost.lit + cost.unlit));
  out += print("  tables of surfaces and media: %.0f kB\n", 1e-3 * eye.tableBytes);
  if (eye.airTables)
    out += print("  tables of air: %d elevations, %d ranges, %d azimuth%s\n", plan.air.elevations, plan.air.ranges,
                 plan.terms.scatteredSun ? plan.air.azimuths : 1, plan.terms.scatteredSun && plan.air.azimuths > 1 ? "s" : "");
  if (eye.framesPerSecond > 0.0) out += print("  about %.3g frames a second on this machine\n", eye.framesPerSecond);
  if (plan.accuracy > 0.0) out += print("  planned in %.2f s\n", eye.seconds);
  return out;
}

std::string ladderText(const std::vector<Plan>& plans, double asked, double subpixels) {
  std::string out =
      print("\n  %-10s %6s %16s %18s %10s %10s %18s\n", "accuracy", "nodes", "tables of air", "places a texture", "parts of", "predicted", "million terms");
  out += print("  %-10s %6s %16s %18s %10s %10s %18s\n", "", "", "", "across x along", "intensity", "error", "a frame");
  const auto termsOf = [&](const Plan& p) { return 1e-6 * subpixels * (costOf(p).lit + costOf(p).unlit); };
  const Plan* last = nullptr;
  bool more = false;
  for (const Plan& p : plans) {
    const TextureTaps taps = tapsFor(p.textureAccuracy);
    const std::string air =
        p.air.elevations > 0 ? std::to_string(p.air.elevations) + "x" + std::to_string(p.air.ranges) + "x" + std::to_string(p.air.azimuths) : "none";
    const double worst = p.predictedError.empty() ? 0.0 : *std::max_element(p.predictedError.begin(), p.predictedError.end());
    out += print("  %-10s %6d %16s %18s", (percent(p.accuracy) + " %").c_str(), p.nodeCount(), air.c_str(),
                 (std::to_string(taps.mostAcross) + "x" + std::to_string(taps.mostAlong)).c_str());
    out += print(" %10s %10s %18.3g%s\n", (percent(budget::kOutlines.of(p.accuracy)) + " %").c_str(), (percent(worst) + " %").c_str(), termsOf(p),
                 p.accuracy == asked ? "  this plan" : "");
    if (last && p.accuracy >= asked)
      more |= p.nodeCount() < last->nodeCount() || !(p.air == last->air) || tapsFor(last->textureAccuracy).mostAcross != taps.mostAcross;
    last = &p;
  }
  if (!more) out += "  nothing is left to buy by asking less\n";
  return out;
}

std::string planJson(const PlannedEye& eye) {
  const Plan& plan = eye.plan;
  const auto names = slotNames(plan, eye.outputs);
  std::string out = "{\"name\": " + quoted(eye.name) + print(", \"accuracy\": %.9g", plan.accuracy) + ", \"terms\": [";
  for (size_t k = 0; k < plan.shares.size(); ++k) {
    const TermShare& s = plan.shares[k];
    out += std::string(k ? ", " : "") + "{\"term\": " + quoted(s.term) + ", \"kept\": " + (s.kept ? "true" : "false") + ", \"share\": {";
    for (size_t i = 0; i < s.share.size(); ++i) out += std::string(i ? ", " : "") + quoted(names[i]) + print(": %.9g", s.share[i]);
    out += "}}";
  }
  out += std::string("], \"shadows\": ") + (plan.terms.shadows ? "true" : "false") + ", \"channels\": [";
  for (size_t s = 0; s < names.size(); ++s) {
    out += std::string(s ? ", " : "") + "{\"name\": " + quoted(names[s]) + print(", \"nodes\": %d", nodesOf(plan, s));
    if (!plan.predictedError.empty()) out += print(", \"reference_wavelengths\": %d, \"predicted_error\": %.9g", plan.fineCount[s], plan.predictedError[s]);
    out += "}";
  }
  const NodeCost cost = costOf(plan);
  out += print("], \"nodes_lit\": %d, \"nodes_unlit\": %d, \"subpixels\": %.0f, \"transparent\": %s, \"planning_s\": %.4g, \"table_bytes\": %.0f", cost.lit,
               cost.unlit, eye.subpixels, eye.buffered ? "true" : "false", eye.seconds, eye.tableBytes);
  if (eye.framesPerSecond > 0.0) out += print(", \"predicted_frames_per_s\": %.4g", eye.framesPerSecond);
  if (eye.camera) out += print(", \"edges\": {\"pixel\": %.4g, \"mean_of_4x4\": %.4g}", edgeError(eye.camera->samples, 1), edgeError(eye.camera->samples, 4));
  if (!eye.limits.empty()) out += ", \"limits\": " + quoted(eye.limits);
  return out + "}";
}

}  // namespace pitviper
