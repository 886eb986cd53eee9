// Path guiding: densities are those of the sampling, forward and reverse; fits find what the events say; what does not
// pay is turned off.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "base/byte_stream.h"
#include "base/error.h"
#include "integrators/guide/gain_estimate.h"
#include "integrators/guide/path_learning.h"
#include "integrators/walk/vertex.h"
#include "render/pass_sequence.h"
#include "support/chi_squared.h"
#include "support/random_guide.h"
#include "support/render_scene.h"

namespace lampyr::test {
namespace {

using lampyr::testing::ChiSquaredResult;
using lampyr::testing::ChiSquaredTestDirections;
using lampyr::testing::SidakLevel;

// Lobes from the widest to the narrowest, some with a place and some with a direction.
DirectionMixture SomeMixture() {
  DirectionMixture mixture;
  const float kappas[] = {0.05f, 1, 5, 30, 200, 1000, 3000, 1e5f};
  Rng rng(4);
  for (size_t i = 0; i < DirectionMixture::kLobes; ++i) {
    const Vector3 direction = SampleUniformSphere(rng.NextPoint2());
    const bool isDirection = i % 3 == 0;
    mixture.SetTarget(i, isDirection ? Point3(direction) : Point3(2.0f * direction), isDirection);
    mixture.kappaPerSquare[i] = kappas[i] / (isDirection ? 1.0f : 4.0f);
    mixture.weight[i] = 1.0f / DirectionMixture::kLobes;
  }
  return mixture;
}

TEST(DirectionMixture, SamplesFollowTheDensity) {
  const DirectionMixture mixture = SomeMixture();
  ASSERT_TRUE(mixture.IsValid());
  // The last place is that of a target.
  const Point3 places[] = {Point3(0.0f), Point3(1, 0.5f, -0.3f), Point3(-30, 2, 5),
                           Point3(mixture.x[1], mixture.y[1], mixture.z[1]), Point3(1e25f, 0, 0)};
  for (const Point3& place : places) {
    Rng rng(8);
    const ChiSquaredResult result = ChiSquaredTestDirections(
        [&]() -> std::optional<Vector3> {
          const float uLobe = rng.NextFloat();
          return mixture.Sample(place, uLobe, rng.NextPoint2());
        },
        [&](const Vector3& direction) { return static_cast<double>(mixture.Density(place, direction).value); }, 40000);
    EXPECT_GT(result.pValue, SidakLevel(5)) << place.x;
    EXPECT_NEAR(result.integral, 1, 2e-3) << place.x;
  }
}

// Two small targets, one of them far, beside what scattering does well by itself.
std::vector<GuideEvent> EventsOfTargets(const Point3& target, const Vector3& direction) {
  Rng rng(3);
  std::vector<GuideEvent> events;
  for (int i = 0; i < 6000; ++i) {
    GuideEvent event;
    event.position = Point3(rng.NextFloat(), rng.NextFloat(), 0);
    event.unguided = 0.25f * kInvPi;
    event.weight = 1;
    if (i % 2 == 0) {
      const Vector3 way = target + 0.05f * SampleUniformSphere(rng.NextPoint2()) - event.position;
      event.distance = glm::length(way);
      event.direction = way / event.distance;
    } else if (i % 4 == 1) {
      const Vector3 way = direction + 0.02f * SampleUniformSphere(rng.NextPoint2());
      event.distance = kInfinity;
      event.direction = way / glm::length(way);
    } else {
      event.distance = 5;
      event.direction = SampleUniformSphere(rng.NextPoint2());
    }
    events.push_back(event);
  }
  return events;
}

TEST(MixtureFit, FindsTargetsAndTheirShare) {
  const Point3 target(2, -1, 1.5f);
  const Vector3 direction = glm::normalize(Vector3(-1, 0.2f, 0.6f));
  const std::vector<GuideEvent> events = EventsOfTargets(target, direction);
  const Point3 center(0.5f, 0.5f, 0);
  const MixtureFit fit = FitMixture(events, center);
  // Three quarters of the events are not scattering's own, of which the guide has 0.85.
  EXPECT_NEAR(fit.share, 0.85 * 0.75, 0.02);
  double near = 0, far = 0;
  for (size_t i = 0; i < DirectionMixture::kLobes; ++i) {
    const Point3 at(fit.mixture.x[i], fit.mixture.y[i], fit.mixture.z[i]);
    const Vector3 way = at - fit.mixture.nearness[i] * center;
    const auto weight = static_cast<double>(fit.mixture.weight[i]);
    if (glm::distance(at, target) < 0.15f) near += weight;
    if (glm::distance(glm::normalize(way), direction) < 0.05f) far += weight;
  }
  EXPECT_NEAR(near, 2. / 3, 0.07);
  EXPECT_NEAR(far, 1. / 3, 0.07);
  // From elsewhere in the region the target is in another direction, and as dense.
  const Point3 elsewhere(1, 0, 0);
  EXPECT_GT(fit.mixture.Density(elsewhere, glm::normalize(target - elsewhere)).value, 20);
}

TEST(MixtureFit, LeavesToScatteringWhatItDoesWell) {
  Rng rng(3);
  std::vector<GuideEvent> events;
  for (int i = 0; i < 5000; ++i) {
    GuideEvent event;
    event.position = Point3(rng.NextFloat(), rng.NextFloat(), 0);
    event.direction = SampleCosineHemisphere(rng.NextPoint2());
    event.unguided = event.direction.z * kInvPi;
    event.distance = 1 + rng.NextFloat();
    event.weight = 1;
    events.push_back(event);
  }
  // Not 0: between densities that are alike, expectation maximisation is slow.
  EXPECT_LT(FitMixture(events, Point3(0.5f, 0.5f, 0)).share, 0.3f);
  // A few events tell nothing, and one that outweighs all others tells little.
  EXPECT_EQ(FitMixture(std::span(events).first(5), Point3(0.0f)).share, 0);
  events[0].weight = 1e9f;
  EXPECT_EQ(FitMixture(std::span(events).first(5), Point3(0.0f)).share, 0);
  for (GuideEvent& event : events) event.weight = 0;
  EXPECT_EQ(FitMixture(events, Point3(0.0f)).share, 0);
}

// A vertex whose walks are guided.
struct GuidedVertex {
  std::shared_ptr<const PathGuide> guide = RandomGuide({Point3(0.0f), 1});
  Vertex vertex;

  GuidedVertex(const BsdfModel& model, const Vector3& toPrevious) {
    const Normal3 Ng = glm::normalize(Vector3(0.3f, -0.2f, 0.9f));
    vertex.bsdf = Bsdf(Frame::FromNormal(Ng), Ng, model);
    vertex.point.position = Point3(0.2f, -0.3f, 0.1f);
    vertex.point.Ng = vertex.point.Ns = Ng;
    vertex.toPrevious = toPrevious;
    vertex.SetGuide(guide->Find(vertex.point.position, GuideSideOf(Ng)));
  }
};

std::vector<std::pair<std::string, BsdfModel>> WideModels() {
  return {{"diffuse", DiffuseBsdf{Color(0.7f)}},
          {"translucent", DiffuseTransmissionBsdf{Color(0.3f), Color(0.4f)}},
          {"medium", PhaseBsdf{Color(0.8f), 0.6f}}};
}

TEST(GuidedScattering, SamplesFollowTheDensityInBothModes) {
  int cases = 0;
  for (const auto& [name, model] : WideModels()) {
    for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
      const GuidedVertex guided(model, glm::normalize(Vector3(0.5f, 0.4f, 0.6f)));
      const Vertex& vertex = guided.vertex;
      ASSERT_TRUE(vertex.guide);
      EXPECT_GT(vertex.guide->radiance.share, 0.2f);
      EXPECT_GT(vertex.guide->importance.share, 0.2f);
      const Frame& frame = vertex.bsdf.ShadingFrame();
      Rng rng(5 + static_cast<uint64_t>(++cases));
      const ChiSquaredResult result = ChiSquaredTestDirections(
          [&]() -> std::optional<Vector3> {
            const float uLobe = rng.NextFloat();
            Guidance guidance;
            const BsdfSample sample = vertex.Sample(uLobe, rng.NextPoint2(), mode, guidance);
            if (!sample) return std::nullopt;
            return frame.ToLocal(sample.wi);
          },
          [&](const Vector3& local) {
            const BsdfEvaluation f = vertex.Evaluate(frame.ToWorld(local), mode);
            // A guided direction in which nothing is scattered ends the path.
            return f.Sum().IsBlack() ? 0.0 : static_cast<double>(f.pdfForward.value);
          },
          40000);
      EXPECT_GT(result.pValue, SidakLevel(6)) << name << ", integral " << result.integral;
    }
  }
}

TEST(GuidedScattering, SampleReportsWhatEvaluateSays) {
  Rng rng(9);
  for (const auto& [name, model] : WideModels()) {
    for (const TransportMode mode : {TransportMode::Radiance, TransportMode::Importance}) {
      const GuidedVertex guided(model, glm::normalize(Vector3(0.5f, 0.4f, 0.6f)));
      const Vertex& vertex = guided.vertex;
      for (int i = 0; i < 2000; ++i) {
        const float uLobe = rng.NextFloat();
        Guidance guidance;
        const BsdfSample sample = vertex.Sample(uLobe, rng.NextPoint2(), mode, guidance);
        if (!sample) continue;
        const BsdfEvaluation f = vertex.Evaluate(sample.wi, mode);
        EXPECT_NEAR(sample.pdfForward.value / f.pdfForward.value, 1, 2e-3) << name;
        EXPECT_NEAR(sample.pdfReverse.value / f.pdfReverse.value, 1, 2e-3) << name;
        const float weight = f.Sum().g * vertex.ScatteringCosine(sample.wi) / f.pdfForward.value;
        EXPECT_NEAR(sample.Weight().g / weight, 1, 2e-3) << name;
        const float unguided = vertex.bsdf.Evaluate(vertex.toPrevious, sample.wi, mode).pdfForward.value;
        EXPECT_NEAR(guidance.forward * unguided / f.pdfForward.value, 1, 2e-3) << name;
        // The reverse density is the forward density of the other walk, which comes from where this one goes.
        const TransportMode other =
            mode == TransportMode::Radiance ? TransportMode::Importance : TransportMode::Radiance;
        const BsdfEvaluation back = vertex.EvaluateBetween(sample.wi, vertex.toPrevious, other);
        EXPECT_NEAR(f.pdfReverse.value / back.pdfForward.value, 1, 1e-4) << name;
        EXPECT_NEAR(f.pdfForward.value / back.pdfReverse.value, 1, 1e-4) << name;
      }
    }
  }
}

// A coat that mirrors has its probability left, less the share of the guide.
TEST(GuidedScattering, LeavesDeltasTheirPart) {
  const CoatTable table(CoatDescription{1.5f, 0.01f, {0.0f}});
  const CoatedDiffuseBsdf coat({0, 0}, 1.5f, Color(0.5f), 5, table);
  const GuidedVertex guided(coat, glm::normalize(Vector3(0.5f, 0.4f, 0.6f)));
  Vertex plain = guided.vertex;
  plain.SetGuide(nullptr);
  Rng rng(2);
  const int samples = 40000;
  int deltas = 0, plainDeltas = 0;
  for (int i = 0; i < samples; ++i) {
    const float uLobe = rng.NextFloat();
    const Point2 u = rng.NextPoint2();
    Guidance guidance, none;
    const BsdfSample sample = guided.vertex.Sample(uLobe, u, TransportMode::Radiance, guidance);
    const BsdfSample without = plain.Sample(uLobe, u, TransportMode::Radiance, none);
    plainDeltas += without && without.isDelta ? 1 : 0;
    if (!sample || !sample.isDelta) continue;
    ++deltas;
    const float kept = 1 - guided.vertex.guide->radiance.share;
    EXPECT_FLOAT_EQ(guidance.forward, kept);
    EXPECT_FLOAT_EQ(guidance.reverse, 1 - guided.vertex.guide->importance.share);
  }
  ASSERT_GT(plainDeltas, 300);
  const double expected = (1 - static_cast<double>(guided.vertex.guide->radiance.share)) * plainDeltas;
  EXPECT_NEAR(deltas, expected, 6 * std::sqrt(expected));
}

std::vector<std::byte> Saved(const auto& object) {
  std::vector<std::byte> bytes;
  ByteWriter writer([&](const void* from, size_t count) {
    const auto* first = static_cast<const std::byte*>(from);
    bytes.insert(bytes.end(), first, first + count);
  });
  object.Save(writer);
  return bytes;
}

TEST(PathGuide, IsWhatItWasAfterSaving) {
  const auto guide = RandomGuide({Point3(0.0f), 2});
  EXPECT_GT(guide->Regions(), 20u);
  const std::vector<std::byte> bytes = Saved(*guide);
  PathGuide loaded;
  ByteReader reader(bytes);
  loaded.Load(reader);
  EXPECT_EQ(Saved(loaded), bytes);
  Rng rng(1);
  for (int i = 0; i < 1000; ++i) {
    const Point3 p = Point3(4.0f * (rng.NextFloat() - 0.5f), rng.NextFloat(), rng.NextFloat());
    const GuideRegion *a = guide->Find(p, static_cast<uint8_t>(i % kGuideSides)),
                      *b = loaded.Find(p, static_cast<uint8_t>(i % kGuideSides));
    EXPECT_EQ(std::memcmp(&a->radiance.mixture, &b->radiance.mixture, sizeof(DirectionMixture)), 0);
  }
}

// Whatever the bytes are, a guide is refused or sound: no place leads out of it.
TEST(PathGuide, DamagedOnesAreRefused) {
  std::vector<std::byte> bytes = Saved(*RandomGuide({Point3(0.0f), 2}));
  Rng rng(6);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::vector<std::byte> damaged = bytes;
    const size_t within = i % 2 == 0 ? std::min<size_t>(bytes.size(), 2000) : bytes.size();
    const auto at = static_cast<size_t>(rng.NextFloat() * static_cast<float>(within)) % damaged.size();
    damaged[at] = static_cast<std::byte>(rng.NextFloat() * 256);
    if (i % 5 == 0) damaged.resize(at);
    PathGuide guide;
    ByteReader reader(damaged);
    try {
      guide.Load(reader);
    } catch (const Error&) {
      ++refused;
      continue;
    }
    for (int k = 0; k < 50; ++k) {
      const GuideRegion* region = guide.Find(Point3(4.0f * (rng.NextFloat() - 0.5f), rng.NextFloat(), rng.NextFloat()),
                                             static_cast<uint8_t>(k % kGuideSides));
      if (!region || !(region->radiance.share > 0)) continue;
      EXPECT_TRUE(region->radiance.mixture.IsValid());
    }
  }
  EXPECT_GT(refused, 60);
}

// A node whose children are beyond the end, also where their number overflows 32 bits.
TEST(PathGuide, ChildrenBeyondTheEndAreRefused) {
  const std::vector<std::byte> bytes = Saved(*RandomGuide({Point3(0.0f), 2}));
  const size_t firstNode = kGuideSides * sizeof(uint32_t) + sizeof(uint64_t);  // split, axis, next
  for (const uint32_t next : {0xffffffffu, 0xfffffffeu, 70000u, 0u}) {
    std::vector<std::byte> damaged = bytes;
    std::memcpy(&damaged[firstNode + 2 * sizeof(uint32_t)], &next, sizeof next);
    PathGuide guide;
    ByteReader reader(damaged);
    EXPECT_THROW(guide.Load(reader), Error) << next;
  }
}

// Paths whose second moments are 3 without a guide and 1.5 with one, in the mean, and vary together; squared mean: 1.
GainEstimate EstimateOf(int paths, uint64_t seed) {
  GainEstimate estimate;
  Rng rng(seed);
  for (int i = 0; i < paths; ++i) {
    const double common = -std::log(1 - static_cast<double>(rng.NextFloat()));
    estimate.Add(3 * common, common * (1 + static_cast<double>(rng.NextFloat())));
  }
  estimate.SetSquaredMeans(paths);
  return estimate;
}

TEST(GainEstimate, BoundsHoldTheGainAsOftenAsTheySay) {
  const double gain = (3 - 1) / (1.5 - 1);
  int above = 0, below = 0;
  const int estimates = 400;
  for (int i = 0; i < estimates; ++i) {
    const GainEstimate estimate = EstimateOf(2000, static_cast<uint64_t>(i));
    EXPECT_LT(estimate.Bound(-2), estimate.Bound(-1));
    EXPECT_LT(estimate.Bound(-1), estimate.Ratio());
    EXPECT_LT(estimate.Ratio(), estimate.Bound(1));
    EXPECT_LT(estimate.Bound(1), estimate.Bound(2));
    above += estimate.Bound(-1) > gain ? 1 : 0;
    below += estimate.Bound(1) < gain ? 1 : 0;
  }
  // 15.9 % of a normal distribution are beyond one deviation; of 400, 63 with a deviation of 7.
  EXPECT_NEAR(above, 63, 30);
  EXPECT_NEAR(below, 63, 30);
}

TEST(GainEstimate, IsCertainOfWhatNeverDiffers) {
  GainEstimate estimate;
  Rng rng(1);
  for (int i = 0; i < 100; ++i) {
    const double moment = 1 + static_cast<double>(rng.NextFloat());
    estimate.Add(moment, moment);
  }
  EXPECT_NEAR(estimate.Bound(-2), 1, 1e-6);
  EXPECT_NEAR(estimate.Bound(2), 1, 1e-6);
}

TEST(GainEstimate, OnePathThatOutweighsAllOthersIsNoCertainty) {
  GainEstimate estimate = EstimateOf(500, 1);
  EXPECT_GT(estimate.Bound(-2), 1);
  estimate.Add(1e6, 10);
  EXPECT_GT(estimate.Ratio(), 100);
  EXPECT_GT(estimate.EffectiveCount(), 100);
  EXPECT_LT(estimate.Bound(-2), 1);
}

// Learning of an image of 256 × 144 pixels from paths that a guide would not help: all light comes evenly.
struct EvenLight {
  static constexpr uint32_t kPixels = 256 * 144;
  PathLearning learning{256, 144, kPixels, false, false};
  size_t paths = 0;

  void Add(uint32_t first, uint32_t end) {
    Rng rng(first);
    std::vector<PathRecords> records(1);
    records[0].SetFraction(learning.Fraction());
    for (uint32_t sample = first; sample < end; ++sample)
      for (uint32_t pixel = 0; pixel < kPixels; ++pixel) AddPath(pixel, sample, rng, records[0]);
    paths += records[0].Paths().size();
    learning.Learn(records);
    learning.Decide(end, 1);
  }

 private:
  static void AddPath(uint32_t pixel, uint32_t sample, Rng& rng, PathRecords& records) {
    if (!records.Wants(MixBits(uint64_t{pixel} << 32 | sample))) return;
    records.StartPath(pixel, sample);
    for (int i = 0; i < 2; ++i) {
      RecordedEvent event;
      event.position = Point3(rng.NextFloat(), rng.NextFloat(), 0);
      event.direction = SampleCosineHemisphere(rng.NextPoint2());
      event.unguided = event.direction.z * kInvPi;
      event.distance = 1 + rng.NextFloat();
      event.foundBefore = static_cast<float>(i);
      records.Add(event);
    }
    records.EndPath(2 + rng.NextFloat(), 3);
  }
};

TEST(PathLearning, GivesUpAfterAFewPercentOfAShortRender) {
  EvenLight light;
  for (const uint32_t samples : {1u, 2u, 4u, 8u}) light.Add(samples / 2, samples);
  EXPECT_FALSE(light.learning.IsRecording());
  EXPECT_FALSE(light.learning.Guide());
  EXPECT_GT(light.paths, 5000u);
  EXPECT_LT(static_cast<double>(light.paths), 0.05 * 8 * EvenLight::kPixels);
}

// A box with a lamp in a niche that faces away: all light arrives by way of a small bright patch of wall.
std::string Niche(bool isOpen) {
  const std::string wall = "Shape \"bilinearmesh\" \"point3 P\" ";
  std::string text =
      "Film \"rgb\" \"integer xresolution\" 48 \"integer yresolution\" 32\nPixelFilter \"box\"\n"
      "Integrator \"path\" \"integer maxdepth\" 6\nLookAt 0 0 0.9  0 0 -1  0 1 0\nCamera \"perspective\" \"float fov\" "
      "60\n"
      "WorldBegin\nMaterial \"diffuse\" \"rgb reflectance\" [0.7 0.7 0.7]\n" +
      wall + "[-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1]\n" + wall + "[-1 -1 1  1 -1 1  -1 1 1  1 1 1]\n" + wall +
      "[-1 -1 -1  -1 -1 1  -1 1 -1  -1 1 1]\n" + wall + "[1 -1 -1  1 -1 1  1 1 -1  1 1 1]\n" + wall +
      "[-1 -1 -1  1 -1 -1  -1 -1 1  1 -1 1]\n" + wall + "[-1 1 -1  1 1 -1  -1 1 1  1 1 1]\n";
  if (!isOpen) {
    // A tube around the lamp, open towards the ceiling.
    text +=
        "AttributeBegin Translate 0.6 0.35 0 Rotate -90 1 0 0\nMaterial \"diffuse\" \"rgb reflectance\" [0.05 0.05 "
        "0.05]\nShape \"cylinder\" \"float radius\" 0.12 \"float zmin\" -0.2 \"float zmax\" 0.4\n"
        "Translate 0 0 -0.2 Shape \"disk\" \"float radius\" 0.12 AttributeEnd\n";
  }
  return text +
         "AttributeBegin Translate 0.6 0.3 0 AreaLightSource \"diffuse\" \"rgb L\" [90 80 70] Shape \"sphere\" "
         "\"float radius\" 0.06 AttributeEnd\n";
}

struct Learned {
  double gain = 0;
  size_t regions = 0;
};

// Learns a scene by path tracing, with this many samples.
Learned Learn(const std::string& text, uint32_t samples) {
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  const BuiltScene built = BuildScene(ParseScene(text, "test.pbrt", diagnostics), {}, true, diagnostics);
  const std::unique_ptr<Integrator> integrator = MakeIntegrator(built.scene, built.settings);
  Film film(built.settings.width, built.settings.height, built.settings.crop, built.scene.outputs->Names());
  PassSequence passes(built.scene, *integrator, built.settings, 2, film);
  passes.Add(0, samples);
  return {passes.Guiding().gain, passes.Guiding().regions};
}

TEST(PathLearning, GuidesWhereItPays) {
  const Learned hidden = Learn(Niche(false), 16), open = Learn(Niche(true), 16);
  EXPECT_GT(hidden.regions, 0u);
  EXPECT_GT(hidden.gain, 1.5);
  EXPECT_EQ(open.regions, 0u) << open.gain;
}

// The error falls, and the mean stays.
TEST(PathLearning, LowersTheError) {
  const auto render = [](bool guides, uint64_t seed) {
    RenderOverrides overrides;
    overrides.values["guide-paths"] = guides;
    overrides.seed = seed;
    return MeanOf(RenderText(Niche(false), 128, overrides, 2).image);
  };
  double guidedMean = 0, plainMean = 0, guidedVariance = 0, plainVariance = 0;
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const MeanValue guided = render(true, seed), plain = render(false, seed);
    guidedMean += guided.mean;
    plainMean += plain.mean;
    guidedVariance += guided.standardError * guided.standardError;
    plainVariance += plain.standardError * plain.standardError;
  }
  EXPECT_LT(guidedVariance, 0.6 * plainVariance);
  EXPECT_NEAR(guidedMean, plainMean, 3.5 * std::sqrt(guidedVariance + plainVariance));
}

}  // namespace
}  // namespace lampyr::test
