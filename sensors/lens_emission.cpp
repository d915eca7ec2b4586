// What the sensor itself sends to its film: the lens, within the cone that the scene fills too, and what is warm around it, up to the cold stop.
// Law: at a pixel that the scene sends  scale x Omega x integral of K tau L  (K: kernel before the optics, tau: their transmission, Omega: its projected solid
// angle):
//   lens: scale Omega integral of K e B(T);  around it: scale Omega_axis ((F / F_stop)^2 - 1) integral of K e_h B(T_h)
// F: that of the lens, F_stop: of the cone that the cold stop leaves open (an ideal, aplanatic lens: a film in a cone of F gets pi L / (4 F^2); 0.5: all of the
// half space). Source: E. L. Dereniak and G. D. Boreman, Infrared Detectors and Systems (1996), cold shields.
#include <algorithm>
#include <map>

#include "sensors/stages.hpp"
#include "sim/camera/sensor_stage.hpp"
#include "sim/radiometry/quadrature.hpp"

namespace pitviper {
namespace {

struct Warm {
  double lens_K = 0.0, around_K = 0.0;
  std::optional<double> emissivity;  ///< of the lens; none: 1 - its transmission
  double aroundEmissivity = 1.0;
  double stop = 0.0;  ///< F number of the cone that is open; 0: the lens's
  double pixelArea_m2 = 0.0, aperture_m = 1.0;

  /// Of an output, by projected solid angle of a pixel.
  double lens(const ChannelOutput& o) const {
    return integral(o, lens_K, [&](double w) { return emissivity ? *emissivity : 1.0 - o.curves->optics(w); });
  }
  /// The same on the axis, around the lens. A pixel's solid angle there says how long the lens is now: area / f^2.
  double housing(const ChannelOutput& o, double axis_sr) const {
    if (!(stop > 0.0)) return 0.0;
    const double fNumber2 = pixelArea_m2 / axis_sr / (aperture_m * aperture_m), around = std::max(0.0, fNumber2 / (stop * stop) - 1.0);
    return around * integral(o, around_K, [&](double) { return aroundEmissivity; });
  }

 private:
  /// scale x integral of K e B.
  template <class Emissivity>
  static double integral(const ChannelOutput& o, double kelvin, const Emissivity& e) {
    const Spectrum body(Spectrum::BlackBody{kelvin, 1.0});
    std::vector<double> knots = o.onFilm.knots();
    for (double w : o.curves->optics.knots()) knots.push_back(w);
    std::sort(knots.begin(), knots.end());
    return o.onFilmScale *
           integrate([&](double w) { return o.onFilm(w) * e(w) * body(w); }, o.curves->response.supportLow(), o.curves->response.supportHigh(), knots);
  }
};

class LensEmissionStage final : public SensorStage {
 public:
  explicit LensEmissionStage(const Warm& warm) : warm_(warm) {}
  void run(const SensorTick& tick, SensorPictures& pictures) override {
    for (std::size_t o = 0; o < pictures.outputs.size(); ++o) {
      const ChannelOutput& output = pictures.outputs[o];
      if (!output.behindOptics || !pictures.cellWeights) continue;
      if (tick.axis_sr != knownFor_sr_) known_.clear(), knownFor_sr_ = tick.axis_sr;
      const auto [at, isNew] = known_.try_emplace(o, 0.0, 0.0);
      if (isNew) at->second = {warm_.lens(output), warm_.housing(output, tick.axis_sr)};
      const double time = output.perExposure ? tick.exposure_s : 1.0, lens = time * at->second.first,
                   around = time * at->second.second * tick.axis_sr / (pictures.cells * pictures.cells);
      std::vector<float>& picture = pictures.values(o);
      for (std::size_t c = 0; c < picture.size(); ++c)
        picture[c] = static_cast<float>(static_cast<double>(picture[c]) + lens * (*pictures.cellWeights)[c] + around);
    }
  }

 private:
  Warm warm_;
  double knownFor_sr_ = 0.0;
  std::map<std::size_t, std::pair<double, double>> known_;  ///< by output
};

}  // namespace

StageModel lensEmissionModel() {
  return {
      "lens_emission",
      "What the warm sensor sends to its own film: the lens by its emissivity, and its housing around the lens's cone as far as a cold stop leaves it open. Of "
      "quantities behind the optics. `apparent_temperature` takes it away again, as a calibration would; its noise stays.",
      {required(within(above(number("temperature", "K", "of the lens", &Warm::lens_K), 0), 0, 2000)),
       within(number("emissivity", "", "of the lens; 1 - `optics` unless given", &Warm::emissivity), 0, 1),
       within(number("stop_f_number", "", "of the cone that the cold stop leaves open, at most that of the lens; 0.5: none; unless given it is the lens's"),
              0.5, 1e3),
       within(above(number("housing_temperature", "K", "of what is seen around the lens; unless given as warm as the lens", &Warm::around_K), 0), 0, 2000),
       withDefault(within(number("housing_emissivity", "", "of it", &Warm::aroundEmissivity), 0, 1), "1")},
      [](const Record& r, const Camera& camera) {
        const double fNumber = camera.pinhole.focalLength_m / camera.pinhole.apertureDiameter_m;
        Warm warm;
        r.fill(warm);
        if (!r.given("housing_temperature")) warm.around_K = warm.lens_K;
        if (r.given("stop_f_number")) {
          const double stop = r.number("stop_f_number");
          if (stop > fNumber * (1.0 + 1e-9))
            throw UserError(r.where("stop_f_number"), "a cold stop that cuts into the lens's cone", "at most its F number, " + std::to_string(fNumber),
                            "lower it, or narrow the aperture to what the stop leaves");
          warm.stop = stop;
        }
        warm.pixelArea_m2 = camera.pinhole.pitchX_m * camera.pinhole.pitchY_m;
        warm.aperture_m = camera.pinhole.apertureDiameter_m;
        StageChoice choice;
        choice.ownLight = [warm](const ChannelOutput& o, double axis_sr) { return o.behindOptics ? axis_sr * (warm.lens(o) + warm.housing(o, axis_sr)) : 0.0; };
        choice.make = [warm](const ShaderLibrary&) { return std::make_unique<LensEmissionStage>(warm); };
        return choice;
      }};
}

}  // namespace pitviper
