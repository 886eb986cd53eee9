// The interface between integrators and lights: selection, sampling, shadow rays and emission. Integrators never call a
// light directly, so that filters, linking and rounding on the edge between a light and a surface are the same for
// every technique.
//
// A LightingServices is an immutable view of the scene's lights. Learned distributions (light selection, guided
// emission) make another view of the same lights, by `With`. A pass uses one view, and so has one distribution with
// exact densities.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "geometry/geometry_scene.h"
#include "geometry/robust.h"
#include "lights/light.h"
#include "lights/light_groups.h"
#include "lights/selection/emission_guide.h"
#include "lights/selection/light_learning.h"
#include "lights/selection/light_selector.h"
#include "lights/services/equiangular.h"
#include "lights/services/light_fronts.h"
#include "lights/services/linking.h"
#include "sampling/rng.h"
#include "spectral/wavelengths.h"

namespace lampyr {

// A sample of next-event estimation with the selection probability of its light. False: no contribution. The light's
// result is kept as returned and never copied, because copying a struct that was just written field by field costs more
// than the sampling (store forwarding).
struct DirectSample {
  uint32_t light = 0;
  bool isDelta = false;               // the light has no surface or directions that a BSDF ray could find
  bool isInfinite = false;            // no end of the shadow ray
  int patch = kAnyPatch;              // that was selected
  PdfDiscrete selection;              // at the receiver, times the number of its samples
  std::optional<LightSample> sample;  // densities without the selection probability

  explicit operator bool() const { return sample && !sample->pdfDirect.IsZero(); }
};

// A light that a ray hit.
struct FoundLight {
  uint32_t light = 0;
  PdfDiscrete selection;  // selection probability of next-event estimation at the origin of the ray
  LightEvaluation evaluation;
  int patch = kAnyPatch;  // that next-event estimation would have selected
};

// An emitted photon.
struct EmittedPhoton {
  uint32_t light = 0;
  PdfDiscrete emissionSelection;
  EmissionSample emission;
  // The density that a guide changes, as it is without one: of the line (1/m²) for lights at infinity, of the direction
  // (1/sr) for others.
  float pdfUnguided = 0;
  Ray ray;
  bool fromSurface = false;  // starts on a surface that camera rays can hit

  // True if only its position is valid: the sampled direction carries nothing, and may have no density.
  bool IsDark() const { return emission.diffuse.IsBlack() && emission.specular.IsBlack(); }
};

// A light for a segment of a ray in a medium, the part of the segment that it can light, and a point of it as the apex
// for equiangular sampling of a distance there.
struct SegmentSample {
  uint32_t light = 0;
  int patch = kAnyPatch;     // that was selected
  PdfDiscrete selection;     // of the light and patch for this segment
  float tMin = 0, tMax = 0;  // no point of the segment outside of [tMin, tMax] receives light from it

  // Lights at infinity have no apex, nor may other lights for some u: distances must then be sampled in another way.
  bool hasApex = false;
  Point3 apex{0.0f};
  PdfArea apexDensity;  // given light and patch: 1/m² on the surface of area lights, 1 (discrete) for points

  // Sampling of a distance in [tMin, tMax]. Requires hasApex.
  EquiangularDistance Distances(const RaySegment& segment) const {
    return {segment.origin, segment.direction, apex, tMin, tMax};
  }
};

// Properties of the participating media that the lighting services depend on.
struct MediaAround {
  bool glow = false;     // some emit light
  double glowPower = 0;  // roughly, W: mean of the channels
  // Not empty if a medium without a boundary is around the scene. It fills the scene's sphere, which then holds these
  // points (the camera, and the corners of the medium if it is a grid) and all lights with a position.
  std::vector<Point3> unboundedHolds;
};

class LightingServices {
 public:
  // `geometry` must outlive the services. `mostSamples`: the largest number of lights selected for a receiver, clamped
  // to [1, LightChoices::kMost]. Each sample is divided by the expected number of samples of its light; densities of
  // next-event estimation include that number.
  LightingServices(const GeometryScene& geometry, std::vector<PlacedLight> lights, LightSelection selection,
                   LightLinking linking = {}, int mostSamples = 1, const MediaAround& media = {});

  // A view of the same lights, selected in this way.
  LightingServices Selecting(LightSelection selection, int mostSamples) const;

  // A view of the same lights with learned selection, which also records results in `learning` while that is recording,
  // and with photons guided by `guide`. Both may be null, must outlive the view, and must not change while it is used.
  // `isTrial`: the view records, but selects without what was learned.
  LightingServices With(LightLearning* learning, const EmissionGuide* guide, bool isTrial = false) const;

  // A view of the same lights at the wavelengths of a pass.
  LightingServices AtWavelengths(std::shared_ptr<const Wavelengths> wavelengths) const;

  // Selects lights for the receiver.
  void SelectLights(const Receiver& receiver, float uSelect, LightChoices& choices) const {
    selector_->Select(receiver, Selection(), MoreBits(uSelect, receiver.position), choices);
  }
  // Samples a selected light.
  DirectSample GenerateSamples(const Receiver& receiver, const SelectedLight& selected, const Point2& u, float time,
                               bool bidirectional) const;

  // Transmittance between the receiver and a sample: 0 if occluded, 1 if unoccluded, a colour behind cut-outs and thin
  // glass. Traces a shadow ray.
  Color Transmittance(const SurfacePoint& from, const DirectSample& direct, float time) const;
  // The shadow ray that Transmittance traces.
  Ray ShadowRay(const SurfacePoint& from, const DirectSample& direct, float time) const;

  // Records the result of a sample for learned selection: the fraction that arrived at the receiver, 0 also if its
  // shadow ray was not traced. May be called from any thread; without effect unless recording.
  void UpdateWithResults(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const {
    if (learning_ && learning_->IsRecording()) RecordResult(receiver, direct, arrived);
  }
  // DirectSample::selection with what was learned so far and without; a view that learns nothing returns 0.
  struct Selections {
    PdfDiscrete learned, unlearned;
  };
  Selections SelectionsOf(const Receiver& receiver, const DirectSample& direct) const;
  // True if selection can learn from results.
  bool LearnsSelection() const { return selector_->Learns(); }
  // Selection for emission without a guide.
  const LightSelector& EmissionSelector() const { return *scene_->emissionSelector; }

  // Selects one light for a segment of a ray in a medium by uSelect, and samples an apex on it by u (SampleApex). At
  // the sampled distance, the light is sampled by GenerateSamples as on a surface, with SegmentSample::selection in
  // place of the selection at that receiver. nullopt: the segment receives nothing from the light that these numbers
  // select.
  std::optional<SegmentSample> GenerateSamplesForRaySegment(const RaySegment& segment, float uSelect,
                                                            const Point2& u) const;
  // Clips the segment to what a light that is selected already can reach, and samples an apex on it, in proportion to
  // its emission. nullopt: it reaches nothing of the segment.
  std::optional<SegmentSample> SampleApex(const RaySegment& segment, const SelectedLight& selected,
                                          const Point2& u) const;
  // Probability of this light and patch in GenerateSamplesForRaySegment. The patch has no effect on lights and
  // selectors without patches.
  PdfDiscrete SegmentSelectionProbability(const RaySegment& segment, uint32_t light, int patch) const;

  // Evaluates the area light at a surface point that a ray from `receiver` along the unit `direction` hit. nullopt: the
  // surface emits nothing in that direction.
  std::optional<FoundLight> EvaluateSamples(const Receiver& receiver, const Vector3& direction, float distance,
                                            const SurfacePoint& point, float time, bool bidirectional) const;

  // Evaluates the light at infinity `i`, in [0, InfiniteCount()), for a ray from `receiver` that escapes along
  // `direction`.
  size_t InfiniteCount() const { return scene_->infinite.size(); }
  std::optional<FoundLight> EvaluateEscaped(size_t i, const Receiver& receiver, const Vector3& direction, float time,
                                            bool bidirectional) const;

  // Radiance seen by a camera ray that hit a light, or that escaped to the light at infinity `i`, in
  // [0, InfiniteCount()).
  Color EmissionForCamera(const Vector3& direction, float distance, const SurfacePoint& point, float time) const;
  Color EscapedEmissionForCamera(size_t i, const Ray& ray) const;
  // True if a ray that arrived at `point` from the unit direction `toRay` hit the origin of the photon.
  bool IsOrigin(const EmittedPhoton& photon, const SurfacePoint& point, const Vector3& toRay, float distance) const;

  // Selects a light for emission and samples a photon. Surfaces nearer than EmissionSample::shinesFrom block it.
  std::optional<EmittedPhoton> GenerateEmission(float uSelect, const Point2& u, const Point2& uDirection,
                                                float time) const;
  // Density of this photon over its density without a guide.
  float EmissionGain(const EmittedPhoton& photon) const;
  // Evaluates the origin of a photon for next-event estimation from its first hit `receiver`. Densities do not include
  // the selection. Also for delta lights, with the discrete density 1.
  std::optional<FoundLight> EvaluateFirstHit(const EmittedPhoton& photon, const Receiver& receiver) const;

  // Applies light filters and linking to a photon at its first hit `receiver`. `diffuse`, `specular`: as emitted,
  // before the transmittance of the segment. False: nothing remains.
  bool FilterFirstHit(const EmittedPhoton& photon, const Receiver& receiver, Color& diffuse, Color& specular) const {
    return !scene_->isLinked || LandsFiltered(photon, receiver, diffuse, specular);
  }

  // True if next-event estimation at a receiver selects patches individually; otherwise patches have the probability of
  // their light.
  bool SelectsPatches(const Receiver& receiver) const { return selector_->SelectsPatches(receiver); }
  PdfDiscrete SelectionProbability(const Receiver& receiver, uint32_t light, int patch) const;
  PdfDiscrete EmissionSelectionProbability(uint32_t light) const;
  // IsAtInfinity: the light is infinite or distant. CanBeHit: BSDF sampling can find it.
  bool IsAtInfinity(uint32_t light) const { return lampyr::IsAtInfinity(scene_->fronts[light].kind); }
  LightKind KindOf(uint32_t light) const { return scene_->fronts[light].kind; }
  bool CanBeHit(uint32_t light) const { return scene_->CanBeHit(light); }
  // True if BSDF sampling can find any light.
  bool HasLightThatCanBeHit() const { return scene_->hasLightThatCanBeHit; }

  const LightGroups& Groups() const { return scene_->groups; }
  // The light at infinity `i`, and the area light at a surface point.
  uint32_t InfiniteLight(size_t i) const { return scene_->infinite[i]; }
  uint32_t LightAt(const SurfacePoint& point) const {
    return static_cast<uint32_t>(std::max(scene_->geometry.LightAt(point.primitive, point.instance), 0));
  }

  bool HasLights() const { return !scene_->lights.empty(); }
  // Unit of the flux of light paths, W: a power of two near the power of all lights. The power of a lamp of radiance
  // 1e30 and a kilometre in size, or of 1e-30 and a micrometre, exceeds the range of float, while its irradiance does
  // not.
  float FluxUnit() const { return scene_->fluxUnit; }
  const std::vector<PlacedLight>& Lights() const { return scene_->lights; }
  const LightLinking& Linking() const { return scene_->linking; }
  const BoundingSphere& SceneSphere() const { return scene_->sphere; }

 private:
  static double MoreBits(float u, const Point3& of) { return WithMoreBits(u, of.x, of.y, of.z); }
  // `moved`: storage for the placement of a moving light; must live as long as the context.
  LightContext Context(uint32_t light, float time, bool bidirectional, std::optional<LightTransform>& moved) const;
  static void SetReceiver(const Receiver& receiver, LightContext& context) {
    context.receiverNormal = receiver.normal;
    context.receiverIsTransmissive = receiver.isTransmissive;
  }

  // The lights as seen from a segment, for their selection.
  class LightsAlong;
  void AddApex(const RaySegment& segment, const Point2& u, SegmentSample& sample) const;

  // Selects a light and samples a photon, with densities without a guide.
  struct Emission {
    PdfDiscrete selection;
    uint32_t light = 0;
    EmissionSample sample;
  };
  std::optional<Emission> Emit(double uSelect, const Point2& u, const Point2& uDirection, float time) const;
  std::optional<EmissionSample> EmitAimed(const LightContext& context, const EmissionGuide::Choice& choice) const;
  // Combines the density of an emission from `from` along `direction` with that of the guide; at infinity, `from` is
  // any point on the line.
  template <class Record>
  void Aim(uint32_t light, const Point3& from, const Vector3& direction, Record& record) const;

  // Applies linking and filters to the light on an edge between a light and a receiver. False: nothing remains. Every
  // technique that forms such an edge calls this, or FilterFirstHit.
  bool Reaches(uint32_t light, const Receiver& receiver) const {
    return !scene_->isLinked || receiver.link == Receiver::kCamera || scene_->linking.IsLit(receiver.link, light);
  }
  template <class Record>
  bool Filter(uint32_t light, const Receiver& receiver, const Vector3& toLight, float distance, float time,
              Record& record) const {
    return !scene_->isLinked || scene_->lights[light].filter < 0 ||
           RunFilter(light, receiver, toLight, distance, time, record.pdfDirect, record.diffuse, record.specular);
  }
  bool RunFilter(uint32_t light, const Receiver& receiver, const Vector3& toLight, float distance, float time,
                 PdfSolidAngle pdfDirect, Color& diffuse, Color& specular) const;
  bool LandsFiltered(const EmittedPhoton& photon, const Receiver& receiver, Color& diffuse, Color& specular) const;

  // Brings the emission of a light, in Rec. 709 as lights give it, to the wavelengths of the view.
  template <class Record>
  void Tune(uint32_t light, Record& record) const {
    if (!wavelengths_) [[likely]]
      return;
    record.diffuse = Tuned(light, record.diffuse);
    record.specular = Tuned(light, record.specular);
  }
  Color Tuned(uint32_t light, const Color& emitted) const;

  // Emission selects whole lights: converts a density of emission given a patch to that of the whole light.
  PdfArea EmissionDensity(const LightContext& context, uint32_t light, int patch, PdfArea given) const;
  void RecordResult(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const;
  Vector3 ErrorOfEnd(const SurfacePoint& from, const DirectSample& direct, float time) const;

  // Shared by all views of a scene.
  struct SceneLights {
    SceneLights(const GeometryScene& geometry, std::vector<PlacedLight> lights, LightLinking linking,
                const MediaAround& media);
    bool CanBeHit(uint32_t light) const {
      const LightFront& front = fronts[light];
      return front.kind == LightKind::Infinite || (front.kind == LightKind::Area && front.canBeHit);
    }

    const GeometryScene& geometry;
    std::vector<PlacedLight> lights;
    LightFronts fronts;
    std::vector<uint32_t> infinite;
    bool hasLightThatCanBeHit = false;
    LightGroups groups;
    BoundingSphere sphere;
    float fluxUnit = 1;
    LightLinking linking;
    bool isLinked = false;  // some light has a filter, or does not illuminate everything
    std::unique_ptr<LightSelector> emissionSelector;
  };
  SelectionSettings Selection() const { return {isTrial_ ? nullptr : learning_, mostSamples_}; }

  std::shared_ptr<const SceneLights> scene_;
  LightSelection selection_ = LightSelection::Tree;
  int mostSamples_ = 1;
  std::shared_ptr<const LightSelector> selector_;
  LightLearning* learning_ = nullptr;
  bool isTrial_ = false;
  const EmissionGuide* guide_ = nullptr;
  std::shared_ptr<const Wavelengths> wavelengths_;  // null: light is in Rec. 709
  // Lights whose spectra are not those of their colours, ascending: the product of their colours in Rec. 709, and that
  // of their spectra at the wavelengths.
  struct OwnSpectra {
    uint32_t light;
    Color color, own;
  };
  std::vector<OwnSpectra> ownSpectra_;
};

template <class Record>
void LightingServices::Aim(uint32_t light, const Point3& from, const Vector3& direction, Record& record) const {
  if (!guide_) return;
  const float share = guide_->Share(light);
  if (!(share > 0)) return;
  if (IsAtInfinity(light)) {
    record.pdfEmit = (1 - share) * record.pdfEmit + share * guide_->LineDensity(light, from, direction);
  } else {
    record.pdfEmitDirection =
        (1 - share) * record.pdfEmitDirection + share * guide_->DirectionDensity(light, from, direction);
  }
}

}  // namespace lampyr
