#include "scenarios/commands/charts/trajectory_sheet.hpp"

#include <vtkCamera.h>
#include <vtkNew.h>
#include <vtkRenderer.h>

#include <algorithm>
#include <cmath>

#include "scenarios/commands/charts/canvas.hpp"
#include "scenarios/commands/charts/space_shapes.hpp"
#include "scenarios/commands/charts/style.hpp"
#include "scenarios/commands/charts/trajectory_axes.hpp"
#include "sim/image/draw_text.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

using namespace chart_style;

constexpr int kWidth_px = 1180, kHeight_px = 780, kLegend_px = 250, kHead_px = 62;
constexpr PictureArea kArea{105.0, kHead_px + 40.0, kWidth_px - kLegend_px - 105.0 - 40.0, kHeight_px - kHead_px - 40.0 - 90.0};
constexpr double kPath_px = 1.7, kBall_px = 4.0, kShadow_px = 0.9, kDrop_px = 0.4, kSight_px = 0.7;
constexpr Rgb8 kGrey{150, 150, 150};
constexpr std::size_t kMostRows = 16;       // of the legend
constexpr std::size_t kMostPoints = 60000;  // of all tubes: more takes seconds and shows no more
/// A camera this many times farther from the bodies than they spread is left out, and said.
constexpr double kFar = 8.0;

bool finite(const glm::dvec3& p) { return std::isfinite(p.x + p.y + p.z); }

Rgb8 paler(Rgb8 c, double share) {
  const auto mix = [share](std::uint8_t v) { return static_cast<std::uint8_t>(std::lround(255.0 - (255.0 - v) * share)); };
  return {mix(c.r), mix(c.g), mix(c.b)};
}

std::string shortened(std::string name) {
  constexpr std::size_t kLongest = 26;
  if (name.size() <= kLongest) return name;
  std::size_t cut = kLongest - 1;
  while (cut > 0 && (static_cast<unsigned char>(name[cut]) & 0xC0u) == 0x80u) --cut;  // not within a letter of UTF-8
  return name.substr(0, cut) + "\u2026";
}

/// "flare_" of "flare_12".
std::string stemOf(const std::string& name) {
  const std::size_t last = name.find_last_not_of("0123456789");
  return last == name.npos ? name : name.substr(0, last + 1);
}

struct Group {
  std::string first, last;
  std::size_t count = 0;
  Rgb8 colour;
  bool isCamera = false;
};

/// A round step of time with 5 to 12 of them in a span.
double markStep(double span_s) {
  const double decade = std::pow(10.0, std::floor(std::log10(span_s)));
  for (const double f : {0.1, 0.2, 0.5, 1.0})
    if (span_s / (f * decade) <= 12.0) return f * decade;
  return decade;
}

class TrajectorySheet {
 public:
  explicit TrajectorySheet(const FlownScene& scene) : scene_(scene), view_(places(), kArea) {
    std::size_t points = 0;
    for (const FlownPath& p : scene_.paths) points += p.position_m.size();
    every_ = 1 + points / kMostPoints;
    double first = INFINITY, last = -INFINITY;
    for (const FlownPath& p : scene_.paths)
      if (!p.time_s.empty()) first = std::min(first, p.time_s.front()), last = std::max(last, p.time_s.back());
    if (last > first) step_s_ = markStep(last - first);
  }

  Rgb8Image draw() {
    Rgb8Image picture = drawnOffScreen(kWidth_px, kHeight_px, [this](vtkRenderer& renderer) { fill(renderer); });
    labels_.write(picture);
    return picture;
  }

 private:
  std::vector<glm::dvec3> places() {
    std::vector<glm::dvec3> bodies, all;
    const auto take = [&](bool cameras, std::vector<glm::dvec3>& to) {
      for (const FlownPath& p : scene_.paths)
        for (const glm::dvec3& at : p.position_m)
          if (p.isCamera == cameras && finite(at)) to.push_back(at);
    };
    take(false, bodies);
    if (bodies.empty()) take(true, bodies);
    glm::dvec3 low = bodies.front(), high = low;
    for (const glm::dvec3& p : bodies) low = glm::min(low, p), high = glm::max(high, p);
    const double reach = kFar * std::max(1.0, glm::distance(low, high));
    all = bodies;
    const auto near = [&](const glm::dvec3& p) { return glm::distance(p, glm::clamp(p, low, high)) <= reach; };
    for (const FlownPath& p : scene_.paths) {
      if (!p.isCamera) continue;
      const bool seen = std::all_of(p.position_m.begin(), p.position_m.end(), [&](const glm::dvec3& at) { return !finite(at) || near(at); });
      if (!seen) beyond_.push_back(p.name);
      else
        for (const glm::dvec3& at : p.position_m)
          if (finite(at)) all.push_back(at);
    }
    return all;
  }

  void fill(vtkRenderer& renderer) {
    look(renderer);
    addAxes(renderer, view_, labels_);
    // Closest approaches are labelled first: others make room.
    for (const FlownMeeting& m : scene_.meetings) addMeeting(renderer, m);
    for (const bool cameras : {false, true})
      for (const FlownPath& p : scene_.paths)
        if (p.isCamera == cameras && !(p.isCamera && isBeyond(p.name))) addPath(renderer, p);
    for (const FlownSight& s : scene_.sights) addSight(renderer, s);
    addHead();
    addLegend(renderer);
  }

  void look(vtkRenderer& renderer) {
    // VTK looks at the middle of the picture.
    const glm::dvec3 target = view_.inFront({0.5 * kWidth_px, 0.5 * kHeight_px}) - view_.back() * view_.reach_px(),
                     from = target + view_.back() * (3.0 * view_.reach_px());
    vtkCamera& camera = *renderer.GetActiveCamera();
    camera.ParallelProjectionOn();
    camera.SetFocalPoint(target.x, target.y, target.z);
    camera.SetPosition(from.x, from.y, from.z);
    camera.SetViewUp(view_.up().x, view_.up().y, view_.up().z);
    camera.SetParallelScale(0.5 * kHeight_px);
    camera.SetClippingRange(0.5 * view_.reach_px(), 6.0 * view_.reach_px());
  }

  bool isBeyond(const std::string& camera) const { return std::find(beyond_.begin(), beyond_.end(), camera) != beyond_.end(); }

  glm::dvec3 onFloor(glm::dvec3 p) const {
    p.z = view_.low_m().z;
    return view_.drawn(p);
  }

  Rgb8 colourOf(const FlownPath& path) {
    const std::string stem = path.isCamera ? path.name : stemOf(path.name);
    for (std::size_t i = 0; i < groups_.size(); ++i)
      if (groups_[i].isCamera == path.isCamera && (path.isCamera ? groups_[i].first : stemOf(groups_[i].first)) == stem) {
        groups_[i].last = path.name;
        ++groups_[i].count;
        return groups_[i].colour;
      }
    const auto bodies = static_cast<std::size_t>(std::count_if(groups_.begin(), groups_.end(), [](const Group& g) { return !g.isCamera; }));
    groups_.push_back({path.name, path.name, 1, path.isCamera ? kInk : seriesColour(bodies % 6), path.isCamera});  // the seventh is black, which cameras have
    return groups_.back().colour;
  }

  void addPath(vtkRenderer& renderer, const FlownPath& path) {
    const Rgb8 colour = colourOf(path);
    std::vector<SpaceLine> lines(1), shadows(1);
    std::vector<glm::dvec3> there, there_m;
    std::vector<double> times;
    for (std::size_t i = 0; i < path.position_m.size(); ++i) {
      const glm::dvec3& p = path.position_m[i];
      if (!finite(p)) {
        if (!lines.back().empty()) lines.emplace_back(), shadows.emplace_back();
        continue;
      }
      const bool isEnd = i + 1 == path.position_m.size() || !finite(path.position_m[i + 1]) || lines.back().empty();
      if (i % every_ != 0 && !isEnd) continue;
      lines.back().push_back(view_.drawn(p)), shadows.back().push_back(onFloor(p));
      there.push_back(lines.back().back()), there_m.push_back(p), times.push_back(path.time_s[i]);
    }
    if (there.empty()) return;
    double way_px = 0.0;
    for (std::size_t i = 1; i < there.size(); ++i) way_px += glm::distance(there[i - 1], there[i]);
    // Within a marker of its beginning all the time: it stands.
    if (way_px < kBall_px) {
      stand(renderer, path, there.front(), there_m.front(), colour);
      return;
    }
    addTubes(renderer, lines, path.isCamera ? 0.6 * kPath_px : kPath_px, colour, true);
    addTubes(renderer, shadows, kShadow_px, paler(colour, 0.35), false);
    const glm::dvec3 tip = there.back();
    std::size_t back = there.size() - 1;
    while (back > 0 && glm::distance(there[back], tip) < 8.0) --back;
    const double cone = isFew(path) ? 1.0 : 0.6;
    addCone(renderer, tip + cone * 6.0 * glm::normalize(tip - there[back]), tip - there[back], cone * 14.0, cone * 5.0, colour);
    mark(renderer, path, times, there_m, colour);
    if (path.isCamera) label(shortened(path.name), view_.onPicture(there_m.back()), kText_px, colour);
  }

  /// Beside a place, where it is free; else not at all.
  void label(const std::string& text, const glm::dvec2& at_px, int size_px, Rgb8 colour) {
    constexpr double kAside_px = 9.0, kOff_px = 10.0;
    for (const glm::dvec2 way : {glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, -1), glm::dvec2(-1, 1), glm::dvec2(1, 2), glm::dvec2(-1, 2),
                                 glm::dvec2(1, -2), glm::dvec2(-1, -2)})
      if (labels_.addIfFree({text, at_px + way * glm::dvec2(kAside_px, kOff_px), way.x > 0.0 ? 0.0 : 1.0, size_px, colour, false})) return;
  }

  /// Not one of a salvo, whose lines and times would be a thicket.
  bool isFew(const FlownPath& path) const {
    constexpr std::ptrdiff_t kFew = 3;
    return path.isCamera || std::count_if(scene_.paths.begin(), scene_.paths.end(),
                                          [&](const FlownPath& p) { return !p.isCamera && stemOf(p.name) == stemOf(path.name); }) <= kFew;
  }

  void stand(vtkRenderer& renderer, const FlownPath& path, const glm::dvec3& at, const glm::dvec3& at_m, Rgb8 colour) {
    addBalls(renderer, {at}, 1.3 * kBall_px, colour);
    addTubes(renderer, {{at, onFloor(at_m)}}, kDrop_px, kGrey, false);
    label(shortened(path.name), view_.onPicture(at_m), kText_px, colour);
  }

  /// Balls at equal times, lines down to the floor, and the times of the first and last.
  void mark(vtkRenderer& renderer, const FlownPath& path, const std::vector<double>& times, const std::vector<glm::dvec3>& places_m, Rgb8 colour) {
    if (!(step_s_ > 0.0)) return;
    std::vector<glm::dvec3> balls;
    std::vector<SpaceLine> drops;
    struct Mark {
      double time_s;
      glm::dvec3 at_m;
    };
    std::vector<Mark> marks;
    double next = std::ceil(times.front() / step_s_ - 1e-9) * step_s_;
    for (std::size_t i = 0; i < times.size(); ++i)
      while (times[i] >= next - 1e-9 * step_s_) {
        const double share = i == 0 || times[i] - times[i - 1] <= 0.0 ? 1.0 : std::clamp((next - times[i - 1]) / (times[i] - times[i - 1]), 0.0, 1.0);
        const glm::dvec3 at = i == 0 ? places_m[0] : glm::mix(places_m[i - 1], places_m[i], share);
        marks.push_back({next, at});
        next += step_s_;
      }
    for (const Mark& m : marks) {
      // Balls that touch tell no times.
      if (!balls.empty() && glm::distance(balls.back(), view_.drawn(m.at_m)) < 2.2 * kBall_px) continue;
      balls.push_back(view_.drawn(m.at_m));
      drops.push_back({view_.drawn(m.at_m), onFloor(m.at_m)});
    }
    addBalls(renderer, balls, path.isCamera || !isFew(path) ? 0.7 * kBall_px : kBall_px, colour);
    if (!path.isCamera && isFew(path)) addTubes(renderer, drops, kDrop_px, kGrey, false);
    for (std::size_t i = 0; i < marks.size(); ++i)
      if ((i == 0 || i + 1 == marks.size()) && isFew(path))
        label(shortNumber(std::abs(marks[i].time_s) < 1e-9 ? 0.0 : marks[i].time_s) + " s", view_.onPicture(marks[i].at_m), kText_px - 2, colour);
  }

  void addSight(vtkRenderer& renderer, const FlownSight& s) {
    if (isBeyond(s.camera)) return;
    const glm::dvec3 from = view_.drawn(s.from);
    // To what it looks at, or where it leaves the box.
    double length_m = s.length_m > 0.0 ? s.length_m : 2.0 * glm::distance(view_.low_m(), view_.high_m());
    for (int i = 0; i < 3; ++i) {
      const double side = s.along[i] > 0.0 ? view_.high_m()[i] : view_.low_m()[i], way = (side - s.from[i]) / s.along[i];
      if (std::isfinite(way) && way >= 0.0) length_m = std::min(length_m, way);
    }
    const glm::dvec3 to_m = s.from + length_m * s.along;
    const glm::dvec3 to = view_.drawn(to_m);
    // Shorter than its lens hood it would hide what it looks at.
    constexpr double kShortest_px = 24.0;
    if (glm::distance(from, to) < kShortest_px) return;
    addTubes(renderer, dashed(from, to, 6.0), kSight_px, kInk, false);
    // Open towards where it looks, as a lens hood is.
    addCone(renderer, from, from - to, 16.0, 7.0, kInk);
    const bool isNamed = std::any_of(scene_.paths.begin(), scene_.paths.end(), [&](const FlownPath& p) { return p.isCamera && p.name == s.camera; });
    if (!isNamed) label(shortened(s.camera), view_.onPicture(s.from), kText_px, kInk);
  }

  void addMeeting(vtkRenderer& renderer, const FlownMeeting& m) {
    constexpr Rgb8 kRed{190, 20, 30};
    const glm::dvec2 at = view_.onPicture(0.5 * (m.at + m.targetAt));
    const std::string text = print("%s m at %s s", shortNumber(m.distance_m).c_str(), shortNumber(m.time_s).c_str());
    const double radius = std::max(9.0, 0.5 * glm::distance(view_.onPicture(m.at), view_.onPicture(m.targetAt)) + 6.0);
    SpaceLine ring;
    constexpr int kSides = 40;
    for (int i = 0; i <= kSides; ++i)
      ring.push_back(view_.inFront(at + radius * glm::dvec2(std::cos(2.0 * kPi * i / kSides), std::sin(2.0 * kPi * i / kSides))));
    addTubes(renderer, {ring, {view_.drawn(m.at), view_.drawn(m.targetAt)}}, 0.8, kRed, false);
    for (const glm::dvec2 way : {glm::dvec2(1, -1), glm::dvec2(-1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(1, -2), glm::dvec2(-1, -2),
                                 glm::dvec2(1, 2), glm::dvec2(-1, 2)}) {
      const glm::dvec2 direction = glm::normalize(way), end = at + (radius + 26.0 * glm::length(way)) * direction;
      const PictureLabel label{text, end + glm::dvec2(direction.x > 0.0 ? 4.0 : -4.0, 0.0), direction.x > 0.0 ? 0.0 : 1.0, kText_px, kRed, true};
      if (!labels_.addIfFree(label)) continue;
      addTubes(renderer, {{view_.inFront(at + radius * direction), view_.inFront(end)}}, 0.6, kRed, false);
      return;
    }
  }

  void addHead() {
    labels_.add({shortened(scene_.title).size() < scene_.title.size() && boldFont().width(scene_.title, kTitle_px) > kWidth_px - 40 ? shortened(scene_.title)
                                                                                                                                    : scene_.title,
                 {20.0, 24.0},
                 0.0,
                 kTitle_px,
                 kInk,
                 true});
    std::string says =
        view_.exaggeration() > 1.0 ? "heights drawn " + shortNumber(view_.exaggeration()) + " times larger than ground distances" : "equal scales on all axes";
    says += ", parallel projection; floor at height " + shortNumber(view_.low_m().z) + " m";
    for (const std::string& c : beyond_) says += "; camera " + shortened(c) + " is too far away to be shown";
    labels_.add({says, {20.0, 47.0}, 0.0, kText_px, kAxis, false});
  }

  void addLegend(vtkRenderer& renderer) {
    double y = kHead_px + 24.0;
    const double x = kWidth_px - kLegend_px + 6.0, textX = x + 36.0;
    std::size_t rows = 0;
    for (const Group& g : groups_) {
      if (++rows > kMostRows) {
        labels_.add({"and " + std::to_string(groups_.size() - kMostRows) + " more", {textX, y}, 0.0, kText_px, kInk, false});
        y += 21.0;
        break;
      }
      addTubes(renderer, {{view_.inFront({x, y}), view_.inFront({x + 28.0, y})}}, g.isCamera ? 1.2 : 2.2, g.colour, false);
      std::string name = g.count == 1
                             ? shortened(g.first)
                             : shortened(g.first) + " \u2026 " + (g.last.size() > stemOf(g.last).size() ? g.last.substr(stemOf(g.last).size()) : g.last);
      if (g.count > 1) name += " (" + std::to_string(g.count) + ")";
      if (g.isCamera) name = shortened("camera " + name);
      labels_.add({name, {textX, y}, 0.0, kText_px, kInk, false});
      y += 21.0;
    }
    y += 12.0;
    const auto row = [&](const std::string& text) {
      labels_.add({text, {textX, y}, 0.0, kText_px - 1, kAxis, false});
      y += 19.0;
    };
    if (step_s_ > 0.0) {
      addBalls(renderer, {view_.inFront({x + 14.0, y})}, kBall_px, kGrey);
      row("every " + shortNumber(step_s_) + " s; cone: its end");
      addTubes(renderer, {{view_.inFront({x, y}), view_.inFront({x + 28.0, y})}}, kShadow_px, paler(kAxis, 0.5), false);
      row("shadow: straight below it");
    }
    if (!scene_.sights.empty()) {
      addTubes(renderer, dashed(view_.inFront({x, y}), view_.inFront({x + 28.0, y}), 5.0), kSight_px, kInk, false);
      row("line of sight at " + shortNumber(scene_.sights.front().time_s) + " s");
    }
    if (!scene_.meetings.empty()) {
      constexpr Rgb8 kRed{190, 20, 30};
      addTubes(renderer, {{view_.inFront({x, y}), view_.inFront({x + 28.0, y})}}, 0.8, kRed, false);
      row("closest approach");
      for (std::size_t i = 0; i < std::min<std::size_t>(scene_.meetings.size(), 6); ++i) {
        const FlownMeeting& m = scene_.meetings[i];
        row(shortened(m.body) + " \u2192 " + shortened(m.target) + ":");
        row("  " + shortNumber(m.distance_m) + " m at " + shortNumber(m.time_s) + " s");
      }
      if (scene_.meetings.size() > 6) row("and " + std::to_string(scene_.meetings.size() - 6) + " more");
    }
  }

  const FlownScene& scene_;
  std::vector<std::string> beyond_;  ///< cameras; places() finds them, so it stands before view_
  TrajectoryView view_;
  PictureLabels labels_;
  std::vector<Group> groups_;
  std::size_t every_ = 1;
  double step_s_ = 0.0;
};

}  // namespace

Rgb8Image drawTrajectorySheet(const FlownScene& scene) { return TrajectorySheet(scene).draw(); }

}  // namespace pitviper
