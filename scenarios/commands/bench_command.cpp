// Speed of this machine: direct mode beside a fixed yardstick timed in the same run, because machines drift.
#include <epoxy/gl.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <sstream>

#include "scenarios/commands/accuracy_bench.hpp"
#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/options.hpp"
#include "scenarios/reader/scenario_reader.hpp"
#include "sim/gl/context.hpp"
#include "sim/render/buffered_pass.hpp"
#include "sim/render/camera_renderer.hpp"
#include "sim/render/direct_pass.hpp"

namespace pitviper {

std::span<const ShaderText> pv_commands_shaders();

namespace {

constexpr int kSize = 256;

/// The scene of the paper's figures: 16 channels over one band, 16 wavelengths in common, a lit, warm wall in air.
std::string benchScenario() {
  std::ostringstream y;
  y << "atmosphere: {extinction: {wavelength: um, unit: 1/km, values: [[2.9, 0.3], [4.2, 2.0], [5.1, 0.4]]}, temperature: 288 K}\n"
    << "background: {temperature: 250 K}\n"
    << "materials: {wall: {components: [{reflection: lambertian, reflectance: {wavelength: um, unit: \"1\", values: [[2.9, 0.1], [5.1, 0.4]]}}]}}\n"
    << "lights: [{name: lamp, intensity: {blackbody: 2000 K, area: 0.1 m2}, visible: false, position: [40 m, 20 m, 10 m]}]\n"
    << "entities: [{name: wall, shape: {model: plate, width: 400 m, height: 400 m}, material: wall, temperature: 300 K}]\n"
    << "cameras:\n  - name: c\n    film: {width: " << kSize << ", height: " << kSize << "}\n    field_of_view: 20 deg\n    aperture: 50 mm\n"
    << "    position: [300 m, 0 m, 0 m]\n    look_at: wall\n    spectral: {samples: 16, spacing: even, shared: true}\n"
    << "    channels:\n";
  for (int c = 0; c < 16; ++c)
    y << "      - {name: c" << c << ", response: {wavelength: um, unit: \"1\", values: [[3, " << 0.2 + 0.05 * c << "], [5, " << 1.0 - 0.05 * c << "]]}}\n";
  return y.str();
}

/// The bare loop, set up once, drawn as often as asked.
class Yardstick {
 public:
  Yardstick()
      : vertexArray_(makeVertexArray()),
        target_(kSize, kSize, std::vector<PixelFormat>(4, PixelFormat::Rgba32f), false),
        constants_(16, 5, PixelFormat::Rgba32f) {
    ShaderLibrary library;
    library.add(pv_commands_shaders());
    ShaderSlots none;
    program_ = Program(assembleShader(shaderLibrary(), "sim/render/glsl/full_screen.vert.glsl", none),
                       assembleShader(library, "scenarios/commands/glsl/yardstick.glsl", none));
    std::vector<float> table(16 * 32 * 32 * 4);
    for (size_t i = 0; i < table.size(); ++i) table[i] = 0.1f + 0.001f * static_cast<float>(i % 97);
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_3D, 1, &name);
    table_ = GlName<deleteTexture>(name);
    glTextureStorage3D(name, 1, GL_RGBA32F, 16, 32, 32);
    glTextureSubImage3D(name, 0, 0, 0, 0, 16, 32, 32, GL_RGBA, GL_FLOAT, table.data());
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    std::vector<float> constants(16 * 5 * 4, 0.3f);
    glTextureSubImage2D(constants_.name(), 0, 0, 0, 16, 5, GL_RGBA, GL_FLOAT, constants.data());
  }
  void draw() {
    target_.bind();
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(vertexArray_);
    glBindTextureUnit(0, table_);
    constants_.bind(1);
    program_.use();
    glUniform2f(program_.uniform("angles"), 0.3f, 0.4f);
    glDrawArrays(GL_TRIANGLES, 0, 3);
  }

 private:
  VertexArray vertexArray_;
  RenderTarget target_;
  Texture2D constants_;
  GlName<deleteTexture> table_;
  Program program_;
};

/// Seconds of each of `repeats` calls, the device idle before and after.
template <class Draw>
std::vector<double> timed(int repeats, Draw draw) {
  std::vector<double> seconds;
  for (int i = 0; i < repeats; ++i) {
    glFinish();
    const auto start = std::chrono::steady_clock::now();
    draw();
    glFinish();
    seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return seconds;
}

double median(std::vector<double> v) {
  std::sort(v.begin(), v.end());
  return v[v.size() / 2];
}

}  // namespace

int benchCommand(const Arguments& arguments) {
  const Options o("bench", arguments, {{"--frames"}, {"--accuracy"}}, 0, 0);
  if (o.has("--accuracy")) return accuracyBench(o.value("--accuracy"));
  const int frames = static_cast<int>(std::clamp(readRange(o.value("--frames", "200"), "--frames").first, 10LL, 100000LL));
  const Simulation sim = readScenarioText(benchScenario(), "bench", ".", {}, findLibraries());
  const GlContext context;
  auto scene = std::make_shared<const GpuScene>(sim);
  const Camera& camera = sim.cameras[0];
  const Plan plan = makePlan(sim, camera.outputs, camera.spectral, camera.where);
  DirectPass pass(sim, plan, shaderLibrary(), scene, false, camera.pinhole.apertureArea_m2());
  BufferedPass buffered(sim, plan, shaderLibrary(), scene, false, camera.pinhole.apertureArea_m2());
  CameraRenderer renderer(sim, camera, shaderLibrary(), scene);
  const WorldState state = advance(sim.entities, sim.lights, 0.0);
  const View view = cameraView(camera.pinhole, cameraPose(camera.mount, state), camera.near_m, 1);
  Yardstick yardstick;
  pass.setState(state);
  buffered.setState(state);
  auto drawDirect = [&] { pass.draw(view, state, {1}); };
  auto drawBuffered = [&] { buffered.draw(view, state, {1}); };
  yardstick.draw();
  drawDirect();
  drawBuffered();
  // Alternating rounds, so that both see the same drift; the ratio is of medians.
  std::vector<double> bare, direct, spectral, whole;
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    for (double s : timed(frames / kRounds, [&] { yardstick.draw(); })) bare.push_back(s);
    for (double s : timed(frames / kRounds, drawDirect)) direct.push_back(s);
    for (double s : timed(frames / kRounds, drawBuffered)) spectral.push_back(s);
    for (double s : timed(std::max(1, frames / kRounds / 4), [&] { renderer.render(state); })) whole.push_back(s);
  }
  const double pixels = kSize * kSize, b = median(bare), d = median(direct), q = median(spectral), w = median(whole);
  std::printf("%s\n%dx%d pixels, 16 channels, 16 wavelengths, one light, thermal emission, air on both legs; median of %zu\n\n",
              context.limits().renderer.c_str(), kSize, kSize, direct.size());
  std::printf("%-44s %12s %12s %12s\n", "", "ms", "Mpixel/s", "frames/s");
  auto row = [&](const char* what, double s) { std::printf("%-44s %12.2f %12.2f %12.1f\n", what, s * 1e3, pixels / s * 1e-6, 1.0 / s); };
  row("yardstick: bare 16-wavelength loop", b);
  row("direct mode", d);
  row("buffered mode", q);
  row("direct mode, read back, in double", w);
  std::printf(
      "\ndirect mode / yardstick: %.2f, buffered mode / yardstick: %.2f (wanted: at least 0.55)\n"
      "Duvenhage 2006, GeForce 6600GT: direct 5.2, buffered 4.6 Mpixel/s; here %.2f and %.2f times that\n",
      b / d, b / q, pixels / d * 1e-6 / 5.2, pixels / q * 1e-6 / 4.6);
  return 0;
}

}  // namespace pitviper
