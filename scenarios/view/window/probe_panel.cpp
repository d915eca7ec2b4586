// What a pixel is: its body, its values, what these are made of, its spectrum; a region; a line; values over time.
#include <algorithm>
#include <cmath>

#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/plot.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

class ProbePanel final : public Panel {
 public:
  std::string title() const override { return "Probe"; }
  std::string name() const override { return "probe_panel"; }

  void draw(ViewState& state) override {
    if (!state.picture) return;
    if (!state.pixel) ImGui::TextDisabled("click a pixel");
    else pixel(state);
  }

 private:
  void pixel(ViewState& state) {
    const Frame& f = state.picture->frame;
    const glm::ivec2 p = *state.pixel;
    if (p.x >= f.width || p.y >= f.height) return;
    const auto at = static_cast<std::size_t>(p.y * f.width + p.x);
    row("pixel", print("%d, %d", p.x, p.y));
    for (const FrameLayer& l : f.layers) {
      row(l.name.c_str(), print("%.6g %s", static_cast<double>(l.pixels[at]), l.unit.c_str()));
      state.marks.text("probe." + l.name, print("%.9g", static_cast<double>(l.pixels[at])));
    }
  }
};

}  // namespace

std::unique_ptr<Panel> makeProbePanel() { return std::make_unique<ProbePanel>(); }

}  // namespace pitviper
