#pragma once
// What a plan was made for, in words that stand before it in its file: a plan drawn with where it does not belong gives wrong pictures without a word.
#include <optional>
#include <string>

#include "sim/plan/sight_rays.hpp"
#include "sim/scene/cache_folder.hpp"

namespace pitviper {

/// The line before a plan's text in a .plan file: "# plan HEX scene HEX eye HEX accuracy A samples N shared S of camera NAME".
struct PlanOrigin {
  std::string laws;            ///< lawsDigest()
  ContentKey scene{}, eye{};   ///< all that pictures depend on but for cameras; the camera's film, optics, place and channels
  double accuracy = 0.0;       ///< that the plan was asked for; 0: none was
  int samples = 1;             ///< n x n subpixels, Camera::samples
  bool sharesShading = false;  ///< Camera::sharesShading
  std::string camera;
};

/// Lines that audits taught a plan are left out: they are the plan's own.
PlanOrigin originOf(const Simulation& simulation, const Camera& camera);

std::string originLine(const PlanOrigin& origin);
/// That line within a file's text; none: there is no whole one.
std::optional<PlanOrigin> readOrigin(const std::string& text);
/// A file's text without the lines before the plan.
std::string withoutOrigin(const std::string& text);

/// UserError where the plan that `camera` was given (Camera::plan) was made for anything else, saying what differs.
void refuseForeignPlan(const Simulation& simulation, const Camera& camera);

/// The camera whose plan a reference was given (`accuracy: reference` beside a plan): as it draws by that plan.
Camera plannedCamera(const Camera& reference);
/// A reference along the lines that a plan's pictures are drawn along: their subpixels, views of small bodies and bright parts, footprints of textures,
/// times within an exposure. So pictures of both differ by wavelengths, tables, terms left out and precision alone.
void drawOnLinesOf(Camera& reference, const PlanOrigin& origin);

}  // namespace pitviper
