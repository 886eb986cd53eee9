// Layers by light path expressions: any partition of the paths adds up to the picture in every integrator, the picture
// does not know of them, each layer is the same in all integrators, and what a render of less depth gives.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

// R, G and B of a layer, "" the picture itself.
Image LayerOf(const Image& image, const std::string& layer) {
  Image result(image.width, image.height, {"R", "G", "B"});
  for (size_t c = 0; c < 3; ++c) {
    const int index = image.ChannelIndex((layer.empty() ? "" : layer + ".") + result.channels[c]);
    if (index < 0) {
      ADD_FAILURE() << "no layer " << layer;
      return result;
    }
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) result.At(x, y, c) = image.At(x, y, static_cast<size_t>(index));
    }
  }
  return result;
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
Replicas LayerOf(const Replicas& replicas, const std::string& layer) {
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
        // What light tracing finds: paths that leave the camera's vertex by a lobe that is wide.
        const bool isFound = integrator != "light" || layer == "direct diffuse" || layer == "indirect diffuse" ||
                             layer == "caustic" || layer == "volume";
        if (isFound)
          ExpectAgreement(LayerOf(replicas, ChannelOf(layer)), LayerOf(reference, ChannelOf(layer)),
                          integrator + " " + layer);
      }
    }
  }
}

TEST(PathLayersOfAll, AreWhatLessDepthGives) {
  for (const std::string integrator : {"path", "light", "bdpt", "sppm", "vcm"}) {
    RenderOverrides shallow = With(integrator, {});
    shallow.seed = 1000;
    shallow.values["max-depth"] = 2;
    const Replicas few = RenderReplicas(kScene, integrator, 10, 16, shallow);
    const Replicas all = RenderReplicas(kScene, integrator, 10, 16, With(integrator, {{"two=C.{0,2}[LO]"}}));
    ExpectAgreement(LayerOf(all, "two"), few, integrator);
  }
}

}  // namespace
}  // namespace lampyr::test
