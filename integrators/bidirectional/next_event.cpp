// s = 1: next-event estimation.
#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"

namespace lampyr {

namespace {

class NextEventTechnique final : public NextEventVisitor {
 public:
  explicit NextEventTechnique(const BidirectionalSample& sample) : sample_(sample), vertex_(sample.camera.Last()) {
    sample_.SetCamera(path_);
    path_.s = 1;
  }

  bool Wants(uint32_t light) override {
    return sample_.settings.connects || sample_.Lighting().EmissionSelectionProbability(light).IsZero();
  }

  float Weigh(const LightConnection& light) override {
    const LightingServices& lighting = sample_.Lighting();
    const DirectSample& direct = light.direct;
    const LightSample& sample = *direct.sample;
    FoundLight found;
    found.light = direct.light;
    found.selection = direct.selection;
    found.evaluation.pdfDirect = sample.pdfDirect;
    found.evaluation.pdfEmit = sample.pdfEmit;
    found.evaluation.pdfEmitDirection = sample.pdfEmitDirection;
    found.evaluation.solidAngleToArea = sample.solidAngleToArea;
    const SolidAnglePerArea edge = FirstEdgeDensity(lighting, direct.light, vertex_.GeometryTerm(sample.direction),
                                                    Sqr(static_cast<double>(sample.distance)));
    path_.end = EndOf(lighting, found, !direct.isDelta && lighting.CanBeHit(direct.light), edge,
                      light.factors.Reversed(), sample_.lightPaths);
    path_.toLight = sample.direction;
    const AreaDensity hit =
        path_.end.canBeHit ? SolidAngleDensity(light.f.pdfForward) * path_.end.solidAnglePerArea : AreaDensity(0);
    Joint joint;
    joint.camera.previous = vertex_.PreviousReverse(light.f.pdfReverse);
    joint.mergesAtCamera = vertex_.CanMerge();
    path_.weight = NextEventWeight(path_.end, vertex_.weight, hit, joint.camera.previous, sample_.connectionCount,
                                   NextEventCount(sample_.camera.Count()),
                                   sample_.MergingOfLight(path_.end, joint, path_.end.direct));
    if (sample_.WantsSums()) [[unlikely]]
      path_.sums = sample_.Sums(path_.end, hit, false, 1);
    return static_cast<float>(path_.weight);
  }

  void Arrived(const LightConnection& light, const Color& value, const Color& contribution) override {
    if (sample_.context.layers)
      sample_.context.layers->Add(sample_.Lighting().GroupOf(light.direct.light), contribution);
    if (!sample_.IsObserved()) return;
    path_.value = value;
    sample_.Report(path_);
  }

 private:
  const BidirectionalSample& sample_;
  const PathVertex& vertex_;
  ConnectedPath path_;
};

}  // namespace

Color EstimateDirectLight(const BidirectionalSample& sample) {
  NextEventTechnique visitor(sample);
  return SampleDirectLight(sample.context, {kCameraDimensions, true, sample.WantedShadowRays()}, sample.camera.Last(),
                           static_cast<int>(sample.camera.Count()) - 1, sample.radiance, visitor);
}

}  // namespace lampyr
