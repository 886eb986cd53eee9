// s = 1: next-event estimation.
#include <limits>

#include "integrators/bidirectional/techniques.h"
#include "integrators/bidirectional/weights.h"
#include "integrators/walk/path_layers.h"

namespace lampyr {

namespace {

class NextEventTechnique final : public NextEventVisitor {
 public:
  explicit NextEventTechnique(const BidirectionalSample& sample) : sample_(sample), vertex_(sample.camera.Last()) {}

  bool Wants(uint32_t light) override {
    return sample_.settings.connects || sample_.Lighting().EmissionSelectionProbability(light).IsZero() ||
           IsFoundHereAlone(light);
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
    end_ = EndOf(lighting, found, !direct.isDelta && lighting.CanBeHit(direct.light), edge, light.factors.Reversed(),
                 sample_.lightPaths);
    const SolidAngleDensity scattered = sample_.continuesHere * SolidAngleDensity(light.f.pdfForward);
    hit_ = end_.canBeHit ? scattered * end_.solidAnglePerArea : AreaDensity(0);
    Joint joint;
    joint.camera.previous = vertex_.PreviousReverse(light.f.pdfReverse);
    joint.mergesAtCamera = vertex_.CanMerge();
    fromLight_ = light.factors.Reversed();
    joint.cameraMergeVolume = MergeVolume(vertex_, {sample.direction, fromLight_},
                                          {vertex_.toPrevious, vertex_.factors}, sample_.settings.photons.volume);
    distance_ = lighting.IsAtInfinity(direct.light) ? std::numeric_limits<double>::infinity()
                                                    : static_cast<double>(sample.distance);
    flightRatio_ = sample_.FlightRatio(sample.direction, distance_, fromLight_.forward);
    weight_ =
        NextEventWeight(end_, sample_.CameraWeight(flightRatio_), hit_, joint.camera.previous, sample_.connectionCount,
                        NextEventCount(sample_.camera.Count()), sample_.MergingOfLight(end_, joint, end_.direct));
    if (!sample_.settings.connects && IsFoundHereAlone(direct.light)) weight_ = 1;
    return static_cast<float>(weight_);
  }

  // The path to the light that was weighted last.
  void Arrived(const LightConnection& light, const Color& value, const Color& contribution) override {
    if (sample_.context.layers)
      AddFoundToLayers(sample_.context, sample_.camera, light.Parts(vertex_),
                       sample_.context.outputs->OfLight(light.direct.light), contribution);
    if (!sample_.IsObserved()) [[likely]]
      return;
    ConnectedPath path;
    sample_.SetCamera(path);
    path.s = 1;
    path.end = end_;
    path.endFactors = fromLight_;
    path.endDistance = distance_;
    path.toLight = light.direct.sample->direction;
    path.value = value;
    path.weight = weight_;
    if (sample_.WantsSums()) path.sums = sample_.Sums(end_, hit_, false, 1, flightRatio_);
    sample_.Report(path);
  }

 private:
  // True if no other technique finds the light when subpaths are not connected: camera paths cannot hit it, and no
  // photon can be merged on the way, as on hair.
  bool IsFoundHereAlone(uint32_t light) const {
    const bool mergesHere = sample_.merging && vertex_.CanMerge();
    return !sample_.couldMerge && !mergesHere && !sample_.Lighting().CanBeHit(light);
  }

  const BidirectionalSample& sample_;
  const PathVertex& vertex_;
  LightEnd end_;
  EdgeFactors fromLight_;
  AreaDensity hit_;  // density of the light's point by scattering at the vertex
  double distance_ = 0, flightRatio_ = 0;
  double weight_ = 1;
};

}  // namespace

Color EstimateDirectLight(const BidirectionalSample& sample) {
  NextEventTechnique visitor(sample);
  return SampleDirectLight(sample.context, {kCameraDimensions, true, sample.WantedShadowRays()}, sample.camera.Last(),
                           static_cast<int>(sample.camera.Count()) - 1, sample.radiance, visitor);
}

}  // namespace lampyr
