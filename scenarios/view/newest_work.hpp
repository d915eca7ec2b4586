#pragma once
// Work of a window that takes long: done by a thread of its own, always the newest wish, so that drawing never waits.
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace pitviper {

/// `Result` of the newest `Wish`. What works lives on its thread from beginning to end, as a GL context must.
template <class Wish, class Result>
class NewestWork {
 public:
  using Stale = std::function<bool()>;  ///< whether a newer wish waits
  using Work = std::function<std::shared_ptr<const Result>(const Wish& wish, const Stale& isStale)>;
  /// `make`: called on the thread at the first wish. A result of null changes nothing. `told`: called there when a wish is done.
  explicit NewestWork(std::function<Work()> make, std::function<void()> told = {})
      : told_(std::move(told)), thread_([this, make = std::move(make)] { run(make); }) {}
  ~NewestWork() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  NewestWork(const NewestWork&) = delete;
  NewestWork& operator=(const NewestWork&) = delete;

  void want(Wish wish) {
    const std::lock_guard lock(mutex_);
    wish_ = std::move(wish);
    isBusy_ = true;
    wake_.notify_all();
  }
  /// Null before the first.
  std::shared_ptr<const Result> newest() const {
    const std::lock_guard lock(mutex_);
    return newest_;
  }
  bool isBusy() const {
    const std::lock_guard lock(mutex_);
    return isBusy_;
  }
  /// Of the last wish; empty: none.
  std::string error() const {
    const std::lock_guard lock(mutex_);
    return error_;
  }
  /// For what is shown bit by bit, by the work itself.
  void publish(std::shared_ptr<const Result> result) {
    const std::lock_guard lock(mutex_);
    newest_ = std::move(result);
  }

 private:
  /// What it gives way by to the window's thread.
  static constexpr int kBehindWindow = 5;

  void run(const std::function<Work()>& make) {
    setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), kBehindWindow);
    Work work;
    for (;;) {
      std::optional<Wish> wish;
      {
        std::unique_lock lock(mutex_);
        wake_.wait(lock, [this] { return wish_ || ends_; });
        if (ends_) return;
        std::swap(wish, wish_);
      }
      std::shared_ptr<const Result> result;
      std::string error;
      try {
        if (!work) work = make();
        result = work(*wish, [this] {
          const std::lock_guard lock(mutex_);
          return wish_.has_value() || ends_;
        });
      } catch (const std::exception& e) {
        error = e.what();
      }
      const std::lock_guard lock(mutex_);
      if (result) newest_ = std::move(result);
      error_ = std::move(error);
      isBusy_ = wish_.has_value();
      if (told_) told_();
    }
  }

  std::function<void()> told_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Wish> wish_;
  bool ends_ = false, isBusy_ = false;
  std::shared_ptr<const Result> newest_;
  std::string error_;
  std::thread thread_;
};

}  // namespace pitviper
