#include "sim/image/preview.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "sim/image/colour_map.hpp"
#include "sim/image/draw_text.hpp"
#include "sim/image/picture_scale.hpp"
#include "sim/image/ticks.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr Rgb8 background = {22, 24, 29};
constexpr Rgb8 frameColour = {74, 79, 90};
constexpr Rgb8 strongText = {240, 242, 245};
constexpr Rgb8 plainText = {198, 203, 212};
constexpr Rgb8 notFinite = {255, 0, 255};  // in neither colour map

constexpr int minLongerSide = 512;
constexpr int kMostPreviewSide = 8192;
constexpr int minBarHeight = 150;  // room for six labels and two notes

/// The finite values of an image and what clipping needs of them.
struct Extent {
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  bool any() const { return least <= most; }
};

Extent extentOf(const std::vector<float>& pixels) {
  Extent extent;
  for (const float value : pixels)
    if (std::isfinite(value)) {
      extent.least = std::min<double>(extent.least, value);
      extent.most = std::max<double>(extent.most, value);
    }
  return extent;
}

std::string shortened(const Font& font, std::string text, int size_px, int room) {
  if (font.width(text, size_px) <= room) return text;
  while (!text.empty() && font.width(text + "…", size_px) > room) {
    while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) text.pop_back();
    if (!text.empty()) text.pop_back();
  }
  return text + "…";
}

/// Values to three digits at even places of a bent scale, each apart from its neighbours.
Ticks bentTicks(const PictureScale& scale) {
  Ticks ticks;
  for (double position : {0.04, 0.2, 0.36, 0.52, 0.68, 0.84, 0.97}) {
    const double exact = scale.value(position), step = std::abs(scale.value(position + 0.03) - scale.value(position - 0.03));
    const double unit = std::pow(10.0, std::floor(std::log10(std::max(step, 1e-300))));
    const double rounded = std::round(exact / unit) * unit;
    const double at = scale.position(rounded);
    if (!std::isfinite(at) || at < 0.0 || at > 1.0 || (!ticks.values.empty() && rounded <= ticks.values.back())) continue;
    ticks.values.push_back(rounded);
    ticks.labels.push_back(std::abs(rounded) >= 1e5 || (rounded != 0.0 && std::abs(rounded) < 1e-3)
                               ? shortNumber(rounded)
                               : print("%.*f", std::clamp(static_cast<int>(-std::floor(std::log10(unit))), 0, 9), rounded));
  }
  return ticks;
}

/// What stands in the column of the colour bar.
struct BarText {
  std::string unit, mostNote, leastNote;
  Ticks ticks;
};

BarText barText(const PreviewOptions& options, const Extent& extent, const PictureScale& scale) {
  BarText text;
  const double low = scale.low(), high = scale.high();
  text.ticks = scale.isLinear() ? chooseTicks(low, high) : bentTicks(scale);
  text.unit = powerText(text.ticks.power);
  if (!text.unit.empty() && !options.unit.empty()) text.unit += ' ';
  text.unit += options.unit;
  if (extent.any() && extent.most > high && !isNearlySame(high, extent.most)) text.mostNote = "max " + shortNumber(extent.most);
  if (extent.any() && extent.least < low && !isNearlySame(extent.least, low)) text.leastNote = "min " + shortNumber(extent.least);
  return text;
}

/// Lengths in pixels, all from the size of the text.
struct Measures {
  int text, title, margin, gap, bar, tick, arrow;

  explicit Measures(int longerSide)
      : text(std::clamp(longerSide / 40, 14, 48)),
        title(text + text / 4),
        margin(text),
        gap(text + text / 4),
        bar(text + text / 4),
        tick(text / 3),
        arrow(text) {}
};

void drawFrame(Rgb8Image& canvas, int x0, int y0, int x1, int y1) {
  canvas.fill(x0 - 1, y0 - 1, x1 + 1, y0, frameColour);
  canvas.fill(x0 - 1, y1, x1 + 1, y1 + 1, frameColour);
  canvas.fill(x0 - 1, y0, x0, y1, frameColour);
  canvas.fill(x1, y0, x1 + 1, y1, frameColour);
}

void drawPixels(Rgb8Image& canvas, int x0, int y0, int factor, int width, int height, const std::vector<float>& pixels, const ColourMap& map,
                const PictureScale& scale, const std::vector<Rgb8>& colours) {
  std::size_t i = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++i) {
      const float value = pixels[i];
      const Rgb8 colour = !std::isfinite(value) ? notFinite : colours.empty() ? map(static_cast<float>(scale.position(value))) : colours[i];
      const int left = x0 + x * factor, top = y0 + y * factor;
      canvas.fill(left, top, left + factor, top + factor, colour);
    }
}

/// Isosceles triangle on the edge row `base` of the bar, its tip `height` rows above (up) or below.
void drawArrow(Rgb8Image& canvas, int x0, int width, int base, int height, bool up, Rgb8 colour) {
  for (int row = 0; row < height; ++row) {
    const int inset = (row + 1) * width / (2 * height + 2);
    const int y = up ? base - 1 - row : base + row;
    canvas.fill(x0 + inset, y, x0 + width - inset, y + 1, colour);
  }
}

void drawBar(Rgb8Image& canvas, int x0, int top, int bottom, const BarText& text, const Measures& measure, const ColourMap& map, const PictureScale& scale) {
  const Font& font = plainFont();
  const int labelsAt = x0 + measure.bar + measure.tick + measure.text / 3;
  const int rise = measure.text * 36 / 100;  // half the height of digits in DejaVu Sans
  if (!text.unit.empty()) {
    font.draw(canvas, x0, top + measure.text * 3 / 4, text.unit, measure.text, strongText);
    top += measure.text + measure.text;
  }
  const auto note = [&](const std::string& words, int middle) { font.draw(canvas, labelsAt, middle + rise, words, measure.text, strongText); };
  if (!text.mostNote.empty()) {
    top += measure.arrow + 2;
    drawArrow(canvas, x0, measure.bar, top - 2, measure.arrow, true, map(1.0f));
    note(text.mostNote, top - 2 - measure.arrow / 2);
  }
  if (!text.leastNote.empty()) {
    bottom -= measure.arrow + 2;
    // A dark end on the dark background needs the frame's colour to be seen.
    drawArrow(canvas, x0, measure.bar, bottom + 2, measure.arrow, false, frameColour);
    note(text.leastNote, bottom + 2 + measure.arrow / 2);
  }
  const int rows = bottom - top;
  for (int row = 0; row < rows; ++row)
    canvas.fill(x0, top + row, x0 + measure.bar, top + row + 1, map(1.0f - static_cast<float>(row) / static_cast<float>(rows - 1)));
  drawFrame(canvas, x0, top, x0 + measure.bar, bottom);
  // A label right beside a note would be written over it.
  const double highest = text.mostNote.empty() ? top - measure.text : top + measure.text * 0.6;
  const double lowest = text.leastNote.empty() ? bottom + measure.text : bottom - measure.text * 0.6;
  for (std::size_t i = 0; i < text.ticks.values.size(); ++i) {
    const double part = std::clamp(scale.position(text.ticks.values[i]), 0.0, 1.0);
    const int y = top + static_cast<int>(std::lround((1.0 - part) * (rows - 1)));
    canvas.fill(x0 + measure.bar + 1, y, x0 + measure.bar + 1 + measure.tick, y + 1, plainText);
    if (y >= highest && y <= lowest) font.draw(canvas, labelsAt, y + rise, text.ticks.labels[i], measure.text, plainText);
  }
}

/// Room for any note, so that the pictures of a run have one size.
int columnWidth(const BarText& text, const Measures& measure) {
  const Font& font = plainFont();
  int labels = font.width("max −8.88e−88", measure.text);
  for (const std::string& label : text.ticks.labels) labels = std::max(labels, font.width(label, measure.text));
  const int beside = measure.bar + measure.tick + measure.text / 3 + labels;
  return std::max(beside, font.width(text.unit, measure.text));
}

PictureScale scaleFor(const std::vector<float>& pixels, const PreviewOptions& options) {
  if (options.scale) return *options.scale;
  if (options.range) return PictureScale::between(options.range->first, options.range->second);
  return PictureScale::of(pixels);
}

int even(int length) { return length + length % 2; }

void check(int width, int height, const std::vector<float>& pixels, const PreviewOptions& options) {
  if (width < 1 || height < 1 || width > kMostPreviewSide || height > kMostPreviewSide) throw std::invalid_argument("makePreview: a side is not in 1..8192");
  if (pixels.size() != static_cast<std::size_t>(width) * static_cast<std::size_t>(height))
    throw std::invalid_argument("makePreview: pixels are not width * height");
  if (!options.colours.empty() && options.colours.size() != pixels.size()) throw std::invalid_argument("makePreview: colours are not width * height");
  if (options.range) {
    const auto [low, high] = *options.range;
    if (!std::isfinite(low) || !std::isfinite(high) || low > high || !std::isfinite(high - low))
      throw std::invalid_argument("makePreview: the range is not finite or falls");
  }
}

}  // namespace

Rgb8Image makePreview(int width, int height, const std::vector<float>& pixels, const PreviewOptions& options) {
  check(width, height, pixels, options);
  const ColourMap& map = colourMap(options.colourMap);
  const PictureScale scale = scaleFor(pixels, options);

  const int longer = std::max(width, height);
  const int factor = (minLongerSide + longer - 1) / longer;
  const int pictureWidth = width * factor, pictureHeight = height * factor;
  const Measures measure(std::max(pictureWidth, pictureHeight));
  const BarText text = barText(options, extentOf(pixels), scale);
  const int column = columnWidth(text, measure);
  const int titleHeight = options.title.empty() ? 0 : measure.title + measure.text;
  const int bodyHeight = std::max(pictureHeight, std::max(minBarHeight, 14 * measure.text));

  Rgb8Image canvas(even(measure.margin + pictureWidth + measure.gap + column + measure.margin),
                   even(measure.margin + titleHeight + bodyHeight + measure.margin), background);
  const int bodyTop = measure.margin + titleHeight;
  if (!options.title.empty()) {
    const int room = canvas.width - 2 * measure.margin;
    boldFont().draw(canvas, measure.margin, measure.margin + measure.title * 8 / 10, shortened(boldFont(), options.title, measure.title, room), measure.title,
                    strongText);
  }
  const int pictureTop = bodyTop + (bodyHeight - pictureHeight) / 2;
  drawPixels(canvas, measure.margin, pictureTop, factor, width, height, pixels, map, scale, options.colours);
  drawFrame(canvas, measure.margin, pictureTop, measure.margin + pictureWidth, pictureTop + pictureHeight);
  drawBar(canvas, measure.margin + pictureWidth + measure.gap, bodyTop, bodyTop + bodyHeight, text, measure, map, scale);
  return canvas;
}

Rgb8Image makePlainPreview(int width, int height, const std::vector<float>& pixels, const PreviewOptions& options) {
  check(width, height, pixels, options);
  Rgb8Image canvas(even(width), even(height), {0, 0, 0});
  drawPixels(canvas, 0, 0, 1, width, height, pixels, colourMap(options.colourMap), scaleFor(pixels, options), options.colours);
  return canvas;
}

Rgb8Image placeSideBySide(const std::vector<Rgb8Image>& pictures) {
  if (pictures.empty()) return {};
  int width = 0, height = 0;
  for (const Rgb8Image& picture : pictures) {
    width += picture.width;
    height = std::max(height, picture.height);
  }
  Rgb8Image sheet(width, height, background);
  int left = 0;
  for (const Rgb8Image& picture : pictures) {
    for (int y = 0; y < picture.height; ++y) {
      const auto from = picture.rgb.begin() + static_cast<std::ptrdiff_t>(picture.offset(0, y));
      std::copy(from, from + 3 * std::ptrdiff_t{picture.width}, sheet.rgb.begin() + static_cast<std::ptrdiff_t>(sheet.offset(left, y)));
    }
    left += picture.width;
  }
  return sheet;
}

}  // namespace pitviper
