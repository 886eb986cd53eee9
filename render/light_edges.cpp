#include "render/light_edges.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "integrators/registry.h"
#include "integrators/walk/integrator_type.h"

namespace lampyr {

namespace {

constexpr uint64_t kProbeSeed = 0x1f83d9abfb41bd6b;
// The first samples of a pixel look for seen light, those from here on are paths.
constexpr uint32_t kFirstPath = 1 << 16;
// Rays of a pixel near an edge besides the first, and its paths.
constexpr int kMoreRays = 8, kPaths = 2;
// An edge is where neighbours differ by so many times the mean of all light that is not seen directly, or of a part of
// what is: before a bright sky, dark objects are not all edges.
constexpr float kContrast = 3;
constexpr double kPartOfSeen = 0.25;
// Pixels next to those with an edge are looked at in so many rounds: a lamp of a pixel's width, or one far out of
// focus, is missed by most first rays.
constexpr int kRounds = 3;
// So many splats around a pixel tell how much light arrives there.
constexpr int kFewestSplats = 3;
// A pixel is judged by the 3 × 3 around it; its outcome depends on pixels as far away as this.
constexpr int kReach = kRounds + 3;
// Squared number of rays for a relative variance of 1 of what a ray sees: the time of a sample of `path` over that of a
// ray, 6, over the relative variance of all other light, 0.1 to 1, of which Sobol points leave a half.
constexpr double kWorth = 8;

// Traces single rays and paths from the camera.
class Probe {
 public:
  // `integrator`: by whose weights light is seen: where light paths find a lamp's picture, its edges have little noise.
  // All other light is found by `path`.
  Probe(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings)
      : scene_(scene.isSpectral
                   ? scene.AtWavelengths(std::make_shared<const Wavelengths>(Wavelengths::OfPass(0, kProbeSeed)), {})
                   : scene),
        filter_(settings.filter),
        integrator_(integrator),
        path_(IntegratorOf("path").create(
            {scene_, settings.width, settings.height, settings.sensor.ImagingRatio(), settings.values})) {}

  // Splats of `paths` light paths that nothing has scattered; none where the camera cannot be reached, or the
  // integrator has light paths of its own.
  SplatList ArrivingDirectly(uint64_t paths, const RenderSettings& settings) const {
    SplatList splats({0, 0}, {static_cast<float>(settings.width), static_cast<float>(settings.height)},
                     SensorResponse());
    if (!scene_.camera->ConnectsLightPaths() || IntegratorOf(settings.integrator).hasTechniques) return splats;
    Settings values = settings.values;
    values.Set(common_settings::kMaxDepth.name, int64_t{0});
    const auto light =
        IntegratorOf("light").create({scene_, settings.width, settings.height, settings.sensor.ImagingRatio(), values});
    Sampler sampler(SamplerKind::Sobol, kProbeSeed);
    RenderCounts counts;
    for (uint64_t i = 0; i < paths; ++i) {
      sampler.StartPixelSample(0, -1, static_cast<uint32_t>(i));
      SampleContext context{scene_, sampler, SampleTime(scene_, sampler), counts};
      splats.StartPath();
      context.splats = &splats;
      light->Sample(nullptr, context);
    }
    return splats;
  }
  // The light that a ray sees before anything scatters it.
  float Seen(int x, int y, uint32_t index, Sampler& sampler) const { return Sample(x, y, index, true, sampler); }
  // The light that a ray through a film point sees before anything scatters it.
  double SeenAt(const Point2& film, uint32_t index, Sampler& sampler) const {
    sampler.StartPixelSample(0, -1, index);
    PixelRay ray;
    const float time = SampleTime(scene_, sampler);
    sampler.SetDimension(dimensions::kLens);
    ray.camera = scene_.camera->GenerateRay(film, sampler.Get2D(), time);
    ray.film = film;
    return static_cast<double>(Trace(ray, time, true, sampler));
  }
  // All other light, by a path.
  float Unseen(int x, int y, uint32_t index, Sampler& sampler) const {
    return Sample(x, y, kFirstPath + index, false, sampler);
  }

 private:
  float Sample(int x, int y, uint32_t index, bool isSeen, Sampler& sampler) const {
    sampler.StartPixelSample(x, y, index);
    const float time = SampleTime(scene_, sampler);
    return Trace(MakePixelRay(scene_, filter_, x, y, time, sampler), time, isSeen, sampler);
  }
  float Trace(const PixelRay& ray, float time, bool isSeen, Sampler& sampler) const {
    if (ray.camera.weight == 0) return 0;
    RenderCounts counts;
    SampleContext context{scene_, sampler, time, counts};
    context.isForSeenLight = isSeen;
    context.seenShare = isSeen ? 1.0f : 0.0f;
    context.tracesLight = false;
    context.film = ray.film;
    const Integrator& integrator = isSeen ? integrator_ : *path_;
    const Color radiance = ray.camera.weight * integrator.Sample(&ray.camera.ray, context);
    return radiance.IsValid() ? radiance.Average() : 0.0f;
  }

  RenderScene scene_;
  PixelFilter filter_;
  const Integrator& integrator_;
  std::unique_ptr<Integrator> path_;
};

// The crop, and the pixels around it that its numbers of rays depend on.
class Window {
 public:
  Window(const RenderSettings& settings, const PixelRect& crop)
      : x0_(std::max(crop.x0 - kReach, 0)),
        y0_(std::max(crop.y0 - kReach, 0)),
        width_(std::min(crop.x1 + kReach, settings.width) - x0_),
        height_(std::min(crop.y1 + kReach, settings.height) - y0_) {}

  size_t Pixels() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }
  int Height() const { return height_; }
  int Width() const { return width_; }
  int X(size_t pixel) const { return x0_ + static_cast<int>(pixel % static_cast<size_t>(width_)); }
  int Y(size_t pixel) const { return y0_ + static_cast<int>(pixel / static_cast<size_t>(width_)); }
  size_t PixelOf(int x, int y) const {
    return static_cast<size_t>(y - y0_) * static_cast<size_t>(width_) + static_cast<size_t>(x - x0_);
  }
  bool Has(int x, int y) const { return x >= x0_ && y >= y0_ && x < x0_ + width_ && y < y0_ + height_; }
  // Calls visit(pixel) for those of the 3 × 3 around `pixel` that the picture has.
  template <class Visit>
  void ForAround(size_t pixel, const Visit& visit) const {
    const int x = X(pixel) - x0_, y = Y(pixel) - y0_;
    for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height_ - 1); ++v) {
      for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width_ - 1); ++u)
        visit(static_cast<size_t>(v) * static_cast<size_t>(width_) + static_cast<size_t>(u));
    }
  }

 private:
  int x0_, y0_, width_, height_;
};

// The light of lamps at a pixel, by light paths.
struct Arriving {
  float light = 0;
  uint32_t splats = 0;
};

// The light of a pixel near an edge.
struct EdgePixel {
  double seen = 0, variance = 0;  // of a ray
  double unseen = 0;
};

class EdgeSearch {
 public:
  EdgeSearch(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
             const PixelRect& crop, int threads)
      : probe_(scene, integrator, settings),
        window_(settings, crop),
        threads_(threads),
        first_(window_.Pixels()),
        indices_(window_.Pixels(), kNotMeasured),
        arriving_(window_.Pixels()) {
    meanUnseen_ = MeanOf(settings, [this](int x, int y, Sampler& s) { return probe_.Unseen(x, y, 0, s); });
    meanSeen_ = MeanOf(settings, [this](int x, int y, Sampler& s) { return probe_.Seen(x, y, 0, s); });
    ParallelFor(window_.Height(), threads_, [this](int row) {
      Sampler sampler(SamplerKind::Sobol, kProbeSeed);
      const auto begin = static_cast<size_t>(row) * static_cast<size_t>(window_.Width());
      for (size_t i = begin; i < begin + static_cast<size_t>(window_.Width()); ++i)
        first_[i] = probe_.Seen(window_.X(i), window_.Y(i), 0, sampler);
    });
    AddArriving(settings);
  }

  // Finds the pixels near edges. False: there are none.
  bool Run() {
    for (int round = 0; round < kRounds; ++round)
      if (!Measure()) break;
    return !measured_.empty();
  }

  // Further rays of each sample of a pixel.
  int MoreRays(size_t pixel) const {
    if (indices_[pixel] == kNotMeasured) return 0;
    EdgePixel mean;
    int count = 0, all = 0, splats = 0;
    double arriving = 0;
    window_.ForAround(pixel, [&](size_t other) {
      arriving += static_cast<double>(arriving_[other].light);
      splats += static_cast<int>(arriving_[other].splats);
      ++all;
      if (indices_[other] == kNotMeasured) return;
      const EdgePixel& there = measured_[indices_[other]];
      mean.seen += there.seen;
      mean.variance += there.variance;
      mean.unseen += there.unseen;
      ++count;
    });
    double seen = mean.seen / count, variance = mean.variance / count;
    const double unseen = mean.unseen / count;
    // A lamp that fills too little of the pixels for the rays to meet it; of few splats the light is not known, as on a
    // large dim lamp.
    if (splats >= kFewestSplats && 2 * seen < arriving / all) {
      seen = arriving / all;
      variance = seen * std::max(typicalSeen_ - seen, 0.0);
    }
    // A sample sees the light or something else, which is the darker on average the more it sees of the light: with n
    // rays the covariance, -seen · unseen, is divided by n as well, and less of the noise of the one is made up for by
    // the other.
    const double gained = variance - 2 * seen * unseen;
    const double brightness = seen + unseen, ofPicture = meanSeen_ + meanUnseen_;
    const double scale = brightness * brightness + 0.01 * ofPicture * ofPicture;
    const double rays = gained > 0 && scale > 0 ? std::sqrt(kWorth * gained / scale) : 1.0;
    if (rays < 2) return 0;
    const auto more = static_cast<uint32_t>(std::min(rays, double{LightEdges::kMostRays}) - 1);
    return static_cast<int>(std::bit_floor(more));
  }
  const Window& Pixels() const { return window_; }

 private:
  static constexpr uint32_t kNotMeasured = 0xffffffff;

  bool IsEdge(float least, float largest) const {
    return static_cast<double>(largest - least) >
           static_cast<double>(kContrast) * std::max(meanUnseen_, kPartOfSeen * meanSeen_);
  }

  // The mean of a sample over pixels that are evenly distributed over the whole picture.
  template <class Sample>
  double MeanOf(const RenderSettings& settings, const Sample& sample) const {
    static constexpr int kMostOnSide = 16, kPixelsBetween = 4;
    const auto side = [](int size) { return std::clamp(size / kPixelsBetween, 1, kMostOnSide); };
    const int columns = side(settings.width), rows = side(settings.height);
    Sampler sampler(SamplerKind::Sobol, kProbeSeed);
    double sum = 0;
    for (int i = 0; i < columns * rows; ++i) {
      const auto place = [](int index, int count, int size) {
        return static_cast<int>((2 * int64_t{index} + 1) * size / (2 * int64_t{count}));
      };
      sum += static_cast<double>(
          sample(place(i % columns, columns, settings.width), place(i / columns, rows, settings.height), sampler));
    }
    return sum / (columns * rows);
  }

  float SeenAt(size_t pixel) const {
    return indices_[pixel] == kNotMeasured ? first_[pixel] : static_cast<float>(measured_[indices_[pixel]].seen);
  }

  // Looks for lamps by light paths: first rays miss those that fill a small part of a pixel, or are far out of focus.
  void AddArriving(const RenderSettings& settings) {
    constexpr uint64_t kMostLightPaths = 1 << 14;
    const uint64_t pixels = static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
    const SplatList splats = probe_.ArrivingDirectly(std::min(pixels, kMostLightPaths), settings);
    for (const Splat& splat : splats.Splats()) {
      const int x = static_cast<int>(splat.film.x), y = static_cast<int>(splat.film.y);
      if (!window_.Has(x, y)) continue;
      Arriving& here = arriving_[window_.PixelOf(x, y)];
      here.light += splat.value.Average() / static_cast<float>(splats.Paths());
      ++here.splats;
    }
    // The typical brightness of a lamp: by rays through some of these points, over the whole film whatever the crop.
    constexpr size_t kTypicalRays = 256;
    const size_t step = std::max<size_t>(splats.Splats().size() / kTypicalRays, 1);
    Sampler sampler(SamplerKind::Sobol, kProbeSeed);
    double sum = 0, squares = 0;
    for (size_t i = 0; i < splats.Splats().size(); i += step) {
      const double seen = probe_.SeenAt(splats.Splats()[i].film, static_cast<uint32_t>(i), sampler);
      sum += seen;
      squares += seen * seen;
    }
    if (sum > 0) typicalSeen_ = squares / sum;
  }

  // Measures the pixels next to edges that have not been measured. False: there are none.
  bool Measure() {
    std::vector<size_t> found;
    for (size_t i = 0; i < window_.Pixels(); ++i) {
      if (indices_[i] != kNotMeasured) continue;
      float least = first_[i], largest = least;
      bool isNextToEdge = false, isLit = false;
      window_.ForAround(i, [&](size_t other) {
        const float seen = SeenAt(other);
        least = std::min(least, seen);
        largest = std::max(largest, seen);
        isLit = isLit || arriving_[other].splats > 0;
        isNextToEdge = isNextToEdge || (indices_[other] != kNotMeasured && measured_[indices_[other]].variance > 0);
      });
      // Light paths say that a lamp is there, and a first ray has missed it.
      const bool mayBeEdge = isLit && static_cast<double>(least) <= 0.5 * typicalSeen_;
      if (isNextToEdge || mayBeEdge || IsEdge(least, largest)) found.push_back(i);
    }
    const size_t before = measured_.size();
    measured_.resize(before + found.size());
    constexpr size_t kTogether = 64;
    ParallelFor(static_cast<int>((found.size() + kTogether - 1) / kTogether), threads_, [&](int chunk) {
      Sampler sampler(SamplerKind::Sobol, kProbeSeed);
      const size_t begin = static_cast<size_t>(chunk) * kTogether;
      for (size_t i = begin; i < std::min(begin + kTogether, found.size()); ++i)
        measured_[before + i] = Measured(found[i], sampler);
    });
    for (size_t i = 0; i < found.size(); ++i) indices_[found[i]] = static_cast<uint32_t>(before + i);
    return !found.empty();
  }

  EdgePixel Measured(size_t pixel, Sampler& sampler) const {
    const int x = window_.X(pixel), y = window_.Y(pixel);
    double sum = static_cast<double>(first_[pixel]), squares = sum * sum;
    EdgePixel edge;
    for (int i = 1; i <= kMoreRays; ++i) {
      const auto seen = static_cast<double>(probe_.Seen(x, y, static_cast<uint32_t>(i), sampler));
      sum += seen;
      squares += seen * seen;
    }
    for (int i = 0; i < kPaths; ++i)
      edge.unseen += static_cast<double>(probe_.Unseen(x, y, static_cast<uint32_t>(i), sampler)) / kPaths;
    constexpr double kRays = kMoreRays + 1;
    edge.seen = sum / kRays;
    edge.variance = std::max((squares - sum * edge.seen) / kMoreRays, 0.0);
    return edge;
  }

  Probe probe_;
  Window window_;
  int threads_;
  double meanUnseen_ = 0, meanSeen_ = 0;
  double typicalSeen_ = 0;          // what a ray sees that sees a lamp: the mean of that, weighted by itself
  std::vector<float> first_;        // of each pixel: what its first ray has seen
  std::vector<uint32_t> indices_;   // of each pixel: in `measured_`
  std::vector<Arriving> arriving_;  // of each pixel
  std::vector<EdgePixel> measured_;
};

}  // namespace

std::unique_ptr<const LightEdges> LightEdges::Find(const RenderScene& scene, const Integrator& integrator,
                                                   const RenderSettings& settings, const PixelRect& crop, int threads) {
  if (!integrator.SeparatesSeenLight()) return nullptr;
  if (!settings.SamplesLightEdges()) return nullptr;
  if (!scene.lighting->HasLightThatCanBeHit() && scene.lighting->InfiniteCount() == 0) return nullptr;
  EdgeSearch search(scene, integrator, settings, crop, threads);
  if (!search.Run()) return nullptr;
  std::vector<uint8_t> rays;
  rays.reserve(static_cast<size_t>(crop.Width()) * static_cast<size_t>(crop.Height()));
  for (int y = crop.y0; y < crop.y1; ++y) {
    for (int x = crop.x0; x < crop.x1; ++x)
      rays.push_back(static_cast<uint8_t>(1 + search.MoreRays(search.Pixels().PixelOf(x, y))));
  }
  if (*std::max_element(rays.begin(), rays.end()) == 1) return nullptr;
  return std::unique_ptr<const LightEdges>(new LightEdges(crop, std::move(rays)));
}

namespace {

constexpr uint64_t kFurtherRays = 0x510e527fade682d1;  // changes the seed for further rays

}  // namespace

EdgeSampler::EdgeSampler(const Pass& pass, bool sharesTime)
    : pass_(pass),
      sharesTime_(sharesTime),
      sampler_(pass.settings.sampler, MixBits(pass.Seed() + kFurtherRays)),
      otherHalf_(pass.settings.sampler, MixBits(pass.Seed() + kFurtherRays + kOtherHalf)) {}

Color EdgeSampler::RadianceOfMany(int x, int y, uint64_t number, int rays, SampleContext& context, PixelRay& ray) {
  const float share = 1.0f / static_cast<float>(rays);
  context.seenShare = share;
  Color radiance = TestedRadiance(pass_.integrator, ray, context);
  // The two halves of the samples of an adaptive film have sequences of their own (AdaptiveSampler).
  const bool hasHalves = pass_.allocation && pass_.film.HasHalf();
  Sampler& sampler = hasHalves && !AdaptiveSampler::IsInHalf(number) ? otherHalf_ : sampler_;
  const auto more = static_cast<uint64_t>(rays - 1), first = (hasHalves ? number / 2 : number) * more;
  for (uint64_t i = first; i < first + more; ++i) {
    sampler.StartPixelSample(x, y, static_cast<uint32_t>(i));
    const float time = sharesTime_ ? context.time : SampleTime(pass_.scene, sampler);
    const PixelRay further = MakePixelRay(pass_.scene, pass_.filter, x, y, time, sampler);
    if (further.camera.weight == 0) continue;
    if (ray.camera.weight == 0) ray.camera.weight = 1;
    SampleContext seen{pass_.scene, sampler, time, context.counts, context.layers};
    seen.outputs = context.outputs;
    seen.observer = context.observer;
    seen.gather = context.gather;
    seen.film = further.film;
    seen.lane = context.lane;
    seen.tracesLight = false;
    seen.isForSeenLight = true;
    seen.seenShare = share * (further.camera.weight / ray.camera.weight);
    radiance += pass_.integrator.Sample(&further.camera.ray, seen);
  }
  return radiance;
}

}  // namespace lampyr
