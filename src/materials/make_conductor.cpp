// "conductor": eta and k (copper), or reflectance; roughness (0), uroughness, vroughness, remaproughness (true).
#include "materials/material_makers.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

struct ConductorRecipe {
  RoughnessParameters roughness;
  MetalParameters metal;

  BsdfModel Make(const TextureContext& where) const {
    const auto index = metal.Evaluate(where);
    return ConductorBsdf{roughness.Evaluate(where), index.eta, index.k};
  }
  void Roughen() { roughness.Roughen(); }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) { metal.TuneTo(wavelengths); }
  bool IsConstant() const { return roughness.IsConstant() && metal.IsConstant(); }
  bool IsAnisotropic() const { return roughness.IsAnisotropic(); }
  bool MayTransmit() const { return false; }
  bool HasDelta() const { return roughness.MayBeSmooth(); }
};

}  // namespace

std::shared_ptr<const Material> MakeConductor(const MaterialInput& input) {
  ConductorRecipe recipe{RoughnessParameters(input, ""), MetalParameters(input, "")};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input,
                          {"eta", "k", "reflectance", "roughness", "uroughness", "vroughness", "remaproughness"});
  return std::make_shared<RecipeMaterial<ConductorRecipe>>(std::move(recipe), std::move(shadingNormal));
}

}  // namespace lampyr
