#pragma once
// A file in memory under a name that a reader can open: it sees the very bytes that were checked, whatever happens to the file they came from.
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <new>
#include <string>
#include <string_view>

namespace pitviper {

class MemoryFile {
 public:
  /// Throws std::bad_alloc.
  explicit MemoryFile(std::string_view bytes) : handle_(memfd_create("mesh", MFD_CLOEXEC)) {
    if (handle_ < 0) throw std::bad_alloc();
    while (!bytes.empty()) {
      const ssize_t count = write(handle_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) {
        close(handle_);
        throw std::bad_alloc();
      }
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  ~MemoryFile() { close(handle_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  /// The same file under one number more. False where the number cannot be had.
  bool alsoAs(int number) const { return dup2(handle_, number) == number; }
  std::string name() const { return "/proc/self/fd/" + std::to_string(handle_); }

 private:
  int handle_;
};

}  // namespace pitviper
