// Tables kept between runs: the same bytes or nothing; what may be wrong with the folder is said once, and stops nobody.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "scenarios/reader/builder.hpp"
#include "sim/parameters/read_file.hpp"
#include "sim/scene/content_cache.hpp"
#include "sim/scene/laws_digest.hpp"
#include "sim/scene/primitives.hpp"
#include "sim/world/clear_facets.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper::test {
namespace {

std::vector<std::string> gTold;

struct ContentCache : testing::Test {
  ContentCache() {
    use(folder.path().string());
    gTold.clear();
    tellOfCacheBy([](const char* line) { gTold.emplace_back(line); });
  }
  ~ContentCache() override {
    tellOfCacheBy(nullptr);
    use(before);
  }
  static void use(const std::string& cache) { setenv("XDG_CACHE_HOME", cache.c_str(), 1); }
  std::vector<std::filesystem::path> files() const {
    std::vector<std::filesystem::path> all;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "pitviper")) all.push_back(entry.path());
    return all;
  }
  const TemporaryFolder folder;
  const std::string before = std::getenv("XDG_CACHE_HOME") != nullptr ? std::getenv("XDG_CACHE_HOME") : "";
};

TEST_F(ContentCache, GivesBackWhatWasWritten) {
  const std::string zeros(3, '\0'), long_(100'000, 'x');
  for (const std::string& bytes : {std::string(), std::string("a"), zeros, long_}) {
    const ContentKey key = contentKey(bytes);
    EXPECT_FALSE(readCachedTable("some-1", key));
    writeCachedTable("some-1", key, bytes);
    EXPECT_EQ(readCachedTable("some-1", key), bytes);
    EXPECT_FALSE(readCachedTable("some-2", key)) << "another version";
    EXPECT_FALSE(readCachedTable("some-1", {key[0], key[1] + 1}));
  }
  EXPECT_TRUE(gTold.empty());
}

// Whatever pieces a fingerprint gives its bytes away in.
TEST_F(ContentCache, KeysOfToldBytesAreThoseOfKeptOnes) {
  for (const std::size_t size : {0, 1, 7, 8, 65'527, 65'528, 65'529, 65'536, 131'073, 200'003}) {
    const auto tell = [size](Fingerprint& f) {
      f.add(std::string(size, 'x')).add(1.0).all(std::vector<float>(size / 3, 2.5f)).all(std::vector<char>(size % 11, 'c'));
    };
    Fingerprint kept;
    tell(kept);
    EXPECT_EQ(contentKeyOf(tell), contentKey(kept.bytes())) << size;
    EXPECT_NE(contentKeyOf(tell), contentKeyOf([&](Fingerprint& f) { tell(f), f.add(0.0); })) << size;
  }
}

TEST_F(ContentCache, ListsReadBackOrNotAtAll) {
  TableWriter out;
  const std::vector<float> some = {1.5f, -2.0f};
  const std::vector<double> none;
  out.all(some), out.all(none);
  TableReader in(out.bytes());
  EXPECT_EQ(in.all<float>(), some);
  EXPECT_FALSE(in.isWhole()) << "a list is left";
  EXPECT_EQ(in.all<double>(), none);
  EXPECT_TRUE(in.isWhole());
  for (std::size_t size = 0; size < out.bytes().size(); ++size) {
    TableReader cut(std::string_view(out.bytes()).substr(0, size));
    cut.all<float>(), cut.all<double>();
    EXPECT_FALSE(cut.isWhole()) << size;
  }
}

TEST_F(ContentCache, DamagedEntriesAreLeftOutAndSaidOnce) {
  const ContentKey key{1, 2};
  const std::string bytes = "a table of some length";
  const auto damaged = [&](const auto& damage) {
    writeCachedTable("some-1", key, bytes);
    EXPECT_EQ(readCachedTable("some-1", key), bytes);
    damage(files().at(0));
    EXPECT_FALSE(readCachedTable("some-1", key));
    EXPECT_TRUE(files().empty()) << "is made anew";
  };
  for (const std::size_t size : {0, 5, 20, 37}) damaged([&](const auto& file) { std::filesystem::resize_file(file, size); });
  for (const int at : {0, 10, 21, 22, 37})
    damaged([&](const auto& file) {
      std::fstream f(file, std::ios::in | std::ios::out | std::ios::binary);
      f.seekp(at);
      f.put('!');
    });
  ASSERT_EQ(gTold.size(), 1u);
  EXPECT_NE(gTold[0].find("is damaged and was removed; pictures are the same without it"), std::string::npos) << gTold[0];
}

TEST_F(ContentCache, AFolderThatCannotBeWrittenIsSaidOnce) {
  folder.put("file", "in the way");
  for (const std::string& cache : {std::string("/proc/unwritable"), (folder.path() / "file").string(), std::string("/dev/null")}) {
    use(cache);
    tellOfCacheBy([](const char* line) { gTold.emplace_back(line); });
    gTold.clear();
    for (int k = 0; k < 3; ++k) {
      writeCachedTable("some-1", {3, 4}, "bytes");
      EXPECT_FALSE(readCachedTable("some-1", {3, 4}));
    }
    ASSERT_EQ(gTold.size(), 1u) << cache;
    EXPECT_NE(gTold[0].find("the cache in " + cache + "/pitviper is of no use: "), std::string::npos) << gTold[0];
  }
}

TEST_F(ContentCache, WhatIsTooLargeIsNotKept) {
  writeCachedTable("some-1", {5, 6}, std::string(kLargestTable + 1, 'x'));
  EXPECT_FALSE(readCachedTable("some-1", {5, 6}));
  EXPECT_TRUE(gTold.empty());
}

TEST_F(ContentCache, ClearFacetsAreTheSame) {
  const Mesh ball = makeSphere(1.0, 24), rod = makeCylinder(0.2, 3.0, 16);
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(0.3, -0.4, 0.8));
  const std::vector<Occluder> none, one = {{rod, glm::dmat3(1.0), {0.2, 0.0, 2.0}}}, farther = {{rod, glm::dmat3(1.0), {0.2, 0.1, 2.0}}};
  std::size_t kept = 0;
  for (const Mesh& mesh : {ball, rod})
    for (const auto* others : {&none, &one, &farther}) {
      const std::vector<char> clear = clearFacets(mesh, toLight, *others);
      EXPECT_EQ(keptClearFacets(mesh, toLight, *others), clear);
      EXPECT_EQ(files().size(), ++kept) << "each by its own content";
      EXPECT_EQ(keptClearFacets(mesh, toLight, *others), clear);
      EXPECT_EQ(files().size(), kept);
    }
  EXPECT_TRUE(gTold.empty());
}

// What is kept is of these sources: a folder that makes tables and is left out would let old ones pass for new.
TEST(LawsDigest, IsOfAllSourcesThatTablesComeFrom) {
  namespace fs = std::filesystem;
  const fs::path root = PITVIPER_SOURCE_DIR;
  const std::set<std::string> none{"import", "import_vdb", "gimbal", "library",
                                   "substances"};  // readers of meshes, which have caches of their own; a mount; data, which is content
  std::set<std::string> files;
  for (const char* folder : {"sim/radiometry", "sim/parameters", "sim/scene", "sim/flight", "sim/model", "sim/world", "sim/radiance", "sim/plan", "atmosphere",
                             "materials", "sensors"})
    for (auto at = fs::recursive_directory_iterator(root / folder); at != fs::recursive_directory_iterator(); ++at) {
      if (at->is_directory() && none.contains(at->path().filename().string())) at.disable_recursion_pending();
      const std::string kind = at->path().extension().string();
      if (kind == ".cpp" || kind == ".hpp" || kind == ".glsl") files.insert(at->path().string());
    }
  EXPECT_GT(files.size(), 200u);
  std::string all;
  for (const std::string& file : files) all += sha256(readWholeFile(file));
  EXPECT_EQ(sha256(all).substr(0, 16), lawsDigest());
}

}  // namespace
}  // namespace pitviper::test
