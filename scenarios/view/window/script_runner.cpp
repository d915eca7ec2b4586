#include "scenarios/view/window/script_runner.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "sim/image/png.hpp"
#include "sim/parameters/print.hpp"
#include "sim/parameters/table.hpp"

namespace pitviper {
namespace {

using Kind = ScriptLine::Kind;

constexpr double kPatience_s = 120.0;
constexpr int kDragSteps = 12;
constexpr double kFilmRate = 25.0;

const std::map<std::string, int>& keyNames() {
  static const std::map<std::string, int> names = [] {
    std::map<std::string, int> all{{"space", GLFW_KEY_SPACE}, {"left", GLFW_KEY_LEFT},  {"right", GLFW_KEY_RIGHT},   {"up", GLFW_KEY_UP},
                                   {"down", GLFW_KEY_DOWN},   {"home", GLFW_KEY_HOME},  {"end", GLFW_KEY_END},       {"escape", GLFW_KEY_ESCAPE},
                                   {"enter", GLFW_KEY_ENTER}, {"tab", GLFW_KEY_TAB},    {"delete", GLFW_KEY_DELETE}, {"backspace", GLFW_KEY_BACKSPACE},
                                   {"plus", GLFW_KEY_EQUAL},  {"minus", GLFW_KEY_MINUS}};
    for (int k = 0; k < 26; ++k) all[std::string(1, static_cast<char>('a' + k))] = GLFW_KEY_A + k;
    for (int k = 0; k < 10; ++k) all[std::string(1, static_cast<char>('0' + k))] = GLFW_KEY_0 + k;
    for (int k = 1; k <= 12; ++k) all["f" + std::to_string(k)] = GLFW_KEY_F1 + k - 1;
    return all;
  }();
  return names;
}

ImVec2 middleOf(const Marks::Place& p) { return ImVec2(0.5f * (p.low.x + p.high.x), 0.5f * (p.low.y + p.high.y)); }

}  // namespace

ScriptRunner::ScriptRunner(std::vector<ScriptLine> script, GlfwWindow& window, Marks& marks, Hooks hooks)
    : script_(std::move(script)), window_(window), marks_(marks), hooks_(std::move(hooks)) {}

ImVec2 ScriptRunner::place(const ScriptLine& line, std::size_t first) const {
  const std::string& name = line.words[0];
  if (line.words.size() > first + 1) {
    const auto surface = marks_.surfaces.find(name);
    const double x = scriptNumber(line, first), y = scriptNumber(line, first + 1);
    if (surface != marks_.surfaces.end()) return surface->second(x, y);
    if (const auto found = marks_.places.find(name); found != marks_.places.end()) {
      const auto& [low, high] = found->second;
      return ImVec2(low.x + static_cast<float>(x) * (high.x - low.x), low.y + static_cast<float>(y) * (high.y - low.y));
    }
  } else if (const auto found = marks_.places.find(name); found != marks_.places.end()) {
    return middleOf(found->second);
  }
  std::vector<std::string> names;
  for (const auto& [known, at] : marks_.places) names.push_back(known);
  for (const auto& [known, at] : marks_.surfaces) names.push_back(known);
  throw unknownWord(line.where, "the window shows no", name, names);
}

void ScriptRunner::press(ImVec2 at, bool down) {
  window_.onCursor(static_cast<double>(at.x), static_cast<double>(at.y));
  window_.onButton(GLFW_MOUSE_BUTTON_LEFT, down, 0);
}

void ScriptRunner::key(const ScriptLine& line) {
  int mods = 0;
  std::string rest = line.words[0];
  for (std::size_t plus; (plus = rest.find('+')) != rest.npos && plus + 1 < rest.size();) {
    const std::string mod = rest.substr(0, plus);
    mods |= mod == "ctrl" ? GLFW_MOD_CONTROL : mod == "shift" ? GLFW_MOD_SHIFT : mod == "alt" ? GLFW_MOD_ALT : 0;
    rest.erase(0, plus + 1);
  }
  const auto found = keyNames().find(rest);
  if (found == keyNames().end()) {
    std::vector<std::string> names;
    for (const auto& [name, code] : keyNames()) names.push_back(name);
    throw unknownWord(line.where, "there is no key", rest, names);
  }
  const int code = found->second;
  actions_.push_back([this, code, mods] { return window_.onKey(code, true, mods), true; });
  actions_.push_back([this, code] { return window_.onKey(code, false, 0), true; });
}

void ScriptRunner::begin(const ScriptLine& line, double now_s) {
  const auto& w = line.words;
  const auto rest = [this] { actions_.push_back([] { return true; }); };  // a frame in which what was done shows
  switch (line.kind) {
    case Kind::Open:
      actions_.push_back([this, file = w[0]] { return hooks_.open(file), true; });
      break;
    case Kind::Wait: {
      const double limit_s = now_s + (w.size() > 1 ? scriptNumber(line, 1) : kPatience_s);
      if (!w[0].empty() && (std::isdigit(static_cast<unsigned char>(w[0][0])) || w[0][0] == '.')) {
        const double until_s = now_s + scriptNumber(line, 0);
        actions_.push_back([this, until_s] { return now_s_ >= until_s; });
      } else {
        rest();
        rest();
        actions_.push_back([this, line, limit_s] {
          if (hooks_.isReached(line.words[0], line.where)) return true;
          if (now_s_ > limit_s)
            throw UserError(line.where, "waited in vain for '" + line.words[0] + "'", "it within the limit", "wait longer, or see what keeps it");
          return false;
        });
        rest();
      }
      break;
    }
    case Kind::Click:
      marks_.wanted = w[0];
      rest();
      rest();
      actions_.push_back([this, line] {
        const ImVec2 at = place(line, 1);
        return window_.onCursor(static_cast<double>(at.x), static_cast<double>(at.y)), true;
      });
      rest();
      actions_.push_back([this, line] { return press(place(line, 1), true), true; });
      actions_.push_back([this] {
        marks_.wanted.clear();
        return window_.onButton(GLFW_MOUSE_BUTTON_LEFT, false, 0), true;
      });
      rest();
      break;
    case Kind::Drag: {
      const int steps = w.size() > 5 ? std::max(1, static_cast<int>(scriptNumber(line, 5))) : kDragSteps;
      const auto along = [this, line](double part) {
        ScriptLine now = line;
        now.words.resize(3);
        for (std::size_t k : {std::size_t{1}, std::size_t{2}})
          now.words[k] = print("%.17g", (1.0 - part) * scriptNumber(line, k) + part * scriptNumber(line, k + 2));
        return place(now, 1);
      };
      // Where it goes is told by what stands there when it begins: an axis may move while something is dragged.
      auto from = std::make_shared<ImVec2>(), to = std::make_shared<ImVec2>();
      actions_.push_back([this, along, from, to] {
        *from = along(0.0), *to = along(1.0);
        return window_.onCursor(static_cast<double>(from->x), static_cast<double>(from->y)), true;
      });
      rest();
      actions_.push_back([this, from] { return press(*from, true), true; });
      for (int k = 1; k <= steps; ++k)
        actions_.push_back([this, from, to, part = static_cast<float>(k) / static_cast<float>(steps)] {
          window_.onCursor(static_cast<double>(from->x + part * (to->x - from->x)), static_cast<double>(from->y + part * (to->y - from->y)));
          return true;
        });
      actions_.push_back([this] { return window_.onButton(GLFW_MOUSE_BUTTON_LEFT, false, 0), true; });
      rest();
      break;
    }
    case Kind::Scroll:
      actions_.push_back([this, line] {
        const ImVec2 at =
            line.words.size() > 2 ? place(line, 2) : middleOf(marks_.places.count(line.words[0]) ? marks_.places.at(line.words[0]) : Marks::Place{});
        return window_.onCursor(static_cast<double>(at.x), static_cast<double>(at.y)), true;
      });
      rest();
      actions_.push_back([this, by = scriptNumber(line, 1)] { return window_.onScroll(0.0, by), true; });
      rest();
      break;
    case Kind::Type:
      for (char c : w[0]) actions_.push_back([this, c] { return window_.onChar(static_cast<unsigned char>(c)), true; });
      rest();
      break;
    case Kind::Key:
      key(line);
      rest();
      break;
    case Kind::Screenshot:
      actions_.push_back([this] { return window_.keepPixels(true), true; });
      actions_.push_back([this, file = w[0]] {
        writePng(file, window_.pixels());
        window_.keepPixels(film_ != nullptr);
        return true;
      });
      break;
    case Kind::Picture:
      actions_.push_back([this, file = w[0]] { return hooks_.writePicture(file), true; });
      break;
    case Kind::Film:
      film_ = std::make_unique<VideoWriter>(w[0], w.size() > 1 ? scriptNumber(line, 1) : kFilmRate, "pitviper view");
      window_.keepPixels(true);
      rest();
      break;
    case Kind::EndFilm:
      if (film_) film_->finish();
      film_.reset();
      window_.keepPixels(false);
      break;
    case Kind::Resize:
      actions_.push_back([this, line] { return window_.resize(static_cast<int>(scriptNumber(line, 0)), static_cast<int>(scriptNumber(line, 1))), true; });
      for (int k = 0; k < 5; ++k) rest();
      break;
    case Kind::Print:
      for (const auto& [name, text] : marks_.texts)
        if (w[0] == "*" || w[0] == name) std::printf("%s: %s\n", name.c_str(), text.c_str());
      std::fflush(stdout);
      break;
    case Kind::Expect: {
      const auto found = marks_.texts.find(w[0]);
      const std::string is = found == marks_.texts.end() ? "nothing" : "'" + found->second + "'";
      if (found == marks_.texts.end() || found->second.find(w[1]) == std::string::npos)
        throw UserError(line.where, "'" + w[0] + "' shows " + is, "'" + w[1] + "' in it", "see a screenshot");
      break;
    }
    case Kind::Quit:
      next_ = script_.size();
      break;
  }
}

bool ScriptRunner::step(double now_s) {
  now_s_ = now_s;
  if (film_)
    film_->add([&] {
      Rgb8Image image = window_.pixels();
      if (image.width % 2 == 0 && image.height % 2 == 0) return image;
      Rgb8Image even(image.width & ~1, image.height & ~1, {});
      for (int y = 0; y < even.height; ++y)
        for (int x = 0; x < even.width; ++x) even.set(x, y, image.at(x, y));
      return even;
    }());
  while (actions_.empty()) {
    if (next_ >= script_.size()) {
      if (film_) film_->finish();
      return false;
    }
    const ScriptLine line = script_[next_++];
    begin(line, now_s);
  }
  waits_ = !actions_.front()();
  if (!waits_) actions_.pop_front();
  return true;
}

}  // namespace pitviper
