#include "scenarios/commands/charts.hpp"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "scenarios/commands/charts/charts_module.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/module_on_demand.hpp"

namespace pitviper {
namespace {

void* fromModule(const char* function) {
  return loadOnDemand({kChartsModule, function, "the charts module", "VTK", "install the package libvtk9-dev and build again, or ask for no chart",
                       "install the package libvtk9.1 (to build: libvtk9-dev), or ask for no chart"},
                      {"charts", 0, 0, -1});
}

}  // namespace

void writeWithCharts(const std::filesystem::path& folder, const std::string& name, const std::string& csv, const std::vector<Chart>& charts, int columns) {
  const std::string stem = (folder / name).string();
  writeFileAtomically(stem + ".csv", csv);
  std::printf("%s.csv written\n", stem.c_str());
  drawCharts(charts, columns, stem + ".png");
  std::printf("%s.png written\n", stem.c_str());
}

void requireCharts() { fromModule(kChartsFunction); }

void drawCharts(const std::vector<Chart>& charts, int columns, const std::filesystem::path& png) {
  if (charts.empty() || columns < 1) throw std::invalid_argument("nothing to draw");
  for (const Chart& c : charts)
    for (const Series& s : c.series)
      if (s.x.size() != s.y.size()) throw std::invalid_argument("series '" + s.name + "' of chart '" + c.title + "' has unequal x and y");
  ChartsReply reply;
  reinterpret_cast<ChartsFunction>(fromModule(kChartsFunction))(&charts, columns, &reply);
  if (!reply.failure.empty()) throw std::runtime_error("the chart " + png.string() + " could not be drawn: " + reply.failure);
  writePng(png, reply.picture);
}

void drawTrajectories(const FlownScene& scene, const std::filesystem::path& png, const std::map<std::string, std::string>& texts,
                      const MayReplace& mayReplace) {
  bool any = false;
  for (const FlownPath& p : scene.paths) {
    if (p.time_s.size() != p.position_m.size()) throw std::invalid_argument("path '" + p.name + "' has unequal times and positions");
    for (const glm::dvec3& at : p.position_m) any = any || std::isfinite(at.x + at.y + at.z);
  }
  if (!any) throw std::invalid_argument("no path to draw");
  ChartsReply reply;
  reinterpret_cast<TrajectoriesFunction>(fromModule(kTrajectoriesFunction))(&scene, &reply);
  if (!reply.failure.empty()) throw std::runtime_error("the picture " + png.string() + " could not be drawn: " + reply.failure);
  writePng(png, reply.picture, texts, mayReplace);
}

}  // namespace pitviper
