#include "render/analysis/pilot_passes.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "integrators/registry.h"
#include "integrators/walk/pixel_ray.h"
#include "render/settings/integrator_choice.h"

namespace lampyr::pilot {

namespace {

// Numbers of the samples of a pixel: those of camera paths, then those of photons, then those that select pixels.
constexpr uint32_t kSamplesOfPart = 1 << 16;
constexpr uint64_t kMostLightPaths = 4 * kMostPilotPixels;

}  // namespace

float PilotPasses::Time(uint32_t pass) const {
  constexpr double kGoldenRatio = 0.6180339887498949;  // spreads any number of passes over the shutter's time
  return scene_.hasMotion ? static_cast<float>(std::fmod(0.5 + pass * kGoldenRatio, 1.0)) : 0.0f;
}

template <class Body>
PassCounts PilotPasses::ForEachPixel(int count, const Body& body) {
  std::vector<PassCounts> counts(kChunks);
  ParallelFor(kChunks, threads_, [&](int chunk) {
    const auto index = static_cast<size_t>(chunk);
    // A variance is estimated by independent samples.
    Sampler sampler(SamplerKind::Independent, kSeed);
    // Splats are not kept, but connections that reach no pixel are not made.
    SplatList splats({0, 0}, {static_cast<float>(settings_.width), static_cast<float>(settings_.height)}, 1);
    const int end = BeginOfChunk(count, chunk + 1, kChunks);
    for (int i = BeginOfChunk(count, chunk, kChunks); i < end; ++i) {
      splats.Clear();
      splats.StartPath();
      body(index, i % grid_.width, i / grid_.width, sampler, counts[index], splats);
    }
  });
  PassCounts total;
  for (const PassCounts& part : counts) total += part;
  return total;
}

PassCounts PilotPasses::TracePhotons(const Integrator& integrator, PhotonStore& store, uint32_t pass) {
  const auto paths = static_cast<int>(std::min<uint64_t>(store.LightPaths(), kMostLightPaths));
  const PassCounts counts =
      ForEachPixel(paths, [&](size_t chunk, int x, int y, Sampler& sampler, PassCounts& ofChunk, SplatList& splats) {
        sampler.StartPixelSample(x, y, pass + kSamplesOfPart);
        photons_[chunk].StartPath();
        SampleContext context{scene_, sampler, Time(pass), ofChunk};
        context.mediumTimes = &ofChunk.media;
        context.splats = &splats;
        context.photons = &photons_[chunk];
        context.isForPhotonsAlone = true;
        context.withOrigin = store.WantsOrigins();
        integrator.Sample(nullptr, context);
      });
  store.Take(photons_);
  store.Finish(pass);
  return counts;
}

PassCounts PilotPasses::Trace(const Integrator& integrator, uint32_t pass, const PhotonPass* gather,
                              const Noted& noted) {
  return ForEachPixel(grid_.Pixels(), [&](size_t chunk, int x, int y, Sampler& sampler, PassCounts& counts,
                                          SplatList& splats) {
    sampler.StartPixelSample(x, y, 2 * kSamplesOfPart + pass / 2);
    sampler.SetDimension(dimensions::kFilm);
    const Point2 u = sampler.Get2D();
    const int column = std::min(static_cast<int>((static_cast<float>(x) + u.x) * grid_.pixel.x), settings_.width - 1),
              row = std::min(static_cast<int>((static_cast<float>(y) + u.y) * grid_.pixel.y), settings_.height - 1);
    sampler.StartPixelSample(x, y, pass);
    SampleContext context{scene_, sampler, Time(pass), counts};
    context.mediumTimes = &counts.media;
    context.splats = integrator.Paths() == TracedPaths::Camera ? nullptr : &splats;
    context.gather = gather;
    context.pixel = static_cast<uint32_t>(grid_.PixelOf(x, y));
    context.sample = pass;
    if (!noted.paths.empty()) context.records = &noted.paths[chunk];
    const PixelRay pixel = MakePixelRay(scene_, filter_, column, row, context.time, sampler);
    const CameraRay& ray = pixel.camera;
    Recorder* const recorder = noted.recorders.empty() ? nullptr : &noted.recorders[chunk];
    if (recorder) {
      context.observer = recorder;
      recorder->StartSample(x, y, ray.weight);
    }
    LightSpread spread;
    if (noted.spreads) context.lightSpread = &spread;
    Color bias;
    if (noted.biases) context.mergeBias = &bias;
    const bool isVignetted = ray.weight == 0;
    const Ray* start = isVignetted ? nullptr : &ray.ray;
    Color value;
    // A render traces a path that disperses once for each lane: all are counted, and the first is recorded.
    if (start || integrator.Paths() != TracedPaths::Camera)
      value = recorder || noted.values ? integrator.Sample(start, context) : SampleLanes(integrator, start, context);
    if (recorder) recorder->EndSample();
    const auto weight = static_cast<double>(ray.weight);
    if (noted.values) (*noted.values)[grid_.PixelOf(x, y)] = weight * static_cast<double>(value.Average());
    if (noted.biases) (*noted.biases)[grid_.PixelOf(x, y)] = weight * static_cast<double>(bias.Average());
    if (!noted.spreads) return;
    LightSpread& sum = (*noted.spreads)[grid_.PixelOf(x, y)];
    sum.squares += weight * weight * spread.squares;
    sum.vertices += spread.vertices;
    sum.samples += spread.samples;
  });
}

std::unique_ptr<Integrator> Make(const char* name, const RenderScene& scene, const RenderSettings& settings,
                                 double fewer, const TechniqueCounts* counts) {
  return IntegratorOf(name).create({scene, settings.width, settings.height, settings.sensor.ImagingRatio(),
                                    settings.values, counts, SplatCount(settings), fewer});
}

PhotonSettings PhotonsOfPilot(const Integrator& integrator, double fewer) {
  PhotonSettings photons = integrator.Photons().value();
  if (photons.lightPaths > 0)
    photons.lightPaths = std::max<uint64_t>(1, static_cast<uint64_t>(static_cast<double>(photons.lightPaths) / fewer));
  return photons;
}

double WiderRadius(double fewer, double alpha) {
  const double shrunk = std::pow(kTypicalPasses, alpha - 1) / alpha;
  return std::sqrt(fewer * std::min(shrunk, 1.0));
}

}  // namespace lampyr::pilot
