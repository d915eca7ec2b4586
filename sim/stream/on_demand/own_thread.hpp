#pragma once
// A thread for a library that may hold it for ever: a sink without a reader, a driver without a display.
#include <pthread.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <future>
#include <thread>

namespace pitviper {

/// Blocks, on the calling thread, what the system sends to any thread of the process: signals are the program's, SIGPIPE of a dead reader is an error like
/// others.
inline void blockSignals(sigset_t* before = nullptr) {
  sigset_t all;
  sigfillset(&all);
  for (int fault : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP}) sigdelset(&all, fault);
  pthread_sigmask(SIG_BLOCK, &all, before);
}

class OwnThread {
 public:
  /// What the destructor gives it to end by itself.
  static constexpr std::chrono::milliseconds kPatience{2000};

  /// `work` owns, or shares, all that it uses: it may outlive this object.
  explicit OwnThread(std::function<void()> work) {
    std::packaged_task<void()> task(std::move(work));
    over_ = task.get_future();
    sigset_t before;
    blockSignals(&before);  // inherited, by the threads that it starts too
    try {
      thread_ = std::thread(std::move(task));
    } catch (...) {
      pthread_sigmask(SIG_SETMASK, &before, nullptr);
      throw;
    }
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
  }
  OwnThread(const OwnThread&) = delete;
  OwnThread& operator=(const OwnThread&) = delete;
  /// Leaves it behind where it does not end.
  ~OwnThread() { isOver(kPatience) ? thread_.join() : thread_.detach(); }

  /// Waits this long for its end.
  bool isOver(std::chrono::milliseconds patience) const { return over_.wait_for(patience) == std::future_status::ready; }

 private:
  std::future<void> over_;
  std::thread thread_;
};

}  // namespace pitviper
