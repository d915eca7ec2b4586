#include "sim/frame/spectral_image.hpp"

#include <algorithm>
#include <cmath>

#include "sim/parameters/print.hpp"
#include "sim/radiometry/spectrum.hpp"

namespace pitviper {
namespace {

constexpr const char* kUnit = "W/(m2 sr um)";

/// A layer's name, S0.3050nm: the first of the Stokes parameters, at a wavelength with a comma for the decimal point.
/// Source: Fichet, Pacanowski and Wilkie 2021, "An OpenEXR Layout for Spectral Images", JCGT 10(3).
constexpr const char *kStokes = "S0", *kLayoutVersion = "1.0", *kLayoutUnit = "W.m^-2.sr^-1.um^-1";
std::string nanometres(double um) {
  std::string text = print("%.12g", 1e3 * um);
  std::replace(text.begin(), text.end(), '.', ',');
  return text + "nm";
}

std::string micrometres(double low, double high) { return print("%.6g to %.6g um", low, high); }

struct Bin {
  double low_um, high_um;
  FloatLayer* layer;
};

class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : where_{file.string(), 0, 0, -1}, exr_(readExr(file)) {}

  SpectralImage read() {
    SpectralImage image;
    if (exr_.held)
      refuse("the file has only a part of its picture: " + sizeOf(*exr_.held) + " of " + sizeOf({0, 0, exr_.width, exr_.height}),
             "all pixels, as they were written");
    image.file = where_.file;
    image.width = exr_.width;
    image.height = exr_.height;
    for (Bin& bin : bins()) {
      if (image.edge_um.empty()) image.edge_um.push_back(bin.low_um);
      image.edge_um.push_back(bin.high_um);
      checkFinite(*bin.layer);
      image.bins.push_back(std::move(bin.layer->pixels));
    }
    readCamera(image);
    for (const auto& a : exr_.attributes)
      if (a.name.rfind("pitviper.", 0) == 0 || a.name.rfind("entity.", 0) == 0) image.attributes.push_back(a);
    return image;
  }

 private:
  [[noreturn]] void refuse(const std::string& wrong, const std::string& expected) const {
    throw UserError(where_, wrong, expected, "take a <camera>_<frame>_spectral.exr of a camera with 'spectral_image: {band: [3 um, 5 um]}'");
  }

  static std::string sizeOf(const PixelBox& box) { return std::to_string(box.right - box.left) + " x " + std::to_string(box.bottom - box.top) + " pixels"; }

  void checkFinite(const FloatLayer& layer) const {
    const auto bad = std::find_if(layer.pixels.begin(), layer.pixels.end(), [](float v) { return !std::isfinite(v); });
    if (bad == layer.pixels.end()) return;
    const auto pixel = bad - layer.pixels.begin();
    refuse("layer '" + layer.name + "' is not finite at column " + std::to_string(pixel % exr_.width) + ", row " + std::to_string(pixel / exr_.width),
           "finite radiances");
  }

  std::vector<Bin> bins() {
    std::vector<Bin> all;
    for (auto& layer : exr_.layers) {
      const Attribute* edges = exr_.findAttribute("bin_um." + layer.name);
      if (!edges) continue;
      const auto numbers = numbersOf(*edges);
      if (!numbers || numbers->size() != 2 ||
          !((*numbers)[0] >= kShortestWavelength_um && (*numbers)[0] < (*numbers)[1] && (*numbers)[1] <= kLongestWavelength_um))
        refuse("attribute 'bin_um." + layer.name + "' is not a bin of wavelength", "two rising edges within 0.1 to 1000 um");
      const Attribute* unit = exr_.findAttribute("unit." + layer.name);
      const auto* text = unit ? std::get_if<std::string>(&unit->value) : nullptr;
      if (!text || *text != kUnit) refuse("layer '" + layer.name + "' is not spectral radiance", std::string("attribute 'unit.") + layer.name + "' = " + kUnit);
      all.push_back({(*numbers)[0], (*numbers)[1], &layer});
    }
    if (all.size() < 2)
      refuse("is not a spectral image: " + std::string(all.empty() ? "no" : "only one") + " layer has an attribute bin_um.<layer>",
             "at least two bins of wavelength");
    std::sort(all.begin(), all.end(), [](const Bin& a, const Bin& b) { return a.low_um < b.low_um; });
    for (size_t i = 0; i + 1 < all.size(); ++i) {
      const double step = all[i + 1].low_um - all[i].high_um;
      if (std::abs(step) > 1e-9 * all[i].high_um)
        refuse(std::string("its bins ") + (step > 0.0 ? "leave a gap between '" : "overlap: '") + all[i].layer->name + "' (" +
                   micrometres(all[i].low_um, all[i].high_um) + ") and '" + all[i + 1].layer->name + "' (" +
                   micrometres(all[i + 1].low_um, all[i + 1].high_um) + ")",
               "bins that follow on each other");
    }
    return all;
  }

  double positive(const char* name) const {
    const Attribute* a = exr_.findAttribute(name);
    const auto numbers = a ? numbersOf(*a) : std::nullopt;
    if (!numbers || numbers->size() != 1 || !(std::isfinite(numbers->front()) && numbers->front() > 0.0))
      refuse(a ? std::string("attribute '") + name + "' is not a number above zero" : std::string("has no attribute '") + name + "'",
             "the camera of the image");
    return numbers->front();
  }

  void readCamera(SpectralImage& image) const {
    Pinhole& p = image.pinhole;
    p.width = image.width;
    p.height = image.height;
    p.focalLength_m = positive("pitviper.focal_length_m");
    p.pitchX_m = positive("pitviper.pitch_x_m");
    p.pitchY_m = positive("pitviper.pitch_y_m");
    p.apertureDiameter_m = positive("pitviper.aperture_m");
    // As wide as a camera of a scenario may look.
    if (!(0.5 * p.width * p.pitchX_m / p.focalLength_m < 31.0 && 0.5 * p.height * p.pitchY_m / p.focalLength_m < 31.0))
      refuse("its pixel pitch, focal length and size do not belong together", "a field of view below 176 deg");
    const Attribute* exposure = exr_.findAttribute("pitviper.exposure_s");
    const auto numbers = exposure ? numbersOf(*exposure) : std::nullopt;
    if (numbers && numbers->size() == 1 && numbers->front() > 0.0 && std::isfinite(numbers->front())) image.exposure_s = numbers->front();
  }

  Location where_;
  ExrImage exr_;
};

}  // namespace

ChannelOutput binOutput(const SpectralBins& bins, int bin) {
  ChannelOutput o;
  o.unit = kUnit;
  o.where = bins.where;
  o.bandLow_um = bins.edge_um[static_cast<size_t>(bin)];
  o.bandHigh_um = bins.edge_um[static_cast<size_t>(bin) + 1];
  o.channel = kStokes;
  o.quantity = nanometres(0.5 * (o.bandLow_um + o.bandHigh_um));
  o.kernel = Spectrum::band(o.bandLow_um, o.bandHigh_um, 1.0 / (o.bandHigh_um - o.bandLow_um));
  return o;
}

void addBins(Frame& frame, const SpectralBins& bins) {
  frame.attributes.push_back({"spectralLayoutVersion", std::string(kLayoutVersion)});
  frame.attributes.push_back({"emissiveUnits", std::string(kLayoutUnit)});
  for (int b = 0; b < bins.count(); ++b) {
    const ChannelOutput o = binOutput(bins, b);
    frame.attributes.push_back({"wavelength_um." + o.layer(), 0.5 * (o.bandLow_um + o.bandHigh_um)});
    frame.attributes.push_back({"bin_um." + o.layer(), std::vector<double>{o.bandLow_um, o.bandHigh_um}});
  }
}

SpectralImage readSpectralImage(const std::filesystem::path& file) { return Reader(file).read(); }

}  // namespace pitviper
