#include "atmosphere/layered.hpp"

#include <algorithm>
#include <cmath>

#include "atmosphere/layered_fit.hpp"
#include "atmosphere/layered_gpu.hpp"
#include "atmosphere/models.hpp"
#include "atmosphere/scattered_sun.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/world/haze_not_fog.hpp"

namespace pitviper {
namespace {

static_assert(kMostAbsorbers <= kMostAirAmounts);

AirStation stationOf(const PathStation& s) {
  AirStation station;
  station.range_m = s.range_m;
  station.height_m = s.height_m;
  station.temperature_K = s.temperature_K;
  std::copy(s.amounts.amount_km.begin(), s.amounts.amount_km.end(), station.amounts.amount.begin());
  return station;
}

class Layered final : public Atmosphere, public HasHaze {
 public:
  explicit Layered(AbsorberTable table) : table_(std::move(table)) {
    for (const Absorber& a : table_.absorbers()) exponents_.push_back(a.exponent);
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
    const double albedo = table_.hazeAlbedo(w);
    for (size_t k = 0; k < absorbers.size(); ++k) {
      if (absorbers[k].kind == AbsorberKind::Scattering) n.molecules[k] = c[k];
      if (absorbers[k].kind == AbsorberKind::Haze || absorbers[k].kind == AbsorberKind::Aerosol) n.haze[k] = albedo * c[k];
    }
    n.asymmetry = asymmetry_(w);
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
  double hazeAbsorbs(double w) const override { return 1.0 - table_.hazeAlbedo(w); }
  double validLow_um() const override { return table_.validLow_um(); }
  double validHigh_um() const override { return table_.validHigh_um(); }
  std::vector<double> knots_um() const override { return table_.knots_um(); }
  void addTo(Fingerprint& f) const override { table_.addTo(f.add("layered")); }

 private:
  AbsorberTable table_;
  std::vector<double> exponents_;
  Spectrum asymmetry_ = ruralAsymmetry();
};

}  // namespace

std::shared_ptr<const Atmosphere> makeLayeredAir(AbsorberTable table) { return std::make_shared<Layered>(std::move(table)); }

namespace {

/// What the absorbers were fitted over is far within.
constexpr double kColdest_K = 100.0, kWarmest_K = 500.0;

}  // namespace

AbsorberTable readAirTable(const Record& r, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / r.text("table");
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(r.where("table"), "there is no file '" + file.string() + "'", "an air table, its path relative to this file", "check the path");
  AbsorberTable table = AbsorberTable::read(file);
  if (r.given("visibility")) table.setVisibility(1e-3 * r.number("visibility"));
  if (r.given("aerosol")) r.text("aerosol") == "none" ? table.removeAerosol() : table.restoreAerosol();
  if (r.given("temperature")) table.setTemperature(r.number("temperature"));
  return table;
}

AirModel layeredModel() {
  return {"layered",
          "Air with structure: absorbers and temperature by height, as a library air has them or a table.",
          {"table"},
          {required(text("table", "air table (.air) beside the scenario, its format at the head of atmosphere/library/us76_rural.air")),
           within(number("visibility", "m", "meteorological visibility of the haze"), 500, 3e5),
           choice("aerosol", {"none", "table"}, "without aerosol, or with the table's"),
           within(number("temperature", "K", "the same at every height, in place of the table's"), kColdest_K, kWarmest_K)},
          [](const AirRecord& air) { return makeLayeredAir(readAirTable(air.record, air.folder)); }};
}

}  // namespace pitviper
