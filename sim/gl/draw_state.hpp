#pragma once
// What a driver without a GPU compiles a program for: its targets, what it reads, its tests.
#include <array>
#include <utility>
#include <vector>

namespace pitviper {

/// Of the current context. Not of it: uniforms and their buffers, storage buffers, vertices; for none of these a program is compiled again.
class DrawState {
 public:
  DrawState();
  /// Into the same context.
  void apply() const;
  /// Into another one that shares objects with it. `framebuffer`: one of that context's, which gets the targets (level 0 of whole textures).
  void applyElsewhere(unsigned framebuffer) const;

 private:
  struct Target {
    unsigned point, texture;
  };
  struct Image {
    unsigned unit;
    int texture, access, format;
  };
  void applyRest() const;
  int framebuffer_ = 0;
  std::vector<Target> targets_;
  std::vector<unsigned> drawBuffers_;
  std::array<int, 2> emptySize_{};                       ///< of a framebuffer without targets [pixels]
  std::vector<std::pair<unsigned, unsigned>> textures_;  ///< unit, name
  std::vector<Image> images_;
  std::vector<std::pair<unsigned, bool>> tests_;
  std::array<int, 4> viewport_{};
  int depthFunc_ = 0, blendFrom_ = 0, blendInto_ = 0, clipOrigin_ = 0, clipDepth_ = 0;
  unsigned char depthMask_ = 0;
  std::array<unsigned char, 4> colourMask_{};
};

}  // namespace pitviper
