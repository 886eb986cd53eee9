// "combiner": runs other filters. Those of each mode are combined first (max, min, screen, multiply, in that order),
// and the results are multiplied. A filter that is not enabled on what is lit is left out.
#include <array>
#include <limits>

#include "lights/filters/filter_base.h"

namespace lampyr {

FilterType CombinerFilterType();

namespace {

Color Combine(CombineMode mode, const Color& a, const Color& b) {
  const auto channel = [mode](float x, float y) {
    if (mode == CombineMode::Max) return std::max(x, y);
    if (mode == CombineMode::Min) return std::min(x, y);
    return std::max(1 - (1 - x) * (1 - y), 0.0f);
  };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
}

class CombinerFilter final : public LightFilter {
 public:
  CombinerFilter(const ParameterList& parameters, const FilterBuildContext& build)
      : linkingGroups_(ReadNames(parameters, "linkingGroups")) {
    const FileLocation where = parameters.WhereOf("filters");
    const std::vector<std::string> names = ReadNames(parameters, "filters");
    if (names.empty()) throw Error(where, parameters.Owner() + " needs the names of its \"filters\"");
    if (!build.find) throw Error(where, parameters.Owner() + ": no filters can be named here");
    const bool isForAll = parameters.Find("mode") != nullptr;
    const CombineMode mode = ReadCombineMode(parameters, "mode");
    for (const std::string& name : names) {
      FilterInstance child = build.find(name, where);
      if (!child.filter) continue;  // without effect
      if (isForAll) child.combineMode = mode;
      children_[static_cast<size_t>(child.combineMode)].push_back(std::move(child));
    }
    radianceModifier_ = FindRadianceModifier();
  }

  void Filter(const FilterContext& context, const FilterSamples& samples) const override {
    for (const CombineMode mode : {CombineMode::Max, CombineMode::Min, CombineMode::Screen}) {
      if (!Children(mode).empty()) CombineAll(mode, context, samples);
    }
    for (const FilterInstance& child : Children(CombineMode::Multiply)) {
      if (context.IsEnabled(child)) child.filter->Filter(context, samples);
    }
  }

  const std::vector<std::string>* GetProperty(FilterProperty property) const override {
    return property == FilterProperty::LinkingGroups ? &linkingGroups_ : nullptr;
  }

  std::optional<float> GetRadianceModifier() const override { return radianceModifier_; }

  bool IsIdentity() const override {
    return std::all_of(children_.begin(), children_.end(), [](const auto& children) { return children.empty(); });
  }

 private:
  // The product of the children's modifiers, if all children are multiplied and each has a modifier; nullopt otherwise.
  // Finite, and 0 only if one of the modifiers is 0: a product beyond the range of float is clamped to it.
  std::optional<float> FindRadianceModifier() const {
    using Limits = std::numeric_limits<float>;
    float product = 1;
    bool isDark = false;
    for (const auto& children : children_) {
      if (&children != &Children(CombineMode::Multiply) && !children.empty()) return std::nullopt;
    }
    for (const FilterInstance& child : Children(CombineMode::Multiply)) {
      const std::optional<float> modifier = child.filter->GetRadianceModifier();
      if (!modifier || child.linking != 0) return std::nullopt;
      product = std::clamp(product * *modifier, Limits::min(), Limits::max());
      isDark = isDark || *modifier == 0;
    }
    return isDark ? 0.0f : product;
  }

  const std::vector<FilterInstance>& Children(CombineMode mode) const { return children_[static_cast<size_t>(mode)]; }

  // Integrators filter batches of one: initialising arrays for more would cost more than the filters.
  void CombineAll(CombineMode mode, const FilterContext& context, const FilterSamples& samples) const {
    if (samples.count == 1) return CombineIn<1>(mode, context, samples);
    CombineIn<64>(mode, context, samples);
  }

  template <int room>
  void CombineIn(CombineMode mode, const FilterContext& context, const FilterSamples& samples) const {
    std::array<Color, room> diffuse, specular, childDiffuse, childSpecular;
    for (int begin = 0; begin < samples.count; begin += room) {
      FilterSamples part = samples.Part(begin, std::min(room, samples.count - begin));
      const auto count = static_cast<size_t>(part.count);
      part.diffuse = childDiffuse.data();
      part.specular = childSpecular.data();
      bool isFirst = true;
      for (const FilterInstance& child : Children(mode)) {
        if (!context.IsEnabled(child)) continue;
        std::fill_n(childDiffuse.begin(), count, Color(1.0f));
        std::fill_n(childSpecular.begin(), count, Color(1.0f));
        child.filter->Filter(context, part);
        for (size_t i = 0; i < count; ++i) {
          diffuse[i] = isFirst ? childDiffuse[i] : Combine(mode, diffuse[i], childDiffuse[i]);
          specular[i] = isFirst ? childSpecular[i] : Combine(mode, specular[i], childSpecular[i]);
        }
        isFirst = false;
      }
      if (isFirst) return;  // none is enabled
      for (size_t i = 0; i < count; ++i) {
        samples.diffuse[static_cast<size_t>(begin) + i] *= diffuse[i];
        samples.specular[static_cast<size_t>(begin) + i] *= specular[i];
      }
    }
  }

  std::vector<std::string> linkingGroups_;
  std::array<std::vector<FilterInstance>, 4> children_;  // by mode
  std::optional<float> radianceModifier_;
};

}  // namespace

FilterType CombinerFilterType() {
  FilterType type;
  type.name = "combiner";
  type.help = "runs several filters: by mode max, min, screen and multiply, and the product of those";
  type.parameters = {
      {"filters", ParameterType::String, "", "\"\"", "", "names of filters, as a list or separated by commas"},
      {"mode", ParameterType::String, "", "\"\"", "",
       "multiply, max, min or screen for all of them, instead of each one's combineMode"},
      {"combineMode", ParameterType::String, "", "\"multiply\"", "", "how another combiner takes this one"},
      {"linkingGroups", ParameterType::String, "", "\"\"", "",
       "groups, separated by commas: only what subscribes to one of them by Attribute \"lightfilter\" is filtered"},
      {"name", ParameterType::String, "", "\"\"", "", "what other combiners call this one"},
  };
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<CombinerFilter>(parameters, build);
  };
  // The suite defines filters of these names (suite/filter_maker.h).
  type.samples = {"\"string filters\" [ \"suite-slot\" \"suite-fade, suite-ball\" \"suite-tint\" ]",
                  "\"string filters\" \"suite-fade, suite-ball\" \"string mode\" \"screen\""};
  return type;
}

}  // namespace lampyr
