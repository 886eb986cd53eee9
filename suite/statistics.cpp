#include "suite/statistics.h"

#include <cmath>

namespace lampyr {

namespace {

// Upper regularised incomplete gamma function Q(a, x): series below a + 1, continued fraction above.
double UpperGamma(double a, double x) {
  if (std::isnan(x)) return 0;
  if (!(x > 0)) return 1;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && std::abs(term) > 1e-16 * std::abs(sum); ++n) {
      term *= x / (a + n);
      sum += term;
    }
    return std::max(0.0, 1 - front * sum);
  }
  constexpr double tiny = 1e-300;
  double b = x + 1 - a, c = 1 / tiny, d = 1 / b, fraction = d;
  for (int n = 1; n < 10000; ++n) {
    const double numerator = -n * (n - a);
    b += 2;
    d = numerator * d + b;
    d = 1 / (std::abs(d) < tiny ? tiny : d);
    c = b + numerator / c;
    if (std::abs(c) < tiny) c = tiny;
    fraction *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return front * fraction;
}

}  // namespace

double ChiSquaredTail(double statistic, int degrees) {
  return UpperGamma(0.5 * degrees, 0.5 * statistic);
}

double NormalTail(double z) {
  return std::erfc(std::abs(z) * 0.70710678118654752);
}

double ChiSquaredTest(std::span<const double> observed, std::span<const double> expected,
                      std::span<const double> errors) {
  double statistic = 0, pooledObserved = 0, pooledExpected = 0, pooledError = 0;
  int cells = 0;
  const auto add = [&](double o, double e, double error) {
    statistic += (o - e) * (o - e) / (e + error * error);
    ++cells;
  };
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] >= 5) {
      add(observed[i], expected[i], errors[i]);
    } else {
      pooledObserved += observed[i];
      pooledExpected += expected[i];
      pooledError += errors[i];
    }
  }
  if (pooledExpected + pooledError > 1e-3) {
    // Small counts are not normally distributed: one more count of variance covers the difference of the Poisson
    // distribution from the normal one.
    const double excess = pooledObserved - pooledExpected;
    statistic += excess * excess / (pooledExpected + 1 + pooledError * pooledError);
    ++cells;
  } else if (pooledObserved > 2) {
    return 0;
  }
  return cells < 2 ? 1 : ChiSquaredTail(statistic, cells - 1);
}

double SidakLevel(double familyWise, int count) {
  return count > 0 ? -std::expm1(std::log1p(-familyWise) / count) : familyWise;
}

double RunningMean::StandardError() const {
  return count_ > 1 ? std::sqrt(squares_ / (count_ - 1) / count_) : 0;
}

}  // namespace lampyr
