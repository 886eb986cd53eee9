#include "app/compare/mean_of_images.h"

#include <algorithm>
#include <cmath>

namespace lampyr {

// Standard errors, because they have the range of the values; variances of very bright or dim pictures exceed that of
// floats.
const std::vector<std::string> kLayers = {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B"};

void MeanOfImages::Add(const Image& image) {
  if (images_ == 0) {
    first_ = image;
    sums_.assign(3 * Pixels(), 0.0);
    squares_.assign(3 * Pixels(), 0.0);
  }
  ++images_;
  for (size_t i = 0; i < Pixels(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const double v = static_cast<double>(image.data[i * image.channels.size() + c]);
      const double shifted = v - First(i, c);  // squares of the remainders cancel less
      sums_[3 * i + c] += shifted;
      squares_[3 * i + c] += shifted * shifted;
    }
  }
}

Image MeanOfImages::Mean() const {
  Image mean = first_;
  mean.channels = kLayers;
  mean.data.assign(6 * Pixels(), 0.0f);
  const double n = images_;
  for (size_t k = 0; k < 3 * Pixels(); ++k) {
    const double shift = sums_[k] / n;
    mean.data[k / 3 * 6 + k % 3] = static_cast<float>(First(k / 3, k % 3) + shift);
    if (images_ < 2) continue;
    mean.data[k / 3 * 6 + k % 3 + 3] =
        static_cast<float>(std::sqrt(std::max(0.0, squares_[k] / n - shift * shift) / (n - 1)));
  }
  return mean;
}

Image WeightedSum(std::span<const Image> means, std::span<const double> weights) {
  Image sum = means[0];
  for (size_t k = 0; k < sum.data.size(); ++k) {
    const bool isError = k % 6 >= 3;
    double total = 0;
    for (size_t i = 0; i < means.size(); ++i) {
      const double term = weights[i] * static_cast<double>(means[i].data[k]);
      total = isError ? std::hypot(total, term) : total + term;
    }
    sum.data[k] = static_cast<float>(total);
  }
  return sum;
}

}  // namespace lampyr
