#include "scenarios/commands/run_notes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sim/frame/mark_header.hpp"
#include "sim/parameters/print.hpp"
#include "sim/plan/averaged_fringes.hpp"
#include "sim/plan/plan.hpp"
#include "sim/plan/sampling_check.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/world/haze_not_fog.hpp"
#include "sim/world/sun_legs.hpp"
#include "sim/world/world.hpp"

namespace pitviper {
namespace {

/// What meshes from files had that was mended, and where they lie far from their file's origin: once a file.
void noteMeshes(const Simulation& sim, Notes& notes) {
  std::set<std::string> told;
  for (const Entity& e : sim.entities) {
    const auto say = [&](const std::string& note) {
      if (told.insert(e.meshFile + note).second) notes.say("mesh of '" + e.name + "' (" + e.meshFile + "): " + note);
    };
    for (const std::string& note : e.mesh->notes) say(note);
    if (const glm::dvec3& o = e.mesh->offset_m; o != glm::dvec3(0.0))
      say(print(
          "it lies about (%.10g, %.10g, %.10g) m forward, left and up of its file's origin, and is held from there, in double precision; 'position' places "
          "the file's origin, about which it turns",
          o.x, o.y, o.z));
  }
}

/// One line for each channel whose response ends before its own end, where the scene has no data.
void noteCuts(const Simulation& sim, Notes& notes) {
  std::set<std::string> told;
  auto note = [&](const std::string& owner, const std::vector<ChannelOutput>& outputs) {
    for (const ChannelOutput& o : outputs)
      if (!o.cut.empty() && told.insert(owner + o.channel).second) notes.say(print("%s, channel '%s': %s", owner.c_str(), o.channel.c_str(), o.cut.c_str()));
  };
  for (const Camera& c : sim.cameras) note("camera " + c.name, c.outputs);
  for (const Probe& p : sim.probes) note("probe " + p.name, p.outputs);
}

}  // namespace

void Notes::say(const std::string& text) {
  std::fprintf(stderr, "note: %s\n", text.c_str());
  all_.push_back(text);
}

void noteSampling(const Simulation& sim, Notes& said) {
  for (const Camera& c : sim.cameras) {
    if (c.spectral.reference || c.spectral.accuracy > 0.0) continue;  // planned for the gas
    const Plan plan = makePlan(sim, c.outputs, c.spectral, c.where);
    if (const auto fringes = checkFringes(sim, plan, c.outputs, 0.01); !fringes.empty())
      said.say(print("camera %s: %d spectral samples are %.2g %% off for the fringes of '%s' in channel %s; ask for an 'accuracy', or raise spectral.samples%s",
                     c.name.c_str(), c.spectral.samples, 100.0 * fringes.front().error, fringes.front().material.c_str(), fringes.front().channel.c_str(),
                     fringes.size() > 1 ? " (the worst of several)" : ""));
    const auto notes = checkSampling(sim, plan, c.outputs, 0.01);
    if (notes.empty()) continue;
    const SamplingNote& n = notes.front();
    said.say(
        print("camera %s: %d spectral samples are %.2g %% off for the emission of %.2g m of '%s' in channel %s; raise spectral.samples, such as "
              "{samples: 64, spacing: even}%s",
              c.name.c_str(), c.spectral.samples, 100.0 * n.error, n.thickness_m, n.medium.c_str(), n.channel.c_str(),
              notes.size() > 1 ? " (the worst of several)" : ""));
  }
}

void noteFog(const Simulation& sim, Notes& said) {
  if (const std::string words = hazeNotFog(sim); !words.empty()) said.say(words);
}

/// Scenes that stand on high ground are easily left in the air above it.
void noteGround(const Simulation& sim, Notes& said) {
  constexpr double kLow_m = 30.0, kHigh_m = 5000.0;
  const double origin_m = sim.frame.origin().height_m;
  if (sim.ground && sim.frame.ground_m() == 0.0 && origin_m > kLow_m && origin_m <= kHigh_m)
    said.say(
        print("the ground, and the haze on it, lie at the height of the sea, %g m below the origin; for a scene that stands on it write 'ground: {height: %g "
              "m}'",
              origin_m, origin_m));
}

/// A light that does not rise is easily taken for one that is missing.
void noteSun(const Simulation& sim, Notes& said) {
  constexpr double kDisc_deg = 0.3;
  if (!sim.sun) return;
  const double elevation_deg = std::asin(std::clamp(sim.sun->toSun.z, -1.0, 1.0)) * 180.0 / kPi;
  if (elevation_deg < -kDisc_deg && (sim.ground || (sim.air && sim.air->top_m() < physics::kFar)))
    said.say(print("the sun (or the moon that stands for it) is %.1f degrees below the horizon of the origin: %s", -elevation_deg,
                   sim.sun->toSun.z < kNight ? "it lights nothing" : "it lights high air alone"));
}

void noteFringes(const Simulation& sim, Notes& said) {
  const auto say = [&](const std::string& owner, const std::vector<ChannelOutput>& outputs) {
    for (const AveragedFringes& f : averagedFringes(sim, outputs)) said.say(owner + ", channel " + f.channel + ": " + wordsOf(f));
  };
  for (const Camera& c : sim.cameras) say("camera " + c.name, c.outputs);
  for (const Probe& p : sim.probes) say("probe " + p.name, p.outputs);
}

void noteNear(const Simulation& sim, double time_s, Notes& notes) {
  const WorldState state = advance(sim, time_s);
  for (const Camera& c : sim.cameras) {
    const glm::dvec3 eye = cameraAt(c, state).pose.position;
    for (size_t e = 0; e < sim.entities.size(); ++e) {
      const Entity& body = sim.entities[e];
      const Pose& pose = state.entities[e];
      const glm::dvec3 centre = pose.position + pose.orientation * glm::dvec3(body.boundingCentre);
      if (static_cast<int>(e) == c.mount.carrier || !state.isThere(e) || sim.mediumOf(body) ||
          glm::length(eye - centre) > static_cast<double>(body.boundingRadius_m) + c.near_m)
        continue;
      const glm::dvec3 at = glm::inverse(pose.orientation) * (eye - pose.position);
      double nearest = INFINITY;
      for (const glm::vec3& p : body.mesh->positions) nearest = std::min(nearest, glm::length(glm::dvec3(p) - at));
      if (nearest >= c.near_m) continue;
      notes.say(print("camera %s: part of '%s' is %.2g m away, nearer than its near (%.2g m), and is not drawn; set near: %.1g mm", c.name.c_str(),
                      body.name.c_str(), nearest, c.near_m, std::max(1e3 * nearest / 10.0, 0.1)));
    }
  }
}

void noteScenario(const Simulation& sim, Notes& notes) {
  noteMeshes(sim, notes);
  noteCuts(sim, notes);
  noteFog(sim, notes);
  noteGround(sim, notes);
  noteSun(sim, notes);
  noteFringes(sim, notes);
}

/// Once a run: what the plan was not made for.
void FrameNotes::limits(const Frame& f) {
  for (const auto& a : f.attributes)
    if (a.name == "pitviper.outside_limits" && told_.insert("limits").second)
      notes_.say(print("camera %s, frame %d is outside the scenario's limits: %s; pixels may be off by more than the accuracy asked for", f.camera.c_str(),
                       f.number, std::get<std::string>(a.value).c_str()));
}

/// Once per camera and channel, and again for its first frame that is full as a whole: pixels whose counts say nothing.
void FrameNotes::saturation(const Frame& f) {
  const int all = f.width * f.height;
  for (const auto& [channel, tally] : markTallies(f)) {
    const std::string key = f.camera + "/" + channel + "/";
    const bool whole = tally.full + tally.bad >= all && tally.full > 0;
    const auto part = [all](int pixels) { return print("%d of %d pixels (%.3g %%)", pixels, all, 100.0 * pixels / all); };
    if (whole ? told_.insert(key + "whole").second : tally.full > 0 && told_.insert(key + "full").second)
      notes_.say(
          print("camera %s, channel %s, frame %d: %s full (the well, or the converter's highest code): their counts say only that there is at least so much "
                "light, and temperatures "
                "and signals to noise are no numbers there; shorten 'exposure', or raise 'full_well' or lower 'gain' of the detector",
                f.camera.c_str(), channel.c_str(), f.number, whole ? "the whole picture is" : (part(tally.full) + (tally.full == 1 ? " is" : " are")).c_str()));
    if (tally.lowest > 0 && told_.insert(key + "lowest").second)
      notes_.say(
          print("camera %s, channel %s, frame %d: %s at the converter's lowest code: their counts say only that there is at most so much light; give the "
                "detector an 'offset', or lengthen "
                "'exposure'",
                f.camera.c_str(), channel.c_str(), f.number, (part(tally.lowest) + (tally.lowest == 1 ? " is" : " are")).c_str()));
  }
}

void FrameNotes::look(const Frame& frame) {
  saturation(frame);
  limits(frame);
}

}  // namespace pitviper
