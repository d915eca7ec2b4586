#include "scenarios/commands/bench_factors.hpp"

#include <functional>

namespace pitviper {
namespace {

/// Materials have no `transmission` yet; with it the transparent layers are timed as well.
constexpr bool kTransparentMaterials = true;

/// Both modes at each value; compared with the same mode at `base`.
BenchFactor varied(const std::string& name, const std::string& heading, const std::vector<int>& values, int base,
                   const std::function<void(BenchSetting&, int)>& set, bool layers = false) {
  BenchFactor f{name, heading, {}};
  for (int value : values)
    for (RenderMode mode : {RenderMode::Direct, RenderMode::Buffered}) {
      BenchVariant v{std::to_string(value), static_cast<double>(value), mode == RenderMode::Direct ? "direct" : "buffered", {}};
      v.setting.mode = mode;
      set(v.setting, value);
      v.added = layers ? value - base : 0;
      f.variants.push_back(v);
    }
  for (auto& v : f.variants)
    for (size_t i = 0; i < f.variants.size(); ++i)
      if (f.variants[i].mode == v.mode && f.variants[i].x == base) v.base = static_cast<int>(i);
  return f;
}

BenchFactor centre() {
  BenchFactor f{"centre", "what is timed", {}};
  for (bool whole : {false, true})
    for (RenderMode mode : {RenderMode::Direct, RenderMode::Buffered}) {
      BenchVariant v{whole ? "frame in memory" : "drawing pass", whole ? 1.0 : 0.0, mode == RenderMode::Direct ? "direct" : "buffered", {}};
      v.setting.mode = mode;
      v.whole = whole;
      v.base = mode == RenderMode::Direct ? 0 : 1;
      f.variants.push_back(v);
    }
  return f;
}

/// Transparent layers before the wall, buffered mode; each kind against the same scene without any.
BenchFactor layers() {
  BenchFactor f{"layers", "transparent layers", {}};
  for (const auto& [name, kind] :
       {std::pair{"attenuation", LayerKind::Attenuating}, {"emission and air", LayerKind::Emitting}, {"and reflection", LayerKind::Reflecting}}) {
    const int base = static_cast<int>(f.variants.size());
    for (int count = 0; count <= 8; ++count) {
      BenchVariant v{std::to_string(count), static_cast<double>(count), name, {}};
      v.setting.mode = RenderMode::Buffered;
      v.setting.layers = count;
      v.setting.layerKind = kind;
      v.setting.air = kind != LayerKind::Attenuating;
      v.base = base;
      v.added = count;
      f.variants.push_back(v);
    }
  }
  return f;
}

}  // namespace

std::vector<BenchFactor> benchFactors() {
  std::vector<BenchFactor> all;
  all.push_back(centre());
  all.push_back(varied(
      "overdraw", "overdraw", {1, 2, 3, 4, 5, 6, 7}, 1,
      [](BenchSetting& s, int v) {
        s.overdraw = v;
        s.densePlates = true;
      },
      true));
  all.push_back(varied("channels", "channels", {1, 4, 16}, 16, [](BenchSetting& s, int v) { s.channels = v; }));
  all.push_back(varied("wavelengths", "wavelengths", {4, 8, 16, 32, 64, 128, 340}, 16, [](BenchSetting& s, int v) { s.wavelengths = v; }));
  all.push_back(varied("lights", "lights", {0, 1, 4, 16}, 1, [](BenchSetting& s, int v) { s.lights = v; }));
  all.push_back(varied("film", "pixels a side", {64, 128, 256, 512, 1024}, 256, [](BenchSetting& s, int v) { s.film_px = v; }));
  if (kTransparentMaterials) all.push_back(layers());
  return all;
}

}  // namespace pitviper
