// Edges of bright lights, as the camera sees them: of a lamp, of its blurred image by a thin lens, of the sun in the
// sky.
//
// A sample of a pixel that a bright lamp half fills is either very bright or not, and its noise hides that of
// everything else. Whether it is bright takes one ray to know, not a path. So samples of such pixels have several
// camera rays: all look for light that they meet before anything scatters it, and one of them goes on as the sample's
// path. Of what n rays see each counts 1 / n (SampleContext::seenShare), in all techniques that hit lights, whatever
// their weights: the expectation is the same. Up to 33 rays cost little, because such pixels are few.
//
// The numbers of rays are found before the first sample, by a few rays through each pixel with random numbers of their
// own: they are a function of the scene, the camera and the size of the picture.
#pragma once

#include <memory>
#include <vector>

#include "integrators/walk/integrator.h"
#include "render/pass.h"
#include "render/settings/render_settings.h"

namespace lampyr {

class LightEdges {
 public:
  // Rays of a sample at most.
  static constexpr int kMostRays = 33;

  // Finds the numbers of rays of the pixels of `crop`. Null if all are 1: the settings turn light edges off, the film
  // limits samples or its filter has negative weights (such samples cannot be divided), or nothing bright has edges.
  static std::unique_ptr<const LightEdges> Find(const RenderScene& scene, const Integrator& integrator,
                                                const RenderSettings& settings, const PixelRect& crop, int threads);

  // Camera rays of each sample of a pixel of the crop: 1 + 0, 1, 2, 4, 8, 16 or 32, so that aligned blocks of samples
  // have aligned blocks of the further rays.
  int Rays(int x, int y) const {
    return rays_[static_cast<size_t>(y - crop_.y0) * static_cast<size_t>(crop_.Width()) +
                 static_cast<size_t>(x - crop_.x0)];
  }

 private:
  LightEdges(const PixelRect& crop, std::vector<uint8_t> rays) : crop_(crop), rays_(std::move(rays)) {}

  PixelRect crop_;
  std::vector<uint8_t> rays_;
};

// Traces the samples of a pass with all of their camera rays. One for each thread.
class EdgeSampler {
 public:
  // `sharesTime`: all rays of a sample have its time; otherwise further ones have times of their own.
  EdgeSampler(const Pass& pass, bool sharesTime);

  // The radiance of a sample, by `ray` and by the further rays of its pixel. `number`: of the sample in its sequence
  // (Pass::Seed). All light is relative to the weights of `ray`. If the lens does not pass it, and passes a further
  // one, its weight becomes 1.
  Color Radiance(int x, int y, uint64_t number, SampleContext& context, PixelRay& ray) {
    const int rays = pass_.edges ? pass_.edges->Rays(x, y) : 1;
    return rays == 1 ? TestedRadiance(pass_.integrator, ray, context)
                     : RadianceOfMany(x, y, number, rays, context, ray);
  }

 private:
  Color RadianceOfMany(int x, int y, uint64_t number, int rays, SampleContext& context, PixelRay& ray);

  const Pass& pass_;
  bool sharesTime_;
  Sampler sampler_, otherHalf_;
};

}  // namespace lampyr
