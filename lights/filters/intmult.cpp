// "intmult": multiplies the light by a tint and a strength, and changes its saturation. The same wherever the receiver
// is. `saturation` moves each colour away from its own luminance (below 1: towards it; 0: grey).
#include <cmath>

#include "lights/filters/filter_base.h"
#include "lights/light_base.h"

namespace lampyr {

FilterType IntMultFilterType();

namespace {

class IntMultFilter final : public FilterBase {
 public:
  IntMultFilter(const ParameterList& parameters, const FilterBuildContext& build) : FilterBase(parameters, build) {
    const double strength = parameters.GetFloat("intensity", 1) * std::exp2(parameters.GetFloat("exposure", 0));
    const Color factor = ReadEmissionColor(parameters, "tint") * static_cast<float>(strength);
    if (!factor.IsValid()) {
      throw Error(parameters.WhereOf("intensity"),
                  parameters.Owner() + ": intensity and exposure leave the range of numbers");
    }
    const float saturation = static_cast<float>(parameters.GetFloat("saturation", 1));
    const auto part = [&](float ofEffect) { return Part{Applied(factor, ofEffect), 1 + ofEffect * (saturation - 1)}; };
    diffuse_ = part(Settings().diffuse);
    specular_ = part(Settings().specular);
  }

  void Filter(const FilterContext&, const FilterSamples& samples) const override {
    for (int i = 0; i < samples.count; ++i) {
      diffuse_.Apply(samples.diffuse[i]);
      specular_.Apply(samples.specular[i]);
    }
  }

  std::optional<float> GetRadianceModifier() const override {
    return std::max(diffuse_.factor.Average(), specular_.factor.Average());
  }

 private:
  struct Part {
    Color factor{1.0f};
    float saturation = 1;

    void Apply(Color& color) const {
      color *= factor;
      if (saturation == 1) return;
      const Color moved = Lerp(Color(color.Luminance()), color, saturation);
      color = Color(std::max(moved.r, 0.0f), std::max(moved.g, 0.0f), std::max(moved.b, 0.0f));
    }
  };
  Part diffuse_, specular_;
};

}  // namespace

FilterType IntMultFilterType() {
  FilterType type;
  type.name = "intmult";
  type.help = "multiplies the light by a colour, wherever it shines";
  type.parameters = WithCommonFilterParameters({
      {"intensity", ParameterType::Float, "", "1", ">= 0", "multiplies the light"},
      {"exposure", ParameterType::Float, "stops", "0", "", "multiplies the light by 2^exposure"},
      {"tint", ParameterType::Rgb, "", "1 1 1", "", "multiplies the light"},
      {"saturation", ParameterType::Float, "", "1", ">= 0", "of the result: 0 is grey, 1 leaves it"},
  });
  type.create = [](const ParameterList& parameters, const FilterBuildContext& build) -> std::unique_ptr<LightFilter> {
    return std::make_unique<IntMultFilter>(parameters, build);
  };
  type.samples = {"\"rgb tint\" [ 0.2 0.5 1 ] \"float intensity\" 1.5", "\"float saturation\" 0 \"float exposure\" -1"};
  return type;
}

}  // namespace lampyr
