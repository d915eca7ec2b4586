// The image module: what is written comes back, damage is reported, and nothing partly written is left.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <future>
#include <limits>
#include <random>
#include <sstream>

#include "sim/image/atomic_file.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/image/draw_text.hpp"
#include "sim/image/exr.hpp"
#include "sim/image/png.hpp"
#include "sim/image/preview.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/error.hpp"
#include "tests/support/read_png.hpp"

namespace pitviper {
namespace {

namespace fs = std::filesystem;

std::string slurp(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  return out.str();
}

void spill(const fs::path& path, std::string_view bytes) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

template <class Error, class Action>
std::string messageOf(Action action) {
  try {
    action();
  } catch (const Error& e) {
    return e.what();
  }
  ADD_FAILURE() << "no error, or not of the expected kind";
  return "";
}

class ImageTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "image_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::permissions(folder_, fs::perms::owner_all, ignored);
    fs::remove_all(folder_, ignored);
  }
  std::size_t filesLeft() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator())); }

  fs::path folder_;
};

using ExrFile = ImageTest;
using AtomicFile = ImageTest;
using PngFile = ImageTest;

ExrImage sample() {
  ExrImage image;
  image.width = 37;
  image.height = 29;
  FloatLayer mw{"mw.radiance", {}}, lw{"lw.radiance", {}};
  for (int i = 0; i < 37 * 29; ++i) {
    mw.pixels.push_back(std::sin(0.1f * static_cast<float>(i)) * 1e-3f);
    lw.pixels.push_back(static_cast<float>(i) * 1e20f);
  }
  mw.pixels[3] = std::numeric_limits<float>::infinity();
  mw.pixels[4] = std::numeric_limits<float>::denorm_min();
  image.layers = {mw, lw};
  image.attributes = {{"pitviper.scenario", std::string("a ² · µ\nb")},
                      {"time_s", 0.1 + 0.2},
                      {"tick", -7},
                      {"position_m", std::vector<double>{1.0 / 3.0, -4e300, 5e-324}},
                      {"quaternion", std::vector<double>{0.1, -1.0 / 3.0, 1e-310, 4e300}},
                      {"nothing", std::vector<double>{}},
                      {"a_name_that_is_longer_than_the_thirty_one_bytes_of_old", std::string()}};
  return image;
}

TEST_F(ExrFile, TwoWritesGiveTheSameBytes) {
  writeExr(folder_ / "a.exr", sample());
  writeExr(folder_ / "b.exr", sample());
  EXPECT_EQ(slurp(folder_ / "a.exr"), slurp(folder_ / "b.exr"));
  EXPECT_EQ(filesLeft(), 2u);
}

TEST_F(ExrFile, PixelsComeBackBitForBit) {
  const ExrImage out = sample();
  writeExr(folder_ / "a.exr", out);
  const ExrImage in = readExr(folder_ / "a.exr");
  EXPECT_EQ(in.width, 37);
  EXPECT_EQ(in.height, 29);
  ASSERT_EQ(in.layers.size(), 2u);
  EXPECT_EQ(in.find("none"), nullptr);
  for (const FloatLayer& layer : out.layers) {
    const FloatLayer* back = in.find(layer.name);
    ASSERT_NE(back, nullptr);
    ASSERT_EQ(back->pixels.size(), layer.pixels.size());
    EXPECT_EQ(std::memcmp(back->pixels.data(), layer.pixels.data(), 4 * layer.pixels.size()), 0);
  }
}

TEST_F(ExrFile, AttributesComeBack) {
  const ExrImage out = sample();
  writeExr(folder_ / "a.exr", out);
  const ExrImage in = readExr(folder_ / "a.exr");
  EXPECT_EQ(in.attributes.size(), out.attributes.size());
  for (const Attribute& attribute : out.attributes) {
    const Attribute* back = in.findAttribute(attribute.name);
    ASSERT_NE(back, nullptr) << attribute.name;
    if (const auto* list = std::get_if<std::vector<double>>(&attribute.value)) EXPECT_EQ(numbersOf(*back), *list) << attribute.name;
    else EXPECT_EQ(back->value, attribute.value) << attribute.name;
  }
  EXPECT_TRUE(std::holds_alternative<std::vector<double>>(in.findAttribute("position_m")->value));
  EXPECT_EQ(numbersOf(*in.findAttribute("pitviper.scenario")), std::nullopt);
}

TEST_F(ExrFile, WhatWasReadCanBeWrittenAgain) {
  writeExr(folder_ / "a.exr", sample());
  writeExr(folder_ / "b.exr", readExr(folder_ / "a.exr"));
  EXPECT_EQ(slurp(folder_ / "a.exr"), slurp(folder_ / "b.exr"));
}

TEST_F(ExrFile, WrongShapesAndNamesAreTheCallersBugs) {
  const fs::path path = folder_ / "a.exr";
  const auto refused = [&](auto change) {
    ExrImage image = sample();
    change(image);
    EXPECT_THROW(writeExr(path, image), std::invalid_argument);
  };
  refused([](ExrImage& i) { i.width = 0; });
  refused([](ExrImage& i) { i.height = 30; });
  refused([](ExrImage& i) { i.layers.clear(); });
  refused([](ExrImage& i) { i.layers[1].name = i.layers[0].name; });
  refused([](ExrImage& i) { i.layers[1].name = ""; });
  refused([](ExrImage& i) { i.attributes[0].name = "dataWindow"; });
  refused([](ExrImage& i) { i.attributes[0].name = i.attributes[1].name; });
  refused([](ExrImage& i) { i.attributes[0].name = std::string(256, 'x'); });
  EXPECT_EQ(filesLeft(), 0u);
}

/// True if the bytes gave an image, false if a UserError that names the file; anything else fails the test.
bool readsOrExplains(const fs::path& path, std::string_view bytes) {
  spill(path, bytes);
  try {
    const ExrImage image = readExr(path);
    for (const FloatLayer& layer : image.layers) EXPECT_EQ(layer.pixels.size(), static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
    return true;
  } catch (const UserError& e) {
    EXPECT_NE(std::string(e.what()).find(path.string()), std::string::npos) << e.what();
    return false;
  }
}

TEST_F(ExrFile, EveryTruncationIsAUserError) {
  writeExr(folder_ / "a.exr", sample());
  const std::string whole = slurp(folder_ / "a.exr");
  for (std::size_t size = 0; size < whole.size(); size += size < 1200 ? 1 : 13)
    EXPECT_FALSE(readsOrExplains(folder_ / "cut.exr", std::string_view(whole).substr(0, size))) << size;
}

TEST_F(ExrFile, FlippedBytesNeverCrash) {
  writeExr(folder_ / "a.exr", sample());
  const std::string whole = slurp(folder_ / "a.exr");
  for (std::size_t i = 0; i < whole.size(); i += i < 1200 ? 1 : 7)
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ change);
      readsOrExplains(folder_ / "bad.exr", bytes);
    }
  std::mt19937 random(1);
  for (int round = 0; round < 1000; ++round) {
    std::string bytes = whole;
    for (int k = 0; k < 8; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
    readsOrExplains(folder_ / "bad.exr", bytes);
  }
}

/// Replaces the value of the first attribute of that name and type in the header.
std::string withValue(std::string bytes, const std::string& nameAndType, std::string_view value) {
  const std::size_t at = bytes.find(nameAndType);
  EXPECT_NE(at, std::string::npos);
  return bytes.replace(at + nameAndType.size() + 4, value.size(), value);
}

TEST_F(ExrFile, HostileHeadersAreUserErrors) {
  writeExr(folder_ / "a.exr", sample());
  const std::string whole = slurp(folder_ / "a.exr");
  const std::string window("dataWindow\0box2i\0", 17);
  const auto box = [](std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    const std::int32_t values[4] = {x0, y0, x1, y1};
    return std::string(reinterpret_cast<const char*>(values), 16);
  };
  const auto refused = [&](const std::string& bytes, const std::string& words) {
    spill(folder_ / "bad.exr", bytes);
    EXPECT_NE(messageOf<UserError>([&] { readExr(folder_ / "bad.exr"); }).find(words), std::string::npos) << words;
  };
  constexpr std::int32_t least = std::numeric_limits<std::int32_t>::min(), most = std::numeric_limits<std::int32_t>::max();
  refused(withValue(whole, window, box(0, 0, 32768, 28)), "32768 on a side");
  refused(withValue(whole, window, box(least, least, most, most)), "32768 on a side");
  refused(withValue(whole, window, box(5, 5, 4, 4)), "32768 on a side");
  refused(withValue(whole, window, box(most - 36, 0, most, 28)), "far out");
  refused(withValue(whole, window, box(0, 0, 32767, 32767)), "far too short");
  std::string flags = whole;
  flags[5] = static_cast<char>(flags[5] | 0x10);
  refused(flags, "multi-part");
  refused("", "not an EXR");
  refused("\x89PNG\r\n\x1a\n something else", "not an EXR");
  EXPECT_NE(messageOf<UserError>([&] { readExr(folder_ / "missing.exr"); }).find("missing.exr"), std::string::npos);
  EXPECT_THROW(readExr(folder_), UserError);
  EXPECT_THROW(readExr("/dev/zero"), UserError);
}

TEST_F(AtomicFile, ReplacesAFileAndLeavesNoTemporary) {
  writeFileAtomically(folder_ / "a.txt", "one");
  writeFileAtomically(folder_ / "a.txt", std::string_view("t\0o", 3));
  EXPECT_EQ(slurp(folder_ / "a.txt"), std::string("t\0o", 3));
  EXPECT_EQ(filesLeft(), 1u);
}

// Expected: what nobody writes any more goes; what is being written (locked by whoever writes), is no file, or only looks alike stays.
TEST_F(AtomicFile, OnlyAbandonedTemporariesGo) {
  const std::string tag = ".0123456789abcdef.partial";
  spill(folder_ / (".killed.exr" + tag), "half");
  spill(folder_ / (".written.exr" + tag), "half");
  spill(folder_ / ".other.partial", "a download of the user's");
  spill(folder_ / ("no_dot" + tag), "x");
  fs::create_directory(folder_ / (".folder" + tag));
  fs::create_symlink(folder_ / ".other.partial", folder_ / (".link" + tag));
  ASSERT_EQ(mkfifo((folder_ / (".pipe" + tag)).c_str(), 0600), 0);
  const int writer = open((folder_ / (".written.exr" + tag)).c_str(), O_WRONLY | O_CLOEXEC);
  ASSERT_EQ(flock(writer, LOCK_EX), 0);
  ensureWritableFolder(folder_);
  EXPECT_FALSE(fs::exists(folder_ / (".killed.exr" + tag)));
  EXPECT_EQ(filesLeft(), 6u);
  close(writer);
  removeAbandonedTemporaries(folder_);
  EXPECT_FALSE(fs::exists(folder_ / (".written.exr" + tag)));
  EXPECT_EQ(filesLeft(), 5u);
}

// Expected: whatever the order, a reader meets one of the writers' files, whole, at every moment; cleaning up meanwhile disturbs none of them.
TEST_F(AtomicFile, ManyWritersOfOneName) {
  constexpr int kWriters = 4, kTurns = 100;
  writeFileAtomically(folder_ / "a.bin", std::string(10000, 'a'));
  std::atomic<int> left{kWriters};
  std::vector<std::future<void>> writers;
  for (int w = 0; w < kWriters; ++w)
    writers.push_back(std::async(std::launch::async, [&, w] {
      for (int turn = 0; turn < kTurns; ++turn) writeFileAtomically(folder_ / "a.bin", std::string(10000, static_cast<char>('a' + w)));
      --left;
    }));
  while (left > 0) {
    removeAbandonedTemporaries(folder_);
    const std::string bytes = slurp(folder_ / "a.bin");
    ASSERT_EQ(bytes.size(), 10000u);
    ASSERT_EQ(bytes.find_first_not_of(bytes[0]), std::string::npos);
  }
  for (auto& w : writers) w.get();  // no writer has failed
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(AtomicFile, WhatMayNotBeReplacedStays) {
  const auto refuse = [](const fs::path& file) { throw UserError({file.string()}, "is another's"); };
  writeFileAtomically(folder_ / "a.txt", "one", refuse);  // nothing there: not asked
  EXPECT_THROW(writeFileAtomically(folder_ / "a.txt", "two", refuse), UserError);
  EXPECT_EQ(slurp(folder_ / "a.txt"), "one");
  writeFileAtomically(folder_ / "a.txt", "three", [](const fs::path&) {});
  EXPECT_EQ(slurp(folder_ / "a.txt"), "three");
  EXPECT_EQ(filesLeft(), 1u);
}

// Expected: what a file says of its origin is found without reading its pixels, and nothing is found in what is damaged, cut at any place or something else.
TEST_F(AtomicFile, TextsInHeaders) {
  ExrImage image = sample();
  image.attributes.push_back({"pitviper.scenario_sha256", std::string("abc")});
  image.attributes.push_back({"a.number", 3});
  writeExr(folder_ / "a.exr", image);
  EXPECT_EQ(readExrText(folder_ / "a.exr", "pitviper.scenario_sha256"), "abc");
  EXPECT_EQ(readExrText(folder_ / "a.exr", "a.number"), std::nullopt);
  EXPECT_EQ(readExrText(folder_ / "a.exr", "pitviper.scenar"), std::nullopt);
  Rgb8Image picture(13, 7, {1, 2, 3});
  writePng(folder_ / "a.png", picture, {{"pitviper.scenario_sha256", "abc"}, {"pitviper.scenario", "name"}});
  EXPECT_EQ(readPngText(folder_ / "a.png", "pitviper.scenario_sha256"), "abc");
  EXPECT_EQ(readPngText(folder_ / "a.png", "pitviper.scenario"), "name");
  EXPECT_EQ(readPngText(folder_ / "a.png", "pitviper"), std::nullopt);
  EXPECT_EQ(test::readPng(folder_ / "a.png").rgb, picture.rgb);
  for (const char* name : {"a.exr", "a.png"}) {
    const std::string bytes = slurp(folder_ / name);
    for (size_t size = 0; size < bytes.size(); size += size < 1500 ? 5 : 997) {
      spill(folder_ / "cut", bytes.substr(0, size));
      const auto exr = readExrText(folder_ / "cut", "pitviper.scenario_sha256"), png = readPngText(folder_ / "cut", "pitviper.scenario_sha256");
      EXPECT_TRUE((!exr || *exr == "abc") && (!png || *png == "abc")) << size;
    }
  }
  EXPECT_EQ(readExrText(folder_ / "nothing", "a"), std::nullopt);
  EXPECT_EQ(readExrText("/dev/zero", "a"), std::nullopt);
  EXPECT_EQ(readPngText(folder_, "a"), std::nullopt);
}

TEST_F(AtomicFile, AMissingFolderIsAnOutputError) {
  const std::string message = messageOf<OutputError>([&] { writeExr(folder_ / "none" / "a.exr", sample()); });
  EXPECT_NE(message.find("none/a.exr"), std::string::npos) << message;
  EXPECT_NE(message.find("No such file"), std::string::npos) << message;
  EXPECT_NE(message.find("fix: "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

TEST_F(AtomicFile, AFullDiskIsFound) {
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  if (full < 0) GTEST_SKIP() << "no /dev/full here";
  const std::string message = messageOf<OutputError>([&] { writeAll(full, "bytes", "frame.exr"); });
  close(full);
  EXPECT_NE(message.find("No space left"), std::string::npos) << message;
  EXPECT_NE(message.find("free space"), std::string::npos) << message;
}

TEST_F(AtomicFile, AWriteThatStopsHalfwayLeavesTheOldFile) {
  writeFileAtomically(folder_ / "a.bin", "old");
  // A limit on the size of files cuts the write short as a full disk does, for root too.
  rlimit before = {};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = 4096;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  std::string message, exrMessage;
  try {
    writeFileAtomically(folder_ / "a.bin", std::string(10000, 'x'));
  } catch (const OutputError& e) {
    message = e.what();
  }
  ExrImage image = sample();
  std::mt19937 random(1);
  for (float& value : image.layers[0].pixels) value = static_cast<float>(random());
  try {
    writeExr(folder_ / "a.exr", image);
  } catch (const OutputError& e) {
    exrMessage = e.what();
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_NE(message.find("cannot write"), std::string::npos) << message;
  EXPECT_NE(exrMessage.find("cannot write"), std::string::npos) << exrMessage;
  EXPECT_EQ(slurp(folder_ / "a.bin"), "old");
  EXPECT_EQ(filesLeft(), 1u);
}

TEST_F(AtomicFile, DevicesAndFoldersAreNotReplaced) {
  EXPECT_THROW(writeFileAtomically("/dev/null", "x"), OutputError);
  EXPECT_THROW(writeFileAtomically(folder_, "x"), OutputError);
  EXPECT_THROW(writeFileAtomically(folder_ / "", "x"), OutputError);
  EXPECT_THROW(writeFileAtomically(folder_ / std::string(300, 'n'), "x"), OutputError);
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
  EXPECT_EQ(filesLeft(), 0u);
}

TEST_F(AtomicFile, AFolderIsCreatedOrExplained) {
  ensureWritableFolder(folder_ / "x" / "y");
  EXPECT_TRUE(fs::is_directory(folder_ / "x" / "y"));
  ensureWritableFolder(folder_ / "x" / "y" / "");
  spill(folder_ / "file", "x");
  EXPECT_THROW(ensureWritableFolder(folder_ / "file"), OutputError);
  EXPECT_THROW(ensureWritableFolder(folder_ / "file" / "below"), OutputError);
  EXPECT_THROW(ensureWritableFolder(""), OutputError);
}

TEST_F(AtomicFile, AReadOnlyFolderIsAnOutputError) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write to a read-only folder";
  fs::permissions(folder_, fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THROW(ensureWritableFolder(folder_), OutputError);
  EXPECT_THROW(writeFileAtomically(folder_ / "a", "x"), OutputError);
}

Rgb8Image samplePicture() {
  Rgb8Image picture(13, 7, {1, 2, 3});
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 13; ++x) picture.set(x, y, {static_cast<std::uint8_t>(19 * x), static_cast<std::uint8_t>(36 * y), static_cast<std::uint8_t>(x * y)});
  return picture;
}

TEST_F(PngFile, ComesBackAndIsTheSameTwice) {
  const Rgb8Image out = samplePicture();
  writePng(folder_ / "a.png", out);
  writePng(folder_ / "b.png", out);
  EXPECT_EQ(slurp(folder_ / "a.png"), slurp(folder_ / "b.png"));
  const Rgb8Image in = test::readPng(folder_ / "a.png");
  EXPECT_EQ(in.width, out.width);
  EXPECT_EQ(in.height, out.height);
  EXPECT_EQ(in.rgb, out.rgb);
}

TEST_F(PngFile, DamageIsAUserError) {
  std::vector<std::uint16_t> codes;
  for (int i = 0; i < 13 * 7; ++i) codes.push_back(static_cast<std::uint16_t>(719 * i));
  writePngGrey(folder_ / "a.png", 13, 7, codes);
  const std::string whole = slurp(folder_ / "a.png");
  for (std::size_t size = 0; size < whole.size(); ++size) {
    spill(folder_ / "bad.png", std::string_view(whole).substr(0, size));
    EXPECT_THROW(readPngGrey(folder_ / "bad.png"), UserError) << size;
  }
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const int change : {0x01, 0x20, 0xff}) {
      std::string bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ change);
      spill(folder_ / "bad.png", bytes);
      try {
        readPngGrey(folder_ / "bad.png");
      } catch (const UserError& e) {
        EXPECT_NE(std::string(e.what()).find("bad.png"), std::string::npos);
      }
    }
  EXPECT_THROW(readPngGrey(folder_ / "none.png"), UserError);
  EXPECT_THROW(readPngGrey(folder_), UserError);
}

TEST_F(PngFile, WrongShapesAreTheCallersBugs) {
  Rgb8Image picture = samplePicture();
  picture.width = 12;
  EXPECT_THROW(writePng(folder_ / "a.png", picture), std::invalid_argument);
  EXPECT_THROW(writePng(folder_ / "a.png", Rgb8Image()), std::invalid_argument);
}

std::string fromHex(std::string_view hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) bytes += static_cast<char>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16));
  return bytes;
}

// Small grey files, encoded elsewhere since the module writes 16 bits only.
constexpr std::string_view grey8 =
    "89504e470d0a1a0a0000000d49484452000000030000000108000000003e8b4b680000000c49444154789c636068f80f00020301802461"
    "f5970000000049454e44ae426082";
constexpr std::string_view grey16 =
    "89504e470d0a1a0a0000000d49484452000000030000000110000000006e1b972b0000000f49444154789c6360601032f9ff1f0003e802"
    "45d58f48480000000049454e44ae426082";
constexpr std::string_view grey1 =
    "89504e470d0a1a0a0000000d4948445200000003000000010100000000339b29190000000a49444154789c6358000000a200a1dc8db1cc"
    "0000000049454e44ae426082";
constexpr std::string_view side16385 =
    "89504e470d0a1a0a0000000d4948445200004001000000010800000000ec3682ba0000000949444154789c630000000100015eff7df900"
    "00000049454e44ae426082";
constexpr std::string_view side16384 =
    "89504e470d0a1a0a0000000d4948445200004000000040001000000000dc33931b0000000949444154789c630000000100015eff7df900"
    "00000049454e44ae426082";

TEST_F(PngFile, GreyCodesAreLinearAndExact) {
  spill(folder_ / "g8.png", fromHex(grey8));
  const GreyImage g8 = readPngGrey(folder_ / "g8.png");
  EXPECT_EQ(g8.bits, 8);
  EXPECT_EQ(g8.width, 3);
  EXPECT_EQ(g8.height, 1);
  EXPECT_EQ(g8.pixels, (std::vector<float>{0.0f, 128.0f / 255.0f, 1.0f}));
  spill(folder_ / "g16.png", fromHex(grey16));
  const GreyImage g16 = readPngGrey(folder_ / "g16.png");
  EXPECT_EQ(g16.bits, 16);
  EXPECT_EQ(g16.pixels, (std::vector<float>{0.0f, 4660.0f / 65535.0f, 1.0f}));
  spill(folder_ / "g1.png", fromHex(grey1));
  const GreyImage g1 = readPngGrey(folder_ / "g1.png");
  EXPECT_EQ(g1.bits, 1);
  EXPECT_EQ(g1.pixels, (std::vector<float>{1.0f, 0.0f, 1.0f}));
}

TEST_F(PngFile, HostileSizesAndColourTexturesAreUserErrors) {
  spill(folder_ / "big.png", fromHex(side16385));
  EXPECT_NE(messageOf<UserError>([&] { readPngGrey(folder_ / "big.png"); }).find("16384"), std::string::npos);
  spill(folder_ / "short.png", fromHex(side16384));
  EXPECT_NE(messageOf<UserError>([&] { readPngGrey(folder_ / "short.png"); }).find("too short"), std::string::npos);
  writePng(folder_ / "rgb.png", samplePicture());
  EXPECT_NE(messageOf<UserError>([&] { readPngGrey(folder_ / "rgb.png"); }).find("colour"), std::string::npos);
}

double okLightness(Rgb8 c) {
  const auto linear = [](double code) { return code <= 0.04045 * 255 ? code / 255 / 12.92 : std::pow((code / 255 + 0.055) / 1.055, 2.4); };
  const double r = linear(c.r), g = linear(c.g), b = linear(c.b);
  return 0.2104542553 * std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b) +
         0.7936177850 * std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b) -
         0.0040720468 * std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
}

TEST(ColourMaps, ThermalLightnessGrowsEvenly) {
  const ColourMap& map = colourMap("thermal");
  const double low = okLightness(map(0)), high = okLightness(map(1));
  EXPECT_GT(high - low, 0.8);
  for (int i = 0; i <= 64; ++i) {
    const double t = i / 64.0;
    EXPECT_NEAR(okLightness(map(static_cast<float>(t))), low + (high - low) * t, 0.008) << t;  // 8-bit codes: 0.004 in the dark
  }
}

TEST(ColourMaps, ClampAndNames) {
  for (const std::string& name : colourMapNames()) {
    const ColourMap& map = colourMap(name);
    EXPECT_EQ(map(-1), map(0));
    EXPECT_EQ(map(2), map(1));
    EXPECT_EQ(map(std::nanf("")), map(0));
  }
  EXPECT_EQ(colourMap("white_hot")(0.5f), (Rgb8{128, 128, 128}));
  EXPECT_THROW(colourMap("no such map"), std::invalid_argument);
}

TEST(AxisTicks, AreRound) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(chooseTicks(0, 1).labels, (Labels{"0.0", "0.2", "0.4", "0.6", "0.8", "1.0"}));
  EXPECT_EQ(chooseTicks(287.3, 312.9).labels, (Labels{"290", "295", "300", "305", "310"}));
  EXPECT_EQ(chooseTicks(-1, 1).labels, (Labels{"−1.0", "−0.5", "0.0", "0.5", "1.0"}));
  const Ticks small = chooseTicks(1.2e-4, 6.1e-4);
  EXPECT_EQ(small.power, -4);
  EXPECT_EQ(small.labels, (Labels{"2", "3", "4", "5", "6"}));
  const Ticks large = chooseTicks(0, 2.5e6);
  EXPECT_EQ(large.power, 6);
  EXPECT_EQ(large.labels, (Labels{"0.0", "0.5", "1.0", "1.5", "2.0", "2.5"}));
  EXPECT_THROW(chooseTicks(1, 1), std::invalid_argument);
  EXPECT_THROW(chooseTicks(0, std::nan("")), std::invalid_argument);
}

TEST(AxisTicks, AreFewAndInsideForAnyRange) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> exponent(-300, 300), part(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::pow(10.0, exponent(random));
    double low = part(random) * scale, high = part(random) * scale;
    if (low > high) std::swap(low, high);
    if (high - low < 1e-6 * scale) continue;
    const Ticks ticks = chooseTicks(low, high);
    EXPECT_GE(ticks.values.size(), 3u) << low << ' ' << high;
    EXPECT_LE(ticks.values.size(), 8u) << low << ' ' << high;
    for (const double value : ticks.values) {
      EXPECT_GE(value, low - 1e-5 * (high - low));
      EXPECT_LE(value, high + 1e-5 * (high - low));
    }
    for (std::size_t k = 1; k < ticks.labels.size(); ++k) EXPECT_NE(ticks.labels[k], ticks.labels[k - 1]) << low << ' ' << high;
  }
}

TEST(AxisTicks, NumbersAlone) {
  EXPECT_EQ(shortNumber(0), "0");
  EXPECT_EQ(shortNumber(305.16), "305.2");
  EXPECT_EQ(shortNumber(410), "410");
  EXPECT_EQ(shortNumber(4.1e-7), "4.1e-7");
  EXPECT_EQ(shortNumber(-4.1e12), "−4.1e12");
  EXPECT_EQ(shortNumber(100000), "1.0e5");
  EXPECT_EQ(powerText(-12), "×10⁻¹²");
  EXPECT_EQ(powerText(0), "");
}

TEST(Text, IsDrawnOrSilentlyAbsent) {
  Rgb8Image picture(200, 40, {0, 0, 0});
  const Font none("/no/such/font.ttf");
  EXPECT_FALSE(none.available());
  EXPECT_EQ(none.width("abc", 16), 0);
  none.draw(picture, 5, 25, "abc", 16, {255, 255, 255});
  EXPECT_EQ(picture.rgb, Rgb8Image(200, 40, {0, 0, 0}).rgb);
  if (!plainFont().available()) GTEST_SKIP() << "DejaVu Sans is not installed";
  plainFont().draw(picture, 5, 25, "W m⁻² sr⁻¹ · µm", 16, {255, 255, 255});
  EXPECT_NE(picture.rgb, Rgb8Image(200, 40, {0, 0, 0}).rgb);
  // Each of these has a glyph of its own, and broken UTF-8 ends.
  EXPECT_GT(plainFont().width("²", 16), 0);
  EXPECT_LT(plainFont().width("²", 16), plainFont().width("22", 16));
  EXPECT_GT(plainFont().width("\xff\xc2\xe2\x82\xf0", 16), 0);
  plainFont().draw(picture, -50, -50, "outside", 16, {255, 0, 0});
  plainFont().draw(picture, 195, 38, "outside", 400, {255, 0, 0});
}

TEST(Preview, RangeIsNeverEmpty) {
  const float nan = std::nanf("");
  const std::vector<std::vector<float>> images = {{}, {nan, nan}, {0, 0, 0}, {300, 300}, {-5}, {300, 300.00003f}, {3e38f, -3e38f}, {1e-45f}};
  for (const std::vector<float>& pixels : images) {
    const PictureScale scale = PictureScale::of(pixels);
    EXPECT_LT(scale.low(), scale.high());
    EXPECT_TRUE(std::isfinite(scale.low()) && std::isfinite(scale.high()));
  }
  std::vector<float> target(100000, 1.0f);
  target[5] = 9.0f;  // a hot point, outside the percentiles
  const auto ends = [](const PictureScale& scale) { return std::pair(scale.low(), scale.high()); };
  EXPECT_EQ(ends(PictureScale::of(target)), (std::pair<double, double>{1.0, 9.0}));
  std::vector<float> ramp;
  for (int i = 0; i <= 1000; ++i) ramp.push_back(static_cast<float>(i));
  EXPECT_EQ(ends(PictureScale::of(ramp)), (std::pair<double, double>{5.0, 998.0}));
}

int countOf(const Rgb8Image& picture, Rgb8 colour) {
  int count = 0;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) count += picture.at(x, y) == colour;
  return count;
}

TEST(Preview, PixelsBecomeSquaresAndNanMagenta) {
  std::vector<float> pixels(100 * 60, 1.0f);
  pixels[0] = std::nanf("");
  pixels[1] = std::numeric_limits<float>::infinity();
  pixels[2] = 2.0f;
  const Rgb8Image picture = makePreview(100, 60, pixels, {"title", "K", "white_hot", std::nullopt, std::pair{0.0, 4.0}});
  EXPECT_GT(picture.width, 600);
  EXPECT_EQ(countOf(picture, {255, 0, 255}), 2 * 6 * 6);
  EXPECT_GE(countOf(picture, {128, 128, 128}), 6 * 6);
  EXPECT_EQ(picture.rgb, makePreview(100, 60, pixels, {"title", "K", "white_hot", std::nullopt, std::pair{0.0, 4.0}}).rgb);
}

TEST(Preview, AnyShapeAndValuesGiveAPicture) {
  for (const auto& [w, h] : {std::pair{1, 1}, {1, 700}, {700, 1}, {513, 4}, {2, 3}}) {
    const std::size_t count = static_cast<std::size_t>(w * h);
    for (const float value : {0.0f, 1e-45f, 3e38f, -7.5f, std::nanf("")}) {
      std::vector<float> pixels(count, value);
      pixels.back() = 1.0f;
      for (const std::string& map : colourMapNames()) {
        const Rgb8Image picture = makePreview(w, h, pixels, {std::string(300, 'M'), "W/(m² sr µm)", map, std::nullopt});
        EXPECT_GE(std::max(picture.width, picture.height), 512);
      }
    }
  }
  EXPECT_THROW(makePreview(2, 2, {1, 2, 3}, {}), std::invalid_argument);
  EXPECT_THROW(makePreview(0, 2, {}, {}), std::invalid_argument);
  PreviewOptions falling;
  falling.range = {2.0, 1.0};
  EXPECT_THROW(makePreview(1, 1, {1}, falling), std::invalid_argument);
  EXPECT_THROW(makePreview(1, 1, {1}, {"", "", "no such map", std::nullopt}), std::invalid_argument);
}

TEST(Preview, SideBySide) {
  const Rgb8Image a(3, 2, {9, 9, 9}), b(4, 5, {7, 7, 7});
  const Rgb8Image sheet = placeSideBySide({a, b});
  EXPECT_EQ(sheet.width, 7);
  EXPECT_EQ(sheet.height, 5);
  EXPECT_EQ(countOf(sheet, {9, 9, 9}), 6);
  EXPECT_EQ(countOf(sheet, {7, 7, 7}), 20);
  EXPECT_EQ(placeSideBySide({}).width, 0);
}

}  // namespace
}  // namespace pitviper
