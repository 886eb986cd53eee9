// Each registered type of filter is the same to all integrators, by its first sample block: a type that is added to the
// registry is rendered here, and one without a sample block fails.
#include "support/filter_agreement.h"

namespace lampyr::test {
namespace {

class FilterTypes : public testing::TestWithParam<std::string> {};

TEST_P(FilterTypes, AreTheSameToAllIntegrators) {
  ExpectFilterAgreement(*FindFilterType(GetParam()), TypeRegistry::BuiltIn(), FilterRegistry().size());
}

std::vector<std::string> RegisteredNames() {
  std::vector<std::string> names;
  for (const FilterType& type : FilterRegistry()) names.push_back(type.name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Registered, FilterTypes, testing::ValuesIn(RegisteredNames()),
                         [](const auto& info) { return info.param; });

// A filter acts on what leaves the light, and coloured glass on the way on what the filter leaves of it: the two do not
// commute where a filter mixes channels.
TEST(LightFilters, ActBeforeTheGlassThatTheLightPasses) {
  const std::string scene = R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
LookAt 0 0.9 1.2  0 0 0  0 1 0
Camera "perspective" "float fov" 30
Integrator "path" "integer maxdepth" 1
WorldBegin
AttributeBegin Translate 0 1 0 Rotate 90 1 0 0
Material "thindielectric" "float eta" 1.5 "rgb transmittance" [ 0.9 0.4 0.1 ] Shape "disk" "float radius" 2
AttributeEnd
LightFilter "intmult" "float saturation" 0.2
LightSource "spot" "rgb I" [ 4 9 6 ] "point3 from" [ 0.1 2 0 ] "point3 to" [ 0 0 0 ] "float coneangle" 25
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "trianglemesh" "point3 P" [ -2 0 -2  -2 0 2  2 0 2  2 0 -2 ] "integer indices" [ 0 1 2 0 2 3 ]
)";
  constexpr int kReplicas = 10;
  const double rate = SidakRate(1e-3, 3);
  const Replicas path = RenderReplicas(scene, "path", kReplicas, 64);
  for (const char* integrator : {"light", "bdpt", "vcm"}) {
    RenderOverrides overrides;
    overrides.seed = 1000;
    const Replicas other = RenderReplicas(scene, integrator, kReplicas, 512, overrides);
    const Agreement result = CompareReplicas(other, path, 8, rate);
    std::printf("%-5s bias %+.3f %% +- %.3f %%\n", integrator, 100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << integrator;
    EXPECT_FALSE(CompareReplicas(other, path, 8, rate, 1.04).Agrees()) << integrator << ": too noisy";
  }
}

}  // namespace
}  // namespace lampyr::test
