#pragma once
// What a CIGI host's changes are to a scenario's bodies, cameras and lamps.
#include <functional>
#include <string>
#include <vector>

#include "sim/model/simulation.hpp"
#include "sim/stream/cigi/cigi_commands.hpp"

namespace pitviper {

/// Numbers that hosts give things:
///   entities  1, 2, ... in the order of the scenario; what is attached there is attached here, and to the same
///   parts     1, 2, ... what is attached to an entity, in that order; offsets and angles are from where the scenario has it
///   views     1, 2, ... cameras in the order of the scenario, and 0 is the first; group 0, or all cameras. Offsets are from the body that carries it; of a
///   camera that stands
///             by itself entity 0: x north, y east, z down at the scenario's origin, angles from there
///   sensors   of a view: gain 0.5 is the scenario's, 0 a tenth, 1 ten times; automatic gain is the scenario's
///   components of entities (class 0, instance: the entity): 0 the body, 1, 2, ... its parts: first word, float, temperature [K];
///             of the system (class 13): 1 level of light `instance` (first word, float), 2 triggers it
/// Whether nothing of it can be, in words; each thing that can is a command, from the tick on that takes it.
class CigiWorld {
 public:
  explicit CigiWorld(const Simulation& simulation) : simulation_(simulation) {}
  using Refuse = std::function<void(const std::string& says)>;
  /// `commands` get those of a datagram, in its order.
  void translate(const std::vector<CigiChange>& changes, std::vector<Command>& commands, const Refuse& refuse);

 private:
  void of(const CigiEntityPose&, std::vector<Command>&, const Refuse&);
  void of(const CigiView&, std::vector<Command>&, const Refuse&);
  void of(const CigiViewDefinition&, std::vector<Command>&, const Refuse&);
  void of(const CigiSensor&, std::vector<Command>&, const Refuse&);
  void of(const CigiPart&, std::vector<Command>&, const Refuse&);
  void of(const CigiRate&, std::vector<Command>&, const Refuse&);
  void of(const CigiComponent&, std::vector<Command>&, const Refuse&);
  /// -1 and refused where there is none.
  int entity(int id, const Refuse&) const;
  int partOf(int entity, int part, const Refuse&) const;
  std::vector<int> cameras(int view, int group, const Refuse&) const;
  /// With the words of a scenario's commands, and their checks.
  void worded(const std::vector<std::pair<std::string, std::string>>& words, std::vector<Command>& commands, const Refuse&) const;

  const Simulation& simulation_;
  std::map<int, CigiRate> rates_;  ///< that go on from each pose, by entity
  std::map<int, CigiOffsets> viewOffsets_, partOffsets_;  ///< given so far, by camera and by entity
};

}  // namespace pitviper
