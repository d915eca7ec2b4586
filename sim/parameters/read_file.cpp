#include "sim/parameters/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <system_error>

namespace pitviper {
namespace {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

const char* kindOf(mode_t mode) {
  if (S_ISDIR(mode)) return "a folder";
  if (S_ISFIFO(mode)) return "a pipe";
  if (S_ISCHR(mode) || S_ISBLK(mode)) return "a device";
  return S_ISSOCK(mode) ? "a socket" : "something else";
}

std::string sizeText(std::uintmax_t bytes) { return bytes < (1u << 20) ? std::to_string(bytes) + " bytes" : std::to_string(bytes >> 20) + " MB"; }

/// `start`: as many bytes are enough; 0: all are wanted.
std::string read(const std::filesystem::path& path, const FileWanted& wanted, const Location& askedAt, std::size_t start) {
  const bool asked = !askedAt.file.empty();
  const Location where = asked ? askedAt : Location{.file = path.string()};
  const std::string subject = asked ? "the file '" + path.string() + "'" : "the file";
  const auto fail = [&](const std::string& wrong, const std::string& fix) { throw UserError(where, wrong, wanted.what, fix); };
  const auto failed = [&] { fail("cannot read " + subject + ": " + std::generic_category().message(errno), wanted.fix); };
  const auto refuseOthers = [&](const struct stat& about) {
    if (!S_ISREG(about.st_mode)) fail("cannot read " + subject + ": it is " + kindOf(about.st_mode) + ", not a regular file", "give the path of a file");
  };
  // Looked at before it is opened, because opening some devices does something, and after, because it may be another by then.
  struct stat about = {};
  if (::stat(path.c_str(), &about) != 0) failed();
  refuseOthers(about);
  // O_NONBLOCK: a pipe put there meanwhile must not wait for a writer.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.number() < 0) failed();
  if (::fstat(file.number(), &about) != 0) failed();
  refuseOthers(about);
  const auto size = static_cast<std::uintmax_t>(about.st_size);
  if (start == 0 && size > wanted.mostBytes)
    throw UserError({path.string(), 1, 1, -1}, "the file has " + sizeText(size), "at most " + sizeText(wanted.mostBytes), wanted.fixLarge);
  const char* const tooLarge = " is too large for this machine's memory";
  try {
    std::string bytes(start > 0 ? std::min(start, static_cast<std::size_t>(size)) : static_cast<std::size_t>(size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::read(file.number(), bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) failed();
      if (count == 0) break;  // it was shortened meanwhile; the format's own check tells
      done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
    return bytes;
  } catch (const std::bad_alloc&) {
    fail(subject + tooLarge, "use a machine with more memory");
  } catch (const std::length_error&) {
    fail(subject + tooLarge, "use a machine with more memory");
  }
  return {};
}

}  // namespace

std::string readWholeFile(const std::filesystem::path& path, const FileWanted& wanted, const Location& askedAt) { return read(path, wanted, askedAt, 0); }

std::string readFileStart(const std::filesystem::path& path, std::size_t bytes, const FileWanted& wanted, const Location& askedAt) {
  return read(path, wanted, askedAt, bytes);
}

}  // namespace pitviper
