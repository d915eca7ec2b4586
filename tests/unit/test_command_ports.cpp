// Commands from outside: what a line, or a datagram, comes to; what is no command is counted, told once, and changes nothing.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "sim/stream/cigi_world.hpp"
#include "sim/stream/command_models.hpp"
#include "sim/stream/command_port.hpp"
#include "sim/world/field_states.hpp"
#include "sim/world/world.hpp"

namespace pitviper::test {
namespace {

const char* const kScene = R"(
origin: {latitude: 36 deg, longitude: -6 deg, height: 100 m}
time: {rate: 100 Hz, frames: 100}

entities:
  - {name: jet, shape: {model: sphere, radius: 5 m}, material: grey_aircraft_paint, temperature: 300 K, position: [0 m, 1 km, 0 m]}
  - {name: pod, attached_to: jet, shape: {model: sphere, radius: 0.5 m}, material: grey_aircraft_paint, temperature: 310 K, position: [1 m, 2 m, 0 m]}
lights:
  - {name: flare, model: lamp, intensity: {library: mtv_flare, scale: 1}, radius: 5 cm, position: [0 m, 1 km, 10 m], level: [[0 s, 0], [0.1 s, 1], [1 s, 0]]}
cameras:
  - name: eye
    position: [0 m, 0 m, 0 m]
    look_at: jet
    film: {width: 8, height: 8, pitch: 15 um}
    focal_length: 50 mm
    aperture: 20 mm
    exposure: 1 ms
    channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}, quantum_efficiency: insb_mwir, output: counts}]
    stages: [{stage: detector, full_well: 1e6, bits: 14}]
)";

Simulation aScene() {
  std::string text = kScene;
  return scene(text);
}

/// A line-wise client of a Unix socket.
class Client {
 public:
  explicit Client(const std::string& path) : socket_(::socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un at{};
    at.sun_family = AF_UNIX;
    std::memcpy(at.sun_path, path.c_str(), path.size());
    connected = connect(socket_, reinterpret_cast<const sockaddr*>(&at), sizeof at) == 0;
    const timeval patience{10, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~Client() { close(socket_); }
  void send(const std::string& text) { EXPECT_EQ(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL), static_cast<ssize_t>(text.size())); }
  /// Empty at the connection's end.
  std::string line() {
    std::string text;
    for (char c = 0; recv(socket_, &c, 1, 0) == 1 && c != '\n';) text += c;
    return text;
  }
  bool connected = false;

 private:
  int socket_;
};

std::string ownSocket(const char* what) {
  return (std::filesystem::temp_directory_path() / ("pitviper_test." + std::to_string(getpid()) + "." + what)).string();
}

// Rationale: what reads, copies and prints values calls itself, a level a call. Expected: whatever of a line nests, lists or objects or both, under whatever
// key, is refused at the same depth, so that no stack, however small, ends; what a command may well have is taken.
TEST(JsonPort, RefusesWhatNestsDeep) {
  const Simulation sim = aScene();
  CommandInbox inbox([](const std::string&) {});
  const std::string path = ownSocket("deep");
  const auto port = openJsonPort({path, true, 1.0, [] { return 0.0; }, {}, {}}, sim, inbox);
  Client c(path);
  ASSERT_TRUE(c.connected);
  const auto nested = [](const std::string& open, const std::string& close, std::size_t count, const std::string& inside) {
    std::string text;
    for (std::size_t k = 0; k < count; ++k) text += open;
    text += inside;
    for (std::size_t k = 0; k < count; ++k) text += close;
    return text;
  };
  const std::vector<std::pair<std::string, std::string>> kinds = {{"[", "]"}, {"{\"a\":", "}"}, {"[{\"a\":", "}]"}, {"{\"a\":[", "]}"}, {"[1,", "]"}};
  for (const char* key : {"id", "host_frame", "status", "position"})
    for (const auto& [open, close] : kinds)
      for (const std::size_t count : {66u, 500u, 4000u}) {
        c.send("{\"" + std::string(key) + "\":" + nested(open, close, count, "1") + "}\n");
        const std::string answer = c.line();
        EXPECT_NE(answer.find("more than 64 deep"), std::string::npos) << key << open << count << answer;
      }
  c.send("{\"id\":" + std::string(32000, '[') + std::string(32000, ']') + "}\n");
  EXPECT_NE(c.line().find("more than 64 deep"), std::string::npos);
  c.send(std::string(60000, '[') + "\n");  // nor is it whole
  EXPECT_NE(c.line().find("error"), std::string::npos);
  for (const auto& [open, close] : kinds) {
    const std::string id = nested(open, close, 20, "1");
    c.send("{\"id\":" + id + "}\n");
    EXPECT_EQ(c.line(), "{\"id\":" + id + ",\"ok\":true}");
  }
}

TEST(JsonPort, TakesCommandsWithAScenariosWordsAndAnswersMistakes) {
  const Simulation sim = aScene();
  std::vector<std::string> log;
  CommandInbox inbox([&](const std::string& line) { log.push_back(line); });
  const std::string path = ownSocket("json");
  double now = 5.0;
  const auto port = openJsonPort({path, true, 1.0, [&] { return now; }, {}, {}}, sim, inbox);
  struct stat status {};
  ASSERT_EQ(::stat(path.c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u);
  Client c(path);
  ASSERT_TRUE(c.connected);
  c.send(R"({"id": 7, "command": "move", "entity": "jet", "position": ["10 m", "20 m", "30 m"]})"
         "\n");
  EXPECT_EQ(c.line(), R"({"id":7,"ok":true})");
  auto taken = inbox.take();
  ASSERT_EQ(taken.size(), 1u);
  EXPECT_TRUE(std::isnan(taken[0].command.at_s)) << "from the tick that takes it";
  taken[0].command.at_s = 0.5;
  World world(sim);
  world.apply(taken[0].command, 50);
  EXPECT_EQ(world.at(0.5).entities[0].position, glm::dvec3(10.0, 20.0, 30.0));

  const std::vector<std::pair<std::string, std::string>> wrong = {
      {R"(nonsense)", "not a JSON object"},
      {R"([1, 2])", "not a JSON object"},
      {R"({"command": "blow"})", "there is no command"},
      {R"({"command": "move", "entity": "jte", "position": ["1 m", "2 m", "3 m"]})", "there is no entity"},
      {R"({"command": "temperature", "entity": "jet", "value": 300})", "unit"},
      {R"({"command": "gain", "camera": "eye", "factor": 0})", "factor"},
      {R"({"command": "light", "light": "flare", "level": "bright"})", "level"},
      {R"({"command": "light", "light": "flare", "level": 1, "extra": 1})", "extra"},
      {R"({"step": 0})", "step"},
      {R"({"step": -3})", "step"},
      {R"({"run": 1})", "true or false"},
      {R"({"end": true, "comand": "x"})", "command"},  // nothing of it is carried out
      {R"({"command": "gain", "camera": "eye", "factor": 2, "factor": 3})", "twice"},
      {R"({"command": "light", "light": "flare", "level": 1, "at": "1 s"})", "a command for 1"},  // 4 s ago
  };
  for (const auto& [text, says] : wrong) {
    c.send(text + "\n");
    const std::string answer = c.line();
    EXPECT_NE(answer.find("error"), std::string::npos) << text;
    EXPECT_NE(answer.find(says), std::string::npos) << text << " said " << answer;
  }
  EXPECT_TRUE(inbox.take().empty());
  EXPECT_FALSE(inbox.isEnding());
  EXPECT_EQ(inbox.counts()["malformed lines"], wrong.size() - 1);
  EXPECT_EQ(inbox.counts()["stale"], 1u);
  EXPECT_EQ(log.size(), 2u) << "once a kind";
  // Numbers of frames rise.
  c.send(R"({"id": 1, "host_frame": 9, "step": 1})"
         "\n");
  EXPECT_EQ(c.line(), R"({"id":1,"ok":true})");
  const auto step = inbox.waitForStep(1000000000);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->hostFrame, 9u);
  c.send(R"({"host_frame": 8, "step": 1})"
         "\n");
  EXPECT_NE(c.line().find("numbers that rise"), std::string::npos);
  port->tickDone({0, 9, 3, 0.03, step->ticket});
  const auto said = nlohmann::json::parse(c.line());
  EXPECT_EQ(said["frame"], 3);
  EXPECT_EQ(said["host_frame"], 9);
  // Steps before an end are taken.
  c.send("{\"step\": 2}\n{\"end\": true, \"id\": 4}\n");
  EXPECT_EQ(c.line(), R"({"id":4,"ok":true})");
  EXPECT_FALSE(inbox.isEnding());
  EXPECT_EQ(inbox.waitForStep(1000000)->ticks, 2u);
  EXPECT_TRUE(inbox.isEnding());
  // A line without end closes the connection, and nothing else.
  Client hostile(path);
  hostile.send(std::string(70000, 'x'));
  EXPECT_EQ(hostile.line(), "");
  c.send(R"({"id": 2})"
         "\n");
  EXPECT_EQ(c.line(), R"({"id":2,"ok":true})");
}

// A host moves a jet, opens its throttle, lets another fly faster and ejects a flare, line by line.
TEST(JsonPort, FlaresThrottlesAndSpeeds) {
  const Simulation sim = scene(std::string(kScene) + R"(
flares: [{name: decoy, type: mtv, from: jet, time: on_command, direction: [0, 0, -1], speed: 20 m/s}]
plumes: [{name: exhaust, on: jet, engine: turbofan_military}]
)");
  CommandInbox inbox;
  const std::string path = ownSocket("flight");
  const auto port = openJsonPort({path, true, 1.0, {}, {}, {}}, sim, inbox);
  Client c(path);
  ASSERT_TRUE(c.connected);
  const std::vector<std::string> lines = {
      R"({"id": 1, "command": "move", "entity": "jet", "position": ["10 m", "2 km", "300 m"], "velocity": ["0 m/s", "200 m/s", "0 m/s"], "heading": "0 deg"})",
      R"({"id": 2, "command": "throttle", "plume": "exhaust", "value": "0.3"})",
      R"({"id": 3, "command": "eject", "flare": "decoy"})",
  };
  for (std::size_t k = 0; k < lines.size(); ++k) {
    c.send(lines[k] + "\n");
    EXPECT_EQ(c.line(), "{\"id\":" + std::to_string(k + 1) + ",\"ok\":true}");
  }
  World world(sim);
  for (LiveCommand& live : inbox.take()) {
    live.command.at_s = 0.5;
    world.apply(live.command, 50);
  }
  const WorldState then = world.at(0.5), later = world.at(0.8);
  ASSERT_EQ(then.ejected.size(), 1u);
  const Trajectory& flown = *then.ejected.at(0)->path;
  EXPECT_LT(glm::length(flown.at(0.5).position - glm::dvec3(10.0, 2000.0, 300.0)), 1e-9);
  EXPECT_LT(glm::length(flown.velocityAt(0.5) - glm::dvec3(0.0, 200.0, -20.0)), 1e-9);
  EXPECT_LT(flown.at(0.8).position.y, 2060.0) << "drag";
  EXPECT_GT(later.lightLevels[1], 0.0);
  EXPECT_NE(fieldOf(later, 1), nullptr);
  EXPECT_NEAR(*later.throttles.at(0)->at(0.8), 0.3, 1e-12);
  EXPECT_LT(glm::length(later.velocities.at(0) - glm::dvec3(0.0, 200.0, 0.0)), 1e-9);
  for (const auto& [text, says] :
       std::vector<std::pair<std::string, std::string>>{{R"({"command": "eject", "flare": "decoi"})", "did you mean 'decoy'?"},
                                                        {R"({"command": "speed", "entity": "jet", "value": "100 m/s"})", "has no route"},
                                                        {R"({"command": "throttle", "plume": "exhaust", "value": "120 %"})", "value"}}) {
    c.send(text + "\n");
    const std::string answer = c.line();
    EXPECT_NE(answer.find(says), std::string::npos) << answer;
  }
}

TEST(JsonPort, RandomBytesNeitherStopItNorChangeAnything) {
  const Simulation sim = aScene();
  CommandInbox inbox;
  const std::string path = ownSocket("fuzz");
  const auto port = openJsonPort({path, true, 1.0, {}, {}, {}}, sim, inbox);
  std::mt19937 random(1);
  const std::string good = R"({"id": 1, "command": "move", "entity": "jet", "position": ["10 m", "20 m", "30 m"], "at": "1 s", "host_frame": 3})";
  const char* const asked = std::getenv("PITVIPER_FUZZ");
  const int rounds = asked ? std::atoi(asked) : 2000;
  std::size_t lines = 0;
  for (int k = 0; k < rounds; k += 100) {
    Client c(path);
    std::string text;
    for (int n = 0; n < 100; ++n) {
      std::string line = good;
      for (unsigned m = random() % 4 + 1; m > 0; --m) line[random() % line.size()] = static_cast<char>(random());
      if (random() % 3 == 0) line.resize(random() % line.size());
      if (random() % 20 == 0) line = std::string(random() % 3000, "[{\"0"[random() % 4]);
      text += line + "\n";
      ++lines;
    }
    c.send(text);
    c.send("{\"id\": \"last\"}\n");
    for (std::string answer; (answer = c.line()) != R"({"id":"last","ok":true})";) ASSERT_NE(answer, "") << "it hung up";
  }
  World world(sim);
  int tick = 0;
  for (LiveCommand& l : inbox.take()) {
    if (!(l.command.at_s <= 1.0)) l.command.at_s = 1.0;
    world.apply(l.command, 100 + tick++);
  }
  EXPECT_TRUE(std::isfinite(world.at(1000.0).entities[0].position.x));
  EXPECT_EQ(world.at(1000.0).entities[1].position - world.at(1000.0).entities[0].position,
            world.at(0.0 + 999.0).entities[1].position - world.at(999.0).entities[0].position);
}

TEST(Commands, AFlareGoesOffWhenItIsTriggered) {
  const Simulation sim = aScene();
  World world(sim);
  world.apply(commandOf({{"command", "trigger"}, {"light", "flare"}}, "test", sim, 3.0), 300);
  EXPECT_EQ(world.at(3.0).lightLevels[0], 0.0);
  EXPECT_NEAR(world.at(3.05).lightLevels[0], 0.5, 1e-12);
  EXPECT_NEAR(world.at(3.1).lightLevels[0], 1.0, 1e-12);
  EXPECT_EQ(world.at(4.5).lightLevels[0], 0.0) << "burnt out";
}

TEST(Commands, OneThatComesLateHoldsAsOfItsOwnTime) {
  const Simulation sim = aScene();
  World world(sim);
  // A pose of 0.98 s that goes on at 100 m/s, taken by the tick at 1 s: 2 m further; half an exposure later still on its way.
  Command c = commandOf({{"command", "move"}, {"entity", "jet"}, {"position", "0 m, 1 km, 0 m"}, {"velocity", "100 m/s, 0 m/s, 0 m/s"}}, "test", sim, 0.98);
  world.apply(c, 100);
  EXPECT_NEAR(world.at(1.0).entities[0].position.x, 2.0, 1e-9);
  EXPECT_NEAR(world.at(1.0005).entities[0].position.x, 2.05, 1e-9);
  EXPECT_NEAR(world.at(0.9995).entities[0].position.x, 1.95, 1e-9) << "an exposure begins before its tick";
}

// A host that only says where: frame by frame, as most do. What it ejects flies as fast as it came.
TEST(CigiWorld, EjectsFlaresAndSetsThrottles) {
  const Simulation sim = scene(std::string(kScene) + R"(
flares: [{name: decoy, type: mtv, from: jet, time: on_command, direction: [0, 0, -1], speed: 20 m/s}]
plumes: [{name: exhaust, on: jet, engine: turbofan_military}]
)");
  CigiWorld cigi(sim);
  World world(sim);
  std::vector<std::string> refused;
  const auto tell = [&](int tick, const std::vector<CigiChange>& changes) {
    std::vector<Command> commands;
    cigi.translate(changes, commands, [&](const std::string& says) { refused.push_back(says); });
    for (Command& c : commands) {
      c.at_s = sim.time.at(tick);
      world.apply(c, tick);
    }
  };
  CigiEntityPose jet;
  jet.entity = 1;
  jet.state = CigiEntityState::Active;
  jet.orientation = glm::quat_cast(sim.frame.ecefFromLocal());
  const double lat = 36.0 * M_PI / 180.0, lon = -6.0 * M_PI / 180.0;
  for (int tick = 0; tick <= 10; ++tick) {
    jet.geodetic = {lat + 1e-7 * tick, lon, 600.0};  // 0.64 m north in 10 ms
    tell(tick, {jet});
  }
  CigiComponent eject, throttle;
  eject.componentClass = throttle.componentClass = CigiComponentClass::System;
  eject.component = 3, eject.instance = 1;
  throttle.component = 4, throttle.instance = 1, throttle.wordCount = 2;
  throttle.words[0] = std::bit_cast<std::uint32_t>(0.25f);
  tell(10, {eject, throttle});
  EXPECT_TRUE(refused.empty());
  const WorldState now = world.at(sim.time.at(10));
  ASSERT_EQ(now.ejected.size(), 1u);
  // A meridian's radius at 36 degrees: 6357.4 km (WGS 84, a (1 - e^2)/(1 - e^2 sin^2)^(3/2)) and 600 m of height.
  const glm::dvec3 speed = now.ejected.at(0)->path->velocityAt(sim.time.at(10));
  EXPECT_NEAR(speed.y, 6358.0e3 * 1e-7 / 0.01, 0.02);
  EXPECT_NEAR(speed.x, 0.0, 1e-3);
  EXPECT_NEAR(speed.z, -20.0, 1e-3);
  EXPECT_NEAR(*now.throttles.at(0)->at(0.1), 0.25, 1e-9);
  eject.instance = 2;
  throttle.instance = 2;
  tell(11, {eject, throttle});
  ASSERT_EQ(refused.size(), 2u);
  EXPECT_NE(refused[0].find("flare 2 is none of 1 to 1"), std::string::npos) << refused[0];
  EXPECT_NE(refused[1].find("plume 2 is none of 1 to 1"), std::string::npos) << refused[1];
}

TEST(CigiWorld, PutsBodiesWhereTheHostHasThem) {
  const Simulation sim = aScene();
  CigiWorld cigi(sim);
  World world(sim);
  std::vector<std::string> refused;
  int tick = 0;
  const auto tell = [&](const std::vector<CigiChange>& changes) {
    std::vector<Command> commands;
    cigi.translate(changes, commands, [&](const std::string& says) { refused.push_back(says); });
    ++tick;
    for (Command& c : commands) {
      c.at_s = sim.time.at(tick);
      world.apply(c, tick);
    }
    return world.at(sim.time.at(tick));
  };
  // 0.01 degrees north of the origin, 500 m up, flying east, right wing down by 30 degrees.
  CigiEntityPose jet;
  jet.entity = 1;
  jet.state = CigiEntityState::Active;
  jet.geodetic = {36.01 * M_PI / 180.0, -6.0 * M_PI / 180.0, 600.0};
  // The north-west-up axes there, turned to the east.
  const double lat = jet.geodetic.latitude_rad, lon = jet.geodetic.longitude_rad;
  const glm::dvec3 up(std::cos(lat) * std::cos(lon), std::cos(lat) * std::sin(lon), std::sin(lat)), east(-std::sin(lon), std::cos(lon), 0.0),
      north = glm::cross(up, east);
  const double roll = M_PI / 6.0;
  const glm::dvec3 left = std::cos(roll) * north + std::sin(roll) * up, top = glm::cross(east, left);
  jet.orientation = glm::quat_cast(glm::dmat3(east, left, top));
  WorldState s = tell({jet});
  EXPECT_TRUE(refused.empty());
  // A meridian's arc at 36 degrees: 110.95 km a degree (WGS 84).
  EXPECT_NEAR(s.entities[0].position.y, 1109.5, 0.5);
  EXPECT_NEAR(s.entities[0].position.x, 0.0, 1e-6);
  EXPECT_NEAR(s.entities[0].position.z, 500.0, 0.2);
  const glm::dvec3 ahead = s.entities[0].orientation * glm::dvec3(1.0, 0.0, 0.0), wing = s.entities[0].orientation * glm::dvec3(0.0, -1.0, 0.0);
  EXPECT_NEAR(ahead.x, 1.0, 1e-9);
  EXPECT_NEAR(wing.z, -0.5, 2e-4) << "right wing down; the vertical turns by 0.01 degrees";
  EXPECT_NEAR(wing.y, -std::cos(roll), 2e-4);
  // What it carries goes with it: 1 m ahead, 2 m to the left of a body that flies east.
  EXPECT_NEAR(s.entities[1].position.x - s.entities[0].position.x, 1.0, 1e-6);
  // It goes on by a rate in its own axes, and turns.
  CigiRate rate;
  rate.entity = 1;
  rate.ownAxes = true;
  rate.linear_m_s = {200.0, 0.0, 0.0};
  rate.angular_rad_s = {0.0, 0.0, -M_PI};
  s = tell({rate});
  const double at_s = sim.time.at(tick);
  EXPECT_NEAR(world.at(at_s + 0.5).entities[0].position.x - s.entities[0].position.x, 100.0, 1e-6);
  // -pi about the own vertical is to the right: after half a second by 90 degrees, about the axis that is tilted with the wings: from east to right and down.
  const glm::dvec3 turned = world.at(at_s + 0.5).entities[0].orientation * glm::dvec3(1.0, 0.0, 0.0);
  EXPECT_NEAR(turned.y, -std::cos(roll), 2e-4);
  EXPECT_NEAR(turned.z, -std::sin(roll), 2e-4);
  // A pose without a rate goes on as the last one said: what comes between two messages is extrapolated.
  s = tell({jet});
  EXPECT_NEAR(world.at(sim.time.at(tick) + 0.1).entities[0].position.x - s.entities[0].position.x, 20.0, 1e-6);
  // Parts, components, views.
  CigiPart pod;
  pod.entity = 1, pod.part = 1, pod.enabled = true;
  pod.offsets.forward_m = 0.5;
  s = tell({pod});
  CigiComponent hot;
  hot.componentClass = CigiComponentClass::Entity;
  hot.instance = 1, hot.wordCount = 6;
  hot.words[0] = std::bit_cast<std::uint32_t>(450.0f);
  s = tell({hot});
  EXPECT_NEAR(s.temperatures_K[0][0], 450.0, 1e-4);
  CigiComponent lamp;
  lamp.componentClass = CigiComponentClass::System;
  lamp.component = 1, lamp.instance = 1, lamp.wordCount = 2;
  lamp.words[0] = std::bit_cast<std::uint32_t>(0.25f);
  EXPECT_NEAR(tell({lamp}).lightLevels[0], 0.25, 1e-9);
  CigiView view;
  view.view = 1;
  view.offsets.yaw_rad = M_PI / 2.0;
  view.offsets.pitch_rad = 0.1;
  s = tell({view});
  const Pose eye = cameraAt(sim.cameras[0], s).pose;
  const glm::dvec3 sight = eye.orientation * glm::dvec3(1.0, 0.0, 0.0);
  EXPECT_NEAR(sight.x, std::cos(0.1), 1e-9) << "90 degrees to the right of north";
  EXPECT_NEAR(sight.z, std::sin(0.1), 1e-9);
  CigiViewDefinition wide;
  wide.view = 0;
  wide.left_rad = -0.1, wide.right_rad = 0.1;
  EXPECT_NEAR(cameraAt(sim.cameras[0], tell({wide})).pinhole.focalLength_m, 0.5 * 8 * 15e-6 / std::tan(0.1), 1e-9);
  CigiSensor sensor;
  sensor.view = 1, sensor.gain = 1.0;
  EXPECT_NEAR(cameraAt(sim.cameras[0], tell({sensor})).gains.common, 10.0, 1e-9);
  EXPECT_TRUE(refused.empty()) << refused.front();
  // What cannot be is said.
  CigiEntityPose wrong = jet;
  for (int id : {0, 3, 65535}) {
    wrong.entity = id;
    tell({wrong});
  }
  wrong = jet;
  wrong.attached = true, wrong.parent = 2;
  tell({wrong});
  wrong = jet;
  wrong.state = CigiEntityState::Destroyed;
  tell({wrong});
  view.view = 9;
  tell({view});
  hot.words[0] = std::bit_cast<std::uint32_t>(-5.0f);
  tell({hot});
  lamp.instance = 7;
  tell({lamp});
  EXPECT_EQ(refused.size(), 8u);
}

TEST(CigiPort, AnswersItsHostAndCountsTheRest) {
  const Simulation sim = aScene();
  CommandInbox inbox;
  int s = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(s, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
  socklen_t size = sizeof own;
  getsockname(s, reinterpret_cast<sockaddr*>(&own), &size);
  const int hostPort = ntohs(own.sin_port), port = hostPort > 60000 ? hostPort - 2000 : hostPort + 2000;
  std::unique_ptr<CommandPort> cigi;
  try {
    cigi = openCigiPort(std::to_string(port), true, sim, inbox);
  } catch (const UserError&) {
    close(s);
    GTEST_SKIP() << "port " << port << " is taken";
  }
  own.sin_port = htons(static_cast<std::uint16_t>(port));
  const timeval patience{5, 0};
  setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const auto control = [&](std::uint32_t frame) {
    std::uint8_t packet[24] = {1, 24, 3, 0, 0x31, 0, 0x00, 0x80};
    std::memcpy(packet + 8, &frame, 4);
    sendto(s, packet, sizeof packet, 0, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  };
  control(5);
  auto step = inbox.waitForStep(5000000000);
  ASSERT_TRUE(step);
  EXPECT_EQ(step->hostFrame, 5u);
  cigi->tickDone({17, 5, 17, 0.17, step->ticket});
  std::uint8_t answer[64];
  ASSERT_EQ(recv(s, answer, sizeof answer, 0), 24);
  EXPECT_EQ(answer[0], 101);
  std::uint32_t number = 0;
  std::memcpy(&number, answer + 8, 4);
  EXPECT_EQ(number, 17u);
  std::memcpy(&number, answer + 16, 4);
  EXPECT_EQ(number, 5u) << "the host's frame";
  control(4);  // out of order
  control(5);  // again: its answer may be lost
  ASSERT_EQ(recv(s, answer, sizeof answer, 0), 24);
  std::mt19937 random(2);
  const char* const asked = std::getenv("PITVIPER_FUZZ");
  for (int k = 0, rounds = asked ? std::atoi(asked) : 2000; k < rounds; ++k) {
    std::uint8_t junk[80];
    for (auto& b : junk) b = static_cast<std::uint8_t>(random());
    sendto(s, junk, random() % sizeof junk, 0, reinterpret_cast<const sockaddr*>(&own), sizeof own);
  }
  // What a slow machine's socket has no room for is lost, as datagrams may be: a host asks again.
  step.reset();
  for (int k = 0; k < 100 && !step; ++k) {
    control(6);
    step = inbox.waitForStep(200000000);
  }
  ASSERT_TRUE(step);
  EXPECT_EQ(step->hostFrame, 6u);
  EXPECT_GE(inbox.counts()["stale CIGI"], 2u);
  EXPECT_GT(inbox.counts()["malformed CIGI"], 0u);
  EXPECT_FALSE(inbox.waitForStep(1000000)) << "nothing else was a step";
  cigi.reset();
  close(s);
}

}  // namespace
}  // namespace pitviper::test
