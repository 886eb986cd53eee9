// The planted faults: wrong lights and filters, made in the process, and patches of the source, which are built apart.
#pragma once

#include <string>
#include <vector>

#include "detection/planted_filter.h"
#include "detection/planted_light.h"
#include "lights/types/type_registry.h"

namespace lampyr::test {

struct LightFault {
  std::string name;     // as the table has it
  std::string subject;  // of subjects.h, that has it
  std::string what;     // one line
  Planting planting;
  CountedLight::EditedPlanting edited;
  std::string ignored;  // a parameter that the light does not look at; "": none
};

struct FilterFault {
  std::string name, subject, what;
  FilterPlanting planting;
  std::string parameters;  // that the fault needs to show in a picture
};

// A patch of the source, tests/detection/patches/<name>.patch.
struct PatchFault {
  std::string name, what;
};

const std::vector<LightFault>& LightFaults();
const std::vector<FilterFault>& FilterFaults();
const std::vector<PatchFault>& PatchFaults();

// The type of `subject` with the fault, under the name "planted". No fault: the sound one, counted.
LightType PlantedType(const std::string& subject, const LightFault* fault);
FilterType PlantedFilterType(const std::string& subject, const FilterFault* fault);

}  // namespace lampyr::test
