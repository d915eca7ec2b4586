// What can be changed by hand: field of view, temperatures, levels; and how that gets into the scenario.
#include <algorithm>
#include <cmath>

#include "scenarios/view/frame_files.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr double kDegree = kPi / 180.0;

class ScenePanel final : public Panel {
 public:
  std::string title() const override { return "Scene"; }
  std::string name() const override { return "scene"; }

  void draw(ViewState& state) override {
    const float text = ImGui::GetTextLineHeight();
    if (!state.hasScene()) {
      if (!state.picture) return;
      row("size", print("%d x %d", state.picture->frame.width, state.picture->frame.height));
      auto words = wordsOf(state.picture->frame);
      std::stable_partition(words.begin(), words.end(), [](const auto& w) { return w.first.rfind("less ", 0) == 0; });
      for (const auto& [name, value] : words) {
        ImGui::TextDisabled("%s", name.c_str());
        ImGui::TextWrapped("%s", value.c_str());
        state.marks.text("attribute." + name, value);
      }
      return;
    }
    const Simulation& sim = state.scene->simulation;
    ImGui::TextUnformatted(sim.name.c_str());
    camera(state, text);
    if (ImGui::CollapsingHeader("temperatures")) {
      for (std::size_t e = 0; e < sim.entities.size(); ++e) {
        const Entity& entity = sim.entities[e];
        for (std::size_t s = 0; s < entity.surfaces.size(); ++s) surface(state, entity, static_cast<int>(e), static_cast<int>(s));
      }
    }
    state.marks.item("temperatures");
    if (!sim.lights.empty() && ImGui::CollapsingHeader("lamps")) {
      for (std::size_t l = 0; l < sim.lights.size(); ++l) {
        const int index = static_cast<int>(l);
        if (sim.lights[l].lamp >= 0) continue;
        const auto set = state.hands.lightLevels.find(index);
        float level = static_cast<float>(set != state.hands.lightLevels.end() ? set->second : sim.lights[l].levelAt(state.time_s));
        ImGui::SetNextItemWidth(10.0f * text);
        if (ImGui::DragFloat((sim.lights[l].name + "##level").c_str(), &level, 0.01f, 0.0f, 100.0f, "%.3f"))
          state.hands.lightLevels[index] = std::max(0.0f, level);
        state.marks.item("level:" + sim.lights[l].name);
      }
    }
    changes(state);
  }

  bool controlKey(int key, bool, ViewState& state) override {
    if (key != 'S' || !state.hands.any()) return false;
    write(state);
    return true;
  }

 private:
  void camera(ViewState& state, float text) {
    const Camera& c = state.cameraShown();
    const auto set = state.hands.focalLengths_m.find(c.name);
    const double width_m = c.pinhole.width * c.pinhole.pitchX_m;
    const double now = set != state.hands.focalLengths_m.end() ? set->second : state.picture ? state.picture->pinhole.focalLength_m : c.pinhole.focalLength_m;
    float field = static_cast<float>(2.0 * std::atan(0.5 * width_m / now) / kDegree);
    ImGui::SetNextItemWidth(14.0f * text);
    if (ImGui::SliderFloat("field of view", &field, 0.1f, 120.0f, "%.3g deg", ImGuiSliderFlags_Logarithmic))
      state.hands.focalLengths_m[c.name] = 0.5 * width_m / std::tan(0.5 * std::clamp(static_cast<double>(field), 0.01, 170.0) * kDegree);
    state.marks.item("field_of_view");
    state.marks.text("field_of_view", print("%.6g", static_cast<double>(field)));
    if (state.picture) {
      const glm::dvec3 p = state.picture->pose.position;
      const Attitude a = attitudeOf(state.picture->pose.orientation);
      row("position", print("%.1f, %.1f, %.1f m", p.x, p.y, p.z));
      row("heading, pitch, roll", print("%.2f, %.2f, %.2f deg", a.heading_rad / kDegree, a.pitch_rad / kDegree, a.roll_rad / kDegree));
    }
    row("film", print("%d x %d, aperture %.3g mm", c.pinhole.width, c.pinhole.height, 1e3 * c.pinhole.apertureDiameter_m));
  }

  void surface(ViewState& state, const Entity& entity, int e, int s) {
    const Surface& surface = entity.surfaces[static_cast<std::size_t>(s)];
    if (surface.temperatureTexture >= 0) return;
    const std::string part =
        entity.surfaces.size() > 1 && entity.mesh && surface.meshPart < entity.mesh->parts.size() ? "." + entity.mesh->parts[surface.meshPart].name : "";
    const auto set = state.hands.temperatures_K.find({e, s});
    float kelvin = static_cast<float>(set != state.hands.temperatures_K.end() ? set->second : surface.temperatureAt_K(state.time_s));
    ImGui::SetNextItemWidth(10.0f * ImGui::GetTextLineHeight());
    if (ImGui::DragFloat((entity.name + part + "##temperature").c_str(), &kelvin, 0.5f, 1.0f, 5000.0f, "%.1f K"))
      state.hands.temperatures_K[{e, s}] = std::clamp(static_cast<double>(kelvin), 1.0, 5000.0);
    state.marks.item("temperature:" + entity.name + part);
  }

  void changes(ViewState& state) {
    const std::vector<YamlChange> keys = keysOf(state.scene->simulation, state.hands, state.time_s);
    if (keys.empty()) return;
    ImGui::Separator();
    ImGui::TextDisabled("changed by hand");
    for (const YamlChange& k : keys) ImGui::TextWrapped("%s: %s", k.path.c_str(), k.value.c_str());
    const std::string all = asSetOptions(keys);
    state.marks.text("changes", all);
    if (button(state.marks, "copy_set", "copy as --set")) {
      ImGui::SetClipboardText(all.c_str());
      state.say("copied");
    }
    ImGui::SameLine();
    if (button(state.marks, "write_back", "write into the scenario", "ctrl + S; comments stay")) write(state);
    ImGui::SameLine();
    if (button(state.marks, "forget", "forget")) state.hands = {}, problem_.clear();
    if (!problem_.empty()) ImGui::TextWrapped("%s", problem_.c_str());
    state.marks.text("write_problem", problem_);
  }

  /// The file that is watched changes, and is read again: what was changed by hand is the scenario's own then.
  void write(ViewState& state) {
    try {
      writeChanges(state.wish.scenario.file, keysOf(state.scene->simulation, state.hands, state.time_s));
      state.say("written into " + state.wish.scenario.file);
      state.hands = {};
    } catch (const std::exception& e) {
      problem_ = e.what();
      state.say("not written");
    }
  }

  std::string problem_;  ///< why the last was not written
};

}  // namespace

std::unique_ptr<Panel> makeScenePanel() { return std::make_unique<ScenePanel>(); }

}  // namespace pitviper
