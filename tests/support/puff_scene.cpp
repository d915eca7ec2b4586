#include "tests/support/puff_scene.hpp"

#include <algorithm>

namespace pitviper::test {
namespace {

class FixedPuffs final : public FieldSource {
 public:
  explicit FixedPuffs(std::vector<Puff> puffs) : puffs_(std::move(puffs)) {}
  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override {
    std::vector<Puff> puffs = puffs_;
    for (Puff& p : puffs) p.sun = world.sunAt(p.centre);
    return std::make_shared<const PuffsState>(std::move(puffs));
  }
  std::string shader() const override { return kPuffsShader; }
  void addTo(Fingerprint& f) const override {
    for (const Puff& p : puffs_) f.add(p.centre).add(p.radius_m).add(p.length_m()).add(p.amount[0]).add(p.temperature_K).add(p.gain);
  }
  glm::dvec2 temperatures_K() const override {
    glm::dvec2 range(puffs_.front().temperature_K);
    for (const Puff& p : puffs_) range = {std::min(range.x, p.temperature_K), std::max(range.y, p.temperature_K)};
    return range;
  }

 private:
  std::vector<Puff> puffs_;
};

}  // namespace

void addPuffs(Simulation& sim, std::vector<Puff> puffs, const Medium& gas) {
  auto material = std::make_shared<Material>();
  material->name = "puffs " + std::to_string(sim.fields.size());
  material->medium = gas;
  sim.materials.push_back(material);
  FieldBody body;
  body.name = material->name;
  body.gases = {{"gas", {{300.0, static_cast<int>(sim.materials.size()) - 1}}}};
  body.source = std::make_shared<const FixedPuffs>(std::move(puffs));
  sim.fields.push_back(std::move(body));
  sim.content += " " + sim.fields.back().name;
}

Puff puffAt(const glm::dvec3& centre, double radius_m, double amount, double temperature_K) {
  Puff p;
  p.centre = centre;
  p.radius_m = radius_m;
  p.amount = {amount, 0.0, 0.0, 0.0};
  p.temperature_K = temperature_K;
  return p;
}

Medium greyGas(double absorption) { return {Spectrum(absorption), {}, {}, {}}; }

}  // namespace pitviper::test
