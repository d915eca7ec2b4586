#pragma once
// The contract of media that vary through their bodies: exhaust jets, smoke, burning clouds, grids of a flow solver's. A field says what a line of sight
// passes in it, step by step; what its gases do with light is their materials' matter (sim/model/medium.hpp).
#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "sim/parameters/error.hpp"
#include "sim/parameters/fingerprint.hpp"
#include "sim/radiometry/physics.hpp"
#include "sim/radiometry/spectrum.hpp"
#include "sim/scene/motion.hpp"

namespace pitviper {

struct Ejected;
struct Simulation;

/// Gases (or kinds of particles) of one field at most: as in sim/render/media/glsl/volume_field.frag.glsl.
constexpr int kMostGases = 8;

/// What a unit of a gas's amount does, at rising temperatures; between two linear in temperature, held beyond.
struct FieldGas {
  struct Level {
    double temperature_K = 0.0;
    int material = 0;  ///< index into Simulation::materials: one with a medium, whose absorption is per unit of amount
  };
  std::string name;
  std::vector<Level> levels;  ///< one: the same at every temperature
  /// Calls visit(material, share) for those two, or that one, that a temperature lies between.
  template <class Visit>
  void at(double temperature_K, const Visit& visit) const {
    std::size_t k = 0;
    while (k + 2 < levels.size() && temperature_K >= levels[k + 1].temperature_K) ++k;
    if (levels.size() == 1) return visit(levels[0].material, 1.0);
    const double low = levels[k].temperature_K, high = levels[k + 1].temperature_K;
    const double share = temperature_K <= low ? 0.0 : temperature_K >= high ? 1.0 : (temperature_K - low) / (high - low);
    if (share < 1.0) visit(levels[k].material, 1.0 - share);
    if (share > 0.0) visit(levels[k + 1].material, share);
  }
};

/// A straight line in the local frame; direction of unit length; what counts of it [m from the origin].
struct FieldLine {
  glm::dvec3 origin{0.0}, direction{0.0, 0.0, 1.0};
  double nearest_m = 0.0, farthest_m = 0.0;
};

/// A stretch of a line within a field, taken as even.
struct FieldStep {
  double enter_m = 0.0, leave_m = 0.0;      ///< along the line
  std::array<double, kMostGases> amount{};  ///< of each gas: the integral of its density along the stretch
  double temperature_K = 0.0;
  double drift_perK = 0.0;                    ///< 1 / temperature at its far end, less that at its near end: setDrifts()
  double gain = 1.0;                          ///< factor of Medium::radiance
  double sun = 0.0;                           ///< share of the sun's disc that nothing solid hides from it
  double sunAmount = 0.0;                     ///< of the first gas between it and the sun, in the field itself
  std::optional<physics::CloudStep> cloud{};  ///< of fields with drops: the light within
};

/// Part of a field as the GPU finds it: what bounds it, in field axes, and where its numbers begin among the texels.
struct FieldElement {
  glm::dvec3 centre{0.0};
  double radius_m = 0.0;
  int texel = 0;               ///< of several neighbours it may be the same
  double finest_m = 0.0;       ///< the least length over which it changes across a line: pixels wider than this look at it along several lines
  int kind = 0;                ///< below kFieldKinds: those alike in how many steps lines through them need
  glm::dvec3 drawnOut_m{0.0};  ///< its axis, as long as that over which it changes along it; 0: the same all around
  glm::dvec3 half_m{0.0};      ///< halves of a box around its centre, along the field's axes, that holds it too; 0: none
};

/// Numbers that a field's shader reads; immutable, so that the same pointer is the same content.
struct FieldTexels {
  std::vector<glm::vec4> texel;
};

/// A field at a time. Immutable and safe to ask from several threads.
class FieldState {
 public:
  virtual ~FieldState() = default;
  /// Where its own axes stand in the local frame; its numbers on the GPU are in these, in single precision.
  glm::dvec3 origin{0.0};
  glm::dmat3 localFromField{1.0};
  glm::dvec3 low{0.0}, high{0.0};  ///< box in field axes; nothing is outside
  glm::dvec3 source{0.0};          ///< where it comes from, in field axes: the middle of nozzles, a flame
  double finest_m = 0.0;           ///< the least of its elements
  std::vector<FieldElement> elements;
  std::shared_ptr<const FieldTexels> texels;
  /// Of a unit of what the shader adds up, how much of each gas it is: see FieldSource::mixtures().
  std::array<double, kMostGases> share{1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0};
  /// `steps` of them at most, rising; nothing where the line misses it. In double, by the same formulas as its shader.
  virtual void along(const FieldLine& line, int steps, std::vector<FieldStep>& out) const = 0;
};

/// The world as a field asks for it, at the time that it is made for.
struct FieldWorld {
  const Simulation* simulation = nullptr;
  double time_s = 0.0;
  /// Pose of an entity now, as commands have it; at earlier times as the scenario has it.
  std::function<Pose(int entity, double time_s)> poseAt;
  /// Share of the sun's disc that reaches a place (0 or 1 where bodies hide it); 0 without a sun.
  std::function<double(const glm::dvec3& place)> sunAt;
  /// Of an entity that commands move, or nothing: its velocity now [m/s].
  std::function<std::optional<glm::dvec3>(int entity)> velocityNow = {};
  /// What commands have made of the throttle of this field's engine at a time, or nothing. Empty: none has.
  std::function<std::optional<double>(double time_s)> throttleAt = {};
  /// What flies of a store that commands eject (Simulation::stores), or null.
  std::function<std::shared_ptr<const Ejected>(int store)> ejected = {};
};

/// What a field of drops scatters many times. Its gas's absorption is c e (sim/radiometry/glsl/cloud.glsl), for which its amount is an optical depth at 0.55
/// um; its albedo and asymmetry are the scaled ones, so that who knows of no drops sees an even medium of the same light. Fields of one gas have the same
/// droplets.
struct Droplets {
  Spectrum albedo, asymmetry;  ///< of single scattering, not scaled
  double height_m = 0.0;       ///< LocalFrame::height of its middle: sky and ground are those of there
};

/// Where a field comes from.
class FieldSource {
 public:
  virtual ~FieldSource() = default;
  /// Null where there is nothing at the time. Called from several threads.
  virtual std::shared_ptr<const FieldState> at(const FieldWorld& world) const = 0;
  /// Its file for the slot `field` of sim/render/media/glsl/volume_field.frag.glsl, which says what is in it.
  virtual std::string shader() const = 0;
  /// Of each gas, the amount of the shader's that it is a part of: gases that always come in the same proportions cost no more than one. Empty: each its own.
  virtual std::vector<int> mixtures() const { return {}; }
  virtual void addTo(Fingerprint& fingerprint) const = 0;
  /// Temperatures that it may have [K], for the tables of its gases.
  virtual glm::dvec2 temperatures_K() const = 0;
  /// A word for tables of targets; empty: it is no target.
  virtual std::string target() const { return {}; }
  /// Whether there is a throttle that a command may set.
  virtual bool hasThrottle() const { return false; }
  /// Null: what it scatters it scatters once. Else its steps have FieldStep::cloud, and its shader a function cloudStep().
  virtual const Droplets* droplets() const { return nullptr; }
};

struct FieldBody {
  std::string name;
  Location where;
  std::vector<FieldGas> gases;
  std::shared_ptr<const FieldSource> source;
};

constexpr int kFieldKinds = 8;

/// Steps along a line: of the reference, of the planner's lines; of pictures by their accuracy.
constexpr int kReferenceFieldSteps = 96, kPlannedFieldSteps = 8;

}  // namespace pitviper
