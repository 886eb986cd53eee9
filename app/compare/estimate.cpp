#include "app/compare/estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "film/metrics.h"

namespace lampyr {

namespace {

using Limits = std::numeric_limits<double>;
constexpr double kOutside = 0.05;  // 95 %

// exp(log(value) ± t · deviation).
Estimate OnLogScale(double value, double deviation, double degrees) {
  if (!(degrees > 0)) return {value, 0, Limits::infinity()};
  const double factor = std::exp(StudentQuantileTwoSided(kOutside, degrees) * deviation);
  return {value, value / factor, value * factor};
}

}  // namespace

Moments MomentsOf(std::span<const double> values) {
  const double n = static_cast<double>(values.size());
  Moments moments;
  for (const double v : values) moments.mean += v;
  moments.mean /= std::max(n, 1.0);
  if (values.size() < 2) return moments;
  for (const double v : values) moments.varianceOfMean += (v - moments.mean) * (v - moments.mean) / (n * (n - 1));
  return moments;
}

std::optional<Estimate> MeanOnLogScale(std::span<const double> values, double otherError) {
  const Moments m = MomentsOf(values);
  if (!(m.mean > 0)) return std::nullopt;
  return OnLogScale(m.mean, std::sqrt(m.varianceOfMean + otherError * otherError) / m.mean,
                    static_cast<double>(values.size()) - 1);
}

std::optional<Estimate> RatioOfMeans(std::span<const double> a, std::span<const double> b) {
  const Moments first = MomentsOf(a), second = MomentsOf(b);
  if (!(first.mean > 0) || !(second.mean > 0)) return std::nullopt;
  const double va = first.varianceOfMean / (first.mean * first.mean);
  const double vb = second.varianceOfMean / (second.mean * second.mean);
  const double na = static_cast<double>(a.size()) - 1, nb = static_cast<double>(b.size()) - 1;
  double degrees = std::min(na, nb);
  if (degrees > 0 && va + vb > 0) degrees = (va + vb) * (va + vb) / (va * va / na + vb * vb / nb);
  return OnLogScale(first.mean / second.mean, std::sqrt(va + vb), degrees);
}

SignificantEstimate JackknifeOf(double value, std::span<const double> without, double otherError) {
  const double n = static_cast<double>(without.size());
  std::vector<double> pseudoValues;  // the error of their mean is the jackknife's
  for (const double one : without) pseudoValues.push_back(n * value - (n - 1) * one);
  if (pseudoValues.empty()) pseudoValues.push_back(value);
  SignificantEstimate estimate = MeanOf(pseudoValues, otherError);
  estimate.value = value;
  return estimate;
}

SignificantEstimate MeanOf(std::span<const double> values, double otherError) {
  const Moments m = MomentsOf(values);
  SignificantEstimate estimate;
  estimate.value = m.mean;
  if (values.size() < 2) {
    estimate.low = -Limits::infinity();
    estimate.high = Limits::infinity();
    return estimate;
  }
  const double t = StudentQuantileTwoSided(kOutside, static_cast<double>(values.size()) - 1);
  const double half = t * std::sqrt(m.varianceOfMean + otherError * otherError);
  estimate.low = m.mean - half;
  estimate.high = m.mean + half;
  constexpr double byChance = 0.01;  // a verdict in words needs more than an interval
  const double certain = StudentQuantileTwoSided(byChance, static_cast<double>(values.size()) - 1) / t;
  estimate.significant = std::abs(m.mean) > certain * half;
  return estimate;
}

}  // namespace lampyr
