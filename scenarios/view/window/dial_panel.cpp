// The dial: accuracy for speed, what a plan then leaves out, and what the picture is off by.
#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "scenarios/view/newest_work.hpp"
#include "scenarios/view/reference_difference.hpp"
#include "scenarios/view/window/glfw_window.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

constexpr float kFinest = 0.1f, kCoarsest = 20.0f;  // per cent

class DialPanel final : public Panel {
 public:
  DialPanel()
      : work_(
            [this] {
              auto desk = std::make_shared<ReferenceDesk>(shaderLibrary());
              return [this, desk](const ShownPicturePointer& picture, const Work::Stale& isStale) {
                return desk->look(*picture, isStale, [this](std::shared_ptr<const ReferenceDifference> some) {
                  work_.publish(std::move(some));
                  GlfwWindow::wake();
                });
              };
            },
            [] { GlfwWindow::wake(); }) {}
  std::string title() const override { return "Accuracy"; }
  std::string name() const override { return "dial"; }

  std::optional<bool> isReached(const std::string& what, const ViewState&) const override {
    if (what != "dial") return std::nullopt;
    return !work_.isBusy() && work_.newest() != nullptr;
  }

  void draw(ViewState& state) override {
    if (!state.hasScene() || !state.picture) return;
    const float text = ImGui::GetTextLineHeight();
    const double asked = state.accuracy > 0.0 ? state.accuracy : state.scene->simulation.cameras[state.camera].spectral.accuracy;
    if (!(asked > 0.0)) ImGui::TextWrapped("This camera asks for no accuracy: its wavelengths are chosen by the scenario's 'spectral'.");
    if (!drags_) dial_ = static_cast<float>(100.0 * (asked > 0.0 ? asked : 0.01));
    ImGui::SetNextItemWidth(16.0f * text);
    ImGui::SliderFloat("asked", &dial_, kFinest, kCoarsest, "%.2f %%", ImGuiSliderFlags_Logarithmic);
    state.marks.item("accuracy");
    drags_ = ImGui::IsItemActive();
    if (ImGui::IsItemDeactivatedAfterEdit() && asked > 0.0) state.accuracy = 0.01 * static_cast<double>(dial_);
    for (const double a : {0.002, 0.01, 0.03, 0.1}) {
      ImGui::SameLine();
      if (button(state.marks, print("accuracy_%g", 100.0 * a), print("%g %%", 100.0 * a)) && asked > 0.0) state.accuracy = a;
    }
    keep(state);
    table();
    const ShownPicture& p = *state.picture;
    if (!p.dropped.empty()) ImGui::TextWrapped("left out: %s", joined(p.dropped).c_str());
    if (!p.kept.empty()) ImGui::TextWrapped("kept: %s", joined(p.kept).c_str());
    ImGui::Separator();
    ImGui::BeginDisabled(p.tier == Tier::Sketch);
    if (button(state.marks, "reference", "difference to the reference",
               "some pixels of this view at every wavelength in double precision, more and more of them"))
      work_.want(state.picture);
    ImGui::EndDisabled();
    if (work_.isBusy()) ImGui::SameLine(), ImGui::TextDisabled("working...");
    if (const std::string wrong = work_.error(); !wrong.empty()) ImGui::TextWrapped("%s", wrong.c_str());
    difference(state, text);
  }

 private:
  using Work = NewestWork<ShownPicturePointer, ReferenceDifference>;
  struct Row {
    double asked, expected, draw_ms;
    int groups;
  };

  static std::string joined(const std::vector<std::string>& words) {
    std::string all;
    for (const std::string& w : words) all += (all.empty() ? "" : ", ") + w;
    return all;
  }

  /// What was seen of each accuracy, of the camera and scene at hand.
  void keep(const ViewState& state) {
    const ShownPicture& p = *state.picture;
    const std::string of = state.cameraShown().name;
    if (of != of_ || geometry_ != state.scene->geometry) rows_.clear(), of_ = of, geometry_ = state.scene->geometry;
    if (p.tier != Tier::Asked || !(p.accuracy > 0.0)) return;
    const auto found = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) { return r.asked == p.accuracy; });
    Row& row = found == rows_.end() ? rows_.emplace_back(Row{p.accuracy, p.error, p.draw_ms, p.groups}) : *found;
    if (p.number != counted_) row.draw_ms = std::min(row.draw_ms, p.draw_ms);  // the first picture of a plan compiles
    counted_ = p.number;
    row.expected = p.error, row.groups = p.groups;
    std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.asked < b.asked; });
  }

  void table() const {
    if (rows_.empty() || !ImGui::BeginTable("accuracies", 4, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchSame)) return;
    for (const char* title : {"asked", "at most expected", "groups", "ms a picture"}) ImGui::TableSetupColumn(title);
    ImGui::TableHeadersRow();
    for (const Row& r : rows_) {
      for (const std::string& cell :
           {print("%.3g %%", 100.0 * r.asked), print("%.2g %%", 100.0 * r.expected), std::to_string(r.groups), print("%.0f", r.draw_ms)}) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(cell.c_str());
      }
    }
    ImGui::EndTable();
  }

  void difference(ViewState& state, float text) {
    const auto newest = work_.newest();
    if (!newest) return;
    if (newest != shown_) {
      shown_ = newest;
      tiles_.resize(newest->channels.size());
      for (std::size_t k = 0; k < tiles_.size(); ++k) {
        if (!tiles_[k]) tiles_[k] = std::make_unique<PictureTile>();
        const auto& c = newest->channels[k];
        Frame frame;
        frame.width = newest->width, frame.height = newest->height;
        FrameLayer layer{c.name, "%, drawn less reference", c.relative};
        for (float& v : layer.pixels) v *= 100.0f;
        const double most = std::max(100.0 * c.largest, 1e-4);
        FrameLook look;
        look.map = "blue_yellow";
        look.layers[c.name].ends = {-most, most};
        LayerPicture picture = layerPicture(frame, layer, look, nullptr);
        picture.title = print("%s: rms %.2g %%, largest %.2g %%", c.name.c_str(), 100.0 * c.rms, 100.0 * c.largest);
        tiles_[k]->load(std::move(picture), newest->width, newest->height);
        state.say(print("%d pixels against the reference", newest->pixels));
      }
    }
    ImGui::TextDisabled("%d pixels, one of each square of %d%s", newest->pixels, newest->step,
                        state.picture->number == newest->picture ? "" : " (of an earlier picture)");
    for (std::size_t k = 0; k < tiles_.size(); ++k) {
      state.marks.text("difference." + newest->channels[k].name, print("%.6g", newest->channels[k].largest));
      tiles_[k]->draw("difference" + std::to_string(k), ImVec2(ImGui::GetContentRegionAvail().x, 17.0f * text), zoom_);
      ImGui::Dummy(ImVec2(0.0f, 0.4f * text));
    }
    state.marks.text("difference_pixels", std::to_string(newest->pixels));
  }

  float dial_ = 1.0f;
  bool drags_ = false;
  std::vector<Row> rows_;
  std::string of_;
  std::shared_ptr<const int> geometry_;
  std::uint64_t counted_ = 0;
  std::shared_ptr<const ReferenceDifference> shown_;
  std::vector<std::unique_ptr<PictureTile>> tiles_;
  TileZoom zoom_;
  Work work_;
};

}  // namespace

std::unique_ptr<Panel> makeDialPanel() { return std::make_unique<DialPanel>(); }

}  // namespace pitviper
