// The weights of bidirectional path tracing, path by path: the recursive ones are those of the explicit densities, and
// those of all techniques of a path sum to 1.
#include <gtest/gtest.h>

#include <map>

#include "agreement/agreement_scenes.h"
#include "integrators/bdpt/bdpt_integrator.h"
#include "integrators/bdpt/full_path.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

struct Worst {
  int paths = 0;
  std::map<std::pair<int, int>, int> perTechnique;
  double sum = 0;        // |Σ weights - 1|
  double recursion = 0;  // between the two ways of weighing the same densities
  double reported = 0;   // between the integrator's weight and that of the densities asked for anew
};

class WeightChecker final : public PathObserver {
 public:
  void Observe(const ConnectedPath& path) override {
    const FullPath full = Unfold(path);
    const std::vector<double> expected = WeightsByDensities(full), recursive = WeightsByRecursion(full);
    ++worst_.paths;
    ++worst_.perTechnique[{path.s, path.t}];
    double sum = 0;
    for (size_t s = 0; s < expected.size(); ++s) {
      sum += recursive[s];
      worst_.recursion = std::max(worst_.recursion, std::abs(recursive[s] - expected[s]));
    }
    worst_.sum = std::max(worst_.sum, std::abs(sum - 1));
    worst_.reported = std::max(worst_.reported, std::abs(path.weight - expected[static_cast<size_t>(path.s)]));
  }
  const Worst& Result() const { return worst_; }

 private:
  Worst worst_;
};

Worst CheckScene(const std::string& text, int paths) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::filesystem::path file = std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes" / "test.pbrt";
  const BuiltScene built = BuildScene(ParseScene(text, file, diagnostics), {}, true, diagnostics);
  BdptSettings settings;
  settings.maxDepth = built.settings.maxDepth;
  const int width = built.settings.width, height = built.settings.height;
  settings.filmPixels = static_cast<double>(width) * static_cast<double>(height);
  const auto integrator = MakeBdptIntegrator(built.scene, settings);
  WeightChecker checker;
  Sampler sampler(SamplerKind::Independent, 5);
  SplatList splats({0, 0}, {static_cast<float>(width), static_cast<float>(height)}, 1);
  RenderCounts counts;
  for (uint32_t index = 0; checker.Result().paths < paths && index < 100000; ++index) {
    sampler.StartPixelSample(0, 0, index);
    splats.Clear();
    splats.StartPath();
    sampler.SetDimension(dimensions::kFilm);
    const Point2 u = sampler.Get2D(), lens = sampler.Get2D();
    const float time = built.scene.hasMotion ? sampler.Get1D() : 0.0f;
    const Point2 film(u.x * static_cast<float>(width), u.y * static_cast<float>(height));
    const CameraRay ray = built.scene.camera->GenerateRay(film, lens, time);
    integrator->Sample(&ray.ray, time, sampler, {splats, counts, &checker});
  }
  return checker.Result();
}

void ExpectExact(const char* name, const Worst& worst) {
  EXPECT_LT(worst.sum, 1e-6) << name;
  EXPECT_LT(worst.recursion, 1e-6) << name;
  // Densities are floats, here of the event as seen from the other end: narrow lobes amplify how directions are
  // rounded.
  EXPECT_LT(worst.reported, 5e-5) << name;
}

TEST(BdptWeights, InEveryAgreementScene) {
  std::map<std::pair<int, int>, int> techniques;
  for (const AgreementScene& scene : AgreementScenes()) {
    const Worst worst = CheckScene(scene.text, 4000);
    EXPECT_GE(worst.paths, 4000) << scene.name;
    ExpectExact(scene.name, worst);
    for (const auto& [technique, count] : worst.perTechnique) techniques[technique] += count;
    std::printf("%-20s %d paths, sums off by %.1e, recursion %.1e, reported %.1e\n", scene.name, worst.paths, worst.sum,
                worst.recursion, worst.reported);
  }
  for (int events = 0; events <= 3; ++events) {
    for (int s = 0; s <= events + 1; ++s) {
      const std::pair<int, int> technique(s, events + 2 - s);
      EXPECT_GT(techniques[technique], 100) << "(" << s << "," << events + 2 - s << ")";
    }
  }
}

// Mirrors, smooth glass and what only passes through: deltas in all places of a path.
TEST(BdptWeights, WithDeltas) {
  const std::string glass = R"(AttributeBegin
Material "dielectric" "float eta" 1.5
Translate 0 0.6 0 Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.9 0.9]
Translate 0 0.5 -1 Shape "disk" "float radius" 0.8
AttributeEnd
AttributeBegin
Material "thindielectric"
Translate 0.5 0.9 0.2 Rotate 80 1 0 0 Shape "disk" "float radius" 0.5
AttributeEnd
)";
  const std::string lamps[] = {"LightSource \"point\" \"rgb I\" [5 4 3] \"point3 from\" [0.4 2 0.4]\n",
                               "LightSource \"distant\" \"rgb L\" [2 2 3] \"point3 from\" [1 2 0.5]\n",
                               "LightSource \"infinite\" \"rgb L\" [0.5 0.6 0.8]\n", Square("\"rgb L\" [9 9 9]", 0.3)};
  for (const std::string& lamp : lamps) {
    const Worst worst = CheckScene(FilmWith("box") + kDown + World(7) + lamp + kThings + glass, 20000);
    EXPECT_GE(worst.paths, 20000);
    ExpectExact(lamp.c_str(), worst);
    std::printf("%d paths, sums off by %.1e, recursion %.1e, reported %.1e\n", worst.paths, worst.sum, worst.recursion,
                worst.reported);
  }
}

}  // namespace
}  // namespace lampyr::test
