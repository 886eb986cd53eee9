// Does a histogram come from the distribution it should? Pearson's χ² with its exact tail.
#pragma once

#include <cmath>
#include <vector>

namespace lampyr::test {

// Per-test level: about a thousand such tests in the whole suite share a family-wise error of 1e-3 (Šidák).
inline constexpr double kSignificance = 1e-6;

// Q(a, x), the regularised upper incomplete gamma function: by series below a + 1, by Lentz's continued fraction above.
inline double UpperGamma(double a, double x) {
  if (x <= 0) return 1;
  const double factor = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1 - sum * factor;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int n = 1; n < 10000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return factor * h;
}

// The probability of a fit at least this bad. Cells that expect fewer than 5 are pooled; a count where none is expected
// is impossible and gives 0.
inline double HistogramPValue(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0, pooledCount = 0, pooledExpected = 0;
  int cells = 0;
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] == 0 && counts[i] > 0) return 0;
    if (expected[i] < 5) {
      pooledCount += counts[i];
      pooledExpected += expected[i];
      continue;
    }
    statistic += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    ++cells;
  }
  if (pooledExpected >= 5) {
    statistic += (pooledCount - pooledExpected) * (pooledCount - pooledExpected) / pooledExpected;
    ++cells;
  }
  return cells < 2 ? 1 : UpperGamma(0.5 * (cells - 1), 0.5 * statistic);
}

}  // namespace lampyr::test
