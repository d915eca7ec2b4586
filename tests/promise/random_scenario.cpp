#include "tests/promise/random_scenario.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <sstream>
#include <string_view>
#include <vector>

#include "tests/promise/random_dice.hpp"

namespace pitviper::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr int kFilm_px = 20;

constexpr const char* kOpaque[] = {"aluminium_sheet",
                                   "asphalt",
                                   "bare_aluminium",
                                   "black_gloss_paint",
                                   "blackbody",
                                   "concrete",
                                   "conifer",
                                   "dry_grass",
                                   "flat_black_paint",
                                   "galvanised_steel_oxidised",
                                   "glass",
                                   "green_grass",
                                   "grey_aircraft_paint",
                                   "olive_gloss_paint",
                                   "oxidised_nickel_alloy",
                                   "rubber",
                                   "sand",
                                   "sea_water",
                                   "snow",
                                   "soil",
                                   "soot",
                                   "titanium",
                                   "water",
                                   "white_lambertian"};
constexpr const char* kGround[] = {"asphalt", "concrete", "conifer", "dry_grass", "green_grass", "sand", "sea_water", "snow", "soil", "water"};
constexpr const char* kPanes[] = {"acrylic_canopy", "germanium_window", "sapphire_dome", "window_glass", "zinc_sulphide_window"};
constexpr const char* kMedia[] = {"afterburner_plume", "jet_exhaust", "jet_exhaust_mixed", "oil_smoke"};
constexpr const char* kResponses[] = {"insb_mwir", "mct_lwir", "mct_lwir_12", "ingaas", "pbse"};

struct Place {
  double x = 0.0, y = 0.0, z = 0.0;
};

/// Numbers of six digits. What is streamed is worked out from left to right, which arguments of a function are not: so the dice fall alike everywhere.
class Text {
 public:
  template <class T>
  Text& operator<<(const T& part) {
    stream_ << part;
    return *this;
  }
  Text& operator<<(const Place& p) { return *this << "[" << p.x << " m, " << p.y << " m, " << p.z << " m]"; }
  operator std::string() const { return stream_.str(); }

 private:
  std::ostringstream stream_;
};

/// Bins of the reference between two wavelengths, about: 1 nm or 5 1/cm, whichever is wider (1 nm below sqrt(2) um).
double binsBetween(double low_um, double high_um) {
  constexpr double kCross_um = 1.4142;
  const double below = std::max(0.0, std::min(high_um, kCross_um) - std::min(low_um, kCross_um)) / 1e-3;
  const double from = std::max(low_um, kCross_um), to = std::max(high_um, kCross_um);
  return below + (1.0 / from - 1.0 / to) / 5e-4;
}

class Composer {
 public:
  explicit Composer(const ScenarioDraw& draw)
      : draw_(draw),
        dice_(draw.seed, static_cast<std::uint64_t>(draw.attempt)),
        more_(draw.seed, 1000 + static_cast<std::uint64_t>(draw.attempt)),
        field_(draw.seed, 2000 + static_cast<std::uint64_t>(draw.attempt)) {}

  std::string compose() {
    placeEye();
    if (draw_.fields) kind_ = static_cast<Kind>(field_.weighted({0.65, 0.2, 0.08, 0.07}));
    heap_ = draw_.fields && kind_ == Kind::None && heaps_.chance(0.15);
    if (kind_ != Kind::None || heap_) draw_.mostWavelengths = std::min(draw_.mostWavelengths, kWithFields), frames_ = std::min(frames_, 2);
    const std::string air = atmosphere(), light = lightFromAbove(), ground = ground_ ? groundPlate() : "", bodies = cluster(), things = row(),
                      lamps = lampsNearby(), field = fields(), eye = camera();
    Text all;
    all << "name: promise_" << draw_.seed << "\nseed: " << draw_.seed << "\ntime: {rate: 1 Hz, frames: " << frames_ << "}\n";
    if (dice_.chance(0.2)) all << (dice_.chance(0.5) ? "render: {shadows: false}\n" : "render: {mode: buffered}\n");
    all << air << light;
    if (!materials_.empty()) all << "materials:\n" << materials_;
    all << "entities:\n" << ground << bodies << things;
    if (!lamps.empty()) all << "lights:\n" << lamps;
    all << field;
    if (heap_) all << cumulus();
    return all << eye;
  }

 private:
  /// Range, field, size of the cluster, heights.
  void placeEye() {
    range_m_ = dice_.byFactor(1.0, 50e3);
    field_rad_ = dice_.byFactor(0.05, 40.0) * kDegree;
    size_m_ = std::min(range_m_ * field_rad_ * dice_.byFactor(0.4, 40.0) / kFilm_px, 0.2 * range_m_);
    ground_ = dice_.chance(0.65);
    const double height_m = dice_.chance(0.3) ? dice_.between(1.5, 20.0) : dice_.byFactor(2.0, 3000.0);
    const double rise = dice_.chance(0.5) ? dice_.between(-0.05, 0.05) : dice_.between(-0.6, 0.6), lowest_m = ground_ ? 1.5 * size_m_ : 1.0;
    rise_ = std::max(rise, std::asin(std::clamp((lowest_m - height_m) / range_m_, -1.0, 0.6)));
    eye_ = {0.0, 0.0, height_m};
    target_ = {0.0, range_m_ * std::cos(rise_), std::max(height_m + range_m_ * std::sin(rise_), lowest_m)};
    frames_ = 1 + dice_.weighted({0.5, 0.3, 0.2});
    fieldAtTarget_m_ = range_m_ * 2.0 * std::tan(0.5 * field_rad_);
  }
  /// On the line of sight.
  Place along(double distance_m) const {
    const double f = distance_m / range_m_;
    return {eye_.x + f * (target_.x - eye_.x), eye_.y + f * (target_.y - eye_.y), eye_.z + f * (target_.z - eye_.z)};
  }
  double kelvin() { return dice_.chance(0.6) ? dice_.between(250.0, 330.0) : dice_.byFactor(200.0, 3000.0); }

  std::string atmosphere() {
    constexpr const char* kAirs[] = {"clear_us76", "hazy_us76", "clear_mls", "hazy_mls"};
    Text out;
    switch (dice_.weighted({0.15, 0.15, 0.7})) {
      case 0:
        return "";
      case 1: {
        const double k = dice_.byFactor(0.01, 3.0);
        out << "atmosphere: {extinction: ";
        if (dice_.chance(0.5)) out << k << " /km";
        else
          out << "{wavelength: um, unit: 1/km, values: [[0.3, " << k << "], [" << dice_.between(1.0, 5.0) << ", " << k * dice_.byFactor(0.05, 20.0) << "], ["
              << dice_.between(6.0, 12.0) << ", " << k * dice_.byFactor(0.05, 20.0) << "], [15, " << k * dice_.byFactor(0.1, 3.0) << "]]}";
        out << ", temperature: " << dice_.between(240.0, 310.0) << " K";
        if (dice_.chance(0.3)) out << ", top: " << dice_.between(5.0, 30.0) << " km";
        return out << "}\n";
      }
      default:
        layered_ = true;
        out << "atmosphere: {library: " << dice_.of(kAirs);
        if (dice_.chance(0.5)) out << ", visibility: " << dice_.byFactor(0.5, 100.0) << " km";
        return out << otherAir() << "}\n";
    }
  }

  /// Climates, weather at the ground, aerosols.
  std::string otherAir() {
    constexpr const char* kClimates[] = {"tropical", "midlatitude_winter", "subarctic_summer", "subarctic_winter"};
    constexpr const char* kAerosols[] = {"rural", "urban", "maritime", "tropospheric", "desert", "advection_fog", "radiation_fog"};
    Text out;
    if (more_.chance(0.3)) out << ", climate: " << more_.of(kClimates);
    if (more_.chance(0.15)) out << ", surface_temperature: " << more_.between(240.0, 310.0) << " K";
    if (more_.chance(0.15)) out << ", humidity: " << more_.between(0.0, 1.0);
    if (more_.chance(0.15)) out << ", co2: " << more_.between(300e-6, 800e-6);
    if (more_.chance(0.3)) out << ", aerosol: " << more_.of(kAerosols);
    if (clouds_.chance(0.25)) out << clouds();
    return out;
  }

  std::string clouds() {
    constexpr const char* kTypes[] = {"stratus", "stratocumulus", "nimbostratus", "altostratus", "cirrus"};
    Text out;
    out << ", clouds: [{type: " << clouds_.of(kTypes) << ", optical_depth: " << clouds_.byFactor(0.1, 50.0);
    if (clouds_.chance(0.4)) out << ", base: " << clouds_.byFactor(50.0, 6000.0) << " m";
    if (clouds_.chance(0.3)) out << ", radius: " << clouds_.byFactor(3.0, 40.0) << " um";
    out << "}]";
    if (clouds_.chance(0.3)) out << ", rain: " << clouds_.byFactor(0.5, 50.0) << " mm/h";
    return out;
  }

  std::string lightFromAbove() {
    Text out;
    if (!layered_ || dice_.chance(0.2)) out << "background: {temperature: " << (dice_.chance(0.3) ? 2.7 : dice_.between(100.0, 300.0)) << " K}\n";
    if (dice_.chance(0.65))
      out << "sun: {azimuth: " << dice_.between(0.0, 360.0) << " deg, elevation: " << (dice_.chance(0.35) ? dice_.between(-1.0, 3.0) : dice_.between(3.0, 89.0))
          << " deg, " << (dice_.chance(0.7) ? "temperature: 5772 K" : "irradiance: {library: solar_e490}") << "}\n";
    if (dice_.chance(0.6)) {
      if (more_.chance(0.2)) out << gradient();
      else if (layered_ && dice_.chance(0.7)) out << "ambient: {from: sky}\n";
      else out << "ambient: {temperature: " << dice_.between(220.0, 300.0) << " K}\n";
    }
    return out;
  }

  std::string gradient() {
    Text out;
    out << "ambient: {gradient: [{elevation: -90 deg, temperature: " << more_.between(250.0, 310.0)
        << " K}, {elevation: 0 deg, temperature: " << more_.between(250.0, 310.0) << " K}, ";
    if (more_.chance(0.5)) out << "{elevation: 0 deg, temperature: " << more_.between(200.0, 290.0) << " K}, ";
    return out << "{elevation: 90 deg, temperature: " << more_.between(180.0, 260.0) << " K}]}\n";
  }

  /// A spectrum over all that channels see, half of them with edges of a nanometre.
  std::string table(double least, double most) { return table(least, most, dice_); }
  static std::string table(double least, double most, RandomDice& dice) {
    std::vector<double> at = {0.3, 15.0};
    for (int k = dice.below(7); k >= 0; --k) at.push_back(dice.byFactor(0.4, 14.0));
    std::sort(at.begin(), at.end());
    const bool steps = dice.chance(0.5);
    Text out;
    out << "{wavelength: um, unit: \"1\", values: [";
    double last = 0.0;
    for (size_t k = 0; k < at.size(); ++k) {
      if (steps && k > 0 && at[k] - at[k - 1] > 2e-3) out << "[" << at[k] - 1e-3 << ", " << last << "], ";
      last = dice.between(least, most);
      out << "[" << at[k] << ", " << last << (k + 1 < at.size() ? "], " : "]");
    }
    return out << "]}";
  }

  /// A library material, or now and then one with a spectrum of its own.
  std::string opaque() {
    if (more_.chance(0.15)) return more_.chance(0.35) ? byTemperature() : lobed();
    if (dice_.chance(0.12)) return facets();
    if (!dice_.chance(0.15)) return dice_.of(kOpaque);
    Text name, row;
    name << "own_" << ++materialCount_;
    row << "  " << std::string(name) << ": {components: [{reflection: " << (dice_.chance(0.7) ? "lambertian" : "phong, exponent: 40")
        << ", reflectance: " << table(0.0, 0.95);
    if (dice_.chance(0.3)) row << ", modifier: {rows: [[" << dice_.unit() << ", " << dice_.unit() << "], [" << dice_.unit() << ", " << dice_.unit() << "]]}";
    materials_ += row << "}]}\n";
    return name;
  }
  /// Of models that the library has few of.
  std::string lobed() {
    Text name, row;
    name << "lobed_" << ++materialCount_;
    row << "  " << std::string(name) << ": {components: [{reflection: ";
    const std::string form = more_.chance(0.3) ? ", form: published" : "";
    switch (more_.below(5)) {
      case 0:
        row << "ward, reflectance: " << more_.between(0.05, 0.9) << ", roughness: " << more_.byFactor(0.05, 0.6);
        break;
      case 1:
        row << "sandford_robertson, emissivity: " << more_.between(0.2, 0.6) << ", diffuse: " << more_.between(0.05, 0.35)
            << ", grazing: " << more_.between(0.05, 0.6) << ", width: " << more_.byFactor(0.05, 0.8) << form;
        break;
      case 2:
        row << "beard_maxwell, n: " << more_.between(1.3, 3.0) << ", k: " << more_.byFactor(0.01, 3.0) << ", scan: " << more_.byFactor(1e-4, 5e-3)
            << ", width: " << more_.byFactor(0.1, 0.5) << ", tau: " << more_.between(10.0, 60.0) << " deg, omega: " << more_.between(10.0, 60.0)
            << " deg, diffuse: " << more_.between(0.0, 0.08) << ", volume: " << more_.between(0.0, 0.03);
        break;
      case 3:
        row << "sea, wind: " << more_.between(1.0, 14.0) << " m/s";
        break;
      default:
        row << "spectral_phong, diffuse: " << more_.between(0.05, 0.4) << ", specular: " << more_.between(0.1, 0.5)
            << ", exponent: {wavelength: um, unit: \"1\", values: [[0.3, " << more_.byFactor(3.0, 300.0) << "], [15, " << more_.byFactor(3.0, 3000.0) << "]]}";
    }
    materials_ += row << "}]}\n";
    return name;
  }
  /// Three temperatures, over all that bodies may have.
  std::string byTemperature() {
    Text name, row;
    name << "warmed_" << ++materialCount_;
    row << "  " << std::string(name) << ": {temperatures: [";
    for (double kelvin : {150.0, 1900.0, 3650.0})
      row << (kelvin > 150.0 ? ", " : "") << "{temperature: " << kelvin << " K, components: [{reflection: lambertian, reflectance: " << table(0.0, 0.95, more_)
          << "}]}";
    materials_ += row << "]}\n";
    return name;
  }
  /// Metal, glass over a pigment, or either under films, of any roughness.
  std::string facets() {
    Text name, row;
    name << "facets_" << ++materialCount_;
    row << "  " << std::string(name) << ": {components: [{reflection: microfacet, roughness: " << dice_.byFactor(0.02, 0.8)
        << ", slopes: " << (dice_.chance(0.7) ? "ggx" : "normal") << ", index: ";
    if (dice_.chance(0.5)) row << (dice_.chance(0.5) ? "titanium" : "{n: 0.6, k: 6}");
    else row << dice_.between(1.3, 2.5) << ", pigment: " << table(0.0, 0.9);
    if (dice_.chance(0.6)) {
      row << ", layers: [";
      for (int k = dice_.below(3); k >= 0; --k)
        row << "{index: {n: " << dice_.between(1.3, 3.5) << ", k: " << (dice_.chance(0.5) ? 0.0 : dice_.byFactor(1e-3, 3.0))
            << "}, thickness: " << dice_.byFactor(10.0, 3000.0) << " nm}" << (k > 0 ? ", " : "]");
    }
    materials_ += row << "}]}\n";
    return name;
  }
  std::string pane() {
    if (dice_.chance(0.15)) {
      Text name, row;
      name << "coated_" << ++materialCount_;
      row << "  " << std::string(name) << ": {components: [{reflection: microfacet, roughness: 0.02, index: {n: " << dice_.between(1.4, 4.0)
          << ", k: " << dice_.byFactor(1e-8, 1e-5) << "}, thickness: " << dice_.between(1.0, 8.0) << " mm, layers: [{index: " << dice_.between(1.3, 2.4)
          << ", thickness: " << dice_.byFactor(50.0, 2000.0) << " nm}]}]}\n";
      materials_ += row;
      return name;
    }
    if (!dice_.chance(0.25)) return dice_.of(kPanes);
    Text name, row;
    name << "pane_" << ++materialCount_;
    row << "  " << std::string(name) << ": {transmission: {transmittance: " << table(dice_.chance(0.3) ? 0.0 : 0.05, 0.95)
        << "}, components: " << (dice_.chance(0.5) ? "[]}\n" : "[{reflection: lambertian, reflectance: 0.04}]}\n");
    materials_ += row;
    return name;
  }

  std::string temperature(double kelvin) {
    Text out;
    if (!dice_.chance(0.1)) return out << kelvin << " K";
    return out << "{rows: [[" << kelvin << " K, " << kelvin * dice_.between(0.9, 1.2) << " K], [" << kelvin * dice_.between(0.9, 1.2) << " K, " << kelvin
               << " K]]}";
  }

  std::string groundPlate() {
    Text out;
    return out << "  - {name: ground, shape: {model: plate, width: 200 km, height: 200 km}, pitch: 90 deg, material: " << dice_.of(kGround)
               << ", temperature: " << dice_.between(255.0, 320.0) << " K, position: [0 m, 0 m, 0 m]}\n";
  }

  std::string shape(double size) {
    Text out;
    switch (dice_.below(7)) {
      case 0:
        out << "{model: sphere, radius: " << 0.5 * size;
        break;
      case 1:
        out << "{model: box, length: " << size << " m, width: " << dice_.between(0.3, 1.0) * size << " m, height: " << dice_.between(0.3, 1.0) * size;
        break;
      case 2:
        out << "{model: cylinder, radius: " << dice_.between(0.15, 0.5) * size << " m, length: " << size;
        break;
      case 3:
        out << "{model: cone, radius: " << dice_.between(0.15, 0.5) * size << " m, top_radius: " << dice_.between(0.0, 0.4) * size << " m, length: " << size;
        break;
      case 4:
        out << "{model: disc, radius: " << 0.5 * size;
        break;
      case 5:
        out << "{model: ellipsoid, length: " << size << " m, width: " << dice_.between(0.3, 1.0) * size << " m, height: " << dice_.between(0.3, 1.0) * size;
        break;
      default:
        out << "{model: plate, width: " << size << " m, height: " << dice_.between(0.3, 1.0) * size;
    }
    return out << " m}";
  }

  Place near(const Place& p, double x_m, double y_m, double z_m) {
    return {p.x + dice_.between(-x_m, x_m), p.y + dice_.between(-y_m, y_m), p.z + dice_.between(-z_m, z_m)};
  }

  std::string cluster() {
    Text out;
    const int count = 1 + dice_.below(4);
    for (int b = 0; b < count; ++b) {
      // Now and then a body of less than a pixel.
      const double size = dice_.chance(0.25) ? dice_.byFactor(0.05, 1.0) * fieldAtTarget_m_ / kFilm_px : size_m_ * dice_.between(0.3, 1.0);
      const double spread_m = (b == 0 ? 0.2 : 0.9) * size_m_, reach_m = 0.3 * std::max(size_m_, size);
      Place at = near(target_, spread_m, spread_m, spread_m);
      if (ground_) at.z = std::max(at.z, 0.6 * size);
      out << "  - {name: b" << b << ", shape: " << shape(size) << ", material: " << opaque() << ", temperature: " << temperature(kelvin());
      if (frames_ > 1 && dice_.chance(0.4)) {
        Place to = near(at, reach_m, reach_m, reach_m);
        to.z = std::max(to.z, at.z);
        out << ", motion: [{time: 0 s, position: " << at << ", heading: " << dice_.between(0.0, 360.0) << " deg}, {time: 2 s, position: " << to << "}]}\n";
      } else {
        out << ", position: " << at << ", heading: " << dice_.between(0.0, 360.0) << " deg, pitch: " << (dice_.chance(0.5) ? 0.0 : dice_.between(-60.0, 60.0))
            << " deg}\n";
      }
    }
    return out;
  }

  std::string medium(const std::string& name, const Place& at, double radius_m, bool trueForm) {
    const std::string material = dice_.of(kMedia);
    const double usual_K = material == "afterburner_plume" ? 1800.0 : material == "jet_exhaust" ? 850.0 : material == "jet_exhaust_mixed" ? 500.0 : 350.0;
    Text out;
    out << "  - {name: " << name << ", shape: {model: ";
    switch (dice_.below(trueForm ? 4 : 5)) {
      case 0:
        out << "sphere, radius: " << radius_m;
        break;
      case 1:
        out << "cylinder, radius: " << 0.5 * radius_m << " m, length: " << dice_.between(0.5, 1.6) * radius_m;
        break;
      case 2:
        out << "cone, radius: " << 0.3 * radius_m << " m, top_radius: " << 0.5 * radius_m << " m, length: " << 1.6 * radius_m;
        break;
      case 3:
        out << "ellipsoid, length: " << 2.0 * radius_m << " m, width: " << radius_m << " m, height: " << dice_.between(0.3, 1.0) * radius_m;
        break;
      default:
        out << "box, length: " << radius_m << " m, width: " << dice_.between(0.3, 1.0) * radius_m << " m, height: " << dice_.between(0.3, 1.0) * radius_m;
    }
    return out << " m}, material: " << material << ", temperature: " << usual_K * dice_.between(0.8, 1.2) << " K, position: " << at
               << ", heading: " << dice_.between(0.0, 360.0) << " deg}\n";
  }

  /// 0 to 4 transparent things, each in a stretch of the line of sight of its own, so that no two cross.
  std::string row() {
    Text out;
    const int count = dice_.weighted({0.25, 0.25, 0.2, 0.15, 0.15});
    hasRow_ = count > 0;
    first_m_ = 0.03 * range_m_;
    const double last_m = range_m_ - 2.5 * size_m_, slot_m = (last_m - first_m_) / std::max(count, 1);
    for (int k = 0; k < count; ++k) {
      const double middle_m = first_m_ + (k + 0.5) * slot_m, field_m = middle_m * 2.0 * std::tan(0.5 * field_rad_);
      const std::string name = "w" + std::to_string(k);
      switch (dice_.weighted({0.6, 0.3, k == 0 ? 0.1 : 0.0})) {
        case 0: {
          const double width_m = field_m * (dice_.chance(0.6) ? dice_.between(1.6, 3.0) : dice_.between(0.2, 1.0));
          // What keeps its edges within its own stretch.
          const double most_rad = std::min(std::asin(std::min(0.8 * slot_m / width_m, 1.0)), 40.0 * kDegree);
          const double aside_m = width_m < field_m ? 0.3 * field_m : 0.0;
          out << "  - {name: " << name << ", shape: {model: plate, width: " << width_m << " m, height: " << width_m << " m}, material: " << pane()
              << ", temperature: " << (dice_.chance(0.7) ? dice_.between(250.0, 330.0) : dice_.between(200.0, 700.0))
              << " K, position: " << near(along(middle_m), aside_m, 0.0, 0.0) << ", heading: " << 180.0 + dice_.between(-most_rad, most_rad) / kDegree
              << " deg, pitch: " << -rise_ / kDegree << " deg}\n";
          break;
        }
        case 1: {
          const double radius_m = std::min(field_m * dice_.byFactor(0.05, 1.0), 0.4 * slot_m);
          const bool pair = dice_.chance(0.3);
          Place at = near(along(middle_m), 0.3 * field_m, 0.0, 0.3 * field_m);
          out << medium(name, at, pair ? 0.7 * radius_m : radius_m, pair);
          at.x += 0.2 * radius_m;
          if (pair) out << medium(name + "b", at, 0.4 * radius_m, true);
          break;
        }
        default:
          dome_ = true;
          out << "  - {name: " << name << ", shape: {model: sphere, radius: " << std::min(first_m_ + 0.5 * slot_m, 10.0) << " m}, material: " << pane()
              << ", temperature: " << dice_.between(250.0, 420.0) << " K, position: " << eye_ << "}\n";
      }
    }
    return out;
  }

  std::string lampsNearby() {
    Text out;
    if (!dice_.chance(0.4)) return "";
    const int count = dice_.chance(0.2) ? 2 : 1;
    for (int l = 0; l < count; ++l) {
      const Place at{target_.x + dice_.between(-1.5, 1.5) * size_m_, target_.y - dice_.between(0.5, 2.0) * size_m_,
                     target_.z + dice_.between(0.0, 1.5) * size_m_};
      out << "  - {name: lamp" << l << ", intensity: {blackbody: " << dice_.between(1000.0, 3200.0)
          << " K, area: " << size_m_ * size_m_ * dice_.byFactor(1e-5, 0.1) << " m2}, radius: " << std::max(1e-6, 0.02 * size_m_) << " m, position: " << at;
      if (dice_.chance(0.3)) out << ", visible: false";
      if (frames_ > 1 && dice_.chance(0.4)) out << ", level: [[0 s, 1], [3 s, 0.2]]";
      out << "}\n";
    }
    return out;
  }

  /// On the film, across the line of sight [m].
  double acrossFilm_m(double distance_m) const { return distance_m * 2.0 * std::tan(0.5 * field_rad_); }
  /// Near the line of sight, above ground.
  Place inView(double distance_m, double share, double lowest_m) {
    const Place on = along(distance_m);
    const double off_m = share * acrossFilm_m(distance_m);
    return {on.x + field_.between(-off_m, off_m), on.y, std::max(on.z + field_.between(-off_m, off_m), lowest_m)};
  }

  /// Exhaust, a trail or flares, of their own dice: other scenes stay as they were. One a scene, and behind what stands in a row: a picture blends a field as
  /// a whole, before or behind what passes through it.
  std::string fields() {
    switch (kind_) {
      case Kind::Plume:
        return plume();
      case Kind::Smoke:
        return smoke();
      case Kind::Flare:
        return flare();
      default:
        return "";
    }
  }

  std::string species() {
    Text out;
    out << "{co2: " << field_.between(0.01, 0.15) << ", h2o: " << field_.between(0.01, 0.3);
    if (field_.chance(0.3)) out << ", co: " << field_.between(0.0, 0.3);
    if (field_.chance(0.4)) out << ", soot: " << field_.byFactor(1e-7, 1e-3);
    if (field_.chance(0.15)) out << ", alumina: " << field_.between(0.0, 0.4);
    return out << "}";
  }

  /// Nozzles of two fifths of a pixel to ten pixels.
  std::string plume() {
    struct Engine {
      const char* name;
      double diameter_m;  // of its stream, about
    };
    constexpr Engine kEngines[] = {{"turbofan_military", 0.5}, {"turbofan_afterburner", 0.6}, {"small_turbojet", 0.35},   {"turboshaft", 0.5},
                                   {"aluminised_motor", 0.12}, {"reduced_smoke_motor", 0.12}, {"double_base_motor", 0.12}};
    const Engine engine = field_.of(kEngines);
    const bool onBody = field_.chance(0.4), looksDown = ground_ && rise_ < -0.02;
    // The finer a jet is, the more lines the reference looks along in each of its pixels: it covers fewer of them.
    const double nozzles_px = field_.byFactor(0.4, 10.0), length_px = field_.byFactor(2.0, 4.0 + 12.0 * nozzles_px);
    double distance_m = range_m_ * (hasRow_ ? field_.between(1.0, 1.3) : field_.between(0.6, 1.3)),
           diameter_m = nozzles_px * acrossFilm_m(distance_m) / kFilm_px;
    if (onBody) distance_m = range_m_, diameter_m = nozzles_px * fieldAtTarget_m_ / kFilm_px;
    // An engine has its size: where it may stand anywhere, its distance is chosen instead.
    const bool byName = field_.chance(0.6) && (onBody || looksDown ? diameter_m < 3.0 * engine.diameter_m && diameter_m > engine.diameter_m / 3.0 : true);
    if (byName) {
      diameter_m = engine.diameter_m;
      if (!onBody && !looksDown) distance_m = diameter_m / nozzles_px * kFilm_px / (2.0 * std::tan(0.5 * field_rad_));
    }
    diameter_m = std::clamp(diameter_m, 0.002, 50.0);
    double length_m = std::clamp(length_px * acrossFilm_m(distance_m) / kFilm_px, 3.0 * diameter_m, 200.0 * diameter_m);
    Text out;
    out << "plumes:\n  - {name: p, ";
    const Place aside{0.0, 0.0, 2.0 * diameter_m};
    const bool pair = field_.chance(0.25);
    Place at, way;
    if (onBody) {
      if (hasRow_) length_m = std::min(length_m, 1.5 * size_m_);
      at = {-0.3 * size_m_, 0.0, 0.0};
      way = {-1.0, field_.between(-0.3, 0.3), field_.between(-0.3, 0.3)};
      out << "on: b0";
    } else {
      if (hasRow_) distance_m = std::max(distance_m, range_m_ + 0.4 * length_m - 1.5 * size_m_);
      way = {field_.between(-1.0, 1.0), field_.between(hasRow_ ? 0.0 : -1.0, 1.0), field_.between(-0.5, 0.5)};
      if (hasRow_) way.x = std::copysign(1.0, way.x), way.y *= 0.3;
      at = inView(distance_m, 0.25, ground_ ? diameter_m : -1e9);
      const double back_m = 0.3 * length_m / std::max(std::hypot(std::hypot(way.x, way.y), way.z), 1e-3);
      at = {at.x - back_m * way.x, at.y - back_m * way.y, std::max(at.z - back_m * way.z, ground_ ? diameter_m : -1e9)};
      if (hasRow_) at.y = std::max(at.y, along(distance_m).y);
    }
    if (pair) out << (onBody ? ", " : "") << "nozzles: [" << at << ", " << Place{at.x + aside.x, at.y + aside.y, at.z + aside.z} << "]";
    else out << (onBody ? ", " : "") << "position: " << at;
    out << ", direction: [" << way.x << ", " << way.y << ", " << way.z << "], ";
    if (byName) out << "engine: " << engine.name << ", begin: -1 s";
    else
      out << "nozzle: {diameter: " << diameter_m << " m, temperature: " << field_.between(400.0, 2800.0) << " K, speed: " << field_.byFactor(20.0, 2500.0)
          << " m/s, species: " << species() << "}";
    if (nozzles_px < 1.0 || field_.chance(0.7)) out << ", length: " << std::max(length_m, 0.02) << " m";
    if (field_.chance(0.2)) out << ", throttle: " << field_.between(0.1, 1.0);
    else if (field_.chance(0.2)) out << ", throttle: [[0 s, " << field_.between(0.2, 1.0) << "], [2 s, " << field_.between(0.2, 1.0) << "]]";
    out << "}\n";
    if (field_.chance(0.3)) out << wind(field_.between(0.0, 360.0));
    return out;
  }

  std::string wind(double from_deg) {
    Text out;
    return out << "wind: {speed: " << field_.byFactor(1.0, 15.0) << " m/s, direction: " << from_deg << " deg}\n";
  }

  /// Drifting with the wind, or blown out, over a part of the film.
  std::string smoke() {
    constexpr const char* kSmokes[] = {"white_phosphorus", "fog_oil", "mtv", "alumina", "soot"};
    double distance_m = range_m_ * field_.between(hasRow_ ? 1.0 : 0.6, 1.5);
    const double length_m = acrossFilm_m(distance_m) * field_.byFactor(0.15, 1.5), speed_m_s = field_.byFactor(1.0, 15.0);
    const double lasts_s = std::clamp(length_m / speed_m_s, 0.2, 100.0), pixel_m = acrossFilm_m(distance_m) / kFilm_px,
                 radius_m = std::clamp(std::max(length_m * field_.byFactor(0.01, 0.15), 0.3 * pixel_m), 0.005, 100.0);
    if (hasRow_) distance_m = std::max(distance_m, range_m_ + 0.5 * length_m - size_m_);
    const double east = field_.chance(0.5) ? 1.0 : -1.0;
    Place at = inView(distance_m, 0.2, ground_ ? radius_m : -1e9);
    at.x -= 0.5 * east * std::min(length_m, speed_m_s * lasts_s);
    Text out;
    out << "wind: {speed: " << speed_m_s << " m/s, direction: " << (east > 0.0 ? 270.0 : 90.0) + field_.between(-20.0, 20.0) << " deg}\n";
    out << "smokes:\n  - {name: s, ";
    if (field_.chance(0.75)) out << "smoke: " << field_.of(kSmokes);
    else out << "extinction: " << field_.byFactor(50.0, 2000.0) << " m2/kg, albedo: " << field_.unit() << ", asymmetry: " << field_.between(-0.3, 0.9);
    // An optical depth of 0.1 to 30 where a kilogram hides 1000 m2.
    out << ", position: " << at << ", rate: " << field_.byFactor(0.1, 30.0) * speed_m_s * 2.0 * radius_m / 1000.0 << " kg/s, begin: " << -lasts_s
        << " s, radius: " << radius_m << " m, lifetime: " << std::max(lasts_s * field_.between(0.5, 3.0), 0.2) << " s, puffs: " << 8 + field_.below(150);
    if (field_.chance(0.5)) out << ", temperature: " << field_.byFactor(300.0, 1500.0) << " K";
    if (field_.chance(0.4)) out << ", dissipation: " << field_.byFactor(1e-5, 1e-2) << " m2/s3, diffusivity: " << field_.byFactor(0.1, 10.0) << " m2/s";
    if (field_.chance(0.4))
      out << ", velocity: [" << east * field_.between(0.0, speed_m_s) << " m/s, 0 m/s, " << field_.between(0.0, 0.3 * speed_m_s) << " m/s]";
    return out << "}\n";
  }

  /// A cloud in view or between the sun and what is in it.
  std::string cumulus() {
    const double distance_m = std::max(range_m_ * heaps_.between(0.3, 3.0), 500.0), across_m = acrossFilm_m(distance_m),
                 width_m = std::clamp(across_m * heaps_.byFactor(0.1, 2.0), 50.0, 6000.0);
    const Place on = along(distance_m), at{on.x + across_m * heaps_.between(-0.4, 0.4), on.y + 0.5 * width_m,
                                           std::max(on.z + across_m * heaps_.between(-0.4, 0.4), ground_ ? 30.0 : -1e9)};
    Text out;
    out << "clouds:\n  - {name: heap, position: " << at << ", width: " << width_m << " m, seed: " << heaps_.below(1000)
        << ", resolution: 16, roughness: " << heaps_.unit();
    if (heaps_.chance(0.7)) out << ", optical_depth: " << heaps_.byFactor(0.5, 100.0);
    if (heaps_.chance(0.3)) out << ", radius: " << heaps_.byFactor(3.0, 30.0) << " um";
    return out << "}\n";
  }

  std::string flare() {
    constexpr const char* kTypes[] = {"mtv", "spectrally_matched", "pyrophoric"};
    // They are 0.2 m across, drawn out to some metres, and fly 30 m in a second.
    double distance_m = field_.byFactor(5.0, 300.0) / (2.0 * std::tan(0.5 * field_rad_));
    if (ground_ && rise_ < -0.02) distance_m = std::min(distance_m, range_m_);
    if (hasRow_) distance_m = std::max(distance_m, range_m_ + 20.0);
    const Place at = inView(distance_m, 0.2, ground_ ? 1.0 : -1e9);
    Text out;
    out << "flares:\n  - {name: f, type: " << field_.of(kTypes) << ", time: " << (frames_ > 1 ? field_.between(-1.0, 1.0) : field_.between(-1.0, -0.1))
        << " s, position: " << at << ", direction: [" << field_.between(-1.0, 1.0) << ", " << field_.between(hasRow_ ? 0.0 : -1.0, 1.0) << ", "
        << field_.between(0.1, 1.0) << "], speed: " << std::min(0.3 * acrossFilm_m(distance_m), 40.0) << " m/s";
    if (field_.chance(0.3)) out << ", smoke: " << (field_.chance(0.7) ? "false" : "soot");
    if (field_.chance(0.3)) out << ", sequence: {count: 2, interval: 0.3 s}";
    if (field_.chance(0.3)) out << ", light: false";
    return out << "}\n";
  }

  std::string response(int wavelengths) {
    Text out;
    if (dice_.chance(0.1) && wavelengths >= kLibraryResponse) return dice_.of(kResponses);
    const double width_um = dice_.byFactor(0.02, 12.0), centre_um = dice_.byFactor(0.41, 13.9);
    const double low = std::max(0.4, centre_um - 0.5 * width_um);
    double high = std::min(14.0, centre_um + 0.5 * width_um);
    while (binsBetween(low, high) > wavelengths && high - low > 0.02) high = low + 0.9 * (high - low);
    if (dice_.chance(0.8)) return out << "{band: [" << low << " um, " << high << " um]}";
    return out << "{wavelength: um, unit: \"1\", values: [[" << low << ", 0], [" << low + dice_.between(0.2, 0.8) * (high - low) << ", 1], [" << high
               << ", 0]]}";
  }

  std::string camera() {
    Text out;
    out << "cameras:\n  - name: c\n    film: {width: " << kFilm_px << ", height: " << kFilm_px << ", pitch: 20 um}\n    field_of_view: " << field_rad_ / kDegree
        << " deg\n    aperture: 50 mm\n    near: " << std::clamp(0.004 * range_m_, 1e-3, 0.1) << " m\n";
    if (dice_.chance(0.25)) out << "    samples: 2\n";
    if (dice_.chance(0.1)) out << "    small_bodies: 0\n";
    if (frames_ > 1 && !dome_ && dice_.chance(0.3))
      out << "    motion: [{time: 0 s, position: " << eye_ << "}, {time: 2 s, position: " << along(dice_.between(-0.5, 0.5) * first_m_) << "}]\n";
    else out << "    position: " << eye_ << "\n";
    out << "    look_at: " << target_ << "\n";
    // Of its own dice: other scenes stay as they were. Its base looks north, where the target about is.
    if (RandomDice(draw_.seed ^ 0x67696d62616cu).chance(0.15)) {
      const double level = std::atan2(target_.z - eye_.z, std::hypot(target_.x - eye_.x, target_.y - eye_.y)) / kDegree;
      out << "    heading: 0 deg\n    gimbal: {driver: truth, lag: 50 ms, azimuth: 40 deg, elevation: [" << std::max(-90.0, level - 12.0) << " deg, "
          << std::min(90.0, level + 12.0) << " deg]}\n";
    }
    out << "    channels:\n";
    const int channels = 1 + dice_.weighted({0.4, 0.4, 0.2});
    for (int c = 0; c < channels; ++c)
      out << "      - {name: c" << c << ", response: " << response(draw_.mostWavelengths / channels) << ", output: radiance}\n";
    return out;
  }

  /// Of the longest library response used, about: 1.7 to 5.8 um.
  static constexpr int kLibraryResponse = 1400;
  ScenarioDraw draw_;
  RandomDice dice_;
  RandomDice more_;   ///< of what came later: other scenes stay as they were
  RandomDice field_;  ///< of fields
  RandomDice clouds_{draw_.seed, 5};
  RandomDice heaps_{draw_.seed, 6};  ///< of cumulus clouds
  bool heap_ = false;
  /// Wavelengths of the reference in scenes with fields: each pixel of these is a hundred steps along up to some hundred lines.
  static constexpr int kWithFields = 40;
  enum class Kind { None, Plume, Smoke, Flare };
  Kind kind_ = Kind::None;
  bool hasRow_ = false;
  double range_m_ = 1.0, field_rad_ = 1.0, size_m_ = 1.0, fieldAtTarget_m_ = 1.0, rise_ = 0.0, first_m_ = 0.0;
  Place eye_, target_;
  bool ground_ = false, layered_ = false, dome_ = false;
  int frames_ = 1, materialCount_ = 0;
  std::string materials_;
};

}  // namespace

std::string randomScenario(const ScenarioDraw& draw) { return Composer(draw).compose(); }

}  // namespace pitviper::test
