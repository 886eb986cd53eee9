// Lights for segments of rays in media: selection, apexes, and the part of a segment that a light reaches.
#include "lights/services/lighting_services.h"

namespace lampyr {

class LightingServices::LightsAlong final : public SegmentLights {
 public:
  LightsAlong(const LightingServices& lighting, const RaySegment& segment) : lighting_(lighting), segment_(segment) {}

  std::optional<SegmentEstimate> EstimateOf(uint32_t light, int patch) const override {
    std::optional<LightTransform> moved;
    LightContext context = lighting_.Context(light, segment_.time, false, moved);
    context.patch = patch;
    const PlacedLight& placed = lighting_.scene_->lights[light];
    auto estimate =
        placed.light->GetIncidentRadianceEstimate(context, segment_.origin, segment_.direction, segment_.length);
    if (estimate) estimate->radiance *= placed.light->Settings().importanceMultiplier * placed.radianceModifier;
    return estimate;
  }

 private:
  const LightingServices& lighting_;
  const RaySegment& segment_;
};

std::optional<SegmentSample> LightingServices::GenerateSamplesForRaySegment(const RaySegment& segment, float uSelect,
                                                                            const Point2& u) const {
  const auto selected =
      selector_->SelectForSegment(segment, LightsAlong(*this, segment), MoreBits(uSelect, segment.direction));
  return selected ? SampleApex(segment, *selected, u) : std::nullopt;
}

std::optional<SegmentSample> LightingServices::SampleApex(const RaySegment& segment, const SelectedLight& selected,
                                                          const Point2& u) const {
  if (!Reaches(selected.light, Receiver::InMedium(segment.origin, segment.link))) return std::nullopt;
  const auto estimate = LightsAlong(*this, segment).EstimateOf(selected.light, selected.patch);
  if (!estimate || !(estimate->minT < estimate->maxT)) return std::nullopt;
  SegmentSample sample;
  sample.light = selected.light;
  sample.patch = selected.patch;
  sample.selection = selected.probability;
  sample.tMin = estimate->minT;
  sample.tMax = estimate->maxT;
  AddApex(segment, u, sample);
  return sample;
}

void LightingServices::AddApex(const RaySegment& segment, const Point2& u, SegmentSample& sample) const {
  const LightFront front = scene_->fronts[sample.light];
  if (lampyr::IsAtInfinity(front.kind)) return;
  std::optional<LightTransform> moved;
  LightContext context = Context(sample.light, segment.time, true, moved);
  context.patch = sample.patch;
  if (front.kind == LightKind::DeltaPosition) {
    // A photon of a point may not exist where its profile is dark; the box of its bounds is the point.
    const auto bounds = front.light->GetEmissionBounds(context);
    if (!bounds) return;
    sample.hasApex = true;
    sample.apex = bounds->box.Center();
    sample.apexDensity = PdfArea(1);
    return;
  }
  // The position of a photon depends on u alone.
  context.u = u;
  context.uDirection = Point2(0.5f);
  const auto photon = front.light->GenerateEmission(context);
  if (!photon) return;
  sample.hasApex = true;
  sample.apex = photon->position;
  sample.apexDensity = photon->pdfEmit;
}

PdfDiscrete LightingServices::SegmentSelectionProbability(const RaySegment& segment, uint32_t light, int patch) const {
  return selector_->SegmentProbability(segment, LightsAlong(*this, segment), light, patch);
}

}  // namespace lampyr
