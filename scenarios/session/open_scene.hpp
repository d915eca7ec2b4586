#pragma once
// A scenario that is open: read once, drawn when asked, its keys changed and its world commanded between two pictures.
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "scenarios/session/expected_worlds.hpp"
#include "scenarios/session/gl_thread.hpp"
#include "scenarios/session/scene_source.hpp"
#include "sim/camera/audit.hpp"
#include "sim/frame/frame.hpp"
#include "sim/frame/pixel_parts.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {

struct DrawnFrame {
  std::shared_ptr<Frame> frame;
  bool isDraft = false;
  bool isOutsideLimits = false;
  std::vector<double> predicted;  ///< relative, per output: what its plan expects to be off by at most; empty: nobody knows
  AuditTally audit;               ///< where it was audited
};

struct DrawWish {
  std::size_t camera = 0;
  double time_s = 0.0;
  bool draft = false;       ///< at once, by few groups, where the plan takes seconds; that is made beside, for a later picture
  std::uint64_t noise = 0;  ///< another draw of the detector's noise; 0: the scenario's own
  bool audited = false;     ///< some pixels are worked out by the reference too
};

/// Called on the caller's thread now and then while something takes long: the share of a plan that is made. True: it is given up (SceneInterrupted).
using SceneProgress = std::function<bool(double share)>;
struct SceneInterrupted {};

/// All calls on any thread, one at a time: a second one meanwhile is a UserError. So is every call after close().
class OpenScene {
 public:
  /// Reads it. Errors: UserError.
  explicit OpenScene(SceneSource source);
  ~OpenScene();
  OpenScene(const OpenScene&) = delete;
  OpenScene& operator=(const OpenScene&) = delete;
  /// The thread, its context and all that was drawn go.
  void close();
  bool isClosed() const { return !thread_; }

  // What it is now; changes make others. On any thread, while others draw or change it too.
  SceneSource source() const;
  std::shared_ptr<const ExpandedScenario> expanded() const;
  std::shared_ptr<const Simulation> simulation() const;
  /// Reads it anew with other keys ("path=value"); what was commanded holds on. Errors: UserError, and then nothing has changed.
  void change(std::vector<std::string> sets);
  /// What it is now is what later changes are held against, not each other: a picture does not depend on those before. What has been drawn with other keys than
  /// a world holds is kept too, as far as that may be.
  void keepDrawings();
  /// Plans from here on are made for these variations too ("path=value" each, besides what is set), at a time: within the scenario's limits pictures between
  /// them need no plan of their own. Errors: UserError of the first that cannot be read.
  void expect(const std::vector<std::vector<std::string>>& variations, double time_s);

  /// A command with the words of a scenario's `commands`, from `time_s` on. Errors: UserError.
  void command(const Value& words, double time_s);
  void forgetCommands();
  /// The world at a time, commands in it.
  WorldState world(double time_s);

  DrawnFrame draw(const DrawWish& wish, const SceneProgress& progress = {});
  /// Of a camera, as its next picture is drawn; made where there is none.
  Plan plan(std::size_t camera, const SceneProgress& progress = {});
  /// Whether a picture of a time waits for no plan.
  bool isPlanned(std::size_t camera, double time_s);
  PixelParts parts(std::size_t camera, double time_s, int column, int row);
  PixelSpectrum spectrum(std::size_t camera, double time_s, int column, int row, double low_um, double high_um, int bins);

 private:
  class Use;
  struct Desk;
  struct Told;
  std::shared_ptr<World> worldAt(int frame) const;
  /// Around a frame, with the commands that there are by then; without one of whatever time is asked for.
  StateAt stateAt(std::optional<int> frame = {}) const;
  template <class Work>
  auto onDesk(Work&& work, const SceneProgress& progress = {});

  SceneSource source_;
  std::shared_ptr<const ExpandedScenario> expanded_;
  std::shared_ptr<const Simulation> simulation_;
  struct Commanded {
    Value words;
    double time_s;
    int tick;
  };
  std::vector<Commanded> commands_;                                     ///< ticks rise
  std::shared_ptr<World> commanded_;                                    ///< with all of them; null: nothing was commanded
  mutable std::pair<int, std::shared_ptr<World>> before_{-1, nullptr};  ///< with those up to a tick
  std::shared_ptr<const Simulation> kept_;                              ///< of keepDrawings(); null: it was not called
  std::shared_ptr<const ExpandedScenario> keptExpanded_;
  std::vector<ExpectedWorld> expected_;
  mutable std::mutex state_;  ///< of what it is now
  std::mutex inUse_;
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<Desk> desk_;  ///< of that thread
};

}  // namespace pitviper
