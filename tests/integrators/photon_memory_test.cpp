// The memory of photons decides how many light paths a pass has, and must not decide how bright the picture is: not
// even where it holds a single path, or none.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "integrators/photon/photon_store.h"
#include "support/estimate.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

// Paths that leave no photon, one, two or three, of which the later are the dimmer.
constexpr const char* kCorner = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
LookAt 0 1.2 1.6  0 0.1 -0.2  0 1 0
Camera "perspective" "float fov" 30
Integrator "path" "integer maxdepth" 4
WorldBegin
AttributeBegin Translate 0 1.6 0 Rotate 90 1 0 0
AreaLightSource "diffuse" "rgb L" [9 9 9] Shape "disk" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [0.7 0.7 0.7]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 0 1  1 0 1 ]
Shape "bilinearmesh" "point3 P" [ -1 0 -1  1 0 -1  -1 1 -1  1 1 -1 ]
)";

// Mean over pictures of independent seeds, of what photons have brought: the same radius in all passes.
Estimate MeanWith(const std::string& integrator, uint64_t bytes, int renders, int samples) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  overrides.values["photon-memory"] = static_cast<int64_t>(bytes);
  overrides.values["radius"] = 0.5;
  overrides.values["alpha"] = 1.0;
  overrides.values["guide-photons"] = false;
  overrides.values["connect"] = false;
  overrides.values["direct-photons"] = true;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(ParseScene(kCorner, "test.pbrt", diagnostics), overrides, true, diagnostics);
  Estimate estimate;
  for (int i = 0; i < renders; ++i) {
    built.settings.seed = static_cast<uint64_t>(i) + 1000 * bytes;
    const Image image = RenderBuilt(built, samples, 1).image;
    estimate.Add(MeanOf(image).mean);
  }
  return estimate;
}

// Weights of vcm depend on the number of paths, which leaves a bias of about 1 / n where the memory decides on n: it is
// compared with a single path and with many.
TEST(PhotonMemory, DoesNotChangeTheMean) {
  const uint64_t photon = PhotonStore::BytesPerPhoton(true);
  for (const std::string integrator : {"sppm", "vcm"}) {
    const Estimate all = MeanWith(integrator, uint64_t{1} << 30, 60, 256);
    for (const uint64_t bytes : {uint64_t{1}, integrator == "sppm" ? 5 * photon / 2 : 64 * photon}) {
      const Estimate few = MeanWith(integrator, bytes, 60, 512);
      const double error = std::sqrt(all.Variance() + few.Variance());
      std::printf("[   info   ] %-4s %5llu bytes: %+.2f +- %.2f %%\n", integrator.c_str(),
                  static_cast<unsigned long long>(bytes), 100 * (few.Mean() / all.Mean() - 1),
                  100 * error / all.Mean());
      EXPECT_LT(error, 0.01 * all.Mean()) << integrator << ", " << bytes << " bytes: too much noise to tell";
      EXPECT_LT(std::abs(few.Mean() - all.Mean()), 4 * error) << integrator << ", " << bytes << " bytes";
    }
  }
}

// The number of paths within the limit does not depend on the number of threads.
TEST(PhotonMemory, HoldsTheSamePathsOnAnyThreads) {
  RenderOverrides overrides;
  overrides.integrator = "vcm";
  overrides.width = overrides.height = 24;
  overrides.values["photon-memory"] = static_cast<int64_t>(60 << 10);
  overrides.layers = {"direct diffuse", "caustic"};
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(kCorner, "test.pbrt", diagnostics), overrides, true, diagnostics);
  const Image one = RenderBuilt(built, 3, 1).image;
  for (const int threads : {2, 3}) EXPECT_EQ(RenderBuilt(built, 3, threads).image.data, one.data) << threads;
}

}  // namespace
}  // namespace lampyr::test
