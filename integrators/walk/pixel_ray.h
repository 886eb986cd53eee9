// Camera rays of a pixel's samples.
#pragma once

#include "film/pixel_filter.h"
#include "integrators/walk/render_scene.h"
#include "sampling/sampler.h"

namespace lampyr {

// A camera ray through a pixel, with the weight of the pixel filter.
struct PixelRay {
  CameraRay camera;
  float filterWeight = 1;
  Point2 film{0.0f};  // where it starts, pixels
};

// Shutter time of the sample that `sampler` has started, the same for all of its path.
inline float SampleTime(const RenderScene& scene, Sampler& sampler) {
  if (!scene.hasMotion) return 0;
  sampler.SetDimension(dimensions::kTime);
  return sampler.Get1D();
}

inline PixelRay MakePixelRay(const RenderScene& scene, const PixelFilter& filter, int x, int y, float time,
                             Sampler& sampler) {
  sampler.SetDimension(dimensions::kFilm);
  const PixelFilter::Offset offset = filter.Sample(sampler.Get2D());
  const Point2 film(static_cast<float>(x) + 0.5f + offset.offset.x, static_cast<float>(y) + 0.5f + offset.offset.y);
  Point2 lens(0.5f);
  if (!scene.camera->HasPinhole()) {
    sampler.SetDimension(dimensions::kLens);
    lens = sampler.Get2D();
  }
  return {scene.camera->GenerateRay(film, lens, time), offset.weight, film};
}

}  // namespace lampyr
