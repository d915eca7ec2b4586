#pragma once
// Shadows of the sun and of point lights. Each body that casts them has a depth map of its own for each light, fitted to its box and in its
// body axes: a jet's map has texels of centimetres beside terrain of 50 km, and terrain's is drawn once, as long as the sun stands still over
// it. A map only decides where it can: where the four texels around a point agree, by more than their own error, that the caster is wholly
// behind the point's plane or well before it. Elsewhere, at outlines and on surfaces nearly along the light, a ray through the caster's tree
// does. So neither bias nor texels show; what a map can miss is what lies between four texels without touching one.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/plan/plan.hpp"
#include "sim/render/geometry/gpu_scene.hpp"
#include "sim/render/geometry/shadow_trees.hpp"
#include "sim/render/shadow/shadow_demand.hpp"
#include "sim/render/shadow/shadow_reach.hpp"

namespace pitviper {

class ShadowPass {
 public:
  /// The simulation and the plan must outlive it.
  ShadowPass(const Simulation& simulation, const Plan& plan, std::shared_ptr<const GpuScene> scene, const ShaderLibrary& library);
  /// Shader file of the slot `shadow`.
  static std::string slotFile(const Plan& plan);

  /// Finds who can shade whom, and draws the maps that have changed. `matters(entity, light)`: false where it is not worth asking. `demand`: what looks at
  /// them; where few pixels do, rays tell all of them. Null: anything may, and casters have maps.
  void setState(const WorldState& state, const std::function<bool(std::size_t, std::size_t)>& matters, const ShadowDemand* demand = nullptr);
  /// Buffers and maps; units 13 to 16.
  void bind() const;
  /// Those that can shade an entity from a light (the sun is the last).
  struct Range {
    std::uint32_t first = 0, count = 0;
  };
  const Program& program() const { return program_; }
  Range castersOf(std::size_t entity, std::size_t light) const { return ranges_[entity * static_cast<size_t>(lightCount_) + light]; }

 private:
  /// A map's texels a side; of a mesh of fewer triangles than kDense rays cost less than a map.
  static constexpr int kTexels = 1024;
  static constexpr std::uint32_t kDense = 64;
  /// Clear facets are found once for bodies of so many triangles (0.2 to 0.4 us each).
  static constexpr std::size_t kFewestFacets = 1024, kMostFacets = 4'000'000;
  /// A map costs as much as the rays of so many pixels, and a part of one more for each triangle (llvmpipe; found on first_light and sixteen).
  static constexpr double kRaysPerMap = 2000.0, kRaysPerTriangle = 1.5;
  /// Maps of 4 MiB each; further casters are left to rays.
  static constexpr int kMostMaps = 64;
  struct Map {
    int layer = -1;
    LightPlace light;  ///< it was drawn for
    std::optional<ShadowProjection> projection;
  };
  /// Whether a caster's bounding sphere comes near the lines from a receiver's to a light, in the local frame: all that most pairs cost.
  bool isNearLine(std::size_t caster, std::size_t receiver, std::size_t light, const WorldState& state, const std::vector<glm::dvec3>& centre) const;
  /// Where a receiver asks for a caster's shadow.
  bool raysCostLess(std::size_t caster, std::size_t receiver, std::size_t light, const WorldState& state, const ShadowDemand* demand) const;
  LightPlace lightFor(std::size_t caster, std::size_t light, const WorldState& state) const;
  Map& mapOf(std::size_t caster, std::size_t light, const LightPlace& place);
  void warmUp();
  void draw(std::size_t caster, const Map& map);
  /// Where one body's axes lie in another's.
  struct Relative {
    glm::dmat3 axes{1.0};  ///< the other's from its own
    glm::dvec3 origin{0.0};
    bool operator==(const Relative&) const = default;
  };
  /// The facets of a still body that it and other still bodies leave clear of the sun.
  struct Clear {
    glm::dvec3 toSun{NAN};  ///< body axes; none are known for another
    std::map<std::size_t, Relative> casters;
  };
  /// Whether a caster shades none of the facets of a body that are marked clear.
  bool leavesClear(std::size_t caster, std::size_t receiver, const glm::dvec3& toSun, const WorldState& state);
  Clear findClear(std::size_t receiver, const glm::dvec3& toSun, const WorldState& state);
  bool staysStill(std::size_t entity) const;
  static Relative relative(const Pose& own, const Pose& other);

  const Simulation& simulation_;
  std::shared_ptr<const GpuScene> scene_;
  std::shared_ptr<const ShadowTrees> trees_;
  int lightCount_;
  Program program_;
  bool warm_ = false;
  DepthLayers layers_;  ///< as many as have been asked for so far
  int mostLayers_ = 0;
  std::map<std::pair<std::size_t, std::size_t>, Map> maps_;
  int layersTaken_ = 0;
  std::vector<ShadowBox> boxes_;  ///< of whole meshes
  std::vector<Range> ranges_;
  std::map<std::uint32_t, Clear> clearOf_;  ///< by first triangle: bodies of one mesh share their bits
  std::vector<std::uint32_t> clear_;        ///< a bit for each of the scene's triangles
  Buffer shadows_, clearFacets_;
};

}  // namespace pitviper
