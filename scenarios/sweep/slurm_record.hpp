#pragma once
// Which job of Slurm a folder's sweep was submitted as: OUT/slurm_job.txt.
#include <filesystem>
#include <string>

namespace pitviper {

struct SlurmRecord {
  std::filesystem::path file = {};
  std::string name = {};      ///< of the jobs, known before they are submitted; empty: none was ever
  std::string job = {};       ///< number of the job that draws; empty: not known whether there is one
  std::string mergeJob = {};  ///< of the one that merges
  std::string cluster = {};   ///< empty: the one that Slurm's programs ask of themselves
};

/// The file, for one process at a time as long as the object lives.
class SlurmRecordFile {
 public:
  /// Errors: UserError where another process has it, or it is none of this program's; OutputError.
  explicit SlurmRecordFile(const std::filesystem::path& folder);
  ~SlurmRecordFile();
  SlurmRecordFile(const SlurmRecordFile&) = delete;
  SlurmRecordFile& operator=(const SlurmRecordFile&) = delete;

  /// As it was read.
  const SlurmRecord& record() const { return record_; }
  /// On the disk when it returns. Errors: OutputError.
  void write(const SlurmRecord& record);

 private:
  void read();
  SlurmRecord record_;
  int descriptor_ = -1;
};

}  // namespace pitviper
