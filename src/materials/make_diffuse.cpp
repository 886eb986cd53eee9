// "diffuse": reflectance (0.5). "diffusetransmission": reflectance (0.25), transmittance (0.25), scale (1).
#include "materials/material_makers.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

struct DiffuseRecipe {
  ColorParameter reflectance;

  BsdfModel Make(const TextureContext& where) const { return DiffuseBsdf{ClampToUnit(reflectance.Evaluate(where))}; }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) { reflectance.TuneTo(wavelengths); }
  bool IsConstant() const { return reflectance.IsConstant(); }
  bool IsAnisotropic() const { return false; }
  bool MayTransmit() const { return false; }
  bool HasDelta() const { return false; }
};

struct DiffuseTransmissionRecipe {
  ColorParameter reflectance, transmittance;
  float scale;

  BsdfModel Make(const TextureContext& where) const {
    return DiffuseTransmissionBsdf{ClampToUnit(scale * reflectance.Evaluate(where)),
                                   ClampToUnit(scale * transmittance.Evaluate(where))};
  }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) {
    reflectance.TuneTo(wavelengths);
    transmittance.TuneTo(wavelengths);
  }
  bool IsConstant() const { return reflectance.IsConstant() && transmittance.IsConstant(); }
  bool IsAnisotropic() const { return false; }
  bool MayTransmit() const { return true; }
  bool HasDelta() const { return false; }
};

}  // namespace

std::shared_ptr<const Material> MakeDiffuse(const MaterialInput& input) {
  DiffuseRecipe recipe{input.textures.GetColor(input.parameters, "reflectance", Color(0.5f), SpectrumRole::Albedo)};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"reflectance"});
  return std::make_shared<RecipeMaterial<DiffuseRecipe>>(std::move(recipe), std::move(shadingNormal));
}

std::shared_ptr<const Material> MakeDiffuseTransmission(const MaterialInput& input) {
  DiffuseTransmissionRecipe recipe{
      input.textures.GetColor(input.parameters, "reflectance", Color(0.25f), SpectrumRole::Albedo),
      input.textures.GetColor(input.parameters, "transmittance", Color(0.25f), SpectrumRole::Albedo),
      static_cast<float>(input.parameters.GetFloat("scale", 1))};
  if (recipe.scale < 0) throw Error(input.parameters.WhereOf("scale"), "\"scale\" must be 0 or more");
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"reflectance", "transmittance", "scale"});
  const auto most = [&](const ColorParameter& c) {
    return c.IsConstant() ? ClampToUnit(recipe.scale * c.Evaluate({})) : Color(0.0f);
  };
  if (const float sum = (most(recipe.reflectance) + most(recipe.transmittance)).Max(); sum > 1.0001f) {
    const bool isGiven = input.parameters.Find("transmittance") != nullptr;
    input.diagnostics.Warn(
        input.parameters.WhereOf(isGiven ? "transmittance" : "reflectance"),
        "the surface scatters more light than it receives: reflectance and transmittance add up to " +
            std::to_string(sum).substr(0, 4));
  }
  return std::make_shared<RecipeMaterial<DiffuseTransmissionRecipe>>(std::move(recipe), std::move(shadingNormal));
}

std::shared_ptr<const Material> MakeGray() {
  return std::make_shared<RecipeMaterial<DiffuseRecipe>>(DiffuseRecipe{Color(0.5f)}, ShadingNormal());
}

}  // namespace lampyr
