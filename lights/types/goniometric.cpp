// A point whose intensity over directions is an image (pbrt-v4's "goniometric"): I · texel, W/sr.
//
// The image is square and equal-area ([Clarberg08]); its middle is the light's +y, its corners -y, the middle of its
// right edge +x and that of its lower edge +z, as in pbrt-v4 (whose y and z are exchanged for this light). A
// direction's intensity is its texel's, without interpolation; R, G and B are averaged, the colour is that of I.
// Shaping multiplies it, about -z as for "point".
#include "lights/types/image_profile.h"
#include "lights/types/shaped_point.h"
#include "sampling/equal_area.h"
#include "sampling/tables.h"

namespace lampyr {

LightType GoniometricLightType();

namespace {

class GoniometricProfile {
 public:
  explicit GoniometricProfile(EmissionImage image) : image_(std::move(image)), parts_(image_) {
    const int width = image_.Width(), height = image_.Height();
    std::vector<float> weights(static_cast<size_t>(width) * height);
    double sum = 0;
    for (size_t i = 0; i < weights.size(); ++i) {
      weights[i] = image_.Texel(static_cast<int>(i) % width, static_cast<int>(i) / width).Average();
      sum += static_cast<double>(weights[i]);
      largest_ = std::max(largest_, weights[i]);
    }
    solidAngle_ = kSphere * sum / static_cast<double>(weights.size());
    LiftDimWeights(weights);
    table_ = Distribution2D(weights, width, height);
  }

  float Shape(const LightTransform& transform, const Vector3& direction) const {
    return image_.Nearest(ToSquare(transform, direction)).Average();
  }
  float Largest() const { return largest_; }

  Vector3 Sample(const LightTransform& transform, const Point2& u) const {
    if (table_.IsZero()) return {0, 0, 1};
    const Vector3 map = EqualAreaSquareToSphere(table_.Sample(u).uv);
    return ToRenderDirection(transform, {map.x, map.z, map.y});
  }

  // Density proportional to the texels, times the change of solid angle. All methods that report it call this.
  PdfSolidAngle Density(const LightTransform& transform, const Vector3& direction) const {
    if (table_.IsZero()) return PdfSolidAngle(0);
    const float density = table_.Density(ToSquare(transform, direction)) / kEqualAreaJacobian;
    return PdfSolidAngle(density * LocalSolidAngleFactor(transform, direction));
  }

  // Closed form under rotations and uniform scales; otherwise a quadrature in local directions.
  double SolidAngle(const LightTransform& transform) const {
    if (IsSimilarity(transform.toRender.linear)) return solidAngle_;
    double sum = 0;
    for (const ImageParts::Part& part : parts_.Parts()) {
      const Vector3 map = EqualAreaSquareToSphere(part.Middle());
      const float factor = LocalSolidAngleFactor(transform, ToRenderDirection(transform, {map.x, map.z, map.y}));
      const Point2d size = part.high - part.low;
      sum += static_cast<double>(part.mean.Average() / factor) * size.x * size.y;
    }
    return kSphere * sum;
  }

  void SetCones(const LightTransform&, EmissionBounds& bounds) const {
    bounds.cosThetaO = -1;
    bounds.cosThetaE = 0;
  }
  bool Clip(const LightTransform&, const Point3&, const Point3&, const Vector3&, float&, float&) const { return true; }

 private:
  static constexpr double kSphere = 4 * 3.14159265358979323846;

  static Point2 ToSquare(const LightTransform& transform, const Vector3& direction) {
    const Vector3 local = ToLocalDirection(transform, direction);
    return EqualAreaSphereToSquare({local.x, local.z, local.y});
  }

  EmissionImage image_;
  ImageParts parts_;
  Distribution2D table_;
  double solidAngle_ = 0;
  float largest_ = 0;
};

EmissionImage ReadDiagram(const ParameterList& parameters, const LightBuildContext& build) {
  const EmissionImage image(parameters, "filename", build);
  if (image.IsEmpty()) {
    if (build.diagnostics && !parameters.Find("shaping:ies:file")) {
      build.diagnostics->Warn(
          parameters.Where(),
          "LightSource \"goniometric\": there is no \"filename\"; it shines alike in all directions");
    }
    auto even = std::make_shared<Image>(1, 1, std::vector<std::string>{"Y"});
    even->data = {1.0f};
    return {even, "even", parameters.Where(), nullptr};
  }
  if (image.Width() != image.Height()) {
    throw Error(parameters.WhereOf("filename"),
                "LightSource \"goniometric\": the image is " + std::to_string(image.Width()) + "×" +
                    std::to_string(image.Height()) + "; a square one (equal-area) is needed");
  }
  return image;
}

std::unique_ptr<Light> CreateGoniometric(const ParameterList& parameters, const LightBuildContext& build) {
  const PointSource source{ReadEmissionColor(parameters, "I")};
  return MakePointLight(GoniometricLightType, parameters, build, GoniometricProfile(ReadDiagram(parameters, build)),
                        source, {0, 0, -1});
}

}  // namespace

LightType GoniometricLightType() {
  LightType type;
  type.name = "goniometric";
  type.help = "a point whose intensity over all directions is an image; shaping is about -z";
  type.parameters = WithShapingParameters({
      {"I", ParameterType::Spectrum, "W/sr", "1", "", "intensity where the image is 1"},
      {"scale", ParameterType::Float, "", "1", ">= 0", "multiplies the intensity"},
      {"power", ParameterType::Float, "W", "-1", "", "if positive: total power that an intensity of 1 is scaled to"},
      {"filename", ParameterType::String, "", "\"\"", "", "square equal-area image; its middle is +y"},
  });
  type.create = CreateGoniometric;
  type.samples = {
      "\"string filename\" \"suite-square.exr\" \"rgb I\" [ 3 2 1 ]",
      "\"string filename\" \"suite-bright.exr\" \"float power\" 20",
      "\"string filename\" \"suite-black.exr\" \"float power\" 5",
      "\"float scale\" 2 \"float exposure\" 1",
      "\"string filename\" \"suite-square.exr\" \"string shaping:ies:file\" \"suite-profile.ies\" \"float power\" 20",
  };
  return type;
}

}  // namespace lampyr
