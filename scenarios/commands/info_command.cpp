#include <cmath>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/pixel_terms.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "sim/parameters/print.hpp"
#include "sim/render/surface/shading_program.hpp"

namespace pitviper {
namespace {

std::string textOf(const Attribute& a) {
  if (const auto* s = std::get_if<std::string>(&a.value)) return *s;
  if (const auto* d = std::get_if<double>(&a.value)) return print("%.9g", *d);
  if (const auto* i = std::get_if<int>(&a.value)) return std::to_string(*i);
  std::string all;
  if (const auto* curve = std::get_if<std::vector<float>>(&a.value)) {
    if (curve->empty()) return "no values";
    return print("%zu values, %.6g ... %.6g", curve->size(), static_cast<double>(curve->front()), static_cast<double>(curve->back()));
  }
  for (double v : std::get<std::vector<double>>(a.value)) all += (all.empty() ? "" : " ") + print("%.12g", v);
  return all;
}

std::string unitOf(const ExrImage& image, const std::string& layer) {
  const Attribute* a = image.findAttribute("unit." + layer);
  return a ? textOf(*a) : "";
}

void printLayers(const ExrImage& image) {
  std::printf("%-32s %-18s %14s %14s %14s\n", "layer", "unit", "min", "mean", "max");
  for (const auto& layer : image.layers) {
    double low = INFINITY, high = -INFINITY, sum = 0.0;
    size_t bad = 0, unseen = 0;
    const bool truth = layer.name.rfind("truth.", 0) == 0;
    for (float v : layer.pixels) {
      if (!std::isfinite(v)) {
        ++bad;
        continue;
      }
      if (truth && v == 0.0f) {  // nothing is seen there
        ++unseen;
        continue;
      }
      low = std::min(low, static_cast<double>(v));
      high = std::max(high, static_cast<double>(v));
      sum += static_cast<double>(v);
    }
    if (low <= high)
      std::printf("%-32s %-18s %14.6g %14.6g %14.6g", layer.name.c_str(), unitOf(image, layer.name).c_str(), low,
                  sum / static_cast<double>(layer.pixels.size() - bad - unseen), high);
    else std::printf("%-32s %-18s %14s %14s %14s", layer.name.c_str(), unitOf(image, layer.name).c_str(), "none", "none", "none");
    if (const Attribute* bin = image.findAttribute("bin_um." + layer.name)) std::printf("  bin [um] %s", textOf(*bin).c_str());
    if (unseen) std::printf("  (%zu pixels see nothing)", unseen);
    if (bad) std::printf("  (%zu not finite)", bad);
    std::printf("\n");
  }
}

/// The driver that `run` would draw with, and how.
void printMachine() {
  const GlContext context;
  const GlLimits& l = context.limits();
  auto row = [](const char* what, const std::string& value) { std::printf("%-36s %s\n", what, value.c_str()); };
  row("renderer", l.renderer + (l.software ? " (drawn by the CPU)" : ""));
  row("vendor, OpenGL", l.vendor + ", " + l.version);
  row("spectral shading as", nameOf(chooseShadingStage()) + " (PITVIPER_SHADING: fragment, compute)");
  row("largest picture", std::to_string(l.largestTexture) + " subpixels a side");
  row("targets in a pass", std::to_string(l.drawBuffers) + " of four channels: " + std::to_string(4 * l.drawBuffers) + " wavelengths a batch in buffered mode");
  row("uniform block", std::to_string(l.uniformBlock) + " bytes: about " + std::to_string(l.uniformBlock / 48) + " wavelengths with up to four lights");
}

struct InfoWish {
  std::optional<std::pair<long long, long long>> at;
  ScenarioWish terms;
};

/// "column,row".
std::pair<long long, long long> pixelOf(const std::string& text, const Location& where) {
  const size_t comma = text.find(',');
  if (comma == std::string::npos) throw UserError(where, "not a pixel", "column,row from the top left, from 0", "write --at 128,128");
  return readRange(text.substr(0, comma) + ":" + text.substr(comma + 1), "--at");
}

int info(const InfoWish& w, const std::string& file) {
  const ExrImage image = readExr(file);
  if (w.at) {
    const auto [x, y] = *w.at;
    if (x < 0 || y < 0 || x >= image.width || y >= image.height)
      throw UserError({"--at " + std::to_string(x) + "," + std::to_string(y), 0, 0, -1}, "outside the picture",
                      "column 0 to " + std::to_string(image.width - 1) + ", row 0 to " + std::to_string(image.height - 1), "choose a pixel of it");
    if (!w.terms.file.empty()) {
      printPixelTerms(image, file, static_cast<int>(x), static_cast<int>(y), w.terms);
      return 0;
    }
    for (const auto& layer : image.layers)
      std::printf("%-32s %.9g %s\n", layer.name.c_str(),
                  static_cast<double>(layer.pixels[static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)]),
                  unitOf(image, layer.name).c_str());
    return 0;
  }
  std::printf("%s: %d x %d pixels\n", file.c_str(), image.width, image.height);
  if (image.held)
    std::printf("the file has columns %d to %d and rows %d to %d of them (its data window); the others are 0\n", image.held->left, image.held->right - 1,
                image.held->top, image.held->bottom - 1);
  std::printf("\n");
  printLayers(image);
  std::printf("\n");
  for (const auto& a : image.attributes)
    if (a.name.rfind("unit.", 0) != 0 && a.name.rfind("entity.", 0) != 0 && a.name.rfind("bin_um.", 0) != 0 && a.name.rfind("wavelength_um.", 0) != 0)
      std::printf("%-44s %s\n", a.name.c_str(), textOf(a).c_str());
  for (int e = 1;; ++e) {  // in their own order; attributes come sorted by name
    const std::string entity = "entity." + std::to_string(e);
    const Attribute* name = image.findAttribute(entity + ".name");
    if (!name) break;
    const Attribute* place = image.findAttribute(entity + ".range_column_row");
    std::printf("%-44s %s: range [m], column, row %s\n", entity.c_str(), textOf(*name).c_str(), place ? textOf(*place).c_str() : "");
  }
  return 0;
}

}  // namespace

CommandLine infoCommand() {
  const auto w = std::make_shared<InfoWish>();
  return {{"info", "[FILE.exr]", "what is in a frame, or what this machine draws with"},
          "Layers with unit, minimum, mean and maximum, and all attributes. Without a file: the driver and its limits.",
          joined({{"--at",
                   "COLUMN,ROW",
                   "the values of one pixel with their units; (0,0) is the top left",
                   {[w](const std::string& text, const Location& where) { w->at = pixelOf(text, where); }},
                   "FILE.exr"},
                  {"--terms", "SCENARIO.yaml",
                   "what that pixel is made of: emission, each light's reflection, the dome's, the air's emission, scattered sunlight, media and lamps in "
                   "view, by the body that sends it, worked out in double precision at every wavelength; the scenario must be the one that the frame was drawn "
                   "from, with the same --set and --root, and its tables and meshes as they were",
                   into(w->terms.file), "--at"}},
                 scenarioOptions(w->terms, "--terms")),
          [w](const Arguments& words) {
            if (!words.empty()) return info(*w, words[0]);
            printMachine();
            return 0;
          }};
}

}  // namespace pitviper
