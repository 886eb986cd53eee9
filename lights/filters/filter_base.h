// What the shipped filters share: the parameters that each of them has, its place, and the loop over a batch.
//
// A filter is a factor F of the light; what is applied is 1 + strength · (F' − 1), where F' is F, or 1 − F (not below
// 0) where `invert` is set, and the strength is density times that for diffuse or specular lobes.
#pragma once

#include <algorithm>

#include "lights/filters/filter_type.h"

namespace lampyr {

struct FilterSettings {
  float diffuse = 1, specular = 1;  // strengths, density included
  bool invert = false;
  std::vector<std::string> linkingGroups;
};

// density, invert, diffuse, specular, linkingGroups.
FilterSettings ReadFilterSettings(const ParameterList& parameters);
// Which of `choices` a parameter names, `missing` where there is no such parameter; an Error for anything else.
int ReadChoice(const ParameterList& parameters, const std::string& name, const std::vector<std::string>& choices,
               int missing = 0);
// multiply (also where there is none), max, min or screen.
CombineMode ReadCombineMode(const ParameterList& parameters, const std::string& name);

// The rows that every shipped filter's table ends with: the above, name and coordsys.
std::vector<ParameterInfo> WithCommonFilterParameters(std::vector<ParameterInfo> parameters);

// The names in "a, b" and [ "a" "b" ].
std::vector<std::string> ReadNames(const ParameterList& parameters, const std::string& name);

class FilterBase : public LightFilter {
 public:
  FilterBase(const ParameterList& parameters, const FilterBuildContext& build)
      : settings_(ReadFilterSettings(parameters)), transform_(build.transform), motion_(build.motion) {}

  const std::vector<std::string>* GetProperty(FilterProperty property) const override {
    return property == FilterProperty::LinkingGroups ? &settings_.linkingGroups : nullptr;
  }
  bool IsIdentity() const override { return settings_.diffuse == 0 && settings_.specular == 0; }
  const FilterSettings& Settings() const { return settings_; }

 protected:
  // Render space to the filter's own, at a time of the shutter.
  Affine ToLocal(float time) const { return motion_ ? motion_->At(time).Inverse() : transform_.toLocal; }

  // One factor F for an edge, as it is applied.
  Color Applied(const Color& factor, float strength) const {
    if (strength == 1 && !settings_.invert) return factor;
    Color f = factor;
    if (settings_.invert) f = Color(std::max(1 - f.r, 0.0f), std::max(1 - f.g, 0.0f), std::max(1 - f.b, 0.0f));
    return Color(1.0f) + (f - Color(1.0f)) * strength;
  }

 private:
  FilterSettings settings_;
  LightTransform transform_;
  std::shared_ptr<const Motion> motion_;
};

// 1 for x ≤ 0, 0 from x = width on, smooth between; a step where the width is 0.
inline float SoftEdge(float x, float width) {
  if (!(x > 0)) return 1;
  if (x >= width) return 0;
  const float t = x / width;
  return 1 - t * t * (3 - 2 * t);
}

// An edge in the filter's own space. `towards` is not unit length where its transform scales.
struct FilterEdge {
  Point3 receiver;
  Vector3 towards;  // the light
  float distance;   // in lengths of `towards`; infinite
};

// A filter from its factor: `Model` has `Color Factor(const FilterEdge&) const`.
template <class Model>
class FilterWith final : public FilterBase {
 public:
  FilterWith(const ParameterList& parameters, const FilterBuildContext& build, Model model)
      : FilterBase(parameters, build), model_(std::move(model)) {}

  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    const Affine toLocal = ToLocal(context.time);
    const FilterSettings& settings = Settings();
    for (int i = 0; i < samples.count; ++i) {
      const FilterEdge edge{toLocal.Point(samples.receiver[i]), toLocal.Vector(samples.toLight[i]),
                            samples.distance[i]};
      const Color factor = model_.Factor(edge);
      samples.diffuse[i] *= Applied(factor, settings.diffuse);
      samples.specular[i] *= Applied(factor, settings.specular);
    }
  }

 private:
  Model model_;
};

}  // namespace lampyr
