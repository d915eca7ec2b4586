// Every frame as a file.
#include "sim/frame/file_formats.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

class FilesSink final : public Sink {
 public:
  FilesSink(const FileFormat& format, SinkPlace place, FileOptions options) : format_(format), place_(std::move(place)), options_(std::move(options)) {
    options_.mayReplace = place_.mayReplace;
  }
  void start() override { ensureWritableFolder(place_.folder); }
  void take(const std::shared_ptr<const Frame>& frame) override {
    format_.write(place_.folder / (frameFileStem(*frame) + format_.extension), *frame, options_);
  }
  std::vector<std::filesystem::path> filesOf(const std::string& camera, int number, const std::string& kind) const override {
    std::vector<std::filesystem::path> files{place_.folder / (frameFileStem(camera, number, kind) + format_.extension)};
    if (!format_.beside.empty()) files.push_back(place_.folder / (frameFileStem(camera, number, kind) + format_.beside));
    return files;
  }

 private:
  const FileFormat& format_;
  SinkPlace place_;
  FileOptions options_;
};

std::vector<std::string> formatNames() {
  std::vector<std::string> names;
  for (const FileFormat& f : fileFormats()) names.push_back(f.name);
  return names;
}

std::string formatWords() {
  std::string words;
  for (const FileFormat& f : fileFormats()) words += (words.empty() ? "" : "; ") + std::string("`") + f.name + "`: " + f.description;
  return words;
}

}  // namespace

SinkModel filesSink() {
  return {"files",
          "Every frame as a file, `<camera>_<frame>`, with all its layers. This, as EXR, is what a run writes where no sink is given.",
          {folderParameter(), withDefault(choice("format", formatNames(), formatWords()), "exr"),
           withDefault(choice("compression", {"none", "zip"}, "of EXR, without loss: a fifth to two fifths less room, and twenty times as long to write"),
                       "none"),
           withDefault(boolean("picture", "of EXR: R, G and B for programs that show nothing else"), "true")},
          [](const Record& r, const Simulation&) {
            FileOptions options;
            options.compression = r.text("compression") == "zip" ? ExrCompression::Zip : ExrCompression::None;
            options.picture = r.boolean("picture");
            const FileFormat& format = fileFormat(r.text("format"));
            for (const char* key : {"compression", "picture"})
              if (r.given(key) && format.name != "exr")
                throw UserError(r.where(key), std::string("'") + key + "' of a file that is no EXR", "'format: exr', or none of it", "remove it");
            return [folder = readFolder(r), &format, options](const Simulation&, const SinkPlace& place) -> std::unique_ptr<Sink> {
              return std::make_unique<FilesSink>(format, place.below(folder), options);
            };
          }};
}

}  // namespace pitviper
