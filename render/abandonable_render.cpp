#include "render/abandonable_render.h"

#include <algorithm>
#include <chrono>

#include "base/stop.h"

namespace lampyr {

AbandonableRender::AbandonableRender(const RenderScene& scene, const Integrator& integrator,
                                     const RenderSettings& settings, int threads, Film& film)
    : film_(film), passes_(scene, integrator, settings, threads, film) {}

bool AbandonableRender::AddSamples(int count) {
  const auto start = std::chrono::steady_clock::now();
  const WorkEnd end =
      RunUntilStopped([this, count] { passes_.Add(static_cast<uint32_t>(samples_), static_cast<uint32_t>(count)); });
  if (end != WorkEnd::Done) return false;
  counts_ += passes_.TakeCounts();
  samples_ += count;
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return true;
}

int AbandonableRender::NextPassSamples(int most, double longest) const {
  if (samples_ == 0) return 1;
  const double affordable = longest * samples_ / std::max(seconds_, 1e-9);
  const double wanted = std::min(affordable, static_cast<double>(std::min(samples_, most - samples_)));
  return std::max(static_cast<int>(wanted), 1);
}

double AbandonableRender::DroppedFraction() const {
  return passes_.DroppedFraction(counts_.droppedSamples, samples_);
}

}  // namespace lampyr
