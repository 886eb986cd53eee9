// Area lights in scenes: irradiance under every shape, place and side against an integral of its own in double; lights
// that are not there; what the camera sees of them.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include <glm/ext/matrix_transform.hpp>

#include "support/render_scene.h"

namespace lampyr::test {
namespace {

using Matrix = glm::dmat4;

struct EmittingShape {
  const char* name;
  const char* text;
  std::function<Point3d(double, double)> at;  // over the unit square; du × dv points to the outside
};

const std::vector<EmittingShape>& EmittingShapes() {
  static const std::vector<EmittingShape> shapes = {
      {"sphere", "Shape \"sphere\" \"float radius\" 0.4\n",
       [](double u, double v) {
         const double z = 2 * v - 1, r = std::sqrt(std::max(0.0, 1 - z * z));
         return 0.4 * Point3d(r * std::cos(2 * M_PI * u), r * std::sin(2 * M_PI * u), z);
       }},
      {"cylinder", "Shape \"cylinder\" \"float radius\" 0.3 \"float zmin\" -0.5 \"float zmax\" 0.5\n",
       [](double u, double v) { return Point3d(0.3 * std::cos(2 * M_PI * u), 0.3 * std::sin(2 * M_PI * u), v - 0.5); }},
      {"disk",
       "Shape \"disk\" \"float radius\" 0.5 \"float innerradius\" 0.2 \"float height\" 0.1 \"float phimax\" 90\n",
       [](double u, double v) {
         const double r = 0.2 + 0.3 * u;
         return Point3d(r * std::cos(0.5 * M_PI * v), r * std::sin(0.5 * M_PI * v), 0.1);
       }},
      {"mesh",
       "Shape \"trianglemesh\" \"point3 P\" [-0.5 -0.4 0 0.5 -0.4 0 0.5 0.4 0 -0.5 0.4 0] \"integer indices\" [0 1 2 0 "
       "2 3]\n",
       [](double u, double v) { return Point3d(u - 0.5, 0.8 * v - 0.4, 0); }},
      {"bilinear", "Shape \"bilinearmesh\" \"point3 P\" [-0.5 -0.5 0.2 0.5 -0.4 -0.1 -0.4 0.5 -0.1 0.6 0.4 0.2]\n",
       [](double u, double v) {
         const Point3d a(-0.5, -0.5, 0.2), b(0.5, -0.4, -0.1), c(-0.4, 0.5, -0.1), d(0.6, 0.4, 0.2);
         return (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * c + u * d);
       }}};
  return shapes;
}

// Irradiance at the origin, facing +y, of radiance 1 that leaves the outside of the shape placed by `m`.
double Irradiance(const EmittingShape& shape, const Matrix& m) {
  const auto at = [&](double u, double v) { return Point3d(m * glm::dvec4(shape.at(u, v), 1)); };
  const double handedness = glm::determinant(glm::dmat3(m)) < 0 ? -1 : 1;
  constexpr int n = 300;
  constexpr double h = 1e-5;
  double sum = 0;
  for (int i = 0; i < n * n; ++i) {
    const double u = (i % n + 0.5) / n, v = (i / n + 0.5) / n;
    const Point3d p = at(u, v);
    const Vector3d element =
        handedness / (4 * h * h) * glm::cross(at(u + h, v) - at(u - h, v), at(u, v + h) - at(u, v - h));
    const double cosineTimesArea = -glm::dot(element, p) / glm::length(p), cosine = p.y / glm::length(p);
    if (cosineTimesArea > 0 && cosine > 0) sum += cosineTimesArea * cosine / glm::dot(p, p);
  }
  return sum / (n * n);
}

struct Place {
  const char* name;
  Matrix matrix;
};

// Where z points down, more or less, above the receiver.
std::vector<Place> Places() {
  const auto turned = [](double angle, double around) {
    return glm::rotate(glm::rotate(Matrix(1), around, Vector3d(0, 1, 0)), angle, Vector3d(1, 0, 0));
  };
  const Matrix base = turned(1.9, 0.4);
  const Matrix shear(1, 0, 0.2, 0, 0.7, 1, 0, 0, 0, 0.3, 1, 0, 0, 0, 0, 1);
  const auto scaled = [](double x, double y, double z) { return glm::scale(Matrix(1), Vector3d(x, y, z)); };
  std::vector<Place> places = {{"rotated", base},
                               {"stretched", base * scaled(1.7, 0.4, 0.8)},
                               {"mirrored", base * scaled(-1, 1, 1)},
                               {"mirrored and stretched", scaled(1, 1.5, 1) * base * scaled(0.5, -1.2, 1.4)},
                               {"sheared", shear * base}};
  for (Place& place : places) place.matrix = glm::translate(Matrix(1), Vector3d(0.3, 1.4, -0.2)) * place.matrix;
  return places;
}

std::string Concat(const Matrix& m) {
  std::string text = "ConcatTransform [";
  for (int i = 0; i < 16; ++i) text += std::to_string(m[i / 4][i % 4]) + " ";
  return text + "]\n";
}

// The camera sees a white disk around the origin that faces +y: the image is E/π.
const std::string kReceiver = R"(Film "rgb" "integer xresolution" 8 "integer yresolution" 8
PixelFilter "box"
LookAt 0 0.02 0.01  0 0 0  0 1 0
Camera "perspective" "float fov" 0.5
Integrator "path" "integer maxdepth" 1
WorldBegin
Material "diffuse" "rgb reflectance" [1 1 1]
AttributeBegin Rotate 90 1 0 0 Shape "disk" "float radius" 0.05 AttributeEnd
)";
const std::string kDark = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n";

void ExpectIrradiance(const std::string& light, double irradiance, const std::string& what, int samples = 256) {
  const Rendered rendered = RenderText(kReceiver + light, samples);
  const MeanValue value = MeanOf(rendered.image);
  EXPECT_LT(value.standardError, 0.02 * irradiance) << what;
  EXPECT_NEAR(value.mean, irradiance / M_PI, 4.5 * value.standardError + 1e-3 * irradiance) << what;
  EXPECT_EQ(rendered.outcome.counts.droppedSamples + rendered.rejectedRays, 0u) << what;
}

TEST(AreaLight, EveryShapeInEveryPlace) {
  int cases = 0;
  for (const EmittingShape& shape : EmittingShapes()) {
    for (const Place& place : Places()) {
      const std::string what = std::string(shape.name) + " " + place.name;
      const double irradiance = 3 * Irradiance(shape, place.matrix);
      ASSERT_GT(irradiance, 0.01) << what;
      const std::string light = "AreaLightSource \"diffuse\" \"rgb L\" [3 3 3]\n" + kDark;
      ExpectIrradiance(light + Concat(place.matrix) + shape.text, irradiance, what);
      ExpectIrradiance(
          "ObjectBegin \"o\"\n" + light + shape.text + "ObjectEnd\n" + Concat(place.matrix) + "ObjectInstance \"o\"\n",
          irradiance, what + ", instanced");
      cases += 2;
    }
  }
  std::printf("%d cases\n", cases);
}

TEST(AreaLight, OpacityZeroShinesAndIsNotThere) {
  // A BSDF ray cannot find it: light sampling alone has to carry everything.
  // light.
  const double irradiance = M_PI * 7 * std::pow(0.5 / 0.6, 2);
  const std::string sphere = "Translate 0 0.6 0\nShape \"sphere\" \"float radius\" 0.5 ";
  const std::string light = "AreaLightSource \"diffuse\" \"rgb L\" [7 7 7]\n";
  ExpectIrradiance(light + sphere + "\"float alpha\" 0\n", irradiance, "constant");
  ExpectIrradiance(
      "Texture \"none\" \"float\" \"constant\" \"float value\" 0\n" + light + sphere + "\"texture alpha\" \"none\"\n",
      irradiance, "constant texture");
  ExpectIrradiance("ObjectBegin \"o\"\n" + light + sphere + "\"float alpha\" 0\nObjectEnd\nObjectInstance \"o\"\n",
                   irradiance, "instanced");
  ExpectIrradiance("AttributeBegin\n" + light + sphere + "\"float alpha\" 0\nAttributeEnd\n" +
                       "Translate 0 0.6 0\nShape \"sphere\" \"float radius\" 0.55 \"float alpha\" 0\n",
                   irradiance, "behind a surface that is not there");
}

// Radiance of a light at a camera at the origin, in front of an environment of radiance 0.25.
double SeenRadiance(const std::string& light) {
  const std::string head = R"(Film "rgb" "integer xresolution" 4 "integer yresolution" 4
Camera "perspective" "float fov" 5
WorldBegin
LightSource "infinite" "rgb L" [0.25 0.25 0.25]
)";
  return MeanOf(RenderText(head + light, 4).image).mean;
}

TEST(AreaLight, CameraSeesThroughWhatIsNotVisible) {
  const std::string shape = "Translate 0 0 3\nShape \"sphere\" ";
  const auto light = [](const char* setting) {
    return std::string("AreaLightSource \"diffuse\" \"rgb L\" [7 7 7] ") + setting + "\n" + kDark;
  };
  const std::string hidden = light("\"bool cameraVisible\" false");
  EXPECT_NEAR(SeenRadiance(light("") + shape), 7, 1e-5);
  EXPECT_NEAR(SeenRadiance(hidden + shape), 0.25, 1e-6);
  EXPECT_NEAR(SeenRadiance("ObjectBegin \"o\"\n" + light("") + shape + "\nObjectEnd\nObjectInstance \"o\"\n"), 7, 1e-5);
  EXPECT_NEAR(SeenRadiance("ObjectBegin \"o\"\n" + hidden + shape + "\nObjectEnd\nObjectInstance \"o\"\n"), 0.25, 1e-6);
  EXPECT_NEAR(SeenRadiance(light("") + shape + "\"float alpha\" 0"), 0.25, 1e-6);
}

TEST(AreaLight, PowerBeyondFloatIsLikelyAndNotImpossible) {
  for (const char* selection : {"power", "tree", "exhaustive"}) {
    Diagnostics diagnostics(Diagnostics::Mode::Collect);
    RenderOverrides overrides;
    overrides.values["light-sampler"] = selection;
    const BuiltScene built = BuildScene(ParseScene(kReceiver + R"(LightSource "point"
AreaLightSource "diffuse" "rgb L" [1e36 1e36 1e36]
Translate 0 5000 0
Shape "sphere" "float radius" 1000
)",
                                                   "test.pbrt", diagnostics),
                                        overrides, true, diagnostics);
    const Receiver receiver{built.scene.lighting->SceneSphere().center, Normal3(0.0f), false};
    EXPECT_GT(built.scene.lighting->SelectionProbability(receiver, 1, kAnyPatch).value, 0.9f) << selection;
  }
}

}  // namespace
}  // namespace lampyr::test
