#include "scenarios/view/window/style.hpp"

#include <array>
#include <filesystem>

namespace pitviper {
namespace {

constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr float kLetters_px = 15.0f;

ImVec4 rgb(int r, int g, int b) { return ImVec4(static_cast<float>(r) / 255.0f, static_cast<float>(g) / 255.0f, static_cast<float>(b) / 255.0f, 1.0f); }

}  // namespace

void setStyle(float scale) {
  ImGuiIO& io = ImGui::GetIO();
  // Latin, Greek, superscripts and arrows, as units and axes have them.
  static const ImWchar letters[] = {0x20,   0xff,   0x370,  0x3ff,  0x2010, 0x2044, 0x2070, 0x209f, 0x2190,
                                    0x21ff, 0x2200, 0x22ff, 0x25a0, 0x25ff, 0x2300, 0x23ff, 0};
  std::error_code ignored;
  if (std::filesystem::is_regular_file(kFont, ignored)) io.Fonts->AddFontFromFileTTF(kFont, kLetters_px * scale, nullptr, letters);
  else io.Fonts->AddFontDefault(), io.FontGlobalScale = scale;
  ImGui::StyleColorsDark();
  ImGuiStyle& s = ImGui::GetStyle();
  s.WindowRounding = s.ChildRounding = s.PopupRounding = 4.0f;
  s.FrameRounding = s.GrabRounding = s.TabRounding = 3.0f;
  s.WindowBorderSize = 0.0f;
  s.FramePadding = ImVec2(8.0f, 4.0f);
  s.ItemSpacing = ImVec2(8.0f, 6.0f);
  s.WindowPadding = ImVec2(10.0f, 10.0f);
  auto& c = s.Colors;
  c[ImGuiCol_WindowBg] = rgb(27, 30, 36);
  c[ImGuiCol_ChildBg] = rgb(33, 37, 44);
  c[ImGuiCol_PopupBg] = rgb(38, 43, 51);
  c[ImGuiCol_FrameBg] = rgb(48, 54, 64);
  c[ImGuiCol_FrameBgHovered] = rgb(60, 67, 79);
  c[ImGuiCol_FrameBgActive] = rgb(70, 78, 92);
  c[ImGuiCol_Button] = rgb(54, 61, 73);
  c[ImGuiCol_ButtonHovered] = rgb(72, 81, 97);
  c[ImGuiCol_ButtonActive] = rgb(170, 122, 40);
  c[ImGuiCol_Header] = rgb(62, 70, 84);
  c[ImGuiCol_HeaderHovered] = rgb(74, 84, 100);
  c[ImGuiCol_HeaderActive] = rgb(84, 95, 114);
  c[ImGuiCol_Tab] = rgb(42, 47, 56);
  c[ImGuiCol_TabHovered] = rgb(84, 95, 114);
  c[ImGuiCol_TabActive] = rgb(72, 81, 97);
  c[ImGuiCol_SliderGrab] = c[ImGuiCol_CheckMark] = rgb(240, 176, 64);
  c[ImGuiCol_SliderGrabActive] = rgb(255, 200, 100);
  c[ImGuiCol_Text] = rgb(226, 230, 236);
  c[ImGuiCol_TextDisabled] = rgb(150, 156, 166);
  c[ImGuiCol_Separator] = rgb(60, 66, 78);
  c[ImGuiCol_NavHighlight] = rgb(240, 176, 64);
  s.ScaleAllSizes(scale);
}

ImU32 curveColour(std::size_t number) {
  static constexpr std::array<ImU32, 8> kColours{IM_COL32(86, 180, 233, 255),  IM_COL32(230, 159, 0, 255),  IM_COL32(0, 158, 115, 255),
                                                 IM_COL32(204, 121, 167, 255), IM_COL32(240, 228, 66, 255), IM_COL32(213, 94, 0, 255),
                                                 IM_COL32(70, 130, 220, 255),  IM_COL32(220, 220, 220, 255)};
  return kColours[number % kColours.size()];
}

}  // namespace pitviper
