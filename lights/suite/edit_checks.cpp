// Editing a light: the edited one is, bit by bit, the one that is made afresh from the merged parameters. Whatever was
// computed from the old parameters and not anew shows.
#include <cstring>

#include "lights/light_base.h"
#include "lights/suite/checks.h"

namespace lampyr::suite {

namespace {

bool SameBits(float a, float b) {
  return std::memcmp(&a, &b, sizeof(float)) == 0;
}
bool SameBits(const Vector3& a, const Vector3& b) {
  return SameBits(a.x, b.x) && SameBits(a.y, b.y) && SameBits(a.z, b.z);
}
bool SameBits(const Color& a, const Color& b) {
  return SameBits(a.r, b.r) && SameBits(a.g, b.g) && SameBits(a.b, b.b);
}

bool SameBits(const LightSample& a, const LightSample& b) {
  return SameBits(a.direction, b.direction) && SameBits(a.distance, b.distance) && SameBits(a.position, b.position) &&
         SameBits(a.normal, b.normal) && SameBits(a.uvw, b.uvw) && a.patchIndex == b.patchIndex &&
         SameBits(a.diffuse, b.diffuse) && SameBits(a.specular, b.specular) &&
         SameBits(a.pdfDirect.value, b.pdfDirect.value) && SameBits(a.pdfEmit.value, b.pdfEmit.value) &&
         SameBits(a.pdfEmitDirection.value, b.pdfEmitDirection.value) &&
         SameBits(a.solidAngleToArea, b.solidAngleToArea);
}
bool SameBits(const LightEvaluation& a, const LightEvaluation& b) {
  return SameBits(a.normal, b.normal) && SameBits(a.diffuse, b.diffuse) && SameBits(a.specular, b.specular) &&
         SameBits(a.pdfDirect.value, b.pdfDirect.value) && SameBits(a.pdfEmit.value, b.pdfEmit.value) &&
         SameBits(a.pdfEmitDirection.value, b.pdfEmitDirection.value) &&
         SameBits(a.solidAngleToArea, b.solidAngleToArea);
}
bool SameBits(const EmissionSample& a, const EmissionSample& b) {
  return SameBits(a.position, b.position) && SameBits(a.normal, b.normal) && SameBits(a.direction, b.direction) &&
         SameBits(a.emissionCosine, b.emissionCosine) && SameBits(a.uvw, b.uvw) && a.patchIndex == b.patchIndex &&
         SameBits(a.diffuse, b.diffuse) && SameBits(a.specular, b.specular) &&
         SameBits(a.pdfEmit.value, b.pdfEmit.value) && SameBits(a.pdfEmitDirection.value, b.pdfEmitDirection.value);
}
bool SameBits(const SegmentEstimate& a, const SegmentEstimate& b) {
  return SameBits(a.radiance, b.radiance) && SameBits(a.minT, b.minT) && SameBits(a.maxT, b.maxT);
}
bool SameBits(const LocalHit& a, const LocalHit& b) {
  return a.t == b.t && a.position == b.position && a.normal == b.normal && a.uv == b.uv;
}
template <class Result>
bool SameBits(const std::optional<Result>& a, const std::optional<Result>& b) {
  return a.has_value() == b.has_value() && (!a || SameBits(*a, *b));
}

bool SameSurfaces(const IntersectableLight* a, const IntersectableLight* b, Rng& rng) {
  if (!a || !b) return a == b;
  const std::vector<Point3> points = a->GetBounds();
  if (points != b->GetBounds()) return false;
  Bounds3d box;
  for (const Point3& p : points) box.Add(Point3d(p));
  for (int i = 0; i < 256; ++i) {
    Vector3d within;
    for (int k = 0; k < 3; ++k) within[k] = static_cast<double>(rng.NextFloat());
    LocalRay ray;
    ray.direction = RandomDirection(rng);
    ray.tMax = 4 * glm::length(box.Diagonal());
    ray.origin = box.min + within * box.Diagonal() - 0.5 * ray.tMax * ray.direction;
    if (!SameBits(a->Intersect(ray), b->Intersect(ray))) return false;
  }
  return true;
}

// What differs between two lights, "" when nothing does.
std::string Difference(const SuiteSubject& subject, const Light& a, const Light& b) {
  if (a.Kind() != b.Kind() || a.PatchCount() != b.PatchCount()) return "kind";
  const LightSettings &s = a.Settings(), &t = b.Settings();
  if (s.name != t.name || s.lightGroup != t.lightGroup || s.cameraVisible != t.cameraVisible ||
      s.traceLightPaths != t.traceLightPaths || s.importanceMultiplier != t.importanceMultiplier ||
      s.fixedSampleCount != t.fixedSampleCount) {
    return "settings";
  }
  if (!SameBits(a.GetPowerEstimate(subject.context), b.GetPowerEstimate(subject.context))) return "power";
  const auto ab = a.GetEmissionBounds(subject.context), bb = b.GetEmissionBounds(subject.context);
  if (ab.has_value() != bb.has_value()) return "bounds";
  if (ab && !(SameBits(ab->box.min, bb->box.min) && SameBits(ab->box.max, bb->box.max) &&
              SameBits(ab->axis, bb->axis) && SameBits(ab->energy, bb->energy) && ab->twoSided == bb->twoSided &&
              SameBits(ab->cosThetaO, bb->cosThetaO) && SameBits(ab->cosThetaE, bb->cosThetaE))) {
    return "bounds";
  }
  Rng rng(subject.caseName.size());
  if (!SameSurfaces(a.Surface(), b.Surface(), rng)) return "surface";
  for (int i = 0; i < 256; ++i) {
    const LightContext context = RandomContext(subject, rng);
    const float reach = subject.context.scene.radius * rng.NextFloat();
    const Point3 P = subject.context.scene.center + reach * Vector3(RandomDirection(rng));
    const auto sa = a.GenerateSamples(context, P), sb = b.GenerateSamples(context, P);
    if (!SameBits(sa, sb)) return "samples";
    if (sa && !SameBits(a.EvaluateSamples(context, HitOf(*sa, P), P), b.EvaluateSamples(context, HitOf(*sa, P), P)))
      return "evaluations";
    if (sa && !SameBits(a.EvaluateEmissionForCamera(context, HitOf(*sa, P)),
                        b.EvaluateEmissionForCamera(context, HitOf(*sa, P))))
      return "what the camera sees";
    if (!SameBits(a.GenerateEmission(context), b.GenerateEmission(context))) return "photons";
    if (!SameBits(a.GetIncidentRadianceEstimate(context, P), b.GetIncidentRadianceEstimate(context, P)))
      return "estimates";
    const Vector3 along(RandomDirection(rng));
    if (!SameBits(a.GetIncidentRadianceEstimate(context, P, along, reach),
                  b.GetIncidentRadianceEstimate(context, P, along, reach)))
      return "estimates of segments";
  }
  return "";
}

}  // namespace

void CheckEdit(const SuiteSubject& subject, const SuiteOrigin& origin, SuiteReport& report) {
  for (size_t i = 0; i < origin.changes.size(); ++i) {
    const ParameterList& changes = origin.changes[i];
    std::unique_ptr<Light> fresh, edited;
    try {
      fresh = MakeLight(*origin.type, MergeParameters(*origin.parameters, changes), *origin.build);
    } catch (const Error&) {
      // The two do not go together: editing must say so too.
    }
    try {
      edited = subject.light->Edit(changes, *origin.build);
    } catch (const Error&) {}
    std::string difference = "error";
    if (!fresh && !edited) difference = "";
    if (fresh && edited) difference = Difference(subject, *fresh, *edited);
    const std::string what = changes.All().empty() ? "nothing" : changes.All()[0].name;
    report.AddError(subject.name, "edit",
                    subject.caseName + " by " + what + (difference.empty() ? "" : ": other " + difference),
                    difference.empty() ? 0 : 1, 0.5);
  }
}

}  // namespace lampyr::suite
