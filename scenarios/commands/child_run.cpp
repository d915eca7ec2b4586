#include "scenarios/commands/child_run.hpp"

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
#include <exception>
#include <mutex>
#include <stdexcept>
#include <utility>

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

/// A process and the pipe that it writes into.
struct Child {
  pid_t process = 0;
  int output = -1;
};

Child started(const Arguments& arguments, std::vector<std::string>& variables) {
  std::vector<std::string> words{"pitviper"};
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
  Child child{0, ends[0]};
  const int failed =
      ::posix_spawn(&child.process, "/proc/self/exe", &settings.files, &settings.attributes, pointersTo(words).data(), pointersTo(variables).data());
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    throw std::runtime_error(std::string("cannot start another process: ") + std::strerror(failed));
  }
  return child;
}

}  // namespace

std::vector<ChildResult> runChildren(const std::vector<Arguments>& all, const std::map<std::string, std::string>& environment,
                                     const std::function<void()>& tick) {
  std::vector<std::string> variables = environmentWith(environment);
  std::vector<Child> children;
  std::vector<ChildResult> results(all.size());
  std::mutex mutex;
  bool ended = false;
  const auto end = [&](const Child& c) {
    if (c.process > 0) ::kill(c.process, SIGTERM);
  };
  const EndsItself ending([&] {
    const std::lock_guard lock(mutex);
    ended = true;
    std::for_each(children.begin(), children.end(), end);
  });
  std::exception_ptr notStarted;
  for (const Arguments& arguments : all) {
    const std::lock_guard lock(mutex);
    try {
      children.push_back(started(arguments, variables));
    } catch (const std::exception&) {
      notStarted = std::current_exception();
      std::for_each(children.begin(), children.end(), end);
      break;
    }
    if (ended) end(children.back());
  }
  constexpr int kTick_ms = 200;
  std::array<char, 4096> buffer{};
  for (;;) {
    std::vector<pollfd> pipes;
    for (const Child& c : children) pipes.push_back({c.output, POLLIN, 0});
    if (std::all_of(children.begin(), children.end(), [](const Child& c) { return c.output < 0; })) break;
    const int ready = ::poll(pipes.data(), pipes.size(), tick ? kTick_ms : -1);
    for (std::size_t k = 0; ready > 0 && k < children.size(); ++k) {
      if (pipes[k].fd < 0 || !pipes[k].revents) continue;
      const ssize_t count = ::read(pipes[k].fd, buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count > 0) {
        results[k].output.append(buffer.data(), static_cast<std::size_t>(count));
        continue;
      }
      ::close(std::exchange(children[k].output, -1));
    }
    if (tick) tick();
  }
  for (std::size_t k = 0; k < children.size(); ++k) {
    int status = 0;
    while (::waitpid(children[k].process, &status, 0) < 0 && errno == EINTR) {
    }
    const std::lock_guard lock(mutex);
    children[k].process = 0;
    results[k].code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  if (notStarted) std::rethrow_exception(notStarted);
  return results;
}

ChildResult runChild(const Arguments& arguments, const std::map<std::string, std::string>& environment) {
  return runChildren({arguments}, environment).front();
}

}  // namespace pitviper
