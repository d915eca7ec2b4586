// Curves of a material under a hand, and what it then looks like: a sphere under two lights, and the scene.
#include <algorithm>
#include <cmath>

#include "scenarios/view/edited_material.hpp"
#include "scenarios/view/surface_import.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/plot.hpp"
#include "scenarios/view/window/sphere_tiles.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/image/atomic_file.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

struct Span {
  const char* name;
  double low_um, high_um;
};
constexpr Span kSpans[] = {{"0.38-0.78 um", 0.38, 0.78}, {"0.3-2.5 um", 0.3, 2.5}, {"3-5 um", 3.0, 5.0}, {"8-14 um", 7.5, 14.0}, {"0.3-15 um", 0.3, 15.0}};
/// How near the mouse has to be to a point, in heights of letters.
constexpr float kReach = 0.6f;

ImU32 colourOf(CurveKind kind) { return curveColour(static_cast<std::size_t>(kind)); }

class MaterialPanel final : public Panel {
 public:
  explicit MaterialPanel(std::string asked) : asked_(std::move(asked)) {}
  std::string title() const override { return "Material"; }
  std::string name() const override { return "material"; }

  std::optional<bool> isReached(const std::string& what, const ViewState&) const override {
    if (what != "sphere") return std::nullopt;
    return sphere_.isDone();
  }

  bool controlKey(int key, bool shift, ViewState& state) override {
    if (!edited_ || (key != 'Z' && key != 'Y')) return false;
    if (key == 'Y' || shift) edited_->redo();
    else edited_->undo();
    (void)state;
    return true;
  }

  /// What was edited is in the scene, once the scene before it has been drawn.
  void look(ViewState& state) override {
    if (!asked_.empty() && (state.hasScene() || state.wish.scenario.file.empty())) {
      const std::string word = std::exchange(asked_, {});
      open(state, word);
    }
    if (!state.hasScene()) return;
    if (state.asRead != read_) read_ = state.asRead, placed_ = 0, inScene_ = -1;
    if (!edited_ || edited_->revision() == placed_ || !opened_) return;
    if (inScene_ < 0) inScene_ = numberOf(state, edited_->name());
    if (inScene_ < 0 || edited_->revision() == first_) return;
    if (state.picture && state.picture->wish.scene != lastScene_ && lastScene_) return;
    try {
      auto material = std::make_shared<Material>(*edited_->material());
      material->name = state.asRead->simulation.materials[static_cast<std::size_t>(inScene_)]->name;
      state.scene = withMaterial(*state.asRead, static_cast<std::size_t>(inScene_), std::move(material));
      placed_ = edited_->revision();
      lastScene_ = state.scene;
      problem_.clear();
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
  }

  void draw(ViewState& state) override {
    const float text = ImGui::GetTextLineHeight();
    chooser(state, text);
    if (!problem_.empty()) ImGui::PushTextWrapPos(0.0f), ImGui::TextColored(ImVec4(1.0f, 0.43f, 0.35f, 1.0f), "%s", problem_.c_str()), ImGui::PopTextWrapPos();
    if (!edited_) {
      ImGui::TextWrapped("Click a body in the picture, or choose a material: its curves can be dragged, and the sphere and the scene follow.");
      return;
    }
    try {
      curves(state, text);
      numbers(state, text);
      film(state, text);
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
    saving(state, text);
    sphere_.draw(state, *edited_, text);
    if (state.hasScene()) sphere_.show(ImVec2(ImGui::GetContentRegionAvail().x, 26.0f * text), text);
  }

  bool drawWide(ViewState&, ImVec2 size) override {
    if (!edited_) return false;
    sphere_.show(size, ImGui::GetTextLineHeight());
    return true;
  }

 private:
  static int numberOf(const ViewState& state, const std::string& name) {
    const auto& all = state.asRead->simulation.materials;
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k]->name == name) return static_cast<int>(k);
    return -1;
  }

  void open(ViewState& state, const std::string& word) {
    try {
      const int at = state.hasScene() ? numberOf(state, word) : -1;
      const Libraries libraries = findLibraries();
      if (at < 0) edited_.emplace(EditedMaterial::named(word, libraries));
      else
        edited_.emplace(surfaceWithin(state.wish.scenario.file, word, state.asRead->simulation.materials[static_cast<std::size_t>(at)], libraries), libraries);
      opened_ = true;
      inScene_ = at;
      first_ = placed_ = edited_->revision();
      point_.reset();
      if (!edited_->surface().inForce(kind_)) kind_ = CurveKind::Diffuse;
      problem_.clear();
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
  }

  static std::string pickedMaterial(const ViewState& state) {
    if (!state.hasScene() || !state.pixel || !state.picture) return "";
    const Frame& f = state.picture->frame;
    const FrameLayer *entity = layerNamed(f, "truth.entity"), *part = layerNamed(f, "truth.part");
    const auto at = static_cast<std::size_t>(state.pixel->y * f.width + state.pixel->x);
    if (!entity || at >= entity->pixels.size()) return "";
    const int m = materialAt(state.asRead->simulation, static_cast<int>(entity->pixels[at]) - 1, part ? static_cast<int>(part->pixels[at]) - 1 : 0);
    return m < 0 ? "" : state.asRead->simulation.materials[static_cast<std::size_t>(m)]->name;
  }

  void chooser(ViewState& state, float text) {
    if (libraryNames_.empty()) libraryNames_ = libraryMaterials(findLibraries());
    std::vector<std::string> names;
    if (state.hasScene())
      for (const auto& m : state.asRead->simulation.materials)
        if (!m->medium) names.push_back(m->name);
    for (const std::string& n : libraryNames_)
      if (std::find(names.begin(), names.end(), n) == names.end()) names.push_back(n);
    if (const int k = choose(state.marks, "material", edited_ ? edited_->name() : "choose...", names, 15.0f * text); k >= 0)
      open(state, names[static_cast<std::size_t>(k)]);
    ImGui::SameLine();
    if (button(state.marks, "material_picked", "that of the probe", "the material of the pixel that was clicked"))
      if (const std::string of = pickedMaterial(state); !of.empty()) open(state, of);
    if (!edited_) return;
    ImGui::SameLine();
    ImGui::BeginDisabled(!edited_->canUndo());
    if (button(state.marks, "undo", "undo", "ctrl + Z")) edited_->undo();
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!edited_->canRedo());
    if (button(state.marks, "redo", "redo", "ctrl + Y")) edited_->redo();
    ImGui::EndDisabled();
    for (const std::string& note : edited_->notes()) ImGui::TextDisabled("note: %s", note.c_str());
    for (const CurveKind kind : kAllCurves) {
      if (!edited_->surface().inForce(kind) || !edited_->has(kind)) continue;
      bool on = kind_ == kind;
      if (toggle(state.marks, std::string("curve:") + axisOf(kind).name, axisOf(kind).name, on, axisOf(kind).meaning)) kind_ = kind, point_.reset();
      ImGui::SameLine();
    }
    std::vector<std::string> spans;
    for (const Span& s : kSpans) spans.emplace_back(s.name);
    if (const int s = choose(state.marks, "span", kSpans[span_].name, spans, 8.0f * text); s >= 0) span_ = static_cast<std::size_t>(s);
  }

  void curves(ViewState& state, float text) {
    if (!edited_->has(kind_)) kind_ = CurveKind::Diffuse;
    const CurveAxis& axis = axisOf(kind_);
    const Span& span = kSpans[span_];
    const std::shared_ptr<const EditedCurve> held = edited_->surface().curve(kind_);  // as it is drawn, whatever becomes of it below
    const EditedCurve& curve = *held;
    double top = axis.bounds.highest;
    if (top > 1.5) {
      // While a point is dragged the axis stays.
      double most = 1.0;
      for (const CurvePoint& p : curve.points()) most = std::max(most, p.value);
      if (!drags_) top_ = axis.logarithmic ? std::min(std::pow(10.0, std::ceil(std::log10(most * 1.3))), axis.bounds.highest) : 1.3 * most;
      top = top_;
    }
    const PlotAxis y{std::string(axis.meaning), axis.logarithmic ? 1.0 : axis.bounds.lowest, top * (top <= 1.0 ? 1.04 : 1.0), axis.logarithmic};
    Plot plot("curves", ImVec2(ImGui::GetContentRegionAvail().x, 17.0f * text),
              {"wavelength [um]", span.low_um, span.high_um, span.high_um / span.low_um > 8.0}, y);
    state.marks.put("plot", plot.low(), plot.high());
    state.marks.surfaces["plot"] = [low = plot.low(), high = plot.high(), x = PlotAxis{"", span.low_um, span.high_um, span.high_um / span.low_um > 8.0}, y](
                                       double a, double b) {
      const auto part = [](const PlotAxis& of, double v) {
        return of.isLog ? std::log(v / of.low) / std::log(of.high / of.low) : (v - of.low) / (of.high - of.low);
      };
      return ImVec2(low.x + static_cast<float>(part(x, a)) * (high.x - low.x), high.y - static_cast<float>(part(y, b)) * (high.y - low.y));
    };
    std::vector<std::pair<std::string, ImU32>> names;
    constexpr int kSteps = 240;
    std::vector<double> x;
    for (int k = 0; k <= kSteps; ++k) x.push_back(span.low_um * std::pow(span.high_um / span.low_um, static_cast<double>(k) / kSteps));
    if (top <= 1.0) {
      plot.level(1.0, colours::kBad);
      for (const CurveKind other : {CurveKind::Diffuse, CurveKind::Specular, CurveKind::Emissivity})
        if (other != kind_ && edited_->has(other) && edited_->surface().inForce(other)) names.push_back(line(plot, x, other, 1.0f));
      if (sumOf_ != std::pair(edited_->revision(), span_)) {
        sum_.clear();
        for (double w : x) sum_.push_back(edited_->energyAt(w));
        sumOf_ = {edited_->revision(), span_};
      }
      plot.line(x, sum_, IM_COL32(255, 255, 255, 110), 1.0f);
      names.emplace_back("returned in all", IM_COL32(255, 255, 255, 110));
    }
    names.push_back(line(plot, x, kind_, 2.4f));
    for (std::size_t k = 0; k < curve.points().size(); ++k) {
      const CurvePoint& p = curve.points()[k];
      if (p.wavelength_um < span.low_um || p.wavelength_um > span.high_um) continue;
      plot.mark(p.wavelength_um, p.value, colourOf(kind_), point_ && *point_ == k);
      const ImVec2 at = plot.at(p.wavelength_um, p.value);
      state.marks.put("point:" + std::to_string(k), ImVec2(at.x - 2.0f, at.y - 2.0f), ImVec2(at.x + 2.0f, at.y + 2.0f));
    }
    plot.legend(names);
    use(plot, curve, text);
  }

  std::pair<std::string, ImU32> line(Plot& plot, const std::vector<double>& x, CurveKind kind, float thickness) const {
    std::vector<double> y;
    for (double w : x) y.push_back(edited_->curve(kind).at(w));
    plot.line(x, y, colourOf(kind), thickness);
    return {axisOf(kind).name, colourOf(kind)};
  }

  /// A point is dragged, added where there is none, removed by the right button or the delete key.
  void use(Plot& plot, const EditedCurve& curve, float text) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!drags_ && plot.isHovered() && (ImGui::IsMouseClicked(0) || ImGui::IsMouseClicked(1))) {
      std::optional<std::size_t> nearest;
      float least = kReach * text;
      for (std::size_t k = 0; k < curve.points().size(); ++k) {
        const ImVec2 at = plot.at(curve.points()[k].wavelength_um, curve.points()[k].value);
        const float away = std::hypot(at.x - io.MousePos.x, at.y - io.MousePos.y);
        if (away < least) least = away, nearest = k;
      }
      if (ImGui::IsMouseClicked(1)) {
        if (nearest) edited_->removePoint(kind_, *nearest), point_.reset();
        return;
      }
      edited_->beginChange();
      drags_ = true;
      const glm::dvec2 v = plot.valueAt(io.MousePos);
      point_ = nearest ? *nearest : edited_->addPoint(kind_, v.x, v.y);
    } else if (drags_ && io.MouseDown[0] && point_ && (io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f)) {
      const glm::dvec2 v = plot.valueAt(io.MousePos);
      edited_->movePoint(kind_, *point_, v.x, v.y);
    }
    if (drags_ && !io.MouseDown[0]) {
      edited_->endChange();
      drags_ = false;
    }
    if (point_ && *point_ < curve.points().size() && !io.WantTextInput && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete))) {
      edited_->removePoint(kind_, *point_);
      point_.reset();
    }
  }

  void numbers(ViewState& state, float text) {
    bool smooth = edited_->curve(kind_).smooth();
    if (check(state.marks, "smooth", "smooth", smooth)) edited_->setSmooth(kind_, smooth);
    const std::shared_ptr<const EditedCurve> held = edited_->surface().curve(kind_);
    const EditedCurve& curve = *held;
    if (point_ && *point_ < curve.points().size()) {
      const CurvePoint p = curve.points()[*point_];
      double um = p.wavelength_um, value = p.value;
      ImGui::SameLine();
      ImGui::SetNextItemWidth(6.0f * text);
      bool changed = ImGui::InputDouble("um##point_um", &um, 0.0, 0.0, "%.5g", ImGuiInputTextFlags_EnterReturnsTrue);
      state.marks.item("point_um");
      ImGui::SameLine();
      ImGui::SetNextItemWidth(6.0f * text);
      changed |= ImGui::InputDouble("##point_value", &value, 0.0, 0.0, "%.5g", ImGuiInputTextFlags_EnterReturnsTrue);
      state.marks.item("point_value");
      state.marks.text("point_um", print("%.9g", p.wavelength_um));
      state.marks.text("point_value", print("%.9g", p.value));
      if (changed) edited_->movePoint(kind_, *point_, um, value);
      ImGui::SameLine();
      if (button(state.marks, "remove_point", "remove")) edited_->removePoint(kind_, *point_), point_.reset();
    }
    state.marks.text("points", std::to_string(curve.points().size()));
    bool given = edited_->has(CurveKind::Emissivity);
    if (!edited_->film()) {
      if (check(state.marks, "emissivity_given", "emissivity of its own (else Kirchhoff's: 1 less what it returns)", given)) edited_->giveEmissivity(given);
    }
  }

  void film(ViewState& state, float text) {
    bool on = edited_->film().has_value();
    if (check(state.marks, "film", "a film on a smooth or rough substrate", on)) edited_->setFilm(on ? std::optional<EditedFilm>(EditedFilm{}) : std::nullopt);
    if (!edited_->film()) return;
    EditedFilm f = *edited_->film();
    float nm = static_cast<float>(1e3 * f.thickness_um), rough = static_cast<float>(f.roughness);
    ImGui::SetNextItemWidth(11.0f * text);
    bool changed = ImGui::SliderFloat("thickness", &nm, 1.0f, 3000.0f, "%.1f nm", ImGuiSliderFlags_Logarithmic);
    state.marks.item("thickness");
    grouped();
    ImGui::SetNextItemWidth(11.0f * text);
    changed |= ImGui::SliderFloat("roughness", &rough, 0.002f, 1.0f, "%.3f", ImGuiSliderFlags_Logarithmic);
    state.marks.item("roughness");
    grouped();
    if (substances_.empty()) substances_ = librarySubstances(findLibraries());
    if (const int k = choose(state.marks, "substrate", f.substrate, substances_, 11.0f * text); k >= 0)
      f.substrate = substances_[static_cast<std::size_t>(k)], changed = true;
    ImGui::SameLine();
    ImGui::TextUnformatted("substrate");
    f.thickness_um = 1e-3 * static_cast<double>(nm), f.roughness = static_cast<double>(rough);
    if (changed) edited_->setFilm(f);
  }

  /// A slider's drag is one step of undo.
  void grouped() {
    if (ImGui::IsItemActivated()) edited_->beginChange();
    if (ImGui::IsItemDeactivated()) edited_->endChange();
  }

  void saving(ViewState& state, float text) {
    if (file_.empty()) file_ = edited_->name() + "_edited.yaml";
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, "%s", file_.c_str());
    ImGui::SetNextItemWidth(18.0f * text);
    if (ImGui::InputText("##material_file", buffer, sizeof buffer)) file_ = buffer;
    state.marks.item("material_file");
    ImGui::SameLine();
    if (!button(state.marks, "save_material", "save as a material file", "loads anywhere: {file: NAME.yaml}, or pitviper material NAME.yaml")) return;
    try {
      writeFileAtomically(file_, edited_->yaml());
      state.say("written: " + file_);
    } catch (const std::exception& e) {
      problem_ = e.what();
    }
  }

  std::string asked_;
  std::optional<EditedMaterial> edited_;
  bool opened_ = false;
  unsigned long long first_ = 0, placed_ = 0;  ///< revisions: as opened; in the scene
  int inScene_ = -1;                           ///< among the scenario's materials
  ViewedScenePointer read_, lastScene_;
  CurveKind kind_ = CurveKind::Diffuse;
  std::optional<std::size_t> point_;
  bool drags_ = false;
  double top_ = 1.0;
  std::vector<double> sum_;  ///< what is returned in all, over the span
  std::pair<unsigned long long, std::size_t> sumOf_{~0ull, 0};
  std::size_t span_ = 0;
  std::vector<std::string> libraryNames_, substances_;
  std::string problem_, file_;
  SphereTiles sphere_;
};

}  // namespace

std::unique_ptr<Panel> makeMaterialPanel(const std::string& asked) { return std::make_unique<MaterialPanel>(asked); }

}  // namespace pitviper
