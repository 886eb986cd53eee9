#include "app/compare/blur.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "app/compare/estimate.h"
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

constexpr size_t kOfOthers = 2;  // pictures that remain for the divisor when two are multiplied

// Differences of pictures, and the divisors of their products.
class Differences {
 public:
  Differences(std::span<const Image* const> wide, std::span<const Image* const> narrow) : wide_(wide), narrow_(narrow) {
    sum_ = Sum(0);
    for (size_t k = 1; k < wide.size(); ++k) {
      const Image more = Sum(k);
      for (size_t i = 0; i < sum_.data.size(); ++i) sum_.data[i] += more.data[i];
    }
  }

  // The mean product of the differences i and j, and of its quotient by the neighbourhoods in all other pictures. These
  // are independent of both factors, so that without a bias the expectation is 0 for any distribution of the noise.
  struct Product {
    double mse = 0, relMse = 0;
  };
  Product Of(size_t i, size_t j) const {
    Image others = sum_;
    const Image ofI = Sum(i), ofJ = Sum(j);
    const auto count = static_cast<float>(2 * (wide_.size() - 2));
    for (size_t k = 0; k < others.data.size(); ++k)
      others.data[k] = std::max(0.0f, others.data[k] - ofI.data[k] - ofJ.data[k]) / count;
    const std::vector<std::array<double, 3>> squares = NeighbourhoodSquares(others);
    const double n = 3 * static_cast<double>(squares.size());
    Product mean;
    size_t pixel = 0;
    for (int y = 0; y < others.height; ++y) {
      for (int x = 0; x < others.width; ++x, ++pixel) {
        const Color a = wide_[i]->RgbAt(x, y) - narrow_[i]->RgbAt(x, y),
                    b = wide_[j]->RgbAt(x, y) - narrow_[j]->RgbAt(x, y);
        const auto add = [&](float first, float second, double square) {
          const double product = static_cast<double>(first) * static_cast<double>(second);
          mean.mse += product / n;
          if (square > 0) mean.relMse += product / square / n;
        };
        add(a.r, b.r, squares[pixel][0]);
        add(a.g, b.g, squares[pixel][1]);
        add(a.b, b.b, squares[pixel][2]);
      }
    }
    return mean;
  }

 private:
  // wide[k] + narrow[k].
  Image Sum(size_t k) const {
    Image sum(wide_[k]->width, wide_[k]->height, {"R", "G", "B"});
    for (int y = 0; y < sum.height; ++y) {
      for (int x = 0; x < sum.width; ++x) {
        const Color color = wide_[k]->RgbAt(x, y) + narrow_[k]->RgbAt(x, y);
        sum.At(x, y, 0) = color.r;
        sum.At(x, y, 1) = color.g;
        sum.At(x, y, 2) = color.b;
      }
    }
    return sum;
  }

  std::span<const Image*const> wide_, narrow_;
  Image sum_;
};

// Mean over pairs, and over the pairs without each of the items.
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
  const Differences differences(wide, narrow);
  for (size_t i = 0; i < wide.size(); ++i) {
    for (size_t j = i + 1; j < wide.size(); ++j) {
      const Differences::Product product = differences.Of(i, j);
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
  // The bound of a one-sided interval, from the two-sided one.
  const double degrees = static_cast<double>(wide.size()) - 1;
  const double oneSided = StudentQuantileTwoSided(0.1, degrees) / StudentQuantileTwoSided(0.05, degrees);
  const auto limit = [&](const SignificantEstimate& estimate) {
    return std::max(estimate.value + oneSided * (estimate.high - estimate.value), 0.0);
  };
  const SignificantEstimate mse = ofMse.Estimated(), relMse = ofRelMse.Estimated(), mean = MeanOf(means);
  Blur blur;
  blur.relMse = std::max(relMse.value, 0.0);
  blur.relMseLimit = limit(relMse);
  blur.mseLimit = limit(mse);
  if (ofPicture != 0) blur.meanLimit = std::max(std::abs(mean.low), std::abs(mean.high)) / std::abs(ofPicture);
  blur.isFromZero = relMse.significant && relMse.value > 0;
  return blur;
}

// The integral of RadiusScale over the samples, each of which extends half a sample to both sides.
double RadiusOfSamples(uint32_t first, int samples) {
  const double alpha = std::get<double>(photon_settings::kAlpha.fallback);
  const double power = 0.5 * (alpha + 1), begin = static_cast<double>(first) + 0.5;
  const double n = std::max(samples, 1);
  return (std::pow(begin + n, power) - std::pow(begin, power)) / (power * n);
}

}  // namespace lampyr
