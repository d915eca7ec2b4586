#include "sim/image/draw_text.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <array>
#include <cstdint>
#include <mutex>
#include <system_error>

namespace pitviper {

struct Font::State {
  FT_Library library = nullptr;
  FT_Face face = nullptr;
  mutable std::mutex mutex;

  ~State() {
    if (face != nullptr) FT_Done_Face(face);
    if (library != nullptr) FT_Done_FreeType(library);
  }
};

namespace {

constexpr char32_t replacement = 0xfffd;

/// Takes one code point off the front of `text`, which is not empty.
char32_t nextCodePoint(std::string_view& text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  std::size_t length = 1;
  char32_t code = first, least = 0;
  if (first >= 0xf0 && first < 0xf8) length = 4, code = first & 0x07, least = 0x10000;
  else if (first >= 0xe0 && first < 0xf0) length = 3, code = first & 0x0f, least = 0x800;
  else if (first >= 0xc0 && first < 0xe0) length = 2, code = first & 0x1f, least = 0x80;
  else if (first >= 0x80) code = replacement;
  for (std::size_t i = 1; i < length; ++i) {
    if (i >= text.size() || (byte(i) & 0xc0) != 0x80) {
      text.remove_prefix(i);
      return replacement;
    }
    code = code << 6 | (byte(i) & 0x3f);
  }
  text.remove_prefix(length);
  return code < least || code > 0x10ffff || (code >= 0xd800 && code <= 0xdfff) ? replacement : code;
}

std::uint8_t blend(std::uint8_t below, std::uint8_t above, int coverage) {
  return static_cast<std::uint8_t>((below * (255 - coverage) + above * coverage + 127) / 255);
}

void drawGlyph(Rgb8Image& picture, const FT_Bitmap& glyph, int left, int top, Rgb8 colour) {
  if (glyph.pixel_mode != FT_PIXEL_MODE_GRAY) return;
  for (int row = 0; row < static_cast<int>(glyph.rows); ++row) {
    const unsigned char* line = glyph.buffer + static_cast<std::ptrdiff_t>(row) * glyph.pitch;
    for (int column = 0; column < static_cast<int>(glyph.width); ++column) {
      const int x = left + column, y = top + row;
      if (!picture.holds(x, y)) continue;
      const Rgb8 below = picture.at(x, y);
      const int coverage = line[column];
      picture.set(x, y, {blend(below.r, colour.r, coverage), blend(below.g, colour.g, coverage), blend(below.b, colour.b, coverage)});
    }
  }
}

/// Sets the text out and calls place(glyph slot, pen x in pixels) for each glyph; returns the advance in pixels.
template <class Place>
int layOut(FT_Face face, std::string_view utf8, int size_px, FT_Int32 loadFlags, Place place) {
  if (size_px < 1 || FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(size_px)) != 0) return 0;
  FT_Pos pen = 0;  // in 1/64 pixel
  FT_UInt before = 0;
  while (!utf8.empty()) {
    const FT_UInt index = FT_Get_Char_Index(face, nextCodePoint(utf8));
    FT_Vector kerning = {0, 0};
    if (before != 0 && index != 0 && FT_Get_Kerning(face, before, index, FT_KERNING_DEFAULT, &kerning) == 0) pen += kerning.x;
    before = index;
    if (FT_Load_Glyph(face, index, loadFlags) != 0) continue;
    place(face->glyph, static_cast<int>((pen + 32) >> 6));
    pen += face->glyph->advance.x;
  }
  return static_cast<int>((pen + 32) >> 6);
}

std::filesystem::path findFont(const char* name) {
  // Debian and Ubuntu, Fedora, Arch.
  constexpr std::array<const char*, 3> folders = {"/usr/share/fonts/truetype/dejavu", "/usr/share/fonts/dejavu-sans-fonts", "/usr/share/fonts/TTF"};
  for (const char* folder : folders) {
    std::error_code ignored;
    const std::filesystem::path file = std::filesystem::path(folder) / name;
    if (std::filesystem::is_regular_file(file, ignored)) return file;
  }
  return {};
}

}  // namespace

Font::Font(const std::filesystem::path& file) : state_(std::make_unique<State>()) {
  if (file.empty() || FT_Init_FreeType(&state_->library) != 0) return;
  if (FT_New_Face(state_->library, file.c_str(), 0, &state_->face) != 0) state_->face = nullptr;
}

Font::~Font() = default;

bool Font::available() const { return state_->face != nullptr; }

int Font::width(std::string_view utf8, int size_px) const {
  if (!available()) return 0;
  const std::lock_guard lock(state_->mutex);
  return layOut(state_->face, utf8, size_px, FT_LOAD_TARGET_LIGHT, [](FT_GlyphSlot, int) {});
}

void Font::draw(Rgb8Image& picture, int x, int y, std::string_view utf8, int size_px, Rgb8 colour) const {
  if (!available()) return;
  const std::lock_guard lock(state_->mutex);
  layOut(state_->face, utf8, size_px, FT_LOAD_RENDER | FT_LOAD_TARGET_LIGHT,
         [&](FT_GlyphSlot slot, int pen) { drawGlyph(picture, slot->bitmap, x + pen + slot->bitmap_left, y - slot->bitmap_top, colour); });
}

std::filesystem::path plainFontFile() { return findFont("DejaVuSans.ttf"); }
std::filesystem::path boldFontFile() { return findFont("DejaVuSans-Bold.ttf"); }

const Font& plainFont() {
  static const Font font(plainFontFile());
  return font;
}

const Font& boldFont() {
  static const Font font(boldFontFile());
  return font;
}

}  // namespace pitviper
