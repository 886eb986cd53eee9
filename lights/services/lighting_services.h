// The one door between integrators and lights: selection, sampling, shadows and emission. An integrator never calls a
// light itself, so whatever happens on the edge between a light and the first surface happens here, once, and alike for
// every technique.
//
// A LightingServices is a view of the scene's lights that never changes. What is learned while an image is rendered
// (which lights are occluded where, where photons are of use) makes another view of the same lights: `With`. A pass is
// given one view, and so has one distribution, whose densities are known exactly.
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
#include "lights/services/light_fronts.h"
#include "lights/services/linking.h"
#include "sampling/rng.h"

namespace lampyr {

// Next-event estimation: a light's sample with the probability of having chosen that light. False: nothing comes from
// there. The light's result is a member as it was returned, never copied: copies of a struct that was written just
// before, field by field, cost more than the sampling.
struct DirectSample {
  uint32_t light = 0;
  bool isDelta = false;               // the light has no surface or directions that a BSDF ray could find
  bool isInfinite = false;            // no end of the shadow ray
  int patch = kAnyPatch;              // that was selected
  PdfDiscrete selection;              // at the receiver, times the number of its samples
  std::optional<LightSample> sample;  // densities without the selection

  explicit operator bool() const { return sample && !sample->pdfDirect.IsZero(); }
};

// A light that a ray found.
struct FoundLight {
  uint32_t light = 0;
  PdfDiscrete selection;  // next-event selection at the receiver that the ray left
  LightEvaluation evaluation;
};

// A photon as it leaves its light.
struct EmittedPhoton {
  uint32_t light = 0;
  PdfDiscrete emissionSelection;
  EmissionSample emission;
  float pdfUnguided = 0;  // of the density that a guide has a part in, what it would be without: 1/m² of lights at
                          // infinity, 1/sr of others
  Ray ray;
  bool fromSurface = false;  // it started on a surface that camera rays can hit

  // A place on a light whose direction carries nothing, and may have no density.
  bool IsDark() const { return emission.diffuse.IsBlack() && emission.specular.IsBlack(); }
};

class LightingServices {
 public:
  // `geometry` must outlive the services. At most `mostSamples` lights are chosen for a receiver, in
  // [1, LightChoices::kMost]. Each sample divides by the number that is expected of its light, so that their
  // contributions add up; densities of next-event estimation count them all.
  LightingServices(const GeometryScene& geometry, std::vector<PlacedLight> lights, LightSelection selection,
                   LightLinking linking = {}, int mostSamples = 1);

  // The same lights, where next-event estimation selects by what `learning` knows, too, and records its results there
  // while that is recording, and where photons are aimed by `guide`. Both must outlive the view, and what they know
  // stays the same while it is used; null: without.
  LightingServices With(LightLearning* learning, const EmissionGuide* guide) const;

  // Chooses lights for the receiver.
  void SelectLights(const Receiver& receiver, float uSelect, LightChoices& choices) const {
    scene_->selector->Select(receiver, learning_, MoreBits(uSelect, receiver.position), choices);
  }
  // A sample on a chosen light.
  DirectSample GenerateSamples(const Receiver& receiver, const SelectedLight& selected, const Point2& u, float time,
                               bool bidirectional) const;

  // What of a sample's light arrives: 0 behind something opaque, 1 where nothing is in the way, and a colour behind
  // cut-outs and thin glass. Traces a shadow ray.
  Color Transmittance(const SurfacePoint& from, const DirectSample& direct, float time) const;

  // What became of a sample: the part of it that arrived at the receiver, 0 too where it was not worth a shadow ray.
  // From any thread; does nothing unless something is recorded.
  void UpdateWithResults(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const {
    if (learning_ && learning_->IsRecording()) RecordResult(receiver, direct, arrived);
  }
  // How lights are chosen for emission without a guide.
  const LightSelector& EmissionSelector() const { return *scene_->emissionSelector; }

  // The area light at a surface point that a ray from `receiver` along the unit `direction` hit; nullopt when that
  // surface emits nothing that way.
  std::optional<FoundLight> EvaluateSamples(const Receiver& receiver, const Vector3& direction, float distance,
                                            const SurfacePoint& point, float time, bool bidirectional) const;

  // The lights at infinity, each as seen by a ray from `receiver` that escapes along `direction`: i in [0,
  // InfiniteCount()).
  size_t InfiniteCount() const { return scene_->infinite.size(); }
  std::optional<FoundLight> EvaluateEscaped(size_t i, const Receiver& receiver, const Vector3& direction, float time,
                                            bool bidirectional) const;

  // What a camera ray sees of a light it hit, or of a light at infinity when it escapes: i in [0, InfiniteCount()).
  Color EmissionForCamera(const Vector3& direction, float distance, const SurfacePoint& point, float time) const;
  Color EscapedEmissionForCamera(size_t i, const Ray& ray) const;
  // Whether a ray that hit `point` from the direction of the unit vector `toRay` met the very place that the photon
  // left.
  bool IsOrigin(const EmittedPhoton& photon, const SurfacePoint& point, const Vector3& toRay, float distance) const;

  // Chooses a light for emission, and emits. Surfaces nearer than EmissionSample::shinesFrom stop the photon.
  std::optional<EmittedPhoton> GenerateEmission(float uSelect, const Point2& u, const Point2& uDirection,
                                                float time) const;
  // How much more often this photon is sent than it would be without a guide.
  float EmissionGain(const EmittedPhoton& photon) const;
  // The light vertex of a photon that landed at `receiver`, as next-event estimation from there sees it: densities
  // without the selection. Delta lights too, which it finds with the discrete density 1.
  std::optional<FoundLight> EvaluateFirstHit(const EmittedPhoton& photon, const Receiver& receiver) const;

  // What a photon brings to the receiver that it has landed on: its light's filter changes it, and where the light is
  // not linked to the receiver it brings nothing. False: nothing is left. The light as it was sent: what it passed on
  // its way comes after the filter.
  bool FilterFirstHit(const EmittedPhoton& photon, const Receiver& receiver, Color& diffuse, Color& specular) const {
    return !scene_->isLinked || LandsFiltered(photon, receiver, diffuse, specular);
  }

  // Whether next-event estimation at a receiver selects patch by patch; otherwise a light's patches have the light's
  // probability.
  bool SelectsPatches(const Receiver& receiver) const { return scene_->selector->SelectsPatches(receiver); }
  PdfDiscrete SelectionProbability(const Receiver& receiver, uint32_t light, int patch) const;
  PdfDiscrete EmissionSelectionProbability(uint32_t light) const;
  // Whether a light has a direction only (infinite and distant lights), and whether a direction that a surface samples
  // can find it.
  bool IsAtInfinity(uint32_t light) const { return lampyr::IsAtInfinity(scene_->fronts[light].kind); }
  bool CanBeHit(uint32_t light) const { return scene_->CanBeHit(light); }
  // Whether there is one that can: a direction that a surface samples may find light.
  bool HasLightThatCanBeHit() const { return scene_->hasLightThatCanBeHit; }

  // The groups that lights are in, and that of the light at infinity `i` and of the area light at a surface point.
  const LightGroups& Groups() const { return scene_->groups; }
  uint32_t GroupOf(uint32_t light) const { return scene_->groups.Of(light); }
  uint32_t GroupOfInfinite(size_t i) const { return scene_->groups.Of(scene_->infinite[i]); }
  uint32_t GroupAt(const SurfacePoint& point) const {
    return scene_->groups.Of(
        static_cast<uint32_t>(std::max(scene_->geometry.LightAt(point.primitive, point.instance), 0)));
  }

  bool HasLights() const { return !scene_->lights.empty(); }
  // W: what light paths carry is in parts of this, a power of two near the power of all lights. A lamp of 1e30 that is
  // a kilometre wide, or of 1e-30 and a micrometre, has a power that no float holds; what arrives of it fits again.
  float FluxUnit() const { return scene_->fluxUnit; }
  const std::vector<PlacedLight>& Lights() const { return scene_->lights; }
  const LightLinking& Linking() const { return scene_->linking; }
  const BoundingSphere& SceneSphere() const { return scene_->sphere; }

 private:
  static double MoreBits(float u, const Point3& of) { return WithMoreBits(u, of.x, of.y, of.z); }
  // `moved` keeps the place of a light that moves, and must live as long as the context.
  LightContext Context(uint32_t light, float time, bool bidirectional, std::optional<LightTransform>& moved) const;

  // What chooses a light and makes its photon, without the guide's part in the densities.
  struct Emission {
    PdfDiscrete selection;
    uint32_t light = 0;
    EmissionSample sample;
  };
  std::optional<Emission> Emit(double uSelect, const Point2& u, const Point2& uDirection, float time) const;
  std::optional<EmissionSample> EmitAimed(const LightContext& context, const EmissionGuide::Choice& choice) const;
  // The guide's part in the density of an emission from `from` along `direction`; at infinity, of any point on the
  // line.
  template <class Record>
  void Aim(uint32_t light, const Point3& from, const Vector3& direction, Record& record) const;

  // An edge between a light and a receiver, with what the light sends along it: linking and filters act on it. False:
  // nothing is left. Each technique that makes such an edge comes here, or to FilterFirstHit.
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

  // Emission chooses a light as a whole: of densities given a patch, that of emission becomes the whole light's.
  PdfArea EmissionDensity(const LightContext& context, uint32_t light, int patch, PdfArea given) const;
  void RecordResult(const Receiver& receiver, const DirectSample& direct, const Color& arrived) const;
  Vector3 ErrorOfEnd(const SurfacePoint& from, const DirectSample& direct, float time) const;

  // What all views of a scene share.
  struct SceneLights {
    SceneLights(const GeometryScene& geometry, std::vector<PlacedLight> lights, LightSelection selection,
                LightLinking linking, int mostSamples);
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
    bool isLinked = false;  // some light has a filter, or does not shine on everything
    std::unique_ptr<LightSelector> selector, emissionSelector;
  };

  std::shared_ptr<const SceneLights> scene_;
  LightLearning* learning_ = nullptr;
  const EmissionGuide* guide_ = nullptr;
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
