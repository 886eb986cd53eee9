#include "integrators/walk/next_event.h"

#include "integrators/guide/selection_test.h"

namespace lampyr {

namespace {

// Transmittance of the shadow ray, and the factors of media on it.
Color TraceShadowRay(const SampleContext& context, const PathVertex& vertex, const DirectSample& direct,
                     uint64_t decider, EdgeFactors& factors) {
  const LightingServices& lighting = *context.scene.lighting;
  ++context.counts.shadowRays;
  if (context.scene.media.empty()) [[likely]]
    return lighting.Transmittance(vertex.point, direct, context.time);
  const Ray ray = lighting.ShadowRay(vertex.point, direct, context.time);
  const EdgeEnd light{Point3d(direct.sample->position)};
  return TransmittanceOf(context, ray, visibility::kShadow, vertex.EndTowards(ray.direction), light, MixBits(decider),
                         factors);
}

}  // namespace

namespace {

[[gnu::noinline]] void Test(const LightingServices& lighting, const Receiver& receiver, const DirectSample& direct,
                            const Color& contribution, TestedSamples& tested) {
  const auto [learned, unlearned] = lighting.SelectionsOf(receiver, direct);
  if (learned.value > 0 && unlearned.value > 0)
    tested.Add(contribution.Average(), direct.selection.value, unlearned.value, learned.value);
}

}  // namespace

Color SampleLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                  const SelectedLight& light, const Point2& u, const Color& soFar, NextEventVisitor& visitor) {
  const LightingServices& lighting = *context.scene.lighting;
  if (!visitor.Wants(light.light)) return Color(0.0f);
  const DirectSample direct = lighting.GenerateSamples(vertex.receiver, light, u, context.time, settings.bidirectional);
  const auto record = [&](const Color& arrived) {
    if (context.tested && settings.learns) lighting.UpdateWithResults(vertex.receiver, direct, arrived);
  };
  const auto nothingArrives = [&] {
    record(Color(0.0f));
    return Color(0.0f);
  };
  if (!direct) return nothingArrives();
  const LightSample& sample = *direct.sample;
  LightConnection connection{direct, vertex.Evaluate(sample.direction, TransportMode::Radiance), Color()};
  const Color scattered = connection.f.diffuse * sample.diffuse + connection.f.specular * sample.specular;
  if (scattered.IsBlack()) return nothingArrives();
  const PdfSolidAngle pdf = direct.selection * sample.pdfDirect;
  if (!(pdf.value > 0)) [[unlikely]] {  // of a defective type of light: weights would hide it
    ++context.counts.droppedSamples;
    return nothingArrives();
  }
  connection.value = vertex.Throughput() * scattered * (vertex.ScatteringCosine(sample.direction) / pdf.value);
  if (connection.value.IsBlack()) return Color(0.0f);
  // Media on the way are a part of the weight, so that their shadow rays are traced before it is known.
  const bool hasMedia = !context.scene.media.empty();
  float weight = hasMedia ? 1.0f : visitor.Weigh(connection);
  const uint64_t decider = ShadowRays::DeciderOf(u.x, u.y);
  const float survivalWeight = settings.shadowRays.SurvivalWeight(connection.value * weight, soFar, decider);
  if (survivalWeight == 0) return Color(0.0f);
  const Color transmitted = TraceShadowRay(context, vertex, direct, decider, connection.factors);
  record(transmitted);
  const Color value = connection.value * transmitted;
  if (value.IsBlack()) return value;
  if (hasMedia) weight = visitor.Weigh(connection);
  const Color contribution = value * (weight * survivalWeight);
  visitor.Arrived(connection, value, contribution);
  if (context.tested && settings.learns && context.tested->Tests()) [[unlikely]]
    Test(lighting, vertex.receiver, direct, contribution, *context.tested);
  return contribution;
}

namespace {

// SampleDirectLight with SampleContext::lightSpread. The variance of one of n samples x_i, which then counts n times,
// is n Σ x_i² - (Σ x_i)².
[[gnu::noinline]] Color SampleAndCompare(const SampleContext& context, const NextEventSettings& settings,
                                         const PathVertex& vertex, float uSelect, const Point2& u, const Color& soFar,
                                         NextEventVisitor& visitor) {
  Color sum;
  double squares = 0;
  uint64_t count = 0;
  ForChosenLights(*context.scene.lighting, vertex.receiver, uSelect, u,
                  [&](const SelectedLight& light, const Point2& own) {
                    const Color found = SampleLight(context, settings, vertex, light, own, soFar + sum, visitor);
                    const auto value = static_cast<double>(found.Average());
                    squares += value * value;
                    ++count;
                    sum += found;
                  });
  LightSpread& spread = *context.lightSpread;
  const auto whole = static_cast<double>(sum.Average());
  spread.squares += static_cast<double>(count) * squares - whole * whole;
  spread.vertices += count > 0 ? 1 : 0;
  spread.samples += count;
  return sum;
}

}  // namespace

Color SampleDirectLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                        int index, const Color& soFar, NextEventVisitor& visitor) {
  Sampler& sampler = context.sampler;
  sampler.SetDimension(settings.dimensions.Of(index, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  Color sum;
  if (context.lightSpread) [[unlikely]]
    return SampleAndCompare(context, settings, vertex, uSelect, u, soFar, visitor);
  ForChosenLights(*context.scene.lighting, vertex.receiver, uSelect, u,
                  [&](const SelectedLight& light, const Point2& own) {
                    sum += SampleLight(context, settings, vertex, light, own, soFar + sum, visitor);
                  });
  return sum;
}

}  // namespace lampyr
