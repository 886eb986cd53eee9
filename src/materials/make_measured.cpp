// "measured": filename, of a tensor file of the RGL material database.
#include "materials/material_makers.h"
#include "materials/measured_file.h"
#include "materials/recipe_material.h"

namespace lampyr {

namespace {

struct MeasuredRecipe {
  std::shared_ptr<const MeasuredData> data;
  std::shared_ptr<const Wavelengths> wavelengths;  // null: in Rec. 709

  BsdfModel Make(const TextureContext&) const { return MeasuredBsdf{data.get(), wavelengths.get()}; }
  void TuneTo(const std::shared_ptr<const Wavelengths>& toWavelengths) { wavelengths = toWavelengths; }
  bool IsConstant() const { return true; }
  bool IsAnisotropic() const { return data->IsAnisotropic(); }
  bool MayTransmit() const { return false; }
  bool HasDelta() const { return false; }
};

}  // namespace

std::shared_ptr<const Material> MakeMeasured(const MaterialInput& input) {
  const std::string name = input.parameters.GetString("filename", "");
  if (name.empty()) throw Error(input.parameters.Where(), "material \"measured\" needs a \"filename\"");
  const FileLocation where = input.parameters.WhereOf("filename");
  MeasuredRecipe recipe{
      std::make_shared<const MeasuredData>(ReadMeasured(input.parameters.ResolveFile(name, where), where)), nullptr};
  ShadingNormal shadingNormal(input.parameters, input.textures, input.diagnostics);
  CheckMaterialParameters(input, {"filename"});
  return std::make_shared<RecipeMaterial<MeasuredRecipe>>(std::move(recipe), std::move(shadingNormal));
}

}  // namespace lampyr
