#include "sensors/figures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "sim/radiometry/constants.hpp"

namespace pitviper {

SensorFigures figuresOf(const Camera& camera, const ChannelOutput& output, double step_s, double kelvin) {
  const Pinhole& p = camera.pinhole;
  const double exposure_s = camera.exposureOf(output.channel);
  SensorFigures figures;
  figures.ifov_rad = p.pitchX_m / p.focalLength_m;
  figures.mtfAtNyquist = figures.drawnMtf = 2.0 / kPi;  // sinc(1/2) of a whole pixel
  const DetectorLaw* law = detectorOf(camera, output.channel);
  for (const StageChoice& s : camera.stagesOf(output.channel)) {
    if (s.drawnTransfer) figures.drawnMtf *= s.drawnTransfer(output, 0.5 / p.pitchX_m);
    if (s.transfer) figures.mtfAtNyquist *= s.transfer(output, 0.5 / p.pitchX_m);
  }
  if (!law || !output.detected) return figures;
  const BandTemperature band(output.kernel, output.bandLow_um, output.bandHigh_um);
  const double axis_sr = p.projectedSolidAngle_sr(p.width / 2, p.height / 2), perIntegral = law->fillFactor * output.scale * exposure_s * axis_sr,
               own = law->fillFactor * ownLightOf(camera, output, axis_sr, exposure_s);
  SensorFigures::Detected d;
  d.electronsAt300K = perIntegral * band.integral(kelvin);
  const double slope = perIntegral * band.slope(kelvin), dark = law->darkCurrent_per_s * exposure_s;
  d.electrons_per_K = slope;
  const auto square = [](double x) { return x * x; };
  // A correction at two points leaves of pixels' own bends what is not on the line through both.
  const bool isCorrected = law->correction.has_value();
  const double seen = d.electronsAt300K + own;
  double bend = law->nonlinearity * seen * seen / law->fullWell;
  if (isCorrected)
    bend = law->nonlinearity / law->fullWell *
           std::abs((d.electronsAt300K - perIntegral * band.integral(law->correction->low_K)) *
                    (d.electronsAt300K - perIntegral * band.integral(law->correction->high_K)));
  struct Noise {
    const char* name;
    double variance;
    bool isFixed;
  };
  const std::array<Noise, 13> noises{Noise{"shot noise of light", d.electronsAt300K, false},
                                     {"shot noise of dark current", dark, false},
                                     {"shot noise of the lens's own light", own, false},
                                     {"read noise", square(law->sigmaTvh), false},
                                     {"1/f noise", DetectorLaw::kFlickerOctaves * law->flickerVariance(step_s), false},
                                     {"noise of rows", square(law->sigmaTv), false},
                                     {"noise of columns", square(law->sigmaTh), false},
                                     {"noise of frames", square(law->sigmaT), false},
                                     {"steps of the converter", 1.0 / (12.0 * square(law->gain)), false},
                                     {"PRNU", isCorrected ? 0.0 : square(law->prnu * seen), true},
                                     {"DSNU", isCorrected ? 0.0 : square(law->sigmaVh), true},
                                     {"fixed rows and columns", isCorrected ? 0.0 : square(law->sigmaV) + square(law->sigmaH), true},
                                     {"what bends leave of a correction", square(bend), true}};
  double temporal = 0.0, fixed = 0.0;
  for (const Noise& n : noises) (n.isFixed ? fixed : temporal) += n.variance;
  d.limitedBy = std::max_element(noises.begin(), noises.end(), [](const Noise& a, const Noise& b) { return a.variance < b.variance; })->name;
  d.netd_K = slope > 0.0 ? std::sqrt(temporal) / slope : INFINITY;
  d.netdWithFixed_K = slope > 0.0 ? std::sqrt(temporal + fixed) / slope : INFINITY;
  d.saturation_K = law->saturation() > dark + own ? band((law->saturation() - dark - own) / perIntegral) : 20.0;
  if (d.saturation_K > 19999.0) d.saturation_K = 0.0;
  const double all = output.kernel.integral(output.bandLow_um, output.bandHigh_um);
  d.noiseEquivalent_W_m2 = std::sqrt(temporal) * (output.bandHigh_um - output.bandLow_um) / (law->fillFactor * output.scale * exposure_s * all);
  figures.detected = d;
  return figures;
}

}  // namespace pitviper
