#include "scenarios/commands/charts/style.hpp"

#include <vtkTextProperty.h>

#include <string>

#include "sim/image/draw_text.hpp"

namespace pitviper::chart_style {

void setFont(vtkTextProperty& text, int size_px, bool bold, Rgb8 colour) {
  // The font of the previews, which has every sign of the labels; else VTK's own.
  static const std::string plain = plainFontFile().string(), heavy = boldFontFile().string();
  const std::string& file = bold ? heavy : plain;
  text.SetFontFamily(file.empty() ? VTK_ARIAL : VTK_FONT_FILE);
  if (!file.empty()) text.SetFontFile(file.c_str());
  text.SetFontSize(size_px * kOversampling);
  text.SetBold(bold && file.empty() ? 1 : 0);
  text.SetItalic(0);
  text.SetShadow(0);
  text.SetColor(colour.r / 255.0, colour.g / 255.0, colour.b / 255.0);
}

}  // namespace pitviper::chart_style
