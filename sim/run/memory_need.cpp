#include "sim/run/memory_need.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "sim/parameters/available_memory.hpp"
#include "sim/parameters/print.hpp"
#include "sim/plan/plan.hpp"

namespace pitviper {
namespace {

/// Program, driver and its compiler, measured with an empty scene on llvmpipe: 0.15 to 0.25 GB.
constexpr double kProgram_bytes = 0.25e9;

/// Of a triangle: half a vertex of 32 bytes, three indices, both again in buffers, and a tree over it for shadows.
constexpr double kTriangle_bytes = 150.0;

/// Of buffered mode, four wavelengths each.
constexpr int kMostTargets = 8;

struct Picture {
  double pixels, subpixels;
  int layers;       ///< integrals drawn: at most four to a target
  int truth;        ///< layers of truth in the frame
  int wavelengths;  ///< in one batch of buffered mode
};

/// What a camera's passes keep from frame to frame.
double keptOnGpu(const Simulation& sim, const Picture& p, bool reference) {
  const double targets = std::ceil(p.layers / 4.0) + (p.truth > 0 ? 3.0 : 0.0);
  constexpr double kVisibility = 12.0, kTarget = 16.0;  // two whole numbers and a depth; four floats
  const bool buffered = !reference && (sim.mode == RenderMode::Buffered || sim.hasTransparent());
  const bool direct = sim.mode != RenderMode::Buffered;
  const double passes = (buffered ? 1.0 : 0.0) + (direct || reference ? 1.0 : 0.0);
  double each = passes * (kVisibility + kTarget * targets * 2.0);  // drawn into, and the buffer it is read back through
  // Spectra of a batch; a copy where transparent things are blended without better means; thickness of media.
  if (buffered) each += kTarget * std::min<double>(kMostTargets, std::ceil(p.wavelengths / 4.0)) * (sim.hasTransparent() ? 2.0 : 1.0) + 2.0 * kTarget;
  return each * p.subpixels;
}

/// While one frame is made: what is read back, its integrals in double, what resolving needs.
double whileDrawn(const Picture& p) {
  const double targets = std::ceil(p.layers / 4.0) + (p.truth > 0 ? 3.0 : 0.0);
  return 16.0 * targets * p.subpixels + 8.0 * p.subpixels + (8.0 * p.layers + 8.0 + (p.truth > 0 ? 44.0 : 0.0)) * p.pixels;
}

/// The frame being drawn and the one being written, of which there are the layers, a copy in the file's order, and the file's bytes, grown by doubling.
double frames(double values) { return 4.0 * values * (1.0 + 1.0 + 1.0 + 2.0); }

Picture pictureOf(const Camera& c) {
  const double pixels = static_cast<double>(c.pinhole.width) * c.pinhole.height;
  const TruthLayers& t = c.truth;
  const int truth = t.range + 2 * t.entity + 3 * t.normal + t.temperature + t.area + 2 * t.solidAngles;
  const int wavelengths = c.spectral.accuracy > 0.0 ? 4 * kMostTargets : c.spectral.samples * static_cast<int>(c.outputs.size());
  return {pixels, pixels * c.samples * c.samples, static_cast<int>(c.outputs.size()), truth, wavelengths};
}

double needOf(const Simulation& sim, const Camera& c) {
  const Picture p = pictureOf(drawnCamera(c));
  constexpr double kSolidAngles = 16.0;
  double need = keptOnGpu(sim, p, c.spectral.reference) + whileDrawn(p) + frames((p.layers + p.truth) * p.pixels) + kSolidAngles * p.pixels;
  if (c.hasStages()) need += 4.0 * 4.0 * p.layers * p.pixels;  // two pictures of each output, what is sent and what comes back
  if (c.spectralImage) {
    const int atOnce = std::min(c.spectralImage->count(), kMostSlots);
    const Picture pass{p.pixels, p.subpixels, atOnce, 0, 4 * kMostTargets};
    need += keptOnGpu(sim, pass, c.spectral.reference) + whileDrawn(pass) + frames(c.spectralImage->count() * p.pixels) + kSolidAngles * p.pixels;
  }
  return need;
}

double needOf(const Simulation& sim, const Probe& p) {
  const double rays = static_cast<double>(p.resolution) * p.resolution;
  // The face above and half of one at the side; the faces follow each other.
  return keptOnGpu(sim, {rays, 1.5 * rays, static_cast<int>(p.outputs.size()), 0, 4 * kMostTargets}, p.spectral.reference) +
         whileDrawn({0.0, rays, static_cast<int>(p.outputs.size()), 0, 0});
}

double needOfScene(const Simulation& sim) {
  std::set<const Mesh*> meshes;
  double need = 0.0;
  for (const Entity& e : sim.entities)
    if (meshes.insert(e.mesh.get()).second) need += kTriangle_bytes * static_cast<double>(e.mesh->triangles.size());
  for (const Texture& t : sim.textures) need += sizeof(float) * static_cast<double>(t.texels.size());
  return need;
}

std::string gigabytes(double bytes) {
  return bytes >= 99.5e9 ? std::to_string(std::llround(bytes / 1e9)) + " GB" : print("%.2g GB", std::max(bytes, 0.0) / 1e9);
}

std::string describe(const Camera& c) {
  return "camera " + c.name + " (" + std::to_string(c.pinhole.width) + "x" + std::to_string(c.pinhole.height) + " pixels, " + std::to_string(c.samples) + "x" +
         std::to_string(c.samples) + " subpixels, " + std::to_string(c.outputs.size()) + (c.outputs.size() == 1 ? " layer" : " layers") +
         (c.spectralImage ? ", a spectral image of " + std::to_string(c.spectralImage->count()) + " bins" : "") + ")";
}

}  // namespace

MemoryNeed memoryNeeded(const Simulation& simulation) {
  MemoryNeed need;
  need.total_bytes = kProgram_bytes + needOfScene(simulation);
  const auto add = [&](double bytes, const std::string& what, const Location& where) {
    need.total_bytes += bytes;
    if (bytes <= need.greatest_bytes) return;
    need.greatest_bytes = bytes;
    need.greatest = what;
    need.where = where;
  };
  for (const Camera& c : simulation.cameras) add(needOf(simulation, c), describe(c), c.where);
  for (const Probe& p : simulation.probes) add(needOf(simulation, p), "probe " + p.name, p.where);
  return need;
}

void refuseBeyondMemory(const Simulation& simulation) {
  const auto available = availableMemory_bytes();
  if (!available) return;
  const MemoryNeed need = memoryNeeded(simulation);
  // Small pictures run in whatever there is: the estimate of the program itself is no reason to refuse.
  if (need.total_bytes <= *available || need.greatest_bytes < kProgram_bytes) return;
  throw UserError(
      need.where, "drawing this takes about " + gigabytes(need.total_bytes) + " of memory, " + gigabytes(need.greatest_bytes) + " of it for " + need.greatest,
      "at most the " + gigabytes(*available) + " that are free here", "lower the film, its subpixels or the number of layers, or run the cameras one by one");
}

}  // namespace pitviper
