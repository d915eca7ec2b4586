// What the sensor itself sends to its film: the lens, within the cone that the scene fills too, and what is warm around it, up to the cold stop.
// Law: at a pixel that the scene sends  scale x Omega x integral of K tau L  (K: kernel before the optics, tau: their transmission, Omega: its projected solid angle):
//   lens: scale Omega integral of K e B(T);  around it: scale Omega_axis ((F / F_stop)^2 - 1) integral of K e_h B(T_h)
// F: that of the lens, F_stop: of the cone that the cold stop leaves open (an ideal, aplanatic lens: a film in a cone of F gets pi L / (4 F^2); 0.5: all of the half space).
// Source: E. L. Dereniak and G. D. Boreman, Infrared Detectors and Systems (1996), cold shields.
#include <algorithm>
#include <cmath>

#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

struct Warm {
  double lens_K = 0.0, around_K = 0.0;
  std::optional<double> emissivity;  ///< of the lens; none: 1 - its transmission
  double aroundEmissivity = 1.0;
  double around = 0.0;  ///< etendue around the lens's, of the lens's on the axis

  /// Of an output for a pixel with a projected solid angle, and for one on the axis.
  double lens(const ChannelOutput& o) const {
    return integral(o, lens_K, [&](double w) { return emissivity ? *emissivity : 1.0 - o.curves->optics(w); });
  }
  double housing(const ChannelOutput& o) const { return around > 0.0 ? around * integral(o, around_K, [&](double) { return aroundEmissivity; }) : 0.0; }

 private:
  /// scale x integral of K e B: the kernel has the optics in it, or the scale has.
  template <class Emissivity>
  static double integral(const ChannelOutput& o, double kelvin, const Emissivity& e) {
    const Spectrum body(Spectrum::BlackBody{kelvin, 1.0});
    std::vector<double> knots = o.kernel.knots();
    for (double w : o.curves->optics.knots()) knots.push_back(w);
    std::sort(knots.begin(), knots.end());
    const auto of = [&](double w) {
      const double tau = o.curves->optics(w);
      return tau > 0.0 ? o.kernel(w) / tau * e(w) * body(w) : 0.0;
    };
    return o.scale * integrate(of, o.bandLow_um, o.bandHigh_um, knots);
  }
};

class LensEmissionStage final : public SensorStage {
 public:
  explicit LensEmissionStage(const Warm& warm) : warm_(warm) {}
  void run(const SensorTick& tick, SensorPictures& pictures) override {
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      const ChannelOutput& output = pictures.outputs[o];
      if (!output.behindOptics || !pictures.cellWeights) continue;
      const double time = output.perExposure ? tick.exposure_s : 1.0, lens = time * warm_.lens(output),
                   around = time * warm_.housing(output) * tick.axis_sr / (pictures.cells * pictures.cells);
      std::vector<float>& picture = pictures.values(o);
      for (std::size_t c = 0; c < picture.size(); ++c) picture[c] = static_cast<float>(static_cast<double>(picture[c]) + lens * (*pictures.cellWeights)[c] + around);
    }
  }

 private:
  Warm warm_;
};

}  // namespace

StageModel lensEmissionModel() {
  return {"lens_emission",
          "What the warm sensor sends to its own film: the lens by its emissivity, and its housing around the lens's cone as far as a cold stop leaves it open. Of "
          "quantities behind the optics. `apparent_temperature` takes it away again, as a calibration would; its noise stays.",
          {required(within(above(number("temperature", "K", "of the lens"), 0), 0, 2000)),
           within(number("emissivity", "", "of the lens; 1 - `optics` unless given"), 0, 1),
           within(number("stop_f_number", "", "of the cone that the cold stop leaves open, at most that of the lens; 0.5: none; unless given it is the lens's"), 0.5, 1e3),
           within(above(number("housing_temperature", "K", "of what is seen around the lens; unless given as warm as the lens"), 0), 0, 2000),
           withDefault(within(number("housing_emissivity", "", "of it"), 0, 1), "1")},
          [](const Record& r, const Camera& camera) {
            const double fNumber = camera.pinhole.focalLength_m / camera.pinhole.apertureDiameter_m;
            Warm warm;
            warm.lens_K = r.number("temperature");
            warm.around_K = r.given("housing_temperature") ? r.number("housing_temperature") : warm.lens_K;
            warm.aroundEmissivity = r.number("housing_emissivity");
            if (r.given("emissivity")) warm.emissivity = r.number("emissivity");
            if (r.given("stop_f_number")) {
              const double stop = r.number("stop_f_number");
              if (stop > fNumber * (1.0 + 1e-9))
                throw UserError(r.where("stop_f_number"), "a cold stop that cuts into the lens's cone", "at most its F number, " + std::to_string(fNumber),
                                "lower it, or narrow the aperture to what the stop leaves");
              warm.around = (fNumber / stop) * (fNumber / stop) - 1.0;
            }
            StageChoice choice;
            choice.ownLight = [warm](const ChannelOutput& o, double axis_sr) {
              return o.behindOptics ? axis_sr * (warm.lens(o) + warm.housing(o)) : 0.0;
            };
            choice.make = [warm](const ShaderLibrary&) { return std::make_unique<LensEmissionStage>(warm); };
            return choice;
          }};
}

}  // namespace pitviper
