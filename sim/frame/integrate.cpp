#include "sim/frame/integrate.hpp"

#include <algorithm>
#include <cmath>

#include "sim/frame/make_frame.hpp"
#include "sim/frame/version.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

std::string interval(double low, double high) { return print("%.6g to %.6g um", low, high); }

void checkCovered(const SpectralImage& image, const ChannelOutput& o) {
  const double low = o.kernel.supportLow(), high = o.kernel.supportHigh(), first = image.edge_um.front(), last = image.edge_um.back();
  if (low >= first * (1 - 1e-9) && high <= last * (1 + 1e-9)) return;
  const std::string band = print("spectral_image: {band: [%.6g um, %.6g um]}", std::min(low, first), std::max(high, last));
  throw UserError(o.where, "channel '" + o.channel + "' responds from " + interval(low, high) + ", beyond the bins of " + image.file,
                  "a response within " + interval(first, last),
                  std::string("render the image with '") + band + "', or cut the response off: 'response: {product: [..., {band: [..., ...]}]}'");
}

/// Sum over bins of weight x mean, for every pixel.
std::vector<double> weightedSum(const SpectralImage& image, const std::vector<double>& weight) {
  std::vector<double> sum(static_cast<size_t>(image.width) * static_cast<size_t>(image.height), 0.0);
  for (size_t k = 0; k < weight.size(); ++k)
    if (weight[k] != 0.0)
      for (size_t p = 0; p < sum.size(); ++p) sum[p] += weight[k] * static_cast<double>(image.bins[k][p]);
  return sum;
}

BinningError errorOf(const std::vector<double>& value, const std::vector<double>& error) {
  std::vector<double> relative;
  for (size_t p = 0; p < value.size(); ++p)
    if (const double r = std::abs(error[p] / value[p]); value[p] != 0.0 && std::isfinite(r)) relative.push_back(r);
  if (relative.empty()) return {};
  const auto middle = relative.begin() + static_cast<std::ptrdiff_t>(relative.size() / 2);
  std::nth_element(relative.begin(), middle, relative.end());
  return {*middle, *std::max_element(relative.begin(), relative.end())};
}

/// What is said anew of the integrated frame.
bool isReplaced(const std::string& name) {
  for (const char* n :
       {"pitviper.version", "pitviper.focal_length_m", "pitviper.pitch_x_m", "pitviper.pitch_y_m", "pitviper.aperture_m", "pitviper.aperture_area_m2",
        "pitviper.exposure_s", "pitviper.spectral_image", "pitviper.sensor", "pitviper.sensor_sha256", kPictureAttribute, "expTime", "aperture"})
    if (name == n) return true;
  return false;
}

template <class T>
T attribute(const SpectralImage& image, const char* name, T otherwise) {
  for (const auto& a : image.attributes)
    if (const T* v = std::get_if<T>(&a.value); v && a.name == name) return *v;
  return otherwise;
}

}  // namespace

BinWeights binWeights(const Spectrum& kernel, const std::vector<double>& edge_um) {
  const size_t count = edge_um.size() - 1;
  BinWeights w{std::vector<double>(count), std::vector<double>(count)};
  const auto knots = kernel.knots();
  const double low = kernel.supportLow(), high = kernel.supportHigh();
  auto centre = [&](size_t k) { return 0.5 * (edge_um[k] + edge_um[k + 1]); };
  for (size_t k = 0; k < count; ++k) {
    const double from = std::max(edge_um[k], low), to = std::min(edge_um[k + 1], high);
    if (!(from < to)) continue;
    w.value[k] = integrate(kernel, from, to, knots);
    const double moment = integrate([&](double x) { return kernel(x) * (x - centre(k)); }, from, to, knots);
    if (count < 2 || std::abs(moment) < 1e-12 * w.value[k] * (edge_um[k + 1] - edge_um[k])) continue;  // rounding of a flat kernel
    const size_t before = k > 0 ? k - 1 : k, after = k + 1 < count ? k + 1 : k;
    const double perSlope = moment / (centre(after) - centre(before));
    w.error[after] += perSlope;
    w.error[before] -= perSlope;
  }
  return w;
}

IntegratedFrame integrateSpectralImage(const SpectralImage& image, const std::vector<ChannelOutput>& outputs, const Pinhole& pinhole, double exposure_s) {
  IntegratedFrame result;
  Frame& frame = result.frame;
  frame.camera = attribute(image, "pitviper.camera", std::string("camera"));
  frame.number = attribute(image, "pitviper.frame", 0);
  frame.time_s = attribute(image, "pitviper.time_s", 0.0);
  frame.width = image.width;
  frame.height = image.height;
  for (const auto& a : image.attributes)
    if (!isReplaced(a.name)) frame.attributes.push_back(a);
  frame.attributes.push_back({"pitviper.version", std::string(kVersion)});
  addOptics(frame, pinhole, exposure_s);
  const bool etendue = std::any_of(outputs.begin(), outputs.end(), [](const auto& o) { return o.perEtendue; });
  const auto solidAngles = etendue ? pinhole.solidAngles() : Pinhole::SolidAngles{};
  for (const auto& o : outputs) {
    checkCovered(image, o);
    const BinWeights w = binWeights(o.kernel, image.edge_um);
    const auto value = weightedSum(image, w.value);
    result.binning.push_back(errorOf(value, weightedSum(image, w.error)));
    FrameLayer layer{o.layer(), o.unit, std::vector<float>(value.size())};
    const double scale = o.scale * (o.perExposure ? exposure_s : 1.0);
    for (size_t p = 0; p < value.size(); ++p) layer.pixels[p] = static_cast<float>(scale * value[p] * (o.perEtendue ? solidAngles.projected_sr[p] : 1.0));
    if (o.asTemperature) toApparentTemperatures(layer.pixels, o, solidAngles.projected_sr, exposure_s);
    frame.layers.push_back(std::move(layer));
    frame.attributes.push_back({"binning_error." + o.layer(), std::vector<double>{result.binning.back().median, result.binning.back().maximum}});
  }
  addUnits(frame, outputs);
  return result;
}

}  // namespace pitviper
