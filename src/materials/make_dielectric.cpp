// "dielectric": eta (1.5), roughness (0), uroughness, vroughness, remaproughness (true). "thindielectric": eta (1.5).
#include "materials/material_makers.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

struct DielectricRecipe {
  RoughnessParameters roughness;
  float eta;

  BsdfModel Make(const TextureContext& where) const { return DielectricBsdf{roughness.Evaluate(where), eta}; }
  bool IsConstant() const { return roughness.IsConstant(); }
  bool IsAnisotropic() const { return roughness.IsAnisotropic(); }
  bool MayTransmit() const { return true; }
  bool HasDelta() const { return eta == 1 || roughness.MayBeSmooth(); }
};

struct ThinDielectricRecipe {
  float eta;

  BsdfModel Make(const TextureContext&) const { return ThinDielectricBsdf{eta}; }
  bool IsConstant() const { return true; }
  bool IsAnisotropic() const { return false; }
  bool MayTransmit() const { return true; }
  bool HasDelta() const { return true; }
};

}  // namespace

std::shared_ptr<const Material> MakeDielectric(const MaterialInput& input) {
  DielectricRecipe recipe{RoughnessParameters(input, ""), GetEta(input, "eta", 1.5f)};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"eta", "roughness", "uroughness", "vroughness", "remaproughness"});
  return std::make_shared<RecipeMaterial<DielectricRecipe>>(std::move(recipe), std::move(shadingNormal));
}

std::shared_ptr<const Material> MakeThinDielectric(const MaterialInput& input) {
  ThinDielectricRecipe recipe{GetEta(input, "eta", 1.5f)};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"eta"});
  return std::make_shared<RecipeMaterial<ThinDielectricRecipe>>(std::move(recipe), std::move(shadingNormal));
}

}  // namespace lampyr
