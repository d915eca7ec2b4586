#pragma once
// Programs' first draws, in several threads. A driver without a GPU compiles what is left of a program when it is first drawn, a tenth of a second to a second
// each, on the thread that draws.
#include <memory>
#include <vector>

#include "sim/gl/objects.hpp"

namespace pitviper {

class DrawState;

/// Makes some programs, each by a draw that reaches no pixel, in the state that it was added in. This thread and others, with contexts that share objects with
/// the current one, take one after the other; what the others compile this one's driver then finds in its cache on the disk. They begin where something is
/// compiled at all. Nothing is made where the driver has no such cache or draws by itself, or for less than two programs: a program is made at its first use in
/// any case.
class FirstDraws {
 public:
  FirstDraws();
  ~FirstDraws();
  FirstDraws(const FirstDraws&) = delete;
  FirstDraws& operator=(const FirstDraws&) = delete;

  /// A program, unless it is made or added, with the targets, textures, images and tests of the current context; the program may be of any state. It must
  /// outlive make(). `primitive`: GL_TRIANGLES or GL_POINTS.
  void add(const Program& program, unsigned primitive);
  /// Throws GlError for a program that this thread cannot make. The state of the context is afterwards what it was.
  void make();

 private:
  struct Entry {
    const Program* program;
    unsigned primitive;
    std::unique_ptr<const DrawState> state;
  };
  std::vector<Entry> entries_;
};

}  // namespace pitviper
