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

LightType PlantedType(const std::string& subjectName, const LightFault* fault) {
  const LightSubject& subject = FindLightSubject(subjectName);
  LightType type = *FindLightType(subject.type, subject.isOnShape);
  type.name = "planted";
  type.samples = {subject.parameters};
  const LightFault planted = fault ? *fault : LightFault();
  type.create = [create = type.create, planted](const ParameterList& parameters, const LightBuildContext& build) {
    const bool drops = !planted.ignored.empty() && parameters.Find(planted.ignored);
    std::shared_ptr<const Light> sound = create(drops ? Without(parameters, planted.ignored) : parameters, build);
    return std::make_unique<CountedLight>(std::move(sound), planted.planting, planted.edited);
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
