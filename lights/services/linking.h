// Light linking: the lights that illuminate a surface, and the filters that act there.
//
// Surfaces with the same Attribute "lighting" and "lightfilter" form a class, whose index a receiver carries. Names are
// resolved while the scene is built; rendering reads one byte of a table.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "lights/filters/light_filter.h"
#include "lights/selection/light_selector.h"

namespace lampyr {

class ParameterList;

class LightLinking {
 public:
  LightLinking();

  // The class of surfaces with these attributes, either of which may be null: "subset" and "excludesubset" of lighting,
  // names of lights or light groups; "subset" of lightfilter, names of filter groups. 0: no restriction.
  uint32_t ClassOf(const ParameterList* lighting, const ParameterList* lightFilter);
  // FilterInstance::linking of a filter in these groups.
  uint32_t FilterKey(const std::vector<std::string>& groups);
  // Adds a filter that lights may name by its index.
  int32_t Add(FilterInstance filter);
  const std::vector<FilterInstance>& Filters() const { return filters_; }

  // To be called when all classes, filters and lights are known. Warns of unknown names.
  void Finish(std::span<const PlacedLight> lights, Diagnostics& diagnostics);

  // True if some light does not illuminate some surface.
  bool Excludes() const { return excludes_; }
  // True if some light has a filter.
  bool HasFilters() const { return hasFilters_; }
  bool IsLit(uint32_t receiverClass, uint32_t light) const {
    return !excludes_ || lit_[receiverClass * lightKeys_ + lightKey_[light]] != 0;
  }
  const uint8_t* EnabledFilters(uint32_t receiverClass) const {
    return enabled_.data() + receiverClass * filterGroups_.size();
  }
  // For each class, the set of lights that illuminate it.
  LightSets Sets() const;

  size_t ClassCount() const { return classes_.size(); }

 private:
  struct Class {
    std::vector<std::string> lights, withoutLights, filterGroups;  // sorted
    FileLocation whereLights, whereWithout, whereGroups;
  };
  static FileLocation WhereOf(const Class& c);
  using ClassNames = std::array<std::vector<std::string>, 3>;
  void FinishLights(std::span<const PlacedLight> lights, Diagnostics& diagnostics);
  void FinishFilters(Diagnostics& diagnostics);

  std::vector<Class> classes_;  // 0: no restriction
  std::map<ClassNames, uint32_t> classIndex_;
  std::vector<std::vector<std::string>> filterGroups_;  // by FilterKey; 0: none
  std::map<std::vector<std::string>, uint32_t> filterKeys_;
  std::vector<FilterInstance> filters_;
  bool excludes_ = false, hasFilters_ = false;
  size_t lightKeys_ = 0;            // kinds of lights that classes can tell apart
  std::vector<uint32_t> lightKey_;  // by light
  std::vector<uint8_t> lit_;        // by class and light key
  std::vector<uint8_t> enabled_;    // by class and filter key
};

}  // namespace lampyr
