#pragma once
// ImGui's widgets that scripts find by name.
#include <imgui.h>

#include <string>
#include <vector>

#include "scenarios/view/window/marks.hpp"

namespace pitviper {

inline bool button(Marks& marks, const std::string& name, const std::string& label, const char* tip = nullptr) {
  const bool pressed = ImGui::Button((label + "##" + name).c_str());
  marks.item(name);
  if (tip && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tip);
  return pressed;
}

/// One that stays down.
inline bool toggle(Marks& marks, const std::string& name, const std::string& label, bool& on, const char* tip = nullptr) {
  if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
  const bool wasOn = on, pressed = button(marks, name, label, tip);
  if (wasOn) ImGui::PopStyleColor();
  if (pressed) on = !on;
  return pressed;
}

inline bool check(Marks& marks, const std::string& name, const std::string& label, bool& on) {
  const bool pressed = ImGui::Checkbox((label + "##" + name).c_str(), &on);
  marks.item(name);
  return pressed;
}

/// One of some words: its number, or -1 where nothing was chosen now.
inline int choose(Marks& marks, const std::string& name, const std::string& now, const std::vector<std::string>& words, float width) {
  int chosen = -1;
  ImGui::SetNextItemWidth(width);
  const bool open = ImGui::BeginCombo(("##" + name).c_str(), now.c_str());
  marks.item(name);
  if (!open) return chosen;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (ImGui::Selectable((words[k] + "##" + name + std::to_string(k)).c_str(), words[k] == now)) chosen = static_cast<int>(k);
    marks.item(name + ":" + words[k]);
  }
  ImGui::EndCombo();
  return chosen;
}

inline void row(const char* what, const std::string& value) {
  ImGui::TextDisabled("%s", what);
  ImGui::SameLine(9.5f * ImGui::GetTextLineHeight());
  ImGui::TextUnformatted(value.c_str());
}

}  // namespace pitviper
