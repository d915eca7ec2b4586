#pragma once
// Pictures for a window, drawn by a thread of its own to the newest wish: at once by a sketch, then by a draft's plan, then as asked, each made beside.
#include <chrono>
#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "scenarios/view/hand_changes.hpp"
#include "scenarios/view/viewed_scene.hpp"
#include "sim/camera/camera_image.hpp"
#include "sim/frame/frame.hpp"
#include "sim/gl/shader_assembler.hpp"

namespace pitviper {

/// What is to be seen.
struct PictureWish {
  ViewedScenePointer scene;
  std::size_t camera = 0;
  double time_s = 0.0;
  HandChanges hands;
  bool operator==(const PictureWish&) const = default;
};

/// What a picture was drawn by: SketchTier, no plan; DraftTier, one of kDraft; Edited, the plan of the scene before an edit, not held against this one; Asked,
/// as asked.
enum class Tier { Sketch, Draft, Edited, Asked, File };
const char* nameOf(Tier tier);

struct ShownPicture {
  PictureWish wish;
  Frame frame;
  Tier tier = Tier::Sketch;
  double error = -1.0;  ///< the largest that its plan expects of any channel; below 0: nobody knows
  double accuracy = 0.0;
  int groups = 0;                          ///< wavelengths, or groups of them, that it is made of
  std::vector<std::string> kept, dropped;  ///< terms
  double draw_ms = 0.0;
  Pose pose;                                 ///< of the camera, local frame
  Pinhole pinhole;                           ///< at its time
  std::shared_ptr<const CameraImage> image;  ///< before the sensor's stages; null: of a file
  std::uint64_t number = 0;                  ///< rises by one with each picture
};
using ShownPicturePointer = std::shared_ptr<const ShownPicture>;

struct MakerStatus {
  std::string doing;     ///< "planning", "" where nothing is awaited
  double share = 0.0;    ///< of what is planned
  double since_s = 0.0;  ///< how long it has been
  std::string error;     ///< why there is no picture, or no plan
};

class PictureMaker {
 public:
  /// The library must outlive it. `told`: called on the drawing thread when there is another picture, or why there is none.
  explicit PictureMaker(const ShaderLibrary& library, std::function<void()> told = {});
  ~PictureMaker();
  PictureMaker(const PictureMaker&) = delete;
  PictureMaker& operator=(const PictureMaker&) = delete;

  /// The newest counts; one like the last changes nothing.
  void want(const PictureWish& wish);
  /// Null before the first.
  ShownPicturePointer newest() const;
  MakerStatus status() const;
  /// Nothing is awaited: the newest picture is of the last wish, and as asked.
  bool isDone() const;

 private:
  struct Desk;
  void run();
  const ShaderLibrary& library_;
  std::function<void()> told_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PictureWish> wish_;
  bool isNew_ = false, ends_ = false, isDone_ = false;
  ShownPicturePointer newest_;
  MakerStatus status_;
  std::chrono::steady_clock::time_point since_;
  std::thread thread_;
};

}  // namespace pitviper
