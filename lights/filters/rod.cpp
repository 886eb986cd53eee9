// "rod": a rounded box in which the light is multiplied by a colour; each side can be moved by itself.
#include <cmath>

#include "lights/filters/region.h"
#include "lights/light_base.h"

namespace lampyr {

FilterType RodFilterType();

namespace {

FilterRegion ReadRod(const ParameterList& parameters) {
  const auto get = [&](const char* name, double value) { return static_cast<float>(parameters.GetFloat(name, value)); };
  FilterRegion region;
  region.edge = get("edge", 0);
  region.falloff = get("falloff", 1);
  region.color = ReadEmissionColor(parameters, "color", Color(0.0f));
  const Vector3 half = 0.5f * Vector3(get("width", 1), get("height", 1), get("depth", 1));
  const Point3 low = -half - Vector3(get("left", 0), get("bottom", 0), get("front", 0));
  const Point3 high = half + Vector3(get("right", 0), get("top", 0), get("back", 0));
  if (!(high.x > low.x && high.y > low.y && high.z > low.z))
    throw Error(parameters.Where(), parameters.Owner() + ": its sides leave nothing of the box");
  region.SetBox(low, high, get("radius", 0));
  return region;
}

}  // namespace

FilterType RodFilterType() {
  FilterType type;
  type.name = "rod";
  type.help = "a rounded box in which the light is multiplied by a colour";
  type.parameters = WithCommonFilterParameters({
      {"width", ParameterType::Float, "", "1", "> 0", "along x"},
      {"height", ParameterType::Float, "", "1", "> 0", "along y"},
      {"depth", ParameterType::Float, "", "1", "> 0", "along z"},
      {"radius", ParameterType::Float, "", "0", ">= 0", "of the corners"},
      {"edge", ParameterType::Float, "", "0", ">= 0", "width of the soft rim, outwards"},
      {"falloff", ParameterType::Float, "", "1", "> 0", "exponent of the rim: above 1 it falls sooner"},
      {"left", ParameterType::Float, "", "0", "", "how much farther the side at -x lies; negative: nearer"},
      {"right", ParameterType::Float, "", "0", "", "the side at +x"},
      {"bottom", ParameterType::Float, "", "0", "", "the side at -y"},
      {"top", ParameterType::Float, "", "0", "", "the side at +y"},
      {"front", ParameterType::Float, "", "0", "", "the side at -z"},
      {"back", ParameterType::Float, "", "0", "", "the side at +z"},
      {"color", ParameterType::Rgb, "", "0 0 0", "", "what the light is multiplied by within"},
  });
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<FilterWith<FilterRegion>>(parameters, build, ReadRod(parameters));
  };
  type.samples = {"\"float width\" 0.5 \"float right\" 0.3 \"float edge\" 0.4 \"float falloff\" 2",
                  "\"float radius\" 0.5 \"rgb color\" [ 2 1 0.5 ]"};
  return type;
}

}  // namespace lampyr
