// Transmittance of a dielectric coat, as tables made once per material.
//
// A coat is a dielectric boundary (smooth or rough, single scattering) above a gap that absorbs exp(-thickness/|cosθ|)
// per crossing: pbrt-v4 gives the gap that extinction also if its medium does not scatter, and so does lampyr.
// Tabulated are:
// - T(θ): the fraction of light from direction θ that crosses the boundary and the gap, integrated over the refracted
//   lobe (not 1 - R: energy lost by single scattering is lost). By reciprocity, T(θ)/η² is also the radiance leaving
//   along θ if the base emits radiance 1 in all directions.
// - R(θ): directional albedo of the boundary from outside, for sampling only.
// - P(θ): geometric mean of T(θ) and of the transmittance of the refracted direction on its way out, for bases that
//   preserve directions.
// - F: the fraction of the light from a diffuse base that the boundary returns to it, including both crossings of the
//   gap.
//
// Nodes are evenly spaced in sqrt(cosθ) and, for textured roughness, in sqrt(α). Anisotropic coats use sqrt(αx·αy).
#pragma once

#include <array>
#include <vector>

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

// Interreflection between a rough metal base and the boundary above it, summed over the bounces at the base, without
// the reflectance F of the metal: of light that arrives in the gap along θ' (inside), the part F^k g_k(θ') leaves after
// k bounces. Tabulated are g_2/g_1 and g_3/g_2, which stands for all later ratios. Includes total reflection at the
// boundary, shadowing loss and the absorption of the gap; a rough boundary reflects specularly, with the reflectance of
// the rough one.
class CoatBounceTable {
 public:
  struct Ratios {
    float second = 0, later = 0;
  };

  // `coat`: the boundary, of which only the middle roughness is used. `baseAlphas`: ascending.
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

// The roughnesses α of the slices for a textured roughness: 0 to 1, denser towards 0.
std::vector<float> TexturedAlphas();

// 1 + x + … + x^(terms-1): the sum over the bounces at the base, as many as "maxdepth" of pbrt-v4 allows.
float TruncatedSeries(float x, int terms);

}  // namespace lampyr
