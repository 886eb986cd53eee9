#include "app/compare/compared_scene.h"

#include <algorithm>

namespace lampyr {

void ComparedScene::Render(const std::string& integrator, uint64_t seed, const std::vector<double>& times,
                           const std::vector<int>& sampleCounts, const AtMilestone& atMilestone,
                           const AfterPass& afterPass) const {
  RenderSettings settings = VariantOf(built_.settings, integrator);
  settings.seed = seed;
  const AnyIntegrator chosen = MakeIntegrator(built_.scene, settings);
  Film film(settings.width, settings.height, settings.crop);
  ProgressiveRender render(built_.scene, chosen, settings, threads_, film);
  const RenderOutcome& outcome = render.Outcome();
  size_t nextTime = 0, nextCount = 0;
  while (nextTime < times.size() || nextCount < sampleCounts.size()) {
    std::optional<double> left;
    if (nextTime < times.size()) left = times[nextTime] - outcome.seconds;
    const int most = nextCount < sampleCounts.size() ? sampleCounts[nextCount] : 1 << 30;
    render.AddSamples(render.NextPassSamples(most, left));
    afterPass(outcome.seconds);
    if (interrupted_.load()) throw ComparisonInterrupted{};
    // The sample that would take the render beyond its time is left out when it would by more than half.
    const double perSample = outcome.seconds / outcome.samplesPerPixel;
    while (nextTime < times.size() && outcome.seconds + 0.5 * perSample >= times[nextTime]) {
      atMilestone(nextTime, {outcome.seconds, outcome.samplesPerPixel}, film.Develop());
      ++nextTime;
    }
    while (nextCount < sampleCounts.size() && outcome.samplesPerPixel >= sampleCounts[nextCount]) {
      atMilestone(times.size() + nextCount, {outcome.seconds, outcome.samplesPerPixel}, film.Develop());
      ++nextCount;
    }
  }
}

}  // namespace lampyr
