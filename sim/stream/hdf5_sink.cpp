// A run's frames as datasets of an HDF5 file, a camera a file.
#include <algorithm>
#include <cerrno>
#include <random>

#include "sim/frame/file_owner.hpp"
#include "sim/frame/version.hpp"
#include "sim/parameters/print.hpp"
#include "sim/stream/data_set_files.hpp"
#include "sim/stream/hdf5/open_hdf5_frames.hpp"
#include "sim/stream/labelled_sink.hpp"

namespace pitviper {
namespace {

/// A file that a library writes by its name, which it has when it is whole. Its name until then is one that removeAbandonedTemporaries() knows; the library's
/// lock tells that its writer is alive.
class PartialFile {
 public:
  explicit PartialFile(std::filesystem::path target) : target_(std::move(target)) {
    std::random_device device;
    partial_ = target_.parent_path() / ("." + target_.filename().string() + print(".%08x%08x.partial", device(), device()));
  }
  PartialFile(const PartialFile&) = delete;
  PartialFile& operator=(const PartialFile&) = delete;
  ~PartialFile() {
    std::error_code ignored;
    if (!kept_) std::filesystem::remove(partial_, ignored);
  }
  const std::filesystem::path& partial() const { return partial_; }
  const std::filesystem::path& target() const { return target_; }
  void keep(const MayReplace& mayReplace) {
    std::error_code failure;
    if (mayReplace && std::filesystem::exists(std::filesystem::symlink_status(target_, failure))) mayReplace(target_);
    std::filesystem::rename(partial_, target_, failure);
    if (failure) throw OutputError(target_, "cannot rename the finished file", failure.value());
    kept_ = true;
  }

 private:
  std::filesystem::path target_, partial_;
  bool kept_ = false;
};

/// A number of a row of the truth.
struct RowColumn {
  std::string name, unit;
  std::function<double(const TargetRow&)> value;  ///< NaN where the row has none
};

std::vector<RowColumn> rowColumns(const std::vector<TargetRow::Channel>& channels) {
  std::vector<RowColumn> columns;
  const auto add = [&](const char* name, const char* unit, double TargetRow::*member) {
    columns.push_back({name, unit, [member](const TargetRow& r) { return r.*member; }});
  };
  add("column", "px", &TargetRow::column), add("row", "px", &TargetRow::row);
  add("left", "px", &TargetRow::left), add("top", "px", &TargetRow::top), add("right", "px", &TargetRow::right), add("bottom", "px", &TargetRow::bottom);
  add("range", "m", &TargetRow::range_m), add("range_rate", "m/s", &TargetRow::rangeRate_m_s);
  add("sight_right", "rad/s", &TargetRow::sightRight_rad_s), add("sight_up", "rad/s", &TargetRow::sightUp_rad_s);
  add("visible", "1", &TargetRow::visible);
  for (const TargetRow::Channel& channel : channels) {
    const auto addOf = [&](const char* name, const std::string& unit, const std::function<double(const TargetRow::Channel&)>& value) {
      columns.push_back({channel.channel + "." + name, unit, [own = channel.channel, value](const TargetRow& r) {
                           for (const TargetRow::Channel& c : r.channels)
                             if (c.channel == own) return value(c);
                           return static_cast<double>(NAN);
                         }});
    };
    addOf("own", channel.unit, [](const TargetRow::Channel& c) { return c.own; });
    addOf("total", channel.unit, [](const TargetRow::Channel& c) { return c.total; });
    addOf("contrast", channel.unit, [](const TargetRow::Channel& c) { return c.contrast; });
    addOf("snr", "1", [](const TargetRow::Channel& c) { return c.signalToNoise; });
    addOf("saturated", "1", [](const TargetRow::Channel& c) { return c.saturated < 0 ? static_cast<double>(NAN) : static_cast<double>(c.saturated); });
  }
  return columns;
}

/// Frames of a camera, those of one kind.
class CameraFile {
 public:
  CameraFile(Hdf5Function open, const std::filesystem::path& file, const Frame& first, int compression) : file_(file) {
    Hdf5Request request{file_.partial().string(), first.width, first.height, compression, {}};
    for (const FrameLayer& l : first.layers) request.layers.emplace_back(l.name, l.unit);
    layers_ = request.layers;
    Hdf5Reply reply;
    open(&request, &reply);
    if (!reply.frames) throw OutputError(file, reply.failure, 0, "check the folder and its disk");
    frames_ = std::move(reply.frames);
  }

  void add(const Frame& frame) {
    std::vector<std::span<const float>> layers;
    for (std::size_t l = 0; l < frame.layers.size(); ++l) {
      if (l >= layers_.size() || frame.layers[l].name != layers_[l].first) break;
      layers.emplace_back(frame.layers[l].pixels);
    }
    if (layers.size() != layers_.size() || frame.layers.size() != layers_.size())
      throw std::runtime_error("camera " + frame.camera + ", frame " + std::to_string(frame.number) + " has other layers than the frames before it");
    told([&] { frames_->add(layers); });
    ends_.numbers.push_back(frame.number);
    ends_.times_s.push_back(frame.time_s);
    rows_.push_back(frame.targets);
    for (const Attribute& a : frame.attributes)
      if (const auto* text = std::get_if<std::string>(&a.value); text && a.name == "pitviper.plan" && plans_.find(*text) == std::string::npos)
        plans_ += (plans_.empty() ? "" : " ") + *text;
  }

  /// `attributes`: of the file, besides its plans'.
  void finish(std::vector<std::pair<std::string, std::string>> attributes, const MayReplace& mayReplace) {
    if (!plans_.empty()) attributes.emplace_back("pitviper.plan", plans_);
    ends_.attributes = std::move(attributes);
    addTargets();
    told([&] { frames_->finish(ends_); });
    frames_.reset();
    file_.keep(mayReplace);
  }

 private:
  void told(const std::function<void()>& work) const {
    try {
      work();
    } catch (const std::runtime_error& problem) {
      throw OutputError(file_.target(), problem.what(), 0, "free space on that disk or choose another output folder");
    }
  }

  void addTargets() {
    std::map<std::string, std::size_t> places;
    std::vector<TargetRow::Channel> channels;
    for (const auto& rows : rows_)
      for (const TargetRow& r : rows) {
        if (channels.empty()) channels = r.channels;
        if (!places.emplace(r.name, ends_.targets.size()).second) continue;
        ends_.targets.push_back(r.name);
        ends_.kinds.push_back(r.kind);
      }
    for (const RowColumn& column : rowColumns(channels)) {
      Hdf5Table table{column.name, column.unit, std::vector<double>(rows_.size() * ends_.targets.size(), NAN)};
      for (std::size_t f = 0; f < rows_.size(); ++f)
        for (const TargetRow& r : rows_[f]) table.values[f * ends_.targets.size() + places.at(r.name)] = column.value(r);
      ends_.tables.push_back(std::move(table));
    }
  }

  PartialFile file_;
  std::vector<std::pair<std::string, std::string>> layers_;
  std::unique_ptr<Hdf5Frames> frames_;  ///< closed before the file's name goes
  std::vector<std::vector<TargetRow>> rows_;
  std::string plans_;
  Hdf5Ends ends_;
};

class Hdf5Sink final : public Sink {
 public:
  Hdf5Sink(const Simulation& sim, const SinkPlace& place, std::vector<std::string> cameras, int compression, Location where)
      : files_("hdf5", sim, place),
        cameras_(std::move(cameras)),
        compression_(compression),
        where_(std::move(where)),
        attributes_{{kScenarioName, sim.name},
                    {kScenarioHash, sim.sha256},
                    {kScenarioContent, sim.content},
                    {"pitviper.seed", std::to_string(sim.seed)},
                    {"pitviper.version", kVersion}} {}

  void start() override {
    open_ = loadHdf5(where_);
    ensureWritableFolder(files_.place().folder);
  }
  void take(const std::shared_ptr<const Frame>& frame) override {
    if (std::find(cameras_.begin(), cameras_.end(), frame->camera) == cameras_.end()) return;
    files_.noteFrame(*frame);
    auto& file = open(*frame);
    file.add(*frame);
  }
  void finish(const std::function<void(double)>&) override {
    for (auto& [name, file] : cameraFiles_) {
      auto attributes = attributes_;
      attributes.emplace_back("pitviper.camera", file.first);
      file.second->finish(std::move(attributes), files_.mayReplaceBeside(kManifest));
      files_.note(name, {{"camera", file.first}});
    }
    cameraFiles_.clear();
    files_.writeManifest({});
  }
  std::vector<std::filesystem::path> filesOf(const std::string& camera, int, const std::string& kind) const override {
    if (!kind.empty() || camera != cameras_.front()) return {};
    return {files_.place().folder / kManifest};  // the frames' files cannot say whose they are
  }

 private:
  CameraFile& open(const Frame& frame) {
    const std::string name = frame.camera + (frame.kind.empty() ? "" : "_" + frame.kind) + ".h5";
    auto& [camera, file] = cameraFiles_[name];
    if (!file) {
      files_.refuseForeignBeside(name, kManifest);  // now, not when the run has ended
      camera = frame.camera;
      file = std::make_unique<CameraFile>(open_, files_.place().folder / name, frame, compression_);
    }
    return *file;
  }

  DataSetFiles files_;
  std::vector<std::string> cameras_;
  int compression_;
  Location where_;
  std::vector<std::pair<std::string, std::string>> attributes_;
  Hdf5Function open_ = nullptr;
  std::map<std::string, std::pair<std::string, std::unique_ptr<CameraFile>>> cameraFiles_;  ///< by name: whose frames, and they
};

}  // namespace

SinkModel hdf5Sink() {
  return {"hdf5",
          "All frames of a camera in one HDF5 file, `<camera>.h5`: each layer a dataset [frames, height, width] of floats with its `unit`, a chunk a frame, "
          "beside `number` and `time_s`; where the camera's `truth` asks for targets, in the group `targets` tables [frames, targets] of what "
          "`<camera>_truth.csv` has; the scenario, its hashes, seed, plans and version as attributes. Spectral images are in `<camera>_spectral.h5`. "
          "`manifest.json` as of `coco`.",
          {folderParameter(), camerasParameter(), withDefault(integer("compression", "without loss: 0 none, to 9; bytes are shuffled first", 0, 9), "4")},
          [](const Record& r, const Simulation& sim) {
            return [folder = readFolder(r), cameras = readCameraNames(r, sim), compression = static_cast<int>(r.integer("compression")), where = r.where()](
                       const Simulation& simulation, const SinkPlace& place) -> std::unique_ptr<Sink> {
              return std::make_unique<Hdf5Sink>(simulation, place.below(folder), cameras, compression, where);
            };
          }};
}

}  // namespace pitviper
