#pragma once
// The panels of the window: each draws itself into the room that it is given, and changes the state by what is done there.
#include <memory>
#include <string>

#include "scenarios/view/window/view_state.hpp"

namespace pitviper {

class Panel {
 public:
  virtual ~Panel() = default;
  virtual std::string title() const = 0;
  /// A word in the names of its widgets.
  virtual std::string name() const = 0;
  virtual void draw(ViewState& state) = 0;
  /// Where there is no scenario, in the place of its pictures; false: nothing.
  virtual bool drawWide(ViewState&, ImVec2) { return false; }
  /// Each frame, shown or not.
  virtual void look(ViewState&) {}
  /// Whether what scripts wait for by this word is there; nothing where it is none of its own.
  virtual std::optional<bool> isReached(const std::string&, const ViewState&) const { return std::nullopt; }
  /// A key that nobody else took, with the control key down.
  virtual bool controlKey(int, bool, ViewState&) { return false; }
};

std::unique_ptr<Panel> makeProbePanel();
std::unique_ptr<Panel> makeScenePanel();
std::unique_ptr<Panel> makeDialPanel();
/// `asked`: a material's name or file to begin with; empty: none.
std::unique_ptr<Panel> makeMaterialPanel(const std::string& asked);

/// Pictures of the layers shown, with overlays and tools, in what is left of the window.
class PicturesPanel {
 public:
  void draw(ViewState& state, ImVec2 size);

 private:
  void reload(ViewState& state);
  void overlay(ViewState& state, const PictureTile& tile);
  void use(ViewState& state, PictureTile& tile);
  void fly(ViewState& state, const PictureTile& tile);
  std::vector<std::unique_ptr<PictureTile>> tiles_;
  std::uint64_t number_ = 0;
  const Frame *frame_ = nullptr, *shaped_ = nullptr;
  FrameLook look_;
  std::vector<std::string> loaded_;
  glm::ivec2 from_{0};
  bool drags_ = false;
};

}  // namespace pitviper
