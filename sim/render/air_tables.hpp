#pragma once
// Layered air as the shader reads it (atmosphere/layered.glsl): tables by elevation and range for a view, made in double precision, and by
// height for ways to lights and to the sun.
#include <memory>

#include "sim/gl/objects.hpp"
#include "sim/gl/shader_assembler.hpp"
#include "sim/plan/air_rows.hpp"

namespace pitviper {

class AirTables {
 public:
  /// `perChannel`: path radiance is integrated over the channels (direct mode), else it is kept per node. Both must outlive it.
  AirTables(const Simulation& simulation, const Plan& plan, bool perChannel, bool wanted = true);
  /// Nothing to do for air that is not layered.
  bool isNeeded() const { return rows_ != nullptr; }
  void addConstants(ShaderSlots& slots) const;
  /// A new picture: its first view has tables of its own (the last picture's where they are the same), which serve those after it where they hold what
  /// these see.
  void begin();
  /// Makes the tables for a view, unless those at hand serve it.
  void update(const View& view, const WorldState& state);
  void bind() const;

 private:
  void addHeights(std::vector<float>& amounts) const;
  std::vector<AirRow> fill() const;
  void upload(const std::vector<AirRow>& rows);

  const Simulation& simulation_;
  const Plan& plan_;
  bool perChannel_;
  std::unique_ptr<AirRows> rows_;
  std::vector<float> heights_;  ///< by height: the same for every view
  AirGrid grid_;
  glm::dvec3 position_{NAN};
  bool first_ = true;  ///< of the picture
  Buffer block_, amounts_, radiance_;
};

}  // namespace pitviper
