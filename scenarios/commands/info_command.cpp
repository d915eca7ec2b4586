#include <cmath>
#include <cstdio>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/commands/pixel_terms.hpp"
#include "sim/gl/blend_path.hpp"
#include "sim/gl/context.hpp"
#include "sim/image/exr.hpp"
#include "sim/parameters/error.hpp"
#include "sim/render/shading_program.hpp"

namespace pitviper {
namespace {

std::string textOf(const Attribute& a) {
  if (const auto* s = std::get_if<std::string>(&a.value)) return *s;
  char buffer[64];
  if (const auto* d = std::get_if<double>(&a.value)) return std::snprintf(buffer, sizeof buffer, "%.9g", *d), buffer;
  if (const auto* i = std::get_if<int>(&a.value)) return std::to_string(*i);
  std::string all;
  if (const auto* curve = std::get_if<std::vector<float>>(&a.value)) {
    if (curve->empty()) return "no values";
    std::snprintf(buffer, sizeof buffer, "%zu values, %.6g ... %.6g", curve->size(), static_cast<double>(curve->front()), static_cast<double>(curve->back()));
    return buffer;
  }
  for (double v : std::get<std::vector<double>>(a.value)) {
    std::snprintf(buffer, sizeof buffer, "%.12g", v);
    all += (all.empty() ? "" : " ") + std::string(buffer);
  }
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
      std::printf("%-32s %-18s %14.6g %14.6g %14.6g", layer.name.c_str(), unitOf(image, layer.name).c_str(), low, sum / static_cast<double>(layer.pixels.size() - bad - unseen), high);
    else
      std::printf("%-32s %-18s %14s %14s %14s", layer.name.c_str(), unitOf(image, layer.name).c_str(), "none", "none", "none");
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
  const BlendPath chosen = chooseBlendPath();
  std::string offered;
  for (BlendPath path : offeredBlendPaths()) offered += (offered.empty() ? "" : ", ") + nameOf(path);
  auto row = [](const char* what, const std::string& value) { std::printf("%-36s %s\n", what, value.c_str()); };
  row("renderer", l.renderer + (l.software ? " (drawn by the CPU)" : ""));
  row("vendor, OpenGL", l.vendor + ", " + l.version);
  row("spectral shading as", nameOf(chooseShadingStage()) + " (PITVIPER_SHADING: fragment, compute)");
  row("transparent things blended by", nameOf(chosen) + " (offered: " + offered + ")");
  row("largest picture", std::to_string(l.largestTexture) + " subpixels a side");
  row("targets in a pass", std::to_string(l.drawBuffers) + " of four channels: " + std::to_string(4 * l.drawBuffers) + " wavelengths a batch in buffered mode");
  row("uniform block", std::to_string(l.uniformBlock) + " bytes: about " + std::to_string(l.uniformBlock / 48) + " wavelengths with up to four lights");
}

}  // namespace

int infoCommand(const Arguments& arguments) {
  const Options o("info", arguments, {{"--at"}, {"--terms"}, {"--set", true, true}, rootOption()}, 0, 1);
  if (o.words().empty()) {
    if (o.has("--at")) throw UserError({"--at " + o.value("--at"), 0, 0, -1}, "a pixel of no file", "info FILE.exr --at COLUMN,ROW", "name the file");
    printMachine();
    return 0;
  }
  if (o.has("--terms") && !o.has("--at"))
    throw UserError({"--terms " + o.value("--terms"), 0, 0, -1}, "parts of no pixel", "info FILE.exr --at COLUMN,ROW --terms SCENARIO.yaml", "add --at");
  if (o.has("--set") && !o.has("--terms"))
    throw UserError({"--set", 0, 0, -1}, "a change of no scenario", "--set beside --terms SCENARIO.yaml", "add --terms, or remove --set");
  if (o.has("--root") && !o.has("--terms"))
    throw UserError({"--root", 0, 0, -1}, "a folder for parts of no scenario", "--root beside --terms SCENARIO.yaml", "add --terms, or remove --root");
  const ExrImage image = readExr(o.words()[0]);
  if (o.has("--at")) {
    std::string text = o.value("--at");
    if (const size_t comma = text.find(','); comma != std::string::npos) text[comma] = ':';
    else text.clear();
    if (text.empty()) throw UserError({"--at " + o.value("--at"), 0, 0, -1}, "not a pixel", "column,row from the top left, from 0", "write --at 128,128");
    const auto [x, y] = readRange(text, "--at");
    if (x < 0 || y < 0 || x >= image.width || y >= image.height)
      throw UserError({"--at " + o.value("--at"), 0, 0, -1}, "outside the picture",
                      "column 0 to " + std::to_string(image.width - 1) + ", row 0 to " + std::to_string(image.height - 1), "choose a pixel of it");
    if (o.has("--terms")) {
      printPixelTerms(image, o.words()[0], static_cast<int>(x), static_cast<int>(y), o.value("--terms"), o.values("--set"), rootsOf(o));
      return 0;
    }
    for (const auto& layer : image.layers)
      std::printf("%-32s %.9g %s\n", layer.name.c_str(),
                  static_cast<double>(layer.pixels[static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x)]),
                  unitOf(image, layer.name).c_str());
    return 0;
  }
  std::printf("%s: %d x %d pixels\n", o.words()[0].c_str(), image.width, image.height);
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

}  // namespace pitviper
