// The weights of bidirectional path tracing and of vertex merging, path by path: the recursive ones are those of the
// explicit densities, and those of all techniques of a path sum to 1.
#include <gtest/gtest.h>

#include <array>
#include <map>

#include "agreement/agreement_scenes.h"
#include "integrators/bdpt/bdpt_integrator.h"
#include "integrators/bdpt/full_path.h"
#include "integrators/common/light_subpath.h"
#include "support/aimed.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

struct Worst {
  int paths = 0;
  std::map<std::pair<int, int>, int> perTechnique;
  double sum = 0;        // |Σ weights - 1|
  double recursion = 0;  // between the two ways of weighing the same densities
  double reported = 0;   // between the integrator's weight and that of the densities asked for anew
  int merges = 0;
};

// Light paths that leave photons, kept whole, so that a merge can be unfolded: a photon is known by what it carries.
class KeptLightPaths final : public LightSubpathVisitor {
 public:
  void Arrived(const LightSubpath& path) override {
    if (!path.Last().storesPhotons) return;
    photons.Add(path.Last(), static_cast<int>(path.count));
    const auto vertices = path.vertices.begin();
    const PathVertex& last = path.Last();
    paths_[KeyOf(last.toPrevious, last.diffuse, last.weight.connect, static_cast<float>(last.previousPerSolidAngle),
                 path.count)] = {{vertices, vertices + static_cast<std::ptrdiff_t>(path.count)}, path.end};
  }
  struct Kept {
    std::vector<PathVertex> vertices;
    LightEnd end;
  };
  const Kept& PathOf(const Photon& photon) const {
    return paths_.at(KeyOf(photon.toPrevious, photon.flux, photon.connect, photon.previousPerSolidAngle, photon.depth));
  }

  PhotonList photons;

 private:
  using Key = std::array<double, 9>;
  static Key KeyOf(const Vector3& d, const Color& c, double connect, float perSolidAngle, size_t depth) {
    return {d.x, d.y, d.z, c.r, c.g, c.b, connect, perSolidAngle, static_cast<double>(depth)};
  }
  std::map<Key, Kept> paths_;
};

class WeightChecker final : public PathObserver {
 public:
  explicit WeightChecker(const KeptLightPaths& kept) : kept_(kept) {}
  void ObserveMerge(const ConnectedPath& path, const Photon& photon) override {
    ConnectedPath merged = path;
    const KeptLightPaths::Kept& light = kept_.PathOf(photon);
    ASSERT_EQ(photon.depth, light.vertices.size());
    merged.light = light.vertices;
    merged.end = light.end;
    merged.toLight = light.vertices[0].toPrevious;
    ++worst_.merges;
    Observe(merged);
  }
  void Observe(const ConnectedPath& path) override {
    const FullPath full = Unfold(path);
    const std::vector<double> expected = WeightsByDensities(full), recursive = WeightsByRecursion(full);
    ++worst_.paths;
    if (!path.isMerged) ++worst_.perTechnique[{path.s, path.t}];
    double sum = 0;
    for (size_t s = 0; s < expected.size(); ++s) {
      sum += recursive[s];
      worst_.recursion = std::max(worst_.recursion, std::abs(recursive[s] - expected[s]));
    }
    worst_.sum = std::max(worst_.sum, std::abs(sum - 1));
    worst_.reported = std::max(worst_.reported, std::abs(path.weight - expected[static_cast<size_t>(full.technique)]));
  }
  const Worst& Result() const { return worst_; }

 private:
  const KeptLightPaths& kept_;
  Worst worst_;
};

// With photons gathered within `radius`, in parts of the scene's; 0: none. Aimed: at two balls in its middle.
Worst CheckScene(const std::string& text, int paths, float radius = 0, bool aimed = false) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const std::filesystem::path file = std::filesystem::path(LAMPYR_SOURCE_DIR) / "scenes" / "test.pbrt";
  const BuiltScene built = BuildScene(ParseScene(text, file, diagnostics), {}, true, diagnostics);
  const BoundingSphere& sphere = built.scene.lighting->SceneSphere();
  const auto guide = AimAt(*built.scene.lighting, sphere.center, 0.2f * sphere.radius);
  if (aimed) built.scene.lighting->AimBy(guide.get());
  BdptSettings settings;
  settings.maxDepth = built.settings.maxDepth;
  const int width = built.settings.width, height = built.settings.height;
  settings.filmPixels = static_cast<double>(width) * static_cast<double>(height);
  settings.merges = radius > 0;
  const auto integrator = MakeBdptIntegrator(built.scene, settings);
  Sampler sampler(SamplerKind::Independent, 5);
  KeptLightPaths kept;
  PhotonPass gather;
  RenderCounts counts;
  if (radius > 0) {
    gather.lightPaths = 2000;
    gather.radius = radius * sphere.radius;
    const LightSubpathTracer tracer(built.scene, settings.maxDepth, {2, 1}, LightSubpathTracer::Weights::All);
    LightSubpath path;
    for (uint32_t i = 0; i < 2000; ++i) {
      sampler.StartPixelSample(1, 0, i);
      tracer.Trace(0.5f, sampler, counts, path, kept);
    }
    gather.map = std::make_shared<PhotonMap>(std::span(&kept.photons, 1), Mis(gather.MergesPerDensity()), 1);
  }
  WeightChecker checker(kept);
  SplatList splats({0, 0}, {static_cast<float>(width), static_cast<float>(height)}, 1);
  for (uint32_t index = 0; checker.Result().paths < paths && index < 100000; ++index) {
    sampler.StartPixelSample(0, 0, index);
    splats.Clear();
    splats.StartPath();
    sampler.SetDimension(dimensions::kFilm);
    const Point2 u = sampler.Get2D(), lens = sampler.Get2D();
    const float time = built.scene.hasMotion ? sampler.Get1D() : 0.0f;
    const Point2 film(u.x * static_cast<float>(width), u.y * static_cast<float>(height));
    const CameraRay ray = built.scene.camera->GenerateRay(film, lens, time);
    integrator->Sample(&ray.ray, time, sampler, {splats, counts, &checker, radius > 0 ? &gather : nullptr});
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

TEST(BdptWeights, WithMergingInEveryAgreementScene) {
  int merges = 0;
  for (const AgreementScene& scene : AgreementScenes()) {
    // Wherever photons are aimed, weights know it.
    for (const bool aimed : {false, true}) {
      const Worst worst = CheckScene(scene.text, 4000, aimed ? 0.1f : 0.003f, aimed);
      EXPECT_GE(worst.paths, 4000) << scene.name;
      ExpectExact(scene.name, worst);
      merges += worst.merges;
      std::printf("%-20s %d paths, %d merged, sums off by %.1e, recursion %.1e, reported %.1e\n", scene.name,
                  worst.paths, worst.merges, worst.sum, worst.recursion, worst.reported);
    }
  }
  EXPECT_GT(merges, 20000);
}

// Mirrors, smooth glass, what only passes through, and mixes that are now matte and now a mirror: deltas in all places
// of a path.
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
MakeNamedMaterial "white" "string type" "diffuse"
MakeNamedMaterial "mirror" "string type" "conductor"
MakeNamedMaterial "both" "string type" "mix" "string materials" [ "white" "mirror" ]
AttributeBegin
NamedMaterial "both"
Translate -0.3 0.2 0.9 Shape "sphere" "float radius" 0.2
Translate 0.7 0 0 Shape "sphere" "float radius" 0.2
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
    const Worst merging = CheckScene(FilmWith("box") + kDown + World(7) + lamp + kThings + glass, 20000, 0.05f);
    EXPECT_GT(merging.merges, 1000);
    ExpectExact(lamp.c_str(), merging);
    std::printf("%d paths, %d merged, sums off by %.1e, recursion %.1e, reported %.1e\n", merging.paths, merging.merges,
                merging.sum, merging.recursion, merging.reported);
  }
}

}  // namespace
}  // namespace lampyr::test
