#include "scenarios/commands/process.hpp"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <functional>
#include <mutex>
#include <new>
#include <string>
#include <thread>
#include <utility>

#include "sim/gl/driver_cache.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/scene/cache_folder.hpp"
#include "sim/stream/ring/ring_memory.hpp"

namespace pitviper {
namespace {

constexpr int kMistake = 2, kMachine = 1;
constexpr const char* kOutOfMemory =
    "pitviper: more memory is needed than this machine gives; expected a scenario that fits; fix: lower the film, its subpixels, the number of layers or the "
    "meshes\n";

void writeToStderr(std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(STDERR_FILENO, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return;  // nobody to tell
    text.remove_prefix(static_cast<std::size_t>(count));
  }
}

/// The next file that is opened must not become stdout because that was closed.
void openClosedStreams() {
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) {
      // For reading only: what is printed is lost, and that is told.
      const int made = ::open("/dev/null", stream == STDERR_FILENO ? O_WRONLY : O_RDONLY);
      if (made >= 0 && made != stream) ::close(made);
    }
}

[[noreturn]] void endBySignal(int number) {
  removeOpenTemporaries();
  removeOpenRings();
  const char* const name = number == SIGINT ? "SIGINT" : number == SIGTERM ? "SIGTERM" : "SIGHUP";
  // A progress bar stands on the terminal's line.
  writeToStderr(std::string(::isatty(STDERR_FILENO) != 0 ? "\n" : "") + "pitviper: ended by " + name +
                "; the files written so far are whole, and nothing else is left; fix: run the same command again for the rest\n");
  ::_exit(128 + number);
}

std::mutex gEnding;
std::function<void()> gEndsItself;

/// A thread takes the signals: it may do what a signal handler may not.
void watchSignals() {
  sigset_t watched;
  sigemptyset(&watched);
  int count = 0;
  for (int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction before = {};
    if (sigaction(number, nullptr, &before) != 0 || before.sa_handler == SIG_IGN) continue;  // as under nohup
    sigaddset(&watched, number);
    ++count;
  }
  if (count == 0 || pthread_sigmask(SIG_BLOCK, &watched, nullptr) != 0) return;
  try {
    std::thread([watched] {
      int number = 0;
      for (;;) {
        while (sigwait(&watched, &number) != 0) {
        }
        const std::lock_guard lock(gEnding);
        if (!gEndsItself) endBySignal(number);
        std::exchange(gEndsItself, nullptr)();  // once: the next one ends it at once
      }
    }).detach();
  } catch (const std::exception&) {
    pthread_sigmask(SIG_UNBLOCK, &watched, nullptr);  // the system's own way of ending is better than none
  }
}

[[noreturn]] void endByException() {
  if (const std::exception_ptr thrown = std::current_exception()) {
    try {
      std::rethrow_exception(thrown);
    } catch (const std::bad_alloc&) {
      removeOpenTemporaries();
      ::_exit(tellOutOfMemory());
    } catch (const std::exception& e) {
      writeToStderr("pitviper: ");
      writeToStderr(e.what());
      writeToStderr("\n");
    } catch (...) {
    }
  }
  std::abort();
}

/// A stream that tens of megabytes of pictures go through each second would give them back to the system after every frame, which then hands them out again
/// page by page, cleared: half of a frame's time at 640 x 512. They are kept.
void keepMemory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);  // the most that it takes
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
}

}  // namespace

void prepareProcess() {
  keepMemory();
  openClosedStreams();
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(endByException);
  tellOfDriverBy(tell);
  tellOfCacheBy(tell);
  watchSignals();
}

EndsItself::EndsItself(std::function<void()> end) {
  const std::lock_guard lock(gEnding);
  gEndsItself = std::move(end);
}

EndsItself::~EndsItself() {
  const std::lock_guard lock(gEnding);
  gEndsItself = nullptr;
}

void tell(const char* message) { writeToStderr(readable(message) + "\n"); }

int finishOutput(int code) {
  errno = 0;
  const bool flushed = std::fflush(stdout) == 0;
  if (flushed && std::ferror(stdout) == 0) return code;
  const int reason = errno;
  tell(("standard output: cannot write what was to be printed" + (reason != 0 ? std::string(": ") + std::strerror(reason) : "") +
        "; fix: free space on its disk, or print elsewhere")
           .c_str());
  return code != 0 ? code : kMachine;
}

int tellOutOfMemory() {
  writeToStderr(kOutOfMemory);
  return kMistake;
}

}  // namespace pitviper
