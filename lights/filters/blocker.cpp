// "blocker": a region that the light does not reach: what lies in the sphere or box is not lit, wherever the light is.
#include <cmath>

#include "lights/filters/region.h"
#include "lights/light_base.h"

namespace lampyr {

FilterType BlockerFilterType();

namespace {

FilterRegion ReadBlocker(const ParameterList& parameters) {
  const auto get = [&](const char* name, double value) { return static_cast<float>(parameters.GetFloat(name, value)); };
  FilterRegion region;
  region.edge = get("edge", 0);
  region.color = ReadEmissionColor(parameters, "color", Color(0.0f));
  if (ReadChoice(parameters, "shape", {"sphere", "box"}) == 0) {
    region.radius = get("radius", 0.5);
  } else {
    const Vector3 half = 0.5f * Vector3(get("width", 1), get("height", 1), get("depth", 1));
    region.SetBox(-half, half, get("rounding", 0));
  }
  return region;
}

}  // namespace

FilterType BlockerFilterType() {
  FilterType type;
  type.name = "blocker";
  type.help = "a sphere or box in which nothing is lit";
  type.parameters = WithCommonFilterParameters({
      {"shape", ParameterType::String, "", "\"sphere\"", "", "sphere or box, about the origin"},
      {"radius", ParameterType::Float, "", "0.5", ">= 0", "of the sphere"},
      {"width", ParameterType::Float, "", "1", "> 0", "of the box, along x"},
      {"height", ParameterType::Float, "", "1", "> 0", "of the box, along y"},
      {"depth", ParameterType::Float, "", "1", "> 0", "of the box, along z"},
      {"rounding", ParameterType::Float, "", "0", ">= 0", "radius of the box's corners"},
      {"edge", ParameterType::Float, "", "0", ">= 0", "width of the soft rim, outwards"},
      {"color", ParameterType::Rgb, "", "0 0 0", "", "what the light is multiplied by within"},
  });
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<FilterWith<FilterRegion>>(parameters, build, ReadBlocker(parameters));
  };
  type.samples = {"\"float radius\" 0.7 \"float edge\" 0.3",
                  "\"string shape\" \"box\" \"float rounding\" 0.2 \"rgb color\" [ 1 0.2 0 ]"};
  return type;
}

}  // namespace lampyr
