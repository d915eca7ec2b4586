#include "scenarios/sweep/svg_drawing.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/commands/html_page.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// A tenth of a pixel is not seen.
std::string svgLength(double v) { return print("%g", std::round(10.0 * v) / 10.0 + 0.0); }

bool beginsCharacter(char c) { return (static_cast<unsigned char>(c) & 0xC0u) != 0x80u; }

}  // namespace

void SvgDrawing::line(double x0, double y0, double x1, double y1, const std::string& colour, double width) {
  body_ += "<path d=\"M" + svgLength(x0) + " " + svgLength(y0) + "L" + svgLength(x1) + " " + svgLength(y1) + "\" stroke=\"" + colour + "\" stroke-width=\"" +
           svgLength(width) + "\"/>\n";
}

void SvgDrawing::bar(double x, double y, double width, double height, const std::string& colour) {
  body_ += "<rect x=\"" + svgLength(x) + "\" y=\"" + svgLength(y) + "\" width=\"" + svgLength(width) + "\" height=\"" + svgLength(height) + "\" fill=\"" +
           colour + "\"/>\n";
}

void SvgDrawing::dots(const std::vector<std::pair<double, double>>& places, double diameter, const std::string& colour) {
  // A line without length and with round ends is a dot, in a third of a circle's bytes. Dots of one path do not add up: four paths do.
  std::array<std::string, 4> paths;
  for (std::size_t i = 0; i < places.size(); ++i) paths[i % paths.size()] += "M" + svgLength(places[i].first) + " " + svgLength(places[i].second) + "h0";
  for (const std::string& path : paths)
    if (!path.empty())
      body_ +=
          "<path d=\"" + path + "\" stroke=\"" + colour + "\" stroke-opacity=\"0.5\" stroke-width=\"" + svgLength(diameter) + "\" stroke-linecap=\"round\"/>\n";
}

void SvgDrawing::text(double x, double y, const std::string& words, Anchor anchor, bool bold) {
  const std::string side = anchor == Anchor::Start ? "" : anchor == Anchor::Middle ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
  body_ += "<text x=\"" + svgLength(x) + "\" y=\"" + svgLength(y) + "\"" + side + (bold ? " font-weight=\"600\"" : "") + ">" + HtmlPage::escaped(words) +
           "</text>\n";
}

std::string SvgDrawing::svg(const std::string& says) const {
  const std::string width = svgLength(width_), height = svgLength(height_);
  return "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + width + " " + height + "\" width=\"" + width +
         "\" style=\"max-width:100%\" role=\"img\" aria-label=\"" + HtmlPage::escaped(says) +
         "\" font-family=\"system-ui,sans-serif\" font-size=\"11\" fill=\"#282828\">\n" + body_ + "</svg>";
}

std::string shortenedText(const std::string& text, std::size_t most) {
  std::size_t characters = 0, cut = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (beginsCharacter(text[i]) && ++characters == most) cut = i;
  return characters > most ? text.substr(0, cut) + "…" : text;
}

}  // namespace pitviper
