#include "scenarios/sweep/other_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <utility>

extern char** environ;

namespace pitviper {
namespace {

/// A pipe whose ends close with it.
class StreamPipe {
 public:
  StreamPipe() {
    if (::pipe2(ends_.data(), O_CLOEXEC) != 0) throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
  }
  ~StreamPipe() {
    for (const int end : ends_)
      if (end >= 0) ::close(end);
  }
  StreamPipe(const StreamPipe&) = delete;
  StreamPipe& operator=(const StreamPipe&) = delete;
  int reading() const { return ends_[0]; }
  int writing() const { return ends_[1]; }
  void closeWriting() { ::close(std::exchange(ends_[1], -1)); }

 private:
  std::array<int, 2> ends_{-1, -1};
};

struct SpawnChoices {
  SpawnChoices() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnChoices() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnChoices(const SpawnChoices&) = delete;
  SpawnChoices& operator=(const SpawnChoices&) = delete;
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

/// Both at once: a program that fills one pipe waits until it is read.
void readToTheEnd(int one, std::string& oneText, int other, std::string& otherText) {
  std::array<pollfd, 2> open{pollfd{one, POLLIN, 0}, pollfd{other, POLLIN, 0}};
  const std::array<std::string*, 2> texts{&oneText, &otherText};
  std::array<char, 4096> buffer{};
  while (open[0].fd >= 0 || open[1].fd >= 0) {
    if (::poll(open.data(), open.size(), -1) < 0) {
      if (errno == EINTR) continue;
      throw std::runtime_error(std::string("cannot wait for another process: ") + std::strerror(errno));
    }
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (open[i].fd < 0 || open[i].revents == 0) continue;
      const ssize_t count = ::read(open[i].fd, buffer.data(), buffer.size());
      if (count > 0) texts[i]->append(buffer.data(), static_cast<std::size_t>(count));
      else if (count == 0 || errno != EINTR) open[i].fd = -1;
    }
  }
}

}  // namespace

std::optional<ProgramResult> runProgram(std::vector<std::string> words, const std::vector<std::string>& without) {
  std::vector<char*> arguments, variables;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  for (char** variable = environ; *variable != nullptr; ++variable) {
    const std::string text = *variable;
    if (std::find(without.begin(), without.end(), text.substr(0, text.find('='))) == without.end()) variables.push_back(*variable);
  }
  variables.push_back(nullptr);
  StreamPipe output, errors;
  SpawnChoices choices;
  posix_spawn_file_actions_addopen(&choices.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&choices.files, output.writing(), STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&choices.files, errors.writing(), STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&choices.attributes, &none);  // this process's threads have theirs blocked: one waits for them
  posix_spawnattr_setflags(&choices.attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failed = ::posix_spawnp(&child, arguments[0], &choices.files, &choices.attributes, arguments.data(), variables.data());
  if (failed == ENOENT) return std::nullopt;
  if (failed != 0) throw std::runtime_error("cannot start " + words[0] + ": " + std::strerror(failed));
  output.closeWriting();
  errors.closeWriting();
  ProgramResult result;
  readToTheEnd(output.reading(), result.output, errors.reading(), result.errors);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace pitviper
