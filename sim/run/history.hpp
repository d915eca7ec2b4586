#pragma once
// What was flown: a row a tick and body, lamp or camera that moves, as comma-separated values, written while a run goes on.
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/frame/frame.hpp"
#include "sim/run/mover.hpp"

namespace pitviper {

/// Whether there is anything to tell: something moves by itself, or commands of the scenario move something.
bool hasHistory(const Simulation& simulation);

/// Where something was, for pictures.
struct HistoryPath {
  std::string name;
  std::string kind;  ///< "body", "light", "camera"
  std::vector<double> time_s;
  std::vector<std::optional<Pose>> poses;  ///< none: it was not there
};

/// Columns of a row: see head(). Bodies and lamps have rows where they move themselves, by the scenario or by a command (from then on); what is fixed to a
/// carrier has none; cameras have them always. Velocity, acceleration and rates of what moves as the scenario says are those of its motion (Mover); of what
/// commands have moved, and of cameras that something points, they are of the parabola through the ticks before and after: none at the first and the last. So
/// the rows of a tick are ready when the next tick is known; memory does not grow with ticks.
class History {
 public:
  /// The simulation must outlive it. `keepsPaths`: for paths(): up to 400,000 poses.
  explicit History(const Simulation& simulation, bool keepsPaths = false);
  ~History();
  History(const History&) = delete;
  History& operator=(const History&) = delete;
  /// The first line, with its end.
  static std::string head();
  /// A camera's frame: ticks in rising order, each of the world as the camera saw it; `pose`: where it looked.
  void look(const Camera& camera, const Frame& frame, const WorldState& world, const Pose& pose);
  /// A tick without cameras.
  void look(int frame, const WorldState& world);
  /// Rows that have become ready since it was asked last.
  std::string take();
  /// No tick follows: take() gives the rest.
  void finish();
  /// Of all that has rows, from the first tick to the last: at 400 times at least where its motion is known, else at ticks (every second, fourth ... of many).
  std::vector<HistoryPath> paths() const;
  /// Where a camera was and looked at a time, the nearest kept tick's where that is not known from its motion; none: there is none of that name, or no tick.
  std::optional<Pose> cameraPoseAt(const std::string& name, double time_s) const;

 private:
  struct Thing;
  struct Sample;
  struct Tick;
  void begin(int frame, const WorldState& world);
  void close();
  void write(const Tick* before, const Tick& now, const Tick* after);
  void row(std::size_t thing, const Tick* before, const Tick& now, const Tick* after);
  void keep(const Tick& tick);
  const WorldState& scenarios(double time_s);

  const Simulation& simulation_;
  Simulation moving_;  ///< what moves of it, by the scenario alone
  std::vector<Thing> things_;
  std::unique_ptr<Tick> before_, now_, open_;
  std::string lines_;
  std::map<double, WorldState> worlds_;  ///< of moving_ around one tick
  bool keepsPaths_;
  std::vector<Tick> kept_;  ///< every keepEvery_th
  std::size_t keepEvery_ = 1, ticks_ = 0;
  double first_s_ = 0.0, last_s_ = 0.0;
};

}  // namespace pitviper
