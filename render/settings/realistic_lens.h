// The parameters of Camera "realistic".
#pragma once

#include <memory>

#include "camera/camera.h"
#include "scene/scene_description.h"

namespace lampyr {

// Reads Camera "realistic", its lens file and the shape of its aperture. Throws located Errors.
std::unique_ptr<Camera> BuildRealisticCamera(const SceneDescription& description, const CameraFrame& frame,
                                             Diagnostics& diagnostics);

}  // namespace lampyr
