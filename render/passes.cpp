#include "render/passes.h"

#include <algorithm>
#include <vector>

#include "base/parallel.h"
#include "render/both_paths.h"
#include "render/light_edges.h"
#include "render/pass.h"

namespace lampyr {

namespace {

constexpr int kTileSize = 16;
constexpr int kLightPaths = -1;  // in the place of the pixel row, for samples that belong to no pixel

// Adds the samples of the passes to the pixel of index `pixel` in the crop.
void TraceAdaptively(const Pass& pass, int x, int y, size_t pixel, AdaptiveSampler& samplers, EdgeSampler& edges,
                     SampleAdder& adder, PathRecords* records, TestedSamples* tested, RenderCounts& counts) {
  PixelSums sums = pass.film.Pixel(x, y);
  uint32_t count = 0;
  for (uint32_t i = pass.first; i < pass.end; ++i) count += pass.allocation->Count(pixel, i - pass.Offset());
  for (uint32_t k = 0; k < count; ++k) {
    const uint64_t number = sums.count;
    Sampler& sampler = samplers.Start(x, y, number);
    const float time = SampleTime(pass.scene, sampler);
    PixelRay ray = MakePixelRay(pass.scene, pass.filter, x, y, time, sampler);
    SampleContext context{pass.scene, sampler, time, counts, adder.StartLayers()};
    context.outputs = pass.Outputs();
    context.lane = pass.FirstLaneOf(x, y, number);
    pass.Record(x, y, number, records, tested, context);
    const Color radiance = edges.Radiance(x, y, number, context, ray);
    adder.Add(x, y, AdaptiveSampler::IsInHalf(number), ray, radiance, sums);
  }
  pass.film.Pixel(x, y) = sums;
}

RenderCounts TraceCameraPaths(const Pass& pass) {
  const PixelRect& crop = pass.film.Crop();
  const int tilesX = (crop.Width() + kTileSize - 1) / kTileSize;
  const int tilesY = (crop.Height() + kTileSize - 1) / kTileSize;
  std::vector<RenderCounts> tileCounts(static_cast<size_t>(tilesX) * tilesY);
  std::vector<PathRecords> tileRecords = pass.MakeRecords(tileCounts.size());
  std::vector<TestedSamples> tileTested = pass.MakeTested(tileCounts.size());
  ParallelFor(tilesX * tilesY, pass.threads, [&](int tile) {
    const int x0 = crop.x0 + tile % tilesX * kTileSize, x1 = std::min(x0 + kTileSize, crop.x1);
    const int y0 = crop.y0 + tile / tilesX * kTileSize, y1 = std::min(y0 + kTileSize, crop.y1);
    Sampler sampler(pass.settings.sampler, pass.settings.seed);
    RenderCounts counts;
    SampleAdder adder(pass.settings, pass.film, counts);
    AdaptiveSampler samplers(pass);
    EdgeSampler edges(pass, false);
    PathRecords* records = pass.learning ? &tileRecords[tile] : nullptr;
    TestedSamples* tested = pass.selection ? &tileTested[tile] : nullptr;
    for (int y = y0; y < y1; ++y) {
      for (int x = x0; x < x1; ++x) {
        if (pass.allocation) {
          const auto pixel =
              static_cast<size_t>(y - crop.y0) * static_cast<size_t>(crop.Width()) + static_cast<size_t>(x - crop.x0);
          TraceAdaptively(pass, x, y, pixel, samplers, edges, adder, records, tested, counts);
          continue;
        }
        PixelSums sums = pass.film.Pixel(x, y);
        for (uint32_t i = pass.first; i < pass.end; ++i) {
          sampler.StartPixelSample(x, y, i);
          const float time = SampleTime(pass.scene, sampler);
          PixelRay ray = MakePixelRay(pass.scene, pass.filter, x, y, time, sampler);
          SampleContext context{pass.scene, sampler, time, counts, adder.StartLayers()};
          context.outputs = pass.Outputs();
          context.lane = pass.FirstLaneOf(x, y, i);
          pass.Record(x, y, i, records, tested, context);
          const Color radiance = edges.Radiance(x, y, i, context, ray);
          adder.Add(x, y, IsInHalf(i), ray, radiance, sums);
        }
        pass.film.Pixel(x, y) = sums;
      }
    }
    tileCounts[tile] = counts;
  });
  if (pass.learning) pass.learning->Learn(tileRecords);
  if (pass.selection) pass.selection->Learn(tileTested);
  return Total(tileCounts);
}

RenderCounts TraceLightPaths(const Pass& pass) {
  const uint64_t end = pass.end * pass.Pixels();
  // A fixed number of chunks at a time, enough to keep all threads busy, bounds the memory of the splats. The film adds
  // paths in their order, so the result does not depend on the division into chunks.
  const int chunks = 4 * std::max(pass.threads, 1);
  std::vector<SplatList> lists(static_cast<size_t>(chunks), pass.film.MakeSplatList(pass.filter, pass.settings.sensor));
  std::vector<RenderCounts> counts(static_cast<size_t>(chunks));
  for (uint64_t round = pass.first * pass.Pixels(), roundEnd = 0; round < end; round = roundEnd) {
    const uint64_t sample = round / pass.Pixels();
    // The splats of a round belong to the layer of half of the samples, or none of them does.
    const uint64_t together = pass.film.HasHalf() ? (sample + 1) * pass.Pixels() : end;
    roundEnd = std::min(round + static_cast<uint64_t>(chunks) * kChunkPaths, together);
    ParallelFor(chunks, pass.threads, [&](int chunk) {
      SplatList& splats = lists[static_cast<size_t>(chunk)];
      splats.Clear();
      Sampler sampler(pass.settings.sampler, pass.settings.seed);
      const uint64_t begin = round + static_cast<uint64_t>(chunk) * kChunkPaths;
      for (uint64_t i = begin; i < std::min(begin + kChunkPaths, roundEnd); ++i) {
        sampler.StartPixelSample(static_cast<int>(i >> 32), kLightPaths, static_cast<uint32_t>(i));
        splats.StartPath();
        SampleContext context{pass.scene, sampler, SampleTime(pass.scene, sampler), counts[static_cast<size_t>(chunk)]};
        context.splats = &splats;
        context.outputs = pass.Outputs();
        if (pass.scene.isSpectral) context.lane = FirstLane(pass.Seed(), i, 0);
        SampleLanes(pass.integrator, nullptr, context);
      }
    });
    pass.film.AddSplats(pass.filter, lists, pass.threads, static_cast<uint32_t>(sample));
  }
  return Total(counts);
}

RenderCounts TracePass(const Pass& pass, PhotonStore* kept) {
  switch (pass.integrator.Paths()) {
    case TracedPaths::Camera:
      return TraceCameraPaths(pass);
    case TracedPaths::Light:
      return TraceLightPaths(pass);
    case TracedPaths::Both:
      break;
  }
  return TraceBothPaths(pass, kept);
}

LanesInBands InBands(const Wavelengths& wavelengths, const SpectralBands& bands) {
  LanesInBands lanes;
  for (int lane = 0; lane < Wavelengths::kLanes; ++lane) {
    lanes.band[lane] = bands.Of(wavelengths[lane]);
    lanes.weight[lane] = wavelengths.PerDensity(lane) / bands.Width();
    lanes.radiance[lane] = static_cast<float>(lanes.weight[lane] * WhiteSpectrum(wavelengths[lane]));
  }
  return lanes;
}

}  // namespace

RenderCounts RenderPass(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                        const PixelFilter& filter, uint32_t first, uint32_t count, int threads, Film& film,
                        PhotonStore* kept, const SampleAllocation* allocation, PathLearning* learning,
                        SelectionTest* selection, const LightEdges* edges) {
  if (!scene.isSpectral) {
    const Pass pass{scene,   integrator, settings,   filter,   first,     first + count,
                    threads, film,       allocation, learning, selection, edges};
    return TracePass(pass, kept);
  }
  RenderCounts counts;
  RenderSettings tuned = settings;
  const bool sharesTime = scene.hasMotion && integrator.Photons();
  std::optional<WavelengthRange> even;
  if (settings.bands) even = {settings.bands->from, settings.bands->to};
  for (uint32_t sample = first; sample < first + count; ++sample) {
    const auto wavelengths = std::make_shared<const Wavelengths>(
        sharesTime ? Wavelengths(static_cast<double>(SharedByPass(settings.seed, allocation, sample).wavelengths), even)
                   : Wavelengths::OfPass(settings.seed, sample, even));
    if (film.HasBands()) film.SetLanes(InBands(*wavelengths, *settings.bands));
    const RenderScene there = scene.AtWavelengths(wavelengths, integrator.MaterialsAfterWide());
    tuned.sensor = settings.sensor.Of(wavelengths->ToRgb());
    const Pass pass{there,   integrator, tuned,      filter,   sample,    sample + 1,
                    threads, film,       allocation, learning, selection, edges};
    counts += TracePass(pass, kept);
    film.CountWhite(wavelengths->White());
  }
  return counts;
}

}  // namespace lampyr
