#include "sim/stream/frame_spool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>

#include "sim/image/atomic_file.hpp"

namespace pitviper {
namespace {

/// A file that nobody can name goes with the program, however that ends.
int openNameless(const std::filesystem::path& folder) {
  if (const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600); file >= 0) return file;
  std::string name = (folder / ".pitviperXXXXXX").string();  // a file system without O_TMPFILE
  const int file = ::mkostemp(name.data(), O_CLOEXEC);
  if (file < 0) throw OutputError(folder, "cannot create a file in it", errno);
  ::unlink(name.c_str());
  return file;
}

}  // namespace

FrameSpool::~FrameSpool() {
  if (file_ >= 0) ::close(file_);
}

void FrameSpool::add(Frame frame) {
  if (file_ < 0) file_ = openNameless(folder_);
  for (FrameLayer& l : frame.layers) {
    writeAll(file_, {reinterpret_cast<const char*>(l.pixels.data()), sizeof(float) * l.pixels.size()}, folder_);
    l.pixels = {};
  }
  frames_.push_back(std::move(frame));
}

void FrameSpool::each(const std::function<void(const Frame&, double)>& visit) const {
  off_t at = 0;
  std::size_t done = 0;
  for (Frame frame : frames_) {
    for (FrameLayer& l : frame.layers) {
      l.pixels.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
      char* to = reinterpret_cast<char*>(l.pixels.data());
      for (std::size_t left = sizeof(float) * l.pixels.size(); left > 0;) {
        const ssize_t got = ::pread(file_, to, left, at);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) throw OutputError(folder_, "cannot read back what was written to it", got < 0 ? errno : EIO);
        to += got, at += got, left -= static_cast<std::size_t>(got);
      }
    }
    visit(frame, static_cast<double>(++done) / static_cast<double>(frames_.size()));
  }
}

}  // namespace pitviper
