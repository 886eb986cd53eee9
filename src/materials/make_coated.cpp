// "coateddiffuse": reflectance (0.5), roughness (0), uroughness, vroughness, remaproughness, eta (1.5), thickness
// (0.01), maxdepth (10). "coatedconductor": the same parameters for the coat with the prefix "interface.", those of the
// metal with "conductor.". The medium between the layers ("albedo", "g") does not scatter here: a warning. "nsamples"
// has no meaning, since nothing is sampled inside. "maxdepth" counts crossings of the gap: half of it, rounded up, is
// the number of bounces at the base.
#include "materials/material_makers.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

float GetThickness(const MaterialInput& input) {
  const FloatParameter thickness = input.textures.GetFloat(input.parameters, "thickness", 0.01f);
  if (!thickness.IsConstant()) {
    input.diagnostics.Warn(input.parameters.WhereOf("thickness"),
                           "a textured \"thickness\" is not supported: its value at uv (0.5, 0.5) is used everywhere");
  }
  const float value = thickness.Evaluate({{0.5f, 0.5f}, Point3(0.0f)});
  if (!(value >= 0)) throw Error(input.parameters.WhereOf("thickness"), "\"thickness\" must not be negative");
  return value;
}

int GetBounces(const MaterialInput& input) {
  const int depth = input.parameters.GetInteger("maxdepth", 10);
  if (depth < 1) throw Error(input.parameters.WhereOf("maxdepth"), "\"maxdepth\" must be at least 1");
  return depth / 2 + depth % 2;
}

void CheckMedium(const MaterialInput& input) {
  const auto albedo = input.textures.FindColor(input.parameters, "albedo", SpectrumRole::Albedo);
  input.textures.FindFloat(input.parameters, "g");
  input.parameters.GetInteger("nsamples", 1);
  if (albedo && !(albedo->IsConstant() && albedo->Evaluate({}).IsBlack())) {
    input.diagnostics.Warn(input.parameters.WhereOf("albedo"),
                           "scattering between the layers is not supported: the medium only absorbs");
  }
}

struct CoatedDiffuseRecipe {
  RoughnessParameters roughness;
  ColorParameter reflectance;
  float eta, thickness;
  int bounces;
  std::shared_ptr<const CoatTable> table = MakeTable();

  std::shared_ptr<const CoatTable> MakeTable() const {
    return std::make_shared<CoatTable>(CoatDescription{eta, thickness, roughness.TableAlphas()});
  }
  void Roughen() {
    roughness.Roughen();
    table = MakeTable();
  }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) { reflectance.TuneTo(wavelengths); }

  BsdfModel Make(const TextureContext& where) const {
    return CoatedDiffuseBsdf(roughness.Evaluate(where), eta, ClampToUnit(reflectance.Evaluate(where)), bounces, *table);
  }
  bool IsConstant() const { return roughness.IsConstant() && reflectance.IsConstant(); }
  bool IsAnisotropic() const { return roughness.IsAnisotropic(); }
  bool MayTransmit() const { return false; }
  bool HasDelta() const { return roughness.MayBeSmooth(); }
};

struct CoatedConductorRecipe {
  // The tables, and the settings that point to them.
  struct Tables {
    CoatTable coat;
    CoatedMetalTable metal;
    CoatedConductorSettings settings;
  };

  RoughnessParameters coat, base;
  MetalParameters metal;
  float eta, thickness;
  int bounces;
  std::shared_ptr<const Tables> tables = MakeTables();

  std::shared_ptr<const Tables> MakeTables() const {
    const CoatDescription description{eta, thickness, coat.TableAlphas()};
    const auto made = std::make_shared<Tables>(
        Tables{CoatTable(description), CoatedMetalTable(description, base.TableAlphas()), {eta, thickness, bounces}});
    made->settings.coat = &made->coat;
    made->settings.metal = &made->metal;
    return made;
  }
  void Roughen() {
    coat.Roughen();
    base.Roughen();
    tables = MakeTables();
  }
  void TuneTo(const std::shared_ptr<const Wavelengths>& wavelengths) { metal.TuneTo(wavelengths); }

  BsdfModel Make(const TextureContext& where) const {
    const auto index = metal.Evaluate(where);
    return CoatedConductorBsdf(coat.Evaluate(where), base.Evaluate(where), index.eta / eta, index.k / eta,
                               tables->settings);
  }
  bool IsConstant() const { return coat.IsConstant() && base.IsConstant() && metal.IsConstant(); }
  bool IsAnisotropic() const { return coat.IsAnisotropic() || base.IsAnisotropic(); }
  bool MayTransmit() const { return false; }
  bool HasDelta() const { return coat.MayBeSmooth() || base.MayBeSmooth(); }
};

}  // namespace

std::shared_ptr<const Material> MakeCoatedDiffuse(const MaterialInput& input) {
  const RoughnessParameters roughness(input, "");
  CoatedDiffuseRecipe recipe{
      roughness, input.textures.GetColor(input.parameters, "reflectance", Color(0.5f), SpectrumRole::Albedo),
      GetEta(input, "eta", 1.5f), GetThickness(input), GetBounces(input)};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMedium(input);
  CheckMaterialParameters(input, {"reflectance", "roughness", "uroughness", "vroughness", "remaproughness", "eta",
                                  "thickness", "maxdepth", "nsamples", "albedo", "g"});
  return std::make_shared<RecipeMaterial<CoatedDiffuseRecipe>>(std::move(recipe), std::move(shadingNormal));
}

std::shared_ptr<const Material> MakeCoatedConductor(const MaterialInput& input) {
  const RoughnessParameters coat(input, "interface."), base(input, "conductor.");
  CoatedConductorRecipe recipe{coat,
                               base,
                               MetalParameters(input, "conductor."),
                               GetEta(input, "interface.eta", 1.5f),
                               GetThickness(input),
                               GetBounces(input)};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMedium(input);
  CheckMaterialParameters(
      input, {"interface.roughness", "interface.uroughness", "interface.vroughness", "interface.eta", "thickness",
              "conductor.eta", "conductor.k", "conductor.roughness", "conductor.uroughness", "conductor.vroughness",
              "reflectance", "remaproughness", "maxdepth", "nsamples", "albedo", "g"});
  return std::make_shared<RecipeMaterial<CoatedConductorRecipe>>(std::move(recipe), std::move(shadingNormal));
}

}  // namespace lampyr
