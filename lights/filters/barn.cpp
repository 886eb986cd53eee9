// "barn": barn doors. A rectangular opening in a plane across the beam, with rounded corners and a soft rim; each of
// four doors shuts a part of it. Light that does not go through the opening is stopped.
#include "lights/filters/beam_window.h"

namespace lampyr {

FilterType BarnFilterType();

namespace {

constexpr const char* kMode = "physical";

struct BarnModel {
  BeamWindow window;
  Point2 center{0.0f};
  Vector2 half{0.5f};
  float radius = 0, edge = 0;
  bool isShut = false;

  Color Factor(const FilterEdge& light) const {
    const auto at = window.Crossing(light);
    if (!at || isShut) return Color(0.0f);
    return Color(SoftEdge(RoundedRectangle(*at - center, half, radius), edge));
  }
};

BarnModel ReadBarn(const ParameterList& parameters) {
  const auto get = [&](const char* name, double value) { return static_cast<float>(parameters.GetFloat(name, value)); };
  BarnModel barn;
  barn.window = ReadBeamWindow(parameters, kMode);
  const float width = get("width", 1), height = get("height", 1);
  const float left = -width / 2 + get("left", 0), right = width / 2 - get("right", 0);
  const float bottom = -height / 2 + get("bottom", 0), top = height / 2 - get("top", 0);
  barn.center = {(left + right) / 2, (bottom + top) / 2};
  barn.half = {(right - left) / 2, (top - bottom) / 2};
  barn.isShut = !(barn.half.x > 0 && barn.half.y > 0);
  barn.radius = std::clamp(get("radius", 0), 0.0f, std::max(0.0f, std::min(barn.half.x, barn.half.y)));
  barn.edge = get("edge", 0);
  return barn;
}

}  // namespace

FilterType BarnFilterType() {
  FilterType type;
  type.name = "barn";
  type.help = "an opening with four doors, in a plane across the beam";
  type.parameters = WithBeamParameters(
      kMode, {
                 {"width", ParameterType::Float, "", "1", "> 0", "of the opening, along x"},
                 {"height", ParameterType::Float, "", "1", "> 0", "of the opening, along y"},
                 {"radius", ParameterType::Float, "", "0", ">= 0", "of its corners"},
                 {"edge", ParameterType::Float, "", "0", ">= 0", "width of its soft rim, outwards"},
                 {"left", ParameterType::Float, "", "0", "", "how far the door at -x is shut; negative: wider open"},
                 {"right", ParameterType::Float, "", "0", "", "the door at +x"},
                 {"top", ParameterType::Float, "", "0", "", "the door at +y"},
                 {"bottom", ParameterType::Float, "", "0", "", "the door at -y"},
             });
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<FilterWith<BarnModel>>(parameters, build, ReadBarn(parameters));
  };
  type.samples = {"\"float width\" 0.8 \"float height\" 0.5 \"float edge\" 0.1 \"float left\" 0.1",
                  "\"string mode\" \"analytic\" \"float radius\" 0.2"};
  return type;
}

}  // namespace lampyr
