// FLIP: known values, symmetry, and the separable filters against plain 2-D convolution.
#include "film/flip.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <random>

namespace lampyr {
namespace {

using Pixels = std::vector<Color>;

double Mean(const std::vector<float>& map) {
  double sum = 0;
  for (const float v : map) sum += static_cast<double>(v);
  return sum / static_cast<double>(map.size());
}

double FlipOf(const Pixels& a, const Pixels& b, int width, int height) {
  return Mean(FlipMap(a, b, width, height));
}

Pixels NoisePixels(size_t count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform(0.0f, 1.2f);
  Pixels pixels(count);
  for (Color& c : pixels) {
    const float r = uniform(generator), g = uniform(generator), b = uniform(generator);
    c = {r, g, b};
  }
  return pixels;
}

TEST(Flip, KnownValuesOfConstantImages) {
  const Pixels black(64, Color(0.0f)), white(64, Color(1.0f)), green(64, Color(0, 1, 0)), blue(64, Color(0, 0, 1));
  EXPECT_EQ(FlipOf(white, white, 8, 8), 0);
  // HyAB of black and white is 100, the largest of the gamut is (41.2761)^(1/0.7): [Andersson20 eq. 7].
  const double knee = 0.4 * 41.2761, expected = 0.95 + 0.05 * (std::pow(100.0, 0.7) - knee) / (41.2761 - knee);
  EXPECT_NEAR(FlipOf(black, white, 8, 8), expected, 1e-4);
  EXPECT_NEAR(FlipOf(green, blue, 8, 8), 1, 1e-4);
  // Values that a display clips do not differ.
  EXPECT_EQ(FlipOf(white, Pixels(64, Color(50.0f)), 8, 8), 0);
}

TEST(Flip, SymmetricBoundedAndZeroOnlyForEqualImages) {
  const Pixels a = NoisePixels(40 * 30, 1), b = NoisePixels(40 * 30, 2);
  const auto ab = FlipMap(a, b, 40, 30), ba = FlipMap(b, a, 40, 30);
  for (size_t i = 0; i < ab.size(); ++i) {
    ASSERT_NEAR(ab[i], ba[i], 1e-6f);
    ASSERT_GE(ab[i], 0.0f);
    ASSERT_LE(ab[i], 1.0f);
  }
  EXPECT_GT(Mean(ab), 0.05);
  EXPECT_EQ(Mean(FlipMap(a, a, 40, 30)), 0);
}

TEST(Flip, GrowsWithTheDifference) {
  double last = 0;
  const Pixels gray(32 * 32, Color(0.4f));
  for (const float amount : {0.02f, 0.05f, 0.1f, 0.2f, 0.4f}) {
    Pixels other = gray;
    for (size_t i = 0; i < other.size(); i += 3) other[i] = Color(0.4f + amount);
    const double flip = FlipOf(gray, other, 32, 32);
    EXPECT_GT(flip, last);
    last = flip;
  }
}

// The published formulas once more, as plainly as possible: 2-D kernels, doubles, one pixel at a time.
class PlainFlip {
 public:
  PlainFlip(int width, int height) : width_(width), height_(height) {}

  double At(const Pixels& a, const Pixels& b, int x, int y) const {
    const auto labA = Lab(a, x, y), labB = Lab(b, x, y);
    const double hyab = std::abs(labA[0] - labB[0]) + std::hypot(labA[1] - labB[1], labA[2] - labB[2]);
    const double largest = 41.2761, distance = std::pow(hyab, 0.7), knee = 0.4 * largest;
    const double color = distance < knee ? 0.95 * distance / knee : 0.95 + 0.05 * (distance - knee) / (largest - knee);
    const double edge = std::abs(Feature(a, x, y, false) - Feature(b, x, y, false));
    const double point = std::abs(Feature(a, x, y, true) - Feature(b, x, y, true));
    return std::pow(color, 1 - std::sqrt(std::max(edge, point) / std::sqrt(2.0)));
  }

 private:
  using Vec = std::array<double, 3>;
  static constexpr double kPpd = 67, kPiValue = 3.14159265358979323846;

  static Vec ToXyz(const Vec& c) {
    return {(0.4123866 * c[0] + 0.3575914 * c[1] + 0.1804505 * c[2]) / 0.9504285,
            0.2126368 * c[0] + 0.7151830 * c[1] + 0.0721802 * c[2],
            (0.0193306 * c[0] + 0.1191972 * c[1] + 0.9503726 * c[2]) / 1.0889004};
  }
  static Vec FromXyz(const Vec& relative) {
    const Vec v = {relative[0] * 0.9504285, relative[1], relative[2] * 1.0889004};
    return {3.241003275 * v[0] - 1.537398934 * v[1] - 0.498615861 * v[2],
            -0.969224334 * v[0] + 1.875930071 * v[1] + 0.041554224 * v[2],
            0.055639423 * v[0] - 0.204011202 * v[1] + 1.057148933 * v[2]};
  }
  const Color& Pixel(const Pixels& p, int x, int y) const {
    return p[static_cast<size_t>(std::clamp(y, 0, height_ - 1) * width_ + std::clamp(x, 0, width_ - 1))];
  }
  Vec Opponent(const Pixels& p, int x, int y) const {
    const auto clip = [](float v) { return static_cast<double>(std::clamp(v, 0.0f, 1.0f)); };
    const Color& c = Pixel(p, x, y);
    const Vec xyz = ToXyz({clip(c.r), clip(c.g), clip(c.b)});
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
  }
  Vec Lab(const Pixels& p, int x, int y) const {
    const int radius = 10;  // ⌈3 √(0.04 / 2π²) 67⌉
    const double a1[3] = {1, 1, 34.1}, b1[3] = {0.0047, 0.0053, 0.04}, a2[3] = {0, 0, 13.5}, b2[3] = {1, 1, 0.025};
    Vec sum = {}, total = {};
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        const Vec value = Opponent(p, x + dx, y + dy);
        const double r2 = (dx * dx + dy * dy) / (kPpd * kPpd);
        for (size_t c = 0; c < 3; ++c) {
          const auto term = [&](double a, double b) {
            return a * std::sqrt(kPiValue / b) * std::exp(-kPiValue * kPiValue * r2 / b);
          };
          const double weight = term(a1[c], b1[c]) + term(a2[c], b2[c]);
          sum[c] += weight * value[c];
          total[c] += weight;
        }
      }
    }
    const double yy = (sum[0] / total[0] + 16) / 116;
    Vec rgb = FromXyz({yy + sum[1] / total[1] / 500, yy, yy - sum[2] / total[2] / 200});
    for (double& v : rgb) v = std::clamp(v, 0.0, 1.0);
    Vec f = ToXyz(rgb);
    for (double& v : f) v = v > 216.0 / 24389 ? std::cbrt(v) : v * 841 / 108 + 4.0 / 29;
    const double lightness = 116 * f[1] - 16;
    return {lightness, 0.01 * lightness * 500 * (f[0] - f[1]), 0.01 * lightness * 200 * (f[1] - f[2])};
  }
  double Feature(const Pixels& p, int x, int y, bool isPoint) const {
    const double deviation = 0.5 * 0.082 * kPpd;
    const int radius = static_cast<int>(std::ceil(3 * deviation));
    const auto kernel = [&](int dx, int dy) {
      const double g = std::exp(-(dx * dx + dy * dy) / (2 * deviation * deviation));
      return isPoint ? (dx * dx / (deviation * deviation) - 1) * g : -dx * g;
    };
    double positive = 0, negative = 0;
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) (kernel(dx, dy) > 0 ? positive : negative) += std::abs(kernel(dx, dy));
    }
    double alongX = 0, alongY = 0;
    for (int dy = -radius; dy <= radius; ++dy) {
      for (int dx = -radius; dx <= radius; ++dx) {
        const double luminance = (Opponent(p, x + dx, y + dy)[0] + 16) / 116;
        const auto weight = [&](int i, int j) {
          const double k = kernel(i, j);
          return k > 0 ? k / positive : k / negative;
        };
        alongX += weight(dx, dy) * luminance;
        alongY += weight(dy, dx) * luminance;
      }
    }
    return std::hypot(alongX, alongY);
  }

  int width_, height_;
};

TEST(Flip, AgreesWithThePlainFormulas) {
  const int width = 33, height = 27;
  Pixels a = NoisePixels(static_cast<size_t>(width * height), 5),
         b = NoisePixels(static_cast<size_t>(width * height), 6);
  for (int y = 0; y < height; ++y) {  // a step and a bright point, so that features weigh in
    for (int x = 0; x < width; ++x) {
      if (x > 16) a[static_cast<size_t>(y * width + x)] *= 0.1f;
    }
  }
  b[static_cast<size_t>(13 * width + 8)] = Color(30.0f);
  const auto map = FlipMap(a, b, width, height);
  const PlainFlip plain(width, height);
  for (const auto& [x, y] : {std::pair{0, 0}, {32, 26}, {16, 13}, {8, 13}, {9, 14}, {17, 3}, {25, 20}, {0, 13}}) {
    EXPECT_NEAR(map[static_cast<size_t>(y * width + x)], plain.At(a, b, x, y), 2e-4) << x << " " << y;
  }
}

TEST(Flip, FastEnoughForLargeImages) {
  const Pixels a = NoisePixels(512 * 512, 3), b = NoisePixels(512 * 512, 4);
  const auto start = std::chrono::steady_clock::now();
  EXPECT_GT(FlipOf(a, b, 512, 512), 0);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
  RecordProperty("seconds", std::to_string(seconds.count()));
  EXPECT_LT(seconds.count(), 5.0);  // 0.1 s alone on a core; the bound holds on a loaded machine and in debug builds
}

TEST(Flip, TinyImages) {
  EXPECT_GT(FlipOf({Color(0.0f)}, {Color(1.0f)}, 1, 1), 0.9);
  EXPECT_GT(FlipOf(Pixels(3, Color(0.0f)), Pixels(3, Color(1.0f)), 3, 1), 0.9);
}

}  // namespace
}  // namespace lampyr
