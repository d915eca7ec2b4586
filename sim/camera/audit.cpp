#include "sim/camera/audit.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sim/plan/freed_memory.hpp"
#include "sim/plan/sights.hpp"
#include "sim/render/reference/reference_pixel.hpp"

namespace pitviper {
namespace {

/// Part of the time that auditing may take unless a scenario says otherwise.
constexpr double kPart = 0.05;
/// Costs in pixels of the bare 16-wavelength loop that `bench` calls the yardstick: of a frame whatever its size, of a subpixel and of each node of it
/// (as plan_command.cpp has them), of a wavelength of the reference with and without layered air, and the part of a frame that its second visibility pass
/// takes. Estimates for llvmpipe on two cores (the README has what audits cost
/// there); elsewhere the part is another.
constexpr double kFrame = 0.2e6, kSubpixel = 5.0, kNode = 0.28, kWavelength = 60.0, kPlainWavelength = 2.0, kVisibility = 0.3;
/// Rays of WholePixels.
constexpr double kWholePlaces = 1024.0;
/// More would be a second reference run.
constexpr double kMost = 16.0;
/// Pixels among which the one is looked for that sees what the fewest do.
constexpr int kDoubts = 256;

}  // namespace

int auditedPixels(double perFrame, int frame) {
  if (!(perFrame > 0.0)) return 0;
  const auto upTo = [perFrame](int f) { return std::ceil(perFrame * f - 1e-9); };
  return static_cast<int>(upTo(frame + 1) - upTo(frame));
}

double affordablePixels(const Simulation& sim, const Camera& camera, const Plan& plan) {
  const double n = camera.samples, subpixels = n * n * camera.pinhole.width * camera.pinhole.height;
  const double frame = kFrame + subpixels * (kSubpixel + kNode * plan.nodeCount());
  double wavelengths = 0.0;
  for (int count : plan.fineCount) wavelengths += count;
  const double pixel =
      (n * n * wavelengths + kWholePlaces * plan.nodeCount()) * (plan.terms.air && sim.air->traits().variesAlongWay ? kWavelength : kPlainWavelength);
  return std::min(kPart * frame / (kVisibility * frame + pixel), kMost);
}

Auditor::Auditor(const Simulation& simulation, const Camera& camera, const Plan& planned, const ShaderLibrary& library, std::shared_ptr<const GpuScene> scene)
    : simulation_(simulation), camera_(camera), library_(library), scene_(std::move(scene)), asked_(planned.accuracy), planned_(planned), asDrawn_(camera) {
  perFrame_ = camera.spectral.reference ? 0.0 : simulation.audit >= 0.0 ? simulation.audit : affordablePixels(simulation, camera, planned);
  camera_.spectral = {};
  camera_.spectral.reference = true;
  camera_.plan.clear();  // its views of bright parts come with each picture
  camera_.truth = {};
  camera_.spectralImage.reset();
  seed_ = mixed(static_cast<std::uint64_t>(simulation.seed));
  for (char c : camera.name) seed_ = mixed(seed_ ^ static_cast<unsigned char>(c));
}

std::vector<int> Auditor::pixelsOf(int count, int frame, std::uint64_t stream) const {
  const auto all = static_cast<std::uint64_t>(camera_.pinhole.width) * static_cast<std::uint64_t>(camera_.pinhole.height);
  std::vector<int> pixels;
  for (int k = 0; k < count; ++k)
    pixels.push_back(static_cast<int>(mixed(mixed(seed_ ^ stream) ^ (static_cast<std::uint64_t>(frame) << 32) ^ static_cast<std::uint64_t>(k)) % all));
  return pixels;
}

int Auditor::doubtful(const WorldState& state, int frame) const {
  const View view = cameraView(camera_, state, camera_.samples);
  std::vector<char> drawn(simulation_.entities.size(), 1);
  if (camera_.mount.carrier >= 0) drawn[static_cast<size_t>(camera_.mount.carrier)] = 0;
  std::map<std::size_t, std::pair<int, int>> seen;  // how many, and the first of them
  for (int pixel : pixelsOf(kDoubts, frame, 2)) {
    const int n = camera_.samples, column = pixel % camera_.pinhole.width, row = camera_.pinhole.height - 1 - pixel / camera_.pinhole.width;
    const glm::dvec3 ray = view.ray((column + 0.5) * n, (row + 0.5) * n);
    const RayHits hits = castRay(simulation_, state, view.position, view.localFromCamera * ray / glm::length(ray), view.near_m * glm::length(ray), &drawn,
                                 false, kPlannedFieldSteps);
    const auto [at, isNew] = seen.try_emplace(ReferenceShader::things(hits), 0, pixel);
    ++at->second.first;
  }
  const auto rarest = std::min_element(seen.begin(), seen.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return seen.size() > 1 ? rarest->second.second : -1;
}

void Auditor::look(const WorldState& state, int frame, CameraImage& image, bool force) {
  const int own = auditedPixels(perFrame_, frame), count = std::max(own, force && perFrame_ > 0.0 ? 1 : 0);
  if (count == 0) return;
  if (!reference_) {
    giveBackFreedMemory();  // of the compiler's, for the first picture
    Plan plan = cameraPlan(simulation_, camera_);
    // What fewer streams lose is known; more would be worked out for every wavelength anew.
    if (plan.terms.streams > 0) plan.streams = plan.terms.streams = std::max(planned_.streams, kUsualStreams);
    reference_ = std::make_unique<CameraRenderer>(simulation_, camera_, std::move(plan), library_, scene_);
  }
  std::vector<int> pixels = pixelsOf(count, frame, 1);
  const int doubt = doubtful(state, frame);
  if (doubt >= 0) pixels.push_back(doubt);
  reference_->setWanted(pixels);
  reference_->setParts(image.parts);
  reference_->setSolidAngles(image.solidAngles, cameraAt(camera_, state).pinhole.focalLength_m);
  CameraImage exact = reference_->render(state), drawn = image;
  putPointsIntoPixels(exact);
  putPointsIntoPixels(drawn);
  std::vector<char> isBroken(pixels.size(), 0);
  for (size_t o = 0; o < camera_.outputs.size(); ++o) {
    const auto slot = static_cast<size_t>(image.slotOfOutput[o]);
    image.audit.resize(std::max(image.audit.size(), slot + 1));
    if (image.audit[slot].pixels > 0) continue;  // another output of the same kernel
    std::vector<double> sorted = drawn.slots[slot], errors;
    std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() * 99 / 100), sorted.end());
    const double floor = std::max(kDark * sorted[sorted.size() * 99 / 100], reference_->plan().darkFloors()[static_cast<size_t>(exact.slotOfOutput[o])]);
    SlotAudit& audit = image.audit[slot];
    for (size_t k = 0; k < pixels.size(); ++k) {
      const auto p = static_cast<size_t>(pixels[k]);
      const double want = exact.slots[static_cast<size_t>(exact.slotOfOutput[o])][p], size = std::max(std::abs(want), floor);
      const double error = size > 0.0 ? std::abs(drawn.slots[slot][p] - want) / size : 0.0;
      if (static_cast<int>(k) < count) errors.push_back(error);
      else audit.doubt = error;
      isBroken[k] = static_cast<char>(isBroken[k] || (asked_ > 0.0 && error > asked_));
      if (error >= tally_.largest) tally_.largest = error, tally_.channel = camera_.outputs[o].channel;
    }
    tally_.errors.insert(tally_.errors.end(), errors.begin(), errors.end());
    std::sort(errors.begin(), errors.end());
    audit.pixels = count;
    audit.median = errors[errors.size() / 2];
    audit.largest = errors.back();
  }
  // One for each of those that the scenario asks for, or a single one.
  for (std::size_t k = 0; asked_ > 0.0 && k < (simulation_.audit > 0.0 ? pixels.size() : 1); ++k) lookAtWhole(state, pixels[k], drawn);
  tally_.pixels += count;
  ++tally_.frames;
  tally_.asked = asked_;
  if (own == 0) image.audit.clear();
  const std::optional<Pose> pose = camera_.follower ? std::optional(cameraAt(camera_, state).pose) : std::nullopt;
  for (size_t k = 0; k < pixels.size(); ++k)
    for (int y = 0; isBroken[k] && y < camera_.samples; ++y)
      for (int x = 0; x < camera_.samples; ++x)
        broken_.push_back(
            {frame, pixels[k] % camera_.pinhole.width + (x + 0.5) / camera_.samples, pixels[k] / camera_.pinhole.width + (y + 0.5) / camera_.samples, pose});
}

void Auditor::lookAtWhole(const WorldState& state, int pixel, const CameraImage& image) {
  if (!whole_) whole_ = std::make_unique<WholePixels>(simulation_, asDrawn_, planned_, seed_ ^ 3);
  const auto whole = whole_->look(state, pixel);
  if (!whole) return;
  const int column = pixel % image.width, row = pixel / image.width;
  for (std::size_t s = 0; s < whole->mean.size(); ++s) {
    double brightest = whole->mean[s];
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, image.height - 1); ++y)
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, image.width - 1); ++x)
        brightest = std::max(brightest, image.slots[s][static_cast<std::size_t>(y * image.width + x)]);
    if (!(brightest > 0.0)) continue;
    tally_.whole.push_back(std::abs(image.slots[s][static_cast<std::size_t>(pixel)] - whole->mean[s]) / brightest);
    tally_.wholeError = std::max(tally_.wholeError, whole->error[s] / brightest);
  }
}

}  // namespace pitviper
