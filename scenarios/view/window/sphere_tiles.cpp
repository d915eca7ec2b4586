#include "scenarios/view/window/sphere_tiles.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "scenarios/view/eye_channels.hpp"
#include "scenarios/view/surface_import.hpp"
#include "scenarios/view/window/glfw_window.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/image/srgb.hpp"
#include "sim/parameters/print.hpp"
#include "sim/radiometry/constants.hpp"

namespace pitviper {
namespace {

constexpr int kSide = 512;
/// Bands that stand for infrared where no scenario has channels.
constexpr std::pair<const char*, std::pair<double, double>> kBands[] = {{"1-2.5 um", {1.0, 2.5}}, {"3-5 um", {3.0, 5.0}}, {"8-12 um", {8.0, 12.0}}};

struct SphereWish {
  std::shared_ptr<const Material> material, beside;  ///< the second: null, none
  std::vector<Illuminant> lights;                    ///< one or two
  std::vector<SphereChannel> bands;
  double temperature_K = 300.0;
  int scene = 0;  ///< another number, other lights and bands
  std::chrono::steady_clock::time_point asked;
};

struct SpherePixels {
  std::string title;
  std::vector<Rgb8> colours;  ///< of the eye
  std::vector<float> values;  ///< of a band
  std::string unit;
};

struct SphereResult {
  std::vector<SpherePixels> pictures;
  std::string verdict;                   ///< of two materials
  double took_ms = 0.0, after_ms = 0.0;  ///< drawing the eye's first picture; from the wish on
};

/// A sphere of one material on the left half and of another on the right.
template <class T>
void joinHalves(std::vector<T>& left, const std::vector<T>& right) {
  for (int y = 0; y < kSide; ++y)
    for (int x = kSide / 2; x < kSide; ++x) {
      const auto at = static_cast<std::size_t>(y * kSide + x);
      left[at] = x == kSide / 2 ? T{} : right[at];
    }
}

/// Pictures that do not change with a material are kept from one wish to the next.
class SphereDesk {
 public:
  /// `publish` gets what the eye sees, with bands as they were before, while these are drawn.
  std::shared_ptr<const SphereResult> draw(const SphereWish& wish, const std::function<bool()>& isStale,
                                           const std::function<void(std::shared_ptr<const SphereResult>)>& publish) {
    if (eye_.empty()) eye_ = eyeChannels(findLibraries());
    prepare(wish);
    const auto from = std::chrono::steady_clock::now();
    const auto since = [](std::chrono::steady_clock::time_point then) {
      return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - then).count();
    };
    // What has not been drawn anew yet is shown as it was: a curve that is dragged waits for nothing but the first picture.
    shown_.resize(wish.lights.size() + wish.bands.size());
    SphereResult result;
    const auto asIs = [&] {
      auto now = std::make_shared<SphereResult>(result);
      for (const SpherePixels& p : shown_)
        if (!p.colours.empty() || !p.values.empty()) now->pictures.push_back(p);
      return now;
    };
    for (std::size_t l = 0; l < wish.lights.size(); ++l) {
      SpherePixels& p = shown_[l];
      p.title = "eye, " + wish.lights[l].name;
      p.colours = coloursOf(l, *wish.material);
      if (wish.beside) joinHalves(p.colours, coloursOf(l, *wish.beside));
      if (l == 0) result.took_ms = since(from), result.after_ms = since(wish.asked);
      if (isStale()) return asIs();
    }
    if (wish.beside) result.verdict = verdictOf(wish);
    publish(asIs());
    for (std::size_t b = 0; b < bands_.size(); ++b) {
      if (isStale()) break;
      SpherePixels p{wish.bands[b].name + ", " + wish.lights[0].name, {}, {}, wish.bands[b].unit};
      try {
        p.values = bands_[b]->draw(*wish.material)[0];
        if (wish.beside) joinHalves(p.values, bands_[b]->draw(*wish.beside)[0]);
      } catch (const UserError&) {  // no data in this band: no picture of it
        p.values.clear();
      }
      shown_[wish.lights.size() + b] = std::move(p);
    }
    return asIs();
  }

 private:
  void prepare(const SphereWish& wish) {
    std::string key = print("%d %.6g", wish.scene, wish.temperature_K);
    for (const Illuminant& l : wish.lights) key += "|" + l.name;
    for (const SphereChannel& c : wish.bands) key += "/" + c.name;
    if (key == key_) return;
    key_ = key;
    eyes_.clear(), whites_.clear(), bands_.clear(), shown_.clear();
    SphereView view;
    view.temperature_K = wish.temperature_K;
    const glm::dvec3 direction(0.4, 0.5, 1.0);
    for (const Illuminant& l : wish.lights) whites_.push_back(whiteUnder(l.irradiance));
    for (const Illuminant& l : wish.lights) eyes_.push_back(std::make_unique<SpherePicture>(eye_, SphereLight{l.irradiance, direction, {}}, view));
    for (const SphereChannel& c : wish.bands)
      bands_.push_back(std::make_unique<SpherePicture>(std::vector{c}, SphereLight{lightIn(c, wish.lights[0].irradiance), direction, {}}, view));
  }

  /// A light that is not told in a band has none there.
  static Spectrum lightIn(const SphereChannel& channel, const Spectrum& light) {
    return light.validLow() <= channel.kernel.supportLow() && light.validHigh() >= channel.kernel.supportHigh() ? light : Spectrum(0.0);
  }

  std::vector<Rgb8> coloursOf(std::size_t light, const Material& material) const {
    const auto xyz = eyes_[light]->draw(material);
    return srgbPixels(xyz[0], xyz[1], xyz[2], whites_[light]);
  }

  /// The screen's white: what an ideal diffuse reflector shows that faces the light. Glints are brighter, and cut.
  double whiteUnder(const Spectrum& light) const {
    std::vector<float> xyz[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Spectrum seen = eye_[k].kernel * light;
      xyz[k] = {static_cast<float>(seen.integral(eye_[k].kernel.supportLow(), eye_[k].kernel.supportHigh()) / kPi)};
    }
    const double white = static_cast<double>(strongestPrimary(xyz[0], xyz[1], xyz[2])[0]);
    return white > 0.0 ? white : 1.0;
  }

  std::string verdictOf(const SphereWish& wish) const {
    std::string text;
    for (const Illuminant& l : wish.lights) {
      const double dE = colourDifference(xyzOf(*wish.material, l.irradiance, eye_), xyzOf(*wish.beside, l.irradiance, eye_), whiteOf(l.irradiance, eye_));
      text += (text.empty() ? "" : ";  ") + print("under %s: dE %.2f%s", l.name.c_str(), dE, dE < 1.0 ? " (alike)" : "");
    }
    return text;
  }

  std::vector<SphereChannel> eye_;
  std::vector<SpherePixels> shown_;  ///< of each light, then of each band
  std::vector<double> whites_;       ///< of each light [cd/m2]
  std::string key_;
  std::vector<std::unique_ptr<SpherePicture>> eyes_, bands_;
};

using SphereWork = NewestWork<SphereWish, SphereResult>;

}  // namespace

struct SphereTiles::Own {
  std::vector<Illuminant> lights;
  ViewedScenePointer lightsOf;
  int scene = 0;
  std::size_t first = 0, second = 1;
  std::string besideName;
  std::shared_ptr<const Material> beside;
  std::string problem;
  float temperature_K = 300.0f;
  unsigned long long asked = 0;
  std::string askedKey;
  bool everAsked = false;
  std::shared_ptr<const SphereResult> shown;
  std::vector<std::unique_ptr<PictureTile>> tiles;
  TileZoom zoom;
  std::vector<std::string> libraryNames = libraryMaterials(findLibraries());
  SphereWork work{[this] {
                    auto desk = std::make_shared<SphereDesk>();
                    return [this, desk](const SphereWish& wish, const SphereWork::Stale& isStale) {
                      return desk->draw(wish, isStale, [this](std::shared_ptr<const SphereResult> some) {
                        work.publish(std::move(some));
                        GlfwWindow::wake();
                      });
                    };
                  },
                  [] { GlfwWindow::wake(); }};
};

SphereTiles::SphereTiles() : own_(std::make_unique<Own>()) {}
SphereTiles::~SphereTiles() = default;

bool SphereTiles::isDone() const { return own_->everAsked && !own_->work.isBusy() && own_->shown == own_->work.newest(); }

void SphereTiles::draw(ViewState& state, const EditedMaterial& edited, float text) {
  Own& o = *own_;
  if (o.lights.empty() || o.lightsOf != state.asRead) {
    o.lights = illuminantsOf(findLibraries(), state.hasScene() ? &state.asRead->simulation : nullptr);
    o.lightsOf = state.asRead;
    ++o.scene;
    const auto at = std::find_if(o.lights.begin(), o.lights.end(), [](const Illuminant& l) { return l.name == "D65"; });
    o.first = at == o.lights.end() ? 0 : static_cast<std::size_t>(at - o.lights.begin());
    o.second = std::min(o.first + 1, o.lights.size() - 1);
  }
  ImGui::Separator();
  std::vector<std::string> names;
  for (const Illuminant& l : o.lights) names.push_back(l.name);
  if (const int k = choose(state.marks, "light", names[o.first], names, 9.5f * text); k >= 0) o.first = static_cast<std::size_t>(k);
  ImGui::SameLine();
  if (const int k = choose(state.marks, "light2", names[o.second], names, 9.5f * text); k >= 0) o.second = static_cast<std::size_t>(k);
  ImGui::SameLine();
  ImGui::SetNextItemWidth(6.0f * text);
  ImGui::DragFloat("##sphere_temperature", &o.temperature_K, 1.0f, 50.0f, 4000.0f, "%.0f K");
  state.marks.item("sphere_temperature");
  std::vector<std::string> materials{"nothing beside"};
  if (state.hasScene())
    for (const auto& m : state.asRead->simulation.materials)
      if (!m->medium) materials.push_back(m->name);
  materials.insert(materials.end(), o.libraryNames.begin(), o.libraryNames.end());
  if (const int k = choose(state.marks, "beside", o.besideName.empty() ? materials[0] : o.besideName, materials, 15.0f * text); k >= 0) {
    o.besideName = k == 0 ? "" : materials[static_cast<std::size_t>(k)];
    o.beside.reset();
    o.problem.clear();
    if (state.hasScene())
      for (const auto& m : state.asRead->simulation.materials)
        if (m->name == o.besideName) o.beside = m;
    try {
      if (!o.beside && !o.besideName.empty()) o.beside = EditedMaterial::named(o.besideName, findLibraries()).material();
    } catch (const UserError& e) {
      o.problem = e.what();
    }
  }
  const std::string key = names[o.first] + "/" + names[o.second] + "/" + o.besideName + print("/%d/%.2f", o.scene, static_cast<double>(o.temperature_K));
  if (!o.everAsked || o.asked != edited.revision() || o.askedKey != key) {
    try {
      SphereWish wish;
      wish.asked = std::chrono::steady_clock::now();
      wish.material = edited.material();
      wish.beside = o.beside;
      wish.lights = {o.lights[o.first], o.lights[o.second]};
      wish.scene = o.scene;
      wish.temperature_K = static_cast<double>(o.temperature_K);
      if (state.hasScene()) {
        for (const SphereChannel& c : sphereChannels(state.cameraShown().outputs))
          if (c.unit == "W/(m2 sr)" && wish.bands.size() < 3) wish.bands.push_back(c);
      } else {
        for (const auto& [name, ends] : kBands) wish.bands.push_back({name, "W/(m2 sr)", Spectrum::band(ends.first, ends.second)});
      }
      o.work.want(std::move(wish));
      o.asked = edited.revision(), o.askedKey = key, o.everAsked = true;
    } catch (const UserError& e) {
      o.problem = e.what();
    }
  }
  if (const std::string wrong = !o.problem.empty() ? o.problem : o.work.error(); !wrong.empty()) ImGui::TextWrapped("%s", wrong.c_str());
  load(state);
  if (!o.shown) return;
  if (!o.shown->verdict.empty()) ImGui::TextWrapped("left and right %s", o.shown->verdict.c_str());
  state.marks.text("verdict", o.shown->verdict);
  state.marks.text("sphere_ms", print("%.1f", o.shown->took_ms));
  state.marks.text("curve_to_picture_ms", print("%.1f", o.shown->after_ms));
  ImGui::TextDisabled("%.0f ms from the curve to the first picture of %d x %d", o.shown->after_ms, kSide, kSide);
}

void SphereTiles::load(const ViewState& state) {
  Own& o = *own_;
  const auto newest = o.work.newest();
  if (!newest || newest == o.shown) return;
  o.shown = newest;
  o.tiles.resize(newest->pictures.size());
  for (std::size_t k = 0; k < o.tiles.size(); ++k) {
    if (!o.tiles[k]) o.tiles[k] = std::make_unique<PictureTile>();
    const SpherePixels& p = newest->pictures[k];
    if (!p.colours.empty()) {
      o.tiles[k]->load(p.title, p.colours, kSide, kSide);
      continue;
    }
    Frame frame;
    frame.width = frame.height = kSide;
    FrameLook look;
    look.map = state.look.map == "auto" ? "thermal" : state.look.map;
    const auto most = *std::max_element(p.values.begin(), p.values.end());
    look.layers[p.title].ends = {0.0, most > 0.0f ? static_cast<double>(most) : 1.0};
    o.tiles[k]->load(layerPicture(frame, {p.title, p.unit, p.values}, look, nullptr), kSide, kSide);
  }
}

void SphereTiles::show(ImVec2 size, float text) {
  Own& o = *own_;
  if (o.tiles.empty()) return;
  const int columns = size.x > 1.5f * size.y ? 3 : 2, rows = (static_cast<int>(o.tiles.size()) + columns - 1) / columns;
  const ImVec2 from = ImGui::GetCursorScreenPos(), cell(size.x / static_cast<float>(columns), size.y / static_cast<float>(rows));
  for (std::size_t k = 0; k < o.tiles.size(); ++k) {
    const int column = static_cast<int>(k) % columns, row = static_cast<int>(k) / columns;
    ImGui::SetCursorScreenPos(ImVec2(from.x + static_cast<float>(column) * cell.x, from.y + static_cast<float>(row) * cell.y));
    o.tiles[k]->draw("sphere" + std::to_string(k), ImVec2(cell.x - text, cell.y - 0.6f * text), o.zoom);
  }
  ImGui::SetCursorScreenPos(ImVec2(from.x, from.y + size.y));
  ImGui::Dummy(ImVec2(1.0f, 1.0f));
}

}  // namespace pitviper
