#pragma once
// The visibility pass: which opaque triangle each pixel sees, and how deep it is. Near bodies first; bodies of one small mesh as instances; of
// bodies with many triangles only those whose box shows something, so that what is hidden costs next to nothing.
#include "sim/gl/objects.hpp"
#include "sim/render/assembly/tables.hpp"
#include "sim/render/geometry/gpu_scene.hpp"
#include "sim/world/view.hpp"

namespace pitviper {

class SolidPass {
 public:
  /// All but the library must outlive it.
  SolidPass(const Simulation& simulation, const std::vector<DrawItem>& items, const GpuScene& scene, const ShaderLibrary& library);
  /// Clears the target and fills it. Draws, view and meshes are bound.
  void draw(RenderTarget& target, const View& view, const WorldState& state, const std::vector<char>& drawn);

  /// Clears the target, and has all programs compiled.
  void warmUp(RenderTarget& target);

  /// Something that may show.
  struct Candidate {
    std::uint32_t draw = 0, first = 0, triangles = 0;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> shown;  ///< first and count of what of them may show; empty: all
    int entity = 0;
    bool cull = false;
    bool boxBefore = false;  ///< its box lies before the camera as a whole
    double distance_m = 0.0;
  };
  std::vector<Candidate> candidatesIn(const View& view, const WorldState& state, const std::vector<char>& drawn) const;
  /// Part by part: clears a target, then draws what may show in a part of it (corner, size) in views of one body each.
  void clear(RenderTarget& target);
  void drawPart(const glm::ivec4& part, const std::vector<Candidate>& candidates) const;

 private:
  void drawOne(const Program& program, const Candidate& c) const;
  void drawTriangles(const Candidate& shape, std::uint32_t first, std::uint32_t count, std::size_t instances) const;
  void cutOff(Candidate& c, const View& view, const Pose& pose, const MeshPart& part) const;
  static void finish();
  void drawHidden(const std::vector<Candidate>& dense);

  const Simulation& simulation_;
  const std::vector<DrawItem>& items_;
  const GpuScene& scene_;
  std::shared_ptr<const SolidPrograms> programs_;
  Buffer instances_;
  std::vector<GlName<deleteQuery>> queries_;
  const RenderTarget* target_ = nullptr;
};

}  // namespace pitviper
