// Types of light and of filter with a planted fault, as a plugin would bring them.
#include "detection/faults.h"
#include "detection/subjects.h"
#include "lights/light_base.h"

namespace lampyr::test {

namespace {

ParameterList Without(const ParameterList& parameters, const std::string& name) {
  std::vector<Parameter> kept;
  for (const Parameter& parameter : parameters.All()) {
    if (parameter.name != name) kept.push_back(parameter);
  }
  return {parameters.Where(), parameters.Owner(), kept};
}

}  // namespace

const std::vector<PatchFault>& PatchFaults() {
  static const std::vector<PatchFault> faults = {
      {"beta-exponent", "along subpaths a forward density enters with the power 1, the rest with 2"},
      {"merge-term", "a connection leaves out merging"},
      {"delta-flag", "a connection at a delta counts as a technique"},
      {"landing-selection", "where a photon lands, next-event estimation counts without its selection"},
      {"emission-selection", "densities of emission lack the selection of the light, in all techniques alike"},
      {"reverse-for-forward", "the density back to the previous vertex is the forward one"},
      {"roulette-in-density", "Russian roulette enters the density of the next vertex"},
      {"roulette-not-divided", "what survives Russian roulette is not divided by the probability (specular part)"},
      {"connection-reversed", "a connection takes the camera vertex's reverse density for the forward one"},
      {"hit-of-delta", "a light that no ray can hit counts as hit"},
      {"film-pixels", "the camera's density lacks the number of pixels where a light path is seen"},
      {"lens-density", "the density of the point on the lens counts twice"},
      {"merge-reversed", "merging takes the reverse density for the forward one"},
      {"infinite-distance", "the density of a landing from infinity is divided by the squared distance"},
      {"merge-area", "the area of merging is half of what it is, in the weights of merging alone"},
      {"merge-correlation", "merging counts correlated photons as independent ones, in its own weights alone"},
      {"photon-count", "the photons of a pass count as those of two"},
      {"adjoint-forgotten", "light paths that scatter lack the adjoint correction of where light arrives"},
      {"photons-unfiltered", "photons ignore the light's filter"},
      {"path-selection-forgotten", "path tracing weighs a hit by the light's density without its selection"},
  };
  return faults;
}

LightType PlantedType(const std::string& subjectName, const LightFault* fault) {
  const LightSubject& subject = FindLightSubject(subjectName);
  LightType type = *FindLightType(subject.type, subject.isOnShape);
  type.name = "planted";
  type.samples = {subject.parameters};
  const LightFault planted = fault ? *fault : LightFault();
  CountedLight::Reading reading;
  if (!planted.ignored.empty())
    reading = [name = planted.ignored](const ParameterList& parameters) { return Without(parameters, name); };
  type.create = [create = type.create, planted, reading](const ParameterList& parameters,
                                                         const LightBuildContext& build) {
    if (reading) parameters.Find(planted.ignored);  // has been asked for
    std::shared_ptr<const Light> sound = create(reading ? reading(parameters) : parameters, build);
    return std::make_unique<CountedLight>(std::move(sound), planted.planting, planted.edited, reading);
  };
  return type;
}

FilterType PlantedFilterType(const std::string& subjectName, const FilterFault* fault) {
  const FilterSubject& subject = FindFilterSubject(subjectName);
  FilterType type = *FindFilterType(subject.type);
  type.name = "planted";
  type.samples = {subject.parameters};
  const FilterPlanting planted = fault ? fault->planting : FilterPlanting();
  type.create = [create = type.create, planted](const ParameterList& parameters,
                                                const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    const bool drops = !planted.ignored.empty() && parameters.Find(planted.ignored);
    std::shared_ptr<const LightFilter> filter =
        create(drops ? Without(parameters, planted.ignored) : parameters, build);
    if (planted.filter) filter = planted.filter(std::move(filter));
    return std::make_unique<CountedFilter>(std::move(filter));
  };
  return type;
}

}  // namespace lampyr::test
