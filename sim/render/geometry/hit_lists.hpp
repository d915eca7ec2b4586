#pragma once
// What the lines of a picture meet that is seen through, as the rasteriser finds it: a chain of hits for each line, in no order.
// Source: per-pixel linked lists, Yang et al. 2010 (doi:10.1111/j.1467-8659.2010.01725.x).
#include <functional>
#include <map>
#include <vector>

#include "sim/gl/objects.hpp"
#include "sim/render/assembly/named_program.hpp"

namespace pitviper {

class HitLists {
 public:
  enum class Kind { Pane, Medium, Border, Field };  ///< border: a triangle of a meshed medium

  /// `slots`: ground and ground_end. A program of each kind that is asked for.
  HitLists(const ShaderLibrary& library, const ShaderSlots& slots, const std::vector<Kind>& kinds);

  /// Finds the hits of a picture, whose solid scene `visibility` has and which must last while they are asked for; what has the nearest depth of all is left
  /// out. `draw`: draws what there is, each after use() of its kind; called again where there was not enough room. Draws, view, meshes are bound.
  void find(const RenderTarget& visibility, const std::function<void()>& draw);
  /// The program of a kind in use, for one to be drawn: its uniforms but those of the lists are the caller's.
  const Program& use(Kind kind) const;
  /// Pixels that have any.
  std::size_t lineCount() const { return lines_; }
  int filmWidth() const { return visibility_->width(); }
  /// Read back: which pixel, and the hit as sim/render/geometry/glsl/hit_kinds.glsl has it.
  void eachHit(const std::function<void(int, int, const glm::uvec4&)>& visit) const;
  /// As textures of these units: first hits of pixels, hits, lines; the chains for writing.
  void bind(unsigned heads, unsigned hits, unsigned lines, unsigned links) const;
  void bindLines(unsigned unit) const { lineList_.bindTexture(unit, 1, true); }
  void addPrograms(std::vector<NamedProgram>& all) const;

 private:
  std::map<Kind, Program> programs_;
  const RenderTarget* visibility_ = nullptr;
  std::size_t lines_ = 0, found_ = 0, room_ = 0;
  Buffer heads_, hits_, links_, lineList_, totals_;
  std::vector<RenderTarget> targets_;  ///< without colours, by size
};

/// More room than was needed once: pictures of a run differ little.
inline std::size_t roomFor(std::size_t needed) { return needed + needed / 4 + 1024; }

}  // namespace pitviper
