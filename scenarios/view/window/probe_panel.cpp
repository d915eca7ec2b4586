// What a pixel is: its body, its values, what these are made of, its spectrum, values over time; a region; a line.
#include <algorithm>
#include <cmath>

#include "scenarios/commands/commands.hpp"
#include "scenarios/view/frame_files.hpp"
#include "scenarios/view/newest_work.hpp"
#include "scenarios/view/pixel_probe.hpp"
#include "scenarios/view/window/glfw_window.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/plot.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/frame/region.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// Around a region, what it is held against.
constexpr int kRing_px = 4;
constexpr std::size_t kMostThen = 4096;
/// A part below this share of its pixel is not listed.
constexpr double kListed = 1e-5;

bool isTruth(const FrameLayer& l) { return l.name.rfind("truth.", 0) == 0; }

class ProbePanel final : public Panel {
 public:
  ProbePanel()
      : work_(
            [this] {
              auto desk = std::make_shared<PixelProbeDesk>(shaderLibrary());
              return [this, desk](const PixelProbeWish& wish, const Work::Stale& isStale) {
                return desk->look(wish, isStale, [this](std::shared_ptr<const PixelProbe> some) {
                  work_.publish(std::move(some));
                  GlfwWindow::wake();
                });
              };
            },
            [] { GlfwWindow::wake(); }) {}
  std::string title() const override { return "Probe"; }
  std::string name() const override { return "probe_panel"; }

  std::optional<bool> isReached(const std::string& what, const ViewState&) const override {
    if (what != "probe") return std::nullopt;
    return asked_ && !work_.isBusy();
  }

  /// Values over time are noted, and the reference is asked, whatever panel is open.
  void look(ViewState& state) override {
    if (!state.picture || !state.pixel) return;
    const Frame& f = state.picture->frame;
    if (state.pixel->x >= f.width || state.pixel->y >= f.height) return;
    note(state);
    const bool isNew = state.picture->number != askedPicture_ || *state.pixel != askedPixel_ || band_ != askedBand_;
    if (!isNew || state.isPlaying || state.picture->tier != Tier::Asked || !state.picture->image) return;
    askedPicture_ = state.picture->number, askedPixel_ = *state.pixel, askedBand_ = band_, asked_ = true;
    const auto [low, high] = bandOf(state);
    work_.want({state.picture, state.pixel->x, state.pixel->y, low, high});
  }

  void draw(ViewState& state) override {
    if (!state.picture) return;
    const float text = ImGui::GetTextLineHeight();
    if (state.pixel) pixel(state, text);
    else ImGui::TextWrapped("Click a pixel; drag a box with 'region', a line with 'profile'.");
    if (state.region) region(state, text);
    if (state.profile) profile(state, text);
  }

 private:
  using Work = NewestWork<PixelProbeWish, PixelProbe>;

  std::pair<double, double> bandOf(const ViewState& state) const {
    if (!state.hasScene()) return {0.0, 0.0};
    for (const ChannelOutput& o : state.cameraShown().outputs)
      if (band_.empty() || o.channel == band_) return {o.bandLow_um, o.bandHigh_um};
    return {0.0, 0.0};
  }

  void note(ViewState& state) {
    const Frame& f = state.picture->frame;
    if (state.historyPixel != state.pixel || state.historyLayers != state.shown)
      state.history.clear(), state.historyPixel = state.pixel, state.historyLayers = state.shown;
    if (noted_ == state.picture->number && !state.history.empty()) return;
    noted_ = state.picture->number;
    PixelThen then{f.time_s, {}};
    const auto at = static_cast<std::size_t>(state.pixel->y * f.width + state.pixel->x);
    for (const std::string& name : state.shown) {
      const FrameLayer* l = layerNamed(f, name);
      then.values.push_back(l ? static_cast<double>(l->pixels[at]) : NAN);
    }
    const auto same = std::find_if(state.history.begin(), state.history.end(), [&](const PixelThen& p) { return p.time_s == then.time_s; });
    if (same != state.history.end()) *same = std::move(then);
    else
      state.history.insert(
          std::lower_bound(state.history.begin(), state.history.end(), then, [](const PixelThen& a, const PixelThen& b) { return a.time_s < b.time_s; }),
          std::move(then));
    if (state.history.size() > kMostThen) state.history.pop_front();
  }

  void pixel(ViewState& state, float text) {
    const Frame& f = state.picture->frame;
    const glm::ivec2 p = *state.pixel;
    if (p.x >= f.width || p.y >= f.height) return;
    const auto at = static_cast<std::size_t>(p.y * f.width + p.x);
    const auto valueOf = [&](const char* layer) {
      const FrameLayer* l = layerNamed(f, layer);
      return l ? static_cast<double>(l->pixels[at]) : 0.0;
    };
    row("pixel", print("%d, %d", p.x, p.y));
    const int entity = static_cast<int>(valueOf("truth.entity")) - 1, part = std::max(static_cast<int>(valueOf("truth.part")) - 1, 0);
    if (state.hasScene() && entity >= 0 && entity < static_cast<int>(state.scene->simulation.entities.size())) {
      const Simulation& sim = state.scene->simulation;
      const Entity& e = sim.entities[static_cast<std::size_t>(entity)];
      const bool named = e.surfaces.size() > 1 && e.mesh && static_cast<std::size_t>(part) < e.mesh->parts.size();
      const std::string body = e.name + (named ? ", " + e.mesh->parts[static_cast<std::size_t>(part)].name : "");
      row("body", body);
      state.marks.text("probe.body", body);
      if (const int m = materialAt(sim, entity, part); m >= 0) {
        row("material", sim.materials[static_cast<std::size_t>(m)]->name);
        state.marks.text("probe.material", sim.materials[static_cast<std::size_t>(m)]->name);
      }
    } else {
      row("body", state.hasScene() ? "none: sky or ground" : bodyNamed(f, entity + 1));
    }
    const double range_m = valueOf("truth.range");
    if (range_m > 0.0) row("temperature, range", print("%.1f K, %.1f m", valueOf("truth.temperature"), range_m));
    if (state.picture->image && state.picture->pinhole.width == f.width) {
      row("pixel's solid angle", print("%.5g sr", state.picture->pinhole.solidAngle_sr(p.x, p.y)));
      if (range_m > 0.0) row("aperture's from there", print("%.5g sr", state.picture->pinhole.apertureArea_m2() / (range_m * range_m)));
    }
    ImGui::Separator();
    for (const FrameLayer& l : f.layers) {
      state.marks.text("probe." + l.name, print("%.9g", static_cast<double>(l.pixels[at])));
      if (isTruth(l)) continue;
      std::string value = print("%.6g %s", static_cast<double>(l.pixels[at]), l.unit.c_str());
      if (const BandTemperature* t = state.temperatureOf(l.name)) value += print("  = %.2f K apparent", (*t)(static_cast<double>(l.pixels[at])));
      row(l.name.c_str(), value);
    }
    parts(state, text);
    overTime(state, text);
  }

  void parts(ViewState& state, float text) {
    if (work_.isBusy()) ImGui::TextDisabled("what it is made of is being worked out...");
    if (const std::string wrong = work_.error(); !wrong.empty()) ImGui::TextWrapped("%s", wrong.c_str());
    const auto probe = work_.newest();
    if (!probe || probe->column != state.pixel->x || probe->row != state.pixel->y || !state.hasScene()) return;
    std::vector<std::size_t> columns;
    std::vector<std::string> channels;
    for (std::size_t k = 0; k < probe->parts.columns.size(); ++k) {
      const std::string& layer = probe->parts.columns[k].layer;
      const std::string channel = layer.substr(0, layer.find('.'));
      if (std::find(channels.begin(), channels.end(), channel) == channels.end() && channels.size() < 6) channels.push_back(channel), columns.push_back(k);
    }
    if (ImGui::BeginTable("parts", static_cast<int>(columns.size()) + 1, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) {
      ImGui::TableSetupColumn("by the reference");
      for (std::size_t k : columns) ImGui::TableSetupColumn((probe->parts.columns[k].layer + " [" + probe->parts.columns[k].unit + "]").c_str());
      ImGui::TableHeadersRow();
      const auto line = [&](const std::string& name, const std::vector<double>& values) {
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name.c_str());
        for (std::size_t k : columns) {
          ImGui::TableNextColumn();
          const double all = probe->parts.all[k];
          if (std::abs(values[k]) > kListed * std::abs(all)) ImGui::Text("%.4g  %.3g %%", values[k], 100.0 * values[k] / all);
          else ImGui::TextDisabled("-");
        }
      };
      for (const auto& r : probe->parts.rows) {
        const bool isListed =
            std::any_of(columns.begin(), columns.end(), [&](std::size_t k) { return std::abs(r.values[k]) > kListed * std::abs(probe->parts.all[k]); });
        if (isListed) line(r.name, r.values);
      }
      line("all of it", probe->parts.all);
      ImGui::EndTable();
    }
    for (std::size_t k : columns) state.marks.text("reference." + probe->parts.columns[k].layer, print("%.9g", probe->parts.all[k]));
    spectrum(state, *probe, channels, text);
  }

  void spectrum(ViewState& state, const PixelProbe& probe, const std::vector<std::string>& channels, float text) {
    for (const std::string& channel : channels) {
      bool on = channel == (band_.empty() ? channels.front() : band_);
      if (toggle(state.marks, "spectrum:" + channel, channel, on)) band_ = channel;
      ImGui::SameLine();
    }
    ImGui::TextDisabled("spectrum over the band of");
    if (!probe.spectrum) return;
    const PixelSpectrum& s = *probe.spectrum;
    std::vector<const std::vector<double>*> all{&s.all};
    for (const auto& c : s.parts) all.push_back(&c.values);
    Plot plot("spectrum", ImVec2(ImGui::GetContentRegionAvail().x, 15.0f * text), {"wavelength [um]", s.edge_um.front(), s.edge_um.back(), false},
              axisAround("W/(m2 sr um)", all, true));
    state.marks.put("spectrum", plot.low(), plot.high());
    std::vector<std::pair<std::string, ImU32>> names{{"all of it", colours::kText}};
    for (std::size_t k = 0; k < s.parts.size(); ++k) {
      plot.line(s.wavelength_um, s.parts[k].values, curveColour(k));
      if (names.size() < 7) names.emplace_back(s.parts[k].name, curveColour(k));
    }
    plot.line(s.wavelength_um, s.all, colours::kText, 2.2f);
    plot.legend(names);
    if (const auto m = plot.mouse()) ImGui::SetTooltip("%.4g um: %.4g W/(m2 sr um)", m->x, m->y);
  }

  void overTime(ViewState& state, float text) {
    if (state.history.size() < 3) return;
    for (std::size_t k = 0; k < std::min<std::size_t>(state.historyLayers.size(), 3); ++k) {
      std::vector<double> t, v;
      for (const PixelThen& p : state.history) t.push_back(p.time_s), v.push_back(p.values[k]);
      const FrameLayer* l = layerNamed(state.picture->frame, state.historyLayers[k]);
      Plot plot("time" + std::to_string(k), ImVec2(ImGui::GetContentRegionAvail().x, 9.0f * text), {"time [s]", t.front(), t.back(), false},
                axisAround(state.historyLayers[k] + " [" + (l ? l->unit : "") + "]", {&v}, false));
      plot.line(t, v, curveColour(k), 2.0f);
      plot.upright(state.picture->frame.time_s, colours::kDim);
    }
    state.marks.text("history", std::to_string(state.history.size()));
  }

  void region(ViewState& state, float text) {
    const Frame& f = state.picture->frame;
    const PixelBox& b = *state.region;
    ImGui::Separator();
    row("region", print("%d, %d to %d, %d", b.left, b.top, b.right - 1, b.bottom - 1));
    for (const std::string& name : state.shown) {
      const FrameLayer* l = layerNamed(f, name);
      if (!l) continue;
      const RegionContrast c = contrastOf(*l, f.width, f.height, b, kRing_px);
      row(name.c_str(),
          print("mean %.5g, sigma %.3g, %.5g to %.5g %s", c.inside.mean, c.inside.standardDeviation, c.inside.minimum, c.inside.maximum, l->unit.c_str()));
      row("", print("contrast to %d pixels around %.4g, SNR %.3g", kRing_px, c.contrast, c.signalToNoise));
      state.marks.text("region." + name, print("%.9g", c.inside.mean));
      std::vector<double> edges, heights;
      const auto bins = c.inside.histogram.size();
      for (std::size_t k = 0; k < bins; ++k) {
        edges.push_back(c.inside.minimum + (c.inside.maximum - c.inside.minimum) * static_cast<double>(k) / static_cast<double>(bins));
        heights.push_back(static_cast<double>(c.inside.histogram[k]));
      }
      edges.push_back(c.inside.maximum);
      Plot plot("histogram" + name, ImVec2(ImGui::GetContentRegionAvail().x, 8.0f * text), {name + " [" + l->unit + "]", edges.front(), edges.back(), false},
                axisAround("pixels", {&heights}, true));
      plot.bars(edges, heights, curveColour(0));
    }
  }

  void profile(ViewState& state, float text) {
    const Frame& f = state.picture->frame;
    ImGui::Separator();
    const glm::ivec4& p = *state.profile;
    row("profile", print("%d, %d to %d, %d", p.x, p.y, p.z, p.w));
    for (std::size_t k = 0; k < state.shown.size(); ++k) {
      const FrameLayer* l = layerNamed(f, state.shown[k]);
      if (!l) continue;
      std::vector<double> x, y;
      for (const ProfilePoint& q : profileOf(*l, f.width, f.height, p.x, p.y, p.z, p.w)) x.push_back(q.distance_px), y.push_back(q.value);
      Plot plot("profile" + l->name, ImVec2(ImGui::GetContentRegionAvail().x, 9.0f * text), {"pixels along the line", 0.0, x.back(), false},
                axisAround(l->name + " [" + l->unit + "]", {&y}, false));
      plot.line(x, y, curveColour(k), 2.0f);
    }
  }

  bool asked_ = false;
  std::uint64_t askedPicture_ = 0, noted_ = 0;
  glm::ivec2 askedPixel_{-1};
  std::string band_, askedBand_ = "-";  ///< a channel
  Work work_;
};

}  // namespace

std::unique_ptr<Panel> makeProbePanel() { return std::make_unique<ProbePanel>(); }

}  // namespace pitviper
