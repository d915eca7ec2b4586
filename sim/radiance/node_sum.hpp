#pragma once
// A sink that adds a line of sight up at wavelengths, or at averages over groups of wavelengths as the shaders do.
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "sim/model/spectral_node.hpp"
#include "sim/radiance/cloud_lights.hpp"
#include "sim/radiance/diffuse_light.hpp"
#include "sim/radiance/radiance.hpp"
#include "sim/radiance/segment_law.hpp"

namespace pitviper {

class NodeSurroundings;
class PlanckTable;

/// What lines have in common at some nodes; may be shared between threads.
class NodeSpectra {
 public:
  /// All but the terms must outlive it; of these, how light from all around and light scattered again are told. `parts`: spectra at the single wavelengths
  /// that these nodes are groups of, whose values are averaged; null: none are known.
  NodeSpectra(const Simulation& simulation, std::span<const SpectralNode> nodes, const Terms& terms, const NodeSpectra* parts = nullptr);
  /// Everything, in full.
  NodeSpectra(const Simulation& simulation, std::span<const SpectralNode> nodes) : NodeSpectra(simulation, nodes, termsOf(simulation)) {}
  const Simulation& simulation() const { return simulation_; }
  std::span<const SpectralNode> nodes() const { return nodes_; }
  /// Black body of a temperature per node, in place: of the air's, and of gas where there are fields, by tables (tests/unit/test_node_sum.cpp has their error).
  void planck(double temperature_K, std::span<double> into) const;
  std::vector<double> of(const Factor& factor) const;
  const NodeSurroundings* surroundings() const { return surroundings_.get(); }
  /// Coefficients of those amounts of air for which some node has one.
  struct AirRows {
    std::vector<size_t> amounts;
    std::vector<double> coefficient;  ///< [of amounts][node]
  };
  /// What an amount of air takes from a line, and scatters by molecules and by haze.
  const AirRows& extinction() const { return extinction_; }
  const AirRows& molecules() const { return molecules_; }
  const AirRows& haze() const { return haze_; }
  /// Of what diffuse() tells: by molecules and by each kind of particles.
  const std::vector<AirRows>& scattered() const { return scattered_; }
  /// Null: light is scattered once.
  const NodeDiffuse* diffuse() const { return diffuse_ ? &*diffuse_ : nullptr; }
  /// What air sends besides its black body: AirNode::source.
  const std::vector<double>& airSource() const { return airSource_; }
  /// Of a material's medium, per node.
  std::span<const double> absorption_per_m(int material) const {
    return std::span(absorption_per_m_).subspan(static_cast<size_t>(material) * nodes_.size(), nodes_.size());
  }
  /// Of a field's gas that has more than absorption, per node: part of its extinction that emits, own radiance, ambient light and, for a phase function of 1,
  /// sunlight that it scatters, asymmetry. Each averaged by itself, as pictures have it. Null of all other materials.
  struct MediumRows {
    std::vector<double> thermal, radiance, around, sunlight, asymmetry;
    std::vector<CloudLight> drops;  ///< of a field that has them; empty
  };
  const MediumRows* mediumRows(int material) const {
    const auto at = mediumRows_.find(material);
    return at == mediumRows_.end() ? nullptr : &at->second;
  }

 private:
  const Simulation& simulation_;
  std::span<const SpectralNode> nodes_;
  AirRows extinction_, molecules_, haze_;
  std::vector<AirRows> scattered_;
  std::vector<double> airSource_;
  std::optional<NodeDiffuse> diffuse_;
  std::vector<double> absorption_per_m_;
  std::shared_ptr<const NodeSurroundings> surroundings_;  ///< null: a uniform dome's
  std::shared_ptr<const PlanckTable> ofAir_, ofGas_;      ///< null: none is asked for
  std::map<int, MediumRows> mediumRows_;
};

/// Radiance per node of one line after the other. One for each thread.
class NodeSum final : public TermSink {
 public:
  explicit NodeSum(const NodeSpectra& spectra);
  /// A new sum begins.
  void begin();
  void restart() override;
  void term(const Term& term) override;
  void segment(const Segment& segment) override;
  void pane(const Factor& transmittance, double modifier) override;

  /// [W/(m2 sr um)] per node.
  std::span<const double> radiance() const { return radiance_; }
  /// By kind of term, in the order of TermKind, where keepParts() was called: [kind][node].
  std::span<const double> part(TermKind kind) const { return parts_[static_cast<size_t>(kind)]; }
  /// Of light of a lamp that surfaces reflect, where keepParts() was called.
  std::span<const double> ofLamp(size_t light) const { return ofLamp_[light]; }
  void keepParts() { keepsParts_ = true; }
  /// Of what this entity sends or reflects, surface or medium, where watchEntity() was called; of all terms, whatever setOnly() says.
  std::span<const double> ofEntity() const { return ofEntity_; }
  void watchEntity(int entity) { watched_ = entity; }
  /// The same of a field, by its index into Simulation::fields, in the place of an entity.
  void watchField(int field) { watchedField_ = field; }
  /// Where watchField() was called: what the line would have without the field.
  std::span<const double> withoutField() const { return isParted_ ? without_.radiance : radiance_; }
  /// From here on only this part is summed; without one, all parts.
  void setOnly(const std::optional<Part>& only) { only_ = only; }
  /// The parts that lines had since watchParts() was called.
  const std::set<Part>& met() const { return met_; }
  void watchParts() { watches_ = true; }
  /// Transmittance of the panes and media on the whole way.
  std::vector<double> transmittance() const;
  /// Transmittance of air, panes and media as far as the place reached.
  std::vector<double> reach() const;

 private:
  const std::vector<double>& values(const Factor& factor);
  bool takes(const Part& part) {
    if (watches_) met_.insert(part);
    return !only_ || *only_ == part;
  }
  void send(TermKind kind, size_t node, double radiance) {
    radiance_[node] += radiance;
    if (keepsParts_) parts_[static_cast<size_t>(kind)][node] += radiance;
  }
  /// Of a place, per node: depth of the air before it and what that lets through, the black body of its air, and depth and transmittance with the way on to the
  /// sun.
  struct At {
    std::vector<double> depth, passed, black, sunDepth, sunPassed;
    TurnedLight light;
  };
  void place(const AirPlace& at, const Segment& of, const AirAmounts* both, At& out);
  void turnAgain(const Segment& segment);
  void tellSources(const Segment& segment);
  bool tellDrifts(const Segment& segment);
  void gather(const Segment& segment);
  /// What particles scatter times their phase functions, kept as lines of one sun mostly ask for the same angle again.
  const NodeSpectra::AirRows& hazeTurned(double cosScatter);
  const std::vector<double>& turnedBy(const MediumInside& medium, double cosScatter);

  const NodeSpectra& spectra_;
  size_t count_;
  std::vector<double> none_, all_;  ///< zeros and ones
  SegmentLaw law_;
  bool keepsParts_ = false;
  int watched_ = -1, watchedField_ = -1;
  bool watchesOne() const { return watched_ >= 0 || watchedField_ >= 0; }
  std::optional<Part> only_;
  bool watches_ = false;
  std::set<Part> met_;
  std::vector<double> radiance_, ofEntity_;
  std::array<std::vector<double>, kTermKinds> parts_;
  std::vector<std::vector<double>> ofLamp_;
  std::vector<double> panes_, mediaDepth_, mediaPassed_;  ///< of the way so far: what panes let through, depth of media, and what that lets through
  struct {
    std::vector<double> depth, passed;                                  ///< of all
    std::vector<double> otherDepth, otherPassed;                        ///< of what is not watched, once a watched field was met
    std::vector<double> emitted, drifting, watched, driftingOfWatched;  ///< sums of depths times sources, and times what these change by
  } own_;                                                               ///< media of the segment being told
  struct {
    std::vector<double> radiance, depth, passed;
  } without_;  ///< the line without the field that is watched: as radiance_, mediaDepth_ and mediaPassed_ from where it begins
  bool isParted_ = false;
  At near_, far_;
  DiffuseMemory memory_;
  std::vector<std::vector<double>> sources_, drifts_;           ///< of each medium of the segment being told
  std::vector<double> black_, change_, sunAir_, shade_, each_;  ///< as they are told; of one medium
  std::vector<double> scratch_, phase_, turned_, turnedByHaze_, termDepth_, termPassed_;
  std::vector<double> againNear_, againFar_;  ///< source of light scattered again at both ends of the segment being told
  std::vector<double> scatters_;              ///< part of its depth that a kind scatters
  NodeSpectra::AirRows hazeTurned_;
  double hazeTurnedAt_ = 2.0;                    ///< cosine that hazeTurned_ is for
  double turnedAt_ = 2.0;                        ///< cosine that turnedOf_ is for
  std::map<int, std::vector<double>> turnedOf_;  ///< of each material
  const AirPlace* sunKnownAt_ = nullptr;         ///< near_ has the way on to the sun from there
  const AirPlace* here_ = nullptr;               ///< the place reached: near_ is its
  std::map<Factor, std::vector<double>> kept_;
};

}  // namespace pitviper
