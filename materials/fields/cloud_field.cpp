#include "materials/fields/cloud_field.hpp"

#include "sim/model/scene_fingerprint.hpp"
#include "sim/radiometry/physics.hpp"

namespace pitviper {
namespace physics {

/// The shader's own text, in double.
class CloudLine {
 public:
  explicit CloudLine(const std::vector<glm::vec4>& texels) : texels_(texels) {}
  Vec3 q_{0.0}, d_{1.0, 0.0, 0.0};
  Real perT_ = 1.0, enter_ = 0.0, leave_ = 0.0;
  Vec4 amountLow_{0.0};
  Real weight_ = 0.0, heat_ = 0.0, lit_ = 0.0;
  Vec4 fieldTexel(int i) const { return Vec4(texels_[static_cast<std::size_t>(i)]); }
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-parameter"  // the contract of field shaders
#include "materials/fields/glsl/cloud.field.glsl"
#pragma GCC diagnostic pop

 private:
  const std::vector<glm::vec4>& texels_;
};
}  // namespace physics

namespace {

/// Lines through a pixel may lie so many nodes apart: neighbours differ little, as what is finer than a node is not there.
constexpr double kNodesApart = 2.0;

class CloudState : public FieldState {
 public:
  CloudState(const DensityGrid& frame, const glm::dvec3& base, std::shared_ptr<const FieldTexels> numbers) {
    origin = base;
    low = frame.first;
    high = frame.last();
    finest_m = kNodesApart * std::min({frame.spacing.x, frame.spacing.y, frame.spacing.z});
    const glm::dvec3 half = 0.5 * (high - low);
    elements.push_back({0.5 * (low + high), 1.001 * glm::length(half), 0, finest_m, 0, {}, 1.001 * half});
    texels = std::move(numbers);
  }

  void along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const override {
    out.clear();
    physics::CloudLine at(texels->texel);
    at.q_ = line.origin - origin;
    at.d_ = line.direction;
    const glm::dvec2 chord = at.fieldChord(0);
    at.enter_ = std::max(chord.x, line.nearest_m);
    at.leave_ = std::min(chord.y, line.farthest_m);
    if (!(chord.y > chord.x) || !(at.leave_ > at.enter_) || steps < 1) return;
    at.fieldLine(0, steps);
    double from = at.enter_;
    for (int i = 0; i < steps; ++i) {
      const double to = at.fieldCut((i + 1.0) / steps);
      at.amountLow_ = glm::dvec4(0.0);
      at.weight_ = at.heat_ = at.lit_ = 0.0;
      at.fieldAdd(0, from, to);
      if (at.weight_ > 0.0) {
        FieldStep& step = out.emplace_back();
        step.enter_m = from;
        step.leave_m = to;
        step.amount[0] = at.amountLow_.x;
        step.temperature_K = at.heat_ / at.weight_;
        step.sun = at.lit_ / at.weight_;
        step.cloud = at.cloudStep();
      }
      from = to;
    }
  }
};

}  // namespace

CloudBody::CloudBody(const CloudBodyOptions& options) : options_(options) { frame_ = cumulusFrame(options_.shape, options_.across); }

CloudBody::CloudBody(DensityGrid grid, double base_K, double lapse_K_m) : given_(std::move(grid)), frame_(given_) {
  options_.base_K = base_K, options_.lapse_K_m = lapse_K_m;
}

void CloudBody::addTo(Fingerprint& f) const {
  f.add("cloud").add(options_.shape.width_m).add(options_.shape.depth_m).add(options_.shape.roughness).add(options_.shape.seed);
  f.add(options_.across).add(options_.mostDepth).add(options_.base_K).add(options_.lapse_K_m).add(given_.first).add(given_.spacing).all(given_.value);
}

glm::dvec2 CloudBody::temperatures_K() const {
  const double top_K = options_.base_K - options_.lapse_K_m * frame_.last().z;
  return {std::min(top_K, options_.base_K), std::max(top_K, options_.base_K)};
}

const DensityGrid& CloudBody::density() const {
  if (!given_.value.empty()) return given_;
  std::call_once(once_, [&] { density_ = cumulusGrid(options_.shape, options_.across, options_.mostDepth); });
  return density_;
}

std::shared_ptr<const FieldState> CloudSource::at(const FieldWorld&) const {
  return std::make_shared<CloudState>(clouds_->body(cloud_).frame(), clouds_->base(cloud_), clouds_->texels(cloud_));
}

void CloudSource::addTo(Fingerprint& f) const {
  clouds_->body(cloud_).addTo(f);
  f.add(clouds_->base(cloud_)).add(drops_.height_m);
  for (const Spectrum* s : {&drops_.albedo, &drops_.asymmetry}) pitviper::addTo(f, *s);
}

Medium cloudGas(const DropOptics& o) {
  const auto table = [&](const char* name, const auto& of) {
    Spectrum::Table t{o.wavelength_um, {}, Outside::Hold, name};
    for (std::size_t i = 0; i < o.wavelength_um.size(); ++i) t.value.push_back(of(physics::cloudOptics(o.extinction[i], o.albedo[i], o.asymmetry[i])));
    return Spectrum(std::move(t));
  };
  Medium gas{table("extinction of drops, scaled", [](const physics::CloudOptics& c) { return c.extinction * physics::cloudScale(c.albedo, c.asymmetry); })};
  gas.albedo = table("albedo of drops, scaled", [](const physics::CloudOptics& c) { return c.scaledAlbedo; });
  gas.asymmetry = table("asymmetry of drops, scaled", [](const physics::CloudOptics& c) { return c.scaledAsymmetry; });
  return gas;
}

Droplets dropletsOf(const DropOptics& o, double height_m) {
  return {Spectrum(Spectrum::Table{o.wavelength_um, o.albedo, Outside::Hold, "albedo of drops"}),
          Spectrum(Spectrum::Table{o.wavelength_um, o.asymmetry, Outside::Hold, "asymmetry of drops"}), height_m};
}

}  // namespace pitviper
