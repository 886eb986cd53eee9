#include "integrators/walk/next_event.h"

namespace lampyr {

namespace {

// Contribution of one selected light.
Color SampleLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                  const SelectedLight& light, const Point2& u, const Color& soFar, NextEventVisitor& visitor) {
  const LightingServices& lighting = *context.scene.lighting;
  if (!visitor.Wants(light.light)) return Color(0.0f);
  const DirectSample direct = lighting.GenerateSamples(vertex.receiver, light, u, context.time, settings.bidirectional);
  const auto nothingArrives = [&] {
    lighting.UpdateWithResults(vertex.receiver, direct, Color(0.0f));
    return Color(0.0f);
  };
  if (!direct) return nothingArrives();
  const LightSample& sample = *direct.sample;
  LightConnection connection{direct, vertex.Evaluate(sample.direction, TransportMode::Radiance), Color()};
  const Color scattered = connection.f.diffuse * sample.diffuse + connection.f.specular * sample.specular;
  if (scattered.IsBlack()) return nothingArrives();
  const PdfSolidAngle pdf = direct.selection * sample.pdfDirect;
  connection.value = vertex.Throughput() * scattered * (vertex.ScatteringCosine(sample.direction) / pdf.value);
  if (connection.value.IsBlack()) return Color(0.0f);
  const float weight = visitor.Weigh(connection);
  const float survivalWeight =
      settings.shadowRays.SurvivalWeight(connection.value * weight, soFar, ShadowRays::DeciderOf(u.x, u.y));
  if (survivalWeight == 0) return Color(0.0f);
  ++context.counts.shadowRays;
  const Color transmitted = lighting.Transmittance(vertex.point, direct, context.time);
  lighting.UpdateWithResults(vertex.receiver, direct, transmitted);
  const Color value = connection.value * transmitted;
  if (value.IsBlack()) return value;
  const Color contribution = value * (weight * survivalWeight);
  visitor.Arrived(connection, value, contribution);
  return contribution;
}

}  // namespace

Color SampleDirectLight(const SampleContext& context, const NextEventSettings& settings, const PathVertex& vertex,
                        int index, const Color& soFar, NextEventVisitor& visitor) {
  Sampler& sampler = context.sampler;
  sampler.SetDimension(settings.dimensions.Of(index, dimensions::kLightSelection));
  const float uSelect = sampler.Get1D();
  const Point2 u = sampler.Get2D();
  Color sum;
  ForChosenLights(*context.scene.lighting, vertex.receiver, uSelect, u,
                  [&](const SelectedLight& light, const Point2& own) {
                    sum += SampleLight(context, settings, vertex, light, own, soFar + sum, visitor);
                  });
  return sum;
}

}  // namespace lampyr
