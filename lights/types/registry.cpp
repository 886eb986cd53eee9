// All built-in lights. A light is its own file, which defines `LightType …LightType()`, and one row here.
#include <cstdio>

#include "lights/light_type.h"

namespace lampyr {

const std::vector<LightType>& LightRegistry() {
  static const std::vector<LightType> registry = [] {
    std::vector<LightType> types;
    // clang-format off
    extern LightType DiffuseAreaLightType();  types.push_back(DiffuseAreaLightType());
    extern LightType MeshAreaLightType();     types.push_back(MeshAreaLightType());
    extern LightType RectLightType();         types.push_back(RectLightType());
    extern LightType DiskLightType();         types.push_back(DiskLightType());
    extern LightType SphereLightType();       types.push_back(SphereLightType());
    extern LightType CylinderLightType();     types.push_back(CylinderLightType());
    extern LightType PointLightType();        types.push_back(PointLightType());
    extern LightType SpotLightType();         types.push_back(SpotLightType());
    extern LightType GoniometricLightType();  types.push_back(GoniometricLightType());
    extern LightType ProjectionLightType();   types.push_back(ProjectionLightType());
    extern LightType DistantLightType();      types.push_back(DistantLightType());
    extern LightType InfiniteLightType();     types.push_back(InfiniteLightType());
    extern LightType DomeLightType();         types.push_back(DomeLightType());
    extern LightType PortalLightType();       types.push_back(PortalLightType());
    // clang-format on
    return types;
  }();
  return registry;
}

const LightType* FindLightType(const std::string& name, bool isAreaLight) {
  for (const LightType& type : LightRegistry()) {
    if (type.name == name && type.isAreaLight == isAreaLight) return &type;
  }
  return nullptr;
}

void CheckParameters(const LightType& type, const ParameterList& parameters) {
  CheckParameters(type, type.Statement(), parameters);
}

namespace {

// "power" and similar parameters have an effect only above 0, and are -1 if absent (pbrt-v4's rule). Any other number
// without effect is likely a mistake, hence the warning.
void WarnOfIgnoredNumbers(const LightType& type, const ParameterList& parameters, Diagnostics& diagnostics) {
  for (const ParameterInfo& row : type.parameters) {
    if (row.type != ParameterType::Float || row.defaultValue != "-1") continue;
    const double value = parameters.GetFloat(row.name, -1);
    if (value > 0 || value == -1) continue;
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    diagnostics.Warn(parameters.WhereOf(row.name), std::string(type.Statement()) + " \"" + type.name + "\": \"" +
                                                       row.name + "\" is " + text +
                                                       ", which is ignored: it counts above 0");
  }
}

}  // namespace

std::unique_ptr<Light> MakeLight(const LightType& type, const ParameterList& parameters,
                                 const LightBuildContext& build) {
  CheckParameters(type, parameters);
  if (build.diagnostics) WarnOfIgnoredNumbers(type, parameters, *build.diagnostics);
  return type.create(parameters, build);
}

}  // namespace lampyr
