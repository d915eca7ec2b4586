#include "sim/stream/clock/wall_clock.hpp"

#include <pthread.h>
#include <sched.h>
#include <sys/timex.h>

#include <cerrno>
#include <cstring>
#include <ctime>

namespace pitviper {
namespace {

constexpr std::int64_t kSecond_ns = 1000000000, kTaiMinusUtc_s = 37;

std::int64_t now_ns(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return static_cast<std::int64_t>(t.tv_sec) * kSecond_ns + t.tv_nsec;
}

/// Linux has CLOCK_TAI equal to UTC until somebody (ntpd, ptp4l) tells it how many seconds lie between.
bool knowsLeapSeconds() {
  timex query{};
  return adjtimex(&query) >= 0 && query.tai != 0;
}

}  // namespace

std::int64_t monotonic_ns() { return now_ns(CLOCK_MONOTONIC); }

std::int64_t taiOf_ns(std::int64_t monotonic) {
  static const std::int64_t kept = knowsLeapSeconds() ? 0 : kTaiMinusUtc_s * kSecond_ns;
  return now_ns(CLOCK_TAI) - monotonic_ns() + monotonic + kept;
}

void sleepUntil_ns(std::int64_t monotonic) {
  const timespec until{static_cast<time_t>(monotonic / kSecond_ns), static_cast<long>(monotonic % kSecond_ns)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

bool sleepUntil_ns(std::int64_t monotonic, const std::function<bool()>& ends) {
  constexpr std::int64_t kLook_ns = 50000000;
  for (std::int64_t now = monotonic_ns(); monotonic - now > kLook_ns; now = monotonic_ns()) {
    if (ends()) return false;
    sleepUntil_ns(now + kLook_ns);
  }
  if (ends()) return false;
  sleepUntil_ns(monotonic);
  return true;
}

std::string askFor(const ThreadWish& wish) {
  std::string refused;
  if (!wish.cores.empty()) {
    cpu_set_t set;
    CPU_ZERO(&set);
    for (int core : wish.cores)
      if (core >= 0 && core < CPU_SETSIZE) CPU_SET(core, &set);
    if (const int error = pthread_setaffinity_np(pthread_self(), sizeof set, &set)) refused += std::string("these cores (") + std::strerror(error) + ")";
  }
  if (wish.fifoPriority > 0) {
    const sched_param parameters{wish.fifoPriority};
    if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters))
      refused += std::string(refused.empty() ? "" : ", ") + "SCHED_FIFO (" + std::strerror(error) + ")";
  }
  return refused;
}

}  // namespace pitviper
