// Every frame as a picture for people.
#include "sim/image/png.hpp"
#include "sim/stream/picture_sink.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

class PreviewFiles final : public PictureUser {
 public:
  explicit PreviewFiles(SinkPlace place) : place_(std::move(place)) {}
  void take(const Frame& frame, const Rgb8Image& picture) override {
    writePng(fileOf(frame.camera, frame.number), picture, pictureTexts(frame), place_.mayReplace);
  }
  std::filesystem::path fileOf(const std::string& camera, int number) const override { return place_.folder / (frameFileStem(camera, number, "") + ".png"); }

 private:
  SinkPlace place_;
};

}  // namespace

std::unique_ptr<PictureUser> previewFiles(const SinkPlace& place) { return std::make_unique<PreviewFiles>(place); }

SinkModel previewsSink() {
  std::vector<Parameter> parameters = styleParameters();
  parameters.insert(parameters.begin(), folderParameter());
  return {"previews", "Every frame as a PNG with a colour bar: its channels side by side.", parameters, [](const Record& r, const Simulation& sim) {
            return [folder = readFolder(r), style = readStyle(r, sim)](const Simulation&, const SinkPlace& run) {
              const SinkPlace place = run.below(folder);
              std::vector<std::unique_ptr<PictureUser>> users;
              users.push_back(previewFiles(place));
              return makePictureSink(style, std::move(users), place);
            };
          }};
}

}  // namespace pitviper
