#include "sim/image/read_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <new>
#include <stdexcept>
#include <system_error>

#include "sim/parameters/error.hpp"

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

}  // namespace

std::string readWholeFile(const std::filesystem::path& path) {
  const Location where{.file = path.string()};
  const auto reason = [](int number) { return std::generic_category().message(number); };
  // Without O_NONBLOCK a named pipe would wait for a writer before it can be refused.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) throw UserError(where, "cannot open the file: " + reason(errno), "a readable file", "check the path and its permissions");
  struct stat about = {};
  if (::fstat(file.number(), &about) != 0) throw UserError(where, "cannot read the file: " + reason(errno), "a readable file", "check the file and its disk");
  if (!S_ISREG(about.st_mode)) throw UserError(where, "is not a regular file", "a regular file", "give the path of a file");
  try {
    std::string bytes(static_cast<std::size_t>(about.st_size), '\0');
    std::size_t done = 0;
    while (done < bytes.size()) {
      const ssize_t count = ::read(file.number(), bytes.data() + done, bytes.size() - done);
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) throw UserError(where, "cannot read the file: " + reason(errno), "a readable file", "check the file and its disk");
      if (count == 0) break;  // it was shortened meanwhile; the format's own check tells
      done += static_cast<std::size_t>(count);
    }
    bytes.resize(done);
    return bytes;
  } catch (const std::bad_alloc&) {
    throw UserError(where, "is too large for this machine's memory", "a smaller file", "use a machine with more memory");
  } catch (const std::length_error&) {
    throw UserError(where, "is too large for this machine's memory", "a smaller file", "use a machine with more memory");
  }
}

}  // namespace pitviper
