// The table of material types.
#include <map>

#include "materials/material_makers.h"

namespace lampyr {

namespace {

struct MaterialType {
  const char* name;
  std::shared_ptr<const Material> (*make)(const MaterialInput&);  // null: a type of pbrt-v4 that is not supported
};

constexpr MaterialType kTypes[] = {
    {"diffuse", MakeDiffuse},
    {"diffusetransmission", MakeDiffuseTransmission},
    {"conductor", MakeConductor},
    {"dielectric", MakeDielectric},
    {"thindielectric", MakeThinDielectric},
    {"coateddiffuse", MakeCoatedDiffuse},
    {"coatedconductor", MakeCoatedConductor},
    {"hair", MakeHair},
    {"measured", MakeMeasured},
    {"mix", MakeMix},
    {"interface", MakeInterface},
    {"none", MakeInterface},
    {"", MakeInterface},
    {"subsurface", nullptr},
};

}  // namespace

std::vector<std::shared_ptr<const Material>> RoughenedMaterials(
    const std::vector<std::shared_ptr<const Material>>& materials) {
  std::map<const Material*, std::shared_ptr<const Material>> made;  // mixes may name a material any number of times
  const Material::Roughener roughened = [&](const std::shared_ptr<const Material>& material) {
    if (!material) return material;
    if (const auto known = made.find(material.get()); known != made.end()) return known->second;
    std::shared_ptr<const Material> rougher = material->Roughened(roughened);
    return made[material.get()] = rougher ? rougher : material;
  };
  std::vector<std::shared_ptr<const Material>> all;
  for (const auto& material : materials) all.push_back(roughened(material));
  return all;
}

std::vector<std::shared_ptr<const Material>> MaterialsAt(
    const std::shared_ptr<const Wavelengths>& wavelengths,
    const std::vector<std::shared_ptr<const Material>>& materials) {
  std::map<const Material*, std::shared_ptr<const Material>> made;
  const Material::Tuner tuned =
      [&](const std::shared_ptr<const Material>& material) -> std::shared_ptr<const Material> {
    if (!material) return nullptr;
    const auto found = made.find(material.get());
    if (found != made.end()) return found->second;
    std::shared_ptr<const Material> there = material->AtWavelengths(wavelengths, tuned);
    return made[material.get()] = there ? there : material;
  };
  std::vector<std::shared_ptr<const Material>> all;
  for (const auto& material : materials) all.push_back(tuned(material));
  return all;
}

std::vector<std::string> MaterialTypeNames() {
  std::vector<std::string> names;
  for (const MaterialType& type : kTypes) {
    if (type.make) names.emplace_back(type.name);
  }
  return names;
}

std::shared_ptr<const Material> MakeMaterial(const std::string& type, const ParameterList& parameters,
                                             const TextureLibrary& textures, const MaterialLookup& namedMaterials,
                                             Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const MaterialType& known : kTypes) {
    if (type == known.name) {
      if (known.make) return known.make({parameters, textures, namedMaterials, diagnostics});
      diagnostics.Warn(parameters.Where(),
                       "material \"" + type +
                           "\" is not modelled: a gray diffuse one replaces it, so that its colour, its gloss and the "
                           "light inside it are wrong");
      return MakeGray();
    }
    if (*known.name) names.emplace_back(known.name);
  }
  throw Error(parameters.Where(), "unknown material \"" + type + "\"" + DidYouMean(type, names));
}

}  // namespace lampyr
