// Around the window's pictures: what is shown and how, time, what the picture is, what is wrong, the keys.
#include <algorithm>
#include <cmath>

#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/viewer.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Words that ImGui reads as a format: a file's name may have % in it.
std::string asFormat(const std::string& words) {
  std::string all;
  for (const char c : words) all += c == '%' ? std::string("%%") : std::string(1, c);
  return all;
}

const std::vector<std::pair<std::string, double>>& speeds() {
  static const std::vector<std::pair<std::string, double>> all{{"each frame", 0.0}, {"x 0.1", 0.1}, {"x 0.25", 0.25}, {"x 1", 1.0}, {"x 4", 4.0}};
  return all;
}

/// What the picture is, and how far off.
std::string tierText(const ShownPicture& p) {
  const std::string most = p.error >= 0.0 ? print("at most %.2g %% expected", 100.0 * p.error) : "error unknown";
  switch (p.tier) {
    case Tier::Sketch:
      return "SKETCH: bodies in the sun without air, shadows, lamps and smoke; error unknown";
    case Tier::Draft:
      return "DRAFT: " + most;
    case Tier::Edited:
      return "EDITED: by the plan before; whether it holds is being found";
    case Tier::File:
      return p.frame.camera.empty() ? "A FILE" : "A FILE of camera " + p.frame.camera;
    case Tier::Asked:
      return p.accuracy > 0.0 ? print("AS ASKED (%.3g %%): ", 100.0 * p.accuracy) + most : "AS SAMPLED: no accuracy is asked for";
  }
  return "";
}

constexpr const char* kHelp[] = {"space",
                                 "play, pause",
                                 "left, right",
                                 "a frame back, on (shift: ten)",
                                 "home, end",
                                 "first, last frame",
                                 "alt + arrows",
                                 "the probe, a pixel (shift: ten)",
                                 "1 ... 9",
                                 "a layer shown or not",
                                 "C",
                                 "next camera",
                                 "G",
                                 "linear, logarithmic, histogram",
                                 "T",
                                 "radiance as apparent temperature",
                                 "M",
                                 "colours",
                                 "O",
                                 "outlines;  B  boxes;  X  track gate",
                                 "P, R, L, F",
                                 "probe, region, line profile, fly",
                                 "W A S D Q E",
                                 "flying; shift: faster",
                                 "V",
                                 "the sensor's own view again",
                                 "ctrl + Z, Y",
                                 "undo, redo in the curves",
                                 "ctrl + S",
                                 "write what was changed into the scenario",
                                 "F1",
                                 "this list",
                                 "F5",
                                 "read the scenario again",
                                 "F12",
                                 "screenshot",
                                 "tab, enter",
                                 "through all buttons"};

}  // namespace

void Viewer::topBar() {
  const float text = ImGui::GetTextLineHeight();
  if (state_.hasScene()) {
    std::vector<std::string> names;
    for (const Camera& c : state_.scene->simulation.cameras) names.push_back(c.name);
    if (const int c = choose(state_.marks, "camera", state_.cameraShown().name, names, 9.0f * text); c >= 0) {
      state_.camera = static_cast<std::size_t>(c);
      chooseLayers();
    }
    ImGui::SameLine();
  }
  if (button(state_.marks, "layers", "layers...")) ImGui::OpenPopup("layers_popup");
  if (ImGui::BeginPopup("layers_popup")) {
    if (state_.picture)
      for (const FrameLayer& l : state_.picture->frame.layers) {
        const auto at = std::find(state_.shown.begin(), state_.shown.end(), l.name);
        bool on = at != state_.shown.end();
        if (check(state_.marks, "layer:" + l.name, l.name + "  [" + l.unit + "]", on)) {
          if (on) state_.shown.push_back(l.name);
          else state_.shown.erase(at);
        }
      }
    ImGui::Separator();
    check(state_.marks, "composite", "three as red, green, blue", state_.composite);
    if (state_.composite && state_.picture && state_.three.size() == 3) {
      std::vector<std::string> names;
      for (const FrameLayer& l : state_.picture->frame.layers) names.push_back(l.name);
      for (std::size_t k = 0; k < 3; ++k) {
        const char* of[] = {"red", "green", "blue"};
        if (const int c = choose(state_.marks, of[k], state_.three[k], names, 12.0f * text); c >= 0) state_.three[k] = names[static_cast<std::size_t>(c)];
        ImGui::SameLine();
        ImGui::TextDisabled("%s", of[k]);
      }
    }
    ImGui::EndPopup();
  }
  ImGui::SameLine();
  lookBar();
  ImGui::SameLine();
  const auto tool = [&](const char* name, Tool t, const char* tip) {
    bool on = state_.tool == t;
    if (toggle(state_.marks, name, name, on, tip)) state_.tool = t;
    ImGui::SameLine();
  };
  ImGui::TextDisabled("|");
  ImGui::SameLine();
  tool("probe", Tool::Probe, "click a pixel (P)");
  tool("region", Tool::Region, "drag a box (R)");
  tool("profile", Tool::Profile, "drag a line (L)");
  tool("fly", Tool::Fly, "drag turns, W A S D Q E move (F); V: the sensor's own view");
  ImGui::TextDisabled("|");
  ImGui::SameLine();
  toggle(state_.marks, "outlines", "outlines", state_.overlays.outlines);
  ImGui::SameLine();
  toggle(state_.marks, "boxes", "boxes", state_.overlays.boxes, "name and range of each body");
  ImGui::SameLine();
  toggle(state_.marks, "gate", "gate", state_.overlays.gate, "around what the camera looks at");
}

void Viewer::lookBar() {
  const float text = ImGui::GetTextLineHeight();
  if (button(state_.marks, "scales", "scales...")) ImGui::OpenPopup("scales_popup");
  ImGui::SameLine();
  std::vector<std::string> maps = colourMapNames();
  maps.insert(maps.begin(), "auto");
  if (const int m = choose(state_.marks, "colours", state_.look.map, maps, 8.0f * text); m >= 0) state_.look.map = maps[static_cast<std::size_t>(m)];
  if (!ImGui::BeginPopup("scales_popup")) return;
  for (const std::string& layer : state_.shown) {
    LayerLook& look = state_.look.layers[layer];
    ImGui::TextUnformatted(layer.c_str());
    if (const int k = choose(state_.marks, "scale:" + layer, nameOf(look.kind), {"linear", "logarithmic", "histogram"}, 8.0f * text); k >= 0)
      look.kind = static_cast<ScaleKind>(k);
    ImGui::SameLine();
    if (state_.temperatureOf(layer) && check(state_.marks, "temperature:" + layer, "apparent temperature", look.asTemperature)) look.ends.reset();
    bool own = !look.ends;
    if (check(state_.marks, "own:" + layer, "ends of each picture's own", own)) {
      look.ends.reset();
      if (!own && state_.picture)
        if (const FrameLayer* l = layerNamed(state_.picture->frame, layer))
          look.ends = DisplayScale::endsOf(layerPicture(state_.picture->frame, *l, state_.look, state_.temperatureOf(layer)).values);
    }
    if (look.ends) {
      ImGui::SetNextItemWidth(8.0f * text);
      ImGui::InputDouble(("##low" + layer).c_str(), &look.ends->first, 0.0, 0.0, "%.5g");
      state_.marks.item("low:" + layer);
      ImGui::SameLine();
      ImGui::SetNextItemWidth(8.0f * text);
      ImGui::InputDouble(("##high" + layer).c_str(), &look.ends->second, 0.0, 0.0, "%.5g");
      state_.marks.item("high:" + layer);
    }
    ImGui::Separator();
  }
  ImGui::EndPopup();
}

void Viewer::timeline(float height) {
  ImGui::BeginChild("timeline", ImVec2(0.0f, height), false, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar);
  if (!state_.files.empty()) fileLine();
  if (state_.hasScene()) {
    const TimeAxis& time = state_.scene->simulation.time;
    const float text = ImGui::GetTextLineHeight();
    if (button(state_.marks, "play", state_.isPlaying ? "\u2016" : "\u25b6", "space")) state_.isPlaying = !state_.isPlaying;
    ImGui::SameLine();
    if (button(state_.marks, "back", "\u25c0", "left")) step(-1);
    ImGui::SameLine();
    if (button(state_.marks, "on", "\u25b8", "right")) step(1);
    ImGui::SameLine();
    toggle(state_.marks, "loop", "loop", state_.loops);
    ImGui::SameLine();
    std::vector<std::string> names;
    std::string now = print("x %g", state_.speed);
    for (const auto& [name, speed] : speeds()) {
      names.push_back(name);
      if (speed == state_.speed) now = name;
    }
    if (const int s = choose(state_.marks, "speed", now, names, 7.0f * text); s >= 0) state_.speed = speeds()[static_cast<std::size_t>(s)].second;
    ImGui::SameLine();
    int frame = static_cast<int>(std::lround((state_.time_s - time.start_s) / time.step_s));
    ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x, 4.0f * text));
    if (ImGui::SliderInt("##time", &frame, 0, std::max(time.frames - 1, 1), print("frame %%d of %d,  t = %.3f s", time.frames, state_.time_s).c_str()))
      state_.time_s = time.at(std::clamp(frame, 0, time.frames - 1));
    state_.marks.item("time");
    state_.marks.text("time", print("%.6g", state_.time_s));
    state_.marks.text("frame", std::to_string(frame));
  }
  ImGui::EndChild();
}

void Viewer::fileLine() {
  if (button(state_.marks, "play", state_.isPlaying ? "\u2016" : "\u25b6", "space")) state_.isPlaying = !state_.isPlaying;
  ImGui::SameLine();
  toggle(state_.marks, "loop", "loop", state_.loops);
  ImGui::SameLine();
  int file = static_cast<int>(state_.file);
  ImGui::SetNextItemWidth(std::max(ImGui::GetContentRegionAvail().x, 4.0f * ImGui::GetTextLineHeight()));
  const std::string name = state_.files[state_.file].filename().string();
  if (ImGui::SliderInt("##file", &file, 0, std::max(static_cast<int>(state_.files.size()) - 1, 1),
                       (asFormat(name) + print(", %d of %zu", file + 1, state_.files.size())).c_str()))
    state_.file = static_cast<std::size_t>(std::clamp(file, 0, static_cast<int>(state_.files.size()) - 1));
  state_.marks.item("time");
  state_.marks.text("file", name);
}

void Viewer::statusLine() {
  std::string line;
  if (state_.picture) {
    const ShownPicture& p = *state_.picture;
    line = tierText(p);
    const ImVec4 colour = p.tier >= Tier::Asked ? ImVec4(0.43f, 0.82f, 0.59f, 1.0f) : ImVec4(0.94f, 0.69f, 0.25f, 1.0f);
    ImGui::TextColored(colour, "%s", line.c_str());
    state_.marks.text("tier", nameOf(p.tier));
    state_.marks.text("status", line);
    state_.marks.text("expected_error", print("%.6g", p.error));
    state_.marks.text("groups", std::to_string(p.groups));
    state_.marks.text("draw_ms", print("%.3g", p.draw_ms));
    ImGui::SameLine();
    if (p.tier != Tier::File) ImGui::TextDisabled("%d groups of wavelengths, %.0f ms a picture", p.groups, p.draw_ms);
  }
  if (!state_.status.doing.empty()) {
    ImGui::SameLine();
    const std::string doing = state_.status.share > 0.0
                                  ? print("%s: %.0f %%, %.0f s so far", state_.status.doing.c_str(), 100.0 * state_.status.share, state_.status.since_s)
                                  : print("%s, %.0f s so far", state_.status.doing.c_str(), state_.status.since_s);
    ImGui::TextUnformatted(doing.c_str());
  }
  if (ImGui::GetTime() < state_.messageUntil_s) {
    ImGui::SameLine();
    ImGui::TextUnformatted(state_.message.c_str());
  }
  if (state_.picture && firstPicture_s_ < 0.0) firstPicture_s_ = now_s_;
  if (state_.picture && state_.picture->tier == Tier::Asked && firstAsked_s_ < 0.0) firstAsked_s_ = now_s_;
  if (state_.picture && state_.picture->wish.scene == askedScene_) {
    if (toPicture_s_ < 0.0) toPicture_s_ = now_s_ - askedAt_s_;
    if (toAsked_s_ < 0.0 && state_.picture->tier == Tier::Asked) toAsked_s_ = now_s_ - askedAt_s_;
  }
  state_.marks.text("scene_to_picture_s", print("%.3f", toPicture_s_));
  state_.marks.text("scene_to_as_asked_s", print("%.3f", toAsked_s_));
  state_.marks.text("first_picture_s", print("%.2f", firstPicture_s_));
  state_.marks.text("first_as_asked_s", print("%.2f", firstAsked_s_));
  state_.marks.text("message", state_.message);
  state_.marks.text("window_ms", print("%.1f", state_.window_ms));
  state_.marks.text("window_s", print("%.1f", state_.window_s));
  state_.marks.text("pictures_s", print("%.1f", state_.pictures_s));
}

/// What is wrong with the file that was saved; the last good scene stays behind it.
void Viewer::problemWindow() {
  const std::string problem = !state_.problem.empty() ? state_.problem : state_.status.error;
  state_.marks.text("problem", problem);
  if (problem.empty()) return;
  const float text = ImGui::GetTextLineHeight();
  ImGui::SetNextWindowPos(ImVec2(2.0f * text, 6.0f * text), ImGuiCond_Appearing);
  ImGui::SetNextWindowSize(ImVec2(48.0f * text, 0.0f));
  ImGui::Begin(state_.problem.empty() ? "No picture" : "The scenario cannot be read; the last good one is shown", nullptr, ImGuiWindowFlags_NoCollapse);
  ImGui::PushTextWrapPos(0.0f);
  const std::size_t place = problem.find(": ");
  ImGui::TextColored(ImVec4(1.0f, 0.43f, 0.35f, 1.0f), "%s", problem.substr(0, place).c_str());
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("a click copies the place");
  state_.marks.item("problem_place");
  if (ImGui::IsItemClicked()) {
    ImGui::SetClipboardText(problem.substr(0, place).c_str());
    state_.say("copied: " + problem.substr(0, place));
  }
  if (place != problem.npos) ImGui::TextUnformatted(problem.substr(place + 2).c_str());
  ImGui::PopTextWrapPos();
  ImGui::End();
}

void Viewer::helpWindow() {
  if (!showsHelp_) return;
  const float text = ImGui::GetTextLineHeight();
  ImGui::SetNextWindowSize(ImVec2(34.0f * text, 0.0f));
  ImGui::Begin("Keys", &showsHelp_, ImGuiWindowFlags_NoCollapse);
  for (std::size_t k = 0; k + 1 < std::size(kHelp); k += 2) {
    ImGui::TextColored(ImVec4(0.94f, 0.69f, 0.25f, 1.0f), "%s", kHelp[k]);
    ImGui::SameLine(11.0f * text);
    ImGui::TextUnformatted(kHelp[k + 1]);
  }
  ImGui::End();
}

}  // namespace pitviper
