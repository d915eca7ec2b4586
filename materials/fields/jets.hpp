#pragma once
// The exhaust of a body's nozzles as a field: jets of free_jet.hpp, side by side along +x of the field, from its first nozzle on.
//
// Gases: what the nozzle has of CO2, H2O and CO [atm m], soot [m: volume fraction x length] and alumina [kg/m2], each in excess over the air around, which the
// atmosphere has already. What overlaps of two jets is added. Left out: jets bent by a turn, what a body does to the flow behind it (a wake, a base), jets
// that hit something.
// Bounded where a thousandth of the mixture fraction of a cross-section lies outside; it begins softly (kJetRamp) and fades out over the last fifth of its
// length, so that no end shows.
#include <memory>
#include <optional>
#include <vector>

#include "materials/fields/engine_presets.hpp"
#include "materials/fields/species.hpp"
#include "sim/model/field.hpp"
#include "sim/parameters/time_course.hpp"
#include "sim/scene/lifetime.hpp"

namespace pitviper {

struct JetsSetup {
  int entity = -1;                       ///< that the nozzles are on; -1: they stand in the local frame
  std::vector<glm::dvec3> nozzles{{}};   ///< places [m], in its axes
  glm::dvec3 direction{-1.0, 0.0, 0.0};  ///< of the exhaust, in its axes; of any length
  const EnginePreset* engine = nullptr;  ///< what leaves a nozzle, or else
  std::optional<NozzleFlow> nozzle;      ///< at throttle 1; a throttle changes its mass flow, by its diameter
  TimeCourse throttle{1.0};              ///< 0 ... 1. A motor's own burn counts besides. 0: a motor and a nozzle are out, an engine idles
  Lifetime life;                         ///< a motor's ignition and an engine's start are at its begin, or at 0 s
  double airWarmer_K = 0.0;              ///< than the standard atmosphere's
  double length_m = 0.0;                 ///< at most; 0: kUsualLength of its nozzle's diameters, or less where it has faded before
  static constexpr double kUsualLength = 200.0;
  /// What the jet has, in the order of the field's gases.
  std::vector<Species> species() const;
};

/// A thing that starts or stops takes so long: its throttle is the mean over this time before. About what a motor's igniter takes; nothing pops.
constexpr double kJetRise_s = 0.1;

/// A jet begins from so many radii before its nozzle's plane to as many behind, as 3 x^2 - 2 x^3: what a line along it sums up stays. Chosen: no nozzle's end
/// is a plane (petals, a view into it); and a picture's lines see where it is.
constexpr double kJetRamp = 0.5;

class JetsSource : public FieldSource {
 public:
  /// std::invalid_argument: no nozzle, neither or both of engine and nozzle, a direction that is none, more than kMostNozzles.
  explicit JetsSource(JetsSetup setup);
  ~JetsSource() override;
  static constexpr std::size_t kMostNozzles = 16;

  std::shared_ptr<const FieldState> at(const FieldWorld& world) const override;
  std::string shader() const override { return "materials/fields/glsl/jets.field.glsl"; }
  std::vector<int> mixtures() const override;
  void addTo(Fingerprint& fingerprint) const override;
  glm::dvec2 temperatures_K() const override;
  std::string target() const override { return "plume"; }
  /// A solid motor has none: it burns as it was cast.
  bool hasThrottle() const override { return !setup_.engine || setup_.engine->breathesAir(); }

  const JetsSetup& setup() const { return setup_; }
  /// What the jet is at a time, to steps that change it by less than a thousandth: throttle 1/2000, speed 0.25 m/s, height 5 m, presence 1/256.
  struct Conditions {
    long long throttle = 0, speed = 0, height = 0, presence = 0;
    auto operator<=>(const Conditions&) const = default;
    double throttlePart() const { return static_cast<double>(throttle) / 2000.0; }
    double presencePart() const { return static_cast<double>(presence) / 256.0; }
  };
  /// FieldWorld::throttleAt.
  using ThrottleSet = std::function<std::optional<double>(double time_s)>;
  /// At a height above sea level [m] and a speed along the axis, against the exhaust [m/s]; nothing where it is out.
  std::optional<Conditions> conditionsAt(double time_s, double height_m, double speed_m_s, const ThrottleSet& commanded = {}) const;
  CoFlow around(const Conditions& conditions) const;
  /// Nothing where the nozzle is out.
  std::optional<NozzleFlow> flowAt(const Conditions& conditions) const;
  /// Its jets, in field axes, at origin 0. Null where nothing leaves.
  std::shared_ptr<const FieldState> stateOf(const Conditions& conditions) const;
  std::size_t kept() const;  ///< jets worked out before that are still there

 private:
  struct Kept;
  double throttleAt(double time_s, const ThrottleSet& commanded) const;
  double askedThrottle(double time_s, const ThrottleSet& commanded) const;
  double presenceAt(double time_s) const;
  JetsSetup setup_;
  glm::dmat3 bodyFromField_{1.0};
  std::vector<glm::dvec3> places_;  ///< of the nozzles in field axes, from the first on
  std::unique_ptr<Kept> kept_;
};

}  // namespace pitviper
