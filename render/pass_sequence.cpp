#include "render/pass_sequence.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "base/byte_stream.h"
#include "base/stop.h"
#include "render/passes.h"

namespace lampyr {

PassSequence::PassSequence(const RenderScene& scene, const Integrator& integrator, const RenderSettings& settings,
                           int threads, Film& film, uint32_t firstSample)
    : scene_(scene),
      lighting_(scene.lighting->Selecting(settings.LightSampler(), settings.LightSamples())),
      integrator_(integrator),
      settings_(settings),
      filter_(settings.filter),
      threads_(threads),
      film_(&film),
      firstSample_(firstSample),
      wantedPhotons_(integrator.Photons()) {
  if (wantedPhotons_ && wantedPhotons_->guided)
    guiding_ = std::make_unique<EmissionLearning>(scene, settings.width, settings.height);
  if (settings.adaptive && integrator.Paths() != TracedPaths::Light && !film.IsAdaptive())
    film.MakeAdaptive(wantedPhotons_.has_value());
  if (wantedPhotons_) film.KeepBias();
  MakePhotonStore();
  if (settings.GuidesPaths() && integrator.FollowsCameraPaths())
    paths_ = std::make_unique<PathLearning>(settings.width, settings.height, film.Pixels(),
                                            integrator.Paths() == TracedPaths::Both, settings.AlwaysGuidesPaths());
  if (settings.LearnsLights() && lighting_.LearnsSelection() && integrator.Paths() != TracedPaths::Light) {
    learning_ = std::make_unique<LightLearning>(scene.lighting->SceneSphere());
    selection_ =
        std::make_unique<SelectionTest>(settings.width, settings.height, film.Pixels(),
                                        integrator.Paths() == TracedPaths::Both, settings.AlwaysLearnsLights());
  }
}

void PassSequence::MakePhotonStore() {
  if (!wantedPhotons_) return;
  const uint64_t pixels = static_cast<uint64_t>(settings_.width) * static_cast<uint64_t>(settings_.height);
  photons_ = std::make_unique<PhotonStore>(*wantedPhotons_, pixels, guiding_.get());
}

void PassSequence::Add(uint32_t done, uint32_t count) {
  if (photons_) before_ = photons_->Statistics();
  if (!hasSoughtEdges_) {  // here and not before, so that it can be stopped as passes can
    RenderScene scene = scene_;
    scene.lighting = std::make_shared<const LightingServices>(lighting_);
    auto edges = LightEdges::Find(scene, integrator_, settings_, film_->Crop(), threads_);
    CheckStop();
    edges_ = std::move(edges);
    hasSoughtEdges_ = true;
  }
  const uint32_t end = done + count;
  while (done < end) {
    const uint32_t milestone = std::bit_ceil(done + 1);
    const bool learns = (learning_ && learning_->IsRecording()) || (guiding_ && guiding_->IsRecording()) ||
                        (paths_ && paths_->IsRecording());
    uint32_t next = learns ? std::min(end, milestone) : end;
    if (film_->IsAdaptive()) {
      StartStage(done);
      next = std::min(next, allocation_->Stage().before + allocation_->Stage().passes);
    }
    AddPass(done, next - done);
    done = next;
    if (learns && done == milestone) Learn(done);
  }
}

void PassSequence::AddPass(uint32_t done, uint32_t count) {
  // The lighting with what has been learned so far; it does not change during the pass.
  view_ = scene_;
  const bool learnsLights = learning_ && learning_->IsRecording(), usesLearned = selection_ && selection_->IsUsed();
  view_.lighting = std::make_shared<const LightingServices>(lighting_.With(
      learnsLights || usesLearned ? learning_.get() : nullptr, guiding_ ? guiding_->Guide() : nullptr, !usesLearned));
  view_.guide = paths_ ? paths_->Guide() : nullptr;
  view_.roulette = paths_ ? paths_->Roulette() : nullptr;
  PathLearning* recorded = RecordsPathsAfter(done) ? paths_.get() : nullptr;
  const RenderCounts counts =
      RenderPass(view_, integrator_, settings_, filter_, firstSample_ + done, count, threads_, *film_, photons_.get(),
                 allocation_.get(), recorded, learnsLights ? selection_.get() : nullptr, edges_.get());
  CheckStop();  // the counts of a given-up pass are not added
  if (film_->IsAdaptive()) film_->CountPasses(count);
  counts_ += counts;
}

namespace {

// Samples per pixel from which on camera paths may be guided beside photons that are not. Photons for which a guide
// pays are mostly known to by then; where a guide of photons seems useless, a few samples are enough. Half as many are
// enough to begin to record.
constexpr uint32_t kPhotonsFirst = 32, kPhotonsFirstIfUseless = 4;

}  // namespace

bool PassSequence::PhotonsAreSettled(uint32_t samples, uint32_t part) const {
  if (!guiding_ || !guiding_->IsRecording()) return true;
  return samples >= (guiding_->SeemsUseless() ? kPhotonsFirstIfUseless : kPhotonsFirst) / part;
}

bool PassSequence::RecordsPathsAfter(uint32_t samples) const {
  if (!paths_ || !paths_->IsRecording()) return false;
  return settings_.AlwaysGuidesPaths() || PhotonsAreSettled(samples, 2);
}

// Called at milestones: after 2^n samples.
void PassSequence::Learn(uint32_t samples) {
  bool changesDensities = false;
  const bool hasRecords = RecordsPathsAfter(samples / 2);
  const bool photonsAreSettled =
      !guiding_ || !guiding_->IsRecording() || (PhotonsAreSettled(samples, 1) && !guiding_->Guide());
  if (learning_ && learning_->IsRecording()) {
    const bool wasUsed = selection_->IsUsed();
    selection_->Decide(samples);
    learning_->Freeze();
    if (!selection_->IsLearning()) learning_->StopRecording();
    if (!selection_->IsLearning() && !selection_->IsUsed()) learning_->Forget();
    changesDensities = wasUsed || selection_->IsUsed();
  }
  // A pass that was given up ends here: its caller has restored the objects below.
  CheckStop();
  if (guiding_ && guiding_->IsRecording() && guiding_->Decide(samples)) changesDensities = true;
  CheckStop();
  if (hasRecords) {
    if (paths_->Decide(samples, threads_, photonsAreSettled)) changesDensities = true;
  } else if (paths_) {
    paths_->Skip(samples);
  }
  CheckStop();
  // The photons of the last pass, and their weights, have densities of the view before. They are dropped and others
  // traced in their place, as when a render is resumed.
  if (changesDensities && photons_) photons_->Clear();
}

// Begins the stage of the pass after `done` others, unless it has begun: ends the one before.
void PassSequence::StartStage(uint32_t done) {
  const SampleStage stage = StageOf(done, firstSample_, settings_.seed);
  if (allocation_ && allocation_->Stage().before == stage.before) return;
  if (stage.before == 0) {
    allocation_ = std::make_unique<SampleAllocation>(stage, film_->Pixels());
    return;
  }
  if (film_->EndedPasses() < stage.before) {
    film_->EndStage();
    // The rates of the stage depend on the light paths that the photons of the last pass are of.
    if (photons_) photons_->Clear();
  }
  allocation_ = std::make_unique<SampleAllocation>(stage, *film_, *settings_.adaptive);
}

RenderCounts PassSequence::TakeCounts() {
  return std::exchange(counts_, RenderCounts());
}

GuidingStatistics PassSequence::Guiding() const {
  GuidingStatistics statistics;
  if (paths_) {
    statistics.gain = paths_->Gain();
    statistics.regions = paths_->Regions();
  }
  if (selection_) {
    statistics.lightGain = selection_->Gain();
    statistics.usesLearnedLights = selection_->IsUsed();
  }
  return statistics;
}

std::optional<PhotonStatistics> PassSequence::Photons() const {
  if (!photons_) return std::nullopt;
  PhotonStatistics statistics = photons_->Statistics();
  if (guiding_) {
    statistics.guideGain = guiding_->Gain();
    statistics.guideComponents = guiding_->Components();
  }
  return statistics;
}

double PassSequence::DroppedFraction(uint64_t dropped, int samplesPerPixel) const {
  const auto fraction = [](uint64_t part, double all) {
    return part == 0 ? 0 : static_cast<double>(part) / std::max(all, static_cast<double>(part));
  };
  const PixelRect& crop = film_->Crop();
  const double pixels = integrator_.Paths() == TracedPaths::Camera
                            ? static_cast<double>(crop.Width()) * crop.Height()
                            : static_cast<double>(settings_.width) * settings_.height;
  const double ofSamples = fraction(dropped, pixels * samplesPerPixel);
  if (!photons_) return ofSamples;
  const PhotonStatistics& statistics = photons_->Statistics();
  return std::max(ofSamples,
                  fraction(statistics.rejected, static_cast<double>(statistics.photons + statistics.rejected)));
}

void PassSequence::StartAnew() {
  counts_ = RenderCounts();
  allocation_.reset();
  // Photons are traced again, as after loading a checkpoint.
  MakePhotonStore();
  if (photons_) photons_->Continue(before_);
}

void PassSequence::LeaveToGivenUpPass(Film& film) {
  film_ = &film;
  (void)photons_.release();
  (void)allocation_.release();
}

// Photons are not saved: those of the last pass are traced again.
void PassSequence::Save(ByteWriter& bytes) const {
  if (photons_) bytes.Value(photons_->Statistics());
  if (learning_) learning_->Save(bytes);
  if (selection_) selection_->Save(bytes);
  if (guiding_) guiding_->Save(bytes);
  if (paths_) paths_->Save(bytes);
}

void PassSequence::Load(ByteReader& bytes) {
  if (photons_) photons_->Continue(bytes.Value<PhotonStatistics>());
  if (learning_) learning_->Load(bytes);
  if (selection_) selection_->Load(bytes);
  if (guiding_) guiding_->Load(bytes);
  if (paths_) paths_->Load(bytes);
}

}  // namespace lampyr
