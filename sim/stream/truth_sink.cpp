// What is true of the targets of each camera, as tables over a run.
#include <map>

#include "sim/frame/file_owner.hpp"
#include "sim/frame/target_rows.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

class TruthSink final : public Sink {
 public:
  TruthSink(const Simulation& simulation, SinkPlace place) : place_(std::move(place)), mark_(tableMark(simulation)) {
    for (const Camera& c : simulation.cameras)
      if (c.truth.targets) texts_[c.name];
  }
  void start() override { ensureWritableFolder(place_.folder); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    const auto text = texts_.find(frame->camera);
    if (text == texts_.end() || !frame->kind.empty()) return;
    std::string& head = heads_[frame->camera];
    if (head.empty() && !frame->targets.empty()) head = targetTableHead(frame->targets);
    text->second += targetTable(*frame);
  }
  void finish(const std::function<void(double)>&) override {
    for (const auto& [camera, text] : texts_)
      writeFileAtomically(fileOf(camera), mark_ + (heads_[camera].empty() ? targetTableHead({}) : heads_[camera]) + text, place_.mayReplace);
  }
  std::vector<std::filesystem::path> filesOf(const std::string& camera, int, const std::string& kind) const override {
    if (!kind.empty() || !texts_.count(camera)) return {};
    return {fileOf(camera)};
  }

 private:
  std::filesystem::path fileOf(const std::string& camera) const { return place_.folder / (camera + "_truth.csv"); }
  SinkPlace place_;
  std::string mark_;
  std::map<std::string, std::string> texts_, heads_;  ///< by camera; what it has columns for is said by the first frame that has a row
};

}  // namespace

SinkModel truthSink() {
  return {"truth",
          "Tables `<camera>_truth.csv` of cameras whose `truth` asks for targets: a row a frame and body, plume, flare or lamp. Written without being asked "
          "for where no sinks are given.",
          {folderParameter()},
          [](const Record& r, const Simulation&) {
            return [folder = readFolder(r)](const Simulation& simulation, const SinkPlace& place) -> std::unique_ptr<Sink> {
              return std::make_unique<TruthSink>(simulation, place.below(folder));
            };
          }};
}

}  // namespace pitviper
