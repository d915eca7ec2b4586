// Streams as users have them: frames of lockstep are those of a run; every frame is accounted for; clients that know nothing of this project open them.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "sim/image/exr.hpp"
#include "sim/image/png.hpp"
#include "sim/stream/ring/pitviper_stream.h"
#include "tests/support/run_program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

bool has(const std::string& program) { return run("command -v " + program).code == 0; }

/// A hot ball that goes across, as a detector counts it.
std::string scenario(const std::string& more = "") {
  return "name: ball\nseed: 3\ntime: {rate: 50 Hz, frames: 8}\nbackground: {temperature: 290 K}\nmaterials: {m: {components: []}}\n"
         "entities:\n- {name: ball, shape: {model: sphere, radius: 2 m}, material: m, temperature: 305 K, motion: [{time: 0 s, position: [1000 m, -3 m, 0 m]}, "
         "{time: 1 s, position: [1000 m, 30 m, 0 m]}]}\n"
         "limits: {range: [500 m, 2 km], temperature: [250 K, 400 K]}\n"
         "cameras:\n- {name: eye, film: {width: 40, height: 30, pitch: 15 um}, focal_length: 50 mm, f_number: 2, exposure: 2 ms, position: [0 m, 0 m, 0 m], "
         "heading: 90 deg, "
         "stages: [{stage: detector, full_well: 7e6, offset: 100, bits: 14, read_noise: 300}], channels: [{name: mw, response: {band: [3.6 um, 4.9 um]}, "
         "quantum_efficiency: 0.8, output: [counts, radiance]}]}\n" +
         more;
}

/// The program in the background; its output when it has ended.
class Background {
 public:
  explicit Background(const std::string& arguments, const std::string& environment = "") {
    // A client that fails must not leave it waiting for ever.
    thread_ = std::thread(
        [this, arguments, environment] { result_ = run(environment + " PITVIPER_HOME=" PITVIPER_SOURCE_DIR " timeout 60 " PITVIPER_PROGRAM " " + arguments); });
  }
  const Result& result() const {
    if (thread_.joinable()) thread_.join();
    return result_;
  }
  ~Background() { result(); }

 private:
  Result result_;
  mutable std::thread thread_;
};

class Stream : public ::testing::Test {
 protected:
  std::string file(const std::string& more = "") { return folder_.put("ball.yaml", scenario(more)); }
  std::string ring(const char* what) const { return "/pitviper.test." + std::to_string(getpid()) + "." + what; }
  std::string socket() const { return (folder_.path() / "commands").string(); }
  fs::path out() const { return folder_.path() / "out"; }
  nlohmann::json report() const {
    std::ifstream in(out() / "stream.json");
    return nlohmann::json::parse(in, nullptr, false);
  }
  std::string client(const std::string& name) const {
    return "cd " + folder_.path().string() + " && PYTHONPATH=" PITVIPER_SOURCE_DIR "/scenarios/clients timeout 50 /usr/bin/python3 " + name;
  }
  bool hasPython() const { return run("/usr/bin/python3 -c 'import numpy'").code == 0; }
  TemporaryFolder folder_;
};

/// Opens a ring as soon as it is there.
bool openRing(pitviper_stream& s, const std::string& name) {
  for (int k = 0; k < 6000; ++k) {
    if (pitviper_stream_open(&s, name.c_str()) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

TEST_F(Stream, LockstepGivesTheFramesOfARun) {
  if (!hasPython()) GTEST_SKIP() << "needs /usr/bin/python3 with numpy";
  const std::string scene = file();
  const Result whole = pitviper("run " + scene + " --out " + out().string());
  ASSERT_EQ(whole.code, 0) << whole.output;
  folder_.put("steps.py", "import sys\nfrom pitviper_commands import Commands\nfrom pitviper_ring import Ring\nc = Commands('" + socket() + "'); r = Ring('" +
                              ring("lockstep") +
                              "', 60)\n"
                              "for k in range(8):\n  said = c.step(host_frame=k + 1)\n  f = r.next(30)\n  assert said['frame'] == k and said['host_frame'] == "
                              "k + 1, said\n  assert f.sequence == k and f.host_frame == k + 1 and f.held()\n"
                              "  assert f.flags == 0 and abs(f.time_ns - k * 20000000) < 2 and abs(f.exposure_end_ns - f.exposure_start_ns - 2000000) < 2\n"
                              "  f['mw.counts'].tofile(f'counts_{k}.raw'); f['mw.radiance'].tofile(f'radiance_{k}.raw')\n"
                              "  assert abs(f.radiance('mw.counts').mean() / f['mw.radiance'].mean() - 1) < 0.1, 'the calibration of counts'  # it is of light "
                              "that is even over the band, and a body at 290 K is not\n"
                              "c.send(end=True)\nprint('stepped')\n");
  Background stream("stream " + scene + " --clock lockstep --commands " + socket() + " --shared-memory " + ring("lockstep"));
  const Result steps = run(client("steps.py"));
  EXPECT_NE(steps.output.find("stepped"), std::string::npos) << steps.output;
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
  EXPECT_NE(stream.result().output.find("8 sent"), std::string::npos) << stream.result().output;
  // Pixel for pixel, to the last bit.
  for (int k = 0; k < 8; ++k) {
    const ExrImage exr = readExr(out() / ("eye_0000" + std::to_string(k) + ".exr"));
    const auto& counts = *std::find_if(exr.layers.begin(), exr.layers.end(), [](const auto& l) { return l.name == "mw.counts"; });
    const auto& radiance = *std::find_if(exr.layers.begin(), exr.layers.end(), [](const auto& l) { return l.name == "mw.radiance"; });
    std::vector<std::uint16_t> streamed(1200);
    std::vector<float> floats(1200);
    std::ifstream(folder_.path() / ("counts_" + std::to_string(k) + ".raw")).read(reinterpret_cast<char*>(streamed.data()), 2400);
    std::ifstream(folder_.path() / ("radiance_" + std::to_string(k) + ".raw")).read(reinterpret_cast<char*>(floats.data()), 4800);
    int differ = 0;
    for (std::size_t p = 0; p < 1200; ++p) differ += static_cast<float>(streamed[p]) != counts.pixels[p] || floats[p] != radiance.pixels[p];
    EXPECT_EQ(differ, 0) << "frame " << k;
  }
}

TEST_F(Stream, RealTimeAccountsForEveryFrameAndWritesItsPage) {
  const Result r = pitviper("stream " + file() + " --rate '100 Hz' --frames 100 --shared-memory " + ring("time") + " --out " + out().string());
  EXPECT_EQ(r.code, 0) << r.output;
  EXPECT_NE(r.output.find("unaccounted for: 0"), std::string::npos) << r.output;
  const auto j = report();
  ASSERT_TRUE(j.is_object());
  const auto& eye = j["cameras"]["eye"];
  EXPECT_EQ(eye["on_time"].get<int>() + eye["late"].get<int>() + eye["dropped"].get<int>() + eye["repeated"].get<int>(), 100);
  EXPECT_GT(j["seconds"].get<double>(), 0.98) << "100 ticks at 100 Hz: the clock does not run away";
  EXPECT_GT(eye["period"]["count"].get<int>(), 0);
  EXPECT_GT(fs::file_size(out() / "stream.html"), 1000u);
  struct stat status {};
  EXPECT_NE(::stat(("/dev/shm" + ring("time")).c_str(), &status), 0) << "nothing is left behind";
}

TEST_F(Stream, ASceneTooSlowForItsRateDegradesAsAskedAndSaysSo) {
  for (const char* late : {"send", "drop", "repeat"}) {
    const Result r = pitviper("stream " + file() + " --rate '20 kHz' --frames 8000 --shared-memory " + ring("late") + " --late " + late + " --out " +
                              out().string() + " --overwrite");
    EXPECT_EQ(r.code, 0) << r.output;
    EXPECT_NE(r.output.find("does not hold"), std::string::npos) << r.output;
    const auto eye = report()["cameras"]["eye"];
    EXPECT_EQ(eye["on_time"].get<int>() + eye["late"].get<int>() + eye["dropped"].get<int>() + eye["repeated"].get<int>(), 8000) << late;
    EXPECT_GT(eye[late == std::string("repeat") ? "repeated" : "dropped"].get<int>(), 0) << late;
    if (late == std::string("drop")) {
      EXPECT_EQ(eye["late"].get<int>(), 0);
    }
  }
}

TEST_F(Stream, TheDialTurnsWhereTheRateDoesNotHold) {
  const Result r = pitviper("stream " + file("accuracy: {asked: 1 %, at_most: 4 %}\n") + " --rate '20 kHz' --frames 8000 --shared-memory " + ring("dial") +
                            " --out " + out().string());
  EXPECT_EQ(r.code, 0) << r.output;
  const auto j = report();
  ASSERT_EQ(j["accuracies"].size(), 3u) << "1, 2 and 4 %";
  int frames = 0, coarsest = 0;
  for (const auto& a : j["accuracies"]) frames += a["frames"].get<int>(), coarsest = a["frames"].get<int>();
  const auto eye = j["cameras"]["eye"];
  EXPECT_EQ(frames, eye["on_time"].get<int>() + eye["late"].get<int>()) << "each frame drawn to one of them";
  EXPECT_GT(coarsest, frames / 2);
  const Result mistake = pitviper("stream " + file("accuracy: {asked: 5 %, at_most: 3 %}\n"));
  EXPECT_EQ(mistake.code, 2);
  EXPECT_NE(mistake.output.find("coarser than at most"), std::string::npos) << mistake.output;
}

TEST_F(Stream, AReaderThatIsKilledDisturbsNobody) {
  Background stream("stream " + file() + " --rate '50 Hz' --frames 150 --shared-memory " + ring("killed"));
  pitviper_stream s{};
  ASSERT_TRUE(openRing(s, ring("killed")));
  for (int k = 0; k < 3; ++k) {
    const pid_t child = fork();
    if (child == 0) {
      pitviper_stream own{};
      if (pitviper_stream_open(&own, ring("killed").c_str()) == 0)
        for (;;) pitviper_stream_next(&own, 1000);
      _exit(1);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  std::uint64_t seen = 0, last = 0;
  while (!s.ended)
    if (const pitviper_stream_frame* f = pitviper_stream_next(&s, 30000)) last = f->sequence, ++seen;
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
  EXPECT_LE(seen + s.lost, last + 1) << "what was dropped has no frame";
  EXPECT_GT(seen, 0u);
  pitviper_stream_close(&s);
}

TEST_F(Stream, ASignalEndsItAfterTheFrameItIsAt) {
  const std::string log = (folder_.path() / "log").string();
  const Result r =
      run("PITVIPER_HOME=" PITVIPER_SOURCE_DIR " " PITVIPER_PROGRAM " stream " + file() + " --endless --shared-memory " + ring("signal") + " > " + log +
          " 2>&1 & p=$!; for k in $(seq 600); do grep -q '^streaming' " + log + " && break; sleep 0.1; done; sleep 0.3; kill -TERM $p; wait $p; echo code $?");
  std::stringstream text;
  text << std::ifstream(log).rdbuf();
  EXPECT_NE(r.output.find("code 0"), std::string::npos) << text.str() << r.output;
  EXPECT_NE(text.str().find("unaccounted for: 0"), std::string::npos) << text.str();
}

TEST_F(Stream, CommandsBeyondTheLimitsAreCarriedOutAndMarked) {
  if (!hasPython()) GTEST_SKIP() << "needs /usr/bin/python3 with numpy";
  folder_.put(
      "far.py",
      "from pitviper_commands import Commands\nfrom pitviper_ring import Ring, OUTSIDE_LIMITS\nc = Commands('" + socket() + "'); r = Ring('" + ring("limits") +
          "', 60)\n"
          "c.step(); a = r.next(30); assert a.flags == 0\nlight = a['mw.counts'].mean() - 100  # less the offset, which no gain turns up\n"
          "c.step(command='gain', camera='eye', factor=1.5); g = r.next(30)\nassert abs((g['mw.counts'].mean() - 100) / light - 1.5) < 0.002, 'noise of a mean "
          "of 1200 pixels is 3e-4'\n"
          "c.step(command='gain', camera='eye', factor=1); a = r.next(30)\n"
          "said = c.step(command='temperature', entity='ball', value='800 K'); b = r.next(30)\nassert b.flags & OUTSIDE_LIMITS and "
          "said['cameras'][0]['outside_limits'], said\n"
          "assert b['mw.counts'].max() > 2 * a['mw.counts'].max(), 'it was carried out'\n"
          "gain = b.gain[0]; c.step(command='gain', camera='eye', factor=2); d = r.next(30); assert abs(d.gain[0] / gain - 0.5) < 1e-9\n"
          "c.send(command='look', camera='eye', exposure='4 ms'); c.step(); e = r.next(30); assert abs(e.exposure_s - 0.004) < 1e-12 and e.pose_age_ns >= 0\n"
          "try: c.step(command='temperature', entity='bal', value='1 K'); assert False\nexcept ValueError as mistake: assert 'did you mean' in str(mistake)\n"
          "c.send(end=True); print('marked')\n");
  Background stream("stream " + file() + " --clock lockstep --commands " + socket() + " --shared-memory " + ring("limits"));
  const Result r = run(client("far.py"));
  EXPECT_NE(r.output.find("marked"), std::string::npos) << r.output;
  EXPECT_EQ(stream.result().code, 0);
  EXPECT_NE(stream.result().output.find("outside the scenario's limits"), std::string::npos) << stream.result().output;
}

TEST_F(Stream, ClientsThatFollowHearOfTheirOwnFrames) {
  if (!hasPython()) GTEST_SKIP() << "needs /usr/bin/python3 with numpy";
  // Held frames leave from another thread than draws them: each line is of its own tick all the same. A step of a clock that nobody holds is a mistake.
  folder_.put("follow.py",
              "from pitviper_commands import Commands\nc = Commands('" + socket() +
                  "')\ntry: c.send(step=1, id=1); c.read(); assert False\nexcept ValueError as e: assert 'nobody holds' in str(e)\n"
                  "c.send(follow=True)\nfor k in range(20):\n  said = c.read()\n  assert len(said['cameras']) + said.get('dropped', 0) == 1, said\n"
                  "  assert said['cameras'] == [] or abs(said['cameras'][0]['exposure_ns'][0] - (said['time_s'] * 1e9 - 1e6)) < 10, said\nc.send(end=True); "
                  "print('followed')\n");
  Background stream("stream " + file() + " --rate '50 Hz' --endless --hold --commands " + socket() + " --shared-memory " + ring("follow"));
  const Result r = run(client("follow.py"));
  EXPECT_NE(r.output.find("followed"), std::string::npos) << r.output;
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
}

TEST_F(Stream, ACigiHostHoldsTheClock) {
  if (!has("/usr/bin/python3")) GTEST_SKIP() << "needs python3";
  const int port = 20000 + getpid() % 20000;
  const std::string text = scenario();
  Background stream("stream " + folder_.put("ball.yaml", text) + " --clock lockstep --frames 30 --cigi " + std::to_string(port) + " --shared-memory " +
                    ring("cigi"));
  pitviper_stream s{};
  ASSERT_TRUE(openRing(s, ring("cigi")));
  const Result host = run("/usr/bin/python3 " PITVIPER_SOURCE_DIR "/scenarios/clients/cigi_host.py 127.0.0.1:" + std::to_string(port) + " --help");
  EXPECT_EQ(host.code, 0) << host.output;
  const Result r =
      run("timeout 50 /usr/bin/python3 " PITVIPER_SOURCE_DIR "/scenarios/clients/cigi_host.py 127.0.0.1:" + std::to_string(port) + " --frames 30 --timeout 30");
  EXPECT_EQ(stream.result().code, 0) << stream.result().output << r.output;
  EXPECT_NE(stream.result().output.find("30 sent"), std::string::npos) << stream.result().output << r.output;
  pitviper_stream_close(&s);
}

TEST_F(Stream, ArvCameraTestReceivesWholePictures) {
  if (!has("arv-camera-test-0.8") || !has("arv-tool-0.8") || !hasPython())
    GTEST_SKIP() << "needs aravis-tools, aravis-tools-cli and /usr/bin/python3 with numpy";
  // It lasts as long as its clients take.
  folder_.put("end.py", "from pitviper_commands import Commands\nCommands('" + socket() + "').send(end=True)\n");
  const std::string address = "127.0.0." + std::to_string(10 + getpid() % 200);
  // Cameras are listed by who answers on the loopback's broadcast.
  Background stream("stream " + file() + " --rate '50 Hz' --endless --commands " + socket() + " --gige " + address + " --out " + out().string());
  Result list;
  for (int k = 0; k < 200 && list.output.find(address) == std::string::npos; ++k) {
    list = run("arv-tool-0.8");
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  EXPECT_NE(list.output.find("pitviper-eye-ball (" + address + ")"), std::string::npos) << list.output;
  const Result values = run("arv-tool-0.8 -a " + address + " control Width Height PixelFormat ExposureTime=1000 ExposureTime");
  EXPECT_NE(values.output.find("Width = 40"), std::string::npos) << values.output;
  EXPECT_NE(values.output.find("ExposureTime = 1000"), std::string::npos) << values.output;
  const Result test = run("arv-camera-test-0.8 -n pitviper-eye-ball --no-packet-socket --duration 2");
  run(client("end.py"));
  const auto at = test.output.find("n_completed_buffers    = ");
  ASSERT_NE(at, std::string::npos) << test.output;
  EXPECT_GT(std::atoi(test.output.c_str() + at + std::strlen("n_completed_buffers    = ")), 10) << test.output;
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
  EXPECT_EQ(report()["sinks"][0]["malformed"], 0);
}

TEST_F(Stream, ACableThatIsPulledAndPutBackStopsNobody) {
  if (!has("arv-camera-test-0.8") || !has("ip")) GTEST_SKIP() << "needs aravis-tools and iproute2";
  const std::string own = std::to_string(getpid()), space = "pv" + own, near = "pva" + own, far = "pvb" + own,
                    net = "10." + std::to_string(100 + getpid() % 100) + ".0.";
  const auto clean = [&] { run("ip netns del " + space + "; ip link del " + near); };
  const Result made = run("ip netns add " + space + " && ip link add " + near + " type veth peer name " + far + " && ip link set " + far + " netns " + space +
                          " && ip addr add " + net + "1/24 dev " + near + " && ip link set " + near + " up && ip netns exec " + space + " sh -c 'ip addr add " +
                          net + "2/24 dev " + far + " && ip link set " + far + " up && ip link set lo up'");
  if (made.code != 0) {
    clean();
    GTEST_SKIP() << "network namespaces are not permitted: " << made.output;
  }
  Background stream("stream " + file() + " --rate '50 Hz' --duration '9 s' --gige " + net + "1 --out " + out().string());
  const Result test = run("sleep 2; (sleep 2; ip link set " + near + " down; sleep 1; ip link set " + near + " up) & timeout 50 ip netns exec " + space +
                          " arv-camera-test-0.8 -n pitviper-eye-ball --no-packet-socket --duration 6; wait");
  clean();
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
  EXPECT_NE(stream.result().output.find("unaccounted for: 0"), std::string::npos) << stream.result().output;
  // Of six seconds five with a cable; the last second counts again.
  const auto at = test.output.find("n_completed_buffers    = ");
  ASSERT_NE(at, std::string::npos) << test.output;
  EXPECT_GT(std::atoi(test.output.c_str() + at + std::strlen("n_completed_buffers    = ")), 100) << test.output;
}

TEST_F(Stream, APipelineGetsTheCounts) {
  if (!has("gst-launch-1.0")) GTEST_SKIP() << "needs gstreamer1.0-tools";
  const std::string raw = (folder_.path() / "a.raw").string();
  const Result r = pitviper("stream " + file() + " --clock free --frames 8 --gstreamer 'filesink location=" + raw + "' --shared-memory " + ring("gst"));
  EXPECT_EQ(r.code, 0) << r.output;
  const Result whole = pitviper("run " + file() + " --out " + out().string());
  ASSERT_EQ(whole.code, 0) << whole.output;
  std::ifstream in(raw, std::ios::binary);
  std::vector<std::uint16_t> codes(8 * 1200);
  in.read(reinterpret_cast<char*>(codes.data()), static_cast<std::streamsize>(2 * codes.size()));
  ASSERT_EQ(in.gcount(), static_cast<std::streamsize>(2 * codes.size())) << r.output;
  const ExrImage exr = readExr(out() / "eye_00007.exr");
  const auto& counts = *std::find_if(exr.layers.begin(), exr.layers.end(), [](const auto& l) { return l.name == "mw.counts"; });
  int differ = 0;
  for (std::size_t p = 0; p < 1200; ++p) differ += static_cast<float>(codes[7 * 1200 + p]) != counts.pixels[p];
  EXPECT_EQ(differ, 0);
  const Result wrong = pitviper("stream " + file() + " --gstreamer nosuchthing");
  EXPECT_EQ(wrong.code, 2) << wrong.output;
}

TEST_F(Stream, AProjectorShowsSixteenBitsInTwoColours) {
  if (!has("Xvfb") || !has("xwd") || !has("pkill")) GTEST_SKIP() << "needs xvfb, x11-apps and procps";
  const std::string display = ":" + std::to_string(100 + getpid() % 800), xwd = (folder_.path() / "screen.xwd").string();
  const Result server = run("(Xvfb " + display + " -screen 0 320x240x24 > /dev/null 2>&1 & echo $!)");
  const Background stream("stream " + file() + " --endless --projector window --clock vsync --shared-memory " + ring("projector"), "DISPLAY=" + display);
  int lit = 0, blue = 0, hottest = 0;
  // Until it shows all of a frame.
  for (int k = 0; k < 300 && lit != 1200; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    if (run("xwd -display " + display + " -root -silent -out " + xwd).code != 0) continue;
    std::ifstream in(xwd, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), {});
    if (bytes.size() < 320u * 240u * 3u) continue;
    // The header's words are big-endian: its own size, bits a pixel, bytes a line, colours of 12 bytes behind it. Blue comes first.
    const auto word = [&](std::size_t n) {
      const auto* at = reinterpret_cast<const unsigned char*>(bytes.data()) + 4 * n;
      return static_cast<std::size_t>(at[0]) << 24 | static_cast<std::size_t>(at[1]) << 16 | static_cast<std::size_t>(at[2]) << 8 | at[3];
    };
    const std::size_t step = word(11) / 8, stride = word(12), first = word(0) + 12 * word(19);
    ASSERT_LE(first + 240 * stride, bytes.size());
    lit = blue = hottest = 0;
    for (std::size_t y = 0; y < 240; ++y)
      for (std::size_t x = 0; x < 320; ++x) {
        const auto* p = reinterpret_cast<const unsigned char*>(bytes.data()) + first + y * stride + x * step;
        const int code = p[2] << 8 | p[1];
        lit += code > 100, blue += p[0] != 0, hottest = std::max(hottest, code);
      }
  }
  run("pkill -TERM -f '^" PITVIPER_PROGRAM " stream .*" + ring("projector") + "'");  // the program alone, not what watches over its time
  EXPECT_EQ(stream.result().code, 0) << stream.result().output;
  run("kill " + server.output);
  EXPECT_EQ(blue, 0);
  EXPECT_EQ(lit, 1200) << "one pixel a pixel";
  EXPECT_GT(hottest, 256) << "the high byte is there";
}

TEST_F(Stream, SelfTestCountsAllItSends) {
  const Result r = pitviper("stream --self-test --duration '0.5 s'");
  EXPECT_EQ(r.code, 0) << r.output;
  EXPECT_NE(r.output.find("unaccounted for: 0"), std::string::npos) << r.output;
  EXPECT_NE(r.output.find("shared memory"), std::string::npos);
  EXPECT_NE(r.output.find("GVSP"), std::string::npos);
}

TEST_F(Stream, MistakesAreSaidInOneLine) {
  const std::string scene = file();
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"--clock sundial", "--clock has no"},
      {"--clock lockstep", "nobody could let the clock go on"},
      {"--clock vsync", "no display whose clock"},
      {"--clock trigger", "nobody could trigger"},
      {"--late never", "--late has no"},
      {"--rate 100", "no such quantity"},
      {"--rate '-1 Hz'", "no such quantity"},
      {"--frames 0", "no number of frames"},
      {"--frames 3 --endless", "more than one"},
      {"--commands 99999", "no place to listen at"},
      {"--cigi 1.2.3:5", "no place to listen at"},
      {"--gige 300.1.1.1", "no IPv4 address"},
      {"--gige 8.8.8.8", "8.8.8.8"},
      {"--shared-memory nosplash", "no name of shared memory"},
      {"--projector tv", "no display"},
      {"--fifo 100", "no priority"},
      {"--cores 0,x", "no list of cores"},
      {"--delay '0 ms'", "no such quantity"},
      {"--gstreamer a --gstreamer b", "more of them than cameras"},
      {"--stale '1 s'", "does nothing without --commands"},
      {"--projector-table a.csv", "does nothing without --projector"},
      {"--clock free --hold", "never late"},
  };
  for (const auto& [options, says] : wrong) {
    const Result r = pitviper("stream " + scene + " " + options);
    EXPECT_EQ(r.code, 2) << options << ": " << r.output;
    EXPECT_NE(r.output.find(says), std::string::npos) << options << ": " << r.output;
    EXPECT_NE(r.output.find("fix:"), std::string::npos) << options << ": " << r.output;
  }
  EXPECT_EQ(pitviper("stream").code, 2);
}

}  // namespace
}  // namespace pitviper::test
