// Sunlight scattered once: closed forms of a plane layer, energy, the earth's shadow, a march by brute force, and published sky radiances.
#include <gtest/gtest.h>

#include <cmath>
#include <ctime>
#include <filesystem>
#include <numeric>
#include <sstream>

#include "atmosphere/modtran_files.hpp"
#include "atmosphere/scattered_sun.hpp"
#include "atmosphere/tape7.hpp"
#include "atmosphere/tape7_spectra.hpp"
#include "sim/radiometry/constants.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/quadrature.hpp"
#include "tests/support/figures.hpp"

namespace pitviper::test {
namespace {

constexpr double kEarth_m = 6371230.0;
// Flat: 10 km of air change a slant path by less than 1e-6.
constexpr double kFlat_m = 6e10;

std::shared_ptr<const AbsorberTable> made(const std::string& text) {
  std::istringstream in("pitviper-air 1\n" + text);
  return std::make_shared<const AbsorberTable>(AbsorberTable::read(in, "made"));
}

// 10 km of even air: molecules, haze and a gas of these vertical optical depths.
std::shared_ptr<const AbsorberTable> layer(double molecules, double haze, double albedo, double gas, double temperature_K = 280.0) {
  std::ostringstream t;
  t.precision(17);
  t << "amount m 1 scattering\namount h 1 haze\namount g 1 gas\n";
  for (const char* height : {"0", "10000"}) t << "level " << height << " " << temperature_K << " 1 1 1\n";
  for (const char* nu : {"800", "25000"}) t << "bin " << nu << " " << albedo << " " << molecules / 10 << " " << haze / 10 << " " << gas / 10 << "\n";
  return made(t.str());
}

std::shared_ptr<const AbsorberTable> standardAir() {
  static const auto air =
      std::make_shared<const AbsorberTable>(AbsorberTable::read(std::filesystem::path(PITVIPER_SOURCE_DIR) / "atmosphere/library/us76_rural.air"));
  return air;
}

const ScatteredSun& standardSky() {
  static const ScatteredSun sky(standardAir(), kEarth_m);
  return sky;
}

// A black body of 5772 K, 6.7943e-5 sr: 1361 W/m2 in all.
double solarIrradiance(double wavelength_um) { return 6.7943e-5 * physics::planckRadiance(wavelength_um, 5772.0); }

double degrees(double d) { return d * kPi / 180.0; }

TEST(ScatteredSun, PhaseFunctionsLoseNothing) {
  for (double g : {-0.5, 0.0, 0.3, 0.663, 0.85}) {
    double sum = 0.0, cosine = 0.0;
    for (const QuadratureNode& n : gaussLegendre(200, -1.0, 1.0)) {
      sum += 2.0 * kPi * n.weight * physics::henyeyGreensteinPhase(n.x, g);
      cosine += 2.0 * kPi * n.weight * n.x * physics::henyeyGreensteinPhase(n.x, g);
    }
    EXPECT_NEAR(sum, 1.0, 1e-12) << g;
    EXPECT_NEAR(cosine, g, 1e-12) << g;  // what the asymmetry means
  }
  double rayleigh = 0.0;
  for (const QuadratureNode& n : gaussLegendre(4, -1.0, 1.0)) rayleigh += 2.0 * kPi * n.weight * physics::rayleighPhase(n.x);
  EXPECT_NEAR(rayleigh, 1.0, 1e-14);
  EXPECT_DOUBLE_EQ(physics::henyeyGreensteinPhase(0.4, 0.0), 1.0 / (4.0 * kPi));
}

// Chandrasekhar 1960: of a layer of depth t, albedo w, phase P [1/sr], sun at mu0, seen at mu:
//   from below  L = E w P mu0 / (mu0 - mu) (exp(-t/mu0) - exp(-t/mu)),   from above  L = E w P mu0 / (mu0 + mu) (1 - exp(-t (1/mu + 1/mu0))).
TEST(ScatteredSun, PlaneLayersAreChandrasekhars) {
  double worst = 0.0;
  const auto check = [&](double molecules, double haze, double albedo, double gas, double asymmetry) {
    const double t = molecules + haze + gas;
    const ScatteredSun sky(layer(molecules, haze, albedo, gas), kFlat_m, Spectrum(asymmetry));
    for (double mu0 : {1.0, 0.6, 0.2})
      for (double mu : {1.0, 0.600001, 0.45, 0.12})
        for (double azimuth : {0.0, 1.0, kPi}) {
          const double across = std::sqrt((1 - mu * mu) * (1 - mu0 * mu0)) * std::cos(azimuth);
          const auto source = [&](double c) {
            return (molecules * physics::rayleighPhase(c) + albedo * haze * physics::henyeyGreensteinPhase(c, asymmetry)) / t;
          };
          const double below = std::abs(mu - mu0) < 1e-12 ? t / mu * std::exp(-t / mu) : mu0 / (mu0 - mu) * (std::exp(-t / mu0) - std::exp(-t / mu));
          const double above = mu0 / (mu0 + mu) * -std::expm1(-t * (1.0 / mu + 1.0 / mu0));
          const double up = sky.scatteredRadiance(1.0, sky.path({0.0, mu, azimuth, mu0}, INFINITY), 7.0);
          const double down = sky.scatteredRadiance(1.0, sky.pathToEnd({10000.0, -mu, azimuth, mu0}), 7.0);
          worst = std::max(
              {worst, std::abs(up / (7.0 * source(across + mu * mu0) * below) - 1.0), std::abs(down / (7.0 * source(across - mu * mu0) * above) - 1.0)});
        }
  };
  check(0.3, 0.0, 1.0, 0.0, 0.0);
  check(1e-5, 0.0, 1.0, 0.0, 0.0);
  check(0.0, 0.01, 1.0, 0.0, 0.0);
  check(0.0, 2.5, 0.7, 0.0, 0.6);
  check(0.2, 0.5, 0.9, 0.7, 0.65);
  // Both the camera's distance to the layer's top and its curvature: 1e4 m / 6e10 m / 0.12^2; differences of nearly equal exponentials.
  bound("single scattering of plane layers against Chandrasekhar's closed forms, relative", worst, 1e-4, "curvature 1e-5 of an optical depth up to 27");
}

TEST(ScatteredSun, ThinAirScattersWhatItTakes) {
  // Flux through both faces = scattering optical depth x irradiance, whatever the phase function and the sun.
  double worst = 0.0;
  for (double g : {0.0, 0.65})
    for (double mu0 : {1.0, 0.4}) {
      const double molecules = 4e-7, haze = 6e-7, albedo = 0.8;
      const ScatteredSun sky(layer(molecules, haze, albedo, 0.0), kFlat_m, Spectrum(g));
      double flux = 0.0;
      for (const QuadratureNode& mu : gaussLegendre(24, 0.0, 1.0))
        for (int i = 0; i < 48; ++i) {
          const double azimuth = kPi * (i + 0.5) / 48, weight = 2.0 * kPi / 48 * mu.weight * mu.x;
          flux += weight * sky.scatteredRadiance(1.0, sky.path({0.0, mu.x, azimuth, mu0}, INFINITY), 1.0);
          flux += weight * sky.scatteredRadiance(1.0, sky.pathToEnd({10000.0, -mu.x, azimuth, mu0}), 1.0);
        }
      worst = std::max(worst, std::abs(flux / (molecules + albedo * haze) - 1.0));
    }
  bound("thin air: scattered flux over scattering depth x irradiance, less 1", worst, 1e-4, "depth 1e-6 over the lowest sine 2e-3; quadrature");
}

TEST(ScatteredSun, AllExtinctionEmits) {
  // What haze scatters out of a line in air of one temperature it scatters in again, whatever its albedo: Kirchhoff's B (1 - tau).
  const double b = physics::planckRadiance(10.0, 280.0);
  for (double albedo : {0.0, 0.4, 1.0})
    for (double e : {0.05, 1.0}) {
      const ScatteredSun sky(layer(0.0, 0.8, albedo, 0.3), kEarth_m, Spectrum(0.7));
      const auto path = sky.path({0.0, e, 0.0, -0.9}, INFINITY);
      EXPECT_NEAR(sky.radiance(10.0, path, 1e3) / (b * (1.0 - sky.transmittance(10.0, path))), 1.0, 1e-9) << albedo << " " << e;
    }
  // With or without what scatters, as AbsorberTable has it.
  for (double haze : {0.0, 0.5}) {
    const ScatteredSun sky(layer(haze, haze, 0.9, 0.7), kEarth_m);
    EXPECT_NEAR(sky.thermalRadiance(9.0, sky.path({0.0, 0.3, 0.0, 0.5}, INFINITY)),
                sky.air().pathRadiance(9.0, sky.air().stations(0.0, 0.3, INFINITY, kEarth_m, 24)), 1e-12);
  }
}

TEST(ScatteredSun, NothingComesOutOfTheShadow) {
  const ScatteredSun& sky = standardSky();
  const auto zenith = [&](double sun_deg) { return sky.scatteredRadiance(0.7, sky.pathToEnd({0.0, 1.0, 0.0, std::sin(degrees(sun_deg))}), 1.0); };
  // The shadow reaches the top of the air, 100 km, over a camera at acos(R / (R + 100 km)) = 10.08 degrees.
  EXPECT_EQ(zenith(-10.2), 0.0);
  EXPECT_GT(zenith(-9.5), 0.0);
  // Twilight falls, evenly through sunset.
  double before = zenith(5.0);
  for (double sun : {2.0, 0.5, -0.5, -2.0, -4.0, -6.0, -8.0}) {
    EXPECT_LT(zenith(sun), before) << sun;
    before = zenith(sun);
  }
  EXPECT_NEAR(zenith(1e-4) / zenith(-1e-4), 1.0, 1e-3);
  EXPECT_LT(zenith(-6.0), 0.01 * zenith(1.0));
  EXPECT_GT(sky.directSun(2.2, 0.0, 0.0, 1.0), 0.0);
  EXPECT_EQ(sky.directSun(2.2, 0.0, -1e-3, 1.0), 0.0);
  EXPECT_GT(sky.directSun(2.2, 9000.0, std::sin(degrees(-2.0)), 1.0), 0.0);
  // Towards where the sun went down the sky is brighter.
  const auto low = [&](double azimuth) { return sky.scatteredRadiance(0.7, sky.pathToEnd({0.0, 0.1, azimuth, std::sin(degrees(-4.0))}), 1.0); };
  EXPECT_GT(low(0.0), 10.0 * low(kPi));
}

// By small steps, amounts of both legs added: nothing in common with the stations but the air's densities.
double marched(double wavelength_um, const SunlitView& v, double range_m, int steps) {
  const AbsorberTable& air = *standardAir();
  const auto c = air.coefficients(wavelength_um);
  const double r0 = kEarth_m + v.height_m, cosView = std::sqrt(1 - v.sinElevation * v.sinElevation),
               cosSun = std::sqrt(1 - v.sinSunElevation * v.sinSunElevation);
  const double cosine = cosView * cosSun * std::cos(v.azimuthFromSun_rad) + v.sinElevation * v.sinSunElevation;
  double sum = 0.0;
  AbsorberAmounts view;
  for (int i = 0; i < steps; ++i) {
    // Steps growing with the square of their number: short near the camera.
    const double s0 = range_m * i * i / steps / steps, s1 = range_m * (i + 1.0) * (i + 1.0) / steps / steps, s = 0.5 * (s0 + s1);
    const double r = std::sqrt(r0 * r0 + 2 * r0 * s * v.sinElevation + s * s), height = r - kEarth_m, step_km = 1e-3 * (s1 - s0);
    AbsorberAmounts half = air.densities(height);
    for (double& w : half.amount_km) w *= 0.5 * step_km;
    view += half;
    const double sunSine = (r0 * v.sinSunElevation + s * cosine) / r;
    const AbsorberAmounts both = view + air.amounts(height, sunSine, INFINITY, kEarth_m);
    double depth = 0.0, source = 0.0;
    for (size_t k = 0; k < air.absorbers().size(); ++k) {
      depth += c[k] * std::pow(both.amount_km[k], air.absorbers()[k].exponent);
      const double scattered = c[k] * 2.0 * half.amount_km[k];
      if (air.absorbers()[k].kind == AbsorberKind::Scattering) source += physics::rayleighPhase(cosine) * scattered;
      if (air.absorbers()[k].kind == AbsorberKind::Haze || air.absorbers()[k].kind == AbsorberKind::Aerosol)
        source += air.hazeAlbedo(wavelength_um) * physics::henyeyGreensteinPhase(cosine, ruralAsymmetry()(wavelength_um)) * scattered;
    }
    sum += source * std::exp(-depth);
    view += half;
  }
  return sum;
}

TEST(ScatteredSun, IsWhatAMarchGives) {
  double windows = 0.0, bands = 0.0;
  for (const auto& [view, range] : {std::pair{SunlitView{0.0, 0.9, 0.4, 0.5}, 110e3},
                                    {SunlitView{0.0, 0.05, 2.0, 0.7}, 800e3},
                                    {SunlitView{200.0, 0.0, 1.0, 0.3}, 15e3},
                                    {SunlitView{9000.0, -0.5, 0.2, 0.15}, 17e3}}) {
    const auto path = standardSky().path(view, range);
    const auto error = [&](double um) { return std::abs(standardSky().scatteredRadiance(um, path, 1.0) / marched(um, view, range, 3000) - 1.0); };
    for (double um : {0.45, 0.76, 1.0, 3.9, 10.0}) windows = std::max(windows, error(um));
    for (double um : {2.7, 4.5}) bands = std::max(bands, error(um));  // legs that do not multiply, and little light
  }
  bound("scattered sunlight of the standard air against a march of 3000 steps, windows, relative", windows, 3e-3, "32 stations");
  bound("the same in opaque bands, 2.7 and 4.5 um", bands, 4e-2, "32 stations; a quarter of it with 64");
}

TEST(ScatteredSun, ConvergesAsStated) {
  double stations = 0.0, dome = 0.0;
  const double wavelengths[] = {0.55, 1.0, 4.0, 10.0};
  const ScatteredSun& sky = standardSky();
  for (double sun : {degrees(6.0), degrees(30.0), degrees(80.0)})
    for (double e : {0.02, 0.2, 0.7, 1.0})
      for (double azimuth : {0.0, 1.5, kPi}) {
        const SunlitView view{0.0, e, azimuth, std::sin(sun)};
        const auto coarse = sky.pathToEnd(view), fine = sky.pathToEnd(view, 300);
        for (double um : wavelengths)
          stations = std::max(stations, std::abs(sky.radiance(um, coarse, solarIrradiance(um)) / sky.radiance(um, fine, solarIrradiance(um)) - 1.0));
      }
  for (double sun : {degrees(10.0), degrees(50.0)}) {
    const auto coarse = sky.dome(0.0, std::sin(sun)), fine = sky.dome(0.0, std::sin(sun), 24, 36);
    EXPECT_NEAR(std::accumulate(coarse.weights.begin(), coarse.weights.end(), 0.0), 1.0, 1e-12);
    for (double um : wavelengths)
      dome = std::max(dome, std::abs(sky.meanSky(um, coarse, solarIrradiance(um)) / sky.meanSky(um, fine, solarIrradiance(um)) - 1.0));
  }
  bound("sky radiance, 32 stations against 300, relative", stations, 3e-3, "log-linear between stations");
  bound("mean sky, 10 x 12 views against 24 x 36, relative", dome, 1e-2, "the aureole between views");
}

TEST(ScatteredSun, MeanSkyOfAUniformDome) {
  // Opaque isothermal gas: the sky is a black body, so is its mean.
  const ScatteredSun sky(layer(0.0, 0.0, 0.0, 800.0), kEarth_m);
  EXPECT_NEAR(sky.meanSky(10.0, sky.dome(0.0, 0.5), 1.0) / physics::planckRadiance(10.0, 280.0), 1.0, 1e-12);
}

// Published skies: orders of magnitude. Haze differs from day to day, and light that is scattered again or comes from the ground is missing here,
// so the visible sky must come out darker than published, by less than four times.
TEST(ScatteredSun, TheVisibleSkyIsDarkerThanPublishedByItsFurtherScattering) {
  const ScatteredSun& sky = standardSky();
  // Luminance of the zenith, clear sky of turbidity T: (4.0453 T - 4.971) tan((4/9 - T/120)(pi - 2 zenith)) - 0.2155 T + 2.4192 kcd/m2. Source:
  // Preetham, Shirley and Smits 1999, A practical analytic model for daylight, appendix. T = 2 is very clear, 3 clear.
  const double turbidity = 2.0, zenith = degrees(60.0);
  const double published =
      1e3 * ((4.0453 * turbidity - 4.971) * std::tan((4.0 / 9.0 - turbidity / 120.0) * (kPi - 2.0 * zenith)) - 0.2155 * turbidity + 2.4192);
  const auto up = sky.pathToEnd({0.0, 1.0, 0.0, std::cos(zenith)});
  double luminance = 0.0;
  for (double um = 0.40; um < 0.7; um += 0.005)  // V(lambda), Gaussian: within 3 % of its integrals
    luminance += 0.005 * kLuminousEfficacy * 1.019 * std::exp(-285.4 * (um - 0.559) * (um - 0.559)) * sky.radiance(um, up, solarIrradiance(um));
  EXPECT_LT(luminance, published);
  bound("luminance of the zenith, sun at 30 degrees: Preetham 1999 (turbidity 2) over single scattering", published / luminance, 4.0, "further scattering");

  // Peak spectral radiance of the north horizon at noon, 30 km of visibility or more: 5 uW/(cm2 sr nm) = 50 W/(m2 sr um). Source: Applied Optics 6
  // (1967) 2105, Measurements of spectral radiance of the horizon sky.
  AbsorberTable clear = *standardAir();
  clear.setVisibility(30.0);
  const ScatteredSun day(std::make_shared<const AbsorberTable>(clear), kEarth_m);
  const auto north = day.pathToEnd({0.0, std::sin(degrees(1.0)), kPi, std::sin(degrees(45.0))});
  double peak = 0.0;
  for (double um = 0.41; um < 1.0; um += 0.01) peak = std::max(peak, day.radiance(um, north, solarIrradiance(um)));
  EXPECT_LT(peak, 50.0);
  bound("horizon away from the sun: measured 50 W/(m2 sr um) (Applied Optics 6, 2105) over single scattering", 50.0 / peak, 4.0, "further scattering");
}

// MODTRAN's own scattered sunlight (SOL_SCAT), 2050-2100 1/cm, US standard air, rural haze of 23 km, isotropic haze (IPH 0, G 0), single scattering.
TEST(ScatteredSun, IsModtransInTheMidwave) {
  const char* named = std::getenv("PITVIPER_TAPE7");
  const auto folder = named ? std::filesystem::path(named) : std::filesystem::path(PITVIPER_SOURCE_DIR) / "../shared/data/tape7";
  if (!std::filesystem::exists(folder / "tape7-05")) GTEST_SKIP() << "no MODTRAN samples in " << folder << "; they are no part of the project";
  const ScatteredSun sky(standardAir(), kEarth_m, Spectrum(0.0));
  // Sun of tape7-03: observer at latitude 25, sun over latitude 23, 45 degrees of longitude to the west; line of sight to the north.
  const double a = degrees(25.0), b = degrees(23.0), away = degrees(45.0);
  const double sunSine = std::sin(a) * std::sin(b) + std::cos(a) * std::cos(b) * std::cos(away);
  const double sunNorth = (std::sin(b) - sunSine * std::sin(a)) / (std::cos(a) * std::sqrt(1 - sunSine * sunSine));
  const SunlitView slant{2000.0, std::cos(degrees(30.0)), std::acos(sunNorth), sunSine}, overhead{0.0, std::cos(degrees(20.0)), 0.0, 1.0};
  const std::pair<const char*, SunlitPath> cases[] = {{"tape7-03", sky.path(slant, 9235.9)}, {"tape7-05", sky.pathToEnd(overhead)}};
  for (const auto& [name, path] : cases) {
    const Tape7Run run = readModtran(folder / name).at(0);
    const Spectrum sun = sunAboveAir(run);
    double mine = 0.0, modtran = 0.0;
    for (size_t i = 0; i < run.wavelength_um.size(); ++i) {
      mine += sky.scatteredRadiance(run.wavelength_um[i], path, sun(run.wavelength_um[i]));
      modtran += run.find("SOL_SCAT")->value[i];
    }
    figure(std::string("scattered sunlight, 4.76-4.88 um, against MODTRAN's ") + name, mine / modtran, 1.0, 0.25,
           "MODTRAN 4's gases against LOWTRAN 7's, albedo of the haze");
  }
}

TEST(ScatteredSun, AnyGeometryGivesANumber) {
  const ScatteredSun& sky = standardSky();
  for (double height : {-400.0, 0.0, 5.0, 12000.0, 99999.0, 100001.0, 4e7})
    for (double e : {-1.0, -0.6, -1e-3, 0.0, 1e-9, 0.2, 1.0})
      for (double sun : {-1.0, -0.2, -1e-6, 0.0, 1e-6, 0.5, 1.0})
        for (double azimuth : {0.0, 1.0, kPi}) {
          const SunlitView view{height, e, azimuth, sun};
          for (const auto& path : {sky.pathToEnd(view), sky.path(view, 1000.0), sky.path(view, 0.0)})
            for (double um : {0.4, 4.26, 14.0}) {
              const double l = sky.radiance(um, path, 2000.0), tau = sky.transmittance(um, path);
              ASSERT_TRUE(std::isfinite(l) && l >= 0.0) << height << " " << e << " " << sun << " " << um << ": " << l;
              ASSERT_TRUE(tau >= 0.0 && tau <= 1.0) << height << " " << e << " " << sun << " " << um << ": " << tau;
            }
          const double direct = sky.directSun(1.0, height, sun, 1.0);
          ASSERT_TRUE(direct >= 0.0 && direct <= 1.0);
        }
  // Above the air the sky is black, and the sun at noon whole.
  EXPECT_EQ(sky.skyRadiance(0.5, {100001.0, 0.1, 0.0, 0.5}, 2000.0), 0.0);
  EXPECT_EQ(sky.directSun(0.5, 100001.0, 0.5, 2000.0), 2000.0);
}

TEST(ScatteredSun, ManyWavelengthsOfOneViewAreCheap) {
  const ScatteredSun& sky = standardSky();
  // Of the processor, in all ten turns: what else the machine does has no say.
  double geometry = 0.0, each = 0.0, sum = 0.0;
  size_t stations = 0;
  for (int turn = 0; turn < 10; ++turn) {
    const std::clock_t start = std::clock();
    const auto path = sky.pathToEnd({0.0, 0.3, 1.0, 0.5});
    const std::clock_t made = std::clock();
    for (int i = 0; i < 1000; ++i) sum += sky.radiance(0.5 + 0.01 * i, path, 1.0);
    geometry += static_cast<double>(made - start) / CLOCKS_PER_SEC;
    each += static_cast<double>(std::clock() - made) / CLOCKS_PER_SEC / 1000;
    stations = path.stations.size();
  }
  EXPECT_GT(sum, 0.0);
  std::printf("geometry of a view %.2f ms, each wavelength %.1f us, %zu stations\n", 1e2 * geometry, 1e5 * each, stations);
  EXPECT_LT(each, 0.2 * geometry);  // what is common is not done again
}

}  // namespace
}  // namespace pitviper::test
