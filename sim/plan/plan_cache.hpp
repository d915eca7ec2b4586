#pragma once
// Plans kept between runs, by content: the same scene, eye and accuracy give the same plan, which takes a second or more to find.
// They are tables as others that are kept (sim/scene/content_cache.hpp).
#include <optional>

#include "sim/plan/plan.hpp"
#include "sim/plan/sight_rays.hpp"
#include "sim/scene/cache_folder.hpp"

namespace pitviper {

/// The key of a plan: of all that it is made from, the content of the whole scenario and of the eye.
ContentKey planKey(const Simulation& simulation, const Eye& eye, bool isForetold = true);

/// A fingerprint of the content of a plan, 32 hexadecimal digits.
std::string planFingerprint(const Plan& plan);

/// Whether drawing takes the same from two plans of a camera, whatever each is expected to lose.
bool drawAlike(const Plan& a, const Plan& b);

/// What a planner adds to an outline (makePlan's plan), as text that reads back to the same numbers; `into` is unchanged where it cannot be read.
std::string writePlanned(const Plan& plan);
bool readPlanned(const std::string& text, Plan& into);

/// False where it is not there, unreadable or damaged (which is told). Never throws.
bool readCachedPlan(const ContentKey& key, Plan& into);
/// A folder that cannot be written is told. Never throws.
void writeCachedPlan(const ContentKey& key, const Plan& plan);

}  // namespace pitviper
