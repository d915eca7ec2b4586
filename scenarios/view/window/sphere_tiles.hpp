#pragma once
// Spheres of a material beside its curves: under two lights, for the eye and for infrared bands; a second material beside it.
#include <memory>
#include <string>
#include <vector>

#include "scenarios/view/edited_material.hpp"
#include "scenarios/view/illuminants.hpp"
#include "scenarios/view/newest_work.hpp"
#include "scenarios/view/sphere_picture.hpp"
#include "scenarios/view/window/picture_tile.hpp"
#include "scenarios/view/window/view_state.hpp"

namespace pitviper {

class SphereTiles {
 public:
  SphereTiles();
  ~SphereTiles();
  /// What is chosen of them: lights, a second material; asks for pictures where something has changed.
  void draw(ViewState& state, const EditedMaterial& edited, float text);
  /// The pictures.
  void show(ImVec2 size, float text);
  bool isDone() const;

 private:
  void load(const ViewState& state);
  struct Own;
  std::unique_ptr<Own> own_;
};

}  // namespace pitviper
