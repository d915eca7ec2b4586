#pragma once
// From a scenario's file to its first picture, once, in this process, with whatever is cached.
#include "scenarios/commands/first_figures.hpp"
#include "scenarios/commands/scenario_wish.hpp"

namespace pitviper {

struct OnceRequest {
  ScenarioWish scenario;
  int frames = 100;      ///< after the first, at most
  double most_s = 20.0;  ///< that they may take together
};

/// Needs a process that has drawn nothing yet and no GlContext; makes one. Spectral images, probes, audits and files are left out.
/// Errors: UserError as of reading; one without a camera.
FirstFigures measureOnce(const OnceRequest& request);

}  // namespace pitviper
