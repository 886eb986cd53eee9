#include "render/abandonable_render.h"

#include <algorithm>
#include <bit>
#include <chrono>

#include "base/stop.h"
#include "render/passes.h"

namespace lampyr {

AbandonableRender::AbandonableRender(const RenderScene& scene, const Integrator& integrator,
                                     const RenderSettings& settings, int threads, Film& film)
    : scene_(scene),
      integrator_(integrator),
      settings_(settings),
      filter_(settings.filter),
      threads_(threads),
      film_(film) {
  const std::optional<PhotonSettings> photons = integrator.Photons();
  if (photons && photons->guided) guiding_ = std::make_unique<EmissionLearning>(scene, settings.width, settings.height);
  if (photons) {
    const uint64_t pixels = static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
    photons_ = std::make_unique<PhotonStore>(*photons, pixels, guiding_.get());
  }
  if (settings.LearnsLights()) learning_ = std::make_unique<LightLearning>(scene.lighting->SceneSphere());
}

void AbandonableRender::AddPass(uint32_t first, uint32_t count) {
  view_ = scene_;
  view_.lighting = std::make_shared<const LightingServices>(
      scene_.lighting->With(learning_.get(), guiding_ ? guiding_->Guide() : nullptr));
  counts_ += RenderPass(view_, integrator_, settings_, filter_, first, count, threads_, film_, nullptr, photons_.get());
  CheckStop();
}

// As ProgressiveRender learns: after 2^n samples, and of light selection up to kLastLearned.
void AbandonableRender::Learn(uint32_t samples) {
  constexpr uint32_t kLastLearned = 64;
  bool changesDensities = false;
  if (learning_ && learning_->IsRecording()) {
    learning_->Freeze();
    if (samples >= kLastLearned) learning_->StopRecording();
    changesDensities = true;
  }
  if (guiding_ && guiding_->IsRecording() && guiding_->Decide(samples)) changesDensities = true;
  if (changesDensities && photons_) photons_->Clear();
}

void AbandonableRender::AddWholePass(int count) {
  const auto start = std::chrono::steady_clock::now();
  auto first = static_cast<uint32_t>(samples_);
  const uint32_t end = first + static_cast<uint32_t>(count);
  while (first < end) {
    const uint32_t milestone = std::bit_ceil(first + 1);
    const bool learns = (learning_ && learning_->IsRecording()) || (guiding_ && guiding_->IsRecording());
    const uint32_t next = learns ? std::min(end, milestone) : end;
    AddPass(first, next - first);
    first = next;
    if (learns && first == milestone) Learn(first);
  }
  samples_ += count;
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool AbandonableRender::AddSamples(int count) {
  return RunUntilStopped([this, count] { AddWholePass(count); }) == WorkEnd::Done;
}

int AbandonableRender::NextPassSamples(int most, double longest) const {
  if (samples_ == 0) return 1;
  const double affordable = longest * samples_ / std::max(seconds_, 1e-9);
  const double wanted = std::min(affordable, static_cast<double>(std::min(samples_, most - samples_)));
  return std::max(static_cast<int>(wanted), 1);
}

double AbandonableRender::DroppedFraction() const {
  const auto fraction = [](uint64_t dropped, double all) {
    return dropped == 0 ? 0 : static_cast<double>(dropped) / std::max(all, static_cast<double>(dropped));
  };
  const PixelRect& crop = film_.Crop();
  const double pixels = integrator_.Paths() == TracedPaths::Camera
                            ? static_cast<double>(crop.Width()) * crop.Height()
                            : static_cast<double>(settings_.width) * settings_.height;
  const double ofSamples = fraction(counts_.droppedSamples, pixels * samples_);
  if (!photons_) return ofSamples;
  const PhotonStatistics statistics = photons_->Statistics();
  return std::max(ofSamples,
                  fraction(statistics.rejected, static_cast<double>(statistics.photons + statistics.rejected)));
}

}  // namespace lampyr
