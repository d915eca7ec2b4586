// Parts of a sweep: which samples and files they are, and the job of Slurm that draws them, before a Slurm that this file plays.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>

#include "scenarios/sweep/part_choice.hpp"
#include "scenarios/sweep/slurm_job.hpp"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kOddWords = {"plain",     "",       "two words",  "it's", "say \"x\"", "$HOME",  "`id`",    "a\\b",
                                            "line\nend", "*",      "#no remark", "!",    "~",         "$(id)",  "--x=y z", "'",
                                            "''",        "ümlaut", "tab\t",      ";",    "a&b",       "[1, 2]", "{a,b}"};

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

/// What is said when `act` is refused; empty where it is not.
template <class Act>
std::string slurmRefusal(const Act& act) {
  try {
    act();
  } catch (const UserError& e) {
    return e.what();
  }
  return "";
}

const Location kPart{"--part", 0, 0, -1};

TEST(PartChoice, IsReadAndRefused) {
  for (const auto& [text, part, of] : {std::tuple{"3/40", 3, 40}, {"0/1", 0, 1}, {"39/40", 39, 40}, {"999999/1000000", 999999, 1000000}}) {
    const PartChoice choice = readPartChoice(text, kPart);
    EXPECT_EQ(choice.part, part);
    EXPECT_EQ(choice.of, of);
    EXPECT_EQ(choice.text(), text);
  }
  for (const char* text : {"40/40",
                           "-1/4",
                           "3/0",
                           "a/b",
                           " 3/40",
                           "3/40 ",
                           "3 / 40",
                           "3/ 40",
                           "",
                           "/",
                           "3",
                           "3/",
                           "/40",
                           "3/40/2",
                           "+3/40",
                           "3.0/40",
                           "03/40",
                           "0x3/40",
                           "0/-1",
                           "0/1000001",
                           "0/99999999999999999999",
                           "4294967299/4294967336",
                           "3\\40",
                           "3/40\n"}) {
    const std::string said = slurmRefusal([&] { readPartChoice(text, kPart); });
    EXPECT_EQ(said.rfind("--part: '", 0), 0u) << "'" << text << "': " << said;
    EXPECT_NE(said.find("' is no part of a sweep; expected K/N, whole numbers"), std::string::npos) << said;
    EXPECT_NE(said.find("; fix: "), std::string::npos) << said;
  }
}

std::vector<int> numbersOf(const PartChoice& choice, const std::vector<int>& all) {
  std::vector<int> own;
  for (const int number : all)
    if (choice.has(number)) own.push_back(number);
  return own;
}

std::vector<int> countedTo(int count) {
  std::vector<int> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

// Expected: every sample is of one part and no other; parts differ by one sample at most where numbers have no gaps.
TEST(PartChoice, EverySampleIsOfOnePart) {
  for (const auto& [samples, of] : {std::pair{100, 7}, {5, 8}, {0, 3}, {1, 1}, {40, 40}}) {
    const std::vector<int> each = countedTo(samples);
    std::multiset<int> all;
    std::size_t fewest = 1000, most = 0;
    for (int part = 0; part < of; ++part) {
      const auto own = numbersOf({part, of}, each);
      all.insert(own.begin(), own.end());
      fewest = std::min(fewest, own.size()), most = std::max(most, own.size());
    }
    EXPECT_LE(most - fewest, 1u);
    EXPECT_EQ(std::vector<int>(all.begin(), all.end()), each);
  }
  // A sample is of its part by its number, whichever others there are.
  EXPECT_EQ(numbersOf({3, 40}, {3, 4, 40, 83, 84, 123, 2147483643}), (std::vector<int>{3, 83, 123, 2147483643}));
}

TEST(PartChoice, FilesOfPartsAreFound) {
  const TemporaryFolder folder;
  EXPECT_EQ(partFile("f", {3, 40}), fs::path("f/parts/part_3_of_40.sqlite"));
  EXPECT_EQ(partFilesIn(folder.path()).of, 0);
  fs::create_directories(folder.path() / "parts");
  EXPECT_EQ(partFilesIn(folder.path(), 40).of, 0);
  for (const char* name : {"parts/part_3_of_40.sqlite", "parts/part_0_of_40.sqlite", "parts/part_3_of_40.sqlite-journal", "parts/part_3_of_40.sqlite-wal",
                           "parts/part_40_of_40.sqlite", "parts/part_03_of_40.sqlite", "parts/part_of_.sqlite", "parts/part_.sqlite",
                           "parts/my_part_1_of_7.sqlite", "parts/part_1_of_7.csv"})
    folder.put(name, "x");
  const PartFiles found = partFilesIn(folder.path(), 40);
  EXPECT_EQ(found.of, 40);
  ASSERT_EQ(found.files.size(), 2u);
  EXPECT_EQ(found.files.at(0), partFile(folder.path(), {0, 40}));
  EXPECT_EQ(found.files.at(3), partFile(folder.path(), {3, 40}));
  const std::string parts = (folder.path() / "parts").string();
  EXPECT_EQ(slurmRefusal([&] { partFilesIn(folder.path(), 20); }),
            parts +
                ": parts of another division lie here, of 40; expected none, or those of 20; fix: use 40 "
                "parts again, remove them, or choose another folder with --out");
  folder.put("parts/part_3_of_7.sqlite", "x");
  EXPECT_EQ(
      slurmRefusal([&] { partFilesIn(folder.path()); }),
      parts + ": parts of several divisions lie here, of 7 and of 40; expected those of one; fix: remove the others, or choose another folder with --out");
  fs::remove(folder.path() / "parts/part_3_of_7.sqlite");
  fs::create_directories(folder.path() / "parts/part_9_of_40.sqlite");
  EXPECT_NE(slurmRefusal([&] { partFilesIn(folder.path()); }).find("has the name of a part, and is no file"), std::string::npos);
  const TemporaryFolder other;
  other.put("parts", "a file");
  EXPECT_NE(slurmRefusal([&] { partFilesIn(other.path()); }).find("cannot be looked through"), std::string::npos);
}

TEST(SlurmJob, RangesAreCompact) {
  EXPECT_EQ(taskRanges({0, 1, 2, 5, 7, 8, 9, 10}), "0-2,5,7-10");
  EXPECT_EQ(taskRanges({4}), "4");
  EXPECT_EQ(taskRanges({9, 3, 4, 3, 8}), "3-4,8-9");
  EXPECT_EQ(taskRanges(countedTo(1000)), "0-999");
  EXPECT_EQ(partsLeft(6, [](int part) { return part % 2 == 1; }), (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(partsLeft(3, [](int) { return true; }), std::vector<int>());
}

/// A folder whose name says all that a shell and Slurm's own reader may take for more than it is.
constexpr const char* kOddFolder = "it's a \"sweep\" of 50%a $HOME `id` #1";

class SlurmScript : public ::testing::Test {
 protected:
  SlurmWish wish() const {
    SlurmWish w;
    w.program = folder_.path() / "the 'program'";
    w.sweepFile = folder_.path() / "sweep $1.yaml";
    w.out = folder_.path() / kOddFolder;
    w.parts = 40;
    return w;
  }
  const TemporaryFolder folder_;
};

TEST_F(SlurmScript, IsAJobOfTasks) {
  SlurmWish w = wish();
  w.options = {"--partition=fast", "--comment=the 2\" lens", "--exclusive"};
  w.home = "/opt/pit viper";
  const std::string text = slurmScript(w, {0, 1, 2, 5, 39});
  EXPECT_EQ(text.rfind("#!/bin/bash\n", 0), 0u);
  for (const char* line : {"#SBATCH --array=0-2,5,39\n", "#SBATCH --requeue\n", "#SBATCH --open-mode=append\n", "#SBATCH --cpus-per-task=2\n",
                           "#SBATCH \"--partition=fast\"\n", "#SBATCH \"--comment=the 2\\\" lens\"\n", "#SBATCH \"--exclusive\"\n",
                           "export PITVIPER_HOME='/opt/pit viper'\n", " --part \"${SLURM_ARRAY_TASK_ID}/40\"\n"})
    EXPECT_NE(text.find(line), std::string::npos) << line << "in\n" << text;
  // Slurm fills in what follows a percent sign: those of the folder are doubled.
  EXPECT_NE(text.find("#SBATCH --output=\"" + folder_.path().string() + "/it's a \\\"sweep\\\" of 50%%a $HOME `id` #1/logs/part_%a.log\"\n"), std::string::npos)
      << text;
  // Options come behind the sweep's own, which they replace so, and all before the first command, behind which Slurm reads none.
  EXPECT_LT(text.find("--cpus-per-task"), text.find("--partition"));
  EXPECT_LT(text.rfind("#SBATCH"), text.find("\nexport"));
  const std::string merge = mergeScript(w);
  EXPECT_EQ(merge.find("--array"), std::string::npos);
  for (const char* line : {"#SBATCH --kill-on-invalid-dep=no\n", "#SBATCH \"--partition=fast\"\n", "/logs/merge.log\"\n", " --merge\n"})
    EXPECT_NE(merge.find(line), std::string::npos) << line << "in\n" << merge;
}

TEST_F(SlurmScript, BashReadsWordsAsTheyWere) {
  for (const std::string& word : kOddWords) {
    const Result said = run("bash -c " + shellWord("printf '%s|' " + shellWord(word) + " " + shellWord(word)));
    EXPECT_EQ(said.code, 0);
    EXPECT_EQ(said.output, word + "|" + word + "|");
  }
  EXPECT_EQ(shellWord("/a/b-1.yaml"), "/a/b-1.yaml");
}

// The script run as Slurm runs it: the program gets the words that it would be given by hand.
TEST_F(SlurmScript, RunsTheProgramWithItsWords) {
  SlurmWish w = wish();
  w.carried = kOddWords;
  w.home = folder_.path() / "home's";
  folder_.put("the 'program'", "#!/bin/bash\nprintf '%s|' \"$@\" \"$PITVIPER_HOME\" \"$LP_NUM_THREADS\"\n");
  fs::permissions(w.program, fs::perms::owner_all);
  std::string words;
  for (const std::string& word : kOddWords) words += word + "|";
  const std::string sweep = "sweep|" + w.sweepFile.string() + "|--out|" + w.out.string() + "|", behind = words + w.home.string() + "|3|";
  const std::string script = folder_.put("job", slurmScript(w, {7})), merge = folder_.put("merge", mergeScript(w));
  for (const std::string& file : {script, merge}) EXPECT_EQ(run("bash -n " + file).output, "");
  const std::string environment = "env -u LP_NUM_THREADS SLURM_ARRAY_TASK_ID=7 SLURM_CPUS_PER_TASK=3 bash ";
  EXPECT_EQ(run(environment + script).output, sweep + "--part|7/40|" + behind);
  EXPECT_EQ(run(environment + merge).output, sweep + "--merge|" + behind);
}

TEST_F(SlurmScript, RefusesWhatSlurmWouldMisread) {
  for (const char* option : {"-p fast", "--partition fast", "partition=fast", "--", "", "--comment=a\n#SBATCH --array=0-9", "--Partition=x"}) {
    SlurmWish w = wish();
    w.options = {option};
    EXPECT_NE(slurmRefusal([&] { slurmScript(w, {0}); }).find("is no option of sbatch in its long form; expected --name=value or --name; fix: "),
              std::string::npos)
        << option;
  }
  for (const char* option : {"--array=0-3", "--job-name=mine", "--wrap=true"}) {
    SlurmWish w = wish();
    w.options = {option};
    EXPECT_NE(slurmRefusal([&] { slurmScript(w, {0}); }).find("the sweep needs --"), std::string::npos) << option;
  }
  for (const char* name : {"back\\slash", "line\nend"}) {
    SlurmWish w = wish();
    w.out = name;
    EXPECT_NE(slurmRefusal([&] { slurmScript(w, {0}); }).find("Slurm can name no file in a folder"), std::string::npos) << name;
  }
}

/// Programs of Slurm's names on PATH that keep what they are asked and answer as a test says.
class SlurmSubmit : public SlurmScript {
 protected:
  void SetUp() override {
    before_ = std::getenv("PATH");
    fs::create_directories(bin());
    setenv("PATH", (bin().string() + ":" + before_).c_str(), 1);
    // Numbers its jobs from 11; a file 'refuse' is what it says instead, of the job whose number is in 'refused'.
    program("sbatch", "cd " + shellWord(folder_.path().string()) +
                          "\n{ printf '%s|' \"$@\"; echo \"job name ${SBATCH_JOB_NAME:-none}\"; } >> asked\n"
                          "count=$(wc -l < asked); number=$((10 + count))\n"
                          "if [ \"$(cat refused 2>/dev/null)\" = $number ]; then cat refuse >&2; exit 1; fi\n"
                          "cat before 2>/dev/null\necho $number$(cat behind 2>/dev/null)\n");
    program("squeue", "cd " + shellWord(folder_.path().string()) +
                          "\nprintf '%s|' \"$@\" > queue_asked\ncat queue 2>/dev/null\ntest ! -f queue_broken || { cat queue_broken >&2; exit 1; }\n");
  }
  void TearDown() override { setenv("PATH", before_.c_str(), 1); }
  void program(const std::string& name, const std::string& text) const {
    const std::string file = folder_.put("bin/" + name, "#!/bin/bash\n" + text);
    fs::permissions(file, fs::perms::owner_all);
  }
  fs::path bin() const { return folder_.path() / "bin"; }
  std::string file(const std::string& name) const { return contentOf(folder_.path() / name); }
  std::string kept() const { return contentOf(wish().out / "slurm_job.txt"); }
  std::string refused(const std::vector<int>& parts = {0, 1}) const {
    return slurmRefusal([&] { submit(wish(), parts); });
  }
  /// Its place, which leads the message, left out.
  std::string refusedOf(const std::string& name) const {
    const std::string place = (wish().out / name).string() + ": ", said = refused();
    EXPECT_EQ(said.rfind(place, 0), 0u) << said;
    return said.substr(std::min(place.size(), said.size()));
  }
  std::string before_;
};

TEST_F(SlurmSubmit, SubmitsTheSweepAndItsMerge) {
  setenv("SBATCH_JOB_NAME", "another", 1);  // would be the job's otherwise, and nobody would find it again
  const SubmittedJob job = submit(wish(), {0, 1, 2, 5});
  unsetenv("SBATCH_JOB_NAME");
  EXPECT_EQ(job.job, "11");
  EXPECT_EQ(job.mergeJob, "12");
  EXPECT_EQ(job.whyNoMerge, "");
  const fs::path out = wish().out;
  EXPECT_EQ(job.script, out / "sweep.sbatch");
  EXPECT_EQ(contentOf(job.script), slurmScript(wish(), {0, 1, 2, 5}));
  EXPECT_EQ(contentOf(out / "merge.sbatch"), mergeScript(wish()));
  EXPECT_TRUE(fs::is_directory(out / "logs"));
  EXPECT_EQ(file("asked"), "--parsable|" + job.script.string() + "|job name none\n--parsable|--dependency=afterany:11|" + (out / "merge.sbatch").string() +
                               "|job name none\n");
  EXPECT_TRUE(std::regex_match(kept(), std::regex("name pitviper-[0-9a-f]{12}\nsweep 11\nmerge 12\n"))) << kept();
  const std::string name = kept().substr(5, kept().find('\n') - 5);
  EXPECT_NE(contentOf(job.script).find("#SBATCH --job-name=" + name + "\n"), std::string::npos);
  EXPECT_NE(contentOf(out / "merge.sbatch").find("#SBATCH --job-name=" + name + "\n"), std::string::npos);
  EXPECT_EQ(file("queue_asked"), "");  // nothing was ever submitted from here
}

// Expected: a second job only when squeue lists none of this folder's name any more; then of just the parts that it is told.
TEST_F(SlurmSubmit, OneJobAtATime) {
  submit(wish(), {0, 1, 2});
  const std::string name = kept().substr(5, kept().find('\n') - 5);
  folder_.put("queue", "11\n11\n12\n");
  EXPECT_EQ(refusedOf("slurm_job.txt"),
            "jobs 11 12 of this folder are still in Slurm's queue; expected one job at a time: two would draw the same parts; fix: wait until squeue does not "
            "list them any more, or end it with scancel 11 12");
  EXPECT_EQ(file("queue_asked"), "--noheader|--name=" + name + "|--format=%F|");
  folder_.put("queue", "12\n");
  EXPECT_EQ(refusedOf("slurm_job.txt").rfind("job 12 of this folder is still in Slurm's queue", 0), 0u);
  folder_.put("queue", "");
  folder_.put("queue_broken", "slurm_load_jobs error: Unable to contact slurm controller (connect failure)\n");
  EXPECT_EQ(refusedOf("slurm_job.txt").rfind("cannot ask Slurm whether the job of this folder, 11, has ended: slurm_load_jobs error: Unable to contact", 0),
            0u);
  const std::string asked = file("asked");
  EXPECT_EQ(std::count(asked.begin(), asked.end(), '\n'), 2) << asked;  // those of the first job
  fs::remove(folder_.path() / "queue_broken");
  EXPECT_EQ(submit(wish(), {2}).job, "13");
  EXPECT_NE(contentOf(wish().out / "sweep.sbatch").find("#SBATCH --array=2\n"), std::string::npos);
  EXPECT_EQ(kept(), "name " + name + "\nsweep 13\nmerge 14\n");
  // The folder under another name: the job was submitted under the old one.
  fs::rename(wish().out, folder_.path() / "moved");
  folder_.put("queue", "13\n");
  SlurmWish moved = wish();
  moved.out = folder_.path() / "moved";
  EXPECT_NE(slurmRefusal([&] { submit(moved, {0}); }).find("job 13 of this folder is still"), std::string::npos);
  EXPECT_EQ(file("queue_asked"), "--noheader|--name=" + name + "|--format=%F|");
}

// Expected: whoever is killed between sbatch and its answer has left the job's name, by which it is found.
TEST_F(SlurmSubmit, AJobWithoutItsNumberIsFound) {
  program("sbatch", "cat " + shellWord((wish().out / "slurm_job.txt").string()) + " > " + shellWord((folder_.path() / "kept").string()) + "\nkill -9 $$\n");
  EXPECT_EQ(refusedOf("sweep.sbatch").rfind("sbatch refuses the job: it ended with 137 and said nothing", 0), 0u);
  EXPECT_TRUE(std::regex_match(file("kept"), std::regex("name pitviper-[0-9a-f]{12}\n"))) << file("kept");
  folder_.put("queue", "77\n");
  EXPECT_EQ(refusedOf("slurm_job.txt").rfind("job 77 of this folder is still in Slurm's queue", 0), 0u);
}

TEST_F(SlurmSubmit, AnotherProcessSubmits) {
  submit(wish(), {0});
  const int held = ::open((wish().out / "slurm_job.txt").c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(held, LOCK_EX), 0);
  EXPECT_EQ(refusedOf("slurm_job.txt"), "a job of this folder is being submitted by another process; expected one at a time; fix: wait until that has ended");
  ::close(held);
  EXPECT_EQ(refused(), "");
}

TEST_F(SlurmSubmit, TellsWhatSlurmSays) {
  folder_.put("refused", "11");
  folder_.put("refuse", "sbatch: error: invalid partition specified: fats\nsbatch: error: Batch job submission failed: Invalid partition name specified\n");
  EXPECT_EQ(
      refusedOf("sweep.sbatch"),
      "sbatch refuses the job: invalid partition specified: fats; Batch job submission failed: Invalid partition name specified; expected a job that this "
      "Slurm takes; fix: change it with --slurm-option, as --slurm-option '--partition=NAME'");
  folder_.put("refused", "12");
  folder_.put("refuse", "sbatch: error: Batch job submission failed: Invalid job array specification\n");
  EXPECT_NE(refusedOf("sweep.sbatch").find("; fix: use fewer --parts: `scontrol show config` has the most as MaxArraySize"), std::string::npos);
  // The merge alone: the sweep runs all the same, and that is told.
  folder_.put("refused", "14");
  folder_.put("refuse", "sbatch: error: QOSMaxSubmitJobPerUserLimit\n");
  const SubmittedJob job = submit(wish(), {0});
  EXPECT_EQ(job.job, "13");
  EXPECT_EQ(job.mergeJob, "");
  EXPECT_EQ(job.whyNoMerge, "QOSMaxSubmitJobPerUserLimit");
  EXPECT_EQ(kept().substr(kept().find('\n')), "\nsweep 13\n");
  // A site's greeting before the number, and a cluster's name behind it.
  folder_.put("before", "Welcome\n");
  folder_.put("behind", ";green");
  EXPECT_EQ(submit(wish(), {0}).job, "15");
  EXPECT_EQ(kept().substr(kept().find('\n')), "\nsweep 15\nmerge 16\ncluster green\n");
  submit(wish(), {0});
  EXPECT_NE(file("queue_asked").find("|--clusters=green|"), std::string::npos);
  folder_.put("behind", " is nothing");
  EXPECT_NE(refused().find("sbatch refuses the job: no number of a job, but '19 is nothing'"), std::string::npos);
}

TEST_F(SlurmSubmit, WithoutSlurm) {
  setenv("PATH", (folder_.path() / "empty").c_str(), 1);
  EXPECT_EQ(
      refused(),
      "--slurm: there is no sbatch on PATH; expected the programs of a Slurm that takes jobs from this machine; fix: say it where jobs are submitted, or draw "
      "the parts in another way: --part 0/N to --part N-1/N, then --merge");
  EXPECT_EQ(refusedOf("slurm_job.txt").rfind("cannot ask Slurm whether the job of this folder has ended: there is no squeue on PATH", 0), 0u);
}

TEST_F(SlurmSubmit, NothingLeftAndAForeignFile) {
  EXPECT_NE(refused({}).find("no part of the sweep is left to draw"), std::string::npos);
  fs::create_directories(wish().out);
  std::ofstream(wish().out / "slurm_job.txt") << "my own notes\n";
  EXPECT_EQ(refusedOf("slurm_job.txt").rfind("does not hold what this program keeps here", 0), 0u);
  EXPECT_EQ(kept(), "my own notes\n");
}

}  // namespace
}  // namespace pitviper::test
