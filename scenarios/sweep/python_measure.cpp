#include "scenarios/sweep/python_measure.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "scenarios/reader/scenario_reader.hpp"

extern char** environ;

namespace pitviper {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kInterpreter = "/usr/bin/python3";  // the distribution's, for which its numpy is

Json numberOrNone(double v) { return std::isfinite(v) ? Json(v) : Json(); }

Json attributesOf(const Frame& frame) {
  Json all = Json::object();
  for (const Attribute& a : frame.attributes) std::visit([&](const auto& v) { all[a.name] = v; }, a.value);
  return all;
}

Json targetsOf(const Frame& frame) {
  Json all = Json::array();
  for (const TargetRow& t : frame.targets) {
    Json channels = Json::object();
    for (const TargetRow::Channel& c : t.channels)
      channels[c.channel] = {{"unit", c.unit},
                             {"own", numberOrNone(c.own)},
                             {"total", numberOrNone(c.total)},
                             {"contrast", numberOrNone(c.contrast)},
                             {"snr", numberOrNone(c.signalToNoise)},
                             {"saturated", c.saturated < 0 ? Json() : Json(c.saturated)}};
    all.push_back({{"name", t.name},
                   {"kind", t.kind},
                   {"column", numberOrNone(t.column)},
                   {"row", numberOrNone(t.row)},
                   {"box", {numberOrNone(t.left), numberOrNone(t.top), numberOrNone(t.right), numberOrNone(t.bottom)}},
                   {"range_m", numberOrNone(t.range_m)},
                   {"range_rate_m_s", numberOrNone(t.rangeRate_m_s)},
                   {"sight_rate_rad_s", {numberOrNone(t.sightRight_rad_s), numberOrNone(t.sightUp_rad_s)}},
                   {"visible", numberOrNone(t.visible)},
                   {"channels", std::move(channels)}});
  }
  return all;
}

Json factorsOf(const std::vector<SweepFactor>& factors, const Sample& sample) {
  Json all = Json::object();
  for (std::size_t k = 0; k < factors.size(); ++k)
    all[factors[k].name] = factors[k].choices.empty() ? Json(sample.values[k]) : Json(factors[k].choices[static_cast<std::size_t>(sample.values[k])]);
  return all;
}

}  // namespace

struct PythonMeasure::Process {
  pid_t id = 0;
  int requests = -1;
  std::FILE* answers = nullptr;

  Process(const std::string& server, const std::string& file, const std::string& function) {
    int in[2], out[2];
    if (::pipe2(in, O_CLOEXEC) != 0) throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    if (::pipe2(out, O_CLOEXEC) != 0) throw std::runtime_error(std::string("cannot make a pipe: ") + std::strerror(errno));
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, in[0], STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&files, out[1], STDOUT_FILENO);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    const std::string words[] = {kInterpreter, "-u", server, file, function};
    std::vector<char*> pointers;
    for (const std::string& w : words) pointers.push_back(const_cast<char*>(w.c_str()));
    pointers.push_back(nullptr);
    const int failed = ::posix_spawn(&id, kInterpreter, &files, &attributes, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
    ::close(in[0]);
    ::close(out[1]);
    requests = in[1];
    answers = ::fdopen(out[0], "r");
    if (failed != 0) id = 0;
  }
  ~Process() {
    ::close(requests);  // it ends with its requests
    if (answers) std::fclose(answers);
    if (id > 0) ::waitpid(id, nullptr, 0);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  bool send(const void* bytes, std::size_t count) const {
    const char* at = static_cast<const char*>(bytes);
    while (count > 0) {
      const ssize_t done = ::write(requests, at, count);
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) return false;
      at += done, count -= static_cast<std::size_t>(done);
    }
    return true;
  }

  /// Empty: it has ended.
  std::string receive() const {
    char* line = nullptr;
    std::size_t size = 0;
    const ssize_t count = ::getline(&line, &size, answers);
    std::string text = count > 0 ? std::string(line, static_cast<std::size_t>(count)) : std::string();
    std::free(line);
    return text;
  }
};

PythonMeasure::PythonMeasure(const Measure& measure) : measure_(measure) {
  ::signal(SIGPIPE, SIG_IGN);  // that it has ended is told by the write
  const std::filesystem::path server = findLibraries().materials.parent_path().parent_path() / "scenarios/python/measure_server.py";
  process_ = std::make_unique<Process>(server.string(), measure.file.string(), measure.function);
  const Json said = Json::parse(process_->receive(), nullptr, false);
  if (said.is_discarded() || !said.is_object())
    throw UserError(measure.where, "Python cannot measure", std::string(kInterpreter) + " with numpy", "install python3-numpy");
  if (said.contains("error"))
    throw UserError(measure.where, measure.file.string() + ": " + said["error"].get<std::string>(), "a function " + measure.function + "(frame, sample)",
                    "mend it there");
}

PythonMeasure::~PythonMeasure() = default;

std::vector<double> PythonMeasure::of(const Frame& frame, const std::vector<SweepFactor>& factors, const Sample& sample) {
  Json layers = Json::array();
  for (const FrameLayer& l : frame.layers) layers.push_back({{"name", l.name}, {"unit", l.unit}});
  const Json told = {{"width", frame.width},
                     {"height", frame.height},
                     {"camera", frame.camera},
                     {"number", frame.number},
                     {"time", frame.time_s},
                     {"layers", layers},
                     {"attributes", attributesOf(frame)},
                     {"targets", targetsOf(frame)},
                     {"sample", sample.number},
                     {"seed", sample.seed},
                     {"factors", factorsOf(factors, sample)}};
  const std::string line = told.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  bool sent = process_->send(line.data(), line.size());
  for (const FrameLayer& l : frame.layers) sent = sent && process_->send(l.pixels.data(), l.pixels.size() * sizeof(float));
  const std::string text = sent ? process_->receive() : std::string();
  const Json said = Json::parse(text, nullptr, false);
  const auto fail = [&](const std::string& what) -> UserError {
    return {measure_.where, measure_.file.string() + ", " + measure_.function + "(): " + what,
            std::to_string(measure_.names.size()) + (measure_.names.size() == 1 ? " number" : " numbers") + " for each frame", "mend it there"};
  };
  if (text.empty()) throw fail("Python has ended");
  if (said.is_object() && said.contains("error")) throw fail(said["error"].get<std::string>());
  if (!said.is_object() || !said.contains("values")) throw fail("it answers no numbers");
  std::vector<double> values;
  for (const Json& v : said["values"]) values.push_back(v.is_number() ? v.get<double>() : NAN);
  if (values.size() != measure_.names.size()) throw fail("it gives " + std::to_string(values.size()));
  return values;
}

}  // namespace pitviper
