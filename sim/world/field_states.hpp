#pragma once
// The fields of a world at a time, each worked out when it is first asked for.
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "sim/model/field.hpp"
#include "sim/model/simulation.hpp"

namespace pitviper {

/// Safe to ask from several threads. The simulation must outlive it.
class FieldStates {
 public:
  FieldStates(const Simulation& simulation, const WorldState& state);
  std::size_t size() const { return places_.size(); }
  /// Null: nothing of it is there now.
  const FieldState* at(std::size_t field) const;

 private:
  struct Place {
    std::once_flag once;
    std::shared_ptr<const FieldState> state;
  };
  double sunAt(const glm::dvec3& place) const;
  std::function<std::optional<double>(double time_s)> throttleOf(int field) const;
  const Simulation& simulation_;
  WorldState world_;  ///< without fields: what stands before the sun
  mutable std::vector<Place> places_;
};

/// A field of a state, or null.
inline const FieldState* fieldOf(const WorldState& state, std::size_t field) { return state.fields ? state.fields->at(field) : nullptr; }

}  // namespace pitviper
