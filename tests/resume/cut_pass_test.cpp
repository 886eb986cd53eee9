// A pass that is cut short leaves no trace: the state that is saved is the one before it, byte for byte, and the
// picture that is gone on with is the one of a render that was never stopped.
#include <algorithm>
#include <chrono>
#include <random>
#include <thread>

#include "base/byte_stream.h"
#include "base/stop.h"
#include "render/build/scene_builder.h"
#include "render/progressive_render.h"
#include "render/settings/integrator_choice.h"
#include "resume/resume_fixture.h"
#include "scene/scene_description.h"

namespace lampyr::test {
namespace {

using Clock = std::chrono::steady_clock;

template <class Saved>
std::string SavedBytes(const Saved& saved) {
  std::string all;
  ByteWriter writer([&](const void* bytes, size_t count) { all.append(static_cast<const char*>(bytes), count); });
  saved.Save(writer);
  return all;
}

// One render with its film.
struct OwnRender {
  explicit OwnRender(const BuiltScene& built)
      : integrator(MakeIntegrator(built.scene, built.settings)),
        film(built.settings.width, built.settings.height, built.settings.crop, built.FilmLayers()) {
    const RenderSettings& s = built.settings;
    render.emplace(built.scene, *integrator, s, 2, film);
  }
  std::unique_ptr<Integrator> integrator;
  Film film;
  std::optional<ProgressiveRender> render;
};

// Requests a stop when so much time is over, unless it is destroyed before.
class StopAfter {
 public:
  explicit StopAfter(double seconds)
      : thread_([this, seconds] {
          const auto end = Clock::now() + std::chrono::duration<double>(seconds);
          while (!isOver_ && Clock::now() < end) std::this_thread::sleep_for(std::chrono::microseconds(50));
          if (!isOver_) RequestStop();
        }) {}
  ~StopAfter() {
    isOver_ = true;
    thread_.join();
    WithdrawStop();
  }

 private:
  std::atomic<bool> isOver_{false};
  std::thread thread_;
};

class CutPass : public Resume {
 protected:
  BuiltScene Build(const std::string& integrator, bool learns, int resolution = 48, bool isAdaptive = false,
                   const std::vector<std::string>& layers = {}) const {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    RenderOverrides overrides;
    overrides.integrator = integrator;
    overrides.layers = layers;
    overrides.values["learn-always"] = learns;
    if (isAdaptive) overrides.adaptive.emplace();
    overrides.width = resolution;
    overrides.height = resolution;
    return BuildScene(ReadScene(folder_ / "scene.pbrt", diagnostics), overrides, true, diagnostics);
  }

  // Returns how often a pass was cut.
  int Check(const BuiltScene& built, std::mt19937& random) const {
    const int passes[] = {1, 1, 2, 3, 5, 8};
    OwnRender whole(built), cut(built);
    int cuts = 0;
    for (const int count : passes) {
      const auto start = Clock::now();
      EXPECT_TRUE(whole.render->AddSamples(count));
      const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
      std::uniform_real_distribution<double> moment(0, seconds);
      const std::string before = SavedBytes(*cut.render);
      bool isDone = false;
      for (int i = 0; i < 4 && !isDone; ++i) {
        {
          const StopAfter stop(moment(random));
          isDone = cut.render->AddSamples(count);
        }
        if (isDone) break;
        ++cuts;
        EXPECT_EQ(cut.render->Outcome().isPartial, cut.render->Outcome().samplesPerPixel == 0);
        if (i % 2 == 0) cut.render->DropPartialPass();
        if (!cut.render->Outcome().isPartial) {
          const std::string after = SavedBytes(*cut.render);
          EXPECT_EQ(after.size(), before.size());
          if (after.size() != before.size()) continue;
          const auto difference = std::mismatch(after.begin(), after.end(), before.begin()).first;
          EXPECT_EQ(difference, after.end()) << "the state has changed at byte " << difference - after.begin();
        }
      }
      if (!isDone) {
        EXPECT_TRUE(cut.render->AddSamples(count));
      }
      EXPECT_EQ(cut.render->Outcome().samplesPerPixel, whole.render->Outcome().samplesPerPixel);
    }
    EXPECT_TRUE(SavedBytes(whole.film) == SavedBytes(cut.film)) << "the picture is another one";
    return cuts;
  }
};

TEST_F(CutPass, LeavesNoTrace) {
  std::mt19937 random(5);
  int cuts = 0;
  for (const char* integrator : {"path", "light", "bdpt", "vcm", "sppm"}) {
    for (const bool learns : {false, true}) {
      if (learns && std::string(integrator) == "light") continue;
      SCOPED_TRACE(std::string(integrator) + (learns ? ", learning lights" : ""));
      cuts += Check(Build(integrator, learns), random);
    }
  }
  for (const char* integrator : {"bdpt", "vcm"})
    cuts += Check(Build(integrator, false, 24, false, {"strategies"}), random);
  for (const char* integrator : {"path", "sppm", "vcm"}) {
    SCOPED_TRACE(std::string(integrator) + ", adaptive");
    cuts += Check(Build(integrator, true, 48, true), random);
  }
  EXPECT_GT(cuts, 50);
  std::printf("[   info   ] %d passes cut short\n", cuts);
}

// The picture of an unfinished first pass can be viewed until it is dropped.
TEST_F(CutPass, OfTheFirstPassThePictureStays) {
  const BuiltScene built = Build("path", false, 400);
  OwnRender own(built);
  double seconds = 0.02;
  double sampled = 0;
  for (; sampled == 0 && seconds < 5; seconds *= 2) {
    const StopAfter stop(seconds);
    if (own.render->AddSamples(1)) break;
    sampled = own.film.SampledFraction();
  }
  ASSERT_GT(sampled, 0) << "the pass was never cut in its middle";
  EXPECT_LT(sampled, 1);
  EXPECT_TRUE(own.render->Outcome().isPartial);
  EXPECT_EQ(own.render->Outcome().samplesPerPixel, 0);
  own.render->DropPartialPass();
  EXPECT_EQ(own.film.SampledFraction(), 0);
}

// Work that does not ask for a stop is given up, and its owner goes on.
TEST(RunUntilStopped, SaysHowTheWorkHasEnded) {
  EXPECT_EQ(RunUntilStopped([] {}), WorkEnd::Done);
  EXPECT_THROW(RunUntilStopped([] { throw Error("wrong"); }), Error);
  {
    const StopAfter stop(0.02);
    EXPECT_EQ(RunUntilStopped([] {
                for (;;) CheckStop();
              }),
              WorkEnd::Stopped);
  }
  EXPECT_FALSE(HasGivenUpWork());
  EXPECT_EQ(RunUntilStopped([] {}), WorkEnd::Done);
}

}  // namespace
}  // namespace lampyr::test
