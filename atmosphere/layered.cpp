#include "atmosphere/layered.hpp"

#include <algorithm>
#include <cmath>

#include "atmosphere/scattered_sun.hpp"
#include "sim/radiometry/spectrum.hpp"

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

class Layered final : public Path {
 public:
  explicit Layered(AbsorberTable table) : table_(std::move(table)) {
    for (const Absorber& a : table_.absorbers()) exponents_.push_back(a.exponent);
  }
  std::string slotFile() const override { return "atmosphere/layered_nodes.glsl"; }
  std::string channelSlotFile() const override { return "atmosphere/layered_channels.glsl"; }
  bool isLayered() const override { return true; }
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

std::shared_ptr<const Path> makeLayeredAir(AbsorberTable table) { return std::make_shared<Layered>(std::move(table)); }

}  // namespace pitviper
