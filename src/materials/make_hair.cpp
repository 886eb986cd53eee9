// "hair": absorption by the first of these that is given: sigma_a, reflectance, color, eumelanin and pheomelanin
// (eumelanin 1.3); eta (1.55), beta_m (0.3), beta_n (0.3), alpha (2 degrees).
#include "materials/hair.h"
#include "materials/material_makers.h"

namespace lampyr {

namespace {

// The absorption of the fibre, as the scene specifies it.
struct Pigment {
  std::optional<ColorParameter> sigmaA, reflectance;
  FloatParameter eumelanin = 1.3f, pheomelanin = 0.0f;
  std::shared_ptr<const Wavelengths> wavelengths;  // at which melanins are evaluated; null: in Rec. 709

  Color Evaluate(const TextureContext& where, float betaN) const {
    if (sigmaA) return sigmaA->Evaluate(where);
    if (reflectance) return HairAbsorption(reflectance->Evaluate(where), betaN);
    const Color absorption = HairAbsorption(eumelanin.Evaluate(where), pheomelanin.Evaluate(where));
    return wavelengths ? wavelengths->FromRgb(absorption) : absorption;
  }
  void TuneTo(const std::shared_ptr<const Wavelengths>& toWavelengths) {
    if (sigmaA) {
      sigmaA->TuneTo(toWavelengths);
    } else if (reflectance) {
      reflectance->TuneTo(toWavelengths);
    } else {
      wavelengths = toWavelengths;
    }
  }
  bool IsConstant() const {
    if (sigmaA) return sigmaA->IsConstant();
    if (reflectance) return reflectance->IsConstant();
    return eumelanin.IsConstant() && pheomelanin.IsConstant();
  }
};

struct HairParameters {
  Pigment pigment;
  FloatParameter eta, betaM, betaN, alpha;

  HairBsdf Make(const TextureContext& where) const {
    const float n = betaN.Evaluate(where);
    const float index = eta.Evaluate(where), tilt = alpha.Evaluate(where);
    return HairBsdf(pigment.Evaluate(where, n), std::min(std::max(1e-2f, index), 1e2f), betaM.Evaluate(where), n,
                    std::min(std::max(-90.0f, tilt), 90.0f));
  }
  bool IsConstant() const {
    return pigment.IsConstant() && eta.IsConstant() && betaM.IsConstant() && betaN.IsConstant() && alpha.IsConstant();
  }
};

// Offset h of a path from the centre of the fibre: v runs across the fibre, mapped to [-1,1]. On a curve the direction
// of v is as seen along the arriving ray, and the normal of the fibre's wall leans towards increasing v.
float OffsetAt(const SurfacePoint& point, const Vector3& wo) {
  const float v = std::min(std::max(-1.0f, 2 * point.uv.y - 1), 1.0f);
  if (point.strand == Strand::None) return v;
  return glm::dot(glm::cross(wo, point.dpdu), point.dpdv) < 0 ? -v : v;
}

class HairMaterial final : public Material {
 public:
  HairMaterial(HairParameters parameters, ShadingNormal shadingNormal)
      : parameters_(std::move(parameters)), shadingNormal_(std::move(shadingNormal)) {
    if (parameters_.IsConstant()) constant_ = parameters_.Make({});
  }

  Bsdf GetBsdf(const SurfacePoint& point, const Vector3& wo) const override {
    const bool isFibre = point.strand == Strand::Fibre;
    const Frame frame = shadingNormal_.IsPlain() || isFibre ? Frame::FromNormalAndTangent(point.Ns, point.dpdu)
                                                            : shadingNormal_.GetFrame(point);
    HairBsdf hair = constant_ ? *constant_ : parameters_.Make({point.uv, point.position, point.Ng});
    hair.offset = OffsetAt(point, wo);
    hair.followsRay = point.strand != Strand::None;
    hair.isFibre = isFibre;
    return Bsdf(frame, point.Ng, hair);
  }
  std::shared_ptr<const Material> AtWavelengths(const std::shared_ptr<const Wavelengths>& wavelengths,
                                                const Tuner&) const override {
    HairParameters tuned = parameters_;
    tuned.pigment.TuneTo(wavelengths);
    return std::make_shared<HairMaterial>(std::move(tuned), shadingNormal_);
  }
  bool MayTransmit() const override { return true; }
  bool HasMappedNormal() const override { return !shadingNormal_.IsPlain(); }
  bool IsFibrous() const override { return true; }
  bool MayGatherPhotons() const override { return false; }

 private:
  HairParameters parameters_;
  ShadingNormal shadingNormal_;
  std::optional<HairBsdf> constant_;
};

FloatParameter InRange(const MaterialInput& input, const std::string& name, float fallback, float least, float most,
                       const std::string& what) {
  const FloatParameter value = input.textures.GetFloat(input.parameters, name, fallback);
  if (!value.IsConstant()) return value;
  const float constant = value.Evaluate({});
  if (!(constant >= least && constant <= most)) {
    throw Error(input.parameters.WhereOf(name), "\"" + name + "\" must be " + what);
  }
  return value;
}

Pigment ReadPigment(const MaterialInput& input) {
  Pigment pigment;
  pigment.sigmaA = input.textures.FindColor(input.parameters, "sigma_a", SpectrumRole::Extinction);
  const char* used = pigment.sigmaA ? "sigma_a" : nullptr;
  const auto isTaken = [&](const char* name) {
    if (!input.parameters.Find(name)) return false;
    if (used) {
      input.diagnostics.Warn(input.parameters.WhereOf(name),
                             std::string("\"") + name + "\" is ignored: \"" + used + "\" is given, too");
      return false;
    }
    return true;
  };
  for (const char* name : {"reflectance", "color"}) {
    if (!isTaken(name)) continue;
    pigment.reflectance = input.textures.FindColor(input.parameters, name, SpectrumRole::Albedo);
    used = name;
  }
  const bool hasEumelanin = isTaken("eumelanin"), hasPheomelanin = isTaken("pheomelanin");
  constexpr float kMost = 1e6f;
  const std::string range = "a concentration between 0 and 1000000";
  if (hasEumelanin || hasPheomelanin) {
    pigment.eumelanin = InRange(input, "eumelanin", 0, 0, kMost, range);
    pigment.pheomelanin = InRange(input, "pheomelanin", 0, 0, kMost, range);
  }
  return pigment;
}

}  // namespace

std::shared_ptr<const Material> MakeHair(const MaterialInput& input) {
  const std::string roughness = "a roughness between 0 and 1";
  HairParameters parameters{
      ReadPigment(input), InRange(input, "eta", 1.55f, 1e-2f, 1e2f, "an index of refraction between 0.01 and 100"),
      InRange(input, "beta_m", 0.3f, 0, 1, roughness), InRange(input, "beta_n", 0.3f, 0, 1, roughness),
      InRange(input, "alpha", 2, -90, 90, "an angle between -90 and 90 degrees")};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(
      input, {"sigma_a", "reflectance", "color", "eumelanin", "pheomelanin", "eta", "beta_m", "beta_n", "alpha"});
  return std::make_shared<HairMaterial>(std::move(parameters), std::move(shadingNormal));
}

}  // namespace lampyr
