// What a long command says while it works.
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <vector>

#include "scenarios/commands/progress.hpp"

namespace pitviper {
namespace {

TEST(Progress, RemainingTimeIsOfStepsAfterTheFirst) {
  ProgressState s;
  s.total = 11;
  s.elapsed_s = 30.0;
  EXPECT_LT(secondsLeft(s), 0.0);  // nothing to judge by
  EXPECT_EQ(progressText(s), "0 of 11, 30 s so far");
  s.done = 1;  // the first compiled programs: it says nothing of the others
  EXPECT_LT(secondsLeft(s), 0.0);
  s.done = 6;
  s.sinceFirst_s = 10.0;
  EXPECT_DOUBLE_EQ(secondsLeft(s), 10.0);
  EXPECT_EQ(progressText(s), "6 of 11, 0.5/s, 10 s left");
  s.share = 0.5;
  EXPECT_NEAR(secondsLeft(s), 4.5 / 0.55, 1e-12);
  s.phase = "planning seeker";
  s.phaseShare = 0.4;
  EXPECT_EQ(progressText(s), "planning seeker, 40 %, 30 s so far");
}

TEST(Progress, TheFirstStepIsJudgedByItsShare) {
  ProgressState s;
  s.total = 2;
  s.share = 0.25;
  s.elapsed_s = 20.0;
  EXPECT_DOUBLE_EQ(secondsLeft(s), 1.75 / 0.25 * 20.0);
  EXPECT_EQ(progressText(s), "0 of 2 and 25 % of the next, 0.013/s, 2 min left");
}

TEST(Progress, LinesComeAtGrowingIntervals) {
  const ProgressPace pace;
  std::vector<double> at = {pace.next_s(0.0)};
  while (at.back() < 3600.0) at.push_back(pace.next_s(at.back()));
  EXPECT_DOUBLE_EQ(at[0], 3.0);
  EXPECT_DOUBLE_EQ(at[1], 6.0);
  EXPECT_DOUBLE_EQ(at[2], 12.0);
  EXPECT_LE(at.size(), 20u);  // lines in an hour
  for (size_t k = 1; k < at.size(); ++k) EXPECT_LE(at[k] - at[k - 1], 300.0);
}

// Rationale: minutes without a word while planning. Expected: lines come although nobody reports anything; none after finish().
TEST(Progress, SpeaksWhileNothingIsReported) {
  std::mutex mutex;
  std::condition_variable more;
  std::vector<std::string> lines;
  {
    Progress progress("scene", 3, {0.01, 0.01}, [&](const std::string& line) {
      const std::lock_guard lock(mutex);
      lines.push_back(line);
      more.notify_all();
    });
    progress.phase("planning seeker");
    auto waitFor = [&](const std::string& part) {
      std::unique_lock lock(mutex);
      more.wait(lock, [&] { return !lines.empty() && lines.back().find(part) != std::string::npos; });
    };
    waitFor("scene: planning seeker, ");
    progress.phase("planning seeker", 0.5);
    waitFor("planning seeker, 50 %");
    progress.step();
    waitFor("1 of 3");
    progress.finish();
    const std::lock_guard lock(mutex);
    lines.clear();
  }
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace pitviper
