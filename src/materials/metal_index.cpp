#include "materials/metal_index.h"

#include <cmath>
#include <limits>
#include <vector>

#include "materials/fresnel.h"
#include "scene/spectrum.h"

namespace lampyr {

namespace {

constexpr float kGrazing = 0.258819045f;  // cos 75°
constexpr double kMostReflectance = 0.9999;
constexpr int kSteps = 512;  // of the search for the index

Color ReflectanceAt(float cosine, const SpectralCurve& eta, const SpectralCurve& k) {
  std::vector<SpectrumSample> spectrum;
  for (size_t i = 0; i < SpectralCurve::kCount; ++i) {
    const float reflectance =
        FresnelConductor(cosine, static_cast<float>(eta.Entry(i)), static_cast<float>(k.Entry(i)));
    spectrum.push_back({SpectralCurve::WavelengthOf(i), static_cast<double>(reflectance)});
  }
  return SpectrumToColor(spectrum, SpectrumRole::Albedo);
}

struct Index {
  float eta = 1, k = 0;
};

// The index with the reflectance `normal` at normal incidence whose reflectance at 75° is nearest to `grazing`. Indices
// with one reflectance at normal incidence lie on a circle; `part` runs along it from 0 to 1 ([Gulbrandsen14]).
Index IndexWith(float normal, float grazing) {
  const double r = std::min(static_cast<double>(normal), kMostReflectance), root = std::sqrt(r);
  Index best;
  float least = std::numeric_limits<float>::infinity();
  for (int i = 0; i <= kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    const double n = part * (1 - r) / (1 + r) + (1 - part) * (1 + root) / (1 - root);
    const double squared = (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r);
    const Index index{static_cast<float>(n), static_cast<float>(std::sqrt(std::max(squared, 0.0)))};
    const float error = std::abs(FresnelConductor(kGrazing, index.eta, index.k) - grazing);
    if (error >= least) continue;
    least = error;
    best = index;
  }
  return best;
}

}  // namespace

MetalIndex RgbIndexOf(const SpectralCurve& eta, const SpectralCurve& k) {
  const Color normal = ReflectanceAt(1, eta, k), grazing = ReflectanceAt(kGrazing, eta, k);
  const Index r = IndexWith(normal.r, grazing.r), g = IndexWith(normal.g, grazing.g),
              b = IndexWith(normal.b, grazing.b);
  return {{r.eta, g.eta, b.eta}, {r.k, g.k, b.k}};
}

}  // namespace lampyr
