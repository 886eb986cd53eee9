#include "render/feature_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "denoise/denoise.h"
#include "geometry/robust.h"
#include "integrators/walk/pixel_ray.h"
#include "sampling/rng.h"

namespace lampyr {

namespace {

constexpr int kFewestSamples = 16, kMostSamples = 128, kMostBounces = 10;
constexpr uint64_t kFeatureSeed = 0x3c6ef372fe94f82b;  // changes the seed
constexpr double kEnoughVariance = 1e-5;               // of the means
constexpr size_t kFeatures = 7;
using Features = std::array<float, kFeatures>;

struct Sums {
  std::array<double, kFeatures> sum{}, squares{};
  int count = 0;

  void Add(const Features& features) {
    for (size_t k = 0; k < kFeatures; ++k) {
      const double value = std::isfinite(features[k]) ? static_cast<double>(features[k]) : 0;
      sum[k] += value;
      squares[k] += value * value;
    }
    ++count;
  }
  // Variance of the mean of feature k.
  double Variance(size_t k) const {
    const double mean = sum[k] / count;
    return std::max(squares[k] / count - mean * mean, 0.0) / std::max(count - 1, 1);
  }
  // The largest variance of albedo and normal, whose range is known.
  double LargestVariance() const {
    double largest = 0;
    for (size_t k = 0; k + 1 < kFeatures; ++k) largest = std::max(largest, Variance(k));
    return largest;
  }
};

class FeatureTracer {
 public:
  explicit FeatureTracer(const BuiltScene& built)
      : scene_(built.scene), settings_(built.settings), filter_(settings_.filter) {}

  // Writes the means over the samples of a pixel, then their variances. Pixels at edges get more samples.
  void Pixel(int x, int y, Sampler& sampler, float* out) const {
    Sums sums;
    for (int i = 0; i < kMostSamples && (i < kFewestSamples || sums.LargestVariance() > kEnoughVariance); ++i) {
      sampler.StartPixelSample(x, y, static_cast<uint32_t>(i));
      const float time = SampleTime(scene_, sampler);
      const PixelRay ray = MakePixelRay(scene_, filter_, x, y, time, sampler);
      sums.Add(ray.camera.weight == 0 ? Features() : Trace(ray.camera.ray, sampler));
    }
    for (size_t k = 0; k < kFeatures; ++k) {
      out[k] = static_cast<float>(sums.sum[k] / sums.count);
      out[kFeatures + k] = static_cast<float>(sums.Variance(k));
    }
  }

 private:
  // The features of one ray; 0 if it hits nothing.
  Features Trace(Ray ray, Sampler& sampler) const {
    Color throughput(1.0f);
    float distance = 0;
    for (int bounce = 0; bounce < kMostBounces; ++bounce) {
      RayHit hit;
      Color passed;
      const uint32_t kind = bounce == 0 ? visibility::kCamera : visibility::kIndirect;
      if (!scene_.geometry->Intersect(ray, kind, hit, passed)) return {};
      const SurfacePoint point = scene_.geometry->GetSurfacePoint(ray, hit);
      distance += glm::length(point.position - ray.origin);
      const int material = scene_.geometry->Attributes(hit.primitive).material;
      const Vector3 wo = -ray.direction;
      if (material < 0 || !scene_.materials[static_cast<size_t>(material)])
        return FeaturesOf(point.Ns, wo, Color(0.0f), distance);
      const Bsdf bsdf = scene_.materials[static_cast<size_t>(material)]->GetBsdf(point, wo);
      sampler.SetDimension(PathDimensions().Of(bounce, dimensions::kLobe));
      const float uLobe = sampler.Get1D();
      const BsdfSample sample = bsdf.Sample(wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
      // Radiance is scaled by η² when light is refracted; power is not.
      if (sample) {
        throughput = throughput * (sample.weightDiffuse + sample.weightSpecular) *
                     (sample.isTransmission ? Sqr(sample.eta) : 1.0f);
      }
      if (!sample || !bsdf.IsDelta())
        return FeaturesOf(bsdf.ShadingFrame().z, wo, sample ? throughput : Color(0.0f), distance);
      ray = SpawnRay(point, sample.wi, ray.time);
    }
    return {};
  }

  static Features FeaturesOf(const Normal3& Ns, const Vector3& wo, const Color& albedo, float distance) {
    const Normal3 n = glm::dot(Ns, wo) < 0 ? -Ns : Ns;
    return {albedo.r, albedo.g, albedo.b, n.x, n.y, n.z, 1 / distance};
  }

  const RenderScene& scene_;
  const RenderSettings& settings_;
  const PixelFilter filter_;
};

}  // namespace

const std::vector<std::string>& FeatureChannels() {
  static const std::vector<std::string> channels = [] {
    std::vector<std::string> names;
    for (const char* prefix : {kFeaturePrefix, kFeatureVariancePrefix}) {
      for (const char* name : {"Albedo.R", "Albedo.G", "Albedo.B", "N.X", "N.Y", "N.Z", "inverseDistance.Z"})
        names.push_back(std::string(prefix) + name);
    }
    return names;
  }();
  return channels;
}

Image FeatureLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted) {
  const PixelRect& crop = built.settings.crop;
  Image image(crop.Width(), crop.Height(), FeatureChannels());
  const FeatureTracer tracer(built);
  ParallelFor(image.height, threads, [&](int row) {
    if (interrupted.load()) return;
    // Other positions than those of the picture's samples, whose noise the features would share.
    Sampler sampler(built.settings.sampler, MixBits(built.settings.seed + kFeatureSeed));
    for (int column = 0; column < image.width; ++column)
      tracer.Pixel(crop.x0 + column, crop.y0 + row, sampler, &image.At(column, row, 0));
  });
  return interrupted.load() ? Image() : image;
}

}  // namespace lampyr
