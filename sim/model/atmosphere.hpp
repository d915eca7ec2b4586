#pragma once
// The contract of the air: what lies between two points, and what it sends. `none` is a model too.
//
// Law: -ln tau = sum over absorbers k of c_k(lambda) W_k^a_k, with W_k the amount of an absorber on the path. A band's transmittance does not
// multiply along a path: amounts of parts, and of the two legs of reflected light, are added before the exponential.
#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/parameters/fingerprint.hpp"

namespace pitviper {

constexpr int kMostAirAmounts = 16;

/// What lies on a path, in units of the path model's own (homogeneous air: metres; layered air: kilometres of sea-level air). Unused places are 0.
struct AirAmounts {
  std::array<double, kMostAirAmounts> amount{};

  AirAmounts& operator+=(const AirAmounts& other) {
    for (size_t k = 0; k < amount.size(); ++k) amount[k] += other.amount[k];
    return *this;
  }
  friend AirAmounts operator+(AirAmounts a, const AirAmounts& b) { return a += b; }
};

/// The air at one wavelength, or averaged over several.
struct AirNode {
  std::array<double, kMostAirAmounts> extinction{};  ///< c_k: optical depth of one unit of each absorber
  std::array<double, kMostAirAmounts> molecules{};   ///< the part of it that molecules scatter ...
  std::array<double, kMostAirAmounts> haze{};        ///< ... and that particles scatter
  std::array<double, kMostAirAmounts> asymmetry{};   ///< of these particles: mean cosine of the angle they turn light by
  double meanAsymmetry = 0.0;                        ///< of all particles: over its phase function tables have what they turn, which changes evenly
  double source = 0.0;                               ///< radiance the air tends to at great depth besides thermal emission of its stations [W/(m2 sr um)]
};

/// Absorbers whose particles turn light alike at all of these nodes, a kind each.
using ParticleKinds = std::vector<std::vector<std::size_t>>;
ParticleKinds particleKinds(std::span<const AirNode> nodes);

/// A place on a path, with all that lies between its beginning and there.
struct AirStation {
  double range_m = 0.0;
  double height_m = 0.0;
  double temperature_K = 0.0;  ///< 0: emits nothing but AirNode::source
  AirAmounts amounts;
};

/// Where a path starts and which way it goes.
struct AirRay {
  double height_m = 0.0;      ///< LocalFrame::height
  double sinElevation = 0.0;  ///< of its direction, there
  double earthRadius_m = 0.0;
};

class Atmosphere;

/// Particles that lie evenly between two heights, with edges: tables by height leave them out, and what is on a way is added in closed form.
struct AirShell {
  int amount = 0;  ///< whose index they have
  double low_m = 0.0, high_m = 0.0;
  double per_m = 0.0;  ///< of the amount
};
/// Those of an air as its lines have them, which are straight over other heights where they bend (Refracts).
std::vector<AirShell> straightShells(const Atmosphere& air);
/// What a way holds of shells.
void addShells(const Atmosphere& air, const AirRay& ray, double range_m, AirAmounts& into);
/// Nothing of them.
void dropShells(std::span<const AirShell> shells, AirAmounts& from);
/// How close together places within shells lie: for tables, whose rows must lose the same as their neighbours, a ratio of 1.4 of amounts, else 2.
enum class Within { Lines, Tables };
/// Rising ranges, and between the first and the last of them those where a ray meets edges of shells and, within, places that lie closer together towards
/// edges, where light changes.
std::vector<double> withShellPlaces(const Atmosphere& air, const AirRay& ray, std::span<const double> ranges_m, Within within = Within::Lines);

/// What the kernel has to do for an air.
struct AirTraits {
  bool any = true;                  ///< false: lets everything through and sends nothing
  bool variesAlongWay = false;      ///< its temperature or what it scatters does: lines of sight are looked at in many places
  bool scattersSun = false;         ///< densities(), AirNode::molecules and haze are there
  bool liesOnGround = false;        ///< a scene in it has a ground, and a sky that lights
  bool isBanded = false;            ///< its extinction changes within nanometres: drawn to an accuracy where a scenario does not say otherwise
  bool linearBetweenKnots = false;  ///< its reference needs no other wavelengths
};

class AirOnGpu;
struct AirTableRequest;
struct Simulation;
struct Plan;

class Atmosphere {
 public:
  virtual ~Atmosphere() = default;
  virtual AirTraits traits() const { return {}; }
  /// Its half on the GPU (sim/render/assembly/air_on_gpu.hpp), for pictures of a plan. `perChannel`: shading integrates over the channels (direct mode), so
  /// path radiance may be integrated over them beforehand. All must outlive it; needs a current GlContext.
  virtual std::unique_ptr<AirOnGpu> onGpu(const Simulation& simulation, const Plan& plan, bool perChannel) const = 0;
  /// Chooses how large the tables are that this half reads (Plan::air), and says what they lose, per slot; empty: nothing, there are none.
  virtual std::vector<double> planTables(const AirTableRequest&) const { return {}; }
  /// The file that says which wavelengths it has; none: it is in the scenario.
  virtual Location where() const { return {}; }
  /// Exponents a_k, one per absorber.
  virtual std::span<const double> exponents() const = 0;
  virtual AirNode node(double wavelength_um) const = 0;
  /// Height of the air's top above the sphere that stands for the earth [m]; infinite where it has none.
  virtual double top_m() const = 0;
  /// Amounts from the beginning of a ray as far as a range (may be infinite); the earth does not stop it.
  virtual AirAmounts amounts(const AirRay& ray, double range_m) const = 0;
  /// Places along a ray, at least where its emission bends; the first where the air begins, the last at the range or the air's end.
  /// Here: the beginning and the end of air that is the same along the ray.
  virtual std::vector<AirStation> stations(const AirRay& ray, double range_m) const;
  /// The ranges of these alone [m].
  virtual std::vector<double> placesAlong(const AirRay& ray, double range_m) const;
  /// The same at given ranges, rising. Here: amounts alone.
  virtual std::vector<AirStation> stationsAt(const AirRay& ray, std::span<const double> ranges_m) const;
  /// Temperature at height 0 [K]; 0: it does not say.
  virtual double groundTemperature_K() const { return 0.0; }
  virtual std::span<const AirShell> shells() const { return {}; }
  /// Amounts that 1000 m of the air at a height hold (of air that scatters sunlight).
  virtual AirAmounts densities(double height_m) const;
  virtual double validLow_um() const = 0;
  virtual double validHigh_um() const = 0;
  /// Wavelengths between which its properties are smooth, rising [um].
  virtual std::vector<double> knots_um() const = 0;
  /// All that it depends on.
  virtual void addTo(Fingerprint& f) const = 0;

  /// W_k^a_k: what the coefficients multiply.
  AirAmounts powered(const AirAmounts& amounts) const;
  double opticalDepth(const AirNode& node, const AirAmounts& amounts) const { return depthOf(node, powered(amounts)); }
  static double depthOf(const AirNode& node, const AirAmounts& powered);
  double transmittance(const AirNode& node, const AirAmounts& amounts) const;
};

/// What air sends along a line of sight, for all places on it: one value per place, 0 at the first. Depths rise from the first on.
struct AirLight {
  std::span<const double> depth;  ///< of all extinction, from the camera
  /// Thermal radiance, all extinction taken as emitting: `source` radiance of a black body at each place, linear in depth between two.
  /// Law: the source of air is (1 - w) B + w <L>, w the albedo, <L> the mean of the radiance around weighted by the phase function. Here <L> = B:
  /// what is scattered out of a line is scattered in again as from surroundings of the air's own temperature.
  /// Source: LOWTRAN 7 without multiple scattering (Kneizys et al. 1988, AFGL-TR-88-0177). Valid: exact in a world of one temperature (Kirchhoff) and
  /// for what only absorbs; what it differs by under a cold sky is light scattered again (sim/radiance/diffuse_light.hpp).
  void emitted(std::span<const double> source, std::span<double> radiance) const;
};

}  // namespace pitviper
