// `bench --phong`: tables of spectral Phong lobes against the formula, error and time, after Table 1 of the tabulation paper.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "scenarios/commands/commands.hpp"
#include "scenarios/commands/phong_tables.hpp"
#include "sim/image/srgb.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr int kSide = 256, kEntries = 200, kSegments = 10;

/// Gaussian lobes that fit the CIE 1931 functions. Source: C. Wyman, P. Sloan, P. Shirley, JCGT 2(2), 1 (2013), multi-lobe fit.
glm::dvec3 observer(double nm) {
  const auto g = [nm](double m, double a, double b) { return std::exp(-0.5 * std::pow((nm - m) * (nm < m ? a : b), 2.0)); };
  return {1.056 * g(599.8, 0.0264, 0.0323) + 0.362 * g(442.0, 0.0624, 0.0374) - 0.065 * g(501.1, 0.0490, 0.0382),
          0.821 * g(568.8, 0.0213, 0.0247) + 0.286 * g(530.9, 0.0613, 0.0322), 1.217 * g(437.0, 0.0845, 0.0278) + 0.681 * g(459.0, 0.0385, 0.0725)};
}

/// Curves over 380 to 780 nm, u = 0..1.
struct Curves {
  const char* name;
  std::function<double(double)> diffuse, specular, exponent;
};

/// The paper shows its curves as pictures only; these span their exponents: broad, middling, narrow.
const std::vector<Curves>& curveSets() {
  static const std::vector<Curves> sets{
      {"R1, exponents 5 to 40", [](double u) { return 0.2 + 0.3 * u; }, [](double u) { return 0.6 - 0.2 * u; }, [](double u) { return 5.0 + 35.0 * u; }},
      {"R2, exponents 20 to 200", [](double u) { return 0.5 - 0.4 * u; }, [](double u) { return 0.3 + 0.3 * std::sin(3.0 * u); },
       [](double u) { return 200.0 - 180.0 * u; }},
      {"R3, exponents 300 to 1000", [](double u) { return 0.1 + 0.2 * u * u; }, [](double u) { return 0.5 + 0.2 * std::cos(6.0 * u); },
       [](double u) { return 300.0 + 700.0 * u; }}};
  return sets;
}

struct Wave {
  glm::dvec3 rgb;  ///< of a white surface's light
  double diffuse, specular, exponent;
};

std::vector<Wave> wavesOf(const Curves& c) {
  std::vector<Wave> waves;
  double white = 0.0;
  for (int nm = 380; nm <= 780; nm += 5) {
    const double u = (nm - 380) / 400.0;
    const glm::dvec3 xyz = observer(nm);
    white += xyz.y;
    waves.push_back({linearSrgb(xyz), c.diffuse(u), c.specular(u), c.exponent(u)});
  }
  for (Wave& w : waves) w.rgb /= white;
  return waves;
}

/// Radiance of a sphere's pixels, of its diffuse part alone where `specular` is none.
template <class Specular>
std::vector<glm::dvec3> picture(const std::vector<Wave>& waves, double radius_px, glm::dvec2 centre, const Specular& specular) {
  glm::dvec3 diffuse(0.0);
  for (const Wave& w : waves) diffuse += w.diffuse * w.rgb;
  const glm::dvec3 light = glm::normalize(glm::dvec3(0.4, 0.5, 1.0)), view(0.0, 0.0, 1.0);
  std::vector<glm::dvec3> all;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const glm::dvec2 p = (glm::dvec2(x + 0.5, y + 0.5) - centre) / radius_px;
      const double r2 = glm::dot(p, p);
      if (r2 >= 1.0) continue;
      const glm::dvec3 n(p.x, p.y, std::sqrt(1.0 - r2));
      const double cosine = glm::dot(n, light);
      if (cosine <= 0.0) {
        all.emplace_back(0.0);
        continue;
      }
      const double t = glm::dot(2.0 * cosine * n - light, view);
      all.push_back(255.0 * (0.7 * cosine * diffuse + (t > 0.0 ? specular(t) : glm::dvec3(0.0))));
    }
  return all;
}

double rms(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / (3.0 * static_cast<double>(a.size())));
}

/// Of the shortest of several.
template <class Draw>
double secondsOf(const Draw& draw, int times) {
  double best = 1e9;
  for (int k = 0; k < times; ++k) {
    const auto start = std::chrono::steady_clock::now();
    draw();
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return best;
}

/// A sphere lit by one lamp, drawn on the CPU in double by the formula at 81 wavelengths and by three kinds of tables of 200 entries, far and near, for
/// three sets of curves: root mean square error in 8-bit units of linear sRGB and time of a picture, as Markdown.
std::string phongBench() {
  std::string out =
      "Spectral Phong, a sphere in 256x256 pixels by the formula at 81 wavelengths and by tables of 200 entries (double precision, one thread)\n\n"
      "| curves | view | uniform, RMS | importance, RMS | angle, RMS | uniform / importance | importance / angle | formula, ms | uniform | importance | angle "
      "|\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Curves& curves : curveSets()) {
    const auto waves = wavesOf(curves);
    const PhongLobe lobe = [&](double t) {
      glm::dvec3 sum(0.0);
      for (const Wave& w : waves) sum += w.specular * std::pow(t, w.exponent) * w.rgb;
      return PhongColour{sum.x, sum.y, sum.z};
    };
    const UniformTable uniform(lobe, kEntries);
    const ImportanceTable importance(lobe, kEntries, kSegments);
    const AngleTable angle(lobe, kEntries);
    for (bool near : {false, true}) {
      const double radius = near ? 420.0 : 110.0;
      // Near: the highlight in the middle of the picture.
      const glm::dvec3 half = glm::normalize(glm::normalize(glm::dvec3(0.4, 0.5, 1.0)) + glm::dvec3(0.0, 0.0, 1.0));
      const glm::dvec2 centre = glm::dvec2(0.5 * kSide) - (near ? radius * glm::dvec2(half.x, half.y) : glm::dvec2(0.0));
      const auto by = [&](const PhongTable& table) {
        return picture(waves, radius, centre, [&](double t) {
          const PhongColour c = table.at(t);
          return glm::dvec3(c[0], c[1], c[2]);
        });
      };
      const auto formula = [&] {
        return picture(waves, radius, centre, [&](double t) {
          const PhongColour c = lobe(t);
          return glm::dvec3(c[0], c[1], c[2]);
        });
      };
      const auto exact = formula();
      const double u = rms(by(uniform), exact), i = rms(by(importance), exact), a = rms(by(angle), exact);
      out += print("| %s | %s | %.4f | %.5f | %.5f | %.1f | %.1f | %.1f | %.2f | %.2f | %.2f |\n", curves.name, near ? "near" : "far", u, i, a, u / i, i / a,
                   1e3 * secondsOf(formula, 2), 1e3 * secondsOf([&] { by(uniform); }, 7), 1e3 * secondsOf([&] { by(importance); }, 7),
                   1e3 * secondsOf([&] { by(angle); }, 7));
    }
  }
  return out +
         "\nThe paper's Table 1 (its own curves, shown as pictures only): uniform / importance 3.8 and 3.6 (R1, far and near), 6.8 and 7.3 (R2), 23.6 and 40.9 "
         "(R3);\n"
         "formula / importance in time 9.6 and 19 (R1), 11 and 17 (R2), 7.5 and 19 (R3).\n";
}

}  // namespace

CommandLine phongBenchCommand() {
  return {{"bench --phong", ""},
          "Tables of 200 entries of spectral Phong lobes against the formula, error and time, as in the paper that proposed them.",
          {},
          [](const Arguments&) { return std::fputs(phongBench().c_str(), stdout), 0; }};
}

}  // namespace pitviper
