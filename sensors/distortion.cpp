// Distortion of the lens: the picture of a pinhole drawn out or in, and what is smaller than a cell moved.
// Law: x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d = y (...) + p1 (r^2 + 2 y^2) + 2 p2 x y; x to the right and y down, tangents
// from the
//   axis, r^2 = x^2 + y^2. Source: D. C. Brown, Photogrammetric Engineering 32, 444 (1966), in the signs of OpenCV's camera calibration. Valid while r_d rises
//   with r.
#include <algorithm>
#include <array>
#include <cmath>

#include "sensors/side_by_side.hpp"
#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"

namespace pitviper {
namespace {

struct Brown {
  double k1 = 0.0, k2 = 0.0, k3 = 0.0, p1 = 0.0, p2 = 0.0;
  glm::dvec2 operator()(const glm::dvec2& q) const {
    const double r2 = glm::dot(q, q), radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    return radial * q + glm::dvec2(2.0 * p1 * q.x * q.y + p2 * (r2 + 2.0 * q.x * q.x), p1 * (r2 + 2.0 * q.y * q.y) + 2.0 * p2 * q.x * q.y);
  }
  /// d r_d / d r of its radial part.
  double rises(double r) const {
    const double r2 = r * r;
    return 1.0 + r2 * (3.0 * k1 + r2 * (5.0 * k2 + 7.0 * r2 * k3));
  }
  /// Newton's steps from the place itself, its slopes by differences.
  glm::dvec2 inverse(const glm::dvec2& d) const {
    constexpr double kStep = 1e-6;
    glm::dvec2 q = d;
    for (int k = 0; k < 20; ++k) {
      const glm::dvec2 off = (*this)(q) - d, a = ((*this)(q + glm::dvec2(kStep, 0)) - (*this)(q - glm::dvec2(kStep, 0))) / (2.0 * kStep),
                       b = ((*this)(q + glm::dvec2(0, kStep)) - (*this)(q - glm::dvec2(0, kStep))) / (2.0 * kStep);
      const double det = a.x * b.y - a.y * b.x;
      const glm::dvec2 step((off.x * b.y - off.y * b.x) / det, (a.x * off.y - a.y * off.x) / det);
      q -= step;
      if (glm::dot(step, step) < 1e-26) break;
    }
    return q;
  }
};

class DistortionStage final : public SensorStage {
 public:
  DistortionStage(const Brown& brown, double cellAtOne_m, double focalLength_m) : brown_(brown), pitch_m_(cellAtOne_m), focal_m_(focalLength_m) {}

  void run(const SensorTick& tick, SensorPictures& pictures) override {
    const double focal = tick.focalLength_m > 0.0 ? tick.focalLength_m : focal_m_;
    follow(focal, pictures);
    const double cell = pitch_m_ / pictures.cells / focal;
    const glm::dvec2 middle(0.5 * pictures.width, 0.5 * pictures.height);
    for (SensorPoint& p : pictures.points) {
      const glm::dvec2 at = brown_((glm::dvec2(p.column, p.row) - middle) * cell) / cell + middle;
      p.column = at.x, p.row = at.y;
    }
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      std::vector<float>& picture = pictures.values(o);
      const std::vector<float> from = picture;
      const bool addsUp = pictures.outputs[o].perEtendue;
      sideBySide(pictures.height, [&](int first, int last) {
        for (int y = first; y < last; ++y)
          for (int x = 0; x < pictures.width; ++x) {
            const auto c = static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(x);
            const Source& s = sources_[c];
            picture[c] = static_cast<float>(between(from, s.x, s.y, pictures.width, pictures.height) * (addsUp ? static_cast<double>(s.area) : 1.0));
          }
      });
    }
  }

 private:
  /// Where a cell's light comes from [cells], and how much of the picture before lies on it.
  struct Source {
    float x, y, area;
  };
  void follow(double focal, const SensorPictures& pictures) {
    if (focal == knownFocal_m_ && sources_.size() == static_cast<std::size_t>(pictures.width) * static_cast<std::size_t>(pictures.height)) return;
    knownFocal_m_ = focal;
    const double cell = pitch_m_ / pictures.cells / focal;
    const glm::dvec2 middle(0.5 * pictures.width, 0.5 * pictures.height);
    sources_.resize(static_cast<std::size_t>(pictures.width) * static_cast<std::size_t>(pictures.height));
    // What the scenario's own focal length allows another may not: a lens that zooms out.
    const glm::dvec2 corner =
        0.5 * glm::dvec2(pictures.width - 2 * pictures.margin_px * pictures.cells, pictures.height - 2 * pictures.margin_px * pictures.cells) * cell;
    const glm::dvec2 from = brown_.inverse(corner), reach = 0.5 * glm::dvec2(pictures.width, pictures.height) * cell;
    bool folds = !(glm::length(brown_(from) - corner) < 1e-9) || !(std::abs(from.x) <= reach.x + cell && std::abs(from.y) <= reach.y + cell);
    for (int k = 1; k <= 64 && !folds; ++k) folds = !(brown_.rises(glm::length(from) * k / 64) > 0.0);
    if (folds)
      throw UserError(
          {"stage 'distortion'", 0, 0, -1},
          "at a focal length of " + std::to_string(1e3 * focal) + " mm the distortion folds the picture over, or needs more than was drawn around the film",
          "coefficients that hold for every focal length that commands set", "lower them, or zoom less far out");
    sideBySide(pictures.height, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        for (int x = 0; x < pictures.width; ++x) {
          const glm::dvec2 q = brown_.inverse((glm::dvec2(x + 0.5, y + 0.5) - middle) * cell), at = q / cell + middle;
          constexpr double kStep = 1e-5;
          const glm::dvec2 a = (brown_(q + glm::dvec2(kStep, 0)) - brown_(q - glm::dvec2(kStep, 0))) / (2.0 * kStep),
                           b = (brown_(q + glm::dvec2(0, kStep)) - brown_(q - glm::dvec2(0, kStep))) / (2.0 * kStep);
          sources_[static_cast<std::size_t>(y) * static_cast<std::size_t>(pictures.width) + static_cast<std::size_t>(x)] = {
              static_cast<float>(at.x - 0.5), static_cast<float>(at.y - 0.5), static_cast<float>(1.0 / std::abs(a.x * b.y - a.y * b.x))};
        }
    });
  }
  /// Cubic through four cells each way (Keys 1981, a = -1/2), never beyond the four around it: no cell is darker or brighter than what it lies between.
  static double between(const std::vector<float>& picture, float x, float y, int width, int height) {
    const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
    const auto weights = [](double t) {
      return std::array<double, 4>{t * (-0.5 + t * (1.0 - 0.5 * t)), 1.0 + t * t * (-2.5 + 1.5 * t), t * (0.5 + t * (2.0 - 1.5 * t)), t * t * (-0.5 + 0.5 * t)};
    };
    const auto a = weights(static_cast<double>(x) - i), b = weights(static_cast<double>(y) - j);
    double sum = 0.0, low = INFINITY, high = -INFINITY;
    for (int q = 0; q < 4; ++q)
      for (int p = 0; p < 4; ++p) {
        const double v = static_cast<double>(picture[static_cast<std::size_t>(std::clamp(j + q - 1, 0, height - 1)) * static_cast<std::size_t>(width) +
                                                     static_cast<std::size_t>(std::clamp(i + p - 1, 0, width - 1))]);
        sum += a[static_cast<std::size_t>(p)] * b[static_cast<std::size_t>(q)] * v;
        if (p == 1 || p == 2)
          if (q == 1 || q == 2) low = std::min(low, v), high = std::max(high, v);
      }
    return std::clamp(sum, low, high);
  }

  Brown brown_;
  double pitch_m_, focal_m_, knownFocal_m_ = 0.0;
  std::vector<Source> sources_;
};

StageChoice readDistortion(const Record& r, const Camera& camera) {
  const Pinhole& p = camera.pinhole;
  if (std::abs(p.pitchX_m / p.pitchY_m - 1.0) > 1e-9)
    throw UserError(r.where(), "a distortion on pixels that are not square", "'pitch' without 'pitch_y'", "remove pitch_y, or the stage");
  const Brown brown{r.number("k1"), r.number("k2"), r.number("k3"), r.number("p1"), r.number("p2")};
  StageChoice choice;
  choice.cells = static_cast<int>(r.integer("cells"));
  const double pixel = p.pitchX_m / p.focalLength_m;
  const glm::dvec2 half(0.5 * p.width * pixel, 0.5 * p.height * pixel);
  // All around the film's edge, how far beyond it light comes from.
  double beyond = 0.0;
  constexpr int kSteps = 64;
  for (int k = 0; k <= kSteps; ++k)
    for (const glm::dvec2& edge : {glm::dvec2(half.x * (2.0 * k / kSteps - 1.0), half.y), glm::dvec2(half.x * (2.0 * k / kSteps - 1.0), -half.y),
                                   glm::dvec2(half.x, half.y * (2.0 * k / kSteps - 1.0)), glm::dvec2(-half.x, half.y * (2.0 * k / kSteps - 1.0))}) {
      const glm::dvec2 q = brown.inverse(edge), back = brown(q);
      if (!(glm::length(back - edge) < 1e-9) || !(glm::length(q) < 30.0))
        throw UserError(r.where(), "a distortion that reaches no light for the film's edge", "coefficients whose r_d covers the film", "lower them");
      for (int s = 1; s <= kSteps; ++s)
        if (!(brown.rises(glm::length(q) * s / kSteps) > 0.0))
          throw UserError(r.where(), "a distortion that folds the picture over within the film", "r_d that rises with r", "lower its coefficients");
      beyond = std::max({beyond, std::abs(q.x) - half.x, std::abs(q.y) - half.y});
    }
  choice.margin_px = static_cast<int>(std::ceil(beyond / pixel)) + 1;
  choice.place = [brown](const glm::dvec2& film_m, double focal_m) {
    const glm::dvec2 at = brown(glm::dvec2(film_m.x, -film_m.y) / focal_m) * focal_m;
    return glm::dvec2(at.x, -at.y);
  };
  choice.make = [brown, pitch = p.pitchX_m, focal = p.focalLength_m](const ShaderLibrary&) { return std::make_unique<DistortionStage>(brown, pitch, focal); };
  return choice;
}

Parameter coefficient(const char* key, const char* description) { return withDefault(within(number(key, "", description), -100.0, 100.0), "0"); }

}  // namespace

StageModel distortionModel() {
  return {"distortion",
          "The lens draws the picture out or in: x_d = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2), y_d alike; x to the right, y down, in "
          "tangents from "
          "the axis (Brown 1966, OpenCV's signs). Before `point_spread`, where there is one. Truth layers stay a pinhole's; positions of targets follow it.",
          {coefficient("k1", "radial; below 0: barrel"), coefficient("k2", "radial"), coefficient("k3", "radial"), coefficient("p1", "tangential"),
           coefficient("p2", "tangential"), withDefault(integer("cells", "cells a side of a pixel", 1, 16), "2")},
          readDistortion};
}

}  // namespace pitviper
