#pragma once
// Air with structure: transmittance and thermal radiance of any path (level, slant, to space) from a few absorber amounts that are common
// to all wavelengths.
//
// Law: -ln tau(nu, path) = sum over k of c_k(nu) W_k(path)^a_k,  W_k = integral of n_k(h) ds.
//   tau transmittance of a band of 20 1/cm; nu wavenumber [1/cm]; n_k density of absorber k relative to sea level; s length along the path
//   [km]; c_k optical depth of the first kilometre; a_k = 1 for what obeys Beer's law (continua, scattering, aerosol), < 1 for bands of lines.
//   The form is LOWTRAN's (Kneizys et al. 1988, AFGL-TR-88-0177; Pierluissi and Maragoudakis 1986, AFGL-TR-86-0272).
// Because a band does not decay exponentially, parts of a path do not multiply: add their amounts, then take the exponential. So a light's leg
// and the camera's leg of reflected light are amounts(...) + amounts(...).
// The format of the files is at the head of each file, atmosphere/library/*.air.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <istream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "atmosphere/aerosol_types.hpp"
#include "atmosphere/air_profile.hpp"
#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

constexpr int kMostAbsorbers = 16;

/// What lies on a path: per absorber the length of sea-level air that would hold as much [km]. Unused places are 0.
struct AbsorberAmounts {
  std::array<double, kMostAbsorbers> amount_km{};

  AbsorberAmounts& operator+=(const AbsorberAmounts& other) {
    for (size_t k = 0; k < amount_km.size(); ++k) amount_km[k] += other.amount_km[k];
    return *this;
  }
  friend AbsorberAmounts operator+(AbsorberAmounts a, const AbsorberAmounts& b) { return a += b; }
};

enum class AbsorberKind { Gas, Scattering, Aerosol, Haze, Layer };
/// How a gas's density follows from pressure, temperature and mixing ratios: the words of the format.
enum class AbsorberLaw { None, Water, Ozone, Air, Self, Foreign, Pair };

struct Absorber {
  std::string name;
  double exponent = 1.0;
  AbsorberKind kind = AbsorberKind::Gas;
  AbsorberLaw law = AbsorberLaw::None;
  double byPressure = 0.0, byTemperature = 0.0;  ///< density x p^x T^-y
};

/// A cloud, or what falls out of one: particles that lie evenly between two heights.
struct ParticleLayer {
  AerosolOptics optics;
  double low_m = 0.0, high_m = 0.0;
  double perKm = 0.0;  ///< extinction at 0.55 um
};

/// A place on a path, with all that lies between its beginning and there.
struct PathStation {
  double range_m = 0.0;
  double temperature_K = 0.0;
  AbsorberAmounts amounts;
  double height_m = 0.0;
};

class AbsorberTable {
 public:
  /// Reads a file; `name` is for messages. Throws UserError with line and column at what is wrong.
  static AbsorberTable read(std::istream& in, const std::string& name);
  static AbsorberTable read(const std::filesystem::path& file);

  const std::string& title() const { return title_; }
  const std::string& source() const { return source_; }
  std::span<const Absorber> absorbers() const { return absorbers_; }
  double validLow_um() const;
  double validHigh_um() const;
  /// Relative humidity over water of the air in which densities of gases are 1; nothing where the table does not say.
  std::optional<double> referenceHumidity() const;
  /// Where the coefficients bend, rising.
  std::vector<double> knots_um() const;
  /// Height above which there is nothing.
  double top_m() const { return levels_.back().altitude_m; }
  /// Heights of the table's levels, rising: densities bend there.
  std::vector<double> levels_m() const;

  /// Scales the haze to another meteorological visibility, 0.5 to 300 km. Extinction at 0.55 um: 3.912 / V - 0.0116 per km.
  /// Source: Koschmieder's law less Rayleigh scattering, as LOWTRAN does. The haze keeps its profile: below 10 km of visibility LOWTRAN's
  /// own falls off less in the first kilometre, so that slant paths out of such haze are too clear here.
  void setVisibility(double visibility_km);
  /// Of another climate or day: temperature and gases; aerosols stay where they are. Errors: UserError at `where` for a table whose amounts have no laws.
  void setProfile(const AirProfile& profile, const Location& where);
  /// Carbon dioxide by volume. The same.
  void setCarbonDioxide(double fraction, const Location& where);
  /// Another aerosol in place of the haze, at the same visibility, and up to which height [m] instead of the table's 2 km: densities are stretched.
  void setHaze(const AerosolOptics& optics);
  void setHazeTop(double height_m);
  /// The ground stands so high above the sea: from here on heights are above it. Gases stay where they are; aerosol below 6 km is squeezed into what is left,
  /// as LOWTRAN 7 does (Kneizys et al. 1988, GNDALT).
  void setGround(double ground_m);
  /// Further particles, above the ground as it is now; the last to be set. Errors: UserError at `where` for more amounts than a table may have.
  void addLayer(const ParticleLayer& layer, const Location& where);
  struct Layer {
    std::size_t absorber = 0;
    ParticleLayer of;
  };
  const std::vector<Layer>& layers() const { return layers_; }
  /// The same temperature everywhere; densities stay as they are.
  void setTemperature(double temperature_K);
  /// No aerosol at all; setVisibility() brings it back.
  void removeAerosol();
  /// What was removed is as the table has it; an aerosol that is there stays as it is.
  void restoreAerosol();

  /// Lines bend from here on, as light does in this air: elevations are apparent ones where a line begins, ranges lengths along it. `standard`: n - 1 of
  /// standard air (airRefractivity()); `coefficient`: k by which the radius of the earth that lines are given is 1 / (1 - k) times the real one (LocalFrame).
  /// Law: n(r) r cos e = constant (Bouguer). With x = n r it is x cos e = constant, a straight line, of which a piece dx holds dr / dx as much path: lines stay
  ///   straight over levels that stand at their x. n - 1 goes with the density of air (the table's scatterer), x evenly between two levels, 1 km apart at most
  ///   up to 20 km.
  /// Valid: x rising with height (no ducts), else false and nothing has changed; so without a scatterer.
  /// Of what lies towards space within 0.3 % of Bouguer's law integrated finely (bentPath(); tests/unit/test_bent_air.cpp).
  bool setRefraction(double standard, double coefficient);
  /// n - 1 where the density of the scatterer is 1, from that of standard air (15 C, 1013.25 hPa); none: there is no scatterer.
  std::optional<double> refractivityPerDensity(double standard) const;
  bool refracts() const { return refracts_; }
  /// Heights as lines have them, which are straight over these, and back.
  double opticalOf(double height_m) const;
  double heightOf(double optical_m) const;
  /// Mean of -R dn/dh over the kilometre above a height; none: there is no scatterer.
  std::optional<double> refractionCoefficient(double standard, double height_m) const;
  /// Density of the scatterer relative to sea level; 0 where there is none.
  double airDensity(double height_m) const;

  /// Amounts on the line from a height, with the sine of its elevation there, as far as a range (may be infinite) over a spherical
  /// earth; the earth itself does not stop it. From either end the same to rounding. Straight unless setRefraction() says otherwise.
  /// Quadrature between each two neighbours of: the levels crossed, the lowest point of the line. By their middle and a series where densities change
  /// little, else kGaussPoints points of Gauss-Legendre.
  /// Relative error below 1e-6 of each amount against the same profiles integrated finely (tests/unit/test_absorber_table.cpp).
  /// What straight lines lack: between two given points it is of second order; of what lies towards space it is 0.4 % at a zenith angle of 80
  /// degrees (LOWTRAN's bent path, same profiles), 8 % of the air on the horizon (tests/unit/test_bent_path.cpp).
  AbsorberAmounts amounts(double height_m, double sinElevation, double range_m, double earthRadius_m) const;
  static constexpr int kGaussPoints = 6;

  /// The same at places along the way, for emission: at every level crossed and, closer together near the beginning, at (i / count)^2 of
  /// the part within the air, and at further ranges asked for. The first is at range 0 or where the air begins.
  std::vector<PathStation> stations(double height_m, double sinElevation, double range_m, double earthRadius_m, int count = 32,
                                    std::span<const double> alsoAt_m = {}) const;

  /// The ranges of these alone [m].
  std::vector<double> placesAlong(double height_m, double sinElevation, double range_m, double earthRadius_m, int count = 32) const;

  /// The same at given ranges alone, rising from 0 on; those before the air begins and beyond its end hold what there is as far as there.
  std::vector<PathStation> stationsAt(double height_m, double sinElevation, std::span<const double> ranges_m, double earthRadius_m) const;

  /// c_k at a wavelength [um]. Throws OutsideSpectrum outside valid...().
  std::array<double, kMostAbsorbers> coefficients(double wavelength_um) const;
  double opticalDepth(double wavelength_um, const AbsorberAmounts& amounts) const;
  double transmittance(double wavelength_um, const AbsorberAmounts& amounts) const;

  /// Thermal radiance of the path seen from its beginning [W/(m2 sr um)], all extinction taken as emitting, as LOWTRAN does
  /// (AirLight::emitted; with sunlight that is scattered: scattered_sun.hpp).
  ///   L = sum over stations of integral of B(T) dtau, B linear in optical depth between two stations.
  /// Converges as the stations get closer: count 32 is within 0.4 % of finer ones in the 3-5 and 8-12 um means.
  double pathRadiance(double wavelength_um, std::span<const PathStation> stations) const;
  double pathRadiance(double wavelength_um, double height_m, double sinElevation, double range_m, double earthRadius_m) const;

  /// Of the haze, for scattered light: albedo of single scattering, and what setHaze() gave of asymmetry.
  double hazeAlbedo(double wavelength_um) const;
  std::optional<double> hazeAsymmetry(double wavelength_um) const;
  /// Of the aerosol above.
  double aerosolAlbedo(double wavelength_um) const;
  /// Densities relative to sea level (the haze scaled to the visibility) and temperature at a height.
  AbsorberAmounts densities(double height_m) const;
  double temperature_K(double height_m) const;
  /// All of it.
  void addTo(Fingerprint& f) const;

 private:
  struct Level {
    double altitude_m = 0.0;
    double optical_m = 0.0;  ///< where it stands for lines: at its altitude, or where refraction puts it
    double temperature_K = 0.0;
    std::array<double, kMostAbsorbers> density{};
    std::array<double, kMostAbsorbers> logRatio{};  ///< ln of the next level's density over this one's; NaN where one of them is 0
  };
  struct Bin {
    double wavenumber_per_cm = 0.0;
    double albedo = 0.0;
    std::array<double, kMostAbsorbers> coefficient{};
  };
  /// Of the air in which densities of gases are 1.
  struct Reference {
    double pressure_Pa = 0.0, temperature_K = 0.0, water = 0.0, ozone = 0.0, carbonDioxide = 0.0;  ///< mole fractions
  };
  struct Range {
    size_t absorber = 0;
    double low_per_cm = 0.0, high_per_cm = 0.0;
  };
  friend class AbsorberTableReader;

  /// A line and what of it lies in the air.
  struct Way;
  /// Rising: these places and where densities bend.
  std::vector<double> placesOn(const Way& way, std::vector<double> cuts_m) const;
  std::vector<PathStation> stationsOn(const Way& way, std::vector<double> cuts_m, int points) const;
  static std::vector<double> closerNearBy(const Way& way, int count, std::span<const double> alsoAt_m);
  size_t intervalAt(double height_m) const;
  /// Length of path on a piece of a line within an interval, over that of the piece.
  double stretchOf(size_t interval) const;
  /// More levels, as the air is there.
  void addLevels(const std::vector<double>& heights_m);
  /// Where between an interval's levels a height lies: 0 to 1, beyond them for what is extrapolated.
  double partOf(size_t interval, double height_m) const;
  /// Densities at a place, or their mean over a short stretch around it: `half` how far either end is from it in parts of the interval, `bend` by how much the
  /// ends' mean lies above it.
  void addDensities(size_t interval, double part, double weight_km, AbsorberAmounts& sum, double half = 0.0, double bend = 0.0) const;
  double depthOf(const std::array<double, kMostAbsorbers>& coefficients, const AbsorberAmounts& amounts) const;
  std::pair<size_t, double> binAt(double wavelength_um) const;

  std::string title_, source_;
  double visibility_km_ = 23.0;                 ///< for which the coefficients stand
  std::array<double, kMostAbsorbers> scale_{};  ///< of each absorber's density: 1, or as the visibility asks
  void finishLevels();
  /// Of the table, as if nothing were scaled.
  std::array<double, kMostAbsorbers> tableDensities(double height_m) const;
  /// Levels anew at some of these heights.
  void relevel(std::vector<double> heights_m, const std::function<Level(double)>& levelAt);
  double hazeTop_m_ = 2000.0;  ///< up to which most of the haze lies
  std::vector<Layer> layers_;
  std::optional<Reference> reference_;
  std::vector<Range> carbonDioxide_;  ///< where an absorber is that
  std::optional<AerosolOptics> haze_;
  std::vector<Absorber> absorbers_;
  std::vector<Level> levels_;
  std::vector<double> steepest_;  ///< of each interval: the largest logarithm of the next level's density over this one's
  std::vector<Bin> bins_;
  double stretchAbove_ = 1.0;  ///< stretchOf() above the top
  bool refracts_ = false;
};

}  // namespace pitviper
