#pragma once
// Sinks of pictures for people: what draws frames as pictures, once, and those who want them.
#include <memory>
#include <vector>

#include "sim/frame/frame_picture.hpp"
#include "sim/model/sink.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {

/// What is made of the pictures of a run. They come in the order of the frames, all of a camera of one size.
class PictureUser {
 public:
  virtual ~PictureUser() = default;
  virtual void take(const Frame& frame, const Rgb8Image& picture) = 0;
  virtual void finish() {}
  /// It wants the first of the layers alone: where pictures are small.
  virtual bool takesFirst() const { return false; }
  /// As of Sink.
  virtual std::filesystem::path fileOf(const std::string& camera, int number) const = 0;
};

/// A PNG for each: `<camera>_<frame>.png`.
std::unique_ptr<PictureUser> previewFiles(const SinkPlace& place);
/// UserError unless `file` is a name for a video: it ends in .mp4 and has no folder.
void readVideoName(const std::filesystem::path& file, const Location& where);
/// A video for each camera. `file`: its name where there is one camera, else with `_<camera>` before its ending; `rate_per_s`: 0 for that of the frames, or 25
/// where theirs is no video's.
std::unique_ptr<PictureUser> videoFiles(const Simulation& simulation, const SinkPlace& place, const std::string& file, double rate_per_s);
/// Some of the pictures of each camera on one sheet: `<camera>_sheet.png`.
std::unique_ptr<PictureUser> contactSheets(const SinkPlace& place);
std::string contactSheetOf(const std::string& camera);

/// Draws the pictures for its users. Where one scale is to hold for a run they are drawn when it ends, and until then frames lie in a file without a name
/// in the place's folder.
std::unique_ptr<Sink> makePictureSink(const PictureStyle& style, std::vector<std::unique_ptr<PictureUser>> users, const SinkPlace& place);

/// `scale`, `palette`, `plain`, `truth` and `ranges` of a sink of pictures, and what a user wrote of them. Errors: UserError.
std::vector<Parameter> styleParameters();
PictureStyle readStyle(const Record& record, const Simulation& simulation);
/// `run`, `frame` or `low:high`. Errors: UserError.
void readScale(const std::string& text, const Location& where, PictureStyle& style);

}  // namespace pitviper
