// Photons from the pass that traces them to the pass that gathers them: what is traced for photons alone costs nothing
// else, and photons never outlive the densities that they carry.
#include <gtest/gtest.h>

#include "agreement/agreement_scenes.h"
#include "base/byte_stream.h"
#include "render/passes.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// Lamps of which some are hidden: what is learned of them differs from what is not.
std::string Lamps() {
  std::string text = FilmWith("box", 16, 16) + kDown + World(4);
  for (int i = 0; i < 12; ++i) {
    text += "LightSource \"point\" \"point3 from\" [" + std::to_string(0.3 * i - 1.6) + " 0.9 " +
            std::to_string(0.2 * (i % 3)) + "] \"rgb I\" [0.3 0.3 0.3]\n";
  }
  text += "AttributeBegin Translate 0.6 0.6 0 Rotate -90 1 0 0 Shape \"disk\" \"float radius\" 0.7 AttributeEnd\n";
  return text + kThings;
}

BuiltScene BuildLamps(const char* integrator, bool learns, bool connects) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["learn-always"] = learns;
  overrides.values["connect"] = connects;
  overrides.values["guide-photons"] = false;
  overrides.values["radius"] = 0.2;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  return BuildScene(ParseScene(Lamps(), "test.pbrt", diagnostics), overrides, true, diagnostics);
}

// Light paths that are traced again for their photons alone are not connected to the camera.
TEST(PhotonPasses, LightPathsForPhotonsAloneCostNoShadowRays) {
  BuiltScene built = BuildLamps("vcm", false, true);
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  const PixelFilter filter(built.settings.filter);
  const auto render = [&](uint32_t first, uint32_t count, PhotonStore* kept) {
    Film film(built.settings.width, built.settings.height, built.settings.crop, {});
    return RenderPass(built.scene, *integrator, built.settings, filter, first, count, 1, film, kept);
  };
  PhotonStore kept(*integrator->Photons(), 16 * 16);
  render(0, 3, &kept);
  const RenderCounts continued = render(3, 1, &kept), again = render(3, 1, nullptr);
  EXPECT_EQ(continued.shadowRays, again.shadowRays);
  EXPECT_GT(continued.shadowRays, 0u);
  EXPECT_GT(again.indirectRays, continued.indirectRays);
}

// The picture of a render that is saved after `samples` and gone on with is that of one that is not, to the bit.
TEST(PhotonPasses, ResumedWhereTheSelectionOfLightsIsLearned) {
  for (const bool connects : {true, false}) {
    BuiltScene built = BuildLamps("vcm", true, connects);
    const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
    const auto film = [&] { return Film(built.settings.width, built.settings.height, built.settings.crop, {}); };
    Film whole = film();
    ProgressiveRender uninterrupted(built.scene, *integrator, built.settings, 1, whole);
    uninterrupted.AddSamples(11);
    // Milestones of learning, and what is between them.
    for (const int samples : {1, 2, 3, 4, 7, 8}) {
      Film first = film(), second = film();
      ProgressiveRender before(built.scene, *integrator, built.settings, 1, first);
      before.AddSamples(samples);
      std::vector<std::byte> saved;
      ByteWriter writer([&](const void* bytes, size_t count) {
        const auto* from = static_cast<const std::byte*>(bytes);
        saved.insert(saved.end(), from, from + count);
      });
      before.Save(writer);
      ProgressiveRender after(built.scene, *integrator, built.settings, 1, second);
      ByteReader bytes(saved);
      after.Load(bytes);
      after.AddSamples(11 - samples);
      EXPECT_EQ(second.Develop().data, whole.Develop().data) << "after " << samples << ", connects " << connects;
    }
  }
}

}  // namespace
}  // namespace lampyr::test
