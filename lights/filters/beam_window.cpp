#include "lights/filters/beam_window.h"

namespace lampyr {

std::vector<ParameterInfo> WithBeamParameters(const char* mode, std::vector<ParameterInfo> parameters) {
  parameters.push_back({"distance", ParameterType::Float, "", "1", "> 0", "of the plane from the origin, along -z"});
  parameters.push_back({"mode", ParameterType::String, "", "\"" + std::string(mode) + "\"", "",
                        "physical: where the ray itself crosses the plane; analytic: where the line from the origin "
                        "to the lit place does"});
  return WithCommonFilterParameters(std::move(parameters));
}

BeamWindow ReadBeamWindow(const ParameterList& parameters, const char* mode) {
  BeamWindow window;
  window.distance = static_cast<float>(parameters.GetFloat("distance", 1));
  const std::vector<std::string> modes = {"physical", "analytic"};
  window.isPhysical = ReadChoice(parameters, "mode", modes, mode == modes[1] ? 1 : 0) == 0;
  return window;
}

}  // namespace lampyr
