#include "lights/types/image_sky.h"

#include "base/parallel.h"
#include "lights/direction_map.h"

namespace lampyr {

namespace {

constexpr double kSphere = 4 * 3.14159265358979323846;

Point2 TexelMiddle(int x, int y, int width, int height) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(height)};
}

}  // namespace

ImageSky::ImageSky(const ParameterList& parameters, const std::string& name, const LightBuildContext& build) {
  const EmissionImage image(parameters, name, build);
  const int width = image.Width(), height = image.Height();
  if (width != height && width != 2 * height) {
    throw Error(parameters.WhereOf(name),
                parameters.Owner() + ": the image is " + std::to_string(width) + "×" + std::to_string(height) +
                    "; a square (equal-area) or one twice as wide as high (latitude-longitude) is needed");
  }
  map_ = width == height ? SkyMap::EqualArea : SkyMap::LatLong;

  const size_t columns = static_cast<size_t>(width);
  std::vector<float> weights(columns * static_cast<size_t>(height));
  struct RowSum {
    double r = 0, g = 0, b = 0;
  };
  std::vector<RowSum> rows(static_cast<size_t>(height));
  ParallelFor(height, HardwareThreads(), [&](int y) {
    const float solidAngle = RowSolidAngle(y, width, height);
    RowSum sum;
    for (int x = 0; x < width; ++x) {
      const Color texel = image.Texel(x, y) * solidAngle;
      weights[static_cast<size_t>(y) * columns + static_cast<size_t>(x)] = texel.Average();
      sum.r += static_cast<double>(texel.r);
      sum.g += static_cast<double>(texel.g);
      sum.b += static_cast<double>(texel.b);
    }
    rows[static_cast<size_t>(y)] = sum;
  });
  RowSum all;
  for (const RowSum& row : rows) all.r += row.r, all.g += row.g, all.b += row.b;
  mean_ = {static_cast<float>(all.r / kSphere), static_cast<float>(all.g / kSphere),
           static_cast<float>(all.b / kSphere)};
  // Lower bound of positive weights, so that the density of a dim texel beside one of 1e9 is within the range of float.
  const auto floor = static_cast<float>(1e-6 * (all.r + all.g + all.b) / 3 / static_cast<double>(weights.size()));
  for (float& weight : weights) weight = weight > 0 ? std::max(weight, floor) : 0.0f;
  table_ = ColorTable(
      weights, [&](int x, int y) { return image.Texel(x, y); }, width, height);
  // A sky whose weights all vanish in float is black.
  if (table_.IsZero()) {
    mean_ = Color(0.0f);
  } else {
    cells_ = SkyCells(table_, [this](const Point2& uv) { return FromSquare(uv); });
  }
}

float ImageSky::RowSolidAngle(int y, int columns, int rows) const {
  const double width = columns, height = rows;
  if (map_ == SkyMap::EqualArea) return static_cast<float>(kSphere / (width * height));
  const double pi = 0.25 * kSphere, middle = pi * (y + 0.5) / height, half = 0.5 * pi / height;
  return static_cast<float>(2 * pi / width * 2 * std::sin(middle) * std::sin(half));
}

double ImageSky::UpperIlluminance(const LightTransform& transform) const {
  const int width = table_.Width(), height = table_.Height();
  const bool isSimilar = IsSimilarity(transform.toRender.linear);
  const Vector3 up = ToRenderDirection(transform, Vector3(0, 0, 1) * toImage_);
  // Cosine times the solid angle in render space over that of the map.
  const auto weight = [&](const Vector3& w) {
    if (isSimilar) return w.z;
    const Vector3 direction = ToRenderDirection(transform, w * toImage_);
    return glm::dot(direction, up) / LocalSolidAngleFactor(transform, direction);
  };
  // Within a texel the cosine is taken as that in the middle; where a placement stretches, in the middle of its parts.
  const int parts = isSimilar ? 1 : std::clamp(512 / std::min(width, height), 1, 32);
  double sum = 0;
  for (int y = 0; y < height * parts; ++y) {
    for (int x = 0; x < width * parts; ++x) {
      const Point2 uv = TexelMiddle(x, y, width * parts, height * parts);
      const float cosine = weight(FromSquare(uv));
      if (!(cosine > 0)) continue;
      sum += static_cast<double>(table_.ColorAt(x / parts, y / parts).Luminance() * cosine *
                                 RowSolidAngle(y, width * parts, height * parts));
    }
  }
  return sum;
}

}  // namespace lampyr
