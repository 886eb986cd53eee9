// A slide projector (pbrt-v4's "projection"): a point light that projects an image along its +z. The intensity of a
// direction is scale · texel, W/sr, without interpolation and without a cosine to any power.
//
// The image fills a frustum of `fov` degrees across its shorter side. Seen from the light, looking along +z with +y up,
// its top is up at +y and its left column at -x, as in pbrt-v4's left-handed space. Shaping multiplies it, about +z.
#include <array>

#include "lights/types/image_profile.h"
#include "lights/types/shaped_point.h"
#include "sampling/tables.h"

namespace lampyr {

LightType ProjectionLightType();

namespace {

// ∫ of the solid angle element over [0,x] × [0,y] of the plane z = 1, signed.
double CornerSolidAngle(double x, double y) {
  return std::atan(x * y / std::sqrt(1 + x * x + y * y));
}

class ProjectionProfile {
 public:
  ProjectionProfile(EmissionImage image, double fovDegrees) : image_(std::move(image)), parts_(image_) {
    const double tangent = std::tan(fovDegrees * (3.14159265358979323846 / 360));
    const double aspect = static_cast<double>(image_.Width()) / image_.Height();
    halfX_ = tangent * std::max(aspect, 1.0);
    halfY_ = tangent / std::min(aspect, 1.0);
    MakeTable();
  }

  Color Shape(const LightTransform& transform, const Vector3& direction) const {
    Point2 uv;
    return FindUv(ToLocalDirection(transform, direction), uv) ? image_.Nearest(uv) : Color(0.0f);
  }
  float Largest() const { return largest_; }

  Vector3 Sample(const LightTransform& transform, const Point2& u) const {
    if (table_.IsZero()) return ToRenderDirection(transform, {0, 0, 1});
    return ToRenderDirection(transform, FromUv(table_.Sample(u).uv));
  }

  // Density proportional to the intensity over local solid angle (dA = dω / cos³θ on the plane z = 1), times the change
  // of solid angle. All methods that report it call this.
  PdfSolidAngle Density(const LightTransform& transform, const Vector3& direction) const {
    const Vector3 local = ToLocalDirection(transform, direction);
    Point2 uv;
    if (table_.IsZero() || !FindUv(local, uv)) return PdfSolidAngle(0);
    const float area = 4 * static_cast<float>(halfX_ * halfY_);
    const float density = table_.Density(uv) / (area * local.z * local.z * local.z);
    return PdfSolidAngle(density * LocalSolidAngleFactor(transform, direction));
  }

  Color SolidAngle(const LightTransform& transform) const;
  void SetCones(const LightTransform& transform, EmissionBounds& bounds) const;
  bool Clip(const LightTransform& transform, const Point3& from, const Point3& origin, const Vector3& direction,
            float& minT, float& maxT) const;

 private:
  void MakeTable();
  // Solid angle of a rectangle of the image; v points down.
  double SolidAngleOf(const Point2d& low, const Point2d& high) const {
    const double x0 = halfX_ * (2 * low.x - 1), x1 = halfX_ * (2 * high.x - 1);
    const double y0 = halfY_ * (2 * low.y - 1), y1 = halfY_ * (2 * high.y - 1);
    return CornerSolidAngle(x1, y1) - CornerSolidAngle(x0, y1) - CornerSolidAngle(x1, y0) + CornerSolidAngle(x0, y0);
  }
  bool FindUv(const Vector3& local, Point2& uv) const {
    if (!(local.z > 0)) return false;
    const float x = local.x / (local.z * static_cast<float>(halfX_));
    const float y = local.y / (local.z * static_cast<float>(halfY_));
    uv = {0.5f * (1 + x), 0.5f * (1 - y)};
    return std::abs(x) <= 1 && std::abs(y) <= 1;
  }
  Vector3 FromUv(const Point2& uv) const {
    return glm::normalize(
        Vector3((2 * uv.x - 1) * static_cast<float>(halfX_), (1 - 2 * uv.y) * static_cast<float>(halfY_), 1));
  }

  EmissionImage image_;
  ImageParts parts_;
  Distribution2D table_;
  double halfX_ = 1, halfY_ = 1;  // of the frustum at z = 1
  Color solidAngle_;              // ∫ texel dω
  float largest_ = 0;
};

// A cell of the table is a texel, or a part of one where the image is so small that the solid angle changes within it.
void ProjectionProfile::MakeTable() {
  constexpr int kLeast = 64;
  const int parts =
      std::max(1, (kLeast + std::max(image_.Width(), image_.Height()) - 1) / std::max(image_.Width(), image_.Height()));
  const int width = image_.Width() * parts, height = image_.Height() * parts;
  std::vector<float> weights(static_cast<size_t>(width) * height);
  double sum[3] = {0, 0, 0};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Color texel = image_.Texel(x / parts, y / parts);
      const Point2d low(static_cast<double>(x) / width, static_cast<double>(y) / height);
      const double solidAngle = SolidAngleOf(low, {(x + 1.0) / width, (y + 1.0) / height});
      // In units of the mean cell, so that the weights fit in a float at any field of view.
      weights[static_cast<size_t>(y) * width + x] = texel.Average() * static_cast<float>(solidAngle * width * height);
      sum[0] += static_cast<double>(texel.r) * solidAngle;
      sum[1] += static_cast<double>(texel.g) * solidAngle;
      sum[2] += static_cast<double>(texel.b) * solidAngle;
      largest_ = std::max(largest_, texel.Average());
    }
  }
  solidAngle_ = {static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])};
  LiftDimWeights(weights);
  table_ = Distribution2D(weights, width, height);
}

// Closed form under rotations and uniform scales; otherwise a quadrature in local directions.
Color ProjectionProfile::SolidAngle(const LightTransform& transform) const {
  if (IsSimilarity(transform.toRender.linear)) return solidAngle_;
  Color sum;
  for (const ImageParts::Part& part : parts_.Parts()) {
    const Vector3 direction = ToRenderDirection(transform, FromUv(part.Middle()));
    const auto solidAngle = static_cast<float>(SolidAngleOf(part.low, part.high));
    sum += part.mean * (solidAngle / LocalSolidAngleFactor(transform, direction));
  }
  return sum;
}

// The frustum stays convex under any transform: its widest direction lies on its rim.
void ProjectionProfile::SetCones(const LightTransform& transform, EmissionBounds& bounds) const {
  constexpr int kPerSide = 64;
  bounds.axis = ToRenderDirection(transform, {0, 0, 1});
  float widest = 0;
  for (int i = 0; i <= kPerSide; ++i) {
    const float t = static_cast<float>(i) / kPerSide;
    for (const Point2& uv : {Point2(t, 0), Point2(t, 1), Point2(0, t), Point2(1, t)})
      widest = std::max(widest, AngleBetween(ToRenderDirection(transform, FromUv(uv)), bounds.axis));
  }
  // In a similar frustum the widest are the corners, which are among these.
  if (!IsSimilarity(transform.toRender.linear)) widest *= 1.01f;
  bounds.cosThetaO = 1;
  bounds.cosThetaE = std::cos(std::min(widest, kPi));
}

// Clips by the four planes of the frustum, in local space, widened slightly for rounding.
bool ProjectionProfile::Clip(const LightTransform& transform, const Point3& from, const Point3& origin,
                             const Vector3& direction, float& minT, float& maxT) const {
  const Vector3d o(transform.toLocal.Point(origin) - from), d(transform.toLocal.Vector(direction));
  const double x = halfX_ * 1.001 + 1e-5, y = halfY_ * 1.001 + 1e-5;
  const std::array<Vector3d, 4> inwards = {Vector3d(1, 0, x), Vector3d(-1, 0, x), Vector3d(0, 1, y),
                                           Vector3d(0, -1, y)};
  double low = static_cast<double>(minT), high = static_cast<double>(maxT);
  for (const Vector3d& normal : inwards) {
    const double height = glm::dot(normal, o), slope = glm::dot(normal, d);
    if (slope > 0) low = std::max(low, -height / slope);
    if (slope < 0) high = std::min(high, -height / slope);
    if (slope == 0 && height < 0) return false;
  }
  if (!(low < high)) return false;
  minT = static_cast<float>(low);
  maxT = static_cast<float>(high);
  return true;
}

std::unique_ptr<Light> CreateProjection(const ParameterList& parameters, const LightBuildContext& build) {
  EmissionImage image(parameters, "filename", build);
  if (image.IsEmpty())
    throw Error(parameters.Where(), "LightSource \"projection\" needs a \"filename\": the image that it throws");
  ProjectionProfile profile(std::move(image), parameters.GetFloat("fov", 90));
  return MakePointLight(ProjectionLightType, parameters, build, std::move(profile), PointSource{}, {0, 0, 1});
}

}  // namespace

LightType ProjectionLightType() {
  LightType type;
  type.name = "projection";
  type.help = "a slide projector: a point that throws an image along +z; shaping is about +z, not -z";
  type.parameters = WithShapingParameters({
      {"filename", ParameterType::String, "", "\"\"", "",
       "the image, W/sr; its top is up at +y, its left column at -x"},
      {"fov", ParameterType::Float, "°", "90", "(0,180)", "across the shorter side of the image"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the image"},
      {"power", ParameterType::Float, "W", "-1", "", "if positive: total power (of the luminance) to scale to"},
  });
  type.create = CreateProjection;
  type.samples = {
      "\"string filename\" \"suite-latlong.exr\"",
      "\"string filename\" \"suite-square.exr\" \"float fov\" 40 \"float power\" 20",
      "\"string filename\" \"suite-latlong.exr\" \"float fov\" 140 \"float scale\" 3",
      "\"string filename\" \"suite-texture.exr\" \"float fov\" 1",
      "\"string filename\" \"suite-bright.exr\" \"float fov\" 60 \"float power\" 5",
      "\"string filename\" \"suite-black.exr\" \"float power\" 5",
      "\"string filename\" \"suite-latlong.exr\" \"float fov\" 70 \"string shaping:ies:file\" \"suite-profile.ies\" "
      "\"float power\" 20",
      "\"string filename\" \"suite-texture.exr\" \"float fov\" 70 \"float shaping:cone:angle\" 20 \"float "
      "shaping:cone:softness\" 1",
  };
  return type;
}

}  // namespace lampyr
