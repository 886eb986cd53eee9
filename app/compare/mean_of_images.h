// Means of independent pictures, with their standard errors from the spread of the pictures.
#pragma once

#include <span>
#include <vector>

#include "film/image.h"

namespace lampyr {

// Mean of pictures of the same size.
class MeanOfImages {
 public:
  void Add(const Image& image);
  int Count() const { return images_; }
  // Channels R, G, B, stderr.R, stderr.G, stderr.B; standard errors are 0 for a single picture.
  Image Mean() const;

 private:
  size_t Pixels() const { return static_cast<size_t>(first_.width) * static_cast<size_t>(first_.height); }
  double First(size_t pixel, size_t channel) const {
    return static_cast<double>(first_.data[pixel * first_.channels.size() + channel]);
  }

  Image first_;
  std::vector<double> sums_, squares_;
  int images_ = 0;
};

// Σ weights[i] · means[i] of pictures as MeanOfImages makes them, independent of each other, with its standard error.
Image WeightedSum(std::span<const Image> means, std::span<const double> weights);

}  // namespace lampyr
