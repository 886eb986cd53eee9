#include "app/compare/spectrum.h"

#include <algorithm>
#include <cmath>

#include "app/compare/estimate.h"
#include "app/compare/fourier.h"
#include "film/metrics.h"

namespace lampyr {

namespace {

using Complex = std::complex<double>;

// The ring of each frequency of a picture, in the order of its transform.
struct Rings {
  std::vector<size_t> of;
  std::vector<double> frequency;  // mean
  std::vector<double> count;

  Rings(int width, int height) {
    const double lowest = 1.0 / std::max(width, height), highest = std::sqrt(0.5);
    std::vector<double> ends = {0.5 * lowest};
    while (ends.back() <= highest) ends.push_back(std::max(ends.back() + lowest, 1.12 * ends.back()));
    frequency.assign(ends.size(), 0.0);
    count.assign(ends.size(), 0.0);
    const auto wrapped = [](int k, int n) { return static_cast<double>(std::min(k, n - k)) / n; };
    for (int v = 0; v < height; ++v) {
      for (int u = 0; u < width; ++u) {
        const double f = std::hypot(wrapped(u, width), wrapped(v, height));
        const auto ring = static_cast<size_t>(std::upper_bound(ends.begin(), ends.end(), f) - ends.begin());
        of.push_back(ring);
        frequency[ring] += f;
        ++count[ring];
      }
    }
    for (size_t i = 0; i < count.size(); ++i) frequency[i] /= std::max(count[i], 1.0);
  }
};

// The transform of the error of a channel, relative as in relMSE.
std::vector<Complex> TransformOfError(const Image& image, const Image& reference, const std::vector<Color>& divisors,
                                      int channel, int threads) {
  const auto of = [channel](const Color& color) {
    return static_cast<double>(channel == 0 ? color.r : channel == 1 ? color.g : color.b);
  };
  std::vector<Complex> error;
  error.reserve(divisors.size());
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double divisor = of(divisors[error.size()]);
      const double difference = of(image.RgbAt(x, y)) - of(reference.RgbAt(x, y));
      error.emplace_back(divisor > 0 ? difference / divisor : 0.0);
    }
  }
  TransformPicture(error, image.width, image.height, threads);
  return error;
}

double Percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  const double at = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<size_t>(at);
  const size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace

std::vector<SpectrumRing> ErrorSpectrum(std::span<const Image* const> images, const Image& reference,
                                        double referenceNoise, int threads) {
  const Rings rings(reference.width, reference.height);
  const size_t frequencies = rings.of.size(), count = rings.count.size();
  const double pixels = static_cast<double>(frequencies), renders = static_cast<double>(images.size());
  const std::vector<Color> divisors = RelativeErrorDivisors(reference);
  std::vector<std::vector<double>> powers(images.size(), std::vector<double>(count, 0.0));
  std::vector<double> ofSum(count, 0.0);
  const double unit = 1 / (3 * pixels * pixels);
  for (int channel = 0; channel < 3; ++channel) {
    std::vector<Complex> sum(frequencies);
    for (size_t k = 0; k < images.size(); ++k) {
      const std::vector<Complex> error = TransformOfError(*images[k], reference, divisors, channel, threads);
      for (size_t i = 0; i < frequencies; ++i) {
        powers[k][rings.of[i]] += unit * std::norm(error[i]);
        sum[i] += error[i];
      }
    }
    for (size_t i = 0; i < frequencies; ++i) ofSum[rings.of[i]] += unit * std::norm(sum[i]);
  }
  std::vector<SpectrumRing> spectrum;
  for (size_t ring = 0; ring < count; ++ring) {
    if (rings.count[ring] == 0) continue;
    const double perDensity = rings.count[ring] / pixels;
    std::vector<double> densities;
    double squares = 0;
    for (const std::vector<double>& power : powers) {
      squares += power[ring];
      densities.push_back(power[ring] / perDensity - referenceNoise);
    }
    const Moments moments = MomentsOf(densities);
    SpectrumRing one;
    one.frequency = rings.frequency[ring];
    one.density = moments.mean;
    one.share = moments.mean * perDensity;
    one.low = Percentile(densities, 0.1);
    one.high = Percentile(densities, 0.9);
    one.deviation = std::sqrt(moments.varianceOfMean * renders);
    one.common = (ofSum[ring] - squares) / (renders * (renders - 1)) / perDensity - referenceNoise;
    spectrum.push_back(one);
  }
  return spectrum;
}

}  // namespace lampyr
