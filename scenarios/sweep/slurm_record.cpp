#include "scenarios/sweep/slurm_record.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <sstream>

#include "sim/image/atomic_file.hpp"
#include "sim/parameters/error.hpp"

namespace pitviper {

SlurmRecordFile::SlurmRecordFile(const std::filesystem::path& folder) {
  record_.file = folder / "slurm_job.txt";
  descriptor_ = ::open(record_.file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
  if (descriptor_ < 0) throw OutputError(record_.file, "cannot be opened", errno);
  try {
    // Where a file system has no locks, the queue is all that can be asked.
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
      throw UserError({record_.file.string(), 0, 0, -1}, "a job of this folder is being submitted by another process", "one at a time",
                      "wait until that has ended");
    read();
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

SlurmRecordFile::~SlurmRecordFile() { ::close(descriptor_); }

void SlurmRecordFile::read() {
  std::string text(4096, ' ');  // longer than four words are
  const ssize_t count = ::pread(descriptor_, text.data(), text.size(), 0);
  if (count < 0) throw OutputError(record_.file, "cannot be read", errno);
  text.resize(static_cast<std::size_t>(count));
  std::istringstream lines(text);
  bool isOwn = true;
  for (std::string key, value; lines >> key >> value;) {
    if (key == "name") record_.name = value;
    else if (key == "sweep") record_.job = value;
    else if (key == "merge") record_.mergeJob = value;
    else if (key == "cluster") record_.cluster = value;
    else isOwn = false;
  }
  if (!isOwn || (record_.name.empty() && !text.empty()))
    throw UserError({record_.file.string(), 0, 0, -1}, "does not hold what this program keeps here", "the name and the numbers of the jobs of this folder",
                    "remove it, when no job of this folder is in Slurm's queue");
}

void SlurmRecordFile::write(const SlurmRecord& record) {
  std::string text = "name " + record.name + "\n";
  if (!record.job.empty()) text += "sweep " + record.job + "\n";
  if (!record.mergeJob.empty()) text += "merge " + record.mergeJob + "\n";
  if (!record.cluster.empty()) text += "cluster " + record.cluster + "\n";
  // In its place, because the lock is this file's. Whoever is killed meanwhile leaves the name, which stands first and is a folder's own.
  if (::lseek(descriptor_, 0, SEEK_SET) != 0) throw OutputError(record_.file, "cannot be written to", errno);
  writeAll(descriptor_, text, record_.file);
  if (::ftruncate(descriptor_, static_cast<off_t>(text.size())) != 0 || ::fsync(descriptor_) != 0)
    throw OutputError(record_.file, "cannot be written to", errno);
}

}  // namespace pitviper
