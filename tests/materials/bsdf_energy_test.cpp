// Reciprocity, the relation of radiance and importance, energy, white furnaces, and extremes.
#include <gtest/gtest.h>

#include "materials/model_table.h"

namespace lampyr::testing {
namespace {

struct Mean {
  double sum = 0, squares = 0;
  int count = 0;
  void Add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double Value() const { return sum / count; }
  double Error() const { return std::sqrt(std::max(0.0, squares / count - Value() * Value()) / count); }
};

// Directional albedo by sampling: of flux by default.
Mean Albedo(const Bsdf& bsdf, const Vector3& wo, int samples, uint64_t seed,
            TransportMode mode = TransportMode::Importance) {
  Mean mean;
  Rng rng(seed);
  for (int i = 0; i < samples; ++i) {
    const float uLobe = rng.NextFloat();
    Bsdf followed = bsdf;
    followed.SetLane(i % 3);
    const auto sample = followed.Sample(wo, uLobe, rng.NextPoint2(), mode);
    // The weights of a dispersive model differ by lane. A refraction is that of one lane in three.
    const Color weight = sample.Weight() * (sample.isDispersion ? 3.0f : 1.0f);
    mean.Add(sample ? static_cast<double>(bsdf.IsDispersive() ? weight.Average() : weight.Max()) : 0.0);
  }
  return mean;
}

// f(wo→wi) for radiance is f(wi→wo) for importance; within one mode, refraction differs by η², reflection not at all,
// and hair by its tilted scales.
TEST(BsdfEnergy, ReciprocityAndAdjoint) {
  ModelTables tables;
  int compared = 0;
  for (const TestModel& model : AllModels(tables)) {
    const Bsdf bsdf = MakeBsdf(model.model);
    Rng rng(3);
    for (int i = 0; i < 1000; ++i) {
      const Vector3 wo = SampleUniformSphere(rng.NextPoint2());
      const float uLobe = rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), TransportMode::Radiance);
      if (!sample || sample.isDelta) continue;
      const Vector3 wi = sample.wi;
      if (AbsDot(wi, bsdf.ShadingFrame().z) < 1e-3f || AbsDot(wo, bsdf.ShadingFrame().z) < 1e-3f) continue;
      const Color radiance = bsdf.Evaluate(wo, wi, TransportMode::Radiance).Sum();
      const Color importance = bsdf.Evaluate(wo, wi, TransportMode::Importance).Sum();
      const Color adjoint = bsdf.Evaluate(wi, wo, TransportMode::Importance).Sum();
      EXPECT_NEAR(adjoint.g, radiance.g, model.tolerance * radiance.g) << model.name;
      ++compared;
      if (model.isHair || !model.isReciprocal) continue;
      // The green lane, whichever was sampled.
      const auto* dispersive = std::get_if<DispersiveBsdf>(&model.model);
      const bool isRefracted = sample.eta != 1, isInside = glm::dot(wo, bsdf.ShadingFrame().z) < 0;
      const float ofLane =
          dispersive && isRefracted ? (isInside ? 1 / dispersive->eta.g : dispersive->eta.g) : sample.eta;
      const float etaSquared = ofLane * ofLane;
      EXPECT_NEAR(importance.g, radiance.g * etaSquared, 1e-4f * importance.g) << model.name;
    }
  }
  EXPECT_GT(compared, 10000);
}

TEST(BsdfEnergy, NoModelGainsEnergy) {
  ModelTables tables;
  for (const TestModel& model : AllModels(tables)) {
    const Bsdf bsdf = MakeBsdf(model.model);
    for (const Vector3& local : LocalDirections()) {
      // Hair's energy is that of the radiance which a fibre scatters.
      const TransportMode mode = model.isHair ? TransportMode::Radiance : TransportMode::Importance;
      const Mean albedo = Albedo(bsdf, bsdf.ShadingFrame().ToWorld(local), 4000, 5, mode);
      EXPECT_LE(albedo.Value(), 1.003 + 4.5 * albedo.Error()) << model.name << " from z = " << local.z;
      // Energy lost by single scattering at microfacets is lost, most of it inside rough glass.
      EXPECT_GE(albedo.Value(), model.lossless ? 0.64 : 0.0) << model.name << " from z = " << local.z;
    }
  }
}

TEST(BsdfEnergy, SmoothGlassLosesNothing) {
  for (const float eta : {0.75f, 1.0f, 1.0001f, 1.5f, 2.4f}) {
    for (const BsdfModel& model : {BsdfModel(DielectricBsdf{{}, eta}), BsdfModel(ThinDielectricBsdf{eta})}) {
      const Bsdf bsdf = MakeBsdf(model);
      Rng rng(9);
      for (int i = 0; i < 2000; ++i) {
        const Vector3 wo = SampleUniformSphere(rng.NextPoint2());
        const float uLobe = rng.NextFloat();
        const Point2 u = rng.NextPoint2();
        const auto importance = bsdf.Sample(wo, uLobe, u, TransportMode::Importance);
        const auto radiance = bsdf.Sample(wo, uLobe, u, TransportMode::Radiance);
        ASSERT_TRUE(importance && radiance);
        EXPECT_EQ(importance.Weight(), Color(1.0f));
        EXPECT_NEAR(radiance.Weight().g * radiance.eta * radiance.eta, 1, 1e-6f);
        EXPECT_TRUE(eta != 1 || glm::length(importance.wi + wo) < 1e-6f);
      }
    }
  }
}

TEST(BsdfEnergy, LosslessCoatOverWhite) {
  ModelTables tables;
  for (const float eta : {1.0f, 1.2f, 1.5f, 2.0f}) {
    const Bsdf diffuse = MakeBsdf(MakeCoated(tables, {}, eta, Color(1.0f), 0, 1000000));
    const Bsdf metal = MakeBsdf(MakeCoatedMetal(tables, {}, {}, eta, Color(1.0f), Color(1e6f), 0, 1000000));
    for (const Vector3& local : LocalDirections()) {
      const Vector3 wo = diffuse.ShadingFrame().ToWorld(local);
      const Mean albedo = Albedo(diffuse, wo, 20000, 13);
      EXPECT_NEAR(albedo.Value(), 1, 3e-3 + 4 * albedo.Error()) << "eta " << eta << ", z = " << local.z;
      EXPECT_NEAR(metal.Sample(wo, 0.5f, {0.5f, 0.5f}, TransportMode::Importance).Weight().g, 1, 2e-3) << "eta " << eta;
    }
  }
}

// Roughness from 0 to 1, η from under 1 to diamond, directions down to the horizon: everything is finite and not
// negative.
TEST(BsdfExtremes, EverythingIsFinite) {
  ModelTables tables;
  Rng rng(17);
  int samples = 0;
  const auto check = [&](const BsdfModel& model, const std::string& name) {
    const Bsdf bsdf = MakeBsdf(model);
    const auto finite = [](float x) { return x >= 0 && x < kInfinity; };
    for (int i = 0; i < 3000; ++i) {
      Vector3 local = SampleUniformSphere(rng.NextPoint2());
      if (i % 3 == 0)
        local = glm::normalize(Vector3(local.x, local.y, local.z * std::pow(10.0f, -8 * rng.NextFloat())));
      if (i % 7 == 0) local = {0, 0, i % 2 ? 1 : -1};
      if (i % 11 == 0) local = {1, 0, 0};
      const Vector3 wo = bsdf.ShadingFrame().ToWorld(local);
      const TransportMode mode = i % 2 ? TransportMode::Radiance : TransportMode::Importance;
      Point2 u = rng.NextPoint2();
      if (i % 5 == 0) u = {i % 2 ? 0.0f : kOneMinusEpsilon, i % 4 < 2 ? 0.0f : kOneMinusEpsilon};
      const float uLobe = i % 13 == 0 ? 0.0f : i % 17 == 0 ? kOneMinusEpsilon : rng.NextFloat();
      const auto sample = bsdf.Sample(wo, uLobe, u, mode);
      const Vector3 wi = sample && i % 2 ? sample.wi : i % 3 ? SampleUniformSphere(rng.NextPoint2()) : -wo;
      const BsdfEvaluation value = bsdf.Evaluate(wo, wi, mode);
      ASSERT_TRUE(value.diffuse.IsValid() && value.specular.IsValid() && finite(value.pdfForward.value) &&
                  finite(value.pdfReverse.value))
          << name << ", wo z " << local.z << ", f " << value.specular.g << ", pdf " << value.pdfForward.value
          << ", reverse " << value.pdfReverse.value;
      if (!sample) continue;
      ASSERT_TRUE(IsFinite(sample.wi) && sample.Weight().IsValid() && finite(sample.pdfForward.value) &&
                  finite(sample.pdfReverse.value))
          << name << ", wo z " << local.z << ", weight " << sample.Weight().g;
      ASSERT_LT(sample.Weight().Max() * std::min(1.0f, sample.eta * sample.eta), 1000) << name << ", wo z " << local.z;
      ++samples;
    }
  };
  for (const float alpha : {0.0f, 1e-5f, 1e-3f, 0.0011f, 0.01f, 0.3f, 1.0f, 5.0f}) {
    for (const TrowbridgeReitz& ggx : {TrowbridgeReitz(alpha, alpha), TrowbridgeReitz(alpha, 1e-5f)}) {
      const std::string name = "alpha " + std::to_string(ggx.alphaX) + " x " + std::to_string(ggx.alphaY);
      for (const float k : {0.0f, 3.0f, 1e6f}) check(ConductorBsdf{ggx, Color(0.2f), Color(k)}, name + " conductor");
      check(ConductorBsdf{ggx, Color(0.0f), Color(0.0f)}, name + " conductor 0");
      check(ConductorBsdf{ggx, Color(1.0f), Color(0.0f)}, name + " conductor 1");
      for (const float eta : {0.01f, 0.66f, 0.9999f, 1.0f, 1.0000001f, 1.0001f, 1.5f, 2.4f, 100.0f}) {
        check(DielectricBsdf{ggx, eta}, name + " dielectric " + std::to_string(eta));
        if (alpha > 0 && alpha < 0.3f && eta != 1.5f) continue;
        check(MakeCoated(tables, ggx, eta, Color(1.0f)), name + " coated diffuse " + std::to_string(eta));
        check(MakeCoatedMetal(tables, ggx, TrowbridgeReitz(0.2f, 1e-5f), eta, Color(0.2f), Color(3.0f)),
              name + " coated metal " + std::to_string(eta));
      }
    }
  }
  check(AbsorbingBsdf{}, "absorbing");
  check(DiffuseTransmissionBsdf{}, "diffuse transmission 0");
  EXPECT_GT(samples, 300000);
}

// Directions that rounding has made longer than opposite, both just above the horizon: no half vector to speak of.
TEST(BsdfExtremes, NearlyOppositeAtTheHorizon) {
  ModelTables tables;
  const Vector3 wo(0x1.b85c26p-1f, -0x1.0534p-1f, 0x1.8p-25f), wi(-0x1.b85c28p-1f, 0x1.053402p-1f, 0x1.8p-25f);
  for (const TestModel& model : AllModels(tables)) {
    const Bsdf bsdf(Frame{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 1}, model.model);
    for (const float side : {1.0f, -1.0f}) {
      const BsdfEvaluation value = bsdf.Evaluate(side * wo, side * wi, TransportMode::Radiance);
      EXPECT_TRUE(value.Sum().IsValid()) << model.name;
      EXPECT_TRUE(value.pdfForward.value >= 0 && value.pdfForward.value < kInfinity) << model.name;
      EXPECT_TRUE(value.pdfReverse.value >= 0 && value.pdfReverse.value < kInfinity) << model.name;
    }
  }
}

}  // namespace
}  // namespace lampyr::testing
