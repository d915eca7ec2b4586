#pragma once
// Anti-aliased text on pictures. The only user of FreeType.
#include <filesystem>
#include <memory>
#include <string_view>

#include "sim/image/picture.hpp"

namespace pitviper {

/// A scalable font. Without its file text is absent, silently: a picture without words is better than none; `available` says so.
/// Calls on one font exclude each other, so threads may share it.
class Font {
 public:
  explicit Font(const std::filesystem::path& file);
  ~Font();
  Font(const Font&) = delete;
  Font& operator=(const Font&) = delete;

  bool available() const;

  /// Advance of the text in pixels for an em of `size_px` pixels; 0 without a font.
  int width(std::string_view utf8, int size_px) const;

  /// Draws with the text's left edge at `x` and its base line at row `y`; what lies outside is cut. Bytes that are no UTF-8 show as U+FFFD.
  void draw(Rgb8Image& picture, int x, int y, std::string_view utf8, int size_px, Rgb8 colour) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The files of DejaVu Sans and its bold face in the system's font folders; empty where they are not installed.
std::filesystem::path plainFontFile();
std::filesystem::path boldFontFile();

/// The fonts in these files.
const Font& plainFont();
const Font& boldFont();

}  // namespace pitviper
