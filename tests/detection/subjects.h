// The sound lights and filters that faults are planted in, and the scenes in which the baselines look at them.
#pragma once

#include <string>
#include <vector>

namespace lampyr::test {

struct LightSubject {
  std::string name;
  std::string type;
  bool isOnShape = false;  // an area light on a square of two triangles
  bool isInfinite = false;
  std::string parameters;
};
const std::vector<LightSubject>& LightSubjects();
const LightSubject& FindLightSubject(const std::string& name);

struct FilterSubject {
  std::string name;
  std::string type;
  std::string parameters;
};
const std::vector<FilterSubject>& FilterSubjects();
const FilterSubject& FindFilterSubject(const std::string& name);

// A closed white box with the light in its middle, or a white ball under a light at infinity. The light's type is
// `type`; `before` is written in front of it, within its scope.
std::string FurnaceScene(const LightSubject& subject, const std::string& type, const std::string& before = "");
// A ground with balls that the light shines on.
std::string TileScene(const LightSubject& subject, const std::string& type, const std::string& before = "");

}  // namespace lampyr::test
