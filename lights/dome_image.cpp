// Light from all around, from an image: square and equal-area as in pbrt-v4 ([Clarberg08]), or latitude-longitude with
// twice the width. The radiance of a direction is its texel's, without interpolation (pbrt-v4's rule), so a table that
// is constant over each texel is proportional to it: no texel that shines has a density of 0.
#include "lights/emission_image.h"
#include "lights/infinite_light.h"
#include "sampling/equal_area.h"
#include "sampling/tables.h"

namespace lampyr {

namespace {

enum class SkyMap { EqualArea, LatLong };

Point2 TexelMiddle(int x, int y, int width, int height) {
  return {(static_cast<float>(x) + 0.5f) / static_cast<float>(width),
          (static_cast<float>(y) + 0.5f) / static_cast<float>(height)};
}

class ImageSky {
 public:
  ImageSky(EmissionImage image, SkyMap map) : image_(std::move(image)), map_(map) {
    const int width = image_.Width(), height = image_.Height();
    std::vector<float> weights(static_cast<size_t>(width) * height);
    double sum[3] = {0, 0, 0}, total = 0;
    for (int y = 0; y < height; ++y) {
      const float solidAngle = RowSolidAngle(y);
      for (int x = 0; x < width; ++x) {
        const Color texel = image_.Texel(x, y);
        weights[static_cast<size_t>(y) * width + x] = texel.Average() * solidAngle;
        sum[0] += static_cast<double>(texel.r * solidAngle);
        sum[1] += static_cast<double>(texel.g * solidAngle);
        sum[2] += static_cast<double>(texel.b * solidAngle);
        total += static_cast<double>(texel.Average() * solidAngle);
      }
    }
    mean_ = {static_cast<float>(sum[0] / kSphere), static_cast<float>(sum[1] / kSphere),
             static_cast<float>(sum[2] / kSphere)};
    // A dim texel beside one of 1e9 keeps a density that a float can hold.
    const auto floor = static_cast<float>(1e-6 * total / static_cast<double>(weights.size()));
    for (float& weight : weights) weight = weight > 0 ? std::max(weight, floor) : 0.0f;
    table_ = Distribution2D(weights, width, height);
    // 1/sr of a square density of 1, and what an image that shines may not lose to rounding of the sums above.
    if (table_.IsZero()) mean_ = Color(0.0f);
  }

  void Scale(float factor) {
    scale_ = factor;
    mean_ *= factor;
  }

  Color Radiance(const Vector3& local) const { return scale_ * image_.Nearest(ToSquare(local)); }
  Color Mean() const { return mean_; }

  Vector3 Sample(const Point2& u) const {
    const Point2 uv = table_.Sample(u).uv;
    return map_ == SkyMap::EqualArea ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv);
  }

  PdfSolidAngle Density(const Vector3& local) const {
    const float density = table_.Density(ToSquare(local));
    if (map_ == SkyMap::EqualArea) return PdfSolidAngle(density / kEqualAreaJacobian);
    const float jacobian = LatLongJacobian(std::sqrt(Sqr(local.x) + Sqr(local.y)));
    return PdfSolidAngle(jacobian > 0 ? density / jacobian : 0.0f);
  }

  // Luminous irradiance of a surface that faces the light's +z, from the texels of the upper hemisphere.
  double UpperIlluminance() const {
    double sum = 0;
    for (int y = 0; y < image_.Height(); ++y) {
      for (int x = 0; x < image_.Width(); ++x) {
        const Point2 uv = TexelMiddle(x, y, image_.Width(), image_.Height());
        const Vector3 w = map_ == SkyMap::EqualArea ? EqualAreaSquareToSphere(uv) : LatLongSquareToSphere(uv);
        if (w.z > 0) sum += static_cast<double>(image_.Texel(x, y).Luminance() * w.z * RowSolidAngle(y));
      }
    }
    return sum;
  }

 private:
  static constexpr double kSphere = 4 * 3.14159265358979323846;

  Point2 ToSquare(const Vector3& local) const {
    return map_ == SkyMap::EqualArea ? EqualAreaSphereToSquare(local) : LatLongSphereToSquare(local);
  }
  // sr of one texel in row y, exact.
  float RowSolidAngle(int y) const {
    const double height = image_.Height(), width = image_.Width();
    if (map_ == SkyMap::EqualArea) return static_cast<float>(kSphere / (width * height));
    const double pi = 0.25 * kSphere, middle = pi * (y + 0.5) / height, half = 0.5 * pi / height;
    return static_cast<float>(2 * pi / width * 2 * std::sin(middle) * std::sin(half));
  }

  EmissionImage image_;
  SkyMap map_;
  Distribution2D table_;
  float scale_ = 1;
  Color mean_;
};

}  // namespace

std::unique_ptr<Light> MakeImageInfiniteLight(LightTypeFunction type, const ParameterList& parameters,
                                              const LightBuildContext& build) {
  const FileLocation where = parameters.WhereOf("filename");
  if (parameters.Find("L")) {
    throw Error(parameters.WhereOf("L"),
                "LightSource \"infinite\": both \"L\" and \"filename\" are given, one is enough");
  }
  EmissionImage image(parameters, build);
  const int width = image.Width(), height = image.Height();
  if (width != height && width != 2 * height) {
    throw Error(where, "LightSource \"infinite\": the image is " + std::to_string(width) + "×" +
                           std::to_string(height) +
                           "; a square (equal-area) or one twice as wide as high (latitude-longitude) is needed");
  }
  ImageSky sky(std::move(image), width == height ? SkyMap::EqualArea : SkyMap::LatLong);
  double scale = parameters.GetFloat("scale", 1);
  const double illuminance = parameters.GetFloat("illuminance", -1);
  if (illuminance > 0) {
    const double measured = sky.UpperIlluminance();
    scale = measured > 0 ? scale * illuminance / measured : 0.0;
  }
  const auto factor = static_cast<float>(scale);
  if (!std::isfinite(factor)) throw Error(parameters.Where(), "LightSource \"infinite\": the radiance is not finite");
  sky.Scale(factor);
  return std::make_unique<InfiniteLightWith<ImageSky>>(type, parameters, std::move(sky));
}

}  // namespace lampyr
