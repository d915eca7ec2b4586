#pragma once
// Layered air as the shader reads it (atmosphere/layered.glsl): tables by elevation and range for a view, made in double precision, and by
// height for ways to lights and to the sun.
#include "atmosphere/coefficients_gpu.hpp"
#include "atmosphere/layered_rows.hpp"
#include "sim/gl/objects.hpp"
#include "sim/render/air_on_gpu.hpp"

namespace pitviper {

class LayeredOnGpu final : public AirOnGpu {
 public:
  /// `perChannel`: path radiance is integrated over the channels (direct mode), else it is kept per node. Both must outlive it.
  LayeredOnGpu(const Simulation& simulation, const Plan& plan, bool perChannel);
  void addSlots(ShaderSlots& slots) const override;
  bool givesChannels() const override { return perChannel_; }
  /// The first view of a picture has tables of its own (the last picture's where they are the same), which serve those after it where they hold what
  /// these see.
  void begin() override { first_ = true; }
  void update(const View& view, const WorldState& state) override;
  void bind() const override;

 private:
  void addHeights(std::vector<float>& amounts) const;
  std::vector<AirRow> fill() const;
  void upload(const std::vector<AirRow>& rows);

  const Simulation& simulation_;
  const Plan& plan_;
  bool perChannel_;
  AirRows rows_;
  std::vector<float> heights_;  ///< by height: the same for every view
  AirGrid grid_;
  glm::dvec3 position_{NAN};
  bool first_ = true;  ///< of the picture
  CoefficientsOnGpu coefficients_;
  Buffer block_, amounts_, radiance_;
};

}  // namespace pitviper
