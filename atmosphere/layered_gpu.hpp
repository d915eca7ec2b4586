#pragma once
// Layered air as the shader reads it (atmosphere/layered.glsl): tables by elevation and range for a view, made in double precision, and by
// height for ways to lights and to the sun.
#include <list>
#include <map>

#include "atmosphere/coefficients_gpu.hpp"
#include "atmosphere/layered_rows.hpp"
#include "sim/gl/objects.hpp"
#include "sim/render/assembly/air_on_gpu.hpp"

namespace pitviper {

class LayeredOnGpu final : public AirOnGpu {
 public:
  /// `perChannel`: path radiance is integrated over the channels (direct mode), else it is kept per node. Both must outlive it.
  LayeredOnGpu(const Simulation& simulation, const Plan& plan, bool perChannel);
  void addSlots(ShaderSlots& slots) const override;
  bool givesChannels() const override { return perChannel_; }
  /// The first view of a picture has tables of its own (the last picture's where they are the same), which serve those after it where they hold what
  /// these see.
  void begin() override;
  void update(const View& view, const WorldState& state) override;
  void bind() const override;
  void takeTables(AirOnGpu& other) override;

 private:
  using RowKey = std::pair<long long, long long>;  ///< azimuth (across), elevation (sine)
  /// Of an eye at one height. Kept for as long as pictures use them.
  struct Rows {
    struct Row {
      AirRow row;
      bool used = true;  ///< by this picture
    };
    AirPlaces places;
    std::vector<double> black;  ///< per node
    std::map<RowKey, Row> at;
  };
  void addHeights(std::vector<float>& amounts) const;
  Rows& rowsOf(const AirGrid& grid);
  void fill(Rows& rows, const AirGrid& grid);
  void upload(const Rows& below, const Rows& above);

  const Simulation& simulation_;
  const Plan& plan_;
  bool perChannel_;
  AirRows rows_;
  std::vector<float> heights_;  ///< by height: the same for every view
  std::list<Rows> kept_;
  AirGrids grids_;
  glm::dvec3 position_{NAN};
  bool first_ = true;  ///< of the picture
  CoefficientsOnGpu coefficients_;
  Buffer block_, amounts_, radiance_;
};

}  // namespace pitviper
