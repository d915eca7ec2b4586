#include "atmosphere/layered.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <stdexcept>

#include "atmosphere/bent_path.hpp"
#include "atmosphere/clouds.hpp"
#include "atmosphere/layered_fit.hpp"
#include "atmosphere/layered_gpu.hpp"
#include "atmosphere/models.hpp"
#include "atmosphere/scattered_sun.hpp"
#include "sim/model/refracts.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/mie.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/world/haze_not_fog.hpp"

namespace pitviper {
namespace {

static_assert(kMostAbsorbers <= kMostAirAmounts);

/// n - 1 of standard air where the eye sees best; from 2 um on it is 1.6 % less.
double refractivity() { return airRefractivity(0.574); }

AirStation stationOf(const PathStation& s) {
  AirStation station;
  station.range_m = s.range_m;
  station.height_m = s.height_m;
  station.temperature_K = s.temperature_K;
  std::copy(s.amounts.amount_km.begin(), s.amounts.amount_km.end(), station.amounts.amount.begin());
  return station;
}

class Layered final : public Atmosphere, public HasHaze, public Refracts {
 public:
  explicit Layered(AbsorberTable table) : table_(std::move(table)) {
    for (const Absorber& a : table_.absorbers()) exponents_.push_back(a.exponent);
    const AbsorberAmounts above = table_.amounts(0.0, 1.0, INFINITY, 6371e3);
    for (size_t k = 0; k < exponents_.size(); ++k) column_[k] = above.amount_km[k];
    for (const AbsorberTable::Layer& l : table_.layers()) shells_.push_back({static_cast<int>(l.absorber), l.of.low_m, l.of.high_m, 1e-3 * l.of.perKm});
  }
  AirTraits traits() const override { return {.variesAlongWay = true, .scattersSun = true, .liesOnGround = true, .isBanded = true}; }
  std::unique_ptr<AirOnGpu> onGpu(const Simulation& simulation, const Plan& plan, bool perChannel) const override {
    return std::make_unique<LayeredOnGpu>(simulation, plan, perChannel);
  }
  std::vector<double> planTables(const AirTableRequest& request) const override { return planLayeredTables(request); }
  double groundTemperature_K() const override { return table_.temperature_K(0.0); }
  std::span<const double> exponents() const override { return exponents_; }
  AirNode node(double w) const override {
    AirNode n;
    const auto c = table_.coefficients(w);
    std::copy(c.begin(), c.end(), n.extinction.begin());
    const auto absorbers = table_.absorbers();
    // Haze and the aerosol above it are one kind of particles, their mean by what a column of the air has of them; each cloud is its own.
    const double albedo = table_.hazeAlbedo(w), above = table_.aerosolAlbedo(w), asymmetryAbove = asymmetry_(w);
    const double asymmetry = table_.hazeAsymmetry(w).value_or(asymmetryAbove);
    double turned = 0.0, scattered = 0.0;
    const auto isHazy = [&](size_t k) { return absorbers[k].kind == AbsorberKind::Haze || absorbers[k].kind == AbsorberKind::Aerosol; };
    for (size_t k = 0; k < absorbers.size(); ++k) {
      if (absorbers[k].kind == AbsorberKind::Scattering) n.molecules[k] = c[k];
      if (!isHazy(k)) continue;
      const bool isHaze = absorbers[k].kind == AbsorberKind::Haze;
      n.haze[k] = (isHaze ? albedo : above) * c[k];
      turned += column_[k] * n.haze[k] * (isHaze ? asymmetry : asymmetryAbove), scattered += column_[k] * n.haze[k];
    }
    n.meanAsymmetry = scattered > 0.0 && asymmetry != asymmetryAbove ? turned / scattered : asymmetryAbove;
    for (size_t k = 0; k < absorbers.size(); ++k)
      if (isHazy(k)) n.asymmetry[k] = n.meanAsymmetry;
    if (shells_.empty()) return n;
    turned = n.meanAsymmetry * scattered;
    for (const AbsorberTable::Layer& l : table_.layers()) {
      const size_t k = l.absorber;
      const AerosolOptics::At own = l.of.optics.at(w);
      n.haze[k] = own.albedo * c[k], n.asymmetry[k] = own.asymmetry;
      const double column = l.of.perKm * 1e-3 * (l.of.high_m - l.of.low_m);
      turned += column * n.haze[k] * own.asymmetry, scattered += column * n.haze[k];
    }
    if (scattered > 0.0) n.meanAsymmetry = turned / scattered;
    return n;
  }
  double top_m() const override { return table_.top_m(); }
  AirAmounts amounts(const AirRay& ray, double range_m) const override {
    const AbsorberAmounts found = table_.amounts(ray.height_m, ray.sinElevation, range_m, ray.earthRadius_m);
    AirAmounts a;
    std::copy(found.amount_km.begin(), found.amount_km.end(), a.amount.begin());
    return a;
  }
  std::vector<AirStation> stations(const AirRay& ray, double range_m) const override {
    std::vector<AirStation> all;
    for (const PathStation& s : table_.stations(ray.height_m, ray.sinElevation, range_m, ray.earthRadius_m)) all.push_back(stationOf(s));
    return all;
  }
  std::vector<double> placesAlong(const AirRay& ray, double range_m) const override {
    return table_.placesAlong(ray.height_m, ray.sinElevation, range_m, ray.earthRadius_m);
  }
  std::vector<AirStation> stationsAt(const AirRay& ray, std::span<const double> ranges_m) const override {
    std::vector<AirStation> all;
    for (const PathStation& s : table_.stationsAt(ray.height_m, ray.sinElevation, ranges_m, ray.earthRadius_m)) all.push_back(stationOf(s));
    return all;
  }
  std::span<const AirShell> shells() const override { return shells_; }
  AirAmounts densities(double height_m) const override {
    const AbsorberAmounts found = table_.densities(height_m);
    AirAmounts a;
    std::copy(found.amount_km.begin(), found.amount_km.end(), a.amount.begin());
    return a;
  }
  double hazePer_km(double w) const override {
    const auto c = table_.coefficients(w);
    const auto here = table_.densities(0.0);
    double sum = 0.0;
    for (size_t k = 0; k < table_.absorbers().size(); ++k)
      if (table_.absorbers()[k].kind == AbsorberKind::Haze) sum += c[k] * here.amount_km[k];
    return sum;
  }
  std::optional<double> refractionCoefficient(double height_m) const override { return table_.refractionCoefficient(refractivity(), height_m); }
  double bending_rad(double height_m, double sinElevation, double earthRadius_m) const override {
    return bendingFromSpace(table_, refractivity(), height_m, sinElevation, earthRadius_m);
  }
  std::shared_ptr<const Atmosphere> bent(double coefficient) const override {
    AbsorberTable table = table_;
    return table.setRefraction(refractivity(), coefficient) ? std::make_shared<Layered>(std::move(table)) : nullptr;
  }
  bool bends() const override { return table_.refracts(); }
  double straightened_m(double height_m) const override { return table_.opticalOf(height_m); }
  double bentBack_m(double straightened_m) const override { return table_.heightOf(straightened_m); }
  double hazeAbsorbs(double w) const override { return 1.0 - table_.hazeAlbedo(w); }
  double validLow_um() const override { return table_.validLow_um(); }
  double validHigh_um() const override { return table_.validHigh_um(); }
  std::vector<double> knots_um() const override { return table_.knots_um(); }
  void addTo(Fingerprint& f) const override { table_.addTo(f.add("layered")); }

 private:
  AbsorberTable table_;
  std::vector<double> exponents_;
  std::vector<AirShell> shells_;
  std::array<double, kMostAbsorbers> column_{};  ///< amounts from the ground straight up
  Spectrum asymmetry_ = ruralAsymmetry();
};

}  // namespace

std::shared_ptr<const Atmosphere> makeLayeredAir(AbsorberTable table) { return std::make_shared<Layered>(std::move(table)); }

namespace {

/// What the absorbers were fitted over is far within.
constexpr double kColdest_K = 100.0, kWarmest_K = 500.0;
/// Clearer air than this is haze or fog, thicker is fog alone: haze would grow to droplets of other spectra.
constexpr double kThickestHaze_m = 500.0;
/// A sounding begins no higher above the ground; drier air than this has no humidity that could be scaled.
constexpr double kHighestFirst_m = 1000.0, kDry = 0.005;
/// An aerosol of one's own.
constexpr const char* kParticles = "particles";
/// Humidity by which aerosols go where a table does not say its own: Shettle and Fenn's usual one.
constexpr double kUsualHumidity = 0.7, kUsualWind_m_s = 10.0;

std::vector<std::string> climates() {
  return {"tropical", "midlatitude_summer", "midlatitude_winter", "subarctic_summer", "subarctic_winter", "us_standard_1976"};
}

/// Spheres of one substance in a log-normal distribution of sizes.
AerosolOptics particlesOf(const AirRecord& air) {
  constexpr double kFrom_um = 0.25, kTo_um = 16.0;
  constexpr int kSteps = 120;
  const Record& r = air.record;
  if (!r.given("particle_radius") || !r.given("particle_n"))
    throw UserError(r.where("aerosol"), "particles of no radius or refractive index", "'particle_radius' and 'particle_n'",
                    "add 'particle_radius: 0.1 um' and 'particle_n: 1.5'");
  const SizeDistribution sizes({LogNormalMode{1e6 * r.number("particle_radius"), std::log(r.number("particle_deviation")), 1.0}});
  const auto indexAt = [&](double um) {
    return std::complex<double>(air.spectrum("particle_n")(um), r.given("particle_k") ? air.spectrum("particle_k")(um) : 0.0);
  };
  std::vector<double> um{0.55};
  for (int i = 0; i <= kSteps; ++i) um.push_back(kFrom_um * std::pow(kTo_um / kFrom_um, i / double(kSteps)));
  for (const char* key : {"particle_n", "particle_k"})
    if (r.given(key))
      for (double w : air.spectrum(key).knots())
        if (w > kFrom_um && w < kTo_um) um.push_back(w);
  std::sort(um.begin(), um.end());
  um.erase(std::unique(um.begin(), um.end(), [](double a, double b) { return b - a < 1e-6 * a; }), um.end());
  // What the indices are not known of is not known of the air either.
  const auto known = [&](double w) {
    try {
      indexAt(w);
    } catch (const OutsideSpectrum&) {
      return false;
    }
    return true;
  };
  std::erase_if(um, [&](double w) { return !known(w); });
  if (um.empty() || um.front() > 0.55 || um.back() < 0.55)
    throw UserError(r.where("particle_n"), "a refractive index that is not known at 0.55 um, where the visibility is", "values from 0.55 um on, or a constant",
                    "extend the table");
  AerosolOptics out;
  // Between two steps of the search the last known one is the end.
  if (!known(kFrom_um)) out.knownLow_um = um.front();
  if (!known(kTo_um)) out.knownHigh_um = um.back();
  for (double w : um) {
    const ParticleOptics own = [&] {
      try {
        return opticsOf(sizes, indexAt(w), w, 2);
      } catch (const std::invalid_argument& e) {
        throw UserError(r.where("particle_radius"), std::string("particles that Mie's theory does not tell: ") + e.what(),
                        "sizes whose largest have at most 1e6 wavelengths around them, and n above 0", "make radius or deviation smaller");
      }
    }();
    if (!(own.extinction_um2 > 0.0))
      throw UserError(r.where("particle_n"), "particles that take nothing from light", "n other than 1, or k above 0", "correct the index");
    out.wavelength_um.push_back(w), out.extinction.push_back(own.extinction_um2), out.albedo.push_back(own.albedo), out.asymmetry.push_back(own.asymmetry);
  }
  const double usual = out.at(0.55).extinction;
  for (double& e : out.extinction) e /= usual;
  return out;
}

/// The profile that keys ask for; none: the table's own.
std::optional<AirProfile> profileOf(const AirRecord& air) {
  const Record& r = air.record;
  const bool isChanged = r.given("surface_temperature") || r.given("surface_pressure") || r.given("humidity");
  if (!r.given("climate") && !r.given("sounding") && !isChanged) return std::nullopt;
  const std::string climate = r.given("climate") ? r.text("climate") : "us_standard_1976";
  AirProfile profile = AirProfile::read(air.library / "climates" / (climate + ".csv"), r.given("climate") ? r.where("climate") : r.where());
  if (r.given("sounding")) {
    profile = AirProfile::read(air.folder / r.text("sounding"), r.where("sounding"), &profile);
    const double first_m = profile.levels().front().altitude_m, above_m = first_m - air.ground_m;
    if (above_m > kHighestFirst_m || profile.soundedTo_m() <= air.ground_m)
      throw UserError(r.where("sounding"),
                      above_m > kHighestFirst_m ? print("a sounding that begins %g m above the ground", above_m)
                                                : print("a sounding that ends at %g m, below the ground at %g m", profile.soundedTo_m(), air.ground_m),
                      "altitudes above the sea, from the ground on", "check the altitudes and their unit, and 'ground: {height}'");
  }
  profile.cutAt(air.ground_m);
  AirAtGround ground;
  if (r.given("surface_temperature")) ground.temperature_K = r.number("surface_temperature");
  if (r.given("surface_pressure")) ground.pressure_Pa = r.number("surface_pressure");
  if (r.given("humidity")) {
    ground.humidity = r.number("humidity");
    if (profile.humidity() < kDry && *ground.humidity > kDry)
      throw UserError(r.where("humidity"),
                      print("'humidity' scales that of the air by height, and the lowest air of this profile has %.2g", profile.humidity()),
                      "a profile with water in its lowest air", "correct the sounding's first row, or remove 'humidity'");
  }
  profile.setGround(ground);
  return profile;
}

}  // namespace

AbsorberTable readAirTable(const AirRecord& air) {
  const Record& r = air.record;
  const std::filesystem::path file = air.folder / r.text("table");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(r.where("table"), "there is no file '" + file.string() + "'", "an air table, its path relative to this file", "check the path");
  AbsorberTable table = AbsorberTable::read(file);
  const std::string aerosol = r.given("aerosol") ? r.text("aerosol") : "table";
  const bool isNamed = aerosol != "table" && aerosol != "none";
  const auto needs = [&](const char* key, bool holds, const std::string& what) {
    if (r.given(key) && !holds) throw UserError(r.where(key), std::string("'") + key + "' has no say here", what, std::string("remove '") + key + "'");
  };
  for (const char* key : {"particle_radius", "particle_deviation", "particle_n", "particle_k"})
    needs(key, aerosol == kParticles, "'aerosol: particles' beside it");
  needs("wind", isNamed && goesByWind(aerosol), "'aerosol: desert' beside it");
  needs("haze_top", aerosol != "none", "an aerosol");
  needs("temperature", !r.given("surface_temperature") && !r.given("sounding"), "a temperature that is the same everywhere, or one by height");
  if (r.given("visibility") && r.number("visibility") < kThickestHaze_m && !isFog(aerosol) && aerosol != kParticles)
    throw UserError(r.where("visibility"), "'visibility' is " + std::to_string(static_cast<int>(r.number("visibility"))) + " m, and the aerosol is no fog",
                    "at least 500 m, or a fog", "add 'aerosol: radiation_fog' or 'advection_fog'");
  const std::optional<AirProfile> profile = profileOf(air);
  if (profile) table.setProfile(*profile, r.where());
  if (air.ground_m != 0.0) table.setGround(air.ground_m);
  if (r.given("co2")) table.setCarbonDioxide(r.number("co2"), r.where("co2"));
  if (aerosol == kParticles) table.setHaze(particlesOf(air));
  else if (isNamed)
    table.setHaze(aerosolOf(aerosol, profile ? profile->humidity() : table.referenceHumidity().value_or(kUsualHumidity),
                            r.given("wind") ? r.number("wind") : kUsualWind_m_s, air.library, r.where("aerosol")));
  if (r.given("haze_top")) table.setHazeTop(r.number("haze_top"));
  if (r.given("visibility")) table.setVisibility(1e-3 * r.number("visibility"));
  if (r.given("aerosol")) aerosol == "none" ? table.removeAerosol() : table.restoreAerosol();
  if (r.given("temperature")) table.setTemperature(r.number("temperature"));
  addClouds(air, table);
  return table;
}

static std::vector<std::string> aerosols() {
  std::vector<std::string> all{"none", "table"};
  all.insert(all.end(), aerosolTypes().begin(), aerosolTypes().end());
  all.push_back(kParticles);
  return all;
}

AirModel layeredModel() {
  AirModel model{
      "layered",
      "Air with structure: absorbers and temperature by height, as a library air has them or a table.",
      {"table"},
      {required(text("table", "air table (.air) beside the scenario, its format at the head of atmosphere/library/us76_rural.air")),
       choice("climate", climates(), "temperature and gases by height, in place of the table's"),
       text("sounding",
            "the same as a radiosonde has them: CSV beside the scenario, its columns under `Air by climate, weather and aerosol`; above its last row as "
            "`climate`"),
       within(number("surface_temperature", "K", "of the lowest air: it changes by as much there, and less and less up to 11 km; relative humidity stays"), 180,
              340),
       within(number("surface_pressure", "Pa", "of the lowest air: pressure above in proportion"), 3e4, 1.1e5),
       within(number("humidity", "", "relative, of the lowest air: below 11 km in proportion"), 0.0, 1.0),
       within(number("co2", "", "carbon dioxide by volume, in place of the table's 330e-6; annual means: 369e-6 in 2000, 389e-6 in 2010, 412e-6 in 2020"), 1e-6,
              0.05),
       within(number("visibility", "m", "meteorological visibility of the haze; below 500 m of fogs and particles alone"), 20, 3e5),
       choice("aerosol", aerosols(), "without aerosol, with the table's, or another near the ground, by the humidity there; 23 km of visibility unless given"),
       within(number("wind", "m/s", "with `aerosol: desert`; 10 m/s unless given"), 0, 30),
       within(number("particle_radius", "m", "with `aerosol: particles`: median radius by number of spheres in a log-normal distribution"), 1e-9, 5e-5),
       withDefault(within(number("particle_deviation", "", "with it: geometric standard deviation of the radius"), 1.02, 4.0), "2"),
       within(spectrum("particle_n", "", "with it: refractive index; known at 0.55 um, where the visibility is; outside what it is known of the air is not"),
              0.01, 20.0),
       within(spectrum("particle_k", "", "with it: extinction index; 0 unless given"), 0.0, 20.0),
       within(number("haze_top", "m", "height up to which most of the aerosol near the ground lies; 2 km unless given"), 50, 10e3),
       within(number("temperature", "K", "the same at every height, in place of the table's"), kColdest_K, kWarmest_K)},
      [](const AirRecord& air) { return makeLayeredAir(readAirTable(air)); }};
  for (Parameter& p : cloudParameters()) model.parameters.push_back(std::move(p));
  return model;
}

}  // namespace pitviper
