#pragma once
// A plot in a window: axes with round ticks, curves, marks, and where on it the mouse is.
#include <imgui.h>

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

namespace pitviper {

struct PlotAxis {
  std::string label;
  double low = 0.0, high = 1.0;
  bool isLog = false;
};

class Plot {
 public:
  /// Takes the room; `id`: unique in the window.
  Plot(const std::string& id, ImVec2 size, PlotAxis x, PlotAxis y);
  Plot(const Plot&) = delete;
  Plot& operator=(const Plot&) = delete;

  ImVec2 at(double x, double y) const;
  glm::dvec2 valueAt(ImVec2 place) const;
  void line(const std::vector<double>& x, const std::vector<double>& y, ImU32 colour, float thickness = 1.6f);
  void bars(const std::vector<double>& edges, const std::vector<double>& heights, ImU32 colour);
  void mark(double x, double y, ImU32 colour, bool isBig);
  void upright(double x, ImU32 colour, const std::string& label = {});
  void level(double y, ImU32 colour);
  /// Names with their colours, in the upper right corner.
  void legend(const std::vector<std::pair<std::string, ImU32>>& names);
  bool isHovered() const { return hovered_; }
  bool isActive() const { return active_; }
  /// Of the mouse, where it is on the plot.
  std::optional<glm::dvec2> mouse() const;
  ImVec2 low() const { return low_; }
  ImVec2 high() const { return high_; }

 private:
  void drawAxes();
  PlotAxis x_, y_;
  ImVec2 low_, high_;  ///< of the inside
  ImDrawList* list_;
  bool hovered_ = false, active_ = false;
};

/// Ends of an axis around some values, a little beyond them.
PlotAxis axisAround(const std::string& label, const std::vector<const std::vector<double>*>& values, bool fromZero);

}  // namespace pitviper
