// Runs that are killed, run at once or ended by signals: what stands in the folder is whole and of one scenario, and nothing else is left.
// PITVIPER_KILLS sets the number of killed runs (default 5; the long test is 100), PITVIPER_ROUNDS of rounds of four runs at once (default 2; 20).
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "sim/image/exr.hpp"

namespace {

namespace fs = std::filesystem;

int fromEnvironment(const char* name, int otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoi(text);
}

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::map<std::string, std::string> filesIn(const fs::path& folder) {
  std::map<std::string, std::string> all;
  if (fs::exists(folder))
    for (const auto& entry : fs::directory_iterator(folder)) all[entry.path().filename().string()] = readAll(entry.path());
  return all;
}

constexpr int kFrames = 12;

/// Two cameras, a probe, previews: every kind of file that a run writes; air that has to be planned.
const char* const kScenario =
    "atmosphere: clear_us76\naccuracy: 10 %\ntime: {rate: 10 Hz, frames: 12}\n"
    "entities: [{name: p, shape: {model: sphere, radius: 2 m}, material: {}, temperature: 330 K}]\n"
    "cameras:\n"
    "- {name: a, film: {width: 48, height: 48}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [90 m, 0 m, 9 m],\n"
    "   channels: [{name: mw, response: {band: [3.6 um, 4.1 um]}}]}\n"
    "- {name: b, film: {width: 32, height: 32}, field_of_view: 9 deg, aperture: 40 mm, look_at: p, position: [0 m, 90 m, 9 m],\n"
    "   channels: [{name: lw, response: {band: [10 um, 11 um]}}], spectral_image: {band: [10 um, 11 um], bins: 4}}\n"
    "probes: [{name: probe, position: [5 m, 5 m, 0 m], resolution: 16, channels: [{name: lw, response: {band: [10 um, 11 um]}, output: irradiance}]}]\n";

class RunsAtOnce : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::ofstream(folder_ / "scene.yaml") << kScenario;
    std::ofstream(folder_ / "other.yaml") << "name: other\n" << kScenario;
    setenv("PITVIPER_HOME", PITVIPER_SOURCE_DIR, 1);
  }
  void TearDown() override {
    if (!HasFailure()) fs::remove_all(folder_);
  }

  /// Starts the program; both streams into `log`.
  pid_t start(const std::vector<std::string>& arguments, const std::string& log = "log", void (*prepare)() = nullptr) const {
    const pid_t child = fork();
    if (child != 0) return child;
    if (prepare != nullptr) prepare();
    if (chdir(folder_.c_str()) != 0) _exit(126);
    const int to = open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    dup2(to, STDOUT_FILENO);
    dup2(to, STDERR_FILENO);
    std::vector<char*> words = {const_cast<char*>(PITVIPER_PROGRAM)};
    for (const auto& a : arguments) words.push_back(const_cast<char*>(a.c_str()));
    words.push_back(nullptr);
    execv(PITVIPER_PROGRAM, words.data());
    _exit(127);
  }
  /// Exit code, or the negative number of the signal that ended it; `peak_kB`: the most memory it had.
  static int wait(pid_t child, long* peak_kB = nullptr) {
    int status = 0;
    rusage usage = {};
    while (wait4(child, &status, 0, &usage) < 0 && errno == EINTR) {
    }
    if (peak_kB != nullptr) *peak_kB = usage.ru_maxrss;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  int run(const std::vector<std::string>& arguments) const { return wait(start(arguments)); }
  std::string log() const { return readAll(folder_ / "log"); }

  /// All that a whole run leaves.
  std::map<std::string, std::string> whole() const {
    EXPECT_EQ(run({"run", "scene.yaml", "--preview", "--out", "whole"}), 0) << log();
    auto files = filesIn(folder_ / "whole");
    EXPECT_EQ(files.size(), kFrames * 5u + 3u);  // a frame and a preview of each camera, a spectral image; the probe's table, a plan of each camera
    return files;
  }
  static bool isTemporary(const std::string& name) { return name[0] == '.'; }

  const fs::path folder_ = fs::temp_directory_path() / ("pitviper_runs_" + std::to_string(getpid()));
};

// Rationale: machines are switched off and jobs are killed. Expected: whatever is there under its own name is the whole file, and one run more leaves exactly
// what one run alone leaves.
TEST_F(RunsAtOnce, KillsLoseNothing) {
  const int kills = fromEnvironment("PITVIPER_KILLS", 5);
  const auto expected = whole();
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(run({"run", "scene.yaml", "--preview", "--out", "timed"}), 0);
  const auto took = std::chrono::steady_clock::now() - begin;
  std::mt19937 random(1);
  size_t files = 0, leftovers = 0, ended = 0;
  for (int kill = 0; kill < kills; ++kill) {
    const std::string out = "out" + std::to_string(kill % 3);  // some folders are met again
    const pid_t child = start({"run", "scene.yaml", "--preview", "--out", out});
    std::this_thread::sleep_for(took * (static_cast<double>(random() % 1000) / 900.0));
    ::kill(child, SIGKILL);
    ended += wait(child) == 0 ? 1 : 0;
    for (const auto& [name, bytes] : filesIn(folder_ / out)) {
      if (isTemporary(name)) {
        ++leftovers;
        continue;
      }
      ++files;
      ASSERT_TRUE(expected.count(name)) << name;
      ASSERT_TRUE(bytes == expected.at(name)) << name << " is not the whole file after kill " << kill;
    }
  }
  std::printf("%d runs killed, %zu of them too late; %zu files seen, all whole; %zu temporaries left meanwhile\n", kills, ended, files, leftovers);
  for (int k = 0; k < std::min(kills, 3); ++k) {
    const std::string out = "out" + std::to_string(k);
    ASSERT_EQ(run({"run", "scene.yaml", "--preview", "--out", out}), 0) << log();
    EXPECT_TRUE(filesIn(folder_ / out) == expected) << out;
  }
}

// Rationale: a cluster starts the same job twice, users press the key again. Expected: all succeed, and leave what one run leaves; the caches too are met by
// all at once, the first time empty.
TEST_F(RunsAtOnce, FourRunsIntoOneFolder) {
  const int rounds = fromEnvironment("PITVIPER_ROUNDS", 2);
  const auto expected = whole();
  const std::string before = std::getenv("XDG_CACHE_HOME");
  long peak_kB = 0;
  for (int round = 0; round < rounds; ++round) {
    if (round % 4 == 0) setenv("XDG_CACHE_HOME", (folder_ / ("cache" + std::to_string(round))).c_str(), 1);
    // Every other round finds the files of the one before.
    const std::string out = "out" + std::to_string(round / 2);
    std::vector<pid_t> children;
    for (int k = 0; k < 4; ++k) children.push_back(start({"run", "scene.yaml", "--preview", "--out", out}, "log" + std::to_string(k)));
    for (int k = 0; k < 4; ++k) {
      long kB = 0;
      EXPECT_EQ(wait(children[static_cast<size_t>(k)], &kB), 0) << readAll(folder_ / ("log" + std::to_string(k)));
      peak_kB = std::max(peak_kB, kB);
    }
    const auto found = filesIn(folder_ / out);
    EXPECT_EQ(found.size(), expected.size());
    ASSERT_TRUE(found == expected) << "round " << round;
  }
  setenv("XDG_CACHE_HOME", before.c_str(), 1);
  std::printf("%d rounds of four runs into one folder: all files whole and the same; a run had at most %ld MB of memory\n", rounds, peak_kB / 1024);
}

// Expected: two scenarios that write the same names at once: the second to come is refused by name, and the folder holds no mixture of its own doing.
TEST_F(RunsAtOnce, TwoScenariosDoNotMix) {
  const pid_t one = start({"run", "scene.yaml", "--out", "out"}, "log1"), two = start({"run", "other.yaml", "--out", "out"}, "log2");
  const int codes[2] = {wait(one), wait(two)};
  EXPECT_TRUE((codes[0] == 0) != (codes[1] == 0) || (codes[0] == 2 && codes[1] == 2)) << codes[0] << " " << codes[1];
  for (const char* name : {"log1", "log2"}) {
    const std::string text = readAll(folder_ / name);
    if (codes[name[3] - '1'] != 2) continue;
    EXPECT_NE(text.find("is there already, of another scenario"), std::string::npos) << text;
  }
}

TEST_F(RunsAtOnce, AnotherScenariosFilesStay) {
  ASSERT_EQ(run({"run", "scene.yaml", "--frames", "0:1", "--preview", "--out", "out"}), 0) << log();
  const auto before = filesIn(folder_ / "out");
  ASSERT_EQ(before.size(), 13u);
  EXPECT_EQ(run({"run", "scene.yaml", "--frames", "1:2", "--out", "out"}), 0) << log();  // its own are replaced
  const auto more = filesIn(folder_ / "out");
  EXPECT_EQ(run({"run", "other.yaml", "--frames", "2:3", "--out", "out"}), 2);
  EXPECT_EQ(log().rfind("out/a_00002.exr: is there already, of another scenario, 'scene'; expected ", 0), 0u) << log();
  EXPECT_NE(log().find("; fix: choose another folder with --out, or add --overwrite"), std::string::npos) << log();
  EXPECT_TRUE(filesIn(folder_ / "out") == more) << "a run that was refused has written";
  EXPECT_EQ(run({"run", "scene.yaml", "--set", "accuracy=9 %", "--out", "out"}), 2);
  EXPECT_NE(log().find("of another version of the scenario 'scene' (its text or --set differ)"), std::string::npos) << log();
  // Each kind of file by itself, and files of others.
  for (const char* name : {"a_00000.png", "probe.csv", "b_00000_spectral.exr"}) {
    fs::create_directories(folder_ / "one");
    fs::copy_file(folder_ / "out" / name, folder_ / "one" / name);
    EXPECT_EQ(run({"run", "other.yaml", "--frames", "0", "--preview", "--out", "one"}), 2) << name;
    EXPECT_EQ(log().rfind(std::string("one/") + name + ": is there already, of another scenario, 'scene'", 0), 0u) << log();
    EXPECT_EQ(run({"run", "scene.yaml", "--frames", "0", "--preview", "--out", "one"}), 0) << log();
    fs::remove_all(folder_ / "one");
  }
  for (const char* name : {"a_00000.exr", "a_00000.png", "probe.csv"})
    for (const char* content : {"", "my own measurements\n", "\x76\x2f\x31\x01\x02\0\0\0"}) {
      fs::create_directories(folder_ / "mine");
      std::ofstream(folder_ / "mine" / name) << content;
      EXPECT_EQ(run({"run", "scene.yaml", "--frames", "0", "--preview", "--out", "mine"}), 2) << name;
      EXPECT_EQ(log().rfind(std::string("mine/") + name + ": is there already and was not written by a run of this program", 0), 0u) << log();
      EXPECT_EQ(readAll(folder_ / "mine" / name), content);
      fs::remove_all(folder_ / "mine");
    }
  EXPECT_EQ(run({"run", "other.yaml", "--frames", "0:1", "--preview", "--out", "out", "--overwrite"}), 0) << log();
  EXPECT_FALSE(filesIn(folder_ / "out").at("a_00000.exr") == before.at("a_00000.exr"));
}

// Expected: the program ends at once with 128 + the signal's number and one line; what is there is whole, nothing half written is left. A signal that was
// ignored when the program started (nohup, a script's background) stays ignored.
TEST_F(RunsAtOnce, SignalsEndItWhole) {
  const auto expected = whole();
  for (const auto& [number, code, name] : {std::tuple{SIGINT, 130, "SIGINT"}, {SIGTERM, 143, "SIGTERM"}, {SIGHUP, 129, "SIGHUP"}}) {
    const std::string out = name;
    // Where this process is kept waiting, the run may have ended before the signal comes: then once more.
    int ended = 0;
    for (int attempt = 0; attempt < 20 && ended == 0; ++attempt) {
      fs::remove_all(folder_ / out);
      const pid_t child = start({"run", "scene.yaml", "--preview", "--out", out});
      while (filesIn(folder_ / out).size() < 3) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      ::kill(child, number);
      ended = wait(child);
    }
    EXPECT_EQ(ended, code) << log();
    EXPECT_NE(log().find(std::string("pitviper: ended by ") + name + "; the files written so far are whole"), std::string::npos) << log();
    const auto found = filesIn(folder_ / out);
    EXPECT_LT(found.size(), expected.size());
    for (const auto& [file, bytes] : found) EXPECT_TRUE(expected.count(file) && bytes == expected.at(file)) << file;
  }
  const auto handler = std::signal(SIGINT, SIG_IGN);
  const pid_t child = start({"run", "scene.yaml", "--preview", "--out", "ignored"});
  std::signal(SIGINT, handler);
  while (filesIn(folder_ / "ignored").empty()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ::kill(child, SIGINT);
  EXPECT_EQ(wait(child), 0) << log();
  EXPECT_TRUE(filesIn(folder_ / "ignored") == expected);
}

// Expected: a file beyond its size limit is one message of the program's own, not a kill, and leaves nothing.
TEST_F(RunsAtOnce, AFileSizeLimitIsAMessage) {
  EXPECT_EQ(wait(start({"run", "scene.yaml", "--out", "out"}, "log",
                       [] {
                         const rlimit small{4096, 4096};
                         setrlimit(RLIMIT_FSIZE, &small);
                       })),
            1);
  EXPECT_NE(log().find("cannot write the file: File too large; fix: raise the file size limit"), std::string::npos) << log();
  for (const auto& [name, bytes] : filesIn(folder_ / "out")) EXPECT_FALSE(isTemporary(name)) << name;
}

}  // namespace
