#pragma once
// Lines of sight cut where something begins or ends on them, near to far: from the hits of each line what is to be worked out, in lists by kind, and in which
// order the line passes it. So things in each other, and panes that cut each other, are right by construction.
#include <functional>
#include <span>
#include <vector>

#include "sim/render/geometry/hit_lists.hpp"

namespace pitviper {

class OrderedLines {
 public:
  /// `firstFieldDraw`: fields are draws from there on.
  OrderedLines(const ShaderLibrary& library, const ShaderSlots& slots, int firstFieldDraw);

  /// Entries of each list, and of each field's in the list of all fields; passages of fields.
  struct Lists {
    std::size_t panes = 0, segments = 0, fieldPassages = 0;
    std::size_t goes = 0;  ///< a pixel's, or each of a pixel's lines through fields and beside them
    std::vector<std::size_t> fieldEntries, fieldFirst;
    std::size_t passages() const { return panes + segments + fieldPassages; }
  };
  /// Of lines [first, first + count). `fieldEntries`: of each field as many as there can be. `set`: sets what sim/render/media/glsl/field_lines.glsl reads.
  /// Draws and view are bound. Throws GlError where a line meets more things than a driver without a GPU works through.
  Lists order(const HitLists& hits, std::size_t first, std::size_t count, std::span<const std::size_t> fieldEntries,
              const std::function<void(const Program&)>& set);

  // What order() left, as textures.
  void bindPanes(unsigned unit) const { panes_.bindTexture(unit, 4, true); }
  void bindSegments(unsigned unit) const { segments_.bindTexture(unit, 4, true); }
  void bindFieldEntries(unsigned unit) const { fieldEntries_.bindTexture(unit, 4, true); }
  void bindWords(unsigned unit) const { words_.bindTexture(unit, 1, true); }
  void bindSteps(unsigned steps, unsigned ofLines, unsigned goes) const;
  NamedProgram program() const { return {"order of hits", program_.text()}; }

 private:
  Program program_;
  int firstField_;
  std::size_t eventRoom_ = 0, stepRoom_ = 0, listRoom_ = 0, wordRoom_ = 0;
  Buffer totals_, events_, lineSteps_, steps_, panes_, segments_, words_, fieldEntries_, goes_;
};

}  // namespace pitviper
