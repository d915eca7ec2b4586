#include <algorithm>
#include <cmath>

#include "scenarios/view/frame_files.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/style.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Flying goes so much of the distance to what is in the middle in a second; over nothing at all:
constexpr double kShareOfRange = 0.5, kNothingThere_m = 200.0;

/// Columns in which so many pictures of a shape fill a room best.
int columnsFor(std::size_t count, ImVec2 room, double shape) {
  int best = 1;
  double largest = 0.0;
  for (int columns = 1; columns <= static_cast<int>(count); ++columns) {
    const int rows = (static_cast<int>(count) + columns - 1) / columns;
    const double side = std::min(static_cast<double>(room.x) / columns / shape, static_cast<double>(room.y) / rows);
    if (side > largest) largest = side, best = columns;
  }
  return best;
}

}  // namespace

void PicturesPanel::reload(ViewState& state) {
  const Frame& frame = state.picture->frame;
  const std::string composite = "composite " + (state.three.size() == 3 ? state.three[0] + ", " + state.three[1] + ", " + state.three[2] : std::string());
  std::vector<std::string> wanted = state.composite && state.three.size() == 3 ? std::vector{composite} : state.shown;
  std::erase_if(wanted, [&](const std::string& name) { return name != composite && !layerNamed(frame, name); });
  const Overlays& o = state.overlays;
  if (shaped_ != &frame && (o.outlines || o.boxes || o.gate)) state.shapes = EntityShapes::of(frame), shaped_ = &frame;
  if (number_ == state.picture->number && frame_ == &frame && look_ == state.look && loaded_ == wanted) return;
  number_ = state.picture->number, frame_ = &frame, look_ = state.look, loaded_ = wanted;
  tiles_.resize(wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (!tiles_[k]) tiles_[k] = std::make_unique<PictureTile>();
    if (wanted[k] == composite) tiles_[k]->load(composite, compositePicture(frame, state.three, state.look), frame.width, frame.height);
    else tiles_[k]->load(layerPicture(frame, *layerNamed(frame, wanted[k]), state.look, state.temperatureOf(wanted[k])), frame.width, frame.height);
  }
}

void PicturesPanel::overlay(ViewState& state, const PictureTile& tile) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRect(tile.low(), tile.high(), true);
  const Overlays& o = state.overlays;
  if (o.outlines)
    for (const glm::ivec4& e : state.shapes.edges) list->AddLine(tile.at(e.x, e.y), tile.at(e.z, e.w), colours::kAccent, 1.2f);
  const int target = state.hasScene() ? state.cameraShown().mount.lookAtEntity : -1;
  const float text = ImGui::GetTextLineHeight();
  for (const EntityShape& s : state.shapes.shapes) {
    const bool isKnown = state.hasScene() && s.entity < static_cast<int>(state.scene->simulation.entities.size());
    const std::string name =
        isKnown ? state.scene->simulation.entities[static_cast<std::size_t>(s.entity)].name : bodyNamed(state.picture->frame, s.entity + 1);
    const ImVec2 low = tile.at(s.left, s.top), high = tile.at(s.right, s.bottom);
    const ImVec2 a(low.x - 3.0f, low.y - 3.0f), b(high.x + 3.0f, high.y + 3.0f);
    if (o.boxes) {
      // What fills the picture from side to side has a name, and no box.
      if (s.left > 0 || s.right < state.picture->frame.width) list->AddRect(a, b, colours::kGood, 0.0f, 0, 1.2f);
      std::string label = o.names ? name : "";
      if (o.ranges) label += (label.empty() ? "" : "  ") + (s.nearest_m < 1e4 ? print("%.0f m", s.nearest_m) : print("%.2f km", 1e-3 * s.nearest_m));
      const ImVec2 at(std::max(a.x, tile.low().x + 2.0f), std::max(a.y - 1.15f * text, tile.low().y + 2.0f));
      list->AddText(ImVec2(at.x + 1.0f, at.y + 1.0f), IM_COL32(0, 0, 0, 220), label.c_str());
      list->AddText(at, colours::kGood, label.c_str());
    }
    if (o.gate && s.entity == target) {
      const ImVec2 m(0.5f * (low.x + high.x), 0.5f * (low.y + high.y));
      const float half = std::max({0.75f * (high.x - low.x), 0.75f * (high.y - low.y), 12.0f}), corner = 0.35f * half;
      for (float x : {-1.0f, 1.0f})
        for (float y : {-1.0f, 1.0f}) {
          const ImVec2 p(m.x + x * half, m.y + y * half);
          list->AddLine(p, ImVec2(p.x - x * corner, p.y), colours::kBad, 2.0f);
          list->AddLine(p, ImVec2(p.x, p.y - y * corner), colours::kBad, 2.0f);
        }
    }
  }
  if (state.pixel) {
    const ImVec2 a = tile.at(state.pixel->x, state.pixel->y), b = tile.at(state.pixel->x + 1, state.pixel->y + 1);
    const ImVec2 m(0.5f * (a.x + b.x), 0.5f * (a.y + b.y));
    list->AddRect(ImVec2(a.x - 1.0f, a.y - 1.0f), ImVec2(b.x + 1.0f, b.y + 1.0f), IM_COL32(255, 255, 255, 255), 0.0f, 0, 1.5f);
    for (const auto& [dx, dy] : {std::pair{1.0f, 0.0f}, {-1.0f, 0.0f}, {0.0f, 1.0f}, {0.0f, -1.0f}})
      list->AddLine(ImVec2(m.x + dx * (0.5f * (b.x - a.x) + 4.0f), m.y + dy * (0.5f * (b.x - a.x) + 4.0f)),
                    ImVec2(m.x + dx * (0.5f * (b.x - a.x) + 12.0f), m.y + dy * (0.5f * (b.x - a.x) + 12.0f)), IM_COL32(255, 255, 255, 255), 1.5f);
  }
  if (state.region)
    list->AddRect(tile.at(state.region->left, state.region->top), tile.at(state.region->right, state.region->bottom), IM_COL32(86, 180, 233, 255), 0.0f, 0,
                  1.5f);
  if (state.profile)
    list->AddLine(tile.at(state.profile->x + 0.5, state.profile->y + 0.5), tile.at(state.profile->z + 0.5, state.profile->w + 0.5), IM_COL32(86, 180, 233, 255),
                  1.8f);
  list->PopClipRect();
}

void PicturesPanel::fly(ViewState& state, const PictureTile& tile) {
  const ImGuiIO& io = ImGui::GetIO();
  if (!state.hasScene() || !state.picture) return;
  const std::string& name = state.cameraShown().name;
  Pose pose = state.hands.flown.count(name) ? state.hands.flown.at(name) : state.picture->pose;
  bool changed = false;
  const auto turn = [&](double right_rad, double up_rad) {
    Attitude a = attitudeOf(pose.orientation);
    a.heading_rad += right_rad;
    a.pitch_rad = std::clamp(a.pitch_rad + up_rad, -1.55, 1.55);
    a.roll_rad = 0.0;
    pose.orientation = orientationFrom(a);
    changed = true;
  };
  const double perPixel = state.picture->pinhole.pitchX_m / state.picture->pinhole.focalLength_m / tile.pixelSize();
  if (tile.isActive() && io.MouseDown[0] && (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f))
    turn(-static_cast<double>(io.MouseDelta.x) * perPixel, static_cast<double>(io.MouseDelta.y) * perPixel);
  glm::dvec3 way(0.0);
  const auto down = [&](char letter) { return !io.WantTextInput && !io.KeyCtrl && ImGui::IsKeyDown(letter); };
  if (down('W')) way.x += 1.0;
  if (down('S')) way.x -= 1.0;
  if (down('A')) way.y += 1.0;
  if (down('D')) way.y -= 1.0;
  if (down('E')) way.z += 1.0;
  if (down('Q')) way.z -= 1.0;
  if (way != glm::dvec3(0.0)) {
    const Frame& f = state.picture->frame;
    const FrameLayer* range = layerNamed(f, "truth.range");
    const double middle_m = range ? range->pixels[static_cast<std::size_t>(f.height / 2 * f.width + f.width / 2)] : 0.0;
    const double speed_m_s = kShareOfRange * (middle_m > 0.0 ? middle_m : kNothingThere_m) * (io.KeyShift ? 4.0 : 1.0);
    pose.position += pose.orientation * way * speed_m_s * std::min(static_cast<double>(io.DeltaTime), 0.1);
    changed = true;
  }
  if (changed) state.hands.flown[name] = pose;
}

void PicturesPanel::use(ViewState& state, PictureTile& tile) {
  const ImGuiIO& io = ImGui::GetIO();
  if (state.tool == Tool::Fly) return fly(state, tile);
  const std::optional<glm::ivec2> under = tile.pixelUnder(io.MousePos);
  if (tile.isHovered() && ImGui::IsMouseClicked(0) && under) from_ = *under, drags_ = true;
  if (!tile.isActive() || !io.MouseDown[0] || !under || !drags_) {
    if (!io.MouseDown[0]) drags_ = false;
    return;
  }
  if (state.tool == Tool::Probe) state.pixel = under;
  if (state.tool == Tool::Region && *under != from_)
    state.region = PixelBox{std::min(from_.x, under->x), std::min(from_.y, under->y), std::max(from_.x, under->x) + 1, std::max(from_.y, under->y) + 1};
  if (state.tool == Tool::Profile && *under != from_) state.profile = glm::ivec4(from_.x, from_.y, under->x, under->y);
}

void PicturesPanel::draw(ViewState& state, ImVec2 size) {
  ImGui::BeginChild("pictures", size, false, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
  const float text = ImGui::GetTextLineHeight();
  if (!state.picture) {
    ImGui::SetCursorPos(ImVec2(2.0f * text, 2.0f * text));
    if (!state.status.error.empty()) ImGui::PushTextWrapPos(0.0f), ImGui::TextColored(ImVec4(1.0f, 0.43f, 0.35f, 1.0f), "%s", state.status.error.c_str());
    else ImGui::TextDisabled(state.hasScene() ? "the first picture is being drawn" : "reading the scenario");
    ImGui::EndChild();
    return;
  }
  reload(state);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const Frame& frame = state.picture->frame;
  if (!tiles_.empty() && room.x > 4.0f * text && room.y > 4.0f * text) {
    const int columns = columnsFor(tiles_.size(), room, static_cast<double>(frame.width) / frame.height * 1.15);
    const int rows = (static_cast<int>(tiles_.size()) + columns - 1) / columns;
    const ImVec2 cell(room.x / static_cast<float>(columns), room.y / static_cast<float>(rows)), from = ImGui::GetCursorScreenPos();
    for (std::size_t k = 0; k < tiles_.size(); ++k) {
      PictureTile& tile = *tiles_[k];
      const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
      ImGui::SetCursorScreenPos(ImVec2(from.x + static_cast<float>(column) * cell.x, from.y + static_cast<float>(row) * cell.y));
      tile.draw("tile" + std::to_string(k), ImVec2(cell.x - 0.8f * text, cell.y - 0.6f * text), state.zoom);
      overlay(state, tile);
      use(state, tile);
      state.marks.put(tile.picture().title, tile.low(), tile.high());
      state.marks.surfaces[tile.picture().title] = [&tile](double x, double y) { return tile.at(x + 0.5, y + 0.5); };
      if (tile.isHovered())
        if (const auto p = tile.pixelUnder(ImGui::GetIO().MousePos); p && !tile.picture().values.empty())
          ImGui::SetTooltip("%d, %d: %.6g %s", p->x, p->y, static_cast<double>(tile.picture().values[static_cast<std::size_t>(p->y * frame.width + p->x)]),
                            tile.picture().unit.c_str());
    }
  } else {
    ImGui::TextDisabled("choose a layer above");
  }
  ImGui::EndChild();
}

}  // namespace pitviper
