#pragma once
// How finely a picture looks at fields, by the accuracy asked for: steps of a line, and lines through a pixel.
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "sim/plan/plan.hpp"

namespace pitviper {

class Dice;
class NodeSum;
struct WorldState;

using ApartByKind = std::array<double, kFieldKinds>;
using StepsByKind = std::array<int, kFieldKinds>;  ///< of a kind of elements; 0: nobody would notice them

/// The least of both with which no channel's radiance on some lines and in some pixels, from the scenario's cameras and probes, is off by more than a third of
/// the plan's accuracy from what many give; with no accuracy asked for: of 0.3 %.
class FieldSampling {
 public:
  /// The same again while somebody holds one of the same simulation and plan.
  static std::shared_ptr<const FieldSampling> of(const Simulation& simulation, const Plan& plan);
  /// By so many nodes of each block of the plan at most, and their share of its weights.
  FieldSampling(const Simulation& simulation, const Plan& plan, int most);
  /// As bytes that read back to the same, for the cache of tables; nothing where they cannot be read, or are of another number of fields.
  std::string bytes() const;
  static std::optional<FieldSampling> from(std::string_view bytes, std::size_t fields);
  /// Of a field: what the times before and after that were looked at need. Seen along its axis a jet needs three times the steps that it needs from the side.
  StepsByKind steps(std::size_t field, double time_s) const;
  /// How much farther apart than pixelLines() has them for the reference lines may lie: the thicker and the more uneven a field, the less.
  ApartByKind coarser(std::size_t field, double time_s) const;

 private:
  FieldSampling() = default;
  struct Needs {
    StepsByKind steps{};
    ApartByKind coarser{};  ///< 0: nothing was there to be looked at
  };
  /// Of a field at a time.
  static Needs needsOf(const Simulation& simulation, const Plan& plan, const WorldState& state, std::size_t field, int pixels, double asked, NodeSum& sum,
                       Dice& dice);
  std::pair<const Needs*, const Needs*> around(std::size_t field, double time_s) const;
  std::vector<double> time_s_;          ///< rising
  std::vector<std::vector<Needs>> of_;  ///< [time][field]
};

}  // namespace pitviper
