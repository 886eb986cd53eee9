#include "app/compare/fourier.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace lampyr {

using Complex = std::complex<double>;

FourierTransform::FourierTransform(int length) {
  auto rest = static_cast<size_t>(length);
  for (size_t k = 0; k < rest; ++k)
    roots_.push_back(std::polar(1.0, -2 * std::numbers::pi * static_cast<double>(k) / length));
  for (size_t prime = 2; rest > 1; ++prime) {
    if (prime * prime > rest) prime = rest;
    for (; rest % prime == 0; rest /= prime) factors_.push_back(prime);
  }
}

void FourierTransform::Apply(const Complex* in, Complex* out) const {
  Apply(in, 1, out, roots_.size(), 0);
}

// The transform of in[0], in[stride], …: every radix-th value, from each of the first `radix` on, is transformed on its
// own, and the results are combined ([Cooley65]).
void FourierTransform::Apply(const Complex* in, size_t stride, Complex* out, size_t length, size_t factor) const {
  if (length == 1) {
    *out = *in;
    return;
  }
  const size_t radix = factors_[factor], part = length / radix, all = roots_.size(), step = all / length;
  for (size_t r = 0; r < radix; ++r) Apply(in + r * stride, stride * radix, out + r * part, part, factor + 1);
  std::vector<Complex> turned(radix);
  for (size_t k = 0; k < part; ++k) {
    for (size_t r = 0; r < radix; ++r) turned[r] = out[r * part + k] * roots_[r * k * step];
    for (size_t q = 0; q < radix; ++q) {
      Complex sum = turned[0];
      for (size_t r = 1; r < radix; ++r) sum += turned[r] * roots_[r * q % radix * (all / radix)];
      out[q * part + k] = sum;
    }
  }
}

void TransformPicture(std::vector<Complex>& picture, int width, int height, int threads) {
  const FourierTransform ofRows(width), ofColumns(height);
  ParallelFor(height, threads, [&](int y) {
    const std::vector<Complex> row(picture.begin() + static_cast<ptrdiff_t>(y) * width,
                                   picture.begin() + static_cast<ptrdiff_t>(y + 1) * width);
    ofRows.Apply(row.data(), &picture[static_cast<size_t>(y) * static_cast<size_t>(width)]);
  });
  ParallelFor(width, threads, [&](int x) {
    std::vector<Complex> column(static_cast<size_t>(height)), transformed(column.size());
    const auto at = [&](size_t y) -> Complex& {
      return picture[y * static_cast<size_t>(width) + static_cast<size_t>(x)];
    };
    for (size_t y = 0; y < column.size(); ++y) column[y] = at(y);
    ofColumns.Apply(column.data(), transformed.data());
    for (size_t y = 0; y < column.size(); ++y) at(y) = transformed[y];
  });
}

}  // namespace lampyr
