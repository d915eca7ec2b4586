#include "scenarios/commands/bench_report.hpp"

#include <algorithm>

#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

// What the paper reached in 2006, for comparison. Source: Duvenhage 2006, section 6: GeForce 6600GT, sixteen channels; frames a second
// are those of buffered mode at 256x256.
constexpr const char* kPaper = "Duvenhage 2006, GeForce 6600GT";
constexpr double kPaperDirect_Mpixel_s = 5.2, kPaperBuffered_Mpixel_s = 4.6;
constexpr double kPaperOverdrawOne_per_s = 70.0, kPaperOverdrawSeven_per_s = 10.0;

constexpr double kYardstickPixels = Yardstick::kSize_px * Yardstick::kSize_px;

std::vector<const BenchRow*> rowsOf(const std::vector<BenchRow>& rows, const std::string& factor) {
  std::vector<const BenchRow*> found;
  for (const BenchRow& r : rows)
    if (r.factor == factor) found.push_back(&r);
  return found;
}

const BenchRow* find(const std::vector<BenchRow>& rows, const std::string& factor, const std::string& value, const std::string& mode) {
  for (const BenchRow& r : rows)
    if (r.factor == factor && r.variant.value == value && r.variant.mode == mode) return &r;
  return nullptr;
}

std::string comparison(const BenchRow& r) {
  if (r.factor == "overdraw") return r.variant.added > 0 ? print("%+.1f %%", 100.0 * (r.timeByBase - 1.0)) : "";
  if (r.factor == "layers") return r.costPerLayer ? print("%.2f a layer", *r.costPerLayer) : "";
  return print("%.2f", r.timeByBase);
}

const char* comparisonHeading(const std::string& factor) {
  if (factor == "overdraw") return "added by what is hidden";
  if (factor == "layers") return "cost by the solid pass";
  return factor == "centre" ? "time by the pass" : "time by the centre";
}

void addTable(std::string& out, const BenchFactor& factor, const std::vector<const BenchRow*>& rows) {
  size_t wide = factor.heading.size(), mode = 4;
  for (const BenchRow* r : rows) wide = std::max(wide, r->variant.value.size()), mode = std::max(mode, r->variant.mode.size());
  const char* last = comparisonHeading(factor.name);
  const auto cells = [&](const std::string& a, const std::string& b, const std::string& c, const std::string& d, const std::string& e, const std::string& f,
                         const std::string& g) {
    return print("| %-*s | %-*s | %9s | %9s | %9s | %12s | %*s |\n", static_cast<int>(wide), a.c_str(), static_cast<int>(mode), b.c_str(), c.c_str(), d.c_str(),
                 e.c_str(), f.c_str(), static_cast<int>(std::string(last).size()), g.c_str());
  };
  out += cells(factor.heading, "mode", "ms", "Mpixel/s", "frames/s", "by yardstick", last) + "|---|---|---|---|---|---|---|\n";
  if (factor.name == "centre" && !rows.empty()) {
    const double bare = rows[0]->yardstickSeconds;
    out += cells("yardstick", "", print("%.2f", bare * 1e3), print("%.2f", kYardstickPixels / bare * 1e-6), print("%.1f", 1.0 / bare), "1.00", "");
  }
  for (const BenchRow* r : rows)
    out += cells(r->variant.value, r->variant.mode, print("%.2f", r->seconds * 1e3), print("%.2f", r->megapixelsPerSecond()),
                 print("%.1f", r->framesPerSecond()), print("%.2f", r->rateByYardstick), comparison(*r));
  out += "\n";
}

void addFindings(std::string& out, const std::vector<BenchRow>& rows) {
  for (const char* mode : {"direct", "buffered"})
    if (const BenchRow* r = find(rows, "centre", "drawing pass", mode)) {
      const double paper = std::string(mode) == "direct" ? kPaperDirect_Mpixel_s : kPaperBuffered_Mpixel_s;
      out += print("%s mode at the centre: %.2f of the yardstick (wanted: at least 0.55); %s: %.1f Mpixel/s, this is %.2f times that\n", mode,
                   r->rateByYardstick, kPaper, paper, r->megapixelsPerSecond() / paper);
    }
  for (const char* mode : {"direct", "buffered"})
    if (const BenchRow* r = find(rows, "overdraw", "7", mode))
      out += print("%s mode: six hidden plates of 8000 triangles add %.1f %% (wanted: at most 25 %%)\n", mode, 100.0 * (r->timeByBase - 1.0));
  const BenchRow *once = find(rows, "overdraw", "1", "buffered"), *seven = find(rows, "overdraw", "7", "buffered");
  if (once && seven)
    out += print("buffered mode, frames/s at overdraw one and seven: %.0f and %.0f; %s: %.0f and %.0f\n", once->framesPerSecond(), seven->framesPerSecond(),
                 kPaper, kPaperOverdrawOne_per_s, kPaperOverdrawSeven_per_s);
  for (const auto& [mode, wanted] :
       {std::pair{"attenuation", "wanted: at most 0.3"}, {"emission and air", "wanted: at most 0.5"}, {"and reflection", "stated"}})
    if (const BenchRow* r = find(rows, "layers", "8", mode); r && r->costPerLayer)
      out += print("a transparent layer (%s) costs %.2f of the solid pass, mean of eight (%s)\n", mode, *r->costPerLayer, wanted);
}

Series seriesOf(const std::vector<const BenchRow*>& rows, const std::string& mode, double (*figure)(const BenchRow&)) {
  Series s;
  s.name = mode;
  for (const BenchRow* r : rows)
    if (r->variant.mode == mode) {
      s.x.push_back(r->variant.x);
      s.y.push_back(figure(*r));
    }
  return s;
}

double rate(const BenchRow& r) { return r.megapixelsPerSecond(); }
double rateByYardstick(const BenchRow& r) { return r.rateByYardstick; }

Chart centreChart(const std::vector<const BenchRow*>& rows) {
  Chart c;
  c.title = "256x256, 16 channels, 16 wavelengths, one light";
  c.yLabel = "Mpixel/s";
  c.categories = {"drawing pass", "frame in memory", "GeForce 6600GT, 2006"};
  for (const auto& [mode, paper] : {std::pair{"direct", kPaperDirect_Mpixel_s}, {"buffered", kPaperBuffered_Mpixel_s}}) {
    Series s = seriesOf(rows, mode, rate);
    s.bars = true;
    s.x.push_back(2.0);
    s.y.push_back(paper);
    c.series.push_back(s);
  }
  if (!rows.empty()) {
    const double bare = kYardstickPixels / rows[0]->yardstickSeconds * 1e-6;
    c.series.push_back({"yardstick", {-0.6, 2.6}, {bare, bare}, true, false});
  }
  return c;
}

Chart overdrawChart(const std::vector<const BenchRow*>& rows) {
  Chart c;
  c.title = "Overdraw: plates of 8000 triangles, from behind";
  c.xLabel = "overdraw";
  c.yLabel = "frames/s";
  c.yFromZero = true;
  for (const char* mode : {"direct", "buffered"}) c.series.push_back(seriesOf(rows, mode, [](const BenchRow& r) { return r.framesPerSecond(); }));
  Series paper{"GeForce 6600GT, 2006, buffered", {}, {}, true, false};
  for (int n = 1; n <= 7; ++n) {  // 70 and 10 frames/s are the ends of what the paper states, in proportion to overdraw
    c.xTicks.push_back(n);
    paper.x.push_back(n);
    paper.y.push_back(kPaperOverdrawOne_per_s / n);
  }
  c.series.push_back(paper);
  return c;
}

Chart layersChart(const std::vector<const BenchRow*>& rows) {
  Chart c;
  c.title = "Transparent layers, buffered mode";
  c.xLabel = "layers";
  c.yLabel = "time / time without layers";
  for (int n = 0; n <= 8; ++n) c.xTicks.push_back(n);
  for (const char* mode : {"attenuation", "emission and air", "and reflection"})
    c.series.push_back(seriesOf(rows, mode, [](const BenchRow& r) { return r.timeByBase; }));
  c.series.push_back({"0.3 a layer", {0.0, 8.0}, {1.0, 3.4}, true, false});
  c.series.push_back({"0.5 a layer", {0.0, 8.0}, {1.0, 5.0}, true, false});
  return c;
}

enum class Spread { Logarithmic, Categories };

/// Rate over the factor's values, by the yardstick: what drifted while the rows were timed is not in it.
Chart rateChart(const BenchFactor& factor, const std::vector<const BenchRow*>& rows, const char* title, Spread spread, bool logY) {
  Chart c;
  c.title = title;
  c.xLabel = factor.heading;
  c.yLabel = "pixel rate / yardstick's";
  c.yFromZero = true;
  c.logX = spread == Spread::Logarithmic;
  c.logY = logY;
  for (const BenchRow* r : rows)
    if (spread == Spread::Categories && r->variant.mode == rows.front()->variant.mode) c.categories.push_back(r->variant.value);
  for (const char* mode : {"direct", "buffered"}) {
    c.series.push_back(seriesOf(rows, mode, rateByYardstick));
    Series& s = c.series.back();
    if (s.x.empty()) {
      c.series.pop_back();
      continue;
    }
    if (spread == Spread::Logarithmic) c.xTicks = s.x;
    else
      for (size_t i = 0; i < s.x.size(); ++i) s.x[i] = static_cast<double>(i);
  }
  return c;
}

}  // namespace

std::string benchTables(const std::vector<BenchFactor>& factors, const std::vector<BenchRow>& rows) {
  std::string out;
  for (const BenchFactor& f : factors) addTable(out, f, rowsOf(rows, f.name));
  addFindings(out, rows);
  return out;
}

std::string benchCsv(const std::vector<BenchRow>& rows) {
  std::string out =
      "factor,value,mode,film [px],channels,wavelengths,lights,overdraw,layers,frames,time [ms],yardstick time [ms],rate [Mpixel/s],rate [frame/s],"
      "rate by yardstick,time by base,cost per layer\n";
  for (const BenchRow& r : rows) {
    const BenchSetting& s = r.variant.setting;
    out += print("%s,%s,%s,%d,%d,%d,%d,%d,%d,%d,%.6g,%.6g,%.6g,%.6g,%.6g,%.6g,", r.factor.c_str(), r.variant.value.c_str(), r.variant.mode.c_str(), s.film_px,
                 s.channels, s.wavelengths, s.lights, s.overdraw, s.layers, r.frames, r.seconds * 1e3, r.yardstickSeconds * 1e3, r.megapixelsPerSecond(),
                 r.framesPerSecond(), r.rateByYardstick, r.timeByBase);
    out += (r.costPerLayer ? print("%.6g", *r.costPerLayer) : "") + "\n";
  }
  return out;
}

std::vector<Chart> benchCharts(const std::vector<BenchFactor>& factors, const std::vector<BenchRow>& all) {
  std::vector<Chart> charts;
  for (const BenchFactor& f : factors) {
    const auto rows = rowsOf(all, f.name);
    if (f.name == "centre") charts.push_back(centreChart(rows));
    else if (f.name == "overdraw") charts.push_back(overdrawChart(rows));
    else if (f.name == "layers") charts.push_back(layersChart(rows));
    else if (f.name == "channels") charts.push_back(rateChart(f, rows, "Channels, at 16 wavelengths", Spread::Logarithmic, false));
    else if (f.name == "wavelengths") charts.push_back(rateChart(f, rows, "Wavelengths, for 16 channels", Spread::Logarithmic, true));
    else if (f.name == "lights") charts.push_back(rateChart(f, rows, "Point lights", Spread::Categories, false));
    else if (f.name == "shading") charts.push_back(rateChart(f, rows, "Shading as fragments or as compute", Spread::Categories, false));
    else if (f.name == "bodies") charts.push_back(rateChart(f, rows, "Bodies of 2000 triangles before the wall", Spread::Categories, false));
    else if (f.name == "triangles") charts.push_back(rateChart(f, rows, "Triangles of the wall", Spread::Logarithmic, false));
    else charts.push_back(rateChart(f, rows, "Size of the film", Spread::Logarithmic, false));
  }
  return charts;
}

}  // namespace pitviper
