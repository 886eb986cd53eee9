// The energy of light paths in media: in a closed box everything that is emitted is absorbed, by walls and by media.
#include "integrators/known_media.h"
#include "integrators/walk/light_path.h"

namespace lampyr::test {
namespace {

constexpr double kReflectance = 0.6;
constexpr int kBatches = 32, kPathsOfBatch = 8192;

// Adds up what the vertices of light paths absorb.
class Absorption final : public LightPathVisitor {
 public:
  explicit Absorption(const RenderScene& scene) : scene_(scene) {}

  void Arrived(LightPath& path, const PathState&) override {
    const PathVertex& vertex = path.vertices.Last();
    Color absorbed(static_cast<float>(1 - kReflectance));
    // The throughput at a collision is over the density of a collision at that length, of which the extinction is a
    // factor.
    if (vertex.IsInMedium())
      absorbed = scene_.media[static_cast<size_t>(vertex.insideMedium)]->At(vertex.point.position).absorption;
    const Color flux = vertex.diffuse * absorbed * scene_.lighting->FluxUnit();
    Radiance& sum = vertex.IsInMedium() ? inMedia : atWalls;
    sum[0] += static_cast<double>(flux.r);
    sum[1] += static_cast<double>(flux.g);
    sum[2] += static_cast<double>(flux.b);
  }

  Radiance inMedia{}, atWalls{};  // W, summed over paths

 private:
  const RenderScene& scene_;
};

// `emitted`: W.
void ExpectBalance(const std::string& what, const std::string& world, const Radiance& emitted) {
  const std::string text =
      "Film \"rgb\" \"integer xresolution\" 4 \"integer yresolution\" 4\nLookAt 0 0 0.9  0 0 0  0 "
      "1 0\nCamera \"perspective\"\nWorldBegin\n" +
      world +
      "Material \"diffuse\" \"rgb reflectance\" [0.6 0.6 0.6]\nShape \"trianglemesh\" \"point3 P\" "
      "[-1 -1 -1 1 -1 -1 1 1 -1 -1 1 -1 -1 -1 1 1 -1 1 1 1 1 -1 1 1] \"integer indices\" [0 2 1 0 3 "
      "2 4 5 6 4 6 7 0 1 5 0 5 4 3 6 2 3 7 6 0 7 3 0 4 7 1 2 6 1 6 5]\n";
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(text, "balance.pbrt", diagnostics), {}, true, diagnostics);
  const RenderScene& scene = built.scene;
  const GlowingMedia glowing(scene);
  Sampler sampler(SamplerKind::Independent, 7);
  RenderCounts counts;
  const SampleContext context{scene, sampler, 0, counts};
  LightPath path(false);
  std::array<std::vector<double>, 3> sums;
  double inMedia = 0, all = 0;
  for (int batch = 0; batch < kBatches; ++batch) {
    Absorption absorption(scene);
    for (int i = 0; i < kPathsOfBatch; ++i) {
      sampler.StartPixelSample(1, 0, static_cast<uint32_t>(batch * kPathsOfBatch + i));
      TraceLightPath(context, 10000, {}, path, absorption, glowing.Probability() > 0 ? &glowing : nullptr);
    }
    for (size_t c = 0; c < 3; ++c) {
      sums[c].push_back((absorption.inMedia[c] + absorption.atWalls[c]) / kPathsOfBatch);
      inMedia += absorption.inMedia[c];
      all += absorption.inMedia[c] + absorption.atWalls[c];
    }
  }
  EXPECT_EQ(counts.droppedSamples + scene.geometry->RejectedRays(), 0u);
  EXPECT_GT(inMedia, 0.1 * all) << "little that media absorb is no test of them";
  EXPECT_LT(inMedia, 0.95 * all);
  const double student = StudentQuantileTwoSided(SidakRate(1e-3, kMostMediaComparisons), kBatches - 1);
  std::printf("%-24s %2.0f %% absorbed in media", what.c_str(), 100 * inMedia / all);
  for (size_t c = 0; c < 3; ++c) {
    const auto moments = replicas_internal::MomentsOf(sums[c]);
    const double error = std::sqrt(moments.variance);
    std::printf("  %+.3f %% +- %.3f %%", 100 * (moments.mean / emitted[c] - 1), 100 * error / emitted[c]);
    EXPECT_LE(error, 0.002 * emitted[c]) << what << ": too noisy";
    EXPECT_NEAR(moments.mean, emitted[c], student * error) << what << ", channel " << c;
  }
  std::printf("\n");
}

const std::string kBulb =
    "AttributeBegin MediumInterface \"\" \"gas\" LightSource \"point\" \"rgb I\" [1 2 3] \"point3 from\" [0.3 0.2 0.1] "
    "AttributeEnd\n";
const Radiance kOfBulb = {4 * M_PI, 8 * M_PI, 12 * M_PI};

std::string BallOf(double radius) {
  return "AttributeBegin Material \"interface\" MediumInterface \"gas\" \"\" Shape \"sphere\" \"float radius\" " +
         std::to_string(radius) + " AttributeEnd\n";
}

TEST(MediaEnergy, OfALampInAMediumOfColours) {
  for (const double g : {0.0, 0.8, -0.5})
    ExpectBalance("g " + std::to_string(g), Homogeneous("gas", {1.5, 1.2, 1}, {0.4, 0.5, 0.7}, g) + BallOf(0.9) + kBulb,
                  kOfBulb);
}

TEST(MediaEnergy, OfALampInAGrid) {
  ExpectBalance("grid of colours", RgbGrid(-1, 0.4) + BallOf(0.95) + kBulb, kOfBulb);
}

// 4π σ_a L_e V of the ball.
TEST(MediaEnergy, OfAGlowBesideALamp) {
  const double radius = 0.7, volume = 4 * M_PI / 3 * radius * radius * radius;
  const Radiance absorption = {0.4, 0.5, 0.7};
  Radiance emitted;
  for (size_t c = 0; c < 3; ++c) emitted[c] = kOfBulb[c] + 4 * M_PI * absorption[c] * 2 * volume;
  ExpectBalance("glow",
                Homogeneous("gas", {1.5, 1.2, 1}, absorption, 0.2, Rgb("Le", {2, 2, 2})) + BallOf(radius) + kBulb,
                emitted);
}

}  // namespace
}  // namespace lampyr::test
