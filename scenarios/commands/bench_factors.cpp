#include "scenarios/commands/bench_factors.hpp"

#include <algorithm>
#include <functional>

#include "sim/render/surface/shading_program.hpp"

namespace pitviper {
namespace {

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

/// All of them matter, but for the last rows: one that does, and fifteen that can't.
BenchFactor lights() {
  BenchFactor f = varied("lights", "lights", {0, 1, 4, 16, 100, 1000}, 1, [](BenchSetting& s, int v) { s.lights = v; });
  for (size_t mode = 0; mode < 2; ++mode) {
    BenchVariant v = f.variants[2 + mode];  // one light
    v.value = "1 of 16";
    v.x = 16.5;
    v.setting.farLights = 15;
    f.variants.push_back(v);
  }
  return f;
}

/// The same bodies as full-screen fragments and as compute.
BenchFactor shading() {
  BenchFactor f{"shading", "spectral shading as", {}};
  for (RenderMode mode : {RenderMode::Direct, RenderMode::Buffered})
    for (ShadingStage stage : {ShadingStage::Fragment, ShadingStage::Compute}) {
      BenchVariant v{nameOf(stage), stage == ShadingStage::Compute ? 1.0 : 0.0, mode == RenderMode::Direct ? "direct" : "buffered", {}};
      v.setting.mode = mode;
      v.setting.shading = nameOf(stage);
      v.base = mode == RenderMode::Direct ? 0 : 2;
      f.variants.push_back(v);
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
        s.triangles = 8000;
      },
      true));
  all.push_back(varied("channels", "channels", {1, 4, 16}, 16, [](BenchSetting& s, int v) { s.channels = v; }));
  all.push_back(varied("wavelengths", "wavelengths", {4, 8, 16, 32, 64, 128, 340}, 16, [](BenchSetting& s, int v) { s.wavelengths = v; }));
  all.push_back(lights());
  all.push_back(varied("film", "pixels a side", {64, 128, 256, 512, 1024, 2048}, 256, [](BenchSetting& s, int v) { s.film_px = v; }));
  all.push_back(varied("bodies", "bodies before the wall", {0, 1, 10, 100, 1000}, 0, [](BenchSetting& s, int v) { s.bodies = v; }));
  all.push_back(
      varied("triangles", "triangles of the wall", {2, 1000, 10'000, 100'000, 1'000'000, 10'000'000}, 2, [](BenchSetting& s, int v) { s.triangles = v; }));
  all.push_back(layers());
  all.push_back(shading());
  return all;
}

}  // namespace pitviper
