#pragma once
// Light in layered air that was scattered or sent by air and ground, any number of times: what it adds to a line of sight beyond sunlight scattered once.
//
// Law: per optical depth of scattering, what is turned into a line is sum of chi_l (2 l + 1) / (4 pi) cos(m phi) Lambda_lm(mu) M_lm(height) with the
//   moments M of level layers over level ground (adding_doubling.hpp), under a sun whose way to each height is that through spheres (pseudo-spherical).
//   The source of air is then (1 - w) B + w <L> in full: thermal light too is scattered in from a sky that is colder, and from
//   ground that is warmer or colder, than the air.
// Source: Dahlback and Stamnes 1991, Planet. Space Sci. 39, 671 (the sun's way); Chandrasekhar 1960 (the formal solution along the line itself).
// Valid: air that does not end sideways, ground of one kind, evenly sending (Lambert). Optical depths of bands are those of the column from space down.
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "sim/model/simulation.hpp"
#include "sim/model/spectral_node.hpp"
#include "sim/radiance/source_iteration.hpp"
#include "sim/scene/cache_folder.hpp"
#include "sim/world/sun_legs.hpp"

namespace pitviper {

/// Air with what lies below and above it.
struct AirColumn {
  std::shared_ptr<const Atmosphere> air;
  std::optional<Sun> sun;  ///< none: it lights no air
  Spectrum background;
  std::shared_ptr<const Material> ground;  ///< null: there is none
  double ground_K = 0.0, earthRadius_m = 0.0;
};
AirColumn columnOf(const Simulation& simulation);

class DiffuseLight {
 public:
  /// The same once for all who ask while somebody keeps it; null where the air scatters nothing.
  static std::shared_ptr<const DiffuseLight> of(const AirColumn& column, int streams);

  const std::vector<double>& heights_m() const { return heights_m_; }  ///< rising
  LayerLight::Shape shape() const { return shape_; }
  bool sunlit() const { return legs_ != nullptr; }
  const std::vector<double>& temperatures_K() const { return temperature_K_; }  ///< of the air at each height
  /// Of all that it depends on.
  const ContentKey& key() const { return key_; }
  /// Of a wavelength, [height][moment]; of the sun for an irradiance of 1.
  struct Moments {
    std::vector<double> solar, thermal;
    AirNode air;
    double irradiance = 0.0;  ///< of the sun; 0: there is none
  };
  /// Kept.
  const Moments& at(double wavelength_um) const;
  AirNode airAt(double wavelength_um) const { return column_.air->node(wavelength_um); }
  const Atmosphere& air() const { return *column_.air; }

 private:
  DiffuseLight(const AirColumn& column, int streams);
  Moments made(double wavelength_um) const;

  AirColumn column_;
  ContentKey key_{};
  int streams_;
  FineDirections fine_;
  LayerLight::Shape shape_;
  std::vector<double> heights_m_;
  std::vector<AirAmounts> above_;      ///< of the column above each height, raised to their powers
  std::vector<double> temperature_K_;  ///< of each height
  std::shared_ptr<const SunLegs> legs_;
  std::vector<AirAmounts> toSun_;  ///< from each height, raised to their powers
  std::vector<double> risen_;      ///< share of the sun's disc at each height
  mutable std::mutex busy_;
  mutable std::map<double, Moments> kept_;
};

/// What there is of a cloud's absorber straight up through all of its shells; 0: it is no cloud's.
double shellAmount(const Atmosphere& air, std::size_t absorber);
/// What an absorber's particles turn of light per unit of its amount; of a cloud the mean over a way straight through it, which sees the less of it the more it
/// takes: haze (1 - exp(-depth)) / depth.
double turnedThrough(const Atmosphere& air, const AirNode& node, std::size_t absorber);

/// What light turned into a line is at the edges of layers: along a line directions hardly change. One for each thread.
struct DiffuseMemory {
  struct Terms {
    double sine = 2.0;
    bool thermal = false, sun = false;      ///< what is told
    std::vector<std::vector<double>> of{};  ///< azimuth terms, each by pattern of each part, or by node
  };
  struct Edge {
    std::vector<Terms> told{};
    std::size_t here = SIZE_MAX;  ///< of these, that of the line
    double cosAzimuth = 2.0;
    std::vector<std::vector<double>> of{};
  };
  std::vector<Edge> edges{};
  /// A line begins that goes through the same places as the one before, under another azimuth: what was told then is found again, in the same order.
  void again() {
    for (Edge& e : edges) e.here = SIZE_MAX;
  }
  /// Any line begins.
  void forget() {
    for (Edge& e : edges) e.told.clear(), e.here = SIZE_MAX;
  }
};

/// What is turned into a line at a place, per optical depth of scattering by molecules (the first) or by a kind of particles, of each node [W/(m2 sr um)]; of
/// the sun for an irradiance of 1.
struct TurnedLight {
  std::vector<std::vector<double>> thermal, solar;
};

/// The same at the nodes of a plan, of groups as the mean over their wavelengths by what each scatters: as the products that plans are fitted to. May be shared
/// between threads.
class NodeDiffuse {
 public:
  /// Apart: a node's figures are the same to the last bit whichever others stand beside it; Together: as sums of patterns, which costs a tenth of it; Kept:
  /// these between runs too (content_cache.hpp), of nodes that will be asked for again.
  enum class Nodes { Apart, Together, Kept };
  NodeDiffuse(std::shared_ptr<const DiffuseLight> light, std::span<const SpectralNode> nodes, Nodes told);
  bool sunlit() const { return light_->sunlit(); }
  /// What TurnedLight tells after molecules.
  const ParticleKinds& particles() const { return kinds_; }
  struct Of {
    bool thermal = true, sun = true;  ///< the sun's where it is there
  };
  /// Where a line goes towards a sine of elevation, and its azimuth is so far from the sun's.
  void at(double height_m, double sine, double cosAzimuth, Of of, DiffuseMemory& memory, TurnedLight& out) const;

 private:
  /// Moments of nodes, times what the phase function has of them, as sums of few patterns.
  struct Part {
    std::vector<int> moments;     ///< of the light's shape, those that matter, by azimuth term
    std::size_t patterns = 0;     ///< 0: each node is told apart
    std::vector<double> pattern;  ///< [height][moment][pattern]
    std::vector<double> share;    ///< [pattern][node]; apart: [height][moment][node]
  };
  void make(std::span<const SpectralNode> nodes);
  bool read(const ContentKey& key);
  void write(const ContentKey& key) const;
  void tellEdge(std::size_t edge, double sine, double cosAzimuth, Of of, DiffuseMemory::Edge& into) const;
  /// `kind`: null: of molecules.
  Part partOf(std::span<const SpectralNode> nodes, bool solar, const std::vector<std::size_t>* kind) const;
  std::shared_ptr<const DiffuseLight> light_;
  std::size_t nodes_;
  Nodes told_;
  ParticleKinds kinds_;
  std::size_t each_ = 1;     ///< molecules and kinds of particles
  std::vector<Part> parts_;  ///< of thermal light by molecules, by each kind, then of the sun's
};

}  // namespace pitviper
