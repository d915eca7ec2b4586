// Every frame as an EXR file.
#include "sim/frame/frame_files.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

class FilesSink final : public Sink {
 public:
  FilesSink(SinkPlace place, ExrCompression compression) : place_(std::move(place)), compression_(compression) {}
  void start() override { ensureWritableFolder(place_.folder); }
  void take(const std::shared_ptr<const Frame>& frame) override { writeFrame(place_.folder, *frame, place_.mayReplace, compression_); }
  std::filesystem::path fileOf(const std::string& camera, int number, const std::string& kind) const override {
    return place_.folder / (frameFileStem(camera, number, kind) + ".exr");
  }

 private:
  SinkPlace place_;
  ExrCompression compression_;
};

}  // namespace

SinkModel filesSink() {
  return {"files",
          "Every frame as an EXR file, `<camera>_<frame>.exr`, with all its layers. This is what a run writes where no sink is given.",
          {folderParameter(),
           withDefault(choice("compression", {"none", "zip"}, "without loss: a fifth to two fifths less room, and twenty times as long to write"), "none")},
          [](const Record& r, const Simulation&) {
            const auto compression = r.text("compression") == "zip" ? ExrCompression::Zip : ExrCompression::None;
            return [folder = readFolder(r), compression](const Simulation&, const SinkPlace& place) -> std::unique_ptr<Sink> {
              return std::make_unique<FilesSink>(place.below(folder), compression);
            };
          }};
}

}  // namespace pitviper
