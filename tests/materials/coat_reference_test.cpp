// The coated models against what they stand for: light that walks at random between the coat's boundary and the base,
// as in pbrt-v4's layered materials (gap extinction 1 per unit of thickness, up to five bounces at the base).
#include <gtest/gtest.h>

#include <array>

#include "materials/model_table.h"
#include "support/chi_squared.h"

namespace lampyr::testing {
namespace {

constexpr int kBins = 4;  // of the outgoing cosine

// Outgoing flux per bin of cosθ, and in all; sums of squares for the error.
struct Outflow {
  std::array<double, kBins + 1> sum{}, squares{};
  int count = 0;

  void Add(const Vector3& wi, double weight) {
    const int bin = std::min(static_cast<int>(std::abs(wi.z) * kBins), kBins - 1);
    sum[static_cast<size_t>(bin)] += weight;
    squares[static_cast<size_t>(bin)] += weight * weight;
    sum[kBins] += weight;
    squares[kBins] += weight * weight;
  }
  double Mean(size_t i) const { return sum[i] / count; }
  double Variance(size_t i) const { return std::max(squares[i] / count - Mean(i) * Mean(i), 0.0) / count; }
};

struct Layers {
  DielectricBsdf coat;
  BsdfModel base;
  float thickness = 0.01f;
};

// One walk, importance downwards from wo; nothing when absorbed.
template <class Base>
void Walk(const Layers& layers, const Base& base, const Vector3& wo, Rng& rng, Outflow& outflow) {
  ++outflow.count;
  constexpr auto kMode = TransportMode::Importance;
  const auto next = [&](const auto& model, const Vector3& from) {
    const float uLobe = rng.NextFloat();
    return model.Sample(from, uLobe, rng.NextPoint2(), kMode);
  };
  auto sample = next(layers.coat, wo);
  if (!sample) return;
  double weight = static_cast<double>(sample.Weight().g);
  if (!sample.isTransmission) return outflow.Add(sample.wi, weight);
  Vector3 w = sample.wi;  // downwards
  for (int bounce = 0; bounce < 5; ++bounce) {
    weight *= std::exp(static_cast<double>(layers.thickness / w.z));
    sample = next(base, -w);
    if (!sample || !(sample.wi.z > 0)) return;
    weight *= static_cast<double>(sample.Weight().g);
    w = sample.wi;
    weight *= std::exp(static_cast<double>(-layers.thickness / w.z));
    sample = next(layers.coat, -w);
    if (!sample) return;
    weight *= static_cast<double>(sample.Weight().g);
    w = sample.wi;
    if (sample.isTransmission) return outflow.Add(w, weight);
  }
}

Outflow Reference(const Layers& layers, const Vector3& wo, int walks) {
  Rng rng(21);
  Outflow outflow;
  for (int i = 0; i < walks; ++i) {
    std::visit([&](const auto& base) { Walk(layers, base, wo, rng, outflow); }, layers.base);
  }
  return outflow;
}

Outflow Sampled(const BsdfModel& model, const Vector3& wo, int samples) {
  Rng rng(22);
  Outflow outflow;
  const Bsdf bsdf(Frame::FromNormal({0, 0, 1}), {0, 0, 1}, model);
  for (int i = 0; i < samples; ++i) {
    ++outflow.count;
    const float uLobe = rng.NextFloat();
    const auto sample = bsdf.Sample(wo, uLobe, rng.NextPoint2(), TransportMode::Importance);
    if (sample) outflow.Add(sample.wi, static_cast<double>(sample.Weight().g));
  }
  return outflow;
}

const std::array<Vector3, 3> kDirections = {glm::normalize(Vector3(0.1f, 0, 1)), glm::normalize(Vector3(0.8f, 0, 0.6f)),
                                            glm::normalize(Vector3(1, 0, 0.2f))};

// Exact: the only error is that of the tables.
TEST(CoatReference, CoatedDiffuseIsTheSumOfAllWalks) {
  struct Case {
    float alpha, eta, reflectance, thickness;
  };
  const Case cases[] = {{0, 1.5f, 0.4f, 0.01f},   {0.158f, 1.5f, 0.2f, 0.01f}, {0.387f, 1.5f, 0.5f, 0.01f},
                        {0.387f, 1.5f, 1, 0.01f}, {0.8f, 1.5f, 0.8f, 0.01f},   {0.1f, 2, 0.8f, 0.2f},
                        {0.3f, 1.2f, 0.9f, 0},    {0.2f, 1, 0.7f, 0.05f}};
  const double level = SidakLevel(static_cast<int>(std::size(cases) * kDirections.size() * (kBins + 1)));
  double worst = 0;
  for (const Case& c : cases) {
    ModelTables tables;
    const TrowbridgeReitz ggx(c.alpha, c.alpha);
    const BsdfModel model = MakeCoated(tables, ggx, c.eta, Color(c.reflectance), c.thickness);
    for (const Vector3& wo : kDirections) {
      const Outflow expected = Reference({{ggx, c.eta}, DiffuseBsdf{Color(c.reflectance)}, c.thickness}, wo, 150000);
      const Outflow actual = Sampled(model, wo, 50000);
      for (size_t i = 0; i <= kBins; ++i) {
        const double tableError = 0.004 * expected.Mean(i) + 2e-4;
        const double excess = std::max(std::abs(actual.Mean(i) - expected.Mean(i)) - tableError, 0.0);
        const double variance = expected.Variance(i) + actual.Variance(i);
        const double p = variance > 0 ? ChiSquaredTail(excess * excess / variance, 1) : (excess > 0 ? 0.0 : 1.0);
        EXPECT_GT(p, level) << "alpha " << c.alpha << " eta " << c.eta << " rho " << c.reflectance
                            << " from z = " << wo.z << " bin " << i << ": " << actual.Mean(i) << " for "
                            << expected.Mean(i);
      }
      worst = std::max(worst, std::abs(actual.Mean(kBins) / expected.Mean(kBins) - 1));
    }
  }
  std::printf("           largest difference of directional albedo: %.2f %%\n", 100 * worst);
}

// Approximate where something is rough: the table of differences is printed, and held to the bounds that the header
// names.
TEST(CoatReference, CoatedConductorIsNearTheSumOfAllWalks) {
  struct Case {
    float coat, base, bound;  // roughness α; relative bound of the directional albedo
  };
  const Case cases[] = {{0, 0, 0.005f},      {0, 0.1f, 0.01f},    {0, 0.3f, 0.01f},    {0, 0.6f, 0.01f},
                        {0.1f, 0, 0.02f},    {0.3f, 0, 0.02f},    {0.1f, 0.1f, 0.02f}, {0.3f, 0.1f, 0.02f},
                        {0.3f, 0.3f, 0.02f}, {0.3f, 0.6f, 0.02f}, {0.1f, 0.6f, 0.02f}, {0.2f, 0.3f, 0.02f},
                        {0.5f, 0.5f, 0.02f}, {0.7f, 0.7f, 0.02f}, {0.7f, 0.2f, 0.02f}};
  const Color eta(0.21f, 0.83f, 1.24f), k(3.8f, 2.6f, 2.3f);
  for (const Case& c : cases) {
    ModelTables tables;
    const TrowbridgeReitz coat(c.coat, c.coat), base(c.base, c.base);
    const BsdfModel model = MakeCoatedMetal(tables, coat, base, 1.5f, eta, k);
    for (const Vector3& wo : kDirections) {
      const Outflow expected = Reference({{coat, 1.5f}, ConductorBsdf{base, eta / 1.5f, k / 1.5f}}, wo, 60000);
      const Outflow actual = Sampled(model, wo, 30000);
      const double difference = actual.Mean(kBins) / expected.Mean(kBins) - 1;
      const double error = std::sqrt(expected.Variance(kBins) + actual.Variance(kBins)) / expected.Mean(kBins);
      std::printf("           coat %.2f base %.2f cos %.2f: albedo %.4f, walk %.4f, %+.2f %% (± %.2f %%)\n",
                  static_cast<double>(c.coat), static_cast<double>(c.base), static_cast<double>(wo.z),
                  actual.Mean(kBins), expected.Mean(kBins), 100 * difference, 100 * error);
      EXPECT_LT(std::abs(difference), static_cast<double>(c.bound) + 4.5 * error);
    }
  }
}

}  // namespace
}  // namespace lampyr::testing
