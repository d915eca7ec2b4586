#pragma once
#include "sim/scene/import/grid_reply.hpp"

namespace pitviper {

/// The arrays of VTK image data, of points or else of cells; checked tags (checkVti) assumed. Throws ImportFailure.
GridData readVti(const GridRequest& request);

}  // namespace pitviper
