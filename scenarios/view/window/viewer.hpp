#pragma once
// The window's frame: what is asked of the drawing thread, and panels around its newest picture.
#include <chrono>
#include <filesystem>
#include <memory>

#include "scenarios/view/frame_files.hpp"
#include "scenarios/view/newest_work.hpp"
#include "scenarios/view/window/glfw_window.hpp"
#include "scenarios/view/window/panels.hpp"
#include "scenarios/view/window/script_runner.hpp"
#include "scenarios/view/window/view_state.hpp"

namespace pitviper {

class Viewer {
 public:
  Viewer(GlfwWindow& window, const ViewWish& wish);
  ~Viewer();
  /// Until the window is closed or the script has ended. Errors: UserError of the script, or of a scenario that cannot be read where nobody is there to mend
  /// it.
  void run();

 private:
  struct Loaded {
    ViewedScenePointer scene;
    std::string problem;
    std::string file;
  };
  void open(const std::string& file);
  void askFile();
  void fileLine();
  void takeLoaded();
  void watchFile(double now_s);
  void ask();
  void tick(double seconds);
  void frame();
  void keys();
  void topBar();
  void lookBar();
  void timeline(float height);
  void statusLine();
  void helpWindow();
  void problemWindow();
  void chooseLayers();
  void writePicture(const std::string& file) const;
  bool isReached(const std::string& what, const Location& where) const;
  void step(int frames);

  GlfwWindow& window_;
  ViewState state_;
  std::unique_ptr<PictureMaker> maker_;
  NewestWork<ScenarioWish, Loaded> loader_;
  std::shared_ptr<const Loaded> loaded_;
  NewestWork<FrameFileWish, ShownPicture> reader_;  ///< of frames
  std::uint64_t filesAsked_ = 0;
  std::filesystem::path askedFile_;
  std::vector<std::unique_ptr<Panel>> panels_;
  PicturesPanel pictures_;
  std::map<std::filesystem::path, std::filesystem::file_time_type> stamps_;
  double nextLook_s_ = 0.0, now_s_ = 0.0, firstPicture_s_ = -1.0, firstAsked_s_ = -1.0, askedAt_s_ = 0.0, toPicture_s_ = -1.0, toAsked_s_ = -1.0;
  std::uint64_t countedPicture_ = 0;
  double countedFrom_s_ = 0.0;
  int countedFrames_ = 0;
  double owed_s_ = 0.0;  ///< of the scenario's time, while it is played
  bool showsHelp_ = false, shoots_ = false, keepsCamera_ = false;
  ViewedScenePointer askedScene_, askedFrom_;
  double askedAccuracy_ = 0.0;
  int wantedPanel_ = -1;
};

}  // namespace pitviper
