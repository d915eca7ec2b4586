#include "sim/run/bare_timer.hpp"


#include "sim/stream/clock/wall_clock.hpp"

namespace pitviper {

BareTimer::BareTimer(std::int64_t first_ns, std::int64_t period_ns) {
  thread_ = std::thread([this, first_ns, period_ns] {
    for (std::int64_t next = first_ns; sleepUntil_ns(next, [this] { return ends_.load(); });) {
      const std::int64_t late = monotonic_ns() - next;
      lateness_.add(late);
      if (10 * late > period_ns) ++late_;
      next += std::max<std::int64_t>(1, (late + period_ns) / period_ns) * period_ns;
    }
  });
}

void BareTimer::end() {
  ends_ = true;
  if (thread_.joinable()) thread_.join();
}

}  // namespace pitviper
