#pragma once
// The surroundings' light at some nodes, and what surfaces send of it to a view: in full, or by harmonics as the shaders do.
#include <map>
#include <memory>
#include <mutex>
#include <span>

#include "sim/model/harmonic_response.hpp"
#include "sim/model/spectral_node.hpp"
#include "sim/radiance/factor.hpp"
#include "sim/radiance/terms.hpp"

namespace pitviper {

/// May be shared between threads.
class NodeSurroundings {
 public:
  /// `degree`: as Terms::surroundings. `parts`: of nodes of single wavelengths, or null; nodes made of them are told as their averages. All must outlive it.
  NodeSurroundings(const Simulation& simulation, std::span<const SpectralNode> nodes, int degree, const NodeSurroundings* parts = nullptr);
  ~NodeSurroundings();
  int degree() const { return degree_; }

  static constexpr std::size_t kCosine = kBlurs, kRests = kCosine + 1;
  /// Numbers of blurs between which lobes of all materials are, by any light; count 0: there are none.
  struct Blurs {
    int first = 0, count = 0;
  };
  /// Of sharp lobes, or of the others.
  Blurs blursInUse(bool sharp) const;
  /// What shines on a place, as the shaders read it.
  struct Light {
    DirectionGrid grid;                ///< the finer one, its horizon and its turn
    std::vector<Harmonics> harmonics;  ///< by node, up to the degree
    /// [blur][entry of the grid][node], nodes filled up to fours: what these leave, by the blurs in use; all but the mean, by those of sharp lobes; what
    /// harmonics leave, by a matt surface's cosine.
    std::vector<float> rest;
  };
  Light lightAt(const Surroundings::Place& place) const;

  /// Means over the nodes of what a component sends [W/(m2 sr um)], a modifier at 1.
  std::vector<double> reflected(const ReflectionComponent& component, const SurfaceView& view) const;
  /// By view angle and node.
  struct Responses {
    int views = 1;
    std::vector<Response> at;
    std::vector<HarmonicResponse::Aim> aims;  ///< by view angle
    bool isSharp = false;
  };
  const Responses& responses(const ReflectionComponent& component) const;
  /// Those of a component of a material in one of its states (or the material itself), told as sharp only where it is so in all of them: shaders mix states.
  const Responses& responses(const Material& material, const Material& state, std::size_t component) const;

 private:
  struct Patterns;
  struct Height;
  const Height& height(std::size_t number) const;
  bool takeParts(std::size_t number, Height& height) const;
  void makePatterns(std::size_t number, Height& height) const;
  /// What Light is mixed of, of one of the surroundings' heights.
  struct Told {
    std::vector<Harmonics> harmonics;
    std::vector<float> rest;
  };
  const Told& told(std::size_t number) const;
  /// By content: several passes of one plan ask for the same.
  std::shared_ptr<const Told> sharedTold(std::size_t number) const;
  Told makeTold(std::size_t number) const;
  const std::vector<double>& ofDome() const;
  std::vector<double> inFull(const ReflectionComponent& component, const SurfaceView& view) const;
  std::vector<double> byHarmonics(const ReflectionComponent& component, const SurfaceView& view) const;
  const std::vector<std::vector<double>>& columns(const ReflectionComponent& component) const;
  /// At nodes, for a view angle: read from a table as the shaders do, or itself.
  std::vector<double> hemispherical(const ReflectionComponent& component, double viewAngle_rad) const;

  const Simulation& simulation_;
  std::span<const SpectralNode> nodes_;
  int degree_;
  const NodeSurroundings* parts_;
  std::vector<double> usual_um_;  ///< by which lobes are aimed, whatever the nodes
  mutable std::mutex busy_;
  mutable std::map<std::size_t, std::unique_ptr<Height>> heights_;
  mutable std::mutex telling_;
  mutable std::map<std::size_t, std::shared_ptr<const Told>> told_;
  mutable std::once_flag isDomeKnown_;
  mutable std::vector<double> ofDome_;
  const Responses& responses(const ReflectionComponent& component, bool sharp) const;
  mutable std::map<std::pair<const ReflectionComponent*, bool>, std::unique_ptr<Responses>> responses_;
  mutable std::map<const ReflectionComponent*, std::unique_ptr<std::vector<std::vector<double>>>> columns_;
  mutable std::map<std::pair<const ReflectionComponent*, int>, std::vector<double>> hemispherical_;
};

}  // namespace pitviper
