#include "scenarios/view/window/viewer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <utility>

#include "scenarios/commands/commands.hpp"
#include "scenarios/view/window/style.hpp"
#include "scenarios/view/window/widgets.hpp"
#include "sim/frame/frame_picture.hpp"
#include "sim/frame/read_frame.hpp"
#include "sim/image/colour_map.hpp"
#include "sim/image/png.hpp"
#include "sim/parameters/print.hpp"

namespace pitviper {
namespace {

/// How often saved files are looked for.
constexpr double kFileLook_s = 0.25;
/// From a frame of the window to the next: where somebody does something or pictures change, and where nothing does; drawing it takes from what is drawn in it.
constexpr double kBusy_s = 1.0 / 32.0, kIdle_s = 1.0 / 6.0, kLeast_s = 1.0 / 120.0;
constexpr double kMessage_s = 6.0;

/// The same bodies of as many surfaces, and lamps, by name.
bool sameThings(const Simulation& a, const Simulation& b) {
  const auto named = [](const auto& x, const auto& y) { return x.name == y.name; };
  return std::equal(a.entities.begin(), a.entities.end(), b.entities.begin(), b.entities.end(),
                    [](const Entity& x, const Entity& y) { return x.name == y.name && x.surfaces.size() == y.surfaces.size(); }) &&
         std::equal(a.lights.begin(), a.lights.end(), b.lights.begin(), b.lights.end(), named);
}

}  // namespace

void ViewState::say(const std::string& text) {
  message = text;
  messageUntil_s = ImGui::GetTime() + kMessage_s;
}

const BandTemperature* ViewState::temperatureOf(const std::string& layer) const {
  if (!hasScene()) return nullptr;
  const auto found = scene->temperatures.find(temperatureKey(cameraShown().name, layer));
  return found == scene->temperatures.end() ? nullptr : found->second.get();
}

Viewer::Viewer(GlfwWindow& window, const ViewWish& wish)
    : window_(window),
      maker_(std::make_unique<PictureMaker>(shaderLibrary(), [] { GlfwWindow::wake(); })),
      loader_(
          [] {
            return [](const ScenarioWish& file, const NewestWork<ScenarioWish, Loaded>::Stale&) {
              auto loaded = std::make_shared<Loaded>();
              loaded->file = file.file;
              try {
                loaded->scene = readScene(file);
                if (loaded->scene->simulation.cameras.empty())
                  throw UserError({file.file, 0, 0, -1}, "a scenario without cameras", "one to look through", "add 'cameras:'");
              } catch (const std::exception& e) {
                loaded->scene.reset();
                loaded->problem = e.what();
              }
              return std::shared_ptr<const Loaded>(std::move(loaded));
            };
          },
          [] { GlfwWindow::wake(); }),
      reader_([] { return [](const FrameFileWish& file, const NewestWork<FrameFileWish, ShownPicture>::Stale&) { return readShownFrame(file); }; },
              [] { GlfwWindow::wake(); }) {
  state_.wish = wish;
  state_.accuracy = 0.0;
  panels_.push_back(makeProbePanel());
  panels_.push_back(makeScenePanel());
  panels_.push_back(makeMaterialPanel(wish.material));
  panels_.push_back(makeDialPanel());
  if (!wish.material.empty()) wantedPanel_ = 2;
  if (!wish.scenario.file.empty()) open(wish.scenario.file);
}

Viewer::~Viewer() = default;

void Viewer::open(const std::string& file) {
  if (file != state_.wish.scenario.file) state_.hands = {}, state_.time_s = NAN, keepsCamera_ = false;
  state_.wish.scenario.file = file;
  stamps_.clear();
  window_.setTitle(file + " - pitviper");
  state_.files.clear();
  state_.file = 0;
  askedFile_.clear();
  if (namesFrames(file)) {
    state_.asRead = state_.scene = nullptr;
    state_.picture.reset();
    state_.shown.clear();
    state_.files = framesIn(file);
    return;
  }
  // A picture of a file has no scene that ask() could hold against the one to come.
  if (state_.picture && state_.picture->tier == Tier::File) state_.picture.reset();
  loader_.want(state_.wish.scenario);
}

/// The frame of a file is asked for, and taken when it has been read.
void Viewer::askFile() {
  const std::filesystem::path& file = state_.files[state_.file];
  if (file != askedFile_) {
    askedFile_ = file;
    reader_.want({file, state_.wish.beside, ++filesAsked_});
  }
  state_.status = {};
  state_.status.error = reader_.error();
  state_.isDone = !reader_.isBusy();
  const auto newest = reader_.newest();
  if (!newest || newest == state_.picture) return;
  state_.picture = newest;
  if (!state_.shown.empty() && layerNamed(newest->frame, state_.shown.front())) return;
  state_.shown.clear();
  // With another beside it: what it has more, under what it has.
  const bool isCompared = !state_.wish.beside.empty();
  for (const FrameLayer* l : shownLayers(newest->frame, {}))
    if (l->name.rfind("less ", 0) != 0 && state_.shown.size() < (isCompared ? 2 : 4)) state_.shown.push_back(l->name);
  const std::vector<std::string> own = state_.shown;
  for (const std::string& name : own)
    for (const FrameLayer& l : newest->frame.layers)
      if (l.name.rfind("less ", 0) == 0 && l.name.ends_with(": " + name)) state_.shown.push_back(l.name);
}

void Viewer::takeLoaded() {
  const std::shared_ptr<const Loaded> newest = loader_.newest();
  if (!newest || newest == loaded_) return;
  loaded_ = newest;
  if (!state_.files.empty()) return;  // frames were opened while it was read
  state_.problem = loaded_->problem;
  if (!loaded_->scene) return;
  const std::string before = state_.hasScene() && keepsCamera_ ? state_.cameraShown().name : state_.wish.camera;
  // What was changed by hand is known by numbers: where bodies or lamps are others, it says nothing.
  if (state_.hasScene() && !sameThings(state_.asRead->simulation, loaded_->scene->simulation))
    state_.hands.temperatures_K.clear(), state_.hands.lightLevels.clear();
  state_.asRead = state_.scene = loaded_->scene;
  const auto& cameras = state_.scene->simulation.cameras;
  state_.camera = 0;
  for (std::size_t c = 0; c < cameras.size(); ++c)
    if (cameras[c].name == before) state_.camera = c;
  if (!before.empty() && cameras[state_.camera].name != before) state_.say("there is no camera '" + before + "' here");
  const TimeAxis& time = state_.scene->simulation.time;
  if (!keepsCamera_) state_.time_s = state_.wish.time_s >= 0.0 ? state_.wish.time_s : time.start_s;
  if (!std::isfinite(state_.time_s)) state_.time_s = time.start_s;
  keepsCamera_ = true;
  chooseLayers();
}

/// All channels of the camera, one quantity of each; what was chosen before stays where it can.
void Viewer::chooseLayers() {
  const Camera& camera = state_.cameraShown();
  std::vector<std::string> all, kept;
  for (const ChannelOutput& o : camera.outputs) all.push_back(o.layer());
  for (const std::string& name : state_.shown)
    if (std::find(all.begin(), all.end(), name) != all.end()) kept.push_back(name);
  if (kept.empty()) {
    std::vector<std::string> channels;
    for (const ChannelOutput& o : camera.outputs)
      if (!o.asMark && std::find(channels.begin(), channels.end(), o.channel) == channels.end() && kept.size() < 4)
        channels.push_back(o.channel), kept.push_back(o.layer());
  }
  state_.shown = kept;
  const auto has = [&](const std::string& name) { return std::find(all.begin(), all.end(), name) != all.end(); };
  const bool eye = has("X.tristimulus") && has("Y.tristimulus") && has("Z.tristimulus");
  if (eye) state_.three = {"X.tristimulus", "Y.tristimulus", "Z.tristimulus"}, state_.composite = true;
  else state_.three.assign(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(3, kept.size())));
  while (!state_.three.empty() && state_.three.size() < 3) state_.three.push_back(state_.three.back());
  if (!eye && kept.size() < 2) state_.composite = false;
}

/// A scenario that was saved, or anything written in YAML beside it, is read again.
void Viewer::watchFile(double now_s) {
  if (now_s < nextLook_s_ || state_.wish.scenario.file.empty() || !state_.files.empty()) return;
  nextLook_s_ = now_s + kFileLook_s;
  const std::filesystem::path file = state_.wish.scenario.file;
  std::map<std::filesystem::path, std::filesystem::file_time_type> now;
  std::error_code failed;
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    std::error_code gone;
    if (entry.path().extension() != file.extension()) continue;
    const auto stamp = entry.last_write_time(gone);
    if (!gone) now[entry.path()] = stamp;
  }
  if (!stamps_.empty() && now != stamps_ && !loader_.isBusy()) loader_.want(state_.wish.scenario);
  if (stamps_.empty() || !loader_.isBusy()) stamps_ = std::move(now);
}

/// The drawing thread is asked for what is to be seen now.
void Viewer::ask() {
  if (!state_.files.empty()) return askFile();
  if (!state_.hasScene()) return;
  if (askedFrom_ != state_.scene || askedAccuracy_ != state_.accuracy) {
    askedScene_ = state_.accuracy > 0.0 ? withAccuracy(*state_.scene, state_.accuracy) : state_.scene;
    askedFrom_ = state_.scene;
    askedAccuracy_ = state_.accuracy;
    askedAt_s_ = now_s_;
    toPicture_s_ = toAsked_s_ = -1.0;
  }
  maker_->want({askedScene_, state_.camera, state_.time_s, state_.hands});
  state_.status = maker_->status();
  state_.isDone = maker_->isDone();
  if (const auto newest = maker_->newest(); newest && newest->wish.scene == askedScene_ && newest->wish.camera == state_.camera) state_.picture = newest;
  else if (!state_.picture || state_.picture->wish.camera != state_.camera || state_.picture->wish.scene->geometry != askedScene_->geometry)
    state_.picture.reset();
}

void Viewer::step(int frames) {
  if (!state_.files.empty()) {
    const int count = static_cast<int>(state_.files.size()), next = static_cast<int>(state_.file) + frames;
    state_.file = static_cast<std::size_t>(state_.loops && state_.isPlaying ? ((next % count) + count) % count : std::clamp(next, 0, count - 1));
    return;
  }
  if (!state_.hasScene()) return;
  const TimeAxis& time = state_.scene->simulation.time;
  int frame = static_cast<int>(std::lround((state_.time_s - time.start_s) / time.step_s)) + frames;
  if (state_.loops && state_.isPlaying) frame = ((frame % time.frames) + time.frames) % time.frames;
  state_.time_s = time.at(std::clamp(frame, 0, time.frames - 1));
}

void Viewer::tick(double seconds) {
  if (!state_.files.empty() && state_.isPlaying && state_.isDone) step(1);
  if (!state_.hasScene() || !state_.isPlaying) return;
  const TimeAxis& time = state_.scene->simulation.time;
  if (state_.speed <= 0.0) {
    if (state_.isDone || (state_.picture && state_.picture->wish.time_s == state_.time_s)) step(1);
    return;
  }
  owed_s_ += state_.speed * seconds;
  const int frames = static_cast<int>(owed_s_ / time.step_s);
  owed_s_ -= frames * time.step_s;
  if (frames > 0) step(frames);
  if (!state_.loops && state_.time_s >= time.at(time.frames - 1)) state_.isPlaying = false;
}

bool Viewer::isReached(const std::string& what, const Location& where) const {
  const auto at = [this](Tier least) { return state_.picture && static_cast<int>(state_.picture->tier) >= static_cast<int>(least); };
  if (what == "done")
    return (state_.isDone && state_.picture && !loader_.isBusy()) || (!state_.problem.empty() && !loader_.isBusy()) || !state_.status.error.empty();
  if (what == "done" && !state_.files.empty()) return state_.isDone && askedFile_ == state_.files[state_.file];
  if (what == "problem") return !state_.problem.empty();
  if (what == "good") return state_.problem.empty() && !loader_.isBusy();
  if (what == "picture") return state_.picture != nullptr;
  if (what == "sketch") return at(Tier::Sketch);
  if (what == "draft") return at(Tier::Draft);
  for (const auto& panel : panels_)
    if (const auto reached = panel->isReached(what, state_)) return *reached;
  throw UserError(where, "nothing is waited for by '" + what + "'", "done, picture, sketch, draft, problem, good, probe, sphere, dial, or a time",
                  "see pitviper view --help");
}

void Viewer::writePicture(const std::string& file) const {
  if (!state_.picture) throw std::runtime_error("view: there is no picture to be written");
  Frame shown = state_.picture->frame;
  std::erase_if(shown.layers, [&](const FrameLayer& l) { return std::find(state_.shown.begin(), state_.shown.end(), l.name) == state_.shown.end(); });
  PictureStyle style;
  style.ownScale = true;
  style.palette = state_.look.map;
  for (const auto& [layer, look] : state_.look.layers)
    if (look.ends && !look.asTemperature) style.ranges[layer] = *look.ends;
  writePreviewFile(file, shown, style);
}

void Viewer::keys() {
  const ImGuiIO& io = ImGui::GetIO();
  const auto pressed = [](int key) { return ImGui::IsKeyPressed(key, true); };
  const auto letter = [&](char c) { return ImGui::IsKeyPressed(c, false); };
  const auto named = [](ImGuiKey key) { return ImGui::GetKeyIndex(key); };
  constexpr int kF1 = 290;  // GLFW's codes
  if (pressed(kF1)) showsHelp_ = !showsHelp_;
  if (pressed(kF1 + 4)) loader_.want(state_.wish.scenario);
  if (pressed(kF1 + 11)) {
    window_.keepPixels(true);
    shoots_ = true;
  }
  if (io.WantTextInput) return;
  if (io.KeyCtrl) {
    for (char c : {'Z', 'Y', 'S'})
      if (letter(c))
        for (auto& panel : panels_)
          if (panel->controlKey(c, io.KeyShift, state_)) break;
    return;
  }
  const int many = io.KeyShift ? 10 : 1;
  if (io.KeyAlt) {
    if (state_.pixel && state_.picture) {
      glm::ivec2 p = *state_.pixel;
      if (pressed(named(ImGuiKey_LeftArrow))) p.x -= many;
      if (pressed(named(ImGuiKey_RightArrow))) p.x += many;
      if (pressed(named(ImGuiKey_UpArrow))) p.y -= many;
      if (pressed(named(ImGuiKey_DownArrow))) p.y += many;
      state_.pixel = glm::ivec2(std::clamp(p.x, 0, state_.picture->frame.width - 1), std::clamp(p.y, 0, state_.picture->frame.height - 1));
    }
    return;
  }
  if (letter(' ') && !ImGui::IsAnyItemActive()) state_.isPlaying = !state_.isPlaying;
  if (!ImGui::IsAnyItemActive()) {
    if (pressed(named(ImGuiKey_LeftArrow))) step(-many);
    if (pressed(named(ImGuiKey_RightArrow))) step(many);
  }
  if (state_.hasScene() && pressed(named(ImGuiKey_Home))) state_.time_s = state_.scene->simulation.time.start_s;
  if (state_.hasScene() && pressed(named(ImGuiKey_End))) state_.time_s = state_.scene->simulation.time.at(state_.scene->simulation.time.frames - 1);
  if (letter('P')) state_.tool = Tool::Probe;
  if (letter('R')) state_.tool = Tool::Region;
  if (letter('L')) state_.tool = Tool::Profile;
  if (letter('F')) state_.tool = Tool::Fly;
  if (letter('O')) state_.overlays.outlines = !state_.overlays.outlines;
  if (letter('B')) state_.overlays.boxes = !state_.overlays.boxes;
  if (letter('X')) state_.overlays.gate = !state_.overlays.gate;
  if (letter('V') && state_.hasScene()) state_.hands.flown.erase(state_.cameraShown().name);
  if (letter('C') && state_.hasScene()) {
    state_.camera = (state_.camera + 1) % state_.scene->simulation.cameras.size();
    chooseLayers();
  }
  if (letter('M')) {
    std::vector<std::string> names = colourMapNames();
    names.insert(names.begin(), "auto");
    const auto at = std::find(names.begin(), names.end(), state_.look.map);
    state_.look.map = at == names.end() || at + 1 == names.end() ? names.front() : *(at + 1);
  }
  for (const std::string& layer : state_.shown) {
    if (letter('G')) state_.look.layers[layer].kind = static_cast<ScaleKind>((static_cast<int>(state_.look.layers[layer].kind) + 1) % 3);
    if (letter('T')) state_.look.layers[layer].asTemperature = !state_.look.layers[layer].asTemperature;
  }
  if (state_.picture)
    for (int k = 0; k < 9; ++k)
      if (letter(static_cast<char>('1' + k)) && k < static_cast<int>(state_.picture->frame.layers.size())) {
        const std::string& name = state_.picture->frame.layers[static_cast<std::size_t>(k)].name;
        const auto at = std::find(state_.shown.begin(), state_.shown.end(), name);
        if (at == state_.shown.end()) state_.shown.push_back(name);
        else state_.shown.erase(at);
      }
}

void Viewer::frame() {
  state_.marks.clear();
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  const float text = ImGui::GetTextLineHeight();
  const float bottom = 4.4f * text, side = std::min(std::max(0.34f * size.x, 26.0f * text), 0.6f * size.x);
  ImGui::SetNextWindowPos(ImVec2(0.0f, 0.0f));
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("pitviper", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoBringToFrontOnFocus |
                   ImGuiWindowFlags_NoSavedSettings);
  topBar();
  const float middle = std::max(ImGui::GetContentRegionAvail().y - bottom, 1.0f);
  const ImVec2 wide(std::max(ImGui::GetContentRegionAvail().x - side, 1.0f), middle);
  if (state_.wish.scenario.file.empty()) {
    ImGui::BeginChild("wide", wide, false, ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse);
    for (auto& panel : panels_)
      if (panel->drawWide(state_, ImGui::GetContentRegionAvail())) break;
    ImGui::EndChild();
  } else {
    pictures_.draw(state_, wide);
  }
  ImGui::SameLine();
  ImGui::BeginChild("side", ImVec2(0.0f, middle));
  if (ImGui::BeginTabBar("panels")) {
    for (std::size_t k = 0; k < panels_.size(); ++k) {
      Panel& panel = *panels_[k];
      const bool open = ImGui::BeginTabItem(panel.title().c_str(), nullptr, wantedPanel_ == static_cast<int>(k) ? ImGuiTabItemFlags_SetSelected : 0);
      state_.marks.item("tab:" + panel.name());
      if (!open) continue;
      ImGui::BeginChild(panel.name().c_str(), ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NoBackground);
      panel.draw(state_);
      ImGui::EndChild();
      ImGui::EndTabItem();
    }
    wantedPanel_ = -1;
    ImGui::EndTabBar();
  }
  ImGui::EndChild();
  timeline(1.9f * text);
  statusLine();
  ImGui::End();
  for (auto& panel : panels_) panel->look(state_);
  problemWindow();
  helpWindow();
  keys();
}

void Viewer::run() {
  std::optional<ScriptRunner> script;
  if (!state_.wish.script.empty())
    script.emplace(readScript(state_.wish.script), window_, state_.marks,
                   ScriptRunner::Hooks{[this](const std::string& file) { open(file); },
                                       [this](const std::string& what, const Location& where) { return isReached(what, where); },
                                       [this](const std::string& file) { writePicture(file); }});
  const auto start = std::chrono::steady_clock::now();
  const auto elapsed = [start] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  double last_s = 0.0, drawn_s = -1.0;
  std::uint64_t drawnPicture = 0;
  bool isDrawn = true;  ///< a script acts once a frame
  while (!window_.isClosed()) {
    const bool acts = script && !script->isWaiting();
    if (isDrawn && script && !script->step(now_s_)) return;
    isDrawn = false;
    const bool isBusy = window_.listen(acts ? 0.0 : std::max(0.0, last_s + kBusy_s - elapsed())) || acts;
    // A mouse that moves says so a thousand times a second.
    if (const double left_s = last_s + kLeast_s - elapsed(); left_s > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(left_s));
    now_s_ = elapsed();
    takeLoaded();
    watchFile(now_s_);
    ask();
    tick(now_s_ - last_s);
    ask();  // for the next frame at once, where the one before has come
    last_s = now_s_;
    // Where nothing changes the window is drawn seldom: what draws it is what draws the scene, where there is no GPU.
    const std::uint64_t picture = state_.picture ? state_.picture->number : 0;
    if (now_s_ - drawn_s < (isBusy ? kBusy_s - kLeast_s : picture != drawnPicture ? 0.0 : kIdle_s)) continue;
    drawnPicture = picture, drawn_s = now_s_;
    window_.beginFrame();
    frame();
    window_.endFrame();
    isDrawn = true;
    if (std::exchange(shoots_, false)) {
      const std::string file = "pitviper_view.png";
      writePng(file, window_.pixels());
      window_.keepPixels(false);
      state_.say("written: " + file);
    }
    state_.window_ms = 1e3 * (elapsed() - now_s_);
    ++countedFrames_;
    if (now_s_ - countedFrom_s_ >= 1.0) {
      const std::uint64_t pictures = state_.picture ? state_.picture->number : 0;
      state_.pictures_s = static_cast<double>(pictures - std::min(countedPicture_, pictures)) / (now_s_ - countedFrom_s_);
      state_.window_s = countedFrames_ / (now_s_ - countedFrom_s_);
      countedPicture_ = pictures, countedFrames_ = 0, countedFrom_s_ = now_s_;
    }
  }
}

}  // namespace pitviper
