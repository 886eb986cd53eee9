#include <cmath>

#include "base/error.h"
#include "camera/camera.h"
#include "fuzz/target_support.h"

namespace lampyr::fuzz {

bool ReadLens(std::string_view bytes) {
  return AcceptErrors([&] {
    RealisticSettings settings;
    settings.lens = ParseLensFile(std::string(bytes), "input.dat");
    CameraFrame frame;
    frame.width = 3;
    frame.height = 2;
    const auto camera = MakeRealisticCamera(frame, settings);
    constexpr int kRays = 6;
    for (int i = 0; i < kRays; ++i) {
      const float part = static_cast<float>(i) / kRays;
      const CameraRay ray = camera->GenerateRay({3 * part, 2 * part * part}, {part, 0.5f}, 0);
      if (!(ray.weight >= 0 && std::isfinite(ray.weight))) Fail("a ray with a weight below 0, or not finite");
      if (!IsFinite(ray.ray.origin) || !(std::abs(glm::length(ray.ray.direction) - 1) < 1e-5f))
        Fail("a ray without a place or a direction");
    }
  });
}

}  // namespace lampyr::fuzz
