// Reconstruction filters. Camera samples use filter importance sampling ([Ernst06]): a sample belongs to one pixel
// only, so that pixels are independent, a crop of a render equals a cropped render, and threads never share a pixel.
// Splats, whose film point is not chosen, are weighted with the value of the filter.
#pragma once

#include <memory>
#include <vector>

#include "math/vec.h"

namespace lampyr {

struct PixelFilterSettings {
  enum class Kind { Box, Triangle, Gaussian, Mitchell, Sinc };
  Kind kind = Kind::Gaussian;
  float radiusX = 1.5f, radiusY = 1.5f;  // pixels
  float sigma = 0.5f;                    // gaussian
  float b = 1.0f / 3, c = 1.0f / 3;      // mitchell
  float tau = 3;                         // sinc
};

// A reconstruction filter. All kinds are separable; each axis is sampled on its own.
class PixelFilter {
 public:
  // Throws an Error if a radius is not positive, or if the filter has no positive integral.
  explicit PixelFilter(const PixelFilterSettings& settings);

  struct Offset {
    Vector2 offset;    // from the pixel's centre, pixels
    float weight = 1;  // mean 1: exactly 1 if f >= 0 everywhere, otherwise ±∫|f|/∫f except at sign changes
  };
  // u in [0,1)².
  Offset Sample(const Point2& u) const;
  // Value at an offset, normalised to ∫ = 1 (for splats); 0 outside of the radius.
  float Evaluate(const Vector2& offset) const { return EvaluateX(offset.x) * EvaluateY(offset.y); }
  // The factors along each axis, each normalised to ∫ = 1.
  float EvaluateX(float offset) const { return EvaluateAxis(*x_, offset); }
  float EvaluateY(float offset) const { return EvaluateAxis(*y_, offset); }
  // Sample count of splats in weights: the number of samples with weights as in Sample, one per pixel, whose mean has
  // the variance of one splat. A splat is spread over all pixels in whose filter it is, on average (∫|f|)² / ∫f² of
  // them (∫f = 1). Box of a pixel's width: 1; Gaussian of σ = 0.5: 3.
  double SplatCount() const { return x_->splatCount * y_->splatCount; }
  // The mean of Offset::weight²: (∫|f|)², 1 if f >= 0 everywhere.
  double SquaredWeight() const { return x_->squaredWeight * y_->squaredWeight; }
  // Half the extent of the filter, pixels.
  Vector2 Radius() const { return {settings_.radiusX, settings_.radiusY}; }

 private:
  // The filter along one axis. For kinds without closed-form inversion, [-radius, radius], but for the ends with 1e-7 of
  // ∫|f|, is divided at `edges` into parts with equal shares of ∫|f|: one look-up maps a random number to an offset.
  struct Axis {
    float radius = 0;
    float integral = 1;        // of f
    double splatCount = 1;     // (∫|f|)² / ∫f²
    double squaredWeight = 1;  // (∫|f|)² / (∫f)²
    float edge = 0;            // narrow Gaussian: exp(-r²/2σ²) over the integral
    std::vector<float> edges;
    std::vector<float> weights;  // per part: its share of ∫f over its share of ∫|f|; empty if f >= 0
  };
  static Axis MakeAxis(const PixelFilterSettings& settings, float radius);
  float SampleAxis(const Axis& axis, float u, float* weight) const;
  float EvaluateAxis(const Axis& axis, float offset) const;

  PixelFilterSettings settings_;
  std::shared_ptr<const Axis> x_, y_;
};

}  // namespace lampyr
