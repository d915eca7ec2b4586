#include "scenarios/commands/child_run.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "scenarios/commands/process.hpp"

extern char** environ;

namespace pitviper {
namespace {

std::vector<std::string> environmentWith(const std::map<std::string, std::string>& own) {
  std::vector<std::string> all;
  for (char** variable = environ; *variable; ++variable) {
    const std::string text = *variable;
    if (!own.count(text.substr(0, text.find('=')))) all.push_back(text);
  }
  for (const auto& [name, value] : own) all.push_back(name + "=" + value);
  return all;
}

std::vector<char*> pointersTo(std::vector<std::string>& texts) {
  std::vector<char*> all;
  for (std::string& t : texts) all.push_back(t.data());
  all.push_back(nullptr);
  return all;
}

struct SpawnSettings {
  SpawnSettings() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
  }
  ~SpawnSettings() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  SpawnSettings(const SpawnSettings&) = delete;
  SpawnSettings& operator=(const SpawnSettings&) = delete;
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

}  // namespace

ChildResult runChild(const Arguments& arguments, const std::map<std::string, std::string>& environment) {
  std::vector<std::string> words{"pitviper"}, variables = environmentWith(environment);
  words.insert(words.end(), arguments.begin(), arguments.end());
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
  SpawnSettings settings;
  posix_spawn_file_actions_addopen(&settings.files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&settings.files, ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&settings.files, ends[1], STDERR_FILENO);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&settings.attributes, &none);  // this process's threads have theirs blocked: one waits for them
  posix_spawnattr_setflags(&settings.attributes, POSIX_SPAWN_SETSIGMASK);
  std::atomic<pid_t> child{0};
  std::atomic<bool> ended{false};
  const EndsItself ending([&] {
    ended = true;
    if (const pid_t now = child; now > 0) ::kill(now, SIGTERM);
  });
  pid_t made = 0;
  const int failed = ::posix_spawn(&made, "/proc/self/exe", &settings.files, &settings.attributes, pointersTo(words).data(), pointersTo(variables).data());
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    throw std::runtime_error(std::string("cannot start another process: ") + std::strerror(failed));
  }
  child = made;
  if (ended) ::kill(made, SIGTERM);
  ChildResult result;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(ends[0], buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    result.output.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(made, &status, 0) < 0 && errno == EINTR) {
  }
  child = 0;
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return result;
}

}  // namespace pitviper
