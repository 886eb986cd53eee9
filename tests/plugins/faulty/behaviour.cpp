// A plugin that loads, and whose types then misbehave: factories that give no light, and lights that throw at work.
#include <limits>
#include <stdexcept>

#include "forwarding_light.h"
#include "lights/light_base.h"
#include "lights/plugin/plugin_api.h"

using namespace lampyr;

namespace {

LightType Type(const std::string& name, decltype(LightType::create) create) {
  LightType type;
  type.name = name;
  type.help = "misbehaves";
  type.parameters = WithCommonParameters({});
  type.create = std::move(create);
  type.samples = {"\"float intensity\" 2"};
  return type;
}

std::shared_ptr<const Light> MakeRect(const ParameterList& parameters, const LightBuildContext& build) {
  return MakeLight(*FindLightType("rect", false), parameters, build);
}

// A rect, but for the place where it throws.
enum class Where { Samples, Photons, Surface, Bounds };

// A rect whose paths start nowhere, in all else a rect.
class Lost final : public test::ForwardingLight {
 public:
  Lost(const ParameterList& parameters, const LightBuildContext& build)
      : ForwardingLight(MakeRect(parameters, build)) {}

  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    auto sample = ForwardingLight::GenerateEmission(context);
    if (sample) sample->position.x = std::numeric_limits<float>::quiet_NaN();
    return sample;
  }
};

// A rect whose samples have a negative density on one half of it, in all else a rect.
class Negative final : public test::ForwardingLight {
 public:
  Negative(const ParameterList& parameters, const LightBuildContext& build)
      : ForwardingLight(MakeRect(parameters, build)) {}

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    auto sample = ForwardingLight::GenerateSamples(context, P);
    if (sample && context.u.x > 0.5f) sample->pdfDirect = PdfSolidAngle(-sample->pdfDirect.value);
    return sample;
  }
};

template <Where kWhere>
class Throwing final : public test::ForwardingLight, private IntersectableLight {
 public:
  Throwing(const ParameterList& parameters, const LightBuildContext& build)
      : ForwardingLight(MakeRect(parameters, build)) {}

  std::optional<LightSample> GenerateSamples(const LightContext& context, const Point3& P) const override {
    // Not at once: in the midst of the work, on some thread.
    if (kWhere == Where::Samples && context.u.x > 0.99f) throw std::runtime_error("burnt out");
    return ForwardingLight::GenerateSamples(context, P);
  }
  std::optional<EmissionSample> GenerateEmission(const LightContext& context) const override {
    if (kWhere == Where::Photons && context.u.x > 0.99f) throw 42;
    return ForwardingLight::GenerateEmission(context);
  }
  std::optional<EmissionBounds> GetEmissionBounds(const LightContext& context) const override {
    if (kWhere == Where::Bounds) throw 42;
    return ForwardingLight::GetEmissionBounds(context);
  }
  const IntersectableLight* Surface() const override { return this; }
  std::vector<Point3> GetBounds() const override { return Sound().Surface()->GetBounds(); }
  std::optional<LocalHit> Intersect(const LocalRay& ray) const override {
    if (kWhere == Where::Surface) throw std::runtime_error("no such surface");
    return Sound().Surface()->Intersect(ray);
  }
};

template <Where kWhere>
LightType ThrowingType(const std::string& name) {
  return Type(name, [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
    return std::make_unique<Throwing<kWhere>>(parameters, build);
  });
}

template <class Exception>
LightType Thrower(const std::string& name, Exception exception) {
  return Type(
      name, [exception](const ParameterList&, const LightBuildContext&) -> std::unique_ptr<Light> { throw exception; });
}

PluginTypes Types() {
  PluginTypes types;
  types.lights = {
      Thrower("throws-exception", std::runtime_error("out of gas")),
      Thrower("throws-error", Error("the mantle is torn")),
      Thrower("throws-number", 42),
      Type("throws-located-error",
           [](const ParameterList& parameters, const LightBuildContext&) -> std::unique_ptr<Light> {
             throw Error(parameters.WhereOf("intensity"), "too bright for its socket");
           }),
      Type("makes-null",
           [](const ParameterList&, const LightBuildContext&) -> std::unique_ptr<Light> { return nullptr; }),
      ThrowingType<Where::Samples>("throws-in-samples"),
      ThrowingType<Where::Photons>("throws-in-photons"),
      ThrowingType<Where::Surface>("throws-in-surface"),
      ThrowingType<Where::Bounds>("throws-in-bounds"),
      Type("lost",
           [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
             return std::make_unique<Lost>(parameters, build);
           }),
      Type("negative",
           [](const ParameterList& parameters, const LightBuildContext& build) -> std::unique_ptr<Light> {
             return std::make_unique<Negative>(parameters, build);
           }),
  };
  FilterType filter;
  filter.name = "filter-throws";
  filter.create = [](const ParameterList&, const FilterBuildContext&) -> std::unique_ptr<LightFilter> { throw 42; };
  types.filters = {filter};
  return types;
}

}  // namespace

LAMPYR_PLUGIN(Types())
