// χ² tests of sampled directions against a density, and of counts against expectations.
//
// The horizon z = 0 of the frame in which directions are given is always a border of bins. Apart from that,
// bins follow the samples: a first set of samples splits the sphere into cells of about equal count, so that a needle
// of a lobe is resolved and no cell is nearly empty. The expected counts are integrals of the density over the cells,
// the observed ones those of a second, independent set. Whatever is no direction (absorbed, delta) is one more bin,
// expected 1 - ∫pdf.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "math/vec.h"

namespace lampyr::testing {

// Upper tail Q(a, x) = Γ(a, x)/Γ(a) of the incomplete gamma function: series below a + 1, continued fraction above
// ([Press07 §6.2]).
inline double UpperIncompleteGamma(double a, double x) {
  if (!(x > 0)) return 1;
  const double scale = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 2000 && term > sum * 1e-16; ++n) sum += term *= x / (a + n);
    return 1 - scale * sum;
  }
  constexpr double kTiny = 1e-300;
  double b = x + 1 - a, c = 1 / kTiny, d = 1 / b, h = d;
  for (int n = 1; n < 2000; ++n) {
    const double an = -n * (n - a);
    b += 2;
    d = an * d + b;
    d = 1 / (std::abs(d) < kTiny ? kTiny : d);
    c = b + an / c;
    if (std::abs(c) < kTiny) c = kTiny;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return scale * h;
}

// Probability of a χ² at least this large by chance.
inline double ChiSquaredTail(double chiSquared, int degreesOfFreedom) {
  return degreesOfFreedom > 0 ? UpperIncompleteGamma(0.5 * degreesOfFreedom, 0.5 * chiSquared) : 1.0;
}

// Level of one of `tests` so that the family of all has the given rate of false alarms ([Šidák67]).
inline double SidakLevel(int tests, double family = 1e-3) {
  return -std::expm1(std::log1p(-family) / std::max(tests, 1));
}

// p-value of counts against expected counts. Bins that expect fewer than 5 are pooled; a count where (almost) nothing
// is expected gives 0.
inline double ChiSquaredPValue(const std::vector<double>& observed, const std::vector<double>& expected) {
  double chiSquared = 0, pooledObserved = 0, pooledExpected = 0;
  int bins = 0;
  for (size_t i = 0; i < observed.size(); ++i) {
    if (expected[i] < 5) {
      pooledObserved += observed[i];
      pooledExpected += std::max(expected[i], 0.0);
      continue;
    }
    chiSquared += (observed[i] - expected[i]) * (observed[i] - expected[i]) / expected[i];
    ++bins;
  }
  if (pooledExpected >= 5) {
    chiSquared += (pooledObserved - pooledExpected) * (pooledObserved - pooledExpected) / pooledExpected;
    ++bins;
  } else if (pooledObserved > pooledExpected + 6 * std::sqrt(pooledExpected + 1)) {
    return 0;
  }
  return ChiSquaredTail(chiSquared, bins - 1);
}

// A rectangle in (cosθ, φ); area in sr.
struct SphereCell {
  double z0 = -1, z1 = 1, phi0 = -3.14159265358979323846, phi1 = 3.14159265358979323846;
  double Area() const { return (z1 - z0) * (phi1 - phi0); }
};

using SphereDensity = std::function<double(const Vector3&)>;

namespace chi_squared_internal {

inline Vector3 Direction(double z, double phi) {
  const double r = std::sqrt(std::max(0.0, (1 - z) * (1 + z)));
  return {static_cast<float>(r * std::cos(phi)), static_cast<float>(r * std::sin(phi)), static_cast<float>(z)};
}

// Gauss-Legendre, 3 × 3 points.
inline double GaussCell(const SphereDensity& density, const SphereCell& cell) {
  constexpr double kNode[3] = {-0.7745966692414834, 0, 0.7745966692414834}, kWeight[3] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double z = 0.5 * (cell.z0 + cell.z1 + kNode[i] * (cell.z1 - cell.z0));
      const double phi = 0.5 * (cell.phi0 + cell.phi1 + kNode[j] * (cell.phi1 - cell.phi0));
      sum += kWeight[i] * kWeight[j] * density(Direction(z, phi));
    }
  }
  return sum * cell.Area();
}

inline double IntegrateAdaptively(const SphereDensity& density, const SphereCell& cell, double whole, double tolerance,
                                  int depth) {
  const double z = 0.5 * (cell.z0 + cell.z1), phi = 0.5 * (cell.phi0 + cell.phi1);
  const SphereCell parts[4] = {{cell.z0, z, cell.phi0, phi},
                               {z, cell.z1, cell.phi0, phi},
                               {cell.z0, z, phi, cell.phi1},
                               {z, cell.z1, phi, cell.phi1}};
  double values[4], sum = 0;
  for (int i = 0; i < 4; ++i) sum += values[i] = GaussCell(density, parts[i]);
  if (depth <= 0 || std::abs(sum - whole) <= tolerance) return sum;
  double refined = 0;
  for (int i = 0; i < 4; ++i) refined += IntegrateAdaptively(density, parts[i], values[i], 0.5 * tolerance, depth - 1);
  return refined;
}

struct Sample {
  double z, phi;
};

// Splits by medians, alternately in z and φ, until 2^levels cells.
inline void Split(std::vector<Sample>& samples, size_t first, size_t last, const SphereCell& cell, int levels,
                  std::vector<SphereCell>& cells) {
  if (levels == 0 || last - first < 32) {
    cells.push_back(cell);
    return;
  }
  const bool inZ = levels % 2 == 0;
  const size_t middle = (first + last) / 2;
  const auto key = [&](const Sample& s) { return inZ ? s.z : s.phi; };
  std::nth_element(samples.begin() + static_cast<long>(first), samples.begin() + static_cast<long>(middle),
                   samples.begin() + static_cast<long>(last),
                   [&](const Sample& a, const Sample& b) { return key(a) < key(b); });
  SphereCell low = cell, high = cell;
  (inZ ? low.z1 : low.phi1) = (inZ ? high.z0 : high.phi0) = key(samples[middle]);
  Split(samples, first, middle, low, levels - 1, cells);
  Split(samples, middle, last, high, levels - 1, cells);
}

}  // namespace chi_squared_internal

// ∫ density over a cell, to about `tolerance`. The cell is first cut geometrically towards all its edges: a large cell
// beside a needle holds the needle's tail along one edge.
inline double IntegrateCell(const SphereDensity& density, const SphereCell& cell, double tolerance, int depth = 7) {
  constexpr double kCuts[] = {0, 1e-4, 1e-2, 0.1, 0.5, 0.9, 0.99, 1 - 1e-4, 1};
  constexpr int kParts = 8;
  double sum = 0;
  for (int i = 0; i < kParts; ++i) {
    for (int j = 0; j < kParts; ++j) {
      const double dz = cell.z1 - cell.z0, dphi = cell.phi1 - cell.phi0;
      const SphereCell part{cell.z0 + kCuts[i] * dz, cell.z0 + kCuts[i + 1] * dz, cell.phi0 + kCuts[j] * dphi,
                            cell.phi0 + kCuts[j + 1] * dphi};
      const double once = chi_squared_internal::GaussCell(density, part);
      sum += chi_squared_internal::IntegrateAdaptively(density, part, once, tolerance / kParts, depth);
    }
  }
  return sum;
}

struct ChiSquaredResult {
  double pValue = 1;
  double integral = 0;         // of the density over the sphere
  double sampledFraction = 0;  // of the draws that were directions
  size_t bins = 0;
};

// `draw` makes one sample: a unit direction, or nothing (absorbed, delta). Deterministic through its own generator.
inline ChiSquaredResult ChiSquaredTestDirections(const std::function<std::optional<Vector3>()>& draw,
                                                 const SphereDensity& density, int draws = 20000, int levels = 7) {
  using namespace chi_squared_internal;
  const auto toSample = [](const Vector3& v) {
    return Sample{static_cast<double>(std::min(std::max(v.z, -1.0f), 1.0f)),
                  std::atan2(static_cast<double>(v.y), static_cast<double>(v.x))};
  };
  std::vector<Sample> pilot;
  for (int i = 0; i < draws; ++i) {
    if (const auto v = draw()) pilot.push_back(toSample(*v));
  }
  // The horizon is always a border of cells: densities may jump there.
  const auto upper = std::partition(pilot.begin(), pilot.end(), [](const Sample& s) { return s.z < 0; });
  const size_t below = static_cast<size_t>(upper - pilot.begin());
  SphereCell lowerHalf, upperHalf;
  lowerHalf.z1 = upperHalf.z0 = 0;
  std::vector<SphereCell> cells;
  Split(pilot, 0, below, lowerHalf, levels - 1, cells);
  Split(pilot, below, pilot.size(), upperHalf, levels - 1, cells);
  std::vector<double> expected, observed(cells.size() + 1, 0.0);
  ChiSquaredResult result;
  for (const SphereCell& cell : cells) {
    const double p = IntegrateCell(density, cell, 1e-5);
    result.integral += p;
    expected.push_back(p * draws);
  }
  expected.push_back((1 - result.integral) * draws);
  int directions = 0;
  for (int i = 0; i < draws; ++i) {
    const auto v = draw();
    if (!v) {
      observed.back() += 1;
      continue;
    }
    ++directions;
    const Sample s = toSample(*v);
    for (size_t c = 0; c < cells.size(); ++c) {
      const SphereCell& cell = cells[c];
      if (s.z >= cell.z0 && s.z <= cell.z1 && s.phi >= cell.phi0 && s.phi <= cell.phi1) {
        observed[c] += 1;
        break;
      }
    }
  }
  result.sampledFraction = static_cast<double>(directions) / draws;
  result.bins = observed.size();
  result.pValue = ChiSquaredPValue(observed, expected);
  return result;
}

}  // namespace lampyr::testing
