#include "render/first_hit_layers.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "film/cryptomatte.h"
#include "integrators/walk/pixel_ray.h"

namespace lampyr {

namespace {

constexpr int kMostHitSamples = 16, kSamplesOfAlbedo = 4;
constexpr int kMostSmooth = 8;  // smooth surfaces that are followed
constexpr size_t kValues = 17;
constexpr size_t kNg = 8, kNs = 11;  // the normals among FirstHit::Values

struct FirstHit {
  Color albedo;
  Point3 position;
  float dzdx = 0, dzdy = 0, depth = 0;
  Normal3 Ng, Ns;
  Point2 uv;
  int32_t object = -1, material = -1;

  std::array<float, kValues> Values() const {
    return {albedo.r, albedo.g, albedo.b, position.x, position.y, position.z, dzdx, dzdy, Ng.x,
            Ng.y,     Ng.z,     Ns.x,     Ns.y,       Ns.z,       uv.x,       uv.y, depth};
  }
};

const std::vector<std::string>& ChannelsOfFilm() {
  static const std::vector<std::string> channels = {"Albedo.R", "Albedo.G", "Albedo.B", "P.X", "P.Y", "P.Z",
                                                    "dzdx",     "dzdy",     "N.X",      "N.Y", "N.Z", "Ns.X",
                                                    "Ns.Y",     "Ns.Z",     "u",        "v"};
  return channels;
}

// The indices of the channels among FirstHit::Values, without those of mattes.
std::vector<size_t> ValuesOf(const RenderSettings& settings) {
  std::vector<size_t> values;
  for (const std::string& channel : FirstHitChannels(settings)) {
    const auto& all = ChannelsOfFilm();
    const std::string name = !settings.firstHit && channel.starts_with("N.") ? "Ns." + channel.substr(2) : channel;
    if (name.starts_with("Crypto")) continue;
    const auto found = std::find(all.begin(), all.end(), name);
    values.push_back(found == all.end() ? kValues - 1 : static_cast<size_t>(found - all.begin()));
  }
  return values;
}

std::vector<float> IdsOf(const std::vector<std::string>& names) {
  std::vector<float> ids;
  for (const std::string& name : names) ids.push_back(CryptomatteId(name));
  return ids;
}

class FirstHitTracer {
 public:
  explicit FirstHitTracer(const BuiltScene& built)
      : scene_(built.scene),
        settings_(built.settings),
        toLayers_(built.renderToLayers),
        fromLayers_(toLayers_.Inverse()),
        toCamera_(built.layersToCamera),
        values_(ValuesOf(built.settings)),
        objects_(IdsOf(built.objectNames)),
        materials_(IdsOf(built.materialNames)),
        mattes_{MattesOf(built.settings)},
        filter_(settings_.filter) {}

  // Writes the channels of a pixel: the means over its samples.
  void Pixel(int x, int y, Sampler& sampler, float* channels) const {
    std::array<double, kValues> sums{};
    CryptomattePixel objects, materials;
    double weights = 0, all = 0;
    for (int i = 0; i < std::min(kMostHitSamples, settings_.samplesPerPixel); ++i) {
      sampler.StartPixelSample(x, y, static_cast<uint32_t>(i));
      const float time = SampleTime(scene_, sampler);
      const PixelRay ray = MakePixelRay(scene_, filter_, x, y, time, sampler);
      // A filter with negative lobes would divide by a sum near 0 at the edge of a surface.
      const double weight = std::abs(static_cast<double>(ray.filterWeight));
      all += weight;
      FirstHit hit;
      if (ray.camera.weight == 0 || !Trace(ray, x, y, sampler, hit)) continue;
      const std::array<float, kValues> values = hit.Values();
      if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); })) continue;
      for (size_t c = 0; c < values.size(); ++c) sums[c] += static_cast<double>(values[c]) * weight;
      weights += weight;
      if (hit.object >= 0 && !objects_.empty()) objects.Add(objects_[static_cast<size_t>(hit.object)], weight);
      if (hit.material >= 0 && !materials_.empty())
        materials.Add(materials_[static_cast<size_t>(hit.material)], weight);
    }
    const std::array<float, kValues> means = MeansOf(sums, weights);
    for (const size_t value : values_) *channels++ = means[value];
    for (const char* matte : mattes_) {
      (matte == kObjectMatte ? objects : materials).Write(all, channels);
      channels += 2 * CryptomattePixel::kRanks;
    }
  }

 private:
  static std::vector<const char*> MattesOf(const RenderSettings& settings) {
    std::vector<const char*> mattes;
    for (const PixelLayer* layer : settings.pixelLayers) {
      for (const char* matte : {kObjectMatte, kMaterialMatte}) {
        if (std::string(layer->name) == matte) mattes.push_back(matte);
      }
    }
    return mattes;
  }

  static std::array<float, kValues> MeansOf(const std::array<double, kValues>& sums, double weights) {
    std::array<float, kValues> means{};
    if (!(weights > 0)) return means;
    std::transform(sums.begin(), sums.end(), means.begin(), [&](double s) { return float(s / weights); });
    for (const size_t first : {kNg, kNs}) {
      const float length = std::hypot(means[first], means[first + 1], means[first + 2]);
      for (size_t c = first; c < first + 3; ++c) means[c] = length > 0 ? means[c] / length : 0.0f;
    }
    return means;
  }

  bool Trace(const PixelRay& pixel, int x, int y, Sampler& sampler, FirstHit& first) const {
    Ray ray = pixel.camera.ray;
    for (int smooth = 0;; ++smooth) {
      RayHit hit;
      Color passed;
      const uint32_t kinds = smooth == 0 ? visibility::kCamera : visibility::kIndirect;
      if (!scene_.geometry->Intersect(ray, kinds, hit, passed)) return false;
      const SurfacePoint point = scene_.geometry->GetSurfacePoint(ray, hit);
      const GeometryAttributes& attributes = scene_.geometry->Attributes(hit.primitive);
      first.material = attributes.material;
      first.object = attributes.object;
      Normal3 Ns = point.Ns;
      if (first.material >= 0 && scene_.materials[static_cast<size_t>(first.material)]) {
        const Bsdf bsdf = scene_.materials[static_cast<size_t>(first.material)]->GetBsdf(point, -ray.direction);
        if (settings_.seesThroughSmooth && smooth < kMostSmooth && Follow(bsdf, point, smooth, sampler, ray)) continue;
        Ns = bsdf.ShadingFrame().z;
        first.albedo = Albedo(bsdf, -ray.direction, sampler);
      }
      SetFrom(point, Ns, ray, x, y, first);
      return true;
    }
  }

  // Moves the ray on if the surface is perfectly smooth.
  static bool Follow(const Bsdf& bsdf, const SurfacePoint& point, int smooth, Sampler& sampler, Ray& ray) {
    if (!bsdf.IsDelta()) return false;
    sampler.SetDimension(PathDimensions().Of(kSamplesOfAlbedo + smooth, dimensions::kLobe));
    const float uLobe = sampler.Get1D();
    const BsdfSample sample = bsdf.Sample(-ray.direction, uLobe, sampler.Get2D(), TransportMode::Radiance);
    if (!sample) return false;
    ray.origin = OffsetRayOrigin(point.position, point.positionError, point.Ng, sample.wi);
    ray.direction = sample.wi;
    ray.tMax = kInfinity;
    return true;
  }

  void SetFrom(const SurfacePoint& point, const Normal3& Ns, const Ray& ray, int x, int y, FirstHit& first) const {
    const auto facing = [&](const Normal3& n) { return glm::dot(n, ray.direction) > 0 ? -n : n; };
    first.Ng = ToLayers(facing(point.Ng));
    first.Ns = ToLayers(facing(Ns));
    first.position = toLayers_.Point(point.position);
    first.depth = toCamera_.Point(first.position).z;
    first.uv = point.uv;
    first.dzdx = DepthChange(point, x, y, {1, 0});
    first.dzdy = DepthChange(point, x, y, {0, 1});
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
  const Affine toLayers_, fromLayers_, toCamera_;
  const std::vector<size_t> values_;
  const std::vector<float> objects_, materials_;  // identifiers of names
  const std::vector<const char*> mattes_;         // in the order of their channels
  const PixelFilter filter_;
};

}  // namespace

// Mattes are last.
std::vector<std::string> FirstHitChannels(const RenderSettings& settings) {
  std::vector<std::string> channels;
  if (settings.firstHit) channels = ChannelsOfFilm();
  for (const bool isMatte : {false, true}) {
    for (const PixelLayer* layer : settings.pixelLayers) {
      if (IsOfSamples(*layer)) continue;
      for (const std::string& channel : layer->channels) {
        if (channel.starts_with("Crypto") == isMatte &&
            std::find(channels.begin(), channels.end(), channel) == channels.end())
          channels.push_back(channel);
      }
    }
  }
  return channels;
}

std::map<std::string, std::string> FirstHitMetadata(const BuiltScene& built) {
  std::map<std::string, std::string> metadata;
  const RenderSettings& settings = built.settings;
  if (!settings.WantsFirstHit()) return metadata;
  metadata[kFirstHitMetadata] =
      settings.firstHit.value_or(FirstHitSpace::World) == FirstHitSpace::World ? "world" : "camera";
  std::string& channels = metadata[kFirstHitChannelsMetadata];
  for (const std::string& channel : FirstHitChannels(settings)) channels += (channels.empty() ? "" : ",") + channel;
  if (settings.Wants(kObjectMatte)) metadata.merge(CryptomatteMetadata("CryptoObject", built.objectNames));
  if (settings.Wants(kMaterialMatte)) metadata.merge(CryptomatteMetadata("CryptoMaterial", built.materialNames));
  return metadata;
}

Image FirstHitLayers(const BuiltScene& built, int threads, const std::atomic<bool>& interrupted) {
  const PixelRect& crop = built.settings.crop;
  Image image(crop.Width(), crop.Height(), FirstHitChannels(built.settings));
  const FirstHitTracer tracer(built);
  ParallelFor(image.height, threads, [&](int row) {
    if (interrupted.load()) return;
    Sampler sampler(built.settings.sampler, built.settings.seed);
    for (int column = 0; column < image.width; ++column) {
      tracer.Pixel(crop.x0 + column, crop.y0 + row, sampler, &image.At(column, row, 0));
    }
  });
  return interrupted.load() ? Image() : image;
}

}  // namespace lampyr
