// Agreement of all integrators through a filter of any type: a scene in which its sample block is bound to lights of
// each kind, and the comparison with path tracing.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "suite/filter_maker.h"
#include "suite/suite_inputs.h"
#include "support/replicas.h"
#include "support/temporary_folder.h"

namespace lampyr::test {

// The filter on a rectangle, on a spot light, which is a delta, and on a distant light, which is at infinity: beside
// the light, at the ground and between the two. `filter` is its statement; "" for none.
inline std::string FilterAgreementScene(const std::string& filter) {
  const auto light = [&](const std::string& place, const std::string& statement) {
    const std::string before = filter.find("LightFilter \"combiner\"") == 0 ? suite::SuiteFilterStatements() : "";
    return "AttributeBegin Translate " + place + " Rotate -90 1 0 0 Scale 1.6 1.6 1\n" + before + filter +
           "\nIdentity\n" + statement + "\nAttributeEnd\n";
  };
  return R"(Film "rgb" "integer xresolution" 16 "integer yresolution" 16
PixelFilter "box"
LookAt 0 4 0  0 0 0  0 0 -1
Camera "orthographic" "float screenwindow" [ -0.8 0.8 -0.8 0.8 ]
Integrator "path" "integer maxdepth" 2
WorldBegin
)" +
         light("-0.2 1.5 0.1",
               "Translate -0.2 1.5 0.1 Rotate -90 1 0 0 LightSource \"rect\" \"float width\" 0.4 \"float height\" 0.3 "
               "\"float intensity\" 14 \"bool cameraVisible\" false \"float shaping:cone:angle\" 45") +
         light("0.2 0.15 -0.1",
               "LightSource \"spot\" \"rgb I\" [ 2 3 4 ] \"point3 from\" [ 0.4 1.6 -0.2 ] \"point3 to\" [ 0 0 0 ] "
               "\"float coneangle\" 40 \"float conedeltaangle\" 15") +
         light("0.1 0.8 0.2",
               "LightSource \"distant\" \"rgb L\" [ 1 0.8 0.6 ] \"float angle\" 20 \"point3 from\" [ 0.2 1 -0.1 ] "
               "\"point3 to\" [ 0 0 0 ]") +
         R"(Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  -1 0 1  0 0 1  0 0 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Shape "trianglemesh" "point3 P" [ -1 0 -1  -1 0 1  -1 0.5 1  -1 0.5 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
Material "conductor" "rgb reflectance" [ 0.9 0.8 0.6 ] "float roughness" 0.5
Shape "trianglemesh" "point3 P" [ 0 0 -1  0 0 1  1 0 1  1 0 -1 ] "integer indices" [ 0 1 2 0 2 3 ]
)";
}

struct FilterTechnique {
  const char *name, *integrator;
  int samples;
  void (*change)(RenderOverrides&);
};

// All the ways to find light that a filter lies on. The first is what the others are compared with.
inline const std::vector<FilterTechnique>& FilterTechniques() {
  static const std::vector<FilterTechnique> techniques = {
      {"path", "path", 128, [](RenderOverrides&) {}},
      {"light", "light", 256, [](RenderOverrides&) {}},
      {"bdpt", "bdpt", 32, [](RenderOverrides&) {}},
      {"vcm", "vcm", 32, [](RenderOverrides&) {}},
      {"vcm --no-connect", "vcm", 20,
       [](RenderOverrides& o) { o.values["connect"] = false, o.values["photons"] = 6000; }},
      {"sppm", "sppm", 32, [](RenderOverrides& o) { o.values["photons"] = 1000; }},
      {"sppm --direct-photons", "sppm", 18,
       [](RenderOverrides& o) { o.values["direct-photons"] = true, o.values["photons"] = 6000; }},
  };
  return techniques;
}

inline Replicas RenderFilterScene(const std::string& filter, const FilterTechnique& technique, uint64_t seed,
                                  const TypeRegistry& types) {
  constexpr int kReplicas = 10;
  const TemporaryFolder folder;
  suite::WriteSuiteInputs(folder.Path());
  RenderOverrides overrides;
  overrides.values["radius"] = 0.05;  // half a pixel, and no less in later passes
  overrides.values["alpha"] = 1;
  overrides.values["guide-photons"] = false;  // it would cost more than it gains
  technique.change(overrides);
  overrides.integrator = technique.integrator;
  Diagnostics diagnostics(Diagnostics::Mode::Collect);
  BuiltScene built = BuildScene(ParseScene(FilterAgreementScene(filter), folder / "test.pbrt", diagnostics), overrides,
                                true, diagnostics, types);
  Replicas replicas;
  for (int i = 0; i < kReplicas; ++i) {
    built.settings.seed = seed + static_cast<uint64_t>(i);
    const Rendered rendered = RenderBuilt(built, technique.samples, 1);
    replicas.images.push_back(rendered.image);
    replicas.faults += rendered.outcome.counts.droppedSamples + rendered.rejectedRays;
  }
  return replicas;
}

// The type's first sample block. Block means are judged at a family-wise rate of 1e-3 over `types` types, and a picture
// that is 2 % off would be noticed.
inline void ExpectFilterAgreement(const FilterType& type, const TypeRegistry& registry, size_t typeCount) {
  ASSERT_FALSE(type.samples.empty()) << "LightFilter \"" << type.name << "\" has no sample block to be rendered";
  constexpr int kBlock = 8;
  const std::vector<FilterTechnique>& techniques = FilterTechniques();
  const double rate = SidakRate(1e-3, static_cast<int>(typeCount * (techniques.size() - 1)));
  const std::string filter = "LightFilter \"" + type.name + "\" " + type.samples[0];
  const Replicas path = RenderFilterScene(filter, techniques[0], 0, registry);
  EXPECT_FALSE(CompareReplicas(path, RenderFilterScene("", techniques[0], 0, registry), kBlock, rate).Agrees())
      << "nothing is seen of the filter";
  uint64_t seed = 0;
  for (size_t i = 1; i < techniques.size(); ++i) {
    const Replicas other = RenderFilterScene(filter, techniques[i], seed += 1000, registry);
    const Agreement result = CompareReplicas(other, path, kBlock, rate);
    std::printf("%-8s %-21s largest |z| %.2f (%.2f), chi2 %.1f (%.1f), bias %+.3f %% +- %.3f %%\n", type.name.c_str(),
                techniques[i].name, result.largestZ, result.thresholdZ, result.chiSquared, result.chiSquaredThreshold,
                100 * result.bias, 196 * result.biasError);
    EXPECT_TRUE(result.Agrees()) << techniques[i].name;
    EXPECT_EQ(path.faults + other.faults, 0u) << techniques[i].name;
    EXPECT_FALSE(CompareReplicas(other, path, kBlock, rate, 1.02).Agrees()) << techniques[i].name << ": too noisy";
    EXPECT_FALSE(CompareReplicas(other, path, kBlock, rate, 0.98).Agrees()) << techniques[i].name << ": too noisy";
  }
}

}  // namespace lampyr::test
