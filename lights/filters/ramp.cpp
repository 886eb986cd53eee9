// "ramp": a colour that changes with the distance of what is lit from the filter's origin, or with its angle from the
// filter's −z axis.
#include <cmath>

#include "lights/filters/filter_base.h"
#include "lights/light_base.h"

namespace lampyr {

FilterType RampFilterType();

namespace {

enum class Interpolation { Linear, Smooth, Constant };

struct RampModel {
  bool isAngle = false;
  float begin = 0, perLength = 1;
  Interpolation interpolation = Interpolation::Linear;
  std::vector<float> knots;  // in [0,1], rising
  std::vector<Color> colors;

  Color Factor(const FilterEdge& light) const {
    const Point3& P = light.receiver;
    const float across = std::sqrt(P.x * P.x + P.y * P.y);
    const float at = isAngle ? std::atan2(across, -P.z) * (180 / kPi) : glm::length(P);
    return At((at - begin) * perLength);
  }

  Color At(float x) const {
    const auto next = std::upper_bound(knots.begin(), knots.end(), x);
    if (next == knots.begin()) return colors.front();
    const auto i = static_cast<size_t>(next - knots.begin()) - 1;
    if (next == knots.end() || interpolation == Interpolation::Constant) return colors[i];
    float t = (x - knots[i]) / (knots[i + 1] - knots[i]);
    if (interpolation == Interpolation::Smooth) t = t * t * (3 - 2 * t);
    return Lerp(colors[i], colors[i + 1], t);
  }
};

RampModel ReadRamp(const ParameterList& parameters) {
  RampModel ramp;
  ramp.isAngle = ReadChoice(parameters, "mode", {"distance", "angle"}) == 1;
  ramp.interpolation =
      static_cast<Interpolation>(ReadChoice(parameters, "interpolation", {"linear", "smooth", "constant"}));
  const double begin = parameters.GetFloat("begin", 0), end = parameters.GetFloat("end", ramp.isAngle ? 90 : 1);
  if (!(end > begin)) throw Error(parameters.WhereOf("end"), parameters.Owner() + ": \"end\" must be after \"begin\"");
  ramp.begin = static_cast<float>(begin);
  ramp.perLength = static_cast<float>(1 / (end - begin));
  for (const double knot : parameters.GetFloats("knots")) ramp.knots.push_back(static_cast<float>(knot));
  ramp.colors = parameters.GetColors("colors", SpectrumRole::Illuminant);
  if (ramp.knots.empty()) ramp.knots = {0, 1};
  if (ramp.colors.empty()) ramp.colors = {Color(0.0f), Color(1.0f)};
  if (ramp.knots.size() != ramp.colors.size()) {
    throw Error(parameters.Where(), parameters.Owner() + ": " + std::to_string(ramp.knots.size()) + " \"knots\" and " +
                                        std::to_string(ramp.colors.size()) + " \"colors\" must be as many");
  }
  for (size_t i = 1; i < ramp.knots.size(); ++i) {
    if (!(ramp.knots[i] > ramp.knots[i - 1]))
      throw Error(parameters.WhereOf("knots"), parameters.Owner() + ": \"knots\" must rise");
  }
  for (const Color& color : ramp.colors) {
    if (!color.IsValid())
      throw Error(parameters.WhereOf("colors"), parameters.Owner() + ": \"colors\" must not be negative or infinite");
  }
  return ramp;
}

}  // namespace

FilterType RampFilterType() {
  FilterType type;
  type.name = "ramp";
  type.help = "a colour by distance from the origin, or by angle from the -z axis";
  type.parameters = WithCommonFilterParameters({
      {"mode", ParameterType::String, "", "\"distance\"", "", "distance or angle (in degrees)"},
      {"begin", ParameterType::Float, "", "0", "", "where the ramp begins"},
      {"end", ParameterType::Float, "", "1 or 90", "", "where it ends: distance or angle"},
      {"knots", ParameterType::Float, "", "0 1", "[0,1]", "places on the ramp, rising"},
      {"colors", ParameterType::Rgb, "", "0 0 0 1 1 1", "", "what the light is multiplied by at the knots"},
      {"interpolation", ParameterType::String, "", "\"linear\"", "", "linear, smooth or constant"},
  });
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<FilterWith<RampModel>>(parameters, build, ReadRamp(parameters));
  };
  type.samples = {"\"float begin\" 0.5 \"float end\" 3",
                  "\"string mode\" \"angle\" \"float end\" 40 \"float knots\" [ 0 0.4 1 ] "
                  "\"rgb colors\" [ 1 1 1  1 0.5 0.2  0 0 0 ]"};
  return type;
}

}  // namespace lampyr
