#include "sim/stream/ring/ring_memory.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <map>
#include <mutex>
#include <stdexcept>

#include "sim/parameters/available_memory.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/ring/pitviper_stream.h"

namespace pitviper {
namespace {

/// Where the C library keeps shared memory objects.
constexpr const char* kFolder = "/dev/shm";

/// Names of this process, and the objects they stand for.
std::mutex gOpen;
std::map<std::string, int> gOpenRings;

bool isSame(const struct stat& a, const struct stat& b) { return a.st_dev == b.st_dev && a.st_ino == b.st_ino; }

/// Who holds an object's lock may take its name away: nobody else does meanwhile.
void unlinkOwn(const std::string& name, int file) {
  struct stat own {
  }, named{};
  if (fstat(file, &own) == 0 && stat((kFolder + name).c_str(), &named) == 0 && isSame(own, named)) shm_unlink(name.c_str());
}

enum class Taken { Gone, Busy };

/// What has the name goes if its writer is no more. Busy: another process is about to take it.
Taken takeAbandoned(const std::string& name) {
  const auto refuse = [&](const std::string& what, const std::string& fix) {
    throw std::runtime_error("shared memory " + name + " " + what + "; expected a free name; fix: " + fix);
  };
  const int file = shm_open(name.c_str(), O_RDONLY, 0);
  if (file < 0) {
    if (errno == ENOENT) return Taken::Gone;
    refuse(std::string("is there already and cannot be opened (") + std::strerror(errno) + ")", "choose another");
  }
  struct Closing {
    int file;
    ~Closing() { close(file); }
  } closing{file};
  pitviper_stream_header h{};
  const bool is = pread(file, &h, sizeof h, 0) == static_cast<ssize_t>(sizeof h) && std::memcmp(h.magic, PITVIPER_STREAM_MAGIC, sizeof h.magic) == 0;
  if (!is) refuse("is there already and is no stream's", "choose another, or remove " + (kFolder + name));
  if (flock(file, LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) refuse(std::string("cannot be locked (") + std::strerror(errno) + ")", "choose another");
    // Its writer has the lock; or its writer is no more, and who has it is replacing it.
    if (h.writer_pid > 0 && h.writer_pid <= INT32_MAX && kill(static_cast<pid_t>(h.writer_pid), 0) != 0 && errno == ESRCH) return Taken::Busy;
    refuse("is written by process " + std::to_string(h.writer_pid), "end that stream, or choose another name");
  }
  unlinkOwn(name, file);
  return Taken::Gone;
}

/// The memory that this thread writes to.
struct Written {
  char* at = nullptr;
  std::size_t bytes = 0;
  volatile std::sig_atomic_t isCut = 0;
};
thread_local Written tWritten;
struct sigaction gBefore;

void onBusError(int, siginfo_t* info, void*) {
  const auto touched = reinterpret_cast<std::uintptr_t>(info->si_addr), first = reinterpret_cast<std::uintptr_t>(tWritten.at);
  if (tWritten.at && touched >= first && touched - first < tWritten.bytes &&
      mmap(tWritten.at, tWritten.bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED | MAP_NORESERVE, -1, 0) != MAP_FAILED) {
    tWritten.isCut = 1;
    return;
  }
  sigaction(SIGBUS, &gBefore, nullptr);  // another's fault: it comes again, and is told as it was
}

void catchBusErrors() {
  static std::once_flag once;
  std::call_once(once, [] {
    struct sigaction action {};
    action.sa_sigaction = onBusError;
    action.sa_flags = SA_SIGINFO;
    sigemptyset(&action.sa_mask);
    sigaction(SIGBUS, &action, &gBefore);
  });
}

}  // namespace

void removeOpenRings() {
  const std::lock_guard lock(gOpen);
  for (const auto& [name, file] : gOpenRings) unlinkOwn(name, file);
}

RingMemory::RingMemory(std::string name, std::size_t bytes, const std::function<void(char*)>& fill) : name_(std::move(name)), bytes_(bytes) {
  const auto fail = [&](const char* what, int reason) {
    if (file_ >= 0) close(file_);
    throw std::runtime_error("shared memory " + name_ + ": " + what + " (" + std::strerror(reason) + "); expected " + std::to_string(bytes_ >> 20) + " MB in " +
                             kFolder + "; fix: free it there, or ask for fewer slots");
  };
  // Of a machine without memory for it the system would end a process, this one or another.
  constexpr double kMostShare = 0.9;
  if (const auto free = availableMemory_bytes(); free && static_cast<double>(bytes_) > kMostShare * *free) fail("the machine has no such memory", ENOMEM);
  // Nobody else's name is worth taking memory for.
  if (struct stat named{}; stat((kFolder + name_).c_str(), &named) == 0) takeAbandoned(name_);
  file_ = open(kFolder, O_RDWR | O_TMPFILE | O_CLOEXEC, 0600);
  if (file_ < 0) fail("cannot be made", errno);
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) fail("cannot be locked", errno);
  // All of it now: a full disk of memory ends a process at its first touch.
  const int room = ftruncate(file_, static_cast<off_t>(bytes_)) != 0 ? errno : posix_fallocate(file_, 0, static_cast<off_t>(bytes_));
  at_ = room != 0 ? MAP_FAILED : mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED, file_, 0);
  if (at_ == MAP_FAILED) fail("there is no room", room != 0 ? room : errno);
  fill(at());
  try {
    place();
  } catch (...) {
    munmap(at_, bytes_);
    close(file_);
    throw;
  }
  catchBusErrors();
}

void RingMemory::place() {
  constexpr std::int64_t kPatience_ns = 5000000000, kPause_ns = 10000000;
  const std::string own = "/proc/self/fd/" + std::to_string(file_), target = kFolder + name_;
  for (const std::int64_t until = monotonic_ns() + kPatience_ns;;) {
    int reason = 0;
    {
      const std::lock_guard lock(gOpen);
      if (linkat(AT_FDCWD, own.c_str(), AT_FDCWD, target.c_str(), AT_SYMLINK_FOLLOW) == 0) {
        gOpenRings[name_] = file_;
        return;
      }
      reason = errno;
    }
    if (reason != EEXIST)
      throw std::runtime_error("shared memory " + name_ + " cannot get its name (" + std::strerror(reason) + "); expected /proc and " + kFolder +
                               " of Linux; fix: mount them");
    if (takeAbandoned(name_) == Taken::Gone) continue;
    if (monotonic_ns() > until)
      throw std::runtime_error("shared memory " + name_ +
                               " is being taken by another process; expected a free name; fix: end that stream, or choose another name");
    sleepUntil_ns(monotonic_ns() + kPause_ns);
  }
}

void RingMemory::unlink() {
  const std::lock_guard lock(gOpen);
  if (const auto open = gOpenRings.find(name_); open != gOpenRings.end() && open->second == file_) {
    unlinkOwn(name_, file_);
    gOpenRings.erase(open);
  }
}

RingMemory::~RingMemory() {
  unlink();
  munmap(at_, bytes_);
  close(file_);
}

bool RingMemory::write(const std::function<void()>& write) {
  tWritten.isCut = 0;
  tWritten.at = at(), tWritten.bytes = bytes_;
  struct Ending {
    ~Ending() { tWritten.at = nullptr; }
  };
  {
    const Ending ending;
    write();
  }
  isCut_ |= tWritten.isCut != 0;
  return !isCut_;
}

}  // namespace pitviper
