#include "materials/film_stack.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

using Complex = std::complex<double>;

/// A medium on the way of light; components of waves in units of the vacuum wave number.
struct Medium {
  Complex index;
  double thickness_um;
  bool coherent;
  Complex across = 0.0;        ///< component across the faces
  Complex once = 0.0;          ///< of a wave, on its way from face to face: never larger than 1, however thick nothing overflows
  Complex admittance[2] = {};  ///< what joins the fields at a face: of the electric field across the plane of incidence, of the magnetic one
};

void prepare(std::vector<Medium>& media, double wavelength_um, double along) {
  const double number = 2.0 * kPi / wavelength_um;
  for (Medium& m : media) {
    const Complex squared = m.index * m.index;
    m.across = std::sqrt(squared - along * along);
    // It goes on or dies away.
    if (m.across.imag() < 0.0 || (m.across.imag() == 0.0 && m.across.real() < 0.0)) m.across = -m.across;
    m.once = m.thickness_um > 0.0 ? std::exp(Complex(0.0, number * m.thickness_um) * m.across) : 1.0;
    m.admittance[0] = m.across;
    m.admittance[1] = m.across / squared;
  }
}

/// Media `from` to `to`, downwards or upwards.
struct Run {
  const std::vector<Medium>& media;
  size_t from, to;
  const Medium& at(size_t k) const { return media[from < to ? from + k : from - k]; }
  size_t faces() const { return from < to ? to - from : from - to; }
};

/// From a medium through coherent layers into another: powers, of flux across the faces.
FilmPower coherentRun(const Run& run, int polarisation) {
  const auto face = [&](size_t j) {
    const Complex a = run.at(j).admittance[polarisation], b = run.at(j + 1).admittance[polarisation], sum = a + b;
    return sum == 0.0 ? std::pair<Complex, Complex>{0.0, 1.0} : std::pair<Complex, Complex>{(a - b) / sum, 2.0 * a / sum};
  };
  size_t j = run.faces() - 1;
  auto [r, t] = face(j);
  while (j-- > 0) {
    const auto [own, through] = face(j);
    const Complex once = run.at(j + 1).once, twice = r * once * once, left = 1.0 + own * twice;
    // At grazing incidence itself a face mirrors whatever lies beneath.
    if (left == 0.0) {
      r = own, t = 0.0;
      continue;
    }
    t = through * t * once / left;
    r = (own + twice) / left;
  }
  const double in = run.at(0).admittance[polarisation].real(), out = run.at(run.faces()).admittance[polarisation].real();
  return {std::norm(r), in > 0.0 ? std::max(0.0, out / in * std::norm(t)) : 0.0};
}

/// `media`: the one that light comes from, the layers, the one that it goes into.
FilmPower through(const std::vector<Medium>& media, int polarisation) {
  // From the last thick layer up: what lies beneath it returns and lets through, as seen from inside it.
  size_t end = media.size() - 1;
  std::optional<FilmPower> beneath;
  for (size_t j = media.size() - 1; j-- > 0;) {
    if (j > 0 && media[j].coherent) continue;
    FilmPower own = coherentRun({media, j, end}, polarisation);
    if (beneath) {
      const FilmPower back = coherentRun({media, end, j}, polarisation);
      const double once = std::norm(media[end].once), left = 1.0 - back.reflectance * beneath->reflectance * once * once;
      // Neither is lost: two perfect mirrors with nothing between them absorb nothing.
      if (left > 0.0)
        own = {own.reflectance + own.transmittance * back.transmittance * once * once * beneath->reflectance / left,
               own.transmittance * once * beneath->transmittance / left};
    }
    beneath = own;
    end = j;
  }
  return *beneath;
}

FilmPower unpolarised(std::vector<Medium>& media, double wavelength_um, double along) {
  prepare(media, wavelength_um, along);
  const FilmPower s = through(media, 0), p = through(media, 1);
  return {std::clamp(0.5 * (s.reflectance + p.reflectance), 0.0, 1.0), std::clamp(0.5 * (s.transmittance + p.transmittance), 0.0, 1.0)};
}

/// Of this thread, so that no call asks for memory.
std::vector<Medium>& emptyMedia() {
  thread_local std::vector<Medium> media;
  media.clear();
  return media;
}

}  // namespace

FilmPower filmPower(const std::vector<FilmLayer>& layers, Complex beneath, double wavelength_um, double sine) {
  std::vector<Medium>& media = emptyMedia();
  media.push_back({1.0, 0.0, true});
  for (const FilmLayer& l : layers) media.push_back({l.index, l.thickness_um, l.coherent});
  media.push_back({beneath, 0.0, true});
  return unpolarised(media, wavelength_um, sine);
}

FilmPower filmPowerFromBeneath(const std::vector<FilmLayer>& layers, double beneath, double wavelength_um, double sine) {
  std::vector<Medium>& media = emptyMedia();
  media.push_back({beneath, 0.0, true});
  for (auto l = layers.rbegin(); l != layers.rend(); ++l) media.push_back({l->index, l->thickness_um, l->coherent});
  media.push_back({1.0, 0.0, true});
  return unpolarised(media, wavelength_um, beneath * sine);
}

}  // namespace pitviper
