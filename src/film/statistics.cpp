// Quantiles of the normal, the χ² and Student's distribution, accurate in the far tails, where corrections for many
// tests need them. The regularised incomplete gamma function Q(a, x) by its series (x < a + 1), or else by Lentz's
// evaluation of its continued fraction; inverses by safeguarded Newton steps on the tail.
#include <algorithm>
#include <cmath>
#include <limits>

#include "film/metrics.h"

namespace lampyr {

namespace {

constexpr double kTiny = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
constexpr int kMaxIterations = 1000000;  // the series needs on the order of √a terms

// x^a e^-x / Γ(a+1)
double GammaTerm(double a, double x) {
  return std::exp(a * std::log(x) - x - std::lgamma(a + 1));
}

double LowerBySeries(double a, double x) {
  double term = 1, sum = 1;
  for (int i = 1; i < kMaxIterations; ++i) {
    term *= x / (a + i);
    sum += term;
    if (term < sum * 1e-17) break;
  }
  return sum * GammaTerm(a, x);
}

double UpperByFraction(double a, double x) {
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, product = d;
  for (int i = 1; i < kMaxIterations; ++i) {
    const double numerator = -i * (i - a);
    b += 2;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1 / d;
    product *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return product * a * GammaTerm(a, x);
}

// Continued fraction of the regularised incomplete beta function I_x(a, b), for x < (a+1)/(a+b+2).
double BetaByFraction(double a, double b, double x) {
  double c = 1, d = 1 - (a + b) * x / (a + 1);
  d = 1 / (std::abs(d) < kTiny ? kTiny : d);
  double product = d;
  for (int m = 1; m < kMaxIterations; ++m) {
    double last = 1;
    for (const double numerator : {m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)),
                                   -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1))}) {
      d = 1 + numerator * d;
      c = 1 + numerator / c;
      d = 1 / (std::abs(d) < kTiny ? kTiny : d);
      if (std::abs(c) < kTiny) c = kTiny;
      last = c * d;
      product *= last;
    }
    if (std::abs(last - 1) < 1e-15) break;
  }
  return product;
}

double RegularisedBeta(double a, double b, double x) {
  if (!(x > 0)) return 0;
  if (x >= 1) return 1;
  const double factor =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x));
  if (x < (a + 1) / (a + b + 2)) return factor * BetaByFraction(a, b, x) / a;
  return 1 - factor * BetaByFraction(b, a, 1 - x) / b;
}

// Solves tail(x) = p for a decreasing `tail`, starting at `guess` in (0, ∞): Newton steps that stay in the bracket,
// bisection otherwise. Steps are taken on log(tail), which is nearly quadratic in the far tail.
template <class Tail, class Density>
double InvertTail(double p, double guess, Tail tail, Density density) {
  double low = 0, high = std::max(guess, 1.0);
  while (tail(high) > p) {
    low = high;
    high *= 2;
  }
  double x = std::clamp(guess, low, high);
  for (int i = 0; i < 200; ++i) {
    const double value = tail(x);
    (value > p ? low : high) = x;
    double next = x + (std::log(value) - std::log(p)) * value / density(x);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-15 * x) return next;
    x = next;
  }
  return x;
}

}  // namespace

double NormalQuantileTwoSided(double p) {
  if (p >= 1) return 0;
  p = std::max(p, std::numeric_limits<double>::min());
  const auto tail = [](double z) { return std::erfc(z / std::sqrt(2.0)); };
  const auto density = [](double z) { return std::sqrt(2 / 3.14159265358979323846) * std::exp(-0.5 * z * z); };
  return InvertTail(p, std::sqrt(-std::log(p)), tail, density);
}

double ChiSquaredTail(double value, double degrees) {
  if (!(degrees > 0)) return value > 0 ? 0 : 1;
  if (!(value > 0)) return 1;
  if (std::isinf(value)) return 0;
  const double a = 0.5 * degrees, x = 0.5 * value;
  return x < a + 1 ? std::clamp(1 - LowerBySeries(a, x), 0.0, 1.0) : std::clamp(UpperByFraction(a, x), 0.0, 1.0);
}

double ChiSquaredQuantile(double p, double degrees) {
  if (p >= 1 || !(degrees > 0)) return 0;
  p = std::max(p, std::numeric_limits<double>::min());
  // Wilson and Hilferty: (χ²/k)^(1/3) is approximately normal.
  const double z = NormalQuantileTwoSided(2 * std::min(p, 1 - p)) * (p < 0.5 ? 1 : -1);
  const double spread = 2 / (9 * degrees);
  const double root = std::max(0.01, 1 - spread + z * std::sqrt(spread));
  const double a = 0.5 * degrees;
  const auto tail = [degrees](double x) { return ChiSquaredTail(x, degrees); };
  const auto density = [a](double x) { return a * GammaTerm(a, 0.5 * x) / x; };
  return InvertTail(p, degrees * root * root * root, tail, density);
}

double StudentQuantileTwoSided(double p, double degrees) {
  if (p >= 1) return 0;
  if (degrees > 1e7) return NormalQuantileTwoSided(p);
  p = std::max(p, std::numeric_limits<double>::min());
  const double logScale =
      std::lgamma(0.5 * (degrees + 1)) - std::lgamma(0.5 * degrees) - 0.5 * std::log(degrees * 3.14159265358979323846);
  const auto tail = [&](double t) { return RegularisedBeta(0.5 * degrees, 0.5, degrees / (degrees + t * t)); };
  const auto density = [&](double t) {
    return 2 * std::exp(logScale - 0.5 * (degrees + 1) * std::log1p(t * t / degrees));
  };
  return InvertTail(p, NormalQuantileTwoSided(p), tail, density);
}

double SidakRate(double familyWiseRate, int tests) {
  if (tests <= 1) return familyWiseRate;
  return -std::expm1(std::log1p(-familyWiseRate) / tests);
}

}  // namespace lampyr
