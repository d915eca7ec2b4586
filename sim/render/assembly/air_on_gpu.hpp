#pragma once
// The contract of an atmosphere's half on the GPU: its shader file for the slot `path`, and the tables that this reads.
//
// The file says what lies on a way (AirPath) and what a node's radiance becomes on it: airFromCamera(range), airBeyond(near, nearRange, height,
// sinElevation, length), airToSun(camera, height), airToLight(camera, height, sinElevation, distance); pathTransmittance(node, air), pathRadiance(node,
// air), pathSeen(node, air, radiance), and for media pathDepth(node, near, far), pathInside(node, near, far). atmosphere/one_amount.glsl has all of them for
// air of one absorber, given its length. Buffers: uniform block 3, textures 20 and 21.
#include "sim/gl/shader_assembler.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

class AirOnGpu {
 public:
  virtual ~AirOnGpu() = default;
  /// The slot `path`, and constants.
  virtual void addSlots(ShaderSlots& slots) const = 0;
  /// Path radiance is integrated over the channels beforehand: the shader has channelAir(group, air) for each four of them, and nodes have none.
  virtual bool givesChannels() const { return false; }
  /// A new picture; then each of its views. Tables may serve several views.
  virtual void begin() {}
  virtual void update(const View&, const WorldState&) {}
  virtual void bind() const {}
  /// Takes over what another has worked out, which was made of the same air, lights, ground and plan.
  virtual void takeTables(AirOnGpu&) {}
};

/// One that is its file alone.
class AirFile final : public AirOnGpu {
 public:
  explicit AirFile(std::string file) : file_(std::move(file)) {}
  void addSlots(ShaderSlots& slots) const override { slots.files["path"] = file_; }

 private:
  std::string file_;
};

}  // namespace pitviper
