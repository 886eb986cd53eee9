// Transmittance of a dielectric coat, tabulated once per material.
//
// A coat is a dielectric boundary (smooth or rough, single scattering) above a gap that absorbs exp(-thickness/|cosθ|)
// per crossing: pbrt-v4 gives the gap that extinction also if its medium does not scatter, and so does lampyr.
// Tabulated are:
// - T(θ): the fraction of light from direction θ that crosses the boundary and the gap, integrated over the refracted
//   lobe (not 1 - R: energy lost by single scattering is lost). By reciprocity, T(θ)/η² is also the radiance leaving
//   along θ if the base emits radiance 1 in all directions.
// - R(θ): directional albedo of the boundary from outside, for sampling only.
// - F: the fraction of the light from a diffuse base that the boundary returns to it, including both crossings of the
//   gap.
//
// Nodes are evenly spaced in sqrt(cosθ) and, for textured roughness, in sqrt(α). Anisotropic coats use sqrt(αx·αy).
#pragma once

#include <array>
#include <vector>

#include "materials/microfacet.h"

namespace lampyr {

struct CoatDescription {
  float eta = 1.5f;
  float thickness = 0.01f;
  std::vector<float> alphas;  // ascending; a single one for constant roughness
};

class CoatTable {
 public:
  // Linear interpolation in roughness between slice `first` and the next.
  struct Slice {
    int first = 0;
    float fraction = 0;
  };

  explicit CoatTable(const CoatDescription& description);

  Slice FindSlice(float alpha) const;
  float Transmittance(float cosTheta, Slice slice) const;
  float Reflectance(float cosTheta, Slice slice) const;
  float MeanTransmittance(Slice slice) const;    // cosine-weighted mean of T over the hemisphere
  float InternalReflectance(Slice slice) const;  // F

 private:
  static constexpr int kNodes = 64;
  using Nodes = std::array<float, kNodes>;
  struct Curves {
    float alpha = 0;
    Nodes transmittance{}, reflectance{};
    float meanTransmittance = 0, internalReflectance = 0;
  };
  static Curves MakeCurves(const CoatDescription& description, float alpha);

  std::vector<Curves> slices_;
};

// A rough metal under a coat: the random walk between the two, without the reflectance F of the metal. Of light that
// arrives from outside along θ, the fraction F^k a_k(θ) leaves after k bounces at the base. It includes total
// reflection at the boundary, shadowing loss and the absorption of the gap. Tabulated are a_1; the scale C for which
// the lobe of one bounce, C(wo) C(wi) times the lobe of a widened base between directions that are refracted at a flat
// boundary, has the albedo a_1 from all directions; the scale of a lobe with the albedo a_2, over C (`second`); and
// a_3/a_2, which approximates all later ratios (`later`).
class CoatedMetalTable {
 public:
  struct Values {
    float scale = 0, second = 0, later = 0, albedo = 0;
  };
  // Interpolation in the roughness of the coat and of the base.
  struct Slice {
    CoatTable::Slice coat, base;
  };

  // `baseAlphas`: ascending.
  CoatedMetalTable(const CoatDescription& coat, const std::vector<float>& baseAlphas);
  Values Find(float cosTheta, const Slice& slice) const;
  Slice FindSlice(float coatAlpha, float baseAlpha) const;

 private:
  static constexpr int kNodes = 64;
  struct Curves {
    std::array<Values, kNodes> nodes;
  };
  const Curves& CurvesOf(int coat, int base) const {
    return curves_[static_cast<size_t>(coat) * baseAlphas_.size() + static_cast<size_t>(base)];
  }

  std::vector<float> coatAlphas_, baseAlphas_;
  std::vector<Curves> curves_;  // by coat, then by base
};

// The lobe of a base, widened by the two refractions at a rough coat: α² = α_base² + 2 (α_coat (1 - 1/η)/2)².
TrowbridgeReitz WidenedBase(const TrowbridgeReitz& base, const TrowbridgeReitz& coat, float eta);

// The roughnesses α of the slices for a textured roughness: 0 to 1, denser towards 0.
std::vector<float> TexturedAlphas();

// 1 + x + … + x^(terms-1): the sum over the bounces at the base, up to the number that "maxdepth" of pbrt-v4 allows.
float TruncatedSeries(float x, int terms);

}  // namespace lampyr
