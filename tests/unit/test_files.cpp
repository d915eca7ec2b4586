// Files that are read, text that is shown, memory that is predicted.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "scenarios/reader/scenario_reader.hpp"
#include "sim/frame/file_owner.hpp"
#include "sim/parameters/available_memory.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/parameters/readable_text.hpp"
#include "sim/run/memory_need.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

namespace fs = std::filesystem;

struct Files : testing::Test {
  const fs::path folder = fs::temp_directory_path() / ("pitviper_files_" + std::to_string(getpid()));
  Files() { fs::create_directories(folder); }
  ~Files() override { fs::remove_all(folder); }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    return folder / name;
  }
  static std::string refusal(const fs::path& file, const FileWanted& wanted = {}, const Location& askedAt = {}) {
    try {
      readWholeFile(file, wanted, askedAt);
    } catch (const UserError& e) {
      return e.what();
    }
    return "";
  }
};

TEST_F(Files, AreReadWhole) {
  const std::string bytes("a\0b\n", 4);
  EXPECT_EQ(readWholeFile(write("a", bytes)), bytes);
  EXPECT_EQ(readFileStart(folder / "a", 2), bytes.substr(0, 2));
  EXPECT_EQ(readFileStart(folder / "a", 200), bytes);
  EXPECT_EQ(readWholeFile(write("empty", "")), "");
  fs::create_symlink(folder / "a", folder / "link");
  EXPECT_EQ(readWholeFile(folder / "link"), bytes);
  EXPECT_EQ(readWholeFile(folder / "a", {.mostBytes = 4}), bytes);
  EXPECT_EQ(readFileStart(folder / "a", 3, {.mostBytes = 1}), bytes.substr(0, 3));
}

// Expected: nothing but a regular file is read, nothing waits, and the message says what it is, where its name was written, what was wanted and what to do.
TEST_F(Files, OthersAreRefused) {
  ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
  fs::create_symlink(folder / "pipe", folder / "link");
  const Location asked{"scene.yaml", 3, 4, -1};
  EXPECT_EQ(refusal("/dev/zero", {.what = "a table"}, asked),
            "scene.yaml:3:4: cannot read the file '/dev/zero': it is a device, not a regular file; expected a table; fix: give the path of a file");
  for (const auto& [name, kind] : {std::pair{"pipe", "a pipe"}, {"link", "a pipe"}, {".", "a folder"}}) {
    EXPECT_NE(refusal(folder / name).find(std::string("cannot read the file: it is ") + kind + ", not a regular file"), std::string::npos) << name;
  }
  EXPECT_NE(refusal(folder / "nothing", {.fix = "look"}).find("No such file or directory; expected a readable file; fix: look"), std::string::npos);
  const std::string large = refusal(write("large", std::string(100, 'x')), {.mostBytes = 99, .fixLarge = "thin it out"}, asked);
  EXPECT_EQ(large, (folder / "large").string() + ":1:1: the file has 100 bytes; expected at most 99 bytes; fix: thin it out");
}

TEST(Text, IsShownAsWholeCharacters) {
  EXPECT_EQ(readable("5 \xc2\xb5m"), "5 \xc2\xb5m");
  EXPECT_EQ(readable("caf\xc3"), "caf");            // cut
  EXPECT_EQ(readable("'caf\xc3...'"), "'caf...'");  // cut, and told so
  EXPECT_EQ(readable("\xe2\x82...\xf0\x9f\x98"), "...");
  EXPECT_EQ(readable("a\xff\x80z"), "a??z");                        // no beginning of anything
  EXPECT_EQ(readable("a\nb\x1b[31mc\x7f\xc2\x9b"), "a b [31mc  ");  // lines, colours, C1 controls
  EXPECT_EQ(readable("a\xe2\x80\xae z"), "a  z");                   // writes backwards from there on
  EXPECT_EQ(readable("\xed\xa0\x80|\xc0\xaf|"), "|??|");            // half a surrogate pair; an overlong slash
  std::string all;
  for (int c = 0; c < 256; ++c) all += static_cast<char>(c);
  for (size_t from = 0; from < all.size(); ++from) {
    const std::string shown = readable(all.substr(from) + all.substr(0, from));
    for (size_t at = 0; at < shown.size(); at += utf8Length(std::string_view(shown).substr(at)))
      ASSERT_GT(utf8Length(std::string_view(shown).substr(at)), 0u) << from << " " << at;
  }
}

TEST(Text, OfFilesIsShownAsTokens) {
  EXPECT_EQ(tokenOf("1.5e-3"), "'1.5e-3'");
  EXPECT_EQ(tokenOf("  path_radiance_5km_W/(m2 sr um) "), "'path_radiance_5km_W/(m2 sr um)'");
  EXPECT_EQ(tokenOf(std::string(40, 'x')), "'" + std::string(32, 'x') + "...'");
  EXPECT_EQ(tokenOf("root:$6$salt$hash:19000"), "'root...'");
  EXPECT_EQ(tokenOf("\x1b[2J"), "'...'");
  EXPECT_EQ(tokenOf(""), "''");
}

// Expected: keys of what is extended are taken in time in proportion to their number: 40,000 take four times as long as 10,000, not sixteen times.
TEST_F(Files, ExtendsIsLinear) {
  const auto secondsFor = [&](int keys) {
    std::string base, own = "extends: base.yaml\n";
    for (int k = 0; k < keys; ++k) base += "base" + std::to_string(k) + ": 1\n", own += "own" + std::to_string(k) + ": 1\n";
    write("base.yaml", base);
    double least = 1e9;
    for (int turn = 0; turn < 3; ++turn) {
      const std::clock_t start = std::clock();                                     // of the processor
      EXPECT_THROW(readScenarioText(own, "own.yaml", folder, {}, {}), UserError);  // an unknown key, met after all were put together
      least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    }
    return least;
  };
  const double few = secondsFor(10000), many = secondsFor(40000);
  EXPECT_LT(many, 9.0 * few) << few << " s, " << many << " s";
}

std::string filmOf(int pixels, int layers, int samples = 1, const std::string& material = "{}") {
  std::string channels;
  for (int c = 0; c < layers; ++c)
    channels += std::string(c == 0 ? "" : ", ") + "{name: c" + std::to_string(c) + ", response: {band: [" + std::to_string(3000 + 100 * c) + " nm, " +
                std::to_string(3100 + 100 * c) + " nm]}}";
  const std::string side = std::to_string(pixels);
  return "entities: [{name: p, shape: {model: sphere, radius: 2 m}, material: " + material +
         ", temperature: 330 K}]\ncameras: [{name: a, film: {width: " + side + ", height: " + side + "}, samples: " + std::to_string(samples) +
         ", field_of_view: 5 deg, aperture: 40 mm, look_at: p, position: [90 m, 0 m, 0 m], spectral: {samples: 1}, channels: [" + channels + "]}]\n";
}

TEST(Memory, GrowsWithThePicture) {
  const auto need = [](int pixels, int layers, int samples = 1, const std::string& material = "{}") {
    return memoryNeeded(scene(filmOf(pixels, layers, samples, material))).total_bytes;
  };
  const double large = need(8192, 16);
  // 67 million pixels of 16 floats on the GPU, in a buffer and read back, 16 doubles of them, and as frames: at least 3 x 4.3 + 8.6 + 4.3 GB.
  EXPECT_GT(large, 25e9);
  EXPECT_LT(large, 80e9);
  EXPECT_GT(need(4096, 16), 0.24 * large);
  EXPECT_LT(need(4096, 16), 0.3 * large);
  EXPECT_GT(need(4096, 16, 2), 1.5 * need(4096, 16));
  EXPECT_GT(need(2048, 4, 1, "{transmission: {transmittance: 0.5}}"), need(2048, 4));
  EXPECT_LT(need(16, 1), 0.3e9);
  const MemoryNeed told = memoryNeeded(scene(filmOf(8192, 16)));
  EXPECT_EQ(told.greatest, "camera a (8192x8192 pixels, 1x1 subpixels, 16 layers)");
  EXPECT_EQ(told.where.line, 2);
}

TEST(Memory, WhatThereIsIsKnown) {
  const auto available = availableMemory_bytes();
  ASSERT_TRUE(available.has_value());  // Linux tells
  EXPECT_GT(*available, 1e6);
  EXPECT_LT(*available, 1e15);
  refuseBeyondMemory(scene(filmOf(16, 1)));
}

TEST_F(Files, OwnersAreTold) {
  Simulation mine, other;
  mine.name = "mine, sha256 abc";  // a name may look like anything
  mine.sha256 = "abc";
  other.name = "other\nname";
  other.sha256 = "def";
  write("a.csv", tableMark(mine) + "frame\n");
  write("b.csv", tableMark(other) + "frame\n");
  const std::string mark = tableMark(other);
  EXPECT_EQ(std::count(mark.begin(), mark.end(), '\n'), 1);
  refuseForeignFile(folder / "none.csv", mine);
  refuseForeignFile(folder / "a.csv", mine);
  refuseForeignFile(folder / "b.csv", other);
  EXPECT_THROW(refuseForeignFile(folder / "a.csv", other), UserError);
  EXPECT_THROW(refuseForeignFile(folder / "b.csv", mine), UserError);
  ASSERT_EQ(mkfifo((folder / "pipe.csv").c_str(), 0600), 0);
  EXPECT_THROW(refuseForeignFile(folder / "pipe.csv", mine), UserError);
  fs::create_symlink(folder / "nowhere", folder / "dangling.csv");
  EXPECT_THROW(refuseForeignFile(folder / "dangling.csv", mine), UserError);
}

}  // namespace
}  // namespace pitviper::test
