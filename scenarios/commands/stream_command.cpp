#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/history_files.hpp"
#include "scenarios/commands/pose_files.hpp"
#include "scenarios/commands/process.hpp"
#include "scenarios/commands/progress.hpp"
#include "scenarios/commands/run_notes.hpp"
#include "scenarios/commands/run_sinks.hpp"
#include "scenarios/commands/stream_report.hpp"
#include "scenarios/commands/stream_self_test.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/gl/context.hpp"
#include "sim/parameters/print.hpp"
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

/// Frames are numbered by an int.
constexpr int kMostTicks = 2000000000;

/// What begins a tick.
struct Clock {
  StreamClock clock = StreamClock::RealTime;
  bool byTrigger = false, bySwap = false;
};

struct StreamOptions {
  DrawWish draw;
  Clock clock;
  std::optional<LatePolicy> late;
  std::optional<double> rate_Hz, duration_s, delay_s;
  std::optional<int> frames, priority;
  double stale_s = 1.0;
  std::vector<int> cores;
  bool endless = false, holds = false, history = false, drafts = false;
  std::string sharedMemory, gige, projectorTable, commands, cigi;
  std::vector<std::string> gstreamer, projectors;
};

/// "0,1".
void readCores(const std::string& text, const Location& where, std::vector<int>& cores) {
  std::istringstream in(text);
  for (std::string core; std::getline(in, core, ',');) {
    if (core.empty() || core.size() > 4 || core.find_first_not_of("0123456789") != std::string::npos)
      throw UserError(where, "no list of cores", "numbers from 0, such as 0,1", "write --cores 1");
    cores.push_back(std::stoi(core));
  }
}

StreamWish wishOf(const StreamOptions& o, const Simulation& sim) {
  StreamWish wish;
  wish.clock = o.clock.clock;
  wish.late = o.late.value_or(LatePolicy::Send);
  wish.ticks = static_cast<std::uint64_t>(sim.time.frames);
  if (o.frames.has_value() + o.duration_s.has_value() + o.endless > 1)
    throw UserError({"--frames, --duration, --endless", 0, 0, -1}, "more than one of them", "one, or none", "remove the others");
  if (o.frames) wish.ticks = static_cast<std::uint64_t>(*o.frames);
  if (o.duration_s) wish.ticks = static_cast<std::uint64_t>(std::clamp(std::round(*o.duration_s / sim.time.step_s), 1.0, double(kMostTicks)));
  if (o.endless || (wish.clock == StreamClock::Lockstep && !o.frames && !o.duration_s)) wish.ticks = 0;
  if (o.delay_s) wish.delay_ns = std::llround(1e9 * *o.delay_s);
  wish.holds = o.holds;
  wish.drafts = o.drafts;
  if (o.priority) wish.thread.fifoPriority = *o.priority;
  wish.thread.cores = o.cores;
  return wish;
}

/// "window", or the number of a monitor.
ProjectorWish projectorOf(const std::string& table, const std::string& text) {
  ProjectorWish wish;
  const bool number = !text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == std::string::npos;
  if (!number && text != "window")
    throw UserError({"--projector " + text, 0, 0, -1}, "no display", "'window', or the number of a monitor from 0", "write --projector 0");
  if (number) wish.monitor = std::stoi(text);
  if (!table.empty()) wish.levels = readProjectorTable(table);
  return wish;
}

/// Those of the scenario and of the command line, each so that it keeps nobody waiting.
std::vector<PlacedSink> sinksOf(const StreamOptions& o, const Simulation& sim, const SinkPlace& place, bool loses) {
  std::vector<PlacedSink> sinks;
  const auto add = [&](const SinkChoice& choice, const std::string& name) {
    auto sink = choice.make(sim, place);
    if (!sink->neverWaits()) sink = std::make_unique<QueuedSink>(std::move(sink), name, loses);
    sinks.push_back({std::move(sink), choice.where});
  };
  for (const SinkChoice& choice : sim.sinks) add(choice, "sink at " + choice.where.text());
  if (!o.sharedMemory.empty()) add(sinkNamed("shared_memory", sim, {{"name", o.sharedMemory}}), "");
  if (!o.gige.empty()) {
    SinkChoice gige = sinkNamed("gige", sim, {{"address", o.gige}});
    gige.where = {"--gige " + o.gige, 0, 0, -1};
    add(gige, "");
  }
  for (PlacedSink& placed : makePictures(sim, place, o.draw.pictures)) {
    placed.sink = std::make_unique<QueuedSink>(std::move(placed.sink), "pictures", loses);
    sinks.push_back(std::move(placed));
  }
  const auto forCameras = [&](const std::string& option, const std::vector<std::string>& texts, const auto& make) {
    if (texts.size() > sim.cameras.size()) throw UserError({option, 0, 0, -1}, "more of them than cameras", "one a camera, in their order", "remove one");
    for (std::size_t k = 0; k < texts.size(); ++k) sinks.push_back({make(sim.cameras[k], texts[k]), {option + " " + texts[k], 0, 0, -1}});
  };
  forCameras("--gstreamer", o.gstreamer, [&](const Camera& c, const std::string& text) { return makeGstreamerSink(sim, c, text); });
  forCameras("--projector", o.projectors,
             [&](const Camera& c, const std::string& text) { return makeProjectorSink(sim, c, projectorOf(o.projectorTable, text)); });
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

int stream(StreamOptions& o) {
  if (o.rate_Hz) o.draw.scenario.changes.push_back(print("time.rate=%.17g Hz", *o.rate_Hz));
  Simulation sim = o.draw.read();
  if (sim.cameras.empty())
    throw UserError({sim.file, 0, 0, -1}, "a scenario without cameras", "one camera at least: its frames are the stream", "add 'cameras:'");
  StreamWish wish = wishOf(o, sim);
  for (const auto& [option, given] : {std::pair{"--delay", wish.delay_ns > 0}, {"--hold", o.holds}, {"--late", o.late.has_value()}})
    if (given && wish.clock != StreamClock::RealTime)
      throw UserError({option, 0, 0, -1}, "frames of this clock are never late", "'--clock real-time', or 'vsync'", std::string("remove ") + option);
  const bool byTrigger = o.clock.byTrigger, isHeard = !o.commands.empty();
  if (o.clock.bySwap && o.projectors.empty())
    throw UserError({"--clock vsync", 0, 0, -1}, "there is no display whose clock it could be", "'--projector'", "add --projector 0");
  if (wish.clock == StreamClock::Lockstep && !byTrigger && !isHeard && o.cigi.empty())
    throw UserError({"--clock lockstep", 0, 0, -1}, "nobody could let the clock go on", "'--commands PLACE' or '--cigi PLACE' for the host that holds it",
                    "add --commands 7380, or use --clock free");
  o.draw.pictures.settle(sim);
  const bool reports = !o.draw.out.empty();
  const std::filesystem::path out = reports ? o.draw.out : "out";
  SinkPlace place{out, {}};
  if (!o.draw.overwrites) place.mayReplace = [&sim](const std::filesystem::path& file) { refuseForeignFile(file, sim); };
  const HistoryWish history{.tables = o.history};
  const bool writes = reports || !sim.sinks.empty() || o.draw.pictures.any();
  const bool loses = wish.clock == StreamClock::RealTime;
  // Threads of sinks and ports use what stands before them.
  CommandInbox inbox([](const std::string& line) { tell(line.c_str()); });
  std::atomic<double> now_s{sim.time.start_s};
  std::atomic<bool> streams{false};
  const auto sinks = sinksOf(o, sim, place, loses);
  if (byTrigger && !isHeard &&
      std::none_of(sinks.begin(), sinks.end(), [](const PlacedSink& s) { return dynamic_cast<ControllableSink*>(s.sink.get()) != nullptr; }))
    throw UserError({"--clock trigger", 0, 0, -1}, "nobody could trigger", "'--gige ADDRESS', or '--commands PLACE' for its pulses", "add --gige 127.0.0.1");
  if (writes) {
    const RunRange range{0, static_cast<int>(std::clamp<std::uint64_t>(wish.ticks, 1, 100000)) - 1};
    OwnFiles own;
    if (reports) {
      own = {out / "stream.json", out / "stream.html"};
      for (const Camera& c : sim.cameras)
        if (leavesPoses(c)) own.push_back(posesFileIn(out, c));
      for (const auto& file : HistoryFiles::filesIn(out, history)) own.push_back(file);
    }
    refuseClashes(sim, range, own, sinks);
    if (!o.draw.overwrites) refuseForeignFiles(sim, range, own, sinks);
    ensureWritableFolder(out);
  }
  Notes notes;
  noteScenario(sim, notes);
  for (const Camera& c : sim.cameras)
    if (c.spectralImage) notes.say("camera " + c.name + ": its spectral image is drawn by run, not by a stream");
  if (!sim.probes.empty()) notes.say("probes are read by run, not by a stream");
  std::vector<ControllableSink*> pulsed;  // complete before the stream begins
  std::vector<std::unique_ptr<CommandPort>> ports;
  if (isHeard) {
    JsonPortWish json{o.commands,
                      wish.clock == StreamClock::Lockstep && !byTrigger,
                      o.stale_s,
                      [&now_s] { return now_s.load(); },
                      {},
                      [&] {
                        if (byTrigger) inbox.step({});
                        if (streams)
                          for (ControllableSink* device : pulsed) device->pulse();
                      }};
    json.status = [&] { return streams ? statusOf(sim, now_s, sinks, inbox) : "{}"; };
    ports.push_back(openJsonPort(json, sim, inbox));
  }
  if (!o.cigi.empty()) ports.push_back(openCigiPort(o.cigi, wish.clock == StreamClock::Lockstep, sim, inbox));
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
    if (auto* projector = dynamic_cast<ProjectorSink*>(placed.sink.get()); projector && o.clock.bySwap && !wish.outsideClock)
      wish.outsideClock = [projector](std::uint64_t) { return projector->nextSwap(); };
  }
  std::vector<CommandPort*> heard;
  for (const auto& port : ports) heard.push_back(port.get());
  const EndsItself ending([&inbox] { inbox.end(); });
  std::map<std::string, GrowingFile> poses;
  if (reports)
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
      {{},
       [&](const Camera& c, double share) { progress->phase(share < 1.0 ? "planning camera " + c.name : "preparing", share < 1.0 ? share : 0.0); },
       flown ? [&flown](const Camera& c, const Frame& frame, const WorldState& world, const Pose& pose) { flown->look(c, frame, world, pose); }
             : decltype(RunProgress::drawn)()},
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
  result.late = wish.late == LatePolicy::Send ? "send" : wish.late == LatePolicy::Drop ? "drop" : "repeat";
  std::fputs(streamSummary(result).c_str(), stdout);
  if (reports) writeStreamReport(result, ownerMark(sim), out, place.mayReplace);
  constexpr int kUnaccounted = 3;
  return result.unaccounted() > 0 ? kUnaccounted : 0;
}

}  // namespace

CommandLine streamCommand() {
  const auto w = std::make_shared<StreamOptions>();
  const auto cores = [w](const std::string& text, const Location& where) { readCores(text, where, w->cores); };
  return {
      {"stream", "SCENARIO.yaml", "frames at a fixed rate to hardware and other programs, and commands from them"},
      "Frames of every camera at a fixed rate to other programs and to hardware, and commands from them. Plans and programs are made before the first frame. "
      "Without a way for frames (here, or in the scenario's 'sinks') they go to shared memory /pitviper. Ends after the scenario's frames, or as asked; SIGINT "
      "and SIGTERM end it after the frame it is at. Prints at the end what became of every frame, and its times; exit code 3 if one is unaccounted for.",
      joined(
          {{"", "", "Clock", {}},
           {"--clock", "CLOCK", "what begins a tick",
            oneOf(w->clock,
                  {{"real-time", {StreamClock::RealTime}, "tick n begins n periods after the first, by the machine's monotonic clock (default)"},
                   {"lockstep",
                    {StreamClock::Lockstep},
                    "simulated time moves when a host says so, by --commands or --cigi; frames are those of run, bit for bit; no end unless given one"},
                   {"free", {StreamClock::Free}, "as fast as it goes"},
                   {"trigger", {StreamClock::Lockstep, true}, "each pulse is a tick: a software trigger of --gige, or {\"pulse\": true} by --commands"},
                   {"vsync", {StreamClock::RealTime, false, true}, "each picture that the first --projector shows is a tick"}})},
           {"--rate", "'R Hz'", "in place of the scenario's 'time.rate'", number(w->rate_Hz, {1e-3, 1e6, "Hz"})},
           {"--frames", "N", "in place of the scenario's 'time.frames'", number(w->frames, {1, kMostTicks, "", false, "no number of frames"})},
           {"--duration", "'T s'", "the same, as time", number(w->duration_s, {0.0, 1e8, "s"})},
           {"--endless", "", "until it is told to end", into(w->endless)},
           {"--draft", "",
            "begin at once, by a draft's few groups (20 %; each frame says so, with the error to expect), and go over between two ticks to what was asked for, "
            "which is made beside: which tick that is differs from one stream to the next",
            into(w->drafts)},
           {"--delay", "'D ms'", "a frame is due so long after its tick began (default: a period)", number(w->delay_s, {1e-6, 10.0, "s"})},
           {"--hold", "", "and leaves then, not before: constant delay", into(w->holds)},
           {"--late", "WHAT", "becomes of what is not there when it is due",
            oneOf(
                w->late,
                {{"send", LatePolicy::Send, "it is sent as soon as it is (default)"},
                 {"drop", LatePolicy::Drop, "it is not sent"},
                 {"repeat", LatePolicy::Repeat,
                  "the picture before is sent in its place; a tick that could not be begun within a period (or the delay less one) is dropped, or repeated"}})},
           {"--fifo", "P", "SCHED_FIFO priority of the thread that draws, where the system lets it", number(w->priority, {1, 99, "", false, "no priority"})},
           {"--cores", "LIST", "and its cores, such as 0,1", {cores}},
           {"", "", "Frames to", {}},
           {"--shared-memory", "/NAME", "POSIX shared memory, of this user alone; sim/stream/ring/pitviper_stream.h says what is in it and is the reader in C",
            into(w->sharedMemory)},
           {"--gige", "ADDRESS",
            "each camera as a machine-vision camera, compatible with GVCP/GVSP, tested with Aravis, at this IPv4 address of the machine and those after it; "
            "clients set exposure and gain, and trigger. More of it: 'sink: gige' in the scenario",
            into(w->gige)},
           {"--gstreamer", "PIPELINE...",
            "a pipeline of the first camera (again: of the next) after 'appsrc', GRAY16_LE, as for gst-launch-1.0: 'videoconvert ! autovideosink'",
            into(w->gstreamer)},
           {"--projector", "DISPLAY...",
            "of the first camera (again: the next): 'window', or the number of a monitor that it fills; 16 bits, the high byte in red and the low one in green",
            into(w->projectors)},
           {"--projector-table", "FILE.csv", "instead grey of 8 bits by a table that was measured: columns 'code [1], level [1]'", into(w->projectorTable),
            "--projector"},
           {"--out", "FOLDER", "stream.json and stream.html, with a chart; created if missing", into(w->draw.out)},
           {"--history", "", "also history.csv and encounters.csv there", into(w->history), "--out"},
           {"",
            "",
            "Commands from (on this machine alone unless an address is given; what is malformed, stale or impossible is counted, ignored and told once a kind)",
            {}},
           {"--commands", "PLACE",
            "lines of JSON at a TCP port (7380, 0.0.0.0:7380) or a Unix socket (/tmp/pitviper.sock), with the words of a scenario's 'commands': {\"command\": "
            "\"move\", \"entity\": \"jet\", \"position\": [\"0 m\", \"1 km\", \"500 m\"]}, look, temperature, light, trigger, gain; with \"at\" for a time; "
            "\"id\" asks for an answer; \"host_frame\" comes back with the frame. {\"step\": 1} in lockstep, {\"run\": false} stops and {\"run\": true} starts "
            "real time, {\"follow\": true} asks for a line a frame, {\"status\": true}, {\"pulse\": true}, {\"end\": true}",
            into(w->commands)},
           {"--stale", "'T s'", "commands for a time so long ago are not carried out; younger ones are taken on to the frame's time",
            number(w->stale_s, {0.0, 1e9, "s"}), "--commands"},
           {"--cigi", "PLACE",
            "CIGI 3.3 at a UDP port (8004, 0.0.0.0:8004), Start of Frame back; IG mode standby stops, operate starts; in lockstep each IG Control is a step. "
            "What has which number: scenarios/README.md",
            into(w->cigi)},
           {"", "", "Scenario", {}}},
          drawOptions(w->draw)),
      [w](const Arguments& words) { return w->draw.scenario.file = words[0], stream(*w); },
      "What is slow has a queue, and skips frames in real time.\n"
      "'accuracy: {asked: 1 %, at_most: 3 %}' in the scenario: where the rate does not hold it draws coarser, up to that; frames say to what.\n"
      "scenarios/clients has a tracker, readers and a CIGI host."};
}

CommandLine selfTestCommand() {
  const auto w = std::make_shared<SelfTestWish>();
  return {{"stream --self-test", ""},
          "What each way takes on this machine, without drawing: 640x512 pixels, in a table.",
          {{"--rate", "'R Hz'", "of frames", number(w->rate_hz, {1.0, 1e4, "Hz"})},
           {"--duration", "'T s'", "for each way", number(w->duration_s, {0.1, 1e4, "s"})}},
          [w](const Arguments&) { return streamSelfTest(*w); }};
}

}  // namespace pitviper
