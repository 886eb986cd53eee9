#include "app/compare/compared_scene.h"

#include <algorithm>
#include <memory>

#include "base/stop.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

void ComparedScene::Render(const std::string& integrator, uint64_t seed, const std::vector<double>& times,
                           const std::vector<int>& sampleCounts, const AtMilestone& atMilestone,
                           const AfterPass& afterPass, uint32_t firstSample, double secondsBefore) const {
  // Never destroyed if a pass was abandoned, because its threads still use it.
  struct Run {
    RenderSettings settings;
    std::unique_ptr<Integrator> integrator;
    Film film;
    ProgressiveRender render;
    Run(const RenderScene& scene, const RenderSettings& chosen, int threads, uint32_t firstSample)
        : settings(chosen),
          integrator(MakeIntegrator(scene, settings)),
          film(settings.width, settings.height, settings.crop),
          render(scene, *integrator, settings, threads, film, nullptr, firstSample) {}
  };
  RenderSettings settings = VariantOf(built_.settings, integrator);
  settings.seed = seed;
  auto run = std::make_unique<Run>(built_.scene, settings, threads_, firstSample);
  ProgressiveRender& render = run->render;
  const Film& film = run->film;
  const RenderOutcome& outcome = render.Outcome();
  const StopWatch watch(&interrupted_, std::nullopt);
  size_t nextTime = 0, nextCount = 0;
  while (nextTime < times.size() || nextCount < sampleCounts.size()) {
    std::optional<double> left;
    if (nextTime < times.size()) left = std::max(times[nextTime] - secondsBefore - outcome.seconds, 0.0);
    const int most = nextCount < sampleCounts.size() ? sampleCounts[nextCount] : 1 << 30;
    const bool isWhole = render.AddSamples(render.NextPassSamples(most, left));
    if (isWhole) afterPass(secondsBefore + outcome.seconds);
    if (HasGivenUpWork()) (void)run.release();
    if (!isWhole || interrupted_.load()) throw ComparisonInterrupted{};
    // A sample that would exceed the time is omitted if it would exceed it by more than half of its duration.
    const double perSample = outcome.seconds / outcome.samplesPerPixel;
    while (nextTime < times.size() && secondsBefore + outcome.seconds + 0.5 * perSample >= times[nextTime]) {
      atMilestone(nextTime, {secondsBefore + outcome.seconds, outcome.samplesPerPixel}, film.Develop());
      ++nextTime;
    }
    while (nextCount < sampleCounts.size() && outcome.samplesPerPixel >= sampleCounts[nextCount]) {
      atMilestone(times.size() + nextCount, {secondsBefore + outcome.seconds, outcome.samplesPerPixel}, film.Develop());
      ++nextCount;
    }
  }
}

double ComparedScene::ChoiceSeconds(const std::string& integrator) const {
  return integrator == kAuto ? built_.choiceSeconds : 0;
}

}  // namespace lampyr
