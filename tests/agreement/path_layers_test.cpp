// Layers by light path expressions: any partition of the paths adds up to the picture in every integrator, the picture
// does not know of them, each layer is the same in all integrators, and what a render of less depth gives.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/layer_of.h"
#include "support/replicas.h"

namespace lampyr::test {
namespace {

constexpr const char* kIntegrators[] = {"path", "light", "bdpt", "sppm", "vcm", "auto"};

// Diffuse, glossy and smooth scattering of both sides, lobes of several kinds at one point, a medium that scatters and
// one that glows. All lights can be found from both ends.
constexpr const char* kScene = R"(Film "rgb" "integer xresolution" 24 "integer yresolution" 20
PixelFilter "box"
LookAt 0 1.5 4.2  0 0.7 0  0 1 0
Camera "perspective" "float fov" 42
Integrator "path" "integer maxdepth" 5
MakeNamedMedium "mist" "string type" "homogeneous" "rgb sigma_s" [1.5 1 2] "rgb sigma_a" [0.1 0.2 0.1] "float g" 0.3
MakeNamedMedium "ember" "string type" "homogeneous" "rgb sigma_s" [0.5 0.5 0.5] "rgb sigma_a" [0.5 0.5 0.5]
  "rgb Le" [0.6 0.3 0.1]
WorldBegin
LightSource "infinite" "rgb L" [0.2 0.3 0.4] "string name" "sky"
AttributeBegin
AreaLightSource "diffuse" "rgb L" [14 11 8] "string name" "lamp"
Material "diffuse" "rgb reflectance" [0.2 0.2 0.2]
Shape "trianglemesh" "point3 P" [-0.8 2.2 -0.4  0.4 2.2 -0.4  0.4 2.2 0.8  -0.8 2.2 0.8] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "rgb L" [1 2 5] "string name" "strip"
Material "diffuse" "rgb reflectance" [0.2 0.2 0.2]
Shape "trianglemesh" "point3 P" [1.8 0.2 -1  1.8 0.2 1  1.8 1.4 1  1.8 1.4 -1] "integer indices" [0 1 2 0 2 3]
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-2.5 0 -2  -2.5 0 2.5  2.5 0 2.5  2.5 0 -2] "integer indices" [0 1 2 0 2 3]
AttributeBegin
Material "coateddiffuse" "rgb reflectance" [0.4 0.5 0.6] "float roughness" 0.2
Shape "trianglemesh" "point3 P" [-2.5 0 -1.2  1.6 0 -1.2  1.6 1.4 -1.2  -2.5 1.4 -1.2] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
Material "dielectric" "float eta" 1.5
Translate -0.5 0.45 0.4 Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "conductor" "rgb reflectance" [0.9 0.8 0.6] "float roughness" 0.3
Translate 0.4 0.3 0.4 Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Material "dielectric" "float eta" 1.4 "float roughness" 0.2
Translate 1.1 0.3 0.6 Shape "sphere" "float radius" 0.28
AttributeEnd
AttributeBegin
Material "diffusetransmission" "rgb reflectance" [0.3 0.2 0.2] "rgb transmittance" [0.4 0.5 0.2]
Shape "trianglemesh" "point3 P" [-1.9 0.2 -0.8  -1.2 0.2 -0.8  -1.2 1.3 -0.8  -1.9 1.3 -0.8] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
Material "interface" MediumInterface "mist" ""
Translate 0.1 0.9 -0.4 Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Material "interface" MediumInterface "ember" ""
Translate 1.1 0.9 -0.5 Shape "sphere" "float radius" 0.3
AttributeEnd
)";

using Partition = std::vector<std::string>;
const std::vector<Partition> kPartitions = {
    {"emission", "direct diffuse", "indirect diffuse", "direct specular", "indirect specular", "transmission",
     "volume"},
    {"length0=C[LO]", "length1=C.[LO]", "length2=C..[LO]", "length3=C.{3,}[LO]"},
    {"seen=C[LO]", "lastD=C.*D[LO]", "lastG=C.*G[LO]", "lastS=C.*S[LO]", "lastV=C.*V[LO]"},
    {"lamp=C.*<L.'lamp'>", "strip=C.*<L.'strip'>", "sky=C.*<L.'sky'>", "media=C.*O"},
    {"caustic", "others=C([^D].*|D([DV].*)?)?[LO]"},
};

std::string ChannelOf(const std::string& layer) {
  std::string name = layer.substr(0, layer.find('='));
  for (char& c : name) c = c == ' ' ? '_' : c;
  return name;
}

RenderOverrides With(const std::string& integrator, const std::vector<Partition>& layers) {
  RenderOverrides overrides;
  overrides.integrator = integrator;
  for (const Partition& partition : layers)
    overrides.layers.insert(overrides.layers.end(), partition.begin(), partition.end());
  return overrides;
}

class PathLayers : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Of, PathLayers, testing::ValuesIn(kIntegrators),
                         [](const auto& tested) { return tested.param; });

TEST_P(PathLayers, PartThePicture) {
  const Image image = RenderText(kScene, 16, With(GetParam(), kPartitions), 2).image;
  const Image whole = LayerOf(image, "");
  for (const Partition& partition : kPartitions) {
    std::vector<double> sums(whole.data.size());
    for (const std::string& layer : partition) {
      const Image part = LayerOf(image, ChannelOf(layer));
      double total = 0;
      for (size_t i = 0; i < sums.size(); ++i) {
        sums[i] += static_cast<double>(part.data[i]);
        total += static_cast<double>(part.data[i]);
      }
      // Light tracing sees no light in smooth surfaces, and no background.
      const bool isSeen = std::string(GetParam()) != "light";
      if (isSeen) {
        EXPECT_GT(total, 0) << layer;
      }
    }
    double largest = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
      const auto value = static_cast<double>(whole.data[i]);
      if (value > 0) largest = std::max(largest, std::abs(sums[i] / value - 1));
    }
    EXPECT_LT(largest, 2e-6) << partition[0];
  }
}

TEST_P(PathLayers, LeaveThePictureAlone) {
  const Image with = RenderText(kScene, 5, With(GetParam(), kPartitions), 2).image;
  const Image without = RenderText(kScene, 5, With(GetParam(), {}), 2).image;
  EXPECT_EQ(LayerOf(with, "").data, LayerOf(without, "").data);
}

// The layer of each of the replicas.
Replicas LayerOfAll(const Replicas& replicas, const std::string& layer) {
  Replicas result;
  for (const Image& image : replicas.images) result.images.push_back(LayerOf(image, layer));
  return result;
}

void ExpectAgreement(const Replicas& a, const Replicas& b, const std::string& what) {
  const Agreement agreement = CompareReplicas(a, b, 8, 1e-4);
  std::printf("%-28s %+.4f ± %.4f, z %.1f of %.1f, χ² %.0f of %.0f\n", what.c_str(), agreement.bias,
              agreement.biasError, agreement.largestZ, agreement.thresholdZ, agreement.chiSquared,
              agreement.chiSquaredThreshold);
  EXPECT_TRUE(agreement.Agrees()) << what;
}

TEST(PathLayersOfAll, AreTheSame) {
  constexpr int kReplicas = 12, kSamples = 24;
  const std::vector<Partition> layers = {kPartitions[0], kPartitions[2], kPartitions[3], {"caustic"}};
  const Replicas reference = RenderReplicas(kScene, "bdpt", kReplicas, kSamples, With("bdpt", layers));
  for (const std::string integrator : {"path", "light", "sppm", "vcm"}) {
    RenderOverrides overrides = With(integrator, layers);
    overrides.seed = 1000;
    if (integrator == "sppm" || integrator == "vcm") overrides.values["radius"] = 0.02;
    if (integrator == "sppm") overrides.values["photons"] = 10000;  // few in a radius are not normal
    const Replicas replicas = RenderReplicas(kScene, integrator, kReplicas, kSamples, overrides);
    for (const Partition& partition : layers) {
      for (const std::string& layer : partition) {
        // Layers that light tracing finds: paths that leave the camera's vertex by a wide lobe.
        const bool isFound = integrator != "light" || layer == "direct diffuse" || layer == "indirect diffuse" ||
                             layer == "caustic" || layer == "volume";
        if (isFound)
          ExpectAgreement(LayerOfAll(replicas, ChannelOf(layer)), LayerOfAll(reference, ChannelOf(layer)),
                          integrator + " " + layer);
      }
    }
  }
}

// A diffuse floor, a glossy ball and a pane of glass in front: of light that no material of a kind has scattered there
// is as much as where that material is black.
TEST(PathLayersOfAll, AreWhatBlackMaterialsLeave) {
  const auto scene = [](double floor, double ball) {
    const auto gray = [](double value) {
      const std::string text = std::to_string(value);
      return "[" + text + " " + text + " " + text + "]\n";
    };
    return R"(Film "rgb" "integer xresolution" 20 "integer yresolution" 16
PixelFilter "box"
LookAt 0 1.2 4  0 0.5 0  0 1 0
Camera "perspective" "float fov" 40
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "rgb L" [0.3 0.4 0.5]
AttributeBegin
AreaLightSource "diffuse" "rgb L" [12 10 8]
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "point3 P" [-0.5 2 -0.5  0.5 2 -0.5  0.5 2 0.5  -0.5 2 0.5] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
Material "conductor" "float roughness" 0.3 "rgb reflectance" )" +
           gray(ball) + R"(Translate 0.3 0.5 0 Shape "sphere" "float radius" 0.5
AttributeEnd
AttributeBegin
Material "dielectric"
Translate -0.7 0.4 0.6 Shape "sphere" "float radius" 0.4
AttributeEnd
Material "diffuse" "rgb reflectance" )" +
           gray(floor) +
           "Shape \"trianglemesh\" \"point3 P\" [-3 0 -3  -3 0 3  3 0 3  3 0 -3] \"integer indices\" [0 1 2 0 2 3]\n";
  };
  const Partition layers = {"noGloss=C[^G]*[LO]", "noDiffuse=C[^D]*[LO]"};
  for (const std::string integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    RenderOverrides overrides = With(integrator, {layers}), black = With(integrator, {});
    black.seed = 1000;
    for (RenderOverrides* each : {&overrides, &black}) {
      if (integrator == "sppm" || integrator == "vcm") each->values["radius"] = 0.03;
      if (integrator == "sppm") each->values["photons"] = 10000;
    }
    const Replicas all = RenderReplicas(scene(0.6, 0.8), integrator, 12, 24, overrides);
    ExpectAgreement(LayerOfAll(all, "noGloss"), RenderReplicas(scene(0.6, 0), integrator, 12, 24, black),
                    integrator + ", black ball");
    // Light tracing connects no vertex of what is not diffuse here but the ball's.
    ExpectAgreement(LayerOfAll(all, "noDiffuse"), RenderReplicas(scene(0, 0.8), integrator, 12, 24, black),
                    integrator + ", black floor");
  }
}

// In fog so thin that the photons of vcm are beams: shafts of light from glass, and what they are seen by. Path tracing
// finds them by events too rare for a test of means.
TEST(PathLayersOfAll, AreTheSameForPhotonBeams) {
  const std::string scene = R"(Film "rgb" "integer xresolution" 20 "integer yresolution" 16
PixelFilter "box"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_s" [0.06 0.05 0.04] "rgb sigma_a" [0.01 0.01 0.02]
MediumInterface "" "fog"
LookAt 0 0.6 4  0 0.4 0  0 1 0
Camera "perspective" "float fov" 45
Integrator "path" "integer maxdepth" 6
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [30 26 20] "string name" "lamp"
Material "diffuse" "rgb reflectance" [0 0 0]
Shape "trianglemesh" "point3 P" [-0.3 2 -0.3  0.3 2 -0.3  0.3 2 0.3  -0.3 2 0.3] "integer indices" [0 1 2 0 2 3]
AttributeEnd
AttributeBegin
Material "dielectric" "float eta" 1.5
MediumInterface "" "fog"
Translate 0 0.8 0 Shape "sphere" "float radius" 0.5
AttributeEnd
Material "diffuse" "rgb reflectance" [0.6 0.5 0.4]
Shape "trianglemesh" "point3 P" [-3 -0.4 -3  -3 -0.4 3  3 -0.4 3  3 -0.4 -3] "integer indices" [0 1 2 0 2 3]
)";
  const Partition layers = {"shaft=CV[GS]+[LO]", "single=CV[LO]", "throughFog=CD.*V.*[LO]", "twice=C.*V.*V.*[LO]",
                            "caustic"};
  RenderOverrides overrides = With("bdpt", {layers});
  overrides.values["max-depth"] = 5;
  const Replicas reference = RenderReplicas(scene, "bdpt", 12, 64, overrides);
  for (const std::string integrator : {"vcm", "sppm"}) {
    overrides.seed = 1000;
    overrides.values["radius"] = 0.03;
    if (integrator == "sppm") overrides.values["photons"] = 10000;
    const Replicas replicas = RenderReplicas(scene, integrator, 12, 32, overrides);
    for (const std::string& layer : layers)
      ExpectAgreement(LayerOfAll(replicas, ChannelOf(layer)), LayerOfAll(reference, ChannelOf(layer)),
                      integrator + " " + layer);
  }
}

TEST(PathLayersOfAll, AreWhatLessDepthGives) {
  for (const std::string integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    RenderOverrides shallow = With(integrator, {});
    shallow.seed = 1000;
    shallow.values["max-depth"] = 2;
    const Replicas few = RenderReplicas(kScene, integrator, 10, 16, shallow);
    const Replicas all = RenderReplicas(kScene, integrator, 10, 16, With(integrator, {{"two=C.{0,2}[LO]"}}));
    ExpectAgreement(LayerOfAll(all, "two"), few, integrator);
  }
}

}  // namespace
}  // namespace lampyr::test
