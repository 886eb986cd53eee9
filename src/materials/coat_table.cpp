#include "materials/coat_table.h"

#include "materials/fresnel.h"
#include "materials/microfacet.h"

namespace lampyr {

namespace {

float GapTransmittance(float thickness, float cosine) {
  return thickness > 0 ? std::exp(-thickness / std::max(cosine, 1e-6f)) : 1.0f;
}

// Fractions of the light from direction θ that microfacets reflect and transmit, including the gap if the ray ends
// inside the coat. `eta` is relative to the side of the light.
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

// Calls visit(m, part) for the microfacets that are visible from `w`, with the fraction `part` of the projected area:
// midpoints of the unit square, mapped by SampleVisibleNormal; by symmetry, of half of it. A smooth boundary has one.
template <class Visit>
void ForVisibleNormals(const TrowbridgeReitz& microfacets, const Vector3& w, int caps, const Visit& visit) {
  constexpr int kAzimuths = 8;
  if (microfacets.IsSmooth()) {
    visit(Vector3(0, 0, 1), 1.0f);
    return;
  }
  const float part = 1.0f / static_cast<float>(caps * kAzimuths);
  for (int i = 0; i < caps; ++i) {
    for (int j = 0; j < kAzimuths; ++j) {
      const Point2 u(0.5f * (static_cast<float>(j) + 0.5f) / kAzimuths,
                     (static_cast<float>(i) + 0.5f) / static_cast<float>(caps));
      visit(microfacets.SampleVisibleNormal(w, u), part);
    }
  }
}

Split ScatterAtBoundary(float cosTheta, float alpha, float eta, float thickness, Side side) {
  const Vector3 wo(SafeSqrt(1 - cosTheta * cosTheta), 0, cosTheta);
  const TrowbridgeReitz microfacets = eta == 1 ? TrowbridgeReitz() : TrowbridgeReitz(alpha, alpha);
  constexpr int kCaps = 64;
  const float stretchO = microfacets.IsSmooth() ? wo.z : microfacets.Stretch(wo);
  Split sum;
  ForVisibleNormals(microfacets, wo, kCaps, [&](const Vector3& m, float part) {
    const Split split = ScatterAtMicrofacet(wo, m, stretchO, microfacets, eta, thickness, side);
    sum.reflected += static_cast<double>(part) * split.reflected;
    sum.transmitted += static_cast<double>(part) * split.transmitted;
  });
  return sum;
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

float CoatTable::MeanTransmittance(Slice slice) const {
  return Blend(slice, [&](int i) { return slices_[i].meanTransmittance; });
}

float CoatTable::InternalReflectance(Slice slice) const {
  return Blend(slice, [&](int i) { return slices_[i].internalReflectance; });
}

namespace {

constexpr int kWalkNodes = 64;  // evenly spaced in sqrt(cosθ)
constexpr int kWalkCaps = 32;   // midpoints in ForVisibleNormals
using WalkNodes = std::array<float, kWalkNodes>;

float NodeCosineOf(int node) {
  return std::max(Sqr(static_cast<float>(node) / (kWalkNodes - 1)), 1e-6f);
}

// Scattering from one side of a boundary to a side: for light from the cosine of each node, the cosines at which it
// continues, with weights.
class WalkKernel {
 public:
  // scatter(direction of the node, m, add) calls add(cosine, weight) for a microfacet visible from the direction.
  template <class Scatter>
  WalkKernel(float alpha, const Scatter& scatter) : alpha_(alpha) {
    const TrowbridgeReitz microfacets(alpha, alpha);
    for (int node = 0; node < kWalkNodes; ++node) {
      const float cosTheta = NodeCosineOf(node);
      const Vector3 w(SafeSqrt(1 - cosTheta * cosTheta), 0, cosTheta);
      std::vector<Entry>& entries = entries_[static_cast<size_t>(node)];
      ForVisibleNormals(microfacets, w, kWalkCaps, [&](const Vector3& m, float part) {
        scatter(w, m, [&](float cosine, float weight) {
          if (weight > 0) entries.push_back({std::sqrt(std::min(cosine, 1.0f)), weight * part});
        });
      });
    }
  }
  // The mean of `after` over the scattered directions, for each direction of incidence.
  WalkNodes Apply(const WalkNodes& after) const {
    WalkNodes before;
    for (size_t node = 0; node < before.size(); ++node) {
      double sum = 0;
      for (const Entry& entry : entries_[node])
        sum += static_cast<double>(entry.weight * Interpolate(after.data(), kWalkNodes, entry.x));
      before[node] = static_cast<float>(sum);
    }
    return before;
  }
  float Alpha() const { return alpha_; }

 private:
  struct Entry {
    float x, weight;  // x: sqrt of the cosine
  };
  std::array<std::vector<Entry>, kWalkNodes> entries_;
  float alpha_;
};

// Weight of a microfacet that reflects or refracts into the direction `to`.
float SeenPart(const TrowbridgeReitz& microfacets, const Vector3& from, const Vector3& to) {
  return microfacets.IsSmooth() ? 1.0f
                                : TrowbridgeReitz::ShadowingRatio(from.z, microfacets.Stretch(from), std::abs(to.z),
                                                                  microfacets.Stretch(to));
}

// Effective roughness of the coat: none if its boundary has no effect.
float CoatRoughnessOf(const CoatDescription& coat, float alpha) {
  return coat.eta == 1 ? 0.0f : alpha;
}
// Refraction into the coat and down to the base, or internal reflection.
auto AcrossCoat(const CoatDescription& coat, float alpha, float eta, bool isReflected) {
  const float roughness = CoatRoughnessOf(coat, alpha), thickness = coat.thickness;
  return [=](const Vector3& w, const Vector3& m, const auto& add) {
    const TrowbridgeReitz microfacets(roughness, roughness);
    const float cosine = std::min(glm::dot(w, m), 1.0f);
    if (!(cosine > 0)) return;
    const float cosT = RefractedCosine(cosine, eta), F = FresnelDielectric(cosine, cosT, eta);
    const Vector3 to = isReflected ? Reflect(w, m, cosine) : w * (-1 / eta) + RefractionShift(cosine, cosT, eta) * m;
    if (isReflected ? !(to.z > 0) : !(F < 1 && to.z < 0)) return;
    const float part = isReflected ? F : 1 - F, down = std::abs(to.z);
    add(down, part * GapTransmittance(thickness, down) * SeenPart(microfacets, w, to));
  };
}

// A boundary of the coat: into it and down to the base, and from within back to the base.
struct CoatKernels {
  WalkKernel enter, back;
  WalkNodes leaving;  // the fraction that leaves, from within

  CoatKernels(const CoatDescription& coat, float alpha)
      : enter(CoatRoughnessOf(coat, alpha), AcrossCoat(coat, alpha, coat.eta, false)),
        back(CoatRoughnessOf(coat, alpha), AcrossCoat(coat, alpha, 1 / coat.eta, true)) {
    for (int node = 0; node < kWalkNodes; ++node)
      leaving[static_cast<size_t>(node)] = static_cast<float>(
          ScatterAtBoundary(NodeCosineOf(node), alpha, 1 / coat.eta, coat.thickness, Side::Inside).transmitted);
  }
};

// Reflection at the base, and up to the boundary.
WalkKernel BaseKernel(const CoatDescription& coat, float alpha) {
  const TrowbridgeReitz microfacets(alpha, alpha);
  return WalkKernel(alpha,
                    [microfacets, thickness = coat.thickness](const Vector3& w, const Vector3& m, const auto& add) {
                      const Vector3 to = Reflect(w, m, glm::dot(w, m));
                      if (to.z > 0) add(to.z, GapTransmittance(thickness, to.z) * SeenPart(microfacets, w, to));
                    });
}

// The lobe of one bounce as in CoatedConductorBsdf, without its scale, as a function of the direction outside.
WalkKernel LobeKernel(const CoatDescription& coat, float coatAlpha, float baseAlpha) {
  const TrowbridgeReitz base =
      WidenedBase(TrowbridgeReitz(baseAlpha, baseAlpha), TrowbridgeReitz(coatAlpha, coatAlpha), coat.eta);
  // The direction of a node is outside, and so is that of the lobe; visible normals are seen from within.
  return WalkKernel(0, [=, eta = coat.eta](const Vector3& w, const Vector3&, const auto& add) {
    const Vector3 o(w.x / eta, w.y / eta, RefractedCosine(w.z, eta));
    if (!(o.z > 0)) return;
    ForVisibleNormals(base, o, kWalkCaps, [&](const Vector3& m, float part) {
      const Vector3 i = Reflect(o, m, glm::dot(o, m));
      const float cosine = i.z > 0 ? RefractedCosine(std::min(i.z, 1.0f), 1 / eta) : 0.0f;
      if (cosine > 0) add(cosine, SeenPart(base, o, i) * part);
    });
  });
}

// C of a lobe: C(wo) ∫ C(wi) lobe = albedo, by iterated symmetric scaling.
WalkNodes ScaleOf(const WalkKernel& lobe, const WalkNodes& albedo) {
  constexpr int kTurns = 10;
  constexpr float kMost = 3;  // limits C at grazing angles, where both sides are nearly 0
  WalkNodes scale;
  scale.fill(1);
  for (int turn = 0; turn < kTurns; ++turn) {
    const WalkNodes now = lobe.Apply(scale);
    for (size_t i = 0; i < scale.size(); ++i)
      scale[i] = now[i] > 0 ? std::min(std::sqrt(scale[i] * albedo[i] / now[i]), kMost) : 0.0f;
  }
  return scale;
}

}  // namespace

TrowbridgeReitz WidenedBase(const TrowbridgeReitz& base, const TrowbridgeReitz& coat, float eta) {
  if (coat.IsSmooth() || eta == 1) return base;
  const float share = 0.5f * Sqr(1 - 1 / eta);
  const float x = std::sqrt(Sqr(base.alphaX) + share * Sqr(coat.alphaX));
  const float y = std::sqrt(Sqr(base.alphaY) + share * Sqr(coat.alphaY));
  return {std::max(x, 1e-3f), std::max(y, 1e-3f)};
}

CoatedMetalTable::CoatedMetalTable(const CoatDescription& coat, const std::vector<float>& baseAlphas)
    : coatAlphas_(coat.alphas), baseAlphas_(baseAlphas) {
  static_assert(kNodes == kWalkNodes);
  std::vector<WalkKernel> bases;
  for (const float alpha : baseAlphas_) bases.push_back(BaseKernel(coat, alpha));
  for (const float coatAlpha : coatAlphas_) {
    const CoatKernels boundary(coat, coatAlpha);
    for (const WalkKernel& base : bases) {
      // The fractions of the light at the base that leave the coat after one, two and three bounces there.
      const WalkNodes one = base.Apply(boundary.leaving), two = base.Apply(boundary.back.Apply(one)),
                      three = base.Apply(boundary.back.Apply(two));
      const WalkNodes first = boundary.enter.Apply(one), second = boundary.enter.Apply(two),
                      third = boundary.enter.Apply(three);
      const WalkKernel lobe = LobeKernel(coat, coatAlpha, base.Alpha());
      const WalkNodes scale = ScaleOf(lobe, first), ofSecond = ScaleOf(lobe, second);
      Curves& curves = curves_.emplace_back();
      for (size_t i = 0; i < kNodes; ++i) {
        curves.nodes[i] = {scale[i], scale[i] > 1e-6f ? ofSecond[i] / scale[i] : 0.0f,
                           second[i] > 1e-8f ? std::min(third[i] / second[i], 1.0f) : 0.0f, first[i]};
      }
    }
  }
}

CoatedMetalTable::Values CoatedMetalTable::Find(float cosTheta, const Slice& slice) const {
  const float position = std::min(std::sqrt(std::abs(cosTheta)), 1.0f) * (kNodes - 1);
  const int node = std::min(static_cast<int>(position), kNodes - 2);
  const float between = position - static_cast<float>(node);
  Values sum;
  const auto add = [&](int coat, int base, float weight) {
    if (!(weight > 0)) return;
    const Values &a = CurvesOf(coat, base).nodes[static_cast<size_t>(node)],
                 &b = CurvesOf(coat, base).nodes[static_cast<size_t>(node) + 1];
    sum.scale += weight * (a.scale + (b.scale - a.scale) * between);
    sum.second += weight * (a.second + (b.second - a.second) * between);
    sum.later += weight * (a.later + (b.later - a.later) * between);
    sum.albedo += weight * (a.albedo + (b.albedo - a.albedo) * between);
  };
  const float c = slice.coat.fraction, d = slice.base.fraction;
  add(slice.coat.first, slice.base.first, (1 - c) * (1 - d));
  add(slice.coat.first + 1, slice.base.first, c * (1 - d));
  add(slice.coat.first, slice.base.first + 1, (1 - c) * d);
  add(slice.coat.first + 1, slice.base.first + 1, c * d);
  return sum;
}

CoatedMetalTable::Slice CoatedMetalTable::FindSlice(float coatAlpha, float baseAlpha) const {
  const auto find = [](const std::vector<float>& alphas, float alpha) {
    return FindSliceAmong(static_cast<int>(alphas.size()), alpha,
                          [&](int i) { return alphas[static_cast<size_t>(i)]; });
  };
  return {find(coatAlphas_, coatAlpha), find(baseAlphas_, baseAlpha)};
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
