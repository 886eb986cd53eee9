// Parallel light from one direction (pbrt-v4's "distant"): L is the irradiance in W/m² of a surface that faces it.
#include "lights/direction_map.h"
#include "lights/infinite_frame.h"
#include "lights/light_base.h"

namespace lampyr {

LightType DistantLightType();

namespace {

class DistantLight final : public LightBase {
 public:
  explicit DistantLight(const ParameterList& parameters) : LightBase(DistantLightType, parameters) {
    const Vector3d toLight = parameters.GetPoint3("from", {0, 0, 0}) - parameters.GetPoint3("to", {0, 0, 1});
    if (!(glm::length(toLight) > 0)) {
      throw Error(parameters.Where(), "LightSource \"distant\": \"from\" and \"to\" are the same point");
    }
    toLight_ = Vector3(glm::normalize(toLight));
    double scale = parameters.GetFloat("scale", 1);
    const double illuminance = parameters.GetFloat("illuminance", -1);
    if (illuminance > 0) scale *= illuminance;
    irradiance_ = ReadEmissionColor(parameters, "L") * static_cast<float>(scale);
    if (!irradiance_.IsValid())
      throw Error(parameters.Where(), "LightSource \"distant\": the irradiance is not finite");
  }

  LightKind Kind() const override { return LightKind::DeltaDirection; }

  float GetIncidentRadianceEstimate(const LightContext&, const Point3&) const override { return irradiance_.Average(); }
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
    if (irradiance_.IsBlack()) return std::nullopt;
    std::optional<LightSample> sample(std::in_place);
    sample->direction = ToRenderDirection(*context.transform, toLight_);
    sample->normal = -sample->direction;
    sample->diffuse = sample->specular = irradiance_;
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
    if (irradiance_.IsBlack()) return std::nullopt;
    EmissionSample sample =
        EmitFromInfinity(context.scene, ToRenderDirection(*context.transform, toLight_), context.uDirection);
    sample.diffuse = sample.specular = irradiance_;
    sample.pdfEmitDirection = PdfSolidAngle(1);
    return sample;
  }

  Color EvaluateEmissionForCamera(const LightContext&, const LightHit&) const override { return Color(0.0f); }

 private:
  Vector3 toLight_;  // local, unit
  Color irradiance_;
};

}  // namespace

LightType DistantLightType() {
  LightType type;
  type.name = "distant";
  type.help = "parallel light from one direction, like the sun's";
  type.parameters = WithCommonParameters({
      {"L", ParameterType::Spectrum, "W/m²", "1", "", "irradiance of a surface that faces the light"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the irradiance"},
      {"illuminance", ParameterType::Float, "W/m²", "-1", "", "if positive: multiplies the irradiance as well"},
      {"from", ParameterType::Point3, "", "0 0 0", "", "the light comes from here"},
      {"to", ParameterType::Point3, "", "0 0 1", "", "and goes there"},
  });
  type.create = [](const ParameterList& parameters, const LightBuildContext&) -> std::unique_ptr<Light> {
    return std::make_unique<DistantLight>(parameters);
  };
  type.samples = {
      "\"rgb L\" [ 3 2 1 ]",
      "\"point3 from\" [ 1 4 1.5 ] \"point3 to\" [ 0 0 0 ] \"float illuminance\" 7",
  };
  return type;
}

}  // namespace lampyr
