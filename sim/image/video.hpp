#pragma once
// Pictures as a video, by the program ffmpeg, which runs beside this one and gets them through a pipe.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "sim/image/atomic_file.hpp"
#include "sim/image/picture.hpp"

namespace pitviper {

/// H.264 in MP4, in fragments of a second: a file that ends early, as on a full disk, is whole up to there.
class VideoWriter {
 public:
  /// `rate_per_s`: pictures a second; `comment` is kept in the file. Errors: OutputError where ffmpeg is missing or the file cannot be begun.
  VideoWriter(const std::filesystem::path& path, double rate_per_s, const std::string& comment, const MayReplace& mayReplace = {});
  ~VideoWriter();
  VideoWriter(const VideoWriter&) = delete;
  VideoWriter& operator=(const VideoWriter&) = delete;

  /// All of one size, of even sides. Errors: OutputError, where the disk is full for one; what was written until then is kept.
  void add(const Rgb8Image& picture);
  /// Waits for the rest and gives the file its name; without it none is left. Errors: OutputError.
  void finish();

 private:
  class Encoder;
  std::unique_ptr<Encoder> encoder_;
  std::filesystem::path path_;
  double rate_per_s_;
  std::string comment_;
  MayReplace mayReplace_;
};

}  // namespace pitviper
