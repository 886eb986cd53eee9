#include "render/first_hit_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "integrators/walk/pixel_ray.h"

namespace lampyr {

namespace {

constexpr int kMostSamples = 16, kSamplesOfAlbedo = 4;
constexpr size_t kNg = 8, kNs = 11;  // the normals among FirstHit::Values

struct FirstHit {
  Color albedo;
  Point3 position;
  float dzdx = 0, dzdy = 0;
  Normal3 Ng, Ns;
  Point2 uv;

  std::array<float, 16> Values() const {
    return {albedo.r, albedo.g, albedo.b, position.x, position.y, position.z, dzdx, dzdy,
            Ng.x,     Ng.y,     Ng.z,     Ns.x,       Ns.y,       Ns.z,       uv.x, uv.y};
  }
};

class FirstHitTracer {
 public:
  explicit FirstHitTracer(const BuiltScene& built)
      : scene_(built.scene),
        settings_(built.settings),
        toLayers_(built.renderToLayers),
        fromLayers_(toLayers_.Inverse()),
        filter_(settings_.filter) {}

  // The means over the samples of a pixel.
  std::array<float, 16> Pixel(int x, int y, Sampler& sampler) const {
    std::array<double, 16> sums{};
    double weights = 0;
    for (int i = 0; i < std::min(kMostSamples, settings_.samplesPerPixel); ++i) {
      sampler.StartPixelSample(x, y, static_cast<uint32_t>(i));
      const float time = SampleTime(scene_, sampler);
      const PixelRay ray = MakePixelRay(scene_, filter_, x, y, time, sampler);
      FirstHit hit;
      if (ray.camera.weight == 0 || !Trace(ray, x, y, sampler, hit)) continue;
      const std::array<float, 16> values = hit.Values();
      if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) continue;
      // A filter with negative lobes would divide by a sum near 0 at the edge of a surface.
      const double weight = std::abs(static_cast<double>(ray.filterWeight));
      for (size_t c = 0; c < values.size(); ++c) sums[c] += static_cast<double>(values[c]) * weight;
      weights += weight;
    }
    std::array<float, 16> means{};
    if (!(weights > 0)) return means;
    std::transform(sums.begin(), sums.end(), means.begin(), [&](double s) { return float(s / weights); });
    for (const size_t first : {kNg, kNs}) {
      const float length = std::hypot(means[first], means[first + 1], means[first + 2]);
      for (size_t c = first; c < first + 3; ++c) means[c] = length > 0 ? means[c] / length : 0.0f;
    }
    return means;
  }

 private:
  bool Trace(const PixelRay& pixel, int x, int y, Sampler& sampler, FirstHit& first) const {
    Ray ray = pixel.camera.ray;
    RayHit hit;
    Color passed;
    if (!scene_.geometry->Intersect(ray, visibility::kCamera, hit, passed)) return false;
    const SurfacePoint point = scene_.geometry->GetSurfacePoint(ray, hit);
    const int material = scene_.geometry->Attributes(hit.primitive).material;
    Normal3 Ns = point.Ns;
    if (material >= 0 && scene_.materials[static_cast<size_t>(material)]) {
      const Bsdf bsdf = scene_.materials[static_cast<size_t>(material)]->GetBsdf(point, -ray.direction);
      Ns = bsdf.ShadingFrame().z;
      first.albedo = Albedo(bsdf, -ray.direction, sampler);
    }
    const auto facing = [&](const Normal3& n) { return glm::dot(n, ray.direction) > 0 ? -n : n; };
    first.Ng = ToLayers(facing(point.Ng));
    first.Ns = ToLayers(facing(Ns));
    first.position = toLayers_.Point(point.position);
    first.uv = point.uv;
    first.dzdx = DepthChange(point, x, y, {1, 0});
    first.dzdy = DepthChange(point, x, y, {0, 1});
    return true;
  }

  Normal3 ToLayers(const Normal3& n) const { return glm::normalize(fromLayers_.NormalByInverse(n)); }

  Color Albedo(const Bsdf& bsdf, const Vector3& wo, Sampler& sampler) const {
    Color sum;
    for (int i = 0; i < kSamplesOfAlbedo; ++i) {
      sampler.SetDimension(PathDimensions().Of(i, dimensions::kLobe));
      const float uLobe = sampler.Get1D();
      const BsdfSample sample = bsdf.Sample(wo, uLobe, sampler.Get2D(), TransportMode::Radiance);
      if (!sample) continue;
      // Radiance is scaled by η² when light is refracted; power is not.
      const float power = sample.isTransmission ? Sqr(sample.eta) : 1.0f;
      sum += (sample.weightDiffuse + sample.weightSpecular) * power;
    }
    return sum / float(kSamplesOfAlbedo);
  }

  // Magnitude of the change of z in the plane of the surface between what the pixel's middle sees of it and what the
  // middle of the pixel `step` away does; 0 if one of them does not meet that plane.
  float DepthChange(const SurfacePoint& point, int x, int y, const Point2& step) const {
    const Point2 middle(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f);
    const auto pointOf = [&](const Ray& through, float& z) {
      const float distance = glm::dot(point.position - through.origin, point.Ng),
                  cosine = glm::dot(through.direction, point.Ng);
      if (!(distance / cosine > 0)) return false;
      z = toLayers_.Point(through.origin + through.direction * (distance / cosine)).z;
      return std::isfinite(z);
    };
    float here = 0, there = 0;
    const CameraRay a = scene_.camera->GenerateRay(middle, Point2(0.5f), 0);
    const CameraRay b = scene_.camera->GenerateRay(middle + step, Point2(0.5f), 0);
    if (a.weight == 0 || b.weight == 0 || !pointOf(a.ray, here) || !pointOf(b.ray, there)) return 0;
    return std::abs(there - here);
  }

  const RenderScene& scene_;
  const RenderSettings& settings_;
  const Affine toLayers_, fromLayers_;
  const PixelFilter filter_;
};

}  // namespace

const std::vector<std::string>& FirstHitChannels() {
  static const std::vector<std::string> channels = {"Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z",
                                                    "dzdx",     "dzdy",     "N.X",      "N.Y", "N.Z", "Ns.X",
                                                    "Ns.Y",     "Ns.Z",     "u",        "v"};
  return channels;
}

Image FirstHitLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted) {
  const PixelRect& crop = built.settings.crop;
  Image image(crop.Width(), crop.Height(), FirstHitChannels());
  const FirstHitTracer tracer(built);
  ParallelFor(image.height, threads, [&](int row) {
    if (interrupted.load()) return;
    Sampler sampler(built.settings.sampler, built.settings.seed);
    for (int column = 0; column < image.width; ++column) {
      const std::array<float, 16> values = tracer.Pixel(crop.x0 + column, crop.y0 + row, sampler);
      std::copy(values.begin(), values.end(), &image.At(column, row, 0));
    }
  });
  return interrupted.load() ? Image() : image;
}

}  // namespace lampyr
