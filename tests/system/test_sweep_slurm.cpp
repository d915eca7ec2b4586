// A sweep as an array job of a real Slurm, one of whose nodes dies meanwhile: at the end everything is there once, and as it comes from one process alone.
// PITVIPER_SLURM=1 runs it: it starts Slurm on this machine (slurm_machine.sh), which takes root, the packages slurmctld, slurmd, slurm-client, munge and
// sqlite3, and about three minutes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <sstream>
#include <thread>

#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

/// A busy machine is slow, and none of these is a promise of speed.
constexpr std::chrono::minutes kMostWait{30};

constexpr int kParts = 6, kSamples = 600;

const char* const kScene =
    "accuracy: 1 %\n"
    "background: {temperature: 270 K}\n"
    "entities: [{name: ball, shape: {model: sphere, radius: 2 m}, material: blackbody, temperature: 330 K}]\n"
    "cameras:\n"
    "- {name: eye, film: {width: 96, height: 96}, field_of_view: 5 deg, aperture: 40 mm, look_at: ball, position: [90 m, 0 m, 9 m],\n"
    "   channels: [{name: mw, response: {band: [3.6 um, 4.1 um]}}]}\n";

std::string sweepText() {
  return "sweep: balls\nscenario: scene.yaml\nseed: 7\nsamples: " + std::to_string(kSamples) +
         "\nvary:\n"
         "- {name: kelvin, key: entities.ball.temperature, uniform: [300 K, 400 K]}\n"
         "- {name: angle, key: cameras.eye.field_of_view, uniform: [4 deg, 8 deg]}\n"
         "measures:\n"
         "- {name: mean, statistic: mean, layer: mw.radiance}\n"
         "- {name: brightest, statistic: max, layer: mw.radiance}\n";
}

std::string quoted(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// False: not within kMostWait.
bool waitUntil(const std::function<bool()>& isSo, std::chrono::milliseconds between = std::chrono::milliseconds(500)) {
  const auto end = std::chrono::steady_clock::now() + kMostWait;
  for (; std::chrono::steady_clock::now() < end; std::this_thread::sleep_for(between))
    if (isSo()) return true;
  return false;
}

/// Why the test cannot run here; empty: it can.
std::string whyNot() {
  if (const char* wish = std::getenv("PITVIPER_SLURM"); wish == nullptr || std::string(wish) != "1") return "takes minutes: set PITVIPER_SLURM=1";
  if (geteuid() != 0) return "Slurm's daemons are started by root";
  for (const char* program : {"slurmctld", "slurmd", "munged", "sbatch", "squeue", "sqlite3"})
    if (run(std::string("command -v ") + program).code != 0)
      return std::string("there is no ") + program + ": apt-get install slurmctld slurmd slurm-client munge sqlite3";
  return "";
}

class SweepOnSlurm : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = whyNot(); !why.empty()) GTEST_SKIP() << why;
    fs::create_directories(folder());
    std::ofstream(folder() / "scene.yaml") << kScene;
    std::ofstream(folder() / "balls.yaml") << sweepText();
    const Result started = machine("start", "2 " + std::to_string(getpid()));
    ASSERT_EQ(started.code, 0) << started.output;
    setenv("SLURM_CONF", (machine_ + "/slurm.conf").c_str(), 1);
  }
  void TearDown() override {
    if (!fs::exists(machine_)) return;
    if (HasFailure()) std::printf("%s\n", run("squeue; tail -n 20 " + quoted(out().string()) + "/logs/* " + machine_ + "/logs/slurmctld.log").output.c_str());
    const Result stopped = machine("stop");
    EXPECT_EQ(stopped.code, 0) << stopped.output;
    EXPECT_FALSE(fs::exists(machine_));
    unsetenv("SLURM_CONF");
  }

  Result machine(const std::string& command, const std::string& words = "") const {
    return run(quoted(PITVIPER_SOURCE_DIR "/tests/system/slurm_machine.sh") + " " + command + " " + machine_ + " " + words);
  }
  /// Names that a shell and Slurm could take for more than they are.
  fs::path folder() const { return temporary_.path() / "a 50%a \"lot\" of $HOME's"; }
  fs::path out() const { return folder() / "out #1"; }
  fs::path partOf(int part) const { return out() / "parts" / ("part_" + std::to_string(part) + "_of_" + std::to_string(kParts) + ".sqlite"); }
  Result sweep(const fs::path& into, const std::string& words = "") const {
    return pitviper("sweep " + quoted((folder() / "balls.yaml").string()) + " --out " + quoted(into.string()) + " " + words);
  }
  Result submitted() const {
    return sweep(out(), "--slurm --parts " + std::to_string(kParts) + " --slurm-option '--time=2:00:00' --slurm-option '--comment=a \"b\" c'");
  }
  /// What the first line says; nothing where the file is not there or is being written.
  static std::optional<int> asked(const fs::path& file, const std::string& question) {
    if (!fs::exists(file)) return std::nullopt;
    const Result said = run("sqlite3 " + quoted(file.string()) + " " + quoted(question));
    if (said.code != 0 || said.output.empty()) return std::nullopt;
    return std::atoi(said.output.c_str());
  }
  int rowsOf(int part) const { return asked(partOf(part), "select count(*) from samples").value_or(0); }
  std::vector<int> incomplete() const {
    std::vector<int> parts;
    for (int part = 0; part < kParts; ++part)
      if (rowsOf(part) != kSamples / kParts) parts.push_back(part);
    return parts;
  }
  static bool queueIsEmpty() {
    const Result said = run("squeue --noheader");
    return said.code == 0 && said.output.empty();
  }
  /// Parts that run on a node now.
  static std::vector<int> partsOn(const std::string& node) {
    std::istringstream tasks(run("squeue --noheader --array --states=RUNNING --nodelist=" + node + " --format=%K").output);
    std::vector<int> parts;
    for (std::string task; tasks >> task;)
      if (task.find_first_not_of("0123456789") == std::string::npos) parts.push_back(std::stoi(task));
    return parts;
  }
  std::string arrayOfScript() const {
    const std::string script = contentOf(out() / "sweep.sbatch"), before = "#SBATCH --array=";
    const std::size_t at = script.find(before);
    return at == std::string::npos ? "" : script.substr(at + before.size(), script.find('\n', at) - at - before.size());
  }
  void expectAllIsThereOnce(const std::string& expectedCsv) const {
    EXPECT_EQ(asked(out() / "sweep.sqlite", "select count(*) from samples"), kSamples);
    EXPECT_EQ(asked(out() / "sweep.sqlite", "select count(distinct sample) from samples"), kSamples);
    EXPECT_TRUE(contentOf(out() / "sweep.csv") == expectedCsv) << "the merged table is not that of one process alone";
  }

  const TemporaryFolder temporary_;
  const std::string machine_ = "/tmp/pitviper_slurm_" + std::to_string(getpid());
};

TEST_F(SweepOnSlurm, ANodeDiesAndNothingLacks) {
  const Result alone = sweep(folder() / "alone");
  ASSERT_EQ(alone.code, 0) << alone.output;
  const std::string expected = contentOf(folder() / "alone" / "sweep.csv");
  ASSERT_EQ(std::count(expected.begin(), expected.end(), '\n'), kSamples + 1);

  const Result first = submitted();
  ASSERT_EQ(first.code, 0) << first.output;
  EXPECT_EQ(arrayOfScript(), "0-5");
  const Result again = submitted();
  EXPECT_EQ(again.code, 2) << again.output;
  EXPECT_NE(again.output.find("still in Slurm's queue"), std::string::npos) << again.output;

  // In the middle of a part: some of its samples are there, and not all.
  std::vector<int> onNode;
  ASSERT_TRUE(waitUntil(
      [&] {
        onNode = partsOn("node2");
        for (const int part : onNode)
          if (const int rows = rowsOf(part); rows > 0 && rows < kSamples / kParts) return true;
        return false;
      },
      std::chrono::milliseconds(20)))
      << "no part was in the middle on node2";
  const Result killed = machine("kill-node", "node2");
  ASSERT_EQ(killed.code, 0) << killed.output;
  int lost = 0;
  for (const int part : onNode) lost += rowsOf(part) < kSamples / kParts ? 1 : 0;
  ASSERT_GT(lost, 0) << "all parts of the node were complete before it died: more samples are needed";
  std::printf("node2 died with %d parts unfinished\n", lost);

  ASSERT_TRUE(waitUntil(queueIsEmpty));
  const std::string jobs = run("scontrol show job").output;
  int restarted = 0;
  for (std::size_t at = 0; (at = jobs.find(" Restarts=", at)) != std::string::npos; ++at) restarted += jobs[at + 10] != '0' ? 1 : 0;
  EXPECT_GE(restarted, lost) << jobs;
  for (int attempt = 0; attempt < 3 && !incomplete().empty(); ++attempt) {
    ASSERT_EQ(submitted().code, 0);
    ASSERT_TRUE(waitUntil(queueIsEmpty));
  }
  expectAllIsThereOnce(expected);

  // Parts that are lost altogether, as with a disk: those alone are drawn again, and the node is back.
  const Result revived = machine("revive-node", "node2");
  ASSERT_EQ(revived.code, 0) << revived.output;
  for (const char* name : {"sweep.csv", "sweep.sqlite"}) fs::remove(out() / name);
  for (const int part : {1, 4}) fs::remove(partOf(part));
  const Result rest = submitted();
  ASSERT_EQ(rest.code, 0) << rest.output;
  EXPECT_EQ(arrayOfScript(), "1,4");
  ASSERT_TRUE(waitUntil(queueIsEmpty));
  expectAllIsThereOnce(expected);
}

}  // namespace
}  // namespace pitviper::test
