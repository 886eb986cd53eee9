#include "render/analysis/pilot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

#include "integrators/guide/path_learning.h"
#include "integrators/photon/emission_learning.h"
#include "render/analysis/candidate_masks.h"
#include "render/analysis/pilot_passes.h"
#include "render/analysis/sppm_candidate.h"
#include "render/settings/integrator_choice.h"
#include "spectral/wavelengths.h"

namespace lampyr {

using namespace pilot;

namespace {

// Longer paths hold little of the light, and without a limit a closed box of mirrors would keep the pilot for hours.
constexpr int64_t kMostEvents = 20;
// Counted time of all passes in nanoseconds, as if their samples were those of bdpt with one light path for each. The
// passes take about three times as long, because they record what they find.
constexpr double kPassesTime = 80e6;
constexpr int kFewestPasses = 4;
// Passes end where the standard error of the best candidate's error is no larger than this part of it.
constexpr double kWellKnown = 0.05;
// Passes of which guides and the roulette of camera paths are learned, fewer if they take so many rays, but as many as
// it takes to make a guide and to test it. Their samples are none of the recorded ones.
constexpr uint32_t kLearningPasses = 4, kFirstLearningPass = 256;
constexpr uint32_t kPassesOfGuide = 2;  // of which a guide is made, to be tested on the others
constexpr uint64_t kLearningRays = 200000;
// Lights that are chosen at a vertex at most; the pilot decides between them and one.
constexpr int kSeveralLights = 2;

// Passes for which there is time: the rarer the light, the more of them it takes to know how noisy an integrator is
// that finds it by chance. Even.
int PassesFor(const Counted& counted, int pixels) {
  const double cost = CostsOf(counted, pixels)[kBdpt].paths;
  const double pairs = std::clamp(kPassesTime / (2 * cost * pixels), kFewestPasses / 2.0, kMostPasses / 2.0);
  return 2 * static_cast<int>(pairs);
}

// The light paths of the pilot are not guided. If those of the render will be, errors are corrected by a typical
// factor. A guide is used if it halves the squared noise of photons (emission_learning.h); noise of other techniques
// remains. Measured over unguided vcm at 160×90: 0.42 to 0.54 in scenes/ring, pool and mirror and in a room with a
// window pane, 0.9 in scenes/spot-lens, most of whose noise is not of photons.
void GuideLightPaths(std::span<PilotCandidate> all) {
  constexpr double kNoise = 0.55;
  for (size_t k = 0; k < all.size(); ++k) {
    if (!Merges(k)) continue;
    PilotCandidate& candidate = all[k];
    candidate.error *= kNoise;
    candidate.uncertainty *= kNoise;
    for (double& error : candidate.tileErrors) error *= kNoise;
    for (double& variance : candidate.tileVariances) variance *= kNoise * kNoise;
  }
}

// The settings with all techniques, for the pilot.
RenderSettings WithAllTechniques(const RenderSettings& settings) {
  RenderSettings all = settings;
  all.integrator = "vcm";
  all.values.Set("merge", true);
  all.values.Set("connect", true);
  all.values.Set("max-depth", std::min<int64_t>(all.values.Integer("max-depth"), kMostEvents));
  return all;
}

// Counts with which all camera paths may end early.
TechniqueCounts Ending() {
  TechniqueCounts counts;
  counts.continuing = FilmMask(1, 1, Point2(1.0f), {static_cast<float>(kContinuing)});
  return counts;
}

std::vector<PilotCandidate> CandidatesWith(std::span<const CandidateCost> costs) {
  std::vector<PilotCandidate> candidates(kCandidates);
  for (size_t k = 0; k < kCandidates; ++k) {
    if (k >= kWholeCandidates) candidates[k].counts = Ending();
    candidates[k].integrator = kCandidateOf[k].integrator;
    candidates[k].counts.log2LightPaths = kCandidateOf[k].log2LightPaths;
    candidates[k].counts.startsWide = kCandidateOf[k].startsWide;
    candidates[k].cost = costs[k].paths + costs[k].merging;
  }
  return candidates;
}

// The integrators of the pilot; those that end have camera paths that may end early.
struct PilotIntegrators {
  std::unique_ptr<Integrator> path, bdpt, vcm, endingBdpt, endingVcm;

  PilotIntegrators(const RenderScene& scene, const RenderSettings& settings, double fewer) {
    const TechniqueCounts ending = Ending();
    path = Make("path", scene, settings, fewer);
    bdpt = Make("bdpt", scene, settings, fewer);
    vcm = Make("vcm", scene, settings, fewer);
    endingBdpt = Make("bdpt", scene, settings, fewer, &ending);
    endingVcm = Make("vcm", scene, settings, fewer, &ending);
  }
};

// The scene as passes see it: with the wavelengths of one of them.
RenderScene WithWavelengths(const RenderScene& scene) {
  return scene.isSpectral ? scene.AtWavelengths(std::make_shared<const Wavelengths>(Wavelengths::OfPass(0, kSeed)), {})
                          : scene;
}

// Sets what a render learns from its camera paths: their guide, if `mayGuide`, and their Russian roulette. Both change
// the error and the cost of integrators, those of path most. `combined`: the settings with all techniques.
void LearnPaths(const PilotIntegrators& integrators, const RenderSettings& combined, const Grid& grid, int threads,
                bool mayGuide, RenderScene& view) {
  if (!combined.GuidesPaths()) return;
  PathLearning learning(grid.width, grid.height, static_cast<size_t>(grid.Pixels()), true,
                        combined.AlwaysGuidesPaths());
  uint64_t rays = 0;
  for (uint32_t pass = 0; pass < kLearningPasses && (pass <= kPassesOfGuide || rays < kLearningRays); ++pass) {
    std::vector<PathRecords> records(kChunks);
    PilotPasses passes(view, combined, grid, threads);
    const PassCounts counts =
        passes.Trace(*integrators.bdpt, kFirstLearningPass + pass, nullptr, {.paths = std::span(records)});
    rays += counts.cameraRays + counts.indirectRays + counts.shadowRays;
    learning.Learn(records);
    if (pass + 1 != kPassesOfGuide) continue;
    learning.Decide(pass + 1, threads, mayGuide);
    view.roulette = learning.Roulette();
  }
  learning.Decide(PathLearning::kLastMilestone, threads, mayGuide);
  view.guide = learning.Guide();
  view.roulette = learning.Roulette();
}

// LightSpread of each integrator, by pixel: sums over the samples of a pixel.
struct Spreads {
  std::vector<LightSpread> path, bdpt, vcm, endingBdpt, endingVcm;
  // Samples of a pixel of `path`, `bdpt` and `endingBdpt`: one, and more of small pictures. Of `endingVcm` there is
  // one.
  uint32_t counting;

  explicit Spreads(int pixels)
      : path(static_cast<size_t>(pixels)),
        bdpt(path),
        vcm(path),
        endingBdpt(path),
        endingVcm(path),
        counting(static_cast<uint32_t>(std::clamp(kMostPilotPixels / pixels, 1, kMostPasses))) {}
};

// `spreads`: null: not wanted.
void CountPaths(const PilotIntegrators& integrators, const RenderScene& scene, const RenderSettings& settings,
                const Grid& grid, int threads, Counted& counted, Spreads* spreads) {
  PilotPasses passes(scene, settings, grid, threads);
  counted.path = passes.Trace(*integrators.path, 0, nullptr, {.spreads = spreads ? &spreads->path : nullptr});
  counted.bdpt = passes.Trace(*integrators.bdpt, 0, nullptr, {.spreads = spreads ? &spreads->bdpt : nullptr});
  counted.endingBdpt =
      passes.Trace(*integrators.endingBdpt, 0, nullptr, {.spreads = spreads ? &spreads->endingBdpt : nullptr});
  for (uint32_t pass = 1; spreads && pass < spreads->counting; ++pass) {
    passes.Trace(*integrators.path, pass, nullptr, {.spreads = &spreads->path});
    passes.Trace(*integrators.bdpt, pass, nullptr, {.spreads = &spreads->bdpt});
    passes.Trace(*integrators.endingBdpt, pass, nullptr, {.spreads = &spreads->endingBdpt});
  }
}

// Inputs and results of the recorded passes of a pilot.
struct Passes {
  const PilotIntegrators& integrators;
  PilotPasses& tracer;
  PhotonStore& store;
  EmissionLearning* learned;  // from the photons; null: nothing learns
  double wider;               // WiderRadius
  int threads;
  Records& records;
  Counted counted;  // by a pass
  Spreads spreads;

  void TraceOne(uint32_t pass, Counted& sum);
};

// Traces a pass and adds its counts to `sum`.
void Passes::TraceOne(uint32_t pass, Counted& sum) {
  tracer.TracePhotons(*integrators.vcm, store, pass);
  const PhotonPass& gather = store.Open(pass, threads, wider);
  sum.stored += gather.map->Size();
  sum.vcm += tracer.Trace(*integrators.vcm, pass, &gather, {.recorders = records.Recorders(), .spreads = &spreads.vcm});
  if (pass == 0) {
    PhotonPass unrecorded = gather;  // photons are learned from once
    unrecorded.use = nullptr;
    sum.endingVcm = tracer.Trace(*integrators.endingVcm, pass, &unrecorded, {.spreads = &spreads.endingVcm});
  }
  records.EndPass(pass);
  store.EndGathering();
  if (learned && learned->IsRecording() && std::has_single_bit(pass + 1)) learned->Decide(pass + 1);
}

// Traces the recorded passes and sums their counts. `isEnough`: called after `first` passes and each doubling, with
// their number and the counts of a pass. Returns the number of passes.
int RunPasses(int first, int most, const std::function<bool(int, const Counted&)>& isEnough, Passes& passes) {
  const auto ofOne = [](Counted sum, int count) {
    const auto n = static_cast<uint64_t>(count);
    sum.stored /= n;
    sum.vcm.lookups /= n;
    sum.vcm.foundPhotons /= n;
    return sum;
  };
  Counted sum = passes.counted;
  int traced = 0;
  for (int end = first; traced < most; end = std::min(2 * end, most)) {
    for (; traced < end; ++traced) passes.TraceOne(static_cast<uint32_t>(traced), sum);
    passes.counted = ofOne(sum, traced);
    if (traced < most && isEnough(traced, passes.counted)) break;
  }
  return traced;
}

// True if the error of the best candidate is known well enough.
bool IsWellKnown(const std::vector<PilotCandidate>& all) {
  const RenderPilot pilot{{all.begin(), all.begin() + kWholeCandidates}, {}};
  const PilotCandidate* const best = pilot.Best();
  return best && best->uncertainty <= kWellKnown * best->error;
}

// Sets the costs of candidates that merge to those with guided light paths: more of their vertices are seen. What they
// do is counted in a pass of their own. `scene`: with the guide. `counted`: without it.
void CountGuided(const PilotIntegrators& integrators, const PhotonSettings& photons, double wider, int threads,
                 const RenderScene& scene, const RenderSettings& settings, const Grid& grid, Counted counted,
                 std::span<CandidateCost> costs) {
  const RenderScene view = WithWavelengths(scene);
  PilotPasses guided(view, settings, grid, threads);
  PhotonStore store(photons, static_cast<uint64_t>(grid.Pixels()), nullptr);
  guided.TracePhotons(*integrators.vcm, store, 0);
  const PhotonPass& gather = store.Open(0, threads, wider);
  counted.stored = gather.map->Size();
  counted.bdpt = counted.vcm = guided.Trace(*integrators.vcm, 0, &gather);
  counted.endingBdpt = counted.endingVcm = guided.Trace(*integrators.endingVcm, 0, &gather);
  store.EndGathering();
  const auto ofGuided = CostsOf(counted, grid.Pixels());
  for (size_t k = 0; k < kCandidates; ++k)
    if (Merges(k)) costs[k] = ofGuided[k];
}

// Factor on the cost of integrators with guided light paths, for the density of the guide at every emission that is
// weighted, which no count includes. Samples of vcm take 1.10 to 1.26 times the counted time in scenes/pool and mirror
// and a room with a window pane (160×90); samples of vcm and sppm take 1.26 to 1.55 times in a pool seen from above and
// a glass of wine, with a guide from the start.
constexpr double kDensities = 1.25;
// Factor on the cost of integrators with guided camera paths, for the densities of the guides at every vertex. Samples
// of path and bdpt take 1.31 and 1.35 times the counted time in scenes/door, over that without guides (160×90, 320 and
// 128 samples).
constexpr double kGuidedPaths = 1.3;

// Factors of guides on the costs of candidates.
struct GuideCosts {
  double ofMerging;  // of light paths, for candidates that merge
  double ofPaths;    // of camera paths

  double Of(size_t candidate) const { return Merges(candidate) ? ofPaths * ofMerging : ofPaths; }
  void Apply(std::span<CandidateCost> costs) const {
    for (size_t k = 0; k < costs.size(); ++k) costs[k] = {Of(k) * costs[k].paths, Of(k) * costs[k].merging};
  }
};

// Adds candidates that decide by the place in the picture whether they merge and whether their camera paths may end
// early. `all`: by their index.
void AddMixed(std::span<const PilotCandidate> all, std::span<const CandidateCost> costs, const Grid& grid, double least,
              std::vector<PilotCandidate>& candidates) {
  const auto pathsOf = [&](size_t k) {
    return Merges(k) ? CameraPaths{&all[WithoutMerging(k)], &all[k], costs[k]}
                     : CameraPaths{&all[k], nullptr, costs[k]};
  };
  for (size_t k = 1; k < kWholeCandidates; ++k) {
    std::vector<CameraPaths> options{pathsOf(k)};
    if (EndingOf(k) < kCandidates) options.push_back(pathsOf(EndingOf(k)));
    if (auto mixed = InParts(options, grid, least)) candidates.push_back(std::move(*mixed));
  }
}

// Counts of the same passes with one light at a vertex instead of several.
Counted WithOneLight(const Counted& counted, const std::vector<LightSpread>& path) {
  uint64_t samples = 0, vertices = 0;
  for (const LightSpread& spread : path) {
    samples += spread.samples;
    vertices += spread.vertices;
  }
  if (samples == 0) return counted;
  // Not every sample of a light has a shadow ray.
  const double direct = counted.path.DirectRays(),
               fewer = direct * (1 - static_cast<double>(vertices) / static_cast<double>(samples));
  const double shorter = std::clamp(RaysOf(counted.bdpt) - RaysOf(counted.endingBdpt), 0.0, RaysOf(counted.path));
  const double media = direct > 0 ? counted.path.media.connections / direct : 0.0;
  const auto take = [media](PassCounts& counts, double shadowRays) {
    counts.shadowRays -= std::min(counts.shadowRays, static_cast<uint64_t>(shadowRays));
    counts.media.connections = std::max(counts.media.connections - media * shadowRays, 0.0);
  };
  Counted one = counted;
  take(one.path, fewer);
  take(one.bdpt, fewer);
  take(one.endingBdpt, fewer * (1 - shorter / RaysOf(counted.path)));
  return one;
}

// Squared error of independent samples over that of Sobol points, for the choice of a light. One dimension makes it,
// the same for all samples of a pixel, and gains more than others do: with half of the difference between one light and
// two by what Sobol points gain on average, 16 to 64 samples of scenes/gallery, lights-1000 and rooms have a fifth of
// it, and those of stage nearly all.
constexpr double kGainOfSelection = 6;

// Errors of candidates with one light at a vertex minus those with several: by tile, as PilotCandidate::tileErrors, but
// of independent samples.
struct ErrorsOfOneLight {
  std::vector<double> path, bdpt, vcm, endingBdpt, endingVcm;

  // `passes`: number of recorded passes.
  ErrorsOfOneLight(const Spreads& spreads, const Records& records, int passes) {
    const auto of = [&records](const std::vector<LightSpread>& spread, uint32_t samples) {
      std::vector<double> squares;
      for (const LightSpread& pixel : spread) squares.push_back(pixel.squares / samples);
      return records.RelativeErrors(squares);
    };
    path = of(spreads.path, spreads.counting);
    bdpt = of(spreads.bdpt, spreads.counting);
    vcm = of(spreads.vcm, static_cast<uint32_t>(passes));
    endingBdpt = of(spreads.endingBdpt, spreads.counting);
    endingVcm = of(spreads.endingVcm, 1);
  }
  // Adds it to the candidate, of whose camera paths the part `ends` may end early. `gain`: of the points of the
  // sampler.
  void AddTo(PilotCandidate& candidate, double ends, double gain) const {
    const bool isPath = candidate.integrator == "path", merges = candidate.integrator == "vcm";
    const std::vector<double>& whole = isPath ? path : merges ? vcm : bdpt;
    const std::vector<double>& ending = isPath ? path : merges ? endingVcm : endingBdpt;
    for (size_t tile = 0; tile < whole.size(); ++tile) {
      const double error = std::lerp(whole[tile], ending[tile], ends) / gain;
      candidate.tileErrors[tile] += error;
      candidate.error += error;
    }
  }
};

// Converts the candidates from several lights at a vertex to one, and adds again those with several that have less
// error in equal time than any with one. `ofGuide`: factor of the guide on the costs of candidates that merge.
void ChooseLightSamples(const Counted& counted, const Spreads& spreads, const Records& records, int pixels, int passes,
                        bool isSobol, const GuideCosts& ofGuides, RenderPilot& pilot) {
  const ErrorsOfOneLight errors(spreads, records, passes);
  const auto several = CostsOf(counted, pixels), one = CostsOf(WithOneLight(counted, spreads.path), pixels);
  const std::vector<PilotCandidate> before = pilot.candidates;
  for (std::vector<PilotCandidate>* candidates : {&pilot.candidates, &pilot.ending}) {
    for (PilotCandidate& candidate : *candidates) {
      const TechniqueCounts& counts = candidate.counts;
      const double ends = (1 - counts.continuing.Mean()) / (1 - kContinuing);
      errors.AddTo(candidate, ends, isSobol ? kGainOfSelection : 1.0);
      const size_t whole =
          candidate.integrator == "path" ? 0 : Find(candidate.integrator == "vcm", counts.log2LightPaths, false, 1);
      const size_t ending = EndingOf(whole) < kCandidates ? EndingOf(whole) : whole;
      candidate.cost -= ofGuides.Of(whole) * std::lerp(several[whole].paths - one[whole].paths,
                                                       several[ending].paths - one[ending].paths, ends);
    }
  }
  const PilotCandidate* const best = pilot.Best();
  if (!best) return;
  std::vector<PilotCandidate> better;
  constexpr double kWorthIt = 0.97;
  for (const PilotCandidate& candidate : before) {
    if (candidate.missing <= kNegligibleLight && candidate.MostErrorTimesCost() < kWorthIt * best->MostErrorTimesCost())
      better.push_back(candidate);
  }
  for (PilotCandidate& candidate : better) {
    candidate.counts.lightSamples = kSeveralLights;
    pilot.candidates.push_back(std::move(candidate));
  }
}

// True if it is to be decided how many lights are chosen at a vertex. Where lights have counts of their own, those are
// what the scene wants.
bool ChoosesLights(const RenderScene& scene, const RenderSettings& settings) {
  const auto& lights = scene.lighting->Lights();
  return settings.values.Integer(common_settings::kLightSamples.name) == 0 &&
         std::none_of(lights.begin(), lights.end(),
                      [](const PlacedLight& placed) { return placed.light->Settings().fixedSampleCount > 0; });
}

// Adds sppm, with the lights that the scene selects and the guide of light paths that the render will have; null: none.
void AddSppm(const RenderScene& scene, const EmissionGuide* guide, const RenderSettings& settings, const Grid& grid,
             const Records& records, int passCount, int threads, RenderPilot& pilot) {
  RenderScene view = scene;
  if (guide) view.lighting = std::make_shared<const LightingServices>(scene.lighting->With(nullptr, guide));
  auto sppm = SppmCandidate(view, WithWavelengths(view), settings, grid, records, pilot.Best(), passCount, threads);
  if (!sppm) return;
  if (guide) sppm->cost *= kDensities;
  pilot.candidates.push_back(std::move(*sppm));
}

// Erases the candidates that the settings exclude. `isGuided`: light paths need a guide from the start, which bdpt does
// not have.
void EraseUnwanted(const RenderSettings& settings, bool isGuided, std::vector<PilotCandidate>& candidates) {
  const bool hasAll = settings.values.IsOn("merge") && settings.values.IsOn("connect");
  // Light paths that are guided, or as many as the settings say, are those of vcm.
  const bool hasOwnPaths = settings.values.Integer("photons") >= 0;
  const bool hasOwnRadius = settings.values.Number("radius") > 0;
  // Pixels take turns; of a few pixels some passes would have no light path.
  const bool isTiny = std::max(settings.width, settings.height) < static_cast<int>(1 / kFewestLightPaths);
  std::erase_if(candidates, [&](const PilotCandidate& candidate) {
    return (isTiny && candidate.counts.log2LightPaths < 0) || (isGuided && candidate.integrator == "bdpt") ||
           (!hasAll && candidate.integrator == "vcm") || (hasOwnRadius && candidate.counts.startsWide) ||
           (hasOwnPaths && candidate.integrator == "vcm" && candidate.counts.log2LightPaths != 0);
  });
}

}  // namespace

const PilotCandidate* RenderPilot::Find(const std::string& integrator, int log2LightPaths) const {
  for (const PilotCandidate& candidate : candidates) {
    if (candidate.integrator == integrator && candidate.counts.log2LightPaths == log2LightPaths &&
        !candidate.counts.HasMasks() && !candidate.counts.startsWide && candidate.counts.lightSamples == 1)
      return &candidate;
  }
  return nullptr;
}

const PilotCandidate* RenderPilot::Best() const {
  // Estimates of rarely found light are noisy, and too small where the pilot has missed the brightest samples. So
  // candidates are compared by upper bounds of their errors.
  const PilotCandidate* best = nullptr;
  for (const PilotCandidate& candidate : candidates) {
    if (candidate.missing > kNegligibleLight) continue;
    if (!best || candidate.MostErrorTimesCost() < best->MostErrorTimesCost()) best = &candidate;
  }
  return best;
}

RenderPilot RunPilot(const RenderScene& scene, const RenderSettings& settings, int threads, int passCount) {
  const RenderSettings combined = WithAllTechniques(settings);
  const Grid grid(settings);
  const double fewer = grid.Fewer();
  const PilotIntegrators integrators(scene, combined, fewer);
  const PhotonSettings photons = PhotonsOfPilot(*integrators.vcm, fewer);
  // If light paths hardly come near to what is seen, vcm guides them from the start. Those of bdpt are hopeless then.
  RenderScene view = scene;
  const bool choosesLights = ChoosesLights(scene, settings);
  if (choosesLights)
    view.lighting =
        std::make_shared<const LightingServices>(scene.lighting->Selecting(settings.LightSampler(), kSeveralLights));
  const std::shared_ptr<const LightingServices> lighting = view.lighting;
  std::optional<EmissionLearning> guiding;
  if (photons.guided) guiding.emplace(scene, settings.width, settings.height);
  const bool isGuided = guiding && guiding->Guide();
  if (isGuided) view.lighting = std::make_shared<const LightingServices>(lighting->With(nullptr, guiding->Guide()));
  // The pilot's light paths are those of bdpt, not guided. What a guide would gain is learned from them.
  EmissionLearning* const learned = guiding && !isGuided ? &*guiding : nullptr;
  PhotonStore store(photons, static_cast<uint64_t>(grid.Pixels()), learned);
  PilotPasses tracer(view, combined, grid, threads);
  const PixelFilter filter(settings.filter);
  Counted counted;
  counted.tracesAnew = scene.hasMotion || scene.isSpectral;
  LearnPaths(integrators, combined, grid, threads, !isGuided, view);
  Spreads spreads(grid.Pixels());
  CountPaths(integrators, view, combined, grid, threads, counted, choosesLights ? &spreads : nullptr);
  const int most = passCount > 0 ? passCount : PassesFor(counted, grid.Pixels());
  const int first = passCount > 0 ? passCount : kFewestPasses;
  if (scene.isSpectral) CountPaths(integrators, WithWavelengths(view), combined, grid, threads, counted, nullptr);
  Records records(grid, filter, SplatCount(settings), !settings.SamplesLightEdges(), kChunks,
                  std::max(most, kMostPasses));
  Passes passes{integrators, tracer,  store,   learned,           WiderRadius(fewer, photons.alpha),
                threads,     records, counted, std::move(spreads)};
  const bool isSobol = settings.sampler == SamplerKind::Sobol;
  const auto isEnough = [&](int count, const Counted& soFar) {
    std::vector<PilotCandidate> all = CandidatesWith(CostsOf(soFar, grid.Pixels()));
    return records.SetErrors(count, filter.SquaredWeight(), isSobol, all) && IsWellKnown(all);
  };
  passCount = RunPasses(first, most, isEnough, passes);
  auto costs = CostsOf(passes.counted, grid.Pixels());
  const bool willBeGuided = learned && learned->Guide();
  if (willBeGuided) {
    view.lighting = std::make_shared<const LightingServices>(lighting->With(nullptr, learned->Guide()));
    CountGuided(integrators, photons, passes.wider, threads, view, combined, grid, passes.counted, costs);
  }
  const GuideCosts ofGuides{isGuided || willBeGuided ? kDensities : 1.0, view.guide ? kGuidedPaths : 1.0};
  ofGuides.Apply(costs);
  auto all = CandidatesWith(costs);
  if (!records.SetErrors(passCount, filter.SquaredWeight(), isSobol, all)) return {};
  if (willBeGuided) GuideLightPaths(all);
  RenderPilot pilot{{all.begin(), all.begin() + kWholeCandidates}, {all.begin() + kWholeCandidates, all.end()}};
  AddMixed(all, costs, grid, records.LeastError(), pilot.candidates);
  EraseUnwanted(settings, isGuided, pilot.candidates);
  EraseUnwanted(settings, isGuided, pilot.ending);
  if (choosesLights)
    ChooseLightSamples(passes.counted, passes.spreads, records, grid.Pixels(), passCount, isSobol, ofGuides, pilot);
  const EmissionGuide* const guide = isGuided ? guiding->Guide() : willBeGuided ? learned->Guide() : nullptr;
  if (settings.values.IsOn("merge")) AddSppm(scene, guide, combined, grid, records, passCount, threads, pilot);
  return pilot;
}

}  // namespace lampyr
