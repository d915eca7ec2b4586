#pragma once
// The sinks of a run: those of the scenario, and what the command line asks for besides; and what they may not write.
#include <memory>
#include <vector>

#include "scenarios/commands/scenario_wish.hpp"
#include "sim/model/simulation.hpp"
#include "sim/run/run.hpp"
#include "sim/stream/picture_sink.hpp"

namespace pitviper {

/// A sink and where it was asked for.
struct PlacedSink {
  std::unique_ptr<Sink> sink;
  Location where;
};

/// What the command line asks for of pictures.
struct PictureWish {
  PictureStyle style = {.ownScale = true};
  bool previews = false, sheet = false, scaled = false, coloured = false;
  std::string video = {};                ///< name of its file; empty: none
  std::vector<std::string> ranges = {};  ///< "layer=low:high"
  bool any() const { return previews || sheet || !video.empty(); }
  /// What the words mean together, and of this scenario's layers. Errors: UserError.
  void settle(const Simulation& simulation);
};

/// What `run` and `stream` draw.
struct DrawWish {
  ScenarioWish scenario;
  std::string out;  ///< empty: not said
  std::vector<std::string> plans, poses;
  bool overwrites = false;
  PictureWish pictures;
  /// The scenario, with plans and poses given. Errors: UserError.
  Simulation read() const;
};
std::vector<Option> drawOptions(DrawWish& wish);

/// Those of the scenario, or files; and the pictures wished for.
std::vector<PlacedSink> makeSinks(const Simulation& simulation, const SinkPlace& place, const PictureWish& pictures);
/// The pictures wished for alone.
std::vector<PlacedSink> makePictures(const Simulation& simulation, const SinkPlace& place, const PictureWish& pictures);

/// Files that a run writes besides its sinks'.
using OwnFiles = std::vector<std::filesystem::path>;
/// Before any work: every file has one writer, and no folder of one is a file of another. Errors: UserError.
void refuseClashes(const Simulation& simulation, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks);
/// Nor may any be of another scenario. Errors: UserError.
void refuseForeignFiles(const Simulation& simulation, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks);

}  // namespace pitviper
