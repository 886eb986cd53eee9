// A pass of camera and light paths, with the photons that it gathers and leaves.
#pragma once

#include "render/pass.h"

namespace lampyr {

RenderCounts TraceBothPaths(const Pass& pass, PhotonStore* kept);

}  // namespace lampyr
