// Base of the built-in filters: common parameters, placement, and the loop over a batch.
//
// With the factor F of a filter, the light is scaled by 1 + strength · (F' − 1). F' is F, or max(0, 1 − F) with
// `invert`; the strength is the density times the value for diffuse or specular lobes.
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
// Index in `choices` of a parameter's value; `missing` if it is not given. Throws an Error for other values.
int ReadChoice(const ParameterList& parameters, const std::string& name, const std::vector<std::string>& choices,
               int missing = 0);
// multiply (the default), max, min or screen.
CombineMode ReadCombineMode(const ParameterList& parameters, const std::string& name);

// Common last rows of every built-in filter's parameter table: the above, name and coordsys.
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
  // From render space to the filter's local space, at a time of the shutter.
  Affine ToLocal(float time) const { return motion_ ? motion_->At(time).Inverse() : transform_.toLocal; }

  // The scale 1 + strength · (F' − 1) for the factor F of an edge.
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

// An edge in the filter's local space. `towards` has the length that the transform gives it.
struct FilterEdge {
  Point3 receiver;
  Vector3 towards;  // the light
  float distance;   // in lengths of `towards`; infinite
};

// A filter whose factor is that of `Model`, which has `Color Factor(const FilterEdge&) const`.
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
