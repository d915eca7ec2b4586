#pragma once
// A thread to which work is given that keeps a GL context current: who gives it may be on any thread, and have other contexts.
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <type_traits>

namespace pitviper {

class GlThread {
 public:
  GlThread() : thread_([this] { serve(); }) {}
  ~GlThread() {
    {
      const std::lock_guard lock(mutex_);
      ends_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }
  GlThread(const GlThread&) = delete;
  GlThread& operator=(const GlThread&) = delete;

  /// Does it there and waits; throws what it throws. One caller at a time. `waiting`: called on the caller's thread now and then meanwhile; must not throw.
  template <class Work>
  auto run(Work&& work, const std::function<void()>& waiting = {}) -> std::invoke_result_t<Work> {
    using Result = std::invoke_result_t<Work>;
    if constexpr (std::is_void_v<Result>) {
      give([&] { work(); }, waiting);
    } else {
      std::unique_ptr<Result> result;
      give([&] { result = std::make_unique<Result>(work()); }, waiting);
      return std::move(*result);
    }
  }

 private:
  static constexpr std::chrono::milliseconds kLook{100};

  void give(const std::function<void()>& work, const std::function<void()>& waiting) {
    std::exception_ptr thrown;
    std::unique_lock lock(mutex_);
    work_ = [&] {
      try {
        work();
      } catch (...) {
        thrown = std::current_exception();
      }
    };
    wake_.notify_all();
    while (!done_.wait_for(lock, kLook, [this] { return !work_; })) {
      if (!waiting) continue;
      lock.unlock();
      waiting();
      lock.lock();
    }
    lock.unlock();
    if (thrown) std::rethrow_exception(thrown);
  }

  void serve() {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return work_ || ends_; });
      if (!work_) return;
      lock.unlock();
      work_();
      lock.lock();
      work_ = nullptr;
      done_.notify_all();
    }
  }

  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::function<void()> work_;
  bool ends_ = false;
  std::thread thread_;
};

}  // namespace pitviper
