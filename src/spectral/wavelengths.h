// The wavelengths of a pass, for transport by wavelength instead of by red, green and blue.
//
// A pass has three wavelengths. A Color then holds values at these: lane 0, 1 and 2 are its r, g and b. All spectra on
// a path are evaluated there, so that integrators need no second version. Radiance is relative to that of the white of
// the picture (D65): an RGB light and an RGB reflectance are upsampled alike, and white is 1 at all wavelengths.
//
// The wavelengths change from pass to pass and are the same for all paths of a pass, so that photons and the camera
// paths that gather them agree.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <glm/mat3x3.hpp>

#include "math/vec.h"
#include "spectral/spectral_curve.h"

namespace lampyr {

// A range of wavelengths, nm, within [SpectralCurve::kFirst, SpectralCurve::kLast].
struct WavelengthRange {
  double from = 0, to = 0;
};

class Wavelengths {
 public:
  static constexpr int kLanes = 3;

  // The wavelengths for u, in [0,1): u/3, (u + 1)/3 and (u + 2)/3 by the inverse of the integral of a smooth density
  // that is large where the eye is sensitive. `even`: a range whose spectrum is recorded, over which half of the
  // density is uniform.
  explicit Wavelengths(double u, const std::optional<WavelengthRange>& even = std::nullopt);
  // The wavelengths of a pass, in an order that is regular after 2^n passes. `seed` moves all of them.
  static Wavelengths OfPass(uint64_t seed, uint64_t pass, const std::optional<WavelengthRange>& even = std::nullopt);

  double operator[](int lane) const { return wavelengths_[static_cast<size_t>(lane)]; }  // nm

  // 1 / (density of the wavelength of a lane), nm: the sum over lanes of f · PerDensity is an estimate of ∫ f dλ.
  double PerDensity(int lane) const { return perDensity_[static_cast<size_t>(lane)]; }

  // A colour in linear Rec. 709, of a surface or of light, at these wavelengths. Gray stays exactly gray. Components
  // are convex combinations of the colour's.
  Color FromRgb(const Color& rgb) const;
  // A curve at these wavelengths.
  Color At(const SpectralCurve& curve) const;
  // From the lanes to linear Rec. 709: an estimate, whose expectation over u is the colour. Components may be negative.
  const glm::mat3& ToRgb() const { return toRgb_; }
  // White (1 in every lane) after ToRgb, by channel. The mean over many passes is 1.
  const std::array<double, 3>& White() const { return white_; }

 private:
  std::array<double, kLanes> wavelengths_{}, perDensity_{};
  std::array<Color, kLanes> basis_{};  // by lane: weights of red, green and blue
  glm::mat3 toRgb_{1.0f};
  std::array<double, 3> white_{};
};

// The spectrum of the white of the picture, which is 1 in every lane: D65, with ∫ S ȳ dλ = ∫ ȳ dλ.
double WhiteSpectrum(double wavelength);

// The colour in linear Rec. 709 of light that is `curve` relative to D65; components may be negative.
Vector3d ColorOf(const SpectralCurve& relativeToWhite);

// The reflectance, in [0,1], of a unit of red, green or blue: three functions that add up to 1 and are as smooth as the
// colours of the primaries under D65 allow ([Mallett19]). Wavelength in nm.
Color UpsamplingBasis(double wavelength);

}  // namespace lampyr
