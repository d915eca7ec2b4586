// The shader of puffs by itself, on the GPU in single precision, against the same lines of sight in double.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "materials/fields/puffs.hpp"
#include "scenarios/commands/commands.hpp"
#include "sim/gl/context.hpp"
#include "sim/gl/objects.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/scene_builder.hpp"

namespace pitviper::test {
namespace {

// Rationale: what sim/render/media/glsl/volume_field.frag.glsl gives to and takes from its slot, without the rest of it: a pixel is a line through the puffs,
// in three steps. Expected: amounts, and what they weigh, within 2e-5 of the greatest: places up to 30 m away have steps of 2e-6 m, a millionth of the least
// radius, and near an edge an amount goes with the root of what is left.
TEST(PuffsOnTheGpu, AreThoseInDouble) {
  needContext();
  std::mt19937 random(8);
  std::uniform_real_distribution<double> one(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<Puff> puffs;
  for (int k = 0; k < 12; ++k) {
    Puff p;
    p.centre = {20.0 * one(random), 8.0 * one(random) - 4.0, 8.0 * one(random) - 4.0};
    p.radius_m = 1.5 + 2.0 * one(random);
    p.halfLength_m = p.radius_m * (0.8 + 3.0 * one(random));
    p.axis = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
    p.amount = {one(random), 0.3 * one(random), 0.0, 0.1};
    p.temperature_K = 300.0 + 900.0 * one(random);
    p.gain = one(random);
    p.sun = one(random);
    p.sunAmount = one(random);
    puffs.push_back(p);
  }
  const PuffsState state(puffs);
  static const ShaderText text[] = {{"test/puffs.glsl", R"(
layout(binding = 17) uniform samplerBuffer fieldTexels;
uniform float elements;
uniform float step_;
uniform float what;
layout(location = 0) out vec4 c;
vec4 fieldTexel(int i) { return texelFetch(fieldTexels, i); }
vec3 q_;
vec3 d_;
float perT_, enter_, leave_;
vec4 amountLow_ = vec4(0.0), amountHigh_ = vec4(0.0);
float weight_ = 0.0, heat_ = 0.0, gained_ = 0.0, lit_ = 0.0, shade_ = 0.0;
void addTemperature(float weight, float temperature) {}
//@slot field
void main() {
  q_ = vec3(-10.0, (gl_FragCoord.xy - 32.0) / 6.0);
  d_ = vec3(2.0, 0.01 * (gl_FragCoord.yx - 32.0));
  perT_ = length(d_);
  enter_ = kFar;
  leave_ = -kFar;
  int first = -1;
  for (int e = 0; e < int(elements); ++e) {
    vec2 chord = fieldChord(4 * e);
    if (!(chord.y > chord.x)) continue;
    if (first < 0) first = 4 * e;
    enter_ = min(enter_, chord.x);
    leave_ = max(leave_, chord.y);
  }
  if (first < 0) { c = vec4(0.0); return; }
  fieldLine(first, 3);
  float from = fieldCut(step_ / 3.0), to = fieldCut((step_ + 1.0) / 3.0);
  for (int e = 0; e < int(elements); ++e) fieldAdd(4 * e, from, to);
  c = what < 0.5 ? amountLow_ : vec4(heat_ / 1000.0, gained_, lit_, shade_);
}
)"}};
  ShaderLibrary library = shaderLibrary();
  library.add(text);
  Program program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", {}),
                  assembleShader(library, "test/puffs.glsl", {{{"field", kPuffsShader}}, {}, {}, {}}));
  Buffer texels;
  texels.upload(state.texels->texel);
  constexpr int kSide = 64;
  double worst = 0.0, greatest = 0.0;
  int covered = 0;
  for (int step = 0; step < 3; ++step)
    for (int what = 0; what < 2; ++what) {
      RenderTarget target(kSide, kSide, {PixelFormat::Rgba32f}, false);
      texels.bindTexture(17, 4);
      drawFullScreen(target, program,
                     {{"elements", static_cast<float>(puffs.size())}, {"step_", static_cast<float>(step)}, {"what", static_cast<float>(what)}});
      Readback readback;
      readback.start(target, 1);
      const auto pixels = readback.wait();
      for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
          const glm::dvec3 q(-10.0, (x + 0.5 - 32.0) / 6.0, (y + 0.5 - 32.0) / 6.0), d(2.0, 0.01 * (y + 0.5 - 32.0), 0.01 * (x + 0.5 - 32.0));
          const glm::dvec3 direction = glm::normalize(d);
          // Its parts are of the union of chords too; none is left out here, all being much longer than the puffs are fine.
          std::vector<FieldStep> all;
          state.along({q + state.origin, direction, -1e3, 1e3}, 3, all);
          // Those of one stretch differ by their temperature alone.
          all.erase(std::unique(all.begin(), all.end(), [](const FieldStep& a, const FieldStep& b) { return a.enter_m == b.enter_m; }), all.end());
          std::array<double, 4> want{};
          if (!all.empty() && all.size() < 3) continue;  // a third of the way that passes no puff is not among them
          if (!all.empty()) {
            const double from = all[static_cast<std::size_t>(step)].enter_m, to = all[static_cast<std::size_t>(step)].leave_m;
            for (const Puff& p : puffs) {
              const double column = puffColumn(p, q + state.origin, direction, from, to),
                           weight = column * (p.amount[0] + p.amount[1] + p.amount[2] + p.amount[3]);
              const std::array<double, 4> weighed{1e-3 * p.temperature_K, p.gain, p.sun, p.sunAmount};
              for (std::size_t k = 0; k < 4; ++k) want[k] += what == 0 ? column * p.amount[k] : weight * weighed[k];
            }
            ++covered;
          }
          for (std::size_t k = 0; k < 4; ++k) {
            const double got = static_cast<double>(pixels.colours[0][static_cast<std::size_t>(4 * (y * kSide + x)) + k]);
            ASSERT_TRUE(std::isfinite(got));
            worst = std::max(worst, std::abs(got - want[k]));
            greatest = std::max(greatest, want[k]);
          }
        }
    }
  EXPECT_GT(covered, 6 * 2000);
  bound("puffs on the GPU against double, of the greatest amount", worst / greatest, 2e-5, "single precision");
}

}  // namespace
}  // namespace pitviper::test
