// A run as a video.
#include "sim/frame/file_owner.hpp"
#include "sim/image/video.hpp"
#include "sim/model/simulation.hpp"
#include "sim/stream/picture_sink.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

/// What players play; a camera of another rate is shown at 25 pictures a second.
constexpr double kSlowest_per_s = 1.0, kFastest_per_s = 120.0, kOtherwise_per_s = 25.0;

class VideoFiles final : public PictureUser {
 public:
  VideoFiles(const Simulation& sim, SinkPlace place, std::filesystem::path file, double rate_per_s)
      : place_(std::move(place)), file_(std::move(file)), rate_per_s_(rate_per_s), comment_(ownerMark(sim)), alone_(sim.cameras.size() == 1) {
    const double own = 1.0 / sim.time.step_s;
    if (rate_per_s_ <= 0.0) rate_per_s_ = own >= kSlowest_per_s && own <= kFastest_per_s ? own : kOtherwise_per_s;
  }
  void take(const Frame& frame, const Rgb8Image& picture) override {
    auto& writer = writers_[frame.camera];
    if (!writer) writer = std::make_unique<VideoWriter>(fileOf(frame.camera, 0), rate_per_s_, comment_, place_.mayReplace);
    writer->add(picture);
  }
  void finish() override {
    for (const auto& [camera, writer] : writers_) writer->finish();
  }
  std::filesystem::path fileOf(const std::string& camera, int) const override {
    return place_.folder / file_.parent_path() / (file_.stem().string() + (alone_ ? "" : "_" + camera) + file_.extension().string());
  }

 private:
  SinkPlace place_;
  std::filesystem::path file_;
  double rate_per_s_;
  std::string comment_;
  bool alone_;
  std::map<std::string, std::unique_ptr<VideoWriter>> writers_;  ///< by camera
};

}  // namespace

void readVideoName(const std::filesystem::path& file, const Location& where) {
  if (file.extension() != ".mp4" || file.has_parent_path() || file.stem().empty())
    throw UserError(where, "'" + file.string() + "' is no name of a video", "a name that ends in .mp4, without a folder", "write 'video.mp4'");
}

std::unique_ptr<PictureUser> videoFiles(const Simulation& simulation, const SinkPlace& place, const std::string& file, double rate_per_s) {
  return std::make_unique<VideoFiles>(simulation, place, file, rate_per_s);
}

SinkModel videoSink() {
  std::vector<Parameter> parameters = styleParameters();
  parameters.insert(
      parameters.begin(),
      {folderParameter(), withDefault(text("file", "its name, which ends in .mp4; of several cameras with `_<camera>` in it"), "video.mp4"),
       within(above(number("rate", "Hz", "pictures a second; unless given that of the frames, or 25 where players have no such rate"), 0.0), 0.0, 1000.0)});
  return {"video", "The run as a video (H.264 in MP4, by ffmpeg) of its previews; of each camera one.", parameters, [](const Record& r, const Simulation& sim) {
            const std::filesystem::path file = r.text("file");
            readVideoName(file, r.where("file"));
            return [folder = readFolder(r), style = readStyle(r, sim), file, rate = r.given("rate") ? r.number("rate") : 0.0](const Simulation& whole,
                                                                                                                          const SinkPlace& run) {
              const SinkPlace place = run.below(folder);
              std::vector<std::unique_ptr<PictureUser>> users;
              users.push_back(videoFiles(whole, place, file.string(), rate));
              return makePictureSink(style, std::move(users), place);
            };
          }};
}

}  // namespace pitviper
