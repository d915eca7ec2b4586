#pragma once
// What leaves the renderer.
#include <memory>
#include <string>
#include <vector>

#include "sim/camera/camera_pointer.hpp"
#include "sim/camera/hot_parts.hpp"
#include "sim/plan/averaged_fringes.hpp"
#include "sim/render/reference/pixel_truth.hpp"
#include "sim/scene/camera.hpp"
#include "sim/scene/scene.hpp"

namespace pitviper {

/// What an audit found of a channel's slot: relative errors |L - Lref| / max(|Lref|, 1e-3 x the 99th percentile of the picture).
struct SlotAudit {
  int pixels = 0;  ///< random ones
  double median = 0.0, largest = 0.0;
  double doubt = -1.0;  ///< of the pixel that sees what few do; below 0: none was looked at
};

/// Light of what is smaller than a subpixel, where it falls.
struct FilmPoint {
  double column = 0.0, row = 0.0;  ///< pixels of the picture from its top left corner
  int slot = 0;
  int pixel = 0;      ///< that it is in (row by row from the top), all of what it stands for
  double flux = 0.0;  ///< kernel unit x W/m2 on the aperture: radiance times projected solid angle; what it hides taken away
};

/// What leaves the renderer: integrals of kernel x radiance per slot and pixel, row 0 at the top.
struct CameraImage {
  int width = 0, height = 0;
  std::vector<std::vector<double>> slots;  ///< [slot][pixel], kernel unit x W/(m2 sr)
  std::shared_ptr<const Pinhole::SolidAngles> solidAngles;
  ChannelValues exposures_s;                                               ///< of the camera at its time
  double exposure_s = 0.0;                                                 ///< the longest of them
  std::vector<TruthPixel> truth;                                           ///< per pixel, or empty
  std::vector<int> slotOfOutput;                                           ///< from the plan
  std::vector<AveragedFringes> averagedFringes;                            ///< of materials, the same in every picture
  double accuracy = 0.0;                                                   ///< from the plan, and so its error per slot
  std::vector<double> predictedError;                                      ///< empty where nothing was measured
  std::string plan;                                                        ///< its fingerprint
  bool isDraft = false;                                                    ///< by that of a draft, while the one asked for is made
  std::vector<Ball> parts;                                                 ///< bright ones that had views of their own
  std::vector<FilmPoint> points;                                           ///< besides `slots`: of a camera with pointsApart
  int exposureParts = 1;                                                   ///< times that it is a mean of
  double exposureMotion_px = 0.0, exposureError = 0.0, streakError = 0.0;  ///< as of ExposureParts
  std::vector<SlotAudit> audit;                                            ///< per slot; empty: not audited
  std::optional<CameraPointing> pointing;                                  ///< of a camera with a follower
};

/// Points become part of the pixels that they are in, and there are none any more.
void putPointsIntoPixels(CameraImage& image);

}  // namespace pitviper
