// Random trees of includes, parameters, expressions and repeated entries, with mistakes: each must become a tree without them, or be refused in one line with
// its place and fix. PITVIPER_FUZZ_EXPAND sets their number (default 1500), PITVIPER_FUZZ_SEED the first seed.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstdlib>
#include <filesystem>
#include <random>

#include "scenarios/reader/expand.hpp"
#include "scenarios/reader/yaml_tree.hpp"
#include "tests/support/temporary_folder.hpp"

namespace pitviper {
namespace {

long long fromEnvironment(const char* name, long long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atoll(text);
}

constexpr int kFiles = 6;
/// Files of entries are the later ones.
constexpr int kMaps = 3;

/// Writes files that are mostly good: each includes later ones, and each parameter uses earlier ones.
class Writer {
 public:
  explicit Writer(std::uint64_t seed) : random_(seed) {}
  size_t below(size_t n) { return static_cast<size_t>(random_() % n); }

  /// `number`: -1 is the scenario.
  std::string file(int number) {
    number_ = number;
    names_.clear();
    std::string text;
    if (number >= kMaps) {
      names_ = below(20) == 0 ? "ai" : "a";  // given by `with`
      for (size_t k = below(3) + 1; k-- > 0;) text += "- " + entry(2) + "\n";
      return text;
    }
    if (number + 1 < kMaps && below(2) == 0) text += "include: " + (below(3) == 0 ? "[" + map() + ", " + map() + "]" : map()) + "\n";
    if (number + 1 < kMaps && below(5) == 0) text += "extends: " + map() + "\n";
    text += "parameters:\n";
    for (char p : {'a', 'b', 'c', 'd'}) {
      text += std::string("  ") + p + ": " + (p == 'a' ? numberText() : value(2)) + "\n";
      names_ += p;
    }
    for (size_t k = below(4); k-- > 0;) text += std::string("k") + std::to_string(number_ + 1) + std::to_string(k) + ": " + value(3) + "\n";
    text += "list: [" + entry(2) + ", " + entry(2) + "]\nname: n$a\nx: $b\ny: [$c, $d]\n";
    return text;
  }
  void damage(std::string& text) {
    static const char* const kWords[] = {"$", "${", "$$", "=", "= ", "include", "repeat", "count", "with", "every", "{",  "}",
                                         "[", "]",  "\"", "-", ": ", "\n",      "4096",   "&a ",   "*a",   "1e999", "..", "/"};
    const size_t at = below(text.size() + 1), length = below(12);
    if (below(2) == 0) text.erase(at, length);
    else text.insert(at, kWords[below(std::size(kWords))]);
  }

 private:
  std::string fileOf(int first, int last) {
    if (below(40) == 0) first = 0;
    return "f" + std::to_string(first + static_cast<int>(below(static_cast<size_t>(std::max(last - first, 1))))) + ".yaml";
  }
  std::string map() { return fileOf(std::min(number_ + 1, kMaps - 1), kMaps); }
  std::string numberText() { return std::to_string(below(9) + 1) + (below(40) == 0 ? " m" : ""); }
  std::string word() {
    if (names_.empty()) return numberText();
    if (below(60) == 0) return "$e";
    return std::string("$") + names_[below(names_.size())];
  }
  std::string expression(int depth) {
    if (depth == 0 || below(3) == 0) return below(2) || names_.empty() ? numberText() : "$a";
    static const char* const kFunctions[] = {"abs", "floor", "sqrt", "min", "max", "mod", "sin"};
    const size_t f = below(30) == 0 ? 6 : below(6);
    if (below(3) == 0) return std::string(kFunctions[f]) + "(" + expression(depth - 1) + (f > 2 && f < 6 ? ", " + expression(depth - 1) : "") + ")";
    return "(" + expression(depth - 1) + " " + "+*-/"[below(10) == 0 ? 2 + below(2) : below(2)] + " " + expression(depth - 1) + ")";
  }
  std::string value(int depth) {
    switch (below(depth > 0 ? 8 : 4)) {
      case 0:
        return numberText();
      case 1:
        return word();
      case 2:
        return "\"= " + expression(2) + "\"";
      case 3:
        return names_.empty() ? "text" : "\"t${a}_$$$a\"";
      case 4:
        return "[" + value(depth - 1) + ", " + value(depth - 1) + "]";
      case 5:
        return "{file: " + value(0) + ", u: " + value(depth - 1) + "}";
      case 6:
        return "[" + entry(depth - 1) + "]";
      default:
        return "text";
    }
  }
  std::string entry(int depth) {
    std::string text = "{";
    const bool file = number_ + 1 < kFiles && below(4) == 0;
    const bool repeated = depth == 2 && below(2) == 0;
    if (file) {
      text +=
          "include: " + fileOf(std::max(number_ + 1, kMaps), kFiles) + ", with: {a: " + (repeated ? "$i" : numberText()) + (below(40) ? "" : ", e: 1") + "}";
    } else {
      text += "name: e" + std::to_string(number_ + 1) + std::to_string(below(1000)) + (repeated && below(2) ? "_$i" : "") +
              ", p: [1 m, 2 m], u: " + (names_.empty() ? "1" : "$a") + ", v: " + value(depth > 0 ? depth - 1 : 0);
    }
    if (repeated)
      text += ", repeat: {count: " + (below(30) == 0 ? "4096" : std::to_string(below(5))) + (below(20) ? "" : ", as: j") +
              (below(2) || file ? "" : ", every: {p: [1 m, 0 cm]}") + "}";
    return text + "}";
  }
  std::mt19937_64 random_;
  int number_ = 0;
  std::string names_;  ///< parameters that may be used
};

/// Nothing is left to be worked out, and every value has a place.
std::string faultIn(const Value& v, int depth) {
  if (depth > kDeepestYaml + 1) return "too deep";
  if (v.where.file.empty()) return "a value without a place";
  if (v.kind == Value::Kind::Map && v.entries.size() != v.keyPlaces.size()) return "keys without places";
  for (const Value& item : v.items) {
    if (item.kind == Value::Kind::Map && (item.find("repeat") || item.find("include"))) return "an entry that is not written out";
    if (auto fault = faultIn(item, depth + 1); !fault.empty()) return fault;
  }
  for (const auto& [key, item] : v.entries)
    if (auto fault = faultIn(item, depth + 1); !fault.empty()) return fault;
  return "";
}

size_t sizeOfTree(const Value& v) {
  size_t n = 1;
  for (const Value& item : v.items) n += sizeOfTree(item);
  for (const auto& [key, item] : v.entries) n += sizeOfTree(item);
  return n;
}

long peakMemory_MB() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss / 1024;
}

TEST(FuzzExpand, AreExpandedOrRefused) {
  const auto count = fromEnvironment("PITVIPER_FUZZ_EXPAND", 1500);
  const auto first = static_cast<std::uint64_t>(fromEnvironment("PITVIPER_FUZZ_SEED", 1));
  const test::TemporaryFolder folder;
  const long before = peakMemory_MB();
  int good = 0, refused = 0;
  size_t largest = 0;
  for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(count); ++seed) {
    Writer writer(seed);
    for (int k = 0; k < kFiles; ++k) {
      std::string text = writer.file(k);
      if (writer.below(30) == 0) writer.damage(text);
      folder.put("f" + std::to_string(k) + ".yaml", text);
    }
    std::string own = writer.file(-1);
    while (writer.below(6) == 0) writer.damage(own);
    std::vector<std::string> overrides;
    if (writer.below(5) == 0) overrides = {"parameters.a=3", "k0=7"};
    try {
      const Value tree = expandScenario(own, "own.yaml", folder.path(), overrides, {}, {}).tree;
      ++good;
      EXPECT_EQ(faultIn(tree, 0), "") << "seed " << seed << "\n" << own;
      largest = std::max(largest, sizeOfTree(tree));
    } catch (const UserError& e) {
      ++refused;
      const std::string message = e.what();
      if (std::getenv("PITVIPER_FUZZ_VERBOSE") != nullptr) std::fprintf(stderr, "%s\n", message.c_str());
      EXPECT_TRUE(message.find("; fix: ") != std::string::npos && (message.find(".yaml") != std::string::npos || message.starts_with("--set")))
          << "seed " << seed << ": " << message;
    } catch (const std::exception& e) {
      ADD_FAILURE() << "seed " << seed << ": not a UserError: " << e.what() << "\n" << own;
    }
  }
  std::printf("%lld trees from seed %llu: %d expanded, the largest into %zu values, %d refused; peak memory %ld MB, %ld before\n", count,
              static_cast<unsigned long long>(first), good, largest, refused, peakMemory_MB(), before);
  EXPECT_LE(largest, kMostYamlNodes);
  EXPECT_GT(good, count / 50) << "hardly anything is good: the test sees nothing but refusals";
  EXPECT_GT(refused, count / 10) << "the mistakes are none";
}

// Expected: under 1 GB for what would be 2^40 values: the 500000 that may come out have about 400 bytes each, and places up to 256 MB.
TEST(FuzzExpand, DoubledChainsStaySmall) {
  std::string parameters = "parameters:\n  a0: {x: [y, z]}\n", aliases = "a0: &a0 {x: [y, z]}\n";
  for (int k = 1; k < 40; ++k) {
    const std::string n = std::to_string(k), o = std::to_string(k - 1);
    parameters += "  a" + n + ": [$a" + o + ", $a" + o + "]\n";
    aliases += "a" + n + ": &a" + n + " [*a" + o + ", *a" + o + "]\n";
  }
  const long before = peakMemory_MB();  // of the whole program: others may have needed more
  for (const std::string& text : {parameters + "b: $a39\n", aliases})
    EXPECT_THROW(expandScenario(text, std::string(40, 'x') + ".yaml", ".", {}, {}, {}), UserError);
  std::printf("peak memory %ld MB\n", peakMemory_MB());
  EXPECT_LT(peakMemory_MB() - before, 1024);
}

}  // namespace
}  // namespace pitviper
