#pragma once
// What a run has to say of a scenario and its frames, for people.
#include <set>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

class Notes {
 public:
  /// A line "note: ..." on stderr, kept.
  void say(const std::string& text);
  const std::vector<std::string>& all() const { return all_; }

 private:
  std::vector<std::string> all_;
};

/// One line for each camera whose wavelengths miss the bands of a gas, or the fringes of a film, by more than a per cent.
void noteSampling(const Simulation& simulation, Notes& notes);
/// One line where the air is haze as thick as fog.
void noteFog(const Simulation& simulation, Notes& notes);
/// One line for each channel in which fringes of a material are averaged.
void noteFringes(const Simulation& simulation, Notes& notes);
/// One line for each camera that begins with part of a body nearer than it draws: a dome in front of it, for instance.
void noteNear(const Simulation& simulation, double time_s, Notes& notes);
/// What is to be said of a scenario before it is drawn: what meshes had that was mended, responses that end where the scene has no data, fog and fringes.
void noteScenario(const Simulation& simulation, Notes& notes);

/// What frames say of themselves, each thing once.
class FrameNotes {
 public:
  explicit FrameNotes(Notes& notes) : notes_(notes) {}
  void look(const Frame& frame);

 private:
  void limits(const Frame& frame);
  void saturation(const Frame& frame);
  Notes& notes_;
  std::set<std::string> told_;
};

}  // namespace pitviper
