// Reconstruction filters with the parameters and shapes of pbrt-v4. Box and triangle are sampled in closed form;
// Gaussian, Mitchell–Netravali ([Mitchell88]) and windowed sinc from quantiles of |f|, whose parts are weighted with
// the integral of f over them, so that the weights have mean 1.
#include "film/pixel_filter.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace lampyr {
namespace {

using Kind = PixelFilterSettings::Kind;

constexpr int kParts = 2048;         // of equal ∫|f|; even, so that 0 is an edge
constexpr int kSteps = 16 * kParts;  // of the quadrature (midpoint rule)

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
  if (!(x >= -radius && x < radius)) return 0;  // half open: a splat on the border of two boxes counts once
  switch (settings.kind) {
    case Kind::Box:
      return 1;
    case Kind::Triangle:
      return radius - std::abs(x);
    case Kind::Gaussian: {
      const double scale = -0.5 / (static_cast<double>(settings.sigma) * static_cast<double>(settings.sigma));
      // exp(sx²) - exp(sr²), without cancellation for large σ, and without overflow for small σ.
      return -std::exp(scale * x * x) * std::expm1(scale * (radius * radius - x * x));
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
    axis.splatCount = settings.kind == Kind::Box ? 2 * r : 1.5 * r;
    return axis;
  }
  const double step = 2 * r / kSteps;
  if (settings.kind == Kind::Gaussian && static_cast<double>(settings.sigma) < step)
    throw Error("the pixel filter's \"sigma\" must be at least " + std::to_string(step) + ", the radius over " +
                std::to_string(kSteps / 2));
  std::vector<double> sums(kSteps + 1, 0.0), absoluteSums(kSteps + 1, 0.0);  // of f and |f| up to each step
  double squares = 0;
  for (size_t i = 0; i < kSteps; ++i) {
    const double value = AxisValue(settings, r, -r + (static_cast<double>(i) + 0.5) * step);
    sums[i + 1] = sums[i] + value;
    absoluteSums[i + 1] = absoluteSums[i] + std::abs(value);
    squares += value * value;
  }
  const double sum = sums.back(), absoluteSum = absoluteSums.back();
  axis.integral = static_cast<float>(sum * step);
  if (!(axis.integral > 0) || !(absoluteSum < 1e3 * sum)) {
    throw Error("the pixel filter has no positive integral over its radius");
  }
  axis.splatCount = absoluteSum * absoluteSum * step / squares;
  axis.squaredWeight = absoluteSum * absoluteSum / (sum * sum);
  if (settings.kind == Kind::Gaussian && radius > 2 * settings.sigma) {  // otherwise the exponentials cancel
    axis.edge = std::exp(-0.5f * Sqr(radius / settings.sigma)) / axis.integral;
  }
  double sumBefore = 0;
  for (size_t part = 0, i = 0; part <= kParts; ++part) {
    // The outermost parts end where the filter has only kTail of its mass left: a narrow Gaussian has little mass in
    // most of its radius, over which the part would be spread.
    constexpr double kTail = 1e-7;
    const double share = absoluteSum * std::clamp(static_cast<double>(part) / kParts, kTail, 1 - kTail);
    while (i + 1 < kSteps && absoluteSums[i + 1] < share) ++i;
    const double within = absoluteSums[i + 1] - absoluteSums[i];
    const double t = within > 0 ? std::clamp((share - absoluteSums[i]) / within, 0.0, 1.0) : 0.0;
    const double sumHere = sums[i] + t * (sums[i + 1] - sums[i]);
    axis.edges.push_back(std::clamp(static_cast<float>(-r + (static_cast<double>(i) + t) * step), -radius, radius));
    if (part > 0 && absoluteSum > sum) axis.weights.push_back(static_cast<float>((sumHere - sumBefore) * kParts / sum));
    sumBefore = sumHere;
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
      const float place = u * kParts;
      const size_t part = std::min(static_cast<size_t>(place), size_t{kParts - 1});
      if (!axis.weights.empty()) *weight *= axis.weights[part];
      return axis.edges[part] + (place - static_cast<float>(part)) * (axis.edges[part + 1] - axis.edges[part]);
    }
  }
}

PixelFilter::Offset PixelFilter::Sample(const Point2& u) const {
  Offset result;
  result.offset.x = SampleAxis(*x_, u.x, &result.weight);
  result.offset.y = SampleAxis(*y_, u.y, &result.weight);
  return result;
}

float PixelFilter::EvaluateAxis(const Axis& axis, float offset) const {
  if (axis.edge > 0) {  // AxisValue at a fraction of its cost: splats evaluate it often
    if (!(offset >= -axis.radius && offset < axis.radius)) return 0;
    return std::max(std::exp(-0.5f * Sqr(offset / settings_.sigma)) / axis.integral - axis.edge, 0.0f);
  }
  const double value = AxisValue(settings_, static_cast<double>(axis.radius), static_cast<double>(offset));
  return static_cast<float>(value / static_cast<double>(axis.integral));
}

}  // namespace lampyr
