#include "scenarios/view/sphere_picture.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/view/band_rule.hpp"
#include "scenarios/view/channel_table.hpp"
#include "sim/model/fringes.hpp"
#include "sim/parameters/on_threads.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kQuarterTurn = 0.5 * kPi;
/// Of the tolerance: integrals over wavelength, then angles between a table's entries.
constexpr double kOfWavelengths = 0.1, kOfAngles = 0.25;
/// Finest steps of a formula's table to one of its own: a sixteenth of the error that its axis is made for.
constexpr int kFiner = 4;
/// Entries of what leaves the sphere by itself over the view angle: a sixteenth of a degree.
constexpr int kViewEntries = 1441;
/// A channel whose warmth is so much less than its light shows none.
constexpr double kNoWarmth = 1e-9;
constexpr std::size_t kLeastPixels = 2048;

std::size_t kindOf(Angle angle) { return static_cast<std::size_t>(angle); }

/// What a table of a component runs over where light and viewer are far: its other angles are fixed.
struct FreeAxes {
  std::vector<std::size_t> own;  ///< which of the component's two
  std::array<AngleAxis, 2> axes;
  std::array<double, 2> fixed_rad{0.0, 0.0};

  FreeAxes(const ReflectionComponent& r, double difference_rad) {
    const auto all = r.axes();
    for (std::size_t k = 0; k < 2; ++k) {
      if (all[k].angle == Angle::Difference) fixed_rad[k] = difference_rad;
      else if (all[k].angle != Angle::None) axes[own.size()] = all[k], own.push_back(k);
    }
  }
  std::array<double, 2> at(const std::array<double, 2>& angles) const {
    auto all = fixed_rad;
    for (std::size_t k = 0; k < own.size(); ++k) all[own[k]] = angles[k];
    return all;
  }
};

BandProbe probeOf(const ReflectionComponent& r, const FreeAxes& free, std::vector<std::size_t> weights) {
  std::vector<std::array<double, 2>> places;
  for (double a : {0.0, 0.06, 0.2, 0.5, 1.0})
    for (double b : {0.3, 0.9}) {
      if ((free.own.empty() && a > 0.0) || (free.own.size() < 2 && b > 0.5)) continue;
      places.push_back(free.at({a * free.axes[0].last_rad, b * free.axes[1].last_rad}));
    }
  const std::size_t count = places.size();
  return {std::move(weights), count, [&r, places = std::move(places)](double w, std::vector<double>& values) {
            for (std::size_t k = 0; k < places.size(); ++k) values[k] = r.column(w, places[k][0], places[k][1]);
          }};
}

bool sameLobe(const Lobe& a, const Lobe& b) { return a.file == b.file && a.function == b.function && a.parameters == b.parameters; }

struct Weighted {
  const ReflectionComponent* lobe;  ///< absent: 1
  std::vector<ChannelTable> tables;
};

/// Reads a table at pixels' angles: out += weight x value; no weight: 1.
void addTable(const ChannelTable& table, std::size_t channel, const std::array<std::vector<float>, 7>& angles, std::size_t from, std::size_t to,
              const float* weight, float* out) {
  const float* values = table.values[channel].data();
  const std::size_t count = to - from;
  struct Axis {
    const float* angle;
    float perRadian, last;
  };
  const auto axisOf = [&](const AngleAxis& a) {
    return Axis{angles[kindOf(a.angle)].data() + from, a.count > 1 ? static_cast<float>((a.count - 1) / a.last_rad) : 0.0f, static_cast<float>(a.count - 1)};
  };
  const auto inner = table.axes[0].count, outer = table.axes[1].count;
  if (inner * outer == 1) {
    for (std::size_t k = 0; k < count; ++k) out[k] += (weight ? weight[k] : 1.0f) * values[0];
    return;
  }
  const Axis a = axisOf(table.axes[0]);
  if (outer == 1) {
    for (std::size_t k = 0; k < count; ++k) {
      const float x = std::min(a.angle[k] * a.perRadian, a.last);
      const int i = std::min(static_cast<int>(x), inner - 2);
      const float low = values[i];
      out[k] += (weight ? weight[k] : 1.0f) * (low + (x - static_cast<float>(i)) * (values[i + 1] - low));
    }
    return;
  }
  const Axis b = axisOf(table.axes[1]);
  for (std::size_t k = 0; k < count; ++k) {
    const float x = std::min(a.angle[k] * a.perRadian, a.last), y = std::min(b.angle[k] * b.perRadian, b.last);
    const int i = std::min(static_cast<int>(x), inner - 2), j = std::min(static_cast<int>(y), outer - 2);
    const float f = x - static_cast<float>(i), g = y - static_cast<float>(j);
    const float *row = values + j * inner + i, *next = row + inner;
    const float low = row[0] + f * (row[1] - row[0]), high = next[0] + f * (next[1] - next[0]);
    out[k] += (weight ? weight[k] : 1.0f) * (low + g * (high - low));
  }
}

}  // namespace

/// A material, or one of two states of it, ready to be read.
struct SpherePicture::Part {
  std::vector<Weighted> reflected;
  std::optional<ChannelTable> own;  ///< emitted and ambient
};

std::vector<SphereChannel> sphereChannels(const std::vector<ChannelOutput>& outputs) {
  std::vector<SphereChannel> all;
  for (const ChannelOutput& o : outputs)
    if (!o.perEtendue && !o.perExposure && !o.behindOptics && !o.detected && !o.asTemperature) all.push_back({o.channel, o.unit, o.kernel * o.scale});
  return all;
}

SpherePicture::SpherePicture(std::vector<SphereChannel> channels, SphereLight light, SphereView view)
    : channels_(std::move(channels)), light_(std::move(light)), view_(view) {
  if (channels_.empty()) throw UserError({}, "a picture of a sphere without channels", "at least one", "add one");
  if (!(glm::length(light_.direction) > 0.0)) throw UserError({}, "a light of a sphere in no direction", "a direction that is not 0", "correct it");
  if (view_.side < 1 || view_.side > 16384) throw UserError({}, print("a picture of a sphere %d pixels wide", view_.side), "1 to 16384", "correct it");
  if (!(view_.radius_px > 0.0)) throw UserError({}, print("a sphere of a radius of %g pixels", view_.radius_px), "more than 0", "correct it");
  if (!(view_.temperature_K >= 0.0)) throw UserError({}, print("a sphere at %g K", view_.temperature_K), "0 K or more", "correct it");
  if (!(view_.tolerance > 0.0)) throw UserError({}, print("a tolerance of %g", view_.tolerance), "more than 0", "take 1e-3");
  for (const SphereChannel& c : channels_)
    for (const Spectrum* own : {&light_.irradiance, light_.ambient ? &*light_.ambient : nullptr})
      if (own && !own->isZero()) {
        const Spectrum seen = c.kernel * *own;
        const double low = seen.supportLow(), high = seen.supportHigh();
        if (low < high && (low < seen.validLow() || high > seen.validHigh()))
          throw UserError({}, print("light of a sphere that is known from %g to %g um, for channel '%s'", seen.validLow(), seen.validHigh(), c.name.c_str()),
                          print("light known from %g to %g um", low, high), "extend its spectrum, or write 'outside: hold' in it");
      }
  light_.direction = glm::normalize(light_.direction);
  place();
}

void SpherePicture::place() {
  const glm::dvec3 light = light_.direction, viewer(0.0, 0.0, 1.0);
  difference_rad_ = 0.5 * angleBetween(Angle::Incidence, light, viewer);
  const double perHalf = 1.0 / glm::length(light + viewer);
  const auto normalAt = [&](std::size_t pixel) {
    const auto side = static_cast<std::size_t>(view_.side);
    const glm::dvec2 p =
        glm::dvec2(static_cast<double>(pixel % side) + 0.5 - view_.centre_px.x, view_.centre_px.y - static_cast<double>(pixel / side) - 0.5) / view_.radius_px;
    const double r2 = glm::dot(p, p);
    return r2 < 1.0 ? glm::dvec3(p, std::sqrt(1.0 - r2)) : glm::dvec3(0.0);
  };
  std::vector<std::size_t> dark;
  for (std::size_t pixel = 0; pixel < static_cast<std::size_t>(view_.side) * static_cast<std::size_t>(view_.side); ++pixel)
    if (const glm::dvec3 n = normalAt(pixel); n.z > 0.0) (glm::dot(n, light) > 0.0 ? pixels_ : dark).push_back(pixel);
  lit_.resize(pixels_.size());
  pixels_.insert(pixels_.end(), dark.begin(), dark.end());
  for (Angle kind : {Angle::Incidence, Angle::Specular, Angle::Half, Angle::HalfRoot}) angle_rad_[kindOf(kind)].resize(lit_.size());
  angle_rad_[kindOf(Angle::View)].resize(pixels_.size());
  onStretches(pixels_.size(), kLeastPixels, [&](std::size_t from, std::size_t to) {
    for (std::size_t k = from; k < to; ++k) {
      const glm::dvec3 n = normalAt(pixels_[k]);
      const double sine = std::sqrt(n.x * n.x + n.y * n.y);
      angle_rad_[kindOf(Angle::View)][k] = static_cast<float>(std::atan2(sine, n.z));
      if (k >= lit_.size()) continue;
      // x of the frame towards the viewer, across the normal.
      const glm::dvec3 along = sine > 0.0 ? glm::dvec3(-n.x * n.z / sine, -n.y * n.z / sine, sine) : glm::dvec3(1.0, 0.0, 0.0);
      const glm::dvec3 own(glm::dot(light, along), glm::dot(light, glm::cross(n, along)), glm::dot(light, n)), seen(sine, 0.0, n.z);
      lit_[k] = {own, sine, n.z};
      for (Angle kind : {Angle::Incidence, Angle::Specular}) angle_rad_[kindOf(kind)][k] = static_cast<float>(angleBetween(kind, own, seen));
      const double half = angleBetween(Angle::Incidence, perHalf * (own + seen), seen);
      angle_rad_[kindOf(Angle::Half)][k] = static_cast<float>(half);
      angle_rad_[kindOf(Angle::HalfRoot)][k] = static_cast<float>(rootOfHalf(half));
    }
  });
}

SpherePicture::Part SpherePicture::part(const Material& m, double share) const {
  // The channels' weights under the lamp, then under their own warmth, then under what is around.
  const std::size_t channels = channels_.size();
  std::vector<Spectrum> weights;
  for (const SphereChannel& c : channels_) weights.push_back(c.kernel * light_.irradiance);
  const Spectrum black(Spectrum::BlackBody{view_.temperature_K, 1.0});
  bool warm = false;
  for (std::size_t c = 0; c < channels; ++c) {
    const Spectrum& kernel = channels_[c].kernel;
    const double low = kernel.supportLow(), high = kernel.supportHigh(), radiated = (kernel * black).integral(low, high);
    const bool shows = radiated > 0.0 && radiated > kNoWarmth * weights[c].integral(low, high);
    weights.push_back(shows ? kernel * black : Spectrum(0.0));
    warm = warm || shows;
  }
  if (light_.ambient)
    for (const SphereChannel& c : channels_) weights.push_back(c.kernel * *light_.ambient);
  for (const Spectrum& w : weights)
    if (!w.isZero() && (w.supportLow() < m.validLow_um() || w.supportHigh() > m.validHigh_um())) {
      const std::string& name = channels_[static_cast<std::size_t>(&w - weights.data()) % channels].name;
      throw UserError(m.where,
                      print("'%s' has no data for channel '%s' (it covers %g to %g um)", m.name.c_str(), name.c_str(), m.validLow_um(), m.validHigh_um()),
                      print("data from %g to %g um", w.supportLow(), w.supportHigh()), "extend its spectra, or write 'outside: hold' in them");
    }

  std::vector<double> knots;
  const auto add = [&](const std::vector<double>& more) { knots.insert(knots.end(), more.begin(), more.end()); };
  std::vector<const HasFringes*> fringes;
  std::vector<BandProbe> probes;
  const auto group = [&](std::size_t number) {
    std::vector<std::size_t> all;
    for (std::size_t c = 0; c < channels; ++c) all.push_back(number * channels + c);
    return all;
  };
  for (const auto& r : m.reflections) {
    add(r->knots_um());
    if (const auto* own = dynamic_cast<const HasFringes*>(r.get())) fringes.push_back(own);
    probes.push_back(probeOf(*r, FreeAxes(*r, difference_rad_), group(0)));
  }
  if (m.given) add(m.given->knots_um());
  if (m.transmission) add(m.transmission->knots_um());
  const auto atViews = [](const auto& f) {
    return [f](double w, std::vector<double>& values) {
      constexpr double kViews_rad[] = {0.0, 0.8, 1.3};
      for (std::size_t k = 0; k < 3; ++k) values[k] = f(w, kViews_rad[k]);
    };
  };
  if (warm) probes.push_back({group(1), 3, atViews([&m](double w, double angle) { return m.emissivity(w, angle); })});
  if (light_.ambient) probes.push_back({group(2), 3, atViews([&m](double w, double angle) { return m.reflectance(w, angle); })});
  const BandRule rule = bandRule(
      weights, knots,
      [&](double w) {
        double least = kLongestWavelength_um;
        for (const HasFringes* f : fringes) least = std::min(least, f->resolvedBy_um(w));
        return least;
      },
      probes, kOfWavelengths * view_.tolerance);
  /// Adds share x the sum over wavelengths of a group's weights x f.
  const auto sum = [&](std::size_t number, double* values, const auto& f) {
    for (std::size_t p = 0; p < rule.wavelength_um.size(); ++p) {
      const auto weight = [&](std::size_t c) { return rule.weight[number * channels + c][p]; };
      bool any = false;
      for (std::size_t c = 0; c < channels; ++c) any = any || weight(c) != 0.0;
      if (!any) continue;
      const double value = share * f(rule.wavelength_um[p]);
      for (std::size_t c = 0; c < channels; ++c) values[c] += weight(c) * value;
    }
  };

  Part made;
  for (const auto& r : m.reflections) {
    const FreeAxes free(*r, difference_rad_);
    const ValuesAtAngles at = [&](const std::array<double, 2>& angles, double* values) {
      const auto all = free.at(angles);
      std::fill(values, values + channels, 0.0);
      sum(0, values, [&](double w) { return r->column(w, all[0], all[1]); });
    };
    AngleAxis finer = free.axes[0];
    finer.count = (finer.count - 1) * kFiner + 1;
    const bool smooth = free.own.size() == 1 && r->angleError() > 0.0;
    ChannelTable table = smooth ? bisectedTable(finer, channels, kOfAngles * view_.tolerance, at) : filledTable(free.axes, channels, at);
    const ReflectionComponent* lobe = r->lobe().file.empty() ? nullptr : r.get();
    const auto same = std::find_if(made.reflected.begin(), made.reflected.end(), [&](const Weighted& w) {
      return lobe == nullptr || w.lobe == nullptr ? lobe == w.lobe : sameLobe(lobe->lobe(), w.lobe->lobe());
    });
    if (same != made.reflected.end()) same->tables.push_back(std::move(table));
    else made.reflected.push_back({lobe, {std::move(table)}});
  }
  if (warm || light_.ambient) {
    const auto leaves = [&](double angle, double* values) {
      std::fill(values, values + channels, 0.0);
      if (warm) sum(1, values, [&](double w) { return m.emissivity(w, angle); });
      if (light_.ambient) sum(2, values, [&](double w) { return m.reflectance(w, angle); });
    };
    const bool varies = m.hemisphericalVaries();
    const AngleAxis axis{varies ? Angle::View : Angle::None, varies ? kViewEntries : 1, varies ? kQuarterTurn : 0.0};
    const ValuesAtAngles at = [&](const std::array<double, 2>& angles, double* values) { leaves(angles[0], values); };
    made.own = varies ? bisectedTable(axis, channels, kOfAngles * view_.tolerance, at) : filledTable({axis, AngleAxis{}}, channels, at);
  }
  return made;
}

void SpherePicture::add(const Part& part, std::size_t from, std::size_t to, std::vector<std::vector<float>>& pictures) const {
  const std::size_t channels = channels_.size(), count = to - from, lit = std::min(to, lit_.size());
  std::vector<std::vector<float>> sums(channels, std::vector<float>(count, 0.0f));
  if (part.own)
    for (std::size_t c = 0; c < channels; ++c) addTable(*part.own, c, angle_rad_, from, to, nullptr, sums[c].data());
  std::vector<float> weight(count);
  if (from < lit)
    for (const Weighted& group : part.reflected) {
      for (std::size_t k = from; k < lit; ++k) {
        const Place& p = lit_[k];
        weight[k - from] = static_cast<float>(group.lobe ? p.light.z * group.lobe->lobeAt(p.light, {p.viewX, 0.0, p.viewZ}) : p.light.z);
      }
      for (const ChannelTable& table : group.tables)
        for (std::size_t c = 0; c < channels; ++c) addTable(table, c, angle_rad_, from, lit, weight.data(), sums[c].data());
    }
  for (std::size_t c = 0; c < channels; ++c)
    for (std::size_t k = 0; k < count; ++k) pictures[c][pixels_[from + k]] += sums[c][k];
}

std::vector<std::vector<float>> SpherePicture::draw(const Material& material) const {
  if (material.medium) throw UserError(material.where, "a sphere of '" + material.name + "', which is a medium", "a surface", "take another material");
  std::vector<Part> parts;
  if (const auto& states = material.states; states && states->texture < 0) {
    const auto last = static_cast<double>(states->entries.size() - 1);
    const double x = std::clamp((view_.temperature_K - states->low) / (states->high - states->low), 0.0, 1.0) * last, low = std::min(std::floor(x), last - 1.0);
    const auto first = static_cast<std::size_t>(low);
    parts.push_back(part(*states->entries[first], 1.0 - (x - low)));
    if (x > low) parts.push_back(part(*states->entries[first + 1], x - low));
  } else {
    parts.push_back(part(material, 1.0));
  }
  std::vector<std::vector<float>> pictures(channels_.size(),
                                           std::vector<float>(static_cast<std::size_t>(view_.side) * static_cast<std::size_t>(view_.side), 0.0f));
  onStretches(pixels_.size(), kLeastPixels, [&](std::size_t from, std::size_t to) {
    for (const Part& p : parts) add(p, from, to, pictures);
  });
  return pictures;
}

}  // namespace pitviper
