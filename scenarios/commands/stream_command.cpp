#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/history_files.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/pose_files.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "scenarios/commands/run_sinks.hpp"
#include "scenarios/commands/stream_report.hpp"
#include "scenarios/commands/stream_self_test.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/gl/context.hpp"
#include "sim/parameters/units.hpp"
#include "sim/run/memory_need.hpp"
#include "sim/run/stream_loop.hpp"
#include "sim/stream/clock/wall_clock.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/stream/controllable_sink.hpp"
#include "sim/stream/pipeline_sinks.hpp"
#include "sim/stream/projector_table.hpp"
#include "sim/stream/queued_sink.hpp"
#include "sim/stream/sink_models.hpp"

namespace pitviper {
namespace {

Location ofOption(const Options& o, const std::string& name) { return {name + " " + o.value(name), 0, 0, -1}; }

double quantity(const Options& o, const std::string& name, const std::string& unit, double low, double high, const std::string& example) {
  const auto q = splitQuantity(o.value(name));
  const auto value = q && !q->unit.empty() ? convert(*q, unit) : std::nullopt;
  if (!value || !(*value >= low && *value <= high))
    throw UserError(ofOption(o, name), "'" + o.value(name) + "' is no such quantity", "a number with its unit", "write " + name + " '" + example + "'");
  return *value;
}

template <class T>
T word(const Options& o, const std::string& name, const std::string& otherwise, const std::vector<std::pair<std::string, T>>& words) {
  const std::string asked = o.value(name, otherwise);
  std::vector<std::string> names;
  for (const auto& [text, value] : words) {
    if (text == asked) return value;
    names.push_back(text);
  }
  throw unknownWord(ofOption(o, name), name + " has no", asked, names);
}

std::vector<int> coresOf(const Options& o) {
  std::vector<int> cores;
  std::string text = o.value("--cores") + ",";
  for (std::size_t comma = 0; (comma = text.find(',')) != std::string::npos && o.has("--cores"); text.erase(0, comma + 1)) {
    const std::string core = text.substr(0, comma);
    if (core.empty() || core.size() > 4 || core.find_first_not_of("0123456789") != std::string::npos)
      throw UserError(ofOption(o, "--cores"), "no list of cores", "numbers from 0, such as 0,1", "write --cores 1");
    cores.push_back(std::stoi(core));
  }
  return cores;
}

/// Frames are numbered by an int.
constexpr double kMostTicks = 2e9;

StreamWish wishOf(const Options& o, const Simulation& sim) {
  StreamWish wish;
  wish.clock = word<StreamClock>(o, "--clock", "real-time",
                                 {{"real-time", StreamClock::RealTime},
                                  {"lockstep", StreamClock::Lockstep},
                                  {"free", StreamClock::Free},
                                  {"trigger", StreamClock::Lockstep},
                                  {"vsync", StreamClock::RealTime}});
  wish.late = word<LatePolicy>(o, "--late", "send", {{"send", LatePolicy::Send}, {"drop", LatePolicy::Drop}, {"repeat", LatePolicy::Repeat}});
  wish.ticks = static_cast<std::uint64_t>(sim.time.frames);
  if (o.has("--frames") + o.has("--duration") + o.has("--endless") > 1)
    throw UserError({"--frames, --duration, --endless", 0, 0, -1}, "more than one of them", "one, or none", "remove the others");
  if (o.has("--frames")) {
    const auto [a, b] = readRange(o.value("--frames"), "--frames");
    if (a != b || a < 1 || static_cast<double>(a) > kMostTicks)
      throw UserError(ofOption(o, "--frames"), "no number of frames", "a whole number from 1", "write --frames 6000");
    wish.ticks = static_cast<std::uint64_t>(a);
  }
  if (o.has("--duration"))
    wish.ticks = static_cast<std::uint64_t>(std::clamp(std::round(quantity(o, "--duration", "s", 0.0, 1e8, "60 s") / sim.time.step_s), 1.0, kMostTicks));
  if (o.has("--endless") || (wish.clock == StreamClock::Lockstep && !o.has("--frames") && !o.has("--duration"))) wish.ticks = 0;
  if (o.has("--delay")) wish.delay_ns = std::llround(1e9 * quantity(o, "--delay", "s", 1e-6, 10.0, "20 ms"));
  wish.holds = o.has("--hold");
  if (o.has("--fifo")) {
    const auto [a, b] = readRange(o.value("--fifo"), "--fifo");
    if (a != b || a < 1 || a > 99) throw UserError(ofOption(o, "--fifo"), "no priority", "1 to 99", "write --fifo 50");
    wish.thread.fifoPriority = static_cast<int>(a);
  }
  wish.thread.cores = coresOf(o);
  return wish;
}

/// "window", or the number of a monitor.
ProjectorWish projectorOf(const Options& o, const std::string& text) {
  ProjectorWish wish;
  const bool number = !text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == std::string::npos;
  if (!number && text != "window")
    throw UserError({"--projector " + text, 0, 0, -1}, "no display", "'window', or the number of a monitor from 0", "write --projector 0");
  if (number) wish.monitor = std::stoi(text);
  if (o.has("--projector-table")) wish.levels = readProjectorTable(o.value("--projector-table"));
  return wish;
}

/// Those of the scenario and of the command line, each so that it keeps nobody waiting.
std::vector<PlacedSink> sinksOf(const Options& o, const Simulation& sim, const SinkPlace& place, const PictureWish& pictures, bool loses) {
  std::vector<PlacedSink> sinks;
  const auto add = [&](const SinkChoice& choice, const std::string& name) {
    auto sink = choice.make(sim, place);
    if (!sink->neverWaits()) sink = std::make_unique<QueuedSink>(std::move(sink), name, loses);
    sinks.push_back({std::move(sink), choice.where});
  };
  for (const SinkChoice& choice : sim.sinks) add(choice, "sink at " + choice.where.text());
  if (o.has("--shared-memory")) add(sinkNamed("shared_memory", sim, {{"name", o.value("--shared-memory")}}), "");
  if (o.has("--gige")) {
    SinkChoice gige = sinkNamed("gige", sim, {{"address", o.value("--gige")}});
    gige.where = ofOption(o, "--gige");
    add(gige, "");
  }
  if (pictures.any()) {
    for (PlacedSink& placed : makePictures(sim, place, pictures)) {
      placed.sink = std::make_unique<QueuedSink>(std::move(placed.sink), "pictures", loses);
      sinks.push_back(std::move(placed));
    }
  }
  const auto forCameras = [&](const std::string& option, const auto& make) {
    const auto texts = o.values(option);
    if (texts.size() > sim.cameras.size()) throw UserError({option, 0, 0, -1}, "more of them than cameras", "one a camera, in their order", "remove one");
    for (std::size_t k = 0; k < texts.size(); ++k) sinks.push_back({make(sim.cameras[k], texts[k]), {option + " " + texts[k], 0, 0, -1}});
  };
  forCameras("--gstreamer", [&](const Camera& c, const std::string& text) { return makeGstreamerSink(sim, c, text); });
  forCameras("--projector", [&](const Camera& c, const std::string& text) { return makeProjectorSink(sim, c, projectorOf(o, text)); });
  if (sinks.empty()) add(sinkNamed("shared_memory", sim), "");
  return sinks;
}

/// What a client may ask for while it runs: a JSON object.
std::string statusOf(const Simulation& sim, double time_s, const std::vector<PlacedSink>& sinks, const CommandInbox& inbox) {
  nlohmann::ordered_json j = {{"status", true}, {"scenario", sim.name}, {"time_s", time_s}, {"commands", inbox.counts()}};
  for (const PlacedSink& placed : sinks)
    for (const SinkCounts& s : placed.sink->counts())
      j["sinks"].push_back({{"sink", s.sink}, {"taken", s.taken}, {"passed_on", s.passedOn}, {"skipped", s.skipped}});
  return j.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

int streamCommand(const Arguments& arguments) {
  std::vector<OptionSpec> specs{{"--clock"},
                                {"--rate"},
                                {"--frames"},
                                {"--duration"},
                                {"--endless", false},
                                {"--late"},
                                {"--delay"},
                                {"--hold", false},
                                {"--fifo"},
                                {"--cores"},
                                {"--shared-memory"},
                                {"--gige"},
                                {"--gstreamer", true, true},
                                {"--projector", true, true},
                                {"--projector-table"},
                                {"--commands"},
                                {"--cigi"},
                                {"--stale"},
                                {"--out"},
                                {"--history", false},
                                {"--set", true, true},
                                rootOption(),
                                {"--plan", true, true},
                                {"--poses", true, true},
                                {"--overwrite", false}};
  for (const OptionSpec& spec : pictureOptions()) specs.push_back(spec);
  specs.push_back({"--self-test", false});
  const Options o("stream", arguments, specs, 0, 1);
  if (o.has("--self-test")) {
    SelfTestWish test;
    if (o.has("--rate")) test.rate_hz = quantity(o, "--rate", "Hz", 1.0, 1e4, "60 Hz");
    if (o.has("--duration")) test.duration_s = quantity(o, "--duration", "s", 0.1, 1e4, "5 s");
    return streamSelfTest(test);
  }
  if (o.words().empty()) throw UserError({"stream", 0, 0, -1}, "no scenario", "a file, or '--self-test'", "write pitviper stream SCENARIO.yaml");
  std::vector<std::string> overrides = o.values("--set");
  if (o.has("--rate")) {
    quantity(o, "--rate", "Hz", 1e-3, 1e6, "100 Hz");
    overrides.push_back("time.rate=" + o.value("--rate"));
  }
  Simulation sim = readScenario(o.words()[0], overrides, findLibraries(), rootsOf(o));
  if (sim.cameras.empty())
    throw UserError({sim.file, 0, 0, -1}, "a scenario without cameras", "one camera at least: its frames are the stream", "add 'cameras:'");
  refuseBeyondMemory(sim);
  readPlans(o, sim);
  replayPoses(o, sim);
  StreamWish wish = wishOf(o, sim);
  const auto needs = [&](const char* option, const char* other) {
    if (o.has(option) && !o.has(other))
      throw UserError({option, 0, 0, -1}, std::string("it does nothing without ") + other, std::string("both, or none"),
                      std::string("add ") + other + ", or remove it");
  };
  needs("--projector-table", "--projector");
  needs("--stale", "--commands");
  needs("--history", "--out");
  for (const char* option : {"--delay", "--hold", "--late"})
    if (o.has(option) && wish.clock != StreamClock::RealTime)
      throw UserError({option, 0, 0, -1}, "frames of this clock are never late", "'--clock real-time', or 'vsync'", std::string("remove ") + option);
  const bool byTrigger = o.value("--clock") == "trigger", bySwap = o.value("--clock") == "vsync";
  if (bySwap && !o.has("--projector"))
    throw UserError({"--clock vsync", 0, 0, -1}, "there is no display whose clock it could be", "'--projector'", "add --projector 0");
  if (wish.clock == StreamClock::Lockstep && !byTrigger && !o.has("--commands") && !o.has("--cigi"))
    throw UserError({"--clock lockstep", 0, 0, -1}, "nobody could let the clock go on", "'--commands PLACE' or '--cigi PLACE' for the host that holds it",
                    "add --commands 7380, or use --clock free");
  const PictureWish pictures = readPictureWish(o, sim);
  const std::filesystem::path out = o.value("--out", "out");
  SinkPlace place{out, {}};
  if (!o.has("--overwrite")) place.mayReplace = [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); };
  const HistoryWish history{o.has("--history"), false, false};
  const bool writes = o.has("--out") || !sim.sinks.empty() || pictures.any();
  const bool loses = wish.clock == StreamClock::RealTime;
  // Threads of sinks and ports use what stands before them.
  CommandInbox inbox([](const std::string& line) { tell(line.c_str()); });
  std::atomic<double> now_s{sim.time.start_s};
  std::atomic<bool> streams{false};
  const auto sinks = sinksOf(o, sim, place, pictures, loses);
  if (byTrigger && !o.has("--commands") &&
      std::none_of(sinks.begin(), sinks.end(), [](const PlacedSink& s) { return dynamic_cast<ControllableSink*>(s.sink.get()) != nullptr; }))
    throw UserError({"--clock trigger", 0, 0, -1}, "nobody could trigger", "'--gige ADDRESS', or '--commands PLACE' for its pulses", "add --gige 127.0.0.1");
  if (writes) {
    const RunRange range{0, static_cast<int>(std::clamp<std::uint64_t>(wish.ticks, 1, 100000)) - 1};
    OwnFiles own;
    if (o.has("--out")) {
      own = {out / "stream.json", out / "stream.html"};
      for (const Camera& c : sim.cameras)
        if (leavesPoses(c)) own.push_back(posesFileIn(out, c));
      for (const auto& file : HistoryFiles::filesIn(out, history)) own.push_back(file);
    }
    refuseClashes(sim, range, own, sinks);
    if (!o.has("--overwrite")) refuseForeignFiles(sim, range, own, sinks);
    ensureWritableFolder(out);
  }
  Notes notes;
  noteMeshes(sim, notes);
  noteCuts(sim, notes);
  noteFog(sim, notes);
  noteFringes(sim, notes);
  for (const Camera& c : sim.cameras)
    if (c.spectralImage) notes.say("camera " + c.name + ": its spectral image is drawn by run, not by a stream");
  if (!sim.probes.empty()) notes.say("probes are read by run, not by a stream");
  std::vector<ControllableSink*> pulsed;  // complete before the stream begins
  std::vector<std::unique_ptr<CommandPort>> ports;
  if (o.has("--commands")) {
    JsonPortWish json{o.value("--commands"),
                      wish.clock == StreamClock::Lockstep && !byTrigger,
                      1.0,
                      [&now_s] { return now_s.load(); },
                      {},
                      [&] {
                        if (byTrigger) inbox.step({});
                        if (streams)
                          for (ControllableSink* device : pulsed) device->pulse();
                      }};
    json.status = [&] { return streams ? statusOf(sim, now_s, sinks, inbox) : "{}"; };
    if (o.has("--stale")) json.stale_s = quantity(o, "--stale", "s", 0.0, 1e9, "0.5 s");
    ports.push_back(openJsonPort(json, sim, inbox));
  }
  if (o.has("--cigi")) ports.push_back(openCigiPort(o.value("--cigi"), wish.clock == StreamClock::Lockstep, sim, inbox));
  const auto trigger = [&inbox, byTrigger] {
    if (byTrigger) inbox.step({});
  };
  ControllableSink::Controls controls{[&](const auto& words) {
                                        try {
                                          inbox.put({commandOf(words, "camera", sim, NAN), monotonic_ns(), 0});
                                        } catch (const UserError& e) {
                                          inbox.refuse("camera settings not possible", e.what());
                                        }
                                      },
                                      trigger};
  const GlContext context;
  std::vector<Sink*> taking;
  for (const PlacedSink& placed : sinks) {
    if (auto* device = dynamic_cast<ControllableSink*>(placed.sink.get())) {
      device->control(controls);
      pulsed.push_back(device);
    }
    placed.sink->start();
    taking.push_back(placed.sink.get());
    if (auto* projector = dynamic_cast<ProjectorSink*>(placed.sink.get()); projector && bySwap && !wish.outsideClock)
      wish.outsideClock = [projector](std::uint64_t) { return projector->nextSwap(); };
  }
  std::vector<CommandPort*> heard;
  for (const auto& port : ports) heard.push_back(port.get());
  const EndsItself ending([&inbox] { inbox.end(); });
  std::map<std::string, GrowingFile> poses;
  if (o.has("--out"))
    for (const Camera& c : sim.cameras)
      if (leavesPoses(c)) poses.try_emplace(c.name, posesFileIn(out, c)).first->second.append(tableMark(sim) + c.follower->recordHeader);
  wish.poses = [&poses](const Camera& c, const std::string& lines) {
    if (const auto file = poses.find(c.name); file != poses.end()) file->second.append(lines);
  };
  std::optional<HistoryFiles> flown;
  if (history.tables) flown.emplace(sim, out, history);
  std::optional<Progress> progress;
  progress.emplace(sim.name, static_cast<int>(wish.ticks));
  progress->phase("preparing");
  StreamResult result;
  result.report = streamFrames(
      sim, shaderLibrary(), wish, inbox, taking, heard,
      {{}, [&](const Camera& c, double share) { progress->phase(share < 1.0 ? "planning camera " + c.name : "preparing", share < 1.0 ? share : 0.0); },
       flown ? [&flown](const Camera& c, const Frame& frame, const WorldState& world, const Pose& pose) { flown->look(c, frame, world, pose); } : decltype(RunProgress::drawn)()},
      [&] {
        std::string places;
        for (const PlacedSink& placed : sinks)
          for (const SinkCounts& s : placed.sink->counts()) places += (places.empty() ? "" : ", ") + s.sink;
        for (const auto& port : ports) places += ", " + port->place();
        tell(("streaming " + sim.name + ": " + places).c_str());
        progress->phase("");
        streams = true;
      },
      [&](std::uint64_t tick) {
        now_s = sim.time.at(static_cast<int>(tick));
        progress->step();
      });
  streams = false;
  progress->phase("finishing");
  for (auto& [camera, file] : poses) file.keep(place.mayReplace);
  if (flown) flown->write(sim.name, place.mayReplace);
  for (const PlacedSink& placed : sinks) placed.sink->finish({});
  for (const PlacedSink& placed : sinks)
    for (const SinkCounts& s : placed.sink->counts()) result.sinks.push_back(s);
  progress->finish();
  result.commands = inbox.counts();
  result.renderer = context.limits().renderer;
  result.scenario = sim.name;
  result.late = o.value("--late", "send");
  std::fputs(streamSummary(result).c_str(), stdout);
  if (o.has("--out")) writeStreamReport(result, ownerMark(sim), out, place.mayReplace);
  constexpr int kUnaccounted = 3;
  return result.unaccounted() > 0 ? kUnaccounted : 0;
}

}  // namespace pitviper
