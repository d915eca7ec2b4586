#include "scenarios/sweep/slurm_job.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenarios/reader/builder.hpp"
#include "scenarios/sweep/other_program.hpp"
#include "scenarios/sweep/slurm_record.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/readable_text.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

/// A task draws on one processor while the other does what stands between two pictures; more tasks are worth more than more processors.
constexpr int kProcessorsPerTask = 2;

/// What sbatch takes from the environment before it looks into the script, and would make of the job another than is kept in mind.
const std::vector<std::string> kNotOfEnvironment = {"SBATCH_ARRAY_INX", "SBATCH_JOB_NAME", "SBATCH_WAIT", "SBATCH_NO_REQUEUE", "SBATCH_OPEN_MODE"};

bool isControl(char c) { return static_cast<unsigned char>(c) < 32 || c == 127; }

fs::path wholePath(const fs::path& path) { return fs::absolute(path).lexically_normal(); }

/// By the rules of #SBATCH lines one word that stands for `text`: in double quotes, where a backslash takes what follows as it is.
std::string sbatchWord(const std::string& text) {
  std::string word = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') word += '\\';
    word += c;
  }
  return word + '"';
}

void checkOption(const std::string& option) {
  const Location where{"--slurm-option '" + readable(option) + "'", 0, 0, -1};
  const std::string name = option.substr(0, option.find('='));
  const bool isName = name.size() > 2 && name.starts_with("--") && name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == name.npos;
  if (!isName || std::any_of(option.begin(), option.end(), isControl))
    throw UserError(where, "is no option of sbatch in its long form", "--name=value or --name", "write --slurm-option '--partition=NAME'");
  for (const std::string_view own : {"--array", "--job-name", "--wrap"})
    if (name == own) throw UserError(where, "the sweep needs " + name + " itself", "another option of sbatch", "remove it");
}

/// A name that no job of another folder has.
std::string jobName(const fs::path& out) { return "pitviper-" + sha256(wholePath(out).string()).substr(0, 12); }

/// `log`: in OUT/logs, as Slurm has names of files.
std::string scriptHead(const SlurmWish& wish, const std::string& about, const std::string& log, const std::vector<std::string>& own) {
  std::string logs = (wholePath(wish.out) / "logs").string();
  if (std::any_of(logs.begin(), logs.end(), [](char c) { return isControl(c) || c == '\\'; }))
    throw UserError({readable(wish.out.string()), 0, 0, -1}, "Slurm can name no file in a folder whose name has a backslash or a control character",
                    "another folder", "choose another one with --out");
  for (std::size_t at = 0; (at = logs.find('%', at)) != logs.npos; at += 2) logs.insert(at, 1, '%');
  std::string text = "#!/bin/bash\n# " + about + "\n#SBATCH --job-name=" + jobName(wish.out) + "\n";
  for (const std::string& line : own) text += "#SBATCH " + line + "\n";
  text += "#SBATCH --requeue\n#SBATCH --open-mode=append\n#SBATCH --output=" + sbatchWord(logs + "/" + log) + "\n#SBATCH --ntasks=1\n";
  text += "#SBATCH --cpus-per-task=" + std::to_string(kProcessorsPerTask) + "\n";
  for (const std::string& option : wish.options) {
    checkOption(option);
    text += "#SBATCH " + sbatchWord(option) + "\n";
  }
  if (!wish.home.empty()) text += "export PITVIPER_HOME=" + shellWord(wholePath(wish.home).string()) + "\n";
  return text + "export LP_NUM_THREADS=\"${LP_NUM_THREADS:-$SLURM_CPUS_PER_TASK}\"\n";
}

/// `task`: the words that are this job's.
std::string commandOf(const SlurmWish& wish, const std::string& task) {
  std::string line = "exec " + shellWord(wholePath(wish.program).string()) + " sweep " + shellWord(wholePath(wish.sweepFile).string()) + " --out " +
                     shellWord(wholePath(wish.out).string()) + " " + task;
  for (const std::string& word : wish.carried) line += " " + shellWord(word);
  return line + "\n";
}

/// One line of what a program of Slurm says: without its name before each.
std::string saidBy(const ProgramResult& result) {
  std::string said;
  for (std::string_view rest = result.errors.empty() ? result.output : result.errors; !rest.empty();) {
    const std::size_t length = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, length);
    rest.remove_prefix(std::min(length + 1, rest.size()));
    for (const std::string_view before : {"sbatch: ", "squeue: ", "error: "})
      if (line.starts_with(before)) line.remove_prefix(before.size());
    if (!line.empty()) said += (said.empty() ? "" : "; ") + readable(line);
  }
  return said.empty() ? "it ended with " + std::to_string(result.code) + " and said nothing" : said;
}

bool isNumber(std::string_view text) { return !text.empty() && text.find_first_not_of("0123456789") == text.npos; }

/// Numbers of the jobs of this name that are in the queue.
std::vector<std::string> jobsInQueue(const SlurmRecord& record) {
  std::vector<std::string> words{"squeue", "--noheader", "--name=" + record.name, "--format=%F"};
  if (!record.cluster.empty()) words.push_back("--clusters=" + record.cluster);
  const auto asked = runProgram(words);
  if (!asked || asked->code != 0)
    throw UserError({record.file.string(), 0, 0, -1},
                    "cannot ask Slurm whether the job of this folder" + (record.job.empty() ? "" : ", " + record.job + ",") +
                        " has ended: " + (asked ? saidBy(*asked) : "there is no squeue on PATH"),
                    "its answer: two jobs at once would draw the same parts",
                    "say it again where and when squeue answers; where that job cannot run any more, remove this file");
  std::vector<std::string> found;
  for (std::string_view rest = asked->output; !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(" \n"), rest.size());
    const std::string word(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (isNumber(word) && std::find(found.begin(), found.end(), word) == found.end()) found.push_back(word);
  }
  return found;
}

void requireNoneInQueue(const SlurmRecord& record) {
  if (record.name.empty()) return;
  const std::vector<std::string> jobs = jobsInQueue(record);
  if (jobs.empty()) return;
  std::string listed;
  for (const std::string& job : jobs) listed += (listed.empty() ? "" : " ") + job;
  throw UserError({record.file.string(), 0, 0, -1},
                  (jobs.size() == 1 ? "job " : "jobs ") + listed + " of this folder " + (jobs.size() == 1 ? "is" : "are") + " still in Slurm's queue",
                  "one job at a time: two would draw the same parts",
                  "wait until squeue does not list " + std::string(jobs.size() == 1 ? "it" : "them") + " any more, or end it with scancel " + listed);
}

struct SbatchAnswer {
  std::string job, cluster;
  std::string refused;  ///< why there is no job; empty: there is one
};

SbatchAnswer sbatch(std::vector<std::string> words) {
  words.insert(words.begin(), {"sbatch", "--parsable"});
  const auto result = runProgram(words, kNotOfEnvironment);
  if (!result)
    throw UserError({"--slurm", 0, 0, -1}, "there is no sbatch on PATH", "the programs of a Slurm that takes jobs from this machine",
                    "say it where jobs are submitted, or draw the parts in another way: --part 0/N to --part N-1/N, then --merge");
  SbatchAnswer answer;
  if (result->code != 0) {
    answer.refused = saidBy(*result);
    return answer;
  }
  // "12" or "12;cluster", behind what a site's own scripts may have printed.
  std::string_view text = result->output;
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.remove_suffix(1);
  text.remove_prefix(std::min(text.rfind('\n') + 1, text.size()));
  const std::size_t middle = std::min(text.find(';'), text.size());
  answer.job = text.substr(0, middle);
  answer.cluster = text.substr(std::min(middle + 1, text.size()));
  if (!isNumber(answer.job)) answer.refused = "no number of a job, but '" + readable(text) + "'";
  return answer;
}

}  // namespace

std::string shellWord(const std::string& text) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:,+@%-=";
  if (!text.empty() && text.find_first_not_of(kPlain) == text.npos) return text;
  std::string word = "'";
  for (const char c : text) {
    if (c == '\'') word += "'\\''";
    else word += c;
  }
  return word + "'";
}

std::string taskRanges(std::vector<int> tasks) {
  std::sort(tasks.begin(), tasks.end());
  tasks.erase(std::unique(tasks.begin(), tasks.end()), tasks.end());
  std::string text;
  for (std::size_t first = 0, next = 0; first < tasks.size(); first = next) {
    for (next = first + 1; next < tasks.size() && tasks[next] == tasks[next - 1] + 1;) ++next;
    text += (text.empty() ? "" : ",") + std::to_string(tasks[first]);
    if (next - first > 1) text += "-" + std::to_string(tasks[next - 1]);
  }
  return text;
}

std::vector<int> partsLeft(int parts, const std::function<bool(int part)>& isComplete) {
  std::vector<int> left;
  for (int part = 0; part < parts; ++part)
    if (!isComplete(part)) left.push_back(part);
  return left;
}

std::string slurmScript(const SlurmWish& wish, const std::vector<int>& partsToRun) {
  return scriptHead(wish, "Each task draws one part of a sweep and goes on where it was. `pitviper sweep ... --slurm`, said again, submits what is left.",
                    "part_%a.log", {"--array=" + taskRanges(partsToRun)}) +
         commandOf(wish, "--part \"${SLURM_ARRAY_TASK_ID}/" + std::to_string(wish.parts) + "\"");
}

std::string mergeScript(const SlurmWish& wish) {
  return scriptHead(wish, "Merges the parts of a sweep, and says which samples lack.", "merge.log", {"--kill-on-invalid-dep=no"}) + commandOf(wish, "--merge");
}

SubmittedJob submit(const SlurmWish& wish, const std::vector<int>& partsToRun) {
  const fs::path out = wholePath(wish.out), script = out / "sweep.sbatch", merge = out / "merge.sbatch";
  if (partsToRun.empty())
    throw UserError({"--slurm", 0, 0, -1}, "no part of the sweep is left to draw", "one that is not complete",
                    "merge what is there: write --merge instead of --slurm");
  const std::string text = slurmScript(wish, partsToRun), mergeText = mergeScript(wish);
  for (const fs::path& folder : {out, out / "logs", out / "parts"}) ensureWritableFolder(folder);
  SlurmRecordFile file(out);
  requireNoneInQueue(file.record());
  writeFileAtomically(script, text);
  writeFileAtomically(merge, mergeText);
  SlurmRecord record;
  record.name = jobName(out);
  file.write(record);
  const SbatchAnswer sweep = sbatch({script.string()});
  if (!sweep.refused.empty())
    throw UserError({script.string(), 0, 0, -1}, "sbatch refuses the job: " + sweep.refused, "a job that this Slurm takes",
                    sweep.refused.find("array") != std::string::npos ? "use fewer --parts: `scontrol show config` has the most as MaxArraySize"
                                                                     : "change it with --slurm-option, as --slurm-option '--partition=NAME'");
  record.job = sweep.job;
  record.cluster = sweep.cluster;
  file.write(record);
  const SbatchAnswer merging = sbatch({"--dependency=afterany:" + sweep.job, merge.string()});
  record.mergeJob = merging.refused.empty() ? merging.job : "";
  file.write(record);
  return {sweep.job, record.mergeJob, merging.refused, script};
}

}  // namespace pitviper
