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
    saturation_ = static_cast<float>(parameters.GetFloat("saturation", 1));
    // Without a saturation the whole effect is one factor.
    const auto part = [&](float effect) { return Part{Applied(factor, effect), Applied(factor, 1), effect}; };
    diffuse_ = part(Settings().diffuse);
    specular_ = part(Settings().specular);
  }

  void Filter(const FilterContext&, const FilterSamples& samples) const override {
    for (int i = 0; i < samples.count; ++i) {
      Apply(diffuse_, samples.diffuse[i]);
      Apply(specular_, samples.specular[i]);
    }
  }

  // At least the transmittance without the saturation: light that has the tint's colour already loses nothing to it.
  std::optional<float> GetRadianceModifier() const override {
    const auto through = [&](const Part& part) {
      Color white(1.0f);
      Apply(part, white);
      return std::max(white.Average(), part.factor.Average());
    };
    return std::max(through(diffuse_), through(specular_));
  }

 private:
  struct Part {
    Color factor{1.0f};  // as applied, without the saturation
    Color whole{1.0f};   // the same at full strength
    float strength = 1;
  };

  void Apply(const Part& part, Color& color) const {
    if (saturation_ == 1) {
      color *= part.factor;
      return;
    }
    const Color tinted = color * part.whole;
    const Color moved = Lerp(Color(tinted.Luminance()), tinted, saturation_);
    const Color whole(std::max(moved.r, 0.0f), std::max(moved.g, 0.0f), std::max(moved.b, 0.0f));
    color = part.strength == 1 ? whole : Lerp(color, whole, part.strength);
  }

  float saturation_ = 1;
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
  type.samples = {"\"rgb tint\" [ 0.2 0.5 1 ] \"float intensity\" 1.5", "\"float saturation\" 0 \"float exposure\" -1",
                  "\"rgb tint\" [ 1 0.3 0.2 ] \"float saturation\" 1.4"};
  return type;
}

}  // namespace lampyr
