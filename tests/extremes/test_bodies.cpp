// The shared .glsl bodies in single precision on the GPU, argument by argument over what a float holds, against long double with the C
// library's own functions: not against the same text in double.
#include "scenarios/commands/commands.hpp"
#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/extremes/extremes.hpp"

namespace pitviper::test {
namespace {

/// `expression` of x and y over a grid: columns x = xFrom ratio^column, rows y = yFrom yRatio^row. Four values a pixel.
struct Grid {
  int width = 256, height = 1;
  std::vector<float> values;
  const float* at(int x, int y) const { return &values[static_cast<size_t>(4 * (y * width + x))]; }
};

Grid evaluate(const std::string& uses, const std::string& expression, int width, int height, float xFrom, float xRatio, float yFrom, float yRatio) {
  needContext();
  const std::string source = uses +
                             "uniform float xFrom;\nuniform float xRatio;\nuniform float yFrom;\nuniform float yRatio;\nlayout(location = 0) out vec4 c;\n"
                             "void main() { float x = xFrom * pow(xRatio, gl_FragCoord.x - 0.5), y = yFrom * pow(yRatio, gl_FragCoord.y - 0.5);\nc = " +
                             expression + "; }\n";
  const ShaderText text[] = {{"test/body.glsl", source}};
  ShaderLibrary library = shaderLibrary();
  library.add(text);
  Program program(assembleShader(library, "sim/render/geometry/glsl/full_screen.vert.glsl", {}), assembleShader(library, "test/body.glsl", {}));
  RenderTarget target(width, height, {PixelFormat::Rgba32f}, false);
  drawFullScreen(target, program, {{"xFrom", xFrom}, {"xRatio", xRatio}, {"yFrom", yFrom}, {"yRatio", yRatio}});
  Readback readback;
  readback.start(target, 1);
  return {width, height, readback.wait().colours[0]};
}

double value(float v) { return static_cast<double>(v); }

TEST(Bodies, ExponentialsFromNothingToInfinity) {
  const Grid g = evaluate("//@use sim/radiometry/glsl/medium.glsl\n", "vec4(x, oneMinusExp(x), decay(x), meanDecay(x))", 512, 1, 1e-37f, 1.4f, 1.0f, 1.0f);
  Range lost("GPU 1 - exp(-x), x from 1e-37 to infinity", 1e-6, "expm1l; 3 bits lost above 0.125");
  Range kept("GPU exp(-x), x from 1e-37 to 87", 1e-6, "expl; two-part reduction");
  Range mean("GPU (1 - exp(-x)) / x, x from 1e-37 to 1e37", 1e-6, "expm1l");
  int infinite = 0;
  for (int k = 0; k < g.width; ++k) {
    const float* v = g.at(k, 0);
    const long double x = v[0];
    if (std::isinf(v[0])) {
      ++infinite;
      EXPECT_EQ(v[1], 1.0f);
      EXPECT_EQ(v[2], 0.0f);
      continue;
    }
    const std::string at = std::to_string(v[0]);
    lost.add(value(v[1]), static_cast<double>(-std::expm1(-x)), at);
    if (v[0] < 87.0f) kept.add(value(v[2]), static_cast<double>(std::exp(-x)), at);
    if (v[0] > 87.4f) {
      EXPECT_EQ(v[2], 0.0f);
    }
    if (x < 1e37L) mean.add(value(v[3]), static_cast<double>(-std::expm1(-x) / x), at);
  }
  EXPECT_GT(infinite, 0);
}

TEST(Bodies, LogarithmOfOneMinus) {
  const Grid g =
      evaluate("//@use sim/radiometry/glsl/exponential.glsl\n", "vec4(min(x, 0.999), logOneMinus(min(x, 0.999)), 0.0, 0.0)", 512, 1, 1e-30f, 1.15f, 1.0f, 1.0f);
  Range log("GPU ln(1 - c), c from 1e-30 to 0.999", 2e-5, "log1pl; 1 - c rounds by 6e-8 where ln is -0.05");
  for (int k = 0; k < g.width; ++k) {
    const float* v = g.at(k, 0);
    log.add(value(v[1]), static_cast<double>(std::log1p(-static_cast<long double>(v[0]))), std::to_string(v[0]));
  }
}

TEST(Bodies, PlanckOverAllWavelengthsAndTemperatures) {
  const Grid g = evaluate("//@use sim/radiometry/glsl/planck.glsl\n", "vec4(x, y, planckRadiance(x, y), 0.0)", 300, 90, 0.1f, 1.0313f, 0.01f, 1.2f);
  Range warm("GPU Planck, 0.1-1000 um, 0.01-110000 K, c2/(lambda T) to 60", 1e-5, "long double; x rounds: 60 x 1.2e-7");
  Range cold("GPU Planck beyond c2/(lambda T) = 60, where not 0", 2e-5, "long double; x rounds: 87 x 1.2e-7");
  int zeros = 0;
  for (int j = 0; j < g.height; ++j)
    for (int i = 0; i < g.width; ++i) {
      const float* v = g.at(i, j);
      const long double w = v[0], t = v[1], c2 = static_cast<long double>(kSecondRadiation_umK), x = c2 / (w * t);
      const long double want = static_cast<long double>(kFirstRadianceConstant) / std::pow(w, 5.0L) / std::expm1(x);
      if (v[2] == 0.0f) {
        ++zeros;
        EXPECT_TRUE(x > 87.3L || want < 1.2e-38L) << v[0] << " um, " << v[1] << " K";
      } else {
        (x <= 60.0L ? warm : cold).add(value(v[2]), static_cast<double>(want), std::to_string(v[0]) + " um, " + std::to_string(v[1]) + " K");
      }
    }
  EXPECT_GT(zeros, 1000);
}

// A stretch of medium of optical depth x in air of depth y on the same stretch, seen from its near end: sources 2 (medium) and 5 (air).
TEST(Bodies, MediumInAir) {
  const Grid g = evaluate("//@use sim/radiometry/glsl/medium.glsl\n", "vec4(x, y, mediumRadiance(x, y, 0.0, 5.0 * oneMinusExp(y), 1.0, 2.0), 0.0)", 60, 60,
                          1e-12f, 2.0f, 1e-12f, 2.0f);
  Range both("GPU medium in air, both depths 1e-12 to 6e5", 2e-6, "(x S + y L)(1 - exp(-x - y)) / (x + y), expm1l");
  for (int j = 0; j < g.height; ++j)
    for (int i = 0; i < g.width; ++i) {
      const float* v = g.at(i, j);
      const long double x = v[0], y = v[1];
      both.add(value(v[2]), static_cast<double>((2.0L * x + 5.0L * y) / (x + y) * -std::expm1(-x - y)), std::to_string(v[0]) + ", " + std::to_string(v[1]));
    }
}

// A segment whose source changes evenly with depth from 3 to 1, and the mean of what it lets through from a depth of y on.
TEST(Bodies, SegmentOfAPath) {
  const Grid g = evaluate("//@use sim/radiometry/glsl/segment.glsl\n",
                          "vec4(x, y, segmentRadiance(3.0, 1.0, x, exp(-x), lostOf(x, exp(-x))), meanPassed(y, y + x, exp(-y), exp(-(y + x))))", 200, 40,
                          1e-12f, 1.19f, 1e-6f, 1.5f);
  Range sent("GPU segment with a source linear in depth, depths 1e-12 to 1300", 8e-6,
             "3 (1 - exp(-d)) - 2 g(d); exp rounds by 1.2e-7, in g over d: 2 x 1.2e-7 / 0.125 of 0.24");
  Range passed("GPU mean of exp(-D) from y to x + y, x to 80 and y to 10", 2e-5, "exp(-y) (1 - exp(-x)) / x; y + x rounds: 6e-8 x 10 / 0.125");
  for (int j = 0; j < g.height; ++j)
    for (int i = 0; i < g.width; ++i) {
      const float* v = g.at(i, j);
      const long double x = v[0], y = v[1], lost = -std::expm1(-x);
      const std::string at = std::to_string(v[0]) + ", " + std::to_string(v[1]);
      const long double growth = x < 1e-3L ? x * (0.5L - x * (1.0L / 3.0L - x * (0.125L - x / 30.0L))) : (lost - x * std::exp(-x)) / x;
      sent.add(value(v[2]), static_cast<double>(3.0L * lost - 2.0L * growth), at);
      if (x < 80.0L && y < 10.0L) passed.add(value(v[3]), static_cast<double>(std::exp(-y) * lost / x), at);
    }
}

}  // namespace
}  // namespace pitviper::test
