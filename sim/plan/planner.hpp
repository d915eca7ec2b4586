#pragma once
// Chooses a plan's wavelengths for what a scene shows: makePlan() with groups of wavelengths in the place of samples.
#include <functional>

#include "sim/plan/sights.hpp"

namespace pitviper {

/// About how much of a plan is made, 0 to 1.
using PlanProgress = std::function<void(double share)>;

/// Whether lines of sight are to say what wavelengths are off by that the user chose (`accuracy: none`); of those that are chosen here they always do.
enum class Foretold { IfChosen, Always };

/// A plan for what a camera or a probe sees. With an accuracy in its spectral settings: groups of wavelengths that integrate lines of sight drawn at
/// random within it, their error on others found (Plan::predictedError). Without: makePlan(), with tables for a usual accuracy. Throws what makePlan() throws.
/// `progress` is told how much is done, on the calling thread; of a plan at hand only that it is made. `earlier`: a plan of this eye for a scene that has
/// changed since in its materials' spectra alone: where its groups, terms and tables hold for this one too, as found on lines that no fit has seen, it is
/// taken.
Plan planFor(const Simulation& simulation, const Eye& eye, const PlanProgress& progress = {}, Foretold error = Foretold::IfChosen,
             const Plan* earlier = nullptr);
/// Whether that of a camera, which asks for an accuracy, need not be made but is found again.
bool isPlanKnown(const Simulation& simulation, const Camera& camera);

/// The same for what the truth of a camera's targets is measured in (measuredOutputs()); where that goes, of the same groups as the picture: no work besides.
Plan measuredPlanFor(const Simulation& simulation, const Camera& camera);

}  // namespace pitviper
