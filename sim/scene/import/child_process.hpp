#pragma once
// Runs the import module in a child process, so that a reader that crashes, hangs or eats memory costs one UserError.
// Included by sim/scene/mesh_import.cpp and sim/scene/grid_import.cpp only. Not for Windows.
#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sim/scene/import/import_reply.hpp"
#include "sim/scene/mesh_cache.hpp"

#if defined(__SANITIZE_ADDRESS__)
#define PITVIPER_IMPORT_SANITIZED 1  // the sanitizer's shadow needs terabytes of address space, and its reports are wanted
#else
#define PITVIPER_IMPORT_SANITIZED 0
#endif

namespace pitviper {

/// What is wrong, over the pipe: 'E' and seven fields, each ended by a zero byte.
template <class Reply>
std::string encodeFailure(const Reply& reply) {
  std::string out = "E";
  for (const std::string& field : {reply.where.file, std::to_string(reply.where.line), std::to_string(reply.where.column), std::to_string(reply.where.byte),
                                   reply.wrong, reply.expected, reply.fix}) {
    for (char c : field) out += c == '\0' ? ' ' : c;
    out += '\0';
  }
  return out;
}

/// A reply over the pipe: 'M' and a serialized mesh with the files read for it, or a failure.
inline std::string encodeReply(const ImportReply& reply, const std::vector<NamedFile>& named) {
  return reply.failed ? encodeFailure(reply) : "M" + serializeMesh(reply.mesh, named);
}

/// Address space beyond what the process has now: 1 GiB and sixteen times the files, which the densest format (binary STL, 50 bytes a triangle, points
/// merged) stays below. Called again for files that the first one names.
inline void allowMemory(std::size_t fileBytes) {
  if (PITVIPER_IMPORT_SANITIZED) return;
  static rlim_t most = 0;
  rlimit limit{};
  if (most == 0) {
    unsigned long long pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    most = pages * static_cast<unsigned long long>(sysconf(_SC_PAGESIZE)) + (1ull << 30);
  }
  most += 16ull * fileBytes;
  getrlimit(RLIMIT_AS, &limit);
  limit.rlim_cur = std::min<rlim_t>(most, limit.rlim_max);
  setrlimit(RLIMIT_AS, &limit);
}

/// OBJ text was read at 20 MB/s on one slow core: a minute and a second per MB of the processor's own time is ample, whatever else the machine does.
inline rlim_t mostProcessor_s(std::size_t fileBytes) { return 60 + (fileBytes >> 20); }

inline ImportReply runModule(const ModuleOnDemand& module, const std::filesystem::path& file, const ImportRequest& request, const Location& askedAt) {
  ImportReply reply;
  std::string problem;
  void* function = functionIn(file, module.function, problem);
  if (function == nullptr) {
    reply.failed = true;
    reply.where = askedAt;
    reply.wrong = std::string(module.called) + " " + problem;
    reply.fix = module.toRun;
    return reply;
  }
  allowMemory(request.bytes.size());
  reinterpret_cast<ImportFunction>(function)(request, &reply);
  return reply;
}

/// Limits itself to what a file of that size can need, writes what `work()` returns, and ends.
template <class Work>
[[noreturn]] void childMain(int pipeEnd, pid_t parent, std::size_t fileBytes, const Work& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(1);
  sigset_t all;
  sigemptyset(&all);
  sigprocmask(SIG_SETMASK, &all, nullptr);  // the parent may wait for its signals in a thread that is not here
  const rlimit none{0, 0}, processor{mostProcessor_s(fileBytes), RLIM_INFINITY};
  setrlimit(RLIMIT_CORE, &none);
  setrlimit(RLIMIT_CPU, &processor);
  if (!PITVIPER_IMPORT_SANITIZED) {
    for (int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGXCPU}) std::signal(signal, SIG_DFL);
    if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0) {  // a library's last words are not for the user
      dup2(nowhere, STDOUT_FILENO);
      dup2(nowhere, STDERR_FILENO);
    }
  }
  try {
    const std::string bytes = work();
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = write(pipeEnd, bytes.data() + sent, bytes.size() - sent);
      if (count < 0 && errno != EINTR) _exit(1);
      if (count > 0) sent += static_cast<std::size_t>(count);
    }
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

/// Everything the child sends before the deadline; sets `late` if it is not done by then.
inline std::string readUntil(int pipeEnd, std::chrono::steady_clock::time_point deadline, bool& late) {
  std::string bytes;
  std::vector<char> block(1 << 16);  // the size of a pipe
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now());
    pollfd waited{pipeEnd, POLLIN, 0};
    const int ready = left.count() <= 0 ? 0 : poll(&waited, 1, static_cast<int>(left.count()));
    if (ready < 0 && errno == EINTR) continue;
    late = ready == 0;
    if (ready <= 0) return bytes;
    const ssize_t count = read(pipeEnd, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return bytes;
    bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// A reply 'E' with its seven fields, or none, as the UserError that it is. `what`: "mesh", "grid".
[[noreturn]] inline void throwReply(const std::string& bytes, const std::string& file, const std::string& failure, const char* what) {
  if (bytes.starts_with('E')) {
    std::vector<std::string> fields;
    for (std::size_t at = 1, end; (end = bytes.find('\0', at)) != std::string::npos; at = end + 1) fields.push_back(bytes.substr(at, end - at));
    if (fields.size() == 7)
      throw UserError(Location{fields[0], std::atoi(fields[1].c_str()), std::atoi(fields[2].c_str()), std::atoll(fields[3].c_str())}, fields[4],
                      fields[5].empty() ? std::string("a sound ") + what + " file" : fields[5],
                      fields[6].empty() ? "correct this place of the file, or export it again" : fields[6]);
  }
  throw UserError(Location{file}, "the reader failed on this file (" + failure + ")", "a sound file",
                  std::string("open and save it again in ") + (std::string(what) == "mesh" ? "a mesh editor" : "the program that wrote it"));
}

inline Mesh decodeReply(const std::string& bytes, const std::string& file, const std::string& failure, std::vector<NamedFile>& named) {
  if (bytes.starts_with('M'))
    if (std::optional<Mesh> mesh = deserializeMesh(std::string_view(bytes).substr(1), &named)) return std::move(*mesh);
  throwReply(bytes, file, failure, "mesh");
}

/// What `work()` returns in a child process; `failure`: why it may be nothing. Throws UserError where no process can be made.
template <class Work>
std::string bytesFromChild(std::size_t fileBytes, const Location& askedAt, const Work& work, std::string& failure) {
  // The child ends by its limit of processor time; this is for one that waits for something, however busy the machine: a disk that is gone, for instance.
  const auto deadline = std::chrono::steady_clock::now() + 30 * std::chrono::seconds(mostProcessor_s(fileBytes));
  int ends[2];
  const pid_t parent = getpid();
  if (pipe2(ends, O_CLOEXEC) != 0) throw UserError(askedAt, "no pipe to the file's reader could be made");
  const pid_t child = fork();
  if (child < 0) {
    close(ends[0]);
    close(ends[1]);
    throw UserError(askedAt, "no process for the file's reader could be started");
  }
  if (child == 0) childMain(ends[1], parent, fileBytes, work);
  close(ends[1]);
  bool late = false;
  std::string bytes = readUntil(ends[0], deadline, late);
  close(ends[0]);
  if (late) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  failure = "it ended without an answer";
  if (late || (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)) failure = "it took too long";
  else if (WIFSIGNALED(status)) failure = "it was ended by signal " + std::to_string(WTERMSIG(status));
  return late ? std::string() : bytes;
}

/// The mesh as the module read it: unchecked; `named`: the files that it read besides, through `beside`. Throws UserError.
template <class FilesBeside>
Mesh importInChild(const ModuleOnDemand& module, const std::filesystem::path& file, const ImportRequest& request, FilesBeside& beside,
                   std::vector<NamedFile>& named, const Location& askedAt) {
  const auto work = [&] {
    ImportRequest asked = request;
    asked.readNamed = [&beside](const std::string& name, std::string& bytes, std::string& problem) {
      if (!beside.read(name, bytes, problem)) return false;
      allowMemory(bytes.size());
      return true;
    };
    return encodeReply(runModule(module, file, asked, askedAt), beside.named());
  };
  std::string failure;
  const std::string bytes = bytesFromChild(request.bytes.size(), askedAt, work, failure);
  return decodeReply(bytes, request.file, failure, named);
}

}  // namespace pitviper
