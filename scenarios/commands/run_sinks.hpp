#pragma once
// The sinks of a run: those of the scenario, and what the command line asks for besides; and what they may not write.
#include <memory>
#include <vector>

#include "scenarios/commands/options.hpp"
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
  PictureStyle style;
  bool previews = false, sheet = false;
  std::string video;  ///< name of its file; empty: none
  bool any() const { return previews || sheet || !video.empty(); }
};

/// Options of pictures, for a command's list.
std::vector<OptionSpec> pictureOptions();
/// What they say. Errors: UserError.
PictureWish readPictureWish(const Options& options, const Simulation& simulation);

/// Those of the scenario, or files; and the pictures wished for.
std::vector<PlacedSink> makeSinks(const Simulation& simulation, const SinkPlace& place, const PictureWish& pictures);
/// The pictures wished for alone.
std::vector<PlacedSink> makePictures(const Simulation& simulation, const SinkPlace& place, const PictureWish& pictures);
/// `--plan FILE`: each is the plan of the camera that it is named after. Errors: UserError.
void readPlans(const Options& options, Simulation& simulation);

/// Files that a run writes besides its sinks'.
using OwnFiles = std::vector<std::filesystem::path>;
/// Before any work: every file has one writer, and no folder of one is a file of another. Errors: UserError.
void refuseClashes(const Simulation& simulation, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks);
/// Nor may any be of another scenario. Errors: UserError.
void refuseForeignFiles(const Simulation& simulation, const RunRange& range, const OwnFiles& own, const std::vector<PlacedSink>& sinks);

}  // namespace pitviper
