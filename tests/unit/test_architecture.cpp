// Includes follow the arrows of the house: scenarios -> materials, atmosphere, sensors -> sim, and within sim later may use earlier.
// Shader files count ("//@use"). Third-party libraries stay in the one place that may know them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <regex>
#include <set>

namespace {

const std::vector<std::string> kOrder = {"sim/radiometry",
                                         "sim/sky",
                                         "sim/parameters",
                                         "sim/image",
                                         "sim/gl",
                                         "sim/scene",
                                         "sim/flight",
                                         "sim/model",
                                         "sim/world",
                                         "sim/radiance",
                                         "sim/plan",
                                         "sim/render/assembly",
                                         "sim/render/geometry",
                                         "sim/render/shadow",
                                         "sim/render/surface",
                                         "sim/render/media",
                                         "sim/render",
                                         "sim/render/reference",
                                         "sim/camera",
                                         "sim/frame",
                                         "sim/stream/clock",
                                         "sim/stream/on_demand",
                                         "sim/stream/ring",
                                         "sim/stream/gige",
                                         "sim/stream/cigi",
                                         "sim/stream/gstreamer",
                                         "sim/stream/hdf5",
                                         "sim/stream/projector",
                                         "sim/stream",
                                         "sim/run"};

int levelOf(const std::string& path) {
  int level = -1;
  size_t longest = 0;  // a folder in another is itself, not that one
  for (size_t i = 0; i < kOrder.size(); ++i)
    if (path.rfind(kOrder[i] + "/", 0) == 0 && kOrder[i].size() > longest) level = static_cast<int>(i), longest = kOrder[i].size();
  if (level >= 0) return level;
  for (const char* m : {"materials/", "atmosphere/", "sensors/"})
    if (path.rfind(m, 0) == 0) return 100;
  if (path.rfind("scenarios/", 0) == 0) return 200;
  return -1;
}

std::string topOf(const std::string& path) { return path.substr(0, path.find('/')); }

struct Use {
  std::string file, included;
  bool system;
};

std::vector<Use> allUses() {
  const std::filesystem::path root = PITVIPER_SOURCE_DIR;
  static const std::regex include(R"re(^\s*(?:#include\s+([<"])([^>"]+)[>"]|//@use\s+(\S+)))re");
  std::vector<Use> uses;
  for (const char* top : {"sim", "materials", "atmosphere", "sensors", "scenarios"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string ext = entry.path().extension().string();
      if (ext != ".cpp" && ext != ".hpp" && ext != ".glsl") continue;
      std::ifstream in(entry.path());
      std::string line;
      while (std::getline(in, line)) {
        std::smatch m;
        if (!std::regex_search(line, m, include)) continue;
        uses.push_back({std::filesystem::relative(entry.path(), root).string(), m[3].matched ? m[3].str() : m[2].str(), m[1].matched && m[1].str() == "<"});
      }
    }
  return uses;
}

std::string violation(const Use& use) {
  if (use.system) {
    static const std::map<std::string, std::vector<std::string>> homes = {
        {"yaml-cpp/", {"scenarios/reader/"}},
        {"GeographicLib/", {"sim/scene/"}},
        {"OpenEXR/", {"sim/image/"}},
        {"Imf", {"sim/image/"}},
        {"Eigen/", {"sim/plan/", "sim/radiance/", "materials/", "sensors/"}},
        {"unsupported/Eigen/", {"sensors/"}},
        {"vtk", {"sim/scene/import/", "scenarios/commands/charts/"}},
        {"openvdb/", {"sim/scene/import_vdb/"}},
        {"epoxy/", {"sim/gl/", "sim/render/", "sim/camera/", "scenarios/commands/bench", "sim/stream/projector/", "scenarios/view/window/"}},
        {"GLFW/", {"sim/stream/projector/", "scenarios/view/window/"}},
        {"imgui", {"scenarios/view/window/"}},
        {"backends/imgui", {"scenarios/view/window/"}},
        {"X11/", {"sim/stream/projector/"}},
        {"gst/", {"sim/stream/gstreamer/"}},
        {"hdf5.h", {"sim/stream/hdf5/"}},
        {"pybind11/", {"scenarios/python/"}},
        {"sqlite3.h", {"scenarios/sweep/"}},
        {"boost/", {"scenarios/sweep/"}}};
    for (const auto& [library, allowed] : homes) {
      if (use.included.rfind(library, 0) != 0) continue;
      for (const auto& home : allowed)
        if (use.file.rfind(home, 0) == 0) return "";
      return use.file + " may not know " + use.included;
    }
    return "";
  }
  const int user = levelOf(use.file), used = levelOf(use.included);
  if (used < 0) return use.file + ": include '" + use.included + "' is not written from the root";
  if (used > user) return use.file + " may not use " + use.included;
  if (user == 100 && used == 100 && topOf(use.file) != topOf(use.included)) return use.file + " may not use its neighbour " + use.included;
  return "";
}

TEST(Architecture, IncludesFollowTheArrows) {
  const auto uses = allUses();
  EXPECT_GT(uses.size(), 200u);
  for (const auto& use : uses) EXPECT_EQ(violation(use), "");
}

/// Names on a way round, in order; empty where there is none.
std::string circle(const std::map<std::string, std::set<std::string>>& uses) {
  std::map<std::string, int> state;  // 1: on the way, 2: done
  std::vector<std::string> way;
  std::function<std::string(const std::string&)> visit = [&](const std::string& at) -> std::string {
    if (state[at] == 2) return "";
    way.push_back(at);
    if (state[at] == 1) {
      std::string text;
      for (auto first = std::find(way.begin(), way.end(), at); first != way.end(); ++first) text += (text.empty() ? "" : " -> ") + *first;
      return text;
    }
    state[at] = 1;
    if (const auto own = uses.find(at); own != uses.end())
      for (const auto& next : own->second)
        if (const std::string found = visit(next); !found.empty()) return found;
    state[at] = 2;
    way.pop_back();
    return "";
  };
  for (const auto& [name, used] : uses)
    if (const std::string found = visit(name); !found.empty()) return found;
  return "";
}

// No header needs itself by way of others.
TEST(Architecture, HeadersStandInNoCircle) {
  std::map<std::string, std::set<std::string>> uses;
  for (const Use& use : allUses())
    if (!use.system && use.file.ends_with(".hpp")) uses[use.file].insert(use.included);
  EXPECT_GT(uses.size(), 100u);
  EXPECT_EQ(circle(uses), "");
  EXPECT_EQ(circle({{"a", {"b"}}, {"b", {"c"}}, {"c", {"a"}}}), "a -> b -> c -> a");
}

// Nor does a folder, but for modules that are loaded on demand, whose door stands in their own.
TEST(Architecture, FoldersStandInNoCircle) {
  std::map<std::string, std::set<std::string>> uses;
  const auto folder = [](const std::string& file) { return std::filesystem::path(file).parent_path().string(); };
  for (const Use& use : allUses()) {
    const std::string from = folder(use.file), to = folder(use.included);
    const bool onDemand = to == "sim/scene/import" || to == "scenarios/commands/charts";
    if (!use.system && from != to && !onDemand && !use.file.ends_with(".glsl")) uses[from].insert(to);
  }
  EXPECT_EQ(circle(uses), "");
}

/// What no line of ours is longer than.
constexpr size_t kColumns = 160;
// A page and a screen hold it; the formatter knows the same number.
TEST(Architecture, NoLineIsLongerThanThePage) {
  const std::filesystem::path root = PITVIPER_SOURCE_DIR;
  int files = 0;
  for (const char* top : {"sim", "materials", "atmosphere", "sensors", "scenarios", "tests"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / top)) {
      const std::string ext = entry.path().extension().string(), name = std::filesystem::relative(entry.path(), root).string();
      if (ext != ".cpp" && ext != ".hpp" && ext != ".h" && ext != ".glsl") continue;
      std::ifstream in(entry.path());
      int number = 0;
      for (std::string line; std::getline(in, line);)
        if (++number, line.size() > kColumns) ADD_FAILURE() << name << ":" << number << ": " << line.size() << " columns";
      ++files;
    }
  EXPECT_GT(files, 1000);
  std::ifstream format(root / ".clang-format");
  const std::string text{std::istreambuf_iterator<char>(format), {}};
  EXPECT_NE(text.find("ColumnLimit: " + std::to_string(kColumns) + "\n"), std::string::npos) << text;
}

TEST(Architecture, TheTestItselfFindsViolations) {
  EXPECT_NE(violation({"sim/radiometry/planck.hpp", "sim/gl/context.hpp", false}), "");
  EXPECT_NE(violation({"sim/render/surface/glsl/shade.frag.glsl", "materials/phong.glsl", false}), "");
  EXPECT_NE(violation({"materials/x.cpp", "atmosphere/homogeneous.hpp", false}), "");
  EXPECT_NE(violation({"sim/run/run.cpp", "yaml-cpp/yaml.h", true}), "");
  EXPECT_EQ(violation({"scenarios/reader/x.cpp", "materials/reflection.hpp", false}), "");
}

}  // namespace
