#pragma once
// A small drawing in SVG: lines, bars, dots and words.
#include <string>
#include <utility>
#include <vector>

namespace pitviper {

/// Lengths in pixels, from the left and from the top.
class SvgDrawing {
 public:
  enum class Anchor { Start, Middle, End };
  SvgDrawing(double width, double height) : width_(width), height_(height) {}
  void line(double x0, double y0, double x1, double y1, const std::string& colour, double width = 1.0);
  void bar(double x, double y, double width, double height, const std::string& colour);
  /// Half clear, so that many in one place show.
  void dots(const std::vector<std::pair<double, double>>& places, double diameter, const std::string& colour);
  void text(double x, double y, const std::string& words, Anchor anchor = Anchor::Start, bool bold = false);
  /// The element; `says`: for who does not see it.
  std::string svg(const std::string& says) const;

 private:
  double width_, height_;
  std::string body_;
};

/// A text's beginning and an ellipsis where it has more than `most` characters, at least 2 (of UTF-8).
std::string shortenedText(const std::string& text, std::size_t most);

}  // namespace pitviper
