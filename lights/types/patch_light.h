// An area light of patches: triangles (mesh.cpp) or bilinear patches (bilinear.cpp). A patch is selected in proportion
// to its area, times the mean of the image over it if there is one. The kind of patch determines how a point in it is
// sampled.
//
// Patches are in render space, or in object space if the object is instanced or moves. The placement is then applied to
// each sample, and a density (1/m²) is that in object space over the local stretch of area.
//
// Patches have, all in their own space:
//   Count(), CanBeSampled(patch)
//   Sample(patch, u)                      parameters of a point
//   SetPoint(patch, p, needsUv, point)    its position, error, normal, uv
//   Density(patch, p)                     1/m², given the patch
//   ParametersOf(patch, uv, position)     of a hit; kParametersNeedPosition: true if the position is used
//   Area(patch, linear)                   under a linear map, as if mapped by it
//   ForElements(patch, linear, image, f)  f(dA, uv, normal) over the patch, whose areas add up to Area
//   Bounds(patch, transform)              box, cone of normals, and whether both sides may be the outer one
#pragma once

#include <optional>

#include "geometry/mapped_area.h"
#include "lights/direction_map.h"
#include "lights/estimates.h"
#include "lights/types/area_lights.h"
#include "lights/types/exitance_table.h"
#include "sampling/tables.h"

namespace lampyr {

template <class Patches>
class PatchLight final : public LightBase {
 public:
  PatchLight(LightTypeFunction type, const ParameterList& parameters, const LightBuildContext& build, Patches patches,
             const EmissionReader& readEmission)
      : LightBase(type, parameters),
        patches_(std::move(patches)),
        built_(build.transform),
        isInPlace_(IsIdentity(build.transform.toRender)),
        mappedArea_(MapArea()),
        builtArea_(TotalArea(built_)),
        emission_(readEmission(
            parameters, build,
            {builtArea_,
             [this](const LightTransform& t) { return mappedArea_.Under(glm::dmat3(t.toRender.linear)); }})),
        exitance_(emission_, built_) {
    BuildTable();
    wholePower_ = PowerOfAll(built_, exitance_);
    wholeBounds_ = BoundsOfAll(built_);
    KeepPatches();
  }

  LightKind Kind() const override { return LightKind::Area; }
  int PatchCount() const override { return std::max<int>(1, static_cast<int>(patches_.Count())); }
  PdfDiscrete PatchProbability(int patch) const override {
    const bool isOne = !table_.IsZero() && static_cast<uint32_t>(patch) < patches_.Count();
    return isOne ? table_.Probability(static_cast<uint32_t>(patch)) : PdfDiscrete(0);
  }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3& P) const override {
    const EmissionBounds bounds = ReachFor(context);
    return SurfaceIrradianceEstimate(bounds, emission_.ApparentPower(context, bounds, UnshapedPowerFor(context), P), P);
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext& context, const Point3& origin,
                                                             const Vector3& direction, float length) const override {
    return SurfaceSegmentEstimate(ReachFor(context), emission_.LargestPower(UnshapedPowerFor(context)), origin,
                                  direction, length);
  }
  Color GetPowerEstimate(const LightContext& context) const override { return PowerFor(context); }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    EmissionBounds bounds = ReachFor(context);
    bounds.energy = PowerFor(context).Average() * Settings().importanceMultiplier;
    return bounds;
  }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    EmittingPoint point;
    if (!SamplePoint(context, point)) return std::nullopt;
    return emission_.Sample(context, P, point);
  }
  std::optional<LightEvaluation> EvaluateSamples(const LightContext& context, const LightHit& hit,
                                                 const Point3&) const override {
    const auto patch = static_cast<uint32_t>(hit.patchIndex);
    if (patch >= patches_.Count()) return std::nullopt;
    const bool isInPlace = IsInPlace(context);
    const Point3 position =
        Patches::kParametersNeedPosition && !isInPlace ? context.transform->toLocal.Point(hit.position) : hit.position;
    const Point2 p = patches_.ParametersOf(patch, hit.uv, position);
    return emission_.Evaluate(context, hit, AreaDensity(context, isInPlace, patch, p, hit.normal));
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    EmittingPoint point;
    if (!SamplePoint(context, point)) return std::nullopt;
    return emission_.Emit(context, point);
  }
  float Opacity(const LightHit& hit) const override { return emission_.OpacityAt(hit); }
  Color EvaluateEmissionForCamera(const LightContext& context, const LightHit& hit) const override {
    return emission_.ForCamera(context, hit, Settings().cameraVisible);
  }

 private:
  bool IsAsBuilt(const LightContext& context) const { return SamePlacement(*context.transform, built_); }
  bool IsInPlace(const LightContext& context) const { return isInPlace_ && IsAsBuilt(context); }

  // 1/m² in render space at parameters p, with the normal `normal`.
  PdfArea AreaDensity(const LightContext& context, bool isInPlace, uint32_t patch, const Point2& p,
                      const Normal3& normal) const {
    if (table_.IsZero()) return PdfArea(0);
    if (context.patch != kAnyPatch && static_cast<uint32_t>(context.patch) != patch) return PdfArea(0);
    const PdfDiscrete choice = context.patch == kAnyPatch ? table_.Probability(patch) : PdfDiscrete(1);
    const PdfArea density = choice * PdfArea(patches_.Density(patch, p));
    if (isInPlace) return density;
    const PdfArea placed(density.value / AreaStretch(context.transform->toRender, normal));
    return placed.value < kInfinity ? placed : PdfArea(0);
  }

  // False if nothing can be sampled.
  bool SamplePoint(const LightContext& context, EmittingPoint& point) const;
  void BuildTable();
  void KeepPatches();
  double TotalArea(const LightTransform& transform) const;
  MappedArea MapArea() const;
  // `exitance`: called as an ExitanceTable is.
  template <class Exitance>
  Color PowerOfOne(uint32_t patch, const LightTransform& transform, const Exitance& exitance) const;
  Color PowerOfAll(const LightTransform& transform, const ExitanceTable& exitance) const;
  Color PowerFor(const LightContext& context) const;
  // Mean of the channels, ignoring shaping and the variation of the image.
  float UnshapedPowerFor(const LightContext& context) const;
  EmissionBounds BoundsOfAll(const LightTransform& transform) const;
  // The emission bounds without the energy.
  EmissionBounds ReachFor(const LightContext& context) const;
  EmissionBounds MovedBounds(const LightContext& context) const;
  EmissionBounds BoundsOfOne(uint32_t patch, const LightTransform& transform) const;

  Patches patches_;
  LightTransform built_;
  bool isInPlace_;  // the patches are in render space, as long as the placement is the one they were built with
  MappedArea mappedArea_;
  double builtArea_ = 0;
  SurfaceEmission emission_;
  ExitanceTable exitance_;
  AliasTable table_;
  Color wholePower_;
  EmissionBounds wholeBounds_;
  // Bounds and area of each patch as built: estimates need them at every vertex of a path. Empty: too many patches.
  struct Kept {
    EmissionBounds bounds;
    double area = 0;
  };
  static constexpr uint32_t kMostKept = 4096;
  std::vector<Kept> kept_;
};

template <class Patches>
void PatchLight<Patches>::KeepPatches() {
  if (patches_.Count() > kMostKept) return;
  const glm::dmat3 linear(built_.toRender.linear);
  for (uint32_t i = 0; i < patches_.Count(); ++i) kept_.push_back({BoundsOfOne(i, built_), patches_.Area(i, linear)});
}

template <class Patches>
bool PatchLight<Patches>::SamplePoint(const LightContext& context, EmittingPoint& point) const {
  if (table_.IsZero()) return false;
  Point2 u = context.u;
  auto patch = static_cast<uint32_t>(context.patch);
  if (context.patch == kAnyPatch) {
    const AliasTable::Result choice = table_.Sample(u.x);
    patch = choice.index;
    u.x = choice.u;
  }
  if (patch >= patches_.Count() || !patches_.CanBeSampled(patch)) return false;
  const Point2 p = patches_.Sample(patch, u);
  // uv is only needed for an image or for cut-outs.
  patches_.SetPoint(patch, p, emission_.NeedsUv(), point);
  point.patch = static_cast<int>(patch);
  const bool isInPlace = IsInPlace(context);
  if (!isInPlace) {
    const LightTransform& transform = *context.transform;
    point.positionError = transform.toRender.PointError(point.position, point.positionError);
    point.position = transform.toRender.Point(point.position);
    point.normal = SafeNormalize(transform.toLocal.NormalByInverse(point.normal), Normal3(0.0f));
  }
  point.density = AreaDensity(context, isInPlace, patch, p, point.normal);
  return true;
}

template <class Patches>
double PatchLight<Patches>::TotalArea(const LightTransform& transform) const {
  const glm::dmat3 linear(transform.toRender.linear);
  double sum = 0;
  for (uint32_t i = 0; i < patches_.Count(); ++i) sum += patches_.Area(i, linear);
  return sum;
}

template <class Patches>
MappedArea PatchLight<Patches>::MapArea() const {
  MappedArea area;
  for (uint32_t i = 0; i < patches_.Count(); ++i) {
    patches_.ForElements(i, glm::dmat3(1.0), nullptr,
                         [&](double part, const Point2&, const Normal3& normal) { area.Add(part, Vector3d(normal)); });
  }
  area.Finish();
  return area;
}

template <class Patches>
void PatchLight<Patches>::BuildTable() {
  const glm::dmat3 linear(built_.toRender.linear);
  const EmissionImage* image = emission_.HasImage() ? &emission_.EmittedImage() : nullptr;
  // The points that estimate a mean may miss a bright texel, so a fraction of the mean of the whole image is added.
  const double floor = image ? 0.01 * static_cast<double>(image->Mean().Average()) : 0.0;
  std::vector<float> weights(patches_.Count());
  for (uint32_t i = 0; i < patches_.Count(); ++i) {
    if (!patches_.CanBeSampled(i)) continue;
    // Without an image, by area alone, so that a light with radiance 0 can be sampled.
    double weight = 0;
    if (image) {
      patches_.ForElements(i, linear, image, [&](double area, const Point2& uv, const Normal3&) {
        weight += area * (static_cast<double>(image->OnSurface(uv).Average()) + floor);
      });
    } else {
      weight = patches_.Area(i, linear);
    }
    weights[i] = static_cast<float>(weight);
  }
  table_ = AliasTable(weights);
}

template <class Patches>
template <class Exitance>
Color PatchLight<Patches>::PowerOfOne(uint32_t patch, const LightTransform& transform, const Exitance& exitance) const {
  const EmissionImage* image = emission_.HasImage() ? &emission_.EmittedImage() : nullptr;
  Color sum;
  patches_.ForElements(patch, glm::dmat3(transform.toRender.linear), image,
                       [&](double area, const Point2& uv, const Normal3& normal) {
                         const auto placedNormal = [&] {
                           return SafeNormalize(transform.toLocal.NormalByInverse(normal), Normal3(0, 0, 1));
                         };
                         sum += static_cast<float>(area) * emission_.Radiance(uv) * exitance(placedNormal);
                       });
  return sum * emission_.Strength(transform);
}

template <class Patches>
Color PatchLight<Patches>::PowerOfAll(const LightTransform& transform, const ExitanceTable& exitance) const {
  Vector3d sum(0.0);
  for (uint32_t i = 0; i < patches_.Count(); ++i) {
    const Color one = PowerOfOne(i, transform, exitance);
    sum += Vector3d(static_cast<double>(one.r), static_cast<double>(one.g), static_cast<double>(one.b));
  }
  return {static_cast<float>(sum.x), static_cast<float>(sum.y), static_cast<float>(sum.z)};
}

template <class Patches>
Color PatchLight<Patches>::PowerFor(const LightContext& context) const {
  const bool isWhole = context.patch == kAnyPatch;
  const auto patch = static_cast<uint32_t>(context.patch);
  if (!isWhole && patch >= patches_.Count()) return Color(0.0f);
  if (IsAsBuilt(context)) return isWhole ? wholePower_ : PowerOfOne(patch, built_, exitance_);
  if (const auto scaleSquared = RelativeScaleSquared(built_, *context.transform)) {
    return (isWhole ? wholePower_ : PowerOfOne(patch, built_, exitance_)) * emission_.PowerScale(*scaleSquared);
  }
  if (isWhole) return PowerOfAll(*context.transform, ExitanceTable(emission_, *context.transform));
  // A table would need the exitance of hundreds of normals; one patch has few, and a triangle one.
  std::optional<Normal3> last;
  Color ofLast;
  return PowerOfOne(patch, *context.transform, [&](const auto& getNormal) {
    const Normal3 normal = emission_.Shaped() ? getNormal() : Normal3(0, 0, 1);
    if (last != normal) {
      last = normal;
      ofLast = emission_.Exitance(*context.transform, normal);
    }
    return ofLast;
  });
}

template <class Patches>
float PatchLight<Patches>::UnshapedPowerFor(const LightContext& context) const {
  const LightTransform& now = *context.transform;
  double area = builtArea_;
  if (context.patch != kAnyPatch) {
    const auto patch = static_cast<uint32_t>(context.patch);
    if (patch >= patches_.Count()) return 0;
    area = !kept_.empty() && IsAsBuilt(context) ? kept_[patch].area
                                                : patches_.Area(patch, glm::dmat3(now.toRender.linear));
  } else if (!IsAsBuilt(context)) {
    const auto scaleSquared = RelativeScaleSquared(built_, now);
    area = scaleSquared ? builtArea_ * static_cast<double>(*scaleSquared)
                        : mappedArea_.Under(glm::dmat3(now.toRender.linear));
  }
  return emission_.MeanRadiance().Average() * static_cast<float>(area) * emission_.Strength(now) * kPi *
         emission_.SideCount();
}

template <class Patches>
EmissionBounds PatchLight<Patches>::BoundsOfAll(const LightTransform& transform) const {
  EmissionBounds whole;
  Vector3d sum(0.0);
  whole.twoSided = emission_.IsTwoSided();
  const glm::dmat3 linear(transform.toRender.linear);
  for (uint32_t i = 0; i < patches_.Count(); ++i) {
    if (!patches_.CanBeSampled(i)) continue;
    const EmissionBounds one = patches_.Bounds(i, transform);
    whole.box.Add(one.box);
    sum += patches_.Area(i, linear) * Vector3d(one.axis);
    whole.twoSided = whole.twoSided || one.twoSided;
  }
  const double length = glm::length(sum);
  whole.cosThetaO = -1;
  if (length > 0) {
    whole.axis = Vector3(sum / length);
    float widest = 0;
    for (uint32_t i = 0; i < patches_.Count(); ++i) {
      if (!patches_.CanBeSampled(i)) continue;
      const EmissionBounds one = patches_.Bounds(i, transform);
      widest = std::max(widest, std::acos(std::clamp(glm::dot(whole.axis, one.axis), -1.0f, 1.0f)) +
                                    (one.cosThetaO < 1 ? std::acos(one.cosThetaO) : 0.0f));
    }
    whole.cosThetaO = widest < kPi ? std::cos(widest) : -1.0f;
  }
  return whole;
}

// The bounds as built, transformed, if the placement preserves angles; otherwise computed from the patches.
template <class Patches>
EmissionBounds PatchLight<Patches>::MovedBounds(const LightContext& context) const {
  const LightTransform& now = *context.transform;
  if (!RelativeScaleSquared(built_, now)) return BoundsOfAll(now);
  EmissionBounds bounds = wholeBounds_;
  bounds.box = Bounds3();
  for (int i = 0; i < 8; ++i) {
    bounds.box.Add(now.toRender.Point(built_.toLocal.Point(wholeBounds_.box.Corner(i))));
  }
  bounds.axis = SafeNormalize(now.toRender.Vector(built_.toLocal.Vector(wholeBounds_.axis)), wholeBounds_.axis);
  return bounds;
}

template <class Patches>
EmissionBounds PatchLight<Patches>::BoundsOfOne(uint32_t patch, const LightTransform& transform) const {
  if (!patches_.CanBeSampled(patch)) return EmissionBounds{};
  EmissionBounds bounds = patches_.Bounds(patch, transform);
  bounds.twoSided = bounds.twoSided || emission_.IsTwoSided();
  return bounds;
}

template <class Patches>
EmissionBounds PatchLight<Patches>::ReachFor(const LightContext& context) const {
  const auto patch = static_cast<uint32_t>(context.patch);
  if (context.patch != kAnyPatch) {
    if (patch >= patches_.Count()) return EmissionBounds{};
    return !kept_.empty() && IsAsBuilt(context) ? kept_[patch].bounds : BoundsOfOne(patch, *context.transform);
  }
  return IsAsBuilt(context) ? wholeBounds_ : MovedBounds(context);
}

}  // namespace lampyr
