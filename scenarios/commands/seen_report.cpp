#include "scenarios/commands/seen_report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "sim/frame/seen_bodies.hpp"
#include "sim/parameters/print.hpp"
#include "sim/scene/mesh_units.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// Bodies that get a line of their own; of more, those alike share one. And lines in all.
constexpr size_t kOneByOne = 20, kMostLines = 60;
/// Hidden shares below this are not told: what the places looked at can tell (96 of them).
constexpr double kHidden = 0.04;
/// Cameras x bodies beyond which only the first frame is looked at: all three would take minutes.
constexpr size_t kMostPairs = 50000;

std::string metres(double v) { return v >= 1e3 ? print("%.3g km", 1e-3 * v) : v < 0.1 && v > 0.0 ? print("%.3g mm", 1e3 * v) : print("%.3g m", v); }

std::string sizeOf(const glm::dvec3& s) {
  const double most = std::max({s.x, s.y, s.z}), scale = most >= 1e4 ? 1e-3 : most < 0.1 ? 1e3 : 1.0;
  auto side = [&](double v) { return print("%.3g", scale * v); };
  return side(s.x) + " x " + side(s.y) + " x " + side(s.z) + (scale < 1.0 ? " km" : scale > 1.0 ? " mm" : " m");
}

std::string pixels(double v) { return std::isinf(v) ? "" : v >= 9.95 ? print("%.0f", v) : print("%.2g", v); }

/// Bodies that are told of together.
struct Line {
  std::vector<size_t> bodies;
};

class Report {
 public:
  Report(const Simulation& sim, const Camera& camera) : sim_(sim), camera_(camera) {
    const int last = sim.time.frames - 1;
    const bool crowd = sim.cameras.size() * sim.entities.size() > kMostPairs;
    for (int f : {0, last / 2, last})
      if (frames_.empty() || (frames_.back() != f && !crowd)) frames_.push_back(f);
    for (int f : frames_) seen_.push_back(bodiesSeen(sim, camera, advance(sim, sim.time.at(f))));
  }

  std::string text() const {
    std::string out = "  camera " + camera_.name + ", in frame";
    for (size_t f = 0; f < frames_.size(); ++f) out += (f ? " | " : " ") + std::to_string(frames_[f]);
    out += ":\n";
    const auto lines = grouped();
    size_t nameWidth = 0, sizeWidth = 0;
    std::vector<size_t> width(frames_.size(), 0);
    std::vector<std::vector<std::string>> cells;
    for (const Line& line : lines) {
      if (cells.size() == kMostLines) break;
      std::vector<std::string> row = {nameOf(line), sizesOf(line)};
      nameWidth = std::max(nameWidth, row[0].size());
      sizeWidth = std::max(sizeWidth, row[1].size());
      for (size_t f = 0; f < frames_.size(); ++f) {
        row.push_back(cellOf(line, f));
        width[f] = std::max(width[f], row.back().size());
      }
      cells.push_back(std::move(row));
    }
    for (const auto& row : cells) {
      out += "    " + padded(row[0], nameWidth) + "  " + padded(row[1], sizeWidth) + "  ";
      for (size_t f = 0; f < frames_.size(); ++f) out += (f ? " | " : "") + (f + 1 < frames_.size() ? padded(row[2 + f], width[f]) : row[2 + f]);
      out += "\n";
    }
    if (lines.size() > kMostLines) out += "    and " + std::to_string(lines.size() - kMostLines) + " more kinds of bodies\n";
    return out;
  }

  bool seesAny() const {
    for (const auto& frame : seen_)
      if (std::any_of(frame.begin(), frame.end(), [](const BodySight& s) { return s.sight == HowSeen::InView; })) return true;
    return false;
  }

 private:
  static std::string padded(const std::string& s, size_t width) { return s + std::string(s.size() < width ? width - s.size() : 0, ' '); }
  static bool tiny(const BodySight& s) { return std::max(s.width_px, s.height_px) < 1.0; }

  std::vector<Line> grouped() const {
    std::vector<Line> lines;
    std::map<std::string, size_t> known;
    for (size_t e = 0; e < sim_.entities.size(); ++e) {
      const bool shows =
          std::any_of(seen_.begin(), seen_.end(), [&](const auto& frame) { return frame[e].sight == HowSeen::InView || frame[e].sight == HowSeen::Hidden; });
      std::string key = shows ? sizeOf(seen_[0][e].size_m) : "";
      for (const auto& frame : seen_) key += "|" + std::to_string(static_cast<int>(frame[e].sight)) + (tiny(frame[e]) ? "t" : "");
      const auto [at, fresh] = known.try_emplace(sim_.entities.size() > kOneByOne ? key : std::to_string(e), lines.size());
      if (fresh) lines.emplace_back();
      lines[at->second].bodies.push_back(e);
    }
    return lines;
  }

  std::string nameOf(const Line& line) const {
    const std::string& first = sim_.entities[line.bodies.front()].name;
    return line.bodies.size() == 1 ? first : first + " and " + std::to_string(line.bodies.size() - 1) + " more";
  }

  std::string sizesOf(const Line& line) const {
    const std::string first = sizeOf(seen_[0][line.bodies.front()].size_m);
    const bool alike = std::all_of(line.bodies.begin(), line.bodies.end(), [&](size_t e) { return sizeOf(seen_[0][e].size_m) == first; });
    return alike ? first : "of several sizes";
  }

  static std::string span(double low, double high, std::string (*text)(double)) {
    const std::string a = text(low), b = text(high);
    return a == b ? a : a + " to " + b;
  }

  std::string cellOf(const Line& line, size_t f) const {
    const BodySight& s = seen_[f][line.bodies.front()];
    double near = INFINITY, far = 0.0, least = INFINITY, most = 0.0, hidden = 0.0;
    for (size_t e : line.bodies) {
      const BodySight& b = seen_[f][e];
      near = std::min(near, b.range_m);
      far = std::max(far, b.range_m);
      least = std::min(least, std::max(b.width_px, b.height_px));
      most = std::max(most, std::max(b.width_px, b.height_px));
      hidden = std::max(hidden, b.hidden);
    }
    const std::string range = span(near, far, metres);
    auto name = [&](int e) {
      return line.bodies.size() > 1 ? std::string("others") : e < 0 ? std::string("another") : sim_.entities[static_cast<size_t>(e)].name;
    };
    switch (s.sight) {
      case HowSeen::Absent:
        return "not there";
      case HowSeen::Carrier:
        return "carries the camera";
      case HowSeen::Behind:
        return range + ", behind the camera";
      case HowSeen::OutOfView:
        return range + ", out of view";
      case HowSeen::TooNear:
        return range + ", nearer than the camera's near";
      case HowSeen::Hidden:
        return range + ", hidden by " + name(s.hiddenBy);
      case HowSeen::InView:
        break;
    }
    std::string text = range + ", ";
    if (std::isinf(most)) text += "wider than the film";
    else if (line.bodies.size() == 1) text += pixels(s.width_px) + " x " + pixels(s.height_px) + " px";
    else text += span(least, most, pixels) + " px";
    if (tiny(s)) text += ", smaller than a pixel";
    else if (s.cut && !std::isinf(most)) text += ", cut by the film's edge";
    if (hidden > kHidden) text += line.bodies.size() > 1 ? ", partly hidden" : print(", %.0f %% hidden by ", 100.0 * s.hidden) + name(s.hiddenBy);
    if (s.through >= 0 && line.bodies.size() == 1) text += ", through " + name(s.through);
    return text;
  }

  const Simulation& sim_;
  const Camera& camera_;
  std::vector<int> frames_;
  std::vector<std::vector<BodySight>> seen_;  ///< [frame][entity]
};

std::string doubts(const Simulation& sim) {
  std::string out;
  std::set<std::string> told;
  for (const Entity& e : sim.entities) {
    if (e.meshFile.empty()) continue;
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::vec3& p : e.mesh->positions) low = glm::min(low, glm::dvec3(p)), high = glm::max(high, glm::dvec3(p));
    const std::string doubt = doubtAboutUnit(high - low, e.metresPerUnit, e.meshFile);
    if (!doubt.empty() && told.insert(e.meshFile + doubt).second) out += "note: mesh of '" + e.name + "' (" + e.meshFile + ") is " + doubt + "\n";
  }
  for (const auto& m : sim.materials)
    for (const std::string& note : m->notes) out += "note: material '" + m->name + "': " + note + "\n";
  return out;
}

}  // namespace

SeenReport reportSeen(const Simulation& sim) {
  SeenReport all;
  if (sim.entities.empty()) return all;
  for (const Camera& c : sim.cameras) {
    const Report report(sim, c);
    all.text += report.text();
    if (!report.seesAny()) all.notes += "note: camera " + c.name + " sees no body in these frames\n";
  }
  all.notes += doubts(sim);
  return all;
}

}  // namespace pitviper
