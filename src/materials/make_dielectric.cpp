// "dielectric": eta (1.5), roughness (0), uroughness, vroughness, remaproughness (true). "thindielectric": eta (1.5),
// transmittance (1), an extension of lampyr: the tint of transmitted light.
#include "materials/material_makers.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

struct DielectricRecipe {
  RoughnessParameters roughness;
  float eta;
  std::shared_ptr<const SpectralCurve> curve;  // of η; null: the same at all wavelengths
  std::optional<Color> etaOfLanes;             // at the wavelengths of a pass

  BsdfModel Make(const TextureContext& where) const {
    if (etaOfLanes) return DispersiveBsdf{roughness.Evaluate(where), *etaOfLanes};
    return DielectricBsdf{roughness.Evaluate(where), eta};
  }
  void Roughen() { roughness.Roughen(); }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) {
    if (curve) etaOfLanes = wavelengths->At(*curve);
  }
  bool Disperses() const { return curve != nullptr; }
  bool IsConstant() const { return roughness.IsConstant(); }
  bool IsAnisotropic() const { return roughness.IsAnisotropic(); }
  bool MayTransmit() const { return true; }
  bool HasDelta() const { return (eta == 1 && !curve) || roughness.MayBeSmooth(); }
};

class ThinDielectric final : public Material, public ThinSurface {
 public:
  ThinDielectric(float eta, ColorParameter transmittance, ShadingNormal shadingNormal)
      : eta_(eta), transmittance_(std::move(transmittance)), shadingNormal_(std::move(shadingNormal)) {}

  Bsdf GetBsdf(const SurfacePoint& point, const Vector3&) const override {
    const Frame frame = shadingNormal_.IsPlain() ? Frame::FromNormal(point.Ns) : shadingNormal_.GetFrame(point);
    return Bsdf(frame, point.Ng, ThinDielectricBsdf{eta_, Tint(point.uv, point.position, point.Ng), point.isThin});
  }
  bool MayTransmit() const override { return true; }
  bool HasDelta() const override { return true; }
  bool IsAlwaysDelta() const override { return true; }
  bool HasMappedNormal() const override { return !shadingNormal_.IsPlain(); }
  bool NeedsParametrization() const override { return !transmittance_.IsConstant() || !shadingNormal_.IsPlain(); }
  const ThinSurface* Thin() const override { return this; }
  std::shared_ptr<const Material> AtWavelengths(const std::shared_ptr<const Wavelengths>& wavelengths,
                                                const Tuner&) const override {
    auto tuned = std::make_shared<ThinDielectric>(*this);
    tuned->transmittance_.TuneTo(wavelengths);
    return tuned;
  }

  float TransmittedFraction(float cosTheta) const override { return 1 - ThinReflectance(cosTheta, eta_); }
  Normal3 NormalAt(const SurfacePoint& point) const override {
    return shadingNormal_.IsPlain() ? point.Ns : shadingNormal_.GetFrame(point).z;
  }
  Color Tint(const Point2& uv, const Point3& position, const Normal3& Ng) const override {
    return ClampToUnit(transmittance_.Evaluate({uv, position, Ng}));
  }
  bool IsClear() const override { return transmittance_.IsConstant() && Tint({}, {}, {}) == Color(1.0f); }

 private:
  float eta_;
  ColorParameter transmittance_;
  ShadingNormal shadingNormal_;
};

}  // namespace

std::shared_ptr<const Material> MakeDielectric(const MaterialInput& input) {
  DielectricRecipe recipe{RoughnessParameters(input, ""), GetEta(input, "eta", 1.5f), FindEtaCurve(input, "eta"), {}};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input,
                          {"eta", "cauchy", "sellmeier", "roughness", "uroughness", "vroughness", "remaproughness"});
  return std::make_shared<RecipeMaterial<DielectricRecipe>>(std::move(recipe), std::move(shadingNormal));
}

std::shared_ptr<const Material> MakeThinDielectric(const MaterialInput& input) {
  const float eta = GetEta(input, "eta", 1.5f);
  ColorParameter transmittance =
      input.textures.GetColor(input.parameters, "transmittance", Color(1.0f), SpectrumRole::Albedo);
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"eta", "transmittance"});
  return std::make_shared<ThinDielectric>(eta, std::move(transmittance), std::move(shadingNormal));
}

}  // namespace lampyr
