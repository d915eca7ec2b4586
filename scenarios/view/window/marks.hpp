#pragma once
// What a window's frame shows, by name: where to click, and what is written there, for scripts.
#include <imgui.h>

#include <functional>
#include <map>
#include <string>

namespace pitviper {

struct Marks {
  struct Place {
    ImVec2 low, high;
  };
  std::map<std::string, Place> places;       ///< of this frame
  std::map<std::string, std::string> texts;  ///< the same
  /// Where on the screen a pixel of a picture, or a value of a plot, is.
  std::map<std::string, std::function<ImVec2(double x, double y)>> surfaces;

  std::string wanted;  ///< a widget that comes into view where it is scrolled out of it; empty: none

  void clear() { places.clear(), texts.clear(), surfaces.clear(); }
  void put(const std::string& name, ImVec2 low, ImVec2 high) { places[name] = {low, high}; }
  /// The widget that was made last.
  void item(const std::string& name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    put(name, low, high);
    const float top = ImGui::GetWindowPos().y;
    if (name == wanted && (low.y < top || high.y > top + ImGui::GetWindowHeight())) ImGui::SetScrollHereY();
  }
  void text(const std::string& name, const std::string& value) { texts[name] = value; }
};

}  // namespace pitviper
