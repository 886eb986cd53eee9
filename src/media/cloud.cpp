// A procedural cloud ([Pharr23 §11.4.2]): fractal noise at a point that other noise displaces, thinner towards the top.
#include <algorithm>
#include <cmath>

#include "math/noise.h"
#include "media/box_medium.h"
#include "media/medium_makers.h"
#include "media/voxels.h"

namespace lampyr {

namespace {

struct CloudParameters {
  ScatteringParameters scattering;
  float density = 1, wispiness = 1, frequency = 5;
};

constexpr int kOctaves = 5;
// Upper bound of |Noise|, which reaches 1.037 between gradients that all point to the middle.
constexpr float kNoiseBound = 1.05f;

// Slope of the noise by finite differences; displaces points.
Vector3 NoiseSlope(const Point3& p) {
  constexpr float kStep = 0.01f;
  const auto [here, alongX, alongY, alongZ] = NoiseAround(p, kStep);
  return (Vector3(alongX, alongY, alongZ) - Vector3(here)) / kStep;
}

// The density at height y if the noise sums to `noise`.
float DensityOf(const CloudParameters& cloud, float y, float noise) {
  const float shaped = std::clamp((1 - y) * 4.5f * cloud.density * noise, 0.0f, 1.0f);
  return std::clamp(shaped + 2 * std::max(0.0f, 0.5f - y), 0.0f, 1.0f);
}

class CloudMedium : public BoxMedium {
 public:
  CloudMedium(const std::string& name, const CloudParameters& cloud, const Affine& toMedium, MajorantGrid majorants)
      : BoxMedium(name, cloud.scattering.asymmetry, false, toMedium, std::move(majorants)), cloud_(cloud) {}

  // About 20 ns for the noise at a point, and 43 around one.
  double LookupNanoseconds() const override { return 20 * kOctaves + (cloud_.wispiness > 0 ? 2 * 43 : 0); }

 protected:
  MediumCoefficients AtInside(const Point3& p) const override {
    Point3 at = p * cloud_.frequency;
    float size = 0.05f * cloud_.wispiness, frequency = 10;
    for (int i = 0; i < 2 && cloud_.wispiness > 0; ++i) {
      at += size * NoiseSlope(at * frequency);
      size *= 0.5f;
      frequency *= 1.99f;
    }
    const float density = DensityOf(cloud_, p.y, 0.5f * FractalNoise(at, 0.5f, kOctaves));
    return {cloud_.scattering.absorption * density, cloud_.scattering.scattering * density, Color()};
  }

 private:
  CloudParameters cloud_;
};

// Layers of height, in which the density is bounded for any noise. Above y = 1, where the cloud is meant to have ended,
// the factor (1 - y) of the formula is negative, and negative noise gives a positive density.
MajorantGrid MakeMajorants(const CloudParameters& cloud, const Bounds3& box, const Affine& toMedium) {
  constexpr int kLayers = 32;
  constexpr float kMostNoise = kNoiseBound * (1 - 1.0f / (1 << kOctaves));  // Σ 2^-i, i from 1
  std::vector<float> majorants;
  const float side = (box.max.y - box.min.y) / kLayers, margin = side * static_cast<float>(kCellMargin);
  for (int i = 0; i < kLayers; ++i) {
    const float low = box.min.y + side * static_cast<float>(i) - margin;
    const float high = box.min.y + side * static_cast<float>(i + 1) + margin;
    const float most = std::max({DensityOf(cloud, low, kMostNoise), DensityOf(cloud, low, -kMostNoise),
                                 DensityOf(cloud, high, kMostNoise), DensityOf(cloud, high, -kMostNoise)});
    majorants.push_back(most * cloud.scattering.Extinction().Max() * kMajorantMargin);
  }
  return {box, 1, kLayers, 1, std::move(majorants), toMedium};
}

// Limits within which every step of the formula is in the range of floats.
constexpr float kLargestCoordinate = 1e9f;

float GetModerate(const ParameterList& parameters, const std::string& name, double defaultValue) {
  const float value = GetNonNegative(parameters, name, defaultValue);
  if (value <= 1e6f) return value;
  throw Error(parameters.WhereOf(name), "\"" + name + "\" must be at most 1e6");
}

}  // namespace

std::shared_ptr<const Medium> MakeCloud(const MediumInput& input) {
  const ParameterList& parameters = input.Parameters();
  CloudParameters cloud;
  cloud.scattering = GetScattering(parameters, false, false);
  cloud.density = GetModerate(parameters, "density", 1);
  cloud.wispiness = GetModerate(parameters, "wispiness", 1);
  cloud.frequency = GetModerate(parameters, "frequency", 5);
  const Bounds3d bounds = GetBox(parameters);
  const Bounds3 box{Point3(bounds.min), Point3(bounds.max)};
  if (!(std::max(MaxAbsComponent(box.min), MaxAbsComponent(box.max)) <= kLargestCoordinate)) {
    throw Error(parameters.WhereOf("p1"), "the box of a cloud must be within 1e9 of the origin of its space");
  }
  parameters.CheckAllUsed({}, {"type", "p0", "p1", "sigma_a", "sigma_s", "g", "density", "wispiness", "frequency"},
                          input.diagnostics);
  const Affine toMedium = MakeToSpace(input.renderFromMedium, input);
  return std::make_shared<CloudMedium>(input.description.name, cloud, toMedium, MakeMajorants(cloud, box, toMedium));
}

}  // namespace lampyr
