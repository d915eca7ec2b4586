#include "atmosphere/aerosol_types.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "sim/parameters/csv_table.hpp"

namespace pitviper {
namespace {

/// What LOWTRAN has, and no droplet is larger beyond.
constexpr double kDampest_percent = 99.0;

/// One of a file's blocks: a humidity [%], a wind [m/s] or a radius [um].
struct Block {
  double by = 0.0;
  AerosolOptics optics;
};

std::vector<Block> blocksOf(const CsvTable& t) {
  if (t.columns.size() != 5)
    throw UserError({t.file, 1, 1, -1}, "not an aerosol", "humidity, wind or radius, wavelength, extinction, albedo, asymmetry", "correct the header");
  std::vector<Block> all;
  for (std::size_t row = 0; row < t.rows(); ++row) {
    if (all.empty() || all.back().by != t.at(row, 0)) all.emplace_back().by = t.at(row, 0);
    AerosolOptics& o = all.back().optics;
    const double um = t.at(row, 1), extinction = t.at(row, 2), albedo = t.at(row, 3), asymmetry = t.at(row, 4);
    if (!(extinction > 0.0 && albedo >= 0.0 && albedo <= 1.0 && std::abs(asymmetry) < 1.0) || (!o.wavelength_um.empty() && !(um > o.wavelength_um.back())))
      throw UserError(t.whereOf(row), "a row that no aerosol has", "rising wavelengths, extinction above 0, albedo 0 to 1, asymmetry within -1 and 1",
                      "correct the row");
    o.wavelength_um.push_back(um), o.extinction.push_back(extinction), o.albedo.push_back(albedo), o.asymmetry.push_back(asymmetry);
  }
  for (const Block& b : all)
    if (b.optics.wavelength_um != all.front().optics.wavelength_um)
      throw UserError({t.file, 1, 1, -1}, "blocks of other wavelengths than the first", "the same in each", "complete the blocks");
  if (all.empty()) throw UserError({t.file, 1, 1, -1}, "an aerosol without rows", "rows by wavelength", "add rows");
  return all;
}

/// `share` of the second.
AerosolOptics mixed(const AerosolOptics& a, const AerosolOptics& b, double share, bool logAsymmetry) {
  AerosolOptics out = a;
  const auto geometric = [&](double x, double y) { return x > 0.0 && y > 0.0 ? x * std::pow(y / x, share) : x + share * (y - x); };
  for (std::size_t i = 0; i < a.extinction.size(); ++i) {
    out.extinction[i] = geometric(a.extinction[i], b.extinction[i]);
    const double absorbed = geometric(a.extinction[i] * (1.0 - a.albedo[i]), b.extinction[i] * (1.0 - b.albedo[i]));
    out.albedo[i] = std::clamp(1.0 - absorbed / out.extinction[i], 0.0, 1.0);
    out.asymmetry[i] = logAsymmetry ? geometric(a.asymmetry[i], b.asymmetry[i]) : a.asymmetry[i] + share * (b.asymmetry[i] - a.asymmetry[i]);
  }
  return out;
}

}  // namespace

AerosolOptics::At AerosolOptics::at(double um) const {
  const auto over = std::upper_bound(wavelength_um.begin(), wavelength_um.end(), um);
  if (over == wavelength_um.begin()) return {extinction.front(), albedo.front(), asymmetry.front()};
  if (over == wavelength_um.end()) return {extinction.back(), albedo.back(), asymmetry.back()};
  const auto k = static_cast<std::size_t>(over - wavelength_um.begin());
  const double f = (um - wavelength_um[k - 1]) / (wavelength_um[k] - wavelength_um[k - 1]);
  const double own = extinction[k - 1] + f * (extinction[k] - extinction[k - 1]);
  const double before = extinction[k - 1] * (1.0 - albedo[k - 1]), after = extinction[k] * (1.0 - albedo[k]);
  return {own, 1.0 - (before + f * (after - before)) / own, asymmetry[k - 1] + f * (asymmetry[k] - asymmetry[k - 1])};
}

const std::vector<std::string>& aerosolTypes() {
  static const std::vector<std::string> all{"rural", "urban", "maritime", "tropospheric", "desert", "advection_fog", "radiation_fog"};
  return all;
}

bool isFog(const std::string& type) { return type.ends_with("_fog"); }
bool goesByWind(const std::string& type) { return type == "desert"; }

namespace {

/// What the library has of a kind, between the blocks beside `asked`, over its extinction at 0.55 um. `scale`: what its law is even in.
AerosolOptics betweenBlocks(const std::string& kind, double asked, const std::function<double(double)>& scale, bool logAsymmetry,
                            const std::filesystem::path& library, const Location& askedAt) {
  const CsvTable t = readCsvTable(library / "aerosols" / (kind + ".csv"),
                                  {.what = "an aerosol of the library", .mostBytes = 1u << 20, .fix = "check the library"}, 10000, askedAt);
  const std::vector<Block> all = blocksOf(t);
  const auto over = std::upper_bound(all.begin(), all.end(), asked, [](double v, const Block& b) { return v < b.by; });
  AerosolOptics out;
  if (over == all.begin()) out = all.front().optics;
  else if (over == all.end()) out = all.back().optics;
  else {
    const Block &low = *(over - 1), &high = *over;
    out = mixed(low.optics, high.optics, (scale(asked) - scale(low.by)) / (scale(high.by) - scale(low.by)), logAsymmetry);
  }
  const double usual = out.at(0.55).extinction;
  for (double& e : out.extinction) e /= usual;
  return out;
}

}  // namespace

AerosolOptics aerosolOf(const std::string& type, double humidity, double wind_m_s, const std::filesystem::path& library, const Location& askedAt) {
  if (goesByWind(type))
    return betweenBlocks(
        type, wind_m_s, [](double v) { return v; }, false, library, askedAt);
  return betweenBlocks(
      type, std::min(100.0 * humidity, kDampest_percent), [](double v) { return std::log(100.0 - v); }, true, library, askedAt);
}

AerosolOptics dropsOf(const std::string& kind, double radius_um, const std::filesystem::path& library, const Location& askedAt) {
  return betweenBlocks(
      kind, radius_um, [](double v) { return std::log(v); }, false, library, askedAt);
}

}  // namespace pitviper
