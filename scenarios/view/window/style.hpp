#pragma once
// How the window looks: colours, sizes, letters.
#include <imgui.h>

namespace pitviper {

/// Of the current ImGui context; `scale`: of a display's density.
void setStyle(float scale);

/// Colours that people tell apart who see colours otherwise. Source: M. Okabe, K. Ito, "Color Universal Design" (2008).
ImU32 curveColour(std::size_t number);

namespace colours {
inline constexpr ImU32 kAccent = IM_COL32(240, 176, 64, 255), kDim = IM_COL32(150, 156, 166, 255), kText = IM_COL32(226, 230, 236, 255),
                       kLine = IM_COL32(70, 76, 88, 255), kPlot = IM_COL32(18, 20, 25, 255), kBad = IM_COL32(255, 110, 90, 255),
                       kGood = IM_COL32(110, 210, 150, 255);
}

}  // namespace pitviper
