#pragma once
// Frames as pictures for people.
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "sim/frame/frame.hpp"
#include "sim/image/preview.hpp"

namespace pitviper {

/// Ends of the colour bar by layer name, in the layer's unit.
using PreviewRanges = std::map<std::string, std::pair<double, double>>;
/// Scales by layer name.
using LayerScales = std::map<std::string, PictureScale>;

struct PictureStyle {
  PreviewRanges ranges = {};                                    ///< of some layers; they come before everything
  std::optional<std::pair<double, double>> range = {};          ///< of all layers
  bool ownScale = false;                                        ///< each frame chooses its own scales, not the run
  std::string palette = "auto";                                 ///< a name of colour_map.hpp; auto: thermal, grey for what eyes see
  bool plain = false;                                           ///< the pixels alone, one to one
  bool truth = false;                                           ///< truth layers too
  bool needsScales() const { return !ownScale && !range; }
};

/// The layers that a picture shows: those of its channels (of an eye's three one), and truth where that is asked for.
std::vector<const FrameLayer*> shownLayers(const Frame& frame, const PictureStyle& style);
/// Ends of a layer that is made for a screen, from black to white: codes are shown as they are, not stretched again. None: others.
std::optional<std::pair<double, double>> screenEnds(const FrameLayer& layer);
/// What a layer's scale is made of: its values, or what a screen shows of an eye's.
std::vector<float> scaledValues(const Frame& frame, const FrameLayer& layer);
/// The layers side by side, each with colour bar and unit; or the first of them. Layers that neither `style` nor `scales` have a scale for choose their own.
Rgb8Image pictureOf(const Frame& frame, const PictureStyle& style = {}, const LayerScales& scales = {}, bool firstAlone = false);
/// What a picture's file says whose it is.
std::map<std::string, std::string> pictureTexts(const Frame& frame);
/// One PNG. `mayReplace`: as of writeFileAtomically. Errors: OutputError.
void writePreviewFile(const std::filesystem::path& file, const Frame& frame, const PictureStyle& style = {}, const MayReplace& mayReplace = {});

}  // namespace pitviper
