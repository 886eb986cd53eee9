// FLIP in two pipelines ([Andersson20 §4]). Colour: opponent space YCxCz, blurred by the contrast sensitivity of the
// eye (sums of Gaussians), CIELab with Hunt's adjustment, HyAB distance, redistributed to [0,1]. Features: edges and
// points by derivatives of a Gaussian on the luminance. The result is colour^(1 - feature). All kernels are sums of
// products of 1-D kernels; borders are replicated.
#include "film/flip.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lampyr {

namespace {

constexpr double kPiDouble = 3.14159265358979323846;
// [Andersson20 §4.1-4.3]: exponents and knee of the redistribution, width of the feature detectors in degrees.
constexpr float kColorExponent = 0.7f, kKneePosition = 0.4f, kKneeValue = 0.95f, kFeatureExponent = 0.5f;
constexpr double kFeatureWidth = 0.082;

struct Triple {
  float x = 0, y = 0, z = 0;
};

// Linear Rec. 709 to XYZ relative to the white point D65, whose XYZ is then (1,1,1): each row sums to 1.
constexpr float kToXyz[3][3] = {{0.43389539f, 0.37624237f, 0.18986224f},
                                {0.21263682f, 0.71518298f, 0.07218020f},
                                {0.01775242f, 0.10946563f, 0.87278195f}};

Triple ToRelativeXyz(const Triple& rgb) {
  const auto row = [&](int i) { return kToXyz[i][0] * rgb.x + kToXyz[i][1] * rgb.y + kToXyz[i][2] * rgb.z; };
  return {row(0), row(1), row(2)};
}

// Inverse of kToXyz, computed, since a second table could disagree.
std::array<std::array<float, 3>, 3> FromXyzMatrix() {
  const auto m = [](int i, int j) { return static_cast<double>(kToXyz[i % 3][j % 3]); };
  std::array<std::array<float, 3>, 3> inverse{};
  double determinant = 0;
  for (int j = 0; j < 3; ++j) determinant += m(0, j) * (m(1, j + 1) * m(2, j + 2) - m(1, j + 2) * m(2, j + 1));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double cofactor = m(i + 1, j + 1) * m(i + 2, j + 2) - m(i + 1, j + 2) * m(i + 2, j + 1);
      inverse[j][i] = static_cast<float>(cofactor / determinant);
    }
  }
  return inverse;
}

Triple ToYCxCz(const Triple& xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

Triple YCxCzToXyz(const Triple& c) {
  const float y = (c.x + 16) / 116;
  return {y + c.y / 500, y, y - c.z / 200};
}

// CIELab with a and b scaled by lightness (Hunt: colours look less colourful in the dark).
Triple ToHuntLab(const Triple& xyz) {
  constexpr float delta = 6.0f / 29;
  const auto f = [](float t) { return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0f / 29; };
  const float fx = f(xyz.x), fy = f(xyz.y), fz = f(xyz.z);
  const float lightness = 116 * fy - 16;
  return {lightness, 0.01f * lightness * 500 * (fx - fy), 0.01f * lightness * 200 * (fy - fz)};
}

float HyAb(const Triple& a, const Triple& b) {
  return std::abs(a.x - b.x) + std::sqrt((a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z));
}

using Kernel = std::vector<float>;  // of odd length, centre in the middle
using Plane = std::vector<float>;

// Filters a plane along x by `horizontal`, then along y by `vertical`; borders are replicated.
Plane Filter(const Plane& in, int width, int height, const Kernel& horizontal, const Kernel& vertical) {
  const int radius = static_cast<int>(horizontal.size() / 2);
  Plane rows(in.size()), out(in.size(), 0.0f);
  std::vector<float> padded(static_cast<size_t>(width + 2 * radius));
  for (int y = 0; y < height; ++y) {
    const float* row = &in[static_cast<size_t>(y) * width];
    std::fill_n(padded.begin(), radius, row[0]);
    std::copy_n(row, width, padded.begin() + radius);
    std::fill_n(padded.begin() + radius + width, radius, row[width - 1]);
    float* target = &rows[static_cast<size_t>(y) * width];
    for (size_t k = 0; k < horizontal.size(); ++k) {
      for (int x = 0; x < width; ++x) target[x] += horizontal[k] * padded[k + static_cast<size_t>(x)];
    }
  }
  const int verticalRadius = static_cast<int>(vertical.size() / 2);
  for (int y = 0; y < height; ++y) {
    float* target = &out[static_cast<size_t>(y) * width];
    for (size_t k = 0; k < vertical.size(); ++k) {
      const int from = std::clamp(y + static_cast<int>(k) - verticalRadius, 0, height - 1);
      const float* source = &rows[static_cast<size_t>(from) * width];
      for (int x = 0; x < width; ++x) target[x] += vertical[k] * source[x];
    }
  }
  return out;
}

// A term a·sqrt(π/b)·exp(-π²x²/b) of a contrast sensitivity function ([Andersson20 table 1]), as a 1-D kernel to be
// applied along both axes; `amplitude` is that of the product.
struct SensitivityTerm {
  double amplitude = 0;
  Kernel kernel;
};

// The terms of one channel, normalised so that together they sum to 1 over the plane.
std::vector<SensitivityTerm> SensitivityKernels(const std::vector<std::array<double, 2>>& terms,
                                                double pixelsPerDegree) {
  constexpr double widest = 0.04;  // the largest b of all channels sets the radius of all
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * kPiDouble * kPiDouble)) * pixelsPerDegree));
  std::vector<SensitivityTerm> kernels;
  double total = 0;
  for (const auto& [a, b] : terms) {
    std::vector<double> weights;
    double sum = 0;
    for (int i = -radius; i <= radius; ++i) {
      const double x = i / pixelsPerDegree;
      weights.push_back(std::exp(-kPiDouble * kPiDouble * x * x / b));
      sum += weights.back();
    }
    SensitivityTerm term;
    for (const double w : weights) term.kernel.push_back(static_cast<float>(w / sum));
    term.amplitude = a * std::sqrt(kPiDouble / b) * sum * sum;
    total += term.amplitude;
    kernels.push_back(std::move(term));
  }
  for (auto& term : kernels) term.amplitude /= total;
  return kernels;
}

Plane FilterBySensitivity(const Plane& plane, int width, int height, const std::vector<SensitivityTerm>& terms) {
  Plane result(plane.size(), 0.0f);
  for (const auto& term : terms) {
    const Plane filtered = Filter(plane, width, height, term.kernel, term.kernel);
    const float amplitude = static_cast<float>(term.amplitude);
    for (size_t i = 0; i < result.size(); ++i) result[i] += amplitude * filtered[i];
  }
  return result;
}

struct FeatureKernels {
  Kernel gaussian, edge, point;  // edge, point: 1st, 2nd derivative; positive and negative parts sum to 1
};

FeatureKernels MakeFeatureKernels(double pixelsPerDegree) {
  const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = std::max(1, static_cast<int>(std::ceil(3 * deviation)));
  const auto normalise = [](const std::vector<double>& weights) {
    double positive = 0, negative = 0;
    for (const double w : weights) (w > 0 ? positive : negative) += std::abs(w);
    Kernel kernel;
    for (const double w : weights) kernel.push_back(static_cast<float>(w == 0 ? 0 : w / (w > 0 ? positive : negative)));
    return kernel;
  };
  std::vector<double> gaussian, edge, point;
  for (int i = -radius; i <= radius; ++i) {
    const double x = i, g = std::exp(-x * x / (2 * deviation * deviation));
    gaussian.push_back(g);
    edge.push_back(-x * g);
    point.push_back((x * x / (deviation * deviation) - 1) * g);
  }
  return {normalise(gaussian), normalise(edge), normalise(point)};
}

// Magnitudes of the edge response and of the point response, per pixel.
struct Features {
  Plane edge, point;
};

Plane Lengths(const Plane& x, const Plane& y) {
  Plane lengths(x.size());
  for (size_t i = 0; i < x.size(); ++i) lengths[i] = std::sqrt(x[i] * x[i] + y[i] * y[i]);
  return lengths;
}

// Input of the final comparison from one image: filtered colours and features.
struct Perceived {
  std::vector<Triple> lab;
  Features features;
};

Features DetectFeatures(const Plane& yChannel, int width, int height, const FeatureKernels& kernels) {
  Plane luminance(yChannel.size());
  for (size_t i = 0; i < luminance.size(); ++i) luminance[i] = (yChannel[i] + 16) / 116;
  const auto both = [&](const Kernel& derivative) {
    return Lengths(Filter(luminance, width, height, derivative, kernels.gaussian),
                   Filter(luminance, width, height, kernels.gaussian, derivative));
  };
  return {both(kernels.edge), both(kernels.point)};
}

Perceived Perceive(const std::vector<Color>& image, int width, int height, const FlipSettings& settings) {
  Plane opponent[3];
  for (Plane& plane : opponent) plane.reserve(image.size());
  const auto clip = [](float v) { return v > 0 ? std::min(v, 1.0f) : 0.0f; };
  for (const Color& color : image) {
    const Triple c = ToYCxCz(ToRelativeXyz({clip(color.r), clip(color.g), clip(color.b)}));
    opponent[0].push_back(c.x);
    opponent[1].push_back(c.y);
    opponent[2].push_back(c.z);
  }
  Perceived perceived;
  perceived.features = DetectFeatures(opponent[0], width, height, MakeFeatureKernels(settings.pixelsPerDegree));

  const std::vector<std::array<double, 2>> sensitivities[3] = {
      {{1, 0.0047}}, {{1, 0.0053}}, {{34.1, 0.04}, {13.5, 0.025}}};
  for (int c = 0; c < 3; ++c) {
    opponent[c] =
        FilterBySensitivity(opponent[c], width, height, SensitivityKernels(sensitivities[c], settings.pixelsPerDegree));
  }
  const auto fromXyz = FromXyzMatrix();
  perceived.lab.resize(image.size());
  for (size_t i = 0; i < image.size(); ++i) {
    const Triple xyz = YCxCzToXyz({opponent[0][i], opponent[1][i], opponent[2][i]});
    const auto row = [&](int r) { return clip(fromXyz[r][0] * xyz.x + fromXyz[r][1] * xyz.y + fromXyz[r][2] * xyz.z); };
    perceived.lab[i] = ToHuntLab(ToRelativeXyz({row(0), row(1), row(2)}));
  }
  return perceived;
}

// Maps HyAB^0.7 to [0,1]: linear up to 0.95 at 40 % of the largest distance, then linear to 1 ([Andersson20 eq. 7]).
float Redistribute(float distance, float largest) {
  const float knee = kKneePosition * largest;
  if (distance < knee) return kKneeValue * distance / knee;
  return std::min(1.0f, kKneeValue + (distance - knee) / (largest - knee) * (1 - kKneeValue));
}

}  // namespace

std::vector<float> FlipMap(const std::vector<Color>& a, const std::vector<Color>& b, int width, int height,
                           const FlipSettings& settings) {
  const Perceived first = Perceive(a, width, height, settings), second = Perceive(b, width, height, settings);
  // The largest distance in the gamut is that between green and blue.
  const float largest =
      std::pow(HyAb(ToHuntLab(ToRelativeXyz({0, 1, 0})), ToHuntLab(ToRelativeXyz({0, 0, 1}))), kColorExponent);
  std::vector<float> map(a.size());
  for (size_t i = 0; i < map.size(); ++i) {
    const float color = Redistribute(std::pow(HyAb(first.lab[i], second.lab[i]), kColorExponent), largest);
    const float edge = std::abs(first.features.edge[i] - second.features.edge[i]);
    const float point = std::abs(first.features.point[i] - second.features.point[i]);
    const float feature = std::pow(std::min(1.0f, std::max(edge, point) / std::sqrt(2.0f)), kFeatureExponent);
    map[i] = color > 0 ? std::pow(color, 1 - feature) : 0.0f;
  }
  return map;
}

}  // namespace lampyr
