#include "materials/coat_table.h"

#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace lampyr {

namespace {

float GapTransmittance(float thickness, float cosine) {
  return thickness > 0 ? std::exp(-thickness / std::max(cosine, 1e-6f)) : 1.0f;
}

// Fractions of the light from direction θ that microfacets reflect and transmit, including the gap if the ray ends
// inside of the coat. `eta` is relative to the side the light comes from.
struct Split {
  double reflected = 0, transmitted = 0;
};

// Where the absorption of the gap applies. Outside: after transmission. Inside: after reflection; the caller applies
// the absorption before the boundary.
enum class Side { Outside, Inside };

Split ScatterAtMicrofacet(const Vector3& wo, const Vector3& m, float stretchO, const TrowbridgeReitz& microfacets,
                          float eta, float thickness, Side side) {
  Split split;
  const float cosO = std::min(glm::dot(wo, m), 1.0f);
  if (!(cosO > 0)) return split;
  const float cosT = RefractedCosine(cosO, eta);
  const float F = FresnelDielectric(cosO, cosT, eta);
  const Vector3 reflected = Reflect(wo, m, cosO);
  if (reflected.z > 0) {
    const float gap = side == Side::Inside ? GapTransmittance(thickness, reflected.z) : 1.0f;
    split.reflected = static_cast<double>(
        F * gap * TrowbridgeReitz::ShadowingRatio(wo.z, stretchO, reflected.z, microfacets.Stretch(reflected)));
  }
  const Vector3 refracted = wo * (-1 / eta) + RefractionShift(cosO, cosT, eta) * m;
  if (F < 1 && refracted.z < 0) {
    const float gap = side == Side::Outside ? GapTransmittance(thickness, -refracted.z) : 1.0f;
    split.transmitted = static_cast<double>(
        (1 - F) * gap * TrowbridgeReitz::ShadowingRatio(wo.z, stretchO, -refracted.z, microfacets.Stretch(refracted)));
  }
  return split;
}

// Midpoint quadrature over the unit square that SampleVisibleNormal maps to microfacets; by symmetry, over half of it.
Split ScatterAtBoundary(float cosTheta, float alpha, float eta, float thickness, Side side) {
  const Vector3 wo(SafeSqrt(1 - cosTheta * cosTheta), 0, cosTheta);
  const TrowbridgeReitz microfacets(alpha, alpha);
  if (microfacets.IsSmooth() || eta == 1) {
    return ScatterAtMicrofacet(wo, {0, 0, 1}, wo.z, TrowbridgeReitz(), eta, thickness, side);
  }
  constexpr int kCaps = 64, kAzimuths = 8;
  const float stretchO = microfacets.Stretch(wo);
  Split sum;
  for (int i = 0; i < kCaps; ++i) {
    for (int j = 0; j < kAzimuths; ++j) {
      const Point2 u(0.5f * (static_cast<float>(j) + 0.5f) / kAzimuths, (static_cast<float>(i) + 0.5f) / kCaps);
      const Vector3 m = microfacets.SampleVisibleNormal(wo, u);
      const Split split = ScatterAtMicrofacet(wo, m, stretchO, microfacets, eta, thickness, side);
      sum.reflected += split.reflected;
      sum.transmitted += split.transmitted;
    }
  }
  return {sum.reflected / (kCaps * kAzimuths), sum.transmitted / (kCaps * kAzimuths)};
}

// Linear interpolation at x in [0,1] between `count` evenly spaced nodes.
float Interpolate(const float* nodes, int count, float x) {
  const float position = std::min(std::max(x, 0.0f), 1.0f) * static_cast<float>(count - 1);
  const int first = std::min(static_cast<int>(position), count - 2);
  const float fraction = position - static_cast<float>(first);
  return nodes[first] + (nodes[first + 1] - nodes[first]) * fraction;
}

template <class Get>
float Blend(CoatTable::Slice slice, const Get& get) {
  const float first = get(slice.first);
  return slice.fraction > 0 ? first + (get(slice.first + 1) - first) * slice.fraction : first;
}

template <class AlphaAt>
CoatTable::Slice FindSliceAmong(int count, float alpha, const AlphaAt& alphaAt) {
  if (count < 2 || alpha <= alphaAt(0)) return {0, 0};
  for (int i = 1; i < count; ++i) {
    if (alpha < alphaAt(i)) return {i - 1, (alpha - alphaAt(i - 1)) / (alphaAt(i) - alphaAt(i - 1))};
  }
  return {count - 1, 0};
}

}  // namespace

CoatTable::Curves CoatTable::MakeCurves(const CoatDescription& description, float alpha) {
  Curves curves;
  curves.alpha = alpha;
  for (int i = 0; i < kNodes; ++i) {
    const float cosTheta = std::max(Sqr(static_cast<float>(i) / (kNodes - 1)), 1e-6f);
    const Split split = ScatterAtBoundary(cosTheta, alpha, description.eta, description.thickness, Side::Outside);
    curves.transmittance[i] = static_cast<float>(split.transmitted);
    curves.reflectance[i] = static_cast<float>(split.reflected);
    const float cosInside = std::max(RefractedCosine(cosTheta, description.eta), 1e-4f);
    const Split out = ScatterAtBoundary(cosInside, alpha, 1 / description.eta, description.thickness, Side::Inside);
    curves.pairTransmittance[i] = static_cast<float>(std::sqrt(
        split.transmitted * out.transmitted * static_cast<double>(GapTransmittance(description.thickness, cosInside))));
  }
  // Cosine-weighted means by the midpoint rule in sin²θ.
  constexpr int kAngles = 512;
  double mean = 0, internal = 0;
  const bool smooth = TrowbridgeReitz(alpha, alpha).IsSmooth();
  const int internalAngles = smooth ? kAngles : 128;
  for (int i = 0; i < kAngles; ++i) {
    const float cosTheta = std::sqrt((static_cast<float>(i) + 0.5f) / kAngles);
    mean += static_cast<double>(Interpolate(curves.transmittance.data(), kNodes, std::sqrt(cosTheta)));
  }
  for (int i = 0; i < internalAngles; ++i) {
    const float cosTheta = std::sqrt((static_cast<float>(i) + 0.5f) / static_cast<float>(internalAngles));
    internal += static_cast<double>(GapTransmittance(description.thickness, cosTheta)) *
                ScatterAtBoundary(cosTheta, alpha, 1 / description.eta, description.thickness, Side::Inside).reflected;
  }
  curves.meanTransmittance = static_cast<float>(mean / kAngles);
  curves.internalReflectance = static_cast<float>(internal / internalAngles);
  return curves;
}

CoatTable::CoatTable(const CoatDescription& description) {
  for (const float alpha : description.alphas) slices_.push_back(MakeCurves(description, alpha));
}

CoatTable::Slice CoatTable::FindSlice(float alpha) const {
  return FindSliceAmong(static_cast<int>(slices_.size()), alpha,
                        [&](int i) { return slices_[static_cast<size_t>(i)].alpha; });
}

float CoatTable::Transmittance(float cosTheta, Slice slice) const {
  const float x = std::sqrt(std::abs(cosTheta));
  return Blend(slice, [&](int i) { return Interpolate(slices_[i].transmittance.data(), kNodes, x); });
}

float CoatTable::Reflectance(float cosTheta, Slice slice) const {
  const float x = std::sqrt(std::abs(cosTheta));
  return Blend(slice, [&](int i) { return Interpolate(slices_[i].reflectance.data(), kNodes, x); });
}

float CoatTable::PairTransmittance(float cosTheta, Slice slice) const {
  const float x = std::sqrt(std::abs(cosTheta));
  return Blend(slice, [&](int i) { return Interpolate(slices_[i].pairTransmittance.data(), kNodes, x); });
}

float CoatTable::MeanTransmittance(Slice slice) const {
  return Blend(slice, [&](int i) { return slices_[i].meanTransmittance; });
}

float CoatTable::InternalReflectance(Slice slice) const {
  return Blend(slice, [&](int i) { return slices_[i].internalReflectance; });
}

CoatBounceTable::CoatBounceTable(const CoatDescription& coat, const std::vector<float>& baseAlphas)
    : alphas_(baseAlphas) {
  // Fractions of the light leaving the base at an angle that leave the coat, and that return to the base.
  Nodes leaving{}, returning{};
  const float coatAlpha = coat.alphas[coat.alphas.size() / 2];
  for (int i = 0; i < kNodes; ++i) {
    const float cosInside = std::max(static_cast<float>(i) / (kNodes - 1), 1e-4f);
    const float gap = GapTransmittance(coat.thickness, cosInside);
    const Split split = ScatterAtBoundary(cosInside, coatAlpha, 1 / coat.eta, coat.thickness, Side::Inside);
    leaving[i] = gap * static_cast<float>(split.transmitted);
    returning[i] = gap * static_cast<float>(split.reflected);
  }
  for (const float alpha : alphas_) slices_.push_back(MakeCurves(leaving, returning, alpha));
}

// g_1(θ) = ∫ base(θ → θ') leaving(θ'),  g_k+1(θ) = ∫ base(θ → θ') returning(θ') g_k(θ').
CoatBounceTable::Curves CoatBounceTable::MakeCurves(const Nodes& leaving, const Nodes& returning, float alpha) {
  constexpr int kCaps = 32, kAzimuths = 12;
  const TrowbridgeReitz microfacets(std::max(alpha, 1e-3f), std::max(alpha, 1e-3f));
  const auto scatter = [&](const Nodes& after) {
    Nodes before{};
    for (int node = 0; node < kNodes; ++node) {
      const float cosTheta = std::max(static_cast<float>(node) / (kNodes - 1), 1e-4f);
      const Vector3 wo(SafeSqrt(1 - cosTheta * cosTheta), 0, cosTheta);
      const float stretchO = microfacets.Stretch(wo);
      double sum = 0;
      for (int k = 0; k < kCaps * kAzimuths; ++k) {
        const Point2 u(0.5f * (static_cast<float>(k % kAzimuths) + 0.5f) / kAzimuths,
                       (static_cast<float>(k / kAzimuths) + 0.5f) / kCaps);
        const Vector3 m = microfacets.SampleVisibleNormal(wo, u);
        const Vector3 wi = Reflect(wo, m, glm::dot(wo, m));
        if (!(wi.z > 0)) continue;
        const float ratio = TrowbridgeReitz::ShadowingRatio(wo.z, stretchO, wi.z, microfacets.Stretch(wi));
        sum += static_cast<double>(ratio * Interpolate(after.data(), kNodes, wi.z));
      }
      before[node] = static_cast<float>(sum / (kCaps * kAzimuths));
    }
    return before;
  };
  const auto times = [](Nodes a, const Nodes& b) {
    for (int i = 0; i < kNodes; ++i) a[i] *= b[i];
    return a;
  };
  const Nodes first = scatter(leaving), second = scatter(times(first, returning)),
              third = scatter(times(second, returning));
  // If nothing leaves after one bounce, there is nothing to scale: directions beyond total reflection, which are never
  // queried.
  Curves curves;
  for (int i = 0; i < kNodes; ++i) {
    curves.second[i] = first[i] > 1e-3f ? second[i] / first[i] : 0.0f;
    curves.later[i] = second[i] > 1e-6f ? std::min(third[i] / second[i], 1.0f) : 0.0f;
  }
  return curves;
}

CoatBounceTable::Ratios CoatBounceTable::FindRatios(float cosInside, CoatTable::Slice slice) const {
  return {Blend(slice, [&](int i) { return Interpolate(slices_[i].second.data(), kNodes, cosInside); }),
          Blend(slice, [&](int i) { return Interpolate(slices_[i].later.data(), kNodes, cosInside); })};
}

CoatTable::Slice CoatBounceTable::FindSlice(float alpha) const {
  return FindSliceAmong(static_cast<int>(alphas_.size()), alpha,
                        [&](int i) { return alphas_[static_cast<size_t>(i)]; });
}

std::vector<float> TexturedAlphas() {
  constexpr int kSlices = 12;
  std::vector<float> alphas;
  for (int i = 0; i < kSlices; ++i) alphas.push_back(Sqr(static_cast<float>(i) / (kSlices - 1)));
  return alphas;
}

float TruncatedSeries(float x, int terms) {
  if (x >= 1) return static_cast<float>(terms);
  return (1 - std::pow(x, static_cast<float>(terms))) / (1 - x);
}

}  // namespace lampyr
