#pragma once
// A sweep's parts as tasks of a Slurm job, and one more job that merges what they left.
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pitviper {

struct SlurmWish {
  std::filesystem::path program, sweepFile, out;
  int parts = 1;
  std::vector<std::string> options = {};  ///< "--partition=x": each a line of #SBATCH, in both jobs
  std::vector<std::string> carried = {};  ///< further words of the command line, in both jobs
  std::filesystem::path home = {};        ///< PITVIPER_HOME in the jobs; empty: as where they are submitted
};

/// By the shell's rules one word that stands for `text`, whatever it holds.
std::string shellWord(const std::string& text);

/// "0-2,5,7-39"
std::string taskRanges(std::vector<int> tasks);

/// The parts from 0 on that `isComplete` does not say yes to.
std::vector<int> partsLeft(int parts, const std::function<bool(int part)>& isComplete);

/// What sbatch is given, as text: the array job in which task K draws part K, and the job that merges. Relative paths are of the working folder.
/// Errors: UserError where an option is none of sbatch's, or one that this program needs itself, and where Slurm cannot name files in `out`.
std::string slurmScript(const SlurmWish& wish, const std::vector<int>& partsToRun);
std::string mergeScript(const SlurmWish& wish);

struct SubmittedJob {
  std::string job;         ///< Slurm's number of the array job
  std::string mergeJob;    ///< and of the one that merges; empty: there is none
  std::string whyNoMerge;  ///< what Slurm said then
  std::filesystem::path script;
};

/// Writes OUT/sweep.sbatch and OUT/merge.sbatch and submits both, the second to run when all tasks of the first have ended. Of a folder one job at a time is in
/// Slurm's queue: OUT/slurm_job.txt keeps its name, from before it is submitted, and its numbers.
/// Errors: UserError where a job of this folder is in the queue, or may be, or is being submitted; where sbatch is not there or refuses, and what
/// slurmScript() refuses. OutputError.
SubmittedJob submit(const SlurmWish& wish, const std::vector<int>& partsToRun);

}  // namespace pitviper
