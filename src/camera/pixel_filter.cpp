// Reconstruction filters with pbrt-v4's parameters and shapes. Box and triangle are sampled in closed form; Gaussian,
// Mitchell–Netravali ([Mitchell88]) and windowed sinc from a fine table of |f|, whose intervals hold the exact integral
// of f up to quadrature, so that the weights' mean is 1.
#include "camera/pixel_filter.h"

#include <cmath>

#include "base/error.h"

namespace lampyr {
namespace {

using Kind = PixelFilterSettings::Kind;

constexpr int kTableSize = 2048;       // intervals of a table, an even number: 0 lies between two
constexpr int kPointsPerInterval = 4;  // midpoint rule

double Sinc(double x) {
  const double t = x * 3.14159265358979323846;
  return std::abs(t) < 1e-5 ? 1 - t * t / 6 : std::sin(t) / t;
}

// [Mitchell88 eq. 8], scaled by 6; support [-2, 2].
double Mitchell(double x, double b, double c) {
  x = std::abs(x);
  if (x <= 1) return ((12 - 9 * b - 6 * c) * x + (-18 + 12 * b + 6 * c)) * x * x + (6 - 2 * b);
  if (x >= 2) return 0;
  return (((-b - 6 * c) * x + (6 * b + 30 * c)) * x + (-12 * b - 48 * c)) * x + (8 * b + 24 * c);
}

// The filter along one axis, not normalised.
double AxisValue(const PixelFilterSettings& settings, double radius, double x) {
  if (!(x >= -radius && x < radius)) return 0;  // half open: a splat on the border of two boxes belongs to one
  switch (settings.kind) {
    case Kind::Box:
      return 1;
    case Kind::Triangle:
      return radius - std::abs(x);
    case Kind::Gaussian: {
      const double scale = -0.5 / (static_cast<double>(settings.sigma) * static_cast<double>(settings.sigma));
      // exp(sx²) - exp(sr²), without cancellation when σ is large.
      return std::exp(scale * radius * radius) * std::expm1(scale * (x * x - radius * radius));
    }
    case Kind::Mitchell:
      return Mitchell(2 * x / radius, static_cast<double>(settings.b), static_cast<double>(settings.c));
    case Kind::Sinc:
      return Sinc(x) * Sinc(x / static_cast<double>(settings.tau));
  }
  return 0;
}

bool IsClosed(Kind kind) {
  return kind == Kind::Box || kind == Kind::Triangle;
}

}  // namespace

PixelFilter::Axis PixelFilter::MakeAxis(const PixelFilterSettings& settings, float radius) {
  if (!(radius > 0) || !(radius < kInfinity)) throw Error("a pixel filter's radius must be a positive number");
  Axis axis;
  axis.radius = radius;
  const double r = static_cast<double>(radius);
  if (IsClosed(settings.kind)) {
    axis.integral = settings.kind == Kind::Box ? 2 * radius : radius * radius;
    return axis;
  }
  const double step = 2 * r / kTableSize;
  double sum = 0, absoluteSum = 0;
  std::vector<float> magnitudes(kTableSize);
  axis.signs.resize(kTableSize);
  for (int i = 0; i < kTableSize; ++i) {
    double mean = 0;
    for (int k = 0; k < kPointsPerInterval; ++k) {
      mean += AxisValue(settings, r, -r + (i + (k + 0.5) / kPointsPerInterval) * step) / kPointsPerInterval;
    }
    magnitudes[static_cast<size_t>(i)] = static_cast<float>(std::abs(mean));
    axis.signs[static_cast<size_t>(i)] = mean < 0 ? -1 : 1;
    sum += mean;
    absoluteSum += std::abs(mean);
  }
  axis.table = Distribution1D(magnitudes);
  axis.integral = static_cast<float>(sum * step);
  axis.absoluteRatio = static_cast<float>(absoluteSum / sum);
  if (!(axis.integral > 0) || !(axis.absoluteRatio < 1e3f) || axis.table.IsZero()) {
    throw Error("the pixel filter has no positive integral over its radius");
  }
  return axis;
}

PixelFilter::PixelFilter(const PixelFilterSettings& settings)
    : settings_(settings), x_(std::make_shared<Axis>(MakeAxis(settings, settings.radiusX))) {
  y_ = settings.radiusY == settings.radiusX ? x_ : std::make_shared<Axis>(MakeAxis(settings, settings.radiusY));
}

float PixelFilter::SampleAxis(const Axis& axis, float u, float* weight) const {
  switch (settings_.kind) {
    case Kind::Box:
      return axis.radius * (2 * u - 1);
    case Kind::Triangle:
      return u < 0.5f ? axis.radius * (std::sqrt(2 * u) - 1) : axis.radius * (1 - std::sqrt(2 * (1 - u)));
    default: {
      const Distribution1D::Result sample = axis.table.Sample(u);
      *weight *= axis.absoluteRatio * static_cast<float>(axis.signs[sample.index]);
      return axis.radius * (2 * sample.x - 1);
    }
  }
}

PixelFilter::Offset PixelFilter::Sample(const Point2& u) const {
  Offset result;
  result.offset.x = SampleAxis(*x_, u.x, &result.weight);
  result.offset.y = SampleAxis(*y_, u.y, &result.weight);
  return result;
}

float PixelFilter::Evaluate(const Vector2& offset) const {
  const double x = AxisValue(settings_, static_cast<double>(x_->radius), static_cast<double>(offset.x));
  const double y = AxisValue(settings_, static_cast<double>(y_->radius), static_cast<double>(offset.y));
  return static_cast<float>(x / static_cast<double>(x_->integral) * (y / static_cast<double>(y_->integral)));
}

}  // namespace lampyr
