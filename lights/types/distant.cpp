// Light from one direction, parallel (pbrt-v4's "distant"), or from a disk of the sky around it (UsdLux's
// DistantLight).
//
// Without `angle`, L is the irradiance in W/m² of a surface that faces the light. With an angle of 2θ, L is the
// radiance in W/(m² sr) of all directions within θ. `normalize` divides it by UsdLux's size factor, π sin²θ up to 90°
// and π (2 - sin²θ) beyond, so that a small disk gives the irradiance of parallel light; under a transform that does
// not preserve angles, by the same integral over the placed cone. `illuminance` scales the light such that a facing
// surface receives `illuminance` times L.
//
// The disk is a cone in local directions; under a transform that does not preserve angles it becomes an ellipse. It is
// expressed, and sampled uniformly, in w = 1 - cosθ, half the squared chord to the axis, to avoid cancellation. A unit
// direction in float is accurate to 1e-7: below an angle of 1e-3° the samples cannot differ, and the light is rendered
// as parallel with the irradiance that the disk would give.
#include "lights/infinite_light.h"

namespace lampyr {

LightType DistantLightType();

namespace {

constexpr double kPiDouble = 3.14159265358979323846;
constexpr double kSmallestAngle = 1e-3;  // degrees

Vector3 ReadToLight(const ParameterList& parameters) {
  const Vector3d toLight = parameters.GetPoint3("from", {0, 0, 0}) - parameters.GetPoint3("to", {0, 0, 1});
  if (!(glm::length(toLight) > 0)) {
    throw Error(parameters.Where(), "LightSource \"distant\": \"from\" and \"to\" are the same point");
  }
  return Vector3(glm::normalize(toLight));
}

class ParallelLight final : public LightBase {
 public:
  ParallelLight(const ParameterList& parameters, const Color& irradiance)
      : LightBase(DistantLightType, parameters),
        toLight_(ReadToLight(parameters)),
        irradiance_(irradiance),
        tint_(ReadLightTint(parameters)) {}

  LightKind Kind() const override { return LightKind::DeltaDirection; }

  float GetIncidentRadianceEstimate(const LightContext& context, const Point3&) const override {
    const float facing = irradiance_.Average();
    if (!(LengthSquared(context.receiverNormal) > 0)) return facing;
    const float cosine = glm::dot(context.receiverNormal, ToRenderDirection(*context.transform, toLight_));
    return facing * (context.receiverIsTransmissive ? std::abs(cosine) : std::max(cosine, 0.0f));
  }
  std::optional<SegmentEstimate> GetIncidentRadianceEstimate(const LightContext&, const Point3&, const Vector3&,
                                                             float length) const override {
    if (irradiance_.IsBlack()) return std::nullopt;
    return SegmentEstimate{irradiance_.Average(), 0, length};
  }
  Color GetPowerEstimate(const LightContext& context) const override {
    return irradiance_ * EmissionDiskArea(context.scene);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext&) const override { return std::nullopt; }

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3&) const override {
    std::optional<LightSample> sample(std::in_place);
    if (!tint_.Split(irradiance_, *sample)) return std::nullopt;
    sample->direction = ToRenderDirection(*context.transform, toLight_);
    sample->normal = -sample->direction;
    sample->pdfDirect = PdfSolidAngle(1);
    if (context.bidirectional) {
      sample->pdfEmit = EmissionDiskDensity(context.scene);
      sample->pdfEmitDirection = PdfSolidAngle(1);
      sample->solidAngleToArea = 1;
    }
    return sample;
  }

  std::optional<LightEvaluation> EvaluateSamples(const LightContext&, const LightHit&, const Point3&) const override {
    return std::nullopt;
  }

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    EmissionSample sample =
        EmitFromInfinity(context.scene, ToRenderDirection(*context.transform, toLight_), context.uDirection);
    if (!tint_.Split(irradiance_, sample)) return std::nullopt;
    sample.pdfEmitDirection = PdfSolidAngle(1);
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext&, const LightHit&) const override { return Color(0.0f); }

 private:
  Vector3 toLight_;  // local, unit
  Color irradiance_;
  LightTint tint_;
};

// A sky of constant radiance within a cone of directions.
class ConeSky {
 public:
  ConeSky(const Vector3& axis, double halfAngle, const Color& radiance)
      : axis_(axis), frame_(Frame::FromNormal(axis)), radiance_(radiance) {
    const double chord = 2 * std::sin(0.5 * halfAngle);
    w_ = 0.5 * chord * chord;
    isSphere_ = halfAngle >= kPiDouble;
    // Samples keep a margin to the rim, the rounding error of directions, so that each is also found inside the cone
    // when it is evaluated.
    const double inner = isSphere_ ? chord : std::max(chord - 3e-7, 0.0);
    wSampled_ = static_cast<float>(0.5 * inner * inner);
    const double sine = std::sin(halfAngle);
    facing_ = static_cast<float>(halfAngle < 0.5 * kPiDouble ? kPiDouble * sine * sine : kPiDouble);
  }

  Color Radiance(const Vector3& local) const { return Contains(local) ? radiance_ : Color(0.0f); }
  SkySample Sample(const SkyReceiver&, const Point2& u) const {
    return {frame_.ToWorld(SampleUniformCone(u, wSampled_)), {}, false};
  }
  SkyPoint Look(const SkyReceiver&, const Vector3& local) const {
    if (!Contains(local)) return {Color(0.0f), PdfSolidAngle(0), PdfSolidAngle(0)};
    const PdfSolidAngle density = UniformConePdf(static_cast<float>(w_));
    return {radiance_, density, density};
  }
  Color Mean() const { return radiance_ * static_cast<float>(0.5 * w_); }
  float Irradiance(const SkyReceiver& receiver) const {
    const float facing = facing_ * radiance_.Average();
    if (!receiver.HasNormal()) return facing;
    // The mean of the directions is along the axis, and of this length.
    const float length = static_cast<float>(1 - 0.5 * w_), variance = 1 - length * length;
    const float cosine = glm::dot(receiver.normal, axis_) * length;
    return facing * MeanCosine(cosine, variance, receiver.isTransmissive) / MeanCosine(length, variance, false);
  }

 private:
  bool Contains(const Vector3& local) const {
    return isSphere_ || 0.5f * LengthSquared(local - axis_) <= static_cast<float>(w_);
  }

  Vector3 axis_;  // local, unit
  Frame frame_;
  Color radiance_;
  double w_ = 0;  // 1 - cosθ
  float wSampled_ = 0, facing_ = 0;
  bool isSphere_ = false;
};

// Integrals over a cone of directions, as placed: of the cosine to its axis where that is positive (the factor from
// radiance to the irradiance of a surface that faces the axis), and of the absolute cosine.
struct ConeIntegrals {
  double facing = 0, size = 0;
};

ConeIntegrals IntegrateCone(const Vector3& axis, double theta, const LightTransform& transform) {
  const double squared = std::sin(theta) * std::sin(theta);
  if (IsSimilarity(transform.toRender.linear)) {
    if (theta > 0.5 * kPiDouble) return {kPiDouble, kPiDouble * (2 - squared)};
    return {kPiDouble * squared, kPiDouble * squared};
  }
  constexpr int n = 256;  // in 1 - cosθ and around the axis
  const double end = 2 * std::sin(0.5 * theta) * std::sin(0.5 * theta);
  const Frame frame = Frame::FromNormal(axis);
  const Vector3 placed = ToRenderDirection(transform, axis);
  ConeIntegrals sum;
  for (int i = 0; i < n * n; ++i) {
    const double w = end * (i / n + 0.5) / n, sine = std::sqrt(w * (2 - w)), phi = 2 * kPiDouble * (i % n + 0.5) / n;
    const Vector3d local(sine * std::cos(phi), sine * std::sin(phi), 1 - w);
    const Vector3 direction = ToRenderDirection(transform, frame.ToWorld(Vector3(local)));
    const auto cosine = static_cast<double>(glm::dot(direction, placed) / LocalSolidAngleFactor(transform, direction));
    sum.facing += std::max(cosine, 0.0);
    sum.size += std::abs(cosine);
  }
  const double each = 2 * kPiDouble * end / (static_cast<double>(n) * n);
  return {sum.facing * each, sum.size * each};
}

std::unique_ptr<Light> CreateDistant(const ParameterList& parameters, const LightBuildContext& build) {
  const LightTint tint = ReadLightTint(parameters);
  const double angle = parameters.GetFloat("angle", 0), theta = angle * kPiDouble / 360;
  double scale = parameters.GetFloat("scale", 1);
  const double illuminance = parameters.GetFloat("illuminance", -1);
  const auto [facing, size] = IntegrateCone(ReadToLight(parameters), theta, build.transform);
  const double normalized = size > 0 ? facing / size : 1;
  double toIrradiance = scale;  // from L to the irradiance of a facing surface, for parallel light and for disks
  if (angle > 0 && !(illuminance > 0)) toIrradiance *= tint.normalize ? normalized : facing;
  if (illuminance > 0) toIrradiance *= illuminance;
  const Color color = ReadEmissionColor(parameters, "L") * tint.color;
  const Color irradiance = color * static_cast<float>(toIrradiance);
  if (!irradiance.IsValid()) throw Error(parameters.Where(), "LightSource \"distant\": the irradiance is not finite");
  if (angle < kSmallestAngle) return std::make_unique<ParallelLight>(parameters, irradiance);
  const Color radiance = color * static_cast<float>(toIrradiance / facing);
  if (!radiance.IsValid()) throw Error(parameters.Where(), "LightSource \"distant\": the radiance is not finite");
  return std::make_unique<InfiniteLightWith<ConeSky>>(DistantLightType, parameters,
                                                      ConeSky(ReadToLight(parameters), theta, radiance));
}

}  // namespace

LightType DistantLightType() {
  LightType type;
  type.name = "distant";
  type.help = "light from one direction, like the sun's: parallel, or from a disk of the sky";
  type.parameters = WithCommonParameters({
      {"L", ParameterType::Spectrum, "W/m²", "1", "",
       "irradiance of a surface that faces the light; with an angle: radiance of the disk in W/(m² sr)"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies L"},
      {"illuminance", ParameterType::Float, "W/m²", "-1", "",
       "if positive: irradiance of a facing surface for an L of 1, whatever the angle"},
      {"from", ParameterType::Point3, "", "0 0 0", "", "the light comes from here"},
      {"to", ParameterType::Point3, "", "0 0 1", "", "and goes there"},
      {"angle", ParameterType::Float, "°", "0", "[0,360]",
       "diameter of the disk (the sun's is 0.53); below 0.001: parallel light of the same irradiance"},
  });
  type.create = CreateDistant;
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"point3 from\" [ 1 4 1.5 ] \"point3 to\" [ 0 0 0 ] \"float illuminance\" 7 \"float diffuse\" 0.5",
      "\"float angle\" 0.53 \"rgb L\" [ 3 2 1 ] \"float intensity\" 50000",
      "\"float angle\" 40 \"bool normalize\" true \"point3 from\" [ 1 -2 0.5 ] \"point3 to\" [ 0 0 0 ] \"float "
      "specular\" 3",
      "\"float angle\" 250 \"bool normalize\" true \"rgb color\" [ 1 0 2 ]",
      "\"float angle\" 360 \"float illuminance\" 2",
  };
  return type;
}

}  // namespace lampyr
