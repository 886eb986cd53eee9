#include "app/compare/compared_scene.h"

#include <algorithm>
#include <memory>

#include "base/stop.h"
#include "denoise/denoise.h"
#include "render/feature_layers.h"
#include "render/settings/integrator_choice.h"

namespace lampyr {

namespace {

// Never destroyed if a pass was abandoned, because its threads still use it.
struct OneRender {
  RenderSettings settings;
  std::unique_ptr<Integrator> integrator;
  Film film;
  ProgressiveRender render;
  OneRender(const RenderScene& scene, const RenderSettings& chosen, int threads, uint32_t firstSample, bool denoises)
      : settings(chosen),
        integrator(MakeIntegrator(scene, settings)),
        film(settings.width, settings.height, settings.crop,
             denoises ? std::vector<std::string>{kHalfLayer} : std::vector<std::string>()),
        render(scene, *integrator, settings, threads, film, firstSample) {}
};

}  // namespace

void ComparedScene::Render(const std::string& integrator, uint64_t seed, const std::vector<double>& times,
                           const std::vector<int>& sampleCounts, const AtMilestone& atMilestone,
                           const AfterPass& afterPass, uint32_t firstSample, double secondsBefore) const {
  RenderSettings settings = VariantOf(built_.settings, integrator);
  settings.seed = seed;
  auto run = std::make_unique<OneRender>(built_.scene, settings, threads_, firstSample, IsDenoised(integrator));
  ProgressiveRender& render = run->render;
  const Film& film = run->film;
  const RenderOutcome& outcome = render.Outcome();
  double seconds = secondsBefore;
  Image features;
  if (IsDenoised(integrator)) {
    const WorkTimer timer;
    features = FeatureLayers(built_, threads_, interrupted_);
    seconds += Seconds(timer.Elapsed());
  }
  const double secondsBeforeSamples = seconds;
  const auto show = [&](size_t index) {
    if (!IsDenoised(integrator)) {
      const auto stated = film.KeepsBias() ? std::optional(film.PartsOfError()) : std::nullopt;
      atMilestone(index, {seconds, outcome.samplesPerPixel, stated}, film.Develop());
      return;
    }
    const WorkTimer timer;
    const Image picture = DenoisedPicture(film, features, outcome.samplesPerPixel);
    atMilestone(index, {seconds + Seconds(timer.Elapsed()), outcome.samplesPerPixel, std::nullopt}, picture);
  };
  const StopWatch watch(&interrupted_, std::nullopt);
  size_t nextTime = 0, nextCount = 0;
  while (nextTime < times.size() || nextCount < sampleCounts.size()) {
    std::optional<double> left;  // by the clock of `render`
    if (nextTime < times.size()) {
      const double ofSamples = seconds - secondsBeforeSamples;
      left = std::max(times[nextTime] - seconds, 0.0) * (ofSamples > 0 ? outcome.seconds / ofSamples : 1.0);
    }
    const int most = nextCount < sampleCounts.size() ? sampleCounts[nextCount] : 1 << 30;
    const int count = render.NextPassSamples(most, left);
    const WorkTimer timer;
    const bool isWhole = render.AddSamples(count);
    seconds += Seconds(timer.Elapsed());
    if (isWhole) afterPass(seconds);
    if (HasGivenUpWork()) (void)run.release();
    if (!isWhole || interrupted_.load()) throw ComparisonInterrupted{};
    // A sample that would exceed the time by more than half of its duration is omitted.
    const double perSample = (seconds - secondsBeforeSamples) / outcome.samplesPerPixel;
    while (nextTime < times.size() && seconds + 0.5 * perSample >= times[nextTime]) {
      show(nextTime);
      ++nextTime;
    }
    while (nextCount < sampleCounts.size() && outcome.samplesPerPixel >= sampleCounts[nextCount]) {
      show(times.size() + nextCount);
      ++nextCount;
    }
  }
}

Image ComparedScene::DenoisedPicture(const Film& film, const Image& features, int samplesPerPixel) const {
  Image picture = film.Develop();
  if (samplesPerPixel < 2) return picture;  // its variance is not known
  if (!features.channels.empty()) AppendChannels(picture, features);
  picture.metadata[kSamplesMetadata] = std::to_string(samplesPerPixel);
  DenoiseReport report;
  Image denoised = Denoise(
      picture, threads_, interrupted_, [](double) {}, report);
  if (denoised.channels.empty()) throw ComparisonInterrupted{};
  return denoised;
}

double ComparedScene::ChoiceSeconds(const std::string& integrator) const {
  return IsAuto(integrator) ? Seconds(built_.choiceTime) : 0;
}

}  // namespace lampyr
