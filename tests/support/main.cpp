// The tests' own start: a cache of their own, and an end to what hangs. A slow or busy machine is no hang: what counts is whether any work is done.
#include <dirent.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <thread>

namespace {

/// A test that waits has this many looks, with two seconds between them, in which neither it nor a process it started uses any processor time. Even a
/// process that a hundred others crowd out gets some in five minutes. Stopped or asleep, the machine does not look either.
constexpr int kLooks = 150;
constexpr std::chrono::seconds kBetween{2};

/// And one that spins has this much processor time, all its threads and processes together: the longest takes about two minutes of it.
constexpr double kMostProcessor_s = 7200.0;

struct Process {
  long parent = 0;
  unsigned long long ticks = 0;
};

/// All processes, from /proc/PID/stat: the fields behind the name, which may hold anything, are the state, the parent, and at 12 to 15 the times.
std::map<long, Process> processes() {
  std::map<long, Process> all;
  DIR* folder = opendir("/proc");
  if (folder == nullptr) return all;
  while (const dirent* entry = readdir(folder)) {
    const long id = std::atol(entry->d_name);
    if (id <= 0) continue;
    std::ifstream in(std::string("/proc/") + entry->d_name + "/stat");
    std::string text;
    std::getline(in, text);
    const size_t name = text.rfind(')');
    if (name == std::string::npos) continue;
    Process p;
    unsigned long long user = 0, system = 0, childUser = 0, childSystem = 0;
    if (std::sscanf(text.c_str() + name + 1, " %*c %ld %*d %*d %*d %*d %*u %*u %*u %*u %*u %llu %llu %llu %llu", &p.parent, &user, &system, &childUser,
                    &childSystem) != 5)
      continue;
    p.ticks = user + system + childUser + childSystem;
    all[id] = p;
  }
  closedir(folder);
  return all;
}

/// Of this process and all below it.
unsigned long long processorTicks() {
  const auto all = processes();
  unsigned long long sum = 0;
  for (const auto& [id, p] : all) {
    long at = id;
    for (int up = 0; up < 64 && at > 1; ++up) {
      if (at == getpid()) {
        sum += p.ticks;
        break;
      }
      const auto found = all.find(at);
      at = found == all.end() ? 0 : found->second.parent;
    }
  }
  return sum;
}

/// Never destroyed: the thread that looks outlives everything.
struct Watched {
  std::mutex mutex;
  std::string test = "the start";
  bool isNew = true;
};
Watched& watched() {
  static Watched* const one = new Watched;
  return *one;
}

class Names : public testing::EmptyTestEventListener {
 public:
  void OnTestStart(const testing::TestInfo& info) override {
    const std::lock_guard lock(watched().mutex);
    watched().test = std::string(info.test_suite_name()) + "." + info.name();
    watched().isNew = true;
  }
};

/// Of this process and the children it has waited for [s].
double processorSeconds() {
  double sum = 0.0;
  for (int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage used{};
    if (getrusage(who, &used) != 0) continue;
    for (const timeval& t : {used.ru_utime, used.ru_stime}) sum += static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  }
  return sum;
}

/// Processor seconds beside the others in the reports: what a test costs, whatever runs beside it.
class Costs : public testing::EmptyTestEventListener {
 public:
  void OnTestStart(const testing::TestInfo&) override { begin_s_ = processorSeconds(); }
  void OnTestEnd(const testing::TestInfo&) override { testing::Test::RecordProperty("processor_s", std::to_string(processorSeconds() - begin_s_)); }

 private:
  double begin_s_ = 0.0;
};

[[noreturn]] void watch() {
  // A fuzz test that was asked to be long is one test, and so is a long promise.
  const bool isLong = std::getenv("PITVIPER_FUZZ") != nullptr || std::getenv("PITVIPER_FUZZ_AIR") != nullptr || std::getenv("PITVIPER_KILLS") != nullptr ||
                      std::getenv("PITVIPER_PROMISE") != nullptr;
  const double perSecond = static_cast<double>(sysconf(_SC_CLK_TCK));
  unsigned long long before = 0, begin = 0;
  for (int idle = 0;; std::this_thread::sleep_for(kBetween)) {
    const unsigned long long now = processorTicks();
    const std::lock_guard lock(watched().mutex);
    if (watched().isNew) begin = now, idle = 0, watched().isNew = false;
    idle = now == before ? idle + 1 : 0;
    before = now;
    const double used_s = static_cast<double>(now - std::min(begin, now)) / perSecond;
    if (idle < kLooks && (isLong || used_s < kMostProcessor_s)) continue;
    std::fprintf(stderr, "%s hangs: %s\n", watched().test.c_str(), idle >= kLooks ? "it waits, and nothing it waits for does any work" : "it goes on and on");
    std::abort();
  }
}

}  // namespace

int main(int argc, char** argv) {
  // Neither what the user has planned and imported decides a test, nor a test what the user draws. Kept between test programs, emptied by ctest.
  setenv("XDG_CACHE_HOME", PITVIPER_BUILD_DIR "/test_cache", 1);
  testing::InitGoogleTest(&argc, argv);
  testing::UnitTest::GetInstance()->listeners().Append(new Names);
  testing::UnitTest::GetInstance()->listeners().Append(new Costs);
  std::thread(watch).detach();
  return RUN_ALL_TESTS();
}
