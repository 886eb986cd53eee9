// Spectra of errors: transforms by their definition, Parseval's theorem, and errors of known frequencies.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "app/compare/fourier.h"
#include "app/compare/spectrum.h"
#include "film/metrics.h"

namespace lampyr {
namespace {

using Complex = std::complex<double>;

TEST(Fourier, IsItsDefinition) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal(0, 1);
  for (const int n : {1, 2, 3, 8, 30, 49, 97, 108, 192}) {
    std::vector<Complex> in(static_cast<size_t>(n)), out(in.size());
    for (Complex& value : in) value = {normal(generator), normal(generator)};
    FourierTransform(n).Apply(in.data(), out.data());
    for (int k = 0; k < n; ++k) {
      Complex sum;
      for (int j = 0; j < n; ++j) {
        const double angle = -2 * std::numbers::pi * (static_cast<int64_t>(j) * k % n) / n;
        sum += in[static_cast<size_t>(j)] * std::polar(1.0, angle);
      }
      EXPECT_LT(std::abs(out[static_cast<size_t>(k)] - sum), 1e-11 * n) << n << " " << k;
    }
  }
}

TEST(Fourier, OfAPictureHasOneWaveInOnePlace) {
  constexpr int width = 12, height = 10;
  std::vector<Complex> picture;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x)
      picture.push_back(std::polar(1.0, 2 * std::numbers::pi * (3.0 * x / width + 4.0 * y / height)));
  }
  TransformPicture(picture, width, height, 2);
  for (size_t i = 0; i < picture.size(); ++i)
    EXPECT_NEAR(std::abs(picture[i]), i == 4 * width + 3 ? width * height : 0.0, 1e-9) << i;
}

constexpr int kWidth = 60, kHeight = 35;

// The reference, with a relative error added.
template <class ErrorAt>
Image Picture(const ErrorAt& errorAt) {
  Image image(kWidth, kHeight, {"R", "G", "B"});
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      for (size_t c = 0; c < 3; ++c) {
        const double value = 0.5 + 0.02 * x + 0.1 * static_cast<double>(c);
        image.At(x, y, c) = static_cast<float>(value * (1 + errorAt(x, y)));
      }
    }
  }
  return image;
}

std::vector<Image> NoisyPictures(double deviation, int count) {
  std::mt19937 generator(2);
  std::normal_distribution<double> normal(0, deviation);
  std::vector<Image> images;
  for (int k = 0; k < count; ++k) images.push_back(Picture([&](int, int) { return normal(generator); }));
  return images;
}

std::vector<const Image*> Pointers(const std::vector<Image>& images) {
  std::vector<const Image*> pointers;
  for (const Image& image : images) pointers.push_back(&image);
  return pointers;
}

TEST(ErrorSpectrum, SharesSumUpToRelMse) {
  const Image reference = Picture([](int, int) { return 0.0; });
  const std::vector<Image> images = NoisyPictures(0.2, 5);
  double relMse = 0, sum = 0;
  for (const Image& image : images) relMse += MeasureError(image, reference).relMse / 5;
  for (const SpectrumRing& ring : ErrorSpectrum(Pointers(images), reference, 0, 2)) sum += ring.share;
  EXPECT_NEAR(sum / relMse, 1, 1e-6);
  // With the reference's noise subtracted, as from relMSE.
  sum = 0;
  for (const SpectrumRing& ring : ErrorSpectrum(Pointers(images), reference, 0.01, 2)) sum += ring.share;
  EXPECT_NEAR(sum / (relMse - 0.01), 1, 1e-6);
}

TEST(ErrorSpectrum, OfIndependentPixelsIsFlat) {
  const Image reference = Picture([](int, int) { return 0.0; });
  const std::vector<SpectrumRing> spectrum = ErrorSpectrum(Pointers(NoisyPictures(0.2, 40)), reference, 0, 1);
  double last = -1;
  for (const SpectrumRing& ring : spectrum) {
    EXPECT_GT(ring.frequency, last);
    last = ring.frequency;
    if (ring.frequency == 0) continue;
    EXPECT_NEAR(ring.density, 0.04, 4 * ring.deviation / std::sqrt(40.0) + 0.002) << ring.frequency;
    EXPECT_LE(ring.low, ring.density);
    EXPECT_GE(ring.high, ring.density);
    EXPECT_LT(std::abs(ring.common), 0.02);
  }
  EXPECT_EQ(spectrum.front().frequency, 0);
  EXPECT_NEAR(last, std::sqrt(0.5), 0.05);
}

TEST(ErrorSpectrum, ABiasIsAtItsFrequencyAndInCommon) {
  const Image reference = Picture([](int, int) { return 0.0; });
  std::mt19937 generator(3);
  std::normal_distribution<double> normal(0, 0.01);
  std::vector<Image> images;
  for (int k = 0; k < 5; ++k) {
    images.push_back(Picture([&](int x, int) {
      return 0.1 * std::cos(2 * std::numbers::pi * x / 5) + normal(generator);  // 0.2 cycles per pixel
    }));
  }
  double atFrequency = 0, elsewhere = 0;
  for (const SpectrumRing& ring : ErrorSpectrum(Pointers(images), reference, 0, 1)) {
    const bool isThere = std::abs(ring.frequency - 0.2) < 0.02;
    (isThere ? atFrequency : elsewhere) += ring.share;
    if (isThere && ring.share > 1e-3) {
      EXPECT_NEAR(ring.common / ring.density, 1, 0.05);
    }
  }
  EXPECT_NEAR(atFrequency, 0.005, 4e-4);  // half of 0.1², the floor of relMSE aside
  EXPECT_LT(elsewhere, 3e-4);
}

}  // namespace
}  // namespace lampyr
