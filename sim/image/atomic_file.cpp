#include "sim/image/atomic_file.hpp"

#include <fcntl.h>
#include <linux/limits.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <random>
#include <set>
#include <system_error>
#include <utility>

#include "sim/parameters/print.hpp"

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

constexpr std::string_view kPartial = ".partial";
constexpr std::size_t kTagDigits = 16;
/// NAME_MAX of Linux file systems is 255; a longer name's temporary has the name's beginning only.
constexpr std::size_t kLongestStem = 200;

/// Temporaries that exist now, for a signal that ends the program.
struct OpenFiles {
  std::mutex mutex;
  std::set<std::string> names;
};
OpenFiles& openFiles() {
  static OpenFiles* const all = new OpenFiles;  // never destroyed: threads may still write while the program ends
  return *all;
}

/// ".NAME.<16 hexadecimal digits>.partial": no two writers, on whatever machine, take the same.
std::filesystem::path temporaryName(const std::filesystem::path& target) {
  static std::atomic<std::uint64_t> count{0};
  std::random_device device;
  const std::uint64_t tag = (static_cast<std::uint64_t>(device()) << 32 | device()) ^ (static_cast<std::uint64_t>(::getpid()) << 20) ^ ++count;
  const std::string digits = print("%016llx", static_cast<unsigned long long>(tag));
  const std::string name = target.filename().string();
  if (name.size() > NAME_MAX) return target.parent_path() / name;  // the system's own error tells
  return target.parent_path() / ("." + name.substr(0, kLongestStem) + "." + digits + std::string(kPartial));
}

bool isTemporaryName(const std::string& name) {
  if (name.size() < 1 + 1 + kTagDigits + kPartial.size() || name[0] != '.' || !name.ends_with(kPartial)) return false;
  const std::size_t tag = name.size() - kPartial.size() - kTagDigits;
  return name[tag - 1] == '.' && name.find_first_not_of("0123456789abcdef", tag) == name.size() - kPartial.size();
}

/// A file that becomes the target when whole. Its lock tells others that its writer is alive: the system frees it with the process, however that ends.
class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& target) : target_(target) {
    // Each try fails only where another process took the file for abandoned in the instant before it was locked.
    for (int tries = 0; tries < 100 && descriptor_ < 0; ++tries) create();
    if (descriptor_ < 0) throw OutputError(target_, "cannot create the file", EBUSY);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    const std::lock_guard lock(openFiles().mutex);
    if (!kept_) ::unlink(name_.c_str());
    openFiles().names.erase(name_.string());
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  int descriptor() const { return descriptor_; }

  void keep(const MayReplace& mayReplace) {
    // Network and quota file systems report a full disk only when closing; the copy keeps the lock until the file has its name.
    const int copy = ::fcntl(descriptor_, F_DUPFD_CLOEXEC, 3);
    if (copy < 0) throw OutputError(target_, "cannot finish the file", errno);
    const int result = ::close(std::exchange(descriptor_, copy));
    if (result != 0) throw OutputError(target_, "cannot finish the file", errno);
    if (!mayReplace || !takeFreeName(mayReplace)) rename();
    kept_ = true;
  }

 private:
  void create() {
    name_ = temporaryName(target_);
    const std::lock_guard lock(openFiles().mutex);
    const int made = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (made < 0 && errno == EEXIST) return;
    if (made < 0) throw OutputError(target_, "cannot create the file", errno);
    struct stat about = {};
    // A file system without locks lets go on: then nobody removes what he cannot lock either.
    if ((::flock(made, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) || ::fstat(made, &about) != 0 || about.st_nlink == 0) {
      ::close(made);
      return;
    }
    openFiles().names.insert(name_.string());
    descriptor_ = made;
  }

  /// True where the target did not exist and now does. Where it does, `mayReplace` has been asked.
  bool takeFreeName(const MayReplace& mayReplace) const {
    if (::renameat2(AT_FDCWD, name_.c_str(), AT_FDCWD, target_.c_str(), RENAME_NOREPLACE) == 0) return true;
    struct stat existing = {};
    // Some file systems know no such renaming: there two runs of different scenarios that write the same name in the same instant are not told apart.
    if (errno == EEXIST || ::lstat(target_.c_str(), &existing) == 0) mayReplace(target_);
    return false;
  }

  void rename() const {
    if (::rename(name_.c_str(), target_.c_str()) != 0) throw OutputError(target_, "cannot rename the finished file", errno);
  }

  std::filesystem::path name_;
  const std::filesystem::path target_;
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

namespace {

void refuseUnfit(const std::filesystem::path& path) {
  if (path.filename().empty() || path.filename() == "." || path.filename() == "..") throw OutputError(path, "is not a file name", 0, "give a file name");
  // A rename over a device, a pipe or a folder would destroy it.
  struct stat existing = {};
  if (::stat(path.c_str(), &existing) == 0 && !S_ISREG(existing.st_mode)) throw OutputError(path, "exists and is not a regular file", 0, "choose another name");
}

}  // namespace

class GrowingFile::Temporary : public pitviper::Temporary {
  using pitviper::Temporary::Temporary;
};

GrowingFile::GrowingFile(const std::filesystem::path& path) : path_(path) {
  refuseUnfit(path);
  file_ = std::make_unique<Temporary>(path);
}

GrowingFile::~GrowingFile() = default;

void GrowingFile::append(std::string_view bytes) {
  try {
    writeAll(file_->descriptor(), bytes, path_);
  } catch (const OutputError&) {
    if (::ftruncate(file_->descriptor(), static_cast<off_t>(size_)) != 0 || ::lseek(file_->descriptor(), 0, SEEK_END) < 0) file_.reset();
    throw;
  }
  size_ += bytes.size();
}

void GrowingFile::keep(const MayReplace& mayReplace) {
  if (!file_) throw OutputError(path_, "cannot finish the file", EIO);
  file_->keep(mayReplace);
}

void writeFileAtomically(const std::filesystem::path& path, std::string_view bytes, const MayReplace& mayReplace) {
  refuseUnfit(path);
  Temporary temporary(path);
  writeAll(temporary.descriptor(), bytes, path);
  temporary.keep(mayReplace);
}

void removeOpenTemporaries() {
  openFiles().mutex.lock();  // for good: no writer goes on
  for (const std::string& name : openFiles().names) ::unlink(name.c_str());
}

void removeAbandonedTemporaries(const std::filesystem::path& folder) {
  std::error_code ended;
  for (std::filesystem::directory_iterator at(folder, ended), end; !ended && at != end; at.increment(ended)) {
    if (!isTemporaryName(at->path().filename().string())) continue;
    const int file = ::open(at->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    struct stat opened = {}, named = {};
    // While the lock is held here its name cannot have become another writer's file.
    if (::fstat(file, &opened) == 0 && S_ISREG(opened.st_mode) && ::flock(file, LOCK_EX | LOCK_NB) == 0 && ::lstat(at->path().c_str(), &named) == 0 &&
        named.st_ino == opened.st_ino && named.st_dev == opened.st_dev)
      ::unlink(at->path().c_str());
    ::close(file);
  }
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
  removeAbandonedTemporaries(folder);
}

}  // namespace pitviper
