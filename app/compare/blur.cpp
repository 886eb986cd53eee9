#include "app/compare/blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/compare/estimate.h"
#include "app/compare/mean_of_images.h"
#include "app/compare/neighbourhood.h"
#include "base/error.h"
#include "film/metrics.h"
#include "integrators/photon/photon_settings.h"

namespace lampyr {

double Blur::RelativeError() const {
  return std::sqrt(isFromZero ? relMse : relMseLimit);
}

Blur Blur::Times(double factor) const {
  Blur blur = *this;
  blur.relMse *= factor * factor;
  blur.relMseLimit *= factor * factor;
  blur.mseLimit *= factor * factor;
  blur.meanLimit *= factor;
  return blur;
}

void Blur::Add(const Blur& other, double weight) {
  const Blur more = other.Times(weight);
  const auto add = [](double& a, double b) { a = std::pow(std::sqrt(a) + std::sqrt(b), 2.0); };
  add(relMse, more.relMse);
  add(relMseLimit, more.relMseLimit);
  add(mseLimit, more.mseLimit);
  meanLimit += more.meanLimit;
  isFromZero |= more.isFromZero;
}

namespace {

constexpr size_t kOfOthers = 2;  // pictures left for the divisor when two are multiplied

// The mean product of the differences i and j, and of its quotient by the neighbourhoods in all other pictures. These
// are independent of both factors, so that without a bias the expectation is 0 whatever the noise.
struct ProductOfDifferences {
  double mse = 0, relMse = 0;

  ProductOfDifferences(std::span<const Image* const> wide, std::span<const Image* const> narrow, size_t i, size_t j) {
    MeanOfImages others;
    for (size_t k = 0; k < wide.size(); ++k) {
      if (k == i || k == j) continue;
      others.Add(*wide[k]);
      others.Add(*narrow[k]);
    }
    const std::vector<std::array<double, 3>> squares = NeighbourhoodSquares(others.Mean());
    const double n = 3 * static_cast<double>(squares.size());
    size_t pixel = 0;
    for (int y = 0; y < wide[i]->height; ++y) {
      for (int x = 0; x < wide[i]->width; ++x, ++pixel) {
        const Color a = wide[i]->RgbAt(x, y) - narrow[i]->RgbAt(x, y),
                    b = wide[j]->RgbAt(x, y) - narrow[j]->RgbAt(x, y);
        const auto add = [&](float ofI, float ofJ, double square) {
          const double product = static_cast<double>(ofI) * static_cast<double>(ofJ);
          mse += product / n;
          if (square > 0) relMse += product / square / n;
        };
        add(a.r, b.r, squares[pixel][0]);
        add(a.g, b.g, squares[pixel][1]);
        add(a.b, b.b, squares[pixel][2]);
      }
    }
  }
};

// Mean over pairs, and over those without each of the items.
struct MeanOfPairs {
  size_t items;
  double all = 0;
  std::vector<double> without;

  explicit MeanOfPairs(size_t count) : items(count), without(count, 0.0) {}
  void Add(size_t i, size_t j, double value) {
    const double n = static_cast<double>(items);
    all += value / (n * (n - 1) / 2);
    for (size_t k = 0; k < items; ++k) {
      if (k != i && k != j) without[k] += value / ((n - 1) * (n - 2) / 2);
    }
  }
  SignificantEstimate Estimated() const { return JackknifeOf(all, without); }
};

}  // namespace

Blur DifferenceOfRadii(std::span<const Image* const> wide, std::span<const Image* const> narrow) {
  if (wide.size() < 2 + kOfOthers || wide.size() != narrow.size())
    throw Error("to tell a blur takes four pictures at each of two radii");
  MeanOfPairs ofMse(wide.size()), ofRelMse(wide.size());
  for (size_t i = 0; i < wide.size(); ++i) {
    for (size_t j = i + 1; j < wide.size(); ++j) {
      const ProductOfDifferences product(wide, narrow, i, j);
      ofMse.Add(i, j, product.mse);
      ofRelMse.Add(i, j, product.relMse);
    }
  }
  std::vector<double> means;
  double ofPicture = 0;
  for (size_t k = 0; k < wide.size(); ++k) {
    const double ofWide = MeanValue(*wide[k]), ofNarrow = MeanValue(*narrow[k]);
    means.push_back(ofWide - ofNarrow);
    ofPicture += 0.5 * (ofWide + ofNarrow) / static_cast<double>(wide.size());
  }
  const SignificantEstimate mse = ofMse.Estimated(), relMse = ofRelMse.Estimated(), mean = MeanOf(means);
  Blur blur;
  blur.relMse = std::max(relMse.value, 0.0);
  blur.relMseLimit = std::max(relMse.high, 0.0);
  blur.mseLimit = std::max(mse.high, 0.0);
  if (ofPicture != 0) blur.meanLimit = std::max(std::abs(mean.low), std::abs(mean.high)) / std::abs(ofPicture);
  blur.isFromZero = relMse.significant && relMse.value > 0;
  return blur;
}

// The integral of RadiusScale over the samples, each of which reaches half a sample to both sides.
double RadiusOfSamples(uint32_t first, int samples) {
  const double alpha = std::get<double>(photon_settings::kAlpha.fallback);
  const double power = 0.5 * (alpha + 1), begin = static_cast<double>(first) + 0.5;
  const double n = std::max(samples, 1);
  return (std::pow(begin + n, power) - std::pow(begin, power)) / (power * n);
}

}  // namespace lampyr
