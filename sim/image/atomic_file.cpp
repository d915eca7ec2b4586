#include "sim/image/atomic_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <system_error>

namespace pitviper {
namespace {

std::string adviceFor(int errorNumber) {
  switch (errorNumber) {
    case ENOSPC:
    case EDQUOT:
      return "free space on that disk or choose another output folder";
    case ENOENT:
      return "create the folder first";
    case EACCES:
    case EPERM:
    case EROFS:
      return "choose an output folder you may write to";
    case ENOTDIR:
      return "choose another output folder; a file is in the way";
    case ENAMETOOLONG:
      return "choose a shorter name";
    case EFBIG:
      return "raise the file size limit (ulimit -f)";
    default:
      return "check the folder and its disk";
  }
}

std::string compose(const std::filesystem::path& path, const std::string& what, int errorNumber, const std::string& fix) {
  std::string message = path.string() + ": " + what;
  if (errorNumber != 0) message += ": " + std::generic_category().message(errorNumber);
  if (!fix.empty()) message += "; fix: " + fix;
  else if (errorNumber != 0) message += "; fix: " + adviceFor(errorNumber);
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 32) c = ' ';  // one line, whatever the path held
  return message;
}

/// Removes the temporary unless it was renamed, and closes what is still open.
class Temporary {
 public:
  Temporary(std::filesystem::path name, const std::filesystem::path& target) : name_(std::move(name)), target_(target) {
    // A leftover of a killed run, or a link put there, must not decide where the bytes go.
    if (::unlink(name_.c_str()) != 0 && errno != ENOENT && errno != ENOTDIR)
      throw OutputError(target_, "cannot replace the leftover " + name_.filename().string(), errno);
    descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor_ < 0) throw OutputError(target_, "cannot create the file", errno);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    if (descriptor_ >= 0) ::close(descriptor_);
    if (!kept_) ::unlink(name_.c_str());
  }

  int descriptor() const { return descriptor_; }

  void keep() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    // Network and quota file systems report a full disk only here.
    if (result != 0) throw OutputError(target_, "cannot finish the file", errno);
    if (::rename(name_.c_str(), target_.c_str()) != 0) throw OutputError(target_, "cannot rename the finished file", errno);
    kept_ = true;
  }

 private:
  std::filesystem::path name_;
  const std::filesystem::path& target_;
  int descriptor_ = -1;
  bool kept_ = false;
};

}  // namespace

OutputError::OutputError(const std::filesystem::path& path, const std::string& what, int errorNumber, const std::string& fix)
    : std::runtime_error(compose(path, what, errorNumber, fix)) {}

void writeAll(int descriptor, std::string_view bytes, const std::filesystem::path& path) {
  constexpr std::size_t atOnce = std::size_t{1} << 30;  // Linux moves at most 2^31 - 4096 bytes per write(2)
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), std::min(bytes.size(), atOnce));
    if (written < 0) {
      if (errno == EINTR) continue;
      throw OutputError(path, "cannot write the file", errno);
    }
    if (written == 0) throw OutputError(path, "cannot write the file", ENOSPC);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes) {
  if (path.filename().empty() || path.filename() == "." || path.filename() == "..") throw OutputError(path, "is not a file name", 0, "give a file name");
  // A rename over a device, a pipe or a folder would destroy it.
  struct stat existing = {};
  if (::stat(path.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode)) throw OutputError(path, "exists and is not a regular file", 0, "choose another name");
  std::filesystem::path name = ".";
  name += path.filename();
  name += ".partial";
  Temporary temporary(path.parent_path() / name, path);
  writeAll(temporary.descriptor(), bytes, path);
  temporary.keep();
}

void ensureWritableFolder(const std::filesystem::path& folder) {
  if (folder.empty()) throw OutputError(folder, "the output folder has no name", 0, "give a folder");
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  struct stat existing = {};
  if (::stat(folder.c_str(), &existing) != 0) {
    const int reason = failure ? failure.value() : errno;
    throw OutputError(folder, "cannot create the folder", reason);
  }
  if (!S_ISDIR(existing.st_mode)) throw OutputError(folder, "is not a folder", 0, "choose another output folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) throw OutputError(folder, "cannot write to the folder", errno);
}

}  // namespace pitviper
