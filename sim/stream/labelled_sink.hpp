#pragma once
// Sinks of pictures with labels for training detectors: what they have in common, and what each format does by itself.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/stream/body_masks.hpp"
#include "sim/stream/data_set_files.hpp"
#include "sim/stream/label_classes.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {

/// A frame, and what is seen in it of bodies that have a class.
struct LabelledFrame {
  const Frame& frame;
  std::string stem;               ///< of its files
  std::string part;               ///< of the split; empty: there is none
  std::filesystem::path picture;  ///< its file's name, below the data set's folder
  const std::vector<BodyMask>& bodies;
};

/// How labels are written.
class LabelFormat {
 public:
  virtual ~LabelFormat() = default;
  /// Where files of a kind lie, below the data set's folder: "images", "masks".
  virtual std::filesystem::path folderOf(const std::string& kind, const std::string& part) const = 0;
  /// Kinds of its own files, besides these.
  virtual std::vector<std::string> kinds() const = 0;
  /// Files of its own of a frame, and of the whole, those that say whose they are.
  virtual std::vector<std::filesystem::path> filesOf(const std::string& stem, const std::string& part) const = 0;
  virtual std::vector<std::filesystem::path> files() const = 0;
  /// Those of the whole that cannot say whose they are.
  virtual std::vector<std::filesystem::path> besides() const { return {}; }
  /// Before the frame's picture is written.
  virtual void take(const LabelledFrame& labelled, DataSetFiles& files) = 0;
  /// After the last picture.
  virtual void finish(DataSetFiles& files) = 0;
};

enum class MaskFiles { None, Png, Tiff };

/// What a user wrote of a sink of labelled pictures.
struct LabelWishes {
  std::filesystem::path folder;
  std::vector<std::string> cameras;  ///< that it takes
  std::string layer;                 ///< of its pictures; empty: each camera's first
  int depth_bits = 16;
  std::optional<std::pair<double, double>> scale;  ///< of the layer, in its unit
  ClassWishes classes;
  DataSplit split;
  MaskFiles masks = MaskFiles::None;
};

/// Keys of such a sink. `depth`: of its pictures unless given.
std::vector<Parameter> labelParameters(const char* depth);
/// `truth`: words of a camera's `truth` that the sink needs. Errors: UserError.
LabelWishes readLabelWishes(const Record& record, const Simulation& simulation, const std::vector<std::string>& truth);

/// `cameras` of a sink that does not take all: the key, and what a user wrote. Errors: UserError where it names none that is there.
Parameter camerasParameter();
std::vector<std::string> readCameraNames(const Record& record, const Simulation& simulation);

using MakeLabelFormat =
    std::function<std::unique_ptr<LabelFormat>(const LabelClasses& classes, const DataSplit& split, const std::vector<std::string>& cameras)>;
std::unique_ptr<Sink> makeLabelledSink(const std::string& name, const LabelWishes& wishes, const Simulation& simulation, const SinkPlace& place,
                                       const MakeLabelFormat& format);

}  // namespace pitviper
