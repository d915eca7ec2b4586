// Faults from outside: files that are no files, streams and memory that are not there, a build folder that is another's.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "sim/image/exr.hpp"
#include "sim/parameters/readable_text.hpp"

namespace {

namespace fs = std::filesystem;

struct Result {
  int code = -1;
  std::string out, err;
  long peak_kB = 0;
};

std::string readAll(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

const std::string kPlate = "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: 300 K}]\n";

std::string camera(const std::string& response = "{band: [3.6 um, 4.9 um]}", const std::string& film = "{width: 8, height: 8}", int layers = 1) {
  std::string channels;
  for (int k = 0; k < layers; ++k)
    channels += std::string(k == 0 ? "" : ", ") + "{name: m" + std::to_string(k) +
                ", response: " + (layers == 1 ? response : "{band: [" + std::to_string(3000 + 100 * k) + " nm, " + std::to_string(3100 + 100 * k) + " nm]}") +
                "}";
  return "cameras: [{name: c, film: " + film +
         ", field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [9 m, 0 m, 0 m], spectral: {samples: 2}, channels: [" + channels + "]}]\n";
}

class Faults : public ::testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(folder_);
    ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
    fs::create_directories(folder_ / "folder");
  }
  void TearDown() override { fs::remove_all(folder_); }
  fs::path put(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  /// Runs a line of bash in the folder; $P is the program. `inside`: another line, in the file .inside.
  Result run(const std::string& line, const std::string& inside = "") const {
    put(".line", line);
    put(".inside", inside);
    const pid_t child = fork();
    if (child == 0) {
      setenv("P", PITVIPER_PROGRAM, 1);
      setenv("PITVIPER_HOME", PITVIPER_SOURCE_DIR, 1);
      if (chdir(folder_.c_str()) != 0) _exit(126);
      execlp("bash", "bash", "-c", "{ . ./.line; } >.stdout 2>.stderr", nullptr);
      _exit(127);
    }
    int status = 0;
    rusage usage = {};
    wait4(child, &status, 0, &usage);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), readAll(folder_ / ".stdout"), readAll(folder_ / ".stderr"), usage.ru_maxrss};
  }
  void expectRefused(const std::string& line, const std::string& word) const {
    const Result r = run(line);
    EXPECT_EQ(r.code, 2) << line << "\n" << r.err;
    EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
    EXPECT_NE(r.err.find(word), std::string::npos) << line << "\n" << r.err;
    EXPECT_NE(r.err.find("; expected "), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("; fix: "), std::string::npos) << r.err;
    EXPECT_LT(r.peak_kB, 1 << 20) << line;
  }
  const fs::path folder_ = fs::temp_directory_path() / ("pitviper_faults_" + std::to_string(getpid()));
};

// Expected: wherever a scenario or the command line names a file, a pipe, a device and a folder are refused in one line, at once, without memory.
TEST_F(Faults, OnlyRegularFilesAreRead) {
  for (const auto& [name, kind] : {std::pair<std::string, std::string>{"pipe", "pipe"}, {"/dev/zero", "device"}, {"folder", "folder"}}) {
    const std::string wrong = "it is a " + kind + ", not a regular file";
    expectRefused("$P check " + name, wrong);
    expectRefused("$P run " + name, wrong);
    expectRefused("$P info " + name, wrong);
    expectRefused("$P integrate " + name + " sensor.yaml", wrong);
    put("a.yaml", kPlate + camera("{file: " + name + "}"));
    expectRefused("$P check a.yaml", wrong);
    put("a.yaml", "atmosphere: {csv: " + name + "}\n" + kPlate + camera());
    expectRefused("$P check a.yaml", "there is no file");
    put("a.yaml", "atmosphere: {tape7: " + name + "}\n" + kPlate + camera());
    expectRefused("$P check a.yaml", "there is no file");
    put("a.yaml", "atmosphere: {table: " + name + "}\n" + kPlate + camera());
    expectRefused("$P check a.yaml", "there is no file");
    put("a.yaml", "entities: [{name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: {file: " + name +
                      ", minimum: 0 K, maximum: 9 K}}]\n" + camera());
    expectRefused("$P check a.yaml", "cannot read the file");
    const std::string link = "mesh_" + kind + ".obj";
    fs::create_symlink(name[0] == '/' ? fs::path(name) : folder_ / name, folder_ / link);
    put("a.yaml", "entities: [{name: p, shape: {model: mesh, file: " + link + ", unit: 1 m}, material: {}, temperature: 300 K}]\n" + camera());
    expectRefused("$P check a.yaml", wrong);
    if (name[0] == '/') continue;
    put("a.yaml", "extends: " + name + "\n" + kPlate + camera());
    expectRefused("$P check a.yaml", wrong);
  }
}

// Rationale: a scenario from elsewhere must not carry a file of this machine into a message. Expected: of files that are no tables nothing but a short
// beginning of a word that a table could hold.
TEST_F(Faults, OtherFilesAreNotToldOf) {
  const std::string secret = "hunter2hunter2hunter2";
  for (const std::string& text : {secret + "\n", "root:" + secret + ":1:2\n", "a," + secret + "\nb," + secret + "\n",
                                  "# " + secret + "\n" + secret + " " + secret + "\n", "key: {" + secret + ": $" + secret + "}\n"}) {
    for (const char* name : {"s.csv", "s.tp7", "s.air", "s.obj", "s.ply", "s.stl", "s.vtp", "s.gltf", "s.png"}) put(name, text);
    std::vector<std::string> scenes = {kPlate + camera("{file: s.csv}")};
    for (const char* air : {"csv: s.csv", "tape7: s.tp7", "table: s.air"}) scenes.push_back("atmosphere: {" + std::string(air) + "}\n" + kPlate + camera());
    for (const char* mesh : {"s.obj", "s.ply", "s.stl", "s.vtp", "s.gltf"})
      scenes.push_back("entities: [{name: p, shape: {model: mesh, file: " + std::string(mesh) + ", unit: 1 m}, material: {}, temperature: 300 K}]\n" +
                       camera());
    for (const std::string& scene : scenes) {
      put("a.yaml", scene);
      const Result r = run("$P check a.yaml");
      EXPECT_EQ(r.code, 2) << scene << r.err;
      const bool isTable = text[0] == 'a';  // two columns: a cell that is no number is told
      EXPECT_TRUE(isTable || r.err.find("hunter2") == std::string::npos) << scene << r.err;
      EXPECT_EQ(r.err.find("$"), std::string::npos) << scene << r.err;
    }
  }
}

// Expected: a message is whole UTF-8, wherever a word was cut for it.
TEST_F(Faults, MessagesAreWholeCharacters) {
  for (int before = 50; before < 64; ++before) {
    put("a.yaml", std::string(static_cast<size_t>(before), 'k') + "\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80\xc3\xa9\xc3\xa9: 1\n" + kPlate + camera());
    const Result r = run("$P check a.yaml");
    EXPECT_EQ(r.code, 2);
    for (size_t at = 0; at < r.err.size(); at += pitviper::utf8Length(std::string_view(r.err).substr(at)))
      ASSERT_GT(pitviper::utf8Length(std::string_view(r.err).substr(at)), 0u) << r.err;
    EXPECT_EQ(r.err.find('?'), std::string::npos) << r.err;
  }
}

// Expected: what was to be printed and could not be is an error, with a message.
TEST_F(Faults, OutputThatIsLostIsAnError) {
  put("a.yaml", kPlate + camera());
  for (const char* command : {"--help", "--version", "keys", "run --help", "check a.yaml"}) {
    const Result full = run(std::string("$P ") + command + " >/dev/full");
    EXPECT_EQ(full.code, 1) << command;
    EXPECT_EQ(full.err.rfind("standard output: cannot write what was to be printed", 0), 0u) << command << full.err;
    const Result closed = run(std::string("$P ") + command + " >&-");
    EXPECT_EQ(closed.code, 1) << command;
    EXPECT_EQ(closed.err.rfind("standard output: cannot write", 0), 0u) << command << closed.err;
  }
  // With nothing open a frame must not become the standard output.
  EXPECT_EQ(run("$P run a.yaml --out out >&- 2>&- <&-").code, 1);
  EXPECT_EQ(readAll(folder_ / "out" / "c_00000.exr").substr(0, 4), "\x76\x2f\x31\x01");
  const std::string frame = readAll(folder_ / "out" / "c_00000.exr");
  ASSERT_EQ(run("$P run a.yaml --out again").code, 0);
  EXPECT_TRUE(frame == readAll(folder_ / "again" / "c_00000.exr"));
}

// Expected: a picture beyond the memory is refused by check and by run, before any work, with the place, the numbers and the fix.
TEST_F(Faults, MemoryIsPredicted) {
  put("large.yaml", kPlate + camera("", "{width: 4096, height: 4096}", 16));
  for (const char* command : {"check", "run"}) {
    const Result r = run("ulimit -v 4000000; $P " + std::string(command) + " large.yaml");
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(r.err.rfind("large.yaml:2:11: drawing this takes about 1", 0), 0u) << r.err;
    for (const char* word : {" GB of memory, ", "for camera c (4096x4096 pixels, 1x1 subpixels, 16 layers); expected at most the 4", "; fix: lower the film"})
      EXPECT_NE(r.err.find(word), std::string::npos) << r.err;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
    EXPECT_LT(r.peak_kB, 200 << 10);
  }
}

// Rationale: LLVM's time to compile doubles with every loop that follows another; lights of a surface are a loop at each wavelength. Expected: programs of many
// lights at many wavelengths, drawn directly, buffered and for transparent surfaces, are there after seconds of the processor (2 to 6 measured on 2 cores; from
// five lights and 16 wavelengths on it were minutes), and their pictures are those of few lights that send the same.
TEST_F(Faults, ProgramsOfManyLightsAreMadeInSeconds) {
  const auto scene = [&](int lamps, double area_cm2, const std::string& more) {
    std::string text =
        "ambient: {temperature: 280 K}\naudit: 0\nmaterials:\n  m: {components: [{reflection: lambertian, reflectance: 0.3}]}\n"
        "  half: {components: [{reflection: lambertian, reflectance: 0.2}], transmission: {transmittance: 0.6}}\nlights:\n";
    for (int k = 0; k < lamps; ++k)
      text += "- {name: l" + std::to_string(k) + ", intensity: {blackbody: 1500 K, area: " + std::to_string(area_cm2) + " cm2}, position: [3 m, -2 m, 3 m]}\n";
    return text + more + "- {name: p, shape: {model: plate, width: 4 m, height: 4 m}, material: m, temperature: 300 K}\n" +
           "cameras: [{name: c, film: {width: 16, height: 16}, field_of_view: 20 deg, aperture: 40 mm, look_at: p, position: [9 m, 1 m, 1 m], spectral: "
           "{samples: 16}, "
           "channels: [{name: a, response: {band: [3.6 um, 4.2 um]}}, {name: b, response: {band: [4.4 um, 4.9 um]}}]}]\n";
  };
  const std::string pane =
      "entities:\n- {name: pane, shape: {model: plate, width: 1 m, height: 1 m}, material: half, temperature: 310 K, position: [2 m, 0 m, 0 m], "
      "heading: 90 deg}\n";
  int kinds = 0;
  for (const std::string& more : std::vector<std::string>{"entities:\n", "render: {mode: buffered}\nentities:\n", pane}) {
    put("few.yaml", scene(2, 10.0, more));
    ASSERT_EQ(run("$P run few.yaml --out few --overwrite").code, 0) << readAll(folder_ / ".stderr");
    for (const int lamps : {6, 20}) {
      if (lamps == 20 && more == pane) continue;
      put("many.yaml", scene(lamps, 20.0 / lamps, more));
      const Result r = run("XDG_CACHE_HOME=$PWD/cache" + std::to_string(++kinds) + " bash -c 'ulimit -t 25; $P run many.yaml --out many --overwrite'");
      ASSERT_EQ(r.code, 0) << lamps << more << r.err;
      const auto few = pitviper::readExr(folder_ / "few" / "c_00000.exr"), many = pitviper::readExr(folder_ / "many" / "c_00000.exr");
      double most = 0.0;
      for (size_t l = 0; l < few.layers.size(); ++l)
        for (size_t k = 0; k < few.layers[l].pixels.size(); ++k)
          most = std::max(most, std::abs(many.layers[l].pixels[k] / static_cast<double>(few.layers[l].pixels[k]) - 1.0));
      EXPECT_LT(most, 1e-5) << lamps << more << ": sums of 20 terms in single precision, 20 x 6e-8, and decimals of the areas";
    }
  }
}

// Rationale: a pixel that is no number, or beyond all numbers, looks like black or white to whoever reads a frame. Expected: whatever makes one, with and
// without stages of a sensor, direct, buffered and by the reference, in a spectral image and a temperature, no frame and no success, but one line that says
// where.
TEST_F(Faults, APixelThatIsNotFiniteNeverLeaves) {
  const auto scene = [](const std::string& plate, const std::string& more, const std::string& camera, const std::string& channel = "") {
    return more +
           "audit: 0\nmaterials: {m: {components: [{reflection: lambertian, reflectance: 0.3}]}}\nentities:\n- {name: p, shape: {model: plate, width: 1 m, "
           "height: 1 m}, "
           "material: m, temperature: " +
           plate +
           "}\ncameras: [{name: c, film: {width: 8, height: 8}, field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: "
           "[9 m, 0 m, 0 m], " +
           camera + "channels: [{name: m, response: {band: [3.6 um, 4.9 um]}" + channel + "}]}]\n";
  };
  const std::string lamp =
      "lights: [{name: l, intensity: {wavelength: um, unit: W/(sr um), values: [[3, 1e30], [6, 1e30]]}, radius: 1 um, level: 1e6, position: [0.01 m, 0.05 m, "
      "0.05 m]}]\n";
  const std::string detector = "exposure: 1 ms, stages: [{stage: detector, full_well: 7e6, bits: 14}], ",
                    efficiency = ", quantum_efficiency: 0.8, output: [counts]";
  int refused = 0;
  for (const std::string& text :
       {scene("300 K", lamp, ""), scene("300 K", lamp + "render: {mode: buffered}\n", ""), scene("300 K", lamp + "accuracy: reference\n", ""),
        scene("300 K", lamp, detector, efficiency), scene("300 K", lamp, "", ", output: [radiance, apparent_temperature]"),
        scene("300 K", "ambient: {radiance: {wavelength: um, unit: W/(m2 sr um), values: [[3, 1e30], [6, 1e30]]}}\n", detector, efficiency)}) {
    put("a.yaml", text);
    const Result r = run("rm -rf out; ulimit -t 40; $P run a.yaml --out out");
    EXPECT_NE(r.code, 0) << text << r.out;
    EXPECT_FALSE(fs::exists(folder_ / "out" / "c_00000.exr")) << text;
    EXPECT_NE(r.err.find("; expected "), std::string::npos) << text << r.err;
    EXPECT_NE(r.err.find("; fix: "), std::string::npos) << text << r.err;
    refused += r.err.find("camera c, frame 0, m.") != std::string::npos;
  }
  EXPECT_GE(refused, 4);
}

// Expected: a flare out of view, however far, costs a picture nothing, and several flares no more programs than one (1 to 6 s of the processor).
TEST_F(Faults, FlaresAnywhereAreDrawnInSeconds) {
  for (const char* flare :
       {"position: [0 m, 0 m, 10 km], speed: 0 m/s", "position: [0 m, 0 m, 1000 km], speed: 0 m/s", "position: [80 km, 1 m, 1 m], speed: 0 m/s",
        "position: [0 m, -3 km, 2 km], speed: 0 m/s", "position: [9 m, -30 m, 3 m], sequence: {count: 5, interval: 0.1 s}"}) {
    put("a.yaml", "time: {rate: 100 Hz, frames: 1}\naudit: 0\n" + kPlate + "flares: [{name: f, type: mtv, time: -0.6 s, " + flare + "}]\n" +
                      "cameras: [{name: c, film: {width: 16, height: 12}, field_of_view: 6 deg, aperture: 40 mm, look_at: p, position: [0 m, -40 m, 0 m], "
                      "channels: [{name: mw, response: {band: [3.7 um, 4.8 um]}}]}]\n");
    const Result r = run("ulimit -t 40; $P run a.yaml --out out --overwrite");
    EXPECT_EQ(r.code, 0) << flare << r.err;
  }
}

// Rationale: the driver writes to the index of its cache as to memory, and a page that the disk has no room for ends the process. Expected: on disks that are
// full before the first context, with and without an index that is only promised, a note and the pictures; on one that fills up later the pictures alone.
TEST_F(Faults, AFullDiskUnderTheDriversCacheCostsTheCacheAlone) {
  if (run("unshare -rm true").code != 0) GTEST_SKIP() << "needs a mount of its own (unshare)";
  put("a.yaml", kPlate + camera());
  ASSERT_EQ(run("$P run a.yaml --out whole").code, 0);
  const std::string frame = readAll(folder_ / "whole" / "c_00000.exr");
  const std::string fill = "dd if=/dev/zero of=disk/fill bs=4k status=none 2>/dev/null; ", draw = "$P run a.yaml --overwrite --out out";
  const std::string promised = "mkdir disk/mesa_shader_cache; truncate -s 1310728 disk/mesa_shader_cache/index; ";
  struct Disk {
    std::string size, before, draws;
    bool told;
  };
  for (const Disk& d : {Disk{"8k", "", "XDG_CACHE_HOME=$PWD/disk " + draw, true},
                        {"600k", "", "XDG_CACHE_HOME=$PWD/disk " + draw, true},
                        {"8m", fill, "XDG_CACHE_HOME=$PWD/disk " + draw, true},
                        {"8m", promised + fill, "XDG_CACHE_HOME=$PWD/disk " + draw, true},
                        {"8m", promised + fill, "MESA_SHADER_CACHE_DIR=$PWD/disk XDG_CACHE_HOME=$PWD/own " + draw, true},
                        {"1400k", promised, "XDG_CACHE_HOME=$PWD/disk " + draw, false},
                        {"8k", "", "MESA_SHADER_CACHE_DISABLE=true XDG_CACHE_HOME=$PWD/disk " + draw, false}}) {
    fs::create_directories(folder_ / "disk");
    const Result r = run("unshare -rm bash -c '. ./.inside'", "mount -t tmpfs -o size=" + d.size + " none disk || exit 9; " + d.before + d.draws);
    EXPECT_EQ(r.code, 0) << d.size << d.draws << r.err;
    EXPECT_EQ(r.err.find("has no room for the driver's cache of shaders") != std::string::npos, d.told) << d.size << d.draws << r.err;
    EXPECT_TRUE(readAll(folder_ / "out" / "c_00000.exr") == frame) << d.size << d.draws;
  }
}

// Expected: where EGL or its drivers are not there, one line that says what to install, and the code of a machine that could not.
TEST_F(Faults, WithoutADriverThereIsAMessage) {
  put("a.yaml", kPlate + camera());
  put("broken/a.json", R"({"file_format_version": "1.0.0", "ICD": {"library_path": "libEGL_nobody.so.0"}})");
  fs::create_directories(folder_ / "none");
  for (const char* without :
       {"__EGL_VENDOR_LIBRARY_DIRS=none", "__EGL_VENDOR_LIBRARY_DIRS=broken", "__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null", "LIBGL_DRIVERS_PATH=$PWD/none"})
    for (const char* command : {"run a.yaml --out out", "check a.yaml --audit", "stream a.yaml --frames 1 --shared-memory /pitviper.test.driver"}) {
      const Result r = run(std::string(without) + " $P " + command);
      EXPECT_EQ(r.code, 1) << without << command << r.err;
      EXPECT_NE(r.err.find("apt-get install libegl1 libgl1 libgl1-mesa-dri"), std::string::npos) << without << r.err;
    }
  const Result r = run("__EGL_VENDOR_LIBRARY_DIRS=none $P run a.yaml --out out");
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.err.rfind("pitviper: EGL has no driver behind it", 0), 0u) << r.err;
  EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
}

// Rationale: numbers that are each in their range may together ask for hours or for all memory. Expected: refused before the work, with the numbers and a fix.
TEST_F(Faults, WorkWithoutEndIsRefused) {
  const auto flights = [](int count, const std::string& step, const std::string& seconds) {
    return "entities:\n- {name: p, shape: {model: plate, width: 1 m, height: 1 m}, material: {}, temperature: 300 K}\n- {repeat: {count: " +
           std::to_string(count) +
           "}, name: 'r$i', shape: {model: sphere, radius: 1 m, segments: 8}, material: {}, temperature: 300 K, position: "
           "[0 m, 0 m, 5 m], motion: {model: ballistic, launch: 0 s, mass: 1 kg, velocity: [0 m/s, 0 m/s, 9000 m/s], step: " +
           step + ", duration: " + seconds + "}}\n" + camera();
  };
  put("a.yaml", flights(4000, "2 ms", "50 s"));
  expectRefused("ulimit -t 40; $P check a.yaml", "at most 10 million in a scenario");
  put("a.yaml", flights(20, "20 ms", "100 s"));
  EXPECT_EQ(run("$P check a.yaml").code, 0);
  // Rings beyond the machine's memory, where the system would end a process.
  for (const char* slots : {"4096", "3500"}) {
    put("a.yaml", "sinks: [{sink: shared_memory, name: /pitviper.test.large, slots: " + std::string(slots) + "}]\n" + kPlate +
                      camera("{band: [3.6 um, 4.9 um]}", "{width: 4096, height: 2048}"));
    const Result r = run("$P run a.yaml --out out");
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_NE(r.err.find("the machine has no such memory"), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("ask for fewer slots"), std::string::npos) << r.err;
    EXPECT_FALSE(fs::exists("/dev/shm/pitviper.test.large"));
  }
}

// Expected: where memory ends all the same, one message and 2.
TEST_F(Faults, OutOfMemoryIsAMessage) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the sanitizer takes all the address space it can get";
#endif
  // A long table and fine meshes, which ask for much in little time.
  std::string table = "wavelength [um], value [1]\n";
  for (int k = 0; k < 90000; ++k) table += std::to_string(0.2 + 1e-4 * k) + ", 0.5\n";
  put("table.csv", table);
  std::string many = "materials:\n";
  for (int k = 0; k < 2; ++k) many += "  m" + std::to_string(k) + ": {components: [{reflection: lambertian, reflectance: {file: table.csv}}]}\n";
  std::string balls = "entities:\n";
  for (int k = 0; k < 12; ++k)
    balls += "- {name: b" + std::to_string(k) + ", shape: {model: sphere, radius: " + std::to_string(1.0 + 0.01 * k) +
             " m, segments: 512}, material: {}, temperature: 300 K}\n";
  put("a.yaml", many + balls + camera());
  bool ended = false;
  for (int megabytes = 40; megabytes <= 400; megabytes += 30) {
    const Result r = run("ulimit -v " + std::to_string(megabytes) + "000; $P check a.yaml");
    if (r.code == 127 || r.err.find("cannot allocate memory in") != std::string::npos || r.err.find("error while loading") != std::string::npos)
      continue;  // not even begun
    if (r.code == 0) break;
    EXPECT_EQ(r.code, 2) << megabytes << " MB: " << r.err;
    EXPECT_EQ(r.err.find('\n'), r.err.size() - 1) << r.err;
    EXPECT_NE(r.err.find("; fix: "), std::string::npos) << r.err;
    ended |= r.err.rfind("pitviper: more memory is needed than this machine gives; ", 0) == 0;
  }
  EXPECT_TRUE(ended) << "no limit met the reader at work";
}

// Rationale: a checkout is copied with its build folder. Expected: the copy builds anew, for itself; a build folder named by PITVIPER_BUILD that is another
// checkout's is refused and stays as it is.
TEST_F(Faults, ABuildFolderBelongsToItsCheckout) {
  fs::create_directories(folder_ / "one/scenarios");
  for (const char* name : {"cmake", "sim", "materials", "atmosphere", "sensors"}) fs::create_directories(folder_ / "one" / name);
  fs::copy_file(fs::path(PITVIPER_SOURCE_DIR) / "pitviper", folder_ / "one/pitviper");
  put("one/CMakeLists.txt", "");
  // Stand-ins: what configures notes whose folder it is, what builds makes a program that says so.
  fs::create_directories(folder_ / "bin");
  put("bin/dpkg-query", "#!/bin/bash\nfor p in \"$@\"; do echo \"$p installed\"; done\n");
  put("bin/cmake",
      "#!/bin/bash\nmkdir -p \"$4\"\nprintf 'CMAKE_HOME_DIRECTORY:INTERNAL=%s\\nCMAKE_CACHEFILE_DIR:INTERNAL=%s\\n' \"$2\" \"$4\" >\"$4/CMakeCache.txt\"\n"
      "printf '%s' \"$2\" >\"$4/build.ninja\"\n");
  put("bin/ninja", "#!/bin/bash\nprintf '#!/bin/bash\\necho program of %s\\n' \"$(cat \"$2/build.ninja\")\" >\"$2/pitviper\"\nchmod +x \"$2/pitviper\"\n");
  ASSERT_EQ(run("chmod +x bin/* one/pitviper").code, 0);
  const std::string path = "export PATH=\"$PWD/bin:$PATH\"; unset PITVIPER_BUILD; ";
  const std::string one = (folder_ / "one").string(), two = (folder_ / "two").string();
  EXPECT_EQ(run(path + "one/pitviper check").out, "program of " + one + "\n");
  EXPECT_EQ(run(path + "one/pitviper check").out, "program of " + one + "\n");
  ASSERT_EQ(run("cp -a one two").code, 0);
  const Result copied = run(path + "two/pitviper check");
  EXPECT_EQ(copied.out, "program of " + two + "\n") << copied.err;
  EXPECT_NE(copied.err.find("was copied from " + one), std::string::npos) << copied.err;
  EXPECT_EQ(run(path + "one/pitviper check").out, "program of " + one + "\n");
  const Result other = run(path + "export PITVIPER_BUILD=$PWD/one/build; two/pitviper check");
  EXPECT_EQ(other.code, 1);
  EXPECT_NE(other.err.find("was made for the checkout " + one), std::string::npos) << other.err;
  EXPECT_EQ(run(path + "one/pitviper check").out, "program of " + one + "\n");
  ASSERT_EQ(run("mv one three").code, 0);
  EXPECT_EQ(run(path + "three/pitviper check").out, "program of " + (folder_ / "three").string() + "\n");
}

}  // namespace
