// A spot light (pbrt-v4's "spot"): full intensity I (W/sr) within a core cone, a smoothstep in cosθ from there to the
// edge of the cone, nothing outside.
//
// Angles enter as w = 1 - cosθ, half the squared chord between direction and axis: cosθ itself has no digits left for a
// cone of 0.01°. In w the profile is 1 up to wStart and smoothstep(t) with t = (wEnd - w) / (wEnd - wStart) up to wEnd;
// its integral over solid angle is 2π (wStart + (wEnd - wStart) / 2), and emission is sampled exactly in proportion to
// it.
#include "lights/types/shaped_point.h"
#include "math/frame.h"
#include "sampling/warp.h"

namespace lampyr {

LightType SpotLightType();

namespace {

// t in [0,1] with density 2·smoothstep(t): inverts 2t³ - t⁴, increasing, by Newton steps kept within a bracket.
float SampleSmoothstep(float u) {
  float low = 0, high = 1, t = std::cbrt(0.5f * u);
  for (int i = 0; i < 24; ++i) {
    const float value = t * t * t * (2 - t) - u;
    (value < 0 ? low : high) = t;
    const float slope = t * t * (6 - 4 * t);
    float next = slope > 0 ? t - value / slope : 0.5f * (low + high);
    if (!(next > low && next < high)) next = 0.5f * (low + high);
    if (std::abs(next - t) <= 1e-7f) return next;
    t = next;
  }
  return t;
}

class ConeProfile {
 public:
  ConeProfile(const Vector3& axis, double coneAngle, double coreAngle)
      : axis_(axis),
        frame_(Frame::FromNormal(axis)),
        wStart_(OneMinusCos(coreAngle)),
        wEnd_(std::max(OneMinusCos(coneAngle), 1e-30f)) {}

  float Shape(const LightTransform& transform, const Vector3& direction) const {
    return LocalShape(ToLocalDirection(transform, direction));
  }

  Vector3 Sample(const LightTransform& transform, const Point2& u) const {
    const float core = CoreShare();
    float w;
    if (u.x < core) {
      w = wStart_ * std::min(u.x / core, 1.0f);
    } else {
      const float t = SampleSmoothstep(std::min((u.x - core) / (1 - core), 1.0f));
      w = wEnd_ - t * (wEnd_ - wStart_);
    }
    const Vector2 around = CosSinTurns(u.y);
    const float r = SafeSqrt(w * (2 - w));
    return ToRenderDirection(transform, frame_.ToWorld({r * around.x, r * around.y, 1 - w}));
  }

  // Density proportional to the intensity in local directions, times the change of solid angle. All methods that report
  // it call this.
  PdfSolidAngle Density(const LightTransform& transform, const Vector3& direction) const {
    const float density = LocalShape(ToLocalDirection(transform, direction)) / LocalSolidAngle();
    return PdfSolidAngle(density * LocalSolidAngleFactor(transform, direction));
  }

  double SolidAngle(const LightTransform& transform) const;
  float Largest() const { return 1; }
  void SetCones(const LightTransform& transform, EmissionBounds& bounds) const {
    SetConeBounds(transform, axis_, wEnd_, bounds);
  }
  bool Clip(const LightTransform& transform, const Point3& from, const Point3& origin, const Vector3& direction,
            float& minT, float& maxT) const {
    return ClipToCone(transform, from, axis_, wEnd_, origin, direction, minT, maxT);
  }

 private:
  static float OneMinusCos(double degrees) {
    const double s = std::sin(degrees * (3.14159265358979323846 / 360));
    return static_cast<float>(2 * s * s);
  }
  float LocalShape(const Vector3& local) const {
    const float w = 0.5f * LengthSquared(local - axis_);
    if (w <= wStart_) return 1;
    if (w >= wEnd_) return 0;
    const float t = (wEnd_ - w) / (wEnd_ - wStart_);
    return t * t * (3 - 2 * t);
  }
  float LocalSolidAngle() const { return 2 * kPi * (wStart_ + 0.5f * (wEnd_ - wStart_)); }
  float CoreShare() const { return wStart_ / (wStart_ + 0.5f * (wEnd_ - wStart_)); }
  // A direction at w from the axis, `turns` around it.
  Vector3 LocalDirection(float w, float turns) const {
    const Vector2 around = CosSinTurns(turns);
    const float r = SafeSqrt(w * (2 - w));
    return frame_.ToWorld({r * around.x, r * around.y, 1 - w});
  }

  Vector3 axis_;  // local, unit
  Frame frame_;
  float wStart_, wEnd_;
};

// Closed form under rotations and uniform scales; otherwise a quadrature in local directions.
double ConeProfile::SolidAngle(const LightTransform& transform) const {
  if (IsSimilarity(transform.toRender.linear)) return static_cast<double>(LocalSolidAngle());
  constexpr int n = 64;
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const float w = wEnd_ * (static_cast<float>(i / n) + 0.5f) / n;
    const Vector3 local = LocalDirection(w, (static_cast<float>(i % n) + 0.5f) / n);
    sum +=
        static_cast<double>(LocalShape(local) / LocalSolidAngleFactor(transform, ToRenderDirection(transform, local)));
  }
  return sum * static_cast<double>(2 * kPi * wEnd_) / (n * n);
}

std::unique_ptr<Light> CreateSpot(const ParameterList& parameters, const LightBuildContext& build) {
  const Vector3d axis = parameters.GetPoint3("to", {0, 0, 1}) - parameters.GetPoint3("from", {0, 0, 0});
  if (!(glm::length(axis) > 0))
    throw Error(parameters.Where(), "LightSource \"spot\": \"from\" and \"to\" are the same point");
  const double cone = parameters.GetFloat("coneangle", 30);
  double delta = parameters.GetFloat("conedeltaangle", 5);
  if (delta > cone) {
    delta = cone;
    if (build.diagnostics) {
      build.diagnostics->Warn(
          parameters.WhereOf("conedeltaangle"),
          "LightSource \"spot\": \"conedeltaangle\" is larger than \"coneangle\"; the cone angle is used");
    }
  }
  const Vector3 direction(glm::normalize(axis));
  return MakePointLight(SpotLightType, parameters, build, ConeProfile(direction, cone, cone - delta),
                        PointSource::Read(parameters), direction);
}

}  // namespace

LightType SpotLightType() {
  LightType type;
  type.name = "spot";
  type.help = "a point that shines into a cone with a soft edge; shaping is about its axis, not -z";
  type.parameters = WithShapingParameters({
      {"I", ParameterType::Spectrum, "W/sr", "1", "", "intensity along the axis"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the intensity"},
      {"power", ParameterType::Float, "W", "-1", "", "if positive: total power that an intensity of 1 is scaled to"},
      {"from", ParameterType::Point3, "", "0 0 0", "", "position"},
      {"to", ParameterType::Point3, "", "0 0 1", "", "a point on the axis"},
      {"coneangle", ParameterType::Float, "°", "30", "(0,180]", "between the axis and the edge of the cone"},
      {"conedeltaangle", ParameterType::Float, "°", "5", "[0,180]", "width of the soft edge, inwards"},
  });
  type.create = CreateSpot;
  type.samples = {
      "\"rgb I\" [ 3 2 1 ]",
      "\"point3 from\" [ 1 2 0.5 ] \"point3 to\" [ 0 0 0 ] \"float coneangle\" 60 \"float conedeltaangle\" 60 \"float "
      "power\" 20",
      "\"float coneangle\" 150 \"float conedeltaangle\" 0",
      "\"float coneangle\" 0.01 \"float conedeltaangle\" 0.002",
      "\"float coneangle\" 179.9 \"float conedeltaangle\" 90",
      "\"string shaping:ies:file\" \"suite-profile.ies\" \"float coneangle\" 70 \"float conedeltaangle\" 20 \"float "
      "power\" 20",
      "\"string shaping:ies:file\" \"suite-profile.ies\" \"point3 to\" [ 1 2 0.5 ] \"float coneangle\" 8",
  };
  return type;
}

}  // namespace lampyr
