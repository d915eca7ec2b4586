#include "scenarios/view/window/picture_tile.hpp"

#include <epoxy/gl.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "scenarios/view/window/style.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/image/ticks.hpp"

namespace pitviper {
namespace {

/// Of the mouse's wheel, a notch.
constexpr double kNotch = 1.25;
constexpr double kMostZoom = 64.0;

ImTextureID asId(unsigned texture) { return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture)); }

}  // namespace

EntityShapes EntityShapes::of(const Frame& frame) {
  EntityShapes all;
  const FrameLayer *entity = layerNamed(frame, "truth.entity"), *range = layerNamed(frame, "truth.range");
  if (!entity) return all;
  std::map<int, EntityShape> shapes;
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= frame.width || y >= frame.height ? 0 : static_cast<int>(entity->pixels[static_cast<std::size_t>(y * frame.width + x)]);
  };
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const int e = at(x, y);
      if (x > 0 && at(x - 1, y) != e) all.edges.emplace_back(x, y, x, y + 1);
      if (y > 0 && at(x, y - 1) != e) all.edges.emplace_back(x, y, x + 1, y);
      if (e == 0) continue;
      auto [found, fresh] = shapes.try_emplace(e, EntityShape{e - 1, x, y, x, y, 0, INFINITY});
      EntityShape& s = found->second;
      s.left = std::min(s.left, x), s.top = std::min(s.top, y), s.right = std::max(s.right, x + 1), s.bottom = std::max(s.bottom, y + 1);
      ++s.pixels;
      if (range) {
        const double r = range->pixels[static_cast<std::size_t>(y * frame.width + x)];
        if (r > 0.0) s.nearest_m = std::min(s.nearest_m, r);
      }
    }
  for (const auto& [e, s] : shapes) all.shapes.push_back(s);
  return all;
}

PictureTile::~PictureTile() {
  if (texture_) glDeleteTextures(1, &texture_);
}

void PictureTile::upload(const std::vector<Rgb8>& colours, int width, int height) {
  if (!texture_) glGenTextures(1, &texture_);
  glBindTexture(GL_TEXTURE_2D, texture_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  if (width != width_ || height != height_) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);  // a pixel is a square
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, width, height, 0, GL_RGB, GL_UNSIGNED_BYTE, colours.data());
  } else {
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, colours.data());
  }
  width_ = width, height_ = height;
}

void PictureTile::load(LayerPicture picture, int width, int height) {
  picture_ = std::move(picture);
  hasBar_ = true;
  upload(picture_.colours, width, height);
}

void PictureTile::load(const std::string& title, const std::vector<Rgb8>& colours, int width, int height) {
  picture_ = {};
  picture_.title = title;
  hasBar_ = false;
  upload(colours, width, height);
}

ImVec2 PictureTile::at(double column, double row) const {
  return ImVec2(origin_.x + static_cast<float>(column * scale_), origin_.y + static_cast<float>(row * scale_));
}

glm::dvec2 PictureTile::placeOf(ImVec2 screen) const {
  return {static_cast<double>(screen.x - origin_.x) / scale_, static_cast<double>(screen.y - origin_.y) / scale_};
}

std::optional<glm::ivec2> PictureTile::pixelUnder(ImVec2 screen) const {
  const glm::dvec2 p = placeOf(screen);
  const glm::ivec2 pixel(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
  if (pixel.x < 0 || pixel.y < 0 || pixel.x >= width_ || pixel.y >= height_) return std::nullopt;
  return pixel;
}

void PictureTile::draw(const std::string& id, ImVec2 size, TileZoom& zoom) {
  const float text = ImGui::GetTextLineHeight();
  const ImVec2 from = ImGui::GetCursorScreenPos();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float bar = hasBar_ ? 6.2f * text : 0.0f;
  low_ = ImVec2(from.x, from.y + 1.4f * text);
  high_ = ImVec2(std::max(from.x + size.x - bar, low_.x + 1.0f), std::max(from.y + size.y, low_.y + 1.0f));
  list->AddText(from, colours::kText, picture_.title.c_str());
  ImGui::SetCursorScreenPos(low_);
  ImGui::InvisibleButton(id.c_str(), ImVec2(high_.x - low_.x, high_.y - low_.y), ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  hovered_ = ImGui::IsItemHovered();
  active_ = ImGui::IsItemActive();
  const double fit = std::min(static_cast<double>(high_.x - low_.x) / std::max(width_, 1), static_cast<double>(high_.y - low_.y) / std::max(height_, 1));
  const auto place = [&] {
    scale_ = fit * zoom.factor;
    const double x = 0.5 * (low_.x + high_.x) - zoom.middle.x * width_ * scale_, y = 0.5 * (low_.y + high_.y) - zoom.middle.y * height_ * scale_;
    origin_ = zoom.factor == 1.0 ? ImVec2(static_cast<float>(low_.x), static_cast<float>(low_.y)) : ImVec2(static_cast<float>(x), static_cast<float>(y));
  };
  place();
  const ImGuiIO& io = ImGui::GetIO();
  if (hovered_ && io.MouseWheel != 0.0f && width_ > 0) {
    const glm::dvec2 under = placeOf(io.MousePos);
    zoom.factor = std::clamp(zoom.factor * std::pow(kNotch, static_cast<double>(io.MouseWheel)), 1.0, kMostZoom);
    scale_ = fit * zoom.factor;
    const glm::dvec2 offset(static_cast<double>(io.MousePos.x - 0.5f * (low_.x + high_.x)), static_cast<double>(io.MousePos.y - 0.5f * (low_.y + high_.y)));
    zoom.middle = (under - offset / scale_) / glm::dvec2(width_, height_);
    if (zoom.factor == 1.0) zoom.middle = {0.5, 0.5};
    place();
  }
  if (active_ && io.MouseDown[1] && zoom.factor > 1.0) {
    zoom.middle -= glm::dvec2(static_cast<double>(io.MouseDelta.x), static_cast<double>(io.MouseDelta.y)) / scale_ / glm::dvec2(width_, height_);
    place();
  }
  list->PushClipRect(low_, high_, true);
  if (width_ > 0) list->AddImage(asId(texture_), at(0, 0), at(width_, height_));
  list->PopClipRect();
  if (!hasBar_) return;
  // Beside the picture, not at the far end of its room.
  const float right = std::min(high_.x, std::max(at(width_, 0).x, low_.x + 1.0f)), bottom = std::min(high_.y, std::max(at(0, height_).y, low_.y + 4.0f * text));
  drawBar(ImVec2(right + 0.6f * text, low_.y), ImVec2(right + 1.6f * text, bottom));
}

void PictureTile::drawBar(ImVec2 low, ImVec2 high) const {
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float text = ImGui::GetTextLineHeight();
  const ColourMap& map = colourMap(picture_.map);
  low.y += 1.2f * text;
  const auto colourAt = [&](float p) {
    const Rgb8 c = map(p);
    return IM_COL32(c.r, c.g, c.b, 255);
  };
  constexpr int kSteps = 64;
  for (int k = 0; k < kSteps; ++k) {
    const float a = static_cast<float>(k) / kSteps, b = static_cast<float>(k + 1) / kSteps;
    const float top = high.y - b * (high.y - low.y), under = high.y - a * (high.y - low.y);
    list->AddRectFilledMultiColor(ImVec2(low.x, top), ImVec2(high.x, under), colourAt(b), colourAt(b), colourAt(a), colourAt(a));
  }
  list->AddRect(low, high, colours::kLine);
  list->AddText(ImVec2(low.x, low.y - 1.25f * text), colours::kDim, picture_.unit.c_str());
  float last = 1e9f;
  for (const auto& [value, label] : picture_.scale.ticks()) {
    const float y = high.y - static_cast<float>(picture_.scale.position(value)) * (high.y - low.y);
    if (std::abs(y - last) < text) continue;
    last = y;
    list->AddLine(ImVec2(high.x, y), ImVec2(high.x + 0.3f * text, y), colours::kDim);
    list->AddText(ImVec2(high.x + 0.45f * text, y - 0.5f * text), colours::kText, label.c_str());
  }
}

}  // namespace pitviper
