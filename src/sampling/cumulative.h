// Cumulative tables of the distributions in sampling/: construction, search and inversion. A Cdf is a pointer to
// floats, or anything else with operator[], of n + 1 entries for n intervals.
//
// The tables count in units of 2^-24, the step of a random float: an interval is chosen exactly in proportion to its
// density, and every nonzero interval can be chosen, however small beside the others. The search starts from a guide
// table ([Chen74]), which holds the intervals that contain equal steps of u.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "math/vec.h"

namespace lampyr::cumulative {

inline constexpr int64_t kUnits = int64_t{1} << 24;  // a cdf counts in 1/kUnits
inline constexpr uint32_t kIntervalsPerGuideStep = 16;

inline double Cleaned(float value) {
  return value > 0 && value < kInfinity ? static_cast<double>(value) : 0.0;
}

inline float ClampedUnit(float u) {
  return u > 0 ? std::min(u, kOneMinusEpsilon) : 0.0f;
}

// Index of the interval that contains x, of n equal intervals of [0,1].
inline int IntervalAt(float x, int n) {
  return std::min(static_cast<int>(static_cast<double>(ClampedUnit(x)) * n), n - 1);
}

// The float nearest to (interval + t)/n that IntervalAt maps back to `interval`.
inline float PointInInterval(int interval, float t, int n) {
  const float x = ClampedUnit(static_cast<float>((interval + static_cast<double>(t)) / n));
  const int found = IntervalAt(x, n);
  if (found == interval) return x;
  return std::nextafter(x, found < interval ? 1.0f : 0.0f);
}

// Number of steps for a table that does not fit the cache: the guide has to fit, and the intervals between two of its
// steps have to lie in a few cache lines.
inline size_t GuideSteps(size_t n) {
  return std::max<size_t>(1, n / kIntervalsPerGuideStep);
}
// Number of steps for a small table, which leaves hardly any search.
inline size_t FineGuideSteps(size_t n) {
  return 2 * n;
}

// Writes the n + 1 entries of the CDF of `values`, whose sum (after Cleaned) is `sum` > 0.
template <class Cdf>
void WriteCdf(std::span<const float> values, double sum, Cdf cdf) {
  int64_t remaining = 0;  // nonzero intervals that still need a unit
  for (const float v : values) remaining += Cleaned(v) > 0;
  const double scale = static_cast<double>(kUnits) / sum;
  double cumulative = 0;
  int64_t units = 0;
  cdf[0] = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    const double value = Cleaned(values[i]);
    if (value > 0) {
      --remaining;
      cumulative += value;
      const int64_t target = remaining == 0 ? kUnits : static_cast<int64_t>(cumulative * scale + 0.5);
      units = std::max(units, std::min(std::max(target, units + 1), kUnits - remaining));
    }
    cdf[i + 1] = static_cast<float>(units) * (1.0f / kUnits);
  }
}

// guide[k] is the interval that contains u = k/steps, shifted right by `shift`; the last entry is the last nonempty
// interval.
template <class Cdf, class Entry>
void WriteGuide(Cdf cdf, size_t n, size_t steps, Entry* guide, int shift = 0) {
  uint32_t interval = 0;
  for (size_t k = 0; k <= steps; ++k) {
    const float u = std::min(static_cast<float>(k) / static_cast<float>(steps), kOneMinusEpsilon);
    while (interval + 1 < n && cdf[interval + 1] <= u) ++interval;
    guide[k] = static_cast<Entry>(interval >> shift);
  }
}

struct Range {
  uint32_t low, high;  // inclusive
};

// The range of intervals that the guide leaves to be searched for u, of n.
template <class Entry>
Range GuidedRange(const Entry* guide, size_t steps, size_t n, float u, int shift = 0) {
  const size_t k = std::min(static_cast<size_t>(u * static_cast<float>(steps)), steps - 1);
  const uint32_t low = static_cast<uint32_t>(guide[k]) << shift;
  const uint32_t high = (static_cast<uint32_t>(guide[k + 1]) << shift) + ((1u << shift) - 1);
  return {low, std::min(high, static_cast<uint32_t>(n) - 1)};
}

// The interval with cdf[i] <= u < cdf[i + 1], which is never an empty one.
template <class Cdf>
uint32_t FindInterval(Cdf cdf, Range range, size_t n, float u) {
  auto [low, high] = range;
  // The step of the guide follows from a rounded product: widen in the rare case that u is just outside of the range.
  if (cdf[low] > u) low = 0;
  if (cdf[high + 1] <= u) high = static_cast<uint32_t>(n) - 1;
  // The last interval that starts at or below u, by a search without data-dependent branches, which would be
  // mispredicted.
  uint32_t count = high - low + 1;
  while (count > 1) {
    const uint32_t half = count / 2;
    low += static_cast<uint32_t>(cdf[low + half] <= u) * half;
    count -= half;
  }
  return low;
}

struct Found {
  uint32_t interval;
  float t;  // position within the interval, [0,1)
};

template <class Cdf>
Found SampleCdf(Cdf cdf, Range range, size_t n, float u) {
  const uint32_t i = FindInterval(cdf, range, n, u);
  return {i, std::min((u - cdf[i]) / (cdf[i + 1] - cdf[i]), kOneMinusEpsilon)};
}

template <class Cdf>
float IntervalDensity(Cdf cdf, size_t i, size_t n) {
  return (cdf[i + 1] - cdf[i]) * static_cast<float>(n);
}

template <class Cdf>
float InvertCdf(Cdf cdf, int n, float x) {
  const int i = IntervalAt(x, n);
  const float t = static_cast<float>(static_cast<double>(ClampedUnit(x)) * n - i);
  return ClampedUnit(cdf[i] + t * (cdf[i + 1] - cdf[i]));
}

// Sums that may exceed the range of float, divided by the largest; positive ones stay above 0.
inline std::vector<float> InRangeOfFloat(std::span<const double> sums) {
  const double largest = sums.empty() ? 0 : *std::max_element(sums.begin(), sums.end());
  std::vector<float> scaled;
  for (const double sum : sums)
    scaled.push_back(sum > 0 ? std::max(static_cast<float>(sum / largest), std::numeric_limits<float>::min()) : 0.0f);
  return scaled;
}

// The shift that makes n intervals fit the 16-bit entries of a guide.
inline int GuideShift(size_t n) {
  int shift = 0;
  while ((n - 1) >> shift > 0xffff) ++shift;
  return shift;
}

}  // namespace lampyr::cumulative
