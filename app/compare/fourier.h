// Discrete Fourier transforms of pictures of any size.
#pragma once

#include <complex>
#include <vector>

namespace lampyr {

// X_k = Σ_j x_j exp(-2πi jk/n) of any length n, by mixed radices: n Σ p steps for the prime factors p of n, so that
// only a length with a large prime factor takes long ([Cooley65]).
class FourierTransform {
 public:
  explicit FourierTransform(int length);
  void Apply(const std::complex<double>* in, std::complex<double>* out) const;

 private:
  void Apply(const std::complex<double>* in, size_t stride, std::complex<double>* out, size_t length,
             size_t factor) const;

  std::vector<std::complex<double>> roots_;  // exp(-2πi k/n)
  std::vector<size_t> factors_;              // of the length, rising
};

// In place, rows then columns, of a picture in row-major order.
void TransformPicture(std::vector<std::complex<double>>& picture, int width, int height, int threads);

}  // namespace lampyr
