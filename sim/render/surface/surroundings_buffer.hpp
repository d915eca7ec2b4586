#pragma once
// The surroundings' light at the places of a scene's bodies, as the shaders read it (sim/render/surface/glsl/ambient_around.glsl).
#include <optional>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/radiance/node_surroundings.hpp"
#include "sim/world/world.hpp"

namespace pitviper {

class SurroundingsBuffer {
 public:
  /// Both must outlive it.
  SurroundingsBuffer(const Simulation& simulation, const NodeSurroundings& light);
  /// Bodies are where a state has them.
  void setState(const WorldState& state);
  /// The slot of an entity's light; -1: of the ground, and of whatever has none.
  float slotOf(int entity) const { return static_cast<float>(entity < 0 ? at_.back() : at_[static_cast<std::size_t>(entity)]); }
  void bind() const { buffer_.bindTexture(31, 4); }
  void addConstants(ShaderSlots& slots) const;

 private:
  /// Steps between two heights of the surroundings: a height within one has the light of its nearest, which moves that by 1e-3 of their difference. Half as
  /// many, and again, where all places together would take more than this many bytes.
  static constexpr double kMostSteps = 512.0;
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;
  std::vector<Surroundings::Place> placesOf(const WorldState& state, double steps) const;
  /// What the shaders read of a place.
  std::vector<float> told(const Surroundings::Place& place) const;

  const Simulation& simulation_;
  const NodeSurroundings& light_;
  std::vector<Surroundings::Place> places_;  ///< of all entities and, last, of the ground
  std::vector<std::size_t> at_;
  std::vector<char> reflects_;                             ///< by entity
  std::size_t size_ = 0;                                   ///< of a slot, in floats
  std::vector<std::optional<Surroundings::Place>> slots_;  ///< of the buffer, all of one size
  Buffer buffer_;
};

}  // namespace pitviper
