// What a dielectric coat lets through, as tables made once per material.
//
// A coat is a dielectric boundary (smooth or rough, single scattering) above a gap that absorbs exp(-thickness/|cosθ|)
// per crossing: pbrt-v4 gives the gap that extinction also when its medium does not scatter, and so do we. Under it:
//   T(θ)  the fraction of light from direction θ that crosses the boundary and the gap, as an integral over the
//   refracted
//         lobe (not 1 - R: what single scattering loses is lost). By reciprocity T(θ)/η² is also the radiance that
//         leaves along θ when the base glows with radiance 1 in all directions.
//   R(θ)  directional albedo of the boundary from outside, for sampling only.
//   P(θ)  geometric mean of T(θ) and its like for the refracted direction on its way out: for bases that keep
//   directions. F     the fraction of a diffuse base's light that returns to it from the boundary, both crossings of
//   the gap included.
// All are tabulated over sqrt(cosθ) and, for textured roughness, over sqrt(α); anisotropic coats use sqrt(αx·αy).
#pragma once

#include <array>
#include <vector>

namespace lampyr {

struct CoatDescription {
  float eta = 1.5f;
  float thickness = 0.01f;
  std::vector<float> alphas;  // ascending; one for a constant roughness
};

class CoatTable {
 public:
  // Linear interpolation in the roughness: between slice `first` and the next.
  struct Slice {
    int first = 0;
    float fraction = 0;
  };

  explicit CoatTable(const CoatDescription& description);

  Slice FindSlice(float alpha) const;
  float Transmittance(float cosTheta, Slice slice) const;
  float Reflectance(float cosTheta, Slice slice) const;
  float PairTransmittance(float cosTheta, Slice slice) const;  // P
  float MeanTransmittance(Slice slice) const;                  // cosine-weighted mean of T over the hemisphere
  float InternalReflectance(Slice slice) const;                // F

 private:
  static constexpr int kNodes = 64;
  using Nodes = std::array<float, kNodes>;
  struct Curves {
    float alpha = 0;
    Nodes transmittance{}, reflectance{}, pairTransmittance{};
    float meanTransmittance = 0, internalReflectance = 0;
  };
  static Curves MakeCurves(const CoatDescription& description, float alpha);

  std::vector<Curves> slices_;
};

// Light between a rough metal base and the boundary above, summed over the bounces at the base, with the metal's own
// reflectance F left out: of light that arrives in the gap along θ' (inside), the part that leaves after k bounces is
// F^k g_k(θ'). Here are g_2/g_1 and g_3/g_2, which stands for all later ratios. Total reflection at the boundary, what
// shadowing loses and the gap are included; at a rough boundary the light is mirrored, with the rough one's
// reflectance.
class CoatBounceTable {
 public:
  struct Ratios {
    float second = 0, later = 0;
  };

  // `coat`: of the boundary, of which the middle roughness counts; `baseAlphas` ascending.
  CoatBounceTable(const CoatDescription& coat, const std::vector<float>& baseAlphas);
  Ratios FindRatios(float cosInside, CoatTable::Slice slice) const;
  CoatTable::Slice FindSlice(float alpha) const;

 private:
  static constexpr int kNodes = 64;
  using Nodes = std::array<float, kNodes>;
  struct Curves {
    Nodes second{}, later{};
  };
  static Curves MakeCurves(const Nodes& leaving, const Nodes& returning, float alpha);

  std::vector<float> alphas_;
  std::vector<Curves> slices_;
};

// Roughnesses for a table of a textured roughness: 0 to 1, denser towards 0.
std::vector<float> TexturedAlphas();

// 1 + x + … + x^(terms-1): bounces at the base, as many as pbrt-v4's "maxdepth" allows.
float TruncatedSeries(float x, int terms);

}  // namespace lampyr
