#include "sim/image/video.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <thread>
#include <vector>

#include "sim/parameters/print.hpp"

extern char** environ;

namespace pitviper {
namespace {

/// Closed with it.
class Descriptor {
 public:
  explicit Descriptor(int value = -1) : value_(value) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  void set(int value) { close(), value_ = value; }
  void close() {
    if (value_ >= 0) ::close(value_);
    value_ = -1;
  }
  int get() const { return value_; }

 private:
  int value_;
};

std::uint32_t bigEndian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | static_cast<unsigned char>(bytes[at + k]);
  return value;
}

/// How much of the start of a stream of MP4 boxes (ISO/IEC 14496-12, 4.2) is of use by itself: up to the end of the last `mdat`, and of `moov`, which says
/// what there is to come.
std::size_t wholeFragments(const std::string& bytes) {
  std::size_t at = 0, whole = 0;
  while (at + 8 <= bytes.size()) {
    const std::size_t length = bigEndian(bytes, at);
    if (length < 8 || at + length > bytes.size()) break;  // ffmpeg's fragments of a second are far below 4 GB
    const std::string type = bytes.substr(at + 4, 4);
    at += length;
    if (type == "mdat" || type == "moov") whole = at;
  }
  return whole;
}

}  // namespace

class VideoWriter::Encoder {
 public:
  Encoder(const std::filesystem::path& path, int width, int height, double rate_per_s, const std::string& comment)
      : path_(path), width_(width), height_(height), file_(path) {
    // Errors of ffmpeg are read when it has ended.
    errors_.set(::memfd_create("ffmpeg", MFD_CLOEXEC));
    int in[2], out[2];
    // A socket, not a pipe: writing to one whose reader has gone is an error, and no signal.
    if (errors_.get() < 0 || ::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, in) != 0) throw OutputError(path, "cannot start ffmpeg", errno);
    in_.set(in[0]);
    const Descriptor itsIn(in[1]);
    if (::pipe2(out, O_CLOEXEC) != 0) throw OutputError(path, "cannot start ffmpeg", errno);
    out_.set(out[0]);
    const Descriptor itsOut(out[1]);
    start(itsIn.get(), itsOut.get(), rate_per_s, comment);
    reader_ = std::thread([this] { read(); });
  }
  ~Encoder() {
    if (process_ > 0 && !ended_) ::kill(process_, SIGKILL);
    end();
  }

  int width() const { return width_; }
  int height() const { return height_; }

  void add(const Rgb8Image& picture) {
    const char* at = reinterpret_cast<const char*>(picture.rgb.data());
    for (std::size_t left = picture.rgb.size(); left > 0;) {
      const ssize_t sent = ::send(in_.get(), at, left, MSG_NOSIGNAL);
      if (sent < 0 && errno == EINTR) continue;
      if (sent < 0) return;  // it has ended: finish() tells why
      at += sent, left -= static_cast<std::size_t>(sent);
    }
  }

  void finish(const MayReplace& mayReplace) {
    const int status = end();
    if (failure_) {
      file_.keep(mayReplace);
      try {
        std::rethrow_exception(failure_);
      } catch (const std::exception& why) {
        throw OutputError(path_, std::string("the video ends early, whole as far as it goes: ") + why.what(), 0, "free space on that disk and run again");
      }
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw OutputError(path_, "ffmpeg could not make the video: " + lastWords(), 0, "look at what it says");
    file_.keep(mayReplace);
  }

 private:
  void start(int in, int out, double rate_per_s, const std::string& comment) {
    const std::string rate = print("%.9g", rate_per_s);
    const std::string size = std::to_string(width_) + "x" + std::to_string(height_), every = std::to_string(std::max(1L, std::lround(rate_per_s))),
                      said = "comment=" + comment;
    // One thread and bitexact: the same pictures give the same bytes.
    const std::vector<std::string> words = {"ffmpeg",
                                            "-v",
                                            "error",
                                            "-f",
                                            "rawvideo",
                                            "-pix_fmt",
                                            "rgb24",
                                            "-s",
                                            size,
                                            "-r",
                                            rate,
                                            "-i",
                                            "pipe:0",
                                            "-an",
                                            "-c:v",
                                            "libx264",
                                            "-preset",
                                            "veryfast",
                                            "-crf",
                                            "16",
                                            "-threads",
                                            "1",
                                            "-sc_threshold",
                                            "0",
                                            "-g",
                                            every,
                                            "-pix_fmt",
                                            "yuv420p",
                                            "-vf",
                                            "scale=out_color_matrix=bt709:out_range=tv",
                                            "-colorspace",
                                            "bt709",
                                            "-color_primaries",
                                            "bt709",
                                            "-color_trc",
                                            "iec61966-2-1",
                                            "-fflags",
                                            "+bitexact",
                                            "-flags:v",
                                            "+bitexact",
                                            "-metadata",
                                            said,
                                            "-movflags",
                                            "frag_keyframe+empty_moov+default_base_moof",
                                            "-f",
                                            "mp4",
                                            "pipe:1"};
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in, 0);
    posix_spawn_file_actions_adddup2(&actions, out, 1);
    posix_spawn_file_actions_adddup2(&actions, errors_.get(), 2);
    const int failed = ::posix_spawnp(&process_, "ffmpeg", &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (failed == 0) return;
    process_ = -1;
    throw OutputError(path_, "cannot start ffmpeg, which videos are made with", failed, "install it: sudo apt-get install ffmpeg");
  }

  /// On a thread of its own, so that neither waits for the other.
  void read() {
    std::string kept;
    std::array<char, 1 << 16> some;
    for (;;) {
      const ssize_t got = ::read(out_.get(), some.data(), some.size());
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      if (failure_) continue;  // let it end
      try {
        kept.append(some.data(), static_cast<std::size_t>(got));
        const std::size_t whole = wholeFragments(kept);
        if (whole == 0) continue;
        file_.append(std::string_view(kept).substr(0, whole));
        kept.erase(0, whole);
      } catch (...) {
        failure_ = std::current_exception();
      }
    }
    try {
      if (!failure_) file_.append(kept);  // the index after the last fragment
    } catch (...) {
      failure_ = std::current_exception();
    }
  }

  int end() {
    if (ended_) return status_;
    ended_ = true;
    in_.close();
    if (reader_.joinable()) reader_.join();
    if (process_ > 0)
      while (::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
      }
    return status_;
  }

  std::string lastWords() const {
    std::array<char, 400> words = {};
    const ssize_t got = ::pread(errors_.get(), words.data(), words.size() - 1, 0);
    return got > 0 ? std::string(words.data(), static_cast<std::size_t>(got)) : std::string("it ended without a word");
  }

  const std::filesystem::path path_;
  int width_, height_;
  GrowingFile file_;
  Descriptor in_, out_, errors_;
  pid_t process_ = -1;
  int status_ = 0;
  bool ended_ = false;
  std::exception_ptr failure_;
  std::thread reader_;
};

VideoWriter::VideoWriter(const std::filesystem::path& path, double rate_per_s, const std::string& comment, const MayReplace& mayReplace)
    : path_(path), rate_per_s_(rate_per_s), comment_(comment), mayReplace_(mayReplace) {}

VideoWriter::~VideoWriter() = default;

void VideoWriter::add(const Rgb8Image& picture) {
  if (picture.width % 2 || picture.height % 2) throw std::invalid_argument("VideoWriter: odd sides");
  if (!encoder_) encoder_ = std::make_unique<Encoder>(path_, picture.width, picture.height, rate_per_s_, comment_);
  if (picture.width != encoder_->width() || picture.height != encoder_->height()) throw std::invalid_argument("VideoWriter: pictures of two sizes");
  encoder_->add(picture);
}

void VideoWriter::finish() {
  if (encoder_) encoder_->finish(mayReplace_);
  encoder_.reset();
}

}  // namespace pitviper
