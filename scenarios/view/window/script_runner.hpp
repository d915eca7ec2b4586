#pragma once
// Does what a script says, through the window's own callbacks, an action a frame.
#include <deque>
#include <functional>
#include <memory>
#include <vector>

#include "scenarios/view/script.hpp"
#include "scenarios/view/window/glfw_window.hpp"
#include "scenarios/view/window/marks.hpp"
#include "sim/image/video.hpp"

namespace pitviper {

class ScriptRunner {
 public:
  struct Hooks {
    std::function<void(const std::string& file)> open;
    std::function<bool(const std::string& what, const Location& where)> isReached;  ///< of `wait`
    std::function<void(const std::string& file)> writePicture;
  };
  ScriptRunner(std::vector<ScriptLine> script, GlfwWindow& window, Marks& marks, Hooks hooks);
  /// Between two frames; false: it has ended. Errors: UserError where a name is nowhere, or an expectation does not hold.
  bool step(double now_s);
  /// For something that is not there yet: nothing is done meanwhile.
  bool isWaiting() const { return waits_; }

 private:
  void begin(const ScriptLine& line, double now_s);
  ImVec2 place(const ScriptLine& line, std::size_t first) const;
  void press(ImVec2 at, bool down);
  void key(const ScriptLine& line);
  std::vector<ScriptLine> script_;
  GlfwWindow& window_;
  Marks& marks_;
  Hooks hooks_;
  std::size_t next_ = 0;
  std::deque<std::function<bool()>> actions_;  ///< true: done
  std::unique_ptr<VideoWriter> film_;
  double now_s_ = 0.0;
  bool waits_ = false;
};

}  // namespace pitviper
