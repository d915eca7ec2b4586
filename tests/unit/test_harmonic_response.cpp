// Lobes as the law of light from all around has them: a lobe of Gauss of known aim, widths and strength comes back as it was made.
#include <gtest/gtest.h>

#include <cmath>

#include "sim/model/harmonic_response.hpp"
#include "sim/radiometry/constants.hpp"
#include "tests/support/figures.hpp"
#include "tests/support/print.hpp"

namespace pitviper::test {
namespace {

/// f cos(theta_l): a lobe of Gauss about a direction `tilt` from the mirrored one towards the normal, `along` and `aside` of the plane of view.
class GaussLobe final : public ReflectionComponent {
 public:
  GaussLobe(double tilt, double along, double aside)
      : ReflectionComponent({"a lobe", "a lobe", {}, 1.0, 1.0 / (std::max(along, aside) * std::max(along, aside))}),
        tilt_(tilt),
        along_(along),
        aside_(aside) {}
  double column(double, double, double) const override { return 1.0; }
  double lobeAt(const glm::dvec3& light, const glm::dvec3& view) const override {
    const double angle = std::acos(view.z) - tilt_;
    const glm::dvec3 aim(-std::sin(angle), 0.0, std::cos(angle)), up(std::cos(angle), 0.0, std::sin(angle));
    const double u = std::atan2(glm::dot(light, up), glm::dot(light, aim)), w = std::asin(light.y);
    return std::exp(-0.5 * (u * u / (along_ * along_) + w * w / (aside_ * aside_))) / light.z;
  }
  bool hemisphericalVaries() const override { return true; }
  std::vector<double> knots_um() const override { return {}; }
  double validLow_um() const override { return 0.1; }
  double validHigh_um() const override { return 1000.0; }

 private:
  double tilt_, along_, aside_;
};

TEST(HarmonicResponse, ALobeOfGaussIsToldAsItIs) {
  const std::vector<double> one{1.0};
  for (const auto& [tilt, along, aside] :
       {std::tuple{0.0, 0.08, 0.08}, std::tuple{0.06, 0.12, 0.07}, std::tuple{-0.04, 0.05, 0.09}, std::tuple{0.02, 0.02, 0.02}}) {
    const GaussLobe lobe(tilt, along, aside);
    const HarmonicResponse response(lobe, 4, one);
    constexpr int kView = 40;
    const auto& aim = response.aim(kView);
    const double v1 = along * along, v2 = aside * aside, v = 0.5 * (v1 + v2), strength = 2.0 * kPi * along * aside;
    const std::string what = print("a lobe of %g x %g rad, tilted by %g: ", along, aside, tilt);
    bound(what + "its aim off [rad]", std::abs(aim.tilt_rad - tilt), 0.001 * along, "light comes evenly from both sides; the sphere bends by a lobe's square");
    bound(what + "its stretch off", std::abs(aim.stretch - (v1 - v2) / (v1 + v2)), 0.01, "moments of a few degrees on the sphere, laws of the plane");
    const Response r = response.at(kView, one, false);
    figure(what + "its strength", r.back(), strength, 0.01, "2 pi times both widths");
    figure(what + "its blur", r.front() / r.back(), blurNumber(v), 0.01, "its mean variance, by number");
  }
}

// What a sharp lobe leaves to its harmonics is what blurred light has of none of them.
TEST(HarmonicResponse, SharpLobesTakeTheirHarmonicsOut) {
  const std::vector<double> one{1.0};
  const GaussLobe lobe(0.0, 0.02, 0.02);
  const HarmonicResponse response(lobe, 4, one);
  EXPECT_TRUE(response.isSharp());
  EXPECT_FALSE(HarmonicResponse(GaussLobe(0.0, 0.2, 0.2), 4, one).isSharp());
  const Response whole = response.at(40, one, false), left = response.at(40, one, true);
  double before = 0.0, after = 0.0;
  for (size_t k = 1; k < kPlaneWeights; ++k) before = std::max(before, std::abs(whole[k])), after = std::max(after, std::abs(left[k]));
  bound("harmonics of a lobe of 0.02 rad beyond its blurred light, of all of them", after / before, 0.02, "a lobe of Gauss is D exp(-l (l + 1) v / 2)");
}

// Numbers of blurs and variances are each other.
TEST(HarmonicResponse, BlursByNumberDouble) {
  EXPECT_EQ(blurOf_rad(0), 0.0);
  for (int n = 1; n < kBlurs; ++n) {
    EXPECT_NEAR(blurOf_rad(n), kFirstBlur_rad * std::pow(2.0, 0.5 * (n - 1)), 1e-12);
    EXPECT_NEAR(blurNumber(blurOf_rad(n) * blurOf_rad(n)), n, 1e-9);
  }
  EXPECT_NEAR(blurNumber(0.0), 0.0, 1e-12);
  EXPECT_NEAR(blurNumber(10.0), kBlurs - 1, 1e-12);
}

}  // namespace
}  // namespace pitviper::test
