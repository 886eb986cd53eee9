// LightFilter "iris": darkens what leaves a light away from the filter's -z axis. Within (1 - softness) · angle of it
// nothing is changed, from `angle` on it is dark, and between the two it fades by a smooth step of the angle.
//
// A filter is a factor on the edge between a light and a receiver, and a function of that edge alone: next-event
// estimation, a direction of the BSDF and a photon that made the same edge are to get the same light.
#include <cmath>

#include "lights/filters/filter_base.h"

using namespace lampyr;

namespace {

// Quantities that follow from the parameters are computed once, here, because Factor is called for every edge.
struct Iris {
  float inner, outer;  // radians

  // FilterWith brings the edge to the filter's own space, and applies density, invert, diffuse and specular.
  Color Factor(const FilterEdge& edge) const {
    // The light leaves along -towards: its angle from -z is that of `towards` from +z.
    const float length = glm::length(edge.towards);
    const float angle = std::acos(std::clamp(edge.towards.z / length, -1.0f, 1.0f));
    return Color(SoftEdge(angle - inner, outer - inner));
  }
};

}  // namespace

FilterType IrisFilterType() {
  FilterType type;
  type.name = "iris";
  type.help = "darkens what leaves a light away from the filter's -z axis";
  // The rows that every filter has (density, invert, …) come after its own.
  type.parameters = WithCommonFilterParameters({
      {"angle", ParameterType::Float, "°", "30", "(0,180]", "from -z where it is dark"},
      {"softness", ParameterType::Float, "", "0.5", "[0,1]", "the part of the angle over which it fades"},
  });
  // The parameters were checked against the table before: names, types and ranges are right.
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    const double angle = parameters.GetFloat("angle", 30) * static_cast<double>(kPi) / 180;
    const double softness = parameters.GetFloat("softness", 0.5);
    const Iris iris{static_cast<float>(angle * (1 - softness)), static_cast<float>(angle)};
    return std::make_unique<FilterWith<Iris>>(parameters, build, iris);
  };
  type.samples = {"\"float angle\" 40", "\"float angle\" 60 \"float softness\" 0 \"bool invert\" true"};
  return type;
}
